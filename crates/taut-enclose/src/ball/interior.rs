//! The ball of many points by an interior-point method, for points of which an active set would take thousands of steps.
//!
//! *Problem.* Points pᵢ in ℝᵈ, bᵢ = |pᵢ|²: minimize t + |c|² where all slacks sᵢ = t − bᵢ + 2pᵢ·c are at least 0. The
//! multipliers λ ≥ 0 of the dual have Σλᵢ = 1 and Σλᵢpᵢ = c, and sᵢλᵢ = 0 at the optimum.
//! *Idea.* Follow sᵢλᵢ = μ → 0. With Q the rows (2pᵢ, 1), a Newton step is (diag(2, …, 2, 0) + Q′ diag(λ/s) Q)(Δc, Δt) =
//! (−2c, −1) + Q′(g/s), so d + 1 unknowns however many points. Predictor and corrector after Mehrotra, g = 0 and then
//! g = σμ − Δs·Δλ. Rows with a small λ/s hardly change the matrix and are left out of it.
//! *Guarantee.* The center and the level t stay feasible, but for rounding; multipliers are feasible after a full step.
//! Near a sphere ten steps gain three digits or more.
//! *Measured.* Corrections of Gondzio's kind save a fifth of the steps, and cost as much as that in products with the rows.
//! *Trap.* Accuracy ends at a gap of about 1e-14, and no multiplier is zero: an active set finishes the work.
//! *Reference.* Mehrotra, SIAM J. Optim. 2(4), 1992; leaving out rows: Tits, Absil and Woessner, SIAM J. Optim. 17(1), 2006.

use taut_kernels::matrix::{Matrix, MatrixMut, set_product};
use taut_kernels::vector::{add_combination, dot};
use taut_points::parallel::ParallelSlice;
use taut_points::{Cancelled, Monitor};

use crate::cholesky::Cholesky;

/// A step goes this part of the way to where a slack or a multiplier becomes 0.
const STEP_FRACTION: f64 = 0.99;
/// A shorter step gains nothing: rounding has taken the last digit.
const STEP_LEAST: f64 = 1e-6;
/// Level and lower bound may differ by this part of the squared radius for rounding alone, while the products of slacks and
/// multipliers, which are updated and not computed afresh, go on falling.
const ROUNDING_GAP: f64 = 2e-14;
/// At most this many steps are taken from one start.
const STEPS_MAX: usize = 40;
/// A start leaves all slacks at least this part of what the farthest new point exceeds the level by.
const START_SLACK: f64 = 0.5;
/// Rows whose λ/s is below this part of the (d + 1)-st largest are left out of the matrix. Measured on noisy spheres, d = 100
/// and 300: 1e-3 leaves out a third of the rows and takes no more steps, 1e-2 half of the rows for a quarter more steps.
const RATIO_CUT: f64 = 1e-3;
/// Rows, and columns of the matrix, that one task works on: fixed, so that the result does not depend on threads.
const TILE_ROWS: usize = 256;
const TILE_COLUMNS: usize = 64;

/// The points, relative to an origin near their center.
pub(super) struct Rows {
    dim: usize,
    /// k × d, row-major.
    coordinates: Vec<f64>,
    norms2: Vec<f64>,
}

impl Rows {
    pub(super) fn new(dim: usize) -> Self {
        Rows { dim, coordinates: vec![], norms2: vec![] }
    }

    pub(super) fn push(&mut self, row: impl Iterator<Item = f64>) {
        let start = self.coordinates.len();
        self.coordinates.extend(row);
        let row = &self.coordinates[start..];
        self.norms2.push(dot(row, row));
    }

    pub(super) fn len(&self) -> usize {
        self.norms2.len()
    }

    pub(super) fn row(&self, i: usize) -> &[f64] {
        &self.coordinates[i * self.dim..(i + 1) * self.dim]
    }

    /// Qx: 2pᵢ·y + u of each row for x = (y, u).
    fn times(&self, x: &[f64]) -> Vec<f64> {
        let (y, u) = x.split_at(self.dim);
        let mut product = vec![0.0; self.len()];
        product.par_chunks_mut(TILE_ROWS).enumerate().for_each(|(tile, out)| {
            for (j, value) in out.iter_mut().enumerate() {
                *value = 2.0 * dot(self.row(tile * TILE_ROWS + j), y) + u[0];
            }
        });
        product
    }

    /// Σ vᵢpᵢ.
    fn combination(&self, v: &[f64]) -> Vec<f64> {
        let parts: Vec<Vec<f64>> = (v.par_chunks(TILE_ROWS).enumerate())
            .map(|(tile, v)| {
                let mut sum = vec![0.0; self.dim];
                add_combination(&mut sum, v, |i| self.row(tile * TILE_ROWS + i));
                sum
            })
            .collect();
        let mut sum = vec![0.0; self.dim];
        add_combination(&mut sum, &vec![1.0; parts.len()], |part| &parts[part]);
        sum
    }
}

/// A center inside the constraints, and multipliers.
#[derive(Clone)]
pub(super) struct InteriorPoint {
    /// c.
    center: Vec<f64>,
    /// t.
    level: f64,
    slacks: Vec<f64>,
    /// λ; all positive.
    multipliers: Vec<f64>,
    /// By how much the farthest row exceeded the level at the last start.
    excess: f64,
    /// Steps taken so far.
    pub(super) steps: u64,
}

impl InteriorPoint {
    /// Starts at a center that was optimal for some of the rows, with that level.
    pub(super) fn new(rows: &Rows, center: Vec<f64>, level: f64) -> Self {
        let mut point = InteriorPoint {
            center,
            level,
            slacks: vec![],
            multipliers: vec![],
            excess: 0.0,
            steps: 0,
        };
        point.start(rows);
        point
    }

    pub(super) fn center(&self) -> &[f64] {
        &self.center
    }

    pub(super) fn multipliers(&self) -> &[f64] {
        &self.multipliers
    }

    /// t + |c|², the squared radius around the center that holds all rows.
    pub(super) fn radius2(&self) -> f64 {
        self.level + dot(&self.center, &self.center)
    }

    /// By how much the farthest row exceeded the level at the last start, in units of the squared radius.
    pub(super) fn excess(&self) -> f64 {
        self.excess
    }

    /// Starts afresh with the rows there are now: raises the level until all of them are inside, and gives each the
    /// multiplier with the same product, whatever the old ones were. Their sum of rows is not c then; a full step mends that.
    pub(super) fn start(&mut self, rows: &Rows) {
        let mut x = self.center.clone();
        x.push(0.0);
        let product = rows.times(&x);
        let levels = || rows.norms2.iter().zip(&product).map(|(b, product)| b - product);
        let highest = levels().fold(f64::NEG_INFINITY, f64::max);
        self.excess = (highest - self.level).max(f64::EPSILON * rows.largest_norm2());
        self.level = highest + START_SLACK * self.excess;
        self.slacks = levels().map(|level| self.level - level).collect();
        let total: f64 = self.slacks.iter().map(|s| 1.0 / s).sum();
        self.multipliers = self.slacks.iter().map(|s| 1.0 / s / total).collect();
    }

    /// The lower bound on the squared radius that the multipliers prove, Σ λᵢbᵢ − |Σ λᵢpᵢ|² for Σλ = 1.
    pub(super) fn lower_bound(&self, rows: &Rows) -> f64 {
        let total: f64 = self.multipliers.iter().sum();
        let combination = rows.combination(&self.multipliers);
        dot(&self.multipliers, &rows.norms2) / total
            - dot(&combination, &combination) / (total * total)
    }

    /// Steps until Σ sᵢλᵢ is no more than `gap` (in units of the squared radius), and level and lower bound differ by
    /// no more, or by no more than rounding; or until rounding or [`STEPS_MAX`] ends it.
    pub(super) fn follow(
        &mut self,
        rows: &Rows,
        gap: f64,
        monitor: &Monitor<'_>,
    ) -> Result<(), Cancelled> {
        let mut settled: Option<Self> = None;
        for _ in 0..STEPS_MAX {
            monitor.check()?;
            let wanted = gap.max(ROUNDING_GAP * self.radius2());
            let products = dot(&self.slacks, &self.multipliers);
            if products <= wanted {
                let is_proved = self.radius2() - self.lower_bound(rows) <= wanted;
                match settled {
                    _ if is_proved && products <= gap => return Ok(()),
                    _ if is_proved => settled = Some(self.clone()),
                    // Where all rows are cospherical, steps below rounding can lead away again.
                    Some(_) => break,
                    None => {}
                }
            }
            if !self.step(rows) {
                break;
            }
        }
        if let Some(settled) = settled {
            *self = InteriorPoint { steps: self.steps, ..settled };
        }
        Ok(())
    }

    /// One predictor and corrector; false when rounding has taken the last digit.
    fn step(&mut self, rows: &Rows) -> bool {
        let k = rows.len();
        let ratio: Vec<f64> =
            self.multipliers.iter().zip(&self.slacks).map(|(l, s)| l / s).collect();
        // With g = 0 the rows drop out of the right-hand side.
        let mut right: Vec<f64> = self.center.iter().map(|c| -2.0 * c).collect();
        right.push(-1.0);
        let Some(solver) = Cholesky::of(rows.normal(&ratio), [&right], 0.0) else { return false };
        let mu = dot(&self.slacks, &self.multipliers) / k as f64;

        let slacks = rows.times(&solver.solution());
        let multipliers: Vec<f64> =
            (0..k).map(|i| -self.multipliers[i] - ratio[i] * slacks[i]).collect();
        let primal = longest(&self.slacks, &slacks, 1.0);
        let dual = longest(&self.multipliers, &multipliers, 1.0);
        let ahead = (0..k).map(|i| {
            (self.multipliers[i] + dual * multipliers[i]) * (self.slacks[i] + primal * slacks[i])
        });
        let sigma = (ahead.sum::<f64>() / (k as f64 * mu)).max(0.0).powi(3);

        let target: Vec<f64> =
            (0..k).map(|i| (sigma * mu - slacks[i] * multipliers[i]) / self.slacks[i]).collect();
        for (r, sum) in right.iter_mut().zip(rows.combination(&target)) {
            *r += 2.0 * sum;
        }
        right[rows.dim] += target.iter().sum::<f64>();
        let x = solver.back(solver.forward(&right));
        let slacks = rows.times(&x);
        let multipliers: Vec<f64> =
            (0..k).map(|i| target[i] - self.multipliers[i] - ratio[i] * slacks[i]).collect();
        let primal = longest(&self.slacks, &slacks, STEP_FRACTION);
        let dual = longest(&self.multipliers, &multipliers, STEP_FRACTION);
        let finite = x.iter().chain(&multipliers).all(|v| v.is_finite());
        if !finite || primal.min(dual) < STEP_LEAST {
            return false;
        }
        self.steps += 1;
        self.center.iter_mut().zip(&x).for_each(|(c, d)| *c += primal * d);
        self.level += primal * x[rows.dim];
        self.slacks.iter_mut().zip(&slacks).for_each(|(s, d)| *s += primal * d);
        self.multipliers.iter_mut().zip(&multipliers).for_each(|(l, d)| *l += dual * d);
        self.slacks.iter().chain(&self.multipliers).all(|v| *v > 0.0)
    }
}

impl Rows {
    fn largest_norm2(&self) -> f64 {
        self.norms2.iter().copied().fold(0.0, f64::max)
    }

    /// diag(2, …, 2, 0) + Q′ diag(ratio) Q without the rows of small ratios, (d + 1) × (d + 1); the upper triangle by
    /// rows is what is read of it.
    fn normal(&self, ratio: &[f64]) -> Vec<f64> {
        let p = self.dim + 1;
        let least = RATIO_CUT * nth_largest(ratio, p);
        let kept: Vec<usize> = (0..ratio.len()).filter(|&i| ratio[i] >= least).collect();
        let mut scaled = vec![0.0; kept.len() * p];
        scaled.par_chunks_mut(TILE_ROWS * p).enumerate().for_each(|(tile, out)| {
            for (row, &i) in out.chunks_exact_mut(p).zip(&kept[tile * TILE_ROWS..]) {
                let root = ratio[i].sqrt();
                for (scaled, x) in row.iter_mut().zip(self.row(i)) {
                    *scaled = 2.0 * root * x;
                }
                row[self.dim] = root;
            }
        });
        let all = Matrix::from_rows(&scaled, kept.len(), p);
        let mut normal = vec![0.0; p * p];
        normal.par_chunks_mut(TILE_COLUMNS * p).enumerate().for_each(|(tile, rows)| {
            let (first, count) = (tile * TILE_COLUMNS, rows.len() / p);
            // Only what is right of the diagonal of the tile.
            let (left, right) =
                (all.column_range(first..first + count), all.column_range(first..p));
            let target = MatrixMut::from_rows(rows, count, p).columns_from(first);
            set_product(target, left.transpose(), right);
        });
        for j in 0..self.dim {
            normal[j * p + j] += 2.0;
        }
        normal
    }
}

/// The n-th largest value, or the smallest where there are fewer.
fn nth_largest(values: &[f64], n: usize) -> f64 {
    let mut sorted = values.to_vec();
    let position = sorted.len().saturating_sub(n);
    *sorted.select_nth_unstable_by(position, f64::total_cmp).1
}

/// The largest step ≤ 1 that goes at most `fraction` of the way to where a value becomes 0.
fn longest(values: &[f64], direction: &[f64], fraction: f64) -> f64 {
    let bound = |(v, d): (&f64, &f64)| if *d < 0.0 { -fraction * v / d } else { 1.0 };
    values.iter().zip(direction).map(bound).fold(1.0, f64::min)
}

#[cfg(test)]
mod tests {
    use taut_points::{Distribution, generate};

    use super::*;

    /// Rows relative to the mean of all, as those of a working set are to that of a sample.
    fn rows_of(values: &[f64], dim: usize) -> Rows {
        let mut mean = vec![0.0; dim];
        let count = (values.len() / dim) as f64;
        for row in values.chunks_exact(dim) {
            mean.iter_mut().zip(row).for_each(|(m, x)| *m += x / count);
        }
        let mut rows = Rows::new(dim);
        for row in values.chunks_exact(dim) {
            rows.push(row.iter().zip(&mean).map(|(x, m)| x - m));
        }
        rows
    }

    /// Follows the path from the center of the first point to the end; returns the point there.
    fn end_of_path(rows: &Rows) -> InteriorPoint {
        let mut point = InteriorPoint::new(rows, rows.row(0).to_vec(), -rows.norms2[0]);
        point.follow(rows, 1e-15, &Monitor::silent()).unwrap();
        point
    }

    #[test]
    fn the_path_ends_at_the_optimum() {
        for (k, distribution) in [
            Distribution::Normal,
            Distribution::Uniform,
            Distribution::CubeVertices,
            Distribution::Sphere,
            Distribution::Shell { thickness: 1e-8 },
            Distribution::Clusters { count: 3, spread: 0.0 },
        ]
        .into_iter()
        .enumerate()
        {
            for (n, dim) in [(9, 1), (30, 2), (300, 7), (600, 70)] {
                let values: Vec<f64> = generate(distribution, n, dim, 8200 + k as u64).unwrap();
                let rows = rows_of(&values, dim);
                let point = end_of_path(&rows);
                let (upper, lower) = (point.radius2(), point.lower_bound(&rows));
                // Any multipliers prove a lower bound; the center is held to hold all rows.
                let mut x = point.center().to_vec();
                x.push(0.0);
                let far = rows.norms2.iter().zip(rows.times(&x)).map(|(b, product)| b - product);
                let reached = far.fold(f64::NEG_INFINITY, f64::max) + dot(&x, &x);
                assert!(reached <= upper * (1.0 + 1e-14), "{distribution}, {n} × {dim}");
                assert!(lower <= reached * (1.0 + 1e-14), "{distribution}, {n} × {dim}");
                let gap = upper / lower - 1.0;
                assert!(gap < 1e-11, "{distribution}, {n} × {dim}: {gap:e}");
                assert!(point.steps <= STEPS_MAX as u64);
            }
        }
    }

    #[test]
    fn the_ball_of_a_simplex_is_known() {
        for dim in [2, 10, 100] {
            let values: Vec<f64> = generate(Distribution::Simplex, dim + 1, dim, 1).unwrap();
            let point = end_of_path(&rows_of(&values, dim));
            let wanted = dim as f64 / (2.0 * (dim as f64 + 1.0));
            assert!((point.radius2() / wanted - 1.0).abs() < 1e-12, "{dim}");
            let even = 1.0 / (dim as f64 + 1.0);
            assert!(point.multipliers().iter().all(|l| (l - even).abs() < 1e-9), "{dim}");
        }
    }

    #[test]
    fn rows_that_come_later_are_inside_after_a_start() {
        let (n, dim) = (500, 20);
        let values: Vec<f64> = generate(Distribution::Normal, n, dim, 8300).unwrap();
        let all = rows_of(&values, dim);
        let mut rows = Rows::new(dim);
        (0..n / 2).for_each(|i| rows.push(all.row(i).iter().copied()));
        let mut point = end_of_path(&rows);
        let before = point.radius2();
        (n / 2..n).for_each(|i| rows.push(all.row(i).iter().copied()));
        point.start(&rows);
        assert!(point.excess() > 0.0 && point.slacks.iter().all(|s| *s > 0.0));
        point.follow(&rows, 1e-15, &Monitor::silent()).unwrap();
        let afresh = end_of_path(&rows).radius2();
        assert!(afresh > before && (point.radius2() / afresh - 1.0).abs() < 1e-12);
    }

    #[test]
    fn sums_do_not_depend_on_tiles() {
        let (n, dim) = (3 * TILE_ROWS + 5, TILE_COLUMNS + 3);
        let values: Vec<f64> = generate(Distribution::Normal, n, dim, 8400).unwrap();
        let rows = rows_of(&values, dim);
        let weights: Vec<f64> = (0..n).map(|i| 1.0 + (i % 7) as f64).collect();
        let p = dim + 1;
        let normal = rows.normal(&weights);
        let entry = |i: usize, a: usize| if a < dim { 2.0 * rows.row(i)[a] } else { 1.0 };
        for (a, b) in [(0, 0), (0, dim), (5, 66), (64, 65), (dim, dim)] {
            let own = if a == b && a < dim { 2.0 } else { 0.0 };
            let sum: f64 = (0..n).map(|i| weights[i] * entry(i, a) * entry(i, b)).sum();
            assert!((normal[a * p + b] - sum - own).abs() < 1e-9 * sum.abs().max(1.0), "{a}, {b}");
        }
        let combination = rows.combination(&weights);
        let sum: f64 = (0..n).map(|i| weights[i] * rows.row(i)[3]).sum();
        assert!((combination[3] - sum).abs() < 1e-9);
    }
}
