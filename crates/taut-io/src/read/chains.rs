//! Chains of positions of the plane, such as the rings of a polygon, as rows x, y and, of several chains, the number of the chain.
//!
//! *Idea.* Readers of text walk over it twice: the first walk counts the chains, which decides about the third column, the second
//! one hands positions to the sink. So nothing but the text is held besides the points.

use std::io::{BufRead, Read};

use super::Decoded;
use crate::input::Job;
use crate::sink::Sink;
use crate::{Error, FilePlace, limits};

/// Takes the number of a chain, from 0, and its next position.
pub(super) type Put<'a> = dyn FnMut(usize, [f64; 2]) -> Result<(), Error> + 'a;

/// Why a walk over a text ends early.
pub(super) enum Stop {
    /// The text is not what it should be: the byte and what is wrong.
    Text(usize, String),
    /// The position was not taken, or a feature is not there.
    Failed(Error),
}

impl From<Error> for Stop {
    fn from(error: Error) -> Self {
        Stop::Failed(error)
    }
}

/// The whole text, of at most `most` bytes.
pub(super) fn held_text(
    job: &Job<'_>,
    mut stream: Box<dyn BufRead>,
    most: u64,
    too_large: impl FnOnce(u64) -> Error,
) -> Result<Vec<u8>, Error> {
    let mut text = vec![];
    stream
        .by_ref()
        .take(most.saturating_add(1))
        .read_to_end(&mut text)
        .map_err(|source| Error::reading(job.path, source))?;
    match text.len() as u64 > most {
        true => Err(too_large(text.len() as u64)),
        false => Ok(text),
    }
}

/// Reads a text whose chains `walk` finds.
pub(super) fn read_text(
    job: &Job<'_>,
    stream: Box<dyn BufRead>,
    problem: &'static str,
    walk: impl Fn(&[u8], &mut Put<'_>) -> Result<(), Stop>,
) -> Result<Decoded, Error> {
    let most = limits::most_held(job.options.memory) / 2;
    let too_large = |bytes| Error::TooLarge {
        path: job.path.to_owned(),
        problem,
        bytes,
        memory: most,
        remedy: "allow more memory, or write the positions as csv: x, y and the number of the ring",
    };
    let text = held_text(job, stream, most, too_large)?;
    let text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&text);
    let walk = |put: &mut Put<'_>| {
        walk(text, put).map_err(|stop| match stop {
            Stop::Failed(error) => error,
            Stop::Text(at, problem) => {
                let before = &text[..at.min(text.len())];
                let line = 1 + memchr::memchr_iter(b'\n', before).count() as u64;
                let start = memchr::memrchr(b'\n', before).map_or(0, |end| end + 1);
                let column = before.len() - start + 1;
                Error::Damaged {
                    path: job.path.to_owned(),
                    format: job.format,
                    place: FilePlace::Line(line),
                    problem: format!("byte {column} of the line: {problem}"),
                }
            }
        })
    };
    let mut chains = 0;
    walk(&mut |chain, _| {
        chains = chains.max(chain + 1);
        Ok(())
    })?;
    decode(job, chains > 1, walk)
}

/// The rows of all positions that `walk` hands over.
pub(super) fn decode(
    job: &Job<'_>,
    is_several: bool,
    walk: impl FnOnce(&mut Put<'_>) -> Result<(), Error>,
) -> Result<Decoded, Error> {
    let width = if is_several { 3 } else { 2 };
    let names = ["x", "y", "ring"].map(str::to_owned);
    let numbers = match &job.options.columns {
        Some(columns) => columns.resolve(job.path, &names[..width], width)?,
        None => (0..width).collect(),
    };
    let mut sink = Sink::new(job, numbers.len());
    let mut row = Vec::with_capacity(numbers.len());
    walk(&mut |chain, [x, y]| {
        let all = [x, y, chain as f64];
        row.clear();
        row.extend(numbers.iter().map(|&number| all[number]));
        sink.push(&row)
    })?;
    let columns = numbers.iter().map(|&number| names[number].clone()).collect();
    Ok(Decoded { source: sink.finish()?, columns, numbers: Some(numbers), labels: Vec::new() })
}
