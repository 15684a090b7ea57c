//! The triangles of a metric, each by itself.

use super::frame::{Frame, PlaneFrame};
use super::triangle::Triangle;
use crate::error::{Error, Result};
use crate::geometry::triangle::{area_from, half_differences};
use crate::geometry::{Motion, Space, Twofold};
use crate::mesh::{FaceId, HalfedgeId, Mesh, PerEdge, PerFace};
use crate::metric::Metric;
use crate::metric::precise::half_angles;
use crate::parallel;
use std::cell::OnceCell;

/// The triangles of a metric as frames walk along and about them.
pub(super) struct Faces<'a, F: Frame> {
    pub mesh: &'a Mesh,
    pub space: Space,
    sides: PerEdge<F::Side>,
    /// At each corner, in corner order.
    angles: PerFace<[F::Angle; 3]>,
    /// Per face: its area, by formulas without angles; whether its lengths break the triangle inequality.
    areas: PerFace<(f64, bool)>,
}

/// A triangle where it lies.
pub(super) struct Placed<F> {
    pub face: FaceId,
    /// The frames of its half-edges.
    pub sides: [F; 3],
    /// [`Faces::local`], once it was needed: pieces have points elsewhere than at its corners.
    pub local: OnceCell<[[f64; 3]; 3]>,
}

impl<'a> Faces<'a, PlaneFrame> {
    /// Of lengths in E² (E entries), by doubles.
    pub fn of_lengths(mesh: &'a Mesh, lengths: PerEdge<f64>) -> Self {
        let mut differences = vec![[0.0; 3]; mesh.n_faces()];
        parallel::fill(&mut differences, |f| {
            half_differences(mesh.opposite_edges(f.into()).map(|e| lengths[e]))
        });
        Self::of_triangles(mesh, lengths, &differences)
    }

    /// Of a metric in E², by doubles: triangles keep their shape where circles of very different sizes meet, which rounded lengths
    /// do not. Errors: those of [`Metric::lengths`]; [`Error::Layout`] in another space.
    pub fn in_plane(mesh: &'a Mesh, metric: &Metric) -> Result<Self> {
        if metric.space != Space::E2 {
            return Err(Error::Layout(format!("a metric in {} has no layout in the plane", metric.space)));
        }
        Ok(Self::of_triangles(mesh, metric.lengths(mesh)?, &metric.differences(mesh)?))
    }

    fn of_triangles(mesh: &'a Mesh, lengths: PerEdge<f64>, differences: &[[f64; 3]]) -> Self {
        let (mut angles, mut areas) =
            (vec![[[0.0; 2]; 3]; mesh.n_faces()], vec![(0.0, false); mesh.n_faces()]);
        parallel::fill_both(&mut angles, &mut areas, |f| {
            let triangle = Triangle::from_differences(differences[f]);
            (triangle.direction, (triangle.area, triangle.excess > 0.0))
        });
        Faces { mesh, space: Space::E2, sides: lengths, angles: angles.into(), areas: areas.into() }
    }
}

impl<'a> Faces<'a, Motion<Twofold>> {
    /// Of a metric in any space, with twice the digits of doubles. Errors: those of [`Metric::lengths`].
    pub fn precise(mesh: &'a Mesh, metric: &Metric) -> Result<Self> {
        let chords = metric.half_chords(mesh)?;
        let angles = half_angles(metric, mesh, &metric.scaled_chords(mesh)?);
        let differences = metric.differences(mesh)?;
        let step = |&chord: &Twofold| [Motion::translation_of_chord(chord, metric.space).a[0], chord];
        let area = |f: FaceId| {
            let broken = angles[f].iter().all(|[cos, sin]| cos.high == 0.0 || sin.high == 0.0);
            (area_from(metric.space, differences[f]), broken)
        };
        Ok(Faces {
            mesh,
            space: metric.space,
            sides: chords.iter().map(step).collect::<Vec<_>>().into(),
            areas: PerFace::from_fn(mesh.n_faces(), area),
            angles,
        })
    }
}

impl<F: Frame> Faces<'_, F> {
    /// Whether the lengths of a face break the triangle inequality.
    pub fn is_broken(&self, f: FaceId) -> bool {
        self.areas[f].1
    }

    /// A number that grows with the length of a face's longest side; in E² by [`PlaneFrame`]s that length.
    pub fn longest(&self, f: FaceId) -> f64 {
        self.mesh.opposite_edges(f).map(|e| F::size(self.sides[e])).into_iter().fold(0.0, f64::max)
    }

    /// The sum of the faces' areas.
    pub fn area(&self) -> f64 {
        self.areas.iter().fold(Twofold::default(), |sum, (area, _)| sum.plus(*area)).high
    }

    /// The frames of the half-edges of a face, in order, from that of its half-edge number `k`.
    pub fn around(&self, f: FaceId, k: usize, frame: F) -> [F; 3] {
        let (sides, angles) = (self.mesh.face_halfedges(f).map(|h| self.sides[h.edge()]), &self.angles[f]);
        let (next, last) = ((k + 1) % 3, (k + 2) % 3);
        let mut frames = [frame; 3];
        frames[next] = frame.forward(sides[k]).turned_onwards(angles[next]);
        frames[last] = frames[next].forward(sides[next]).turned_onwards(angles[last]);
        // From the nearer end: the step is rounded to doubles of its size.
        if F::size(sides[last]) < F::size(sides[next]) {
            frames[last] = frames[last].ending_at(&frame, sides[last]);
        }
        frames
    }

    /// A face whose first half-edge has this frame.
    pub fn placed(&self, f: FaceId, frame: F) -> Placed<F> {
        Placed { face: f, sides: self.around(f, 0, frame), local: OnceCell::new() }
    }

    /// The corners of a face as its first half-edge has them at the origin, along the x axis: ambient coordinates.
    pub fn local(&self, f: FaceId) -> [[f64; 3]; 3] {
        self.around(f, 0, F::identity(self.space)).map(|frame| frame.apply([0.0, 0.0, 1.0]))
    }

    /// The frame of the twin of the half-edge with this frame.
    pub fn across(&self, frame: F, h: HalfedgeId) -> F {
        frame.forward(self.sides[h.edge()]).turned_round()
    }

    /// The distance from the origin of the corner opposite `h` in its face (corner number `k` starts it), from its frame.
    pub fn distance_of_apex(&self, frame: F, f: FaceId, k: usize) -> f64 {
        let last = self.mesh.face_halfedges(f)[(k + 2) % 3];
        frame.distance_of_apex(self.angles[f][k], self.sides[last.edge()])
    }

    /// The face of a half-edge and its number there. Errors: [`Error::Layout`] outside the surface.
    pub fn place_of(&self, h: HalfedgeId) -> Result<(FaceId, usize)> {
        place_in_face(self.mesh, h)
    }
}

/// The face of a half-edge and its number among the face's half-edges. Errors: [`Error::Layout`] outside the surface.
pub(super) fn place_in_face(mesh: &Mesh, h: HalfedgeId) -> Result<(FaceId, usize)> {
    let f = mesh.face(h);
    let place = f.and_then(|f| mesh.face_halfedges(f).iter().position(|&side| side == h).map(|k| (f, k)));
    place.ok_or_else(|| Error::Layout(format!("half-edge {h} belongs to no face")))
}
