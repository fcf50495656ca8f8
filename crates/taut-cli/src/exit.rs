//! How the command ends: one exit code, and for a failure one line on standard error.

use std::process::ExitCode;

use crate::{watch, writing};

/// How a subcommand that did not fail ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// Done and as asked.
    Done,
    /// A check failed; what and where has been said.
    CheckFailed,
    /// Stopped early by a budget, or where rounding hides the gap that was asked for; the one reached has been said.
    StoppedEarly,
}

/// Turns the end of a subcommand into the exit code of the process.
pub(crate) fn code(end: anyhow::Result<Outcome>) -> ExitCode {
    match end {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        Ok(Outcome::CheckFailed) => ExitCode::from(1),
        Ok(Outcome::StoppedEarly) => ExitCode::from(3),
        Err(_) if watch::interrupted() => ExitCode::from(watch::INTERRUPTED),
        Err(error) => {
            // The outermost sentence is complete; the causes below it say parts of it again.
            writing::complain(&error.to_string());
            ExitCode::from(2)
        }
    }
}
