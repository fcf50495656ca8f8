//! `taut inscribe`: large shapes inside another; here the ellipsoid inside a polytope.

mod bodies;
mod circle;
mod dops;
mod ellipse;
mod polygon;
mod rectangle;
mod triangle;

use taut::certify::InscribedEllipsoid;
use taut::{InscribedOptions, Monitor, Solution, inscribed_ellipsoid};

use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::reading::{HalfSpaces, Opened, Reading};
use crate::pipeline::{self, Find, Input, Output, OutputOptions};
use crate::reports;
use crate::watch::Watch;

/// Find the largest shape inside another, with proof.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Example: taut inscribe circle ring.csv -o circle.json --draw circle.svg
See: taut inscribe bodies --help, taut inscribe circle --help, taut inscribe dops --help,
     taut inscribe ellipse --help, taut inscribe ellipsoid --help, taut inscribe polygon --help,
     taut inscribe rectangle --help, taut inscribe triangle --help")]
pub(crate) struct Args {
    #[command(subcommand)]
    body: Body,
}

#[derive(Debug, clap::Subcommand)]
enum Body {
    Bodies(bodies::Bodies),
    Circle(circle::Circle),
    Dops(dops::Dops),
    Ellipse(ellipse::Ellipse),
    Ellipsoid(Ellipsoid),
    Polygon(polygon::Polygon),
    Rectangle(rectangle::Rectangle),
    Triangle(triangle::Triangle),
}

/// Find the ellipsoid of largest volume inside a polytope, given by half-spaces.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
A row a₁, …, a_d, b is the half-space of all x with a₁x₁ + … + a_d x_d ≤ b. The polytope must have an end in every \
direction and an interior point; if not, the message tells why.
Exit: 0 reached · 1 the check failed · 2 bad input or usage, nothing written ·
      3 stopped early by the budget of steps, or where rounding hides the gap that was asked for;
        the gap reached is reported
Example: taut inscribe ellipsoid sides.csv -o inside.json --draw inside.svg &&
         taut verify inside.json sides.csv")]
struct Ellipsoid {
    #[command(flatten)]
    sides: HalfSpaces,
    /// Proved gap to reach, in (0, 1): largest log-volume ≤ log-volume + ε
    #[arg(long, value_name = "REAL", default_value = "1e-9", allow_negative_numbers = true)]
    epsilon: f64,
    /// Most Newton steps, then the ellipsoid so far is given with its gap; at least 1
    #[arg(long, value_name = "N", default_value_t = InscribedOptions::default().max_steps)]
    max_steps: u64,
    #[command(flatten)]
    output: OutputOptions,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    effort: Effort,
}

impl Args {
    pub(crate) fn run(&self) -> anyhow::Result<Outcome> {
        match &self.body {
            Body::Bodies(args) => pipeline::run(args),
            Body::Circle(args) => pipeline::run(args),
            Body::Dops(args) => pipeline::run(args),
            Body::Ellipse(args) => pipeline::run(args),
            Body::Ellipsoid(args) => pipeline::run(args),
            Body::Polygon(args) => pipeline::run(args),
            Body::Rectangle(args) => args.run(),
            Body::Triangle(args) => pipeline::run(args),
        }
    }
}

impl Find for Ellipsoid {
    type Answer = InscribedEllipsoid;
    type Extra = ();

    fn input(&self) -> Input<'_> {
        Input { path: &self.sides.path, reading: &self.reading, effort: &self.effort }
    }

    fn output(&self) -> Output<'_> {
        self.output.output()
    }

    fn solve(
        &self,
        sides: &Opened,
        watch: &Watch,
    ) -> anyhow::Result<(Solution<InscribedEllipsoid>, ())> {
        let solve = |monitor: &Monitor<'_>| {
            inscribed_ellipsoid(
                sides.source(),
                &InscribedOptions { monitor: *monitor, ..self.options() },
            )
        };
        let found = watch.during("solving", solve).map_err(|error| sides.explain(error))?;
        Ok((found, ()))
    }

    fn outcome(&self, found: &Solution<InscribedEllipsoid>) -> Outcome {
        reports::outcome(found.trace.stop, found.certificate.gap, self.epsilon)
    }
}

impl Ellipsoid {
    fn options(&self) -> InscribedOptions<'static> {
        InscribedOptions {
            epsilon: self.epsilon,
            max_steps: self.max_steps,
            ..InscribedOptions::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::{Args as _, FromArgMatches};

    #[test]
    fn the_defaults_are_those_of_the_library() {
        let command = super::Ellipsoid::augment_args(clap::Command::new("ellipsoid"));
        let matches = command.get_matches_from(["ellipsoid", "sides.csv"]);
        let args = super::Ellipsoid::from_arg_matches(&matches).unwrap();
        assert_eq!(args.options(), taut::InscribedOptions::default());
    }
}
