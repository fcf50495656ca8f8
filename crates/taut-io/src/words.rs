//! Lines of words, and numbers as text, with the errors of a text that is cut short.

use std::io::{BufRead, Read};

use crate::mesh::MeshBuilder;
use crate::{Error, FilePlace};

/// A line, its comment, and where it stands.
pub(crate) struct Line<'a> {
    pub(crate) at: FilePlace,
    /// Without blanks around it; may be empty where there is a comment.
    pub(crate) words: &'a [u8],
    pub(crate) comment: &'a [u8],
}

/// Lines that hold more than blanks and a comment, numbered from 1.
pub(crate) struct Lines {
    stream: Box<dyn BufRead>,
    line: Vec<u8>,
    number: u64,
    /// True if a last line without its end is a line.
    open: bool,
    /// True if a backslash at the end of a line joins the next one to it.
    joined: bool,
    /// True if the last line has no end.
    cut: bool,
}

impl Lines {
    /// Lines after the first `number`; `open` says whether the last one may lack its end.
    pub(crate) fn new(stream: Box<dyn BufRead>, number: u64, open: bool) -> Self {
        Lines { stream, line: Vec::new(), number, open, joined: false, cut: false }
    }

    /// A backslash at the end of a line joins the next one to it.
    pub(crate) fn joined(self) -> Self {
        Lines { joined: true, ..self }
    }

    /// Goes to the next line that is not blank; false where there is none.
    ///
    /// A last line without its end is refused, unless the lines are open-ended: a file that was cut within a number
    /// could look whole.
    pub(crate) fn advance(&mut self, mesh: &MeshBuilder<'_>) -> Result<bool, Error> {
        loop {
            self.line.clear();
            loop {
                self.number += 1;
                let limit = mesh.longest_line();
                // One byte more than a line may have shows that it has too many.
                let most = (limit as u64 + 1).saturating_sub(self.line.len() as u64);
                (&mut self.stream)
                    .take(most)
                    .read_until(b'\n', &mut self.line)
                    .map_err(|source| Error::reading(mesh.path(), source))?;
                if self.line.len() > limit {
                    let (path, line) = (mesh.path().to_owned(), self.number);
                    return Err(Error::LongLine { path, line, limit });
                }
                let words = self.line.trim_ascii_end();
                match self.joined && self.line.ends_with(b"\n") && words.ends_with(b"\\") {
                    true => self.line.truncate(words.len() - 1),
                    false => break,
                }
            }
            // The mark that some editors put before UTF-8.
            if self.number == 1 && self.line.starts_with(b"\xef\xbb\xbf") {
                self.line.drain(..3);
            }
            match self.line.last() {
                None => return Ok(false),
                Some(b'\n') => {}
                Some(_) if self.open => self.cut = true,
                Some(_) => {
                    let problem = "it does not end with a line feed, as if the file were cut short";
                    return Err(mesh.damaged(FilePlace::Line(self.number), problem));
                }
            }
            if !self.line.trim_ascii().is_empty() {
                return Ok(true);
            }
        }
    }

    /// Returns true if the last line was one without its end.
    pub(crate) fn cut(&self) -> bool {
        self.cut
    }

    /// Where the line last gone to stands.
    pub(crate) fn place(&self) -> FilePlace {
        FilePlace::Line(self.number)
    }

    /// The line last gone to, with all its bytes.
    pub(crate) fn bytes(&self) -> &[u8] {
        &self.line
    }

    /// Goes to the next line that holds words.
    pub(crate) fn skip_comments(&mut self, mesh: &MeshBuilder<'_>) -> Result<(), Error> {
        while self.advance(mesh)? && self.line.trim_ascii_start().starts_with(b"#") {}
        Ok(())
    }

    /// The line last gone to; `None` at the end.
    pub(crate) fn current(&self) -> Option<Line<'_>> {
        let end = memchr::memchr(b'#', &self.line).unwrap_or(self.line.len());
        let (words, comment) = self.line.split_at(end);
        let at = FilePlace::Line(self.number);
        let line = Line { at, words: words.trim_ascii(), comment: comment.trim_ascii() };
        (!self.line.is_empty()).then_some(line)
    }
}

pub(crate) fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
}

pub(crate) fn whole(word: &[u8]) -> Option<i64> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// Writes three coordinates as [`put_number`], with blanks between them, and ends the line.
pub(crate) fn put_place(at: [f64; 3], out: &mut Vec<u8>) {
    put_numbers(at, b" ", out);
    out.push(b'\n');
}

/// Writes numbers as [`put_number`], with `between` them.
pub(crate) fn put_numbers<const N: usize>(values: [f64; N], between: &[u8], out: &mut Vec<u8>) {
    for (j, value) in values.into_iter().enumerate() {
        if j > 0 {
            out.extend_from_slice(between);
        }
        put_number(value, out);
    }
}

/// Writes the shortest decimals that read back to the same bits.
pub(crate) fn put_number(value: f64, out: &mut Vec<u8>) {
    let mut buffer = zmij::Buffer::new();
    let digits = buffer.format(value);
    out.extend_from_slice(digits.strip_suffix(".0").unwrap_or(digits).as_bytes());
}

/// Writes ids, each with `first` added and a blank before it, and ends the line.
pub(crate) fn put_ids(ids: &[u32], first: u64, out: &mut Vec<u8>) {
    for &id in ids {
        out.push(b' ');
        put_whole(u64::from(id) + first, out);
    }
    out.push(b'\n');
}

pub(crate) fn put_whole(value: u64, out: &mut Vec<u8>) {
    let mut digits = [0; 20];
    let mut rest = value;
    let mut at = digits.len();
    loop {
        at -= 1;
        digits[at] = b'0' + (rest % 10) as u8;
        rest /= 10;
        if rest == 0 {
            break;
        }
    }
    out.extend_from_slice(&digits[at..]);
}
