//! Progress and cancellation of one long call, shared across threads.
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
#[derive(Clone, Default)]
pub struct Control(Arc<ControlState>);

impl Control {
    /// A fresh handle: no progress, not cancelled.
    pub fn new() -> Self {
        Self::default()
    }

    /// Ask the call to stop. It cannot be taken back; use a new handle for the next call.
    pub fn cancel(&self) {
        let mut at = self.0.cancelled_at.lock().unwrap_or_else(PoisonError::into_inner);
        at.get_or_insert_with(Instant::now);
        self.0.cancelled.store(true, Ordering::Release);
    }

    /// True if [`Control::cancel`] was called.
    pub fn is_cancelled(&self) -> bool {
        self.0.cancelled.load(Ordering::Acquire)
    }

    /// Time since [`Control::cancel`] was called; right after a call has returned [`Error::Cancelled`] this is
    /// its latency.
    pub fn since_cancel(&self) -> Option<Duration> {
        self.0.cancelled_at.lock().unwrap_or_else(PoisonError::into_inner).map(|at| at.elapsed())
    }

    /// The current stage and the fraction of it that is done, in [0, 1].
    pub fn progress(&self) -> (Stage, f64) {
        let stage = Stage::ALL[self.0.stage.load(Ordering::Relaxed) as usize % Stage::ALL.len()];
        (stage, f64::from_bits(self.0.fraction.load(Ordering::Relaxed)))
    }

    /// Reports the stage and the fraction of it that is done. Long calls repeat this, and end where it fails.
    ///
    /// # Errors
    ///
    /// [`Error::Cancelled`] if the call was cancelled.
    pub fn step(&self, stage: Stage, fraction: f64) -> Result<()> {
        self.0.stage.store(stage as u8, Ordering::Relaxed);
        self.0.fraction.store(fraction.clamp(0.0, 1.0).to_bits(), Ordering::Relaxed);
        self.check()
    }

    /// Like [`Control::step`], without a report.
    ///
    /// # Errors
    ///
    /// [`Error::Cancelled`] if the call was cancelled.
    pub fn check(&self) -> Result<()> {
        if self.is_cancelled() { Err(Error::Cancelled) } else { Ok(()) }
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
}
