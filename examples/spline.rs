//! Fits a cubic spline to a surface and evaluates it: `cargo run --release --example spline`.

#![allow(clippy::print_stdout)]

use ricci::spline::{FlatMetric, FlatMetricOptions, SurfaceFitOptions, fit_surface};
use ricci::{Control, Result, Surface, mesh::shapes};

fn main() -> Result<()> {
    let (surface, control) = (Surface::from_soup(&shapes::torus(2.0, 1.0, 36, 18)?)?, Control::new());
    let flat = FlatMetric::new(&surface, &FlatMetricOptions::default(), &control)?;
    let fit = fit_surface(&surface, &flat, &SurfaceFitOptions::default(), &control)?;
    assert!(fit.folds.is_empty());
    println!("largest distance {:.1e} of the diagonal of the bounding box", fit.max);
    let smooth = fit.spline.tessellate(8, 0, &control)?;
    println!("{} points on the spline", smooth.positions.len());
    Ok(())
}
