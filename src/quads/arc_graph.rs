//! The bidirected graph of a T-mesh: its nodes are the two directions of each rectangle, and every arc joins the two that lie beside it.
//!
//! A state is a direction of a rectangle and the sign of what its first side has more than the opposite one; a step changes an arc by 1, which
//! removes the excess of one state and leaves that of another.

use super::t_mesh::{HalfArc, TMesh};
use std::collections::VecDeque;

/// The end of walks at the boundary.
pub(super) const OUTSIDE: usize = 0;

/// A step of a walk: this half-arc's arc changes by this much.
pub(super) type WalkStep = (HalfArc, i64);

/// The graph.
#[derive(Debug, Clone)]
pub(super) struct ArcGraph {
    /// Per half-arc the rectangle and direction to its left, 2r + d, and the sign with which its side counts.
    pub beside: Vec<Option<(usize, i64)>>,
    /// Per rectangle and direction the half-arcs of both sides.
    pub sides: Vec<Vec<HalfArc>>,
    /// Per state the steps that remove its excess.
    pub steps: Vec<Vec<WalkStep>>,
}

impl ArcGraph {
    pub fn new(t_mesh: &TMesh) -> ArcGraph {
        let mut beside = vec![None; 2 * t_mesh.arcs.len()];
        let mut sides = vec![Vec::new(); 2 * t_mesh.rectangles.len()];
        for (r, rectangle) in t_mesh.rectangles.iter().enumerate() {
            for (k, side) in rectangle.sides.iter().enumerate() {
                let u = 2 * r + k % 2;
                for &h in side {
                    beside[h] = Some((u, if k < 2 { 1 } else { -1 }));
                    sides[u].push(h);
                }
            }
        }
        let mut steps = vec![Vec::new(); 2 * sides.len() + 1];
        for (h, at) in beside.iter().enumerate() {
            match *at {
                Some((u, sign)) => {
                    for s in [1, -1] {
                        steps[ArcGraph::state(u, s)].push((h, -s * sign));
                    }
                }
                None => steps[OUTSIDE].extend([(h, 1), (h, -1)]),
            }
        }
        ArcGraph { beside, sides, steps }
    }

    /// The state in which a rectangle's direction has an excess of this sign.
    pub fn state(u: usize, sign: i64) -> usize {
        1 + 2 * u + usize::from(sign < 0)
    }

    /// The rectangle and direction of a state that is not outside, and its sign.
    pub fn excess_of(state: usize) -> (usize, i64) {
        ((state - 1) / 2, if state % 2 == 1 { 1 } else { -1 })
    }

    /// The state before a step.
    pub fn before(&self, step: WalkStep) -> usize {
        let (h, change) = step;
        self.beside[h].map_or(OUTSIDE, |(u, sign)| ArcGraph::state(u, -change * sign))
    }

    /// The state after a step.
    pub fn after(&self, step: WalkStep) -> usize {
        let (h, change) = step;
        self.beside[h ^ 1].map_or(OUTSIDE, |(v, sign)| ArcGraph::state(v, change * sign))
    }

    /// Half-arcs of a closed walk across rectangles through an arc, or of one between two places of the boundary.
    pub fn strip(&self, arc: usize) -> Option<Vec<HalfArc>> {
        let forth = self.shortest_crossing(2 * arc, Some(2 * arc))?;
        if forth.first() == forth.last() && forth.len() > 1 {
            return Some(forth[1..].to_vec());
        }
        let back = self.shortest_crossing(2 * arc + 1, None)?;
        Some(forth.into_iter().chain(back.into_iter().skip(1)).collect())
    }

    /// The shortest walk across rectangles that enters the one to the left of a half-arc: to the boundary or to a half-arc, which it crosses
    /// at its end as it did at first.
    fn shortest_crossing(&self, first: HalfArc, goal: Option<HalfArc>) -> Option<Vec<HalfArc>> {
        let mut came: Vec<Option<HalfArc>> = vec![None; self.beside.len()];
        let mut waiting = VecDeque::from([first]);
        let trace = |came: &[Option<HalfArc>], last: HalfArc| {
            let mut walk = vec![last];
            let mut at = last;
            while let Some(before) = came[at] {
                walk.push(before);
                if before == first {
                    break;
                }
                at = before;
            }
            walk.reverse();
            walk
        };
        while let Some(h) = waiting.pop_front() {
            let Some((u, sign)) = self.beside[h] else { return Some(trace(&came, h)) };
            for &g in &self.sides[u] {
                // The walk leaves across the opposite side, into the rectangle to the left of the other half-arc.
                let next = g ^ 1;
                if self.beside[g].is_none_or(|(_, other)| other == sign) || came[next].is_some() {
                    continue;
                }
                came[next] = Some(h);
                if Some(next) == goal {
                    return Some(trace(&came, next));
                }
                if next != first {
                    waiting.push_back(next);
                }
            }
        }
        None
    }
}
