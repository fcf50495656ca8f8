//! Options to draw an answer.

use taut_points::shown_number;

use crate::number::gap;
use crate::{Axis, Error};

/// What captions say of an answer without a gap.
pub(crate) const NO_GAP: &str = "no gap is certified";

/// Options to draw. Write `DrawOptions { max_points: 5_000, ..Default::default() }`.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawOptions {
    /// Most items drawn, at least 1, default 20,000; the support of a ball is always drawn, and the caption names both
    /// counts.
    pub max_points: usize,
    /// Width of a figure, pixels, from 240 to 10,000, default 720.
    pub width: f64,
    /// Height of a figure without its caption, pixels, from 180 to 10,000, default 560; plots are lower.
    pub height: f64,
    /// Names of the columns, for the axes; where one is missing, x, y, z or the number of the column stands in.
    pub columns: Vec<String>,
    /// The gap that a checker proved for the answer, by default none: captions and plots tell it rather than the gap that the solver
    /// says, which they mark as such.
    pub proved_gap: Option<f64>,
}

impl Default for DrawOptions {
    fn default() -> Self {
        DrawOptions {
            max_points: 20_000,
            width: 720.0,
            height: 560.0,
            columns: Vec::new(),
            proved_gap: None,
        }
    }
}

impl DrawOptions {
    pub(crate) fn check(&self) -> Result<(), Error> {
        let wrong = |name, value: String, expected| Err(Error::Option { name, value, expected });
        if self.max_points == 0 {
            return wrong("max_points", "0".into(), "at least 1");
        }
        if !(240.0..=10_000.0).contains(&self.width) {
            return wrong("width", shown_number(self.width), "240 to 10,000");
        }
        if !(180.0..=10_000.0).contains(&self.height) {
            return wrong("height", shown_number(self.height), "180 to 10,000");
        }
        Ok(())
    }

    /// The gap to tell: the one that is proved, else the one that the solver says.
    pub(crate) fn gap(&self, claimed: f64) -> f64 {
        self.proved_gap.unwrap_or(claimed)
    }

    /// The gap in words, and who says so.
    pub(crate) fn gap_words(&self, name: &str, claimed: f64) -> String {
        match (self.gap(claimed), self.proved_gap) {
            (told, _) if !told.is_finite() => NO_GAP.to_owned(),
            (told, Some(_)) => format!("{name} {}, proved by the checker", gap(told)),
            (told, None) => format!("{name} {}, as the solver says", gap(told)),
        }
    }

    /// The axis of a column in a space of `dim` dimensions.
    pub(crate) fn axis(&self, column: usize, dim: usize) -> Axis {
        match self.columns.get(column) {
            Some(name) if !name.trim().is_empty() => Axis::named(name.trim()),
            _ if dim <= 3 => Axis::named(["x", "y", "z"][column]),
            _ => Axis::named(format!("column {column}")),
        }
    }
}
