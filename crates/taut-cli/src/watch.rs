//! Progress on standard error, and stopping on Ctrl-C.
//!
//! *Idea.* Solvers tell a [`Monitor`] of each block from any thread: that is one addition to an atomic counter here,
//! and the bar is drawn from it at most ten times a second. An interrupt sets a flag that the same monitor shows to
//! the solver, which then ends between two blocks; nothing has been written by then, so outputs stay as they were.
//! *Trap.* Where no monitor is asked (reading text, waiting for standard input) a flag would never be seen: there an
//! interrupt ends the process at once, which is safe for the same reason.

use std::io::IsTerminal;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use taut::Monitor;

use crate::effort::Progress;
use crate::output::writing;

/// Exit code after an interrupt: 128 and the number of the signal, as shells have it.
pub(crate) const INTERRUPT_CODE: u8 = 130;

/// States whether an interrupt was asked for while somebody looked.
static STOP: AtomicBool = AtomicBool::new(false);
/// States whether somebody looks.
static WATCHED: AtomicBool = AtomicBool::new(false);

/// Work that is over sooner than this is not worth a bar.
const BAR_DELAY: Duration = Duration::from_millis(300);

/// From now on Ctrl-C ends the work that is watched, or else the process; a second one always the process.
pub(crate) fn stop_on_interrupt() {
    let handler = || {
        if !WATCHED.load(Ordering::SeqCst) || STOP.swap(true, Ordering::SeqCst) {
            taut_io::remove_unfinished();
            std::process::exit(INTERRUPT_CODE.into());
        }
    };
    // Without a handler the system's own stays, which ends the process: no harm.
    ctrlc::set_handler(handler).ok();
}

/// From now on a write beyond the limit of the size of files fails as on a full disk, and what failed is said; left
/// alone, the system would end the process and temporary files would stay.
pub(crate) fn survive_file_limits() {
    #[cfg(unix)]
    signal_hook::flag::register(signal_hook::consts::SIGXFSZ, std::sync::Arc::default()).ok();
}

/// Returns true if watched work was asked to stop.
pub(crate) fn interrupted() -> bool {
    STOP.load(Ordering::SeqCst)
}

/// Watches one step of work after the other.
pub(crate) struct Watch {
    how: Progress,
    terminal: bool,
}

impl Watch {
    pub(crate) fn new(how: Progress) -> Self {
        Watch { how, terminal: std::io::stderr().is_terminal() }
    }

    /// Says how far the work has come, where progress is shown.
    pub(crate) fn print(&self, words: &str) {
        match self.how {
            Progress::Always => writing::print_line(words),
            Progress::Auto if self.terminal => writing::print_line(words),
            Progress::Auto | Progress::Never => {}
        }
    }

    /// Does one step of work with a monitor that shows it as `what` and handles interrupts.
    pub(crate) fn during<R>(&self, what: &str, work: impl FnOnce(&Monitor<'_>) -> R) -> R {
        let lines = self.how == Progress::Always && !self.terminal;
        let bars = self.how != Progress::Never && self.terminal;
        let bar = hidden_bar();
        let (done, shown, start) = (AtomicU64::new(0), AtomicBool::new(false), Instant::now());
        let on_pass = |pass: u64, points: u64| {
            if lines {
                writing::print_line(&format!("{what}: pass {pass} over {points} points"));
            }
            done.store(0, Ordering::Relaxed);
            bar.set_length(points);
            bar.set_prefix(format!("{what}, pass {pass}"));
        };
        let on_points = |points: u64| {
            let done = done.fetch_add(points, Ordering::Relaxed) + points;
            if bars && start.elapsed() > BAR_DELAY {
                if !shown.swap(true, Ordering::Relaxed) {
                    bar.set_draw_target(ProgressDrawTarget::stderr_with_hz(10));
                }
                bar.set_position(done);
            }
        };
        WATCHED.store(true, Ordering::SeqCst);
        let result = work(&Monitor {
            on_points: Some(&on_points),
            on_pass: Some(&on_pass),
            cancel: Some(&STOP),
        });
        WATCHED.store(false, Ordering::SeqCst);
        bar.finish_and_clear();
        result
    }
}

/// A bar that is drawn nowhere until it is given a target.
fn hidden_bar() -> ProgressBar {
    let template = "{prefix} [{bar:32}] {human_pos} of {human_len} points, {elapsed}, {eta} left";
    ProgressBar::with_draw_target(Some(0), ProgressDrawTarget::hidden()).with_style(
        ProgressStyle::with_template(template)
            .expect("the template is well formed")
            .progress_chars("=> "),
    )
}
