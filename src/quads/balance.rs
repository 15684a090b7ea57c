//! The start of a quantisation: what opposite sides of rectangles differ by after rounding is removed along cheapest walks.

use super::arc_graph::{ArcGraph, OUTSIDE, WalkStep};
use super::quantisation::Quantisation;
use super::reached::Reached;
use crate::control::Control;
use crate::error::{Error, Result};
use std::collections::BinaryHeap;

/// The cost of a step below the least number while sides are made even, far above that of any other walk.
const BELOW_COST: f64 = 1e12;

impl Quantisation {
    /// Removes what opposite sides differ by, along cheapest walks. Arcs may fall below the least number where nothing else is possible, so
    /// that walks always exist.
    ///
    /// # Errors
    /// [`Error::Layout`] for a graph without them, which no T-mesh has; [`Error::Cancelled`].
    pub(super) fn balance(&mut self, control: &Control) -> Result<()> {
        // Searches from all excesses at once hide the walk from one to another behind those of the other; then each is tried alone.
        let mut only: Option<usize> = None;
        loop {
            control.check()?;
            let mut excess = self.excess();
            if excess.iter().all(|e| *e == 0) {
                return Ok(());
            }
            let sources: Vec<usize> = (0..excess.len()).filter(|&u| excess[u] != 0).collect();
            let walks = match only {
                Some(k) => self.cheapest_walks(&excess, &sources[k % sources.len()..][..1]),
                None => self.cheapest_walks(&excess, &sources),
            };
            let mut is_changed = vec![false; self.numbers.len()];
            let mut is_better = false;
            for walk in walks {
                let (Some(&first), Some(&last)) = (walk.first(), walk.last()) else { continue };
                let from = self.graph.beside[first.0];
                let to = self.graph.beside[last.0 ^ 1];
                let mut left = excess.clone();
                let mut apply = |end: Option<(usize, i64)>, change: i64| {
                    if let Some((u, sign)) = end {
                        left[u] += sign * change;
                    }
                };
                apply(from, first.1);
                apply(to, last.1);
                let is_less =
                    |end: Option<(usize, i64)>| end.is_none_or(|(u, _)| left[u].abs() < excess[u].abs());
                if walk.iter().any(|(h, _)| is_changed[h / 2]) || !is_less(from) || !is_less(to) {
                    continue;
                }
                for &(h, change) in &walk {
                    self.numbers[h / 2] += change;
                    is_changed[h / 2] = true;
                }
                excess = left;
                is_better = true;
            }
            only = match only {
                _ if is_better => None,
                None => Some(0),
                Some(k) if k + 1 < sources.len() => Some(k + 1),
                Some(_) => {
                    return Err(Error::Layout("opposite sides of rectangles cannot be made even".into()));
                }
            };
        }
    }

    /// Walks from excesses to those that they cancel or to the boundary, the cheapest first. Gains count as no cost.
    fn cheapest_walks(&self, excess: &[i64], sources: &[usize]) -> Vec<Vec<WalkStep>> {
        let n = self.graph.steps.len();
        let mut distance = vec![f64::INFINITY; n];
        let mut came: Vec<Option<(usize, WalkStep)>> = vec![None; n];
        let mut root = vec![usize::MAX; n];
        let mut waiting = BinaryHeap::new();
        let mut is_done = vec![false; n];
        for &u in sources {
            let state = ArcGraph::state(u, excess[u].signum());
            distance[state] = 0.0;
            root[state] = u;
            waiting.push(Reached(0.0, state));
        }
        let mut ends = Vec::new();
        while let Some(Reached(d, state)) = waiting.pop() {
            if std::mem::replace(&mut is_done[state], true) {
                continue;
            }
            let is_end = state == OUTSIDE || {
                let (u, s) = ArcGraph::excess_of(state);
                excess[u] * s < 0 && (root[state] != u || excess[u].abs() > 1)
            };
            if is_end && came[state].is_some() {
                ends.push(state);
                continue;
            }
            for &step in &self.graph.steps[state] {
                let arc = step.0 / 2;
                let falls_below = step.1 < 0 && self.numbers[arc] <= self.least[arc];
                let cost = if falls_below { BELOW_COST } else { self.change_cost(arc, step.1).max(0.0) };
                let (next, total) = (self.graph.after(step), d + cost);
                if total < distance[next] {
                    distance[next] = total;
                    came[next] = Some((state, step));
                    root[next] = root[state];
                    waiting.push(Reached(total, next));
                }
            }
        }
        let walk = |&end: &usize| {
            let mut steps = Vec::new();
            let mut at = end;
            while let Some((before, step)) = came[at] {
                steps.push(step);
                at = before;
            }
            steps.reverse();
            steps
        };
        ends.iter().map(walk).collect()
    }
}
