//! `taut draw`: pictures of an answer that was found earlier.

use std::path::PathBuf;

use anyhow::bail;
use taut::Solution;
use taut::certify::Violation;
use taut::certify::with_solution;

use crate::commands::verify::{judge, read_answer, shown};
use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::obstacles::Obstacles;
use crate::input::reading::{Opened, Points, Reading};
use crate::output::picture::{Drawing, Picture, PictureOptions};
use crate::output::writing;
use crate::reports::{Report, Summary};
use crate::watch::Watch;

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
    obstacles: Obstacles,
    #[command(flatten)]
    options: PictureOptions,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    effort: Effort,
}

impl Args {
    pub(crate) fn run(&self) -> anyhow::Result<Outcome> {
        let picture = Picture::of_path(&self.out)?;
        writing::check_writable(&[&self.out], &[&self.answer, &self.points.path])?;
        let watch = self.effort.start()?;
        let answer = read_answer(&self.answer, &self.points.path)?;
        let points = self.reading.open_for(&self.points.path, &self.obstacles, &answer)?;
        let drawing = with_solution!(&answer, found => self.drawing(found, &points, &watch)?);
        match drawing {
            Ok(drawing) => {
                writing::replace(&self.out, &picture.draw(drawing, &self.options)?)?;
                Ok(Outcome::Done)
            }
            Err(violation) => {
                let violation = points.explain_violation(&violation, &shown(&self.answer));
                writing::print_error(&format!("rejected, so not drawn: {violation}"));
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
        let report = Report { found, points: points.source(), verdict };
        Ok(Ok(Drawing::of(&report, points, &self.options)?))
    }
}
