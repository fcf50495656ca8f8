//! `taut inscribe ellipse`: the largest ellipse in a polygon.

use std::path::PathBuf;

use taut::certify::InscribedEllipse;
use taut::inscribe::{EllipseMethod, EllipseOptions, EllipseThesisOptions, inscribed_ellipse};
use taut::{Monitor, Solution};

use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::choice::{check_method_options, choice};
use crate::input::reading::{Opened, Reading};
use crate::input::samples::Samples;
use crate::pipeline::{Find, Input, Output, OutputOptions};
use crate::reports;
use crate::watch::Watch;

/// Find the ellipse of largest area in a polygon, with or without holes.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Two columns x, y are the vertices of one ring in order. A third column has the number of the ring, 0, 1, and so on, \
for polygons with holes or of several parts; inside is what an odd number of rings wind around. The last vertex of a \
ring may repeat its first. Rings may neither cross nor touch; if they do, the message names two edges by the rows \
between which they lead. With another method than the default the bound is as near to the best ellipse known as ε \
says, and the gap is that of the ellipse which the method found.
Exit: 0 reached · 1 the check failed · 2 bad input or usage, nothing written ·
      3 stopped early by the budget of cells, or where rounding hides the gap that was asked for;
        the gap reached is reported
Example: taut inscribe ellipse ring.csv -o ellipse.json --draw ellipse.svg &&
         taut verify ellipse.json ring.csv
         taut inscribe ellipse ring.csv --method thesis
         taut inscribe ellipse points.csv --samples --ring ring.csv -o ellipse.json")]
pub(super) struct Ellipse {
    /// Rings of vertices in order, in any format of `taut formats`, such as CSV or GeoJSON; - is standard input
    #[arg(value_name = "RING")]
    path: PathBuf,
    /// The way to find it; the upper bound comes from branch and bound in any case
    #[arg(
        long, value_name = "NAME", default_value = EllipseMethod::default().name(), value_parser = choice::<EllipseMethod>()
    )]
    method: EllipseMethod,
    #[command(flatten)]
    samples: Samples,
    /// Proved relative gap to reach, in (0, 1): largest area ≤ (1 + ε)·area; of other methods that of the best ellipse known
    #[arg(long, value_name = "REAL", default_value = "1e-3", allow_negative_numbers = true)]
    epsilon: f64,
    /// Most cells of the certificate; where ε takes more, a larger gap is proved; at least 1
    #[arg(long, value_name = "N", default_value_t = EllipseOptions::default().max_cells)]
    max_cells: u64,
    /// Of thesis and five-point, samples along the rings, 12 to 1000 [default: 200]
    #[arg(long, value_name = "N")]
    sample_count: Option<u64>,
    /// Of thesis and five-point, the least semi-axis in spacings of the samples, at least 0.5 [default: 1]
    #[arg(long, value_name = "REAL", allow_negative_numbers = true)]
    fatness: Option<f64>,
    /// Of thesis and five-point, the largest angle between normals where ellipse and ring touch, in degrees below 90 [default: 45]
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true)]
    angle: Option<f64>,
    /// Of thesis and five-point, the seed of the order and of the perturbation of the samples [default: 1]
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
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

    fn samples(&self) -> Option<&Samples> {
        Some(&self.samples)
    }

    fn check_method_options(&self) -> anyhow::Result<()> {
        let given = [
            ("sample-count", self.sample_count.is_some()),
            ("fatness", self.fatness.is_some()),
            ("angle", self.angle.is_some()),
            ("seed", self.seed.is_some()),
        ];
        check_method_options(self.method.name(), &given, |_, method: &EllipseMethod| {
            matches!(method, EllipseMethod::Thesis(_) | EllipseMethod::FivePoint(_))
        })
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
        let usual = EllipseThesisOptions::default();
        let thesis = EllipseThesisOptions {
            sample_count: self.sample_count.unwrap_or(usual.sample_count),
            fatness: self.fatness.unwrap_or(usual.fatness),
            angle: self.angle.unwrap_or(usual.angle),
            seed: self.seed.unwrap_or(usual.seed),
        };
        EllipseOptions {
            method: match self.method {
                EllipseMethod::Thesis(_) => EllipseMethod::Thesis(thesis),
                EllipseMethod::FivePoint(_) => EllipseMethod::FivePoint(thesis),
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
        assert_eq!(
            (found.method, found.epsilon, found.max_cells),
            (expected.method, expected.epsilon, expected.max_cells)
        );
        for &(name, method, _) in <taut::inscribe::EllipseMethod as taut::points::Choice>::CHOICES {
            let command = super::Ellipse::augment_args(clap::Command::new("ellipse"));
            let matches = command.get_matches_from(["ellipse", "ring.csv", "--method", name]);
            assert_eq!(
                super::Ellipse::from_arg_matches(&matches).unwrap().options().method,
                method
            );
        }
    }
}
