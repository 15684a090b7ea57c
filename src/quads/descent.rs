//! Descents of a quantisation: changes along closed walks as long as they lower its cost.

use super::arc_graph::WalkStep;
use super::quantisation::Quantisation;
use super::walk_search::{SAME_COST, WalkSearch};
use crate::control::Control;
use crate::error::Result;

/// The cost of changing an arc by 2 less twice that of changing it by 1, per use of the arc.
const REPEATED_COST: f64 = 1.0;
/// Steps of searches in one descent, about half a second: numbers are consistent at any time, so that it can end anywhere.
pub(super) const MOST_WORK: usize = 40_000_000;
/// Steps of a search that take as long as a test of one arc.
const WORK_OF_TEST: usize = 30;
/// Share of the cost that a descent has to gain for another to follow.
const LEAST_GAIN: f64 = 1e-3;

/// A test of numbers of which some came to 0.
pub(super) type ZeroTest<'a> = &'a mut dyn FnMut(&[i64]) -> bool;

/// A descent in which each search begins with what the one before found.
struct Descent<'a> {
    of: &'a mut Quantisation,
    search: WalkSearch,
    /// Per arc what each use costs in addition where walks have used it twice.
    surcharge: Vec<f64>,
    /// The steps that searches took.
    work: usize,
}

impl Quantisation {
    /// Changes numbers along closed walks as long as that lowers the cost. A test is asked where arcs come to 0; where it refuses, the longest
    /// of them stays above 0. Returns the steps that its searches took.
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`].
    pub fn descend(&mut self, is_good: ZeroTest<'_>, control: &Control) -> Result<usize> {
        let least = self.least.clone();
        let mut work = 0;
        loop {
            let before = self.value();
            work += self.descend_once(is_good, control)?;
            // What was refused may be possible once other arcs have changed.
            self.least.clone_from(&least);
            if self.value() >= before - LEAST_GAIN * before || work > MOST_WORK {
                return Ok(work);
            }
        }
    }

    /// A descent after which arcs stay above 0 where the test refused.
    ///
    /// # Errors
    /// Those of [`Quantisation::descend`].
    pub(super) fn descend_once(&mut self, is_good: ZeroTest<'_>, control: &Control) -> Result<usize> {
        let mut descent = Descent::new(self);
        descent.lower_tested(is_good, control)?;
        Ok(descent.work)
    }
}

impl<'a> Descent<'a> {
    fn new(of: &'a mut Quantisation) -> Descent<'a> {
        let search = WalkSearch::new(&of.graph, &|h| of.step_costs(h / 2));
        let surcharge = vec![0.0; of.numbers.len()];
        Descent { of, search, surcharge, work: 0 }
    }

    /// Tells the search what the changes of an arc cost now.
    fn wake(&mut self, arc: usize) {
        let costs = self.of.step_costs(arc).map(|cost| cost + self.surcharge[arc]);
        [2 * arc, 2 * arc + 1].into_iter().for_each(|h| self.search.wake(&self.of.graph, h, costs));
    }

    fn apply(&mut self, walk: &[WalkStep]) {
        walk.iter().for_each(|&(h, change)| self.of.numbers[h / 2] += change);
    }

    fn undo(&mut self, walk: &[WalkStep]) {
        walk.iter().for_each(|&(h, change)| self.of.numbers[h / 2] -= change);
    }

    fn wake_all(&mut self, walk: &[WalkStep]) {
        walk.iter().for_each(|&(h, _)| self.wake(h / 2));
    }

    /// Makes the arcs dearer that a walk uses more than once, which costs more than twice the first use; where the number of squares is the
    /// cost, all of its arcs.
    fn discourage(&mut self, walk: &[WalkStep]) {
        let mut arcs: Vec<usize> = walk.iter().map(|(h, _)| h / 2).collect();
        arcs.sort_unstable();
        let least = if self.of.counts_squares() { 1 } else { 2 };
        for same in arcs.chunk_by(|a, b| a == b).filter(|same| same.len() >= least) {
            self.surcharge[same[0]] += REPEATED_COST;
        }
    }

    /// Changes numbers along walks that lower the cost until none is left that the test has not refused.
    fn lower_tested(&mut self, is_good: ZeroTest<'_>, control: &Control) -> Result<()> {
        loop {
            control.check()?;
            let walks = self.search.negative_walks(&self.of.graph, &mut self.work);
            if walks.is_empty() {
                return Ok(());
            }
            for walk in walks {
                self.take_tested(&walk, is_good);
            }
            if self.work > MOST_WORK {
                return Ok(());
            }
        }
    }

    /// Changes numbers along a walk if that lowers the cost and the test does not refuse it.
    fn take_tested(&mut self, walk: &[WalkStep], is_good: ZeroTest<'_>) {
        if self.of.walk_cost(walk) >= -SAME_COST {
            self.discourage(walk);
            self.wake_all(walk);
            return;
        }
        self.apply(walk);
        let zeros = walk.iter().map(|&(h, _)| h / 2).filter(|&a| self.of.numbers[a] == 0);
        if let Some(zero) = self.of.longest_zero(zeros) {
            self.work += WORK_OF_TEST * self.of.numbers.len();
            if !is_good(&self.of.numbers) {
                self.of.least[zero] = 1;
                self.undo(walk);
            }
        }
        self.wake_all(walk);
        for arc in self.of.count_again() {
            self.wake(arc);
        }
    }
}
