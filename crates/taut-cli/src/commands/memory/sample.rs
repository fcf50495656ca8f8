//! `taut memory sample`: some of many numbers, in order.

use std::io::Cursor;
use std::path::PathBuf;

use taut::certify::Trace;
use taut::certify::{AnyFileSolution, DrawnSample, FileSolution, Files, SampleCertificate};
use taut::oblivious::sample;

use crate::effort::Effort;
use crate::exit::Outcome;
use crate::output::files::Proof;
use crate::output::writing::{self, Outputs};

/// Draw K different numbers below N, in order: every set of K is equally likely.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Which numbers these are depends on N, K and the seed alone. The time depends on K, not on N. The check draws them \
again, by code of its own.
Exit: 0 done · 1 the check failed · 2 bad input or usage
Example: taut memory sample -n 1000000000 -k 1000 --seed 7 -o rows.txt --certificate rows.json
         taut verify rows.json rows.txt")]
pub(super) struct Args {
    /// The number of items to choose from
    #[arg(short, long = "of", value_name = "N")]
    n: u64,
    /// The number of draws, at most N
    #[arg(short, long = "draws", alias = "draw", value_name = "K")]
    k: u64,
    /// Chooses the numbers
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Where to write them, one in a line; - is standard output
    #[arg(short, long, value_name = "FILE", default_value = "-", help_heading = "Writing")]
    out: PathBuf,
    #[command(flatten)]
    proof: Proof,

    #[command(flatten)]
    effort: Effort,
}

impl Args {
    pub(super) fn run(&self) -> anyhow::Result<Outcome> {
        let Self { n, k, seed, .. } = *self;
        self.proof.look_at(&self.out, &[])?;
        let watch = self.effort.start()?;
        let drawn = watch.during("drawing", |_| sample(seed, n, k))?;
        let mut text = String::with_capacity(drawn.len() * 12);
        for number in drawn {
            text.push_str(&number.to_string());
            text.push('\n');
        }
        let found = FileSolution {
            answer: DrawnSample { of: n, drawn: k },
            certificate: SampleCertificate { seed },
            trace: Trace { method: "divide".to_owned(), ..Trace::default() },
        };
        if !self.proof.no_verify {
            let mut bytes = Cursor::new(text.as_bytes());
            let files = Files { input: None, output: &mut bytes };
            if let Err(error) = watch.during("checking", |monitor| found.check(files, monitor)) {
                writing::print_error(&format!("the check failed: {error}"));
                return Ok(Outcome::CheckFailed);
            }
        }
        let mut outputs = Outputs::default();
        outputs.add(&self.out, text.as_bytes())?;
        if let Some(path) = &self.proof.certificate {
            let text = AnyFileSolution::Sample(found).to_json() + "\n";
            outputs.add(path, text.as_bytes())?;
        }
        outputs.finish()?;
        Ok(Outcome::Done)
    }
}
