//! `ricci seamless` as a job: what it refuses, computes, writes and reports.

use super::args::{ConesChoice, SeamlessArgs};
use super::figures::{SeamlessOutcome, WrittenMap};
use super::picture::draw;
use crate::csv;
use crate::failure::{Failure, NO_POSITIONS};
use crate::input::{self, Input};
use crate::options::OnChoice;
use crate::output::{check_extension, check_outputs};
use crate::progress::doing;
use crate::report::timed;
use crate::runner::{CommandRun, Job, JobHeader};
use crate::solved::SolvedMetric;
use crate::surface_layout::SurfaceLayout;
use crate::uv::{self, UvOptions};
use ricci::control::Stage;
use ricci::seamless::{ConeValence, Seamless, SeamlessCones, SeamlessMap, SeamlessOptions, seamless};

impl Job for SeamlessArgs {
    type Outcome = SeamlessOutcome;

    fn header(&self) -> JobHeader<'_> {
        JobHeader { name: "seamless", common: &self.common, mesh: Some(&self.surface.file.mesh) }
    }

    fn check(&self) -> Result<(), Failure> {
        check_extension("--uv", self.uv.as_deref(), &["obj", "glb"])?;
        check_extension("--picture", self.picture.picture.as_deref(), &["png", "svg"])?;
        let table = match &self.cones {
            ConesChoice::Table(path) => Some(path.as_path()),
            _ => None,
        };
        let files = [&self.uv, &self.xref, &self.metric, &self.picture.picture, &self.common.report];
        check_outputs(&[Some(&self.surface.file.mesh), table], &files.map(|file| file.as_deref()))
    }

    fn compute(&self, run: &mut CommandRun<'_>) -> Result<SeamlessOutcome, Failure> {
        let input = input::surface(&self.surface, &mut run.seconds, run.control)?;
        if self.uv.is_some() && input.positions().is_none() {
            return Err(Failure::Usage(format!("--uv: {NO_POSITIONS}")));
        }
        let options = SeamlessOptions {
            cones: cones(&self.cones, &input)?,
            quarter_turns: self.turning.clone(),
            tolerance: self.tolerance,
            threads: self.common.threads,
            ..SeamlessOptions::default()
        };
        let solve = || doing("solving", || seamless(&input.surface, &options, run.control));
        let found = timed(&mut run.seconds.solve, solve)?;
        let map = map(&input, &found, run)?;
        let target = found.solution.final_target()?;
        let metric = SolvedMetric::new(found.solution.clone(), target)?;
        Ok(SeamlessOutcome { input, found, map, metric })
    }

    fn write(&self, outcome: &SeamlessOutcome, run: &mut CommandRun<'_>) -> Result<(), Failure> {
        let SeamlessOutcome { input, map, metric, .. } = outcome;
        let picture = self.picture.picture.as_deref();
        match map {
            Ok(map) => {
                if let Some(path) = &self.uv {
                    let written = uv::write(&mut run.outputs, path, input, &map.laid, UvOptions::default());
                    if let Some(added) = run.failed.attempt("uv", written)? {
                        run.added = added;
                    }
                }
                run.file("xref", self.xref.as_deref(), |outputs, path| {
                    outputs.add(path, |out| uv::write_origins(out, input, &map.laid, OnChoice::Refined))
                })?;
                run.picture("picture", picture, || draw(outcome, map, self))?;
            }
            Err(why) => {
                let asked = [
                    ("uv", self.uv.is_some()),
                    ("xref", self.xref.is_some()),
                    ("picture", picture.is_some()),
                ];
                run.failed.refuse(why, &asked);
            }
        }
        run.file("metric", self.metric.as_deref(), |outputs, path| metric.write_metric(outputs, path))
    }
}

fn cones(choice: &ConesChoice, input: &Input) -> Result<SeamlessCones, Failure> {
    Ok(match choice {
        ConesChoice::Field => SeamlessCones::Field,
        ConesChoice::Auto(n) => SeamlessCones::Auto(*n),
        ConesChoice::Table(path) => {
            let rows = csv::read_valences(path, input.mesh().n_vertices())?;
            let cone = |(vertex, valence)| ConeValence { vertex, valence };
            SeamlessCones::Valences(rows.into_iter().map(cone).collect())
        }
    })
}

/// The map; why there is none, where it failed.
fn map(
    input: &Input,
    found: &Seamless,
    run: &mut CommandRun<'_>,
) -> Result<Result<WrittenMap, String>, Failure> {
    let control = run.control;
    control.step(Stage::Layout, 0.0)?;
    let lay_out = || -> ricci::Result<WrittenMap> {
        let SeamlessMap { layout, moved } = found.map(control)?;
        Ok(WrittenMap { laid: SurfaceLayout::new(input, &found.solution, layout)?, moved })
    };
    match timed(&mut run.seconds.layout, lay_out) {
        Ok(map) => Ok(Ok(map)),
        Err(ricci::Error::Cancelled) => Err(ricci::Error::Cancelled.into()),
        Err(error) => Ok(Err(error.to_string())),
    }
}
