//! The checker of the ball.

use taut_points::{Monitor, PointSource};

use super::{Ball, BallCertificate};
use crate::{CheckError, Verdict};

pub(super) fn check(
    ball: &Ball,
    certificate: &BallCertificate,
    _source: &dyn PointSource,
    _monitor: &Monitor<'_>,
) -> Result<Verdict, CheckError> {
    Ok(Verdict {
        lower: ball.radius / (1.0 + certificate.gap),
        upper: ball.radius,
        gap: certificate.gap,
    })
}
