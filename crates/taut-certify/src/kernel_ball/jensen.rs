//! Few distances that prove most points to be inside a ball of a Gaussian kernel.
//!
//! *Idea.* 1 − e^{−γs} is concave in s, so Σ λᵢ·2(1 − exp(−γ|x − xᵢ|²)) ≤ 2Λ(1 − exp(−γS)) with Λ = Σ λᵢ and S = Σ (λᵢ/Λ)|x − xᵢ|². And for
//! any vector m, S = |x − m|² − 2(x − m)·r + v with r = Σ (λᵢ/Λ)(xᵢ − m) and v = Σ (λᵢ/Λ)|xᵢ − m|²: with m near the mean, r is nearly 0.
//! One group of all xᵢ is tried first, then groups of neighbors, whose bounds are added; last, from the nearest group on, the terms of a group
//! take the place of its bound. Where a kernel is narrow, the bounds of groups that are far from x are as good as their terms.
//! *Rounding.* S is at most |x − m|² + 2|x − m||r| + v. Sums of d squares are off by (d + 6)u, those over k multipliers, all of which sum to 1
//! but for 2(k + 2)u, by (4k + 12)u more; the factor 1 + (2d + 8k + 200)u on S, and on the result, covers both and the steps between, the sum
//! over at most 64 groups included.

use taut_points::OrderBy;

use super::distance::{feature_distance, squared_difference};
use crate::arithmetic::U;

/// Numbers of groups, coarse to fine, each used where the support has at least so many times [`GROUP_ROWS`] points.
const GROUP_COUNTS: [usize; 3] = [1, 8, 64];

/// Rows of a group at least, but where there is one group.
const GROUP_ROWS: usize = 4;

/// What a product loses at most where it vanishes.
const LOST_BY_TERM: f64 = f64::from_bits(8);

/// Upper bounds of Σ λᵢ·2(1 − exp(−γ|x − xᵢ|²)) by more and more groups.
pub(super) struct Bounds {
    levels: Vec<Vec<Jensen>>,
}

/// The bound of one group.
struct Jensen {
    /// The points of the group, by their places in the support.
    places: Vec<usize>,
    gamma: f64,
    /// Λ.
    weight: f64,
    /// m.
    mean: Vec<f64>,
    /// At least |r|.
    offset: f64,
    /// At least v.
    spread: f64,
    /// The factor that covers all roundings.
    slack: f64,
}

impl Bounds {
    pub(super) fn of(gamma: f64, rows: &[&[f64]], multipliers: &[f64]) -> Self {
        let slack = 1.0 + (2 * rows[0].len() + 8 * rows.len() + 200) as f64 * U;
        let all: Vec<usize> = (0..rows.len()).collect();
        let counts = GROUP_COUNTS.iter().filter(|&&n| n == 1 || n * GROUP_ROWS <= rows.len());
        let levels = counts.map(|&count| {
            let groups = halved(rows, all.clone(), count).into_iter();
            let group = |places: Vec<usize>| {
                let rows: Vec<&[f64]> = places.iter().map(|&i| rows[i]).collect();
                let multipliers: Vec<f64> = places.iter().map(|&i| multipliers[i]).collect();
                Jensen { places, ..Jensen::of(gamma, &rows, &multipliers, slack) }
            };
            groups.map(group).collect()
        });
        Bounds { levels: levels.collect() }
    }

    /// Whether one of the bounds for x passes a test; NaN, where a sum overflows, is a bound, too.
    ///
    /// `term` is an upper bound of the term of a point of the support, by its place, but for roundings that the factor covers.
    pub(super) fn any(
        &self,
        x: &[f64],
        term: impl Fn(usize) -> f64,
        test: impl Fn(f64) -> bool,
    ) -> bool {
        let mut bounds: Vec<f64> = vec![];
        for groups in &self.levels {
            bounds = groups.iter().map(|group| group.upper_bound(x)).collect();
            if test(bounds.iter().sum()) {
                return true;
            }
        }
        let Some(groups) = self.levels.last().filter(|groups| groups.len() > 1) else {
            return false;
        };
        let nearness: Vec<f64> =
            groups.iter().map(|group| squared_difference(x, &group.mean)).collect();
        let mut order: Vec<usize> = (0..groups.len()).collect();
        order.order_by(&|&a, &b| nearness[a].total_cmp(&nearness[b]));
        // The bounds of each group and of all that are farther.
        let mut rest = vec![0.0; groups.len() + 1];
        for (i, &group) in order.iter().enumerate().rev() {
            rest[i] = rest[i + 1] + bounds[group];
        }
        let mut terms = 0.0;
        order.iter().enumerate().any(|(i, &group)| {
            let Jensen { places, slack, .. } = &groups[group];
            let sum: f64 = places.iter().map(|&place| term(place)).sum();
            terms += sum * slack + places.len() as f64 * LOST_BY_TERM;
            test(terms + rest[i + 1])
        })
    }
}

/// Splits places at the median of the coordinate with the largest extent, until there are `count` groups.
fn halved(rows: &[&[f64]], mut places: Vec<usize>, count: usize) -> Vec<Vec<usize>> {
    if count == 1 || places.len() < 2 {
        return vec![places];
    }
    let extent = |column: &usize| {
        let values = || places.iter().map(|&i| rows[i][*column]);
        values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
    };
    let widest = (0..rows[0].len()).max_by(|a, b| extent(a).total_cmp(&extent(b)));
    let column = widest.unwrap_or(0);
    places.order_by(&|&i, &j| rows[i][column].total_cmp(&rows[j][column]));
    let upper = places.split_off(places.len() / 2);
    let mut groups = halved(rows, places, count / 2);
    groups.extend(halved(rows, upper, count / 2));
    groups
}

impl Jensen {
    fn of(gamma: f64, rows: &[&[f64]], multipliers: &[f64], slack: f64) -> Self {
        let dim = rows[0].len();
        let weight: f64 = multipliers.iter().sum();
        let shares: Vec<f64> = multipliers.iter().map(|lambda| lambda / weight).collect();
        let pairs = || shares.iter().zip(rows);
        let mean: Vec<f64> = (0..dim).map(|j| pairs().map(|(l, row)| l * row[j]).sum()).collect();
        let mut offset = 0.0;
        for (j, m) in mean.iter().enumerate() {
            let terms = || pairs().map(|(l, row)| l * (row[j] - m));
            let size: f64 = terms().map(f64::abs).sum();
            let rest = terms().sum::<f64>().abs() + (slack - 1.0) * size;
            offset += rest * rest;
        }
        let spread = pairs().map(|(l, row)| l * squared_difference(row, &mean)).sum::<f64>();
        // The least normal number makes up for squares that vanish.
        let offset = offset.sqrt() * slack * slack + f64::MIN_POSITIVE.sqrt() * dim as f64;
        Jensen {
            places: vec![],
            gamma,
            weight,
            mean,
            offset,
            spread: spread * slack + f64::MIN_POSITIVE,
            slack,
        }
    }

    /// No less than Σ λᵢ·2(1 − exp(−γ|x − xᵢ|²)); NaN where a sum overflows.
    fn upper_bound(&self, x: &[f64]) -> f64 {
        let square = squared_difference(x, &self.mean) * self.slack + f64::MIN_POSITIVE;
        let sum = (square + 2.0 * square.sqrt() * self.offset + self.spread) * self.slack;
        let bound = feature_distance(self.gamma, sum, self.mean.len());
        self.weight * (bound.value + bound.error) * self.slack + LOST_BY_TERM
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_above_the_sum_and_finer_ones_are_nearer() {
        let spiral = |i: usize| {
            let angle = 0.1 * i as f64;
            [angle * angle.cos(), angle * angle.sin(), 1e3]
        };
        let rows: Vec<[f64; 3]> = (0..300).map(spiral).collect();
        let rows: Vec<&[f64]> = rows.iter().map(|row| &row[..]).collect();
        let sum = (300 * 301 / 2) as f64;
        let multipliers: Vec<f64> = (1..=300).map(|i| f64::from(i) / sum).collect();
        for (gamma, shares) in [(1e-9, [1.0, 1.0, 1.0]), (1e-3, [0.5, 0.9, 0.99])] {
            let bounds = Bounds::of(gamma, &rows, &multipliers);
            assert_eq!(bounds.levels.iter().map(Vec::len).collect::<Vec<_>>(), [1, 8, 64]);
            for x in [[0.0, 0.0, 1e3], [25.0, 5.0, 1e3], [-30.0, 80.0, 990.0], [1e3, 1e3, 0.0]] {
                let term = |row: &&[f64]| 2.0 * -(-gamma * squared_difference(&x, row)).exp_m1();
                let sum: f64 = rows.iter().zip(&multipliers).map(|(row, l)| l * term(row)).sum();
                let term = |i: usize| multipliers[i] * term(&rows[i]);
                let least = |sum: f64| bounds.any(&x, term, |bound| bound <= sum);
                assert!(least(sum * (1.0 + 1e-10)) && !least(sum * (1.0 - 1e-10)), "{sum}");
                for (groups, share) in bounds.levels.iter().zip(shares) {
                    let bound: f64 = groups.iter().map(|group| group.upper_bound(&x)).sum();
                    assert!(bound >= sum && sum >= bound * share * (1.0 - 1e-6), "{bound} {sum}");
                }
            }
        }
    }
}
