//! Edges of one triangulation as straight lines through another one.

use super::super::cover::{PlacedMesh, PrecisePoint, determinant, logarithm};
use super::stand::{At, Settled, View};
use crate::error::{Error, Result};
use crate::geometry::DoubleDouble;
use crate::mesh::{HalfedgeId, VertexId};

/// Faces that an edge crosses at most.
const MOST_FACES: usize = 1_000_000;
/// Distance from a corner below which the end of a line is at it, where the vertices are the same: other copies of the vertex are far away.
const AT_CORNER: f64 = 1e-6;
/// Turns around a vertex in which the face is looked for into which a line leaves: around a cone the plane goes round several times.
const MOST_TURNS: usize = 16;

/// Where an edge of the source crosses one of the target.
#[derive(Debug, Clone, Copy)]
pub(super) struct Crossing {
    /// The half-edge that is crossed, from its left to its right.
    pub halfedge: HalfedgeId,
    /// Weight of the tip, along the source's half-edge 2e.
    pub along: f64,
    /// Weight of the tip, along the half-edge 2e that is crossed.
    pub across: DoubleDouble,
    /// Sum of the weights of the vectors of the target's edge over that of the source's.
    pub weight: f64,
}

/// Which corner of the target an edge of the source leaves a common vertex in: the half-edge there, and the direction, in its frame.
pub(super) type Leaving = Option<(HalfedgeId, [DoubleDouble; 2])>;

/// An edge of the source on the target.
#[derive(Debug, Clone)]
pub(super) enum Path {
    /// It is an edge of the target: this half-edge, in the direction of its own half-edge 2e.
    Along(HalfedgeId),
    /// At its two ends, and between.
    Through([Leaving; 2], Vec<Crossing>),
}

/// The two ends of an edge, in the opened target.
#[derive(Clone, Copy)]
struct Line {
    near: HalfedgeId,
    ends: [PrecisePoint; 2],
}

pub(super) struct Tracer<'a> {
    pub settled: &'a Settled,
    pub target: &'a PlacedMesh,
}

/// The way into the target.
enum Start {
    Along(HalfedgeId),
    /// At the end already: inside the face, or at the corner of a half-edge.
    Done(Option<HalfedgeId>),
    /// Out of the first face through this side.
    Out(HalfedgeId),
}

impl Tracer<'_> {
    /// An edge inside the surface, from the origin of its half-edge 2e to the tip.
    ///
    /// # Errors
    /// [`Error::Matching`] where it does not end where its vertex stands.
    pub fn path(&self, h: HalfedgeId) -> Result<Path> {
        let source = &self.settled.source;
        let [a, b] = [source.cover.mesh.origin(h), source.cover.mesh.tip(h)];
        let from = &self.settled.forward[a.index()];
        let tip = source.at[b].origin();
        let tip = source.cover.along(h).map_or(tip, |along| along.apply(tip));
        let mut line =
            Line { near: from.near, ends: [source.at[a].origin(), tip].map(|p| from.copy.apply(p)) };
        let mut leaving: [Leaving; 2] = [None, None];
        let start = self.start(&mut line, [a, b], &mut leaving[0])?;
        let mut side = match start {
            Start::Along(along) => return Ok(Path::Along(along)),
            Start::Done(corner) => {
                leaving[1] = corner.map(|h| self.direction(&line, h, 0));
                return Ok(Path::Through(leaving, Vec::new()));
            }
            Start::Out(side) => side,
        };
        let mut crossings = Vec::new();
        for _ in 0..MOST_FACES {
            let view = View::new(self.target, side);
            if self.is_over(&line, b, side, &view)? {
                return Ok(Path::Through(leaving, crossings));
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
                return Ok(Path::Through(leaving, crossings));
            }
            side = if self.is_left(&line, prev) { next } else { prev };
        }
        Err(unclear(h))
    }

    /// The first face, and where the line leaves it.
    fn start(&self, line: &mut Line, [a, b]: [VertexId; 2], leaving: &mut Leaving) -> Result<Start> {
        let mesh = &self.target.cover.mesh;
        let [near, next, prev] = [line.near, mesh.next(line.near), mesh.prev(line.near)];
        let corner = [near, next, prev].into_iter().find(|&h| self.is_at(line, b, h));
        match self.settled.forward[a.index()].at {
            At::Vertex(_) => self.leave(line, b, leaving),
            _ if corner.is_some() => Ok(Start::Done(corner)),
            At::Side(..) => Ok(Start::Out(if self.is_left(line, prev) { next } else { prev })),
            At::Inside(_) => {
                let left = [near, next, prev].map(|h| self.is_left(line, h));
                let out = (0..3).find(|&k| !left[k] && left[(k + 1) % 3]);
                out.map(|k| Start::Out([near, next, prev][k])).ok_or_else(|| unclear(line.near))
            }
        }
    }

    /// Out of a common vertex: the face around it into which the line leads.
    fn leave(&self, line: &mut Line, b: VertexId, leaving: &mut Leaving) -> Result<Start> {
        let mesh = &self.target.cover.mesh;
        let degree = mesh.fan(mesh.origin(line.near)).len();
        // Clockwise to the boundary, if there is one.
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
                return Ok(Start::Along(near));
            }
            if !self.is_left(line, next) && self.is_left(line, prev) {
                // The second side of the face may be the line itself.
                if !self.is_at(line, b, prev) {
                    *leaving = Some(self.direction(line, near, 1));
                    return Ok(Start::Out(next));
                }
            }
            if mesh.is_outside(prev.twin()) {
                break;
            }
            *line = self.across(line, prev);
        }
        Err(unclear(line.near))
    }

    /// Whether the line ends in the face that it would leave through a side.
    fn is_over(&self, line: &Line, b: VertexId, side: HalfedgeId, view: &View) -> Result<bool> {
        let mesh = &self.target.cover.mesh;
        let standing = &self.settled.forward[b.index()];
        let is_here = mesh.face(side) == mesh.face(standing.near);
        let end = view.home.apply(line.ends[1]);
        let is_beyond = || f64::from(determinant([view.corners[0], view.corners[1], end])) < 0.0;
        match standing.at {
            At::Vertex(_) => Ok(false),
            At::Side(..) => Ok(is_here && (side == standing.near || !is_beyond())),
            At::Inside(_) if is_beyond() => Ok(false),
            At::Inside(_) if is_here => Ok(true),
            At::Inside(_) => Err(unclear(side)),
        }
    }

    fn across(&self, line: &Line, side: HalfedgeId) -> Line {
        let near = side.twin();
        match self.target.cover.across(side) {
            Some(across) => {
                let back = across.inverse();
                Line { near, ends: line.ends.map(|p| back.apply(p)) }
            }
            None => Line { near, ..*line },
        }
    }

    /// Whether the corner of a half-edge of the face is to the left of the line, or on it.
    fn is_left(&self, line: &Line, h: HalfedgeId) -> bool {
        let home = self.target.frame_at(line.near).inverse();
        let [a, b] = line.ends.map(|p| home.apply(p));
        f64::from(determinant([a, b, home.apply(self.target.corner(h))])) >= 0.0
    }

    /// Whether the line ends at the corner of a half-edge of the face, where the two triangulations have a common vertex.
    fn is_at(&self, line: &Line, b: VertexId, h: HalfedgeId) -> bool {
        let At::Vertex(there) = self.settled.forward[b.index()].at else { return false };
        if self.target.cover.mesh.origin(h) != there {
            return false;
        }
        let [x, y] =
            logarithm(self.target.cover.space, self.target.frame_at(h).inverse().apply(line.ends[1]));
        x.hypot(y) < AT_CORNER
    }

    /// The corner of a half-edge of the face, and the direction from there to an end of the line.
    fn direction(&self, line: &Line, h: HalfedgeId, end: usize) -> (HalfedgeId, [DoubleDouble; 2]) {
        let [x, y, _] = self.target.frame_at(h).inverse().apply(line.ends[end]);
        (h, [x, y])
    }
}

/// Where the line leaves a face through a side, which is seen from its origin.
fn crossing(view: &View, line: &Line, side: HalfedgeId) -> Crossing {
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
    Crossing {
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
