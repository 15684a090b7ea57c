//! Newton's method down the energy of a map, in the plane or on the sphere.

use super::descent_matrix::{DescentMatrix, NewtonStep};
use super::report::FlattenStop;
use crate::control::{Control, Stage};
use crate::error::Result;
use crate::parallel;

/// Share of the decrease along the tangent that a step is to reach [Arm66].
const SUFFICIENT: f64 = 1e-4;
/// Part of the energy, or of 1 if that is more, that rounding may add to it.
const ENERGY_ROUNDING: f64 = 1e-14;
/// Most halvings of a step.
const MOST_HALVINGS: usize = 50;
/// Steps of a share less than this do not count as progress where triangles bound them.
const LEAST_STEP: f64 = 1e-10;
/// Steps after which half of the progress is shown.
const HALF_WAY: f64 = 15.0;

/// A kind of map whose energy is lowered: two unknowns per vertex, in the plane or tangential to the sphere.
pub(super) trait MovingMap: Sync {
    /// The place of a vertex.
    type Place: Copy + Send + Sync;

    /// What a step lowers: the energy with the terms of conditions; infinite where a triangle has no area.
    fn merit(&self, points: &[Self::Place]) -> f64;
    /// The terms of conditions.
    fn conditions_value(&self, points: &[Self::Place]) -> f64;
    /// Prepares the matrix for the terms at these points.
    ///
    /// # Errors
    /// Those of [`DescentMatrix::hold`].
    fn look_at(
        &mut self,
        points: &[Self::Place],
        system: &mut DescentMatrix<'_>,
        control: &Control,
    ) -> Result<()>;
    /// Fills in the gradient and the Hessian.
    fn assemble(&self, system: &mut DescentMatrix<'_>, points: &[Self::Place], clamped: bool);
    /// The largest share of a step, at most 1, that is safely this side of a triangle without area.
    fn bound(&self, points: &[Self::Place], direction: &[[f64; 2]]) -> f64;
    /// The place of a vertex after a step of it.
    fn moved(&self, place: Self::Place, by: [f64; 2]) -> Self::Place;
    /// True if no triangle is turned over and nothing else is that must not be.
    fn is_map(&self, points: &[Self::Place]) -> bool;
}

/// A map on its way down.
pub(super) struct MapDescent<M: MovingMap> {
    pub map: M,
    pub points: Vec<M::Place>,
    /// The energy at the start and after each step, without the terms of conditions.
    pub energies: Vec<f64>,
    /// What the last step has lowered: the energy with the terms of conditions.
    merit: f64,
    /// Steps by the Hessian itself.
    pub unclamped: usize,
    /// The decrement of the last step.
    pub decrement: f64,
}

/// A step as far as it is made.
struct AcceptedStep<P> {
    points: Vec<P>,
    merit: f64,
    /// The share of the Newton step.
    share: f64,
}

/// What is made of a Newton step.
enum StepOutcome<P> {
    Accepted(AcceptedStep<P>),
    /// A triangle is about to lose its area.
    Blocked,
    /// The energy does not fall.
    Refused,
}

impl<M: MovingMap> MapDescent<M> {
    pub fn new(map: M, points: Vec<M::Place>) -> MapDescent<M> {
        MapDescent {
            map,
            points,
            energies: Vec::new(),
            merit: f64::INFINITY,
            unclamped: 0,
            decrement: f64::INFINITY,
        }
    }

    /// Descends until the decrement is at most the tolerance, in at most so many steps.
    ///
    /// # Errors
    /// Those of [`MovingMap::look_at`]; [`crate::Error::Cancelled`].
    pub fn run(
        &mut self,
        system: &mut DescentMatrix<'_>,
        tolerance: f64,
        most: usize,
        control: &Control,
    ) -> Result<FlattenStop> {
        self.merit = self.map.merit(&self.points);
        if self.energies.is_empty() {
            self.energies.push(self.merit - self.map.conditions_value(&self.points));
        }
        // The Hessian itself is tried once a full step was made.
        let mut unclamped = false;
        for _ in 0..most {
            let k = self.energies.len() as f64 - 1.0;
            control.step(Stage::Layout, k / (k + HALF_WAY))?;
            self.map.look_at(&self.points, system, control)?;
            let mut step = if unclamped { self.step(system, false) } else { None };
            let mut outcome = step.as_ref().map(|step| self.outcome(step));
            control.check()?;
            let by_hessian = matches!(outcome, Some(StepOutcome::Accepted(_)));
            if !by_hessian {
                step = self.step(system, true);
                outcome = step.as_ref().map(|step| self.outcome(step));
            }
            let (Some(step), Some(outcome)) = (step, outcome) else { return Ok(FlattenStop::NoStep) };
            let made = match outcome {
                StepOutcome::Accepted(made) => made,
                StepOutcome::Blocked => return Ok(FlattenStop::Barrier),
                StepOutcome::Refused => return Ok(FlattenStop::NoStep),
            };
            unclamped = made.share == 1.0;
            self.unclamped += usize::from(by_hessian);
            let before = std::mem::replace(&mut self.decrement, (-step.slope).sqrt());
            (self.points, self.merit) = (made.points, made.merit);
            self.energies.push(self.merit - self.map.conditions_value(&self.points));
            if unclamped && let Some(stop) = self.ended(before, tolerance) {
                return Ok(stop);
            }
        }
        Ok(FlattenStop::MaxIterations)
    }

    /// Why the descent ends after a full step, if it does; `before` is the decrement of the step before.
    fn ended(&self, before: f64, tolerance: f64) -> Option<FlattenStop> {
        let decrement = self.decrement;
        if decrement <= tolerance {
            return Some(FlattenStop::Converged);
        }
        let least = ENERGY_ROUNDING * self.merit.abs().max(1.0);
        (decrement * decrement < least && decrement > 0.5 * before).then_some(FlattenStop::Rounding)
    }

    fn step(&self, system: &mut DescentMatrix<'_>, clamped: bool) -> Option<NewtonStep> {
        self.map.assemble(system, &self.points, clamped);
        system.step(clamped)
    }

    /// Makes the step, or as much of it as turns no triangle over and lowers the energy enough.
    fn outcome(&self, step: &NewtonStep) -> StepOutcome<M::Place> {
        let mut share = self.map.bound(&self.points, &step.direction);
        if share < LEAST_STEP {
            return StepOutcome::Blocked;
        }
        let slack = ENERGY_ROUNDING * self.merit.abs().max(1.0);
        for _ in 0..MOST_HALVINGS {
            let mut points = self.points.clone();
            parallel::fill(&mut points, |v| {
                self.map.moved(self.points[v], step.direction[v].map(|x| share * x))
            });
            let merit = self.map.merit(&points);
            let is_lower = merit <= self.merit + SUFFICIENT * share * step.slope + slack;
            if is_lower && self.map.is_map(&points) {
                return StepOutcome::Accepted(AcceptedStep { points, merit, share });
            }
            share *= 0.5;
        }
        StepOutcome::Refused
    }
}
