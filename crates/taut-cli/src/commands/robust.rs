//! The options of `taut ellipsoid --robust`: center, scatter and outliers of most of the points.

use anyhow::bail;
use taut::{RobustMethod, RobustOptions};

use crate::input::choice::choice;

/// Options that only robust ellipsoids have.
#[derive(Clone, Debug, clap::Args)]
#[command(next_help_heading = "Robust")]
pub(crate) struct Robust {
    /// Let most of the points decide, whatever the others are, and name the outliers
    #[arg(
        long, value_name = "NAME", value_parser = choice::<RobustMethod>(),
        conflicts_with_all = ["balls", "ellipsoids", "method", "max_passes", "seed"]
    )]
    robust: Option<RobustMethod>,
    /// About which part of the points is kept: mcd and mve take 0.5, where most outliers are borne, to 1; trim takes
    /// what is above 0 up to 1 [default: 0.5; trim 0.9]
    #[arg(
        long = "keep",
        alias = "coverage",
        value_name = "PART",
        requires = "robust",
        allow_negative_numbers = true
    )]
    coverage: Option<f64>,
    /// Part of normal points that the ellipsoid of mcd and mve is to hold, in [0.5, 1) [default: 0.975]
    #[arg(long, value_name = "PART", requires = "robust", allow_negative_numbers = true)]
    level: Option<f64>,
}

impl Robust {
    /// The options of the library, where something robust is asked for.
    pub(crate) fn options(&self, epsilon: f64) -> anyhow::Result<Option<RobustOptions<'static>>> {
        let Some(method) = self.robust else { return Ok(None) };
        if method == RobustMethod::Trim && self.level.is_some() {
            bail!("--level has no meaning with --robust trim, which knows no normal points");
        }
        let default = RobustOptions::default();
        Ok(Some(RobustOptions {
            method,
            coverage: self.coverage,
            level: self.level.unwrap_or(default.level),
            epsilon,
            // The threads are those of the pool, which reading and checking use as well.
            ..default
        }))
    }
}

#[cfg(test)]
mod tests {
    use clap::{Args as _, FromArgMatches};

    #[test]
    fn the_defaults_are_those_of_the_library() {
        let command =
            crate::commands::ellipsoid::Args::augment_args(clap::Command::new("ellipsoid"));
        let matches = command.get_matches_from(["ellipsoid", "points.csv", "--robust", "mcd"]);
        let args = crate::commands::ellipsoid::Args::from_arg_matches(&matches).unwrap();
        assert_eq!(args.robust().unwrap(), Some(taut::RobustOptions::default()));
    }
}
