//! The JSON file of `ricci forms --forms`.

use super::outcome::FormsOutcome;
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
