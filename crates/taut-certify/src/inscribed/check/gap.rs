//! By how much an ellipsoid in the polytope can exceed the answer, from the multipliers.
//!
//! *Upper bound.* Let {w + Bz : |z| ≤ 1} lie in the polytope, in the frame and with B symmetric. Its point w + Bãᵢ/|ãᵢ| has
//! ãᵢᵀw + ãᵢᵀBãᵢ/|ãᵢ| ≤ sᵢ; summed with weights λᵢ, with r = Σλᵢãᵢ, β = Σλᵢsᵢ and W = Σλᵢãᵢãᵢᵀ/|ãᵢ|, it is rᵀw + tr(BW) ≤ β. As
//! tr(BW) ≥ d·(det B·det W)^(1/d), for λ scaled so that tr W = d,
//!
//! > log det B ≤ d·log((β + |r||w|)/d) − log det W.
//!
//! *The rest r.* It is 0 but for rounding, and |w| is bounded: with nᵢ = |ãᵢ| and tᵢ = ãᵢᵀw, both sᵢ − tᵢ and nᵢ|w| + tᵢ are at
//! least 0; the sum of λᵢ/nᵢ times their products gives, with ω the least eigenvalue of W and δ = Σλᵢ|sᵢ − nᵢ|,
//! (ω − |r|)·|w| ≤ β + |r| + δ. And ω ≥ 1 − ‖W − I‖.
//! *Rounding.* Sums in doubled precision of k numbers, each formed from 4d or so, of sizes that are summed up beside them.
//! *Scale.* A half-space and its multiplier mean the same as (2⁻ᵏã, 2⁻ᵏs) and 2ᵏλ, and so do all multipliers times one number.
//! Each |ã| is brought to [1, 2) and the largest multiplier too, by powers of two. So sums neither over- nor underflow,
//! whatever range an answer and its multipliers were written in.
//! *Trap.* Any multipliers that are not negative prove a bound, so those below 2⁻³⁰⁰ of the largest count as 0. Had they
//! been taken as they stand, products of subnormal numbers would vanish, and with them the bounds on their rounding.

use taut_points::{Monitor, ReadError};

use super::super::{InscribedCertificate, InscribedEllipsoid};
use super::side::{Side, exponent};
use crate::CheckError;
use crate::arithmetic::{Compensated, DoubleDouble, Field, Ring, U, factorize};
use crate::ellipsoid::check::lower_bound::logarithm;
use crate::hashed_pass::KeptRows;

/// Multipliers below 2 to this of the largest count as 0.
const LEAST_EXPONENT: i32 = -300;

/// Between which values the trace of W lies, for k multipliers of at most 2 of which the largest is at least 1 and sides
/// of lengths in [1, 2): 1 ≤ tr W < 4k, with room for rounding.
const TRACE_RANGE: std::ops::Range<f64> = 0.5..f64::from_bits((1023 + 100) << 52);

/// λ = m·2ᵉ with m in [1, 2), for λ > 0, subnormal numbers included.
fn parts(lambda: f64) -> (f64, i32) {
    const SCALE_EXPONENT: i32 = 64;
    let (lambda, shift) = match lambda < f64::MIN_POSITIVE {
        true => (lambda * 2f64.powi(SCALE_EXPONENT), SCALE_EXPONENT),
        false => (lambda, 0),
    };
    let e = exponent(lambda);
    (lambda * 2f64.powi(-(e / 2)) * 2f64.powi(-(e - e / 2)), e - shift)
}

/// The sides of the support of length in [1, 2), each with its multiplier, the largest of which is in [1, 2).
fn weighted_sides(
    answer: &InscribedEllipsoid,
    certificate: &InscribedCertificate,
    support: &KeptRows,
    monitor: &Monitor<'_>,
) -> Result<Vec<(f64, Side)>, CheckError> {
    let mut sides = Vec::with_capacity(certificate.support.len());
    let mut largest = i32::MIN;
    for (&id, &lambda) in certificate.support.iter().zip(&certificate.multipliers) {
        monitor.check().map_err(ReadError::from)?;
        let Some((k, side)) = Side::of(answer, support.row(id)).normalized() else { continue };
        let (mantissa, e) = parts(lambda);
        largest = largest.max(e + k);
        sides.push((mantissa, e + k, side));
    }
    let counts = sides.into_iter().filter(|(_, e, _)| e - largest >= LEAST_EXPONENT);
    Ok(counts.map(|(m, e, side)| (m * 2f64.powi(e - largest), side)).collect())
}

/// By how much the log-volume of an ellipsoid in the polytope can exceed that of the answer.
pub(super) fn gap(
    answer: &InscribedEllipsoid,
    certificate: &InscribedCertificate,
    support: &KeptRows,
    monitor: &Monitor<'_>,
) -> Result<f64, CheckError> {
    let dim = answer.center.len();
    let zero = DoubleDouble::of(0.0);
    let mut rest = vec![zero; dim];
    let mut matrix = vec![zero; dim * (dim + 1) / 2];
    let mut beta = zero;
    let (mut delta, mut size, mut error) = (0.0, 0.0, 0.0);
    let sides = weighted_sides(answer, certificate, support, monitor)?;
    for (lambda, side) in &sides {
        let weight = DoubleDouble::of(*lambda);
        let mut squares = matrix.iter_mut();
        for (a, normal) in side.normal.iter().enumerate() {
            let term = weight.times(normal);
            rest[a] = rest[a].plus(&term);
            let term = term.over(&side.length);
            for (other, square) in side.normal[..=a].iter().zip(&mut squares) {
                *square = square.plus(&term.times(other));
            }
        }
        beta = beta.plus(&weight.times(&side.slack));
        delta += lambda * (side.slack.minus(&side.length).rounded().abs() + side.slack_error);
        size += lambda * (side.length.rounded() + side.slack.rounded().abs());
        error += lambda * (4.0 * side.normal_error + side.slack_error);
    }
    // The loss of products of entries far below the length of their side.
    error += (sides.len() * (dim + 2) * (dim + 2)) as f64 * f64::MIN_POSITIVE;
    let trace = (0..dim).fold(zero, |sum, a| sum.plus(&matrix[a * (a + 3) / 2]));
    if !TRACE_RANGE.contains(&trace.rounded()) {
        return Ok(f64::INFINITY);
    }
    // λ is scaled so that tr W = d; what is off is off by this much then.
    let tau = trace.over(&DoubleDouble::of(dim as f64));
    let unit = tau.rounded();
    let roundings = 8.0 * (sides.len() + 4 * dim + 64) as f64;
    let off =
        (roundings * DoubleDouble::ROUNDOFF * size * dim as f64 + error) / unit * (1.0 + 64.0 * U);
    let mut norm = Compensated::default();
    for a in 0..dim {
        for b in 0..=a {
            let at = a * (a + 1) / 2 + b;
            matrix[at] = matrix[at].over(&tau);
            let beside = if a == b { matrix[at].minus(&DoubleDouble::of(1.0)) } else { matrix[at] };
            let square = beside.rounded() * beside.rounded();
            norm.add(if a == b { square } else { 2.0 * square });
        }
    }
    let norm = norm.known().size().sqrt() * (1.0 + 16.0 * U) + off;
    let square: f64 = rest.iter().map(|r| r.rounded() * r.rounded()).sum();
    let rest = square.sqrt() / unit * (1.0 + (dim + 16) as f64 * U) + off;
    let beta = beta.over(&tau);
    let least = 1.0 - norm - rest;
    let is_near_optimal = least > 0.0;
    if !is_near_optimal {
        return Ok(f64::INFINITY);
    }
    let far =
        (beta.rounded() + rest + delta / unit * (1.0 + 64.0 * U) + off) / least * (1.0 + 16.0 * U);
    for a in 0..dim {
        let at = a * (a + 3) / 2;
        matrix[at] = matrix[at].minus(&DoubleDouble::of(off));
    }
    if !factorize(&mut matrix, dim) {
        return Ok(f64::INFINITY);
    }
    let (mut logs, mut sizes) = (0.0, 0.0);
    for a in 0..dim {
        let term = logarithm(&matrix[a * (a + 3) / 2]);
        logs += term;
        sizes += term.abs();
    }
    let d = dim as f64;
    let beyond = beta.minus(&DoubleDouble::of(d)).rounded() + off + rest * far;
    let grown = d * (beyond / d).ln_1p();
    let gap = grown - logs + (dim + 16) as f64 * U * (sizes + grown.abs());
    Ok(if gap.is_finite() { gap.max(0.0) } else { f64::INFINITY })
}
