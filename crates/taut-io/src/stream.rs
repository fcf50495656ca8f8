//! Rows of numbers one by one, as they come: for work that begins before the input ends.
//!
//! *Idea.* A window of bytes moves over the stream; a row is read where it stands. Nothing is kept of rows before.
//! *Guarantee.* Each row has as many numbers as were asked for, or the error names its line, or its place in bytes.
//! *Trap.* NaN is a number here: who sends rows may mark something by it. Who wants points refuses it.

use std::io::{ErrorKind, Read};

use memchr::memchr;

use crate::limits::LONGEST_LINE;
use crate::{Error, StreamRowError, number};

/// Bytes that are asked for at once.
const READ_BYTES: usize = 1 << 18;

/// How rows are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowForm {
    /// A line for each row, its numbers parted by commas, semicolons or spaces. Empty lines, and what follows a #, are left
    /// out, and so is a first line of names.
    Text,
    /// Each number as a little-endian `f64`, without anything between.
    Raw,
}

/// Rows of a stream.
///
/// ```
/// use taut_io::{RowForm, RowStream};
///
/// let mut rows = RowStream::new("x,y\n1,2\n3,4.5\n".as_bytes(), "standard input", RowForm::Text);
/// let mut row = [0.0; 2];
/// assert!(rows.next(&mut row)? && row == [1.0, 2.0]);
/// assert!(rows.next(&mut row)? && row == [3.0, 4.5]);
/// assert!(!rows.next(&mut row)?);
/// # Ok::<(), taut_io::Error>(())
/// ```
#[derive(Debug)]
pub struct RowStream<R> {
    input: R,
    name: String,
    form: RowForm,
    /// Bytes that are not handed out begin at `start`.
    window: Vec<u8>,
    start: usize,
    has_ended: bool,
    /// Bytes before the window.
    passed: u64,
    /// Lines before `start`.
    lines: u64,
    has_rows: bool,
}

impl<R: Read> RowStream<R> {
    /// The rows of `input`, which errors call `name`.
    pub fn new(input: R, name: &str, form: RowForm) -> Self {
        Self {
            input,
            name: name.to_owned(),
            form,
            window: Vec::new(),
            start: 0,
            has_ended: false,
            passed: 0,
            lines: 0,
            has_rows: false,
        }
    }

    /// Where the row that was read last stands, in words.
    pub fn place(&self) -> String {
        match self.form {
            RowForm::Text => format!("{}: line {}", self.name, self.lines),
            RowForm::Raw => {
                format!("{}: before byte {}", self.name, self.passed + self.start as u64)
            }
        }
    }

    /// Reads the next row; returns false if there is none.
    ///
    /// # Errors
    /// [`Error::Read`]; [`Error::StreamRow`] for what is no row of so many numbers; [`Error::LongLine`].
    pub fn next(&mut self, row: &mut [f64]) -> Result<bool, Error> {
        match self.form {
            RowForm::Text => self.next_line(row),
            RowForm::Raw => self.next_record(row),
        }
    }

    fn next_record(&mut self, row: &mut [f64]) -> Result<bool, Error> {
        let bytes = 8 * row.len();
        while self.window.len() - self.start < bytes {
            if self.has_ended {
                let left = self.window.len() - self.start;
                return match left {
                    0 => Ok(false),
                    _ => Err(self.wrong(format!("{left} bytes are left, but a row has {bytes}"))),
                };
            }
            self.fill()?;
        }
        let record = &self.window[self.start..self.start + bytes];
        for (x, bytes) in row.iter_mut().zip(record.chunks_exact(8)) {
            *x = f64::from_le_bytes(bytes.try_into().unwrap_or_default());
        }
        self.start += bytes;
        Ok(true)
    }

    fn next_line(&mut self, row: &mut [f64]) -> Result<bool, Error> {
        loop {
            let mut searched = 0;
            let length = loop {
                let rest = &self.window[self.start..];
                if let Some(at) = memchr(b'\n', &rest[searched..]) {
                    break searched + at;
                }
                searched = rest.len();
                if searched > LONGEST_LINE {
                    let (path, line) = (self.name.clone(), self.lines + 1);
                    return Err(Error::LongLine { path, line, limit: LONGEST_LINE });
                }
                if self.has_ended {
                    break searched;
                }
                self.fill()?;
            };
            if length == 0 && self.start == self.window.len() {
                return Ok(false);
            }
            let begin = self.start;
            self.start = (begin + length + 1).min(self.window.len());
            self.lines += 1;
            let line = &self.window[begin..begin + length];
            let line = &line[..memchr(b'#', line).unwrap_or(line.len())];
            match parse_row(line.trim_ascii(), row) {
                Ok(false) => {}
                Ok(true) => {
                    self.has_rows = true;
                    return Ok(true);
                }
                // A first line of words has names.
                Err(Wrong::Word(_)) if !self.has_rows => self.has_rows = true,
                Err(Wrong::Word(word)) => {
                    return Err(self.wrong(format!("`{word}` is no number")));
                }
                Err(Wrong::Count(found)) => {
                    let expected = row.len();
                    return Err(self.wrong(format!("{found} numbers, but {expected} are expected")));
                }
            }
        }
    }

    #[cold]
    fn wrong(&self, problem: String) -> Error {
        StreamRowError { place: self.place(), problem }.into()
    }

    /// Reads on, after moving what is left to the front.
    #[cold]
    fn fill(&mut self) -> Result<(), Error> {
        self.passed += self.start as u64;
        self.window.drain(..self.start);
        self.start = 0;
        let filled = self.window.len();
        self.window.resize(filled + READ_BYTES, 0);
        let read = loop {
            match self.input.read(&mut self.window[filled..]) {
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                read => break read,
            }
        };
        self.window.truncate(filled + *read.as_ref().unwrap_or(&0));
        self.has_ended = matches!(read, Ok(0));
        read.map(drop).map_err(|source| Error::Read { path: self.name.clone(), source })
    }
}

/// What is wrong with a row.
enum Wrong {
    Word(String),
    Count(usize),
}

/// Reads the numbers of a line; returns false if it is empty.
fn parse_row(line: &[u8], row: &mut [f64]) -> Result<bool, Wrong> {
    let is_separator = |byte: &u8| matches!(byte, b',' | b';' | b' ' | b'\t');
    let mut count = 0;
    for word in line.split(is_separator).filter(|word| !word.is_empty()) {
        let value = number::parse(word);
        let value = value.map_err(|_| Wrong::Word(String::from_utf8_lossy(word).into_owned()))?;
        if let Some(x) = row.get_mut(count) {
            *x = value;
        }
        count += 1;
    }
    match count {
        0 => Ok(false),
        n if n == row.len() => Ok(true),
        n => Err(Wrong::Count(n)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Hands out few bytes at a time.
    struct Drops<'a>(&'a [u8], usize);

    impl Read for Drops<'_> {
        fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
            let count = self.1.min(self.0.len()).min(buffer.len());
            buffer[..count].copy_from_slice(&self.0[..count]);
            self.0 = &self.0[count..];
            Ok(count)
        }
    }

    fn all(bytes: &[u8], form: RowForm, drop: usize) -> Result<Vec<[f64; 2]>, String> {
        let mut rows = RowStream::new(Drops(bytes, drop), "points", form);
        let (mut row, mut found) = ([0.0; 2], Vec::new());
        while rows.next(&mut row).map_err(|error| error.to_string())? {
            found.push(row);
        }
        Ok(found)
    }

    #[test]
    fn rows_do_not_depend_on_the_pieces_that_bytes_come_in() {
        let text = b"x y\n1,2\r\n\n# a remark\n3;-4.5 # another\n\t5e-1  6\n7 8";
        let rows = vec![[1.0f64, 2.0], [3.0, -4.5], [0.5, 6.0], [7.0, 8.0]];
        let raw: Vec<u8> = rows.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
        for drop in [1, 2, 3, 7, 1000] {
            assert_eq!(all(text, RowForm::Text, drop), Ok(rows.clone()), "{drop}");
            assert_eq!(all(&raw, RowForm::Raw, drop), Ok(rows.clone()), "{drop}");
        }
        assert_eq!(all(b"", RowForm::Text, 9), Ok(vec![]));
        let marked = all(b"nan,17\n", RowForm::Text, 9).unwrap();
        assert!(marked[0][0].is_nan() && marked[0][1] == 17.0);
    }

    #[test]
    fn what_is_no_row_is_named_with_its_place() {
        let text = |bytes: &[u8]| all(bytes, RowForm::Text, 5).unwrap_err();
        assert_eq!(text(b"x,y\n1,2\n3,four\n"), "points: line 3: `four` is no number");
        assert_eq!(text(b"x,y\nu,v\n"), "points: line 2: `u` is no number");
        assert_eq!(text(b"\n1,2,3\n"), "points: line 2: 3 numbers, but 2 are expected");
        let raw = all(&[0; 39], RowForm::Raw, 5).unwrap_err();
        assert_eq!(raw, "points: before byte 32: 7 bytes are left, but a row has 16");
    }
}
