//! `taut memory`: the algorithms for the memory hierarchy, on files.

mod key;
mod order;
mod sample;
mod simulate;
mod sort;
mod transpose;

use std::path::Path;

use clap::Subcommand;

pub(crate) use simulate::panel;

use crate::exit::Outcome;

/// Sort, transpose and sample more than memory holds; order points; count cache misses.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
`sort` and `transpose` stay within a limit on memory. What is written appears whole or not at all.
Example: taut memory sort records.bin --item-bytes 32 --memory 256M -o sorted.bin")]
pub(crate) struct Args {
    #[command(subcommand)]
    what: Subcommands,
}

#[derive(Debug, Subcommand)]
enum Subcommands {
    Sort(sort::Args),
    Transpose(transpose::Args),
    Sample(sample::Args),
    Order(order::Args),
    Simulate(simulate::Args),
}

impl Args {
    pub(crate) fn run(&self) -> anyhow::Result<Outcome> {
        match &self.what {
            Subcommands::Sort(args) => args.run(),
            Subcommands::Transpose(args) => args.run(),
            Subcommands::Sample(args) => args.run(),
            Subcommands::Order(args) => args.run(),
            Subcommands::Simulate(args) => args.run(),
        }
    }
}

/// Returns true if a file is a NumPy array by its name.
fn is_npy(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("npy"))
}
