//! Quantisations by relaxation: with halves allowed the least cost is found exactly, and then one half after the other is rounded.
//!
//! In the double cover each arc has two copies, one per direction in which walks cross it. Numbers of the copies form a circulation, whose
//! least cost is that of cancelling every walk that lowers it; the mean of both copies is a whole number or a half. An arc with a half is
//! rounded to the side on which the cheapest walk makes up for it, and stays there, until no halves are left.

use super::arc_graph::WalkStep;
use super::descent::MOST_WORK;
use super::quantisation::Quantisation;
use super::t_mesh::HalfArc;
use super::walk_search::{SAME_COST, WalkSearch};
use crate::control::Control;
use crate::error::Result;
use crate::geometry::random::SplitMix64;

/// Orders in which halves are rounded; the best numbers count.
const ROUNDINGS: usize = 20;
/// Steps of searches after which no other order is tried, about a tenth of a second.
const MOST_WORK_OF_ROUNDINGS: usize = 6_000_000;
/// Share of the least cost within which numbers are good enough.
const NEAR_LEAST: f64 = 2e-3;
/// The seed of the orders.
const SEED: u64 = 7;

/// What keeps numbers usable: how they are made so, and the test that a descent asks where arcs come to 0.
pub(super) struct Usable<'a> {
    pub enforce: &'a mut dyn FnMut(&mut Quantisation) -> Result<()>,
    pub holds: &'a mut dyn FnMut(&[i64]) -> bool,
}

impl Quantisation {
    /// Lowers the difference from the wanted lengths: a descent, and others from roundings of the relaxation.
    ///
    /// # Errors
    /// Those of `enforce`; [`crate::Error::Cancelled`].
    pub fn lower(&mut self, usable: Usable<'_>, control: &Control) -> Result<()> {
        let Usable { enforce, holds } = usable;
        let least = self.least.clone();
        self.descend(holds, control)?;
        // Arcs that may not come to 0 count in the relaxation too.
        self.descend_once(holds, control)?;
        let start = self.clone();
        let relaxation = Relaxation::new(&start, control)?;
        let (least_cost, mut work) = (relaxation.cost(), relaxation.work);
        let mut random = SplitMix64::new(SEED);
        for _ in 0..ROUNDINGS {
            if work > MOST_WORK_OF_ROUNDINGS || self.cost() <= least_cost * (1.0 + NEAR_LEAST) {
                break;
            }
            let mut rounded = Relaxation { work: 0, ..relaxation.clone() };
            let is_whole = rounded.round_all(&mut random, control)?;
            work += rounded.work;
            if !is_whole {
                continue;
            }
            let mut other = start.clone();
            other.numbers = rounded.means();
            enforce(&mut other)?;
            work += other.descend_once(holds, control)?;
            if other.cost() < self.cost() && holds(&other.numbers) {
                *self = other;
            }
        }
        self.least = least;
        self.descend(holds, control)?;
        Ok(())
    }
}

/// The numbers of both copies of each arc.
#[derive(Clone)]
pub(super) struct Relaxation<'a> {
    of: &'a Quantisation,
    /// Per half-arc the number of the copy that a step from its rectangle makes longer.
    copies: Vec<i64>,
    /// Per arc the least and the greatest number of its copies.
    bounds: Vec<[i64; 2]>,
    search: WalkSearch,
    work: usize,
}

impl<'a> Relaxation<'a> {
    /// The copies of least cost, near these numbers where several have it.
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`].
    pub fn new(of: &'a Quantisation, control: &Control) -> Result<Relaxation<'a>> {
        let copies: Vec<i64> = of.numbers.iter().flat_map(|&n| [n, n]).collect();
        let bounds: Vec<[i64; 2]> = of.least.iter().map(|&least| [least, i64::MAX]).collect();
        let costs = |h: HalfArc| [1, -1].map(|change| of.cost_from(h / 2, of.numbers[h / 2], change));
        let search = WalkSearch::new(&of.graph, &costs);
        let mut relaxed = Relaxation { of, copies, bounds, search, work: 0 };
        relaxed.lower(control)?;
        Ok(relaxed)
    }

    /// The cost, half of each copy's: no whole numbers cost less.
    pub fn cost(&self) -> f64 {
        let costs = self.copies.iter().enumerate().map(|(h, &n)| (n as f64 - self.of.wanted[h / 2]).powi(2));
        0.5 * costs.sum::<f64>()
    }

    /// The arcs with a half.
    fn halves(&self) -> Vec<usize> {
        let pairs = self.copies.as_chunks::<2>().0.iter().enumerate();
        pairs.filter(|(_, [a, b])| (a - b) % 2 != 0).map(|(arc, _)| arc).collect()
    }

    /// The mean of the copies of each arc, where that is a whole number.
    fn means(&self) -> Vec<i64> {
        self.copies.as_chunks::<2>().0.iter().map(|[a, b]| (a + b) / 2).collect()
    }

    /// Rounds halves in an order made at random until there are none; false where an arc cannot be rounded.
    fn round_all(&mut self, random: &mut SplitMix64, control: &Control) -> Result<bool> {
        loop {
            let halves = self.halves();
            if halves.is_empty() {
                return Ok(true);
            }
            if !self.round(halves[(random.unit() * halves.len() as f64) as usize]) {
                return Ok(false);
            }
            self.lower(control)?;
        }
    }

    /// Rounds an arc to the side on which that costs less; false if neither is possible.
    fn round(&mut self, arc: usize) -> bool {
        let [a, b] = [2 * arc, 2 * arc + 1];
        let (low, high) = if self.copies[a] < self.copies[b] { (a, b) } else { (b, a) };
        let middle = (self.copies[a] + self.copies[b]).div_euclid(2);
        let before = self.bounds[arc];
        let mut best: Option<(f64, [i64; 2], Vec<WalkStep>)> = None;
        // The lower copy is made longer by a step from its own side, the higher one shorter by a step from the other.
        for (bounds, first) in [([middle + 1, before[1]], (low, 1)), ([before[0], middle], (high ^ 1, -1))] {
            self.bounds[arc] = bounds;
            self.wake(arc);
            let Some(walk) = self.search.cheapest_walk(&self.of.graph, first, &mut self.work) else {
                continue;
            };
            let cost = walk.iter().map(|&step| self.step_cost(step)).sum();
            if best.as_ref().is_none_or(|(least, ..)| cost < *least - SAME_COST) {
                best = Some((cost, bounds, walk));
            }
        }
        let Some((_, bounds, walk)) = best else { return false };
        self.bounds[arc] = bounds;
        self.apply(&walk);
        self.wake(arc);
        true
    }

    /// Cancels walks that lower the cost.
    fn lower(&mut self, control: &Control) -> Result<()> {
        loop {
            control.check()?;
            let walks = self.search.negative_walks(&self.of.graph, &mut self.work);
            if walks.is_empty() || self.work > MOST_WORK {
                return Ok(());
            }
            walks.iter().for_each(|walk| self.apply(walk));
        }
    }

    fn apply(&mut self, walk: &[WalkStep]) {
        walk.iter().for_each(|&step| self.copies[Relaxation::copy(step)] += step.1);
        walk.iter().for_each(|&(h, _)| self.wake(h / 2));
    }

    fn wake(&mut self, arc: usize) {
        for h in [2 * arc, 2 * arc + 1] {
            let costs = [1, -1].map(|change| self.step_cost((h, change)));
            self.search.wake(&self.of.graph, h, costs);
        }
    }

    /// The copy that a step changes: a step back along one copy starts on the other side of the arc.
    fn copy(step: WalkStep) -> usize {
        if step.1 > 0 { step.0 } else { step.0 ^ 1 }
    }

    /// The cost of a step; infinite beyond the bounds.
    fn step_cost(&self, step: WalkStep) -> f64 {
        let (arc, n) = (step.0 / 2, self.copies[Relaxation::copy(step)]);
        let [least, most] = self.bounds[arc];
        let after = n + step.1;
        let is_allowed = if step.1 > 0 { after <= most } else { after >= least };
        if is_allowed { self.of.cost_from(arc, n, step.1) } else { f64::INFINITY }
    }
}
