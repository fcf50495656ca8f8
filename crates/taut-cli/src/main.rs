//! The `taut` command: tight shapes of point sets, with proof.
//!
//! A subcommand is its options, its solver and its side outputs ([`commands`]); the [`pipeline`] opens, solves, checks,
//! writes and reports, the same for all. What is said about an answer is in [`reports`]. Nothing is calculated here: the
//! answers are those of the library crates, and so are the checks.

mod cli;
mod clock;
mod commands;
mod effort;
mod exit;
mod input;
mod out_of_memory;
mod output;
mod pipeline;
mod reports;
mod watch;

use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = match cli::Cli::parsed() {
        Ok(cli) => cli,
        Err(unparsed) => return exit::unparsed(&unparsed),
    };
    watch::stop_on_interrupt();
    watch::survive_file_limits();
    exit::code(cli.run())
}
