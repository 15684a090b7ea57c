//! Forms of surfaces with boundary, and of their doubles.

use crate::harmonic::samples::{forms_of, in_space};
use ricci::harmonic::{Classes, Domain, FormsOptions, HarmonicForms, with_conjugate};
use ricci::mesh::{Double, PerEdge, VertexId, shapes};
use ricci::{Control, Surface};

fn samples() -> Vec<(&'static str, Surface)> {
    vec![
        ("annulus", in_space(&shapes::annulus(0.4, 1.0, 6, 30).unwrap())),
        (
            "torus with 3 holes",
            in_space(&shapes::punch(&shapes::torus(2.0, 0.8, 40, 20).unwrap(), 3).unwrap()),
        ),
        ("genus 2 with a hole", in_space(&shapes::punch(&shapes::genus(2, 4).unwrap(), 1).unwrap())),
    ]
}

fn of_classes(surface: &Surface, classes: Classes) -> HarmonicForms {
    let domain = Domain::new(surface, &Control::new()).unwrap();
    HarmonicForms::new(&domain, &FormsOptions { classes, base: None }, &Control::new()).unwrap()
}

#[test]
fn both_kinds_of_classes_are_closed_and_coclosed() {
    for (name, surface) in samples() {
        let mesh = surface.mesh();
        let rank = 2 * mesh.genus() + mesh.boundary_loops().len() - 1;
        for classes in [Classes::Absolute, Classes::Relative] {
            let forms = of_classes(&surface, classes);
            assert_eq!(forms.forms.len(), rank, "{name}");
            assert!(
                forms.closedness <= 1e-12 && forms.coclosedness <= 1e-10,
                "{name}: {}",
                forms.coclosedness
            );
            let (mesh, periods) = (forms.domain.mesh(), forms.periods());
            for (k, form) in forms.forms.iter().enumerate() {
                // Over the last boundary loop the integral is minus the sum of the others.
                for l in 0..forms.basis.loops.len() - 1 {
                    let is_own = k == l && (classes == Classes::Absolute || k < 2 * mesh.genus());
                    let expected = if is_own { 1.0 } else { 0.0 };
                    assert!((periods[k][l] - expected).abs() < 1e-10, "{name} {classes:?}: period {k}, {l}");
                }
                let on_boundary = mesh.edges().filter(|&e| mesh.is_boundary_edge(e)).map(|e| form.0[e].abs());
                let largest = on_boundary.fold(0.0, f64::max);
                assert!((largest == 0.0) == (classes == Classes::Relative), "{name}: {largest}");
            }
        }
    }
}

/// Wedge products of absolute with relative classes: intersection numbers of the handles, minus the identity for loops and arcs.
#[test]
fn absolute_and_relative_classes_are_dual() {
    for (name, surface) in samples() {
        let [absolute, relative] = [Classes::Absolute, Classes::Relative].map(|c| of_classes(&surface, c));
        let handles = 2 * surface.mesh().genus();
        for (k, x) in absolute.forms.iter().enumerate() {
            for (l, y) in relative.forms.iter().enumerate() {
                let expected = match (k < handles, l < handles) {
                    (true, true) if k / 2 == l / 2 => l as f64 - k as f64,
                    (false, false) if k == l => -1.0,
                    _ => 0.0,
                };
                let wedge = x.wedge(y, absolute.domain.mesh());
                assert!((wedge - expected).abs() < 1e-9, "{name}: {k}, {l}: {wedge}");
            }
        }
    }
}

/// The forms of the double that its mirror symmetry keeps restrict to those with absolute classes, where both triangulations are mirror
/// images.
#[test]
fn absolute_forms_are_the_symmetric_ones_of_the_double() {
    let (_, surface) = samples().swap_remove(0);
    let double = Double::new(surface.mesh()).unwrap();
    let lengths: PerEdge<f64> = double.spread_edges(surface.lengths()).unwrap().into();
    let closed = Surface::intrinsic(double.mesh.clone(), lengths, surface.geometry()).unwrap();
    let of_double = HarmonicForms::new(
        &Domain::rigid(&closed).unwrap(),
        &FormsOptions { base: Some(VertexId(0)), ..FormsOptions::default() },
        &Control::new(),
    )
    .unwrap();
    let half =
        HarmonicForms::new(&Domain::rigid(&surface).unwrap(), &FormsOptions::default(), &Control::new())
            .unwrap();
    // The annulus has one class; that of the double with the same integral along the core is its mirror image.
    let core = &half.basis.loops[0];
    let coefficients: Vec<f64> = of_double.forms.iter().map(|form| form.over(core)).collect();
    assert!(coefficients.iter().any(|x| x.abs() > 0.5), "{coefficients:?}");
    let [a, b] = [&half.forms[0], &of_double.combination(&class_of(&of_double, core))];
    for e in surface.mesh().edges() {
        assert!((a.0[e] - b.0[e]).abs() < 1e-10, "edge {e}: {} {}", a.0[e], b.0[e]);
    }
}

/// Coefficients of the class of the torus with the integral 1 over `core`, and 0 over a loop and its mirror image together: of those
/// with integral 1 the one of least energy.
fn class_of(forms: &HarmonicForms, core: &[ricci::mesh::HalfedgeId]) -> Vec<f64> {
    let c: Vec<f64> = forms.forms.iter().map(|form| form.over(core)).collect();
    let g = forms.inner_products();
    let det = g[0][0] * g[1][1] - g[0][1] * g[1][0];
    let x = [(g[1][1] * c[0] - g[0][1] * c[1]) / det, (g[0][0] * c[1] - g[1][0] * c[0]) / det];
    let scale = x[0] * c[0] + x[1] * c[1];
    x.map(|x| x / scale).to_vec()
}

/// dφ/2π of the round annulus has the conjugate −d log r/2π, up to O(h²).
#[test]
fn the_conjugate_of_the_angle_is_the_logarithm_of_the_radius() {
    let error = |n: usize| {
        let surface = in_space(&shapes::annulus(0.4, 1.0, n, 5 * n).unwrap());
        let [absolute, relative] = [Classes::Absolute, Classes::Relative].map(|c| of_classes(&surface, c));
        let form = with_conjugate(&absolute, &relative, &[1.0]).unwrap();
        let around = form.over(&absolute.basis.loops[0])[0];
        let log = |v: VertexId| {
            let [x, y, _] = surface.positions().unwrap()[v.index()];
            x.hypot(y).ln() / std::f64::consts::TAU
        };
        let mesh = absolute.domain.mesh();
        // Counterclockwise or clockwise, as the loop runs.
        let off = |sign: f64| {
            let miss = |e| {
                let [a, b] = mesh.ends(e).map(log);
                (form.0[e][1] + sign * around * (b - a)).abs()
            };
            mesh.edges().map(miss).fold(0.0, f64::max)
        };
        off(1.0).min(off(-1.0)) * n as f64
    };
    let errors = [4, 8, 16].map(error);
    assert!(errors.windows(2).all(|pair| 3.0 * pair[1] <= pair[0]), "{errors:?}");
}

#[test]
fn a_disk_has_no_forms_and_a_sphere_neither() {
    for soup in [shapes::disk(4).unwrap(), shapes::icosphere(3).unwrap()] {
        assert!(forms_of(&in_space(&soup)).forms.is_empty());
    }
}
