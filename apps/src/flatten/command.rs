//! `ricci flatten` as a job: what it refuses, computes, writes and reports.

use super::args::{EnergyChoice, FlattenArgs};
use super::outcome::{FlattenOutcome, PlaneOutcome};
use super::part::{self, Part};
use super::seamed::SeamedMap;
use crate::failure::{Failure, NO_POSITIONS};
use crate::input::Input;
use crate::output::{check_extension, check_mesh_extension, check_outputs};
use crate::progress::doing;
use crate::runner::{CommandRun, Job, JobHeader};
use crate::seamless::ConesChoice;
use ricci::flatten::{FlattenOptions, Flattening, flatten};
use serde::Serialize;
use std::io::Write;

impl Job for FlattenArgs {
    type Outcome = FlattenOutcome;

    fn header(&self) -> JobHeader<'_> {
        JobHeader { name: "flatten", common: &self.common, mesh: Some(&self.surface.file.mesh) }
    }

    fn check(&self) -> Result<(), Failure> {
        check_extension("--uv", self.uv.as_deref(), &["obj", "glb"])?;
        check_mesh_extension("--sphere", self.sphere.as_deref(), &[])?;
        check_extension("--picture", self.picture.picture.as_deref(), &["png", "svg"])?;
        self.flat.check()?;
        if self.has_limits() && (self.pin.is_some() || self.straight.is_some() || self.patch.is_some()) {
            let why = "--strain and --shear open darts, which can take pinned vertices, straight pieces and vertices of a --patch apart";
            return Err(Failure::Usage(why.into()));
        }
        if self.energy == EnergyChoice::Area && self.conformal == Some(0.0) {
            let why = "--conformal 0: maps that keep areas are too many for one to be least; give a share above 0, or leave it out";
            return Err(Failure::Usage(why.into()));
        }
        let files = [
            &self.trace,
            &self.uv,
            &self.sphere,
            &self.flat.flat,
            &self.patch,
            &self.areal,
            &self.shape,
            &self.picture.picture,
            &self.common.report,
        ];
        let cones = match &self.cones {
            Some(ConesChoice::Table(path)) => Some(path.as_path()),
            _ => None,
        };
        let read = [&self.label, &self.weights, &self.pin, &self.straight].map(|file| file.as_deref());
        check_outputs(
            &[&[Some(&*self.surface.file.mesh), cones], &read[..]].concat(),
            &files.map(|file| file.as_deref()),
        )
    }

    fn compute(&self, run: &mut CommandRun<'_>) -> Result<FlattenOutcome, Failure> {
        let part = part::read(&self.surface, self.label.as_deref(), run)?;
        check_surface(self, &part.input)?;
        let options = self.options_with_conditions(&part)?;
        if self.is_round(part.input.mesh()) {
            return Ok(FlattenOutcome::Sphere(Box::new(self.round_map(part.input, &options, run)?)));
        }
        let mut seamed = None;
        let (Part { input, origins, n_whole }, flat, sheet) = if self.has_seams(part.input.mesh()) {
            let found = self.seamed_map(&part.input, &options, run)?;
            let SeamedMap { map, .. } = &found;
            let flat = Flattening { points: map.layout.coordinates.clone(), report: map.report.clone() };
            seamed = Some(found);
            (part, flat, None)
        } else if self.has_limits() {
            let (part, flat, sheet) = self.with_darts(part, &options, run)?;
            (part, flat, Some(sheet))
        } else {
            let flat = doing("flattening", || flatten(&part.input.surface, &options, run.control))?;
            (part, flat, None)
        };
        [run.seconds.layout, run.seconds.solve] = flat.report.seconds;
        Ok(FlattenOutcome::Plane(Box::new(PlaneOutcome {
            input,
            origins,
            n_whole,
            flat,
            sheet,
            seamed,
            tolerance: self.tolerance,
            injective: self.injective,
            has_conditions: self.pin.is_some() || self.straight.is_some(),
            written_turned: Default::default(),
        })))
    }

    fn write(&self, outcome: &FlattenOutcome, run: &mut CommandRun<'_>) -> Result<(), Failure> {
        let report = match outcome {
            FlattenOutcome::Plane(found) => &found.flat.report,
            FlattenOutcome::Sphere(found) => &found.map.report,
        };
        run.file("trace", self.trace.as_deref(), |outputs, path| {
            outputs.add(path, |out| write_energies(out, &report.energies))
        })?;
        let outcome = match outcome {
            FlattenOutcome::Plane(found) => found,
            FlattenOutcome::Sphere(found) => return self.write_round(found, run),
        };
        run.file("uv", self.uv.as_deref(), |outputs, path| outcome.write_uv(outputs, path))?;
        run.file("flat", self.flat.flat.as_deref(), |outputs, path| {
            outcome.write_flat(outputs, path, &self.flat)
        })?;
        run.file("patch", self.patch.as_deref(), |outputs, path| outputs.add_bytes(path, &outcome.patch()?))?;
        run.file("areal", self.areal.as_deref(), |outputs, path| outputs.add_bytes(path, &outcome.areal()?))?;
        run.file("shape", self.shape.as_deref(), |outputs, path| outputs.add_bytes(path, &outcome.shape()?))?;
        run.picture("picture", self.picture.picture.as_deref(), || outcome.draw(self))
    }

    fn settings<'a>(&'a self, outcome: &'a FlattenOutcome) -> impl Serialize + 'a {
        let input_geometry = outcome.source().surface.geometry().name();
        FlattenSettings { input_geometry, args: self, conformal: self.options().conformal_share() }
    }
}

impl FlattenArgs {
    /// The library's options, but for what files say.
    pub fn options(&self) -> FlattenOptions {
        FlattenOptions {
            energy: self.energy.into(),
            conformal: self.conformal,
            tolerance: self.tolerance,
            max_iterations: self.max_iterations,
            rings: self.rings,
            injective: self.injective,
            threads: self.common.threads,
            ..FlattenOptions::default()
        }
    }
}

/// Refuse what can be refused once the surface is known.
fn check_surface(args: &FlattenArgs, input: &Input) -> Result<(), Failure> {
    let mesh = input.mesh();
    if args.is_round(mesh) {
        return args.check_round(input);
    }
    if args.sphere.is_some() {
        let why = "is for closed surfaces of genus 0 without --cones; this one is laid into the plane (--uv, --flat)";
        return Err(Failure::Usage(format!("--sphere {why}")));
    }
    if args.has_seams(mesh) {
        args.check_seamed()?;
    }
    let in_space = input.positions().is_some();
    let drawn = args.picture.picture.is_some() && !args.picture.is_svg();
    let refused = [
        (args.uv.is_some() && !in_space, format!("--uv: {NO_POSITIONS}; use --flat")),
        (drawn && !in_space, format!("--picture: {NO_POSITIONS}; use .svg")),
    ];
    match refused.into_iter().find(|(refused, _)| *refused) {
        Some((_, why)) => Err(Failure::Usage(why)),
        None => args.flat.check_surface(input),
    }
}

/// The energy at the start and after each step.
fn write_energies(out: &mut impl Write, energies: &[f64]) -> std::io::Result<()> {
    writeln!(out, "step,energy")?;
    energies.iter().enumerate().try_for_each(|(step, energy)| writeln!(out, "{step},{energy:?}"))
}

/// The options of a run as its report has them.
#[derive(Serialize)]
struct FlattenSettings<'a> {
    input_geometry: &'static str,
    #[serde(flatten)]
    args: &'a FlattenArgs,
    conformal: f64,
}
