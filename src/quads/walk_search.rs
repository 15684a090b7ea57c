//! The search for closed walks that lower the cost of a quantisation, by Bellman and Ford's method.

use super::arc_graph::{ArcGraph, OUTSIDE, WalkStep};

/// Costs that differ by less than this are the same; lengths are of the order of 1.
pub(super) const SAME_COST: f64 = 1e-9;

/// A step from a state, as the search needs it.
#[derive(Clone, Copy)]
struct SearchStep {
    next: u32,
    arc: u32,
    /// 0 for a longer arc, 1 for a shorter one.
    way: u32,
}

/// A search whose distances stay from one walk to the next, so that only states near changes are looked at again.
pub(super) struct WalkSearch {
    distance: Vec<f64>,
    waiting: Vec<usize>,
    is_waiting: Vec<bool>,
    /// Per state its steps, and the first of them in the list of all.
    steps: Vec<SearchStep>,
    first: Vec<usize>,
    /// Per arc the cost of a change by 1 and by −1.
    cost: Vec<[f64; 2]>,
    /// Per state the last walk back in which it was seen.
    seen: Vec<usize>,
    n_walks: usize,
}

impl WalkSearch {
    /// A search with these costs of a change by 1 and by −1 per arc.
    pub fn new(of: &ArcGraph, costs: &dyn Fn(usize) -> [f64; 2]) -> WalkSearch {
        let n = of.steps.len();
        let (mut steps, mut first) = (Vec::new(), vec![0]);
        for of_state in &of.steps {
            steps.extend(of_state.iter().map(|&(h, change)| SearchStep {
                next: of.after((h, change)) as u32,
                arc: (h / 2) as u32,
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
            cost: (0..of.beside.len() / 2).map(costs).collect(),
            seen: vec![0; n],
            n_walks: 0,
        }
    }

    /// Sets the costs of an arc, and looks again at the states from which it is changed.
    pub fn wake(&mut self, of: &ArcGraph, arc: usize, cost: [f64; 2]) {
        self.cost[arc] = cost;
        for h in [2 * arc, 2 * arc + 1] {
            let states = of.beside[h].map_or([OUTSIDE; 2], |(u, _)| [1, -1].map(|s| ArcGraph::state(u, s)));
            for state in states {
                if !std::mem::replace(&mut self.is_waiting[state], true) {
                    self.waiting.push(state);
                }
            }
        }
    }

    /// Closed walks that seem to lower the cost; none only if there is none. Adds the number of steps that were looked at to the work.
    pub fn negative_walks(&mut self, of: &ArcGraph, work: &mut usize) -> Vec<Vec<WalkStep>> {
        let n = self.distance.len();
        // Per state the one before it, and the number of the step between.
        let mut came: Vec<Option<(u32, u32)>> = vec![None; n];
        let mut changed = Vec::new();
        for _ in 0..n {
            for state in std::mem::take(&mut self.waiting) {
                self.is_waiting[state] = false;
                let range = self.first[state]..self.first[state + 1];
                *work += range.len();
                let distance = self.distance[state];
                for (k, step) in self.steps[range].iter().enumerate() {
                    let next = step.next as usize;
                    let total = distance + self.cost[step.arc as usize][step.way as usize];
                    if total < self.distance[next] - SAME_COST {
                        self.distance[next] = total;
                        came[next] = Some((state as u32, k as u32));
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
            let walks = self.cycles(of, &came, &changed);
            if !walks.is_empty() {
                return walks;
            }
            changed.clear();
        }
        Vec::new()
    }

    /// The cycles of the graph in which each state came from at most one other, that are reached backwards from these states.
    fn cycles(&mut self, of: &ArcGraph, came: &[Option<(u32, u32)>], starts: &[usize]) -> Vec<Vec<WalkStep>> {
        let before_all = self.n_walks;
        let mut found = Vec::new();
        for &start in starts {
            self.n_walks += 1;
            let mut at = start;
            while self.seen[at] <= before_all {
                self.seen[at] = self.n_walks;
                let Some((before, _)) = came[at] else { break };
                at = before as usize;
            }
            if self.seen[at] != self.n_walks || came[at].is_none() {
                continue;
            }
            let (mut walk, mut state) = (Vec::new(), at);
            while let Some((before, step)) = came[state] {
                state = before as usize;
                walk.push(of.steps[state][step as usize]);
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
