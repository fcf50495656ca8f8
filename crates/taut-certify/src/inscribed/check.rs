//! The checker of the inscribed ellipsoid, in arithmetic of its own.
//!
//! *Frame.* y = G⁻¹(x − c) makes the answer the unit ball and a half-space {y : ãᵀy ≤ s}, ã = Gᵀa, s = b − aᵀc.
//! *Inside.* |ãᵢ| ≤ sᵢ for every row, with all roundings on the safe side: [`side`].
//! *Upper bound.* From the multipliers, by the inequality of means: [`gap`].
//! *Volume.* log |det G| is calculated anew, and what that may be off by is added to the bound.
//! *Reference.* The dual of Khachiyan and Todd, Math. Programming 61, 1993.

mod gap;
mod side;
mod structure;

use taut_points::{BlockHash, Monitor, PointSource, PointsHash, Rows, hash_block, map_blocks};

use self::side::Side;
use super::{InscribedCertificate, InscribedEllipsoid, InscribedVerdict};
use crate::arithmetic::{Field, Ring, U};
use crate::ellipsoid::check::agreement;
use crate::ellipsoid::check::frame::Frame;
use crate::{CheckError, Ellipsoid, Violation};

/// How much the gap claimed may fall short of the gap proved, relatively and for each dimension: as for ellipsoids.
const GAP_SLACK: (f64, f64) = (1e-9, 2e-15);

pub(super) fn check(
    answer: &InscribedEllipsoid,
    certificate: &InscribedCertificate,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<InscribedVerdict, CheckError> {
    structure::check(answer, certificate, source)?;
    let most = log_volume(answer)?;
    monitor.pass(1, source.len());
    inside(answer, certificate.points_hash, source, monitor)?;
    let gap = gap::gap(answer, certificate, source, monitor)?;
    let (relative, absolute) = GAP_SLACK;
    let dim = answer.center.len() as f64;
    let is_proved = gap <= certificate.gap * (1.0 + relative) + absolute * dim;
    if !is_proved {
        return Err(Violation::LogGap { claimed: certificate.gap, proved: gap }.into());
    }
    let lower = answer.log_volume;
    Ok(InscribedVerdict { lower, upper: (most + gap).next_up(), gap })
}

/// Whether log_volume is log |det G| and the logarithm of the unit ball; returns what the volume is at most.
fn log_volume(answer: &InscribedEllipsoid) -> Result<f64, Violation> {
    let dim = answer.center.len();
    let claimed = answer.log_volume;
    // G takes the place of a factor: its determinant is asked for, and nothing else.
    let ellipsoid = Ellipsoid {
        center: answer.center.clone(),
        center_tail: vec![],
        matrix: vec![],
        factor: answer.axes.clone(),
        hull: None,
        log_volume: claimed,
    };
    let frame = Frame::of(&ellipsoid);
    let singular = Violation::LogVolume { claimed, found: f64::NEG_INFINITY };
    let mut logs = agreement::log_determinant(None, &frame).ok_or(singular)?;
    logs.extend(agreement::log_unit_ball(dim));
    logs.push(dim as f64 * frame.scale.ln());
    let size: f64 = logs.iter().map(|l| l.abs()).sum();
    let found: f64 = logs.iter().sum();
    let tolerance = 32.0 * U * (size + dim as f64);
    let agrees = (found - claimed).abs() <= tolerance && tolerance.is_finite();
    if agrees {
        Ok(claimed.max(found + tolerance))
    } else {
        Err(Violation::LogVolume { claimed, found })
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
            || row[..row.len() - 1].iter().all(|&a| a == 0.0) && row[row.len() - 1] >= 0.0;
        if !is_inside {
            return Err(Violation::OutsideHalfSpace { row: first + i as u64, excess: -room });
        }
    }
    Ok(())
}
