//! Public data sets and their random halves.

use rand::SeedableRng;
use rand::seq::SliceRandom;
use taut_recognize::classify::{Labeled, Model, TrainOptions, train};

use super::*;

/// Splits of each set.
pub(crate) const SPLITS: usize = 10;

/// Labeled points with splits into halves.
pub(crate) struct Set {
    pub(crate) name: &'static str,
    pub(crate) dim: usize,
    pub(crate) values: Vec<f64>,
    pub(crate) labels: Vec<u32>,
    pub(crate) classes: Vec<String>,
    /// Rows in an order; the first half of them is for training.
    orders: Vec<Vec<usize>>,
}

/// What a classifier reached over all splits.
pub(crate) struct Reached {
    /// The mean of the accuracies.
    pub(crate) accuracy: f64,
    /// Their standard deviation.
    pub(crate) spread: f64,
    /// The share of each class that was found, over all splits.
    pub(crate) recalls: Vec<f64>,
    /// Seconds to train and to predict.
    pub(crate) seconds: f64,
}

impl Set {
    /// Reads a set of which the first column is the label; `None`, after saying so, where it is missing.
    pub(crate) fn read(name: &'static str, file: &str, classes: &[&str]) -> Result<Option<Self>> {
        let Some(text) = data::read_gz(&format!("recognize/{file}.csv.gz"))? else {
            return Ok(None);
        };
        let (mut labels, mut values) = (vec![], vec![]);
        for line in text.lines().skip(1) {
            let mut fields = line.split(',').map(str::parse::<f64>);
            let label = fields.next().context("a line without a label")??;
            labels.push(label as u32);
            for field in fields {
                values.push(field?);
            }
        }
        let dim = values.len() / labels.len().max(1);
        let count = labels.iter().max().map_or(0, |&most| most as usize + 1);
        let name_of = |class: usize| {
            classes.get(class).map_or_else(|| class.to_string(), |&name| name.to_owned())
        };
        let classes = (0..count).map(name_of).collect();
        let orders = (0..SPLITS).map(|split| order(split as u64, labels.len())).collect();
        Ok(Some(Set { name, dim, values, labels, classes, orders }))
    }

    /// The breast cancer set of Wisconsin with its ten fixed splits.
    pub(crate) fn breast_cancer() -> Result<Option<Self>> {
        let Some(set) = Set::read("breast cancer", "wdbc", &["malignant", "benign"])? else {
            return Ok(None);
        };
        let Some(text) = data::read_gz("recognize/wdbc_splits_10.csv.gz")? else { return Ok(None) };
        let order = |line: &str| line.split(',').map(|row| Ok(row.parse()?)).collect();
        let orders = text.lines().map(order).collect::<Result<Vec<Vec<usize>>>>()?;
        ensure!(orders.len() == SPLITS, "{} splits of the breast cancer set", orders.len());
        Ok(Some(Set { orders, ..set }))
    }

    /// Rows for peers: the label, the features, and for each split 1 where the row is for training.
    pub(crate) fn table(&self) -> (Vec<f64>, usize) {
        let columns = 1 + self.dim + SPLITS;
        let mut table = vec![0.0; self.labels.len() * columns];
        for (row, cells) in table.chunks_exact_mut(columns).enumerate() {
            cells[0] = f64::from(self.labels[row]);
            cells[1..=self.dim].copy_from_slice(self.row(row));
        }
        for (split, order) in self.orders.iter().enumerate() {
            for &row in &order[..order.len() / 2] {
                table[row * columns + 1 + self.dim + split] = 1.0;
            }
        }
        (table, columns)
    }

    fn row(&self, row: usize) -> &[f64] {
        &self.values[row * self.dim..(row + 1) * self.dim]
    }

    fn part(&self, rows: &[usize]) -> (Vec<f64>, Vec<u32>) {
        let values = rows.iter().flat_map(|&row| self.row(row)).copied().collect();
        (values, rows.iter().map(|&row| self.labels[row]).collect())
    }

    /// Trains on one half and predicts the other, for each split.
    pub(crate) fn run(&self, options: &TrainOptions<'_>) -> Result<Reached> {
        let mut accuracies = vec![];
        let (mut right, mut all) = (vec![0.0; self.classes.len()], vec![0.0; self.classes.len()]);
        let start = Instant::now();
        for order in &self.orders {
            let (first, second) = order.split_at(order.len() / 2);
            let ((values, labels), (tests, truth)) = (self.part(first), self.part(second));
            let points = Points::new(&values, self.dim)?;
            let model: Model = train(Labeled::new(points, &labels, &self.classes)?, options)?;
            let found = model.predict(Points::new(&tests, self.dim)?)?;
            let mut hits = 0.0;
            for (found, &label) in found.iter().zip(&truth) {
                let hit = f64::from(u8::from(found.class == Some(label)));
                hits += hit;
                right[label as usize] += hit;
                all[label as usize] += 1.0;
            }
            accuracies.push(hits / truth.len() as f64);
        }
        let seconds = start.elapsed().as_secs_f64();
        let recalls = right.iter().zip(&all).map(|(right, all)| right / all).collect();
        Ok(Reached::of(&accuracies, recalls, seconds))
    }
}

impl Reached {
    pub(crate) fn of(accuracies: &[f64], recalls: Vec<f64>, seconds: f64) -> Self {
        let count = accuracies.len() as f64;
        let accuracy = accuracies.iter().sum::<f64>() / count;
        let squares = accuracies.iter().map(|x| (x - accuracy).powi(2)).sum::<f64>();
        let spread = (squares / (count - 1.0).max(1.0)).sqrt();
        Reached { accuracy, spread, recalls, seconds }
    }
}

/// A random order of rows.
fn order(seed: u64, rows: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..rows).collect();
    order.shuffle(&mut rand::rngs::StdRng::seed_from_u64(seed));
    order
}
