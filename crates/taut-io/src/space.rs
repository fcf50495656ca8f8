//! Decides whether a file system has room for what is about to be written.
//!
//! *Guarantee.* Only what surely does not fit is refused: the bytes counted are the fewest that the points can take.

use std::path::Path;

use taut_points::PointSource;

use crate::create::folder_of_output;
use crate::{Compression, Error, Format};

/// Most bytes that one byte of a compressed file can stand for: zstd writes 128 KiB of equal bytes as 4, gzip and xz do less.
const LARGEST_RATIO: u64 = 1 << 15;

/// A coordinate in text takes at least this many bytes: a digit and what parts it from the next.
const COORDINATE_BYTES_MIN: u64 = 2;

/// Fewest bytes of a file of these points.
pub(crate) fn least_bytes(
    source: &dyn PointSource,
    format: Format,
    compression: Option<Compression>,
) -> u64 {
    let values = source.len().saturating_mul(source.dim() as u64);
    let plain = match format {
        Format::Npy | Format::Raw | Format::Arrow | Format::Parquet => {
            source.scalar().size() as u64
        }
        _ => COORDINATE_BYTES_MIN,
    };
    // Parquet compresses its columns by itself.
    let compressed = compression.is_some() || format == Format::Parquet;
    values.saturating_mul(plain) / if compressed { LARGEST_RATIO } else { 1 }
}

/// Refuses an output of at least `bytes` bytes where its file system has fewer left; devices, pipes and standard output take
/// any number.
pub(crate) fn check_space(path: &Path, shown: &str, bytes: u64) -> Result<(), Error> {
    let free = folder_of_output(path).and_then(|folder| free(&folder));
    match free {
        Some(free) if free < bytes => Err(Error::NoSpace { path: shown.to_owned(), bytes, free }),
        _ => Ok(()),
    }
}

/// Bytes that are left where `path` is or will be written; `None` where the system does not say, and for devices and pipes.
pub fn free_bytes(path: &Path) -> Option<u64> {
    folder_of_output(path).and_then(|folder| free(&folder))
}

/// Bytes that are left where a folder is; `None` where the system does not say.
#[cfg(unix)]
fn free(folder: &Path) -> Option<u64> {
    let found = rustix::fs::statvfs(folder).ok()?;
    Some(found.f_bavail.saturating_mul(found.f_frsize))
}

#[cfg(not(unix))]
fn free(_: &Path) -> Option<u64> {
    None
}

#[cfg(test)]
mod tests {
    use taut_points::{Distribution, GeneratedSource, ScalarKind};

    use super::*;

    #[test]
    fn the_fewest_bytes_of_a_file_are_counted() {
        let source =
            GeneratedSource::new(Distribution::Normal, 1 << 30, 1 << 10, 0, ScalarKind::F32);
        let source = source.unwrap();
        let least = |format, compression| least_bytes(&source, format, compression);
        assert_eq!(least(Format::Npy, None), 1 << 42);
        assert_eq!(least(Format::Csv, None), 1 << 41);
        assert_eq!(least(Format::Raw, Some(Compression::Zstd)), 1 << 27);
        assert_eq!(least(Format::Parquet, None), 1 << 27);
    }

    #[cfg(unix)]
    #[test]
    fn more_than_is_left_is_refused_before_anything_is_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("points.npy");
        assert!(check_space(&path, "points.npy", 1).is_ok());
        let refused = check_space(&path, "points.npy", u64::MAX);
        assert!(matches!(refused, Err(Error::NoSpace { bytes: u64::MAX, .. })), "{refused:?}");
        assert!(check_space(Path::new("/dev/null"), "/dev/null", u64::MAX).is_ok());
        assert!(check_space(Path::new("-"), "standard output", u64::MAX).is_ok());
    }
}
