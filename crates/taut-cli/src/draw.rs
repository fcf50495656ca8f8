//! `taut draw`: pictures of an answer that was found earlier.

use std::path::PathBuf;

use taut::{Answer, AnySolution, Items, Solution, Violation};

use crate::effort::Effort;
use crate::ellipsoid_report::EllipsoidReport;
use crate::exit::Outcome;
use crate::picture::{Look, Picture};
use crate::reading::{Opened, Points, Reading};
use crate::report::Report;
use crate::triangulation::TriangulationReport;
use crate::verify::{judge, read_answer, shown};
use crate::watch::Watch;
use crate::writing;

/// Draw an answer and its points as SVG, PNG or an interactive HTML page.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
The answer is checked first; one that does not fit the points is not drawn, and the exit code is 1.
Example: taut draw ball.json points.csv -o ball.html")]
pub(crate) struct Args {
    /// The answer, as `taut ball -o` and `taut delaunay -o` write it; - is standard input
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
        let drawing = match &answer {
            AnySolution::Ball(found) if found.certificate.items == Items::Ellipsoids => {
                anyhow::bail!("{}: {}", shown(&self.answer), Report::NO_PICTURE)
            }
            AnySolution::Ball(found) => self
                .judged(found, &points, &watch)?
                .map(|verdict| Report { found, points: &points, verdict }.drawing(&self.look)),
            AnySolution::Ellipsoid(found) => self.judged(found, &points, &watch)?.map(|verdict| {
                EllipsoidReport { found, points: &points, verdict }.drawing(&self.look)
            }),
            AnySolution::Inscribed(_) => {
                anyhow::bail!(
                    "{} is an inscribed ellipsoid, and there are no pictures of these",
                    shown(&self.answer)
                )
            }
            AnySolution::Robust(_) => {
                anyhow::bail!(
                    "{} is a robust ellipsoid, and there are no pictures of these",
                    shown(&self.answer)
                )
            }
            AnySolution::Triangulation(found) => {
                self.judged(found, &points, &watch)?.map(|verdict| {
                    TriangulationReport { found, points: &points, verdict }.drawing(&self.look)
                })
            }
        };
        match drawing {
            Ok(drawing) => {
                writing::replace(&self.out, &picture.draw(drawing?, &self.look)?)?;
                Ok(Outcome::Done)
            }
            Err(violation) => {
                let violation = points.explain_violation(&violation, &shown(&self.answer));
                writing::complain(&format!("rejected, so not drawn: {violation}"));
                Ok(Outcome::CheckFailed)
            }
        }
    }

    /// The verdict, `None` where none is wanted, or the first violation.
    fn judged<A: Answer>(
        &self,
        found: &Solution<A>,
        points: &Opened,
        watch: &Watch,
    ) -> anyhow::Result<Result<Option<A::Verdict>, Violation>> {
        match self.no_verify {
            true => Ok(Ok(None)),
            false => Ok(judge(found, points, watch)?.map(Some)),
        }
    }
}
