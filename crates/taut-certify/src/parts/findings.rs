//! The findings of a checker in some rows, and how they merge with those in others.

use taut_points::{ByteReader, ByteWriter, PartsError};

use crate::{CentersViolation, Violation};

/// The first rows that are wrong, and how far rows reach.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Findings {
    /// The first row that is no point or ball.
    pub(crate) invalid: Option<Violation>,
    /// The first row outside.
    pub(crate) outside: Option<Violation>,
    /// By how much rows reach outside an ellipsoid at worst, of what is granted.
    pub(crate) excess: f64,
    /// How far they reach from its center, by coordinate; empty where nobody asks.
    pub(crate) extents: Vec<f64>,
}

impl Findings {
    /// Those of these rows and of others: the first fault of each kind, and the largest numbers.
    pub(crate) fn merge(self, other: Self) -> Self {
        let first =
            |a: Option<Violation>, b: Option<Violation>| a.into_iter().chain(b).min_by_key(row_of);
        let (mut extents, more) = if self.extents.len() >= other.extents.len() {
            (self.extents, other.extents)
        } else {
            (other.extents, self.extents)
        };
        extents.iter_mut().zip(more).for_each(|(extent, other)| *extent = extent.max(other));
        Findings {
            invalid: first(self.invalid, other.invalid),
            outside: first(self.outside, other.outside),
            excess: self.excess.max(other.excess),
            extents,
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
            write_fault(fault.as_ref(), bytes);
        }
        bytes.float(self.excess);
        bytes.floats(&self.extents);
    }

    pub(crate) fn read(bytes: &mut ByteReader<'_>) -> Result<Self, PartsError> {
        Ok(Findings {
            invalid: read_fault(bytes)?,
            outside: read_fault(bytes)?,
            excess: bytes.float()?,
            extents: bytes.floats()?,
        })
    }
}

/// The number of faults that have no form in bytes; readers know it as little as any other.
const OTHER_FAULT: u64 = 6;

fn write_fault(fault: Option<&Violation>, bytes: &mut ByteWriter) {
    let (kind, row, column, numbers): (u64, u64, usize, [f64; 3]) = match fault {
        Some(&Violation::NonFinite { row, column, value }) => (1, row, column, [value, 0.0, 0.0]),
        Some(&Violation::NegativeRadius { row, value }) => (2, row, 0, [value, 0.0, 0.0]),
        Some(&Violation::Outside { row, distance, radius, excess }) => {
            (3, row, 0, [distance, radius, excess])
        }
        Some(&Violation::OutsideEllipsoid { row, norm, excess }) => {
            (4, row, 0, [norm, excess, 0.0])
        }
        Some(&Violation::Centers(CentersViolation::Outside {
            row,
            center,
            distance,
            radius,
            excess,
        })) => (5, row, center, [distance, radius, excess]),
        None => (0, 0, 0, [0.0; 3]),
        // No faults of rows: whoever reads them refuses the bytes, and does not take them for none.
        Some(_) => (OTHER_FAULT, 0, 0, [0.0; 3]),
    };
    bytes.whole(kind);
    bytes.whole(row);
    bytes.count(column);
    numbers.into_iter().for_each(|number| bytes.float(number));
}

fn read_fault(bytes: &mut ByteReader<'_>) -> Result<Option<Violation>, PartsError> {
    let (kind, row, column) = (bytes.whole()?, bytes.whole()?, bytes.size()?);
    let [a, b, c] = [bytes.float()?, bytes.float()?, bytes.float()?];
    Ok(match kind {
        0 => None,
        1 => Some(Violation::NonFinite { row, column, value: a }),
        2 => Some(Violation::NegativeRadius { row, value: a }),
        3 => Some(Violation::Outside { row, distance: a, radius: b, excess: c }),
        4 => Some(Violation::OutsideEllipsoid { row, norm: a, excess: b }),
        5 => {
            let (center, distance, radius, excess) = (column, a, b, c);
            Some(CentersViolation::Outside { row, center, distance, radius, excess }.into())
        }
        _ => return Err(bytes.wrong()),
    })
}

/// The row that a fault is about.
fn row_of(fault: &Violation) -> u64 {
    match *fault {
        Violation::NonFinite { row, .. }
        | Violation::NegativeRadius { row, .. }
        | Violation::Outside { row, .. }
        | Violation::OutsideEllipsoid { row, .. }
        | Violation::Centers(CentersViolation::Outside { row, .. }) => row,
        _ => u64::MAX,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_without_a_form_in_bytes_is_not_taken_for_none() {
        let fault = Violation::Hash { claimed: String::new(), found: String::new() };
        for (outside, is_readable) in [(None, true), (Some(fault), false)] {
            let mut bytes = ByteWriter::new("test");
            Findings { outside, ..Findings::default() }.write(&mut bytes);
            let bytes = bytes.into_bytes();
            let read = Findings::read(&mut ByteReader::new("test", &bytes).unwrap());
            assert_eq!(read.is_ok(), is_readable);
        }
    }
}
