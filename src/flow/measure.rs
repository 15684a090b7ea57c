//! Angles and derivative weights of faces, from what a state knows of vertices and edges.

use crate::geometry::conformal::{
    Edge, Vertex, differences, differences_of, differences_of_lengths, in_one_unit, plain_chord,
};
use crate::geometry::lanes::{Lanes, Wide};
use crate::geometry::scaled::scaled;
use crate::geometry::triangle::{self, Angles, plane_angles_with_weights, sound_plane_angles_with_weights};
use crate::geometry::weights::weights_from_sines;
use crate::geometry::{Space, Twofold, chords};
use crate::mesh::{EdgeId, FaceId, Mesh};
use crate::metric::Metric;
use crate::parallel::{fill_both, in_parts_of_both};
use pulp::{Arch, Simd, WithSimd};

/// Faces that are measured together, a multiple of the doubles in a vector of any processor.
const BLOCK: usize = 64;

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
    /// Angles and derivative weights of all faces; weights 0 of broken ones.
    pub fn measure(self, angles: &mut [Angles], weights: &mut [[f64; 3]]) {
        if !self.has_chords() {
            fill_both(angles, weights, |f| self.measured(f.into()));
            return;
        }
        in_parts_of_both(angles, weights, |start, angles, weights| {
            Arch::new().dispatch(ByChords { parts: self, start, angles, weights });
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

/// [`Parts::measured`] of the faces from `start` on, several at a time, where chords are known.
struct ByChords<'a> {
    parts: Parts<'a>,
    start: usize,
    angles: &'a mut [Angles],
    weights: &'a mut [[f64; 3]],
}

impl WithSimd for ByChords<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let ByChords { parts, start, angles, weights } = self;
        // Opposite each corner: a double of the half chord, and what it misses.
        let mut chords = [[1.0; BLOCK]; 6];
        // Angles, weights, and whether these may be used.
        let mut found = [[0.0; BLOCK]; 7];
        for (b, (angles, weights)) in angles.chunks_mut(BLOCK).zip(weights.chunks_mut(BLOCK)).enumerate() {
            let first = start + b * BLOCK;
            for i in 0..angles.len() {
                for (k, chord) in parts.chords_at((first + i).into()).into_iter().enumerate() {
                    (chords[k][i], chords[3 + k][i]) = (chord.high, chord.low);
                }
            }
            let sides = chords.each_ref().map(|x| S::as_simd_f64s(x).0);
            let out = found.each_mut().map(|x| S::as_mut_simd_f64s(x).0);
            let [out_0, out_1, out_2, out_3, out_4, out_5, out_6] = out;
            for i in 0..out_0.len() {
                let at = |k: usize| Wide::new(simd, sides[k][i]);
                let chords = [[at(0), at(1), at(2)], [at(3), at(4), at(5)]];
                let ([a, b, c], [u, v, w], is_sound) = measured(parts.class.space, chords);
                (out_0[i], out_1[i], out_2[i]) = (a.at, b.at, c.at);
                (out_3[i], out_4[i], out_5[i]) = (u.at, v.at, w.at);
                out_6[i] = is_sound.at;
            }
            for (i, (angles, weights)) in angles.iter_mut().zip(weights.iter_mut()).enumerate() {
                (angles.at, *weights) = ([0, 1, 2].map(|k| found[k][i]), [3, 4, 5].map(|k| found[k][i]));
                if found[6][i] != 1.0 {
                    (*angles, *weights) = parts.measured((first + i).into());
                }
            }
        }
    }
}

/// Angles and derivative weights of triangles of vertex scaling in E² or H², with 1 for each whose are sound.
#[inline(always)]
fn measured<L: Lanes>(space: Space, chords: [[L; 3]; 2]) -> ([L; 3], [L; 3], L) {
    let [high, low] = chords;
    match space {
        Space::E2 => sound_plane_angles_with_weights(differences_of(high, low)),
        _ => chords::sound_angles_with_weights(chords),
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
            let chords: Vec<Twofold> =
                (0..mesh.n_edges()).map(|e| chord(mesh, &class, &vertices, e.into())).collect();
            assert!(chords.iter().all(|chord| chord.high > 0.0));
            let parts = Parts { mesh, class: &class, vertices: &vertices, edges: &[], chords: &chords };
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
