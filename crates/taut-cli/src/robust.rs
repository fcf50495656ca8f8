//! `taut ellipsoid --robust`: centre, scatter and outliers of most of the points.

use std::path::PathBuf;

use anyhow::bail;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use taut::{RobustMethod, RobustOptions, robust_ellipsoid_of_source};

use crate::clock::Clock;
use crate::exit::Outcome;
use crate::reading::Opened;
use crate::report;
use crate::robust_report::RobustReport;
use crate::verify::judge;
use crate::watch::Watch;
use crate::writing::{self, Outputs};

/// Options that only robust ellipsoids have.
#[derive(Clone, Debug, clap::Args)]
#[command(next_help_heading = "Robust")]
pub(crate) struct Robust {
    /// Let most of the points decide, whatever the others are, and name the outliers
    #[arg(
        long, value_name = "NAME", value_parser = methods(),
        conflicts_with_all = ["balls", "ellipsoids", "method", "max_passes", "seed", "draw"]
    )]
    robust: Option<RobustMethod>,
    /// About which part of the points is kept: mcd and mve take 0.5, where most outliers are borne, to 1; trim takes
    /// what is above 0 up to 1 [default: 0.5; trim 0.9]
    #[arg(long, value_name = "PART", requires = "robust", allow_negative_numbers = true)]
    coverage: Option<f64>,
    /// Part of normal points that the ellipsoid of mcd and mve is to hold, in [0.5, 1) [default: 0.975]
    #[arg(long, value_name = "PART", requires = "robust", allow_negative_numbers = true)]
    level: Option<f64>,
}

fn methods() -> impl TypedValueParser<Value = RobustMethod> {
    let explained = RobustMethod::ALL.map(|method| {
        PossibleValue::new(method.name()).help(match method {
            RobustMethod::Mcd => "the points whose covariance has the least determinant",
            RobustMethod::Mve => "the points that fit the smallest ellipsoid",
            RobustMethod::Trim => "the same, and its ellipsoid as it stands",
        })
    });
    PossibleValuesParser::new(explained).try_map(|name| name.parse::<RobustMethod>())
}

/// What a run needs beside its own options.
pub(crate) struct Run<'a> {
    pub(crate) points: &'a Opened,
    pub(crate) watch: &'a Watch,
    pub(crate) clock: Clock,
    /// Where the JSON goes.
    pub(crate) out: Option<&'a PathBuf>,
    pub(crate) json: bool,
    pub(crate) quiet: bool,
    pub(crate) verify: bool,
}

impl Robust {
    /// The options of the library, where something robust is asked for.
    pub(crate) fn options(&self, epsilon: f64) -> anyhow::Result<Option<RobustOptions>> {
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
            threads: None, // those of the pool, which reading and checking use as well
        }))
    }
}

/// Finds, checks, writes and tells.
pub(crate) fn run(options: &RobustOptions, run: Run<'_>) -> anyhow::Result<Outcome> {
    let Run { points, watch, mut clock, out, json, quiet, verify } = run;
    let found = watch
        .during("solving", |monitor| robust_ellipsoid_of_source(points.source(), options, monitor))
        .map_err(|error| points.explain(error))?;
    clock.lap("solving");

    let mut verdict = None;
    if verify {
        match judge(&found, points, watch)? {
            Ok(proved) => verdict = Some(proved),
            Err(violation) => {
                let violation = points.explain_violation(&violation, "the ellipsoid found");
                writing::complain(&format!("the check failed: {violation}"));
                return Ok(Outcome::CheckFailed);
            }
        }
        clock.lap("checking");
    }

    let mut outputs = Outputs::default();
    let text = || found.to_json() + "\n";
    if let Some(out) = out {
        outputs.add(out, text().as_bytes())?;
    }
    // Where the answer goes to standard output, nothing else does.
    if out.is_none_or(|out| !writing::is_stream(out)) {
        if json {
            outputs.say(&text());
        } else if !quiet {
            let report = RobustReport { found: &found, points, verdict };
            let mut facts = report.facts();
            facts.push(clock.fact());
            outputs.say(&report::text(&report.title(), &facts));
        }
    }
    outputs.finish()?;
    Ok(Outcome::Done)
}

#[cfg(test)]
mod tests {
    use clap::{Args as _, FromArgMatches};

    #[test]
    fn the_defaults_are_those_of_the_library() {
        let command = crate::ellipsoid::Args::augment_args(clap::Command::new("ellipsoid"));
        let matches = command.get_matches_from(["ellipsoid", "points.csv", "--robust", "mcd"]);
        let args = crate::ellipsoid::Args::from_arg_matches(&matches).unwrap();
        assert_eq!(args.robust().unwrap(), Some(taut::RobustOptions::default()));
    }
}
