//! The `taut` command: tight shapes of point sets, with proof.
//!
//! Each subcommand is a file of its own and the same four steps: open, solve, write, say. What they share (how
//! points are read, how much effort is spent, how files are replaced) lies beside them, one thought per file.
//! Nothing is calculated here: the answers are those of the library crates, and so are the checks.

mod answer_file;
mod ball;
mod ball_report;
mod centers;
mod centers_report;
mod cli;
mod clock;
mod completions;
mod curve;
mod curve_report;
mod delaunay;
mod draw;
mod effort;
mod elbow;
mod ellipsoid;
mod ellipsoid_report;
mod exit;
mod files;
mod formats;
mod generate;
mod inscribe;
mod inscribed_report;
mod man;
mod memory;
mod numbers;
mod order_report;
mod out_of_memory;
mod picture;
mod pipeline;
mod radii;
mod reading;
mod report;
mod robust;
mod robust_report;
mod size;
mod surface;
mod surface_report;
mod tour;
mod triangulation;
mod verify;
mod watch;
mod writing;

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    let cli = match cli::Cli::try_parse() {
        Ok(cli) => cli,
        Err(unparsed) => return exit::unparsed(&unparsed),
    };
    watch::stop_on_interrupt();
    watch::survive_file_limits();
    exit::code(cli.run())
}
