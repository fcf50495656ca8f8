//! `taut memory order`: points along a Hilbert curve or in Z-order.

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use taut::certify::OrderCurve;
use taut::points::{OwnedPoints, ScalarKind, Scratch};
use taut::{PointSource, spatial_order};
use taut_io::write_points;

use crate::clock::Clock;
use crate::effort::Effort;
use crate::exit::Outcome;
use crate::numbers::{count, counted};
use crate::reading::{Opened, Points, Reading};
use crate::report::{self, Fact};
use crate::verify::judge;
use crate::writing::{self, Outputs};

/// Put points of the plane or of space in an order in which neighbours are near each other.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
The order depends on the set of points alone; equal points are side by side, the first row first.
Exit: 0 done · 1 the check failed · 2 bad input or usage, nothing written
Example: taut memory order points.csv -o order.json --points sorted.csv && taut verify order.json points.csv")]
pub(super) struct Args {
    #[command(flatten)]
    points: Points,
    /// Along which curve
    #[arg(long, value_enum, default_value = "hilbert")]
    curve: Curve,
    /// Do without the independent check
    #[arg(long)]
    no_verify: bool,
    /// Write the numbers of the rows in order, from 0, and the certificate as JSON; - is standard output
    #[arg(short, long, value_name = "FILE", help_heading = "Writing")]
    out: Option<PathBuf>,
    /// Write the points in that order, in the format that the name tells
    #[arg(long = "points", value_name = "FILE", help_heading = "Writing")]
    sorted: Option<PathBuf>,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    effort: Effort,
}

/// Which curve.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Curve {
    /// steps are short: cells that follow each other share a side
    Hilbert,
    /// Z-order, the bits of coordinates interleaved: cells of a grid of any size are runs
    Morton,
}

impl Args {
    pub(super) fn run(&self) -> anyhow::Result<Outcome> {
        let outputs: Vec<&Path> =
            [&self.out, &self.sorted].into_iter().flatten().map(|path| &**path).collect();
        writing::look_at(&outputs, &[&self.points.path])?;
        let watch = self.effort.start()?;
        let mut clock = Clock::start();
        let points = self.reading.open(&self.points.path)?;
        clock.lap("reading");
        let curve = match self.curve {
            Curve::Hilbert => OrderCurve::Hilbert,
            Curve::Morton => OrderCurve::Morton,
        };
        let found = watch
            .during("ordering", |monitor| spatial_order(points.source(), curve, monitor))
            .map_err(|error| points.explain_delaunay(error))?;
        clock.lap("ordering");
        let mut grids = None;
        if !self.no_verify {
            match judge(&found, &points, &watch)? {
                Ok(verdict) => grids = Some(verdict.grids),
                Err(violation) => {
                    let why = points.explain_violation(&violation, "the order");
                    writing::complain(&format!("the check failed: {why}"));
                    return Ok(Outcome::CheckFailed);
                }
            }
            clock.lap("checking");
        }
        let mut outputs = Outputs::default();
        if let Some(path) = &self.out {
            outputs.add_json(path, &found)?;
        }
        if let Some(path) = &self.sorted {
            let names = points.names(points.source().dim());
            let sorted = reordered(&points, &found.answer.rows)?;
            watch
                .during("writing", |monitor| write_points(&*sorted, &names, path, None, monitor))?;
        }
        let streams =
            [&self.out, &self.sorted].into_iter().flatten().any(|p| writing::is_stream(p));
        if !self.effort.quiet && !streams {
            let checked = match grids {
                Some(grids) => {
                    let grids = counted(grids, "grid");
                    Fact::new("verified", "yes").remark(format!("the one order, by {grids}"))
                }
                None => Fact::new("verified", "not checked"),
            };
            let rows = count(points.source().len());
            let curve = match self.curve {
                Curve::Hilbert => "along a Hilbert curve",
                Curve::Morton => "in Z-order",
            };
            let facts = [checked, clock.fact()];
            outputs.say(&report::text(&format!("{rows} points {curve}"), &facts));
        }
        outputs.finish()?;
        Ok(Outcome::Done)
    }
}

/// The points in another order, in the precision of the file.
fn reordered(points: &Opened, order: &[u64]) -> anyhow::Result<Box<dyn PointSource>> {
    let dim = points.source().dim();
    let mut scratch = Scratch::new();
    let rows = points.source().read(0..points.source().len(), &mut scratch);
    let rows = rows.map_err(|error| points.reading_failed(error))?;
    let mut sorted = vec![0.0; order.len() * dim];
    for (place, &row) in sorted.chunks_exact_mut(dim).zip(order) {
        rows.copy_row(row as usize, place);
    }
    let refused = |error| anyhow!("{}: {error}", points.name());
    Ok(match points.source().scalar() {
        ScalarKind::F64 => Box::new(OwnedPoints::new(sorted, dim).map_err(refused)?),
        ScalarKind::F32 => {
            let narrow: Vec<f32> = sorted.into_iter().map(|value| value as f32).collect();
            Box::new(OwnedPoints::new(narrow, dim).map_err(refused)?)
        }
    })
}
