//! What `ricci flow` says on stdout.

use crate::failure::Failure;
use crate::job::Outcome;
use crate::laid::Laid;
use crate::report::Done;
use crate::say::{count, ending, lines, modulus, surface, tolerance};
use ricci::flow::StopReason;
use ricci::mesh::VertexId;

/// The summary of a flow.
pub fn say(done: &Done<Outcome>) -> Result<(), Failure> {
    let outcome = &done.result;
    let report = &outcome.report;
    let mut text = surface(&done.input);
    text += &format!(
        "metric   {} {}, target {}: {} after {}, max |K − K̄| = {:.1e}{}{}\n",
        outcome.solved.solution.metric().space,
        outcome.solved.scheme,
        outcome.rule_name,
        report.stop_reason,
        count(report.iterations, "step", "steps"),
        report.max_curvature_error,
        tolerance(report.tolerance),
        match report.broken_triangles {
            0 => String::new(),
            n => format!(", {}", count(n, "broken triangle", "broken triangles")),
        }
    );
    if !report.converged() {
        text += &format!("why      {}\n", why(outcome));
    }
    text += &match &outcome.layout {
        Ok(laid) => format!("layout   {}\n", layout(laid)),
        Err(why) => format!("layout   none: {why}\n"),
    };
    lines(&(text + &ending(done, &outcome.solved)), &done.files)
}

/// The quality of a layout.
pub fn layout(laid: &Laid) -> String {
    let q = &laid.quality;
    let mut text = format!(
        "{}, dilatation mean {:.4} max {:.3}, area ratio {:.2e} to {:.2e}",
        count(laid.flipped().len(), "triangle flipped", "triangles flipped"),
        q.qc_mean,
        q.qc_max,
        q.area_ratio_min,
        q.area_ratio_max
    );
    if let Some(packed) = &laid.packed {
        let charts = &packed.charts;
        text += &format!(
            "\ncharts   {}, {:.0} % of the unit square",
            count(charts.count(), "chart", "charts"),
            100.0 * charts.efficiency
        );
    }
    text + &modulus(laid.modulus)
}

/// Why a flow did not converge, as far as that is known.
fn why(outcome: &Outcome) -> String {
    let report = &outcome.report;
    if report.stop_reason == StopReason::BrokenTriangles {
        return format!(
            "no metric of the scheme on this triangulation: its energy is least with broken {}",
            named("face", "faces", &outcome.solved.curvature.broken)
        );
    }
    if let Some(o) = &report.obstruction {
        return format!(
            "the target adds up to {:.6} at {}; every metric of the scheme on this triangulation has more than {:.6} there",
            o.curvature,
            named("vertex", "vertices", &o.vertices),
            o.least
        );
    }
    if let StopReason::OutOfReach { step } = report.stop_reason {
        return format!(
            "lengths would differ by a factor of about e^{step:.0}: too much curvature at too few vertices; spread it over cones \
             (--target auto:N), or make the boundary geodesic where χ < 0 (ricci uniformize)"
        );
    }
    let worst: Vec<VertexId> = report.worst.iter().map(|&(v, _)| v).collect();
    format!("the error is largest at {}", named("vertex", "vertices", &worst))
}

/// The first few elements of a list.
fn named<Id: ToString>(one: &str, many: &str, list: &[Id]) -> String {
    const SHOWN: usize = 5;
    let ids: Vec<String> = list.iter().take(SHOWN).map(ToString::to_string).collect();
    let more = if list.len() > SHOWN { format!(" … ({} in all)", list.len()) } else { String::new() };
    format!("{} {}{more}", if list.len() == 1 { one } else { many }, ids.join(", "))
}
