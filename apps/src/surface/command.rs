//! `ricci surface` as a job: what it refuses, computes and writes.

use super::args::ScanArgs;
use super::figures::{ScanOutcome, WrittenSurface};
use crate::failure::Failure;
use crate::output::{check_extension, check_outputs};
use crate::progress::doing;
use crate::quads::with_positions;
use crate::report::timed;
use crate::runner::{CommandRun, Job, JobHeader};
use crate::seamless::{ConesChoice, chosen_cones};
use ricci::seamless::sharp_edges;
use ricci::spline::{FewPatchesOptions, LayoutFit, LayoutFitOptions, StepOptions, fit_few_patches};

impl Job for ScanArgs {
    type Outcome = ScanOutcome;

    fn header(&self) -> JobHeader<'_> {
        JobHeader { name: "surface", common: &self.common, mesh: Some(&self.surface.file.mesh) }
    }

    fn check(&self) -> Result<(), Failure> {
        check_extension("-o", Some(&self.out), &["step", "stp"])?;
        let table = match &self.cones {
            Some(ConesChoice::Table(path)) => Some(path.as_path()),
            _ => None,
        };
        let read = [Some(&*self.surface.file.mesh), table];
        check_outputs(&read, &[Some(&*self.out), self.common.report.as_deref()])
    }

    fn compute(&self, run: &mut CommandRun<'_>) -> Result<ScanOutcome, Failure> {
        let input = with_positions(&self.surface, run)?;
        let features = self.features.map(|degrees| sharp_edges(&input.surface, degrees.to_radians()));
        let options = FewPatchesOptions {
            cones: self.cones.as_ref().map(|cones| chosen_cones(cones, &input)).transpose()?,
            features: features.transpose()?.unwrap_or_default(),
            fit: LayoutFitOptions {
                tolerance: self.tolerance,
                most_spans: self.spans.into(),
                bending: self.bending,
                threads: self.common.threads,
            },
        };
        let fit = || fit_few_patches(&input.surface, &options, run.control);
        let LayoutFit { seamless, fit, .. } = timed(&mut run.seconds.solve, || doing("fitting", fit))?;
        let mut step = Vec::new();
        let name = self.surface.file.mesh.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let step_options = StepOptions { name, unit: self.unit.length_unit(), colours: self.colours };
        timed(&mut run.seconds.write, || fit.spline.write_step(&step_options, &mut step))?;
        let written = WrittenSurface { normal_jump: fit.spline.normal_jump(), step };
        Ok(ScanOutcome { input, seamless, tolerance: options.fit.limit(&fit), fit, written })
    }

    fn write(&self, outcome: &ScanOutcome, run: &mut CommandRun<'_>) -> Result<(), Failure> {
        run.outputs.add_bytes(&self.out, &outcome.written.step)
    }
}
