//! `taut inscribe circle`: the largest circle in a polygon.

use std::path::PathBuf;

use taut::certify::InscribedCircle;
use taut::{CircleOptions, Monitor, Solution, inscribed_circle};

use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::reading::{Opened, Reading};
use crate::input::samples::Samples;
use crate::pipeline::{Find, Input, Output, OutputOptions};
use crate::reports;
use crate::watch::Watch;

/// Find the largest circle in a polygon, with or without holes.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Two columns x, y are the vertices of one ring in order. A third column has the number of the ring, 0, 1, and so on, \
for polygons with holes or of several parts; inside is what an odd number of rings wind around. The last vertex of a \
ring may repeat its first. Rings may neither cross nor touch; if they do, the message names two edges by the rows \
between which they lead.
Exit: 0 reached · 1 the check failed · 2 bad input or usage, nothing written ·
      3 stopped early by the budget of cells, or where rounding hides the gap that was asked for;
        the gap reached is reported
Example: taut inscribe circle ring.csv -o circle.json --draw circle.svg &&
         taut verify circle.json ring.csv")]
pub(super) struct Circle {
    /// Rings of vertices in order, in any format of `taut formats`, such as CSV or GeoJSON; - is standard input
    #[arg(value_name = "RING")]
    path: PathBuf,
    #[command(flatten)]
    samples: Samples,
    /// Proved relative gap to reach, in (0, 1): largest radius ≤ (1 + ε)·radius
    #[arg(long, value_name = "REAL", default_value = "1e-9", allow_negative_numbers = true)]
    epsilon: f64,
    /// Most cells of the certificate; where ε takes more, a larger gap is proved; at least 1
    #[arg(long, value_name = "N", default_value_t = CircleOptions::default().max_cells)]
    max_cells: u64,
    #[command(flatten)]
    output: OutputOptions,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    effort: Effort,
}

impl Find for Circle {
    type Answer = InscribedCircle;
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

    fn solve(
        &self,
        ring: &Opened,
        watch: &Watch,
    ) -> anyhow::Result<(Solution<InscribedCircle>, ())> {
        let solve = |monitor: &Monitor<'_>| {
            let options = CircleOptions { monitor: *monitor, ..self.options() };
            inscribed_circle(ring.source(), &options)
        };
        let found = watch.during("solving", solve).map_err(|error| ring.explain(error))?;
        Ok((found, ()))
    }

    fn outcome(&self, found: &Solution<InscribedCircle>) -> Outcome {
        reports::outcome(found.trace.stop, found.certificate.gap, self.epsilon)
    }
}

impl Circle {
    fn options(&self) -> CircleOptions<'static> {
        CircleOptions {
            epsilon: self.epsilon,
            max_cells: self.max_cells,
            ..CircleOptions::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::{Args as _, FromArgMatches};

    #[test]
    fn the_defaults_are_those_of_the_library() {
        let command = super::Circle::augment_args(clap::Command::new("circle"));
        let matches = command.get_matches_from(["circle", "ring.csv"]);
        let found = super::Circle::from_arg_matches(&matches).unwrap().options();
        let expected = taut::CircleOptions::default();
        assert_eq!((found.epsilon, found.max_cells), (expected.epsilon, expected.max_cells));
    }
}
