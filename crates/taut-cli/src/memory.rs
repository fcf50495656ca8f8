//! `taut memory`: the algorithms for the memory hierarchy, on files.

mod key;
mod sample;
mod sort;
mod transpose;

use clap::Subcommand;

use taut::oblivious::Error;

use crate::exit::Outcome;
use crate::writing;

/// Sort, transpose and sample more than memory holds.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Each of these stays within a limit on memory, and a file appears whole or not at all.
Example: taut memory sort records.bin --width 32 --memory 256M -o sorted.bin")]
pub(crate) struct Args {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    Sort(sort::Args),
    Transpose(transpose::Args),
    Sample(sample::Args),
}

impl Args {
    pub(crate) fn run(&self) -> anyhow::Result<Outcome> {
        match &self.what {
            What::Sort(args) => args.run(),
            What::Transpose(args) => args.run(),
            What::Sample(args) => args.run(),
        }
    }
}

/// Whether a check found what it should; what it found instead is said.
fn holds(checked: Result<(), Error>) -> anyhow::Result<bool> {
    match checked {
        Ok(()) => Ok(true),
        Err(
            error @ (Error::UnsortedFile { .. }
            | Error::OtherRecords { .. }
            | Error::Differs { .. }),
        ) => {
            writing::complain(&error.to_string());
            Ok(false)
        }
        Err(error) => Err(error.into()),
    }
}
