//! Angles and derivative weights of faces, from the measured vertices and edges of a state.

use crate::geometry::conformal::{
    Edge, Vertex, differences, differences_of, differences_of_lengths, in_one_unit, plain_chord,
};
use crate::geometry::lanes::{Formula, Lanes, work_out};
use crate::geometry::scaled::scaled;
use crate::geometry::triangle::{
    self, Angles, TriangleSines, plane_angles_with_weights, sound_plane_angles_with_weights,
};
use crate::geometry::weights::weights_from_sines;
use crate::geometry::{DoubleDouble, Space, chords};
use crate::mesh::{EdgeId, FaceId, Mesh};
use crate::metric::Metric;
use crate::parallel::{fill_both, in_parts_of_both};

/// True if half chords are all that faces need: for vertex scaling in E² and H².
pub(super) fn needs_chords_alone(class: &Metric) -> bool {
    class.space != Space::S2 && class.epsilon.iter().all(|&e| e == 0)
}

/// The half chord of an edge, for vertex scaling; 0 if the edge has no length, and if the length needs a unit of its own.
#[inline]
pub(super) fn chord(mesh: &Mesh, class: &Metric, vertices: &[Vertex], e: EdgeId) -> DoubleDouble {
    let ([a, b], eta) = class.ends_and_eta(mesh, vertices, e);
    plain_chord(class.space, a, b, eta)
}

/// The vertices and edges of a metric, from which its faces are measured.
#[derive(Clone, Copy)]
pub(super) struct FaceMeasures<'a> {
    pub mesh: &'a Mesh,
    pub class: &'a Metric,
    pub vertices: &'a [Vertex],
    /// Empty if the half chords are known instead.
    pub edges: &'a [Edge],
    pub chords: &'a [DoubleDouble],
}

impl FaceMeasures<'_> {
    /// Angles and derivative weights of all faces; weights 0 of broken ones.
    pub fn measure(self, angles: &mut [Angles], weights: &mut [[f64; 3]]) {
        if !self.has_chords() {
            fill_both(angles, weights, |f| self.measured(f.into()));
            return;
        }
        let formula = ChordFormula { space: self.class.space };
        in_parts_of_both(angles, weights, |start, angles, weights| {
            let given = |i: usize| {
                let [a, b, c] = self.chords_at((start + i).into());
                [a.high, b.high, c.high, a.low, b.low, c.low]
            };
            work_out(formula, angles.len(), given, |i, [a, b, c, u, v, w, is_sound]| {
                (angles[i], weights[i]) = match is_sound {
                    1.0 => (Angles { at: [a, b, c] }, [u, v, w]),
                    _ => self.measured((start + i).into()),
                };
            });
        });
    }

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
    fn chords_at(self, f: FaceId) -> [DoubleDouble; 3] {
        self.mesh.opposite_edges(f).map(|e| self.chords[e.index()])
    }

    /// Angles and derivative weights by the formulas that hold in all classes.
    #[inline(never)]
    fn by_differences(self, f: FaceId) -> (Angles, [f64; 3]) {
        let (mesh, class) = (self.mesh, self.class);
        let (corners, edges, _) = self.at(f);
        let differences = differences(corners, edges);
        let eta = mesh.opposite_edges(f).map(|e| class.eta[e].high);
        let sines = TriangleSines::new(class.space, differences);
        let q2 = edges.map(|e| e.q2);
        let weights = weights_from_sines(&sines, q2, corners, eta);
        (sines.angles(), weights)
    }

    /// The corners of a face and the edges opposite them, in one unit of length, and its exponent.
    fn at(self, f: FaceId) -> ([Vertex; 3], [Edge; 3], i32) {
        let FaceMeasures { mesh, class, vertices, .. } = self;
        let mut corners = mesh.face_vertices(f).map(|v| vertices[v.index()]);
        let edge = |e| if self.has_chords() { class.edge(mesh, vertices, e) } else { self.edges[e.index()] };
        let mut edges = mesh.opposite_edges(f).map(edge);
        let unit = in_one_unit(&mut corners, &mut edges);
        (corners, edges, unit)
    }

    /// Area of a face; infinite beyond the range of f64, from lengths of 1e154 on.
    pub fn area(self, f: FaceId) -> f64 {
        let by_chords = self.has_chords() && self.class.space == Space::H2;
        let found = if by_chords { chords::area(self.chords_at(f)) } else { None };
        found.unwrap_or_else(|| {
            let (corners, edges, unit) = self.at(f);
            scaled(triangle::area_from(self.class.space, differences(corners, edges)), 2 * unit)
        })
    }
}

/// The formula for triangles of vertex scaling in E² or H²: angles, derivative weights, and 1 if these are sound, else 0. Given are the
/// high parts of the half chords opposite the corners, then their low parts.
#[derive(Clone, Copy)]
struct ChordFormula {
    space: Space,
}

impl Formula<6, 7> for ChordFormula {
    #[inline(always)]
    fn of<L: Lanes>(self, [a, b, c, a_low, b_low, c_low]: [L; 6]) -> [L; 7] {
        let (high, low) = ([a, b, c], [a_low, b_low, c_low]);
        let (angles, weights, is_sound) = match self.space {
            Space::E2 => sound_plane_angles_with_weights(differences_of(high, low)),
            _ => chords::sound_angles_with_weights([high, low]),
        };
        let ([a, b, c], [u, v, w]) = (angles, weights);
        [a, b, c, u, v, w, is_sound]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::VertexId;
    use crate::mesh::shapes;
    use crate::metric::{Class, Surface};

    /// Every face of a part, of parts of any length, has the bits that it has alone; broken ones too.
    #[test]
    fn faces_have_the_same_bits_several_at_a_time_and_alone() -> crate::Result<()> {
        let mut broken = 0;
        for space in [Space::E2, Space::H2] {
            let mut soup = shapes::torus(2.0, 0.9, 60, 30)?;
            shapes::noise(&mut soup, 0.3, 1)?;
            let surface = Surface::from_soup(&soup)?;
            let (mesh, mut class) = (surface.mesh(), surface.initial(Class::yamabe(space))?.metric);
            for v in 0..mesh.n_vertices() {
                class.u[VertexId::from(v)] += 0.4 * (v as f64).sin();
            }
            let vertices: Vec<Vertex> = (0..mesh.n_vertices())
                .map(|v| Vertex::precise(space, 0, class.u[VertexId::from(v)], 0.0))
                .collect();
            let chords: Vec<DoubleDouble> =
                (0..mesh.n_edges()).map(|e| chord(mesh, &class, &vertices, e.into())).collect();
            assert!(chords.iter().all(|chord| chord.high > 0.0));
            let parts =
                FaceMeasures { mesh, class: &class, vertices: &vertices, edges: &[], chords: &chords };
            let alone: Vec<_> = mesh.faces().map(|f| parts.measured(f)).collect();
            broken += alone.iter().filter(|(angles, _)| angles.broken()).count();
            for faces in [1, 3, 64, 65, mesh.n_faces()] {
                let mut angles = vec![Angles { at: [0.0; 3] }; faces];
                let mut weights = vec![[0.0; 3]; faces];
                parts.measure(&mut angles, &mut weights);
                let together: Vec<_> = angles.into_iter().zip(weights).collect();
                assert!(together == alone[..faces], "{space}, {faces}");
            }
        }
        assert!(broken > 0);
        Ok(())
    }
}
