//! Defines how the command ends: one exit code, and for a failure one line on standard error.

use std::io::Write;
use std::process::ExitCode;

use crate::output::writing;
use crate::watch;

/// The exit code for bad input or usage, and for what the system refuses.
pub(crate) const FAILURE_CODE: u8 = 2;

/// The way in which a subcommand that did not fail ended.
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
        Err(_) if watch::interrupted() => ExitCode::from(watch::INTERRUPT_CODE),
        Err(error) => {
            // The outermost sentence is complete; the causes below it say parts of it again.
            writing::print_error(&error.to_string());
            ExitCode::from(FAILURE_CODE)
        }
    }
}

/// Says why there is no command to run: help and the version on standard output, or what is wrong with the words given.
pub(crate) fn unparsed(unparsed: &clap::Error) -> ExitCode {
    if unparsed.use_stderr() {
        // The result is the same if nobody reads it.
        unparsed.print().ok();
        return ExitCode::from(FAILURE_CODE);
    }
    let printed = unparsed.print().and_then(|()| std::io::stdout().flush());
    code(writing::unless_closed(printed).map(|()| Outcome::Done))
}
