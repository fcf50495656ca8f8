//! Long work beside a live interpreter.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use pyo3::prelude::*;
use taut::Monitor;

/// How often Python is asked whether a signal has come. It delays a Ctrl-C, never a result.
const LISTEN: Duration = Duration::from_millis(50);

/// Runs `work` on a thread of its own with the interpreter released, and cancels it when Python has a signal whose
/// handler raises (Ctrl-C): then the exception of that handler is returned.
pub(crate) fn interruptible<R: Send>(
    py: Python<'_>,
    work: impl FnOnce(&Monitor<'_>) -> R + Send,
) -> PyResult<R> {
    let (cancel, done) = (AtomicBool::new(false), AtomicBool::new(false));
    let listener = std::thread::current();
    std::thread::scope(|scope| {
        let worker = scope.spawn(|| {
            let result = work(&Monitor { cancel: Some(&cancel), ..Monitor::silent() });
            done.store(true, Ordering::Release);
            listener.unpark();
            result
        });
        let mut raised = Ok(());
        // `done` ends the wait at once; a thread that panicked never sets it, but is finished.
        while raised.is_ok() && !done.load(Ordering::Acquire) && !worker.is_finished() {
            py.detach(|| std::thread::park_timeout(LISTEN));
            raised = py.check_signals();
        }
        cancel.store(raised.is_err(), Ordering::Relaxed);
        let result = py.detach(|| worker.join()).unwrap_or_else(|panic| resume_unwind(panic));
        raised.map(|()| result)
    })
}
