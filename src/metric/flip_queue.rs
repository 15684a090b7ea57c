//! The queue of edges that may have to be flipped, and the loop that flips them.

use crate::control::Control;
use crate::error::{Error, Result};
use crate::mesh::{EdgeId, FixedEdges, Flip, HalfedgeId, Mesh, PerEdge};
use crate::parallel;
use std::collections::VecDeque;

/// Edges that are looked at between two checks of the control: about 1 ms of work.
const EDGES_PER_STEP: usize = 4096;

/// Edges that may fail the Delaunay condition, first come first served.
#[derive(Debug, Clone)]
pub struct FlipQueue {
    waiting: VecDeque<EdgeId>,
    /// Per edge, true if it waits or must never wait.
    queued: PerEdge<bool>,
}

impl FlipQueue {
    /// An empty queue for a surface with this many edges. `fixed` edges never enter it, and so are never flipped.
    pub fn new(n_edges: usize, fixed: &FixedEdges) -> FlipQueue {
        FlipQueue { waiting: VecDeque::new(), queued: PerEdge::from_fn(n_edges, |e| fixed.contains(e)) }
    }

    /// Every edge of a surface but the `fixed` ones.
    pub fn all(mesh: &Mesh, fixed: &FixedEdges) -> FlipQueue {
        let mut queue = FlipQueue::new(mesh.n_edges(), fixed);
        mesh.edges().for_each(|e| queue.push(e));
        queue
    }

    /// The edges between two faces for which `holds`, asked in parallel, is true of the half-edge `2e`; `fixed` ones never.
    pub(super) fn where_holds(
        mesh: &Mesh,
        fixed: &FixedEdges,
        holds: impl Fn(HalfedgeId) -> bool + Sync,
    ) -> FlipQueue {
        let mut held = vec![false; mesh.n_edges()];
        parallel::fill(&mut held, |e| {
            let h = EdgeId::from(e).halfedge();
            between_faces(mesh, h) && holds(h)
        });
        let mut queue = FlipQueue::new(mesh.n_edges(), fixed);
        mesh.edges().filter(|e| held[e.index()]).for_each(|e| queue.push(e));
        queue
    }

    /// Let an edge wait, unless it does already or is fixed.
    pub fn push(&mut self, e: EdgeId) {
        if !std::mem::replace(&mut self.queued[e], true) {
            self.waiting.push_back(e);
        }
    }

    /// Drop the waiting edges for which `holds`, asked in parallel, is false of the half-edge `2e`. They may be pushed again.
    pub(super) fn keep_where(&mut self, holds: impl Fn(HalfedgeId) -> bool + Sync) {
        let waiting = std::mem::take(&mut self.waiting);
        let mut held = vec![false; waiting.len()];
        parallel::fill(&mut held, |k| holds(waiting[k].halfedge()));
        for (e, held) in waiting.into_iter().zip(held) {
            if held {
                self.waiting.push_back(e);
            } else {
                self.queued[e] = false;
            }
        }
    }

    /// True if no edge waits.
    pub fn is_empty(&self) -> bool {
        self.waiting.is_empty()
    }

    /// The edges that wait, in order.
    pub(super) fn into_vec(self) -> Vec<EdgeId> {
        self.waiting.into()
    }

    fn pop(&mut self) -> Option<EdgeId> {
        let e = self.waiting.pop_front()?;
        self.queued[e] = false;
        Some(e)
    }

    /// Flip edges until no edge waits, or `most` have been flipped. An edge that the flip of another may have made fail is looked at
    /// again. Returns the number of flips.
    ///
    /// # Errors
    /// [`Error::Cancelled`]; some flips are done then.
    pub(crate) fn flip_until_empty<T: Copy>(
        &mut self,
        most: usize,
        surface: &mut Flippable<'_, T, impl FnMut(&Mesh, &PerEdge<T>, HalfedgeId) -> Option<T>>,
        control: &Control,
    ) -> Result<usize> {
        let Flippable { mesh, values, decide, record } = surface;
        let (mut flips, mut looked_at) = (0, 0usize);
        while flips < most {
            let Some(edge) = self.pop() else { break };
            if looked_at.is_multiple_of(EDGES_PER_STEP) {
                control.check()?;
            }
            looked_at += 1;
            let h = edge.halfedge();
            if !between_faces(mesh, h) {
                continue;
            }
            let Some(value) = decide(mesh, values, h) else { continue };
            record(mesh, Flip { edge, value: values[edge] });
            let sides = mesh.quadrilateral(h);
            mesh.flip(edge);
            values[edge] = value;
            flips += 1;
            sides.into_iter().for_each(|side| self.push(side.edge()));
        }
        Ok(flips)
    }
}

/// A triangulation with a value per edge, and the rule by which its edges are flipped.
pub(crate) struct Flippable<'a, T, D> {
    pub mesh: &'a mut Mesh,
    /// Length or η.
    pub values: &'a mut PerEdge<T>,
    /// The value that the edge of a half-edge between two faces gets by its flip, or `None` where it is not to be flipped.
    pub decide: D,
    /// Called with each flip just before it is made.
    pub record: &'a mut dyn FnMut(&Mesh, Flip<T>),
}

/// Largest number of flips without progress: 100 per edge and a million.
///
/// Ordinary surfaces need less than one isometric flip per edge, and single cones on the corpus at most ten flips per edge inside the
/// class (200,000 flips on 20,000 edges). A million takes one or two seconds, and is more than it takes to unwind a torus of two
/// vertices that is sheared 100,000 times (400,000 flips), the thinnest that is accepted.
pub(crate) fn allowance(n_edges: usize) -> usize {
    100 * n_edges + 1_000_000
}

/// True if an edge lies between two different faces. No other edge has another diagonal.
pub(crate) fn between_faces(mesh: &Mesh, h: HalfedgeId) -> bool {
    let [f, g] = [h, h.twin()].map(|h| mesh.face(h));
    f.is_some() && g.is_some() && f != g
}

/// The error of flips that do not end.
pub(crate) fn endless(message: &'static str) -> Error {
    Error::Connectivity { element: "mesh", index: 0, message }
}
