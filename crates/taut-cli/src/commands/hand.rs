//! `taut hand`: hands in images, measured and made.

mod evaluate;
pub(crate) mod measure;
mod synthesize;

use clap::Subcommand;

use crate::exit::Outcome;

/// Measure the outline of a hand in an image, or make synthetic scans of hands.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Example: taut hand synthesize scans --people 3 --scans 2
         taut hand measure scans/person-0000-scan-00.png --draw hand.svg
         taut hand evaluate --synthetic 20x6
See: taut hand measure --help, taut hand synthesize --help, taut hand evaluate --help")]
pub(crate) struct Args {
    #[command(subcommand)]
    what: Subcommands,
}

#[derive(Debug, Subcommand)]
enum Subcommands {
    Measure(measure::Args),
    Synthesize(synthesize::Args),
    Evaluate(evaluate::Args),
}

impl Args {
    pub(crate) fn run(&self) -> anyhow::Result<Outcome> {
        match &self.what {
            Subcommands::Measure(args) => args.run(),
            Subcommands::Synthesize(args) => args.run(),
            Subcommands::Evaluate(args) => args.run(),
        }
    }
}
