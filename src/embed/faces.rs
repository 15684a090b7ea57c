//! The triangles of a metric, each by itself.

use super::frame::{Frame, ORIGIN, PlaneFrame};
use super::triangle::Triangle;
use crate::error::{Error, Result};
use crate::geometry::model::distance;
use crate::geometry::triangle::{area_from, half_differences};
use crate::geometry::{Motion, Space, Twofold};
use crate::mesh::{EdgeId, FaceId, HalfedgeId, Mesh, PerEdge, PerFace};
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

impl<'a> Faces<'a, PlaneFrame> {
    /// Of lengths in E² (E entries), by doubles.
    pub fn of_lengths(mesh: &'a Mesh, lengths: PerEdge<f64>) -> Self {
        let mut differences = vec![[0.0; 3]; mesh.n_faces()];
        parallel::fill(&mut differences, |f| {
            half_differences(mesh.opposite_edges(f.into()).map(|e| lengths[e]))
        });
        Self::of_triangles(mesh, lengths, &differences)
    }

    /// Of a metric in E², by doubles. Triangles keep their shape where circles of very different sizes meet, since they come from
    /// [`Metric::differences`]: rounded lengths would lose it.
    ///
    /// # Errors
    /// Those of [`Metric::lengths`]; [`Error::Layout`] in another space.
    pub fn in_plane(mesh: &'a Mesh, metric: &Metric) -> Result<Self> {
        if metric.space != Space::E2 {
            return Err(Error::Layout(format!("a metric in {} has no layout in the plane", metric.space)));
        }
        let measured = metric.measured(mesh)?;
        Ok(Self::of_triangles(mesh, measured.lengths()?, &measured.differences()))
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
    /// Of a metric in any space, with twice the digits of doubles.
    ///
    /// # Errors
    /// Those of [`Metric::lengths`].
    pub fn precise(mesh: &'a Mesh, metric: &Metric) -> Result<Self> {
        let differences = metric.differences(mesh)?;
        let chords = metric.scaled_chords(mesh);
        let angles = half_angles(metric, mesh, &chords);
        let mut sides = vec![[Twofold::default(); 2]; mesh.n_edges()];
        parallel::fill(&mut sides, |e| {
            let (chord, unit) = chords[EdgeId::from(e)];
            let chord = chord.scaled(unit);
            [Motion::translation_of_chord(chord, metric.space).a[0], chord]
        });
        let area = |f: FaceId| {
            let broken = angles[f].iter().all(|[cos, sin]| cos.high == 0.0 || sin.high == 0.0);
            (area_from(metric.space, differences[f]), broken)
        };
        Ok(Faces {
            mesh,
            space: metric.space,
            sides: sides.into(),
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
        // The last corner is placed from its nearer neighbour, since a step is rounded to doubles of its size.
        if F::size(sides[last]) < F::size(sides[next]) {
            frames[last] = frames[last].ending_at(&frame, sides[last]);
        }
        frames
    }

    /// The corners of a face as its first half-edge has them at the origin, along the x axis: ambient coordinates.
    pub fn local(&self, f: FaceId) -> [[f64; 3]; 3] {
        self.around(f, 0, F::identity(self.space)).map(|frame| frame.origin())
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
}

/// A final face where it lies.
pub(super) struct Placed<'a, F: Frame> {
    faces: &'a Faces<'a, F>,
    face: FaceId,
    /// The frames of its half-edges.
    sides: &'a [F; 3],
    /// [`Faces::local`], formed where a piece has a point elsewhere than at a corner of the face.
    local: OnceCell<[[f64; 3]; 3]>,
}

impl<'a, F: Frame> Placed<'a, F> {
    pub fn new(faces: &'a Faces<'a, F>, face: FaceId, sides: &'a [F; 3]) -> Self {
        Placed { faces, face, sides, local: OnceCell::new() }
    }

    /// The point with these weights of the face's corners, as the face's first half-edge has it at the origin.
    fn local(&self, weights: [f64; 3]) -> [f64; 3] {
        combination(self.faces.space, *self.local.get_or_init(|| self.faces.local(self.face)), weights)
    }

    /// The point of the face with these weights of its corners, where it lies.
    pub fn point(&self, weights: [f64; 3]) -> [f64; 3] {
        match corner_at(weights) {
            Some(corner) => self.sides[corner].origin(),
            None => self.sides[0].apply(self.local(weights)),
        }
    }

    /// What the doubles of [`Placed::point`] miss of x and y at a corner; elsewhere nothing more is known.
    pub fn remainder(&self, weights: [f64; 3]) -> [f64; 2] {
        corner_at(weights).map_or([0.0; 2], |corner| self.sides[corner].remainder())
    }

    /// By how much a point misses the one with these weights, as [`Frame::miss`] has it: at a corner about the corner itself, since seen
    /// from elsewhere in a large face of H² the difference would be magnified.
    pub fn miss(&self, point: [f64; 3], weights: [f64; 3]) -> [f64; 2] {
        match corner_at(weights) {
            Some(corner) => self.sides[corner].miss(point, ORIGIN),
            None => self.sides[0].miss(point, self.local(weights)),
        }
    }

    /// The length of the face's longest side, or a number that grows with it: [`Faces::longest`].
    pub fn longest(&self) -> f64 {
        self.faces.longest(self.face)
    }
}

/// The corner of a face at which a point with these weights lies, if it is one.
pub(super) fn corner_at(weights: [f64; 3]) -> Option<usize> {
    weights.iter().position(|&w| w == 1.0)
}

/// The point of the plane, hyperboloid or sphere in the direction of a combination of points; at a corner, the corner itself.
pub(super) fn combination(space: Space, corners: [[f64; 3]; 3], weights: [f64; 3]) -> [f64; 3] {
    if let Some(corner) = corner_at(weights) {
        return corners[corner];
    }
    let [x, y, w] = [0, 1, 2].map(|i| (0..3).map(|k| weights[k] * corners[k][i]).sum::<f64>());
    // In H² −⟨P, P⟩ = Σ w_i² + Σ 2 w_i w_j cosh d_ij = (Σ w_i)² + Σ 4 w_i w_j sinh²(d_ij/2), which does not cancel.
    let norm = match space {
        Space::E2 => w,
        Space::S2 => (x * x + y * y + w * w).sqrt(),
        Space::H2 => {
            let pairs = [[0, 1], [1, 2], [2, 0]].map(|[i, j]| {
                let half = (0.5 * distance(corners[i], corners[j])).sinh();
                4.0 * weights[i] * weights[j] * half * half
            });
            let sum: f64 = weights.iter().sum();
            (sum * sum + pairs.iter().sum::<f64>()).sqrt()
        }
    };
    let (x, y) = (x / norm, y / norm);
    // So that the point is on the hyperboloid to the last digit.
    let w = if space == Space::H2 { 1.0f64.hypot(x.hypot(y)) } else { w / norm };
    [x, y, w]
}

/// The face of a half-edge and its number among the face's half-edges.
///
/// # Errors
/// [`Error::Layout`] outside the surface.
pub(super) fn corner_of(mesh: &Mesh, h: HalfedgeId) -> Result<(FaceId, usize)> {
    mesh.corner(h).ok_or_else(|| Error::Layout(format!("half-edge {h} belongs to no face")))
}
