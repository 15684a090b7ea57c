//! Splines over whole surfaces.

mod analytic;
mod closest;
mod coarse;
mod cones;
mod files;
mod fit;
mod hole;
mod order;
mod space;
mod sphere;

use ricci::mesh::shapes;
use ricci::spline::{FlatMetric, FlatMetricOptions, SurfaceFit, SurfaceFitOptions, fit_surface};
use ricci::{Control, Surface};
use std::sync::OnceLock;

/// A cubic spline over a surface of genus 2 with one singular vertex, which is made once.
fn sample() -> &'static SurfaceFit {
    static SAMPLE: OnceLock<SurfaceFit> = OnceLock::new();
    SAMPLE.get_or_init(|| {
        let surface = Surface::from_soup(&shapes::genus(2, 8).unwrap()).unwrap();
        let flat = FlatMetric::new(&surface, &FlatMetricOptions::default(), &Control::new()).unwrap();
        fit_surface(&surface, &flat, &SurfaceFitOptions::default(), &Control::new()).unwrap()
    })
}
