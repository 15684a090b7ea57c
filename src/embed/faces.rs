//! The triangles of a metric with their sides and angles, and the frames of their half-edges.

use super::frame::{HalfedgeFrame, MovingFrame, PlaneFrame};
use super::pieces::{LayoutPieces, PlaceInFace};
use crate::error::{Error, Result};
use crate::geometry::complex::{cross, sub};
use crate::geometry::model::distance;
use crate::geometry::motion::precise_point;
use crate::geometry::plane_triangle::PlaneTriangle;
use crate::geometry::triangle::half_differences;
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::mesh::{EdgeId, FaceId, HalfedgeId, Mesh, PerEdge, PerFace};
use crate::metric::Metric;
use crate::metric::common_subdivision::corner_at;
use crate::metric::precise::shapes;
use crate::parallel;
use std::cell::OnceCell;

/// The triangles of a metric, in the form in which frames move along their sides and turn at their corners.
pub(super) struct Faces<'a, F: HalfedgeFrame> {
    pub mesh: &'a Mesh,
    pub space: Space,
    sides: PerEdge<F::Side>,
    /// Per face, the angles in corner order.
    angles: PerFace<[F::Angle; 3]>,
    /// The sum of the faces' areas, by formulas without angles.
    area: f64,
    /// Faces whose lengths break the triangle inequality, ascending.
    broken: Vec<FaceId>,
}

impl<'a> Faces<'a, PlaneFrame> {
    /// The triangles with these lengths in E² (E entries), in f64.
    pub fn of_lengths(mesh: &'a Mesh, lengths: PerEdge<f64>) -> Self {
        Self::of_triangles(mesh, lengths, |lengths, f| {
            half_differences(mesh.opposite_edges(f).map(|e| lengths[e]))
        })
    }

    /// The triangles of a metric in E², in f64. They are formed from [`Metric::differences`], so that triangles whose vertex circles have
    /// very different sizes keep their shape, which rounded lengths would lose.
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
            let triangle = PlaneTriangle::from_differences(differences(&lengths, f.into()));
            (triangle.direction, (triangle.area, triangle.excess > 0.0))
        });
        Faces { mesh, space: Space::E2, sides: lengths, angles: angles.into(), ..Faces::summed(mesh, &areas) }
    }
}

impl<'a> Faces<'a, Motion<DoubleDouble>> {
    /// The triangles of a metric in any space, in double-double precision.
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
    /// The face across a half-edge of the triangulation, and the frame of its first half-edge. `first`: the frame of the first half-edge of
    /// the face on the left.
    ///
    /// # Errors
    /// [`Error::Layout`] unless the half-edge has a face on both sides.
    pub fn across_side(
        &self,
        first: Motion<DoubleDouble>,
        h: HalfedgeId,
    ) -> Result<(FaceId, Motion<DoubleDouble>)> {
        let ((face, side), (next, k)) = (corner_of(self.mesh, h)?, corner_of(self.mesh, h.twin())?);
        let across = self.across(self.side(face, side, first), h);
        Ok((next, self.around(next, k, across)[0]))
    }

    /// A point of a face whose first half-edge has this frame; at a corner in double-double precision.
    pub fn point(&self, face: FaceId, first: Motion<DoubleDouble>, place: PlaceInFace) -> [DoubleDouble; 3] {
        match place.rounded_corner() {
            Some(corner) => self.around(face, 0, first)[corner].origin(),
            None => {
                let local = combination(self.space, self.local(face), place.weights());
                first.apply(precise_point(self.space, local))
            }
        }
    }
}

impl<'a, F: HalfedgeFrame> Faces<'a, F> {
    /// The sum of these areas and the list of the broken faces, which are marked by `true`; sides and angles stay empty.
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

    /// True if the lengths of a face break the triangle inequality.
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

    /// A number that grows with the length of a face's longest side; with [`PlaneFrame`]s, that length.
    #[inline]
    pub fn longest(&self, f: FaceId) -> f64 {
        self.mesh.opposite_edges(f).map(|e| F::size(self.sides[e])).into_iter().fold(0.0, f64::max)
    }

    /// The sum of the faces' areas.
    pub fn area(&self) -> f64 {
        self.area
    }

    /// The area of pieces of the faces: half of all area for the given half of a double, the sum of the pieces' areas where caps are left out.
    pub fn area_of(&self, pieces: &LayoutPieces) -> f64 {
        let mesh = pieces.mesh();
        if self.mesh.is_closed() {
            return if mesh.is_closed() { 1.0 } else { 0.5 } * self.area;
        }
        let has_caps = pieces.common_subdivision().is_some_and(|r| r.n_vertices[0] < self.mesh.n_vertices());
        if self.space != Space::E2 || !has_caps {
            return self.area;
        }
        let area = |f: FaceId| {
            let local = self.local(pieces.final_face(f));
            let place = |weights| combination(self.space, local, weights);
            let [a, b, c] = pieces.final_barycentric(f).map(place).map(|[x, y, _]| [x, y]);
            0.5 * cross(sub(b, a), sub(c, a))
        };
        mesh.faces().map(area).sum()
    }

    /// The ambient coordinates of a face's corners when its first half-edge starts at the origin, along the x axis.
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
    pub fn around<W: MovingFrame<Side = F::Side, Angle = F::Angle>>(
        &self,
        f: FaceId,
        k: usize,
        frame: W,
    ) -> [W; 3] {
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

    /// The frames of the half-edges of a face, in order, from that of its first one.
    #[inline]
    pub fn all<W: MovingFrame<Side = F::Side, Angle = F::Angle>>(&self, f: FaceId, first: W) -> [W; 3] {
        self.onwards::<W, 0>(f, first)
    }

    /// The frames of the half-edges of a face, one after the other from that of its half-edge number `K`.
    #[inline]
    fn onwards<W: MovingFrame<Side = F::Side, Angle = F::Angle>, const K: usize>(
        &self,
        f: FaceId,
        frame: W,
    ) -> [W; 3] {
        let (sides, angles) = (self.sides(f), &self.angles[f]);
        let [here, next, last] = [K, (K + 1) % 3, (K + 2) % 3];
        let second = frame.forward(sides[here]).turned_onwards(angles[next]);
        let third = second.forward(sides[next]).turned_onwards(angles[last]);
        // The last corner is placed from its nearer neighbour, since the rounding of a step grows with its length.
        let nearer = W::size(sides[last]) < W::size(sides[next]);
        [frame, second, if nearer { third.ending_at(&frame, sides[last]) } else { third }]
    }

    /// The frame of half-edge number `k` of a face, from that of its first one.
    #[inline]
    pub fn side<W: MovingFrame<Side = F::Side, Angle = F::Angle>>(&self, f: FaceId, k: usize, first: W) -> W {
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
    pub fn first<W: MovingFrame<Side = F::Side, Angle = F::Angle>>(
        &self,
        f: FaceId,
        k: usize,
        frame: W,
    ) -> W {
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
    pub fn beyond<W: MovingFrame<Side = F::Side, Angle = F::Angle>>(
        &self,
        f: FaceId,
        k: usize,
        first: W,
    ) -> W {
        let inwards = if k == 2 { first.turned_inwards(self.angles[f][0]) } else { None };
        inwards.unwrap_or_else(|| self.across(self.side(f, k, first), self.mesh.face_halfedges(f)[k]))
    }

    /// The frame of the twin of the half-edge with this frame.
    #[inline]
    pub fn across<W: MovingFrame<Side = F::Side, Angle = F::Angle>>(&self, frame: W, h: HalfedgeId) -> W {
        frame.forward(self.sides[h.edge()]).turned_round()
    }

    /// The distance from the origin of the corner opposite the twin of a half-edge with this frame, or a number that grows with it; `None`
    /// if no face lies beyond.
    #[inline]
    pub fn distance_beyond<W: MovingFrame<Side = F::Side, Angle = F::Angle>>(
        &self,
        frame: W,
        h: HalfedgeId,
    ) -> Option<f64> {
        let (f, k) = self.mesh.corner(h.twin())?;
        let last = self.mesh.prev(h.twin());
        Some(self.across(frame, h).distance_of_apex(self.angles[f][k], self.sides[last.edge()]))
    }
}

/// A final face at its place in the layout.
pub(super) struct PlacedFace<'a, F: HalfedgeFrame> {
    faces: &'a Faces<'a, F>,
    face: FaceId,
    /// The frame of its first half-edge.
    first: F,
    /// [`Faces::local`], computed when a point is asked for that is no corner of the face.
    local: OnceCell<[[f64; 3]; 3]>,
}

impl<'a, F: HalfedgeFrame> PlacedFace<'a, F> {
    pub fn new(faces: &'a Faces<'a, F>, face: FaceId, first: F) -> Self {
        PlacedFace { faces, face, first, local: OnceCell::new() }
    }

    /// The point with these weights of the face's corners, when the face's first half-edge starts at the origin.
    fn local(&self, weights: [f64; 3]) -> [f64; 3] {
        combination(self.faces.space, *self.local.get_or_init(|| self.faces.local(self.face)), weights)
    }

    /// A point of the face in the layout, and the low parts of x and y in double-double precision, which are known only at a corner.
    pub fn point(&self, place: PlaceInFace) -> ([f64; 3], [f64; 2]) {
        match place.rounded_corner() {
            Some(corner) => self.faces.side(self.face, corner, self.first).point(),
            None => (self.first.apply(self.local(place.weights())), [0.0; 2]),
        }
    }

    /// The differences between `points` and the points of the face at these places ([`HalfedgeFrame::miss`]). At a corner the difference is
    /// a vector at the corner itself, since in a large face of H² it would be magnified elsewhere.
    pub fn misses(&self, points: [[f64; 3]; 3], places: [PlaceInFace; 3], sides: &[F; 3]) -> [[f64; 2]; 3] {
        [0, 1, 2].map(|k| match places[k].rounded_corner() {
            Some(corner) => sides[corner].miss_of_origin(points[k]),
            None => self.first.miss(points[k], self.local(places[k].weights())),
        })
    }

    /// The frames of the face's half-edges.
    pub fn sides(&self) -> [F; 3] {
        self.faces.all(self.face, self.first)
    }

    /// [`Faces::longest`] of the face.
    pub fn longest(&self) -> f64 {
        self.faces.longest(self.face)
    }
}

/// The point of the plane, hyperboloid or sphere in the direction of a combination of corners; if only one has a weight, that corner.
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
    // In H² w is computed from x and y, so that the point lies on the hyperboloid to the last digit.
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
