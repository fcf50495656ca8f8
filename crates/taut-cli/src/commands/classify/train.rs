//! `taut classify train`.

use std::path::PathBuf;

use anyhow::bail;
use serde_json::json;
use taut::recognize::classify::{
    Cells, Labeled, Model, Preset, PresetOptions, Rule, Scaling, TrainOptions, Width, train,
};

use super::data::{Table, classes_of, explain};
use super::picture::decision_map;
use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::choice::choice;
use crate::input::reading::{Points, Reading, wrong_option};
use crate::output::numbers::{count, counted};
use crate::output::picture::{Drawing, Picture, PictureOptions};
use crate::output::writing::{self, Outputs};

/// Learn a classifier from labeled points.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
All that is learned comes from these points alone: scaling, whitening, widths, thresholds, and the choice among \
several candidates, which inner folds make. Labels of CSV files may be any text; the model keeps them. It also keeps \
rows of the points, as they are after scaling.
Exit: 0 done · 2 bad input or usage, nothing written
Example: taut classify train train.csv --label species --model model.json --method svm --reject 0.01")]
pub(super) struct Args {
    #[command(flatten)]
    points: Points,
    /// Column of the labels, by name or number from 0; svdd alone does without
    #[arg(long, value_name = "COLUMN")]
    label: Option<String>,
    /// The method, or the rule to choose among several
    #[arg(long, value_name = "NAME", default_value = Preset::default().name(), value_parser = choice::<Preset>())]
    method: Preset,
    /// How features are scaled [default: as the method needs]
    #[arg(long, value_name = "NAME", value_parser = choice::<Scaling>())]
    scaling: Option<Scaling>,
    /// Width of Gaussian kernels: auto, or theta=, theta-squared=, gamma=, sigma= or scale= with a number, for
    /// exp(−d²/θ), exp(−d²/θ²), exp(−γd²), exp(−d²/2σ²), and γ = number/variance [default: auto, or by inner folds]
    #[arg(long = "kernel-width", alias = "width", value_name = "WIDTH")]
    width: Option<Width>,
    /// How balls divide the space [default: power; voronoi for whitened-ball]
    #[arg(long = "rule", alias = "cells", value_name = "NAME", value_parser = choice::<Cells>())]
    cells: Option<Cells>,
    /// Share of the points of a class that may be outside its ball, in (0, 1] [default: none; 0.05 for svdd]
    #[arg(long, value_name = "REAL", allow_negative_numbers = true)]
    nu: Option<f64>,
    /// C of support vector machines, above 0 [default: by inner folds]
    #[arg(long, value_name = "REAL", allow_negative_numbers = true)]
    cost: Option<f64>,
    /// Take N steps of Algorithm 11 of the thesis instead of the optimal ball; at least 2
    #[arg(long, value_name = "N")]
    thesis_steps: Option<u64>,
    /// Inner folds, at least 2, for choices, rejection and probabilities [default: 5]
    #[arg(long, value_name = "N")]
    folds: Option<usize>,
    /// Reject points that score below a threshold, which this share of points of the right class misses; in [0, 1)
    #[arg(long, value_name = "SHARE", allow_negative_numbers = true)]
    reject: Option<f64>,
    /// Fit probabilities to scores of points held out
    #[arg(long)]
    probabilities: bool,
    /// Draws folds and the first points of searches
    #[arg(long, value_name = "N", default_value_t = TrainOptions::default().seed)]
    seed: u64,

    /// Where to write the model, as JSON
    #[arg(long, value_name = "FILE", help_heading = "Writing")]
    model: PathBuf,
    /// Draw which class each place of the plane belongs to, if there are two features; .svg, .png or .html
    #[arg(long, value_name = "FILE", help_heading = "Writing")]
    draw: Option<PathBuf>,
    /// Print the summary as JSON
    #[arg(long, help_heading = "Writing")]
    json: bool,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    effort: Effort,
}

impl Args {
    pub(super) fn run(&self) -> anyhow::Result<Outcome> {
        if writing::is_stream(&self.model) {
            bail!("the model is written to a file: name it after --model");
        }
        let given = PresetOptions {
            scaling: self.scaling,
            width: self.width,
            cells: self.cells,
            nu: self.nu,
            cost: self.cost,
            steps: self.thesis_steps,
        };
        let candidates = self.method.candidates(&given).map_err(|error| match error {
            taut::recognize::Error::Input(taut::points::InputError::Option {
                name,
                value,
                expected,
            }) => {
                let name = match name {
                    "steps" => "thesis-steps",
                    "width" => "kernel-width",
                    "cells" => "rule",
                    other => other,
                };
                wrong_option(name, &value, expected)
            }
            other => other.into(),
        })?;
        if self.label.is_none() && self.method != Preset::Svdd {
            bail!("training needs --label COLUMN: only --method svdd learns without labels");
        }
        let needs_folds = candidates.len() > 1 || self.reject.is_some() || self.probabilities;
        if let Some(folds) = self.folds.filter(|_| !needs_folds) {
            let expected = "left out where nothing is chosen, rejected or calibrated";
            return Err(wrong_option("folds", &folds.to_string(), expected));
        }
        let files: Vec<_> =
            [&self.model].into_iter().chain(&self.draw).map(PathBuf::as_path).collect();
        writing::check_writable(&files, &[&self.points.path])?;
        writing::check_json(&self.model, "--model")?;
        let picture = self.draw.as_deref().map(Picture::of_path).transpose()?;
        let watch = self.effort.start()?;
        let opened = self.reading.open_labeled(&self.points.path, self.label.as_deref(), &[])?;
        let table = Table::of(&opened)?;
        let points = table.points()?;
        if self.draw.is_some() && points.dim() != 2 {
            bail!(
                "--draw shows classes in the plane, but the points have {}: choose two with --columns",
                counted(points.dim() as u64, "feature")
            );
        }
        let (classes, labels) = match &self.label {
            Some(_) => classes_of(opened.labels()),
            None => (vec!["inside".to_owned()], vec![0; points.len()]),
        };
        if let Some(folds) = self.folds.filter(|&folds| folds > points.len()) {
            let expected = format!("at most one for each of the {} points", points.len());
            return Err(wrong_option("folds", &folds.to_string(), &expected));
        }
        let data =
            Labeled::new(points, &labels, &classes).map_err(|error| explain(&opened, error))?;
        let found = watch.during("training", |monitor| {
            let options = TrainOptions {
                candidates,
                committee: self.method.committee(),
                folds: self.folds(),
                reject: self.reject,
                calibrate: self.probabilities,
                seed: self.seed,
                monitor: *monitor,
                ..TrainOptions::default()
            };
            train(data, &options)
        });
        let model = found
            .and_then(|model| model.with_columns(opened.names(points.dim())))
            .map_err(|error| explain(&opened, error))?;
        let mut outputs = Outputs::default();
        outputs.add(&self.model, (model.to_json() + "\n").as_bytes())?;
        if let (Some(path), Some(picture)) = (&self.draw, picture) {
            // Options of pictures would collide with the width of kernels.
            let look = PictureOptions::default();
            let options = look.options(opened.names(points.dim()));
            let map = decision_map(&model, &points, &labels, &options)?;
            let drawing = Drawing {
                title: "A classifier in the plane".to_owned(),
                heading: opened.name().to_owned(),
                fields: vec![],
                figures: map.into_iter().collect(),
            };
            outputs.add(path, &picture.draw(drawing, &look)?)?;
        }
        if self.json {
            outputs.print(&(self.summary_json(&model, points.len(), &labels) + "\n"));
        } else if !self.effort.quiet {
            outputs.print(&self.summary(&model, &points, &labels));
        }
        outputs.finish()?;
        for warning in model.warnings() {
            writing::print_error(&warning);
        }
        Ok(Outcome::Done)
    }

    fn folds(&self) -> usize {
        self.folds.unwrap_or(TrainOptions::default().folds)
    }

    fn summary(&self, model: &Model, points: &taut::Points<'_, f64>, labels: &[u32]) -> String {
        let mut text = format!(
            "Classifier for {} of {}, learned from {}\n",
            counted(model.classes().len() as u64, "class").replace("classs", "classes"),
            counted(points.dim() as u64, "feature"),
            counted(points.len() as u64, "point")
        );
        let shown: Vec<String> = counts(model, labels)
            .into_iter()
            .take(10)
            .map(|(class, points)| format!("{class}: {}", count(points)))
            .collect();
        let more = model.classes().len().saturating_sub(shown.len());
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        text += &format!("  classes   {}{more}\n", shown.join(", "));
        let methods = model.methods();
        text += &match &methods[..] {
            [only] => format!("  method    {}\n", described(&only.rule)),
            several => {
                format!("  method    {} that vote\n", counted(several.len() as u64, "method"))
            }
        };
        if let Some(best) = model.trials().iter().max_by_key(|trial| trial.correct) {
            let share = 100.0 * best.correct as f64 / best.points as f64;
            text += &format!(
                "  chosen    among {} by {} inner folds; the best had {share:.2} % right there\n",
                counted(model.trials().len() as u64, "candidate"),
                self.folds()
            );
        }
        if let Some(threshold) = model.threshold() {
            text += &format!("  rejects   scores below {threshold:.6}\n");
        }
        text += &format!("  model     {}\n", self.model.display());
        text
    }

    fn summary_json(&self, model: &Model, points: usize, labels: &[u32]) -> String {
        let counts: Vec<_> = counts(model, labels)
            .into_iter()
            .map(|(name, points)| json!({ "name": name, "points": points }))
            .collect();
        json!({
            "points": points,
            "classes": counts,
            "methods": model.methods(),
            "trials": model.trials(),
            "threshold": model.threshold(),
            "warnings": model.warnings(),
        })
        .to_string()
    }
}

/// The classes with their points.
fn counts<'a>(model: &'a Model, labels: &[u32]) -> Vec<(&'a str, u64)> {
    let mut counts = vec![0; model.classes().len()];
    labels.iter().for_each(|&label| counts[label as usize] += 1);
    model.classes().iter().map(String::as_str).zip(counts).collect()
}

/// A rule in words.
fn described(rule: &Rule) -> String {
    match rule {
        Rule::NearestBox => "nearest box".to_owned(),
        Rule::Ball { width, cells, nu, steps } => {
            let nu = nu.map_or_else(String::new, |nu| format!(", ν = {nu}"));
            let steps = steps.map_or_else(String::new, |steps| format!(", {steps} steps"));
            format!("smallest balls, width {width}, {cells} cells{nu}{steps}")
        }
        Rule::Svdd { width, nu } => format!("soft balls, width {width}, ν = {nu}"),
        Rule::Svm { width, cost } => {
            format!("support vector machine, width {width}, C = {cost}")
        }
        Rule::Mahalanobis { .. } => "Mahalanobis distances".to_owned(),
        Rule::Plda => "two-covariance PLDA".to_owned(),
        _ => "another method".to_owned(),
    }
}
