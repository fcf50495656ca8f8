//! `taut inscribe triangle`: the largest triangle in a polygon.

use std::path::PathBuf;

use taut::certify::InscribedTriangle;
use taut::inscribe::{TriangleMethod, TriangleOptions, TriangleThesisOptions, inscribed_triangle};
use taut::{Monitor, Solution};

use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::choice::{check_method_options, choice};
use crate::input::reading::{Opened, Reading};
use crate::input::samples::Samples;
use crate::pipeline::{Find, Input, Output, OutputOptions};
use crate::reports;
use crate::watch::Watch;

/// Find the triangle of largest area in a polygon, with or without holes.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Two columns x, y are the vertices of one ring in order. A third column has the number of the ring, 0, 1, and so on, \
for polygons with holes or of several parts; inside is what an odd number of rings wind around. The last vertex of a \
ring may repeat its first. Rings may neither cross nor touch; if they do, the message names two edges by the rows \
between which they lead. With another method than the default the bound is as near to the best triangle known as ε \
says, and the gap is that of the triangle which the method found.
Exit: 0 reached · 1 the check failed · 2 bad input or usage, nothing written ·
      3 stopped early by the budget of cells, or where rounding hides the gap that was asked for;
        the gap reached is reported
Example: taut inscribe triangle ring.csv -o triangle.json --draw triangle.svg &&
         taut verify triangle.json ring.csv
         taut inscribe triangle ring.csv --method thesis
         taut inscribe triangle points.csv --samples --ring ring.csv -o triangle.json")]
pub(super) struct Triangle {
    /// Rings of vertices in order, in any format of `taut formats`, such as CSV or GeoJSON; - is standard input
    #[arg(value_name = "RING")]
    path: PathBuf,
    /// The way to find it; the upper bound comes from branch and bound in any case
    #[arg(
        long, value_name = "NAME", default_value = TriangleMethod::default().name(), value_parser = choice::<TriangleMethod>()
    )]
    method: TriangleMethod,
    #[command(flatten)]
    samples: Samples,
    /// Proved relative gap to reach, in (0, 1): largest area ≤ (1 + ε)·area; of other methods that of the best triangle known
    #[arg(long, value_name = "REAL", default_value = "1e-3", allow_negative_numbers = true)]
    epsilon: f64,
    /// Most cells of the certificate; where ε takes more, a larger gap is proved; at least 1
    #[arg(long, value_name = "N", default_value_t = TriangleOptions::default().max_cells)]
    max_cells: u64,
    /// Of thesis, random points in the polygon, 3 to 4096 [default: 300]
    #[arg(long, value_name = "N")]
    sample_count: Option<u64>,
    /// Of thesis, the seed of the random points [default: 1]
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    #[command(flatten)]
    output: OutputOptions,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    effort: Effort,
}

impl Find for Triangle {
    type Answer = InscribedTriangle;
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

    fn check_method_options(&self) -> anyhow::Result<()> {
        let given = [("sample-count", self.sample_count.is_some()), ("seed", self.seed.is_some())];
        check_method_options(self.method.name(), &given, |_, method: &TriangleMethod| {
            matches!(method, TriangleMethod::Thesis(_))
        })
    }

    fn solve(
        &self,
        ring: &Opened,
        watch: &Watch,
    ) -> anyhow::Result<(Solution<InscribedTriangle>, ())> {
        let solve = |monitor: &Monitor<'_>| {
            let options = TriangleOptions { monitor: *monitor, ..self.options() };
            inscribed_triangle(ring.source(), &options)
        };
        let found = watch.during("solving", solve).map_err(|error| ring.explain(error))?;
        Ok((found, ()))
    }

    fn outcome(&self, found: &Solution<InscribedTriangle>) -> Outcome {
        reports::outcome(found.trace.stop, found.certificate.gap, self.epsilon)
    }
}

impl Triangle {
    fn options(&self) -> TriangleOptions<'static> {
        let usual = TriangleThesisOptions::default();
        let thesis = TriangleThesisOptions {
            sample_count: self.sample_count.unwrap_or(usual.sample_count),
            seed: self.seed.unwrap_or(usual.seed),
        };
        TriangleOptions {
            method: match self.method {
                TriangleMethod::Thesis(_) => TriangleMethod::Thesis(thesis),
                other => other,
            },
            epsilon: self.epsilon,
            max_cells: self.max_cells,
            ..TriangleOptions::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::{Args as _, FromArgMatches};

    #[test]
    fn the_defaults_are_those_of_the_library() {
        let command = super::Triangle::augment_args(clap::Command::new("triangle"));
        let matches = command.get_matches_from(["triangle", "ring.csv"]);
        let found = super::Triangle::from_arg_matches(&matches).unwrap().options();
        let expected = taut::inscribe::TriangleOptions::default();
        assert_eq!(
            (found.method, found.epsilon, found.max_cells),
            (expected.method, expected.epsilon, expected.max_cells)
        );
        for &(name, method, _) in <taut::inscribe::TriangleMethod as taut::points::Choice>::CHOICES
        {
            let command = super::Triangle::augment_args(clap::Command::new("triangle"));
            let matches = command.get_matches_from(["triangle", "ring.csv", "--method", name]);
            assert_eq!(
                super::Triangle::from_arg_matches(&matches).unwrap().options().method,
                method
            );
        }
    }
}
