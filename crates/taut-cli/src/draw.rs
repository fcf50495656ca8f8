//! `taut draw`: pictures of an answer that was found earlier.

use std::path::PathBuf;

use anyhow::bail;
use taut::certify::with_solution;
use taut::{Solution, Violation};

use crate::effort::Effort;
use crate::exit::Outcome;
use crate::picture::{Drawing, Look, Picture};
use crate::reading::{Opened, Points, Reading};
use crate::report::{Report, Summary};
use crate::verify::{judge, read_answer, shown};
use crate::watch::Watch;
use crate::writing;

/// Draw an answer and its points as SVG, PNG or an interactive HTML page.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
The answer is checked first; one that does not fit the points is not drawn, and the exit code is 1.
Example: taut draw ball.json points.csv -o ball.html")]
pub(crate) struct Args {
    /// The answer, as `taut ball -o`, `taut ellipsoid -o` and their like write it; - is standard input
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
        let answer = read_answer(&self.answer, &self.points.path)?;
        let points = self.reading.open(&self.points.path)?;
        let drawing = with_solution!(&answer, found => self.drawing(found, &points, &watch)?);
        match drawing {
            Ok(drawing) => {
                writing::replace(&self.out, &picture.draw(drawing, &self.look)?)?;
                Ok(Outcome::Done)
            }
            Err(violation) => {
                let violation = points.explain_violation(&violation, &shown(&self.answer));
                writing::complain(&format!("rejected, so not drawn: {violation}"));
                Ok(Outcome::CheckFailed)
            }
        }
    }

    /// The pictures of an answer that fits the points, or what is wrong with it.
    fn drawing<A: Summary>(
        &self,
        found: &Solution<A>,
        points: &Opened,
        watch: &Watch,
    ) -> anyhow::Result<Result<Drawing, Violation>> {
        if let Some(why) = A::no_picture(found) {
            bail!("{}: {why}", shown(&self.answer))
        }
        let verdict = match self.no_verify {
            true => None,
            false => match judge(found, points, watch)? {
                Ok(verdict) => Some(verdict),
                Err(violation) => return Ok(Err(violation)),
            },
        };
        Ok(Ok(Report { found, points, verdict }.drawing(&self.look)?))
    }
}
