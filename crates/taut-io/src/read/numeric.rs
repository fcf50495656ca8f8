//! Which columns of a text hold numbers, before it is read.
//!
//! *Idea.* A column holds numbers if every row but the first has a number there or lacks the value, and at least one has a number. The
//! first row is a header if it has a word in such a column.

use std::io::BufRead;

use super::delimited::delimiter;
use super::lines::Lines;
use super::rows::{is_missing, is_number_with, split};
use crate::input::Job;
use crate::{Error, Header};

/// The columns that hold numbers.
pub(crate) struct Found {
    pub(crate) numbers: Vec<usize>,
    pub(crate) has_header: bool,
    /// The fields of the first row.
    pub(crate) first: Vec<String>,
    /// For each column how many rows of data have a word, and how many nothing.
    pub(crate) words: Vec<[u64; 2]>,
}

/// The kinds of fields that the rows have in a column.
#[derive(Clone, Copy, Default)]
struct Contents {
    has_numbers: bool,
    words: u64,
    missing: u64,
}

impl Contents {
    fn add(&mut self, field: &[u8], is_number: bool) {
        match is_number {
            true => self.has_numbers = true,
            false if is_missing(field) => self.missing += 1,
            false => self.words += 1,
        }
    }
}

/// Reads all rows of a text, and returns the columns that hold numbers; there must be one.
pub(crate) fn columns(job: &Job<'_>, stream: Box<dyn BufRead>) -> Result<Found, Error> {
    let is_number = |field: &[u8]| is_number_with(field, job.options.decimal);
    let mut lines = Lines::new(stream, job);
    let none = || Error::NoRows { path: job.path.to_owned() };
    let (_, text) = lines.next_data()?.ok_or_else(none)?;
    let delimiter = delimiter(job, text);
    let first: Vec<Vec<u8>> =
        split(text, delimiter).into_iter().map(|field| field.into_owned()).collect();
    let mut columns = vec![Contents::default(); first.len()];
    while let Some((_, text)) = lines.next_data()? {
        // A row that is too long or too short is refused when it is read.
        for (column, field) in columns.iter_mut().zip(split(text, delimiter)) {
            column.add(&field, is_number(&field));
        }
    }
    let holds = |column: &Contents| column.has_numbers && column.words == 0;
    let has_header = match job.options.header {
        Header::Present => true,
        Header::Absent => false,
        Header::Auto => {
            let is_name = |field: &[u8]| !is_number(field) && !is_missing(field);
            columns.iter().zip(&first).any(|(column, field)| holds(column) && is_name(field))
        }
    };
    if !has_header {
        for (column, field) in columns.iter_mut().zip(&first) {
            column.add(field, is_number(field));
        }
    }
    let numbers: Vec<usize> = (0..columns.len()).filter(|&at| holds(&columns[at])).collect();
    let first: Vec<String> =
        first.iter().map(|name| String::from_utf8_lossy(name).into_owned()).collect();
    if numbers.is_empty() {
        let (path, problem) = (job.path.to_owned(), "no numeric column");
        return Err(Error::NoCoordinates { path, problem, columns: first });
    }
    let words = columns.iter().map(|column| [column.words, column.missing]).collect();
    Ok(Found { numbers, has_header, first, words })
}
