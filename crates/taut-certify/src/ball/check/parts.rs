//! The checker of the ball over some rows at a time: the same tests, and what each part finds put together.

use std::collections::BTreeMap;

use taut_points::{Monitor, Rows};

use super::super::{Ball, BallCertificate};
use super::enclosure::Enclosure;
use super::{lower_bound, structure, verdict};
use crate::hashed_pass::KeptRows;
use crate::parts::Findings;
use crate::{CheckError, Items, Verdict};

/// Refuses what is wrong without a look at the points, and ellipsoids, which are judged in memory.
pub(crate) fn check_structure(
    ball: &Ball,
    certificate: &BallCertificate,
    n: u64,
    columns: usize,
) -> Result<(), CheckError> {
    if certificate.items == Items::Ellipsoids {
        return Err(CheckError::NoParts { kind: "ball of ellipsoids" });
    }
    Ok(structure::check(ball, certificate, n, columns)?)
}

/// Finds the first fault of the rows of a block.
pub(crate) fn check_block(
    ball: &Ball,
    certificate: &BallCertificate,
    first: u64,
    rows: &Rows<'_>,
) -> Findings {
    match Enclosure::of(ball, certificate.items).block(first, rows) {
        Ok(outside) => Findings { outside, ..Findings::default() },
        Err(invalid) => Findings { invalid: Some(invalid), ..Findings::default() },
    }
}

/// The verdict over all rows, once nothing but the rows of the support is needed.
pub(crate) fn prove(
    ball: &Ball,
    certificate: &BallCertificate,
    support: &BTreeMap<u64, Vec<f64>>,
    columns: usize,
    monitor: &Monitor<'_>,
) -> Result<Verdict, CheckError> {
    let support = KeptRows::of(support, columns);
    let bound = lower_bound::prove(ball, certificate, &support, monitor)?;
    verdict(ball, certificate, &bound)
}
