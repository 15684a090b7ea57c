//! Angles and derivative weights of faces, from what a state knows of vertices and edges.

use crate::geometry::conformal::{
    Edge, Vertex, differences, differences_of_lengths, in_one_unit, plain_chord,
};
use crate::geometry::scaled::scaled;
use crate::geometry::triangle::{self, Angles, plane_angles_with_weights};
use crate::geometry::weights::weights_from_sines;
use crate::geometry::{Space, Twofold, chords};
use crate::mesh::{EdgeId, FaceId, Mesh};
use crate::metric::Metric;

/// Whether half chords are all that faces need: for vertex scaling in E² and H².
pub(super) fn needs_chords_alone(class: &Metric) -> bool {
    class.space != Space::S2 && class.epsilon.iter().all(|&e| e == 0)
}

/// The half chord of an edge, for vertex scaling; 0 where it has no length, and where that needs a unit of its own.
#[inline]
pub(super) fn chord(mesh: &Mesh, class: &Metric, vertices: &[Vertex], e: EdgeId) -> Twofold {
    let [a, b] = mesh.ends(e).map(|v| vertices[v.index()]);
    plain_chord(class.space, a, b, class.eta[e])
}

/// What faces are measured from.
#[derive(Clone, Copy)]
pub(super) struct Parts<'a> {
    pub mesh: &'a Mesh,
    pub class: &'a Metric,
    pub vertices: &'a [Vertex],
    /// None where the chords are known instead.
    pub edges: &'a [Edge],
    pub chords: &'a [Twofold],
}

impl Parts<'_> {
    /// Angles and derivative weights of a face; weights 0 of a broken one.
    #[inline]
    pub fn measured(self, f: FaceId) -> (Angles, [f64; 3]) {
        let found = match (self.has_chords(), self.class.space) {
            (true, Space::E2) => {
                return plane_angles_with_weights(differences_of_lengths(self.chords_at(f)));
            }
            (true, _) => chords::angles_with_weights(self.chords_at(f)),
            (false, _) => None,
        };
        found.unwrap_or_else(|| self.by_differences(f))
    }

    #[inline]
    fn has_chords(self) -> bool {
        !self.chords.is_empty()
    }

    #[inline]
    fn chords_at(self, f: FaceId) -> [Twofold; 3] {
        self.mesh.opposite_edges(f).map(|e| self.chords[e.index()])
    }

    /// The way that serves all classes.
    #[inline(never)]
    fn by_differences(self, f: FaceId) -> (Angles, [f64; 3]) {
        let (mesh, class) = (self.mesh, self.class);
        let (corners, edges, _) = self.at(f);
        let differences = differences(corners, edges);
        let eta = mesh.opposite_edges(f).map(|e| class.eta[e].high);
        let sines = triangle::sines(class.space, differences);
        let q2 = edges.map(|e| e.q2);
        let weights = weights_from_sines(class.space, (differences, sines), q2, corners, eta);
        (triangle::angles_from_sines(class.space, differences, sines), weights)
    }

    /// The corners of a face and the edges opposite them, in one unit of length, and its exponent.
    fn at(self, f: FaceId) -> ([Vertex; 3], [Edge; 3], i32) {
        let Parts { mesh, class, vertices, .. } = self;
        let mut corners = mesh.face_vertices(f).map(|v| vertices[v.index()]);
        let mut edges = mesh.opposite_edges(f).map(|e| match self.has_chords() {
            true => class.edge(mesh, vertices, e),
            false => self.edges[e.index()],
        });
        let unit = in_one_unit(&mut corners, &mut edges);
        (corners, edges, unit)
    }

    /// Area of a face; infinite where doubles end, which takes lengths of 1e154.
    pub fn area(self, f: FaceId) -> f64 {
        let by_chords = self.has_chords() && self.class.space == Space::H2;
        let found = if by_chords { chords::area(self.chords_at(f)) } else { None };
        found.unwrap_or_else(|| {
            let (corners, edges, unit) = self.at(f);
            scaled(triangle::area_from(self.class.space, differences(corners, edges)), 2 * unit)
        })
    }
}
