//! From a path to points.

use std::path::Path;

use taut_points::PointSource;

use crate::{Error, Format, Place, ReadOptions};

/// Points of a file, and what is known of it.
pub struct Input {
    /// The points. They keep any temporary file alive.
    pub source: Box<dyn PointSource>,
    /// A name for each coordinate; empty where the file has none.
    pub columns: Vec<String>,
    /// The format that was read.
    pub format: Format,
    /// The file as shown to people; `standard input` for `-`.
    pub path: String,
    /// The column of the file for each coordinate, where some were selected.
    numbers: Option<Vec<usize>>,
}

impl Input {
    /// Where coordinate `column` of point `row` (both from 0, as solvers count) stands in the file.
    pub fn describe_cell(&self, row: u64, column: usize) -> Place {
        let number = self.numbers.as_ref().and_then(|numbers| numbers.get(column).copied());
        Place {
            path: self.path.clone(),
            row: row.saturating_add(1),
            line: None,
            column: number.unwrap_or(column),
            name: self.columns.get(column).cloned(),
        }
    }
}

/// Opens the points of `path`; `-` is standard input.
///
/// # Errors
/// [`Error`], with file, row, column and value.
pub fn open(path: &Path, options: &ReadOptions) -> Result<Input, Error> {
    let _ = options;
    Err(Error::UnknownFormat { path: path.display().to_string() })
}

/// Opens the points of a file whose bytes are in memory; `name` tells the format as a path would.
///
/// # Errors
/// As [`open`].
pub fn open_bytes(bytes: Vec<u8>, name: &str, options: &ReadOptions) -> Result<Input, Error> {
    let _ = (bytes, options);
    Err(Error::UnknownFormat { path: name.to_owned() })
}
