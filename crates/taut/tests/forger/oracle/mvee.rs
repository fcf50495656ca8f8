//! The minimum volume enclosing ellipsoid of points, bracketed in 256 bits.
//!
//! *Lower bound.* For u ≥ 0 with Σuᵢ = 1, p̄ = Σuᵢpᵢ and Σ = Σuᵢ(pᵢ − p̄)(pᵢ − p̄)ᵀ, every enclosing ellipsoid has a log-volume of
//! at least log κᵣ + (r/2)·log r + ½·log det Σ. *Upper bound.* {x : (x − p̄)ᵀΣ⁻¹(x − p̄) ≤ ρ} encloses all points where ρ is the
//! largest value of the left side. Both hold for every u, so how u is found does not matter for the proof.
//! *Weights.* They maximize log det M(u) for M = Σuᵢqᵢqᵢᵀ, qᵢ = (yᵢ, 1), over u ≥ 0 with Σuᵢ = 1. The conditions are
//! wᵢᵢ + sᵢ = λ and uᵢsᵢ = 0 with s ≥ 0 and wᵢⱼ = qᵢᵀM⁻¹qⱼ. A primal–dual interior-point method takes Newton steps on
//! uᵢsᵢ = μ while μ falls; it does not mind that u is not unique, as for the corners of a cube. Of many points only
//! those far out take part, and those that the ellipsoid found does not enclose join.
//! *Reference.* Todd, Minimum-Volume Ellipsoids, SIAM 2016, chapters 2 and 3.

use super::interval::{Interval, log_unit_ball};
use super::linear::{Factor, Matrix, Vector, Way, difference, dot};

/// At most this many points take part in a solve at first.
const FIRST_POINTS_MAX: usize = 40;
/// One solve has at most this many steps; each divides μ by about 10.
const STEPS_MAX: usize = 160;
/// A solve that is to be as sharp as can be ends at this μ, as a power of two.
pub(super) const MU_EXPONENT_MIN: i64 = -130;

/// A lower and an upper bound.
#[derive(Clone, Debug)]
pub(super) struct Bracket {
    pub(super) lower: Interval,
    pub(super) upper: Interval,
}

/// The trial ellipsoid of some weights.
pub(super) struct Trial {
    pub(super) mean: Vector,
    /// Σ factorized.
    pub(super) factor: Factor,
    /// The lower bound on the log-volume.
    pub(super) lower: Interval,
}

impl Trial {
    /// `None` where Σ may be singular. The weights need not sum to 1.
    pub(super) fn of(points: &[Vector], weights: &[Interval], way: Way) -> Option<Self> {
        let rank = points.first()?.len();
        let sum = weights.iter().fold(Interval::zero(), |sum, u| sum.plus(u));
        let used = || weights.iter().zip(points).filter(|(u, _)| u.is_positive());
        let mut mean: Vector = vec![Interval::zero(); rank];
        for (u, p) in used() {
            mean.iter_mut().zip(p).for_each(|(m, p)| *m = m.plus(&u.times(p)));
        }
        let mean: Vector = mean.iter().map(|m| m.over(&sum)).collect::<Option<_>>()?;
        let mut squares = vec![vec![Interval::zero(); rank]; rank];
        for (u, p) in used() {
            let offset = difference(p, &mean);
            for (a, row) in squares.iter_mut().enumerate() {
                let term = u.times(&offset[a]);
                for (entry, x) in row[..=a].iter_mut().zip(&offset) {
                    *entry = entry.plus(&term.times(x));
                }
            }
        }
        for row in &mut squares {
            for entry in row {
                *entry = way.keep(entry.over(&sum)?);
            }
        }
        let factor = Factor::of(&squares, way)?;
        let r = Interval::integer(rank as i64);
        let most = (0..rank).fold(factor.determinant(), |product, _| product.times(&r));
        let lower = log_unit_ball(rank).plus(&most.ln()?.scaled(-1));
        Some(Trial { mean, factor, lower })
    }

    /// (x − p̄)ᵀΣ⁻¹(x − p̄).
    pub(super) fn square(&self, x: &[Interval]) -> Option<Interval> {
        self.factor.quadratic(&difference(x, &self.mean))
    }

    /// The bracket of this trial when no item has a square beyond `far`.
    pub(super) fn bracket(&self, far: &Interval) -> Option<Bracket> {
        let rank = self.mean.len() as i64;
        let grown = far.over(&Interval::integer(rank))?.ln()?.times(&Interval::integer(rank));
        let upper = self.lower.plus(&grown.scaled(-1));
        Some(Bracket { lower: self.lower.clone(), upper })
    }
}

/// The larger of two, or a bound on both.
pub(super) fn larger(a: Interval, b: Interval) -> Interval {
    match a.at_most(&b) {
        Some(true) => b,
        Some(false) => a,
        None if a.upper().at_most(&b.upper()) == Some(true) => b.upper(),
        None => a.upper(),
    }
}

/// The bracket that these weights prove for the points.
pub(super) fn bracket(points: &[Vector], weights: &[Interval]) -> Option<Bracket> {
    let trial = Trial::of(points, weights, Way::Proved)?;
    let mut far = Interval::zero();
    for point in points {
        far = larger(far, trial.square(point)?);
    }
    trial.bracket(&far)
}

/// Weights that are nearly the best, up to 2^`end`, and 0 for most points; `None` for points that do not span the space.
pub(super) fn weights(points: &[Vector], end: i64) -> Option<Vector> {
    let uniform = vec![Interval::integer(1); points.len()];
    let all = Trial::of(points, &uniform, Way::Plain)?;
    let whitened: Matrix = points
        .iter()
        .map(|p| all.factor.whitened(&difference(p, &all.mean)))
        .collect::<Option<_>>()?;
    let mut chosen = first_choice(&whitened);
    loop {
        let part: Matrix = chosen.iter().map(|&i| whitened[i].clone()).collect();
        let found = interior(&part, end)?;
        let trial = Trial::of(&part, &found, Way::Plain)?;
        let limit = Interval::integer(trial.mean.len() as i64);
        let limit = limit.plus(&limit.scaled(end + 30));
        let mut outside: Vec<(f64, usize)> = vec![];
        for (i, y) in whitened.iter().enumerate() {
            let square = trial.square(y)?;
            if !chosen.contains(&i) && square.at_most(&limit) != Some(true) {
                outside.push((square.rounded(), i));
            }
        }
        if outside.is_empty() {
            let mut weights = vec![Interval::zero(); points.len()];
            chosen.iter().zip(found).for_each(|(&i, u)| weights[i] = u);
            return Some(weights);
        }
        outside.sort_by(|a, b| b.0.total_cmp(&a.0));
        chosen.extend(outside.iter().take(FIRST_POINTS_MAX / 4).map(|o| o.1));
    }
}

/// All of few points; of many, those farthest from the mean and along the axes.
fn first_choice(whitened: &[Vector]) -> Vec<usize> {
    let n = whitened.len();
    if n <= FIRST_POINTS_MAX {
        return (0..n).collect();
    }
    let plain: Vec<Vec<f64>> =
        whitened.iter().map(|y| y.iter().map(Interval::rounded).collect()).collect();
    let mut chosen: Vec<usize> = vec![];
    let mut take = |score: &dyn Fn(&Vec<f64>) -> f64, count: usize| {
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by(|&i, &j| score(&plain[j]).total_cmp(&score(&plain[i])));
        chosen.extend(order.into_iter().take(count));
    };
    take(&|y| y.iter().map(|v| v * v).sum(), FIRST_POINTS_MAX / 2);
    for a in 0..plain[0].len() {
        take(&|y| y[a], 1);
        take(&|y| -y[a], 1);
    }
    chosen.sort_unstable();
    chosen.dedup();
    chosen
}

/// The interior-point method on points that are about 1 from 0; `None` where they do not span the space.
fn interior(points: &[Vector], end: i64) -> Option<Vector> {
    let (n, way) = (points.len(), Way::Plain);
    let one = Interval::integer(1);
    let lifted: Matrix =
        points.iter().map(|y| y.iter().cloned().chain([one.clone()]).collect()).collect();
    let count = Interval::integer(n as i64);
    let mut u = vec![way.keep(one.over(&count)?); n];
    let mut w = products(&lifted, &u)?;
    let most = w.iter().enumerate().fold(Interval::zero(), |most, (i, row)| {
        if most.at_most(&row[i]) == Some(true) { row[i].clone() } else { most }
    });
    let mut lambda = most.times(&Interval::fraction(11, 10)?).into_middle();
    let mut s: Vector = (0..n).map(|i| way.keep(lambda.minus(&w[i][i]))).collect();
    for _ in 0..STEPS_MAX {
        let mu = way.keep(dot(&u, &s).over(&count)?);
        if mu.binary_order() < end {
            break;
        }
        let target = way.keep(mu.times(&Interval::fraction(1, 10)?));
        // (W∘W + diag(s/u))Δu + Δλ = wᵢᵢ + μ/uᵢ − λ and ΣΔu = 1 − Σu.
        let mut matrix: Matrix = Vec::with_capacity(n);
        let mut right: Vector = Vec::with_capacity(n);
        for i in 0..n {
            let mut row: Vector = (0..=i).map(|j| way.keep(w[i][j].square())).collect();
            row[i] = way.keep(row[i].plus(&s[i].over(&u[i])?));
            matrix.push(row);
            right.push(way.keep(w[i][i].plus(&target.over(&u[i])?).minus(&lambda)));
        }
        let factor = Factor::of(&matrix, way)?;
        let (free, of_lambda) = (factor.solve(&right)?, factor.solve(&vec![one.clone(); n])?);
        let sum = |x: &[Interval]| x.iter().fold(Interval::zero(), |sum, x| sum.plus(x));
        let short = one.minus(&sum(&u));
        let step_lambda = way.keep(sum(&free).minus(&short).over(&sum(&of_lambda))?);
        let step_u: Vector = free
            .iter()
            .zip(&of_lambda)
            .map(|(f, l)| way.keep(f.minus(&l.times(&step_lambda))))
            .collect();
        let step_s: Vector = (0..n)
            .map(|i| {
                let wanted = target.minus(&s[i].times(&step_u[i])).over(&u[i])?;
                Some(way.keep(wanted.minus(&s[i])))
            })
            .collect::<Option<_>>()?;
        let alpha = longest(&u, &step_u).min(longest(&s, &step_s));
        let alpha = Interval::exact(alpha)?;
        let go = |x: &mut Interval, step: &Interval| *x = way.keep(x.plus(&alpha.times(step)));
        u.iter_mut().zip(&step_u).for_each(|(x, step)| go(x, step));
        s.iter_mut().zip(&step_s).for_each(|(x, step)| go(x, step));
        go(&mut lambda, &step_lambda);
        w = products(&lifted, &u)?;
    }
    Some(u)
}

/// wᵢⱼ for j ≤ i.
fn products(lifted: &[Vector], u: &[Interval]) -> Option<Matrix> {
    let m = lifted[0].len();
    let mut matrix = vec![vec![Interval::zero(); m]; m];
    for (u, q) in u.iter().zip(lifted) {
        for (a, row) in matrix.iter_mut().enumerate() {
            let term = u.times(&q[a]);
            for (entry, q) in row[..=a].iter_mut().zip(q) {
                *entry = entry.plus(&term.times(q));
            }
        }
    }
    let factor = Factor::of(&matrix, Way::Plain)?;
    let z: Matrix = lifted.iter().map(|q| factor.whitened(q)).collect::<Option<_>>()?;
    let row = |i: usize| (0..=i).map(|j| dot(&z[i], &z[j]).into_middle()).collect();
    Some((0..z.len()).map(row).collect())
}

/// The longest step up to 1 that takes a number above 0 no nearer to 0 than by 99 hundredths of the way.
pub(super) fn longest(x: &[Interval], step: &[Interval]) -> f64 {
    let ratios = x.iter().zip(step).filter(|(_, step)| step.negative().is_positive());
    ratios.fold(1.0, |least: f64, (x, step)| {
        let ratio = x.over(&step.negative()).map_or(0.0, |ratio| ratio.rounded());
        least.min(0.99 * ratio)
    })
}
