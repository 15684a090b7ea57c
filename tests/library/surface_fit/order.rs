//! The order of fits to exact surfaces under refinement.

use super::analytic::{LevelFunction, SplineErrors, bumps, bumps_level, errors, torus, torus_level};
use ricci::mesh::io::Soup;
use ricci::spline::{FlatMetric, FlatMetricOptions, SurfaceFitOptions, fit_surface};
use ricci::{Control, Surface};

fn fitted(soup: &Soup, level: LevelFunction, degree: usize) -> SplineErrors {
    let surface = Surface::from_soup(soup).unwrap();
    let flat = FlatMetric::new(&surface, &FlatMetricOptions::default(), &Control::new()).unwrap();
    // A tolerance that no fit meets: corrections go on while they gain.
    let options = SurfaceFitOptions { degree, tolerance: 1e-12, rounds: 1, ..SurfaceFitOptions::default() };
    let fit = fit_surface(&surface, &flat, &options, &Control::new()).unwrap();
    assert!(fit.folds.is_empty(), "{:?}", fit.folds);
    let found = errors(&fit.spline, level);
    eprintln!("degree {degree}, {} control points: {found:?}", fit.spline.space().n_control_points());
    found
}

/// Errors fall at least by the factors 2^order where there are four times as many control points.
fn check(coarse: SplineErrors, fine: SplineErrors, [distance, normal, curvature]: [f64; 3]) {
    let order = |a: f64, b: f64| (a / b).log2();
    let found = [
        order(coarse.rms, fine.rms),
        order(coarse.normal_rms, fine.normal_rms),
        order(coarse.curvature_rms, fine.curvature_rms),
    ];
    eprintln!("orders {found:?}");
    assert!(found[0] > distance && found[1] > normal && found[2] > curvature, "{found:?}");
    assert!(fine.max < coarse.max && fine.normal < coarse.normal, "{coarse:?} {fine:?}");
}

/// A torus with vertices at random: distance, normal and mean curvature of cubics.
#[test]
fn cubic_fits_to_a_torus_have_full_order() {
    let [coarse, fine] = [30, 60].map(|n| fitted(&torus(2 * n, n, 0.6), torus_level, 3));
    check(coarse, fine, [3.0, 2.2, 1.4]);
    assert!(fine.rms < 5e-6 && fine.normal < 0.01 && fine.curvature < 0.3, "{fine:?}");
}

/// A surface with boundary and four corners.
#[test]
fn cubic_fits_to_bumps_have_full_order() {
    let [coarse, fine] = [20, 40].map(|n| fitted(&bumps(n, 0.6), bumps_level, 3));
    check(coarse, fine, [3.0, 2.2, 1.2]);
}
