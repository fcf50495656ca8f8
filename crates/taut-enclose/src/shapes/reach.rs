//! The point of an ellipsoid that lies farthest from the origin.
//!
//! *Problem.* Along the axes of the ellipsoid: maximize |h + Λ^½z|² over |z| ≤ 1, for a diagonal Λ ⪰ 0.
//! *Formula.* z = Λ^½h/(μ − Λ) for the μ ≥ λ₁ = max λ with |z| = 1, and the largest value is φ(μ) = μ(1 + Σ hₖ²/(μ − λₖ)),
//! which bounds it from above for every μ > λ₁.
//! *Idea.* The unknown is δ = μ − λ₁, so that no digit of μ − λₖ is lost; Newton steps on 1/|z| = 1, which is nearly
//! linear in δ, inside a bracket.
//! *Trap.* Where h has no part along the longest axes and the others leave |z| < 1 at δ = 0, what is missing goes to a
//! longest axis, in either direction: there is more than one farthest point. Near that case the others are nearly as
//! far, and a solver wants to know all of them at once.
//! *Reference.* Moré and Sorensen, SIAM J. Sci. Stat. Comput. 4(3), 1983.

/// Axes within this part of the longest are tried instead of it, in both directions.
const LONGEST_TOLERANCE: f64 = 0.2;
/// At most this many steps are made. Newton steps end after a handful; halving the exponent of a bracket takes no more
/// than this.
const STEPS_MAX: usize = 200;

/// The point farthest out.
pub(crate) struct Farthest {
    /// |h + Λ^½z|², rounding aside from above.
    pub(crate) square: f64,
    /// βₖ = zₖ/√λₖ, 0 where λₖ = 0: along the axes, the direction in which the point is that of the ellipsoid that lies
    /// farthest.
    pub(crate) beta: Vec<f64>,
}

/// The point of {h + Λ^½z : |z| ≤ 1} farthest from 0.
pub(crate) fn farthest(lambda: &[f64], h: &[f64]) -> Farthest {
    let top = lambda.iter().copied().fold(0.0, f64::max);
    if top == 0.0 {
        return Farthest { square: h.iter().map(|h| h * h).sum(), beta: vec![0.0; h.len()] };
    }
    let gaps: Vec<f64> = lambda.iter().map(|l| top - l.max(0.0)).collect();
    let weights: Vec<f64> = lambda.iter().zip(h).map(|(l, h)| l.max(0.0) * h * h).collect();
    let delta = shift(&gaps, &weights);
    let mut beta = vec![0.0; h.len()];
    let (mut z2, mut sum) = (0.0, 0.0);
    for (k, beta) in beta.iter_mut().enumerate() {
        let below = gaps[k] + delta;
        if below > 0.0 && h[k] != 0.0 {
            *beta = h[k] / below;
            z2 += lambda[k].max(0.0) * *beta * *beta;
            sum += h[k] * *beta;
        }
    }
    if delta == 0.0 && z2 < 1.0 {
        let longest = lambda.iter().position(|&l| l == top).unwrap_or(0);
        beta[longest] = ((1.0 - z2) / top).sqrt();
    }
    Farthest { square: (top + delta) * (1.0 + sum), beta }
}

/// δ ≥ 0 with Σ wₖ/(gₖ + δ)² = 1, or 0 where the sum is less at 0 already.
fn shift(gaps: &[f64], weights: &[f64]) -> f64 {
    let mut low = gaps.iter().zip(weights).map(|(g, w)| w.sqrt() - g).fold(0.0, f64::max);
    let mut high = weights.iter().sum::<f64>().sqrt();
    let sums = |delta: f64| {
        let (mut square, mut cube) = (0.0, 0.0);
        for (g, &w) in gaps.iter().zip(weights) {
            if w > 0.0 {
                let inverse = 1.0 / (g + delta);
                square += w * inverse * inverse;
                cube += w * inverse * inverse * inverse;
            }
        }
        (square, cube)
    };
    let mut delta = low;
    for _ in 0..STEPS_MAX {
        let (square, cube) = sums(delta);
        if delta == 0.0 && square <= 1.0 {
            return 0.0;
        }
        if square > 1.0 {
            low = delta
        } else {
            high = delta
        }
        if (square - 1.0).abs() <= 4.0 * f64::EPSILON {
            break;
        }
        let next = delta + square * (square.sqrt() - 1.0) / cube;
        if next == delta || high <= low {
            break;
        }
        let is_between = low < next && next < high;
        let middle =
            if low > 0.0 && high > 4.0 * low { (low * high).sqrt() } else { 0.5 * (low + high) };
        delta = if is_between { next } else { middle };
    }
    delta
}

/// The farthest point, and others that are nearly as far: what lies along the longest axes is turned to each of them, in
/// both directions, and to where `seeds` have their parts along these axes. Calls `found` with |h + Λ^½z|² and β of each.
///
/// Seeds are vectors z; a solver gives points that touched before, so that those which touch in a circle keep their places
/// on it while it moves.
pub(crate) fn alternatives(
    lambda: &[f64],
    h: &[f64],
    best: &Farthest,
    seeds: &[Vec<f64>],
    mut found: impl FnMut(f64, &[f64]),
) {
    let top = lambda.iter().copied().fold(0.0, f64::max);
    found(best.square, &best.beta);
    let is_long = |k: usize| lambda[k] > 0.0 && lambda[k] >= (1.0 - LONGEST_TOLERANCE) * top;
    let long: Vec<usize> = (0..h.len()).filter(|&k| is_long(k)).collect();
    let rest: f64 = (0..h.len())
        .filter(|&k| !is_long(k))
        .map(|k| (h[k] + lambda[k].max(0.0) * best.beta[k]).powi(2))
        .sum();
    let along: f64 = long.iter().map(|&k| lambda[k] * best.beta[k] * best.beta[k]).sum();
    let mut beta = best.beta.clone();
    let mut turn = |z: &dyn Fn(usize) -> f64| {
        let length = long.iter().map(|&k| z(k) * z(k)).sum::<f64>().sqrt();
        if length == 0.0 {
            return;
        }
        let mut value = rest;
        for &k in &long {
            let part = along.sqrt() * z(k) / length;
            beta[k] = part / lambda[k].sqrt();
            value += (h[k] + lambda[k].sqrt() * part).powi(2);
        }
        found(value, &beta);
    };
    for &k in &long {
        for sign in [1.0, -1.0] {
            if long.len() > 1 || sign * best.beta[k] <= 0.0 {
                turn(&|j| if j == k { sign } else { 0.0 });
            }
        }
    }
    if long.len() > 1 {
        seeds.iter().for_each(|seed| turn(&|k| seed[k]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(lambda: &[f64], h: &[f64]) {
        let found = farthest(lambda, h);
        let z2: f64 = lambda.iter().zip(&found.beta).map(|(l, b)| l * b * b).sum();
        let square: f64 =
            lambda.iter().zip(&found.beta).zip(h).map(|((l, b), h)| (h + l * b).powi(2)).sum();
        assert!((z2 - 1.0).abs() < 1e-9, "{lambda:?} {h:?}: |z|² = {z2}");
        assert!(
            (square / found.square - 1.0).abs() < 1e-12,
            "{lambda:?} {h:?}: {square} {}",
            found.square
        );
        // No point of a fine grid of directions lies farther out.
        let n = h.len();
        for seed in 0..2000u64 {
            let mut z: Vec<f64> =
                (0..n).map(|k| (0.5 + (seed * 7 + k as u64 * 13) as f64 * 0.7391).sin()).collect();
            let norm = z.iter().map(|z| z * z).sum::<f64>().sqrt();
            z.iter_mut().for_each(|z| *z /= norm);
            let value: f64 = (0..n).map(|k| (h[k] + lambda[k].sqrt() * z[k]).powi(2)).sum();
            assert!(value <= found.square * (1.0 + 1e-12));
        }
        let seeds = [(0..n).map(|k| 1.0 / (1.0 + k as f64)).collect()];
        alternatives(lambda, h, &found, &seeds, |value, beta| {
            let z2: f64 = lambda.iter().zip(beta).map(|(l, b)| l * b * b).sum();
            let square: f64 =
                lambda.iter().zip(beta).zip(h).map(|((l, b), h)| (h + l * b).powi(2)).sum();
            assert!((z2 - 1.0).abs() < 1e-9);
            assert!((square / value - 1.0).abs() < 1e-12);
            assert!(value <= found.square * (1.0 + 1e-12));
        });
    }

    #[test]
    fn the_farthest_point_is_found_where_it_is_hard() {
        check(&[1.0, 2.0, 3.0], &[0.3, -0.2, 0.1]);
        check(&[1.0, 2.0, 3.0], &[0.3, -0.2, 0.0]);
        check(&[1.0, 2.0, 3.0], &[0.3, -0.2, 1e-18]);
        check(&[1.0, 2.0, 3.0], &[5.0, 1.0, 0.0]);
        check(&[4.0, 4.0, 4.0], &[0.0, 0.0, 0.0]);
        check(&[4.0, 4.0, 1.0], &[0.0, 1e-9, 2.0]);
        check(&[1e-12, 0.0, 1.0], &[1e3, 2.0, 1e-3]);
        check(&[2.0], &[0.7]);
    }

    #[test]
    fn a_point_is_where_it_is() {
        assert_eq!(farthest(&[0.0, 0.0], &[3.0, 4.0]).square, 25.0);
    }
}
