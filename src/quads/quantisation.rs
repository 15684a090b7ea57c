//! Quantisation: a whole number for each arc of a T-mesh such that opposite sides of every rectangle have the same sum, near wanted lengths.
//!
//! A change of an arc by 1 makes the two rectangles beside it uneven; in each another arc of the same side or the opposite one makes up for
//! it, and so on: consistent changes are closed walks in the double cover of a bidirected graph, whose states are a rectangle, one of its two
//! directions, and the sign of what its first side has more than the opposite one. Walks may begin and end at the boundary \[LCK21\].

use super::arc_graph::{ArcGraph, WalkStep};
use super::t_mesh::{HalfArc, TMesh};
use crate::control::Control;
use crate::error::{Error, Result};
use std::sync::Arc;

/// The cost of a longer arc where the number of squares is the cost: less than a square, so that it decides only between equally many.
const LENGTH_COST: f64 = 0.01;

/// A quantisation that is being improved.
#[derive(Debug, Clone)]
pub(super) struct Quantisation {
    pub(super) graph: Arc<ArcGraph>,
    /// Per arc the wanted length.
    pub(super) wanted: Vec<f64>,
    /// Per arc the least number.
    pub(super) least: Vec<i64>,
    /// Per arc the number of squares that come with a unit of it, where the number of squares is the cost.
    squares_across: Option<Vec<f64>>,
    /// Per arc its number.
    pub numbers: Vec<i64>,
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
        found.balance(control)?;
        found.raise_strips()?;
        Ok(found)
    }

    /// Wanted lengths rounded, not balanced.
    fn start(t_mesh: &TMesh, wanted: Vec<f64>, least: i64) -> Quantisation {
        let numbers = wanted.iter().map(|x| (x.round() as i64).max(least)).collect();
        let least = vec![least; wanted.len()];
        Quantisation { graph: Arc::new(ArcGraph::new(t_mesh)), wanted, least, squares_across: None, numbers }
    }

    /// What the first side of each rectangle has more than the opposite one, per direction.
    pub fn excess(&self) -> Vec<i64> {
        let sum = |side: &Vec<HalfArc>| {
            side.iter().map(|&h| self.graph.beside[h].map_or(0, |(_, sign)| sign * self.numbers[h / 2])).sum()
        };
        self.graph.sides.iter().map(sum).collect()
    }

    /// Another start: numbers that are at least this large, from which arcs may become 0.
    ///
    /// # Errors
    /// Those of [`Quantisation::balanced`].
    pub fn restarted(&self, least: i64, control: &Control) -> Result<Quantisation> {
        let numbers = self.wanted.iter().map(|x| (x.round() as i64).max(least)).collect();
        let mut other = Quantisation { numbers, least: vec![least; self.wanted.len()], ..self.clone() };
        other.balance(control)?;
        other.raise_strips()?;
        other.descend(&mut |_| true, control)?;
        other.least.fill(0);
        Ok(other)
    }

    /// Keeps an arc above 0 from now on; its strip is raised.
    ///
    /// # Errors
    /// [`Error::Layout`] as [`Quantisation::balanced`].
    pub fn keep_above_zero(&mut self, arc: usize) -> Result<()> {
        self.least[arc] = 1;
        self.raise_strips()
    }

    /// Makes an arc longer by 1 at least; its strip is raised.
    ///
    /// # Errors
    /// [`Error::Layout`] as [`Quantisation::balanced`].
    pub fn make_longer(&mut self, arc: usize) -> Result<()> {
        self.least[arc] = self.numbers[arc] + 1;
        self.raise_strips()
    }

    /// The least number of an arc.
    pub fn set_least(&mut self, arc: usize, least: i64) {
        self.least[arc] = least;
    }

    /// The arc with the greatest wanted length of those that are 0.
    pub fn longest_zero(&self, arcs: impl Iterator<Item = usize>) -> Option<usize> {
        let zero = arcs.filter(|&a| self.numbers[a] == 0);
        zero.max_by(|&a, &b| self.wanted[a].total_cmp(&self.wanted[b]).then(b.cmp(&a)))
    }

    /// The sum of squared differences from the wanted lengths.
    pub fn cost(&self) -> f64 {
        self.numbers.iter().zip(&self.wanted).map(|(&n, x)| (n as f64 - x).powi(2)).sum()
    }

    /// From now on the number of squares is the cost of a descent.
    pub fn prefer_few_squares(&mut self) {
        self.squares_across = Some(self.counted_across());
    }

    /// The squares along the first side of each rectangle's direction.
    fn extents(&self, numbers: &[i64]) -> Vec<i64> {
        let sum = |side: &Vec<HalfArc>| {
            let first = side.iter().filter(|&&h| self.graph.beside[h].is_some_and(|(_, sign)| sign > 0));
            first.map(|h| numbers[h / 2]).sum()
        };
        self.graph.sides.iter().map(sum).collect()
    }

    /// Per arc the number of squares that come with a unit of it: half of those across the rectangles on both sides, which have another arc
    /// on the opposite side.
    fn counted_across(&self) -> Vec<f64> {
        let extents = self.extents(&self.numbers);
        let across = |h: HalfArc| self.graph.beside[h].map_or(0.0, |(u, _)| 0.5 * extents[u ^ 1] as f64);
        (0..self.numbers.len()).map(|a| across(2 * a) + across(2 * a + 1)).collect()
    }

    /// What a descent lowers: the number of squares with the sum of all lengths, or the difference from the wanted lengths.
    pub fn value(&self) -> f64 {
        if self.squares_across.is_some() { self.squares_cost(&self.numbers) } else { self.cost() }
    }

    /// The number of squares of these numbers, with the sum of all lengths.
    fn squares_cost(&self, numbers: &[i64]) -> f64 {
        let squares: i64 = self.extents(numbers).as_chunks::<2>().0.iter().map(|[m, n]| m * n).sum();
        squares as f64 + LENGTH_COST * numbers.iter().sum::<i64>() as f64
    }

    /// The cost of a change of an arc; infinite below the least number.
    pub(super) fn change_cost(&self, arc: usize, change: i64) -> f64 {
        self.cost_from(arc, self.numbers[arc], change)
    }

    /// The cost of a change of an arc from this number; infinite below the least number.
    pub(super) fn cost_from(&self, arc: usize, n: i64, change: i64) -> f64 {
        if n + change < self.least[arc] {
            return f64::INFINITY;
        }
        if let Some(across) = &self.squares_across {
            return change as f64 * (across[arc] + LENGTH_COST);
        }
        let [before, after] = [n, n + change].map(|n| (n as f64 - self.wanted[arc]).powi(2));
        after - before
    }

    /// The costs of a change of an arc by 1 and by −1 in a search.
    pub(super) fn step_costs(&self, arc: usize) -> [f64; 2] {
        [1, -1].map(|change| self.change_cost(arc, change))
    }

    /// Raises arcs below their least number to it along shortest closed walks, or walks from the boundary to the boundary.
    ///
    /// # Errors
    /// [`Error::Layout`] where an arc is on no such walk, which no T-mesh with lengths has.
    pub(super) fn raise_strips(&mut self) -> Result<()> {
        for arc in 0..self.numbers.len() {
            if self.numbers[arc] >= self.least[arc] {
                continue;
            }
            let Some(strip) = self.graph.strip(arc) else {
                return Err(Error::Layout(format!("arc {arc} lies on no strip of rectangles")));
            };
            while self.numbers[arc] < self.least[arc] {
                strip.iter().for_each(|h| self.numbers[h / 2] += 1);
            }
        }
        Ok(())
    }

    /// True if the number of squares is the cost.
    pub(super) fn counts_squares(&self) -> bool {
        self.squares_across.is_some()
    }

    /// Counts the squares across arcs after changes of numbers; returns the arcs for which they are others.
    pub(super) fn count_again(&mut self) -> Vec<usize> {
        let Some(before) = self.squares_across.take() else { return Vec::new() };
        let across = self.counted_across();
        let changed = (0..across.len()).filter(|&a| across[a] != before[a]).collect();
        self.squares_across = Some(across);
        changed
    }

    /// The change of the cost along a walk.
    pub(super) fn walk_cost(&self, walk: &[WalkStep]) -> f64 {
        if self.squares_across.is_some() {
            let mut after = self.numbers.clone();
            walk.iter().for_each(|&(h, change)| after[h / 2] += change);
            if after.iter().zip(&self.least).any(|(n, least)| n < least) {
                return f64::INFINITY;
            }
            return self.squares_cost(&after) - self.squares_cost(&self.numbers);
        }
        let mut changes: Vec<(usize, i64)> = walk.iter().map(|(h, change)| (h / 2, *change)).collect();
        changes.sort_unstable();
        let total = |arc: &[(usize, i64)]| {
            let change = arc.iter().map(|(_, change)| change).sum();
            if change == 0 { 0.0 } else { self.change_cost(arc[0].0, change) }
        };
        changes.chunk_by(|a, b| a.0 == b.0).map(total).sum()
    }
}

#[cfg(test)]
#[path = "quantisation_tests.rs"]
mod tests;

#[cfg(test)]
#[path = "quantisation_table_tests.rs"]
mod table_tests;
