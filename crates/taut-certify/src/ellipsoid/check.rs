//! The checker of the ellipsoid.

mod structure;

use taut_points::{Monitor, PointSource};

use super::{Ellipsoid, EllipsoidCertificate, EllipsoidVerdict};
use crate::{CheckError, Violation};

pub(super) fn check(
    ellipsoid: &Ellipsoid,
    certificate: &EllipsoidCertificate,
    source: &dyn PointSource,
    _monitor: &Monitor<'_>,
) -> Result<EllipsoidVerdict, CheckError> {
    structure::check(ellipsoid, certificate, source)?;
    Err(Violation::Gap { claimed: certificate.gap, proved: f64::INFINITY }.into())
}
