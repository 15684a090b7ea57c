//! Traces the edges of the source as straight lines through the target.

use super::super::cover::{PlacedMesh, PrecisePoint, determinant, logarithm};
use super::stand::{FaceView, SettledVertices, VertexPlace};
use crate::error::{Error, Result};
use crate::geometry::DoubleDouble;
use crate::mesh::{HalfedgeId, VertexId};

/// Largest number of faces that an edge crosses.
const MOST_FACES: usize = 1_000_000;
/// Distance from a corner below which the end of a line is at it, if the vertices are the same; other copies of the vertex are far away.
const AT_CORNER: f64 = 1e-6;
/// Largest number of turns around a vertex in the search for the face into which a line leaves: around a cone of large angle the plane goes
/// round several times.
const MOST_TURNS: usize = 16;

/// The crossing of an edge of the source with one of the target.
#[derive(Debug, Clone, Copy)]
pub(super) struct TracedCrossing {
    /// The half-edge that is crossed, from its left to its right.
    pub halfedge: HalfedgeId,
    /// Weight of the tip, along the source's half-edge 2e.
    pub along: f64,
    /// Weight of the tip, along the half-edge 2e that is crossed.
    pub across: DoubleDouble,
    /// Sum of the weights of the vectors of the target's edge over that of the source's.
    pub weight: f64,
}

/// The corner of the target in which an edge of the source leaves a common vertex: the half-edge there, and the direction in its frame.
pub(super) type Departure = Option<(HalfedgeId, [DoubleDouble; 2])>;

/// An edge of the source on the target.
#[derive(Debug, Clone)]
pub(super) enum TracedEdge {
    /// It is an edge of the target: this half-edge, in the direction of the source's half-edge 2e.
    Along(HalfedgeId),
    /// It runs through faces: its departures from the common vertices at its two ends, and the crossings between.
    Through([Departure; 2], Vec<TracedCrossing>),
}

/// The two ends of an edge, in the opened target.
#[derive(Clone, Copy)]
struct EdgeLine {
    near: HalfedgeId,
    ends: [PrecisePoint; 2],
}

/// The triangulations between which edges are traced.
pub(super) struct EdgeTracer<'a> {
    pub settled: &'a SettledVertices,
    pub target: &'a PlacedMesh,
}

/// The first step of a line into the target.
enum TraceStart {
    Along(HalfedgeId),
    /// The line ends in the first face, or at the corner of this half-edge of it.
    Done(Option<HalfedgeId>),
    /// The line leaves the first face through this side.
    Out(HalfedgeId),
}

impl EdgeTracer<'_> {
    /// The trace of an interior edge, from the origin of its half-edge 2e to the tip.
    ///
    /// # Errors
    /// [`Error::Matching`] if it does not end at the place of its vertex.
    pub fn path(&self, h: HalfedgeId) -> Result<TracedEdge> {
        let source = &self.settled.source;
        let [a, b] = [source.cover.mesh.origin(h), source.cover.mesh.tip(h)];
        let from = &self.settled.forward[a.index()];
        let tip = source.at[b].origin();
        let tip = source.cover.along(h).map_or(tip, |along| along.apply(tip));
        let mut line =
            EdgeLine { near: from.near, ends: [source.at[a].origin(), tip].map(|p| from.copy.apply(p)) };
        let mut leaving: [Departure; 2] = [None, None];
        let start = self.start(&mut line, [a, b], &mut leaving[0])?;
        let mut side = match start {
            TraceStart::Along(along) => return Ok(TracedEdge::Along(along)),
            TraceStart::Done(corner) => {
                leaving[1] = corner.map(|h| self.direction(&line, h, 0));
                return Ok(TracedEdge::Through(leaving, Vec::new()));
            }
            TraceStart::Out(side) => side,
        };
        let mut crossings = Vec::new();
        for _ in 0..MOST_FACES {
            let view = FaceView::new(self.target, side);
            if self.is_over(&line, b, side, &view)? {
                return Ok(TracedEdge::Through(leaving, crossings));
            }
            let mesh = &self.target.cover.mesh;
            if mesh.is_outside(side.twin()) {
                break;
            }
            crossings.push(crossing(&view, &line, side));
            line = self.across(&line, side);
            let [next, prev] = [mesh.next(line.near), mesh.prev(line.near)];
            if self.is_at(&line, b, prev) {
                leaving[1] = Some(self.direction(&line, prev, 0));
                return Ok(TracedEdge::Through(leaving, crossings));
            }
            side = if self.is_left(&line, prev) { next } else { prev };
        }
        Err(unclear(h))
    }

    /// The first step of a line from a to b.
    fn start(
        &self,
        line: &mut EdgeLine,
        [a, b]: [VertexId; 2],
        leaving: &mut Departure,
    ) -> Result<TraceStart> {
        let mesh = &self.target.cover.mesh;
        let [near, next, prev] = [line.near, mesh.next(line.near), mesh.prev(line.near)];
        let corner = [near, next, prev].into_iter().find(|&h| self.is_at(line, b, h));
        match self.settled.forward[a.index()].at {
            VertexPlace::Vertex(_) => self.leave(line, b, leaving),
            _ if corner.is_some() => Ok(TraceStart::Done(corner)),
            VertexPlace::Side(..) => Ok(TraceStart::Out(if self.is_left(line, prev) { next } else { prev })),
            VertexPlace::Inside(_) => {
                let left = [near, next, prev].map(|h| self.is_left(line, h));
                let out = (0..3).find(|&k| !left[k] && left[(k + 1) % 3]);
                out.map(|k| TraceStart::Out([near, next, prev][k])).ok_or_else(|| unclear(line.near))
            }
        }
    }

    /// The first step of a line from a common vertex: turns around the vertex to the face into which the line leads.
    fn leave(&self, line: &mut EdgeLine, b: VertexId, leaving: &mut Departure) -> Result<TraceStart> {
        let mesh = &self.target.cover.mesh;
        let degree = mesh.fan(mesh.origin(line.near)).len();
        // First turn clockwise to the boundary, if the vertex is on one.
        for _ in 0..degree {
            if !mesh.is_boundary_vertex(mesh.origin(line.near)) || mesh.is_outside(line.near.twin()) {
                break;
            }
            *line = self.across(line, line.near);
            line.near = mesh.next(line.near);
        }
        for _ in 0..MOST_TURNS * (degree + 1) {
            let [near, next, prev] = [line.near, mesh.next(line.near), mesh.prev(line.near)];
            if self.is_at(line, b, next) {
                return Ok(TraceStart::Along(near));
            }
            if !self.is_left(line, next) && self.is_left(line, prev) {
                // The second side of the face may be the line itself.
                if !self.is_at(line, b, prev) {
                    *leaving = Some(self.direction(line, near, 1));
                    return Ok(TraceStart::Out(next));
                }
            }
            if mesh.is_outside(prev.twin()) {
                break;
            }
            *line = self.across(line, prev);
        }
        Err(unclear(line.near))
    }

    /// True if the line ends in the face that it would leave through a side.
    fn is_over(&self, line: &EdgeLine, b: VertexId, side: HalfedgeId, view: &FaceView) -> Result<bool> {
        let mesh = &self.target.cover.mesh;
        let standing = &self.settled.forward[b.index()];
        let is_here = mesh.face(side) == mesh.face(standing.near);
        let end = view.home.apply(line.ends[1]);
        let is_beyond = || f64::from(determinant([view.corners[0], view.corners[1], end])) < 0.0;
        match standing.at {
            VertexPlace::Vertex(_) => Ok(false),
            VertexPlace::Side(..) => Ok(is_here && (side == standing.near || !is_beyond())),
            VertexPlace::Inside(_) if is_beyond() => Ok(false),
            VertexPlace::Inside(_) if is_here => Ok(true),
            VertexPlace::Inside(_) => Err(unclear(side)),
        }
    }

    fn across(&self, line: &EdgeLine, side: HalfedgeId) -> EdgeLine {
        let near = side.twin();
        match self.target.cover.across(side) {
            Some(across) => {
                let back = across.inverse();
                EdgeLine { near, ends: line.ends.map(|p| back.apply(p)) }
            }
            None => EdgeLine { near, ..*line },
        }
    }

    /// True if the corner of a half-edge of the face is to the left of the line, or on it.
    fn is_left(&self, line: &EdgeLine, h: HalfedgeId) -> bool {
        let home = self.target.frame_at(line.near).inverse();
        let [a, b] = line.ends.map(|p| home.apply(p));
        f64::from(determinant([a, b, home.apply(self.target.corner(h))])) >= 0.0
    }

    /// True if the line ends at the corner of a half-edge of the face, where the two triangulations have a common vertex.
    fn is_at(&self, line: &EdgeLine, b: VertexId, h: HalfedgeId) -> bool {
        let VertexPlace::Vertex(there) = self.settled.forward[b.index()].at else { return false };
        if self.target.cover.mesh.origin(h) != there {
            return false;
        }
        let [x, y] =
            logarithm(self.target.cover.space, self.target.frame_at(h).inverse().apply(line.ends[1]));
        x.hypot(y) < AT_CORNER
    }

    /// The corner of a half-edge of the face, and the direction from there to an end of the line.
    fn direction(&self, line: &EdgeLine, h: HalfedgeId, end: usize) -> (HalfedgeId, [DoubleDouble; 2]) {
        let [x, y, _] = self.target.frame_at(h).inverse().apply(line.ends[end]);
        (h, [x, y])
    }
}

/// The crossing of a line with the side through which it leaves a face, in the frame of the side's origin.
fn crossing(view: &FaceView, line: &EdgeLine, side: HalfedgeId) -> TracedCrossing {
    let [a, b] = line.ends.map(|p| view.home.apply(p));
    let [c, d, _] = view.corners;
    let zero = DoubleDouble::from(0.0);
    let positive = |x: DoubleDouble| if f64::from(x) > 0.0 { x } else { zero };
    // (a × b) × (c × d) = |c d a| b − |c d b| a = |a b d| c − |a b c| d, the point as a vector.
    let (from, to) = (positive(-determinant([c, d, b])), positive(determinant([c, d, a])));
    let (first, second) = (positive(determinant([a, b, d])), positive(-determinant([a, b, c])));
    let share = |x: DoubleDouble, y: DoubleDouble| {
        let sum = x + y;
        if f64::from(sum) > 0.0 { y / sum } else { DoubleDouble::from(0.5) }
    };
    let across = if side.0 & 1 == 0 { share(first, second) } else { share(second, first) };
    let weight = f64::from(first + second) / f64::from(from + to);
    TracedCrossing {
        halfedge: side,
        along: f64::from(share(from, to)),
        across,
        weight: if weight > 0.0 && weight.is_finite() { weight } else { 1.0 },
    }
}

fn unclear(h: HalfedgeId) -> Error {
    Error::Matching(format!(
        "edge {} of the source is not clear enough on the target for an overlay",
        h.edge()
    ))
}
