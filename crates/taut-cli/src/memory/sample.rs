//! `taut memory sample`: some of many numbers, in order.

use std::path::PathBuf;

use taut::oblivious::sample;

use crate::effort::Effort;
use crate::exit::Outcome;
use crate::writing;

/// Draw K different numbers below N, in order: every set of K is equally likely.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Which numbers these are depends on N, K and the seed alone. The time depends on K, not on N.
Example: taut memory sample -n 1000000000 -k 1000 --seed 7 -o rows.txt")]
pub(super) struct Args {
    /// How many there are to choose from
    #[arg(short, long = "of", value_name = "N")]
    n: u64,
    /// How many to draw, at most N
    #[arg(short, long = "draw", value_name = "K")]
    k: u64,
    /// Chooses the numbers
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Where to write them, one in a line; - is standard output
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    out: PathBuf,

    #[command(flatten)]
    effort: Effort,
}

impl Args {
    pub(super) fn run(&self) -> anyhow::Result<Outcome> {
        writing::look_at(&[&self.out], &[])?;
        self.effort.start()?;
        let drawn = sample(self.seed, self.n, self.k)?;
        let mut text = String::with_capacity(drawn.len() * 12);
        for number in drawn {
            text.push_str(&number.to_string());
            text.push('\n');
        }
        writing::replace(&self.out, text.as_bytes())?;
        Ok(Outcome::Done)
    }
}
