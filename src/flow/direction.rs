//! The direction of a Newton step: by the factor that is there, by one in single precision, by one in doubles.

use super::Flow;
use super::newton::Iterate;
use super::report::Report;
use super::seconds::timed;
use super::solve::center;
use super::system::{Precision, System};
use crate::control::Control;
use crate::error::Result;
use crate::geometry::largest;
use crate::linalg::conjugate::ResidualBound;

/// First shift of a matrix that is not positive definite, relative to its mean diagonal; grows by [`SHIFT_GROWTH`].
const FIRST_SHIFT: f64 = 1e-12;
/// Factor from one shift to the next: [`SHIFTS`] of them reach the diagonal's own size and beyond.
const SHIFT_GROWTH: f64 = 100.0;
/// Shifts that are tried for one step, at most.
const SHIFTS: usize = 12;
/// The linear residual of a step that is solved with the factor of an earlier matrix, as a share of what is left of the error if it falls
/// quadratically at the rate of the last step \[EW96, choice 2\]: too little to slow that down.
const FORCING: f64 = 0.1;
/// Largest share of the right-hand side that a step leaves which is solved with a factor of another matrix or in single precision.
const MAX_FORCING: f64 = 0.01;
/// Radians. While edges may be flipped, a step by the factor of its own matrix leaves no more than this: what it leaves decides which
/// diagonal a quadrilateral on a circle is flipped to, and a symmetric surface has thousands of those. Later steps leave less anyway.
const TIES: f64 = 1e-10;
/// Radians. No step leaves less than this of a linear residual, a tenth of the rounding of an angle of 1. It is far below the rounding of
/// the curvature because u magnifies what is left over the whole surface.
const LEAST_LEFT: f64 = 2e-17;
/// Radians. Nor less than this at the vertex that is held, where what is left at all the others adds up: the rounding of a curvature.
const LEAST_SUM: f64 = 4e-16;
/// Unknowns from which on a factor in single precision saves time. Below, the first step is exact: one that is not breaks the symmetry of
/// a surface, whose quadrilaterals on a circle are then flipped one way or the other.
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
        self.assemble(&mut system, &at.state, report);
        let mut found = self.direction_near(&mut system, at, report, control)?;
        let is_large = system.unknowns() >= SINGLE_FROM;
        if !found && is_large && self.single_serves && at.is_sound() {
            system = self.analysed(system, Precision::Single, report)?;
            found = self.direction_single(&mut system, at, report, control)?;
            self.single_serves = found;
        }
        if !found {
            system = self.analysed(system, Precision::Double, report)?;
            found = self.direction_of(&mut system, at, report, control)?;
        }
        self.system = Some(system);
        at.solved_at = found.then_some(report.flips);
        Ok(found)
    }

    /// The Newton direction of a matrix that has been assembled, by the factor that an earlier step of this solve has left. False where
    /// that does not pay; it is then not tried again for some steps, more and more of them.
    fn direction_near(
        &self,
        system: &mut System,
        at: &mut Iterate,
        report: &mut Report,
        control: &Control,
    ) -> Result<bool> {
        let (misses, from) = at.misses;
        if at.solved_at.is_none() || report.iterations < from || !at.is_sound() {
            return Ok(false);
        }
        let forcing = f64::min(FORCING * (at.error / at.last_error).powi(2), MAX_FORCING);
        let found = self.solve_near(system, at, forcing, (report, control))?;
        at.misses = if found { (0, 0) } else { (misses + 1, report.iterations + (2 << misses.min(8))) };
        Ok(found)
    }

    /// The Newton direction of a matrix that has been assembled, by its own factor in single precision; false where that does not serve.
    fn direction_single(
        &self,
        system: &mut System,
        at: &mut Iterate,
        report: &mut Report,
        control: &Control,
    ) -> Result<bool> {
        report.factorisations += 1;
        let factored = timed(&mut report.seconds.factor, || system.factor()).is_ok();
        let most = if self.flips_allowed { TIES / at.error } else { MAX_FORCING };
        let forcing = f64::min(FORCING * at.error, f64::min(most, MAX_FORCING));
        Ok(factored && self.solve_near(system, at, forcing, (report, control))?)
    }

    /// `at.step` from `at.residual` with an earlier factor, up to this share of the error; false where that does not pay.
    pub(super) fn solve_near(
        &self,
        system: &mut System,
        at: &mut Iterate,
        share: f64,
        (report, control): (&mut Report, &Control),
    ) -> Result<bool> {
        let [largest, sum] = [LEAST_LEFT, LEAST_SUM].map(|least| f64::max(share * at.error, least));
        let bound = ResidualBound { largest, sum: if self.free_scale() { sum } else { f64::INFINITY } };
        let seconds = &mut report.seconds.solve;
        self.solve_by(at, |residual, step| {
            timed(seconds, || system.solve_near(residual, bound, step, control))
        })
    }

    /// `at.step` from `at.residual` with the last factor; false where it is not finite.
    pub(super) fn solve_step(
        &self,
        system: &mut System,
        at: &mut Iterate,
        report: &mut Report,
    ) -> Result<bool> {
        let seconds = &mut report.seconds.solve;
        self.solve_by(at, |residual, step| Ok(timed(seconds, || system.solve(residual, self.enough(), step))))
    }

    /// `at.step` by a solution of the system for `at.residual`; false where `solve` finds none.
    ///
    /// Where no step changes the total curvature, its rounding is spread over all vertices first, else the one that is held has all of it;
    /// the step is the one that leaves the mean of u.
    fn solve_by(
        &self,
        Iterate { residual, step, .. }: &mut Iterate,
        solve: impl FnOnce(&[f64], &mut [f64]) -> Result<bool>,
    ) -> Result<bool> {
        if self.free_scale() {
            center(residual);
        }
        let found = solve(residual, step)?;
        if found && self.free_scale() {
            center(step);
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
        system: &mut System,
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
            if factored && self.solve_step(system, at, report)? {
                // A step that more shift does not shorten is not the loose vertices': the line search will cap it.
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
    fn single_precision_leads_to_the_metric_of_doubles() {
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
            assert_eq!(flow.system.as_ref().unwrap().is_ready(Precision::Single), single);
            solution
        });
        let [one, other] = [&single, &double].map(|s| s.report().unwrap());
        assert!(one.converged() && one.iterations == other.iterations && one.factorisations == 1);
        let apart = |(a, b): (&f64, &f64)| (a - b).abs();
        let most = single.metric().u.iter().zip(double.metric().u.iter()).map(apart).fold(0.0, f64::max);
        assert!(most < 1e-12, "{most:e}");
    }
}
