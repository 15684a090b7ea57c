//! The gradient and the Hessian of every energy against differences of it, and the clamped Hessian against the eigenvalues of the other.

use super::energy::EnergyShares;
use super::rest_triangle::{RestTriangle, TriangleModel};
use nalgebra::{SMatrix, SymmetricEigen};

const NONE: EnergyShares = EnergyShares { isometric: 0.0, conformal: 0.0, area: 0.0, arap: 0.0 };

/// Every energy alone, and a blend.
fn energies() -> [EnergyShares; 5] {
    [
        EnergyShares { isometric: 1.0, ..NONE },
        EnergyShares { conformal: 1.0, ..NONE },
        EnergyShares { area: 1.0, ..NONE },
        EnergyShares { arap: 1.0, ..NONE },
        EnergyShares { isometric: 0.5, conformal: 0.2, area: 0.2, arap: 0.1 },
    ]
}

/// A triangle of the surface and several images of it: stretched, squeezed, sheared, turned, isometric.
fn triangle() -> RestTriangle {
    RestTriangle { weight: 0.7, ..RestTriangle::new([1.3, 0.9, 1.7]).unwrap() }
}

fn images() -> Vec<[[f64; 2]; 3]> {
    vec![
        [[0.1, 0.2], [1.4, 0.0], [0.3, 1.1]],
        [[0.0, 0.0], [0.2, 0.1], [0.05, 0.4]],
        [[0.0, 0.0], [-3.0, 0.5], [-0.2, -2.0]],
        [[5.0, -1.0], [5.0, 1.0], [4.9, 0.2]],
        // The triangle itself, turned: side k is opposite corner k.
        isometric_image(),
    ]
}

fn isometric_image() -> [[f64; 2]; 3] {
    let [a, b, c] = [1.3_f64, 0.9, 1.7];
    let cos = (b * b + c * c - a * a) / (2.0 * b * c);
    let at = [[0.0, 0.0], [c, 0.0], [b * cos, b * (1.0 - cos * cos).sqrt()]];
    let (sin, cos) = 0.4_f64.sin_cos();
    at.map(|[x, y]| [cos * x - sin * y, sin * x + cos * y])
}

fn moved(image: [[f64; 2]; 3], k: usize, by: f64) -> [[f64; 2]; 3] {
    let mut image = image;
    image.as_flattened_mut()[k] += by;
    image
}

fn matrix(model: &TriangleModel) -> SMatrix<f64, 6, 6> {
    SMatrix::from_fn(|i, j| model.hessian[i.max(j) * (i.max(j) + 1) / 2 + i.min(j)])
}

#[test]
fn gradients_and_hessians_are_those_of_differences() {
    let rest = triangle();
    let step = 1e-5;
    for shares in energies() {
        for image in images() {
            let model = rest.model(&shares, image, false);
            let hessian = matrix(&model);
            let scale = hessian.norm().max(1.0);
            for k in 0..6 {
                let [after, before] = [step, -step].map(|by| moved(image, k, by));
                let slope = (rest.energy(&shares, after) - rest.energy(&shares, before)) / (2.0 * step);
                assert!((slope - model.gradient[k]).abs() < 1e-7 * scale, "{shares:?} {image:?} {k}");
                let [after, before] = [after, before].map(|at| rest.model(&shares, at, false).gradient);
                for i in 0..6 {
                    let second = (after[i] - before[i]) / (2.0 * step);
                    let apart = (second - hessian[(i, k)]).abs();
                    assert!(apart < 1e-6 * scale, "{shares:?} {image:?} {i} {k}: {apart:e} of {scale:e}");
                }
            }
        }
    }
}

#[test]
fn the_clamped_hessian_has_the_eigenvalues_that_are_not_negative() {
    let rest = triangle();
    let mut negative = 0;
    for shares in energies() {
        for image in images() {
            let [all, kept] = [false, true].map(|clamped| matrix(&rest.model(&shares, image, clamped)));
            let scale = all.norm();
            let least = |of: SMatrix<f64, 6, 6>| SymmetricEigen::new(of).eigenvalues.min();
            assert!(least(kept) > -1e-12 * scale);
            assert!(least(kept - all) > -1e-12 * scale, "clamping takes nothing away");
            negative += usize::from(least(all) < -1e-9 * scale);
            if least(all) >= 0.0 {
                assert!((kept - all).norm() < 1e-12 * scale);
            }
        }
    }
    assert!(negative >= 5, "only {negative} Hessians have a negative eigenvalue");
}

#[test]
fn energies_are_least_at_isometries_and_grow_without_bound_toward_no_area() {
    let rest = triangle();
    for (shares, least) in energies().into_iter().zip([4.0, 4.0, 4.0, 0.0, 3.6]) {
        let at = rest.energy(&shares, isometric_image()) / rest.weight;
        assert!((at - least).abs() < 1e-14, "{at}");
        let slope = rest.model(&shares, isometric_image(), false).gradient;
        assert!(slope.iter().all(|g| g.abs() < 1e-14), "{slope:?}");
        assert!(shares.value(2.0, 0.0).is_infinite() && shares.value(2.0, -1.0).is_infinite());
        let is_barrier = shares.arap < 1.0;
        assert_eq!(shares.value(2.0, 1e-9) > 1e6, is_barrier);
    }
}

#[test]
fn needles_keep_their_digits() {
    // A needle mapped to itself: what is off is rounding.
    for short in [1e-6, 1e-10] {
        let sides = [short, 1.0, 1.0];
        let rest = RestTriangle::new(sides).unwrap();
        let height = (1.0 - 0.25 * short * short).sqrt();
        let image = [[0.0, height], [-0.5 * short, 0.0], [0.5 * short, 0.0]];
        let [s, t] = rest.map(image).singular;
        assert!((s - 1.0).abs() < 1e-14 && (t - 1.0).abs() < 1e-14, "{s} {t}");
    }
    assert!(RestTriangle::new([2.0, 1.0, 1.0]).is_none() && RestTriangle::new([3.0, 1.0, 1.0]).is_none());
}
