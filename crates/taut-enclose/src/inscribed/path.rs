//! Newton steps along the central path of the inscribed ellipsoid, and what its multipliers prove.
//!
//! *Formula.* Minimize −ln det(1 + S) − μΣ ln Dᵢ, Dᵢ = (sᵢ − ãᵢ′w)² − |(1 + S)ãᵢ|², over symmetric S and w, in the frame of
//! the current ellipsoid: its Hessian at S = 0, w = 0 is the metric of steps. After each step the frame moves along.
//! At the minimum λᵢ = 2μsᵢ/Dᵢ satisfy Σλᵢãᵢ = 0 and Σλᵢãᵢãᵢ′/sᵢ = 1, so the gap is about Σλᵢ(sᵢ − |ãᵢ|) ≤ 2nμ.
//! *Trap.* Where the ellipsoid is thin, rounding G moves its short axes by what is left of the long ones across them. So the
//! columns of G are kept orthogonal, and it does so with the second power only.
//! *Trap.* Σλᵢãᵢ is only as near 0 as the last step was good, and enters the bound with its first power. So the λ are moved
//! by the least relative change that satisfies both equations.

use taut_certify::{PassBounds, Stop};
use taut_kernels::DoubleDouble;
use taut_kernels::vector::{add_scaled, dot};
use taut_points::{Monitor, ReadError};

use super::start::Interior;
use super::{HalfSpaces, InscribedOptions, PathResult, ROUNDING, View, seen};
use crate::Error;
use crate::ellipsoid::dense::cholesky;
use crate::ellipsoid::outcome::log_unit_ball;

/// μ is multiplied by this once its minimum is nearly reached.
const MU_FACTOR: f64 = 0.1;
/// A step whose square length, in the metric of the function over μ, is below this is near enough to lower μ.
const STEP_SQUARE_MAX: f64 = 0.1;
/// At the last μ, a step whose square length is below this is near enough to end.
const LAST_STEP_SQUARE_MAX: f64 = 1e-6;
/// A step as short as that is taken whole: the function falls, though rounding may not show it.
const WHOLE_STEP_SQUARE_MAX: f64 = 0.05;
/// Shifts of a Hessian, over its largest entry; all but the first for one that rounding made indefinite.
const SHIFTS: [f64; 5] = [0.0, 1e-15, 1e-14, 1e-13, 1e-12];
/// Columns are made orthogonal in at most this many rounds of rotations; five are usual.
const SWEEPS_MAX: usize = 12;
/// At the last μ at most this many steps are taken, after which rounding is in the way.
const LAST_STEPS_MAX: u32 = 20;

/// Follows the path until 2nμ is below what is wanted.
pub(super) fn follow(
    sides: &HalfSpaces,
    start: Interior,
    options: &InscribedOptions<'_>,
    monitor: &Monitor<'_>,
) -> Result<PathResult, Error> {
    let dim = sides.dim;
    let n = sides.rows().len();
    let mut center = start.center;
    let mut axes = vec![0.0; dim * dim];
    start.half_axes.iter().enumerate().for_each(|(j, half)| axes[j * dim + j] = 0.5 * half);
    // Beyond what rounding allows, half-spaces that hardly touch lose what proves their part.
    let last_mu = 0.1 * options.epsilon.max(ROUNDING * dim as f64) / (2 * n) as f64;
    let mut mu = 1.0f64.max(last_mu);
    let (mut steps, mut at_last, mut history) = (0, 0, vec![]);
    let view = |center: &[f64], axes: &[f64]| -> Vec<View> {
        sides.rows().map(|row| seen(row, center, axes)).collect()
    };
    let mut views = view(&center, &axes);
    let stop = loop {
        monitor.check().map_err(ReadError::from)?;
        let Some((step, length)) = newton(&views, dim, mu) else { break Stop::Rounding };
        steps += 1;
        let moved = take(&mut center, &mut axes, &views, &step, length, mu, dim);
        orthogonalize(&mut axes, dim);
        views = view(&center, &axes);
        if mu <= last_mu {
            at_last += 1;
            if length < LAST_STEP_SQUARE_MAX || !moved || at_last == LAST_STEPS_MAX {
                break Stop::Converged;
            }
        } else if length < STEP_SQUARE_MAX || !moved {
            let lower = log_determinant(&axes, dim) + log_unit_ball(dim);
            let upper = lower + 2.0 * n as f64 * mu;
            history.push(PassBounds { lower, upper, working_set: n as u64 });
            mu = (MU_FACTOR * mu).max(last_mu);
        }
        if steps == options.max_steps {
            break Stop::PassBudget;
        }
    };
    let multiplier =
        |View { normal: a, slack: s, unit }: &View| 2.0 * mu * s / (s * s - dot(a, a)) / unit;
    let lambda = views.iter().map(multiplier).collect();
    Ok(PathResult { center, axes, lambda, steps, stop, history })
}

/// Entries (k, l), k ≥ l, of a symmetric matrix, and by what they are multiplied in a vector of the same length.
fn entries(dim: usize) -> impl Iterator<Item = (usize, usize, f64)> {
    let weight = |k: usize, l: usize| if k == l { 1.0 } else { std::f64::consts::SQRT_2 };
    (0..dim).flat_map(move |k| (0..=k).map(move |l| (k, l, weight(k, l))))
}

/// The Newton step (S as a vector, then w) and the square of its length in the metric of the Hessian over μ.
fn newton(views: &[View], dim: usize, mu: f64) -> Option<(Vec<f64>, f64)> {
    let p = dim * (dim + 1) / 2;
    let size = p + dim;
    let mut gradient = vec![0.0; size];
    let mut hessian = vec![0.0; size * size];
    // Σ 2μ/D·ãã′, which stands in both blocks of the second derivatives.
    let mut c = vec![0.0; dim * dim];
    let mut q = vec![0.0; size];
    for View { normal: a, slack: s, .. } in views {
        let room = s * s - dot(a, a);
        for ((k, l, weight), q) in entries(dim).zip(&mut q) {
            *q = 2.0 * weight * a[k] * a[l] / room;
        }
        for (q, a) in q[p..].iter_mut().zip(a) {
            *q = 2.0 * s * a / room;
        }
        add_scaled(&mut gradient, mu, &q);
        for i in 0..size {
            let factor = mu * q[i];
            add_scaled(&mut hessian[i * size..i * size + i + 1], factor, &q[..=i]);
        }
        for k in 0..dim {
            add_scaled(&mut c[k * dim..(k + 1) * dim], 2.0 * mu / room * a[k], a);
        }
    }
    for (i, (k, l, _)) in entries(dim).enumerate() {
        gradient[i] -= if k == l { 1.0 } else { 0.0 };
        hessian[i * size + i] += 1.0;
        // ½(EC + CE) for the unit matrix E of this entry.
        let scale = if k == l { 1.0 } else { std::f64::consts::FRAC_1_SQRT_2 };
        for (j, (m, o, weight)) in entries(dim).take(i + 1).enumerate() {
            let product = |row: usize, column: usize| {
                let left = |x: usize, y: usize| if row == x { c[y * dim + column] } else { 0.0 };
                let right = |x: usize, y: usize| if column == x { c[row * dim + y] } else { 0.0 };
                let (there, back) = (left(k, l) + right(l, k), left(l, k) + right(k, l));
                0.5 * scale * if k == l { there } else { there + back }
            };
            let value = 0.5 * (product(m, o) + product(o, m));
            hessian[i * size + j] += weight * value;
        }
    }
    for k in 0..dim {
        for l in 0..=k {
            hessian[(p + k) * size + p + l] -= c[k * dim + l];
        }
    }
    // A ball in a polytope that is much longer than wide leaves the Hessian singular but for rounding. A shift by what
    // rounding is shortens the step along the polytope, where the ellipsoid soon grows all the same.
    if !hessian.iter().all(|h| h.is_finite()) {
        return None;
    }
    let largest = (0..size).map(|i| hessian[i * size + i]).fold(f64::MIN_POSITIVE, f64::max);
    let plain = hessian.clone();
    let is_shifted = |hessian: &mut [f64], shift: f64| {
        hessian.copy_from_slice(&plain);
        (0..size).for_each(|i| hessian[i * size + i] += shift * largest);
        cholesky(hessian, size)
    };
    if !SHIFTS.iter().any(|&shift| is_shifted(&mut hessian, shift)) {
        return None;
    }
    let mut step: Vec<f64> = gradient.iter().map(|g| -g).collect();
    solve(&hessian, size, &mut step);
    let length = -dot(&step, &gradient);
    (length >= 0.0).then_some((step, length / mu))
}

/// (LL′)⁻¹b.
fn solve(lower: &[f64], n: usize, b: &mut [f64]) {
    for i in 0..n {
        b[i] = (b[i] - dot(&lower[i * n..i * n + i], &b[..i])) / lower[i * n + i];
    }
    for i in (0..n).rev() {
        b[i] /= lower[i * n + i];
        let value = b[i];
        let (head, _) = b.split_at_mut(i);
        add_scaled(head, -value, &lower[i * n..i * n + i]);
    }
}

/// Goes along a step as far as the barrier falls; says whether anywhere.
fn take(
    center: &mut [f64],
    axes: &mut [f64],
    views: &[View],
    step: &[f64],
    length: f64,
    mu: f64,
    dim: usize,
) -> bool {
    let mut s = vec![0.0; dim * dim];
    for ((k, l, weight), v) in entries(dim).zip(step) {
        (s[k * dim + l], s[l * dim + k]) = (v / weight, v / weight);
    }
    let w = &step[dim * (dim + 1) / 2..];
    let grown = |t: f64| -> Vec<f64> {
        (0..dim * dim).map(|at| t * s[at] + if at / dim == at % dim { 1.0 } else { 0.0 }).collect()
    };
    // By how much the function differs from its value here; none where it is not defined.
    let change = |t: f64| -> Option<f64> {
        let turned = grown(t);
        let mut lower = turned.clone();
        if !cholesky(&mut lower, dim) {
            return None;
        }
        let mut sum: f64 = -2.0 * (0..dim).map(|k| lower[k * dim + k].ln()).sum::<f64>();
        for View { normal: a, slack, .. } in views {
            let image: Vec<f64> = turned.chunks_exact(dim).map(|row| dot(row, a)).collect();
            let slack_then = slack - t * dot(a, w);
            let room = (slack_then - dot(&image, &image).sqrt())
                * (slack_then + dot(&image, &image).sqrt());
            if !(room > 0.0 && slack_then > 0.0) {
                return None;
            }
            let before = (slack - dot(a, a).sqrt()) * (slack + dot(a, a).sqrt());
            sum -= mu * (room / before).ln();
        }
        Some(sum)
    };
    let mut t = 1.0;
    for _ in 0..40 {
        if change(t).is_some_and(|change| {
            change <= -0.1 * t * mu * length || length < WHOLE_STEP_SQUARE_MAX
        }) {
            let turned = grown(t);
            for (row, c) in axes.chunks_exact_mut(dim).zip(center.iter_mut()) {
                *c += t * dot(row, w);
                let moved: Vec<f64> =
                    turned.chunks_exact(dim).map(|other| dot(row, other)).collect();
                row.copy_from_slice(&moved);
            }
            return true;
        }
        t *= 0.5;
    }
    false
}

/// Turns the frame so that the columns of G are orthogonal: rotations of two columns at a time, after Jacobi.
pub(super) fn orthogonalize(axes: &mut [f64], dim: usize) {
    let largest = axes.iter().fold(0.0f64, |m, g| m.max(g.abs()));
    for _ in 0..SWEEPS_MAX {
        let mut is_orthogonal = true;
        for (p, q) in (0..dim).flat_map(|q| (0..q).map(move |p| (p, q))) {
            let (mut pp, mut qq, mut pq) = (0.0, 0.0, 0.0);
            for row in axes.chunks_exact(dim) {
                let (x, y) = (row[p] / largest, row[q] / largest);
                (pp, qq, pq) = (pp + x * x, qq + y * y, pq + x * y);
            }
            let is_small = pq.abs() <= f64::EPSILON * pp.sqrt() * qq.sqrt();
            if is_small {
                continue;
            }
            is_orthogonal = false;
            let zeta = (qq - pp) / (2.0 * pq);
            let tangent = zeta.signum() / (zeta.abs() + zeta.hypot(1.0));
            let cos = 1.0 / tangent.hypot(1.0);
            let sin = cos * tangent;
            for row in axes.chunks_exact_mut(dim) {
                (row[p], row[q]) = (cos * row[p] - sin * row[q], sin * row[p] + cos * row[q]);
            }
        }
        if is_orthogonal {
            break;
        }
    }
}

/// ln |det G| by elimination, to twice the digits: where the axes are thin and turned, pivots cancel.
pub(super) fn log_determinant(axes: &[f64], dim: usize) -> f64 {
    let mut rows: Vec<Vec<DoubleDouble>> =
        axes.chunks_exact(dim).map(|row| row.iter().map(|&g| g.into()).collect()).collect();
    let mut sum = 0.0;
    for k in 0..dim {
        let size = |row: usize| rows[row][k].high.abs();
        let pivot = (k..dim).max_by(|&a, &b| size(a).total_cmp(&size(b)));
        rows.swap(k, pivot.unwrap_or(k));
        let (above, below) = rows.split_at_mut(k + 1);
        let top = &above[k];
        sum += top[k].high.abs().ln();
        for row in below {
            let factor = row[k] / top[k];
            for (value, other) in row[k..].iter_mut().zip(&top[k..]) {
                *value = *value - factor * *other;
            }
        }
    }
    sum
}

/// Multipliers moved by the least relative change so that Σλᵢãᵢ = 0 and Σλᵢãᵢãᵢ′/|ãᵢ| = 1.
pub(super) fn corrected(views: &[View], mut lambda: Vec<f64>) -> Vec<f64> {
    let dim = views[0].normal.len();
    let p = dim * (dim + 1) / 2;
    let size = p + dim;
    let rows: Vec<Vec<f64>> = views
        .iter()
        .map(|View { normal: a, .. }| {
            let length = dot(a, a).sqrt();
            entries(dim)
                .map(|(k, l, weight)| weight * a[k] * a[l] / length)
                .chain(a.iter().copied())
                .collect()
        })
        .collect();
    for _ in 0..3 {
        let mut rest = vec![0.0; size];
        entries(dim).zip(&mut rest).for_each(|((k, l, _), r)| *r = if k == l { 1.0 } else { 0.0 });
        let mut gram = vec![0.0; size * size];
        for (row, &l) in rows.iter().zip(&lambda) {
            add_scaled(&mut rest, -l, row);
            for i in 0..size {
                add_scaled(&mut gram[i * size..i * size + i + 1], l * l * row[i], &row[..=i]);
            }
        }
        // Fewer sides than equations leave it singular: what cannot be corrected stays.
        let trace: f64 = (0..size).map(|i| gram[i * size + i]).sum();
        (0..size).for_each(|i| gram[i * size + i] += 1e-13 * trace);
        if !cholesky(&mut gram, size) {
            break;
        }
        solve(&gram, size, &mut rest);
        for (row, l) in rows.iter().zip(&mut lambda) {
            let change = (*l * dot(row, &rest)).max(-0.9);
            *l += *l * change;
        }
    }
    lambda
}

/// Returns what multipliers prove: the bound of the certificate.
pub(super) fn gap(views: &[View], lambda: &[f64]) -> f64 {
    let dim = views[0].normal.len();
    let d = dim as f64;
    let trace: f64 =
        views.iter().zip(lambda).map(|(view, l)| l * dot(&view.normal, &view.normal).sqrt()).sum();
    let tau = trace / d;
    let (mut rest, mut matrix) = (vec![0.0; dim], vec![0.0; dim * dim]);
    let (mut room, mut delta) = (0.0, 0.0);
    for (View { normal: a, slack: s, .. }, l) in views.iter().zip(lambda) {
        let (l, length) = (l / tau, dot(a, a).sqrt());
        add_scaled(&mut rest, l, a);
        for k in 0..dim {
            add_scaled(&mut matrix[k * dim..(k + 1) * dim], l / length * a[k], a);
        }
        room += l * (s - length);
        delta += l * (s - length).abs();
    }
    let off = |at: usize| matrix[at] - if at / dim == at % dim { 1.0 } else { 0.0 };
    let norm = (0..dim * dim).map(|at| off(at) * off(at)).sum::<f64>().sqrt();
    let rest = dot(&rest, &rest).sqrt();
    let far = (d + room + rest + delta) / (1.0 - norm - rest);
    let is_near_optimal = far > 0.0;
    if !is_near_optimal || !cholesky(&mut matrix, dim) {
        return f64::INFINITY;
    }
    let logs: f64 = (0..dim).map(|k| 2.0 * matrix[k * dim + k].ln()).sum();
    (d * ((room + rest * far) / d).ln_1p() - logs).max(0.0)
}
