//! The triangles of a metric, each by itself.

use super::frame::{Frame, PlaneFrame, Walk};
use super::pieces::Place;
use super::triangle::Triangle;
use crate::error::{Error, Result};
use crate::geometry::model::distance;
use crate::geometry::motion::precise_point;
use crate::geometry::triangle::half_differences;
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::mesh::{EdgeId, FaceId, HalfedgeId, Mesh, PerEdge, PerFace};
use crate::metric::Metric;
use crate::metric::precise::shapes;
use crate::metric::refinement::corner_at;
use crate::parallel;
use std::cell::OnceCell;
use std::hint::black_box;

/// The triangles of a metric as frames walk along and about them.
pub(super) struct Faces<'a, F: Frame> {
    pub mesh: &'a Mesh,
    pub space: Space,
    sides: PerEdge<F::Side>,
    /// At each corner, in corner order.
    angles: PerFace<[F::Angle; 3]>,
    /// The sum of the faces' areas, by formulas without angles.
    area: f64,
    /// Faces whose lengths break the triangle inequality, ascending.
    broken: Vec<FaceId>,
}

impl<'a> Faces<'a, PlaneFrame> {
    /// Of lengths in E² (E entries), by doubles.
    pub fn of_lengths(mesh: &'a Mesh, lengths: PerEdge<f64>) -> Self {
        Self::of_triangles(mesh, lengths, |lengths, f| {
            half_differences(mesh.opposite_edges(f).map(|e| lengths[e]))
        })
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
        Ok(Self::of_triangles(mesh, measured.lengths()?, |_, f| measured.differences_of(f)))
    }

    fn of_triangles(
        mesh: &'a Mesh,
        lengths: PerEdge<f64>,
        differences: impl Fn(&PerEdge<f64>, FaceId) -> [f64; 3] + Sync,
    ) -> Self {
        let (mut angles, mut areas) =
            (vec![[[0.0; 2]; 3]; mesh.n_faces()], vec![(0.0, false); mesh.n_faces()]);
        parallel::fill_both(&mut angles, &mut areas, |f| {
            let triangle = Triangle::from_differences(differences(&lengths, f.into()));
            (triangle.direction, (triangle.area, triangle.excess > 0.0))
        });
        Faces { mesh, space: Space::E2, sides: lengths, angles: angles.into(), ..Faces::summed(mesh, &areas) }
    }
}

impl<'a> Faces<'a, Motion<DoubleDouble>> {
    /// Of a metric in any space, with twice the digits of doubles.
    ///
    /// # Errors
    /// Those of [`Metric::lengths`].
    pub fn precise(mesh: &'a Mesh, metric: &Metric) -> Result<Self> {
        let (chords, angles, areas) = shapes(metric, mesh)?;
        let mut sides = vec![[DoubleDouble::default(); 2]; mesh.n_edges()];
        parallel::fill(&mut sides, |e| {
            let (chord, unit) = chords[EdgeId::from(e)];
            let chord = chord.scaled(unit);
            [Motion::translation_of_chord(chord, metric.space).a[0], chord]
        });
        Ok(Faces { mesh, space: metric.space, sides: sides.into(), angles, ..Faces::summed(mesh, &areas) })
    }
}

impl Faces<'_, Motion<DoubleDouble>> {
    /// A point of a face, the first half-edge of which has this frame, to twice the digits at a corner.
    pub fn point(&self, (face, first): (FaceId, Motion<DoubleDouble>), place: Place) -> [DoubleDouble; 3] {
        match place.rounded() {
            Some(corner) => self.around(face, 0, first)[corner].origin(),
            None => {
                let local = combination(self.space, self.local(face), place.weights());
                first.apply(precise_point(self.space, local))
            }
        }
    }
}

impl<'a, F: Frame> Faces<'a, F> {
    /// What is known of faces with these areas, broken ones marked.
    fn summed(mesh: &'a Mesh, areas: &[(f64, bool)]) -> Self {
        let sum = areas.iter().fold(DoubleDouble::default(), |sum, (area, _)| sum.plus(*area));
        Faces {
            mesh,
            space: Space::E2,
            sides: Vec::new().into(),
            angles: Vec::new().into(),
            area: sum.high,
            broken: mesh.faces().filter(|f| areas[f.index()].1).collect(),
        }
    }

    /// Reads what a walk around a face reads, so that it is near when the walk comes.
    #[inline]
    pub fn read(&self, f: FaceId) {
        black_box((self.angles[f][0], self.sides(f)));
    }

    /// Whether the lengths of a face break the triangle inequality.
    pub fn is_broken(&self, f: FaceId) -> bool {
        !self.broken.is_empty() && self.broken.binary_search(&f).is_ok()
    }

    /// The lengths of the edges.
    pub fn lengths(&self) -> PerEdge<f64> {
        let mut lengths = vec![0.0; self.sides.len()];
        parallel::fill(&mut lengths, |e| F::length(self.space, self.sides[EdgeId::from(e)]));
        lengths.into()
    }

    /// The length of the side opposite a corner.
    pub fn length(&self, f: FaceId, corner: usize) -> f64 {
        F::length(self.space, self.sides[self.mesh.opposite_edges(f)[corner]])
    }

    /// A number that grows with the length of a face's longest side; in E² by [`PlaneFrame`]s that length.
    #[inline]
    pub fn longest(&self, f: FaceId) -> f64 {
        self.mesh.opposite_edges(f).map(|e| F::size(self.sides[e])).into_iter().fold(0.0, f64::max)
    }

    /// The sum of the faces' areas.
    pub fn area(&self) -> f64 {
        self.area
    }

    /// The corners of a face as its first half-edge has them at the origin, along the x axis: ambient coordinates.
    pub fn local(&self, f: FaceId) -> [[f64; 3]; 3] {
        self.all(f, F::identity(self.space)).map(|frame| frame.origin())
    }

    /// The sides of a face, in the order of its half-edges.
    #[inline]
    fn sides(&self, f: FaceId) -> [F::Side; 3] {
        self.mesh.face_halfedges(f).map(|h| self.sides[h.edge()])
    }

    /// The frames of the half-edges of a face, in order, from that of its half-edge number `k`.
    #[inline]
    pub fn around<W: Walk<Side = F::Side, Angle = F::Angle>>(&self, f: FaceId, k: usize, frame: W) -> [W; 3] {
        match k {
            0 => self.all(f, frame),
            1 => {
                let [p, q, r] = self.onwards::<W, 1>(f, frame);
                [r, p, q]
            }
            _ => {
                let [p, q, r] = self.onwards::<W, 2>(f, frame);
                [q, r, p]
            }
        }
    }

    /// [`Faces::around`] from the first half-edge.
    #[inline]
    pub fn all<W: Walk<Side = F::Side, Angle = F::Angle>>(&self, f: FaceId, first: W) -> [W; 3] {
        self.onwards::<W, 0>(f, first)
    }

    /// The frames of the half-edges of a face, one after the other from that of its half-edge number `K`.
    #[inline]
    fn onwards<W: Walk<Side = F::Side, Angle = F::Angle>, const K: usize>(
        &self,
        f: FaceId,
        frame: W,
    ) -> [W; 3] {
        let (sides, angles) = (self.sides(f), &self.angles[f]);
        let [here, next, last] = [K, (K + 1) % 3, (K + 2) % 3];
        let second = frame.forward(sides[here]).turned_onwards(angles[next]);
        let third = second.forward(sides[next]).turned_onwards(angles[last]);
        // The last corner is placed from its nearer neighbour, since a step is rounded to doubles of its size.
        let nearer = W::size(sides[last]) < W::size(sides[next]);
        [frame, second, if nearer { third.ending_at(&frame, sides[last]) } else { third }]
    }

    /// The frame of half-edge number `k` of a face, from that of its first one.
    #[inline]
    pub fn side<W: Walk<Side = F::Side, Angle = F::Angle>>(&self, f: FaceId, k: usize, first: W) -> W {
        match k {
            0 => first,
            1 => {
                let [h, ..] = self.mesh.face_halfedges(f);
                first.forward(self.sides[h.edge()]).turned_onwards(self.angles[f][1])
            }
            _ => self.all(f, first)[2],
        }
    }

    /// The frame of the first half-edge of a face, from that of its half-edge number `k`.
    #[inline]
    pub fn first<W: Walk<Side = F::Side, Angle = F::Angle>>(&self, f: FaceId, k: usize, frame: W) -> W {
        match k {
            0 => frame,
            1 => {
                let [h, ..] = self.mesh.face_halfedges(f);
                let back = frame.backwards(self.sides[h.edge()], self.angles[f][1]);
                back.unwrap_or_else(|| self.around(f, 1, frame)[0])
            }
            _ => {
                let [.., h] = self.mesh.face_halfedges(f);
                frame.forward(self.sides[h.edge()]).turned_onwards(self.angles[f][0])
            }
        }
    }

    /// The frame of the twin of half-edge number `k` of a face, from that of the face's first one.
    #[inline]
    pub fn beyond<W: Walk<Side = F::Side, Angle = F::Angle>>(&self, f: FaceId, k: usize, first: W) -> W {
        let inwards = if k == 2 { first.turned_inwards(self.angles[f][0]) } else { None };
        inwards.unwrap_or_else(|| self.across(self.side(f, k, first), self.mesh.face_halfedges(f)[k]))
    }

    /// The frame of the twin of the half-edge with this frame.
    #[inline]
    pub fn across<W: Walk<Side = F::Side, Angle = F::Angle>>(&self, frame: W, h: HalfedgeId) -> W {
        frame.forward(self.sides[h.edge()]).turned_round()
    }

    /// The distance from the origin of the corner opposite the twin of a half-edge with this frame, or a number that grows with it; none
    /// where no face is beyond.
    #[inline]
    pub fn distance_beyond<W: Walk<Side = F::Side, Angle = F::Angle>>(
        &self,
        frame: W,
        h: HalfedgeId,
    ) -> Option<f64> {
        let (f, k) = self.mesh.corner(h.twin())?;
        let last = self.mesh.prev(h.twin());
        Some(self.across(frame, h).distance_of_apex(self.angles[f][k], self.sides[last.edge()]))
    }
}

/// A final face where it lies.
pub(super) struct Placed<'a, F: Frame> {
    faces: &'a Faces<'a, F>,
    face: FaceId,
    /// The frame of its first half-edge.
    first: F,
    /// [`Faces::local`], formed where a piece has a point elsewhere than at a corner of the face.
    local: OnceCell<[[f64; 3]; 3]>,
}

impl<'a, F: Frame> Placed<'a, F> {
    pub fn new(faces: &'a Faces<'a, F>, face: FaceId, first: F) -> Self {
        Placed { faces, face, first, local: OnceCell::new() }
    }

    /// The point with these weights of the face's corners, as the face's first half-edge has it at the origin.
    fn local(&self, weights: [f64; 3]) -> [f64; 3] {
        combination(self.faces.space, *self.local.get_or_init(|| self.faces.local(self.face)), weights)
    }

    /// A point of the face where it lies, and what its doubles miss of x and y: nothing is known of that elsewhere than at a corner.
    pub fn point(&self, place: Place) -> ([f64; 3], [f64; 2]) {
        match place.rounded() {
            Some(corner) => self.faces.side(self.face, corner, self.first).point(),
            None => (self.first.apply(self.local(place.weights())), [0.0; 2]),
        }
    }

    /// By how much points miss these of the face, as [`Frame::miss`] has it: at a corner about the corner itself, since seen
    /// from elsewhere in a large face of H² the difference would be magnified.
    pub fn misses(&self, points: [[f64; 3]; 3], places: [Place; 3], sides: &[F; 3]) -> [[f64; 2]; 3] {
        [0, 1, 2].map(|k| match places[k].rounded() {
            Some(corner) => sides[corner].miss_of_origin(points[k]),
            None => self.first.miss(points[k], self.local(places[k].weights())),
        })
    }

    /// The frames of its half-edges.
    pub fn sides(&self) -> [F; 3] {
        self.faces.all(self.face, self.first)
    }

    /// The length of the face's longest side, or a number that grows with it: [`Faces::longest`].
    pub fn longest(&self) -> f64 {
        self.faces.longest(self.face)
    }
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
#[inline]
pub(super) fn corner_of(mesh: &Mesh, h: HalfedgeId) -> Result<(FaceId, usize)> {
    mesh.corner(h).ok_or_else(|| outside(h))
}

/// The face of a half-edge.
///
/// # Errors
/// [`Error::Layout`] outside the surface.
#[inline]
pub(super) fn face_of(mesh: &Mesh, h: HalfedgeId) -> Result<FaceId> {
    mesh.face(h).ok_or_else(|| outside(h))
}

#[cold]
fn outside(h: HalfedgeId) -> Error {
    Error::Layout(format!("half-edge {h} belongs to no face"))
}
