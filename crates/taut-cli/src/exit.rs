//! How the command ends: one exit code, and for a failure one line on standard error.

use std::io::ErrorKind;
use std::process::ExitCode;

use crate::watch;

/// How a subcommand that did not fail ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// Done and as asked.
    Done,
    /// A check failed; what and where has been said.
    CheckFailed,
    /// A budget ended the work; the gap reached has been said.
    StoppedEarly,
}

/// Turns the end of a subcommand into the exit code of the process.
pub(crate) fn code(end: anyhow::Result<Outcome>) -> ExitCode {
    match end {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        Ok(Outcome::CheckFailed) => ExitCode::from(1),
        Ok(Outcome::StoppedEarly) => ExitCode::from(3),
        Err(_) if watch::interrupted() => ExitCode::from(watch::INTERRUPTED),
        // Whoever reads our output has enough: `taut ... | head` is no failure.
        Err(error) if is_broken_pipe(&error) => ExitCode::SUCCESS,
        Err(error) => {
            // The outermost sentence is complete; the causes below it say parts of it again.
            eprintln!("taut: {error}");
            ExitCode::from(2)
        }
    }
}

fn is_broken_pipe(error: &anyhow::Error) -> bool {
    error.chain().any(|cause| {
        cause
            .downcast_ref::<std::io::Error>()
            .is_some_and(|cause| cause.kind() == ErrorKind::BrokenPipe)
    })
}
