//! `ricci forms` as a job: what it refuses, computes, writes and reports.

use super::args::FormsArgs;
use super::file::{BoundsFile, FormsFile};
use super::outcome::FormsOutcome;
use super::picture::{draw, write_uv};
use crate::failure::{Failure, NO_POSITIONS};
use crate::input::{self, Input};
use crate::output::{check_extension, check_outputs};
use crate::runner::{CommandRun, Job, JobHeader};
use serde::Serialize;

impl Job for FormsArgs {
    type Outcome = FormsOutcome;

    fn header(&self) -> JobHeader<'_> {
        JobHeader { name: "forms", common: &self.common, mesh: Some(&self.surface.file.mesh) }
    }

    fn check(&self) -> Result<(), Failure> {
        let picture = self.picture.picture.as_deref();
        check_extension("--uv", self.uv.as_deref(), &["obj", "glb"])?;
        check_extension("--picture", picture, &["png", "svg"])?;
        if !self.combination.is_empty() && self.combination.iter().all(|&x| x == 0.0) {
            let why = "--combination: the form 0 has no zeros and no trajectories; give a coefficient that is not 0";
            return Err(Failure::Usage(why.into()));
        }
        let in_space = self.show.is_some() || self.zoom.is_some() || self.picture.is_turned();
        if self.picture.is_svg() && in_space {
            let why = "--show, --zoom, --view, --up: an SVG shows the integral of the form alone; use .png, or leave them out";
            return Err(Failure::Usage(why.into()));
        }
        let files = [&self.forms, &self.bounds, &self.uv, &self.picture.picture, &self.common.report];
        check_outputs(&[Some(&self.surface.file.mesh)], &files.map(|file| file.as_deref()))
    }

    fn compute(&self, run: &mut CommandRun<'_>) -> Result<FormsOutcome, Failure> {
        let input = input::surface(&self.surface, &mut run.seconds, run.control)?;
        check_surface(self, &input)?;
        FormsOutcome::new(input, self, &mut run.seconds, run.control)
    }

    fn write(&self, outcome: &FormsOutcome, run: &mut CommandRun<'_>) -> Result<(), Failure> {
        let (input, control) = (&outcome.input, run.control);
        run.file("forms", self.forms.as_deref(), |outputs, path| {
            outputs.add_json(path, &FormsFile::new(outcome))
        })?;
        run.file("bounds", self.bounds.as_deref(), |outputs, path| {
            let none =
                || Failure::Failed("the surface has no period matrix, for it is open or a sphere".into());
            let bounds = outcome.bounds.as_ref().ok_or_else(none)?;
            outputs.add_json(path, &BoundsFile::new(bounds, outcome.forms.basis.group.names()))
        })?;
        run.file("uv", self.uv.as_deref(), |outputs, path| {
            write_uv(outputs, path, input, &outcome.chosen()?.layout)
        })?;
        let draw = || draw(input, outcome.chosen()?, self, control);
        run.picture("picture", self.picture.picture.as_deref(), draw)
    }

    fn settings<'a>(&'a self, outcome: &'a FormsOutcome) -> impl Serialize + 'a {
        FormsSettings {
            input_geometry: outcome.input.surface.geometry().name(),
            base: outcome.forms.basis.base.0,
            combination: outcome.chosen.as_ref().map_or(&[], |chosen| &chosen.coefficients),
            args: self,
        }
    }
}

/// Refuse what can be refused once the surface is known.
fn check_surface(args: &FormsArgs, input: &Input) -> Result<(), Failure> {
    input.check_vertex("--base", args.base)?;
    input.check_vertex("--zoom", args.zoom.map(|zoom| zoom.vertex))?;
    let drawn = [
        (args.uv.is_some(), "--uv"),
        (args.picture.picture.is_some() && !args.picture.is_svg(), "--picture: as .png"),
    ];
    match drawn.into_iter().find(|(wanted, _)| *wanted && input.positions().is_none()) {
        Some((_, option)) => Err(Failure::Usage(format!("{option}: {NO_POSITIONS}"))),
        None => Ok(()),
    }
}

/// The options of a run as its report has them.
#[derive(Serialize)]
struct FormsSettings<'a> {
    input_geometry: &'static str,
    base: u32,
    combination: &'a [f64],
    #[serde(flatten)]
    args: &'a FormsArgs,
}
