//! The JSON file of `ricci forms --forms`.

use super::outcome::FormsOutcome;
use ricci::geometry::complex::Complex;
use ricci::moduli::PeriodBounds;
use serde::Serialize;

/// Forms as values on oriented edges i → j, whose ends are in `edges`. `face_edges` has the 1-based numbers of the edges opposite the
/// corners, with the direction as sign.
#[derive(Serialize)]
pub struct FormsFile<'a> {
    faces: Vec<[u32; 3]>,
    /// The Euclidean lengths of the edges opposite the corners.
    lengths: Vec<[f64; 3]>,
    face_edges: Vec<[i32; 3]>,
    edges: Vec<[u32; 2]>,
    basis: Vec<String>,
    harmonic: Vec<&'a [f64]>,
    holomorphic: Vec<ComplexValues>,
}

#[derive(Serialize)]
struct ComplexValues {
    real: Vec<f64>,
    imag: Vec<f64>,
}

/// What proves the width of a period matrix. Edges, faces and directions as in [`FormsFile`], on the finer triangulation; the lengths are the
/// sums of `lengths` and `lengths_lo`. Form k has the integrals `integers[k][e] + potential[k][j] − potential[k][i]` over the edges i → j
/// without its quadratic terms, and the function beside the integers has `curve[k][e]` more at the midpoint of an edge than on average at its
/// ends.
#[derive(Serialize)]
pub struct BoundsFile<'a> {
    faces: Vec<[u32; 3]>,
    lengths: Vec<[f64; 3]>,
    lengths_lo: Vec<[f64; 3]>,
    face_edges: Vec<[i32; 3]>,
    edges: Vec<[u32; 2]>,
    basis: Vec<String>,
    harmonic: Vec<Vec<f64>>,
    integers: Vec<&'a [i32]>,
    potential: Vec<&'a [f64]>,
    curve: Vec<&'a [f64]>,
    period_matrix: &'a [Vec<Complex>],
    gap: f64,
}

impl<'a> BoundsFile<'a> {
    pub fn new(bounds: &'a PeriodBounds, basis: Vec<String>) -> BoundsFile<'a> {
        let (mesh, lengths) = (&bounds.surface.mesh, bounds.surface.double_lengths());
        let part = |k: usize| mesh.faces().map(|f| mesh.opposite_edges(f).map(|e| lengths[e][k])).collect();
        let of_form = |(k, form): (usize, &ricci::moduli::ClosedForm)| {
            let along = |e| {
                let [i, j] = mesh.ends(e);
                f64::from(bounds.surface.cochains[k][e]) + (form.potential[j] - form.potential[i])
            };
            mesh.edges().map(along).collect()
        };
        BoundsFile {
            faces: mesh.triangles(),
            lengths: part(0),
            lengths_lo: part(1),
            face_edges: mesh.faces().map(|f| mesh.face_edges(f)).collect(),
            edges: mesh.edges().map(|e| mesh.ends(e).map(|v| v.0)).collect(),
            basis,
            harmonic: bounds.forms.iter().enumerate().map(of_form).collect(),
            integers: bounds.surface.cochains.iter().map(|c| &**c).collect(),
            potential: bounds.forms.iter().map(|form| &*form.potential).collect(),
            curve: bounds.forms.iter().map(|form| &*form.curve).collect(),
            period_matrix: &bounds.matrix,
            gap: bounds.gap,
        }
    }
}

impl FormsFile<'_> {
    pub fn new(outcome: &FormsOutcome) -> FormsFile<'_> {
        let domain = &outcome.forms.domain;
        let mesh = domain.mesh();
        let part = |form: &ricci::harmonic::ComplexForm, k: usize| form.0.iter().map(|z| z[k]).collect();
        FormsFile {
            faces: mesh.triangles(),
            lengths: mesh.faces().map(|f| mesh.opposite_edges(f).map(|e| domain.lengths()[e])).collect(),
            face_edges: mesh.faces().map(|f| mesh.face_edges(f)).collect(),
            edges: mesh.edges().map(|e| mesh.ends(e).map(|v| v.0)).collect(),
            basis: outcome.forms.basis.group.names(),
            harmonic: outcome.forms.forms.iter().map(|form| &*form.0).collect(),
            holomorphic: outcome
                .holomorphic
                .iter()
                .map(|form| ComplexValues { real: part(form, 0), imag: part(form, 1) })
                .collect(),
        }
    }
}
