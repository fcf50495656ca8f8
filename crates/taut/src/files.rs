//! Files that `taut-oblivious` sorted or transposed, as answers of `taut-certify`: neither crate knows the other.
//!
//! ```
//! use taut::certify::Files;
//! use taut::files::{StoredMatrix, transposed};
//! use taut::oblivious::{TransposeFileOptions, transpose_file};
//!
//! let folder = std::env::temp_dir();
//! let (from, to) = (folder.join("taut-files-from.bin"), folder.join("taut-files-to.bin"));
//! std::fs::write(&from, b"adbecf")?;                       // two rows of three bytes, column by column
//! let stored = StoredMatrix { rows: 2, columns: 3, width: 1, offset: 0, by_columns: true, dtype: None };
//! let monitor = taut::Monitor::silent();
//! let found = transpose_file(&from, stored.matrix(), &to, b"", &TransposeFileOptions::default(), &monitor)?;
//! assert_eq!(std::fs::read(&to)?, b"adbecf");              // as the transpose has it row by row
//!
//! let answer = stored.transpose(0);
//! let (mut input, mut output) = (std::fs::File::open(&from)?, std::fs::File::open(&to)?);
//! let certificate = answer.certify(Files { input: Some(&mut input), output: &mut output }, &monitor)?;
//! assert_eq!(transposed(answer, certificate, &found).trace.method, "tiles");
//! # std::fs::remove_file(&from)?;
//! # std::fs::remove_file(&to)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use taut_certify::{
    ElementOrder, FileSolution, Hash128, KeyKind, SortCertificate, SortedFile, Trace,
    TransposeCertificate, TransposedFile,
};
use taut_oblivious::external::{FileSort, KeyKind as Kind, RecordLayout};
use taut_oblivious::{FileMatrix, FileTransposition};

/// A matrix in a file, in either order of its elements: what the header of an `.npy` file says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StoredMatrix {
    /// Rows.
    pub rows: u64,
    /// Columns.
    pub columns: u64,
    /// Bytes of an element, at least 1.
    pub width: usize,
    /// Bytes of the file before the first element.
    pub offset: u64,
    /// True if elements of a column lie side by side (Fortran order), not those of a row.
    pub by_columns: bool,
    /// In an `.npy` file the type of an element as the header has it: `<f8`.
    pub dtype: Option<String>,
}

impl StoredMatrix {
    /// Returns true if the order of elements is that of columns, and not that of rows too.
    fn turned(&self) -> bool {
        self.by_columns && self.rows > 1 && self.columns > 1
    }

    /// Returns what to transpose for a file with the transpose, row by row.
    pub fn matrix(&self) -> FileMatrix {
        let Self { rows, columns, width, offset, .. } = *self;
        match self.turned() {
            // The elements lie as those of the transpose do: one row of them all. More than 2⁶⁴ are in no file, whose length
            // is checked.
            true => FileMatrix { rows: 1, columns: rows.saturating_mul(columns), width, offset },
            false => FileMatrix { rows, columns, width, offset },
        }
    }

    /// Returns what the file with the transpose, row by row after `output_offset` bytes, is then said to be.
    pub fn transpose(&self, output_offset: u64) -> TransposedFile {
        TransposedFile {
            rows: self.rows,
            columns: self.columns,
            width: self.width as u64,
            order: if self.turned() { ElementOrder::Columns } else { ElementOrder::Rows },
            input_offset: self.offset,
            output_offset,
            dtype: self.dtype.clone(),
        }
    }
}

/// The solution of a transposition, from what it did and what was certified of the files.
pub fn transposed(
    answer: TransposedFile,
    certificate: TransposeCertificate,
    found: &FileTransposition,
) -> FileSolution<TransposedFile> {
    let counters = [
        ("bytes_read", found.bytes_read),
        ("bytes_written", found.bytes_written),
        ("tiles", found.tiles),
    ];
    FileSolution { answer, certificate, trace: Trace { passes: 1, ..trace("tiles", counters) } }
}

/// The solution of a sort.
pub fn sorted(layout: &RecordLayout, found: &FileSort) -> FileSolution<SortedFile> {
    let answer = SortedFile {
        records: found.certificate.records,
        width: layout.width as u64,
        header: found.header,
        key: [layout.key.start as u64, layout.key.end as u64],
        key_kind: match layout.kind {
            Kind::U64 => KeyKind::U64,
            Kind::I64 => KeyKind::I64,
            Kind::F64 => KeyKind::F64,
            Kind::Bytes => KeyKind::Bytes,
        },
    };
    let hash = found.certificate.hash.wrapping_add(found.header_hash);
    let certificate = SortCertificate { hash: Hash128(hash) };
    let counters = [
        ("bytes_read", found.bytes_read),
        ("bytes_written", found.bytes_written),
        ("runs", found.runs),
    ];
    FileSolution { answer, certificate, trace: trace("merge-runs", counters) }
}

fn trace(method: &str, counters: [(&str, u64); 3]) -> Trace {
    Trace {
        method: method.to_owned(),
        counters: counters.map(|(name, value)| (name.to_owned(), value)).into(),
        ..Trace::default()
    }
}
