//! Not here yet.

use taut_points::{Monitor, PointSource};

use super::{Centers, CentersCertificate, CentersVerdict};
use crate::{CheckError, Violation};

pub(super) fn check(
    _centers: &Centers,
    _certificate: &CentersCertificate,
    _source: &dyn PointSource,
    _monitor: &Monitor<'_>,
) -> Result<CentersVerdict, CheckError> {
    Err(Violation::EmptySupport.into())
}
