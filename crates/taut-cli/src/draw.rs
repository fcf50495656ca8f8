//! `taut draw`: pictures of an answer that was found earlier.

use std::path::PathBuf;

use anyhow::bail;
use taut::AnySolution;

use crate::effort::Effort;
use crate::exit::Outcome;
use crate::picture::{Look, Picture};
use crate::reading::{Points, Reading};
use crate::report::Report;
use crate::verify::{judge, read_answer, shown};
use crate::writing;

/// Draw an answer and its points as SVG, PNG or an interactive HTML page.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
The answer is checked first; one that does not fit the points is not drawn, and the exit code is 1.
Example: taut draw ball.json points.csv -o ball.html")]
pub(crate) struct Args {
    /// The answer, as `taut ball -o` writes it; - is standard input
    answer: PathBuf,
    #[command(flatten)]
    points: Points,
    /// The picture: .svg and .png show one, .html all
    #[arg(short, long, value_name = "FILE")]
    out: PathBuf,
    /// Draw without checking first
    #[arg(long)]
    no_verify: bool,
    #[command(flatten)]
    look: Look,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    effort: Effort,
}

impl Args {
    pub(crate) fn run(&self) -> anyhow::Result<Outcome> {
        let picture = Picture::of_path(&self.out)?;
        writing::look_at(&[&self.out], &[&self.answer, &self.points.path])?;
        let watch = self.effort.start()?;
        let name = shown(&self.answer);
        let AnySolution::Ball(found) = read_answer(&self.answer, &self.points.path)? else {
            bail!("{name}: this is a triangulation, and only balls can be drawn");
        };
        let points = self.reading.open(&self.points.path)?;
        let verdict = match self.no_verify {
            true => None,
            false => match judge(&found, &points, &watch)? {
                Ok(verdict) => Some(verdict),
                Err(violation) => {
                    let violation = points.explain_violation(&violation, &name);
                    writing::complain(&format!("rejected, so not drawn: {violation}"));
                    return Ok(Outcome::CheckFailed);
                }
            },
        };
        let drawn =
            picture.draw(&Report { found: &found, points: &points, verdict }, &self.look)?;
        writing::replace(&self.out, &drawn)?;
        Ok(Outcome::Done)
    }
}
