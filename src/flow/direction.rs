//! The direction of a Newton step: by the factor of an earlier step, by a new one in f32, or by one in f64.

use super::Flow;
use super::newton::Iterate;
use super::report::Report;
use super::seconds::timed;
use super::solve::centre;
use super::system::{NewtonSystem, Precision};
use crate::control::Control;
use crate::error::Result;
use crate::geometry::largest;
use crate::linalg::conjugate::ResidualBound;

/// First shift of a matrix that is not positive definite, relative to its mean diagonal; grows by [`SHIFT_GROWTH`].
const FIRST_SHIFT: f64 = 1e-12;
/// NewtonFactor from one shift to the next: [`SHIFTS`] of them reach the diagonal's own size and beyond.
const SHIFT_GROWTH: f64 = 100.0;
/// Largest number of shifts that are tried for one step.
const SHIFTS: usize = 12;
/// The linear residual of a step that is solved with the factor of an earlier matrix, as a share of the error that would remain at the
/// quadratic rate of the last step \[EW96, choice 2\]: too small to slow the convergence down.
const FORCING: f64 = 0.1;
/// Largest linear residual, as a share of the right-hand side, of a step that is solved with a factor of another matrix or in f32.
const MAX_FORCING: f64 = 0.01;
/// Radians. Largest linear residual of a step by the f32 factor of its own matrix while edges may be flipped: it decides which diagonal a
/// cocircular quadrilateral is flipped to, and a symmetric surface has thousands of those. Later steps leave less anyway.
const TIES: f64 = 1e-10;
/// Radians. Linear residual below which no step is solved further: a tenth of the rounding of an angle of 1. It is far below the rounding
/// of the curvature because the residuals of the whole surface add up in u.
const LEAST_LEFT: f64 = 2e-17;
/// Radians. The same bound at the vertex whose u is held, where the residuals of all others add up: the rounding of a curvature.
const LEAST_SUM: f64 = 4e-16;
/// Number of unknowns from which on a factor in f32 saves time. Below, the first step is solved in f64, since an inexact one breaks the
/// symmetry of a surface, whose cocircular quadrilaterals are then flipped one way or the other.
const SINGLE_FROM: usize = 10_000;

impl Flow {
    /// The Newton direction into `at.step`, with the matrix at `at.state`; false where there is none.
    pub(super) fn direction(
        &mut self,
        at: &mut Iterate,
        report: &mut Report,
        control: &Control,
    ) -> Result<bool> {
        let mut system = self.take_system(report)?;
        control.check()?;
        self.assemble(&mut system, &at.state, report);
        control.check()?;
        let mut found = self.direction_near(&mut system, at, report, control)?;
        let is_large = system.unknowns() >= SINGLE_FROM;
        if !found && is_large && self.single_serves && at.is_sound() {
            system = self.analysed(system, Precision::F32, report)?;
            control.check()?;
            found = self.direction_single(&mut system, at, report, control)?;
            self.single_serves = found;
        }
        if !found {
            system = self.analysed(system, Precision::F64, report)?;
            found = self.direction_of(&mut system, at, report, control)?;
        }
        self.system = Some(system);
        at.solved_at = found.then_some(report.flips);
        Ok(found)
    }

    /// The Newton direction of a matrix that has been assembled, by the factor of an earlier step of this solve. False if a new factor is
    /// quicker; the old one is then not tried again for some steps, for more and more of them at each failure.
    fn direction_near(
        &self,
        system: &mut NewtonSystem,
        at: &mut Iterate,
        report: &mut Report,
        control: &Control,
    ) -> Result<bool> {
        let (misses, from) = at.misses;
        if at.solved_at.is_none() || report.iterations < from || !at.is_sound() {
            return Ok(false);
        }
        let forcing = f64::min(FORCING * (at.error / at.last_error).powi(2), MAX_FORCING);
        let found = timed(&mut report.seconds.solve, || self.solve_near(system, at, forcing, control))?;
        at.misses = if found { (0, 0) } else { (misses + 1, report.iterations + (2 << misses.min(8))) };
        Ok(found)
    }

    /// The Newton direction of a matrix that has been assembled, by its own factor in f32; false if that is not precise enough.
    fn direction_single(
        &self,
        system: &mut NewtonSystem,
        at: &mut Iterate,
        report: &mut Report,
        control: &Control,
    ) -> Result<bool> {
        report.factorisations += 1;
        let factored = timed(&mut report.seconds.factor, || system.factor()).is_ok();
        control.check()?;
        let most = if self.flips_allowed { TIES / at.error } else { MAX_FORCING };
        let forcing = f64::min(FORCING * at.error, f64::min(most, MAX_FORCING));
        Ok(factored && timed(&mut report.seconds.solve, || self.solve_near(system, at, forcing, control))?)
    }

    /// `at.step` from `at.residual` with an earlier factor, up to this share of the error; false if a new factor is quicker.
    pub(super) fn solve_near(
        &self,
        system: &mut NewtonSystem,
        at: &mut Iterate,
        share: f64,
        control: &Control,
    ) -> Result<bool> {
        let [largest, sum] = [LEAST_LEFT, LEAST_SUM].map(|least| f64::max(share * at.error, least));
        let bound = ResidualBound { largest, sum: if self.free_scale() { sum } else { f64::INFINITY } };
        self.solve_by(at, |residual, step| system.solve_near(residual, bound, step, control))
    }

    /// `at.step` from `at.residual` with the last factor; false where it is not finite.
    pub(super) fn solve_step(
        &self,
        system: &mut NewtonSystem,
        at: &mut Iterate,
        report: &mut Report,
    ) -> Result<bool> {
        let seconds = &mut report.seconds.solve;
        self.solve_by(at, |residual, step| Ok(timed(seconds, || system.solve(residual, self.enough(), step))))
    }

    /// `at.step` by a solution of the system for `at.residual`; false where `solve` finds none.
    ///
    /// If u is determined up to a constant, the rounding of the total curvature is spread over all vertices first, since it would all go to
    /// the vertex that is held; and the step keeps the mean of u.
    fn solve_by(
        &self,
        Iterate { residual, step, .. }: &mut Iterate,
        solve: impl FnOnce(&[f64], &mut [f64]) -> Result<bool>,
    ) -> Result<bool> {
        if self.free_scale() {
            centre(residual);
        }
        let found = solve(residual, step)?;
        if found && self.free_scale() {
            centre(step);
        }
        Ok(found)
    }

    /// The Newton direction of a matrix that has been assembled.
    ///
    /// A vertex whose triangles all break has a zero row, and rounding can make the matrix indefinite. Where the matrix has
    /// no factor, its diagonal is raised at the vertices of broken triangles (at all, where none is broken), so far that no
    /// u moves further than `max_step`: capping the step instead would hold back the sound vertices for the loose ones.
    /// `at.shift` remembers by how much, for the next iteration.
    fn direction_of(
        &self,
        system: &mut NewtonSystem,
        at: &mut Iterate,
        report: &mut Report,
        control: &Control,
    ) -> Result<bool> {
        let mut loose = vec![false; at.residual.len()];
        for f in self.mesh.faces().filter(|f| at.state.angles[f.index()].broken()) {
            self.mesh.face_vertices(f).into_iter().for_each(|v| loose[v.index()] = true);
        }
        if !loose.contains(&true) {
            loose.fill(true);
            at.shift = 0.0;
        }
        let first = FIRST_SHIFT * system.jacobian.mean_diagonal();
        let mut added = if at.shift > SHIFT_GROWTH * first { at.shift / SHIFT_GROWTH } else { 0.0 };
        system.jacobian.add_diagonal(|v| if loose[v] { added } else { 0.0 });
        let mut last = f64::INFINITY;
        for _ in 0..SHIFTS {
            control.check()?;
            report.factorisations += 1;
            let factored = timed(&mut report.seconds.factor, || system.factor()).is_ok();
            control.check()?;
            if factored && self.solve_step(system, at, report)? {
                // If more shift does not shorten the step, it is not long because of loose vertices; the line search will cap it.
                let now = largest(&at.step);
                let settled = now > 0.5 * last;
                last = now;
                if added == 0.0 || now <= self.options.max_step || settled {
                    at.shift = added;
                    report.shifted += usize::from(added > 0.0);
                    return Ok(true);
                }
            }
            let more = if added == 0.0 { first } else { added * SHIFT_GROWTH };
            system.jacobian.add_diagonal(|v| if loose[v] { more } else { 0.0 });
            added += more;
        }
        Ok(false)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::flow::{Flips, Options};
    use crate::geometry::Space;
    use crate::mesh::shapes;
    use crate::metric::{Class, Surface, Target};

    #[test]
    fn a_factor_in_f32_leads_to_the_metric_of_one_in_f64() {
        let options = Options { flips: Flips::Never, threads: 2, ..Options::default() };
        let mut soup = shapes::torus(2.0, 0.9, 160, 80).unwrap();
        shapes::noise(&mut soup, 0.05, 1).unwrap();
        let surface = Surface::from_soup(&soup).unwrap();
        assert!(surface.mesh().n_vertices() > SINGLE_FROM);
        let [single, double] = [true, false].map(|single| {
            let (class, control) = (Class::yamabe(Space::E2), Control::new());
            let mut flow = Flow::new(surface.clone(), class, &options, &control).unwrap();
            flow.single_serves = single;
            let solution = flow.solve(&Target::Uniform, &control).unwrap();
            assert_eq!(flow.system.as_ref().unwrap().is_ready(Precision::F32), single);
            solution
        });
        let [one, other] = [&single, &double].map(|s| s.report().unwrap());
        assert!(one.converged() && one.iterations == other.iterations && one.factorisations == 1);
        let apart = |(a, b): (&f64, &f64)| (a - b).abs();
        let most = single.metric().u.iter().zip(double.metric().u.iter()).map(apart).fold(0.0, f64::max);
        assert!(most < 1e-12, "{most:e}");
    }
}
