//! Quantisations with few squares: descents of the number of squares, each from the best numbers so far with one strip raised.

use super::quantisation::Quantisation;
use super::separation::Separation;
use crate::control::{Control, Stage};
use crate::error::Result;
use crate::geometry::random::SplitMix64;

/// Steps of searches in all descents from one start, about a second; fewer in instrumented builds, where each takes ten times as long.
const MOST_WORK: usize = if cfg!(fuzzing) { 1_600_000 } else { 160_000_000 };
/// Descents that may follow each other without fewer squares, per arc.
const FRUITLESS_PER_ARC: usize = 4;
/// The seed of the order in which strips are raised.
const SEED: u64 = 2021;

/// Numbers with as few squares as a search finds that starts from these: a descent along walks often ends where every single walk would let two
/// cones fall together; from a longer strip another descent leads past it.
///
/// # Errors
/// Those of [`Quantisation::make_longer`] and [`Quantisation::descend`].
pub(super) fn coarsened(
    start: &Quantisation,
    separation: &Separation<'_>,
    control: &Control,
) -> Result<Quantisation> {
    let is_apart = &mut |numbers: &[i64]| separation.holds(numbers);
    let mut best = start.clone();
    best.prefer_few_squares();
    let mut work = best.descend(is_apart, control)?;
    let mut random = SplitMix64::new(SEED);
    let n = best.numbers.len();
    let mut fruitless = 0;
    while work < MOST_WORK && fruitless < FRUITLESS_PER_ARC * n {
        control.step(Stage::Layout, work as f64 / MOST_WORK as f64)?;
        let mut other = best.clone();
        let arc = (random.unit() * n as f64) as usize;
        other.make_longer(arc)?;
        work += other.descend(is_apart, control)?;
        other.set_least(arc, 0);
        work += other.descend(is_apart, control)?;
        fruitless = if other.value() < best.value() { 0 } else { fruitless + 1 };
        if other.value() <= best.value() && separation.holds(&other.numbers) {
            best = other;
        }
    }
    Ok(best)
}
