//! `taut classify predict`.

use std::path::PathBuf;

use serde_json::json;
use taut::recognize::classify::{Model, Prediction};

use super::data::{Table, explain, model};
use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::reading::{Points, Reading};
use crate::output::numbers::exact;
use crate::output::writing::{self, Outputs};

/// Find the classes of points with a trained model.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
A row of the output belongs to the same row of the points. The class of a rejected point is empty. Where the file and \
the model have names of columns, the model takes its own, and others do no harm.
Exit: 0 done · 2 bad input or usage, nothing written
Example: taut classify predict new.csv --model model.json -o classes.csv --scores")]
pub(super) struct Args {
    #[command(flatten)]
    points: Points,
    /// The model that `taut classify train` wrote
    #[arg(long, value_name = "FILE")]
    model: PathBuf,
    /// Add the score of each class, and its probability if the model has some
    #[arg(long)]
    scores: bool,

    /// Where to write the classes: .csv with a header, or .json; - is standard output
    #[arg(short, long, value_name = "FILE", default_value = "-", help_heading = "Writing")]
    out: PathBuf,
    /// Write JSON instead of CSV
    #[arg(long, help_heading = "Writing")]
    json: bool,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    effort: Effort,
}

impl Args {
    pub(super) fn run(&self) -> anyhow::Result<Outcome> {
        writing::check_writable(&[&self.out], &[&self.points.path, &self.model])?;
        let as_json = writing::writes_json(&self.out, self.json, "csv")?;
        let model = model(&self.model)?;
        let watch = self.effort.start()?;
        let opened = self.reading.open_labeled(&self.points.path, None, model.columns())?;
        let table = Table::of(&opened)?;
        let points = table.points()?;
        let found = watch.during("predicting", |_| model.predict(points));
        let found = found.map_err(|error| explain(&opened, error))?;
        let text = if as_json { self.json_of(&model, &found) } else { self.csv_of(&model, &found) };
        let mut outputs = Outputs::default();
        outputs.add(&self.out, text.as_bytes())?;
        outputs.finish()?;
        Ok(Outcome::Done)
    }

    fn csv_of(&self, model: &Model, found: &[Prediction]) -> String {
        let mut header = vec!["class".to_owned()];
        let has_probabilities = found.first().is_some_and(|first| first.probabilities.is_some());
        if self.scores {
            header.extend(model.classes().iter().map(|class| format!("score {class}")));
            if has_probabilities {
                header.extend(model.classes().iter().map(|class| format!("probability {class}")));
            }
        }
        let mut text = row(header.iter().map(|field| quoted(field)));
        for found in found {
            let class = name(model, found).map(quoted).unwrap_or_default();
            let numbers = found.scores.iter().chain(found.probabilities.iter().flatten());
            let numbers = numbers.take(if self.scores { usize::MAX } else { 0 });
            text += &row([class].into_iter().chain(numbers.map(|&number| exact(number))));
        }
        text
    }

    fn json_of(&self, model: &Model, found: &[Prediction]) -> String {
        let rows: Vec<_> = found
            .iter()
            .map(|found| match self.scores {
                true => json!({
                    "class": name(model, found),
                    "scores": found.scores,
                    "probabilities": found.probabilities,
                }),
                false => json!({ "class": name(model, found) }),
            })
            .collect();
        json!({ "classes": model.classes(), "rows": rows }).to_string() + "\n"
    }
}

/// The name of the class, unless the point was rejected.
fn name<'a>(model: &'a Model, found: &Prediction) -> Option<&'a str> {
    found.class.map(|class| model.classes()[class as usize].as_str())
}

fn row(fields: impl Iterator<Item = String>) -> String {
    fields.collect::<Vec<_>>().join(",") + "\n"
}

/// A field of CSV, in quotes where it needs them.
fn quoted(field: &str) -> String {
    match field.contains([',', '"', '\n', '\r']) || field.trim() != field {
        true => format!("\"{}\"", field.replace('"', "\"\"")),
        false => field.to_owned(),
    }
}
