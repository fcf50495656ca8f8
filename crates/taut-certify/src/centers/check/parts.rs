//! The checker of centers over some rows at a time: the same tests, and what each part finds put together.

use std::collections::BTreeMap;

use taut_points::{Monitor, Rows};

use super::super::{Centers, CentersCertificate, CentersVerdict};
use super::enclosure::Enclosure;
use super::item::Layout;
use super::structure::Reading;
use super::{conclude, structure};
use crate::hashed_pass::KeptRows;
use crate::parts::Findings;
use crate::{CheckError, Items, Violation};

/// The kind of answers whose proof looks at all rows once more.
pub(super) const AMONG_ROWS: &str = "centers whose bound holds among the rows alone";

/// Refuses what is wrong without a look at the rows, and what is judged over all of them at once.
pub(crate) fn check_structure(
    answer: &Centers,
    certificate: &CentersCertificate,
    n: u64,
    columns: usize,
) -> Result<(), CheckError> {
    let kind = match () {
        () if certificate.items == Items::Ellipsoids => "centers of ellipsoids",
        () if certificate.weights => "centers of points with weights",
        () if certificate.group.is_some() => "centers of groups",
        () if !answer.assignment.is_empty() => "centers with an assignment",
        () => return Ok(structure::check(answer, certificate, n, columns).map(|_| ())?),
    };
    Err(CheckError::NoParts { kind })
}

/// Finds the first fault of the rows of a block.
pub(crate) fn check_block(
    answer: &Centers,
    certificate: &CentersCertificate,
    columns: usize,
    first: u64,
    rows: &Rows<'_>,
    monitor: &Monitor<'_>,
) -> Result<Findings, CheckError> {
    let layout = Layout::of(certificate, columns)?;
    match Enclosure::of(answer, layout.kind).block(first, rows, monitor) {
        Ok(outside) => {
            Ok(Findings { outside: outside.map(Violation::from), ..Findings::default() })
        }
        Err(CheckError::Rejected(invalid)) => {
            Ok(Findings { invalid: Some(invalid), ..Findings::default() })
        }
        Err(other) => Err(other),
    }
}

/// The verdict over all rows, once nothing but those that the certificate and the answer name is needed.
pub(crate) fn prove(
    answer: &Centers,
    certificate: &CentersCertificate,
    rows: &BTreeMap<u64, Vec<f64>>,
    n: u64,
    columns: usize,
    monitor: &Monitor<'_>,
) -> Result<CentersVerdict, CheckError> {
    let (Reading::Items(layout), gap) = structure::check(answer, certificate, n, columns)? else {
        return Err(CheckError::NoParts { kind: "centers of ellipsoids" });
    };
    let kept = KeptRows::of(rows, columns);
    let branches = conclude(answer, certificate, layout, &kept, columns, None, monitor)?;
    let (lower, upper) = (answer.lower_bound, answer.radius);
    Ok(CentersVerdict { lower, upper, gap, branches })
}
