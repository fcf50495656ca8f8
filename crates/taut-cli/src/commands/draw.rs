//! `taut draw`: pictures of an answer that was found earlier.

use std::path::{Path, PathBuf};

use anyhow::{anyhow, bail};
use taut::Solution;
use taut::certify::Violation;
use taut::certify::with_solution;

use crate::commands::verify::mesh::{FIELDS_OF_METHOD, Judged, MeshOnPoints, is_mesh};
use crate::commands::verify::{judge, read_answer, shown};
use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::obstacles::Obstacles;
use crate::input::reading::{Opened, Reading};
use crate::output::picture::{Drawing, Picture, PictureOptions};
use crate::output::writing;
use crate::reports::{Report, Summary};
use crate::watch::Watch;

/// Draw an answer and its points as SVG, PNG or an interactive HTML page.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
The answer is checked first; one that does not fit the points is not drawn, and the exit code is 1.
Example: taut draw ball.json points.csv -o ball.html
         taut draw mesh.ply -o mesh.html")]
pub(crate) struct Args {
    /// The answer, as `taut ball -o`, `taut ellipsoid -o` and their like write it, or a mesh; - is standard input
    answer: PathBuf,
    /// The points, in any format of `taut formats`; - is standard input. Of a mesh by default its vertices
    points: Option<PathBuf>,
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
        let inputs: Vec<&Path> = [Some(&self.answer), self.points.as_ref()]
            .into_iter()
            .flatten()
            .map(|path| &**path)
            .collect();
        writing::check_writable(&[&self.out], &inputs)?;
        let watch = self.effort.start()?;
        let drawing = match (is_mesh(&self.answer), &self.points) {
            (true, points) => self.drawing_of_mesh(points.as_ref(), &watch)?,
            (false, Some(path)) => {
                let (answer, choice) = read_answer(&self.answer, path)?;
                let reading = self.reading.as_for(choice.as_ref());
                let reading =
                    reading.map_err(|error| anyhow!("{}: {error}", shown(&self.answer)))?;
                let points = reading.open_for(path, &self.obstacles, &answer)?;
                with_solution!(&answer, found => self.drawing(found, &points, &watch)?)
                    .map_err(|violation| points.explain_violation(&violation, &shown(&self.answer)))
            }
            (false, None) => {
                bail!("name the points after {}: only meshes have their own", shown(&self.answer))
            }
        };
        match drawing {
            Ok(drawing) => {
                writing::replace(&self.out, &picture.draw(drawing, &self.options)?)?;
                Ok(Outcome::Done)
            }
            Err(why) => {
                writing::print_error(&format!("rejected, so not drawn: {why}"));
                Ok(Outcome::CheckFailed)
            }
        }
    }

    /// The pictures of a mesh that can be judged, or why it cannot.
    fn drawing_of_mesh(
        &self,
        points: Option<&PathBuf>,
        watch: &Watch,
    ) -> anyhow::Result<Result<Drawing, String>> {
        self.obstacles.refuse()?;
        let mesh = MeshOnPoints::open(&self.answer, points, &self.reading)?;
        let points = &mesh.points;
        Ok(match mesh.judge(watch)? {
            Err(why) => Err(why),
            Ok(Judged::Surface(found, verdict)) => {
                let report =
                    Report { found: &*found, points: points.source(), verdict: Some(verdict) };
                let mut drawing = Drawing::of(&report, points, &self.options)?;
                drawing.fields.retain(|field| !FIELDS_OF_METHOD.contains(&&*field.name));
                Ok(drawing)
            }
            // There is no other, and a picture shows its hull as well.
            Ok(Judged::Triangulation(verdict)) => {
                let solve = |monitor: &taut::Monitor<'_>| {
                    let options = taut::DelaunayOptions { monitor: *monitor, ..Default::default() };
                    taut::delaunay(points.source(), &options)
                };
                let found =
                    watch.during("drawing", solve).map_err(|error| points.explain(error))?;
                let report =
                    Report { found: &found, points: points.source(), verdict: Some(verdict) };
                Ok(Drawing::of(&report, points, &self.options)?)
            }
        })
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
