//! The end of a command: its picture, its report, and all of its files put in place.

use crate::failure::Failure;
use crate::output::Outputs;
use crate::progress::doing;
use crate::report::{Figures, Report, Seconds, path_text, timed};
use ricci::Control;
use ricci::control::Stage;
use serde::Serialize;
use std::path::Path;
use std::time::Instant;

/// The files of one run, from the first that is written until all are in place.
pub struct Delivery<'a> {
    pub outputs: Outputs,
    control: &'a Control,
    start: Instant,
    begin: Instant,
    /// Seconds of drawing.
    drawing: f64,
}

impl<'a> Delivery<'a> {
    /// Nothing written yet; `start`: when the command began.
    ///
    /// # Errors
    /// [`Failure::Cancelled`].
    pub fn new(control: &'a Control, start: Instant) -> Result<Delivery<'a>, Failure> {
        control.step(Stage::Write, 0.0)?;
        let outputs = Outputs::default();
        Ok(Delivery { outputs, control, start, begin: Instant::now(), drawing: 0.0 })
    }

    /// With files that have been written before.
    pub fn with(self, outputs: Outputs) -> Delivery<'a> {
        Delivery { outputs, ..self }
    }

    /// Draw a picture and write it, if it is asked for.
    pub fn picture(
        &mut self,
        path: Option<&Path>,
        draw: impl FnOnce() -> Result<Vec<u8>, Failure>,
    ) -> Result<(), Failure> {
        let Some(path) = path else { return Ok(()) };
        self.control.check()?;
        let drawn = doing("drawing", || timed(&mut self.drawing, draw));
        self.outputs.add_bytes(path, &drawn?)
    }

    /// The control of the run.
    pub fn control(&self) -> &'a Control {
        self.control
    }

    /// Add what writing has taken to the seconds of the run, once all files but the report are written.
    pub fn close(&self, seconds: &mut Seconds) {
        seconds.picture = self.drawing;
        seconds.write += self.begin.elapsed().as_secs_f64() - self.drawing;
        seconds.total = self.start.elapsed().as_secs_f64();
    }

    /// Write the report, if it is asked for, and put every file in place; returns their names. A report that cannot be written keeps none
    /// of the others back.
    pub fn commit<O: Serialize>(
        mut self,
        path: Option<&Path>,
        report: impl FnOnce() -> Report<O, Figures>,
    ) -> Result<Vec<String>, Failure> {
        self.control.check()?;
        let reported = path.map_or(Ok(()), |path| self.outputs.add_report(path, &report()));
        self.control.check()?;
        let files = self.outputs.commit()?.iter().map(|p| path_text(p)).collect();
        reported.map(|()| files)
    }
}
