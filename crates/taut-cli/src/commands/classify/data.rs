//! Points with labels, and models, out of files.

use std::fs::{self, File};
use std::io::Read;
use std::path::Path;

use anyhow::{anyhow, bail};
use taut::Points;
use taut::points::gather;
use taut::recognize::Error;
use taut::recognize::classify::Model;

use crate::input::reading::Opened;
use crate::output::writing::is_stream;

/// Most bytes of a model: 8 GiB.
const MODEL_BYTES_MAX: u64 = 8 << 30;

/// All rows of a file in memory, in double precision.
pub(super) struct Table {
    values: Vec<f64>,
    dim: usize,
}

impl Table {
    pub(super) fn of(opened: &Opened) -> anyhow::Result<Self> {
        let source = opened.source();
        let all: Vec<u64> = (0..source.len()).collect();
        let values = gather(source, &all).map_err(|error| opened.reading_failed(error))?;
        Ok(Table { values, dim: source.dim() })
    }

    pub(super) fn points(&self) -> anyhow::Result<Points<'_, f64>> {
        Ok(Points::new(&self.values, self.dim)?)
    }
}

/// The classes of labels in the order of the alphabet, or of numbers where all are, and the class of each point.
pub(super) fn classes_of(labels: &[String]) -> (Vec<String>, Vec<u32>) {
    let mut classes = labels.to_vec();
    classes.sort();
    classes.dedup();
    if classes.iter().all(|class| class.parse::<f64>().is_ok_and(f64::is_finite)) {
        let value = |class: &String| class.parse().unwrap_or(f64::NAN);
        // Stable, so that texts of one value stay in order.
        classes.sort_by(|a, b| f64::total_cmp(&value(a), &value(b)));
    }
    let place: std::collections::HashMap<&str, u32> =
        classes.iter().map(String::as_str).zip(0..).collect();
    let numbers = labels.iter().map(|label| place[label.as_str()]).collect();
    (classes, numbers)
}

/// The classes of a model to which labels belong.
pub(super) fn classes_in(
    model: &Model,
    labels: &[String],
    points: &Opened,
) -> anyhow::Result<Vec<u32>> {
    let place: std::collections::HashMap<&str, u32> =
        model.classes().iter().map(String::as_str).zip(0..).collect();
    let find = |(row, label): (usize, &String)| {
        place.get(label.as_str()).copied().ok_or_else(|| {
            let known: Vec<&str> = model.classes().iter().map(String::as_str).take(8).collect();
            anyhow!(
                "{}, row {}: the label is `{label}`, which the model does not know: expected one of {}",
                points.name(),
                row + 1,
                known.join(", ")
            )
        })
    };
    labels.iter().enumerate().map(find).collect()
}

/// Reads a model.
pub(super) fn model(path: &Path) -> anyhow::Result<Model> {
    let name = path.display();
    if is_stream(path) {
        bail!("a model is read from a file: name it after --model");
    }
    let failed = |source: std::io::Error| anyhow!("{name}: the model could not be read: {source}");
    if fs::metadata(path).map_err(failed)?.is_dir() {
        bail!("{name} is a folder: name the file of the model");
    }
    let file = File::open(path).map_err(failed)?;
    taut_io::refuse_device(&file, &name.to_string())?;
    let mut text = String::new();
    file.take(MODEL_BYTES_MAX).read_to_string(&mut text).map_err(failed)?;
    Model::from_json(&text).map_err(|error| anyhow!("{name}: {error}"))
}

/// Says where in a file is what was refused.
pub(super) fn explain(points: &Opened, error: Error) -> anyhow::Error {
    match error {
        Error::Dimension { found, expected } => anyhow!(
            "{}: points have {found} coordinate{}, but the model was trained on {expected}; choose them with --columns",
            points.name(),
            if found == 1 { "" } else { "s" }
        ),
        other => points.explain(other),
    }
}
