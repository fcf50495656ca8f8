//! Lists of rows, compared with distances row by row.

use crate::Violation;

/// States whether a row is in an ascending list, asked for ascending rows.
pub(super) struct Cursor<'a> {
    rows: &'a [u64],
}

impl<'a> Cursor<'a> {
    pub(super) fn from(rows: &'a [u64], first: u64) -> Self {
        Cursor { rows: &rows[rows.partition_point(|&row| row < first)..] }
    }

    pub(super) fn names(&mut self, row: u64) -> bool {
        let found = self.rows.first() == Some(&row);
        if found {
            self.rows = &self.rows[1..];
        }
        found
    }
}

/// Refuses a list that does not name a row just when it lies beyond the border, at 1. NaN is on neither side.
pub(super) fn compare(
    list: &'static str,
    is_listed: bool,
    row: u64,
    distance: f64,
    slack: f64,
) -> Result<(), Violation> {
    let (is_inside, is_outside) = (distance <= 1.0 + slack, distance >= 1.0 - slack);
    if !is_listed && !is_inside {
        return Err(lacks(list, row, distance));
    }
    if is_listed && !is_outside {
        return Err(Violation::Listed { list, problem: "names", row, distance });
    }
    Ok(())
}

pub(super) fn lacks(list: &'static str, row: u64, distance: f64) -> Violation {
    Violation::Listed { list, problem: "lacks", row, distance }
}
