//! The checker of curves.

pub(super) mod tour;

use taut_points::{Monitor, PointSource, hash_points};

use super::{Curve, CurveCertificate, CurveVerdict};
use crate::{CheckError, Violation};

pub(super) fn check(
    _curve: &Curve,
    certificate: &CurveCertificate,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<CurveVerdict, CheckError> {
    let found = hash_points(source, monitor)?;
    if found != certificate.points_hash {
        let claimed = certificate.points_hash.to_string();
        return Err(Violation::Hash { claimed, found: found.to_string() }.into());
    }
    Ok(CurveVerdict { band: certificate.band, certified: false })
}
