//! `taut curve`: the curves that points of the plane were sampled from, with what is known about them.

use std::path::{Path, PathBuf};

use anyhow::bail;
use taut::certify::Curve;
use taut::reconstruct::{CurveThesisOptions, Ends};
use taut::{CurveMethod, CurveOptions, Monitor, Solution, curve};
use taut_io::{Content, Format, Polyline, polylines_file};

use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::choice::{check_method_options, choice};
use crate::input::reading::{Opened, Points, Reading};
use crate::output::picture::Picture;
use crate::output::writing::Outputs;
use crate::pipeline::{self, Find, Input, Output};
use crate::watch::Watch;

/// Find the curves that points of the plane were sampled from, noisy or not, and say whether the sampling was dense enough.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Certified means: closed curves without crossings, sampled so densely beside their own features that a smooth curve \
with these samples has the same loops. Where that cannot be said, the reason is told, and the exit code is 0 all the \
same.
Exit: 0 done · 1 the check failed · 2 bad input or usage, nothing written
Example: taut curve points.csv -o curve.json --draw curve.svg && taut verify curve.json points.csv
         taut curve points.csv -o curve.geojson")]
pub(crate) struct Args {
    #[command(flatten)]
    points: Points,
    /// The way to find them
    #[arg(
        long, value_name = "NAME", default_value = CurveMethod::default().name(), value_parser = choice::<CurveMethod>()
    )]
    method: CurveMethod,
    /// Leave ends as they are where samples end, and join none across a gap; of a tour make a path
    #[arg(long)]
    open: bool,
    /// Of thesis and thesis-crude, ρ: how much longer than wide the coarse disk of a point must be, at least 1 [default: 4]
    #[arg(long, value_name = "REAL", allow_negative_numbers = true)]
    rho: Option<f64>,
    /// Of thesis and thesis-crude, ω: the first disk of a point holds (ln n)^(1 + ω) points; above 0 [default: 0.1]
    #[arg(long, value_name = "REAL", allow_negative_numbers = true)]
    omega: Option<f64>,
    /// Of thesis and thesis-crude, the least distance of the curves from their medial axis, in the unit of the points; by default
    /// it is estimated
    #[arg(long, value_name = "REAL", allow_negative_numbers = true)]
    feature: Option<f64>,
    /// Say for each point in the JSON which place on the curves is next to it
    #[arg(long)]
    places: bool,
    /// Do without the independent check
    #[arg(long)]
    no_verify: bool,

    /// Write the answer: .json with the certificate, or the curves alone as .csv or .geojson; - is JSON on standard output
    #[arg(short, long, value_name = "FILE", help_heading = "Writing")]
    out: Option<PathBuf>,
    /// Print the JSON instead of the summary
    #[arg(long, help_heading = "Writing")]
    json: bool,
    /// Write the curves as one path of SVG, in coordinates of the input, with nothing else in the file
    #[arg(long = "path", value_name = "FILE", help_heading = "Writing")]
    svg_path: Option<PathBuf>,
    /// Draw the curves with their points; .svg and .png show one picture, .html all
    #[arg(long, value_name = "FILE", help_heading = "Writing")]
    draw: Option<PathBuf>,

    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    effort: Effort,
}

impl Find for Args {
    type Answer = Curve;
    type Extra = ();

    fn input(&self) -> Input<'_> {
        Input { path: &self.points.path, reading: &self.reading, effort: &self.effort }
    }

    fn output(&self) -> Output<'_> {
        Output {
            no_verify: self.no_verify,
            out: self.out.as_deref(),
            json: self.json,
            draw: self.draw.as_deref(),
        }
    }

    fn check_options(&self) -> anyhow::Result<()> {
        let given = [
            ("rho", self.rho.is_some()),
            ("omega", self.omega.is_some()),
            ("feature", self.feature.is_some()),
        ];
        check_method_options(self.method.name(), &given, |_, method: &CurveMethod| {
            matches!(method, CurveMethod::Thesis(_) | CurveMethod::ThesisCrude(_))
        })?;
        self.line_format()?;
        match &self.svg_path {
            Some(path) if Format::of_path(path).0 != Some(Format::Svg) => {
                bail!("{}: --path writes SVG; name it .svg", path.display())
            }
            _ => Ok(()),
        }
    }

    fn side_files(&self) -> Vec<&Path> {
        self.svg_path.as_deref().into_iter().collect()
    }

    fn solve(&self, points: &Opened, watch: &Watch) -> anyhow::Result<(Solution<Curve>, ())> {
        self.thesis().check().map_err(|error| points.explain(error))?;
        let solve = |monitor: &Monitor<'_>| {
            curve(points.source(), &CurveOptions { monitor: *monitor, ..self.options() })
        };
        let found = watch.during("solving", solve).map_err(|error| points.explain(error))?;
        Ok((found, ()))
    }

    fn write(
        &self,
        found: &mut Solution<Curve>,
        _: &(),
        _: &Opened,
        outputs: &mut Outputs,
        _: &Monitor<'_>,
    ) -> anyhow::Result<()> {
        let curves: Vec<Polyline<'_>> = found
            .answer
            .curves
            .iter()
            .map(|curve| Polyline { vertices: &curve.vertices, closed: curve.closed })
            .collect();
        match (&self.out, self.line_format()?) {
            (Some(out), lines @ Some(_)) => outputs.hold(polylines_file(&curves, out, lines)?),
            (Some(out), None) => outputs.add_json(out, found)?,
            (None, _) => {}
        }
        if let Some(path) = &self.svg_path {
            outputs.hold(polylines_file(&curves, path, Some(Format::Svg))?);
        }
        Ok(())
    }
}

impl Args {
    pub(crate) fn run(&self) -> anyhow::Result<Outcome> {
        pipeline::run(self)
    }

    /// The format of the curves that go to `--out`; none where JSON does.
    fn line_format(&self) -> anyhow::Result<Option<Format>> {
        let Some(out) = &self.out else { return Ok(None) };
        let json = out.extension().is_none_or(|extension| extension.eq_ignore_ascii_case("json"));
        let shown = out.display();
        match Format::of_path_for(out, Content::Curves) {
            Some(Format::Svg) => bail!(
                "{shown}: -o writes JSON, or the curves as .csv or .geojson; draw with --draw {shown}, or write their \
                 path alone with --path {shown}"
            ),
            Some(format) => Ok(Some(format)),
            None if json => Ok(None),
            None if Picture::of_path(out).is_ok() => {
                bail!("{shown}: -o writes JSON or the curves; draw with --draw {shown}")
            }
            None => bail!("{shown}: -o writes .json, .csv or .geojson; name one of these"),
        }
    }

    fn options(&self) -> CurveOptions<'static> {
        CurveOptions {
            method: match self.method {
                CurveMethod::Thesis(_) => CurveMethod::Thesis(self.thesis()),
                CurveMethod::ThesisCrude(_) => CurveMethod::ThesisCrude(self.thesis()),
                other => other,
            },
            ends: if self.open { Ends::Open } else { Ends::Auto },
            places: self.places,
            // The threads are those of the pool, which reading and checking use as well.
            ..CurveOptions::default()
        }
    }

    fn thesis(&self) -> CurveThesisOptions {
        let usual = CurveThesisOptions::default();
        CurveThesisOptions {
            rho: self.rho.unwrap_or(usual.rho),
            omega: self.omega.unwrap_or(usual.omega),
            feature: self.feature,
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::{Args as _, FromArgMatches};

    #[test]
    fn the_defaults_are_those_of_the_library() {
        let command = super::Args::augment_args(clap::Command::new("curve"));
        let matches = command.get_matches_from(["curve", "points.csv"]);
        let args = super::Args::from_arg_matches(&matches).unwrap();
        assert_eq!(args.options(), taut::CurveOptions::default());
    }
}
