//! Indices of real forms and zeros of holomorphic ones.

use crate::common::Random;
use crate::harmonic::samples::{closed, forms_of, in_space, intrinsic};
use ricci::geometry::Space;
use ricci::harmonic::{OneForm, PeriodMatrix, indices, zeros};
use ricci::mesh::{PerEdge, shapes};

#[test]
fn indices_of_generic_harmonic_forms_are_not_positive_and_sum_to_the_euler_characteristic() {
    let mut random = Random::new(3);
    for (name, surface) in closed() {
        let forms = forms_of(&surface);
        let mesh = forms.domain.mesh();
        for _ in 0..4 {
            let coefficients: Vec<f64> = forms.forms.iter().map(|_| random.symmetric()).collect();
            let found = indices(mesh, &forms.combination(&coefficients));
            assert_eq!(found.total(), mesh.euler(), "{name}");
            assert!(found.largest() <= 0, "{name}: {}", found.largest());
        }
    }
}

/// The total does not depend on the form being harmonic; that no index is positive does.
#[test]
fn indices_of_any_values_sum_to_the_euler_characteristic() {
    let mut random = Random::new(5);
    for (name, surface) in closed() {
        let mesh = surface.mesh();
        let form = OneForm(PerEdge::from_fn(mesh.n_edges(), |_| random.symmetric()));
        let found = indices(mesh, &form);
        assert_eq!(found.total(), mesh.euler(), "{name}");
        assert!(mesh.n_faces() < 30 || found.largest() == 1, "{name}");
    }
}

#[test]
fn zeros_of_holomorphic_forms_number_twice_the_genus_less_two() {
    let mut random = Random::new(7);
    for (name, surface) in closed() {
        let forms = forms_of(&surface);
        let periods = PeriodMatrix::new(&forms).unwrap();
        let g = periods.genus();
        for _ in 0..3 {
            let c: Vec<[f64; 2]> = (0..g).map(|_| [random.symmetric(), random.symmetric()]).collect();
            let found = zeros(forms.domain.mesh(), &periods.holomorphic(&forms, &c).unwrap());
            let total: i64 = found.iter().map(|zero| zero.multiplicity).sum();
            assert_eq!(total, 2 * g as i64 - 2, "{name}: {found:?}");
        }
    }
}

/// On the Bolza surface the forms x dx/y and dx/y have double zeros at fixed points of the hyperelliptic involution, all others two zeros
/// that it exchanges; no pole appears on a fine mesh.
#[test]
fn holomorphic_forms_of_the_bolza_surface_have_no_poles() {
    let forms = forms_of(&intrinsic(&shapes::bolza(4).unwrap(), Space::H2));
    let periods = PeriodMatrix::new(&forms).unwrap();
    let mut random = Random::new(11);
    for _ in 0..8 {
        let c: Vec<[f64; 2]> = (0..2).map(|_| [random.symmetric(), random.symmetric()]).collect();
        let found = zeros(forms.domain.mesh(), &periods.holomorphic(&forms, &c).unwrap());
        assert!(found.iter().all(|zero| zero.multiplicity > 0) && found.len() <= 2, "{found:?}");
    }
}

/// A vertex where the values turn three times is a zero of order 2.
#[test]
fn the_form_of_z_cubed_has_a_double_zero_at_the_centre() {
    let disk = in_space(&shapes::disk(6).unwrap());
    let mesh = disk.mesh();
    let cube = |v: ricci::mesh::VertexId| {
        let [x, y, _] = disk.positions().unwrap()[v.index()];
        [x * x * x - 3.0 * x * y * y, 3.0 * x * x * y - y * y * y]
    };
    let form = ricci::harmonic::ComplexForm(PerEdge::from_fn(mesh.n_edges(), |e| {
        let [a, b] = mesh.ends(e).map(cube);
        [b[0] - a[0], b[1] - a[1]]
    }));
    let found = zeros(mesh, &form);
    let total: i64 = found.iter().map(|zero| zero.multiplicity).sum();
    assert!(total == 2 && found.len() == 1, "{found:?}");
    let [x, y, _] = disk.positions().unwrap()[found[0].vertex.index()];
    assert!(x.hypot(y) < 0.2);
}
