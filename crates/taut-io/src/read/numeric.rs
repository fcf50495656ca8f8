//! Which columns of a text hold numbers, before it is read.
//!
//! *Idea.* A column holds numbers if every row but the first has a number there or lacks the value, and at least one has a number. The
//! first row is a header if it has names in such columns.
//! *Trap.* A mistyped number must neither make its row a header nor its column one of words: both would be lost unsaid. A column with
//! numbers and words is refused, and so is one with numbers that have the other mark before their decimals.

use std::io::BufRead;

use super::delimited::{delimiter, is_failed_with};
use super::lines::Lines;
use super::rows::{hint, is_gap_with, is_missing, is_number_with, shown, split};
use crate::input::Job;
use crate::{Columns, Decimal, Error, Header, Missing, Place};

/// The columns that hold numbers.
pub(crate) struct Found {
    pub(crate) numbers: Vec<usize>,
    pub(crate) has_header: bool,
    /// The fields of the first row.
    pub(crate) first: Vec<String>,
    /// For each column how many rows of data have a word, and how many nothing.
    pub(crate) words: Vec<[u64; 2]>,
}

/// A word where it stands: the row of data after the first row of the text, its line, and the field.
type Word = (u64, u64, Vec<u8>);

/// The kinds of fields that the rows have in a column.
#[derive(Clone, Default)]
struct Contents {
    has_numbers: bool,
    words: u64,
    missing: u64,
    /// The first word.
    first_word: Option<Word>,
    /// The first word that is a number with the other mark before its decimals.
    other_mark: Option<Word>,
}

impl Contents {
    fn add(&mut self, field: &[u8], decimal: Decimal, (row, line): (u64, u64)) {
        if is_gap_with(field, decimal) {
            self.missing += 1;
            return;
        }
        if is_number_with(field, decimal) {
            self.has_numbers = true;
            return;
        }
        self.words += 1;
        let word = || (row, line, field.to_vec());
        self.first_word.get_or_insert_with(word);
        let other = match decimal {
            Decimal::Point => Decimal::Comma,
            Decimal::Comma => Decimal::Point,
        };
        if self.other_mark.is_none() && is_number_with(field, other) {
            self.other_mark = Some(word());
        }
    }

    /// The word that should be a number, by all that the column holds.
    fn mistake(&self) -> Option<&Word> {
        let beside_numbers = self.first_word.as_ref().filter(|_| self.has_numbers);
        self.other_mark.as_ref().or(beside_numbers)
    }
}

/// Reads all rows of a text, and returns the columns that hold numbers; there must be one.
pub(crate) fn columns(job: &Job<'_>, stream: Box<dyn BufRead>) -> Result<Found, Error> {
    let decimal = job.options.decimal;
    let mut lines = Lines::new(stream, job);
    let none = || Error::NoRows { path: job.path.to_owned() };
    let (first_line, text) = lines.next_data()?.ok_or_else(none)?;
    let delimiter = delimiter(job, text);
    let first: Vec<Vec<u8>> =
        split(text, delimiter).into_iter().map(|field| field.into_owned()).collect();
    let mut columns = vec![Contents::default(); first.len()];
    let mut row = 0;
    while let Some((line, text)) = lines.next_data()? {
        row += 1;
        // A row that is too long or too short is refused when it is read.
        for (column, field) in columns.iter_mut().zip(split(text, delimiter)) {
            column.add(&field, decimal, (row, line));
        }
    }
    let holds = |column: &Contents| column.has_numbers && column.words == 0;
    let label = job.options.label.as_deref().map(Columns::of_label);
    let is_named = label.as_ref().is_some_and(Columns::has_names);
    let has_header = match job.options.header {
        Header::Present => true,
        Header::Absent => false,
        // A label with a name is in a file with names.
        Header::Auto if is_named => true,
        Header::Auto => {
            let of_numbers = (0..first.len()).filter(|&column| holds(&columns[column]));
            let label = label.as_ref().map(|label| label.resolve(job.path, &[], first.len()));
            let label = label.transpose()?.map(|numbers| numbers[0]);
            let decisive: Vec<usize> = of_numbers.filter(|&column| Some(column) != label).collect();
            has_names(job, &first, &decisive, first_line)?
        }
    };
    if !has_header {
        for (column, field) in columns.iter_mut().zip(&first) {
            column.add(field, decimal, (0, first_line));
        }
    }
    let numbers: Vec<usize> = (0..columns.len()).filter(|&at| holds(&columns[at])).collect();
    let first: Vec<String> =
        first.iter().map(|name| String::from_utf8_lossy(name).into_owned()).collect();
    // Who counts what is missing takes columns as they are.
    if job.options.missing != Missing::Keep {
        let names: &[String] = if has_header { &first } else { &[] };
        let label = label.map(|label| label.resolve(job.path, names, first.len())).transpose()?;
        let label = label.map(|numbers| numbers[0]);
        let others = (0..columns.len()).filter(|&column| Some(column) != label);
        let mistakes = others.filter_map(|column| Some((column, columns[column].mistake()?)));
        if let Some((column, (row, line, value))) = mistakes.min_by_key(|(_, word)| word.1) {
            let (path, name) = (job.path.to_owned(), names.get(column).cloned());
            let row = row + u64::from(!has_header);
            let place = Place { path, row, line: Some(*line), column, name };
            let (value, hint) = (shown(value), hint(value, decimal));
            return Err(Error::NotANumber { place, value, hint });
        }
    }
    if numbers.is_empty() {
        let (path, problem) = (job.path.to_owned(), "no numeric column");
        return Err(Error::NoCoordinates { path, problem, columns: first });
    }
    let words = columns.iter().map(|column| [column.words, column.missing]).collect();
    Ok(Found { numbers, has_header, first, words })
}

/// Tests whether the first row holds names, by its fields in the columns of numbers.
fn has_names(
    job: &Job<'_>,
    first: &[Vec<u8>],
    columns: &[usize],
    line: u64,
) -> Result<bool, Error> {
    let decimal = job.options.decimal;
    let is_number = |column: usize| is_number_with(&first[column], decimal);
    let is_name = |column: usize| !is_number(column) && !is_missing(&first[column]);
    let is_failed = |column: usize| is_name(column) && is_failed_with(&first[column], decimal);
    let find = |test: &dyn Fn(usize) -> bool| columns.iter().copied().find(|&column| test(column));
    let path = || job.path.to_owned();
    if let Some(column) = find(&is_failed) {
        return Err(Error::DoubtfulHeader {
            path: path(),
            line,
            column,
            value: shown(&first[column]),
        });
    }
    match (find(&is_name), find(&is_number)) {
        (None, _) => Ok(false),
        (Some(_), None) => Ok(true),
        (Some(column), Some(_)) => {
            Err(Error::MixedHeader { path: path(), line, column, value: shown(&first[column]) })
        }
    }
}
