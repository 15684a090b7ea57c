//! The progress bar on a terminal, and the handler of Ctrl-C.

use crate::failure::Failure;
use crate::output;
use indicatif::{ProgressBar, ProgressStyle};
use ricci::Control;
use ricci::control::Stage;
use std::io::{IsTerminal, Write};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

/// Time between two updates of the bar.
const REFRESH: Duration = Duration::from_millis(100);
/// Runs shorter than this show no bar.
const PATIENCE: Duration = Duration::from_millis(400);
/// Time that work has to end by itself after Ctrl-C. Together with the time in which the memory of a large picture is freed, the process
/// ends within a tenth of a second.
const GRACE: Duration = Duration::from_millis(25);

/// The name of the work under way, where the library has no stage for it.
static WORK: Mutex<Option<&str>> = Mutex::new(None);

/// A progress bar that follows a `Control` until it is dropped.
pub struct Progress {
    stop: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Progress {
    /// Follow `control`, if stderr is a terminal and the command is not to be quiet.
    pub fn watch(control: &Control, quiet: bool) -> Progress {
        if quiet || !std::io::stderr().is_terminal() {
            return Progress { stop: None, thread: None };
        }
        let (stop, stopped) = channel();
        let control = control.clone();
        let thread = std::thread::spawn(move || {
            if stopped.recv_timeout(PATIENCE) != Err(RecvTimeoutError::Timeout) {
                return;
            }
            let bar = ProgressBar::new(1000);
            if let Ok(style) = ProgressStyle::with_template("{msg:<12} {bar:40} {percent:>3} %  {elapsed}") {
                bar.set_style(style);
            }
            while stopped.recv_timeout(REFRESH) == Err(RecvTimeoutError::Timeout) {
                let (stage, fraction) = control.progress();
                let work = WORK.lock().unwrap_or_else(PoisonError::into_inner).unwrap_or(stage_name(stage));
                bar.set_message(if control.is_cancelled() { "stopping" } else { work });
                bar.set_position((1000.0 * fraction) as u64);
            }
            bar.finish_and_clear();
        });
        Progress { stop: Some(stop), thread: Some(thread) }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        drop(self.stop.take());
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// Do some work under a name that the bar shows.
pub fn doing<T>(what: &'static str, work: impl FnOnce() -> T) -> T {
    let name = |what| *WORK.lock().unwrap_or_else(PoisonError::into_inner) = what;
    name(Some(what));
    let done = work();
    name(None);
    done
}

fn stage_name(stage: Stage) -> &'static str {
    match stage {
        Stage::Idle => "",
        Stage::Read => "reading",
        Stage::Build => "building",
        Stage::Flow => "flowing",
        Stage::Layout => "laying out",
        Stage::Write => "writing",
    }
}

/// A control that Ctrl-C cancels. If work has not ended a moment later, the process ends: none of its files is in place yet, and the
/// temporary ones are removed.
pub fn cancellable() -> Control {
    let control = Control::new();
    let handle = control.clone();
    // If no handler can be set, Ctrl-C ends the process at once: temporary files are left behind, but no output is half-written.
    let _ = ctrlc::set_handler(move || {
        handle.cancel();
        std::thread::sleep(GRACE);
        if output::abandon() {
            let _ = writeln!(std::io::stderr(), "ricci: {}", Failure::Cancelled);
            std::process::exit(Failure::Cancelled.exit_code().into());
        }
    });
    control
}
