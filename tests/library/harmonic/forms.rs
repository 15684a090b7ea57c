//! The properties of every basis of harmonic forms.

use crate::common;
use crate::harmonic::samples::{closed, forms_of, in_space, intrinsic};
use ricci::geometry::Space;
use ricci::harmonic::{HarmonicForms, PeriodMatrix, with_conjugate};
use ricci::mesh::shapes;
use ricci::topology::intersection_matrix;
use ricci::{Error, Surface};

/// Closedness, coclosedness and periods, recomputed from the values by this test's own formulas; Riemann's second relation.
fn check(name: &str, surface: &Surface) -> HarmonicForms {
    let forms = forms_of(surface);
    let (domain, mesh, genus) = (&forms.domain, forms.domain.mesh(), surface.mesh().genus());
    assert_eq!(forms.forms.len(), 2 * genus, "{name}");
    assert!(domain.weights().iter().all(|&w| w > -1e-9), "{name}");
    for (k, form) in forms.forms.iter().enumerate() {
        let size = form.0.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        for f in mesh.faces() {
            let around: f64 = mesh.face_halfedges(f).iter().map(|&h| form.along(h)).sum();
            assert!(around.abs() <= 1e-12 * size, "{name}: dω = {around:e} at face {f}");
        }
        for v in mesh.vertices() {
            let flux: f64 = mesh.outgoing(v).map(|h| domain.weights()[h.edge()] * form.along(h)).sum();
            assert!(flux.abs() <= 1e-10 * size, "{name}: d*ω = {:e} at vertex {v}", flux / size);
        }
        for (l, path) in forms.basis.loops.iter().enumerate() {
            let expected = if k == l { 1.0 } else { 0.0 };
            assert!((form.over(path) - expected).abs() <= 1e-10, "{name}: period {k}, {l}");
        }
    }
    let periods = PeriodMatrix::new(&forms).unwrap();
    assert!(periods.least_eigenvalue > 0.0, "{name}: {}", periods.least_eigenvalue);
    forms
}

#[test]
fn forms_are_closed_and_coclosed_with_the_identity_as_periods() {
    for (name, surface) in closed() {
        check(&name, &surface);
    }
}

#[test]
fn forms_of_the_corpus_are_closed_and_coclosed() {
    let Some((folder, rows)) = common::index("good") else { return };
    let mut seen = 0;
    for row in rows {
        let vertices: usize = row["V"].parse().unwrap();
        let surface = Surface::read(folder.join(&row["file"])).unwrap();
        if vertices <= 6000 && surface.mesh().is_closed() && surface.mesh().genus() > 0 {
            check(&row["name"], &surface);
            seen += 1;
        }
    }
    assert!(seen >= 5, "{seen}");
}

/// The inner products from few values are those of the definition; the wedge products are the intersection numbers.
#[test]
fn inner_products_and_wedge_products_are_those_of_the_definition() {
    for (name, surface) in closed() {
        let forms = forms_of(&surface);
        let mesh = forms.domain.mesh();
        let products = forms.inner_products();
        let intersections = intersection_matrix(mesh, &forms.basis.loops).unwrap();
        for (k, x) in forms.forms.iter().enumerate() {
            for (l, y) in forms.forms.iter().enumerate() {
                let inner = x.inner(y, &forms.domain);
                assert!((inner - products[k][l]).abs() < 1e-9, "{name}: {inner} {}", products[k][l]);
                let wedge = x.wedge(y, mesh);
                assert!((wedge - intersections[k][l] as f64).abs() < 1e-9, "{name}: {wedge}");
            }
        }
    }
}

/// The star of a form, by the products that define it: ∫ ω_k ∧ *ω = (ω_k, ω).
#[test]
fn the_star_has_the_products_that_define_it() {
    let forms = forms_of(&in_space(&shapes::genus(2, 4).unwrap()));
    let form = with_conjugate(&forms, &forms, &[1.0, -0.3, 0.2, 2.0]).unwrap();
    let [form, star] = [form.re(), form.im()];
    for k in &forms.forms {
        let [wedge, inner] = [k.wedge(&star, forms.domain.mesh()), k.inner(&form, &forms.domain)];
        assert!((wedge - inner).abs() < 1e-10, "{wedge} {inner}");
    }
}

/// Integrals of the holomorphic basis over the a-loops are the identity, over the b-loops Π.
#[test]
fn holomorphic_forms_have_the_period_matrix_as_periods() {
    let forms = forms_of(&in_space(&shapes::genus(3, 3).unwrap()));
    let periods = PeriodMatrix::new(&forms).unwrap();
    for i in 0..3 {
        let form = periods.basis_form(&forms, i).unwrap();
        for j in 0..3 {
            let [over_a, over_b] = [0, 1].map(|k| form.over(&forms.basis.loops[2 * j + k]));
            let expected = if i == j { 1.0 } else { 0.0 };
            assert!((over_a[0] - expected).abs() < 1e-12 && over_a[1].abs() < 1e-12, "{over_a:?}");
            let pi = periods.matrix[i][j];
            assert!(
                (over_b[0] - pi[0]).abs() < 1e-12 && (over_b[1] - pi[1]).abs() < 1e-12,
                "{over_b:?} {pi:?}"
            );
        }
    }
    assert!(periods.basis_form(&forms, 3).is_err());
}

#[test]
fn surfaces_without_a_period_matrix_are_refused_by_name() {
    for soup in
        [shapes::icosphere(3).unwrap(), shapes::punch(&shapes::torus(2.0, 1.0, 20, 10).unwrap(), 1).unwrap()]
    {
        let refused = PeriodMatrix::new(&forms_of(&in_space(&soup)));
        assert!(matches!(refused, Err(Error::Argument { what: "surface", .. })));
    }
    let flat = intrinsic(&shapes::flat_torus([0.0, 1.0], 3, 3).unwrap(), Space::E2);
    let cancelled = ricci::Control::new();
    cancelled.cancel();
    assert!(matches!(ricci::harmonic::Domain::new(&flat, &cancelled), Err(Error::Cancelled)));
}
