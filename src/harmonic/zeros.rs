//! The indices of harmonic forms and the zeros of holomorphic ones, counted from the values on edges.
//!
//! ```
//! use ricci::harmonic::{Domain, FormsOptions, HarmonicForms, PeriodMatrix, zeros};
//! use ricci::{Control, Surface, mesh::shapes};
//! let two = Surface::from_soup(&shapes::genus(2, 4)?)?;
//! let forms = HarmonicForms::new(&Domain::new(&two, &Control::new())?, &FormsOptions::default(), &Control::new())?;
//! let form = PeriodMatrix::new(&forms)?.basis_form(&forms, 0)?;
//! assert_eq!(zeros(forms.domain.mesh(), &form).iter().map(|z| z.multiplicity).sum::<i64>(), 2);
//! # Ok::<(), ricci::Error>(())
//! ```

use super::one_form::{ComplexForm, OneForm};
use crate::archive::stored;
use crate::geometry::complex::{cross, dot, neg, norm};
use crate::mesh::union_find::UnionFind;
use crate::mesh::{EdgeId, FaceId, HalfedgeId, Mesh, PerFace, PerVertex, VertexId};
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// The indices of a real form. The index of an interior vertex is `1 − s/2` for s changes of sign among the half-edges that leave it, in
/// turn; that of a face is 1 if the signs around it agree, otherwise 0. Boundary vertices have the index 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Indices {
    /// Per vertex, its index.
    pub vertices: PerVertex<i64>,
    /// Per face, its index.
    pub faces: PerFace<i64>,
    /// Per vertex, true if a value there is lost in rounding ([`RESOLUTION`]), so that its index and those of its faces mean nothing.
    pub unresolved: PerVertex<bool>,
    /// Per face, true if a corner is unresolved.
    pub unresolved_faces: PerFace<bool>,
}

/// Largest value of a form, relative to its largest one, that is lost in rounding: along a horn of the surface a form falls off
/// exponentially, but it is known to an absolute accuracy only, about 1e-13 of its largest value.
pub const RESOLUTION: f64 = 1e-11;

impl Indices {
    /// The sum of all indices: 2 − 2g on a closed surface, for every form.
    pub fn total(&self) -> i64 {
        self.vertices.iter().sum::<i64>() + self.faces.iter().sum::<i64>()
    }

    /// The largest resolved index: at most 0 for a harmonic form with positive weights.
    pub fn largest(&self) -> i64 {
        let at_vertices = self.vertices.iter().zip(&self.unresolved);
        let all = at_vertices.chain(self.faces.iter().zip(&self.unresolved_faces));
        all.filter(|(_, lost)| !**lost).map(|(index, _)| *index).max().unwrap_or(0)
    }
}

/// The indices of a real form. A value 0 counts as positive along the half-edge 2e.
pub fn indices(mesh: &Mesh, form: &OneForm) -> Indices {
    let is_positive = |h: HalfedgeId| (form.0[h.edge()] >= 0.0) == (h.0 & 1 == 0);
    let at_vertex = |v: VertexId| {
        if mesh.is_boundary_vertex(v) {
            return 0;
        }
        let changes = mesh.outgoing(v).filter(|&h| is_positive(h) != is_positive(mesh.next(h.twin())));
        1 - changes.count() as i64 / 2
    };
    let at_face = |f: FaceId| {
        let [a, b, c] = mesh.face_halfedges(f).map(is_positive);
        i64::from(a == b && b == c)
    };
    let unresolved = unresolved(mesh, |e| form.0[e].abs());
    let lost = |f: FaceId| mesh.face_vertices(f).into_iter().any(|v| unresolved[v]);
    Indices {
        unresolved_faces: PerFace::from_fn(mesh.n_faces(), lost),
        vertices: PerVertex::from_fn(mesh.n_vertices(), at_vertex),
        faces: PerFace::from_fn(mesh.n_faces(), at_face),
        unresolved,
    }
}

/// Per vertex, true if it is an end of an edge whose value is lost in rounding.
fn unresolved(mesh: &Mesh, size: impl Fn(EdgeId) -> f64) -> PerVertex<bool> {
    let largest = mesh.edges().map(&size).fold(0.0, f64::max);
    let mut found = PerVertex::filled(mesh.n_vertices(), false);
    for e in mesh.edges().filter(|&e| size(e) <= RESOLUTION * largest) {
        mesh.ends(e).into_iter().for_each(|v| found[v] = true);
    }
    found
}

/// A zero of a complex form.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Zero {
    /// The vertex nearest to the zero.
    pub vertex: VertexId,
    /// The number of zeros that coincide there; negative for a pole, which a form has only if the mesh is too coarse for it.
    pub multiplicity: i64,
}
stored!(row Zero { vertex: VertexId, multiplicity: i64 });

/// The zeros of a complex closed form, by vertex. On a closed surface their multiplicities add up to 2g − 2, for every form.
///
/// The integrals of the form draw each face in the plane. A vertex around which the drawn faces turn m + 1 times is a zero of order m; a
/// face that is drawn clockwise holds a simple zero. Neighbouring faces and vertices of order other than 0 are one zero. A region in which
/// values are lost in rounding ([`RESOLUTION`]) is one zero too, whose order follows from the turning around the region.
pub fn zeros(mesh: &Mesh, form: &ComplexForm) -> Vec<Zero> {
    let lost = unresolved(mesh, |e| norm(form.0[e]));
    let n = mesh.n_vertices();
    // The orders of vertices, then those of faces; the order of a region in which values are lost is stored at its first vertex.
    let mut order = vec![0i64; n + mesh.n_faces()];
    let mut joined = UnionFind::new(order.len());
    let mut turned = PerVertex::filled(n, 0.0);
    let mut regions: BTreeMap<u32, f64> = BTreeMap::new();
    for e in mesh.edges() {
        let [i, j] = mesh.ends(e);
        if lost[i] && lost[j] {
            joined.join(i.0, j.0);
        }
    }
    for f in mesh.faces() {
        let (vertices, sides) = (mesh.face_vertices(f), mesh.face_halfedges(f).map(|h| form.along(h)));
        let corner = |k: usize| [sides[k], neg(sides[(k + 2) % 3])];
        if let Some(v) = vertices.into_iter().find(|v| lost[*v]) {
            // A face contributes half a turn minus its angles at corners outside the region.
            let outside = (0..3).filter(|&k| !lost[vertices[k]]).map(|k| {
                let [z, w] = corner(k);
                let angle = cross(z, w).atan2(dot(z, w));
                turned[vertices[k]] += angle;
                angle
            });
            let taken: f64 = outside.sum();
            *regions.entry(joined.root(v.0)).or_insert(0.0) += 0.5 - taken / TAU;
            continue;
        }
        let clockwise = cross(sides[0], sides[1]) < 0.0;
        order[n + f.index()] = i64::from(clockwise);
        for (k, v) in vertices.into_iter().enumerate() {
            let [z, w] = corner(k);
            let angle = cross(z, w).abs().atan2(dot(z, w));
            turned[v] += if clockwise { -angle } else { angle };
        }
    }
    for v in mesh.vertices() {
        if lost[v] {
            *regions.entry(joined.root(v.0)).or_insert(0.0) -= 1.0;
        } else if !mesh.is_boundary_vertex(v) {
            order[v.index()] = (turned[v] / TAU).round() as i64 - 1;
        }
    }
    regions.into_iter().for_each(|(root, sum)| order[root as usize] = sum.round() as i64);
    clusters(mesh, form, &order, joined)
}

/// The zeros after touching vertices and faces of order other than 0 have been joined and their orders added up.
fn clusters(mesh: &Mesh, form: &ComplexForm, order: &[i64], mut joined: UnionFind) -> Vec<Zero> {
    let n = mesh.n_vertices();
    let number = |f: FaceId| (n + f.index()) as u32;
    // The corners of a face of order other than 0 belong to its cluster, whatever their own orders; so do the vertices of such a region.
    let mut belongs: Vec<bool> =
        (0..n).map(|v| order[joined.root(v as u32) as usize] != 0 || order[v] != 0).collect();
    for f in mesh.faces().filter(|&f| order[number(f) as usize] != 0) {
        for v in mesh.face_vertices(f) {
            joined.join(number(f), v.0);
            belongs[v.index()] = true;
        }
    }
    for e in mesh.edges() {
        let [i, j] = mesh.ends(e);
        if order[i.index()] != 0 && order[j.index()] != 0 {
            joined.join(i.0, j.0);
        }
    }
    let mut total = vec![0; order.len()];
    (0..order.len()).for_each(|k| total[joined.root(k as u32) as usize] += order[k]);
    // The vertex of a zero is the one around which the form is smallest.
    let size = |v: VertexId| {
        let all = mesh.outgoing(v).map(|h| norm(form.along(h)));
        let (sum, count) = all.fold((0.0, 0.0), |(sum, count), x| (sum + x, count + 1.0));
        sum / count
    };
    let mut nearest: BTreeMap<u32, (f64, VertexId)> = BTreeMap::new();
    for v in mesh.vertices().filter(|v| belongs[v.index()]) {
        let (size, root) = (size(v), joined.root(v.0));
        let best = nearest.entry(root).or_insert((size, v));
        if size < best.0 {
            *best = (size, v);
        }
    }
    let of =
        |(root, (_, vertex)): (u32, (f64, VertexId))| Zero { vertex, multiplicity: total[root as usize] };
    let mut all: Vec<Zero> = nearest.into_iter().map(of).filter(|zero| zero.multiplicity != 0).collect();
    all.sort_unstable_by_key(|zero| zero.vertex);
    all
}
