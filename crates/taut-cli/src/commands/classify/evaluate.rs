//! `taut classify evaluate`.

use std::path::PathBuf;

use anyhow::bail;
use serde_json::{Value, json};
use taut::recognize::classify::{Model, Prediction};
use taut::recognize::evaluate::{Confusion, ScoreSet, clopper_pearson, warnings};
use taut_draw::Field;

use super::data::{Table, classes_in, explain, model};
use super::picture::{decision_map, trade_off};
use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::reading::{Opened, Points, Reading};
use crate::output::numbers::{count, counted};
use crate::output::picture::{Drawing, Picture, PictureOptions};
use crate::output::writing::{self, Outputs};

/// The confidence of intervals.
const CONFIDENCE: f64 = 0.95;
/// The false match rate at which the false non-match rate is told.
const FMR_SHOWN: f64 = 0.01;
/// Classes of the largest matrix that is printed.
const PRINTED_CLASSES_MAX: usize = 12;

/// Tell how good a model is on labeled points that it was not trained on.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
A rejected point counts as wrong. Intervals are those of Clopper and Pearson with a confidence of 95 %; they hold if \
the points do not depend on each other. FMR is the share of scores against other classes that are accepted, FNMR that \
of scores against the own class that are not, both at one threshold. Sensitivity and specificity are of the class \
named by --positive.
Exit: 0 done · 2 bad input or usage
Example: taut classify evaluate test.csv --label diagnosis --positive malignant --model model.json")]
pub(super) struct Args {
    #[command(flatten)]
    points: Points,
    /// Column of the labels, by name or number from 0
    #[arg(long, value_name = "COLUMN")]
    label: String,
    /// The model that `taut classify train` wrote
    #[arg(long, value_name = "FILE")]
    model: PathBuf,
    /// The class of which sensitivity, specificity and precision are told
    #[arg(long, value_name = "CLASS")]
    positive: Option<String>,

    /// Where to write the report, as .txt or .json; - is standard output
    #[arg(short, long, value_name = "FILE", default_value = "-", help_heading = "Writing")]
    out: PathBuf,
    /// Write JSON instead of words
    #[arg(long, help_heading = "Writing")]
    json: bool,
    /// Draw the classes of the plane, if there are two features, and the error rates over all thresholds; .svg, .png or .html
    #[arg(long, value_name = "FILE", help_heading = "Writing")]
    draw: Option<PathBuf>,
    #[command(flatten)]
    picture: PictureOptions,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    effort: Effort,
}

impl Args {
    pub(super) fn run(&self) -> anyhow::Result<Outcome> {
        let files: Vec<_> =
            [&self.out].into_iter().chain(&self.draw).map(PathBuf::as_path).collect();
        writing::check_writable(&files, &[&self.points.path, &self.model])?;
        let as_json = writing::writes_json(&self.out, self.json, "txt")?;
        let picture = self.draw.as_deref().map(Picture::of_path).transpose()?;
        let model = model(&self.model)?;
        let watch = self.effort.start()?;
        let names = model.columns();
        let opened = self.reading.open_labeled(&self.points.path, Some(&self.label), names)?;
        let table = Table::of(&opened)?;
        let truth = classes_in(&model, opened.labels(), &opened)?;
        let points = table.points()?;
        let refused = |error| explain(&opened, error);
        let found = watch.during("predicting", |_| model.predict(points)).map_err(refused)?;
        let classes: Vec<Option<u32>> = found.iter().map(|found| found.class).collect();
        let matrix = Confusion::new(model.classes(), &truth, &classes).map_err(refused)?;
        let scores = comparisons(&found, &truth);
        let text = match as_json {
            true => self.json_of(&matrix, scores.as_ref(), &opened)?.to_string() + "\n",
            false => self.words_of(&model, &matrix, scores.as_ref(), &opened)?,
        };
        let mut outputs = Outputs::default();
        outputs.add(&self.out, text.as_bytes())?;
        if let (Some(path), Some(picture)) = (&self.draw, picture) {
            let options = self.picture.options(opened.names(points.dim()));
            let map = decision_map(&model, &points, &truth, &options)?;
            let rates = scores.as_ref().map(|scores| trade_off(scores, &options));
            let figures: Vec<_> = map.into_iter().chain(rates).collect();
            if figures.is_empty() {
                bail!("--draw has nothing to show: there is one class, and not two features");
            }
            let drawing = Drawing {
                title: "A classifier on labeled points".to_owned(),
                heading: opened.name().to_owned(),
                fields: vec![Field::new("accuracy", percent(matrix.accuracy()))],
                figures,
            };
            outputs.add(path, &picture.draw(drawing, &self.picture)?)?;
        }
        outputs.finish()?;
        Ok(Outcome::Done)
    }

    fn words_of(
        &self,
        model: &Model,
        matrix: &Confusion,
        scores: Option<&ScoreSet>,
        opened: &Opened,
    ) -> anyhow::Result<String> {
        let refused = |error| explain(opened, error);
        let (right, all) = (matrix.correct(), matrix.total());
        let mut text = format!("Classifier on {}\n", counted(all, "point"));
        let rejected: u64 = matrix.rows().filter_map(|row| row.last()).sum();
        let interval = clopper_pearson(right, all, CONFIDENCE).map_err(refused)?;
        text += &format!(
            "  accuracy     {} ({} of {}); 95 % interval {} to {}\n",
            percent(matrix.accuracy()),
            count(right),
            count(all),
            percent(Some(interval.low)),
            percent(Some(interval.high))
        );
        text += &format!("  rejected     {}\n", count(rejected));
        if let Some(scores) = scores {
            text += &format!(
                "  equal error  {} of scores against the own and other classes; FNMR {} at FMR ≤ 1 %\n",
                percent(Some(scores.equal_error_rate())),
                percent(Some(scores.at_fmr(FMR_SHOWN).fnmr))
            );
        }
        if let Some(name) = &self.positive {
            let binary = matrix.positive(name).map_err(refused)?;
            for (figure, value) in [
                ("sensitivity", binary.sensitivity()),
                ("specificity", binary.specificity()),
                ("precision", binary.precision()),
            ] {
                text += &format!("  {figure:<12} {}; positive is `{name}`\n", percent(value));
            }
        }
        for (class, recall) in
            model.classes().iter().zip(matrix.recalls()).take(PRINTED_CLASSES_MAX)
        {
            text += &format!("  found        {} of `{class}`\n", percent(recall));
        }
        if model.classes().len() <= PRINTED_CLASSES_MAX {
            text += "\n  true class, then points predicted as each class, and rejected\n";
            for (class, row) in model.classes().iter().zip(matrix.rows()) {
                let cells: Vec<String> = row.iter().map(|&cell| format!("{cell:>7}")).collect();
                text += &format!("  {class:<20}{}\n", cells.join(""));
            }
        }
        if let Some(warning) = warnings(all - right, all) {
            text += &format!("  note         {warning}\n");
        }
        Ok(text)
    }

    fn json_of(
        &self,
        matrix: &Confusion,
        scores: Option<&ScoreSet>,
        opened: &Opened,
    ) -> anyhow::Result<Value> {
        let refused = |error| explain(opened, error);
        let (right, all) = (matrix.correct(), matrix.total());
        let interval = clopper_pearson(right, all, CONFIDENCE).map_err(refused)?;
        let positive = match &self.positive {
            Some(name) => {
                let binary = matrix.positive(name).map_err(refused)?;
                json!({
                    "class": name,
                    "sensitivity": binary.sensitivity(),
                    "specificity": binary.specificity(),
                    "precision": binary.precision(),
                    "f1": binary.f1(),
                })
            }
            None => Value::Null,
        };
        Ok(json!({
            "points": all,
            "correct": right,
            "accuracy": matrix.accuracy(),
            "interval": { "confidence": CONFIDENCE, "low": interval.low, "high": interval.high },
            "classes": matrix.classes(),
            "recalls": matrix.recalls(),
            "confusion": matrix.rows().collect::<Vec<_>>(),
            "positive": positive,
            "verification": scores.map(|scores| json!({
                "equal_error_rate": scores.equal_error_rate(),
                "fmr_max": FMR_SHOWN,
                "fnmr": scores.at_fmr(FMR_SHOWN).fnmr,
            })),
            "warning": warnings(all - right, all).map(|warning| warning.to_string()),
        }))
    }
}

/// Scores of points against their own class and against all others; none where the model has one class.
fn comparisons(found: &[Prediction], truth: &[u32]) -> Option<ScoreSet> {
    let (mut genuine, mut impostor) = (vec![], vec![]);
    for (found, &own) in found.iter().zip(truth) {
        for (class, &score) in (0..).zip(&found.scores) {
            if class == own { genuine.push(score) } else { impostor.push(score) }
        }
    }
    ScoreSet::new(genuine, impostor).ok()
}

/// A share in percent.
fn percent(share: Option<f64>) -> String {
    share.map_or_else(|| "none".to_owned(), |share| format!("{:.2} %", 100.0 * share))
}
