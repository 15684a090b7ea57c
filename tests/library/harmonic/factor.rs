//! The rate at which the residual of the conformal factor's weak equation falls.

use crate::harmonic::samples::{in_space, intrinsic};
use ricci::geometry::Space;
use ricci::harmonic::Domain;
use ricci::harmonic::factor::{curvature_integrals, factor_residual, solution_residual};
use ricci::mesh::shapes;
use ricci::{Class, Control, Solution, Surface, Target, flow};

fn flown(surface: Surface, space: Space, target: &Target) -> Solution {
    flow::flow(surface, Class::yamabe(space), target, &flow::Options::default(), &Control::new()).unwrap()
}

/// Each error is at most a third of the one before: the edges are halved, and the rate is 2.
fn falls(errors: &[f64], what: &str) {
    assert!(errors.windows(2).all(|pair| 3.0 * pair[1] <= pair[0]), "{what}: {errors:?}");
}

#[test]
fn known_factors_satisfy_the_equation_to_the_square_of_the_edges() {
    let control = Control::new();
    // A torus of revolution is flat over its squared distance from the axis.
    let torus = [16, 32, 64].map(|n| {
        let soup = shapes::torus(2.0, 0.8, 2 * n, n).unwrap();
        let factor: Vec<f64> = soup.positions.iter().map(|[x, y, _]| -x.hypot(*y).ln()).collect();
        let domain = Domain::new(&in_space(&soup), &control).unwrap();
        factor_residual(&domain, &factor, &vec![0.0; factor.len()], &control).unwrap()
    });
    falls(&torus, "torus of revolution");
    // Enneper's surface over the disk of radius 0.7: the plane metric times (1 + r²)², its boundary a circle of the plane.
    let enneper = [8, 16, 32].map(|n| {
        let mut soup = shapes::disk(n).unwrap();
        soup.positions.iter_mut().for_each(|p| *p = p.map(|x| 0.7 * x));
        let plane = Domain::new(&in_space(&soup), &control).unwrap();
        let flat = curvature_integrals(plane.metric()).unwrap();
        let factor: Vec<f64> = soup.positions.iter().map(|[x, y, _]| -(1.0 + x * x + y * y).ln()).collect();
        for [x, y, z] in &mut soup.positions {
            let (u, v) = (*x, *y);
            [*x, *y, *z] = [u - u.powi(3) / 3.0 + u * v * v, v - v.powi(3) / 3.0 + v * u * u, u * u - v * v];
        }
        let domain = Domain::new(&in_space(&soup), &control).unwrap();
        factor_residual(&domain, &factor, &flat, &control).unwrap()
    });
    falls(&enneper, "Enneper's surface");
    // A function that is no conformal factor has a large residual.
    let soup = shapes::torus(2.0, 0.8, 32, 16).unwrap();
    let domain = Domain::new(&in_space(&soup), &control).unwrap();
    let wrong: Vec<f64> = soup.positions.iter().map(|[x, y, _]| -0.5 * x.hypot(*y).ln()).collect();
    let off = factor_residual(&domain, &wrong, &vec![0.0; wrong.len()], &control).unwrap();
    assert!((off - 0.5).abs() < 0.02, "{off}");
    assert!(factor_residual(&domain, &wrong[1..], &vec![0.0; wrong.len()], &control).is_err());
}

#[test]
fn factors_of_flows_satisfy_the_equation_to_the_square_of_the_edges() {
    let residual = |solution: &Solution| solution_residual(solution, &Control::new()).unwrap();
    let torus = [12, 24, 48].map(|n| {
        let mut soup = shapes::torus(2.0, 0.8, 2 * n, n).unwrap();
        soup.positions.iter_mut().for_each(|[x, y, z]| *z += 0.3 * *x + 0.2 * (*x * *y).sin());
        residual(&flown(in_space(&soup), Space::E2, &Target::Uniform))
    });
    falls(&torus, "to the plane");
    let two = [4, 8, 16]
        .map(|n| residual(&flown(in_space(&shapes::genus(2, n).unwrap()), Space::H2, &Target::Uniform)));
    falls(&two, "to the hyperbolic plane");
    let disk = [6, 12, 24].map(|n| {
        let mut soup = shapes::disk(n).unwrap();
        soup.positions.iter_mut().for_each(|[x, y, z]| *z = 0.3 * (2.0 * *x).sin() * (2.0 * *y).cos());
        residual(&flown(in_space(&soup), Space::E2, &Target::Boundary))
    });
    assert!(disk.windows(2).all(|pair| 2.0 * pair[1] <= pair[0]), "{disk:?}");
}

#[test]
fn integrals_of_curvature_add_up_to_the_euler_number() {
    for (surface, space) in [
        (intrinsic(&shapes::bolza(2).unwrap(), Space::H2), Space::H2),
        (in_space(&shapes::genus(2, 3).unwrap()), Space::H2),
        (in_space(&shapes::genus(3, 3).unwrap()), Space::E2),
        (intrinsic(&shapes::pants([1.0, 1.5, 2.0], 2).unwrap(), Space::H2), Space::H2),
    ] {
        let euler = surface.mesh().euler() as f64;
        let solution = flown(surface, space, &Target::Uniform);
        let total: f64 = curvature_integrals(&solution).unwrap().iter().sum();
        assert!((total - std::f64::consts::TAU * euler).abs() < 1e-8, "{total} {euler}");
    }
}
