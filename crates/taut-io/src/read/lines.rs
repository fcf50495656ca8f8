//! Lines of a stream, without a copy, numbered from 1.

use std::io::{BufRead, ErrorKind};

use memchr::{memchr, memchr_iter};

use crate::input::Job;
use crate::limits::longest_line;
use crate::{Error, FilePlace, Format};

/// A quote that is still open after this many bytes is a mistake, not a field.
const LONGEST_QUOTE: usize = 1 << 20;

/// Most bytes taken from the stream at once.
const CHUNK: usize = 1 << 18;

/// Lines without their ends (`\n` or `\r\n`) and without the byte order mark of UTF-8.
pub(super) struct Lines<'a> {
    stream: Box<dyn BufRead>,
    path: &'a str,
    format: Format,
    buffer: Vec<u8>,
    /// Where the bytes not yet handed out begin.
    start: usize,
    ended: bool,
    /// Lines handed out.
    number: u64,
    /// Most bytes of a line.
    longest: usize,
}

impl<'a> Lines<'a> {
    pub(super) fn new(stream: Box<dyn BufRead>, job: &'a Job<'_>) -> Self {
        Lines {
            stream,
            path: job.path,
            format: job.format,
            buffer: Vec::new(),
            start: 0,
            ended: false,
            number: 0,
            longest: longest_line(job.options.memory),
        }
    }

    pub(super) fn next(&mut self) -> Result<Option<(u64, &[u8])>, Error> {
        let Some(length) = self.length()? else { return Ok(None) };
        self.number += 1;
        Ok(Some((self.number, self.take(length))))
    }

    /// The next line that holds anything but spaces and a comment. A line that ends within quotes goes on.
    pub(super) fn next_data(&mut self) -> Result<Option<(u64, &[u8])>, Error> {
        loop {
            let Some(mut length) = self.length()? else { return Ok(None) };
            self.number += 1;
            let number = self.number;
            let line = &self.buffer[self.start..self.start + length];
            // The mark is not white, so it must be looked past here too.
            let line = if number == 1 { without_mark(line) } else { line };
            if line.trim_ascii_start().is_empty() || is_comment(line) {
                self.take(length);
                continue;
            }
            let mut open = memchr_iter(b'"', line).count() % 2 == 1;
            while open {
                if self.start + length >= self.buffer.len() || length > LONGEST_QUOTE {
                    return Err(Error::OpenQuote { path: self.path.to_owned(), line: number });
                }
                let from = length + 1;
                length = self.end_after(from)?;
                self.number += 1;
                let more = &self.buffer[self.start + from..self.start + length];
                open ^= memchr_iter(b'"', more).count() % 2 == 1;
            }
            let line = self.take(length);
            return Ok(Some((number, if number == 1 { without_mark(line) } else { line })));
        }
    }

    /// Bytes to the end of the next line; none when there is no further line.
    fn length(&mut self) -> Result<Option<usize>, Error> {
        let length = self.end_after(0)?;
        Ok((self.start < self.buffer.len()).then_some(length))
    }

    /// Hands out a line of `length` bytes and steps over its end.
    fn take(&mut self, length: usize) -> &[u8] {
        let line = self.start..self.start + length;
        self.start = (line.end + 1).min(self.buffer.len());
        let line = &self.buffer[line];
        line.strip_suffix(b"\r").unwrap_or(line)
    }

    /// The distance from `start` to the first line feed at or after distance `from`, or to the end of the stream.
    fn end_after(&mut self, mut from: usize) -> Result<usize, Error> {
        loop {
            let rest = &self.buffer[(self.start + from).min(self.buffer.len())..];
            if let Some(at) = memchr(b'\n', rest) {
                return Ok(from + at);
            }
            from = self.buffer.len() - self.start;
            if from > self.longest {
                let (path, line, limit) = (self.path.to_owned(), self.number + 1, self.longest);
                return Err(Error::LongLine { path, line, limit });
            }
            if self.ended {
                return Ok(from);
            }
            self.fill()?;
        }
    }

    /// Reads on, after moving what is left to the front.
    fn fill(&mut self) -> Result<(), Error> {
        self.buffer.drain(..self.start);
        self.start = 0;
        let chunk = loop {
            match self.stream.fill_buf() {
                Err(e) if e.kind() == ErrorKind::Interrupted => {}
                // Asked again because a borrow may not leave a loop that goes on.
                Ok(_) => break self.stream.fill_buf().map_err(|e| Error::reading(self.path, e))?,
                Err(e) => return Err(Error::reading(self.path, e)),
            }
        };
        if self.number == 0 && chunk.contains(&0) {
            return Err(Error::Damaged {
                path: self.path.to_owned(),
                format: self.format,
                place: FilePlace::File,
                problem: "it holds zero bytes, so it is no text in UTF-8".to_owned(),
            });
        }
        self.ended = chunk.is_empty();
        // Bytes in memory come all at once, and must not be copied all at once.
        let used = chunk.len().min(CHUNK);
        self.buffer.extend_from_slice(&chunk[..used]);
        self.stream.consume(used);
        Ok(())
    }
}

/// Tests whether a line is a comment; Excel begins a field without a value with the mark of one.
fn is_comment(line: &[u8]) -> bool {
    const MISSING: &[u8] = b"#N/A";
    let line = line.trim_ascii_start();
    let is_missing = line.split_at_checked(MISSING.len()).is_some_and(|(word, rest)| {
        let ends = matches!(rest.first(), None | Some(b',' | b';' | b'\t' | b' ' | b'\r'));
        ends && word.eq_ignore_ascii_case(MISSING)
    });
    line.starts_with(b"#") && !is_missing
}

fn without_mark(line: &[u8]) -> &[u8] {
    line.strip_prefix(b"\xef\xbb\xbf").unwrap_or(line)
}
