//! What obj and off share: lines of words, and numbers as text.

use std::io::BufRead;

use super::reading::Building;
use crate::{Error, MeshPlace};

/// A line, its comment, and where it stands.
pub(super) struct Line<'a> {
    pub(super) at: MeshPlace,
    /// Without blanks around it; may be empty where there is a comment.
    pub(super) words: &'a [u8],
    pub(super) comment: &'a [u8],
}

/// Lines that hold more than blanks and a comment, numbered from 1.
pub(super) struct Lines {
    stream: Box<dyn BufRead>,
    line: Vec<u8>,
    number: u64,
}

impl Lines {
    pub(super) fn new(stream: Box<dyn BufRead>) -> Self {
        Lines { stream, line: Vec::new(), number: 0 }
    }

    /// Goes to the next line that is not blank; false where there is none.
    ///
    /// A last line without its end is refused: a file that was cut within a number could look whole.
    pub(super) fn advance(&mut self, mesh: &Building<'_>) -> Result<bool, Error> {
        loop {
            self.line.clear();
            self.number += 1;
            self.stream
                .read_until(b'\n', &mut self.line)
                .map_err(|source| Error::reading(mesh.path, source))?;
            match self.line.last() {
                None => return Ok(false),
                Some(b'\n') => {}
                Some(_) => {
                    let problem = "it does not end with a line feed, as if the file were cut short";
                    return Err(mesh.damaged(MeshPlace::Line(self.number), problem));
                }
            }
            if !self.line.trim_ascii().is_empty() {
                return Ok(true);
            }
        }
    }

    /// Goes to the next line that holds words.
    pub(super) fn skip_comments(&mut self, mesh: &Building<'_>) -> Result<(), Error> {
        while self.advance(mesh)? && self.line.trim_ascii_start().starts_with(b"#") {}
        Ok(())
    }

    /// The line last gone to; `None` at the end.
    pub(super) fn current(&self) -> Option<Line<'_>> {
        let end = memchr::memchr(b'#', &self.line).unwrap_or(self.line.len());
        let (words, comment) = self.line.split_at(end);
        let at = MeshPlace::Line(self.number);
        let line = Line { at, words: words.trim_ascii(), comment: comment.trim_ascii() };
        (!self.line.is_empty()).then_some(line)
    }
}

/// The words of a line.
pub(super) fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
}

/// A whole number.
pub(super) fn whole(word: &[u8]) -> Option<i64> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// Words of at least three coordinates; further ones are colours or weights.
pub(super) fn place<'a>(words: impl Iterator<Item = &'a [u8]>) -> Option<[f64; 3]> {
    let mut at = [0.0; 3];
    let mut count = 0;
    for word in words {
        let value = fast_float2::parse(word).ok()?;
        if let Some(slot) = at.get_mut(count) {
            *slot = value;
        }
        count += 1;
    }
    (count >= 3).then_some(at)
}

/// Writes the shortest decimals that read back to the same bits, with a blank before each.
pub(super) fn put_place(at: [f64; 3], out: &mut Vec<u8>) {
    let mut buffer = zmij::Buffer::new();
    for (j, value) in at.into_iter().enumerate() {
        if j > 0 {
            out.push(b' ');
        }
        let digits = buffer.format(value);
        out.extend_from_slice(digits.strip_suffix(".0").unwrap_or(digits).as_bytes());
    }
    out.push(b'\n');
}

/// Writes ids, each with `first` added and a blank before it, and ends the line.
pub(super) fn put_ids(ids: &[u32], first: u64, out: &mut Vec<u8>) {
    for &id in ids {
        out.push(b' ');
        let mut digits = [0; 20];
        let mut rest = u64::from(id) + first;
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
    out.push(b'\n');
}
