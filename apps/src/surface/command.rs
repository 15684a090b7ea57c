//! `ricci surface` as a job: what it refuses, computes and writes.

use super::args::{ScanArgs, ScanColor};
use super::figures::{ScanOutcome, WrittenSurface};
use super::picture::{PARTS, draw};
use crate::failure::Failure;
use crate::input::{Input, polygons};
use crate::output::{check_extension, check_mesh_extension, check_outputs, format_of};
use crate::progress::doing;
use crate::quads::with_positions;
use crate::report::timed;
use crate::runner::{CommandRun, Job, JobHeader};
use crate::seamless::{ConesChoice, chosen_cones};
use ricci::mesh::io::{self, Attributes};
use ricci::seamless::{Seamless, sharp_edges};
use ricci::spline::{
    ControlMesh, ControlMeshFit, FewPatchesOptions, LayoutFit, LayoutFitOptions, QuadFit, StepOptions,
    TessellationSize, fit_control_mesh, fit_few_patches,
};

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
        if self.combs && self.color == ScanColor::Distance {
            return Err(Failure::Usage(
                "--combs: --color distance draws the mesh, which has no patches".into(),
            ));
        }
        check_extension("--patches", self.patches.as_deref(), &["json"])?;
        check_mesh_extension("--triangles", self.triangles.as_deref(), &[])?;
        check_extension("--picture", self.picture.picture.as_deref(), &["png"])?;
        let read = [Some(&*self.surface.file.mesh), table];
        let files = [
            Some(&self.out),
            self.patches.as_ref(),
            self.triangles.as_ref(),
            self.picture.picture.as_ref(),
            self.common.report.as_ref(),
        ];
        check_outputs(&read, &files.map(|file| file.map(|f| &**f)))
    }

    fn compute(&self, run: &mut CommandRun<'_>) -> Result<ScanOutcome, Failure> {
        let fit_options = LayoutFitOptions {
            tolerance: self.tolerance,
            most_spans: self.spans.into(),
            bending: self.bending,
            threads: self.common.threads,
        };
        let Fitted { input, seamless, fit } = if self.from_quads {
            self.fitted_to_limit(&fit_options, run)?
        } else {
            self.fitted_to_scan(&fit_options, run)?
        };
        let mut step = Vec::new();
        let name = self.surface.file.mesh.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let step_options = StepOptions { name, unit: self.unit.length_unit(), colours: self.colours };
        timed(&mut run.seconds.write, || fit.spline.write_step(&step_options, &mut step))?;
        let written = WrittenSurface {
            normal_jump: fit.spline.normal_jump(),
            n_faces: fit.spline.n_step_faces()?,
            step,
        };
        Ok(ScanOutcome { input, seamless, tolerance: fit_options.limit(&fit), fit, written })
    }

    fn write(&self, outcome: &ScanOutcome, run: &mut CommandRun<'_>) -> Result<(), Failure> {
        let spline = &outcome.fit.spline;
        run.outputs.add_bytes(&self.out, &outcome.written.step)?;
        run.file("patches", self.patches.as_deref(), |outputs, path| {
            outputs.add(path, |mut out| spline.write_json(&mut out))
        })?;
        let (threads, control) = (self.common.threads, run.control);
        run.file("triangles", self.triangles.as_deref(), |outputs, path| {
            let soup = spline.tessellate(TessellationSize::Parts(PARTS), threads, control)?;
            let format = format_of(path)?;
            outputs.add_named(path, |path| io::write_as(path, format, &soup).map(drop))
        })?;
        run.picture("picture", self.picture.picture.as_deref(), || draw(outcome, self, control))
    }
}

/// A fit with the surface that it is fitted to.
struct Fitted {
    input: Input,
    seamless: Option<Seamless>,
    fit: QuadFit,
}

impl ScanArgs {
    fn fitted_to_scan(
        &self,
        fit_options: &LayoutFitOptions,
        run: &mut CommandRun<'_>,
    ) -> Result<Fitted, Failure> {
        let input = with_positions(&self.surface, run)?;
        let features = self.features.map(|degrees| sharp_edges(&input.surface, degrees.to_radians()));
        let options = FewPatchesOptions {
            cones: self.cones.as_ref().map(|cones| chosen_cones(cones, &input)).transpose()?,
            features: features.transpose()?.unwrap_or_default(),
            fit: fit_options.clone(),
        };
        let fit = || fit_few_patches(&input.surface, &options, run.control);
        let LayoutFit { seamless, fit, .. } = timed(&mut run.seconds.solve, || doing("fitting", fit))?;
        Ok(Fitted { input, seamless: Some(seamless), fit })
    }

    /// A fit to the Catmull–Clark surface of the file's polygons.
    fn fitted_to_limit(
        &self,
        fit_options: &LayoutFitOptions,
        run: &mut CommandRun<'_>,
    ) -> Result<Fitted, Failure> {
        let mesh = &self.surface.file.mesh;
        let control_mesh = timed(&mut run.seconds.read, || {
            let (positions, faces) = polygons(mesh)?;
            ControlMesh::new(positions, faces)
        })?;
        let fit = || fit_control_mesh(&control_mesh, fit_options, run.control);
        let ControlMeshFit { surface, fit, .. } = timed(&mut run.seconds.solve, || doing("fitting", fit))?;
        let input =
            Input { path: mesh.to_path_buf(), surface, attributes: Attributes::default(), split: None };
        Ok(Fitted { input, seamless: None, fit })
    }
}
