//! `ricci spline fit` as a job: a spline near a mesh, by least squares.

use super::args::FitArgs;
use super::outcome::FitOutcome;
use super::planar::fit_planar;
use super::whole::fit_whole;
use crate::failure::Failure;
use crate::input;
use crate::options::MeshArgs;
use crate::output::{check_extension, check_outputs};
use crate::report::{Checks, Done, Figures, InputSummary, timed};
use crate::runner::{CommandRun, Job, JobHeader, JobOutcome};
use crate::say::{self, count};
use ricci::spline::Identities;
use serde::Serialize;
use serde_json::{Map, Value};
use std::io::Write;

// Tolerances for errors that are 0 in exact arithmetic.
/// Largest difference of the sum of the basis functions from 1.
const UNITY_TOLERANCE: f64 = 1e-12;
/// Largest error of a polynomial that the basis reproduces.
const REPRODUCTION_TOLERANCE: f64 = 1e-10;
/// Largest jump of a derivative across a side that two patches share.
const CONTINUITY_TOLERANCE: f64 = 1e-8;

/// The options of a run as its report has them.
#[derive(Serialize)]
struct FitSettings<'a> {
    #[serde(flatten)]
    args: &'a FitArgs,
    /// The values that the fit chose for options that were not given.
    #[serde(flatten)]
    defaults: &'a Map<String, Value>,
}

impl Job for FitArgs {
    type Outcome = FitOutcome;

    fn header(&self) -> JobHeader<'_> {
        JobHeader { name: "spline", common: &self.common, mesh: None }
    }

    fn check(&self) -> Result<(), Failure> {
        check_extension("-o", Some(&self.out), &["json"])?;
        check_outputs(&[Some(&self.mesh)], &[Some(&*self.out), self.common.report.as_deref()])
    }

    fn compute(&self, run: &mut CommandRun<'_>) -> Result<FitOutcome, Failure> {
        let control = run.control;
        let file = MeshArgs { mesh: self.mesh.clone(), weld: None };
        let input = input::read(&file, None, &mut run.seconds, control)?;
        let mut outcome = timed(&mut run.seconds.solve, || {
            if self.planar { fit_planar(self, input, control) } else { fit_whole(self, input, control) }
        })?;
        let identities = outcome.spline.identities(self.common.threads, &control.still())?;
        check_identities(&mut outcome.checks, &identities);
        outcome.figures = figures(&outcome, &identities);
        Ok(outcome)
    }

    fn write(&self, outcome: &FitOutcome, run: &mut CommandRun<'_>) -> Result<(), Failure> {
        run.outputs.add(&self.out, |out| out.write_all(outcome.spline.to_json().as_bytes()))
    }

    fn settings<'a>(&'a self, outcome: &'a FitOutcome) -> impl Serialize + 'a {
        FitSettings { args: self, defaults: &outcome.defaults }
    }
}

impl JobOutcome for FitOutcome {
    type Figures = Figures;

    fn checks(&self) -> Checks {
        self.checks.clone()
    }

    fn input(&self) -> Option<InputSummary> {
        Some(InputSummary::of(&self.input))
    }

    fn figures(&self, _: &CommandRun<'_>) -> Figures {
        self.figures.clone()
    }

    fn summary(&self, done: &Done) -> String {
        let space = self.spline.space();
        let filled = match self.spline.holes().len() {
            0 => String::new(),
            n => format!(", {}", count(n, "filled hole", "filled holes")),
        };
        format!(
            "{}spline   degree {}, {}, {}{filled}\nfit      root mean square {:.2e}, largest {:.2e} of the diagonal of the bounding box\n{}wrote    {}\n",
            say::surface(&self.input),
            space.degree(),
            count(space.patches().len(), "patch", "patches"),
            count(space.n_control_points(), "control point", "control points"),
            self.rms,
            self.max,
            done.checks.told(true),
            done.files[0],
        )
    }
}

fn figures(outcome: &FitOutcome, identities: &Identities) -> Figures {
    let space = outcome.spline.space();
    let figures = Figures::default()
        .with("degree", space.degree())
        .with("patches", space.patches().len())
        .with("control_points", space.n_control_points())
        // Fractions of the diagonal of the bounding box.
        .with("rms", outcome.rms)
        .with("max", outcome.max)
        .with("partition_of_unity", identities.partition_of_unity)
        .if_some("polynomial_reproduction", identities.polynomial_reproduction)
        .with("continuity", identities.continuity)
        // The number of sides that two patches share, at corners of the boundary, across which the spline is less smooth than elsewhere.
        .with("rough_sides", identities.rough_sides);
    figures.and(&outcome.figures)
}

fn check_identities(checks: &mut Checks, identities: &Identities) {
    checks.add("partition_of_unity", identities.partition_of_unity, UNITY_TOLERANCE);
    if let Some(error) = identities.polynomial_reproduction {
        checks.add("polynomial_reproduction", error, REPRODUCTION_TOLERANCE);
    }
    checks.add("continuity", identities.continuity, CONTINUITY_TOLERANCE);
}
