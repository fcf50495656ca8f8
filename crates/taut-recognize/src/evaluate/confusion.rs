//! Confusion matrices, with the positive class named.

use crate::Error;

/// How often each class was taken for each.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Confusion {
    classes: Vec<String>,
    /// For each true class, the counts of predicted ones and of rejected points.
    counts: Vec<u64>,
}

/// Counts of one class, called positive, against all others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Binary {
    /// Positive points found so.
    pub true_positives: u64,
    /// Positive points not found so, rejected ones included.
    pub false_negatives: u64,
    /// Points of other classes found positive.
    pub false_positives: u64,
    /// Points of other classes not found positive.
    pub true_negatives: u64,
}

impl Confusion {
    /// Counts points by their classes and what was predicted, `None` being a rejection.
    ///
    /// # Errors
    /// [`Error::LabelCount`] and [`Error::Label`].
    pub fn new(
        classes: &[String],
        truth: &[u32],
        predicted: &[Option<u32>],
    ) -> Result<Self, Error> {
        if truth.len() != predicted.len() {
            return Err(Error::LabelCount { labels: truth.len(), points: predicted.len() });
        }
        let count = classes.len();
        let mut counts = vec![0; count * (count + 1)];
        for (row, (&label, &found)) in truth.iter().zip(predicted).enumerate() {
            let column = found.map_or(count, |found| found as usize);
            let wrong = [Some(label), found].into_iter().flatten().find(|&l| l as usize >= count);
            if let Some(label) = wrong {
                return Err(Error::Label { row, label, classes: count });
            }
            counts[label as usize * (count + 1) + column] += 1;
        }
        Ok(Confusion { classes: classes.to_vec(), counts })
    }

    /// Names of the classes.
    pub fn classes(&self) -> &[String] {
        &self.classes
    }

    /// For each class, the number of its points that were taken for each class, and last of those rejected.
    pub fn rows(&self) -> impl Iterator<Item = &[u64]> {
        self.counts.chunks_exact(self.classes.len() + 1)
    }

    /// All points.
    pub fn total(&self) -> u64 {
        self.counts.iter().sum()
    }

    /// Points whose class was found.
    pub fn correct(&self) -> u64 {
        self.rows().enumerate().map(|(class, row)| row[class]).sum()
    }

    /// The share of points whose class was found; none of no points. A rejected point counts as wrong.
    pub fn accuracy(&self) -> Option<f64> {
        share(self.correct(), self.total())
    }

    /// The share of points of each class that was found, of those classes that have points.
    pub fn recalls(&self) -> Vec<Option<f64>> {
        self.rows().enumerate().map(|(class, row)| share(row[class], row.iter().sum())).collect()
    }

    /// The counts with the class of this name as the positive one.
    ///
    /// # Errors
    /// [`taut_points::InputError::Option`] where no class has the name.
    pub fn positive(&self, name: &str) -> Result<Binary, Error> {
        let expected = "the name of a class";
        let class = self.classes.iter().position(|known| known == name);
        let class = class.ok_or_else(|| Error::option("positive", name.to_owned(), expected))?;
        let mut counts = Binary::default();
        for (truth, row) in self.rows().enumerate() {
            let all: u64 = row.iter().sum();
            if truth == class {
                counts.true_positives += row[class];
                counts.false_negatives += all - row[class];
            } else {
                counts.false_positives += row[class];
                counts.true_negatives += all - row[class];
            }
        }
        Ok(counts)
    }
}

impl Binary {
    /// The share of positive points found: recall, true positive rate.
    pub fn sensitivity(&self) -> Option<f64> {
        share(self.true_positives, self.true_positives + self.false_negatives)
    }

    /// The share of other points not found positive.
    pub fn specificity(&self) -> Option<f64> {
        share(self.true_negatives, self.true_negatives + self.false_positives)
    }

    /// The share of points found positive that are.
    pub fn precision(&self) -> Option<f64> {
        share(self.true_positives, self.true_positives + self.false_positives)
    }

    /// The harmonic mean of sensitivity and precision.
    pub fn f1(&self) -> Option<f64> {
        let wrong = self.false_positives + self.false_negatives;
        share(2 * self.true_positives, 2 * self.true_positives + wrong)
    }
}

fn share(part: u64, whole: u64) -> Option<f64> {
    (whole > 0).then(|| part as f64 / whole as f64)
}
