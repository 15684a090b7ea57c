//! The figures of forms, as the report has them, and what is said of them.

use super::found::Found;
use crate::failure::Failure;
use crate::report::{Done, Figures};
use crate::say;
use ricci::harmonic::Zero;
use serde_json::{Value, json};

fn zeros(zeros: &[Zero]) -> Value {
    zeros.iter().map(|z| json!({"vertex": z.vertex.0, "multiplicity": z.multiplicity})).collect()
}

pub fn of_forms(found: &Found) -> Figures {
    let (forms, periods) = (&found.forms, found.periods.as_ref());
    let figures = Figures::default()
        .with("forms", forms.forms.len())
        .with("basis", forms.basis.group.names())
        .with("flips", forms.domain.metric().start_flips())
        .with("period_matrix", periods.map_or(Value::Null, |p| json!(p.matrix)))
        .with("zeros", found.zeros.iter().map(|z| zeros(z)).collect::<Vec<_>>())
        .with("closedness", forms.closedness)
        .with("coclosedness", forms.coclosedness)
        .with("period_error", found.period_error())
        .with("largest_index", found.largest_index())
        .with("riemann_symmetry", periods.map(|p| p.asymmetry))
        .with("riemann_min_eigenvalue", periods.map(|p| p.least_eigenvalue))
        .with("star_residual", periods.map(|p| p.star_residual))
        .if_some("modulus", periods.and_then(|p| p.modulus()).map(|tau| json!(tau)));
    match &found.chosen {
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

pub fn say(done: &Done<Found>) -> Result<(), Failure> {
    let found = &done.result;
    let forms = &found.forms;
    let mut text = say::surface(&done.input);
    text += &format!(
        "forms    {}, dω = {:.1e}, d*ω = {:.1e}, integrals off by {:.1e}\n",
        say::count(forms.forms.len(), "harmonic form", "harmonic forms"),
        forms.closedness,
        forms.coclosedness,
        found.period_error()
    );
    if let Some(periods) = &found.periods {
        text += &format!(
            "periods  least eigenvalue of Im Π {:.6}, ‖Π − Πᵀ‖/‖Π‖ = {:.1e}, ‖J² + 1‖ = {:.1e}{}\n",
            periods.least_eigenvalue,
            periods.asymmetry,
            periods.star_residual,
            say::modulus(periods.modulus())
        );
    }
    if let Some(chosen) = &found.chosen {
        let total: i64 = chosen.zeros.iter().map(|z| z.multiplicity).sum();
        text += &format!(
            "drawn    a form with {} at {}, dilatation {:.4} on average, {:.4} on 99% of the area\n",
            say::count(total.unsigned_abs() as usize, "zero", "zeros"),
            say::count(chosen.zeros.len(), "vertex", "vertices"),
            chosen.dilatation.0,
            chosen.dilatation.1
        );
    }
    say::lines(&(text + &say::finish(done, &found.failed)), &done.files)
}
