//! Fits to whole surfaces of genus 3, and folds.

use super::sample;
use crate::common;
use ricci::spline::{
    FlatMetric, FlatMetricOptions, SingularVertices, Spline, SurfaceFitOptions, fit_surface,
};
use ricci::{Control, Surface};

/// Spline and filling of its hole are fitted together: surfaces of genus 3 with a total angle of five turns at one vertex.
#[test]
fn a_quarter_of_the_vertices_is_enough_for_genus_three() {
    let Some(folder) = common::corpus("good") else { return };
    for (name, degree) in [("genus3", 4), ("3holes", 4)] {
        let surface = Surface::read(folder.join(format!("{name}.obj"))).unwrap();
        let of_one =
            FlatMetricOptions { singular: SingularVertices::Count(1), ..FlatMetricOptions::default() };
        let flat = FlatMetric::new(&surface, &of_one, &Control::new()).unwrap();
        let options = SurfaceFitOptions { degree, rounds: 2, ..SurfaceFitOptions::default() };
        let fitted = fit_surface(&surface, &flat, &options, &Control::new()).unwrap();
        assert!(fitted.rms <= 1e-3 && fitted.max <= 1e-2, "{name}: {} {}", fitted.rms, fitted.max);
        let fills = fitted.spline.holes().iter().filter_map(|hole| hole.fill.as_ref());
        let coefficients: usize = fills.map(|fill| fill.coefficients().len()).sum();
        let all = fitted.spline.space().n_control_points() + coefficients;
        assert!(4 * all <= surface.mesh().n_vertices(), "{name}: {all}");
        assert_eq!(fitted.spline.holes().len(), 1);
    }
}

/// A control point that is moved across the surface makes the patches around it fold, and no others.
#[test]
fn folds_are_found_where_they_are() {
    let fitted = sample();
    let (domain, spline) = (&fitted.domain, &fitted.spline);
    assert_eq!(domain.folds(spline, 0, &Control::new()).unwrap(), fitted.folds);
    assert_eq!(spline.folds(0, &Control::new()).unwrap(), fitted.folds);
    let patches = spline.space().patches();
    let is_whole = |p: &usize| !fitted.folds.contains(p);
    let patch = (0..patches.len()).rev().find(is_whole).unwrap();
    // With degree 3, the middle control point is the one whose function belongs to the patch alone.
    let control = patches[patch].control[4] as usize;
    let mut points = spline.control_points().to_vec();
    points[control] = points[control].map(|x| x + 10.0);
    let bent = Spline::new(spline.space().clone(), points).unwrap().with_holes(spline.holes().to_vec());
    let folds = domain.folds(&bent, 0, &Control::new()).unwrap();
    assert!(folds.contains(&patch), "{patch}: {folds:?}");
    assert_eq!(bent.folds(0, &Control::new()).unwrap(), folds);
    assert!(folds.len() < patches.len() / 2, "{folds:?}");
}
