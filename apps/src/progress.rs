//! A progress bar on a terminal, and Ctrl-C.

use indicatif::{ProgressBar, ProgressStyle};
use ricci::Control;
use ricci::control::Stage;
use std::io::IsTerminal;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

/// Time between two updates of the bar.
const REFRESH: Duration = Duration::from_millis(100);
/// Runs shorter than this show no bar.
const PATIENCE: Duration = Duration::from_millis(400);

/// Shows where a `Control` is until dropped.
pub struct Progress {
    stop: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Progress {
    /// Watch `control`, if stderr is a terminal and it may be used.
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
                bar.set_message(if control.is_cancelled() { "stopping" } else { stage_name(stage) });
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

/// A control that Ctrl-C cancels.
pub fn cancellable() -> Control {
    let control = Control::new();
    let handle = control.clone();
    // Without a handler Ctrl-C ends the process at once, which leaves nothing half-written either.
    let _ = ctrlc::set_handler(move || handle.cancel());
    control
}
