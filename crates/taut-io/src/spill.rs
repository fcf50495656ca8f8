//! Decides before reading how much of the points will wait in a temporary file.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use crate::{ReadOptions, joined};

/// The first bytes of a LAS file, up to the counts of the points in version 1.4.
const LAS_HEAD_BYTES: usize = 255;

/// Bytes that [`open`](crate::open) writes to a temporary file for the points of a LAS or LAZ file, or of all such files of a
/// folder; at most so many where the options keep only some points.
///
/// The counts in the headers tell. It is 0 where points fit into the memory of the options, and where nobody knows before the
/// points are read: for other formats and for standard input.
pub fn spill_bytes(path: &Path, options: &ReadOptions) -> u64 {
    let Some(memory) = options.memory else { return 0 };
    let columns = ["x", "y", "z"].map(str::to_owned);
    let shown = path.display().to_string();
    let chosen = options.columns.as_ref();
    let dim = chosen.and_then(|chosen| chosen.resolve(&shown, &columns, 3).ok());
    let dim = dim.map_or(3, |columns| columns.len() as u64);
    let files = match path.is_dir() {
        true => joined::files(path).unwrap_or_default(),
        false => vec![path.to_owned()],
    };
    let memory = memory / (files.len() as u64).max(1);
    let bytes = |file: &Path| las_points(file).unwrap_or(0).saturating_mul(8 * dim);
    files.iter().map(|file| bytes(file)).filter(|&bytes| bytes > memory).sum()
}

/// Bytes of a point that is not compressed, at least: point format 0.
const LAS_RECORD_BYTES_MIN: u64 = 20;

/// The number of points in the header of a LAS or LAZ file; `None` for other files.
fn las_points(path: &Path) -> Option<u64> {
    // To open a pipe would wait for its writer.
    let is_file = path.metadata().is_ok_and(|found| found.is_file());
    let mut head = vec![];
    let file = File::open(path).ok().filter(|_| is_file)?;
    file.take(LAS_HEAD_BYTES as u64).read_to_end(&mut head).ok()?;
    let is_las = head.starts_with(b"LASF");
    let legacy = head.get(107..)?.first_chunk().map(|bytes| u64::from(u32::from_le_bytes(*bytes)));
    let minor = *head.get(25)?;
    let long = head.get(247..)?.first_chunk().map(|bytes| u64::from_le_bytes(*bytes));
    let points = if minor >= 4 { long } else { legacy };
    // A file that was cut is refused when it is read, with the place; the highest bits say that points are compressed.
    let is_compressed = *head.get(104)? & 0xc0 != 0;
    let most = path.metadata().ok()?.len() / LAS_RECORD_BYTES_MIN;
    points.filter(|&points| is_las && (is_compressed || points <= most))
}
