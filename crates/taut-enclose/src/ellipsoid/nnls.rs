//! The quadratic model of a Newton step, solved exactly: non-negative least squares on Gram data.
//!
//! *Problem.* At multipliers u, in coordinates in which Σ uᵢwᵢwᵢ′ = 1 for wᵢ = (yᵢ, 1), the second-order model of
//! ln det Σ vᵢwᵢwᵢ′ − m·Σvᵢ, m = d + 1, is (up to a constant) (2κ − m1)′v − v′Hv/2, κᵢ = |wᵢ|², Hᵢⱼ = (wᵢ·wⱼ)². Find
//! its maximizer over v ≥ 0.
//! *Idea.* Lawson and Hanson's active set with a triangular factor of H over the points in use. The gradient is
//! gᵢ = bᵢ − wᵢ′Nwᵢ with the m × m matrix N = Σ vⱼwⱼwⱼ′: one sweep prices thousands of points without a row of H. Each
//! sweep gives a batch, whose members are priced again, exactly, when their turn comes.
//! *Guarantee.* The model rises with every step but that which leaves a bad start. At the end no point of the working set has a gradient above the tolerance.
//! *Trap.* A point whose column depends on those in use (a copy, or one of more than m(m + 1)/2) has no pivot. It enters
//! by an exact exchange: weight moves to it along the dependence, on which the model is linear, until another leaves.
//! Where few points are in use of the p = m(m + 1)/2 that may be, a batch enters at once, and points leave many at a time: then a
//! factor is extended or made again by products of matrices.
//! *Trap.* The answer of a model may need thousands of exchanges where points lie on an ellipsoid up to rounding:
//! [`Outcome::Stuck`] says so early.
//! *Reference.* Lawson and Hanson, Solving Least Squares Problems, 1974, chapter 23.

use std::collections::HashSet;

use taut_kernels::matrix::{Matrix, MatrixMut, set_product};
use taut_kernels::substitution::products;
use taut_kernels::triangle::{POINTS, moments};
use taut_kernels::vector::dot;
use taut_points::OrderBy;
use taut_points::parallel::ParallelSlice;

use super::counters::Counters;
use super::whitener::Whitened;
use super::working_set::{basis_max, copy_row};
use crate::cholesky::Cholesky;

/// A column whose squared distance from the span of the others is below this part of its square depends on them.
const DEPENDENT_RATIO: f64 = 1e-11;
/// A y of the exchange direction must exceed this to bound its length: it is rounding of the substitution otherwise.
const DIRECTION_MIN: f64 = 1e-12;
/// A candidate whose gradient has fallen below this part of the best of its batch can wait for the next.
const CANDIDATE_RATIO_MIN: f64 = 0.3;
/// From this many points on, a factor is made in blocks rather than point by point.
const BLOCKED_FACTOR_MIN: usize = 96;
/// From this size p = m(m + 1)/2 of a model on, a cold start guesses the points in use. Below, guessing gains nothing.
const GUESSED_START_MIN: usize = 300;
/// A cold start that guesses nothing reserves memory for at most this many members.
const COLD_ROOM_MAX: usize = 64;

/// Fewer points than this enter one by one.
const TOGETHER_MIN: usize = 8;
/// A start is bad if more than this part, as a divisor, of its points have a negative v.
const BAD_START_RATIO: usize = 8;
/// Points leave by a new factor, not one by one, if they are more than this part, as a divisor, of those that stay.
const NEW_FACTOR_RATIO: usize = 6;
/// One task multiplies this many rows of H: fixed, so that the result does not depend on threads.
const TILE_ROWS: usize = 64;
/// So many points with a negative multiplier leave at once, if the model rises: to know that costs as much as two solutions.
const LEAVING_MIN: usize = 4;

/// The way in which a model ended.
pub(super) enum Outcome {
    /// Solved: the step to take.
    Solved(Step),
    /// More steps than a model of this size should need: the caller has another solver for such working sets.
    Stuck,
}

/// A maximizer of the model.
pub(super) struct Step {
    /// The points in use and their v.
    pub(super) weights: Vec<(usize, f64)>,
    /// N = Σ vⱼwⱼwⱼ′, lower triangle, m × m by rows.
    pub(super) matrix: Vec<f64>,
}

/// Solves the model over the working set `whitened`, from the multipliers `u`, until no gradient exceeds `tolerance`; gives up
/// after as many exchanges and pivots as `patience` says.
pub(super) fn solve(
    dim: usize,
    whitened: &Whitened,
    u: &[f64],
    tolerance: f64,
    patience: (u64, u64),
    counters: &mut Counters,
) -> Outcome {
    let p = basis_max(dim);
    let mut set = ActiveSet::new(dim, whitened);
    let used: Vec<usize> = (0..u.len()).filter(|&i| u[i] > 0.0).collect();
    if used.len() <= p {
        set.start(&used, &used.iter().map(|&i| u[i]).collect::<Vec<_>>(), counters);
    } else if p >= GUESSED_START_MIN {
        set.crash(3 * p / 5, counters);
    } else {
        set.reserve(p.min(COLD_ROOM_MAX));
    }
    let (pivots, exchanges) = (counters.pivots, counters.exchanges);
    let mut tabu = HashSet::new();
    loop {
        let matrix = set.matrix();
        let gradient = set.price(&matrix);
        let batch = set.batch(&gradient, tolerance, &tabu);
        let Some(&best) = batch.first() else {
            let weights = set.members.iter().copied().zip(set.v.iter().copied()).collect();
            return Outcome::Solved(Step { weights, matrix });
        };
        if set.takes_all(&batch) && set.enter_all(&batch, counters) {
            set.settle(counters);
            // Of a batch that leaves as it came, nothing but rounding is to be had.
            if batch.iter().all(|j| !set.members.contains(j)) {
                tabu.extend(batch);
            }
        } else {
            set.enter_in_turn(batch, gradient[best], &mut tabu, counters);
        }
        if counters.exchanges - exchanges > patience.0 || counters.pivots - pivots > patience.1 {
            return Outcome::Stuck;
        }
    }
}

/// Exchanges and pivots after which an interior-point method would have been faster on k points; many where it has just
/// been tried without success.
///
/// A step of that is O((k + 2p)p²) and a pivot O(p²), an exchange a few sweeps of a p × p factor. For p = 496, three eighths of k + 2p
/// in place of half made no difference on shells of thickness 1e-2, 1e-4 and 1e-8; for p = 1326 it made vertices of a cube take twice as long.
pub(super) fn patience(k: usize, dim: usize, tried: bool) -> (u64, u64) {
    let p = basis_max(dim);
    let (exchanges, pivots) = match tried {
        true => (4 * k, 640 + 10 * k),
        false if p > 150 => (k / 40, (k + 2 * p) / 2),
        false => (k / 3, 640 + k),
    };
    (64 + exchanges as u64, pivots as u64)
}

/// A point that may become a member. One point after the other uses the same memory.
#[derive(Default)]
struct EnteringPoint {
    point: usize,
    /// Its w, as in the rows of the members.
    row: Vec<f64>,
    /// Its column of H over the members.
    column: Vec<f64>,
    /// R⁻ᵀ times that.
    reduced: Vec<f64>,
}

struct ActiveSet<'a> {
    dim: usize,
    whitened: &'a Whitened,
    /// The points in use.
    members: Vec<usize>,
    /// Their v.
    v: Vec<f64>,
    /// Their w, `stride` apart: y, 1, and zeros.
    rows: Vec<f64>,
    stride: usize,
    factor: Cholesky<1>,
}

impl<'a> ActiveSet<'a> {
    fn new(dim: usize, whitened: &'a Whitened) -> Self {
        ActiveSet {
            dim,
            whitened,
            members: vec![],
            v: vec![],
            rows: vec![],
            stride: (dim + 1).next_multiple_of(8),
            factor: Cholesky::default(),
        }
    }

    /// bᵢ = 2κᵢ − m.
    fn b(&self, i: usize) -> f64 {
        2.0 * self.whitened.leverages[i] + 1.0 - self.dim as f64
    }

    /// Writes the w of a point, `stride` numbers.
    fn copy_row(&self, i: usize, row: &mut [f64]) {
        let (y, rest) = row.split_at_mut(self.dim);
        copy_row(&self.whitened.blocks, self.dim, i, y);
        rest.fill(0.0);
        rest[0] = 1.0;
    }

    /// The w of several points.
    fn rows_of(&self, points: &[usize]) -> Vec<f64> {
        let mut rows = vec![0.0; points.len() * self.stride];
        for (&i, row) in points.iter().zip(rows.chunks_exact_mut(self.stride)) {
            self.copy_row(i, row);
        }
        rows
    }

    /// Writes the w of point j and its column of H.
    fn prepare(&self, j: usize, entering: &mut EnteringPoint) {
        entering.point = j;
        entering.row.resize(self.stride, 0.0);
        self.copy_row(j, &mut entering.row);
        entering.column.resize(self.members.len(), 0.0);
        products(&self.rows, self.stride, &entering.row, &mut entering.column);
        entering.column.iter_mut().for_each(|h| *h *= *h);
    }

    /// H over the given points, whose rows these are: the upper triangle, which is what a factor reads.
    fn gram(&self, rows: &[f64]) -> Vec<f64> {
        let s = rows.len() / self.stride;
        let mut gram = vec![0.0; s * s];
        let matrix = Matrix::from_rows(rows, s, self.stride);
        gram.par_chunks_mut(TILE_ROWS * s).enumerate().for_each(|(tile, rows)| {
            let (first, count) = (tile * TILE_ROWS, rows.len() / s);
            let (left, right) =
                (matrix.row_range(first..first + count), matrix.row_range(first..s));
            let target = MatrixMut::from_rows(rows, count, s).columns_from(first);
            set_product(target, left, right.transpose());
            for row in rows.chunks_exact_mut(s) {
                row[first..].iter_mut().for_each(|h| *h *= *h);
            }
        });
        gram
    }

    /// Takes up points with given v; those that depend on others are left out. Then the model is maximized over them.
    fn start(&mut self, points: &[usize], v: &[f64], counters: &mut Counters) {
        if points.len() >= BLOCKED_FACTOR_MIN && self.take_up(points, v) {
            self.drop_from_start(counters);
            self.settle(counters);
            return;
        }
        self.reserve(points.len());
        let mut entering = EnteringPoint::default();
        for (&j, &v) in points.iter().zip(v) {
            self.prepare(j, &mut entering);
            if let Some(pivot) = self.pivot(&mut entering) {
                self.append(&entering, v, pivot);
            }
        }
        self.settle(counters);
    }

    /// Replaces the members; returns false, with all as it was, if one of them depends on the others.
    fn take_up(&mut self, points: &[usize], v: &[f64]) -> bool {
        let rows = self.rows_of(points);
        let b: Vec<f64> = points.iter().map(|&i| self.b(i)).collect();
        let Some(factor) = Cholesky::of(self.gram(&rows), [&b], DEPENDENT_RATIO) else {
            return false;
        };
        (self.members, self.v, self.rows) = (points.to_vec(), v.to_vec(), rows);
        self.factor = factor;
        true
    }

    /// A cold start: the points of largest leverage, less those whose v is negative, until there are none.
    fn crash(&mut self, count: usize, counters: &mut Counters) {
        const GUESS_ROUNDS_MAX: usize = 6;
        const RIDGE: f64 = 1e-12;
        let mut points: Vec<usize> = (0..self.whitened.leverages.len()).collect();
        let leverage = |i: &usize| self.whitened.leverages[*i];
        points.order_by(&|a, b| leverage(b).total_cmp(&leverage(a)).then(a.cmp(b)));
        points.truncate(count);
        for _ in 0..GUESS_ROUNDS_MAX {
            let rows = self.rows_of(&points);
            let b: Vec<f64> = points.iter().map(|&i| self.b(i)).collect();
            let mut gram = self.gram(&rows);
            // Copies of a point would leave no factor: the ridge shares the weight among them.
            (0..points.len()).for_each(|i| gram[i * points.len() + i] *= 1.0 + RIDGE);
            let Some(factor) = Cholesky::of(gram, [&b], 0.0) else { return };
            let v = factor.solution();
            counters.crashes += 1;
            if v.iter().all(|&v| v > 0.0) {
                self.start(&points, &v, counters);
                return;
            }
            points = points.into_iter().zip(v).filter(|(_, v)| *v > 0.0).map(|(i, _)| i).collect();
        }
        let guess = vec![1.0 / points.len() as f64; points.len()];
        self.start(&points, &guess, counters);
    }

    /// Reduces the column of the point. Returns its pivot, or `None` if the column depends on those of the members.
    fn pivot(&self, entering: &mut EnteringPoint) -> Option<f64> {
        entering.reduced.clone_from(&entering.column);
        self.factor.forward_in_place(&mut entering.reduced);
        let kappa = 1.0 + self.whitened.leverages[entering.point];
        let rho2 = kappa * kappa - dot(&entering.reduced, &entering.reduced);
        (rho2 > DEPENDENT_RATIO * kappa * kappa).then(|| rho2.sqrt())
    }

    /// Makes room for so many members, of which there are none yet, and for some more.
    fn reserve(&mut self, count: usize) {
        let room = count + count / 8 + 8;
        self.factor.reserve(room);
        self.members.reserve(room);
        self.v.reserve(room);
        self.rows.reserve(room * self.stride);
    }

    /// Makes the point a member.
    fn append(&mut self, entering: &EnteringPoint, v: f64, pivot: f64) {
        self.factor.append(&entering.reduced, pivot, [self.b(entering.point)]);
        self.members.push(entering.point);
        self.v.push(v);
        self.rows.extend_from_slice(&entering.row);
    }

    fn delete(&mut self, position: usize) {
        self.factor.delete(position);
        self.members.remove(position);
        self.v.remove(position);
        self.rows.drain(position * self.stride..(position + 1) * self.stride);
    }

    /// Tests whether a batch may enter at once: near p points most of it would leave again.
    fn takes_all(&self, batch: &[usize]) -> bool {
        let p = basis_max(self.dim);
        p >= GUESSED_START_MIN
            && self.members.len() >= BLOCKED_FACTOR_MIN
            && batch.len() >= TOGETHER_MIN
            && self.members.len() + batch.len() < 3 * p / 5
    }

    /// Makes several points members at once; returns false, with all as it was, if one of them depends on the others.
    fn enter_all(&mut self, points: &[usize], counters: &mut Counters) -> bool {
        let (s, count) = (self.members.len(), points.len());
        let rows = self.rows_of(points);
        let b: Vec<f64> = points.iter().map(|&j| self.b(j)).collect();
        let members = Matrix::from_rows(&self.rows, s, self.stride).transpose();
        let mut columns = vec![0.0; count * s];
        columns
            .par_chunks_mut(TILE_ROWS * s)
            .zip(rows.par_chunks(TILE_ROWS * self.stride))
            .for_each(|(columns, rows)| {
                let count = columns.len() / s;
                let left = Matrix::from_rows(rows, count, self.stride);
                set_product(MatrixMut::from_rows(columns, count, s), left, members);
                columns.iter_mut().for_each(|h| *h *= *h);
            });
        if !self.factor.append_all(columns, self.gram(&rows), &b, DEPENDENT_RATIO) {
            return false;
        }
        self.members.extend(points);
        self.v.resize(s + count, 0.0);
        self.rows.extend(rows);
        counters.pivots += count as u64;
        true
    }

    /// Makes the points of a batch members, the best first, as long as their gradients are not far below that of the best.
    fn enter_in_turn(
        &mut self,
        batch: Vec<usize>,
        largest: f64,
        tabu: &mut HashSet<usize>,
        counters: &mut Counters,
    ) {
        let best = batch[0];
        let mut entering = EnteringPoint::default();
        for j in batch {
            self.prepare(j, &mut entering);
            if self.b(j) - dot(&entering.column, &self.v) < CANDIDATE_RATIO_MIN * largest {
                // The best can only have lost its gradient to rounding.
                if j == best {
                    tabu.insert(j);
                }
                continue;
            }
            self.enter(&mut entering, counters);
            self.settle(counters);
            if !self.members.contains(&j) {
                tabu.insert(j);
            }
        }
    }

    /// Makes the point a member, by exchanges as long as it depends on the members.
    fn enter(&mut self, entering: &mut EnteringPoint, counters: &mut Counters) {
        let mut weight = 0.0;
        loop {
            if let Some(pivot) = self.pivot(entering) {
                self.append(entering, weight, pivot);
                counters.pivots += 1;
                return;
            }
            let y = self.factor.back(entering.reduced.clone());
            let bound = (0..y.len())
                .filter(|&i| y[i] > DIRECTION_MIN)
                .map(|i| (self.v[i] / y[i], i))
                .min_by(|a, b| a.0.total_cmp(&b.0));
            // The last coordinates of the w say that some y is positive; rounding may say otherwise.
            let Some((t, blocker)) = bound else { return };
            self.v.iter_mut().zip(&y).for_each(|(v, y)| *v = (*v - t * y).max(0.0));
            weight += t;
            self.delete(blocker);
            entering.column.remove(blocker);
            counters.exchanges += 1;
        }
    }

    /// Goes to the maximizer of the model over the members, or as far as v ≥ 0 lets it, dropping who is in the way.
    fn settle(&mut self, counters: &mut Counters) {
        let mut z = vec![];
        loop {
            self.factor.solution_into(&mut z);
            let mut step = 1.0;
            let mut blocker = None;
            for (i, (&v, &z)) in self.v.iter().zip(&z).enumerate() {
                if z <= 0.0 && v <= step * (v - z) {
                    step = if v > z { v / (v - z) } else { 0.0 };
                    blocker = Some(i);
                }
            }
            let Some(blocker) = blocker else {
                self.v = z;
                return;
            };
            if self.drop_all(&z, counters) {
                continue;
            }
            self.v.iter_mut().zip(&z).for_each(|(v, z)| *v = (*v + step * (z - *v)).max(0.0));
            self.delete(blocker);
            counters.pivots += 1;
        }
    }

    /// Goes to the maximizer z of the model without v ≥ 0, less what is negative in it, and drops all who are, if there are
    /// many and the model rises. Many leave after a Newton step, and each of them alone would cost a solution.
    fn drop_all(&mut self, z: &[f64], counters: &mut Counters) -> bool {
        let leaving: Vec<usize> = (0..z.len()).filter(|&i| z[i] <= 0.0).collect();
        if leaving.len() < LEAVING_MIN {
            return false;
        }
        // Twice the model falls short of its maximum by the square of R(z − v).
        let now: Vec<f64> = z.iter().zip(&self.v).map(|(z, v)| z - v).collect();
        let then: Vec<f64> = z.iter().map(|z| z.min(0.0)).collect();
        if self.factor.square(&then) >= self.factor.square(&now) {
            return false;
        }
        self.v.iter_mut().zip(z).for_each(|(v, z)| *v = z.max(0.0));
        self.delete_all(&leaving);
        counters.pivots += leaving.len() as u64;
        true
    }

    /// Takes points out, by a new factor where they are many.
    fn delete_all(&mut self, positions: &[usize]) {
        let left = self.members.len() - positions.len();
        if left >= BLOCKED_FACTOR_MIN && NEW_FACTOR_RATIO * positions.len() > left {
            let leaves: HashSet<usize> = positions.iter().copied().collect();
            let kept: Vec<usize> =
                (0..self.members.len()).filter(|i| !leaves.contains(i)).collect();
            let members: Vec<usize> = kept.iter().map(|&i| self.members[i]).collect();
            let v: Vec<f64> = kept.iter().map(|&i| self.v[i]).collect();
            if self.take_up(&members, &v) {
                return;
            }
        }
        positions.iter().rev().for_each(|&position| self.delete(position));
    }

    /// Drops all whose v would be negative, even if the model falls, if they are so many that the start was no good one.
    fn drop_from_start(&mut self, counters: &mut Counters) {
        let z = self.factor.solution();
        let leaving: Vec<usize> = (0..z.len()).filter(|&i| z[i] <= 0.0).collect();
        if BAD_START_RATIO * leaving.len() > z.len() {
            self.v.iter_mut().zip(z).for_each(|(v, z)| *v = z.max(0.0));
            self.delete_all(&leaving);
            counters.pivots += leaving.len() as u64;
        }
    }

    /// N = Σ vⱼwⱼwⱼ′.
    fn matrix(&self) -> Vec<f64> {
        let count = self.members.len().next_multiple_of(POINTS);
        let (mut blocks, mut weights) = (vec![0.0; count * self.dim], vec![0.0; count]);
        for (i, (row, &v)) in self.rows.chunks_exact(self.stride).zip(&self.v).enumerate() {
            weights[i] = v;
            let start = i / POINTS * POINTS * self.dim + i % POINTS;
            for (j, &y) in row[..self.dim].iter().enumerate() {
                blocks[start + j * POINTS] = y;
            }
        }
        moments(self.dim, &blocks, &weights)
    }

    /// gᵢ = bᵢ − wᵢ′Nwᵢ for all points of the working set.
    fn price(&self, matrix: &[f64]) -> Vec<f64> {
        let mut gradient = self.whitened.forms(matrix);
        gradient.iter_mut().enumerate().for_each(|(i, g)| *g = self.b(i) - *g);
        gradient
    }

    /// The points of largest gradient above the tolerance, the best first.
    fn batch(&self, gradient: &[f64], tolerance: f64, tabu: &HashSet<usize>) -> Vec<usize> {
        let mut barred = vec![false; gradient.len()];
        self.members.iter().chain(tabu).for_each(|&i| barred[i] = true);
        let worth = |i: &usize| gradient[*i] > tolerance && !barred[*i];
        let mut batch: Vec<usize> = (0..gradient.len()).filter(worth).collect();
        let keep = (self.members.len() / 8).max(8);
        let better = |a: &usize, b: &usize| gradient[*b].total_cmp(&gradient[*a]).then(a.cmp(b));
        if batch.len() > keep {
            batch.select_nth_unstable_by(keep, better);
            batch.truncate(keep);
        }
        batch.sort_unstable_by(better);
        batch
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ellipsoid::newton::REBASE_TOLERANCE;
    use crate::ellipsoid::whitener::{Rebased, Whitener};
    use crate::ellipsoid::working_set::WorkingSet;
    use taut_points::{Distribution, generate};

    /// Rows with equal weights, under their whitener.
    fn whitened(rows: &[f64], dim: usize) -> Whitened {
        let mut set = WorkingSet::new(dim);
        for (i, row) in rows.chunks_exact(dim).enumerate() {
            set.push(i as u64, row, 1.0);
        }
        set.normalize();
        let mut whitener = Whitener::of_scales(&vec![1.0; dim]);
        assert_eq!(whitener.rebase(&set, REBASE_TOLERANCE), Rebased::Plainly);
        whitener.apply(&set)
    }

    /// v ≥ 0, g ≤ 0 and gv = 0, with g = b − Hv from all of H.
    fn check_optimal(dim: usize, whitened: &Whitened, u: &[f64], p: usize) -> u64 {
        let k = whitened.leverages.len();
        let mut counters = Counters::default();
        let Outcome::Solved(step) = solve(dim, whitened, u, 1e-9, (9999, 9999), &mut counters)
        else {
            panic!("a small model takes few steps")
        };
        assert!(step.weights.len() <= p);
        let mut rows = vec![vec![1.0; dim + 1]; k];
        for (i, row) in rows.iter_mut().enumerate() {
            copy_row(&whitened.blocks, dim, i, &mut row[..dim]);
        }
        for (i, row) in rows.iter().enumerate() {
            let product =
                |j: usize| row.iter().zip(&rows[j]).map(|(a, b)| a * b).sum::<f64>().powi(2);
            let sum: f64 = step.weights.iter().map(|&(j, v)| product(j) * v).sum();
            let g = 2.0 * whitened.leverages[i] + 1.0 - dim as f64 - sum;
            assert!(g <= 2e-9, "point {i}: {g:e}");
            if let Some((_, v)) = step.weights.iter().find(|(j, _)| *j == i) {
                assert!(*v >= 0.0 && g.abs() < 1e-9, "point {i}: {v:e}, {g:e}");
            }
        }
        counters.exchanges
    }

    #[test]
    fn models_are_solved_to_their_optimality_conditions() {
        for (n, dim) in [(40, 2), (300, 4), (500, 7), (400, 26)] {
            let p = basis_max(dim);
            let rows: Vec<f64> = generate(Distribution::Normal, n, dim, 3).unwrap();
            let points = whitened(&rows, dim);
            // Cold, warm from the first points, and warm from one.
            check_optimal(dim, &points, &vec![1.0 / n as f64; n], p);
            let mut u = vec![0.0; n];
            u[..p.min(n / 2)].fill(0.1);
            check_optimal(dim, &points, &u, p);
            u.fill(0.0);
            u[n - 1] = 1.0;
            check_optimal(dim, &points, &u, p);
        }
    }

    /// Points near a sphere: more of them fit a model than can be independent, and copies always depend.
    #[test]
    fn dependent_points_are_exchanged() {
        let (n, dim) = (2000, 4);
        let mut rows: Vec<f64> = generate(Distribution::Normal, n, dim, 8).unwrap();
        for (i, row) in rows.chunks_exact_mut(dim).enumerate() {
            let length = dot(row, row).sqrt() * (1.0 + 1e-7 * (i % 97) as f64);
            row.iter_mut().for_each(|v| *v /= length);
        }
        let twice: Vec<f64> = rows.iter().chain(&rows).copied().collect();
        for rows in [rows, twice] {
            let points = whitened(&rows, dim);
            let mut u = vec![0.0; points.leverages.len()];
            u[..15].fill(1.0 / 15.0);
            let exchanges = check_optimal(dim, &points, &u, 15);
            assert!(exchanges > 0);
        }
    }

    /// Multipliers on the ends of the axes are optimal. Points of the sphere come into the model by rounding alone, and leave it again.
    #[test]
    fn a_model_that_is_optimal_up_to_rounding_ends() {
        let dim = 48;
        let mut set = WorkingSet::new(dim);
        for at in 0..2 * dim {
            let mut row = vec![0.0; dim];
            row[at / 2] = if at % 2 == 0 { 1.0 } else { -1.0 };
            set.push(at as u64, &row, 1.0);
        }
        let sphere: Vec<f64> = generate(Distribution::Sphere, 300, dim, 3).unwrap();
        for (id, row) in (1000..).zip(sphere.chunks_exact(dim)) {
            set.push(id, row, 0.0);
        }
        set.normalize();
        let mut whitener = Whitener::of_scales(&vec![1.0; dim]);
        whitener.rebase(&set, REBASE_TOLERANCE);
        let points = whitener.apply(&set);
        let mut counters = Counters::default();
        let end = solve(dim, &points, set.weights(), 0.0, (9999, 9999), &mut counters);
        let Outcome::Solved(step) = end else { panic!("rounding took all patience") };
        assert!(step.weights.iter().all(|(_, v)| *v >= 0.0));
        assert!(counters.pivots > 0, "no point came in");
    }
}
