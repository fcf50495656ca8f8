//! `taut classify`: classes of points, learned from points with labels.

mod data;
mod evaluate;
mod picture;
mod predict;
mod train;

use clap::Subcommand;

use crate::exit::Outcome;

/// Learn the classes of points from labeled ones, predict them, and tell how good the predictions are.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Example: taut classify train train.csv --label species --model model.json
         taut classify evaluate test.csv --label species --model model.json
         taut classify predict new.csv --model model.json -o classes.csv
See: taut classify train --help, taut classify predict --help, taut classify evaluate --help")]
pub(crate) struct Args {
    #[command(subcommand)]
    what: Subcommands,
}

#[derive(Debug, Subcommand)]
enum Subcommands {
    Train(train::Args),
    Predict(predict::Args),
    Evaluate(evaluate::Args),
}

impl Args {
    pub(crate) fn run(&self) -> anyhow::Result<Outcome> {
        match &self.what {
            Subcommands::Train(args) => args.run(),
            Subcommands::Predict(args) => args.run(),
            Subcommands::Evaluate(args) => args.run(),
        }
    }
}
