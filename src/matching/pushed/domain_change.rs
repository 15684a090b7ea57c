//! The change from one domain of the target to another: the source, which lies in the old domain, gets places in the new one, in the class
//! that pushing its landmarks to their partners determines.

use super::boundary::BoundaryPlacement;
use super::slits::{PointInFace, PushStart, PushedLandmark, Slits};
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::matching::cover::{LocatedVertex, PlacedMesh, UniversalCover, WalkSeed, located, moved};
use crate::matching::landmarks::{MarkedSurface, Marks};
use crate::mesh::{HalfedgeId, Mesh, PerHalfedge, PerVertex, VertexId};

/// Weight of a corner with which a point counts as that corner.
const AT_CORNER: f64 = 1.0 - 1e-9;
/// Largest distance from the identity of the product of the transformations around a face: rounding.
const CLOSED: f64 = 1e-6;
/// Distance from the identity below which a transformation counts as the identity: rounding.
const IDENTITY: f64 = 1e-12;

/// Source and target in the old domain.
#[derive(Clone, Copy)]
pub(crate) struct OldDomain<'a> {
    pub source: &'a PlacedMesh,
    pub target: &'a PlacedMesh,
    /// The start of the search for the source's vertices in the target.
    pub seed: WalkSeed,
}

/// The source as it lies in the old domain of the target, and the new domain.
pub(crate) struct DomainChange<'a> {
    /// The source in the old domain.
    source: &'a PlacedMesh,
    new: &'a PlacedMesh,
    marks: [&'a Marks; 2],
    /// Per vertex of the source its place in the old domain.
    found: Vec<LocatedVertex>,
    /// Per vertex of the source the number of its landmark.
    landmark: PerVertex<Option<u32>>,
    /// Per vertex a point strictly inside the face of its place.
    inside: Vec<PointInFace>,
    /// The places in the new domain of the vertices on the boundary.
    boundary: BoundaryPlacement,
    slits: Slits<'a>,
}

impl<'a> DomainChange<'a> {
    /// The change from the `old` domain to the `new` one. The variant selects the paths of the landmarks ([`Slits::new`]).
    ///
    /// # Errors
    /// Those of [`located`], [`Slits::new`] and [`BoundaryPlacement::new`].
    pub fn new(
        old: OldDomain<'a>,
        new: &'a PlacedMesh,
        sides: [MarkedSurface<'a>; 2],
        variant: u64,
        control: &Control,
    ) -> Result<DomainChange<'a>> {
        let OldDomain { source, target, seed } = old;
        let (mut found, _) = located(source, target, seed, control)?;
        let (mesh, marks) = (sides[0].surface.mesh(), sides.map(|side| side.marks));
        let mut landmark = PerVertex::filled(mesh.n_vertices(), None);
        let mut pushes = Vec::with_capacity(marks[0].landmarks.len());
        for (k, (&from, &to)) in marks[0].landmarks.iter().zip(&marks[1].landmarks).enumerate() {
            landmark[from] = Some(k as u32);
            let place = found[from.index()].place;
            let corners = new.cover.mesh.face_halfedges(place.face);
            let there =
                (0..3).find(|&c| place.weights[c] > AT_CORNER && new.cover.mesh.origin(corners[c]) == to);
            let start = match there {
                Some(c) => PushStart::AtPartner(corners[c]),
                None => PushStart::AtPoint(PointInFace::new(target, place.face, place.weights)),
            };
            pushes.push(PushedLandmark {
                start,
                to,
                name: format!("landmark {k} (vertices {from} and {to})"),
            });
        }
        let slits = Slits::new([target, new], &pushes, &marks[1].loops, variant, control)?;
        let boundary = BoundaryPlacement::new([target, new], sides, &mut found, &slits)?;
        let inside = found.iter().map(|f| PointInFace::new(target, f.place.face, f.place.weights)).collect();
        Ok(DomainChange { source, new, marks, found, landmark, inside, boundary, slits })
    }

    /// The source in the new domain, and the starts of searches in both directions.
    ///
    /// # Errors
    /// [`Error::Matching`] if the sides of a face do not close in the new domain or a line in the old one is lost.
    pub fn image(&self) -> Result<(PlacedMesh, [WalkSeed; 2])> {
        let mesh = &self.source.cover.mesh;
        let space = self.new.cover.space;
        let mut along = PerHalfedge::filled(mesh.n_halfedges(), Motion::identity(space));
        for e in mesh.edges() {
            let h = e.halfedge();
            along[h] = self.along(h)?;
            along[h.twin()] = along[h].inverse();
        }
        let at = self.places();
        let first = |marks: &Marks| marks.landmarks.first().or(marks.corners.first()).copied();
        let (Some(first), Some(to)) = (first(self.marks[0]), first(self.marks[1])) else {
            return Err(Error::Matching("no landmark to start from".into()));
        };
        let start = mesh.fan(first)[0];
        let corners = self.corners(mesh, &along, start, &at)?;
        let across = |h: HalfedgeId| {
            let origin = mesh.origin(h);
            // Seen from a landmark the surface around it is determined only up to a turn: seen from the other end it is determined.
            let is_turned = self.landmark[origin].is_some();
            let (own, other) = if is_turned { (mesh.next(h), h.twin()) } else { (h, mesh.next(h.twin())) };
            if mesh.is_outside(h.twin()) {
                return None;
            }
            let motion = corners[own].compose(&corners[other].inverse()).normalised();
            (motion.distance_from_identity() > IDENTITY).then_some(motion)
        };
        let cover = UniversalCover::new(mesh, space, across, &[start])?;
        let at = PerVertex::from_fn(mesh.n_vertices(), |v: VertexId| {
            corners[cover.own(v)].compose(&at[v]).normalised()
        });
        let seeds =
            [WalkSeed { vertex: first, near: self.new.cover.own(to) }, WalkSeed { vertex: to, near: start }];
        Ok((PlacedMesh { cover, at }, seeds))
    }

    /// The transformation of the new domain along a half-edge, from the place of its origin to that of its tip.
    fn along(&self, h: HalfedgeId) -> Result<Motion<DoubleDouble>> {
        let cover = &self.source.cover;
        let [u, w] = [cover.mesh.origin(h), cover.mesh.tip(h)];
        let reverse = self.landmark[w].is_some();
        let (from, to, along) =
            if reverse { (w, u, cover.along(h).map(|m| m.inverse())) } else { (u, w, cover.along(h)) };
        // From the place of the one to that of the other in the opened old domain.
        let copy = self.found[from.index()].copy;
        let deck = along.map_or(copy, |along| copy.compose(&along));
        let deck = deck.compose(&self.found[to.index()].copy.inverse()).normalised();
        let end = deck.apply(self.inside[to.index()].point);
        let motion = match self.landmark[from] {
            Some(k) => self.slits.landmark_to(k as usize, end)?,
            None => {
                let motion = self.slits.between(self.inside[from.index()], end)?;
                match self.boundary.shift(from) {
                    Some(shift) => shift.inverse().compose(&motion),
                    None => motion,
                }
            }
        };
        let motion = match self.boundary.shift(to) {
            Some(shift) => motion.compose(shift),
            None => motion,
        };
        Ok(if reverse { motion.inverse() } else { motion })
    }

    /// Frames at the places of the vertices in the opened new domain, at the same barycentric coordinates as in the old one.
    fn places(&self) -> PerVertex<Motion<DoubleDouble>> {
        let mut at = PerVertex::from_fn(self.found.len(), |v: VertexId| {
            let place = self.found[v.index()].place;
            let corners = self.new.corners(place.face).map(|p| p.map(f64::from));
            let [x, y, w] = [0, 1, 2].map(|i| (0..3).map(|k| place.weights[k] * corners[k][i]).sum::<f64>());
            let size = match self.new.cover.space {
                Space::H2 => ((w - x) * (w + x) - y * y).max(f64::MIN_POSITIVE).sqrt(),
                _ => w,
            };
            PlacedMesh::frame(self.new.cover.space, [x / size, y / size, w / size])
        });
        for (&from, &to) in self.marks[0].landmarks.iter().zip(&self.marks[1].landmarks) {
            at[from] = self.new.at[to];
        }
        for place in &self.boundary.places {
            at[place.vertex] = moved(&self.new.at[place.before], [place.distance, 0.0]);
        }
        at
    }

    /// Per half-edge of a face the transformation from the place of its origin to the corner there, as the source is opened: face by face,
    /// each seen from one of its corners that is no landmark. In the face of `start` the landmark at its origin lies at its place.
    fn corners(
        &self,
        mesh: &Mesh,
        along: &PerHalfedge<Motion<DoubleDouble>>,
        start: HalfedgeId,
        at: &PerVertex<Motion<DoubleDouble>>,
    ) -> Result<PerHalfedge<Motion<DoubleDouble>>> {
        let space = self.new.cover.space;
        let mut corners = PerHalfedge::filled(mesh.n_halfedges(), Motion::identity(space));
        for f in mesh.faces() {
            let sides = mesh.face_halfedges(f);
            let is_free = |h: &HalfedgeId| self.landmark[mesh.origin(*h)].is_none();
            let Some(base) = sides.iter().position(is_free) else {
                return Err(Error::Matching(format!("face {f} of the source has three landmarks")));
            };
            let [a, b, c] = [0, 1, 2].map(|k| sides[(base + k) % 3]);
            let (to_b, to_c) = (along[a], along[c].inverse());
            let closed = to_b.compose(&along[b]);
            // Landmarks stay where they are when the surface is turned about them.
            let tip = at[mesh.origin(c)].origin();
            let [p, q] = [closed.apply(tip), to_c.apply(tip)]
                .map(|p| at[mesh.origin(a)].inverse().apply(p).map(f64::from));
            let off = (0..2).map(|k| (p[k] - q[k]).abs() / p[2].abs().max(1.0)).fold(0.0, f64::max);
            if self.landmark[mesh.origin(b)].is_none() && (off.is_nan() || off > CLOSED) {
                return Err(Error::Matching(format!(
                    "the sides of face {f} of the source do not close in the target's domain (by {off:.1e}): the landmarks lie too close together"
                )));
            }
            (corners[b], corners[c]) = (to_b, to_c);
            if sides.contains(&start) {
                let back = corners[start].inverse();
                sides.into_iter().for_each(|h| corners[h] = back.compose(&corners[h]));
            }
        }
        Ok(corners)
    }
}
