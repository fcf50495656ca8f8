//! The ellipsoid of a working set by an interior-point method: for working sets of which a model would need thousands of exchanges.
//!
//! *Problem.* Points wᵢ = (yᵢ, 1) that lie on an ellipsoid but for rounding: every set of p = m(m + 1)/2 of them is
//! nearly optimal, and an active set walks through a great many.
//! *Idea.* Symmetric M ≻ 0, slacks sᵢ = 1 − wᵢ′Mwᵢ and multipliers zᵢ follow the path M⁻¹ = Σ zᵢwᵢwᵢ′, zᵢsᵢ = μ → 0.
//! With F the rows svec(wᵢwᵢ′), beside the diagonal times √2, a Newton step is (K + F′ diag(z/s) F) ΔM = svec(M⁻¹) −
//! F′(g/s), K the symmetric Kronecker square of M⁻¹: p unknowns however many points. Predictor and corrector after
//! Mehrotra, g = 0 and then g = σμ − Δs·Δz, and up to two of Gondzio's centrality correctors. F is never held whole: its products are forms
//! and moments of the points ([`FourthMoments`]).
//! The start is the ellipsoid of the round before, a little larger: from there it takes five steps, from one at a gap of 1 it takes ten.
//! *Guarantee.* The best multipliers met after a step are handed back.
//! *Trap.* It puts multipliers on all points, and accuracy ends at a gap of 1e-11 to 1e-13: the active set finishes, from the p − 1
//! largest.
//! *Reference.* Mehrotra, SIAM J. Optim. 2(4), 1992; Gondzio, Computational Optimization and Applications 6, 1996; for this problem Sun and
//! Freund, Operations Research 52(5), 2004.

use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};

use taut_kernels::triangle::moments;
use taut_kernels::vector::dot;
use taut_points::parallel::ParallelSlice;
use taut_points::{Monitor, OrderBy, ReadError};

use super::counters::Counters;
use super::dense::{cholesky, divide_rows};
use super::fourth_moments::FourthMoments;
use super::newton::{REBASE_TOLERANCE, gap};
use super::whitener::{Rebased, Whitened, Whitener};
use super::working_set::WorkingSet;
use crate::Error;
use crate::cholesky::Cholesky;

/// The active set takes over at this gap at the latest: what points differ by may be far less than a gap of 1e-9.
const GAP_MIN: f64 = 1e-13;
/// At most this many steps are taken.
const STEPS_MAX: usize = 60;
/// At most this many steps in a row may leave the gap no better.
const STEPS_WITHOUT_PROGRESS_MAX: usize = 3;
/// A step goes this part of the way to the border of the cone.
const STEP_FRACTION: f64 = 0.98;
/// The least slack of a start, in parts of what the largest leverage exceeds that of an optimum by. A third of it leaves no room for
/// a whole step in one start of ten, three times as much takes a tenth more steps.
const START_SLACK: f64 = 3.0;
/// The least slack of a start where all points are inside: rounding of slacks is to be far below it.
const START_SLACK_MIN: f64 = 1e-11;
/// The largest slack of a start: where points are farther outside, the multipliers tell little of the optimum.
const START_SLACK_MAX: f64 = 0.1;
/// Until a whole step has been made, μ falls by no more than this: M would follow a path of multipliers that are none yet, and each
/// step becomes shorter. With 0.1 and with 0.5 the worst of a hundred starts took twice as many steps.
const SIGMA_MIN: f64 = 0.3;
/// Centrality correctors of a step, at most. On shells of 10⁴ points in thirty dimensions (example `ellipsoids`) one or two save a quarter to
/// a third of the steps for thickness 1e-8 and 10 to 14 % of them for 1e-4; three and four as many for 1e-8 and 16 to 20 % for 1e-4.
const CORRECTORS_MAX: usize = 2;
/// Gondzio's δ: a corrector is to make lengths longer by this much. On the same shells 0.15 and 0.5 take as many steps.
const LENGTH_HOPED: f64 = 0.3;
/// Gondzio's γδ: a corrector counts if the sum of both lengths gains this much. He asks it of each.
const LENGTH_GAIN_MIN: f64 = 0.03;
/// The part of a length that a corrector must leave, where it makes the other one longer.
const LENGTH_KEPT_MIN: f64 = 0.9;
/// Gondzio's β_min: products after a corrector should lie between this times their aim and their aim over this. On the same shells 0.03 and
/// 0.3 take as many steps.
const PRODUCT_RATIO_MIN: f64 = 0.1;
/// One task makes this many rows of the normal matrix.
const TILE_ROWS: usize = 16;

/// Replaces the multipliers of a working set by nearly optimal ones; a gap of `tolerance` is good enough. The whitener is that of
/// good multipliers, those of the set or of one that shares most of its points; it stays as it is.
pub(super) fn solve(
    set: &mut WorkingSet,
    whitener: &Whitener,
    tolerance: f64,
    counters: &mut Counters,
    monitor: &Monitor<'_>,
) -> Result<(), Error> {
    let mut state = State::new(set, whitener);
    let mut best = (f64::INFINITY, set.weights().to_vec());
    let mut patience = STEPS_WITHOUT_PROGRESS_MAX;
    for _ in 0..STEPS_MAX {
        monitor.check().map_err(ReadError::from)?;
        counters.interior += 1;
        if !state.step() {
            break;
        }
        let total: f64 = state.z.iter().sum();
        set.weights_mut().iter_mut().zip(&state.z).for_each(|(u, z)| *u = z / total);
        let mut trial = whitener.clone();
        if trial.rebase(set, REBASE_TOLERANCE) == Rebased::Never {
            break;
        }
        let reached = gap(set.dim(), trial.apply(set).largest());
        if reached < best.0 {
            best = (reached, set.weights().to_vec());
            patience = STEPS_WITHOUT_PROGRESS_MAX;
        } else {
            patience -= 1;
        }
        if reached <= tolerance.max(GAP_MIN) || patience == 0 {
            break;
        }
    }
    set.weights_mut().copy_from_slice(&best.1);
    set.normalize();
    Ok(())
}

/// Tests whether no more than p − 1 points have a multiplier.
pub(super) fn is_basis(set: &WorkingSet) -> bool {
    let p = (set.dim() + 1) * (set.dim() + 2) / 2;
    set.weights().iter().filter(|u| **u > 0.0).count() < p
}

/// Leaves the p − 1 largest multipliers: a basis, from which the active set needs no exchange and a step or two.
pub(super) fn keep_basis(set: &mut WorkingSet) {
    let p = (set.dim() + 1) * (set.dim() + 2) / 2;
    for &i in largest_first(set.weights()).iter().skip(p - 1) {
        set.weights_mut()[i] = 0.0;
    }
    set.normalize();
}

/// Positions by weight, the first of equals first.
pub(super) fn largest_first(weights: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..weights.len()).collect();
    order.order_by(&|&a, &b| weights[b].total_cmp(&weights[a]).then(a.cmp(&b)));
    order
}

/// The least slack of a start from an ellipsoid in which |y|² is at most `largest`, before it is bounded.
fn start_slack(m: usize, largest: f64) -> f64 {
    START_SLACK * ((1.0 + largest) / m as f64 - 1.0)
}

/// Tests whether a start would come nearer: where its slack would be less than [`START_SLACK_MIN`] it would be worse than the multipliers at hand.
pub(super) fn can_start(dim: usize, largest: f64) -> bool {
    start_slack(dim + 1, largest) > START_SLACK_MIN
}

struct State {
    m: usize,
    p: usize,
    /// The y of all points.
    whitened: Whitened,
    fourth: FourthMoments,
    /// svec of M.
    matrix: Vec<f64>,
    s: Vec<f64>,
    z: Vec<f64>,
    /// True once a whole step has been made: then M⁻¹ = Σ zᵢwᵢwᵢ′ up to the second order of a step.
    feasible: bool,
}

impl State {
    /// M a multiple of the identity inside the cone, in the coordinates of the whitener: that of multipliers for which few
    /// points are outside, and by little. Of points that joined since, or have left, M knows nothing, and multipliers follow in one step.
    fn new(set: &WorkingSet, whitener: &Whitener) -> Self {
        let m = set.dim() + 1;
        let p = m * (m + 1) / 2;
        let whitened = whitener.apply(set);
        let largest = whitened.largest();
        let slack = start_slack(m, largest).clamp(START_SLACK_MIN, START_SLACK_MAX);
        let start = 1.0 / ((1.0 + slack) * (1.0 + largest));
        let mut identity = vec![0.0; m * m];
        (0..m).for_each(|a| identity[a * m + a] = start);
        let matrix = svec(&identity, m);
        let s: Vec<f64> = whitened.leverages.iter().map(|l| 1.0 - start * (1.0 + l)).collect();
        let mu = m as f64 / s.iter().map(|s| 1.0 / s).sum::<f64>();
        let of_weight = |(u, s): (&f64, &f64)| 0.5 * (u * m as f64 + mu / s);
        let z = set.weights().iter().zip(&s).map(of_weight).collect();
        State { m, p, whitened, fourth: FourthMoments::new(m), matrix, s, z, feasible: false }
    }

    /// One for each place of a block: those that fill the last one are 0.
    fn padded(&self, mut weights: Vec<f64>) -> Vec<f64> {
        weights.resize(self.whitened.blocks.len() / (self.m - 1), 0.0);
        weights
    }

    /// One predictor and its correctors; false when rounding has taken the last digit.
    fn step(&mut self) -> bool {
        let k = self.s.len();
        let Some(inverse) = inverse(&self.matrix, self.m) else { return false };
        let ratio: Vec<f64> = self.z.iter().zip(&self.s).map(|(z, s)| z / s).collect();
        let normal = self.normal(&inverse, &ratio);
        let mu = dot(&self.z, &self.s) / k as f64;
        let Some(solver) = Cholesky::of(normal, [&svec(&inverse, self.m)], 0.0) else {
            return false;
        };
        let predictor = self.direction(&solver.solution(), vec![0.0; k], &ratio);
        let (primal, dual) =
            (self.primal_length(&predictor, 1.0), self.dual_length(&predictor, 1.0));
        let ahead = (0..k)
            .map(|i| (self.z[i] + dual * predictor.z[i]) * (self.s[i] + primal * predictor.s[i]));
        let sigma = (ahead.sum::<f64>() / (k as f64 * mu)).max(0.0).powi(3);
        let sigma = if self.feasible { sigma } else { sigma.max(SIGMA_MIN) };
        let aim = sigma * mu;
        let g: Vec<f64> = (0..k).map(|i| aim - predictor.s[i] * predictor.z[i]).collect();
        let corrected = |g| self.corrected(&solver, &inverse, g, &ratio);
        let Step { direction, primal, dual } = self.centered(corrected(g), aim, corrected);
        if !(primal > 1e-10 && dual > 1e-10) {
            return false;
        }
        self.matrix.iter_mut().zip(&direction.matrix).for_each(|(m, d)| *m += primal * d);
        self.s.iter_mut().zip(&direction.s).for_each(|(s, d)| *s += primal * d);
        self.z.iter_mut().zip(&direction.z).for_each(|(z, d)| *z += dual * d);
        self.feasible |= dual == 1.0;
        self.s.iter().chain(&self.z).all(|v| v.is_finite() && *v > 0.0)
    }

    /// K + F′ diag(ratio) F, p × p; the upper triangle by rows is what is read of it.
    fn normal(&mut self, inverse: &[f64], ratio: &[f64]) -> Vec<f64> {
        let (m, p) = (self.m, self.p);
        let weights = self.padded(ratio.to_vec());
        self.fourth.fill(&self.whitened.blocks, &weights);
        let fourth = &self.fourth;
        let pairs: Vec<[usize; 2]> = (0..m).flat_map(|a| (a..m).map(move |b| [a, b])).collect();
        let mut normal = vec![0.0; p * p];
        normal.par_chunks_mut(TILE_ROWS * p).enumerate().for_each(|(tile, rows)| {
            for (i, row) in (tile * TILE_ROWS..).zip(rows.chunks_exact_mut(p)) {
                fill_row(&mut row[i..], m, pairs[i], inverse, fourth);
            }
        });
        normal
    }

    /// The step of one right-hand side.
    fn corrected(&self, solver: &Cholesky<1>, inverse: &[f64], g: Vec<f64>, ratio: &[f64]) -> Step {
        let factors = g.iter().zip(&self.s).map(|(g, s)| g / s).collect();
        let pull = moments(self.m - 1, &self.whitened.blocks, &self.padded(factors));
        let mut right = svec(inverse, self.m);
        right.iter_mut().zip(svec(&pull, self.m)).for_each(|(r, f)| *r -= f);
        let solution = solver.back(solver.forward(&right));
        let direction = self.direction(&solution, g, ratio);
        let primal = self.primal_length(&direction, STEP_FRACTION);
        let dual = self.dual_length(&direction, STEP_FRACTION);
        Step { direction, primal, dual }
    }

    /// A step after a few centrality correctors: where a step as long as is hoped for would leave a product zs far from `aim`, its g asks
    /// for more or for less.
    fn centered(&self, mut step: Step, aim: f64, corrected: impl Fn(Vec<f64>) -> Step) -> Step {
        for _ in 0..CORRECTORS_MAX {
            let Step { direction, primal, dual } = &step;
            // Both are 1 at most.
            if primal + dual + LENGTH_GAIN_MIN > 2.0 {
                break;
            }
            let hope = |length: f64| (length + LENGTH_HOPED).min(1.0);
            let (primal_hoped, dual_hoped) = (hope(*primal), hope(*dual));
            let centered_g = |(i, g): (usize, &f64)| {
                let s = self.s[i] + primal_hoped * direction.s[i];
                let z = self.z[i] + dual_hoped * direction.z[i];
                // Not `clamp`, which panics where the aim has become no number.
                let wanted = (s * z).max(PRODUCT_RATIO_MIN * aim).min(aim / PRODUCT_RATIO_MIN);
                g + (wanted - s * z).max(-aim / PRODUCT_RATIO_MIN)
            };
            let next = corrected(direction.g.iter().enumerate().map(centered_g).collect());
            let is_longer = next.primal + next.dual >= primal + dual + LENGTH_GAIN_MIN;
            let is_kept =
                next.primal >= LENGTH_KEPT_MIN * primal && next.dual >= LENGTH_KEPT_MIN * dual;
            // A first whole step of the multipliers makes them feasible.
            let is_first_whole = !self.feasible && *dual == 1.0;
            if !is_longer || !is_kept || is_first_whole && next.dual < 1.0 {
                break;
            }
            step = next;
        }
        step
    }

    /// Δs and Δz that belong to ΔM and g.
    fn direction(&self, matrix: &[f64], g: Vec<f64>, ratio: &[f64]) -> Direction {
        let forms = self.whitened.forms(&smat(matrix, self.m));
        let s: Vec<f64> = forms.into_iter().map(|form| -form).collect();
        let z = (0..s.len()).map(|i| g[i] / self.s[i] - self.z[i] - ratio[i] * s[i]).collect();
        Direction { matrix: matrix.to_vec(), s, z, g }
    }

    /// Returns how far M and s can go, at most 1, and `fraction` of the way to their border.
    fn primal_length(&self, direction: &Direction, fraction: f64) -> f64 {
        let mut length = longest(&self.s, &direction.s, fraction);
        for _ in 0..60 {
            let moved: Vec<f64> =
                self.matrix.iter().zip(&direction.matrix).map(|(m, d)| m + length * d).collect();
            if cholesky(&mut smat(&moved, self.m), self.m) {
                return length;
            }
            length *= 0.7;
        }
        0.0
    }

    fn dual_length(&self, direction: &Direction, fraction: f64) -> f64 {
        longest(&self.z, &direction.z, fraction)
    }
}

struct Direction {
    matrix: Vec<f64>,
    s: Vec<f64>,
    z: Vec<f64>,
    /// The right-hand side: sᵢΔzᵢ + zᵢΔsᵢ = gᵢ − sᵢzᵢ.
    g: Vec<f64>,
}

/// A direction, how far M and s go along it (`primal`), and how far z does (`dual`).
struct Step {
    direction: Direction,
    primal: f64,
    dual: f64,
}

/// The largest step ≤ 1 that goes at most `fraction` of the way to where a value becomes 0.
fn longest(values: &[f64], direction: &[f64], fraction: f64) -> f64 {
    let bound = |(v, d): (&f64, &f64)| if *d < 0.0 { -fraction * v / d } else { 1.0 };
    values.iter().zip(direction).map(bound).fold(1.0, f64::min)
}

/// Row (a, b) of the normal matrix from its diagonal entry on.
fn fill_row(
    row: &mut [f64],
    m: usize,
    [a, b]: [usize; 2],
    inverse: &[f64],
    fourth: &FourthMoments,
) {
    let root = if a == b { 1.0 } else { SQRT_2 };
    let of_a = &inverse[a * m..(a + 1) * m];
    let of_b = &inverse[b * m..(b + 1) * m];
    let mut rest = row;
    for c in a..m {
        let first = if c == a { b } else { c };
        let (entries, later) = std::mem::take(&mut rest).split_at_mut(m - first);
        rest = later;
        // In order a, b, c, d are a, c, d, b for d < b, one by one, and from d = b on side by side.
        let between = b.saturating_sub(first);
        for (entry, d) in entries[..between].iter_mut().zip(first..) {
            *entry = fourth.of([a, c, d])[b - d];
        }
        let others = if c <= b { [a, c, b] } else { [a, b, c] };
        entries[between..].copy_from_slice(fourth.of(others));
        let (ac, bc) = (0.5 * of_a[c], 0.5 * of_b[c]);
        for ((entry, ad), bd) in entries.iter_mut().zip(&of_a[first..]).zip(&of_b[first..]) {
            *entry = SQRT_2 * root * (*entry + (ac * bd + ad * bc));
        }
        // The entry of c = d has no √2.
        if first == c {
            entries[0] *= FRAC_1_SQRT_2;
        }
    }
}

/// The upper triangle by rows, beside the diagonal times √2, of a symmetric matrix whose lower triangle is read.
fn svec(matrix: &[f64], m: usize) -> Vec<f64> {
    let mut vector = Vec::with_capacity(m * (m + 1) / 2);
    for a in 0..m {
        vector.push(matrix[a * m + a]);
        vector.extend((a + 1..m).map(|b| matrix[b * m + a] * SQRT_2));
    }
    vector
}

/// The matrix of a vector, symmetric.
fn smat(vector: &[f64], m: usize) -> Vec<f64> {
    let mut matrix = vec![0.0; m * m];
    let mut entries = vector.iter();
    for a in 0..m {
        for (b, &entry) in (a..m).zip(entries.by_ref()) {
            let value = if a == b { entry } else { entry / SQRT_2 };
            (matrix[a * m + b], matrix[b * m + a]) = (value, value);
        }
    }
    matrix
}

/// The inverse of a positive definite matrix, given as a vector; symmetric.
fn inverse(vector: &[f64], m: usize) -> Option<Vec<f64>> {
    let mut lower = smat(vector, m);
    if !cholesky(&mut lower, m) {
        return None;
    }
    // L⁻¹, then L⁻ᵀL⁻¹.
    let mut root = vec![0.0; m * m];
    (0..m).for_each(|a| root[a * m + a] = 1.0);
    divide_rows(&lower, m, &mut root);
    let mut inverse = vec![0.0; m * m];
    for a in 0..m {
        for b in 0..=a {
            let entry = (a..m).map(|c| root[c * m + a] * root[c * m + b]).sum();
            (inverse[a * m + b], inverse[b * m + a]) = (entry, entry);
        }
    }
    Some(inverse)
}

#[cfg(test)]
mod tests {
    use super::super::working_set::copy_row;
    use super::*;
    use taut_points::{Distribution, generate};

    #[test]
    fn the_path_ends_near_the_optimum_of_normal_points() {
        let (n, dim) = (300, 4);
        let rows: Vec<f64> = generate(Distribution::Normal, n, dim, 5).unwrap();
        let mut set = WorkingSet::new(dim);
        for (i, row) in rows.chunks_exact(dim).enumerate() {
            set.push(i as u64, row, 1.0 / n as f64);
        }
        let mut whitener = Whitener::of_scales(&[1.0; 4]);
        let mut counters = Counters::default();
        assert_eq!(whitener.rebase(&set, REBASE_TOLERANCE), Rebased::Plainly);
        solve(&mut set, &whitener, 0.0, &mut counters, &Monitor::silent()).unwrap();
        assert_eq!(whitener.rebase(&set, REBASE_TOLERANCE), Rebased::Plainly);
        assert!(gap(dim, whitener.apply(&set).largest()) < 1e-10);
        keep_basis(&mut set);
        assert!(is_basis(&set));
        assert_eq!(whitener.rebase(&set, REBASE_TOLERANCE), Rebased::Plainly);
        assert!(gap(dim, whitener.apply(&set).largest()) < 1e-6);
        assert!((5..40).contains(&counters.interior));
    }

    /// A few points joined after the ellipsoid was found: the next one takes few steps from there.
    #[test]
    fn a_start_from_the_ellipsoid_before_takes_few_steps() {
        let (n, joined, dim) = (500, 40, 6);
        let shell = Distribution::Shell { thickness: 1e-6 };
        let rows: Vec<f64> = generate(shell, n + joined, dim, 9).unwrap();
        let mut set = WorkingSet::new(dim);
        let mut whitener = Whitener::of_scales(&[1.0; 6]);
        let mut counters = Counters::default();
        let rows: Vec<&[f64]> = rows.chunks_exact(dim).collect();
        let mut steps = vec![];
        for (first, part, weight) in [(0, &rows[..n], 1.0 / n as f64), (n, &rows[n..], 0.0)] {
            (first as u64..).zip(part).for_each(|(id, row)| set.push(id, row, weight));
            if first == 0 {
                assert_eq!(whitener.rebase(&set, REBASE_TOLERANCE), Rebased::Plainly);
            }
            solve(&mut set, &whitener, 1e-8, &mut counters, &Monitor::silent()).unwrap();
            whitener.rebase(&set, REBASE_TOLERANCE);
            assert!(gap(dim, whitener.apply(&set).largest()) <= 1.1e-8);
            steps.push(counters.interior - steps.iter().sum::<u64>());
        }
        assert!(steps[1] + 2 <= steps[0] && steps[1] <= 7, "{steps:?}");
    }

    /// From the rows svec(ww′) of F and K svec(X) = svec(M⁻¹XM⁻¹).
    #[test]
    fn the_normal_matrix_is_that_of_the_definition() {
        for (n, dim) in [(40, 1), (90, 4), (200, 9)] {
            let rows: Vec<f64> = generate(Distribution::Normal, n, dim, 3).unwrap();
            let set = WorkingSet::of_rows(dim, (0..n as u64).collect(), &rows);
            let mut whitener = Whitener::of_scales(&vec![1.0; dim]);
            assert_eq!(whitener.rebase(&set, REBASE_TOLERANCE), Rebased::Plainly);
            let mut state = State::new(&set, &whitener);
            let (m, p) = (state.m, state.p);
            let ratio: Vec<f64> = (0..n).map(|i| 0.5 + (i % 7) as f64).collect();
            let entry = |i: usize, j: usize| {
                if i == j { 2.0 + i as f64 } else { 0.1 / (1.0 + (i * j) as f64) }
            };
            let inverse: Vec<f64> = (0..m * m).map(|at| entry(at / m, at % m)).collect();
            let normal = state.normal(&inverse, &ratio);
            let product = |x: &[f64], y: &[f64]| -> Vec<f64> {
                let entry = |at: usize| (0..m).map(|k| x[at / m * m + k] * y[k * m + at % m]).sum();
                (0..m * m).map(entry).collect()
            };
            let mut expected = vec![0.0; p * p];
            for column in 0..p {
                let mut unit = vec![0.0; p];
                unit[column] = 1.0;
                let image = product(&product(&inverse, &smat(&unit, m)), &inverse);
                for (row, value) in svec(&image, m).into_iter().enumerate() {
                    expected[row * p + column] = value;
                }
            }
            let mut w = vec![1.0; m];
            for (i, r) in ratio.iter().enumerate() {
                copy_row(&state.whitened.blocks, dim, i, &mut w[..dim]);
                let square: Vec<f64> = (0..m * m).map(|at| w[at / m] * w[at % m]).collect();
                let f = svec(&square, m);
                for row in 0..p {
                    (0..p).for_each(|column| expected[row * p + column] += r * f[row] * f[column]);
                }
            }
            for row in 0..p {
                for column in row..p {
                    let (found, wanted) = (normal[row * p + column], expected[row * p + column]);
                    let size = (expected[row * p + row] * expected[column * p + column]).sqrt();
                    assert!((found - wanted).abs() < 1e-12 * size, "{dim}: {row} {column}");
                }
            }
        }
    }

    /// So many points of a thin shell with equal multipliers, and their whitener.
    fn shell(thickness: f64, n: usize, dim: usize) -> (WorkingSet, Whitener) {
        let rows: Vec<f64> = generate(Distribution::Shell { thickness }, n, dim, 4).unwrap();
        let set = WorkingSet::of_rows(dim, (0..n as u64).collect(), &rows);
        let mut whitener = Whitener::of_scales(&vec![1.0; dim]);
        assert_eq!(whitener.rebase(&set, REBASE_TOLERANCE), Rebased::Plainly);
        (set, whitener)
    }

    /// Without centrality correctors this takes 15 steps, with them 12.
    #[test]
    fn centered_steps_are_few() {
        let (mut set, mut whitener) = shell(1e-5, 600, 8);
        let mut counters = Counters::default();
        solve(&mut set, &whitener, 1e-10, &mut counters, &Monitor::silent()).unwrap();
        whitener.rebase(&set, REBASE_TOLERANCE);
        assert!(gap(8, whitener.apply(&set).largest()) <= 1.1e-10);
        assert!(counters.interior <= 13, "{}", counters.interior);
    }

    /// Correctors that gain are taken, others are not, and neither is one that asks for no number.
    #[test]
    fn a_centered_step_is_no_shorter() {
        let (set, whitener) = shell(1e-5, 60, 3);
        let mut state = State::new(&set, &whitener);
        let step = |primal: f64, dual: f64| {
            let zeros = vec![0.0; set.len()];
            let direction =
                Direction { matrix: vec![], s: zeros.clone(), z: zeros.clone(), g: zeros };
            Step { direction, primal, dual }
        };
        for is_feasible in [false, true] {
            state.feasible = is_feasible;
            let lengths = |first: (f64, f64), next: (f64, f64)| {
                let found = state.centered(step(first.0, first.1), 1e-9, |_| step(next.0, next.1));
                (found.primal, found.dual)
            };
            assert_eq!(lengths((0.5, 0.5), (0.7, 0.6)), (0.7, 0.6));
            assert_eq!(lengths((0.5, 0.5), (0.5, 0.51)), (0.5, 0.5));
            assert_eq!(lengths((0.5, 0.5), (0.1, 1.0)), (0.5, 0.5));
            assert_eq!(lengths((0.5, 0.5), (f64::NAN, 1.0)), (0.5, 0.5));
            let whole = if is_feasible { (0.9, 0.95) } else { (0.5, 1.0) };
            assert_eq!(lengths((0.5, 1.0), (0.9, 0.95)), whole);
        }
        let unchanged = state.centered(step(0.1, 0.2), f64::NAN, |_| step(0.0, 0.0));
        assert_eq!((unchanged.primal, unchanged.dual), (0.1, 0.2));
    }

    #[test]
    fn vectors_and_matrices_keep_scalar_products() {
        let a = [2.0, 1.0, 0.5, 1.0, 3.0, -1.0, 0.5, -1.0, 4.0];
        let vector = svec(&a, 3);
        assert!(smat(&vector, 3).iter().zip(&a).all(|(x, y)| (x - y).abs() < 1e-15));
        assert!((dot(&vector, &vector) - dot(&a, &a)).abs() < 1e-13);
        let inverse = inverse(&vector, 3).unwrap();
        for i in 0..3 {
            for j in 0..3 {
                let entry: f64 = (0..3).map(|k| a[i * 3 + k] * inverse[k * 3 + j]).sum();
                assert!((entry - f64::from(u8::from(i == j))).abs() < 1e-14);
            }
        }
    }
}
