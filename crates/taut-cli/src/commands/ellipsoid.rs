//! `taut ellipsoid`: the ellipsoid of least volume around points, balls or ellipsoids, or around most points.

use taut::certify::{Ellipsoid, RobustEllipsoid};
use taut::{
    EllipsoidMethod, EllipsoidOptions, Monitor, RobustOptions, Solution, ellipsoid,
    robust_ellipsoid,
};

use crate::commands::ball::items;
use crate::commands::robust::Robust;
use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::choice::choice;
use crate::input::reading::{Opened, Points, Reading};
use crate::output::tables::{self, TableFiles, Tables};
use crate::pipeline::{self, Find, Input, Output, OutputOptions};
use crate::reports;
use crate::watch::Watch;

/// Find the ellipsoid of least volume around a point set, with proof.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Points in a line, a plane or another flat are solved in that flat, and the summary says so.
Exit: 0 reached · 1 the check failed · 2 bad input or usage, nothing written ·
      3 stopped early by a budget, or where rounding hides the gap that was asked for;
        the gap reached is reported
Example: taut ellipsoid points.csv -o ellipsoid.json --draw ellipsoid.html &&
         taut verify ellipsoid.json points.csv
         taut ellipsoid points.csv --robust mcd")]
pub(crate) struct Args {
    #[command(flatten)]
    points: Points,
    /// Rows are balls: the coordinates of a center, then the radius; all are held in memory, and newton is the one method
    #[arg(long)]
    balls: bool,
    /// Rows are ellipsoids {m + v : vvᵀ ⪯ S}: the coordinates of the center m, then the lower triangle of the shape
    /// matrix S, row by row; all are held in memory, and newton is the one method
    #[arg(long, conflicts_with = "balls")]
    ellipsoids: bool,
    /// Proved gap to reach, in [0, 1): log-volume ≤ least + ε; 0 is exact to rounding
    #[arg(long, value_name = "REAL", default_value = "1e-9", allow_negative_numbers = true)]
    epsilon: f64,
    /// The way to find it; all end in the same certificate
    #[arg(
        long, value_name = "NAME", default_value = EllipsoidMethod::default().name(), value_parser = choice::<EllipsoidMethod>()
    )]
    method: EllipsoidMethod,
    /// Most reads of all points, then the best ellipsoid so far is given with its gap: at least 2; a read or two more
    /// settle flat sets and the scale of extreme coordinates
    #[arg(long, value_name = "N", default_value_t = EllipsoidOptions::default().max_passes)]
    max_passes: u64,
    /// Chooses the directions of Algorithm 3, from which all methods but newton and thesis-khachiyan start
    #[arg(long, value_name = "N", default_value_t = EllipsoidOptions::default().seed)]
    seed: u64,
    #[command(flatten)]
    tables: TableFiles,
    #[command(flatten)]
    output: OutputOptions,
    #[command(flatten)]
    robust: Robust,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    effort: Effort,
}

/// The ellipsoid around all rows.
struct Enclosing<'a>(&'a Args);

impl Find for Enclosing<'_> {
    type Answer = Ellipsoid;
    type Extra = ();

    fn input(&self) -> Input<'_> {
        self.0.input()
    }

    fn output(&self) -> Output<'_> {
        self.0.output.output()
    }

    fn solve(&self, points: &Opened, watch: &Watch) -> anyhow::Result<(Solution<Ellipsoid>, ())> {
        let solve = |monitor: &Monitor<'_>| {
            let options = EllipsoidOptions { monitor: *monitor, ..self.0.options() };
            ellipsoid(points.source(), &options)
        };
        let found = watch.during("solving", solve).map_err(|error| points.explain(error))?;
        Ok((found, ()))
    }

    fn table_files(&self) -> Option<(&TableFiles, &'static [&'static str])> {
        Some((&self.0.tables, &["support"]))
    }

    fn tables(&self, found: &Solution<Ellipsoid>, points: &Opened) -> Tables {
        vec![("support", tables::rows(points, &found.certificate.support))]
    }

    fn outcome(&self, found: &Solution<Ellipsoid>) -> Outcome {
        reports::outcome(found.trace.stop, found.certificate.gap, self.0.epsilon)
    }
}

/// The ellipsoid of most of the points.
struct RobustSolver<'a>(&'a Args, RobustOptions<'static>);

impl Find for RobustSolver<'_> {
    type Answer = RobustEllipsoid;
    type Extra = ();

    fn input(&self) -> Input<'_> {
        self.0.input()
    }

    fn output(&self) -> Output<'_> {
        self.0.output.output()
    }

    fn solve(
        &self,
        points: &Opened,
        watch: &Watch,
    ) -> anyhow::Result<(Solution<RobustEllipsoid>, ())> {
        let solve = |monitor: &Monitor<'_>| {
            robust_ellipsoid(points.source(), &RobustOptions { monitor: *monitor, ..self.1 })
        };
        let found = watch
            .during("solving", solve)
            .map_err(|error| points.explain_option(error, ["coverage", "keep"]))?;
        Ok((found, ()))
    }

    fn table_files(&self) -> Option<(&TableFiles, &'static [&'static str])> {
        Some((&self.0.tables, &["outliers"]))
    }

    fn tables(&self, found: &Solution<RobustEllipsoid>, points: &Opened) -> Tables {
        vec![("outliers", tables::rows(points, &found.answer.outliers))]
    }

    fn outcome(&self, found: &Solution<RobustEllipsoid>) -> Outcome {
        // The minimum covariance determinant has no gap that could be missed.
        found.certificate.enclosure.as_ref().map_or(Outcome::Done, |enclosure| {
            reports::outcome(found.trace.stop, enclosure.certificate.gap, self.1.epsilon)
        })
    }
}

impl Args {
    pub(crate) fn run(&self) -> anyhow::Result<Outcome> {
        match self.robust()? {
            Some(options) => pipeline::run(&RobustSolver(self, options)),
            None => pipeline::run(&Enclosing(self)),
        }
    }

    fn input(&self) -> Input<'_> {
        Input { path: &self.points.path, reading: &self.reading, effort: &self.effort }
    }

    pub(crate) fn robust(&self) -> anyhow::Result<Option<RobustOptions<'static>>> {
        self.robust.options(self.epsilon)
    }

    fn options(&self) -> EllipsoidOptions<'static> {
        EllipsoidOptions {
            inputs: items(self.balls, self.ellipsoids),
            epsilon: self.epsilon,
            method: self.method,
            max_passes: self.max_passes,
            threads: None, // those of the pool, which reading and checking use as well
            seed: self.seed,
            ..EllipsoidOptions::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::{Args as _, FromArgMatches};

    #[test]
    fn the_defaults_are_those_of_the_library() {
        let command = super::Args::augment_args(clap::Command::new("ellipsoid"));
        let matches = command.get_matches_from(["ellipsoid", "points.csv"]);
        let args = super::Args::from_arg_matches(&matches).unwrap();
        assert_eq!(args.options(), taut::EllipsoidOptions::default());
    }
}
