//! The checker of the inscribed ellipsoid, in arithmetic of its own.
//!
//! *Frame.* y = G⁻¹(x − c) makes the answer the unit ball and a half-space {y : ãᵀy ≤ s}, ã = Gᵀa, s = b − aᵀc.
//! *Inside.* |ãᵢ| ≤ sᵢ for every row, with all roundings on the safe side: [`side`].
//! *Upper bound.* From the multipliers, by the inequality of means: [`gap`].
//! *Volume.* log |det G| is calculated here; what that may be off by widens the bracket at both ends.
//! *Reference.* The dual of Khachiyan and Todd, Math. Programming 61, 1993.

mod gap;
mod side;
mod structure;

use taut_points::{Monitor, PointSource, Rows};

use self::side::Side;
use super::{InscribedCertificate, InscribedEllipsoid, InscribedVerdict};
use crate::arithmetic::{Field, Ring, U};
use crate::ellipsoid::check::agreement::{self, LogVolume};
use crate::ellipsoid::check::frame::Frame;
use crate::hashed_pass::{KeptRows, WantedRows, all_finite, hashed_pass};
use crate::{CheckError, Ellipsoid, Violation};

/// The amount by which the gap claimed may fall short of the gap proved, relatively and for each dimension: as for ellipsoids.
const GAP_SLACK: (f64, f64) = (1e-9, 2e-15);

pub(super) fn check(
    answer: &InscribedEllipsoid,
    certificate: &InscribedCertificate,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<InscribedVerdict, CheckError> {
    structure::check(answer, certificate, source)?;
    let volume = log_volume(answer)?;
    monitor.pass(1, source.len());
    let support = inside(answer, certificate, source, monitor)?;
    let gap = gap::gap(answer, certificate, &support, monitor)?;
    let (relative, absolute) = GAP_SLACK;
    let dim = answer.center.len() as f64;
    let is_proved = gap <= certificate.gap * (1.0 + relative) + absolute * dim;
    if !is_proved {
        return Err(Violation::LogGap { claimed: certificate.gap, proved: gap }.into());
    }
    let LogVolume { value, error } = volume;
    let rounding = |other: f64| 4.0 * U * (value.abs() + error + other);
    let (lower, upper) = (value - (error + rounding(0.0)), value + (error + gap + rounding(gap)));
    Ok(InscribedVerdict { lower, upper, gap })
}

/// Compares log_volume with log |det G| and the logarithm of the unit ball; returns what is found here.
fn log_volume(answer: &InscribedEllipsoid) -> Result<LogVolume, Violation> {
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
    agreement::claimed_log_volume(claimed, &logs, dim, 0.0)
}

/// Proves that every half-space holds the ellipsoid; returns the rows of the support.
fn inside(
    answer: &InscribedEllipsoid,
    certificate: &InscribedCertificate,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<KeptRows, CheckError> {
    let wanted = WantedRows::of(&certificate.support);
    let claimed = certificate.points_hash;
    let (blocks, support) = hashed_pass(source, claimed, wanted, monitor, |first, rows| {
        all_finite(first, rows)?;
        Ok(block(answer, first, rows))
    })?;
    blocks.into_iter().collect::<Result<(), _>>()?;
    Ok(support)
}

fn block(answer: &InscribedEllipsoid, first: u64, rows: &Rows<'_>) -> Result<(), Violation> {
    let mut row = vec![0.0; answer.center.len() + 1];
    for i in 0..rows.len() {
        rows.copy_row(i, &mut row);
        let side = Side::of(answer, &row);
        let room = side.slack.minus(&side.length).rounded();
        let error = side.slack_error + side.normal_error;
        // An infinite room is an overflow, which proves nothing.
        let is_inside = room * (1.0 - 4.0 * U) >= error && room.is_finite()
            || row[..row.len() - 1].iter().all(|&a| a == 0.0) && row[row.len() - 1] >= 0.0;
        if !is_inside {
            return Err(Violation::OutsideHalfSpace { row: first + i as u64, excess: -room });
        }
    }
    Ok(())
}
