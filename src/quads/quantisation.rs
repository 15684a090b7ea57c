//! Quantisation: a whole number for each arc of a T-mesh such that opposite sides of every rectangle have the same sum, near wanted lengths.
//!
//! A change of an arc by 1 makes the two rectangles beside it uneven; in each another arc of the same side or the opposite one makes up for
//! it, and so on: consistent changes are closed walks in the double cover of a bidirected graph, whose states are a rectangle, one of its two
//! directions, and the sign of what its first side has more than the opposite one. Walks may begin and end at the boundary \[LCK21\].

use super::t_mesh::{HalfArc, TMesh};
use crate::control::Control;
use crate::error::{Error, Result};
use std::cmp::Ordering;
use std::collections::{BTreeMap, BinaryHeap, VecDeque};

/// Costs that differ by less than this are the same; lengths are of the order of 1.
const SAME_COST: f64 = 1e-9;

/// The end of walks at the boundary.
const OUTSIDE: usize = 0;

/// A quantisation that is being improved.
pub(super) struct Quantisation {
    /// Per half-arc the rectangle and direction to its left, 2r + d, and the sign with which its side counts.
    beside: Vec<Option<(usize, i64)>>,
    /// Per rectangle and direction the half-arcs of both sides.
    sides: Vec<Vec<HalfArc>>,
    /// Per state the steps that remove its excess.
    steps: Vec<Vec<WalkStep>>,
    /// Per arc the wanted length.
    wanted: Vec<f64>,
    /// Per arc the least number.
    least: Vec<i64>,
    /// Per arc its number.
    pub numbers: Vec<i64>,
}

/// A step of a walk: this half-arc's arc changes by this much.
type WalkStep = (HalfArc, i64);

/// A state in the order of the search.
#[derive(PartialEq)]
struct Reached(f64, usize);

impl Eq for Reached {}

impl PartialOrd for Reached {
    fn partial_cmp(&self, other: &Reached) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Reached {
    fn cmp(&self, other: &Reached) -> Ordering {
        other.0.total_cmp(&self.0).then(other.1.cmp(&self.1))
    }
}

impl Quantisation {
    /// Consistent numbers near wanted lengths, each at least `least`.
    ///
    /// # Errors
    /// [`Error::Layout`] for wanted lengths that are no numbers; [`Error::Cancelled`].
    pub fn balanced(t_mesh: &TMesh, wanted: Vec<f64>, least: i64, control: &Control) -> Result<Quantisation> {
        if let Some(a) = wanted.iter().position(|x| !x.is_finite() || x.abs() > 1e9) {
            return Err(Error::Layout(format!("arc {a} is to have {} edges", wanted[a])));
        }
        let mut found = Quantisation::start(t_mesh, wanted, least);
        // Where a shortest walk lowers an arc twice that has room for once only, walks need room for both; where there is none of these, all
        // arcs are raised first.
        while !found.balance(1, control)? && !found.balance(2, control)? {
            let before = std::mem::replace(&mut found.numbers, vec![0; t_mesh.arcs.len()]);
            found.raise_strips()?;
            found.numbers.iter_mut().zip(before).for_each(|(n, old)| *n += old);
        }
        Ok(found)
    }

    /// Wanted lengths rounded, not balanced.
    pub fn start(t_mesh: &TMesh, wanted: Vec<f64>, least: i64) -> Quantisation {
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
        let numbers = wanted.iter().map(|x| (x.round() as i64).max(least)).collect();
        let mut steps = vec![Vec::new(); 2 * sides.len() + 1];
        for (h, at) in beside.iter().enumerate() {
            match *at {
                Some((u, sign)) => {
                    for s in [1, -1] {
                        steps[Quantisation::state(u, s)].push((h, -s * sign));
                    }
                }
                None => steps[OUTSIDE].extend([(h, 1), (h, -1)]),
            }
        }
        let least = vec![least; wanted.len()];
        Quantisation { beside, sides, steps, wanted, least, numbers }
    }

    /// What the first side of each rectangle has more than the opposite one, per direction.
    pub fn excess(&self) -> Vec<i64> {
        let sum = |side: &Vec<HalfArc>| {
            side.iter().map(|&h| self.beside[h].map_or(0, |(_, sign)| sign * self.numbers[h / 2])).sum()
        };
        self.sides.iter().map(sum).collect()
    }

    /// The sum of squared differences from the wanted lengths.
    pub fn cost(&self) -> f64 {
        self.numbers.iter().zip(&self.wanted).map(|(&n, x)| (n as f64 - x).powi(2)).sum()
    }

    /// The cost of a change of an arc; infinite below the least number.
    fn change_cost(&self, arc: usize, change: i64) -> f64 {
        let n = self.numbers[arc];
        if n + change < self.least[arc] {
            return f64::INFINITY;
        }
        let [before, after] = [n, n + change].map(|n| (n as f64 - self.wanted[arc]).powi(2));
        after - before
    }

    /// The state in which a rectangle's direction has an excess of this sign.
    fn state(u: usize, sign: i64) -> usize {
        1 + 2 * u + usize::from(sign < 0)
    }

    /// The state after a step.
    fn after(&self, (h, change): WalkStep) -> usize {
        self.beside[h ^ 1].map_or(OUTSIDE, |(v, sign)| Quantisation::state(v, change * sign))
    }

    /// Removes what opposite sides differ by, along cheapest walks of arcs that can change so many times; false if some is left.
    fn balance(&mut self, uses: i64, control: &Control) -> Result<bool> {
        loop {
            control.check()?;
            let mut excess = self.excess();
            if excess.iter().all(|e| *e == 0) {
                return Ok(true);
            }
            let walks = self.cheapest_walks(&excess, uses);
            let mut is_changed = vec![false; self.numbers.len()];
            let mut is_better = false;
            for walk in walks {
                let (Some(&first), Some(&last)) = (walk.first(), walk.last()) else { continue };
                let from = self.beside[first.0];
                let to = self.beside[last.0 ^ 1];
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
                let mut seen: Vec<usize> = walk.iter().map(|(h, _)| h / 2).collect();
                seen.sort_unstable();
                if seen.windows(2).any(|pair| pair[0] == pair[1]) && !self.is_allowed(&walk) {
                    continue;
                }
                for &(h, change) in &walk {
                    self.numbers[h / 2] += change;
                    is_changed[h / 2] = true;
                }
                excess = left;
                is_better = true;
            }
            if !is_better {
                return Ok(false);
            }
        }
    }

    /// True if no arc on a walk falls below the least number.
    fn is_allowed(&self, walk: &[WalkStep]) -> bool {
        walk.iter().all(|(h, _)| {
            let total: i64 = walk.iter().filter(|(g, _)| g / 2 == h / 2).map(|(_, change)| change).sum();
            self.numbers[h / 2] + total >= self.least[h / 2]
        })
    }

    /// Walks from excesses to those that they cancel or to the boundary, the cheapest first. Gains count as no cost.
    fn cheapest_walks(&self, excess: &[i64], uses: i64) -> Vec<Vec<WalkStep>> {
        let n = self.steps.len();
        let mut distance = vec![f64::INFINITY; n];
        let mut came: Vec<Option<(usize, WalkStep)>> = vec![None; n];
        let mut waiting = BinaryHeap::new();
        let mut is_done = vec![false; n];
        for (u, e) in excess.iter().enumerate().filter(|(_, e)| **e != 0) {
            let state = Quantisation::state(u, e.signum());
            distance[state] = 0.0;
            waiting.push(Reached(0.0, state));
        }
        let mut ends = Vec::new();
        while let Some(Reached(d, state)) = waiting.pop() {
            if std::mem::replace(&mut is_done[state], true) {
                continue;
            }
            let is_end = state == OUTSIDE || {
                let (u, s) = ((state - 1) / 2, if (state - 1) % 2 == 0 { 1 } else { -1 });
                excess[u] * s < 0
            };
            if is_end && came[state].is_some() {
                ends.push(state);
                continue;
            }
            for &step in &self.steps[state] {
                let cost = self.change_cost(step.0 / 2, step.1);
                let (next, total) = (self.after(step), d + cost.max(0.0));
                let arc = step.0 / 2;
                if self.numbers[arc] + uses * step.1 >= self.least[arc].min(self.numbers[arc])
                    && total < distance[next]
                {
                    distance[next] = total;
                    came[next] = Some((state, step));
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

    /// Raises arcs below 1 to it along shortest closed walks, or walks from the boundary to the boundary.
    ///
    /// # Errors
    /// [`Error::Layout`] where an arc is on no such walk, which no T-mesh with lengths has.
    pub fn raise_strips(&mut self) -> Result<()> {
        for arc in 0..self.numbers.len() {
            if self.numbers[arc] >= 1 {
                continue;
            }
            let strip = self.strip(arc);
            let Some(strip) = strip else {
                return Err(Error::Layout(format!("arc {arc} lies on no strip of rectangles")));
            };
            strip.into_iter().for_each(|h| self.numbers[h / 2] += 1);
        }
        Ok(())
    }

    /// Half-arcs of a closed walk across rectangles through an arc, or of one between two places of the boundary.
    fn strip(&self, arc: usize) -> Option<Vec<HalfArc>> {
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

    /// The change of the cost along a walk.
    fn walk_cost(&self, walk: &[WalkStep]) -> f64 {
        let mut changes: Vec<(usize, i64)> = walk.iter().map(|(h, change)| (h / 2, *change)).collect();
        changes.sort_unstable();
        let total = |arc: &[(usize, i64)]| {
            let change = arc.iter().map(|(_, change)| change).sum();
            if change == 0 { 0.0 } else { self.change_cost(arc[0].0, change) }
        };
        changes.chunk_by(|a, b| a.0 == b.0).map(total).sum()
    }

    /// Changes numbers along closed walks as long as that lowers the cost. Where a test refuses a change, the arcs that it would bring to 0
    /// stay above it.
    pub fn descend(&mut self, is_good: &mut dyn FnMut(&[i64]) -> bool, control: &Control) -> Result<()> {
        let mut search = WalkSearch::new(self.steps.len());
        loop {
            control.check()?;
            let mut is_better = false;
            for walk in search.negative_walks(self) {
                if self.walk_cost(&walk) >= -SAME_COST {
                    continue;
                }
                is_better = true;
                walk.iter().for_each(|&(h, change)| self.numbers[h / 2] += change);
                if !is_good(&self.numbers) {
                    for &(h, change) in &walk {
                        self.least[h / 2] = self.least[h / 2].max(i64::from(self.numbers[h / 2] == 0));
                        self.numbers[h / 2] -= change;
                    }
                }
                walk.iter().for_each(|&(h, _)| search.wake(self, h / 2));
            }
            if !is_better {
                return Ok(());
            }
        }
    }
}

/// A search for closed walks that lower the cost, by Bellman and Ford's method. Distances stay from one search to the next, so that only
/// states near changes are looked at again.
struct WalkSearch {
    distance: Vec<f64>,
    waiting: Vec<usize>,
    is_waiting: Vec<bool>,
}

impl WalkSearch {
    fn new(n: usize) -> WalkSearch {
        WalkSearch { distance: vec![0.0; n], waiting: (0..n).collect(), is_waiting: vec![true; n] }
    }

    /// Looks again at the states from which an arc is changed.
    fn wake(&mut self, of: &Quantisation, arc: usize) {
        for h in [2 * arc, 2 * arc + 1] {
            let states =
                of.beside[h].map_or([OUTSIDE; 2], |(u, _)| [1, -1].map(|s| Quantisation::state(u, s)));
            for state in states {
                if !std::mem::replace(&mut self.is_waiting[state], true) {
                    self.waiting.push(state);
                }
            }
        }
    }

    /// Closed walks that seem to lower the cost; none only if there is none.
    fn negative_walks(&mut self, of: &Quantisation) -> Vec<Vec<WalkStep>> {
        let WalkSearch { distance, waiting, is_waiting } = self;
        let n = distance.len();
        let mut came: Vec<Option<(usize, WalkStep)>> = vec![None; n];
        let mut changed = Vec::new();
        for _ in 0..n {
            for state in std::mem::take(waiting) {
                is_waiting[state] = false;
                for &step in &of.steps[state] {
                    let next = of.after(step);
                    let total = distance[state] + of.change_cost(step.0 / 2, step.1);
                    if total < distance[next] - SAME_COST {
                        distance[next] = total;
                        came[next] = Some((state, step));
                        changed.push(next);
                        if !std::mem::replace(&mut is_waiting[next], true) {
                            waiting.push(next);
                        }
                    }
                }
            }
            if waiting.is_empty() {
                return Vec::new();
            }
            let walks = cycles(&came, &changed);
            if !walks.is_empty() {
                return walks;
            }
            changed.clear();
        }
        Vec::new()
    }
}

/// The cycles of a graph in which each state came from at most one other, that are reached from these states.
fn cycles(came: &[Option<(usize, WalkStep)>], starts: &[usize]) -> Vec<Vec<WalkStep>> {
    // The round in which a state was seen.
    let mut round: BTreeMap<usize, usize> = BTreeMap::new();
    let mut found = Vec::new();
    for (k, &start) in starts.iter().enumerate() {
        let mut at = start;
        while !round.contains_key(&at) {
            round.insert(at, k);
            let Some((before, _)) = came[at] else { break };
            at = before;
        }
        if round[&at] != k || came[at].is_none() {
            continue;
        }
        let (mut walk, mut state) = (Vec::new(), at);
        while let Some((before, step)) = came[state] {
            walk.push(step);
            state = before;
            if state == at {
                break;
            }
        }
        if state == at {
            walk.reverse();
            found.push(walk);
        }
    }
    found
}
