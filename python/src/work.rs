//! Long work beside a live interpreter, also in a process that was forked.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::time::Duration;

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::{ThreadPoolBuildError, ThreadPoolBuilder};
use taut::Monitor;

/// The interval at which Python is asked whether a signal has come. It delays a Ctrl-C, never a result.
const SIGNAL_INTERVAL: Duration = Duration::from_millis(50);

/// Runs `work` on a thread of its own with the interpreter released, and cancels it when Python has a signal whose
/// handler raises (Ctrl-C): then the exception of that handler is returned.
pub(crate) fn interruptible<R: Send>(
    py: Python<'_>,
    work: impl FnOnce(&Monitor<'_>) -> R + Send,
) -> PyResult<R> {
    let (mut work, mut found) = (Some(work), None);
    run(py, &mut |monitor| found = work.take().map(|work| work(monitor)))?;
    Ok(found.expect("work that ended without an exception has a result"))
}

/// As [`interruptible`], compiled once for all kinds of work.
fn run(py: Python<'_>, work: &mut (dyn FnMut(&Monitor<'_>) + Send)) -> PyResult<()> {
    let (cancel, done) = (AtomicBool::new(false), AtomicBool::new(false));
    let listener = std::thread::current();
    std::thread::scope(|scope| {
        let worker = scope.spawn(|| {
            let monitor = Monitor { cancel: Some(&cancel), ..Monitor::silent() };
            let result = with_living_threads(&mut || work(&monitor));
            done.store(true, Ordering::Release);
            listener.unpark();
            result
        });
        let mut raised = Ok(());
        // `done` ends the wait at once; a thread that panicked never sets it, but is finished.
        while raised.is_ok() && !done.load(Ordering::Acquire) && !worker.is_finished() {
            py.detach(|| std::thread::park_timeout(SIGNAL_INTERVAL));
            raised = py.check_signals();
        }
        cancel.store(raised.is_err(), Ordering::Relaxed);
        let result = py.detach(|| worker.join()).unwrap_or_else(|panic| resume_unwind(panic));
        raised?;
        result.map_err(|error| PyRuntimeError::new_err(format!("no threads to work with: {error}")))
    })
}

/// Runs `work` in a pool whose threads live in this process.
///
/// *Trap.* A forked child, as `multiprocessing` makes them, inherits rayon's global pool without its threads, and
/// would wait for them endlessly; nor has it the helpers that `taut_points` has for loops outside of a pool. So the process
/// that works first keeps that pool, and each of its forks builds one for each call: that costs the start of its threads.
/// One kept for longer would need a lock, and a lock can be inherited locked.
fn with_living_threads(work: &mut (dyn FnMut() + Send)) -> Result<(), ThreadPoolBuildError> {
    /// The process whose global pool it is; no process has the number 0.
    static OWNER: AtomicU32 = AtomicU32::new(0);
    let this = std::process::id();
    match OWNER.compare_exchange(0, this, Ordering::Relaxed, Ordering::Relaxed) {
        Err(owner) if owner != this => ThreadPoolBuilder::new().build()?.install(work),
        _ => work(),
    }
    Ok(())
}
