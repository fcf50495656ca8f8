//! `taut memory order`: points along a Hilbert curve or in Z-order.

use std::path::{Path, PathBuf};

use anyhow::{anyhow, bail};
use taut::certify::{Order, OrderCurve};
use taut::points::{OwnedPoints, ScalarKind, Scratch};
use taut::{Monitor, OrderOptions, PointSource, Solution, spatial_order};
use taut_io::write_points;

use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::choice::choice;
use crate::input::reading::{Opened, Points, Reading};
use crate::output::tables::{self, is_table};
use crate::output::writing::Outputs;
use crate::pipeline::{self, Find, Input, Output};
use crate::watch::Watch;

/// Put points of the plane or of space in an order in which neighbors are near each other.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
The order depends on the set of points alone; equal points are side by side, the first row first.
Exit: 0 done · 1 the check failed · 2 bad input or usage, nothing written
Example: taut memory order points.csv -o order.json --ordered sorted.csv &&
         taut verify order.json points.csv")]
pub(super) struct Args {
    #[command(flatten)]
    points: Points,
    /// Along which curve
    #[arg(long, value_name = "CURVE", default_value = OrderCurve::default().name(), value_parser = choice::<OrderCurve>())]
    curve: OrderCurve,
    /// Do without the independent check
    #[arg(long)]
    no_verify: bool,
    /// Write the numbers of the rows in order, from 0: .json with the certificate, or a table as .csv, .npy, .parquet and the like; - is
    /// JSON on standard output
    #[arg(short, long, value_name = "FILE", help_heading = "Writing")]
    out: Option<PathBuf>,
    /// Print the JSON instead of the summary
    #[arg(long, help_heading = "Writing")]
    json: bool,
    /// Write the points in that order, in the format that the name tells
    #[arg(long = "ordered", alias = "points", value_name = "FILE", help_heading = "Writing")]
    sorted: Option<PathBuf>,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    effort: Effort,
}

impl Find for Args {
    type Answer = Order;
    type Extra = ();

    fn input(&self) -> Input<'_> {
        Input { path: &self.points.path, reading: &self.reading, effort: &self.effort }
    }

    fn output(&self) -> Output<'_> {
        Output { no_verify: self.no_verify, out: self.out.as_deref(), json: self.json, draw: None }
    }

    fn check_options(&self) -> anyhow::Result<()> {
        self.output().refuse_but_tables(&self.points.path)
    }

    fn side_files(&self) -> Vec<&Path> {
        self.sorted.as_deref().into_iter().collect()
    }

    fn solve(&self, points: &Opened, watch: &Watch) -> anyhow::Result<(Solution<Order>, ())> {
        let solve = |monitor: &Monitor<'_>| {
            let options =
                OrderOptions { curve: self.curve, monitor: *monitor, ..OrderOptions::default() };
            spatial_order(points.source(), &options)
        };
        let found = watch.during("ordering", solve).map_err(|error| points.explain(error))?;
        Ok((found, ()))
    }

    fn write(
        &self,
        found: &mut Solution<Order>,
        _: &(),
        points: &Opened,
        outputs: &mut Outputs,
        monitor: &Monitor<'_>,
    ) -> anyhow::Result<()> {
        match &self.out {
            Some(path) if is_table(path) => {
                outputs.add_table(path, &tables::rows(points, &found.answer.rows))?;
            }
            Some(path) => outputs.add_json(path, found)?,
            None => {}
        }
        if let Some(path) = &self.sorted {
            if !points.labels().is_empty() {
                bail!("--ordered writes coordinates, which have no names: leave out --id");
            }
            let names = points.names(points.source().dim());
            let sorted = reordered(points, &found.answer.rows)?;
            write_points(&*sorted, &names, path, None, monitor)?;
        }
        Ok(())
    }
}

impl Args {
    pub(super) fn run(&self) -> anyhow::Result<Outcome> {
        pipeline::run(self)
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
