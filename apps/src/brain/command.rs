//! `ricci brain` as a job: what it refuses, computes, writes and reports.

use super::args::BrainArgs;
use super::outcome::{BrainOutcome, Made};
use super::side::HemisphereSide;
use crate::failure::Failure;
use crate::output::check_outputs;
use crate::runner::{CommandRun, Job, JobHeader};
use std::path::Path;
use std::time::SystemTime;

impl Job for BrainArgs {
    type Outcome = BrainOutcome;

    fn header(&self) -> JobHeader<'_> {
        JobHeader { name: "brain", common: &self.common, mesh: self.surfaces.first().map(|path| &**path) }
    }

    fn check(&self) -> Result<(), Failure> {
        let sides = self.sides()?;
        if !self.label.is_empty() && self.label.len() != self.surfaces.len() {
            let (labels, surfaces) = (self.label.len(), self.surfaces.len());
            let why = format!(
                "{labels} labels for {surfaces} surfaces: give one for each, in their order, or none"
            );
            return Err(Failure::Usage(why));
        }
        std::fs::create_dir_all(&*self.out)
            .map_err(|e| Failure::Usage(format!("--out {}: {e}", self.out.display())))?;
        let endings = self.endings();
        let mut files: Vec<_> = sides
            .iter()
            .flat_map(|&side| endings.iter().map(move |ending| self.file(side, ending)))
            .collect();
        files.extend(self.common.report.as_ref().map(|path| path.to_path_buf()));
        let read: Vec<Option<&Path>> =
            self.surfaces.iter().chain(&self.label).map(|path| Some(&**path)).collect();
        check_outputs(&read, &files.iter().map(|path| Some(&**path)).collect::<Vec<_>>())
    }

    fn compute(&self, run: &mut CommandRun<'_>) -> Result<BrainOutcome, Failure> {
        let (sides, n) = (self.sides()?, self.surfaces.len());
        let mut made = Vec::new();
        for (k, (&side, path)) in sides.iter().zip(&self.surfaces).enumerate() {
            let label = self.label.get(k).map(|label| &**label);
            made.push(if self.resume && self.is_done(side, path, label) {
                Made::Kept { side, path: path.to_path_buf() }
            } else {
                let found = self.hemisphere(side, path, label, &run.control.part_of(k, n))?;
                Made::New(Box::new(found))
            });
        }
        Ok(BrainOutcome { made, radius: self.radius, written_turned: Default::default() })
    }

    fn write(&self, outcome: &BrainOutcome, run: &mut CommandRun<'_>) -> Result<(), Failure> {
        for made in &outcome.made {
            if let Made::New(hemisphere) = made {
                let turned = self.write_hemisphere(hemisphere, run)?;
                outcome.written_turned.lock().map_err(|e| Failure::Failed(e.to_string()))?.push(turned);
            }
        }
        Ok(())
    }
}

impl BrainArgs {
    /// True if all files of a hemisphere are there and none is older than what it is made from.
    fn is_done(&self, side: HemisphereSide, surface: &Path, label: Option<&Path>) -> bool {
        let time = |path: &Path| -> Option<SystemTime> { path.metadata().ok()?.modified().ok() };
        let made_from: Option<Vec<SystemTime>> =
            [Some(surface), label].into_iter().flatten().map(time).collect();
        let made: Option<Vec<SystemTime>> =
            self.endings().iter().map(|ending| time(&self.file(side, ending))).collect();
        match (
            made_from.and_then(|times| times.into_iter().max()),
            made.and_then(|times| times.into_iter().min()),
        ) {
            (Some(from), Some(made)) => made >= from,
            _ => false,
        }
    }
}
