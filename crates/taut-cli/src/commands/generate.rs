//! `taut generate`: seeded point sets of the literature, of any size.

use std::io::ErrorKind;
use std::path::PathBuf;

use anyhow::{anyhow, bail};
use clap::builder::{PossibleValue, PossibleValuesParser};
use taut::PointSource;
use taut::points::Distribution;
use taut::points::generate::curves::{CurveNoise, CurveSource, TestCurve};
use taut::points::generate::{Parameters, RadiusLaw};
use taut::points::{Error, GeneratedSource, ScalarKind};
use taut_io::{Format, write_points};

use crate::commands::radii::Balls;
use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::reading::{formats, scalar, wrong_option};
use crate::output::writing;
use crate::watch::Watch;

/// Generate a seeded point set; point i depends on the seed and i alone.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Points are written as they are drawn, so there may be more of them than memory holds.
Example: taut generate normal -n 10000 -d 300 -o normal.npy && taut ball normal.npy")]
pub(crate) struct Args {
    /// The distribution that the points are drawn from
    #[arg(value_parser = distributions())]
    distribution: String,
    /// Number of points, at least 1
    #[arg(short, long = "points", value_name = "N")]
    n: u64,
    /// Dimension, at least 1
    #[arg(short, long = "dim", value_name = "D")]
    d: usize,
    /// Chooses the set
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Half the thickness of a shell, at least 0 [default: 0.1]
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    thickness: Option<f64>,
    /// Number of clusters, clouds or towns, at least 1 [default: 5; √N / 4, at least 10; √(N / 50), at least 8]
    #[arg(long = "clusters", alias = "count", value_name = "K")]
    count: Option<u64>,
    /// Standard deviation of a cluster, at least 0 [default: 0.05]
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    spread: Option<f64>,
    /// Vertices of a polygon, at least 1 [default: N]
    #[arg(long, value_name = "K")]
    vertices: Option<u64>,
    /// Points along an axis of a grid, at least 1 [default: the fewest that make N points]
    #[arg(long, value_name = "K")]
    side: Option<u64>,
    /// Angle by which a grid is turned in the plane of the first two axes [default: 0]
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true)]
    angle: Option<f64>,
    /// The number of turns of a spiral, at least 0 [default: 10]
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    turns: Option<f64>,
    /// Standard deviation of the noise of a torus, at least 0 [default: 0.0001]; of a curve the largest shift off it, in units of
    /// its least local feature size [default: 0.05]
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    noise: Option<f64>,
    /// The curve of `curve`
    #[arg(long, value_name = "SHAPE", value_parser = shapes())]
    shape: Option<String>,
    /// Share of the points of a curve that have nothing to do with it, from 0 to 1 [default: 0]
    #[arg(
        long = "outlier-share",
        alias = "outliers",
        value_name = "SHARE",
        allow_negative_numbers = true
    )]
    outliers: Option<f64>,
    /// Make balls: a last column of radii, equal:R, uniform:A:B or exponential:MEAN
    #[arg(long, value_name = "LAW")]
    radii: Option<RadiusLaw>,

    /// Where to write; - is standard output
    #[arg(short, long, value_name = "FILE", default_value = "-", help_heading = "Writing")]
    out: PathBuf,
    /// Format of the points; `taut formats` lists them [default: told by the name, csv for -]
    #[arg(long, value_name = "F", value_parser = formats(Format::writes), hide_possible_values = true, help_heading = "Writing")]
    format: Option<Format>,
    /// Type of a coordinate; points are drawn in f64, then rounded
    #[arg(long = "type", value_name = "TYPE", default_value = "f64", value_parser = scalar(), help_heading = "Writing")]
    scalar: ScalarKind,

    #[command(flatten)]
    effort: Effort,
}

/// The name of samples of curves.
const CURVE: &str = "curve";

fn distributions() -> PossibleValuesParser {
    let curve =
        (CURVE, "near curves of the plane, denser where features are small; --shape says which");
    let all = Distribution::NAMES.into_iter().chain([curve]);
    PossibleValuesParser::new(all.map(|(name, help)| PossibleValue::new(name).help(help)))
}

fn shapes() -> PossibleValuesParser {
    PossibleValuesParser::new(
        TestCurve::NAMES.map(|(name, help)| PossibleValue::new(name).help(help)),
    )
}

impl Args {
    pub(crate) fn run(&self) -> anyhow::Result<Outcome> {
        if self.n == 0 {
            bail!("-n is 0: expected at least 1 point");
        }
        // Before a curve is made, which takes threads.
        let watch = self.effort.start()?;
        if self.distribution == CURVE {
            return self.write(&watch, &self.curve()?);
        }
        for (name, is_given) in
            [("shape", self.shape.is_some()), ("outlier-share", self.outliers.is_some())]
        {
            if is_given {
                bail!("--{name} belongs to curve, not to {}: leave it out", self.distribution);
            }
        }
        let distribution = self.distribution().map_err(refused)?;
        let points = GeneratedSource::new(distribution, self.n, self.d, self.seed, self.scalar)
            .map_err(refused)?;
        let balls = self
            .radii
            .map(|law| Balls::new(points, self.seed, law))
            .transpose()
            .map_err(refused)?;
        match &balls {
            Some(balls) => self.write(&watch, balls),
            None => self.write(&watch, &points),
        }
    }

    /// The rows near a curve.
    fn curve(&self) -> anyhow::Result<CurveSource> {
        // All that other distributions take; noise is shared.
        let foreign = [
            ("thickness", self.thickness.is_some()),
            ("clusters", self.count.is_some()),
            ("spread", self.spread.is_some()),
            ("vertices", self.vertices.is_some()),
            ("side", self.side.is_some()),
            ("angle", self.angle.is_some()),
            ("turns", self.turns.is_some()),
            ("radii", self.radii.is_some()),
        ];
        if let Some((name, _)) = foreign.iter().find(|(_, is_given)| *is_given) {
            bail!("--{name} belongs to other distributions, not to curve: leave it out");
        }
        if self.d != 2 {
            return Err(wrong_option(
                "dim",
                &self.d.to_string(),
                "2: these curves are in the plane",
            ));
        }
        let Some(shape) = self.shape.as_deref().and_then(TestCurve::named) else {
            bail!("curve needs --shape: `taut generate --help` lists them");
        };
        let noise = CurveNoise {
            delta: self.noise.unwrap_or(0.05),
            outliers: self.outliers.unwrap_or(0.0),
            ..CurveNoise::default()
        };
        CurveSource::new(shape.build(), self.n, noise, self.seed, self.scalar).map_err(refused)
    }

    fn write(&self, watch: &Watch, source: &dyn PointSource) -> anyhow::Result<Outcome> {
        let format = match self.format {
            None if writing::is_stream(&self.out) => Some(Format::Csv),
            given => given,
        };
        let written = watch.during("writing", |monitor| {
            monitor.pass(1, source.len());
            write_points(source, &[], &self.out, format, monitor)
        });
        match written {
            // Whoever reads the points has enough: `taut generate ... | head` is no failure.
            Err(taut_io::Error::Write { source, .. }) if source.kind() == ErrorKind::BrokenPipe => {
            }
            written => written?,
        }
        Ok(Outcome::Done)
    }

    fn distribution(&self) -> Result<Distribution, Error> {
        let Args { thickness, count, spread, vertices, side, angle, turns, noise, .. } = *self;
        let given = Parameters { thickness, count, spread, vertices, side, angle, turns, noise };
        Distribution::named(&self.distribution, self.n, self.d, &given)
    }
}

/// The name that the command line gives to a parameter of a distribution.
fn option_of(parameter: &str) -> &str {
    match parameter {
        "count" => "clusters",
        "outliers" => "outlier-share",
        other => other,
    }
}

/// Returns what the generator refused, under the name that the command line gives it.
fn refused(error: Error) -> anyhow::Error {
    match error {
        Error::Parameter { name, value, expected } => {
            wrong_option(option_of(name), &value, expected)
        }
        Error::Foreign { name, owner, distribution } => {
            let name = option_of(name);
            anyhow!("--{name} belongs to {owner}, not to {distribution}: leave it out")
        }
        Error::ZeroDimension => wrong_option("dim", "0", "a dimension of at least 1"),
        other => other.into(),
    }
}
