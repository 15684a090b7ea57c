//! Period matrices of surfaces for which they are known.

use crate::harmonic::samples::{forms_of, in_space, intrinsic};
use num_complex::Complex64;
use ricci::geometry::Space;
use ricci::geometry::hyperelliptic::period_matrix;
use ricci::geometry::modulus::modulus;
use ricci::harmonic::{Domain, HarmonicForms, PeriodMatrix};
use ricci::mesh::shapes;
use ricci::{Control, Surface};

fn periods(surface: &Surface) -> PeriodMatrix {
    PeriodMatrix::new(&forms_of(surface)).unwrap()
}

fn distance([a, b]: [f64; 2], [c, d]: [f64; 2]) -> f64 {
    (a - c).hypot(b - d)
}

#[test]
fn moduli_of_flat_tori_are_exact() {
    for tau in [[0.0, 1.0], [0.3, 1.2], [-0.45, 0.95], [0.5, 0.75f64.sqrt()], [0.1, 7.0]] {
        for (n, m) in [(1, 1), (2, 3), (9, 6)] {
            let found = periods(&intrinsic(&shapes::flat_torus(tau, n, m).unwrap(), Space::E2));
            let expected = modulus([[1.0, 0.0], tau]).unwrap();
            assert!(distance(found.modulus().unwrap(), expected) < 1e-12, "{tau:?} {n} {m}: {found:?}");
            assert!(found.star_residual < 1e-12);
        }
    }
}

/// Every error falls by a factor of at least 3 when the edges are halved.
fn falls(errors: &[f64], what: &str) {
    assert!(errors.windows(2).all(|pair| pair[1] * 3.0 <= pair[0]), "{what}: {errors:?}");
}

#[test]
fn the_torus_of_revolution_has_the_modulus_of_its_profile() {
    // The profile's circle of radius r at distance R is a rectangle of sides 2π and 2π r/√(R² − r²).
    let (big, small) = (2.0, 0.8f64);
    let side = (big * big - small * small).sqrt() / small;
    let refined = [16, 32, 64].map(|n| periods(&in_space(&shapes::torus(big, small, 2 * n, n).unwrap())));
    falls(&refined.each_ref().map(|p| distance(p.modulus().unwrap(), [0.0, side])), "modulus");
    falls(&refined.each_ref().map(|p| p.star_residual), "J² + 1");
}

/// Values that the energy of integer classes takes, the 16 least, ascending: they are the same for every canonical basis. The
/// energy of the class (m; n) is `|m + Πn|²` in the metric (Im Π)⁻¹, here for genus 2.
fn energies(matrix: &[Vec<[f64; 2]>]) -> Vec<f64> {
    let [x, y] = [0, 1].map(|k| [0, 1].map(|i| [0, 1].map(|j| matrix[i][j][k])));
    let det = y[0][0] * y[1][1] - y[0][1] * y[1][0];
    let inverse = [[y[1][1] / det, -y[0][1] / det], [-y[1][0] / det, y[0][0] / det]];
    let square = |a: [[f64; 2]; 2], v: [f64; 2]| -> f64 {
        (0..2).map(|i| (0..2).map(|j| v[i] * a[i][j] * v[j]).sum::<f64>()).sum()
    };
    let range = -3..=3i32;
    let mut all = Vec::new();
    for m in range.clone().flat_map(|a| range.clone().map(move |b| [a, b])) {
        for n in range.clone().flat_map(|a| range.clone().map(move |b| [a, b])) {
            let [m, n] = [m, n].map(|v| v.map(f64::from));
            let re = [0, 1].map(|i| m[i] + x[i][0] * n[0] + x[i][1] * n[1]);
            all.push(square(inverse, re) + square(y, n));
        }
    }
    all.sort_by(f64::total_cmp);
    all.truncate(16);
    all
}

fn spectral_distance(found: &PeriodMatrix, branch_points: &[Complex64]) -> f64 {
    let exact: Vec<Vec<[f64; 2]>> = period_matrix(branch_points)
        .unwrap()
        .iter()
        .map(|r| r.iter().map(|z| [z.re, z.im]).collect())
        .collect();
    let [found, exact] = [energies(&found.symmetrised()), energies(&exact)];
    found.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn the_bolza_surface_has_the_period_matrix_of_its_curve() {
    // y² = x (x⁴ − 1), up to Sp(4, ℤ): the energies of integer classes agree.
    let i = Complex64::i();
    let points = [Complex64::from(0.0), Complex64::from(1.0), i, Complex64::from(-1.0), -i];
    let refined = [2, 3, 4].map(|level| periods(&intrinsic(&shapes::bolza(level).unwrap(), Space::H2)));
    falls(&refined.each_ref().map(|p| spectral_distance(p, &points)), "energies");
    falls(&refined.each_ref().map(|p| p.star_residual), "J² + 1");
    assert!(spectral_distance(&refined[2], &points) < 0.02);
    // By the automorphisms the asymmetry after flips is small, but does not fall steadily; on the subdivided mesh itself it falls.
    let rigid = [2, 3, 4].map(|level| {
        let domain = Domain::rigid(&intrinsic(&shapes::bolza(level).unwrap(), Space::H2)).unwrap();
        let forms = HarmonicForms::new(&domain, &Default::default(), &Control::new()).unwrap();
        PeriodMatrix::new(&forms).unwrap().asymmetry
    });
    falls(&rigid, "Π − Πᵀ");
    assert!(refined.iter().zip(rigid).all(|(flipped, rigid)| 10.0 * flipped.asymmetry < rigid));
}

#[test]
fn hyperelliptic_surfaces_converge_to_the_period_matrix_of_their_curve() {
    let points = [[-1.6, 0.1], [-0.7, -0.3], [-0.1, 0.6], [0.5, -0.5], [1.1, 0.4], [1.5, -0.2]]
        .map(|[re, im]| Complex64::new(re, im));
    let mut shape = shapes::hyperelliptic(&points, 8).unwrap();
    let errors = [0, 1, 2].map(|_| {
        let found = periods(&intrinsic(&shape, Space::S2));
        shape = shape.subdivide().unwrap();
        spectral_distance(&found, &points)
    });
    // Cones of angle 4π at the branch points leave rate 1.
    assert!(errors.windows(2).all(|pair| pair[1] < 0.7 * pair[0]) && errors[2] < 0.2, "{errors:?}");
}

/// Triangles that are graded towards the branch points resolve the forms there, so the rate is 2. The points have no symmetry.
#[test]
fn grading_towards_the_branch_points_gives_the_second_rate() {
    let points = [[-1.6, 0.1], [-0.7, -0.3], [-0.1, 0.6], [0.5, -0.5], [1.1, 0.4], [1.5, -0.2]]
        .map(|[re, im]| Complex64::new(re, im));
    let found = [8, 16, 32]
        .map(|n| periods(&intrinsic(&shapes::hyperelliptic_graded(&points, n, 3.0).unwrap(), Space::S2)));
    falls(&found.each_ref().map(|p| spectral_distance(p, &points)), "energies");
    let asymmetries = found.each_ref().map(|p| p.asymmetry);
    assert!(asymmetries.windows(2).all(|pair| 2.5 * pair[1] <= pair[0]), "{asymmetries:?}");
}

#[test]
fn moduli_of_the_flow_and_of_the_form_approach_each_other() {
    let errors = [12, 24, 48].map(|n| {
        let mut soup = shapes::torus(2.0, 0.8, 2 * n, n).unwrap();
        // A torus without symmetry.
        soup.positions.iter_mut().for_each(|[x, y, z]| *z += 0.3 * *x + 0.2 * (*x * *y).sin());
        let surface = in_space(&soup);
        let by_form = periods(&surface).modulus().unwrap();
        let flat =
            ricci::canonical::uniformize_quotient(&surface, &Default::default(), &Control::new()).unwrap();
        distance(by_form, flat.deck.modulus().unwrap())
    });
    assert!(errors.windows(2).all(|pair| 2.0 * pair[1] <= pair[0]), "{errors:?}");
}
