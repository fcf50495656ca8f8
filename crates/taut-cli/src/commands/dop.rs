//! `taut dop`: the bounding k-dop of points or of a mesh.

use taut::certify::BoundingDop;
use taut::enclose::{DopOptions, bounding_dop};
use taut::{Monitor, Solution};

use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::reading::{Opened, Points, Reading};
use crate::pipeline::{self, Find, Input, Output, OutputOptions};
use crate::watch::Watch;

/// Find the smallest polytope with facets in k directions (k-dop) around points of space or a mesh, with proof.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Of a mesh (.ply, .obj, .off, .stl) all vertices are points, used or not. Each offset is the least number that is at \
least u·p for all points p, so that no facet can move inward.
Exit: 0 found · 1 the check failed · 2 bad input or usage, nothing written
Example: taut dop horse.off -k 18 -o dop.json --draw dop.html && taut verify dop.json horse.off")]
pub(crate) struct Args {
    #[command(flatten)]
    points: Points,
    /// Directions of the facets: 6 (a box), 14, 18 or 26
    #[arg(short = 'k', long, value_name = "K", default_value_t = DopOptions::default().directions)]
    directions: usize,
    #[command(flatten)]
    output: OutputOptions,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    effort: Effort,
}

impl Find for Args {
    type Answer = BoundingDop;
    type Extra = ();

    fn input(&self) -> Input<'_> {
        Input { path: &self.points.path, reading: &self.reading, effort: &self.effort }
    }

    fn output(&self) -> Output<'_> {
        self.output.output()
    }

    fn solve(&self, points: &Opened, watch: &Watch) -> anyhow::Result<(Solution<BoundingDop>, ())> {
        let solve = |monitor: &Monitor<'_>| {
            bounding_dop(points.source(), &DopOptions { monitor: *monitor, ..self.options() })
        };
        let found = watch.during("solving", solve).map_err(|error| points.explain(error))?;
        Ok((found, ()))
    }
}

impl Args {
    pub(crate) fn run(&self) -> anyhow::Result<Outcome> {
        pipeline::run(self)
    }

    fn options(&self) -> DopOptions<'static> {
        DopOptions { directions: self.directions, ..DopOptions::default() }
    }
}

#[cfg(test)]
mod tests {
    use clap::{Args as _, FromArgMatches};

    #[test]
    fn the_defaults_are_those_of_the_library() {
        let command = super::Args::augment_args(clap::Command::new("dop"));
        let matches = command.get_matches_from(["dop", "points.csv"]);
        let args = super::Args::from_arg_matches(&matches).unwrap();
        assert_eq!(args.options(), taut::enclose::DopOptions::default());
    }
}
