//! Covariances within classes, and their shrinkage.
//!
//! *Idea.* Residuals to the mean of the own class are pooled over all classes of two points or more, with as many degrees of freedom as
//! there are residuals less one for each class. Where these are few, the covariance is drawn towards a multiple of the identity by the
//! amount that has the least expected squared error.
//! *Reference.* Ledoit and Wolf, A well-conditioned estimator for large-dimensional covariance matrices, J. Multivar. Anal. 88, 2004.

use super::data::Rows;
use super::dense;
use crate::Error;

/// Residuals to the means of their classes, row after row.
pub(super) struct Residuals {
    values: Vec<f64>,
    dim: usize,
    count: usize,
    /// Residuals less one for each class.
    freedom: usize,
}

impl Residuals {
    /// Those of all classes of at least two rows.
    pub(super) fn of(rows: &Rows) -> Self {
        let (means, counts, dim) = (rows.means(), rows.counts(), rows.dim);
        let mut values = vec![];
        for (row, class) in rows.iter().filter(|row| counts[row.1] >= 2) {
            let mean = &means[class * dim..(class + 1) * dim];
            values.extend(row.iter().zip(mean).map(|(x, mean)| x - mean));
        }
        let count = values.len() / dim;
        let freedom = count - counts.iter().filter(|&&count| count >= 2).count();
        Residuals { values, dim, count, freedom }
    }

    /// Σ rᵢrⱼ over the residuals r.
    fn products(&self) -> Vec<f64> {
        products(&self.values, self.dim)
    }

    /// The unbiased pooled covariance.
    pub(super) fn pooled(&self) -> Vec<f64> {
        let freedom = self.freedom.max(1) as f64;
        self.products().into_iter().map(|product| product / freedom).collect()
    }

    /// The pooled covariance with the shrinkage of Ledoit and Wolf.
    pub(super) fn shrunk(&self) -> Vec<f64> {
        let (n, d) = (self.count.max(1) as f64, self.dim as f64);
        let mut s: Vec<f64> = self.products().into_iter().map(|product| product / n).collect();
        let mean = (0..self.dim).map(|i| s[i * self.dim + i]).sum::<f64>() / d;
        let squares: f64 = s.iter().map(|x| x * x).sum();
        let lengths = self.values.chunks_exact(self.dim);
        let fourth: f64 =
            lengths.map(|r| r.iter().map(|x| x * x).sum::<f64>()).map(|x| x * x).sum();
        let delta = (squares - d * mean * mean) / d;
        let beta = (fourth / n - squares) / (d * n);
        let share = if delta > 0.0 { (beta / delta).clamp(0.0, 1.0) } else { 1.0 };
        let unbiased = n / self.freedom.max(1) as f64;
        s.iter_mut().for_each(|x| *x *= (1.0 - share) * unbiased);
        (0..self.dim).for_each(|i| s[i * self.dim + i] += share * mean * unbiased);
        s
    }

    /// Refuses residuals that say nothing of the spread within classes.
    pub(super) fn check(&self, rows: &Rows, needs: &'static str) -> Result<(), Error> {
        if self.freedom > 0 {
            return Ok(());
        }
        // All classes have one point.
        Err(Error::ClassCount { classes: rows.classes, needs })
    }
}

fn products(values: &[f64], dim: usize) -> Vec<f64> {
    let mut sums = vec![0.0; dim * dim];
    for r in values.chunks_exact(dim) {
        for i in 0..dim {
            for j in 0..=i {
                sums[i * dim + j] += r[i] * r[j];
            }
        }
    }
    for i in 0..dim {
        for j in 0..i {
            sums[j * dim + i] = sums[i * dim + j];
        }
    }
    sums
}

/// The unbiased covariance of each class, zero for one of a single row.
pub(super) fn of_class(rows: &Rows, class: usize) -> Vec<f64> {
    let values = rows.of_class(class);
    let labels = vec![0; values.len() / rows.dim];
    Residuals::of(&Rows { values, dim: rows.dim, labels, classes: 1 }).pooled()
}

/// The sum of the variances of all coordinates, of all rows together.
pub(super) fn total_variance(rows: &Rows) -> f64 {
    let n = rows.len() as f64;
    (0..rows.dim)
        .map(|j| {
            let column = || rows.values.iter().skip(j).step_by(rows.dim);
            let mean = column().sum::<f64>() / n;
            column().map(|x| (x - mean) * (x - mean)).sum::<f64>() / n
        })
        .sum()
}

/// The sum of the variances of all coordinates within classes.
pub(super) fn within_variance(rows: &Rows) -> f64 {
    let residuals = Residuals::of(rows);
    residuals.values.iter().map(|r| r * r).sum::<f64>() / residuals.freedom.max(1) as f64
}

/// The lower factor of a covariance.
pub(super) fn lower(covariance: &[f64], dim: usize) -> Result<Vec<f64>, Error> {
    dense::factor_with_ridge(covariance, dim).ok_or(Error::Overflow)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows() -> Rows {
        let values = vec![1.0, 2.0, 3.0, 1.0, 2.0, 6.0, -4.0, 0.0, -1.0, 5.0, 7.0, 7.0];
        Rows { values, dim: 2, labels: vec![0, 0, 0, 1, 1, 2], classes: 3 }
    }

    #[test]
    fn the_pooled_covariance_is_that_of_the_definition() {
        // Means: (2, 3), (−2.5, 2.5); the third class has one row. 5 residuals less 2 classes.
        let expected =
            [(1.0 + 1.0 + 0.0 + 2.25 + 2.25) / 3.0, (1.0 - 2.0 + 0.0 + 3.75 + 3.75) / 3.0];
        let found = Residuals::of(&rows()).pooled();
        assert!((found[0] - expected[0]).abs() < 1e-15);
        assert!((found[1] - expected[1]).abs() < 1e-15 && found[1] == found[2]);
        assert!((within_variance(&rows()) - found[0] - found[3]).abs() < 1e-14);
    }

    #[test]
    fn the_shrinkage_minimizes_by_definition() {
        // Directly: δ² = |S − μI|²/d, β² = Σ|rrᵀ − S|²/(n²d), both Frobenius.
        let residuals = Residuals::of(&rows());
        let s: Vec<f64> = residuals.products().iter().map(|x| x / 5.0).collect();
        let mean = (s[0] + s[3]) / 2.0;
        let delta = ((s[0] - mean).powi(2) + (s[3] - mean).powi(2) + 2.0 * s[1] * s[1]) / 2.0;
        let mut beta = 0.0;
        for r in residuals.values.chunks_exact(2) {
            for i in 0..2 {
                for j in 0..2 {
                    beta += (r[i] * r[j] - s[i * 2 + j]).powi(2);
                }
            }
        }
        let share = (beta / 50.0 / delta).min(1.0);
        let found = residuals.shrunk();
        let expected = ((1.0 - share) * s[0] + share * mean) * 5.0 / 3.0;
        assert!((found[0] / expected - 1.0).abs() < 1e-13, "{found:?} {expected}");
        assert!((found[1] / ((1.0 - share) * s[1] * 5.0 / 3.0) - 1.0).abs() < 1e-13);
        // Equal points in each class: nothing to shrink, and no division by 0.
        let flat =
            Rows { values: vec![1.0, 1.0, 2.0, 2.0], dim: 1, labels: vec![0, 0, 1, 1], classes: 2 };
        assert_eq!(Residuals::of(&flat).shrunk(), [0.0]);
    }
}
