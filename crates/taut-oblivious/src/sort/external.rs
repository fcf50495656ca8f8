//! Sorting files of records that are larger than memory.
//!
//! *Problem.* n records of w bytes in a file, a key in each, a limit on memory.
//! *Idea.* Read what fits, sort it, write it as a run; then merge all runs at once. All runs stand in one file, so three
//! files are open however many runs there are. If so many runs come together that their blocks would be tiny,
//! neighboring runs are merged into longer ones first.
//! *Guarantee.* Stable: the output is a function of the input and the place of the key, whatever the memory and the
//! threads. Each byte is read twice and written twice while there are at most some memory / 256 KiB runs of nine tenths of
//! the memory, 240 GB for 256 MiB (below 16 MiB of memory some 60 runs); a file that fits is read and written once. The
//! output appears whole under its name or not at all. What is read back from runs is compared with what was read first by a
//! hash of 128 bits of the multiset of records, which is the certificate, and held to its order, whoever made the run;
//! `taut-certify` has the checker, which shares no code with the sort.
//! *Trap.* Waiting for the disk and sorting in turn wastes both: a block is written while the next one is filled, and the
//! next blocks are asked for before they are needed.
//! *Trap.* Memory that is allowed need not be taken: where the file does not fit, runs are made as long as lets their merge
//! need as much memory as they did.
//! *Trap.* A limit on memory counts everything: the numbers of the records, the block that is being written.
//! *References.* D. Knuth, *The Art of Computer Programming* 3, 5.4.1 (multiway merging), 5.4.9;
//! A. Aggarwal, J. Vitter, *The input/output complexity of sorting*, CACM 31(9), 1988; D. Clarke et al., *Incremental
//! multiset hash functions*, ASIACRYPT 2003 (sums of hashes).

mod chunk;
mod digest;
mod engine;
mod files;
mod journal;
mod layout;
mod medium;
mod merge;
mod plan;
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};

use taut_points::Monitor;

use crate::error::Error;
pub use layout::{KeyKind, RecordLayout};

use crate::store::Pending;

/// Options to sort a file. Write `FileSortOptions { memory: 1 << 30, ..Default::default() }`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileSortOptions {
    /// Most bytes of memory for records and what is needed to sort them; the program itself comes on top. At least
    /// 64 KiB and 64 records, default 256 MiB.
    pub memory: usize,
    /// The folder for runs; none: that of the output. Runs have no name there and vanish with the process.
    pub scratch: Option<PathBuf>,
    /// A file to keep the runs in, under this name, until the output is there; another one than input and output. If it
    /// exists, it must be from the same sort, which then goes on behind the last run that was complete: the input must be
    /// the same file, unchanged, and what those runs were made of is read again and compared by a hash. None by default:
    /// nothing outlives the process. None is made for a file that fits into memory.
    pub resume: Option<PathBuf>,
    /// Bytes of the input before its first record, at most 2²⁴: they are no records, and the output begins with them as well.
    /// Default 0.
    pub header: u64,
}

impl Default for FileSortOptions {
    fn default() -> Self {
        Self { memory: 256 << 20, scratch: None, resume: None, header: 0 }
    }
}

/// A fingerprint that proves that two files hold the same records, in whatever order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Multiset {
    /// Number of records.
    pub records: u64,
    /// Sum of the hashes of all records, modulo 2¹²⁸. Two multisets that differ agree in it by chance only, as far as
    /// hashes are random numbers; it is no defense against somebody who means to deceive.
    pub hash: u128,
}

/// The result of sorting a file: its certificate, and counters.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FileSort {
    /// The records that were read. If they did not fit, those that came back from the runs for the output were found to be
    /// the same. Nobody has read the output: the checker of `taut-certify` does.
    pub certificate: Multiset,
    /// Bytes before the first record.
    pub header: u64,
    /// The hash of these bytes, as of one more record; 0 where there are none.
    pub header_hash: u128,
    /// Runs that the input was cut into; 1 if it fitted.
    pub runs: u64,
    /// Runs that an earlier process had left, of those.
    pub runs_resumed: u64,
    /// Bytes read from all files.
    pub bytes_read: u64,
    /// Bytes written to all files.
    pub bytes_written: u64,
}

/// Sorts the records of a file by their key into another file, or into the same one.
///
/// Stable. `monitor` is told of a pass over the records while runs are made, one for each merge of some runs into a longer
/// one, and one for the last merge; it can stop the work after any block. Until the output is complete, `output` is
/// untouched. Where the system has files without a name, nothing is left behind even if the process is killed, but for
/// the file of [`FileSortOptions::resume`], which is removed when the output is there. Room for runs, also those of merges in
/// steps, and for the output is reserved at the beginning where the system can, so that a full disk is told before the work.
/// An output that exists is replaced, also behind a symbolic link, and its permissions are kept.
///
/// Runs on the current rayon pool.
///
/// # Errors
/// [`Error::Option`] for a layout or a limit that makes no sense or is more than the system gives, and for a file to resume
/// that is of another sort;
/// [`Error::Partial`] if the input ends within a record; [`Error::File`] for what the system refuses;
/// [`Error::ReadBack`], or [`Error::DamagedRuns`] of a file to resume, if records came back from the disk other than they
/// were written, [`Error::UnsortedRun`] if their order is not that of a run; [`Error::Cancelled`].
pub fn sort_file(
    input: &Path,
    output: &Path,
    layout: &RecordLayout,
    options: &FileSortOptions,
    monitor: &Monitor<'_>,
) -> Result<FileSort, Error> {
    sort_file_pending(input, output, layout, options, monitor)?.publish()
}

/// [`sort_file`], but for the last step: the output is complete and has not its name yet, so that it can be looked at before
/// it replaces an earlier one and a file to resume is removed.
///
/// # Errors
/// Those of [`sort_file`].
pub fn sort_file_pending(
    input: &Path,
    output: &Path,
    layout: &RecordLayout,
    options: &FileSortOptions,
    monitor: &Monitor<'_>,
) -> Result<Pending<FileSort>, Error> {
    files::sort(input, output, layout, options, monitor, |file, _| file)
}
