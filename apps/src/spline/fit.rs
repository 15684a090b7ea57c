//! `ricci spline fit`.

use super::args::FitArgs;
use super::height_field::{HeightField, height_field};
use crate::failure::Failure;
use crate::input::{self, Input};
use crate::options::MeshArgs;
use crate::output::{Outputs, check_extension, check_outputs};
use crate::progress::Progress;
use crate::report::{Checks, Figures, InputSummary, Report, Seconds, timed};
use crate::say::{self, count};
use ricci::Control;
use ricci::spline::{
    FitOptions, Fitted, Identities, KnotOptions, Locator, Parameter, SplineSpace, fit as fit_points,
    triangulate,
};
use serde::Serialize;
use std::io::Write;
use std::sync::Arc;
use std::time::Instant;

/// Control points per vertex of the mesh where no edge is asked for.
const CONTROL_SHARE: f64 = 0.25;
/// Limits of the checks: identities of exact arithmetic, which doubles keep to this.
const UNITY: f64 = 1e-12;
const REPRODUCTION: f64 = 1e-10;
const CONTINUITY: f64 = 1e-8;

#[derive(Serialize)]
struct Asked<'a> {
    edge: f64,
    #[serde(flatten)]
    args: &'a FitArgs,
}

/// Fit a spline to a mesh over the plane. The exit code is 1 if a check fails.
pub fn fit(args: &FitArgs, control: &Control) -> Result<u8, Failure> {
    let start = Instant::now();
    check_extension("-o", Some(&args.out), &["json"])?;
    check_outputs(&[Some(&args.mesh)], &[Some(&*args.out), args.common.report.as_deref()])?;
    let progress = Progress::watch(control, args.common.quiet);
    let file = MeshArgs { mesh: args.mesh.clone(), weld: None };
    let input = input::read(&file, None, control)?;
    let mut seconds = Seconds { ..input.seconds };
    let field = height_field(&input)?;
    let edge =
        args.edge.unwrap_or_else(|| usual_edge(&field.outline, field.points.len(), args.degree.into()));
    let fitted = timed(&mut seconds.solve, || fitted(args, &field, edge, control))?;
    let identities = fitted.spline.identities(args.common.threads, control)?;
    let (diagonal, checks) = (diagonal(field.points), checks(&identities));
    let figures = figures(&fitted, &identities, diagonal);
    let mut outputs = Outputs::default();
    timed(&mut seconds.write, || {
        outputs.add(&args.out, |out| out.write_all(fitted.spline.to_json().as_bytes()))
    })?;
    let text = text(args, &input, (&fitted, diagonal), &checks);
    if let Some(path) = &args.common.report {
        seconds.total = start.elapsed().as_secs_f64();
        let report = Report::new("spline", InputSummary::of(&input), Asked { edge, args }, figures);
        outputs.add_report(path, &report.finished(checks.clone(), seconds))?;
    }
    control.check()?;
    let files = outputs.commit()?;
    drop(progress);
    if !args.common.quiet {
        say::lines(&text, &files)?;
    }
    Ok(checks.exit_code())
}

fn fitted(args: &FitArgs, field: &HeightField<'_>, edge: f64, control: &Control) -> Result<Fitted, Failure> {
    let domain = triangulate(&field.outline, edge)?;
    control.check()?;
    let space = SplineSpace::planar(&domain, &domain.knots(args.degree.into(), &KnotOptions::default())?)?;
    let locator = Locator::new(&domain);
    let place = |(v, p): (usize, &[f64; 3])| -> Result<Parameter, Failure> {
        locator.locate([p[0], p[1]]).ok_or_else(|| {
            let path = args.mesh.display();
            Failure::Input(format!(
                "{path}: vertex {v} does not lie over the inside of the boundary: parts of the mesh overlap"
            ))
        })
    };
    let places = field.points.iter().enumerate().map(place).collect::<Result<Vec<_>, _>>()?;
    let options = FitOptions { fairness: args.fairness, threads: args.common.threads };
    Ok(fit_points(&Arc::new(space), &places, field.points, &options, control)?)
}

/// The edge for which there is about a quarter as many control points as vertices: n²/2 of them come to a triangle.
fn usual_edge(outline: &[Vec<[f64; 2]>], vertices: usize, degree: usize) -> f64 {
    let doubled = |polygon: &Vec<[f64; 2]>| -> f64 {
        let next = polygon.iter().cycle().skip(1);
        polygon.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum()
    };
    let area = 0.5 * outline.iter().map(doubled).sum::<f64>().abs();
    let triangles = 2.0 * CONTROL_SHARE * vertices as f64 / (degree * degree) as f64;
    (4.0 / 3f64.sqrt() * area / triangles.max(1.0)).sqrt()
}

/// The diagonal of the bounding box of points.
fn diagonal(points: &[[f64; 3]]) -> f64 {
    let extent = |x: usize| {
        let all = points.iter().map(|p| p[x]);
        all.clone().fold(f64::NEG_INFINITY, f64::max) - all.fold(f64::INFINITY, f64::min)
    };
    [0, 1, 2].map(extent).iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn figures(fitted: &Fitted, identities: &Identities, diagonal: f64) -> Figures {
    let space = fitted.spline.space();
    Figures::default()
        .with("degree", space.degree())
        .with("patches", space.patches().len())
        .with("control_points", space.n_control_points())
        // Fractions of the diagonal of the bounding box.
        .with("rms", fitted.rms / diagonal)
        .with("max", fitted.max / diagonal)
        .with("partition_of_unity", identities.partition_of_unity)
        .if_some("polynomial_reproduction", identities.polynomial_reproduction)
        .with("continuity", identities.continuity)
        // Sides between patches, at corners of the boundary, across which the spline is less smooth.
        .with("rough_sides", identities.rough_sides)
}

fn checks(identities: &Identities) -> Checks {
    let mut checks = Checks::default();
    checks.add("partition_of_unity", identities.partition_of_unity, UNITY);
    if let Some(error) = identities.polynomial_reproduction {
        checks.add("polynomial_reproduction", error, REPRODUCTION);
    }
    checks.add("continuity", identities.continuity, CONTINUITY);
    checks
}

fn text(args: &FitArgs, input: &Input, (fitted, diagonal): (&Fitted, f64), checks: &Checks) -> String {
    let space = fitted.spline.space();
    let failed = checks.failed();
    format!(
        "{}spline   degree {}, {}, {}\nfit      root mean square {:.2e}, largest {:.2e} of the diagonal of the bounding box\nchecks   {}\nwrote    {}\n",
        say::surface(input),
        args.degree,
        count(space.patches().len(), "patch", "patches"),
        count(space.n_control_points(), "control point", "control points"),
        fitted.rms / diagonal,
        fitted.max / diagonal,
        if failed.is_empty() { "all hold".into() } else { format!("FAILED: {}", failed.join(", ")) },
        args.out.display(),
    )
}
