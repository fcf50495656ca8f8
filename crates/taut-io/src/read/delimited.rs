//! Text with columns: csv, tsv and whitespace.
//!
//! *Idea.* The first row of data decides: what parts the columns (in CSV the first of `,` `;` tab and spaces that
//! makes all fields numbers, else the most frequent), how many there are, and whether it is a header.
//! *Trap.* A mistyped or missing number in the first row must not turn it into a header and so lose a point: a row
//! with both names and numbers is refused, and so is one with a field that looks like a value that went wrong.

use std::borrow::Cow;
use std::io::{BufRead, BufReader, Cursor, Seek};

use super::Decoded;
use super::lines::Lines;
use super::rows::{Delimiter, Rows, is_missing, is_number_with, shown, split};
use super::{Seekable, numeric};
use crate::input::{Job, Medium};
use crate::labels;
use crate::sink::Sink;
use crate::{Columns, Decimal, Error, Format, Header, Missing, ReadOptions};

/// Reads the rows; where the columns of numbers are to be found first, twice.
pub(super) fn read(job: &Job<'_>, medium: Medium) -> Result<Decoded, Error> {
    if !job.options.numeric {
        return read_rows(job, medium.stream());
    }
    let (found, stream) = match medium.seekable(job)? {
        Seekable::Bytes(bytes) => {
            let found = numeric::columns(job, Box::new(Cursor::new(bytes.clone())))?;
            let stream: Box<dyn BufRead> = Box::new(Cursor::new(bytes));
            (found, stream)
        }
        Seekable::File(mut file) => {
            let failed = |source| Error::reading(job.path, source);
            file.rewind().map_err(failed)?;
            let twin = file.try_clone().map_err(failed)?;
            let found = numeric::columns(job, Box::new(BufReader::new(twin)))?;
            file.rewind().map_err(failed)?;
            let stream: Box<dyn BufRead> = Box::new(BufReader::new(file));
            (found, stream)
        }
    };
    let options = ReadOptions {
        columns: Some(Columns::of_numbers(found.numbers)),
        header: if found.has_header { Header::Present } else { Header::Absent },
        numeric: false,
        ..job.options.clone()
    };
    read_rows(&Job { options: &options, path: job.path, format: job.format }, stream)
}

fn read_rows(job: &Job<'_>, stream: Box<dyn BufRead>) -> Result<Decoded, Error> {
    let mut lines = Lines::new(stream, job);
    let Some((line, text)) = lines.next_data()? else {
        return Err(Error::NoRows { path: job.path.to_owned() });
    };
    let delimiter = delimiter(job, text);
    let first = split(text, delimiter);
    let mut rows = Rows::new(job, delimiter, 0, first.len());
    let label = job.options.label.as_deref().map(Columns::of_label);
    let header = match &label {
        Some(label) => is_header_beside(job, label, &first, line)?,
        None => is_header(job, &first, line)?,
    };
    if header {
        rows.names = first.iter().map(|name| String::from_utf8_lossy(name).into_owned()).collect();
        rows.why = "as in the header";
    }
    if let Some(columns) = &job.options.columns {
        rows.numbers = Some(columns.resolve(job.path, &rows.names, rows.width)?);
    }
    if let Some(label) = &label {
        let column = label.resolve(job.path, &rows.names, rows.width)?[0];
        let numbers = rows.numbers.take();
        let others = || (0..rows.width).filter(|&other| other != column).collect();
        let numbers = numbers.map_or_else(others, |mut numbers: Vec<usize>| {
            numbers.retain(|&other| other != column);
            numbers
        });
        labels::check_others(numbers.len(), label)?;
        (rows.numbers, rows.label) = (Some(numbers), Some(column));
    }
    let mut sink = Sink::new(job, rows.dim());
    if !header {
        rows.push((line, text), &mut sink)?;
    }
    while let Some(next) = lines.next_data()? {
        rows.push(next, &mut sink)?;
    }
    let (columns, numbers) = (rows.coordinate_names(), rows.numbers.take());
    Ok(Decoded { source: sink.finish()?, columns, numbers, labels: rows.labels })
}

/// The delimiter of the columns, by the first row of data.
pub(super) fn delimiter(job: &Job<'_>, line: &[u8]) -> Delimiter {
    match job.format {
        Format::Tsv => Delimiter::Byte(b'\t'),
        Format::Whitespace => Delimiter::White,
        _ => find_delimiter(line, job.options.decimal),
    }
}

fn find_delimiter(line: &[u8], decimal: Decimal) -> Delimiter {
    let [comma, semicolon, tab] = [b',', b';', b'\t'].map(Delimiter::Byte);
    // Commas before decimals part columns only where numbers are quoted.
    let candidates = match decimal {
        Decimal::Point => [comma, semicolon, tab, Delimiter::White],
        Decimal::Comma => [semicolon, tab, Delimiter::White, comma],
    };
    let numeric = |&delimiter: &Delimiter| {
        split(line, delimiter).iter().all(|field| is_number_with(field, decimal))
    };
    if let Some(found) = candidates.into_iter().find(numeric) {
        return found;
    }
    // Spaces are the last resort only: they stand inside names and labels.
    let fields = |delimiter: Delimiter| split(line, delimiter).len();
    if decimal == Decimal::Comma {
        // Commas stand inside numbers and names, so that the most frequent mark need not part anything.
        let found = [semicolon, tab, comma].into_iter().find(|&mark| fields(mark) > 1);
        return found.unwrap_or(Delimiter::White);
    }
    let mut best = candidates[0];
    for other in candidates[1..].iter().filter(|other| **other != Delimiter::White) {
        if fields(*other) > fields(best) {
            best = *other;
        }
    }
    if fields(best) == 1 { Delimiter::White } else { best }
}

/// Tests whether the first row holds names.
fn is_header(job: &Job<'_>, first: &[Cow<'_, [u8]>], line: u64) -> Result<bool, Error> {
    let columns = job.options.columns.as_ref();
    match job.options.header {
        Header::Present => return Ok(true),
        Header::Absent => return Ok(false),
        Header::Auto => {}
    }
    let is_number = |field: &[u8]| is_number_with(field, job.options.decimal);
    let is_gap = |field: &[u8]| job.options.missing != Missing::Refuse && is_missing(field);
    // All fields count, selected or not: a label beside numbers is no name, but `1O`, `NA` and a gap are no names either.
    let is_failed = |field: &[u8]| is_failed_with(field, job.options.decimal) && !is_gap(field);
    if let Some(column) = first.iter().position(|field| is_failed(field)) {
        return match columns {
            // An unselected hole beside numbers does no harm: what is selected decides alone.
            Some(columns) if !columns.has_names() && all_numbers(job, columns, first)? => Ok(false),
            // The row that holds the names asked for is the header, with a hole over an index or not.
            Some(columns) if columns.has_names() && holds_names(job, columns, first) => Ok(true),
            _ => Err(Error::DoubtfulHeader {
                path: job.path.to_owned(),
                line,
                column,
                value: shown(&first[column]),
            }),
        };
    }
    // Who asks for names says that there are some, unless the row holds nothing but numbers.
    let numbers = match columns {
        Some(columns) if columns.has_names() => {
            return Ok(!first.iter().all(|field| is_number(field)));
        }
        Some(columns) => Columns::resolve(columns, job.path, &[], first.len())?,
        None => (0..first.len()).collect(),
    };
    let is_text = |field: &[u8]| !is_number(field) && !is_gap(field);
    let text = numbers.iter().copied().find(|&column| is_text(&first[column]));
    let value = numbers.iter().copied().find(|&column| is_number(&first[column]));
    match (text, value) {
        (None, _) => Ok(false),
        (Some(_), None) => Ok(true),
        (Some(column), Some(_)) => Err(Error::MixedHeader {
            path: job.path.to_owned(),
            line,
            column,
            value: shown(&first[column]),
        }),
    }
}

/// Tests whether the first row holds names, where one column holds labels, which may be any text.
fn is_header_beside(
    job: &Job<'_>,
    label: &Columns,
    first: &[Cow<'_, [u8]>],
    line: u64,
) -> Result<bool, Error> {
    match job.options.header {
        Header::Present => return Ok(true),
        Header::Absent => return Ok(false),
        // A label with a name is in a file with names.
        Header::Auto if label.has_names() => return Ok(true),
        Header::Auto => {}
    }
    let is_number = |field: &[u8]| is_number_with(field, job.options.decimal);
    let is_gap = |field: &[u8]| job.options.missing != Missing::Refuse && is_missing(field);
    let label = label.resolve(job.path, &[], first.len())?[0];
    let others = || (0..first.len()).filter(|&column| column != label);
    let is_text = |field: &[u8]| !is_number(field) && !is_gap(field);
    let is_failed = |field: &[u8]| is_failed_with(field, job.options.decimal) && !is_gap(field);
    let text = others().find(|&column| is_text(&first[column]));
    let Some(column) = text else { return Ok(false) };
    let (path, value) = (job.path.to_owned(), shown(&first[column]));
    if let Some(column) = others().find(|&column| is_failed(&first[column])) {
        return Err(Error::DoubtfulHeader { path, line, column, value: shown(&first[column]) });
    }
    match others().any(|column| is_number(&first[column])) {
        true => Err(Error::MixedHeader { path, line, column, value }),
        false => Ok(true),
    }
}

/// Returns true if the names of a selection stand in the row, and all it selects may be names.
fn holds_names(job: &Job<'_>, columns: &Columns, first: &[Cow<'_, [u8]>]) -> bool {
    let names: Vec<String> =
        first.iter().map(|name| String::from_utf8_lossy(name).into_owned()).collect();
    let decimal = job.options.decimal;
    let may_be_name =
        |field: &[u8]| !is_number_with(field, decimal) && !is_failed_with(field, decimal);
    let numbers = columns.resolve(job.path, &names, first.len());
    numbers.is_ok_and(|numbers| numbers.iter().all(|&column| may_be_name(&first[column])))
}

/// Tests whether all selected fields are numbers.
fn all_numbers(job: &Job<'_>, columns: &Columns, first: &[Cow<'_, [u8]>]) -> Result<bool, Error> {
    let numbers = columns.resolve(job.path, &[], first.len())?;
    Ok(numbers.iter().all(|&column| is_number_with(&first[column], job.options.decimal)))
}

/// Tests whether a field is no number but begins as one, or is what tables write where a number is missing.
pub(crate) fn is_failed_value(field: &[u8]) -> bool {
    is_failed_with(field, Decimal::Point)
}

/// The same with another mark before the decimals.
pub(super) fn is_failed_with(field: &[u8], decimal: Decimal) -> bool {
    let starts = matches!(field.first(), Some(b'0'..=b'9' | b'+' | b'-' | b'.'));
    !is_number_with(field, decimal) && (starts || is_missing(field))
}
