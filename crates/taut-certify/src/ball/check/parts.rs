//! The checker of the ball over some rows at a time: the same tests, and what each part finds put together.

use std::collections::BTreeMap;

use taut_points::{ByteReader, ByteWriter, Monitor, PartsError, Rows};

use super::super::{Ball, BallCertificate};
use super::enclosure::Enclosure;
use super::{lower_bound, structure, verdict};
use crate::hashed_pass::{KeptRows, WantedRows};
use crate::{CheckError, Items, Verdict, Violation};

/// What is wrong with the rows of a part.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Faults {
    /// The first row that is no point or ball.
    invalid: Option<Violation>,
    /// The first row outside.
    outside: Option<Violation>,
}

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

/// The rows that the verdict will need.
pub(crate) fn wanted(certificate: &BallCertificate) -> WantedRows {
    WantedRows::of(&certificate.support)
}

/// What is wrong with the rows of a block.
pub(crate) fn check_block(
    ball: &Ball,
    certificate: &BallCertificate,
    first: u64,
    rows: &Rows<'_>,
) -> Faults {
    match Enclosure::of(ball, certificate.items).block(first, rows) {
        Ok(outside) => Faults { invalid: None, outside },
        Err(invalid) => Faults { invalid: Some(invalid), outside: None },
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

impl Faults {
    /// Those of these rows and of others: the first of each kind.
    pub(crate) fn merge(self, other: Self) -> Self {
        let first =
            |a: Option<Violation>, b: Option<Violation>| a.into_iter().chain(b).min_by_key(row_of);
        Faults {
            invalid: first(self.invalid, other.invalid),
            outside: first(self.outside, other.outside),
        }
    }

    /// Rows that are none are refused before it is asked whether they are the right ones.
    pub(crate) fn refuse_invalid(&self) -> Result<(), Violation> {
        self.invalid.clone().map_or(Ok(()), Err)
    }

    pub(crate) fn refuse_outside(&self) -> Result<(), Violation> {
        self.outside.clone().map_or(Ok(()), Err)
    }

    pub(crate) fn write(&self, bytes: &mut ByteWriter) {
        for fault in [&self.invalid, &self.outside] {
            match *fault {
                Some(Violation::NonFinite { row, column, value }) => {
                    for number in [1, row, column as u64] {
                        bytes.whole(number);
                    }
                    bytes.float(value);
                }
                Some(Violation::NegativeRadius { row, value }) => {
                    for number in [2, row] {
                        bytes.whole(number);
                    }
                    bytes.float(value);
                }
                Some(Violation::Outside { row, distance, radius, excess }) => {
                    for number in [3, row] {
                        bytes.whole(number);
                    }
                    for number in [distance, radius, excess] {
                        bytes.float(number);
                    }
                }
                _ => bytes.whole(0),
            }
        }
    }

    pub(crate) fn read(bytes: &mut ByteReader<'_>) -> Result<Self, PartsError> {
        let mut fault = || -> Result<Option<Violation>, PartsError> {
            Ok(Some(match bytes.whole()? {
                0 => return Ok(None),
                1 => Violation::NonFinite {
                    row: bytes.whole()?,
                    column: bytes.size()?,
                    value: bytes.float()?,
                },
                2 => Violation::NegativeRadius { row: bytes.whole()?, value: bytes.float()? },
                3 => Violation::Outside {
                    row: bytes.whole()?,
                    distance: bytes.float()?,
                    radius: bytes.float()?,
                    excess: bytes.float()?,
                },
                _ => return Err(bytes.wrong()),
            }))
        };
        Ok(Faults { invalid: fault()?, outside: fault()? })
    }
}

/// The row that a fault is about.
fn row_of(fault: &Violation) -> u64 {
    match *fault {
        Violation::NonFinite { row, .. }
        | Violation::NegativeRadius { row, .. }
        | Violation::Outside { row, .. } => row,
        _ => u64::MAX,
    }
}
