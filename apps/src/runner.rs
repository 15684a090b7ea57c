//! The frame that every command runs in: one pool of threads, the progress bar, the seconds, the checks, the report, the files and the
//! exit code.
//!
//! A command is a [`Job`]: its arguments, what it computes, and what it writes and reports of that.

use crate::defects::DefectFigures;
use crate::failure::Failure;
use crate::options::Common;
use crate::output::{self, Outputs};
use crate::progress::{Progress, doing};
use crate::report::{
    Attempts, Checks, Done, Figures, InputSummary, PhaseSeconds, RunReport, path_text, timed,
};
use crate::say;
use ricci::Control;
use ricci::control::Stage;
use ricci::parallel::Pool;
use serde::Serialize;
use serde_json::json;
use std::io::Write;
use std::path::Path;
use std::time::Instant;

/// A command with its arguments. The frame calls its methods in the order in which they stand here.
pub trait Job: Serialize + Sync {
    type Outcome: JobOutcome;

    fn header(&self) -> JobHeader<'_>;

    /// Refuse what can be refused before anything is read.
    fn check(&self) -> Result<(), Failure>;

    /// Read the input and compute.
    fn compute(&self, run: &mut CommandRun<'_>) -> Result<Self::Outcome, Failure>;

    /// Write every file that was asked for but the report.
    fn write(&self, outcome: &Self::Outcome, run: &mut CommandRun<'_>) -> Result<(), Failure>;

    /// The options with the defaults put in: a run with these options is this run.
    fn settings<'a>(&'a self, _outcome: &'a Self::Outcome) -> impl Serialize + 'a {
        self
    }
}

/// The parts of a command's arguments that the frame needs.
pub struct JobHeader<'a> {
    /// The name of the command in its report.
    pub name: &'static str,
    pub common: &'a Common,
    /// The mesh file that the report of a failure names; without one a failure is told on stderr alone.
    pub mesh: Option<&'a Path>,
}

/// The surface that a command has read, and everything that it has computed from it.
pub trait JobOutcome: Send {
    /// The type of the result in the report.
    type Figures: Serialize;

    /// The bounds that the outcome is held against.
    fn checks(&self) -> Checks {
        Checks::default()
    }

    /// The surface as the report has it; called only where a report is written, as [`JobOutcome::figures`].
    fn input(&self) -> Option<InputSummary> {
        None
    }

    /// The result as the report has it.
    fn figures(&self, run: &CommandRun<'_>) -> Self::Figures;

    /// The summary for stdout.
    fn summary(&self, done: &Done) -> String;
}

/// The files, seconds and failures that a command gathers on its way.
pub struct CommandRun<'a> {
    pub control: &'a Control,
    /// The files that are complete; none is in place yet.
    pub outputs: Outputs,
    pub seconds: PhaseSeconds,
    /// The options whose files could not be made, with the reasons.
    pub failed: Attempts,
    /// The numbers of vertices and faces that the file of `--uv` has beyond the input's.
    pub added: [usize; 2],
}

impl<'a> CommandRun<'a> {
    fn new(control: &'a Control) -> CommandRun<'a> {
        CommandRun {
            control,
            outputs: Outputs::default(),
            seconds: PhaseSeconds::default(),
            failed: Attempts::default(),
            added: [0; 2],
        }
    }

    /// Write the file of an option, if it is asked for; one that cannot be made keeps none of the others back.
    ///
    /// # Errors
    /// [`Failure::Cancelled`] alone.
    pub fn file(
        &mut self,
        option: &'static str,
        path: Option<&Path>,
        write: impl FnOnce(&mut Outputs, &Path) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let Some(path) = path else { return Ok(()) };
        let written = write(&mut self.outputs, path);
        self.failed.attempt(option, written).map(drop)
    }

    /// [`CommandRun::file`] for a picture.
    ///
    /// # Errors
    /// [`Failure::Cancelled`] alone.
    pub fn picture(
        &mut self,
        option: &'static str,
        path: Option<&Path>,
        draw: impl FnOnce() -> Result<Vec<u8>, Failure>,
    ) -> Result<(), Failure> {
        let drawn = self.draw(path, draw);
        self.failed.attempt(option, drawn).map(drop)
    }

    /// Draw a picture and write it, if it is asked for.
    ///
    /// # Errors
    /// The errors of `draw`, and [`Failure::Failed`] where the file cannot be written.
    pub fn draw(
        &mut self,
        path: Option<&Path>,
        draw: impl FnOnce() -> Result<Vec<u8>, Failure>,
    ) -> Result<(), Failure> {
        let Some(path) = path else { return Ok(()) };
        self.control.check()?;
        let drawn = doing("drawing", || timed(&mut self.seconds.picture, draw));
        self.outputs.add_bytes(path, &drawn?)
    }
}

/// Run a command and say what came out; returns the exit code. A report that was asked for says why the command has failed.
pub fn run(job: &impl Job, control: &Control) -> Result<u8, Failure> {
    let done = execute(job, control).and_then(|done| {
        if !job.header().common.quiet {
            say::lines(&done.summary, &done.files)?;
        }
        Ok(done.exit_code)
    });
    if let Err(failure) = &done
        && let Err(why) = report_failure(job, failure)
    {
        let _ = writeln!(std::io::stderr(), "ricci: {why}");
    }
    done
}

/// Run a command without a word. The exit code is 1 if a check fails or a file that was asked for could not be made.
pub fn execute(job: &impl Job, control: &Control) -> Result<Done, Failure> {
    let start = Instant::now();
    job.check()?;
    // Reading, computing and writing divide their work among the threads of one pool, which starts once.
    Pool::new(job.header().common.threads)?.run(|| execute_in_pool(job, start, control))
}

fn execute_in_pool(job: &impl Job, start: Instant, control: &Control) -> Result<Done, Failure> {
    let JobHeader { name, common, .. } = job.header();
    let progress = Progress::watch(control, common.quiet);
    // The work fills nine tenths of the progress, its files the rest.
    let work = control.part(0.0, 0.9);
    let mut run = CommandRun::new(&work);
    let outcome = job.compute(&mut run)?;
    control.step(Stage::Write, 0.9)?;
    let begin = Instant::now();
    job.write(&outcome, &mut run)?;
    run.seconds.write += begin.elapsed().as_secs_f64() - run.seconds.picture;
    run.seconds.total = start.elapsed().as_secs_f64();
    let checks = outcome.checks();
    control.check()?;
    let mut written = Ok(());
    if let Some(path) = &common.report {
        let report = RunReport::new(name, outcome.input(), job.settings(&outcome), outcome.figures(&run));
        written = run.outputs.add_report(path, &report.finished(checks.clone(), run.seconds));
        control.check()?;
    }
    let left_out = run.outputs.left_out().to_vec();
    // A report that cannot be written keeps none of the others back.
    let files = run.outputs.commit()?.iter().map(|path| path_text(path)).collect();
    written?;
    control.finish();
    drop(progress);
    let exit_code = if run.failed.0.is_empty() { checks.exit_code() } else { 1 };
    let mut done = Done {
        checks,
        failed: run.failed,
        added: run.added,
        left_out,
        files,
        seconds: start.elapsed().as_secs_f64(),
        exit_code,
        summary: String::new(),
    };
    if !common.quiet {
        done.summary = outcome.summary(&done);
    }
    Ok(done)
}

/// Write the report of a command whose input is not what it needs, or that cannot deliver, if a report was asked for. It has no result
/// but `error`: the message, the exit code, and the defects of the input.
fn report_failure(job: &impl Job, failure: &Failure) -> Result<(), Failure> {
    let is_told = matches!(failure.exit_code(), 1 | 3) && !output::in_place();
    let JobHeader { name, common, mesh } = job.header();
    let (Some(path), Some(mesh)) = (common.report.as_ref().filter(|_| is_told), mesh) else { return Ok(()) };
    let (input, defects) = match failure {
        Failure::Defects(found) | Failure::Unglued(found) => {
            let defects: Vec<_> = found.defects.iter().map(DefectFigures::from).collect();
            (Some(InputSummary::new(mesh, &**found)), defects)
        }
        _ => (None, Vec::new()),
    };
    let error = json!({"message": failure.to_string(), "exit_code": failure.exit_code(), "defects": defects});
    let report = RunReport::new(name, input, job, Figures::default().with("error", error));
    let mut outputs = Outputs::default();
    outputs.add_report(path, &report.finished(Checks::default(), PhaseSeconds::default()))?;
    outputs.commit().map(drop)
}
