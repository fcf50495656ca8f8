//! `taut hand evaluate`.

mod report;
mod scans;

use std::path::PathBuf;

use anyhow::{anyhow, bail};
use taut::recognize::Error;
use taut::recognize::evaluate::{Contender, ProtocolOptions, hand_contenders, run_protocol};
use taut::recognize::hand::HandOptions;
use taut::recognize::hand::synthetic::Generator;

use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::reading::wrong_option;
use crate::output::picture::{Picture, PictureOptions};
use crate::output::writing::{self, Outputs};
use report::Report;
use scans::Scans;

/// Synthetic scans, at most.
const SCANS_MAX: u64 = 1_000_000;

/// Tell how well people are recognized by their hands: the experiment of the thesis, over many random splits.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
In each split some scans of each person are for training, and all others are probes. Every method sees the same \
splits. Scans that cannot be measured count as failures to acquire (FTA), people with too few scans as failures to \
enroll (FTE). The second half of the figures is for people from whom nothing was learned but their own template. \
Intervals come from draws of people.
Exit: 0 done · 2 bad input or usage, nothing written
Example: taut hand evaluate scans --labels scans/truth.csv --draw rates.svg
         taut hand evaluate --synthetic 70x10 --seed 1 --feature-table features.csv")]
pub(super) struct Args {
    /// Scans in PNG, JPEG or TIFF, JSON of `taut hand measure`, folders of these, or one table of features
    #[arg(value_name = "PATH")]
    paths: Vec<PathBuf>,
    /// CSV with the columns `file` and `person` [default: a person's scans have one name, and a number at its end]
    #[arg(long, value_name = "FILE")]
    labels: Option<PathBuf>,
    /// Make and measure synthetic scans instead of reading some, such as 70x10
    #[arg(
        long,
        value_name = "PEOPLExSCANS",
        conflicts_with_all = ["paths", "labels", "dpi"],
        value_parser = people_and_scans
    )]
    synthetic: Option<(u64, u64)>,
    /// Dots per inch, 20 to 2400 [default: those of the files]
    #[arg(long, value_name = "REAL", allow_negative_numbers = true)]
    dpi: Option<f64>,
    /// Numbers of training scans
    #[arg(long, value_name = "N", value_delimiter = ',', default_values_t = ProtocolOptions::default().training)]
    training: Vec<usize>,
    /// Random splits, 1 to 100000
    #[arg(long, value_name = "N", default_value_t = ProtocolOptions::default().splits)]
    splits: usize,
    /// Folds of people, of whom one in turn is unseen; at least 2
    #[arg(long, value_name = "N", default_value_t = ProtocolOptions::default().folds)]
    folds: usize,
    /// The false acceptance rate at which rejections are told
    #[arg(long, value_name = "SHARE", default_value_t = ProtocolOptions::default().far_max, allow_negative_numbers = true)]
    far: f64,
    /// Methods, by name [default: all]
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    method: Vec<String>,
    /// Draws splits, folds and intervals, and synthetic people
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,

    /// Where to write the report, as .txt or .json; - is standard output
    #[arg(short, long, value_name = "FILE", default_value = "-", help_heading = "Writing")]
    out: PathBuf,
    /// Write JSON instead of words
    #[arg(long, help_heading = "Writing")]
    json: bool,
    /// Write a table of all features, from which the command starts much faster
    #[arg(long = "feature-table", alias = "table", value_name = "FILE", help_heading = "Writing")]
    table: Option<PathBuf>,
    /// Draw error rates over thresholds, as .svg, .png or .html
    #[arg(long, value_name = "FILE", help_heading = "Writing")]
    draw: Option<PathBuf>,
    #[command(flatten)]
    picture: PictureOptions,
    #[command(flatten)]
    effort: Effort,
}

impl Args {
    pub(super) fn run(&self) -> anyhow::Result<Outcome> {
        if self.paths.is_empty() && self.synthetic.is_none() {
            bail!("name scans, folders of scans or a table of features, or use --synthetic 70x10");
        }
        let outputs = [Some(&self.out), self.table.as_ref(), self.draw.as_ref()];
        let files: Vec<_> = outputs.into_iter().flatten().map(PathBuf::as_path).collect();
        let inputs: Vec<_> = self.paths.iter().chain(&self.labels).map(PathBuf::as_path).collect();
        writing::check_writable(&files, &inputs)?;
        let as_json = writing::writes_json(&self.out, self.json, "txt")?;
        let picture = self.draw.as_deref().map(Picture::of_path).transpose()?;
        let contenders = self.contenders()?;
        let watch = self.effort.start()?;
        let scans = watch.during("measuring", |monitor| self.scans(monitor))?;
        let found = watch.during("splitting", |monitor| {
            let options = ProtocolOptions {
                training: self.training.clone(),
                splits: self.splits,
                folds: self.folds,
                far_max: self.far,
                seed: self.seed,
                monitor: *monitor,
                ..ProtocolOptions::default()
            };
            run_protocol(&scans.attempts(), &contenders, &options)
        });
        let found = found.map_err(explain)?;
        let report = Report {
            scans: &scans,
            contenders: &contenders,
            found: &found,
            splits: self.splits,
            folds: self.folds,
            far: self.far,
            heading: self.heading(),
        };
        let text = if as_json { report.to_json() } else { report.to_words() };
        let mut outputs = Outputs::default();
        outputs.add(&self.out, text.as_bytes())?;
        if let Some(table) = &self.table {
            outputs.add(table, scans.to_table().as_bytes())?;
        }
        if let (Some(path), Some(picture)) = (&self.draw, picture) {
            outputs.add(path, &picture.draw(report.drawing(&self.picture), &self.picture)?)?;
        }
        outputs.finish()?;
        Ok(Outcome::Done)
    }

    /// Says what was read.
    fn heading(&self) -> String {
        match self.synthetic {
            Some((people, scans)) => {
                format!("synthetic scans, {people} people × {scans}, seed {}", self.seed)
            }
            None => {
                let names: Vec<String> =
                    self.paths.iter().take(3).map(|path| path.display().to_string()).collect();
                let more = if self.paths.len() > 3 { ", …" } else { "" };
                names.join(", ") + more
            }
        }
    }

    fn scans(&self, monitor: &taut::points::Monitor<'_>) -> anyhow::Result<Scans> {
        match self.synthetic {
            Some((people, scans)) => {
                let generator = Generator { seed: self.seed, ..Generator::default() };
                Scans::synthetic(&generator, people, scans, monitor)
            }
            None => {
                let options = HandOptions { dots_per_inch: self.dpi, ..HandOptions::default() };
                Scans::read(&self.paths, self.labels.as_deref(), &options, monitor)
            }
        }
    }

    fn contenders(&self) -> anyhow::Result<Vec<Contender>> {
        let mut all = hand_contenders();
        if self.method.is_empty() {
            return Ok(all);
        }
        let known: Vec<String> = all.iter().map(|contender| contender.name.clone()).collect();
        if let Some(unknown) = self.method.iter().find(|name| !known.contains(name)) {
            bail!("option `--method` is {unknown}: expected some of {}", known.join(", "));
        }
        all.retain(|contender| self.method.contains(&contender.name));
        Ok(all)
    }
}

/// The error with options by their names on the command line.
fn explain(error: Error) -> anyhow::Error {
    match error {
        Error::Input(taut::points::InputError::Option { name, value, expected }) => {
            wrong_option(if name == "far_max" { "far" } else { name }, &value, expected)
        }
        other => anyhow!("{other}"),
    }
}

fn people_and_scans(text: &str) -> Result<(u64, u64), String> {
    let parts = text
        .split_once(['x', '×'])
        .and_then(|(people, scans)| Some((people.parse().ok()?, scans.parse().ok()?)));
    parts
        .filter(|&(people, scans): &(u64, u64)| {
            people > 0 && scans > 0 && people.saturating_mul(scans) <= SCANS_MAX
        })
        .ok_or_else(|| format!("expected people × scans, such as 70x10, {SCANS_MAX} scans at most"))
}
