//! A closed surface with one vertex, the puncture, sent to infinity; its star, and the bounds on u that the star sets.
//!
//! ```text
//!        ∞           ∞ has u = 0, and with it a horocycle. The arc h from ∞ to j has length √(2 η_h e^{u_j}) ≥ 1: no horocycle may reach
//!      / | \         into that of ∞, so u_j ≥ −log(2 η_h), the *bound*. The arcs of length 1 are the star, its link bounds the
//!     i——j——m        planar part, with all other vertices. Beyond a link edge of length c lies a triangle with sides a, b, c; the arc
//!      \ | /         across it to its third corner k has length (a + b)/c (Ptolemy), so it has to be flipped
//!        k           into the star, and u_k be raised to its bound, where c ≥ a + b: where the triangle breaks.
//! ```
//!
//! The bound is the Delaunay condition with the horocycle of ∞ as one of the circles: the triangulation at given u is its one.

use crate::error::{Error, Result};
use crate::geometry::conformal::{Edge, Vertex, differences, edge, in_one_unit};
use crate::geometry::scaled::scaled;
use crate::geometry::triangle::angles_from;
use crate::geometry::weights::weights;
use crate::geometry::{DoubleDouble, Space};
use crate::mesh::{EdgeId, FaceId, Flip, HalfedgeId, Mesh, NormalCoordinates, PerEdge, PerVertex, VertexId};
use crate::metric::Metric;
use crate::metric::delaunay::ClassFlips;
use crate::parallel;
use std::f64::consts::PI;

/// A vertex is above its bound if its u exceeds the bound by more than this, which is far above the rounding of u and η.
const OFF_BOUND: f64 = 1e-12;
/// Largest number of flips per edge. Surfaces need less than one; rounding could make a sequence of flips repeat.
const MOST_FLIPS_PER_EDGE: usize = 100;
/// Rounding of η (of relative size ε) changes an angle π − φ by a few ε/φ. An edge is not flipped where the angles opposite it exceed π
/// by less than this multiple of ε/φ.
const ANGLE_ROUNDINGS: f64 = 32.0;
/// Radians. An edge is not flipped if the angles exceed π by less than this, which bounds the rounding at any φ.
const LEAST_EXCESS: f64 = 1e-12;
/// Radians. A polyhedron whose dihedral angles are all this close to 0 and π counts as flat. If they are within δ, rounding makes |K| of
/// the spherical metric up to 6e-15/δ (measured), which is above the default tolerance of 1e-10 at this δ.
pub(super) const FLAT_POLYHEDRON: f64 = 5e-5;
/// Radians. If no polyhedron is found on a surface this close to a flat one, the error names flatness as the reason.
pub(super) const NEARLY_FLAT: f64 = 1e-2;

/// A punctured surface in E²: vertex scaling, except that some vertices may be circles (ε = 1) whose edges to points have η ≥ 0.
#[derive(Debug, Clone)]
pub(super) struct PuncturedSurface {
    pub mesh: Mesh,
    /// u is 0 at the puncture.
    pub metric: Metric,
    /// The puncture, ∞.
    pub at: VertexId,
    /// Sets of curves that record every flip.
    pub followed: Vec<NormalCoordinates>,
    /// Flips so far.
    pub flips: usize,
}

impl PuncturedSurface {
    /// The arcs from the puncture, clockwise.
    pub fn star(&self) -> Vec<HalfedgeId> {
        self.mesh.outgoing(self.at).collect()
    }

    /// The link edge of the face left of an arc.
    pub fn link(&self, arc: HalfedgeId) -> HalfedgeId {
        self.mesh.next(arc)
    }

    /// The edges of the star and of its link.
    pub fn rim(&self) -> Vec<EdgeId> {
        self.star().into_iter().flat_map(|arc| [arc.edge(), self.link(arc).edge()]).collect()
    }

    /// Least u that the tip of a half-edge may have if its origin is the puncture.
    pub fn bound(&self, arc: HalfedgeId) -> f64 {
        -(2.0 * self.metric.eta[arc.edge()].high).ln()
    }

    /// Length of an edge; 0 if it has no real one.
    pub fn length(&self, h: HalfedgeId) -> f64 {
        let [a, b] = self.mesh.ends(h.edge()).map(|v| self.metric.vertex(v));
        edge(Space::E2, a, b, self.metric.eta[h.edge()]).map_or(0.0, |edge| edge.length(Space::E2))
    }

    /// A u of the puncture at which arcs are so long that the star's faces are triangles too.
    pub fn closing_u(&self) -> f64 {
        let longest = self.star().iter().map(|&arc| self.length(self.link(arc))).fold(1.0, f64::max);
        2.0 * (2.0 * longest).ln()
    }

    /// The metric with that u.
    pub fn closed(&self) -> Metric {
        let mut metric = self.metric.clone();
        (metric.u[self.at], metric.u_low[self.at]) = (self.closing_u(), 0.0);
        metric
    }

    /// True if the face of a half-edge belongs to the star.
    pub fn in_star(&self, h: HalfedgeId) -> bool {
        [h, self.mesh.next(h), self.mesh.prev(h)].iter().any(|&h| self.mesh.origin(h) == self.at)
    }

    /// Half-perimeter differences of a face, from u in double-double precision. Errors: [`Error::EdgeWeight`] at an edge whose length is
    /// beyond the range of f64.
    fn differences(&self, f: FaceId) -> Result<[f64; 3]> {
        let (corners, edges, unit) = self.parts(f)?;
        Ok(differences(corners, edges).map(|r| scaled(r, unit)))
    }

    /// The corners of a face and its sides in one unit of length, and the exponent of that.
    fn parts(&self, f: FaceId) -> Result<([Vertex; 3], [Edge; 3], i32)> {
        let mut corners = self.mesh.face_vertices(f).map(|v| self.metric.vertex(v));
        let sides = self.mesh.opposite_edges(f);
        let side = |k: usize| {
            let (e, need) = (sides[k], "one that gives the edge a length in floating-point range at this u");
            let eta = self.metric.eta[e];
            let made = edge(Space::E2, corners[(k + 1) % 3], corners[(k + 2) % 3], eta);
            made.ok_or(Error::EdgeWeight { edge: e.index(), eta: eta.high, need })
        };
        let mut edges = [side(0)?, side(1)?, side(2)?];
        let unit = in_one_unit(&mut corners, &mut edges);
        Ok((corners, edges, unit))
    }

    /// The face of a half-edge with its corner there. Errors: [`Error::Connectivity`] outside the surface, which is closed.
    fn corner(&self, h: HalfedgeId) -> Result<(FaceId, usize)> {
        let message = "has no face, on a surface that should be closed";
        self.mesh.corner(h).ok_or(Error::connectivity("half-edge", h.index(), message))
    }

    /// Angle of the planar part in the corner that is `turn` half-edges after `h` in its face; 0 in the star, which is no part of it.
    fn angle(&self, h: HalfedgeId, turn: usize) -> Result<f64> {
        if self.in_star(h) {
            return Ok(0.0);
        }
        let (f, corner) = self.corner(h)?;
        Ok(angles_from(Space::E2, self.differences(f)?).at[(corner + turn) % 3])
    }

    /// The angles under which the circle of a face, which is orthogonal to those of its corners, meets its sides; if no corner is a circle,
    /// these are the angles of the face. A side is Delaunay if those of its two faces add up to π at most.
    fn side_angles(&self, f: FaceId) -> Result<[f64; 3]> {
        let (corners, edges, _) = self.parts(f)?;
        let r = differences(corners, edges);
        if corners.iter().all(|v| v.epsilon == 0.0) {
            return Ok(angles_from(Space::E2, r).at);
        }
        let eta = self.mesh.opposite_edges(f).map(|e| self.metric.eta[e].high);
        let cotangents = weights(Space::E2, r, edges.map(|e| e.q2), corners, eta).map(|w| 2.0 * w);
        Ok(cotangents.map(|x| 1f64.atan2(x)))
    }

    /// Per edge the angles of the planar part opposite it ([`PuncturedSurface::side_angles`]); 0 in the star.
    fn opposite(&self) -> Result<PerEdge<[f64; 2]>> {
        let mut found = vec![Ok([0.0; 3]); self.mesh.n_faces()];
        parallel::fill(&mut found, |f| {
            let f = FaceId::from(f);
            if self.in_star(self.mesh.face_halfedge(f)) {
                return Ok([0.0; 3]);
            }
            self.side_angles(f)
        });
        let at = found.into_iter().collect::<Result<Vec<_>>>()?;
        let angle = |h: HalfedgeId| {
            let (f, corner) = self.corner(h)?;
            Ok(at[f.index()][(corner + 2) % 3])
        };
        let both = |e: EdgeId| Ok([angle(e.halfedge())?, angle(e.halfedge().twin())?]);
        Ok(self.mesh.edges().map(both).collect::<Result<Vec<_>>>()?.into())
    }

    /// Per edge, the excess over π of the angles opposite it; it is Delaunay if that is not positive.
    pub fn excess(&self) -> Result<PerEdge<f64>> {
        Ok(self.opposite()?.iter().map(|[a, b]| a + b - PI).collect::<Vec<_>>().into())
    }

    /// Turning of the link at the tip of each arc of the star: π − the angle inside. It adds up to 2π.
    pub fn turning(&self) -> Result<Vec<f64>> {
        let inside = |arc: HalfedgeId| {
            let first = self.mesh.next(self.link(arc).twin());
            let around = std::iter::successors(Some(first), |out| Some(self.mesh.next(out.twin())));
            let planar = around.take_while(|&out| self.mesh.tip(out) != self.at);
            planar.map(|out| self.angle(out, 0)).sum::<Result<f64>>()
        };
        self.star().into_iter().map(|arc| Ok(PI - inside(arc)?)).collect()
    }

    /// True if all vertices but the puncture lie on a line of the plane, and thus all on one circle of the sphere, up to the angle `within`:
    /// planar angles are 0 or π, they add up to 2π inside, and the outline, which runs along the line and back, nowhere turns the wrong way.
    pub fn is_flat(&self, within: f64) -> Result<bool> {
        let mut around = PerVertex::filled(self.mesh.n_vertices(), 0.0);
        for h in self.mesh.halfedges().filter(|&h| !self.in_star(h)) {
            let angle = self.angle(h, 0)?;
            if angle.min(PI - angle) > within {
                return Ok(false);
            }
            around[self.mesh.origin(h)] += angle;
        }
        // A vertex j between two arcs from the puncture to it is an end of the line.
        let mut outside = PerVertex::filled(self.mesh.n_vertices(), false);
        for j in self.star().into_iter().map(|arc| self.mesh.tip(arc)) {
            (around[j], outside[j]) = (around[j] + PI, true);
        }
        let fits = |v: VertexId| match around[v] - 2.0 * PI {
            off if outside[v] => off <= within,
            off => off.abs() <= within,
        };
        Ok(self.mesh.vertices().all(|v| v == self.at || fits(v)))
    }

    /// Flip an edge inside the class.
    pub fn flip(&mut self, e: EdgeId) -> bool {
        let followed = &mut self.followed;
        let mut record = |mesh: &Mesh, flip: Flip<DoubleDouble>| {
            followed.iter_mut().for_each(|normal| normal.record(mesh, flip.edge))
        };
        let flipped =
            ClassFlips { mesh: &mut self.mesh, metric: &mut self.metric, record: &mut record }.flip(e);
        self.flips += usize::from(flipped);
        flipped
    }

    /// Flip until the star is that of u: vertices above their bound leave the link, those that violate it enter, and the u of the link is
    /// set to its bounds. `slivers`: edges of slivers are flipped too. Returns true if anything was flipped. Errors: flips that do not end.
    pub fn enter(&mut self, slivers: bool) -> Result<bool> {
        let before = self.flips;
        loop {
            let last = self.flips;
            for arc in self.star() {
                let j = self.mesh.tip(arc);
                if self.mesh.origin(arc) == self.at
                    && (j == self.at || self.metric.u[j] > self.bound(arc) + OFF_BOUND)
                {
                    self.flip(arc.edge());
                }
            }
            for arc in self.star() {
                let edge = self.link(arc);
                let beyond = edge.twin();
                let k = self.mesh.origin(self.mesh.prev(beyond));
                if k != self.at && self.slack(beyond)? <= 0.0 && self.flip(edge.edge()) {
                    self.metric.u[k] = self.metric.u[k].max(self.bound(edge));
                    self.metric.u_low[k] = 0.0;
                }
            }
            if slivers {
                self.flip_slivers()?;
            }
            if self.flips == last {
                break;
            }
            if self.flips - before > MOST_FLIPS_PER_EDGE * self.mesh.n_edges() {
                return Err(Error::connectivity(
                    "vertex",
                    self.at.index(),
                    "flips around a puncture do not end",
                ));
            }
        }
        for arc in self.star() {
            let j = self.mesh.tip(arc);
            (self.metric.u[j], self.metric.u_low[j]) = (self.bound(arc), 0.0);
        }
        Ok(self.flips > before)
    }

    /// Half of the excess of the other two sides over an edge, in its planar face, the one beyond the star.
    pub fn slack(&self, side: HalfedgeId) -> Result<f64> {
        let (f, corner) = self.corner(if self.in_star(side) { side.twin() } else { side })?;
        Ok(self.differences(f)?[(corner + 2) % 3])
    }

    /// Flip edges that are not Delaunay by more than rounding. The test of the Newton steps uses the cosines of the angles, which do not
    /// decide if one angle is π − φ and the other is about φ, with φ below 1e-6.
    fn flip_slivers(&mut self) -> Result<()> {
        let fails = |[a, b]: [f64; 2]| {
            let phi = (PI - a.max(b)).max(f64::EPSILON);
            a + b - PI > LEAST_EXCESS + ANGLE_ROUNDINGS * f64::EPSILON / phi
        };
        // Usually no edge fails, and one parallel test of all of them is enough.
        if !self.opposite()?.iter().any(|&angles| fails(angles)) {
            return Ok(());
        }
        for e in self.mesh.edges() {
            if fails([self.opposite_angle(e.halfedge())?, self.opposite_angle(e.halfedge().twin())?]) {
                self.flip(e);
            }
        }
        Ok(())
    }

    /// The angle of [`PuncturedSurface::opposite`] in the face of a half-edge.
    fn opposite_angle(&self, h: HalfedgeId) -> Result<f64> {
        if self.in_star(h) {
            return Ok(0.0);
        }
        let (f, corner) = self.corner(h)?;
        Ok(self.side_angles(f)?[(corner + 2) % 3])
    }

    /// Send another vertex v, no circle, to infinity, by the inversion at its place in the `plane`:
    /// `u_i − log(|z_i − z_v|² − ε_i e^{2 u_i})`, up to a constant.
    pub fn puncture(&mut self, v: VertexId, plane: &PerVertex<[f64; 2]>) {
        let u = self.seen_from(v, plane);
        (self.metric.u, self.at) = (u, v);
        self.metric.u_low = PerVertex::filled(self.mesh.n_vertices(), 0.0);
        for arc in self.star() {
            let j = self.mesh.tip(arc);
            self.metric.u[j] = self.bound(arc);
        }
    }

    /// u of the plane with v at infinity.
    pub fn seen_from(&self, v: VertexId, plane: &PerVertex<[f64; 2]>) -> PerVertex<f64> {
        let [x, y] = plane[v];
        PerVertex::from_fn(self.mesh.n_vertices(), |i| match i {
            i if v == self.at => self.metric.u[i],
            i if i == v => 0.0,
            i if i == self.at => self.metric.u[v],
            i => {
                let (distance, own) =
                    ((plane[i][0] - x).hypot(plane[i][1] - y), self.metric.vertex(i).radius);
                self.metric.u[i] + self.metric.u[v] - (distance - own).ln() - (distance + own).ln()
            }
        })
    }
}
