//! The checker of a transposed matrix in a file.
//!
//! *Idea.* With both files: tiles of the input are compared with the tiles of the output that they should be, byte by
//! byte. With one: the hash of the certificate, in which each element counts with its place.
//! *Guarantee.* Both files: exact, each read once. One file: wrong elements pass by chance only, one in 2¹²⁸.
//! *Trap.* Elements of a Fortran-ordered input lie as those of the transpose do: the two files then differ in headers only.

use serde::{Deserialize, Serialize};
use taut_points::Monitor;

use super::bytes::Source;
use super::npy;
use super::{FileAnswer, FileCheckError, FileVerdict, FileViolation, Files, Hash128, WhichFile};

/// Which elements of a matrix lie side by side.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ElementOrder {
    /// Those of a row (C order).
    Rows,
    /// Those of a column (Fortran order).
    Columns,
}

/// A file that holds the transpose of the matrix in another one, row by row.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a transposed file: an object with rows, columns, width, order, input_offset and output_offset"
)]
pub struct TransposedFile {
    /// Rows of the input.
    pub rows: u64,
    /// Columns of the input.
    pub columns: u64,
    /// Bytes of an element, at least 1.
    pub width: u64,
    /// The way in which the elements of the input lie.
    pub order: ElementOrder,
    /// Bytes of the input before its first element; it ends with the last.
    pub input_offset: u64,
    /// Bytes of the output before its first element; it ends with the last.
    pub output_offset: u64,
    /// Where both are `.npy` files, the type of an element as their headers have it: `<f8`. Without it the header of an output
    /// that begins as an `.npy` file is judged all the same, and then that of such an input.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dtype: Option<String>,
}

/// The proof of which matrix it is.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "the certificate of a transposed file: an object with hash"
)]
pub struct TransposeCertificate {
    /// Sum, modulo 2¹²⁸, of the hashes of records that are the number of an element in the output (from 0, eight bytes,
    /// least significant first) and the element.
    pub hash: Hash128,
}

/// A tile has this many bytes.
const TILE_BYTES: u64 = 1 << 23;

impl FileAnswer for TransposedFile {
    type Certificate = TransposeCertificate;
    const KIND: &'static str = "transpose";

    fn check(
        &self,
        certificate: &TransposeCertificate,
        files: Files<'_>,
        monitor: &Monitor<'_>,
    ) -> Result<FileVerdict, FileCheckError> {
        let compared = files.input.is_some();
        let found = self.certify(files, monitor)?;
        if found != *certificate {
            let (claimed, found) = (certificate.hash.to_string(), found.hash.to_string());
            return Err(FileViolation::Hash { file: WhichFile::Output, claimed, found }.into());
        }
        Ok(FileVerdict { items: self.rows.saturating_mul(self.columns), compared })
    }
}

impl TransposedFile {
    /// Compares the files as far as they are there, and returns the certificate of what was found.
    ///
    /// # Errors
    /// As [`FileAnswer::check`].
    pub fn certify(
        &self,
        files: Files<'_>,
        monitor: &Monitor<'_>,
    ) -> Result<TransposeCertificate, FileCheckError> {
        if self.width == 0 {
            let (what, value, expected) = ("width", "0".to_owned(), "at least one byte");
            return Err(FileViolation::Number { what, value, expected }.into());
        }
        let mut output = Source::new(WhichFile::Output, files.output)?;
        let offset = self.output_offset;
        self.has_length(&output, offset)?;
        let is_npy = self.dtype.is_some() || offset > 0 && npy::begins(&mut output)?;
        if is_npy {
            self.has_header(&mut output, offset)?;
        }
        let Some(input) = files.input else { return self.hash(&mut output, monitor) };
        let mut input = Source::new(WhichFile::Input, input)?;
        let offset = self.input_offset;
        self.has_length(&input, offset)?;
        if self.dtype.is_some() || is_npy && offset > 0 && npy::begins(&mut input)? {
            self.has_header(&mut input, offset)?;
        }
        self.compare(&mut input, &mut output, monitor)
    }

    fn has_length(&self, source: &Source<'_>, offset: u64) -> Result<(), FileViolation> {
        let (file, found) = (source.which, source.length);
        let elements = u128::from(self.rows) * u128::from(self.columns);
        let expected = elements
            .checked_mul(self.width.into())
            .and_then(|bytes| bytes.checked_add(offset.into()))
            .unwrap_or(u128::MAX);
        if u128::from(found) == expected {
            Ok(())
        } else {
            Err(FileViolation::Length { file, found, expected })
        }
    }

    /// The header of an `.npy` file.
    fn has_header(&self, source: &mut Source<'_>, offset: u64) -> Result<(), FileCheckError> {
        let file = source.which;
        let header = npy::header(source)?;
        let has_type = match &self.dtype {
            Some(dtype) => npy::is_same_type(&header.dtype, dtype),
            None => npy::width(&header.dtype) == Some(self.width),
        };
        let shape = match file {
            WhichFile::Input => [self.rows, self.columns],
            WhichFile::Output => [self.columns, self.rows],
        };
        let fortran = file == WhichFile::Input && self.order == ElementOrder::Columns;
        // One row or one column lies the same way in both orders.
        let order_matters = self.rows > 1 && self.columns > 1;
        let problem = if header.offset != offset {
            format!("has {} bytes, not {offset}", header.offset)
        } else if !has_type {
            let bytes = format!("of {} bytes", self.width);
            let expected = self.dtype.as_ref().map_or(bytes, |dtype| format!("{dtype:?}"));
            format!("says that elements are {:?}, not {expected}", header.dtype)
        } else if header.shape != shape {
            format!("says that the shape is {:?}, not {shape:?}", header.shape)
        } else if header.fortran != fortran && (order_matters || file == WhichFile::Output) {
            format!("says that Fortran order is {}, not {fortran}", header.fortran)
        } else if file == WhichFile::Output && !header.is_plain() {
            "is not as NumPy writes it".to_owned()
        } else {
            return Ok(());
        };
        Err(FileViolation::Header { file, problem }.into())
    }

    /// The hash of the output alone.
    fn hash(
        &self,
        output: &mut Source<'_>,
        monitor: &Monitor<'_>,
    ) -> Result<TransposeCertificate, FileCheckError> {
        let (mut hash, mut place) = (Hash128::default(), 0u64);
        if output.length > self.output_offset {
            output.items(self.output_offset, self.width as usize, monitor, |element| {
                hash.add([&place.to_le_bytes(), element]);
                place += 1;
                Ok(())
            })?;
        }
        Ok(TransposeCertificate { hash })
    }

    /// Tile by tile: rows of the input against columns of the output.
    fn compare(
        &self,
        input: &mut Source<'_>,
        output: &mut Source<'_>,
        monitor: &Monitor<'_>,
    ) -> Result<TransposeCertificate, FileCheckError> {
        let Self { rows, columns, width, .. } = *self;
        let mut hash = Hash128::default();
        if rows == 0 || columns == 0 {
            return Ok(TransposeCertificate { hash });
        }
        // From here on a row, a column and an element are no longer than files that are there.
        let most = (TILE_BYTES / width).max(1);
        let tall = rows.min(most.isqrt().max(1));
        let wide = columns.min(most / tall);
        let tall = rows.min(most / wide);
        let element = width as usize;
        let bytes = (tall * wide) as usize * element;
        let (mut from, mut to) = (vec![0; bytes], vec![0; bytes]);
        monitor.pass(1, rows * columns);
        for top in (0..rows).step_by(tall as usize) {
            for left in (0..columns).step_by(wide as usize) {
                monitor.check()?;
                let (tall, wide) = (tall.min(rows - top), wide.min(columns - left));
                self.read_input(input, [top, left], [tall, wide], &mut from)?;
                let run = tall as usize * element;
                for (j, run) in (left..).zip(to.chunks_exact_mut(run).take(wide as usize)) {
                    output.read_at(self.output_offset + (j * rows + top) * width, run)?;
                    for (i, found) in (top..).zip(run.chunks_exact(element)) {
                        let at = ((i - top) * wide + (j - left)) as usize * element;
                        if from[at..at + element] != *found {
                            let (file, row, column) = (WhichFile::Output, j, i);
                            return Err(FileViolation::Element { file, row, column }.into());
                        }
                        hash.add([&(j * rows + i).to_le_bytes(), found]);
                    }
                }
                monitor.points(tall * wide);
            }
        }
        Ok(TransposeCertificate { hash })
    }

    /// A tile of the input, row by row, however it lies in the file.
    fn read_input(
        &self,
        input: &mut Source<'_>,
        [top, left]: [u64; 2],
        [tall, wide]: [u64; 2],
        tile: &mut [u8],
    ) -> Result<(), FileCheckError> {
        let Self { rows, columns, width, .. } = *self;
        let element = width as usize;
        let at = |number: u64| self.input_offset + number * width;
        match self.order {
            ElementOrder::Rows => {
                for (i, row) in
                    (top..top + tall).zip(tile.chunks_exact_mut(wide as usize * element))
                {
                    input.read_at(at(i * columns + left), row)?;
                }
            }
            ElementOrder::Columns => {
                let mut column = vec![0; tall as usize * element];
                for j in 0..wide {
                    input.read_at(at((left + j) * rows + top), &mut column)?;
                    for (i, value) in column.chunks_exact(element).enumerate() {
                        let place = (i * wide as usize + j as usize) * element;
                        tile[place..place + element].copy_from_slice(value);
                    }
                }
            }
        }
        Ok(())
    }
}
