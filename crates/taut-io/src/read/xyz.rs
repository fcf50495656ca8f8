//! Lines of `x y z`, as point clouds have them, or after a count, a comment and with element symbols, as molecules do.
//!
//! Further columns (colors, charges) are not coordinates unless selected.

use std::io::BufRead;

use super::Decoded;
use super::lines::Lines;
use super::rows::{Delimiter, Rows, is_number, split};
use crate::input::Job;
use crate::sink::Sink;
use crate::{Error, FilePlace, Format};

pub(super) fn read(job: &Job<'_>, stream: Box<dyn BufRead>) -> Result<Decoded, Error> {
    let mut lines = Lines::new(stream, job);
    let none = || Error::NoRows { path: job.path.to_owned() };
    let (line, text) = lines.next_data()?.ok_or_else(none)?;
    let count = std::str::from_utf8(text).ok().and_then(|text| text.trim().parse::<u64>().ok());
    let first = match count {
        None => (line, text.to_vec()),
        Some(_) => {
            // The comment may be blank, so it is the next line whatever it holds; some writers leave it out.
            let (line, text) = lines.next()?.ok_or_else(none)?;
            match is_row(text) {
                true => (line, text.to_vec()),
                false => {
                    lines.next_data()?.map(|(line, text)| (line, text.to_vec())).ok_or_else(none)?
                }
            }
        }
    };
    let fields = split(&first.1, Delimiter::White);
    let skip = usize::from(fields.first().is_some_and(|symbol| !is_number(symbol)));
    let width = fields.len() - skip;
    if width < 3 {
        let problem = format!("line {} has {width} coordinates, not at least 3", first.0);
        return Err(Error::Damaged {
            path: job.path.to_owned(),
            format: Format::Xyz,
            place: FilePlace::File,
            problem,
        });
    }
    let mut rows = Rows::new(job, Delimiter::White, skip, width);
    rows.names = ["x", "y", "z"].map(str::to_owned).to_vec();
    rows.names.extend((3..width).map(|column| column.to_string()));
    rows.numbers = Some(match &job.options.columns {
        Some(columns) => columns.resolve(job.path, &rows.names, width)?,
        None => vec![0, 1, 2],
    });
    let mut sink = Sink::new(job, rows.dim());
    rows.push((first.0, &first.1), &mut sink)?;
    while let Some(next) = lines.next_data()? {
        rows.push(next, &mut sink)?;
    }
    if let Some(expected) = count.filter(|&count| count != sink.len()) {
        let (path, found) = (job.path.to_owned(), sink.len());
        return Err(Error::Count {
            path,
            format: Format::Xyz,
            expected,
            found,
            unit: ("point", "points"),
        });
    }
    let (columns, numbers) = (rows.coordinate_names(), rows.numbers.take());
    Ok(Decoded { source: sink.finish()?, columns, numbers, labels: Vec::new() })
}

/// Returns true if a line holds a point: at least three numbers, and nothing else but a symbol before them.
fn is_row(line: &[u8]) -> bool {
    let fields = split(line, Delimiter::White);
    let numbers = fields.iter().rev().take_while(|field| is_number(field)).count();
    numbers >= 3 && fields.len() - numbers <= 1
}
