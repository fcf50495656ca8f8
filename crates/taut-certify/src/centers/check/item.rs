//! The kinds of rows: a point, a ball, or a point with a weight, and the column that names their group.

use taut_points::Scalar;

use super::super::{CentersCertificate, CentersViolation};
use crate::{Items, Violation};

/// The way in which rows are to be read.
#[derive(Clone, Copy, Debug)]
pub(super) enum Kind {
    Points,
    Balls,
    Weighted,
}

/// The columns of a row.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layout {
    pub(super) kind: Kind,
    /// The column of the group, which is none of the item's.
    pub(super) group: Option<usize>,
    /// d.
    pub(super) dim: usize,
}

impl Layout {
    /// Returns what the certificate says rows are, if rows of so many columns can be that.
    pub(super) fn of(certificate: &CentersCertificate, columns: usize) -> Result<Self, Violation> {
        let Some(group) = certificate.group else {
            let kind = Kind::of(certificate, columns)?;
            return Ok(Layout { kind, group: None, dim: kind.dim(columns) });
        };
        let at = usize::try_from(group).ok().filter(|&group| group < columns && columns > 1);
        let Some(at) = at else {
            return Err(CentersViolation::GroupColumn { column: group, columns }.into());
        };
        let kind = Kind::of(certificate, columns - 1)?;
        Ok(Layout { kind, group: Some(at), dim: kind.dim(columns - 1) })
    }

    /// The numbers of a row that are its item's.
    pub(super) fn of_item<T: Scalar>(self, row: &[T]) -> Vec<T> {
        match self.group {
            None => row.to_vec(),
            Some(at) => [&row[..at], &row[at + 1..]].concat(),
        }
    }

    /// The group of a row, −0 as 0; none where each row stands for itself.
    pub(super) fn group_of<T: Scalar>(self, row: &[T]) -> Option<f64> {
        self.group.map(|at| row[at].into() + 0.0)
    }
}

/// Position p, radius r and weight w: the item reaches w·|p − c| + r from c. One of r = 0 and w = 1 always holds.
#[derive(Clone, Copy)]
pub(super) struct Item<'a, T> {
    pub(super) position: &'a [T],
    pub(super) radius: f64,
    pub(super) weight: f64,
}

impl Kind {
    /// Returns what the certificate says rows are, if rows of so many columns can be that.
    pub(super) fn of(certificate: &CentersCertificate, columns: usize) -> Result<Self, Violation> {
        match (certificate.items, certificate.weights) {
            (Items::Ellipsoids, _) => {
                let problem = "of which each is a group of its own";
                Err(CentersViolation::Ellipsoids { problem }.into())
            }
            (Items::Balls, true) => Err(CentersViolation::WeightsOfBalls.into()),
            (Items::Balls, false) if columns < 2 => Err(Violation::NoRadius { columns }),
            (Items::Points, true) if columns < 2 => {
                Err(CentersViolation::NoWeight { columns }.into())
            }
            (Items::Balls, false) => Ok(Kind::Balls),
            (Items::Points, true) => Ok(Kind::Weighted),
            (Items::Points, false) => Ok(Kind::Points),
        }
    }

    /// The dimension of rows of so many columns.
    pub(super) fn dim(self, columns: usize) -> usize {
        match self {
            Kind::Points => columns,
            Kind::Balls | Kind::Weighted => columns - 1,
        }
    }

    #[inline(always)]
    pub(super) fn item<T: Scalar>(self, row: &[T]) -> Item<'_, T> {
        match (self, row) {
            (Kind::Balls, [position @ .., r]) => {
                Item { position, radius: (*r).into(), weight: 1.0 }
            }
            (Kind::Weighted, [position @ .., w]) => {
                Item { position, radius: 0.0, weight: (*w).into() }
            }
            _ => Item { position: row, radius: 0.0, weight: 1.0 },
        }
    }

    /// Refuses rows that are no such item.
    pub(super) fn is_valid<T: Scalar>(self, number: u64, row: &[T]) -> Result<(), Violation> {
        for (column, &value) in row.iter().enumerate() {
            let value: f64 = value.into();
            if !value.is_finite() {
                return Err(Violation::NonFinite { row: number, column, value });
            }
        }
        let Item { radius, weight, .. } = self.item(row);
        if radius < 0.0 {
            return Err(Violation::NegativeRadius { row: number, value: radius });
        }
        if weight <= 0.0 {
            return Err(CentersViolation::Weight { row: number, value: weight }.into());
        }
        Ok(())
    }
}
