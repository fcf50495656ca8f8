//! `taut verify`: judges an answer from the points and its certificate alone.

use std::io::Read;
use std::path::{Path, PathBuf};

use anyhow::{anyhow, bail};
use taut::certify::CheckError;
use taut::{AnySolution, Verdict, Violation};

use crate::effort::Effort;
use crate::exit::Outcome;
use crate::numbers::{exact, gap};
use crate::reading::{Opened, Points, Reading};
use crate::report::{self, Fact};
use crate::watch::Watch;
use crate::writing;

/// Check an answer and its certificate against the points, trusting neither.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Columns and the like have to be chosen as for the answer: the certificate knows its points by a hash.
Exit: 0 proved · 1 rejected, with the first violation · 2 bad input or usage
Example: taut verify ball.json points.csv")]
pub(crate) struct Args {
    /// The answer, as `taut ball -o` writes it; - is standard input
    answer: PathBuf,
    #[command(flatten)]
    points: Points,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    effort: Effort,
}

impl Args {
    pub(crate) fn run(&self) -> anyhow::Result<Outcome> {
        let watch = self.effort.start()?;
        let answer = read_answer(&self.answer, &self.points.path)?;
        let points = self.reading.open(&self.points.path)?;
        let (outcome, said) = match judge(&answer, &points, &watch)? {
            Ok(verdict) => (
                Outcome::Done,
                report::text(&format!("Verified: {}", claim(&answer)), &facts(&verdict)),
            ),
            Err(violation) => {
                let said = format!("Rejected: {}\n", points.explain_violation(&violation));
                (Outcome::CheckFailed, said)
            }
        };
        if !self.effort.quiet {
            writing::say(said.as_bytes())?;
        }
        Ok(outcome)
    }
}

/// The verdict, or the first violation; an error where the points cannot be read.
pub(crate) fn judge(
    answer: &AnySolution,
    points: &Opened,
    watch: &Watch,
) -> anyhow::Result<Result<Verdict, Violation>> {
    match watch.during("checking", |monitor| answer.check(points.source(), monitor)) {
        Ok(verdict) => Ok(Ok(verdict)),
        Err(CheckError::Rejected(violation)) => Ok(Err(violation)),
        Err(CheckError::Read(error)) => Err(points.reading_failed(error)),
        Err(error) => Err(error.into()),
    }
}

/// Reads an answer; `points` is the other input, as both cannot be standard input.
pub(crate) fn read_answer(path: &Path, points: &Path) -> anyhow::Result<AnySolution> {
    let name =
        if path == Path::new("-") { "standard input".into() } else { path.display().to_string() };
    let mut text = String::new();
    let read = match path == Path::new("-") {
        true if points == Path::new("-") => {
            bail!("only one of answer and points can be standard input: give a file for the other")
        }
        true => std::io::stdin().read_to_string(&mut text),
        false => std::fs::File::open(path).and_then(|mut file| file.read_to_string(&mut text)),
    };
    read.map_err(|source| anyhow!("{name}: the answer could not be read: {source}"))?;
    AnySolution::from_json(&text).map_err(|error| anyhow!("{name}: {error}"))
}

fn claim(answer: &AnySolution) -> String {
    match answer {
        AnySolution::Ball(found) => format!("ball of radius {}", exact(found.answer.radius)),
    }
}

fn facts(verdict: &Verdict) -> Vec<Fact> {
    let bracket = format!("{} ≤ smallest radius ≤ {}", exact(verdict.lower), exact(verdict.upper));
    vec![
        Fact::new("bracket", bracket),
        Fact::new("gap", gap(verdict.gap)).remark("relative, proved from the points alone"),
    ]
}
