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

use taut_points::{Monitor, PointSource, ReadError, Scratch};

use super::super::{InscribedCertificate, InscribedEllipsoid};
use super::side::Side;
use crate::CheckError;
use crate::arithmetic::{Compensated, DoubleDouble, Field, Ring, U, factorise};
use crate::ellipsoid::check::lower_bound::logarithm;

/// By how much the log-volume of an ellipsoid in the polytope can exceed that of the answer.
pub(super) fn gap(
    answer: &InscribedEllipsoid,
    certificate: &InscribedCertificate,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<f64, CheckError> {
    let dim = answer.center.len();
    let zero = DoubleDouble::of(0.0);
    let mut rest = vec![zero; dim];
    let mut matrix = vec![zero; dim * (dim + 1) / 2];
    let mut beta = zero;
    let (mut delta, mut size, mut error) = (0.0, 0.0, 0.0);
    let mut row = vec![0.0; dim + 1];
    let mut scratch = Scratch::new();
    for (&id, &lambda) in certificate.support.iter().zip(&certificate.multipliers) {
        monitor.check().map_err(ReadError::from)?;
        source.read(id..id + 1, &mut scratch)?.copy_row(0, &mut row);
        let side = Side::of(answer, &row);
        if side.length.rounded() <= 1e6 * side.normal_error {
            continue;
        }
        let weight = DoubleDouble::of(lambda);
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
    let trace = (0..dim).fold(zero, |sum, a| sum.plus(&matrix[a * (a + 3) / 2]));
    let has_matrix = trace.rounded() > 0.0;
    if !has_matrix {
        return Ok(f64::INFINITY);
    }
    // λ is scaled so that tr W = d; what is off is off by this much then.
    let tau = trace.over(&DoubleDouble::of(dim as f64));
    let unit = tau.rounded();
    let roundings = 8.0 * (certificate.support.len() + 4 * dim + 64) as f64;
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
    if !factorise(&mut matrix, dim) {
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
    Ok(if gap.is_nan() { f64::INFINITY } else { gap.max(0.0) })
}
