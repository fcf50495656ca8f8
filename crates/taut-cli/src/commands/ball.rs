//! `taut ball`: the smallest ball around points or balls, or in the feature space of a kernel.

mod kernel;

use taut::certify::Ball;
use taut::{BallMethod, BallOptions, Items, Monitor, Solution, ball};

use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::choice::choice;
use crate::input::reading::{Opened, Points, Reading};
use crate::input::units::UnitOptions;
use crate::output::tables::{self, TableFiles, Tables};
use crate::pipeline::{self, Find, Input, Output, OutputOptions};
use crate::reports;
use crate::watch::Watch;

/// Find the smallest ball around a point set, with proof.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Exit: 0 reached · 1 the check failed · 2 bad input or usage, nothing written ·
      3 stopped early by a budget, or where rounding hides the gap that was asked for;
        the gap reached is reported
Example: taut ball points.csv -o ball.json --draw ball.svg && taut verify ball.json points.csv
         taut ball points.csv --kernel gaussian --gamma 0.5 --nu 0.05 -o soft.json --draw soft.svg")]
pub(crate) struct Args {
    #[command(flatten)]
    points: Points,
    /// Rows are balls: the coordinates of a center, then the radius
    #[arg(long)]
    balls: bool,
    /// Rows are ellipsoids {m + v : vvᵀ ⪯ S}: the coordinates of the center m, then the lower triangle of the shape
    /// matrix S, row by row; all are held in memory
    #[arg(long, conflicts_with_all = ["balls", "draw"])]
    ellipsoids: bool,
    /// Proved relative gap to reach, in [0, 1): radius ≤ (1 + ε) · smallest; 0 is exact to rounding. With --kernel it is the gap of the
    /// squared radius, above 0
    /// [default: 1e-9, with --kernel 1e-6]
    #[arg(long, value_name = "REAL", allow_negative_numbers = true)]
    epsilon: Option<f64>,
    /// The way to find it; all end in the same certificate
    #[arg(long, value_name = "NAME", default_value = BallMethod::default().name(), value_parser = choice::<BallMethod>())]
    method: BallMethod,
    /// Far points taken to the core-set per pass, by core-set; at least 1 [default: by dimension]
    #[arg(long, value_name = "N")]
    batch: Option<usize>,
    /// Relative accuracy of the ball of a core-set, in (0, 1), by thesis-pure and thesis-fast [default: the square of epsilon]
    #[arg(long, value_name = "REAL", allow_negative_numbers = true)]
    delta: Option<f64>,
    /// Most reads of all points, then the best ball so far is given with its gap: at least 3, 4 for the thesis'
    /// methods; a read or two more settle the scale of extreme coordinates. With --kernel at least 1 and at most 10000
    #[arg(long, value_name = "N", default_value_t = BallOptions::default().max_passes)]
    max_passes: u64,
    /// Chooses the point from which the thesis' methods start
    #[arg(long, value_name = "N", default_value_t = BallOptions::default().seed)]
    seed: u64,
    #[command(flatten)]
    kernel: kernel::KernelArgs,
    #[command(flatten)]
    tables: TableFiles,
    #[command(flatten)]
    output: OutputOptions,
    #[command(flatten)]
    units: UnitOptions,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    effort: Effort,
}

impl Find for Args {
    type Answer = Ball;
    type Extra = ();

    fn input(&self) -> Input<'_> {
        Input { path: &self.points.path, reading: &self.reading, effort: &self.effort }
    }

    fn output(&self) -> Output<'_> {
        self.output.output()
    }

    fn check_options(&self) -> anyhow::Result<()> {
        self.units.check(&[("--balls", self.balls), ("--ellipsoids", self.ellipsoids)])?;
        self.output().refuse_other_formats(&self.points.path)
    }

    fn open(&self, _: &Watch) -> anyhow::Result<Opened> {
        let opened = self.reading.open(&self.points.path)?;
        if self.balls || self.ellipsoids { Ok(opened) } else { self.units.apply(opened) }
    }

    fn solve(&self, points: &Opened, watch: &Watch) -> anyhow::Result<(Solution<Ball>, ())> {
        let solve = |monitor: &Monitor<'_>| {
            ball(points.source(), &BallOptions { monitor: *monitor, ..self.options() })
        };
        let found = watch.during("solving", solve).map_err(|error| points.explain(error))?;
        Ok((found, ()))
    }

    fn table_files(&self) -> Option<(&TableFiles, &'static [&'static str])> {
        Some((&self.tables, &["support"]))
    }

    fn tables(&self, found: &Solution<Ball>, points: &Opened) -> Tables {
        vec![("support", tables::rows(points, &found.certificate.support))]
    }

    fn outcome(&self, found: &Solution<Ball>) -> Outcome {
        reports::outcome(found.trace.stop, found.certificate.gap, self.options().epsilon)
    }
}

impl Args {
    pub(crate) fn run(&self) -> anyhow::Result<Outcome> {
        match self.kernel.of(self)? {
            Some(kernel) => {
                self.units.check(&[("--kernel", true)])?;
                pipeline::run(&kernel)
            }
            None => pipeline::run(self),
        }
    }

    fn options(&self) -> BallOptions<'static> {
        BallOptions {
            inputs: items(self.balls, self.ellipsoids),
            epsilon: self.epsilon.unwrap_or(BallOptions::default().epsilon),
            method: self.method,
            batch: self.batch,
            delta: self.delta,
            max_passes: self.max_passes,
            threads: None, // those of the pool, which reading and checking use as well
            seed: self.seed,
            ..BallOptions::default()
        }
    }
}

/// Returns the kind of the inputs, by the options of that name.
pub(crate) fn items(balls: bool, ellipsoids: bool) -> Items {
    match (balls, ellipsoids) {
        (_, true) => Items::Ellipsoids,
        (true, false) => Items::Balls,
        (false, false) => Items::Points,
    }
}

#[cfg(test)]
mod tests {
    use clap::{Args as _, FromArgMatches};

    #[test]
    fn the_defaults_are_those_of_the_library() {
        let command = super::Args::augment_args(clap::Command::new("ball"));
        let matches = command.get_matches_from(["ball", "points.csv"]);
        let args = super::Args::from_arg_matches(&matches).unwrap();
        assert_eq!(args.options(), taut::BallOptions::default());
    }
}
