//! Indices of harmonic forms and zeros of holomorphic ones, counted by their edges' values.
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
use crate::geometry::complex::{Complex, cross, dot, neg, norm};
use crate::mesh::union_find::UnionFind;
use crate::mesh::{FaceId, HalfedgeId, Mesh, PerFace, PerVertex, VertexId};
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// Indices of a real form: at vertices inside `1 − s/2`, s being the number of changes of sign among the half-edges that leave it, in
/// turn; at faces 1 if the signs around it agree, else 0. Boundary vertices have 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Indices {
    /// Per vertex.
    pub vertices: PerVertex<i64>,
    /// Per face.
    pub faces: PerFace<i64>,
}

impl Indices {
    /// The sum of all: 2 − 2g on a closed surface, whatever the form.
    pub fn total(&self) -> i64 {
        self.vertices.iter().sum::<i64>() + self.faces.iter().sum::<i64>()
    }

    /// The largest: at most 0 for a harmonic form without values 0, where the weights are positive.
    pub fn largest(&self) -> i64 {
        self.vertices.iter().chain(&self.faces).copied().max().unwrap_or(0)
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
    Indices {
        vertices: PerVertex::from_fn(mesh.n_vertices(), at_vertex),
        faces: PerFace::from_fn(mesh.n_faces(), at_face),
    }
}

/// A zero of a complex form.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Zero {
    /// The vertex that it is nearest to.
    pub vertex: VertexId,
    /// How many zeros coincide there; negative for a pole, which a form has only where a mesh is too coarse for it.
    pub multiplicity: i64,
}

/// The zeros of a complex closed form, by vertex: their multiplicities add up to 2g − 2 on a closed surface, whatever the form.
///
/// Integrals of the form draw each face in the plane. Where the drawn faces around a vertex turn m + 1 times there is a zero of order m;
/// a face that is drawn clockwise holds a simple one. Neighbouring faces and vertices with such numbers are one zero.
pub fn zeros(mesh: &Mesh, form: &ComplexForm) -> Vec<Zero> {
    let mut turned = PerVertex::filled(mesh.n_vertices(), 0.0);
    let mut order = vec![0i64; mesh.n_vertices() + mesh.n_faces()];
    for f in mesh.faces() {
        let sides = mesh.face_halfedges(f).map(|h| form.along(h));
        let clockwise = cross(sides[0], sides[1]) < 0.0;
        let sign = if clockwise { -1.0 } else { 1.0 };
        order[mesh.n_vertices() + f.index()] = i64::from(clockwise);
        for (k, v) in mesh.face_vertices(f).into_iter().enumerate() {
            turned[v] += sign * corner_angle(sides[k], neg(sides[(k + 2) % 3]));
        }
    }
    for v in mesh.vertices().filter(|&v| !mesh.is_boundary_vertex(v)) {
        order[v.index()] = (turned[v] / (2.0 * PI)).round() as i64 - 1;
    }
    clusters(mesh, form, &order)
}

/// Joins vertices and faces of order other than 0 that touch, and adds their orders up.
fn clusters(mesh: &Mesh, form: &ComplexForm, order: &[i64]) -> Vec<Zero> {
    let n = mesh.n_vertices();
    let number = |f: FaceId| (n + f.index()) as u32;
    let mut joined = UnionFind::new(order.len());
    // Faces of order 0 join nothing; a corner of another face belongs to its cluster, whatever its own order.
    let mut belongs: Vec<bool> = order.iter().map(|&m| m != 0).collect();
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
    // The zero is put at the vertex around which the form is least.
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

/// The angle between two vectors, 0 to π.
fn corner_angle(z: Complex, w: Complex) -> f64 {
    cross(z, w).abs().atan2(dot(z, w))
}
