//! The six deterministic starts of DetMCD: rankings of the points by how central they look.
//!
//! *Problem.* C-steps lead downhill from where they start; among the starts must be one that outliers have not spoilt.
//! *Idea.* Coordinates are brought to median 0 and scale 1. Six matrices that single outliers cannot bend far, each of
//! another kind, give directions: the correlations of hyperbolic tangents, of ranks and of normal scores, the
//! covariance of signs, that of the half nearest the medians, and the raw OGK matrix of pairs. In the eigenvectors of
//! each, scales are taken again by Qn and a center by medians, and points are ranked by the distance these say.
//! *Guarantee.* A function of the points, of their order only where distances are equal. Shifted and scaled coordinates
//! give the same rankings; turned ones need not: medians by coordinate are not the medians of turned points.
//! *Trap.* Where half of the points lie in a hyperplane a scale is 0. It is taken as a trifle, so that exactly those
//! points come first.
//! *Reference.* Hubert, Rousseeuw, Verdonck, J. Computational and Graphical Statistics 21, 2012; Maronna, Zamar,
//! Technometrics 44, 2002, for OGK.

use taut_kernels::vector::dot;
use taut_points::OrderBy;

use super::chi_square::quantile;
use super::eigen::eigenvectors;
use super::scale::{median, qn};

/// The number of them.
pub(super) const START_COUNT: usize = 6;

/// This part of the largest scale stands for a scale of 0.
const SCALE_RATIO_MIN: f64 = 1e-10;

/// Rows that scales of sums and differences are taken of: there are d(d − 1) such scales.
const PAIR_ROWS: usize = 500;

/// Points by columns, each of median 0 and scale 1.
pub(super) struct Standardized {
    columns: Vec<Vec<f64>>,
    rows: usize,
}

impl Standardized {
    /// Of rows of dimension `dim`; what does not fit into `f64` is infinite and ranks last.
    pub(super) fn of(values: &[f64], dim: usize) -> Self {
        let rows = values.len() / dim;
        let columns = (0..dim)
            .map(|j| {
                let mut column: Vec<f64> = values.iter().skip(j).step_by(dim).copied().collect();
                standardize(&mut column);
                column
            })
            .collect();
        Standardized { columns, rows }
    }

    /// Squared distances by start `which` of [`START_COUNT`].
    pub(super) fn distances(&self, which: usize) -> Vec<f64> {
        let matrix = match which {
            0 => self.correlation(|column| column.iter().map(|x| x.tanh()).collect()),
            1 => self.correlation(ranks),
            2 => {
                let scores = normal_scores(self.rows);
                self.correlation(|column| {
                    let score = |rank: f64| {
                        0.5 * (scores[rank.floor() as usize - 1] + scores[rank.ceil() as usize - 1])
                    };
                    ranks(column).into_iter().map(score).collect()
                })
            }
            3 => self.signs(),
            4 => self.nearest_half(),
            _ => self.pairs(),
        };
        self.refined(matrix)
    }

    fn dim(&self) -> usize {
        self.columns.len()
    }

    fn correlation(&self, transform: impl Fn(&[f64]) -> Vec<f64>) -> Vec<f64> {
        let columns: Vec<Vec<f64>> = self
            .columns
            .iter()
            .map(|column| {
                let mut column = transform(column);
                let mean = column.iter().sum::<f64>() / column.len() as f64;
                column.iter_mut().for_each(|x| *x -= mean);
                let norm = dot(&column, &column).sqrt();
                if norm > 0.0 {
                    column.iter_mut().for_each(|x| *x /= norm);
                }
                column
            })
            .collect();
        symmetric(self.dim(), |a, b| if a == b { 1.0 } else { dot(&columns[a], &columns[b]) })
    }

    fn squares(&self) -> Vec<f64> {
        let mut squares = vec![0.0; self.rows];
        for column in &self.columns {
            squares.iter_mut().zip(column).for_each(|(s, x)| *s += x * x);
        }
        squares
    }

    fn weighted(&self, weights: &[f64]) -> Vec<f64> {
        symmetric(self.dim(), |a, b| {
            let terms = self.columns[a].iter().zip(&self.columns[b]).zip(weights);
            terms.map(|((x, y), w)| if *w > 0.0 { w * x * y } else { 0.0 }).sum()
        })
    }

    /// Σ zz′/|z|².
    fn signs(&self) -> Vec<f64> {
        let weight = |s: f64| if s > 0.0 && s.is_finite() { 1.0 / s } else { 0.0 };
        self.weighted(&self.squares().into_iter().map(weight).collect::<Vec<_>>())
    }

    /// The covariance of the half of the points that lies nearest the medians.
    fn nearest_half(&self) -> Vec<f64> {
        let squares = self.squares();
        let half = self.rows.div_ceil(2);
        let weights: Vec<f64> =
            nearest(&squares, half).into_iter().map(|kept| f64::from(u8::from(kept))).collect();
        let means: Vec<f64> = self
            .columns
            .iter()
            .map(|c| {
                let kept = c.iter().zip(&weights).filter(|(_, w)| **w > 0.0);
                kept.map(|(x, _)| x).sum::<f64>() / half as f64
            })
            .collect();
        let mut matrix = self.weighted(&weights);
        let dim = self.dim();
        for a in 0..dim {
            for b in 0..dim {
                matrix[a * dim + b] = matrix[a * dim + b] / half as f64 - means[a] * means[b];
            }
        }
        matrix
    }

    /// (Qn²(x + y) − Qn²(x − y))/4 for each pair of columns, of their first rows.
    fn pairs(&self) -> Vec<f64> {
        let scale = |x: &[f64], y: &[f64], sign: f64| {
            let pairs = x.iter().zip(y).take(PAIR_ROWS);
            let mut sum: Vec<f64> = pairs.map(|(x, y)| x + sign * y).collect();
            sum.sort_unstable_by(f64::total_cmp);
            qn(&sum)
        };
        symmetric(self.dim(), |a, b| {
            let (x, y) = (&self.columns[a], &self.columns[b]);
            if a == b {
                return 1.0;
            }
            0.25 * (scale(x, y, 1.0).powi(2) - scale(x, y, -1.0).powi(2))
        })
    }

    /// Distances in the eigenvectors of a matrix, with scales and a center of their own.
    fn refined(&self, mut matrix: Vec<f64>) -> Vec<f64> {
        let dim = self.dim();
        let vectors = eigenvectors(&mut matrix, dim);
        let mut images: Vec<Vec<f64>> =
            vectors.chunks_exact(dim).map(|vector| combined(&self.columns, vector)).collect();
        let mut scales: Vec<f64> = images
            .iter()
            .map(|image| {
                let mut sorted = image.clone();
                sorted.sort_unstable_by(f64::total_cmp);
                qn(&sorted)
            })
            .collect();
        let largest = scales.iter().fold(0.0f64, |m, &s| if s > m { s } else { m });
        let least = if largest > 0.0 { SCALE_RATIO_MIN * largest } else { 1.0 };
        scales.iter_mut().for_each(|s| *s = s.max(least));
        for (image, scale) in images.iter_mut().zip(&scales) {
            image.iter_mut().for_each(|x| *x /= scale);
        }
        // Medians along the coordinates, not along the eigenvectors: turned back, |·| stays.
        let mut squares = vec![0.0; self.rows];
        for j in 0..dim {
            let back: Vec<f64> = (0..dim).map(|k| vectors[k * dim + j]).collect();
            let column = combined(&images, &back);
            let center = median(&mut column.clone());
            squares.iter_mut().zip(&column).for_each(|(s, x)| *s += (x - center) * (x - center));
        }
        squares
    }
}

/// Which `count` of the values are least; among equal ones the first.
pub(super) fn nearest(values: &[f64], count: usize) -> Vec<bool> {
    if count == 0 {
        return vec![false; values.len()];
    }
    let mut copy = values.to_vec();
    let (_, &mut bound, _) = copy.select_nth_unstable_by(count - 1, f64::total_cmp);
    let below = values.iter().filter(|v| v.total_cmp(&bound).is_lt()).count();
    let mut ties = count - below;
    values
        .iter()
        .map(|v| match v.total_cmp(&bound) {
            std::cmp::Ordering::Less => true,
            std::cmp::Ordering::Equal if ties > 0 => {
                ties -= 1;
                true
            }
            _ => false,
        })
        .collect()
}

fn symmetric(dim: usize, entry: impl Fn(usize, usize) -> f64) -> Vec<f64> {
    let mut matrix = vec![0.0; dim * dim];
    for a in 0..dim {
        for b in 0..=a {
            let value = entry(a, b);
            let value = if value.is_finite() { value } else { 0.0 };
            (matrix[a * dim + b], matrix[b * dim + a]) = (value, value);
        }
    }
    matrix
}

/// Σ wⱼ·column j.
fn combined(columns: &[Vec<f64>], weights: &[f64]) -> Vec<f64> {
    let mut sum = vec![0.0; columns[0].len()];
    for (column, w) in columns.iter().zip(weights) {
        sum.iter_mut().zip(column).for_each(|(s, x)| *s += w * x);
    }
    sum
}

/// To median 0 and scale 1: Qn, or where half of the values are equal the mean distance from the median, or nothing.
fn standardize(column: &mut [f64]) {
    let mut sorted = column.to_vec();
    let center = median(&mut sorted);
    let n = sorted.len() as f64;
    let scales = [qn(&sorted), sorted.iter().map(|x| (x - center).abs() / n).sum()];
    let scale = scales.into_iter().find(|&s| s > 0.0).unwrap_or(1.0);
    column.iter_mut().for_each(|x| *x = (*x - center) / scale);
}

/// Ranks from 1, equal values sharing the mean of theirs.
fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.order_by(&|&i, &j| values[i].total_cmp(&values[j]));
    let mut ranks = vec![0.0; values.len()];
    let mut start = 0;
    for group in order.chunk_by(|&i, &j| values[i] == values[j]) {
        let rank = start as f64 + 0.5 * (group.len() as f64 + 1.0);
        group.iter().for_each(|&i| ranks[i] = rank);
        start += group.len();
    }
    ranks
}

/// Φ⁻¹((i − 1/3)/(n + 1/3)) for i = 1, …, n.
fn normal_scores(n: usize) -> Vec<f64> {
    let score = |i: usize| {
        let p = (i as f64 - 1.0 / 3.0) / (n as f64 + 1.0 / 3.0);
        quantile((2.0 * p - 1.0).abs(), 1).sqrt() * (p - 0.5).signum()
    };
    (1..=n).map(score).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ties_share_ranks_and_the_first_are_nearest() {
        assert_eq!(ranks(&[3.0, 1.0, 3.0, 2.0]), [3.5, 1.0, 3.5, 2.0]);
        assert_eq!(nearest(&[2.0, 1.0, 2.0, 2.0], 3), [true, true, true, false]);
        let scores = normal_scores(5);
        assert!(scores[2].abs() < 1e-7 && (scores[4] + scores[0]).abs() < 1e-12, "{scores:?}");
    }

    #[test]
    fn every_start_ranks_far_points_last() {
        // A grid of 10 × 10, and 30 points far away on one side.
        let mut values: Vec<f64> =
            (0..100).flat_map(|i| [f64::from(i % 10), f64::from(i / 10) * 3.0]).collect();
        (0..30).for_each(|i| values.extend([1000.0 + f64::from(i % 5), 500.0 + f64::from(i)]));
        let points = Standardized::of(&values, 2);
        for which in 0..START_COUNT {
            let kept = nearest(&points.distances(which), 65);
            assert!(kept[100..].iter().all(|kept| !kept), "start {which}");
        }
    }
}
