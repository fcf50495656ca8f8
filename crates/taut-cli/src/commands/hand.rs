//! `taut hand`: hands in images, measured, made and recognized.

mod evaluate;
pub(crate) mod measure;
#[cfg(feature = "store")]
mod people;
mod synthesize;

use clap::Subcommand;

use crate::exit::Outcome;

/// Measure the outline of a hand in an image, make synthetic scans of hands, and recognize people.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Example: taut hand synthesize scans --people 3 --scans 2
         taut hand measure scans/person-0000-scan-00.png --draw hand.svg
         taut hand key -o key
         taut hand enroll --create --store people --key key --person Ada \\
             scans/person-0000-scan-0[0-2].png
         taut hand verify --store people --key key --person Ada scans/person-0000-scan-03.png
         taut hand evaluate --synthetic 20x6
See: taut hand measure --help, taut hand synthesize --help, taut hand enroll --help,
     taut hand evaluate --help")]
pub(crate) struct Args {
    #[command(subcommand)]
    what: Subcommands,
}

#[derive(Debug, Subcommand)]
enum Subcommands {
    Measure(measure::Args),
    Synthesize(synthesize::Args),
    Evaluate(evaluate::Args),
    #[cfg(feature = "store")]
    #[command(flatten)]
    People(people::Subcommands),
}

impl Args {
    pub(crate) fn run(&self) -> anyhow::Result<Outcome> {
        match &self.what {
            Subcommands::Measure(args) => args.run(),
            Subcommands::Synthesize(args) => args.run(),
            Subcommands::Evaluate(args) => args.run(),
            #[cfg(feature = "store")]
            Subcommands::People(command) => command.run(),
        }
    }
}
