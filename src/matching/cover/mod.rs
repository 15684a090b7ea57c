//! A triangulation in the universal cover of a surface of constant curvature: one lift of every vertex, and the deck transformations from
//! face to face.

mod face_boxes;
mod walk;

pub(super) use self::walk::{LocatedVertex, WalkSeed, locate, located};
use crate::archive::{in_range, stored};
use crate::embed::Layout;
use crate::error::{Error, Result, check_size};
use crate::geometry::motion::precise_point;
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::mesh::{FaceId, HalfedgeId, Mesh, PerHalfedge, PerVertex, VertexId};
use crate::parallel;
use crate::topology::CutGraph;
use std::sync::Arc;

/// A surface that is opened along a cut, and the deck transformations across the cut.
///
/// Every vertex has an *own corner*: the corner of the opened surface whose position is that of the vertex. Its other corners lie at the
/// images of this position under deck transformations.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct UniversalCover {
    pub mesh: Arc<Mesh>,
    pub space: Space,
    /// The deck transformations that occur; number 0 is the identity.
    motions: Vec<Motion<DoubleDouble>>,
    /// The number of those that are the identity or occur across half-edges; they come first.
    n_across: usize,
    /// Per half-edge of a face the number of the transformation that carries the opened surface onto its neighbour across it.
    across: PerHalfedge<u32>,
    /// Per half-edge of a face the number of the transformation that carries the vertex at its origin to the corner there.
    corner: PerHalfedge<u32>,
    /// Per vertex the half-edge of its own corner.
    own: PerVertex<HalfedgeId>,
}
stored!(sections UniversalCover { mesh, space, motions, n_across, across, corner, own } check UniversalCover::check_parts);

impl UniversalCover {
    /// Checks that the parts of an archive fit each other.
    fn check_parts(&self) -> Result<()> {
        check_size("sides", self.across.len(), self.mesh.n_halfedges())?;
        check_size("corners", self.corner.len(), self.mesh.n_halfedges())?;
        check_size("own corners", self.own.len(), self.mesh.n_vertices())?;
        let named = self.across.iter().chain(&self.corner).map(|&k| k as usize);
        in_range("motion", named.chain(self.n_across.checked_sub(1)), self.motions.len())?;
        in_range("half-edge", self.own.iter().map(|h| h.index()), self.mesh.n_halfedges())
    }

    /// The cover with these transformations across half-edges, `None` for the identity. `own`: half-edges whose corners become the own
    /// corners of their vertices. A vertex on the boundary always has the corner at the boundary edge that leaves it with the surface on
    /// the left.
    pub fn new(
        mesh: &Arc<Mesh>,
        space: Space,
        across: impl Fn(HalfedgeId) -> Option<Motion<DoubleDouble>>,
        own: &[HalfedgeId],
    ) -> Result<UniversalCover> {
        let n = mesh.n_halfedges();
        let mut motions = vec![Motion::identity(space)];
        let mut across_number = PerHalfedge::filled(n, 0u32);
        for h in mesh.halfedges().filter(|&h| !mesh.is_outside(h)) {
            if let Some(motion) = across(h) {
                across_number[h] = motions.len() as u32;
                motions.push(motion);
            }
        }
        let n_across = motions.len();
        let mut wished = PerVertex::filled(mesh.n_vertices(), None);
        own.iter().for_each(|&h| wished[mesh.origin(h)] = Some(h));
        let (mut corner, mut own) = (PerHalfedge::filled(n, 0u32), Vec::with_capacity(mesh.n_vertices()));
        for v in mesh.vertices() {
            let mut fan = mesh.fan(v);
            let wish = wished[v].filter(|_| !mesh.is_boundary_vertex(v));
            if let Some(first) = wish.and_then(|h| fan.iter().position(|&g| g == h)) {
                fan.rotate_left(first);
            }
            let Some(&first) = fan.first() else {
                return Err(Error::connectivity("vertex", v.index(), "has no face"));
            };
            own.push(first);
            let mut at = 0u32;
            for pair in fan.windows(2) {
                // Counterclockwise from face to face: the transformation to the corner in the next face.
                let step = across_number[mesh.prev(pair[0])];
                if step != 0 {
                    let motion = motions[step as usize].inverse().compose(&motions[at as usize]);
                    at = motions.len() as u32;
                    motions.push(motion.normalised());
                }
                corner[pair[1]] = at;
            }
        }
        Ok(UniversalCover {
            mesh: mesh.clone(),
            space,
            motions,
            n_across,
            across: across_number,
            corner,
            own: own.into(),
        })
    }

    /// The cover of a surface that is opened along a cut. `pairings`: per segment the transformation that carries the opened surface onto
    /// its neighbour on the left of the segment; `own` as for [`UniversalCover::new`].
    pub fn along_cut(
        mesh: &Arc<Mesh>,
        space: Space,
        cut: &CutGraph,
        pairings: &[Motion<DoubleDouble>],
        own: &[HalfedgeId],
    ) -> Result<UniversalCover> {
        // Per half-edge 1 + the number of the segment that it lies on, negative on the right side of the segment.
        let mut side = PerHalfedge::filled(mesh.n_halfedges(), 0i32);
        for (k, segment) in cut.segments.iter().enumerate() {
            for &h in segment {
                (side[h], side[h.twin()]) = (k as i32 + 1, -(k as i32) - 1);
            }
        }
        let across = |h: HalfedgeId| {
            let pairing = pairings.get((side[h].unsigned_abs() as usize).wrapping_sub(1))?;
            Some(if side[h] > 0 { *pairing } else { pairing.inverse() })
        };
        UniversalCover::new(mesh, space, across, own)
    }

    /// The half-edge of a vertex's own corner.
    pub fn own(&self, v: VertexId) -> HalfedgeId {
        self.own[v]
    }

    /// The transformation that carries the opened surface onto its neighbour across a half-edge of a face; `None` for the identity.
    pub fn across(&self, h: HalfedgeId) -> Option<&Motion<DoubleDouble>> {
        Some(self.across[h]).filter(|&k| k != 0).map(|k| &self.motions[k as usize])
    }

    /// The transformations across the half-edges of the cut.
    pub fn neighbours(&self) -> &[Motion<DoubleDouble>] {
        &self.motions[1..self.n_across]
    }

    /// The transformation from a vertex to its corner at a half-edge of a face; `None` for the identity.
    pub fn corner(&self, h: HalfedgeId) -> Option<&Motion<DoubleDouble>> {
        Some(self.corner[h]).filter(|&k| k != 0).map(|k| &self.motions[k as usize])
    }

    /// The transformation that carries the vertex at a half-edge's tip to the end of the lift of the half-edge that starts at the vertex at
    /// its origin; `None` for the identity.
    pub fn along(&self, h: HalfedgeId) -> Option<Motion<DoubleDouble>> {
        let (inside, is_turned) = if self.mesh.is_outside(h) { (h.twin(), true) } else { (h, false) };
        let [from, to] = [inside, self.mesh.next(inside)].map(|h| self.corner[h]);
        if from == to {
            return None;
        }
        let motion = self.motions[from as usize].inverse().compose(&self.motions[to as usize]);
        Some(if is_turned { motion.inverse() } else { motion })
    }
}

/// A triangulation in a universal cover, with a frame at the position of every vertex: the motion that carries the origin there.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PlacedMesh {
    pub cover: UniversalCover,
    pub at: PerVertex<Motion<DoubleDouble>>,
}
stored!(sections PlacedMesh { cover, at });

/// A point in double-double precision.
pub(super) type PrecisePoint = [DoubleDouble; 3];

impl PlacedMesh {
    /// The vertices at the points where a layout puts their own corners.
    ///
    /// # Errors
    /// [`Error::Matching`] for a layout that is not opened along edges of the surface.
    pub fn of_layout(cover: UniversalCover, layout: &Layout) -> Result<PlacedMesh> {
        let Some(on_input) = layout.on_input() else {
            return Err(Error::Matching("the layout is not opened along the cut".into()));
        };
        let point = |v: VertexId| {
            let corner = on_input.corner_index[cover.own(v)] as usize;
            let k = on_input.points[corner] as usize;
            match cover.space {
                Space::S2 => PlacedMesh::frame(cover.space, layout.points[k]),
                space => Motion::to_origin(space, layout.precise_point(k)).inverse(),
            }
        };
        let at = PerVertex::from_fn(cover.mesh.n_vertices(), point);
        Ok(PlacedMesh { cover, at })
    }

    /// The frame at a point that the translation from the origin to the point makes of the frame at the origin.
    pub fn frame(space: Space, point: [f64; 3]) -> Motion<DoubleDouble> {
        let [x, y, w] = point;
        if space == Space::S2 && w < 0.0 {
            // Half a turn of the sphere brings the point nearer to the origin than to its antipode, at which the translation is not
            // determined.
            let (zero, one) = (DoubleDouble::from(0.0), DoubleDouble::from(1.0));
            let half_turn = Motion { space, a: [zero; 2], b: [one, zero] };
            return half_turn.compose(&PlacedMesh::frame(space, [-x, y, -w]));
        }
        Motion::to_origin(space, precise_point(space, point)).inverse()
    }

    /// The position in the opened surface of the corner of a half-edge of a face.
    pub fn corner(&self, h: HalfedgeId) -> PrecisePoint {
        let point = self.at[self.cover.mesh.origin(h)].origin();
        self.cover.corner(h).map_or(point, |motion| motion.apply(point))
    }

    /// The frame at the corner of a half-edge of a face in the opened surface.
    pub fn frame_at(&self, h: HalfedgeId) -> Motion<DoubleDouble> {
        let frame = self.at[self.cover.mesh.origin(h)];
        self.cover.corner(h).map_or(frame, |motion| motion.compose(&frame))
    }

    /// The frames at the corners of a face in the opened surface.
    pub fn face(&self, f: FaceId) -> [Motion<DoubleDouble>; 3] {
        self.cover.mesh.face_halfedges(f).map(|h| self.frame_at(h))
    }

    /// The corners of a face in the opened surface.
    pub fn corners(&self, f: FaceId) -> [PrecisePoint; 3] {
        self.cover.mesh.face_halfedges(f).map(|h| self.corner(h))
    }

    /// Per half-edge the vector, in the frame at its origin, of the geodesic to its tip.
    pub fn logarithms(&self) -> PerHalfedge<[f64; 2]> {
        let mesh = &self.cover.mesh;
        let mut all = vec![[0.0; 2]; mesh.n_halfedges()];
        parallel::fill(&mut all, |h| {
            let h = HalfedgeId::from(h);
            let tip = self.at[mesh.tip(h)];
            let tip = self.cover.along(h).map_or(tip, |motion| motion.compose(&tip));
            logarithm(self.cover.space, seen_from(&self.at[mesh.origin(h)], &tip))
        });
        all.into()
    }

    /// The faces whose corners are not counterclockwise, by positions in double-double precision.
    pub fn flipped(&self) -> Vec<FaceId> {
        let mesh = &self.cover.mesh;
        let mut kept = vec![false; mesh.n_faces()];
        parallel::fill(&mut kept, |f| {
            let f = FaceId::from(f);
            let corners = self.face(f);
            f64::from(determinant(corners.map(|corner| seen_from(&corners[0], &corner)))) > 0.0
        });
        mesh.faces().filter(|f| !kept[f.index()]).collect()
    }
}

/// The point of one frame in the coordinates of another one (`home`). At the distance d from the origin of H² the rounding error grows by
/// the factor e^d; if the coordinates of the point itself were carried back, it would grow by e^{2d}.
pub(super) fn seen_from(home: &Motion<DoubleDouble>, frame: &Motion<DoubleDouble>) -> PrecisePoint {
    home.inverse().compose(frame).origin()
}

/// `det(p, q, r)`: positive for a counterclockwise triangle.
pub(super) fn determinant([p, q, r]: [PrecisePoint; 3]) -> DoubleDouble {
    let minor = |i: usize, j: usize| q[i] * r[j] - q[j] * r[i];
    p[0] * minor(1, 2) + p[1] * minor(2, 0) + p[2] * minor(0, 1)
}

/// The vector of the geodesic from the origin to a point.
pub(super) fn logarithm(space: Space, [x, y, w]: PrecisePoint) -> [f64; 2] {
    let (x, y, w) = (f64::from(x), f64::from(y), f64::from(w));
    let far = x.hypot(y);
    let length = match space {
        Space::E2 => far,
        Space::H2 => far.asinh(),
        Space::S2 => far.atan2(w),
    };
    if far > 0.0 { [x, y].map(|c| c * (length / far)) } else { [0.0; 2] }
}

/// Number of steps to an axis: the first one leads there up to rounding.
const AXIS_STEPS: usize = 3;

/// The rotation about the origin that brings the x axis to a direction.
pub(super) fn turn_to(space: Space, [x, y]: [f64; 2]) -> Motion<DoubleDouble> {
    let half = 0.5 * y.atan2(x);
    Motion::rotation([half.cos(), half.sin()], space).precise()
}

/// The frame at a point whose x axis points to another one, and the distance between them.
pub(super) fn aimed(space: Space, [from, to]: [PrecisePoint; 2]) -> (Motion<DoubleDouble>, f64) {
    let frame = Motion::to_origin(space, from).inverse();
    let ahead = logarithm(space, frame.inverse().apply(to));
    (frame.compose(&turn_to(space, ahead)), ahead[0].hypot(ahead[1]))
}

/// The frame at the point of the axis of a translation of H² that is nearest to another frame, its x axis along the axis.
pub(super) fn on_axis(
    translation: &Motion<DoubleDouble>,
    near: &Motion<DoubleDouble>,
) -> Motion<DoubleDouble> {
    // Seen from a point at the distance d from the axis, Im a is ± sinh(d) sinh(l/2), and |b|² − (Im a)² is sinh²(l/2).
    let seen = |frame: &Motion<DoubleDouble>| {
        let seen = translation.conjugated_by(&frame.inverse()).positive();
        (f64::from(seen.a[1]), seen.b.map(f64::from))
    };
    let mut frame = *near;
    for _ in 0..AXIS_STEPS {
        let (turned, [x, y]) = seen(&frame);
        let size = x.hypot(y);
        let far = (turned / ((size - turned) * (size + turned)).max(f64::MIN_POSITIVE).sqrt()).asinh();
        let sideways = |by: f64| moved(&frame, [-by * y / size, by * x / size]);
        let both = [sideways(far), sideways(-far)];
        let off = both.map(|frame| seen(&frame).0.abs());
        frame = if off[0] <= off[1] { both[0] } else { both[1] };
    }
    frame.compose(&turn_to(frame.space, seen(&frame).1))
}

/// A frame after parallel transport along the geodesic of a vector in it.
pub(super) fn moved(frame: &Motion<DoubleDouble>, [x, y]: [f64; 2]) -> Motion<DoubleDouble> {
    let length = x.hypot(y);
    if length == 0.0 {
        return *frame;
    }
    let turn = turn_to(frame.space, [x, y]);
    let step = Motion::translation(length, frame.space).precise();
    frame.compose(&turn).compose(&step).compose(&turn.inverse()).normalised()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_carry_the_origin_to_their_points() {
        let far = [[0.6, 0.0, 0.8], [0.0, 0.6, -0.8], [0.0, 0.0, -1.0], [0.0, 0.0, 1.0]];
        for p in far {
            let q = PlacedMesh::frame(Space::S2, p).origin().map(f64::from);
            assert!((0..3).all(|k| (p[k] - q[k]).abs() < 1e-15), "{p:?} {q:?}");
        }
    }

    #[test]
    fn a_frame_moves_along_a_vector_and_sees_where_it_came_from_behind_it() {
        for space in [Space::E2, Space::H2, Space::S2] {
            let from = moved(&Motion::identity(space), [0.7, -0.4]);
            let to = moved(&from, [0.3, 0.2]);
            let [ahead, back] =
                [(from, to), (to, from)].map(|(a, b): (Motion<DoubleDouble>, Motion<DoubleDouble>)| {
                    logarithm(space, a.inverse().apply(b.origin()))
                });
            assert!((0..2).all(|k| (ahead[k] + back[k]).abs() < 1e-15), "{space:?}: {ahead:?} {back:?}");
            assert!((ahead[0] - 0.3).abs() < 1e-15 && (ahead[1] - 0.2).abs() < 1e-15);
        }
    }
}
