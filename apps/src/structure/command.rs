//! `ricci structure` as a job: what it refuses, computes, writes and reports.

use super::args::{SourceChoice, StructureArgs};
use super::figures::StructureOutcome;
use super::file::AtlasFile;
use super::picture::draw;
use crate::failure::{Failure, NO_POSITIONS};
use crate::input::{self, Input};
use crate::options::FlipsChoice;
use crate::output::{check_extension, check_outputs};
use crate::progress::doing;
use crate::report::timed;
use crate::runner::{CommandRun, Job, JobHeader};
use ricci::flow;
use ricci::mesh::VertexId;
use ricci::structure::{AtlasOptions, atlas};
use serde::Serialize;

impl Job for StructureArgs {
    type Outcome = StructureOutcome;

    fn header(&self) -> JobHeader<'_> {
        JobHeader { name: "structure", common: &self.common, mesh: Some(&self.surface.file.mesh) }
    }

    fn check(&self) -> Result<(), Failure> {
        if matches!((self.from, self.flips), (SourceChoice::Form, FlipsChoice::Never)) {
            let why = "--flips is for the flow, and a structure from a 1-form has none: leave it out";
            return Err(Failure::Usage(why.into()));
        }
        check_extension("--picture", self.picture.picture.as_deref(), &["png"])?;
        let files = [&self.atlas, &self.picture.picture, &self.common.report];
        check_outputs(&[Some(&self.surface.file.mesh)], &files.map(|file| file.as_deref()))
    }

    fn compute(&self, run: &mut CommandRun<'_>) -> Result<StructureOutcome, Failure> {
        let input = input::surface(&self.surface, &mut run.seconds, run.control)?;
        check_surface(self, &input)?;
        let options = AtlasOptions {
            structure: self.kind.into(),
            charts: self.charts.into(),
            radius: self.radius,
            source: self.from.into(),
            singular: self.singular.map(VertexId),
            quads: self.faces,
            flow: flow::Options {
                threads: self.common.threads,
                flips: self.flips.into(),
                ..flow::Options::default()
            },
        };
        let make = || doing("atlas", || atlas(&input.surface, &options, run.control));
        let atlas = timed(&mut run.seconds.solve, make)?;
        Ok(StructureOutcome { input, atlas })
    }

    fn write(&self, outcome: &StructureOutcome, run: &mut CommandRun<'_>) -> Result<(), Failure> {
        let (StructureOutcome { input, atlas }, control) = (outcome, run.control);
        run.file("atlas", self.atlas.as_deref(), |outputs, path| {
            outputs.add_json(path, &AtlasFile::new(atlas))
        })?;
        run.picture("picture", self.picture.picture.as_deref(), || draw(input, atlas, self, control))
    }

    fn settings<'a>(&'a self, outcome: &'a StructureOutcome) -> impl Serialize + 'a {
        let singular = &outcome.atlas.singular_vertices;
        let has_one = self.singular.is_some() || singular.len() == 1;
        StructureSettings {
            input_geometry: outcome.input.surface.geometry().name(),
            singular: singular.first().map(|v| v.0).filter(|_| has_one),
            args: self,
        }
    }
}

/// Refuse what can be refused once the surface is known.
fn check_surface(args: &StructureArgs, input: &Input) -> Result<(), Failure> {
    input.check_vertex("--singular", args.singular)?;
    if args.picture.picture.is_some() && input.positions().is_none() {
        return Err(Failure::Usage(format!("--picture: {NO_POSITIONS}")));
    }
    Ok(())
}

/// The options of a run as its report has them.
#[derive(Serialize)]
struct StructureSettings<'a> {
    input_geometry: &'static str,
    singular: Option<u32>,
    #[serde(flatten)]
    args: &'a StructureArgs,
}
