//! The checks, the figures and the summary of `ricci forms`.

use super::outcome::FormsOutcome;
use crate::report::{Checks, Done, Figures, InputSummary};
use crate::runner::{CommandRun, JobOutcome};
use crate::say;
use ricci::harmonic::Zero;
use ricci::moduli::PeriodBounds;
use serde_json::{Value, json};

fn zeros(zeros: &[Zero]) -> Value {
    zeros.iter().map(|z| json!({"vertex": z.vertex.0, "multiplicity": z.multiplicity})).collect()
}

/// The proven period matrix, with the radius of each entry.
fn bounds(found: &PeriodBounds) -> Value {
    let g = found.matrix.len();
    let radius: Vec<Vec<f64>> = (0..g).map(|i| (0..g).map(|j| found.radius(i, j)).collect()).collect();
    let mut figures = json!({
        "period_matrix": found.matrix,
        "radius": radius,
        "first_gap": found.first_gap,
        "vertices_added": found.n_added,
        "unknowns": found.n_unknowns,
        "systems": found.rounds,
        "reached": found.is_reached,
    });
    // In a basis of short loops, whose rows are sums of the loops a1, b1, ….
    let reduced = found.reduced();
    figures["reduced"] =
        json!({"period_matrix": reduced.matrix, "radius": reduced.radius, "loops": reduced.loops});
    if let Some(tau) = found.modulus() {
        figures["modulus"] = json!(tau.value);
        figures["modulus_radius"] = json!(tau.radius);
    }
    figures
}

/// The width of the period matrix in words.
fn width(found: &PeriodBounds) -> String {
    let narrowed = if found.is_reached { "" } else { ", not as narrow as asked for" };
    let modulus = found.modulus().map_or_else(String::new, |tau| {
        format!("{}, off by at most {:.1e}", say::modulus(Some(tau.value)), tau.radius)
    });
    format!(
        "bounds   Π is known to {:.1e}{narrowed}, by {} more{modulus}\n",
        found.gap,
        say::count(found.n_added, "vertex", "vertices"),
    )
}

/// Largest dω of a form of the basis, relative to its largest value.
const CLOSED: f64 = 1e-12;
/// Largest d*ω of a form of the basis, relative to its largest value.
const COCLOSED: f64 = 1e-10;
/// Largest error of the integral of a form of the basis over a loop.
const PERIODS: f64 = 1e-10;

impl JobOutcome for FormsOutcome {
    type Figures = Figures;

    fn checks(&self) -> Checks {
        let mut checks = Checks::default();
        checks.add("closedness", self.forms.closedness, CLOSED);
        checks.add("coclosedness", self.forms.coclosedness, COCLOSED);
        checks.add("period_error", self.period_error(), PERIODS);
        if let Some(periods) = &self.periods {
            // Positive definite: minus the least eigenvalue is below 0.
            checks.add("riemann_indefinite", -periods.least_eigenvalue, 0.0);
            let expected = 2 * periods.genus() as i64 - 2;
            let total = |zeros: &Vec<Zero>| zeros.iter().map(|z| z.multiplicity).sum::<i64>();
            let off = self.zeros.iter().map(|zeros| (total(zeros) - expected).abs()).max().unwrap_or(0);
            checks.add("zeros_missing", off as f64, 0.0);
        }
        if let (Some(bounds), Some(width)) = (&self.bounds, self.width) {
            checks.add_with_remedy("width", bounds.gap, width, "ask for a larger --width");
        }
        checks
    }

    fn input(&self) -> Option<InputSummary> {
        Some(InputSummary::of(&self.input))
    }

    fn figures(&self, run: &CommandRun<'_>) -> Figures {
        let (forms, periods) = (&self.forms, self.periods.as_ref());
        let figures = Figures::default()
            .with("left_out", run.outputs.left_out())
            .with("forms", forms.forms.len())
            .with("basis", forms.basis.group.names())
            .with("flips", forms.domain.metric().start_flips())
            .with("period_matrix", periods.map_or(Value::Null, |p| json!(p.matrix)))
            .with("zeros", self.zeros.iter().map(|z| zeros(z)).collect::<Vec<_>>())
            .with("closedness", forms.closedness)
            .with("coclosedness", forms.coclosedness)
            .with("period_error", self.period_error())
            .with("largest_index", self.largest_index())
            .with("riemann_symmetry", periods.map(|p| p.asymmetry))
            .with("riemann_min_eigenvalue", periods.map(|p| p.least_eigenvalue))
            .with("star_residual", periods.map(|p| p.star_residual))
            .if_some("modulus", periods.and_then(|p| p.modulus()).map(|tau| json!(tau)))
            .if_some("gap", self.bounds.as_ref().map(|b| b.gap))
            .if_some("bounds", self.bounds.as_ref().map(bounds));
        match &self.chosen {
            Some(chosen) => figures
                .with("combination", chosen.coefficients.clone())
                .with("combination_zeros", zeros(&chosen.zeros))
                .with("unevenness", chosen.unevenness)
                .with("flipped_triangles", chosen.layout.flipped.len())
                .with("qc_mean", chosen.dilatation.0)
                .with("qc_99", chosen.dilatation.1),
            None => figures,
        }
    }

    fn summary(&self, done: &Done) -> String {
        let forms = &self.forms;
        let mut text = say::surface(&self.input);
        text += &format!(
            "forms    {}, dω = {:.1e}, d*ω = {:.1e}, integrals off by {:.1e}\n",
            say::count(forms.forms.len(), "harmonic form", "harmonic forms"),
            forms.closedness,
            forms.coclosedness,
            self.period_error()
        );
        if let Some(periods) = &self.periods {
            text += &format!(
                "periods  least eigenvalue of Im Π {:.6}, ‖Π − Πᵀ‖/‖Π‖ = {:.1e}, ‖J² + 1‖ = {:.1e}{}\n",
                periods.least_eigenvalue,
                periods.asymmetry,
                periods.star_residual,
                say::modulus(periods.modulus())
            );
        }
        text += &self.bounds.as_ref().map_or_else(String::new, width);
        if let Some(chosen) = &self.chosen {
            let total: i64 = chosen.zeros.iter().map(|z| z.multiplicity).sum();
            text += &format!(
                "drawn    a form with {} at {}, dilatation {:.4} on average, {:.4} on 99% of the area\n",
                say::count(total.unsigned_abs() as usize, "zero", "zeros"),
                say::count(chosen.zeros.len(), "vertex", "vertices"),
                chosen.dilatation.0,
                chosen.dilatation.1
            );
        }
        text + &say::finish(done)
    }
}
