//! The search for closed walks that lower the cost of a quantisation, by Bellman and Ford's method.

use super::arc_graph::{ArcGraph, OUTSIDE, WalkStep};
use super::reached::Reached;
use super::t_mesh::HalfArc;
use std::collections::BinaryHeap;

/// Costs that differ by less than this are the same; lengths are of the order of 1.
pub(super) const SAME_COST: f64 = 1e-9;

/// A step from a state, as the search needs it.
#[derive(Clone, Copy)]
struct SearchStep {
    next: u32,
    half: u32,
    /// 0 for a longer arc, 1 for a shorter one.
    way: u32,
}

/// How a state was reached: from which state, by which of its steps, at what cost, and in which search.
#[derive(Clone, Copy)]
struct Arrival {
    search: u32,
    from: u32,
    step: u32,
    cost: f64,
}

/// A search whose distances stay from one walk to the next, so that only states near changes are looked at again.
#[derive(Clone)]
pub(super) struct WalkSearch {
    distance: Vec<f64>,
    waiting: Vec<usize>,
    is_waiting: Vec<bool>,
    /// Per state its steps, and the first of them in the list of all.
    steps: Vec<SearchStep>,
    first: Vec<usize>,
    /// Per half-arc the cost of the steps that change it by 1 and by −1.
    cost: Vec<[f64; 2]>,
    /// Per state the way to it in one search, and the number of that search.
    came: Vec<Arrival>,
    n_searches: u32,
    /// Per state the last walk back in which it was seen.
    seen: Vec<usize>,
    n_walks: usize,
}

impl WalkSearch {
    /// A search with these costs of the steps that change a half-arc by 1 and by −1.
    pub fn new(of: &ArcGraph, costs: &dyn Fn(usize) -> [f64; 2]) -> WalkSearch {
        let n = of.steps.len();
        let (mut steps, mut first) = (Vec::new(), vec![0]);
        for of_state in &of.steps {
            steps.extend(of_state.iter().map(|&(h, change)| SearchStep {
                next: of.after((h, change)) as u32,
                half: h as u32,
                way: u32::from(change < 0),
            }));
            first.push(steps.len());
        }
        WalkSearch {
            distance: vec![0.0; n],
            waiting: (0..n).collect(),
            is_waiting: vec![true; n],
            steps,
            first,
            cost: (0..of.beside.len()).map(costs).collect(),
            came: vec![Arrival { search: 0, from: 0, step: 0, cost: 0.0 }; n],
            n_searches: 0,
            seen: vec![0; n],
            n_walks: 0,
        }
    }

    /// Sets the costs of a half-arc's steps, and looks again at the states from which they are taken.
    pub fn wake(&mut self, of: &ArcGraph, h: HalfArc, cost: [f64; 2]) {
        self.cost[h] = cost;
        let states = of.beside[h].map_or([OUTSIDE; 2], |(u, _)| [1, -1].map(|s| ArcGraph::state(u, s)));
        for state in states {
            if !std::mem::replace(&mut self.is_waiting[state], true) {
                self.waiting.push(state);
            }
        }
    }

    /// Closed walks that seem to lower the cost; none only if there is none. Adds the number of steps that were looked at to the work.
    pub fn negative_walks(&mut self, of: &ArcGraph, work: &mut usize) -> Vec<Vec<WalkStep>> {
        let n = self.distance.len();
        self.n_searches += 1;
        let mut changed = Vec::new();
        for _ in 0..n {
            for state in std::mem::take(&mut self.waiting) {
                self.is_waiting[state] = false;
                let range = self.first[state]..self.first[state + 1];
                *work += range.len();
                let distance = self.distance[state];
                for k in 0..range.len() {
                    let step = self.steps[range.start + k];
                    let next = step.next as usize;
                    let total = distance + self.cost[step.half as usize][step.way as usize];
                    if total < self.distance[next] - SAME_COST {
                        self.distance[next] = total;
                        self.came[next] = self.arrival(state, k, total);
                        changed.push(next);
                        if !std::mem::replace(&mut self.is_waiting[next], true) {
                            self.waiting.push(next);
                        }
                    }
                }
            }
            if self.waiting.is_empty() {
                return Vec::new();
            }
            let walks = self.cycles(of, &changed);
            if !walks.is_empty() {
                return walks;
            }
            changed.clear();
        }
        Vec::new()
    }

    /// The cheapest closed walk that begins with this step, whose way back has to cost infinitely much, after a search has found nothing: its distances
    /// then leave no step a negative cost.
    pub fn cheapest_walk(
        &mut self,
        of: &ArcGraph,
        first: WalkStep,
        work: &mut usize,
    ) -> Option<Vec<WalkStep>> {
        self.n_searches += 1;
        let (start, goal) = (of.after(first), of.before(first));
        self.came[start] = self.arrival(start, 0, 0.0);
        let mut waiting = BinaryHeap::from([Reached(0.0, start)]);
        while let Some(Reached(so_far, state)) = waiting.pop() {
            if state == goal {
                break;
            }
            if self.came[state].cost < so_far {
                continue;
            }
            let range = self.first[state]..self.first[state + 1];
            *work += range.len();
            for k in 0..range.len() {
                let step = self.steps[range.start + k];
                let next = step.next as usize;
                let cost = self.cost[step.half as usize][step.way as usize];
                if cost == f64::INFINITY {
                    continue;
                }
                let total = so_far + (cost + self.distance[state] - self.distance[next]).max(0.0);
                if self.arrived(next).is_none_or(|known| total < known.cost) {
                    self.came[next] = self.arrival(state, k, total);
                    waiting.push(Reached(total, next));
                }
            }
        }
        let mut walk = Vec::new();
        let mut state = goal;
        while state != start {
            let arrival = self.arrived(state)?;
            state = arrival.from as usize;
            walk.push(of.steps[state][arrival.step as usize]);
        }
        walk.push(first);
        walk.reverse();
        Some(walk)
    }

    /// An arrival of this search.
    fn arrival(&self, from: usize, step: usize, cost: f64) -> Arrival {
        Arrival { search: self.n_searches, from: from as u32, step: step as u32, cost }
    }

    /// How this search reached a state, if it did.
    fn arrived(&self, state: usize) -> Option<Arrival> {
        Some(self.came[state]).filter(|arrival| arrival.search == self.n_searches)
    }

    /// The cycles of the graph in which each state came from at most one other, that are reached backwards from these states.
    fn cycles(&mut self, of: &ArcGraph, starts: &[usize]) -> Vec<Vec<WalkStep>> {
        let before_all = self.n_walks;
        let mut found = Vec::new();
        for &start in starts {
            self.n_walks += 1;
            let mut at = start;
            while self.seen[at] <= before_all {
                self.seen[at] = self.n_walks;
                let Some(arrival) = self.arrived(at) else { break };
                at = arrival.from as usize;
            }
            if self.seen[at] != self.n_walks || self.arrived(at).is_none() {
                continue;
            }
            let (mut walk, mut state) = (Vec::new(), at);
            while let Some(arrival) = self.arrived(state) {
                state = arrival.from as usize;
                walk.push(of.steps[state][arrival.step as usize]);
                if state == at {
                    walk.reverse();
                    found.push(walk);
                    break;
                }
            }
        }
        found
    }
}
