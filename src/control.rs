//! Progress and cancellation of one long call, shared across threads. Progress runs from 0 to 1 over the whole call and never goes back: a
//! part of the work reports into its own part of that range ([`Control::part`]).
//!
//! ```
//! use ricci::control::Stage;
//! use ricci::{Control, Error};
//! let control = Control::new();
//! let other = control.clone(); // for another thread
//! control.step(Stage::Flow, 0.5)?;
//! assert_eq!(other.progress(), (Stage::Flow, 0.5));
//! other.cancel();
//! assert_eq!(control.step(Stage::Flow, 0.6), Err(Error::Cancelled));
//! # Ok::<(), Error>(())
//! ```

use crate::error::{Error, Result};
use std::panic::{RefUnwindSafe, UnwindSafe};
use std::sync::atomic::{AtomicBool, AtomicU8, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The stage of a long call.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Stage {
    /// Nothing has started.
    Idle = 0,
    /// Reading a file.
    Read = 1,
    /// Building connectivity.
    Build = 2,
    /// Solving for the metric.
    Flow = 3,
    /// Laying the metric out.
    Layout = 4,
    /// Writing a file.
    Write = 5,
}

impl Stage {
    const ALL: [Stage; 6] =
        [Stage::Idle, Stage::Read, Stage::Build, Stage::Flow, Stage::Layout, Stage::Write];
}

/// A question whether a call is to end, asked with the stage and the fraction of the call that is done.
pub trait EndQuestion: Fn((Stage, f64)) -> bool + Send + Sync + UnwindSafe + RefUnwindSafe {}

impl<Q: Fn((Stage, f64)) -> bool + Send + Sync + UnwindSafe + RefUnwindSafe> EndQuestion for Q {}

#[derive(Default)]
struct ControlState {
    cancelled: AtomicBool,
    cancelled_at: Mutex<Option<Instant>>,
    stage: AtomicU8,
    fraction: AtomicU64,
}

/// Handle on a running call: any thread may read its progress or cancel it. Clones share one state.
///
/// A cancelled call returns [`Error::Cancelled`] at its next check and leaves its inputs unchanged; a sparse
/// factorisation under way finishes first.
#[derive(Clone)]
pub struct Control {
    state: Arc<ControlState>,
    /// The fractions of the whole call at which the work that holds this handle begins and ends.
    range: [f64; 2],
    /// A question that is asked at every check.
    question: Option<Arc<dyn EndQuestion>>,
}

impl Default for Control {
    fn default() -> Self {
        Control { state: Arc::default(), range: [0.0, 1.0], question: None }
    }
}

impl Control {
    /// A fresh handle: no progress, not cancelled.
    pub fn new() -> Self {
        Self::default()
    }

    /// The handle for a part of the work, which fills the fractions `from` to `to` of what this handle fills.
    pub fn part(&self, from: f64, to: f64) -> Control {
        let [begin, end] = self.range;
        let at = |fraction: f64| begin + (end - begin) * fraction.clamp(0.0, 1.0);
        Control { range: [at(from), at(to)], ..self.clone() }
    }

    /// The handle for the part with the number `k` of `n` parts of equal length.
    pub fn part_of(&self, k: usize, n: usize) -> Control {
        let n = n.max(1) as f64;
        self.part(k as f64 / n, (k + 1) as f64 / n)
    }

    /// The same handle, whose checks fail with [`Error::Cancelled`] also when `question` answers true. It is asked at every check, by any
    /// thread, with this handle's stage and progress. The C face asks whether the system has refused memory, so that calls end before their
    /// reserves are used up; tests count the checks.
    pub fn asking(&self, question: Arc<dyn EndQuestion>) -> Control {
        Control { question: Some(question), ..self.clone() }
    }

    /// The handle for attempt number `k`, where the first that succeeds ends the work: it fills three quarters of what earlier ones leave.
    pub fn attempt(&self, k: usize) -> Control {
        let left = |k: usize| 0.25f64.powi(k.min(64) as i32);
        self.part(1.0 - left(k), 1.0 - left(k + 1))
    }

    /// The handle for work whose length is not known: it is checked, and does not change the progress.
    pub fn still(&self) -> Control {
        self.part(0.0, 0.0)
    }

    /// Ask the call to stop. It cannot be taken back; use a new handle for the next call.
    pub fn cancel(&self) {
        let mut at = self.state.cancelled_at.lock().unwrap_or_else(PoisonError::into_inner);
        at.get_or_insert_with(Instant::now);
        self.state.cancelled.store(true, Ordering::Release);
    }

    /// True if [`Control::cancel`] was called.
    pub fn is_cancelled(&self) -> bool {
        self.state.cancelled.load(Ordering::Acquire)
    }

    /// Time since [`Control::cancel`] was called; right after a call has returned [`Error::Cancelled`] this is
    /// its latency.
    pub fn since_cancel(&self) -> Option<Duration> {
        self.state.cancelled_at.lock().unwrap_or_else(PoisonError::into_inner).map(|at| at.elapsed())
    }

    /// The current stage and the fraction of the whole call that is done, in [0, 1].
    pub fn progress(&self) -> (Stage, f64) {
        let stage = Stage::ALL[self.state.stage.load(Ordering::Relaxed) as usize % Stage::ALL.len()];
        (stage, f64::from_bits(self.state.fraction.load(Ordering::Relaxed)))
    }

    /// Progress is 0 again, for the next call with this handle.
    pub fn restart(&self) {
        self.state.stage.store(Stage::Idle as u8, Ordering::Relaxed);
        self.state.fraction.store(0, Ordering::Relaxed);
    }

    /// The work of this handle is done: its range is filled, whatever its last step was.
    pub fn finish(&self) {
        self.advance(1.0);
    }

    /// Positive numbers are ordered as their bits are, so that the larger fraction stays.
    fn advance(&self, fraction: f64) {
        let [begin, end] = self.range;
        let at = begin + (end - begin) * fraction.clamp(0.0, 1.0);
        self.state.fraction.fetch_max(at.max(0.0).to_bits(), Ordering::Relaxed);
    }

    /// Reports the stage and the fraction of this handle's work that is done; one that is less than an earlier one, or no number, changes
    /// nothing. Long calls repeat this, and end where it fails.
    ///
    /// # Errors
    ///
    /// [`Error::Cancelled`] if the call was cancelled.
    pub fn step(&self, stage: Stage, fraction: f64) -> Result<()> {
        self.state.stage.store(stage as u8, Ordering::Relaxed);
        self.advance(fraction);
        self.check()
    }

    /// Like [`Control::step`], without a report.
    ///
    /// # Errors
    ///
    /// [`Error::Cancelled`] if the call was cancelled.
    pub fn check(&self) -> Result<()> {
        let asked = || self.question.as_ref().is_some_and(|question| question(self.progress()));
        if self.is_cancelled() || asked() { Err(Error::Cancelled) } else { Ok(()) }
    }

    /// [`Control::check`] before the first step and then before every `every`-th one; counts the step in `steps`. For loops whose steps
    /// take less time than reading the handle.
    pub(crate) fn check_every(&self, every: usize, steps: &mut usize) -> Result<()> {
        *steps += 1;
        if (*steps - 1).is_multiple_of(every) { self.check() } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clones_share_progress_and_cancellation() {
        let control = Control::new();
        let other = control.clone();
        assert!(other.step(Stage::Flow, 0.25).is_ok());
        assert_eq!(control.progress(), (Stage::Flow, 0.25));
        assert!(control.since_cancel().is_none());
        control.cancel();
        assert_eq!(other.step(Stage::Flow, 0.5), Err(Error::Cancelled));
        assert!(other.since_cancel().is_some());
    }
    #[test]
    fn progress_of_parts_fills_the_whole_and_never_goes_back() {
        let control = Control::new();
        let mut seen = Vec::new();
        for k in 0..2 {
            let half = control.part_of(k, 2);
            for fraction in [0.0, 0.5, 0.25, f64::NAN] {
                half.part(0.0, 0.5).step(Stage::Flow, fraction).unwrap();
                seen.push(control.progress().1);
            }
            half.finish();
            seen.push(control.progress().1);
        }
        assert_eq!(seen, [0.0, 0.125, 0.125, 0.125, 0.5, 0.5, 0.625, 0.625, 0.625, 1.0]);
        control.restart();
        assert_eq!(control.progress(), (Stage::Idle, 0.0));
    }

    #[test]
    fn a_question_ends_the_call_without_cancelling_the_handle() {
        let control = Control::new();
        let asking = control.asking(Arc::new(|(stage, fraction)| stage == Stage::Flow && fraction > 0.5));
        assert_eq!(asking.step(Stage::Flow, 0.5), Ok(()));
        assert_eq!(asking.part(0.5, 1.0).step(Stage::Flow, 0.1), Err(Error::Cancelled));
        assert_eq!(control.check(), Ok(()));
    }
}
