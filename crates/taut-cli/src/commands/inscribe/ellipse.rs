//! `taut inscribe ellipse`: the largest ellipse in a polygon.

mod report;

use std::path::PathBuf;

use taut::certify::InscribedEllipse;
use taut::inscribe::{EllipseFivePointOptions, EllipseMethod, EllipseOptions, inscribed_ellipse};
use taut::{Monitor, Solution};

use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::choice::choice;
use crate::input::reading::{Opened, Reading};
use crate::pipeline::{Find, Input, Output, OutputOptions};
use crate::reports;
use crate::watch::Watch;

/// Find the ellipse of largest area in a polygon, with or without holes.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Two columns x, y are the vertices of one ring in order. A third column has the number of the ring, 0, 1, and so on, for
polygons with holes or of several parts; inside is what an odd number of rings wind around. The last vertex of a ring may
repeat its first. Rings may neither cross nor touch; if they do, the message names two edges by the vertices between
which they lead, counted from 0. With --method five-point the bound is as near to the largest area as ε says, and the gap is
that of the ellipse through samples.
Exit: 0 reached · 1 the check failed · 2 bad input or usage, nothing written ·
      3 stopped early by the budget of cells, or where rounding hides the gap that was asked for;
        the gap reached is reported
Example: taut inscribe ellipse ring.csv -o ellipse.json --draw ellipse.svg &&
         taut verify ellipse.json ring.csv")]
pub(super) struct Ellipse {
    /// Rings of vertices in order, in any format of `taut formats`, such as CSV or GeoJSON; - is standard input
    #[arg(value_name = "RING")]
    path: PathBuf,
    /// The way to find it
    #[arg(
        long, value_name = "NAME", default_value = EllipseMethod::default().name(), value_parser = choice::<EllipseMethod>()
    )]
    method: EllipseMethod,
    /// Of five-point, samples at even distances along the boundary, from 6 to 400
    #[arg(long, value_name = "N", default_value_t = EllipseFivePointOptions::DEFAULT.samples)]
    samples: u64,
    /// Of five-point, the least cosine of the angle between the normals of ellipse and boundary, in (-1, 1)
    #[arg(long, value_name = "REAL", default_value_t = EllipseFivePointOptions::DEFAULT.normal, allow_negative_numbers = true)]
    normal: f64,
    /// Of five-point, the least small radius in distances of samples, at least 0
    #[arg(long, value_name = "REAL", default_value_t = EllipseFivePointOptions::DEFAULT.fatness, allow_negative_numbers = true)]
    fatness: f64,
    /// Proved relative gap to reach, in (0, 1): largest area ≤ (1 + ε)·area
    #[arg(long, value_name = "REAL", default_value = "1e-3", allow_negative_numbers = true)]
    epsilon: f64,
    /// Most cells of the certificate; where ε takes more, a larger gap is proved; at least 1
    #[arg(long, value_name = "N", default_value_t = EllipseOptions::default().max_cells)]
    max_cells: u64,
    #[command(flatten)]
    output: OutputOptions,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    effort: Effort,
}

impl Find for Ellipse {
    type Answer = InscribedEllipse;
    type Extra = ();

    fn input(&self) -> Input<'_> {
        Input { path: &self.path, reading: &self.reading, effort: &self.effort }
    }

    fn output(&self) -> Output<'_> {
        self.output.output()
    }

    fn solve(
        &self,
        ring: &Opened,
        watch: &Watch,
    ) -> anyhow::Result<(Solution<InscribedEllipse>, ())> {
        let solve = |monitor: &Monitor<'_>| {
            let options = EllipseOptions { monitor: *monitor, ..self.options() };
            inscribed_ellipse(ring.source(), &options)
        };
        let found = watch.during("solving", solve).map_err(|error| ring.explain(error))?;
        Ok((found, ()))
    }

    fn outcome(&self, found: &Solution<InscribedEllipse>) -> Outcome {
        reports::outcome(found.trace.stop, found.certificate.gap, self.epsilon)
    }
}

impl Ellipse {
    fn options(&self) -> EllipseOptions<'static> {
        let five_point = EllipseFivePointOptions {
            samples: self.samples,
            normal: self.normal,
            fatness: self.fatness,
        };
        EllipseOptions {
            method: match self.method {
                EllipseMethod::FivePoint(_) => EllipseMethod::FivePoint(five_point),
                other => other,
            },
            epsilon: self.epsilon,
            max_cells: self.max_cells,
            ..EllipseOptions::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::{Args as _, FromArgMatches};

    #[test]
    fn the_defaults_are_those_of_the_library() {
        let command = super::Ellipse::augment_args(clap::Command::new("ellipse"));
        let matches = command.get_matches_from(["ellipse", "ring.csv"]);
        let found = super::Ellipse::from_arg_matches(&matches).unwrap().options();
        let expected = taut::inscribe::EllipseOptions::default();
        assert_eq!((found.epsilon, found.max_cells), (expected.epsilon, expected.max_cells));
        assert_eq!(found.method, expected.method);
    }
}
