//! The matrices, against each other and against geometry.

use crate::harmonic::samples::{closed, in_space, intrinsic};
use ricci::geometry::Space;
use ricci::harmonic::Domain;
use ricci::mesh::shapes;
use ricci::{Control, Surface};
use sprs::CsMat;

fn domain(surface: &Surface) -> Domain {
    Domain::new(surface, &Control::new()).unwrap()
}

/// Largest |entry|.
fn largest(matrix: &CsMat<f64>) -> f64 {
    matrix.data().iter().fold(0.0, |most, x| most.max(x.abs()))
}

fn times(matrix: &CsMat<f64>, x: &[f64]) -> Vec<f64> {
    let row = |row: sprs::CsVecView<f64>| row.iter().map(|(j, a)| a * x[j]).sum();
    matrix.outer_iterator().map(row).collect()
}

#[test]
fn derivatives_compose_to_zero_and_make_the_laplacian() {
    for (name, surface) in closed() {
        let domain = domain(&surface);
        let [d0, d1, laplacian] = [domain.d0(), domain.d1(), domain.laplacian()];
        assert_eq!(largest(&(&d1 * &d0)), 0.0, "{name}");
        let made = &(&d0.transpose_view().to_csr() * &domain.star1()) * &d0;
        let size = largest(&domain.star1());
        assert!(largest(&(&made - &laplacian)) <= 1e-12 * size, "{name}");
        assert!(largest(&(&laplacian - &laplacian.transpose_view().to_csr())) == 0.0, "{name}");
        let doubled: Vec<f64> = domain.face_areas().iter().flat_map(|&a| [a, a]).collect();
        let areas = CsMat::new(
            (doubled.len(), doubled.len()),
            (0..=doubled.len()).collect(),
            (0..doubled.len()).collect(),
            doubled,
        );
        let gradient = domain.gradient();
        let made = &(&gradient.transpose_view().to_csr() * &areas) * &gradient;
        assert!(largest(&(&made - &laplacian)) <= 1e-9 * size, "{name}");
        let [mass, area] = [domain.star0().data().iter().sum::<f64>(), domain.face_areas().iter().sum()];
        assert!((mass / area - 1.0).abs() < 1e-12, "{name}");
    }
}

#[test]
fn the_laplacian_of_a_linear_function_is_zero_and_its_gradient_constant() {
    let disk = in_space(&shapes::disk(7).unwrap());
    let domain = domain(&disk);
    let mesh = domain.mesh();
    let u: Vec<f64> = disk.positions().unwrap().iter().map(|p| 2.0 * p[0] - 0.7 * p[1] + 3.0).collect();
    let image = times(&domain.laplacian(), &u);
    let inside = mesh.vertices().filter(|&v| !mesh.is_boundary_vertex(v));
    inside.for_each(|v| assert!(image[v.index()].abs() < 1e-12));
    let gradient = times(&domain.gradient(), &u);
    for f in mesh.faces() {
        let [x, y] = [gradient[2 * f.index()], gradient[2 * f.index() + 1]];
        assert!((x.hypot(y) - 2f64.hypot(0.7)).abs() < 1e-12);
    }
    let area: f64 = domain.face_areas().iter().sum();
    assert!((domain.energy(&u).unwrap() - 0.5 * area * (4.0 + 0.49)).abs() < 1e-11);
}

/// Weights are at least 0 on every surface, also of curved triangles; on the given triangulation they are not.
#[test]
fn intrinsic_delaunay_weights_are_not_negative() {
    for (name, surface) in closed() {
        let least = domain(&surface).weights().iter().copied().fold(f64::INFINITY, f64::min);
        assert!(least > -1e-10, "{name}: {least}");
    }
    let sheared = intrinsic(&shapes::flat_torus([0.5, 0.3], 6, 6).unwrap(), Space::E2);
    let rigid = Domain::rigid(&sheared).unwrap();
    assert!(rigid.weights().iter().any(|&w| w < -0.1));
}
