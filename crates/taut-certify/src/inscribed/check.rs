//! The checker of the inscribed ellipsoid, in arithmetic of its own.
//!
//! *Frame.* y = G⁻¹(x − c) makes the answer the unit ball and a half-space {y : ãᵀy ≤ s}, ã = Gᵀa, s = b − aᵀc.
//! *Inside.* |ãᵢ| ≤ sᵢ for every row, with all roundings on the safe side.
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
//! *Reference.* The dual of Khachiyan and Todd, Math. Programming 61, 1993.

use taut_points::{
    BlockHash, Monitor, PointSource, PointsHash, ReadError, Rows, Scratch, hash_block, map_blocks,
};

use super::{InscribedCertificate, InscribedEllipsoid, InscribedVerdict};
use crate::arithmetic::{Compensated, DoubleDouble, Field, Ring, U, factorise};
use crate::ellipsoid::check::lower_bound::logarithm;
use crate::{CheckError, Violation};

/// How much the gap claimed may fall short of the gap proved, relatively and for each dimension: as for ellipsoids.
const GAP_SLACK: (f64, f64) = (1e-9, 2e-15);
/// What log_volume may be off by, for each dimension and each unit of the logarithms.
const LOG_SLACK: f64 = 64.0 * U;

pub(super) fn check(
    answer: &InscribedEllipsoid,
    certificate: &InscribedCertificate,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<InscribedVerdict, CheckError> {
    structure(answer, certificate, source)?;
    log_volume(answer)?;
    monitor.pass(1, source.len());
    inside(answer, certificate.points_hash, source, monitor)?;
    let gap = gap(answer, certificate, source, monitor)?;
    let (relative, absolute) = GAP_SLACK;
    let dim = answer.center.len() as f64;
    let is_proved = gap <= certificate.gap * (1.0 + relative) + absolute * dim;
    if !is_proved {
        return Err(Violation::LogGap { claimed: certificate.gap, proved: gap }.into());
    }
    let lower = answer.log_volume;
    Ok(InscribedVerdict { lower, upper: (lower + gap).next_up(), gap })
}

fn structure(
    answer: &InscribedEllipsoid,
    certificate: &InscribedCertificate,
    source: &dyn PointSource,
) -> Result<(), Violation> {
    let dim = source.dim().saturating_sub(1);
    let found = answer.center.len();
    if found != dim || dim == 0 {
        return Err(Violation::Dimension { found, expected: dim });
    }
    let length = |what, found, expected| match found == expected {
        true => Ok(()),
        false => Err(Violation::Length { what, found, expected }),
    };
    length("the list of axes", answer.axes.len(), dim)?;
    for row in &answer.axes {
        length("a row of the axes", row.len(), dim)?;
    }
    let numbers = answer.center.iter().chain(answer.axes.iter().flatten());
    if let Some(&value) = numbers.chain([&answer.log_volume]).find(|v| !v.is_finite()) {
        let what = "a number of the answer".into();
        return Err(Violation::Number { what, value, expected: "a finite number" });
    }
    let value = certificate.gap;
    if !(value >= 0.0 && value.is_finite()) {
        let what = "the claimed gap".into();
        return Err(Violation::Number { what, value, expected: "a finite number, at least 0" });
    }
    let InscribedCertificate { support, multipliers, .. } = certificate;
    if support.is_empty() {
        return Err(Violation::EmptySupport);
    }
    length("the list of multipliers", multipliers.len(), support.len())?;
    if let Some((position, &value)) =
        multipliers.iter().enumerate().find(|(_, v)| !(**v > 0.0 && v.is_finite()))
    {
        let what = format!("multiplier {position}");
        return Err(Violation::Number { what, value, expected: "a finite number above 0" });
    }
    for (position, &point) in support.iter().enumerate() {
        let problem = match position.checked_sub(1).map(|before| support[before]) {
            _ if point >= source.len() => "but there are not so many",
            Some(before) if before >= point => "which is no more than the entry before it",
            _ => continue,
        };
        return Err(Violation::Support { position, point, problem });
    }
    Ok(())
}

/// Whether log_volume is log |det G| and the logarithm of the unit ball, by elimination with column pivots.
fn log_volume(answer: &InscribedEllipsoid) -> Result<(), Violation> {
    let dim = answer.center.len();
    let mut rows: Vec<Vec<DoubleDouble>> =
        answer.axes.iter().map(|row| row.iter().map(|&v| DoubleDouble::of(v)).collect()).collect();
    let first = if dim.is_multiple_of(2) { 2 } else { 3 };
    let mut sum = if dim.is_multiple_of(2) { 0.0 } else { 2f64.ln() };
    let mut size = sum;
    for d in (first..=dim).step_by(2) {
        sum += (2.0 * std::f64::consts::PI / d as f64).ln();
        size += 1.0;
    }
    for k in 0..dim {
        let size_of = |i: usize| rows[i][k].rounded().abs();
        let pivot = (k..dim).max_by(|&a, &b| size_of(a).total_cmp(&size_of(b))).unwrap_or(k);
        rows.swap(k, pivot);
        let (above, below) = rows.split_at_mut(k + 1);
        let top = &above[k];
        let log = top[k].rounded().abs().ln();
        sum += log;
        size += log.abs();
        for row in below {
            let factor = row[k].over(&top[k]);
            for j in k..dim {
                row[j] = row[j].minus(&factor.times(&top[j]));
            }
        }
    }
    let claimed = answer.log_volume;
    let is_volume = (sum - claimed).abs() <= LOG_SLACK * (dim as f64 + size);
    if is_volume { Ok(()) } else { Err(Violation::LogVolume { claimed, found: sum }) }
}

/// One half-space in the frame.
struct Side {
    /// ã.
    normal: Vec<DoubleDouble>,
    /// |ã|.
    length: DoubleDouble,
    /// s.
    slack: DoubleDouble,
    /// What ã in length and s are off by.
    normal_error: f64,
    slack_error: f64,
}

impl Side {
    fn of(answer: &InscribedEllipsoid, row: &[f64]) -> Self {
        let dim = answer.center.len();
        let zero = DoubleDouble::of(0.0);
        let rounding = 4.0 * (dim + 8) as f64 * DoubleDouble::ROUNDOFF;
        let mut normal = vec![zero; dim];
        let mut sizes = 0.0;
        let mut slack = DoubleDouble::of(row[dim]);
        let mut size = row[dim].abs();
        for (j, axes) in answer.axes.iter().enumerate() {
            let a = DoubleDouble::of(row[j]);
            for (sum, &g) in normal.iter_mut().zip(axes) {
                *sum = sum.plus(&a.times(&DoubleDouble::of(g)));
                sizes += (row[j] * g).abs();
            }
            slack = slack.minus(&a.times(&DoubleDouble::of(answer.center[j])));
            size += (row[j] * answer.center[j]).abs();
        }
        let square = normal.iter().fold(zero, |sum, v| sum.plus(&v.times(v)));
        let length = if square.rounded() > 0.0 { square.root() } else { zero };
        let normal_error = rounding * (sizes + length.rounded()) + f64::MIN_POSITIVE;
        let slack_error = rounding * size + f64::MIN_POSITIVE;
        Side { normal, length, slack, normal_error, slack_error }
    }
}

fn inside(
    answer: &InscribedEllipsoid,
    claimed: PointsHash,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<(), CheckError> {
    let blocks = map_blocks(source, monitor, |first, rows| {
        if let Some((row, column, value)) = rows.first_non_finite() {
            let row = first + row as u64;
            return Err(CheckError::from(Violation::NonFinite { row, column, value }));
        }
        Ok((hash_block(&rows), block(answer, first, &rows)))
    })?;
    let hashes: Vec<BlockHash> = blocks.iter().map(|block| block.0).collect();
    let found = PointsHash::of_blocks(source.len(), source.dim(), hashes);
    if found != claimed {
        let (claimed, found) = (claimed.to_string(), found.to_string());
        return Err(Violation::Hash { claimed, found }.into());
    }
    blocks.into_iter().try_for_each(|block| block.1)?;
    Ok(())
}

fn block(answer: &InscribedEllipsoid, first: u64, rows: &Rows<'_>) -> Result<(), Violation> {
    let mut row = vec![0.0; answer.center.len() + 1];
    for i in 0..rows.len() {
        rows.copy_row(i, &mut row);
        let side = Side::of(answer, &row);
        let room = side.slack.minus(&side.length).rounded();
        let is_inside = room * (1.0 - 4.0 * U) >= side.slack_error + side.normal_error
            || side.length.rounded() == 0.0
                && row[..row.len() - 1].iter().all(|&a| a == 0.0)
                && row[row.len() - 1] >= 0.0;
        if !is_inside {
            return Err(Violation::OutsideHalfSpace { row: first + i as u64, excess: -room });
        }
    }
    Ok(())
}

/// By how much the log-volume of an ellipsoid in the polytope can exceed that of the answer.
fn gap(
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
