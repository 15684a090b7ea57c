//! Splines near height fields, with x and y of the mesh as parameters: `ricci spline fit --planar`.

use super::args::FitArgs;
use super::height_field::{HeightField, height_field};
use super::outcome::FitOutcome;
use crate::failure::Failure;
use crate::input::Input;
use crate::report::{Checks, Figures};
use ricci::Control;
use ricci::geometry::vector::diagonal;
use ricci::spline::{
    FitOptions, KnotOptions, Locator, Parameter, SplineFit, SplineSpace, fit as fit_points, triangulate,
};
use serde_json::Map;
use std::sync::Arc;

/// The number of control points per vertex of the mesh where no edge length is asked for.
const CONTROL_SHARE: f64 = 0.25;
/// The weight of the variation of bending where none is asked for.
const FAIRNESS: f64 = 1e-12;

pub fn fit_planar(args: &FitArgs, input: Input, control: &Control) -> Result<FitOutcome, Failure> {
    let field = height_field(&input)?;
    let edge =
        args.edge.unwrap_or_else(|| usual_edge(&field.outline, field.points.len(), args.degree.into()));
    let fitted = fitted(args, &field, edge, control)?;
    let diagonal = diagonal(field.points);
    let mut defaults = Map::new();
    defaults.insert("edge".into(), edge.into());
    defaults.insert("fairness".into(), args.fairness.unwrap_or(FAIRNESS).into());
    Ok(FitOutcome {
        rms: fitted.rms / diagonal,
        max: fitted.max / diagonal,
        spline: fitted.spline,
        defaults,
        figures: Figures::default(),
        checks: Checks::default(),
        input,
    })
}

fn fitted(
    args: &FitArgs,
    field: &HeightField<'_>,
    edge: f64,
    control: &Control,
) -> Result<SplineFit, Failure> {
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
    let options = FitOptions { fairness: args.fairness.unwrap_or(FAIRNESS), threads: args.common.threads };
    Ok(fit_points(&Arc::new(space), &places, field.points, &options, control)?)
}

/// The edge length of the domain's triangles for which there are about a quarter as many control points as vertices, at n²/2 control
/// points per triangle for degree n.
fn usual_edge(outline: &[Vec<[f64; 2]>], vertices: usize, degree: usize) -> f64 {
    let doubled = |polygon: &Vec<[f64; 2]>| -> f64 {
        let next = polygon.iter().cycle().skip(1);
        polygon.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum()
    };
    let area = 0.5 * outline.iter().map(doubled).sum::<f64>().abs();
    let triangles = 2.0 * CONTROL_SHARE * vertices as f64 / (degree * degree) as f64;
    (4.0 / 3f64.sqrt() * area / triangles.max(1.0)).sqrt()
}
