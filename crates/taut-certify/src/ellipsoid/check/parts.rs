//! The checker of the ellipsoid over some points at a time: the same tests, and what each part finds put together.

use std::collections::BTreeMap;

use taut_points::{Monitor, Rows};

use super::super::{Ellipsoid, EllipsoidCertificate, EllipsoidVerdict};
use super::enclosure::{Enclosed, Enclosure};
use super::frame::Frame;
use super::{Stated, agreement, conclude, structure};
use crate::hashed_pass::KeptRows;
use crate::parts::Findings;
use crate::{CheckError, Items};

/// Refuses what is wrong without a look at the points, and what is judged over all of them: other items, flats, points left out.
pub(crate) fn check_structure(
    ellipsoid: &Ellipsoid,
    certificate: &EllipsoidCertificate,
    n: u64,
    columns: usize,
) -> Result<(), CheckError> {
    if certificate.items != Items::Points {
        return Err(CheckError::NoParts { kind: "ellipsoid of balls or ellipsoids" });
    }
    if ellipsoid.hull.is_some() {
        return Err(CheckError::NoParts { kind: "ellipsoid in a flat" });
    }
    if !certificate.left_out.is_empty() {
        return Err(CheckError::NoParts { kind: "ellipsoid with points left out" });
    }
    structure::check(ellipsoid, certificate, n, columns)?;
    let frame = Frame::of(ellipsoid);
    agreement::matrix(ellipsoid, &frame)?;
    agreement::log_volume(ellipsoid, &frame)?;
    Ok(())
}

/// Finds the first fault of the points of a block, and how far they reach.
pub(crate) fn check_block(
    ellipsoid: &Ellipsoid,
    certificate: &EllipsoidCertificate,
    first: u64,
    rows: &Rows<'_>,
) -> Findings {
    let frame = Frame::of(ellipsoid);
    match Enclosure::of(&frame, None, certificate).valid_block(first, rows) {
        Err(invalid) => Findings { invalid: Some(invalid), ..Findings::default() },
        Ok(Err(outside)) => Findings { outside: Some(outside), ..Findings::default() },
        Ok(Ok(Enclosed { excess, extents, .. })) => {
            Findings { excess, extents, ..Findings::default() }
        }
    }
}

/// The verdict over all points, once nothing but those of the support is needed.
pub(crate) fn prove(
    ellipsoid: &Ellipsoid,
    certificate: &EllipsoidCertificate,
    findings: &Findings,
    support: &BTreeMap<u64, Vec<f64>>,
    columns: usize,
    monitor: &Monitor<'_>,
) -> Result<EllipsoidVerdict, CheckError> {
    let frame = Frame::of(ellipsoid);
    let difference = agreement::matrix(ellipsoid, &frame)?;
    let log_volume = agreement::log_volume(ellipsoid, &frame)?;
    let stated = Stated { frame: &frame, difference, log_volume };
    let enclosed = Enclosed::of(findings.excess, findings.extents.clone());
    let support = KeptRows::of(support, columns);
    conclude(certificate, &stated, &enclosed, &support, monitor)
}
