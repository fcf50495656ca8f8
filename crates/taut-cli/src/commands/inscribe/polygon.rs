//! `taut inscribe polygon`: a large convex polygon in a polygon.

use std::path::PathBuf;

use taut::certify::ConvexPolygon;
use taut::inscribe::{ConvexOptions, inscribed_polygon};
use taut::{Monitor, Solution};

use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::reading::{Opened, Reading};
use crate::input::samples::Samples;
use crate::pipeline::{Find, Input, Output, OutputOptions};
use crate::watch::Watch;

/// Find a large convex polygon in a polygon, with or without holes.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Two columns x, y are the vertices of one ring in order. A third column has the number of the ring, 0, 1, and so on, \
for polygons with holes or of several parts; inside is what an odd number of rings wind around.
The polygon found is a local optimum. That it is inside is proved, and so is a bound of the largest: the largest \
ellipse times 3√3/π, or the convex hull. The gap between them is up to 65 % even where no polygon is larger.
Exit: 0 found · 1 the check failed · 2 bad input or usage, nothing written
Example: taut inscribe polygon ring.csv -o polygon.json --draw polygon.svg &&
         taut verify polygon.json ring.csv")]
pub(super) struct Polygon {
    /// Rings of vertices in order, in any format of `taut formats`, such as CSV or GeoJSON; - is standard input
    #[arg(value_name = "RING")]
    path: PathBuf,
    #[command(flatten)]
    samples: Samples,
    /// Rounds in which sides are taken out and the room is carved again
    #[arg(long, value_name = "N", default_value_t = ConvexOptions::default().rounds)]
    rounds: u64,
    /// Local ellipses to start from, at least 1
    #[arg(long, value_name = "N", default_value_t = ConvexOptions::default().starts)]
    starts: u64,
    /// Seed of the rounds
    #[arg(long, value_name = "N", default_value_t = ConvexOptions::default().seed)]
    seed: u64,
    /// Proved relative gap of the largest ellipse, which is the bound, in (0, 1)
    #[arg(long, value_name = "REAL", default_value = "1e-2", allow_negative_numbers = true)]
    epsilon: f64,
    #[command(flatten)]
    output: OutputOptions,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    effort: Effort,
}

impl Find for Polygon {
    type Answer = ConvexPolygon;
    type Extra = ();

    fn input(&self) -> Input<'_> {
        Input { path: &self.path, reading: &self.reading, effort: &self.effort }
    }

    fn output(&self) -> Output<'_> {
        self.output.output()
    }

    fn samples(&self) -> Option<&Samples> {
        Some(&self.samples)
    }

    fn solve(&self, ring: &Opened, watch: &Watch) -> anyhow::Result<(Solution<ConvexPolygon>, ())> {
        let solve = |monitor: &Monitor<'_>| {
            let options = ConvexOptions { monitor: *monitor, ..self.options() };
            inscribed_polygon(ring.source(), &options)
        };
        let found = watch.during("solving", solve).map_err(|error| ring.explain(error))?;
        Ok((found, ()))
    }

    fn outcome(&self, _found: &Solution<ConvexPolygon>) -> Outcome {
        Outcome::Done
    }
}

impl Polygon {
    fn options(&self) -> ConvexOptions<'static> {
        ConvexOptions {
            rounds: self.rounds,
            starts: self.starts,
            seed: self.seed,
            epsilon: self.epsilon,
            ..ConvexOptions::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::{Args as _, FromArgMatches};

    #[test]
    fn the_defaults_are_those_of_the_library() {
        let command = super::Polygon::augment_args(clap::Command::new("polygon"));
        let matches = command.get_matches_from(["polygon", "ring.csv"]);
        let found = super::Polygon::from_arg_matches(&matches).unwrap().options();
        let expected = taut::inscribe::ConvexOptions::default();
        let parts = |o: &taut::inscribe::ConvexOptions<'_>| (o.rounds, o.starts, o.seed, o.epsilon);
        assert_eq!(parts(&found), parts(&expected));
    }
}
