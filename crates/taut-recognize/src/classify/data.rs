//! Points with the number of a class for each.

use std::collections::BTreeSet;

use taut_points::Points;

use crate::Error;

/// Points in memory, each with the number of its class.
#[derive(Clone, Copy, Debug)]
pub struct Labeled<'a> {
    points: Points<'a, f64>,
    labels: &'a [u32],
    classes: &'a [String],
}

impl<'a> Labeled<'a> {
    /// Joins points, the numbers of their classes, and the names of the classes.
    ///
    /// # Errors
    /// [`Error::LabelCount`], [`Error::Label`], [`Error::ClassPoints`] where a class has no point, [`Error::ClassName`], and
    /// [`taut_points::InputError::NonFinite`].
    pub fn new(
        points: Points<'a, f64>,
        labels: &'a [u32],
        classes: &'a [String],
    ) -> Result<Self, Error> {
        if labels.len() != points.len() {
            return Err(Error::LabelCount { labels: labels.len(), points: points.len() });
        }
        let mut counts = vec![0usize; classes.len()];
        for (row, &label) in labels.iter().enumerate() {
            match counts.get_mut(label as usize) {
                Some(count) => *count += 1,
                None => return Err(Error::Label { row, label, classes: classes.len() }),
            }
        }
        if let Some(empty) = counts.iter().position(|&count| count == 0) {
            let class = classes[empty].clone();
            return Err(Error::ClassPoints { class, points: 0, needs: "each class needs one" });
        }
        if classes.is_empty() {
            return Err(Error::ClassCount { classes: 0, needs: "training needs labeled points" });
        }
        let mut names = BTreeSet::new();
        if let Some(name) = classes.iter().find(|&name| !names.insert(name)) {
            return Err(Error::ClassName { name: name.clone() });
        }
        check_finite(&points)?;
        Ok(Labeled { points, labels, classes })
    }

    /// The points.
    pub fn points(&self) -> Points<'a, f64> {
        self.points
    }

    /// The number of the class of each point.
    pub fn labels(&self) -> &'a [u32] {
        self.labels
    }

    /// The names of the classes.
    pub fn classes(&self) -> &'a [String] {
        self.classes
    }

    /// The rows at some places, with the same classes.
    pub(super) fn subset(&self, places: &[usize]) -> Rows {
        let points = places.iter().flat_map(|&i| self.points.row(i)).copied().collect();
        let labels = places.iter().map(|&i| self.labels[i]).collect();
        Rows { values: points, dim: self.points.dim(), labels, classes: self.classes.len() }
    }

    /// All rows.
    pub(super) fn all(&self) -> Rows {
        Rows {
            values: self.points.values().to_vec(),
            dim: self.points.dim(),
            labels: self.labels.to_vec(),
            classes: self.classes.len(),
        }
    }
}

pub(crate) fn check_finite(points: &Points<'_, f64>) -> Result<(), Error> {
    Ok(taut_points::Rows::F64(*points).check_finite(0)?)
}

/// Labeled rows that a rule learns from; a class may have none.
#[derive(Clone, Debug)]
pub(super) struct Rows {
    /// Row after row.
    pub(super) values: Vec<f64>,
    pub(super) dim: usize,
    pub(super) labels: Vec<u32>,
    pub(super) classes: usize,
}

impl Rows {
    pub(super) fn len(&self) -> usize {
        self.labels.len()
    }

    pub(super) fn row(&self, i: usize) -> &[f64] {
        &self.values[i * self.dim..(i + 1) * self.dim]
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = (&[f64], usize)> {
        self.values.chunks_exact(self.dim).zip(self.labels.iter().map(|&label| label as usize))
    }

    /// The number of rows of each class.
    pub(super) fn counts(&self) -> Vec<usize> {
        let mut counts = vec![0; self.classes];
        self.labels.iter().for_each(|&label| counts[label as usize] += 1);
        counts
    }

    /// The values of the rows of one class, row after row.
    pub(super) fn of_class(&self, class: usize) -> Vec<f64> {
        self.iter().filter(|row| row.1 == class).flat_map(|row| row.0).copied().collect()
    }

    /// The mean of each class, class after class; zeros for a class without rows.
    pub(super) fn means(&self) -> Vec<f64> {
        let mut means = vec![0.0; self.classes * self.dim];
        for (row, class) in self.iter() {
            for (mean, x) in means[class * self.dim..].iter_mut().zip(row) {
                *mean += x;
            }
        }
        for (mean, count) in means.chunks_exact_mut(self.dim).zip(self.counts()) {
            mean.iter_mut().for_each(|mean| *mean /= count.max(1) as f64);
        }
        means
    }
}
