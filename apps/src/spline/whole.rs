//! Splines near whole surfaces, over their flat metric.

use super::args::{AtlasChoice, FitArgs, SingularChoice};
use super::outcome::FitOutcome;
use crate::failure::Failure;
use crate::input::Input;
use crate::progress::doing;
use crate::report::{Checks, Figures};
use ricci::Control;
use ricci::flow;
use ricci::spline::{
    FitCondition, FitFailure, FlatMetric, FlatMetricOptions, SurfaceFit, SurfaceFitOptions, fit_surface_over,
};
use serde_json::{Map, Value};

pub fn fit_whole(args: &FitArgs, input: Input, control: &Control) -> Result<FitOutcome, Failure> {
    let whole = &args.whole;
    if let SingularChoice::At(vertices) = &whole.singular {
        vertices.iter().try_for_each(|&v| input.check_vertex("--singular", Some(v)))?;
    }
    if input.positions().is_none() {
        let path = input.path.display();
        return Err(Failure::Input(format!(
            "{path}: an intrinsic metric has no points in space to be fitted"
        )));
    }
    let threads = args.common.threads;
    let options = FlatMetricOptions {
        source: whole.atlas.into(),
        singular: whole.singular.to_library(),
        corners: whole.corners.as_ref().map_or_else(Default::default, |corners| corners.to_library()),
        flow: flow::Options { threads, ..flow::Options::default() },
        ..FlatMetricOptions::default()
    };
    let flats =
        doing("flat metric", || FlatMetric::candidates(&input.surface, &options, &control.part(0.05, 0.2)))?;
    let usual = SurfaceFitOptions::default();
    let options = SurfaceFitOptions {
        degree: args.degree.into(),
        control_points: whole.control_points.map(|n| n as usize),
        tolerance: whole.tolerance,
        fairness: args.fairness.unwrap_or(usual.fairness),
        threads,
        ..usual
    };
    let fit = || fit_surface_over(&input.surface, &flats, &options, &control.part(0.2, 1.0));
    let (fitted, chosen) = doing("fit", fit)?;
    let mut checks = Checks::default();
    checks.add("max", fitted.max, whole.tolerance);
    checks.add("folded_patches", fitted.folds.len() as f64, 0.0);
    for failure in fitted.failures(&input.surface, whole.tolerance) {
        tell(&mut checks, &failure);
    }
    let singular: Vec<u32> = fitted.singular.iter().map(|v| v.0).collect();
    let mut defaults = Map::new();
    defaults.insert("fairness".into(), fitted.fairness.into());
    if let (AtlasChoice::Flow, [v]) = (whole.atlas, &singular[..]) {
        defaults.insert("singular".into(), Value::from(*v));
    }
    let factor_range = flats[chosen].factor_range(&input.surface)?;
    let folded_share = fitted.folded_share(&input.surface);
    // The total angles at the singular vertices, in turns; -1 at infinity.
    let angles: Vec<f64> = fitted.spline.holes().iter().map(|hole| hole.turns).collect();
    let radii: Vec<f64> = fitted.spline.holes().iter().map(|hole| hole.radius).collect();
    let figures = Figures::default()
        .with("singular_vertices", &singular[..])
        // The ratio of the largest factor between flat lengths and lengths on the surface to the least, outside their neighbourhoods.
        .with("factor_range", factor_range)
        .with("hole_angles", angles)
        // The radii of the holes in the unit of the flat metric, and the share of the vertices that lie in holes.
        .with("hole_radii", radii)
        .with("hole_share", share_in_holes(&fitted))
        .with("hole_coefficients", coefficients(&fitted))
        // Patches in which normals turn by more than 60 degrees over a twelfth of a side.
        .with("folded_patches", &fitted.folds[..])
        .with("folded_share", folded_share)
        .with("rounds", fitted.rounds);
    let SurfaceFit { rms, max, spline, .. } = fitted;
    Ok(FitOutcome { input, spline, rms, max, defaults, figures, checks })
}

/// Most patches that a summary names.
const NAMED: usize = 8;

/// Adds to a check that fails the place and what can be changed.
fn tell(checks: &mut Checks, failure: &FitFailure) {
    let (name, remedy) = match failure.condition {
        FitCondition::RootMeanSquare => {
            ("rms", "more control points (--control-points) or a larger --tolerance")
        }
        FitCondition::Largest => (
            "max",
            "more control points (--control-points), another singular vertex (--singular) so that the flat metric shrinks less there, or a \
             larger --tolerance",
        ),
        FitCondition::Folds => (
            "folded_patches",
            "more control points (--control-points), more --fairness, or another singular vertex (--singular) or --atlas, so that the flat \
             metric shrinks less there",
        ),
    };
    let mut named: Vec<String> = failure.patches.iter().take(NAMED).map(ToString::to_string).collect();
    if failure.patches.len() > NAMED {
        named.push("…".into());
    }
    let vertex = failure.vertex.map_or_else(String::new, |v| format!(", worst at vertex {v}"));
    let place = format!(
        "{:.2} % of the surface, {} {}{vertex}",
        100.0 * failure.share,
        if failure.patches.len() == 1 { "patch" } else { "patches" },
        named.join(", ")
    );
    if let Some(check) = checks.0.get_mut(name).filter(|check| !check.holds) {
        (check.place, check.remedy) = (Some(place), Some(remedy.into()));
    }
}

fn share_in_holes(fitted: &SurfaceFit) -> f64 {
    let holes = fitted.spline.holes();
    let inside = fitted.places.iter().filter(|&&at| holes.iter().any(|hole| hole.contains(at))).count();
    inside as f64 / fitted.places.len().max(1) as f64
}

fn coefficients(fitted: &SurfaceFit) -> usize {
    let fills = fitted.spline.holes().iter().filter_map(|hole| hole.fill.as_ref());
    fills.map(|fill| fill.coefficients().len()).sum()
}
