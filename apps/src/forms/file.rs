//! Forms as a JSON file.

use super::found::Found;
use serde::Serialize;

/// A value per oriented edge i → j, the ends in `edges`; `face_edges` are 1-based edge numbers opposite the corners with the direction as
/// sign.
#[derive(Serialize)]
pub struct FormsFile<'a> {
    faces: Vec<[u32; 3]>,
    /// Euclidean lengths opposite the corners.
    lengths: Vec<[f64; 3]>,
    face_edges: Vec<[i32; 3]>,
    edges: Vec<[u32; 2]>,
    basis: Vec<String>,
    harmonic: Vec<&'a [f64]>,
    holomorphic: Vec<Parts>,
}

#[derive(Serialize)]
struct Parts {
    real: Vec<f64>,
    imag: Vec<f64>,
}

impl FormsFile<'_> {
    pub fn new(found: &Found) -> FormsFile<'_> {
        let domain = &found.forms.domain;
        let mesh = domain.mesh();
        let part = |form: &ricci::harmonic::ComplexForm, k: usize| form.0.iter().map(|z| z[k]).collect();
        FormsFile {
            faces: mesh.triangles(),
            lengths: mesh.faces().map(|f| mesh.opposite_edges(f).map(|e| domain.lengths()[e])).collect(),
            face_edges: mesh.faces().map(|f| mesh.face_edges(f)).collect(),
            edges: mesh.edges().map(|e| mesh.ends(e).map(|v| v.0)).collect(),
            basis: found.forms.basis.group.names(),
            harmonic: found.forms.forms.iter().map(|form| &*form.0).collect(),
            holomorphic: found
                .holomorphic
                .iter()
                .map(|form| Parts { real: part(form, 0), imag: part(form, 1) })
                .collect(),
        }
    }
}
