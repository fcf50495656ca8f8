//! Rows of text to rows of numbers.
//!
//! *Idea.* Nearly every row is plain numbers: those are parsed in one walk over the bytes, without first cutting the
//! row into fields. Whatever the walk stumbles over (quotes, text, a selection, a mistake) is cut and looked at
//! field by field, and that path alone makes the messages.

use std::borrow::Cow;

use memchr::memchr;

use crate::input::Job;
use crate::number::{self, NumberError};
use crate::sink::Sink;
use crate::{Decimal, Error, Missing, Place};

/// The delimiter of the columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Delimiter {
    /// This byte; spaces around fields do not count.
    Byte(u8),
    /// Any number of spaces and tabs.
    White,
}

/// The fields of a row, unquoted and trimmed.
pub(super) fn split(line: &[u8], delimiter: Delimiter) -> Vec<Cow<'_, [u8]>> {
    let mut fields = Vec::new();
    let mut rest = line;
    loop {
        rest = skip_white(rest, delimiter);
        if delimiter == Delimiter::White && rest.is_empty() {
            return fields;
        }
        let (field, after) = cut(rest, delimiter);
        fields.push(field);
        match after {
            Some(after) => rest = after,
            None => return fields,
        }
    }
}

/// Cuts the first field off; what follows its delimiter is none when the row ends with the field.
fn cut(text: &[u8], delimiter: Delimiter) -> (Cow<'_, [u8]>, Option<&[u8]>) {
    let ends = |text: &[u8]| match delimiter {
        Delimiter::Byte(byte) => memchr(byte, text),
        Delimiter::White => text.iter().position(|&b| b == b' ' || b == b'\t'),
    };
    let after = |at: usize, text| match at < <[u8]>::len(text) {
        true => Some(&text[at + 1..]),
        false => None,
    };
    if text.first() != Some(&b'"') {
        let at = ends(text).unwrap_or(text.len());
        return (Cow::Borrowed(text[..at].trim_ascii()), after(at, text));
    }
    // Within quotes, two quotes mean one.
    let (mut field, mut at) = (Vec::new(), 1);
    loop {
        let Some(quote) = memchr(b'"', &text[at..]) else {
            field.extend_from_slice(&text[at..]);
            return (Cow::Owned(field), None);
        };
        field.extend_from_slice(&text[at..at + quote]);
        at += quote + 1;
        if text.get(at) != Some(&b'"') {
            break;
        }
        field.push(b'"');
        at += 1;
    }
    let end = at + ends(&text[at..]).unwrap_or(text.len() - at);
    field.extend_from_slice(text[at..end].trim_ascii());
    (Cow::Owned(field), after(end, text))
}

/// Without leading spaces; tabs are spaces unless they part the columns.
fn skip_white(mut text: &[u8], delimiter: Delimiter) -> &[u8] {
    while let [b' ' | b'\t', rest @ ..] = text {
        if delimiter == Delimiter::Byte(text[0]) {
            break;
        }
        text = rest;
    }
    text
}

/// Returns true if a field is written as a number; NaN, infinities and what is too small for an `f64` are numbers too.
pub(super) fn is_number(field: &[u8]) -> bool {
    is_number_with(field, Decimal::Point)
}

/// The same with another mark before the decimals.
pub(super) fn is_number_with(field: &[u8], decimal: Decimal) -> bool {
    parse_with(field.trim_ascii(), decimal) != Err(NumberError::NotANumber)
}

/// Reads a word with the given mark before its decimals.
fn parse_with(word: &[u8], decimal: Decimal) -> Result<f64, NumberError> {
    match decimal {
        Decimal::Point => number::parse(word),
        // A point could part thousands.
        Decimal::Comma if word.contains(&b'.') => Err(NumberError::NotANumber),
        Decimal::Comma => {
            let word: Vec<u8> = word.iter().map(|&b| if b == b',' { b'.' } else { b }).collect();
            number::parse(&word)
        }
    }
}

/// Tests whether a field is what tables write where a value is missing.
pub(crate) fn is_missing(field: &[u8]) -> bool {
    const WORDS: [&[u8]; 10] =
        [b"", b"NA", b"N/A", b"#N/A", b"<NA>", b"null", b"none", b"?", b".", b"-"];
    let field = field.trim_ascii();
    WORDS.iter().any(|word| field.eq_ignore_ascii_case(word))
}

/// Tests whether a field is such a word, or NaN.
pub(super) fn is_gap_with(field: &[u8], decimal: Decimal) -> bool {
    is_missing(field) || parse_with(field.trim_ascii(), decimal).is_ok_and(|value| value.is_nan())
}

/// Appends the numbers of a row to `out`; false (and some rubbish in `out`) when it is not all plain finite numbers.
fn walk(line: &[u8], delimiter: Delimiter, out: &mut Vec<f64>) -> bool {
    let mut rest = line;
    loop {
        rest = skip_white(rest, delimiter);
        let Ok((value, used)) = number::parse_start(rest) else { return false };
        if !value.is_finite() {
            return false;
        }
        out.push(value);
        let parted = matches!(rest.get(used), Some(b' ' | b'\t'));
        rest = skip_white(&rest[used..], delimiter);
        match (rest.first(), delimiter) {
            (None, _) => return true,
            (Some(&byte), Delimiter::Byte(wanted)) if byte == wanted => rest = &rest[1..],
            (Some(_), Delimiter::White) if parted => {}
            _ => return false,
        }
    }
}

/// Reads rows of equal width to a sink.
pub(super) struct Rows<'a> {
    pub(super) job: &'a Job<'a>,
    pub(super) delimiter: Delimiter,
    /// Leading fields that are no columns: the number of a TSPLIB node, the symbol of an atom.
    pub(super) skip: usize,
    /// Columns, without the skipped fields.
    pub(super) width: usize,
    /// Where the width comes from.
    pub(super) why: &'static str,
    /// Names of the columns; empty where there are none.
    pub(super) names: Vec<String>,
    /// The columns that are coordinates; all where none.
    pub(super) numbers: Option<Vec<usize>>,
    /// The column of labels; with one, `numbers` are there.
    pub(super) label: Option<usize>,
    pub(super) labels: Vec<String>,
    row: Vec<f64>,
}

impl<'a> Rows<'a> {
    pub(super) fn new(job: &'a Job<'a>, delimiter: Delimiter, skip: usize, width: usize) -> Self {
        Rows {
            job,
            delimiter,
            skip,
            width,
            why: "as in the first row",
            names: Vec::new(),
            numbers: None,
            label: None,
            labels: Vec::new(),
            row: Vec::new(),
        }
    }

    /// Dimension of the points.
    pub(super) fn dim(&self) -> usize {
        self.numbers.as_ref().map_or(self.width, Vec::len)
    }

    pub(super) fn coordinate_names(&self) -> Vec<String> {
        match &self.numbers {
            Some(numbers) => {
                numbers.iter().filter_map(|&number| self.names.get(number).cloned()).collect()
            }
            None => self.names.clone(),
        }
    }

    /// Parses a line and adds it to `sink`.
    pub(super) fn push(
        &mut self,
        (number, line): (u64, &[u8]),
        sink: &mut Sink<'_, f64>,
    ) -> Result<(), Error> {
        self.row.clear();
        let plain =
            self.skip == 0 && self.numbers.is_none() && self.job.options.decimal == Decimal::Point;
        if plain && walk(line, self.delimiter, &mut self.row) && self.row.len() == self.width {
            return sink.push(&self.row);
        }
        self.by_fields(line, number, sink.len() + 1)?;
        sink.push(&self.row)
    }

    fn by_fields(&mut self, line: &[u8], line_number: u64, row: u64) -> Result<(), Error> {
        let fields = split(line, self.delimiter);
        if fields.len() != self.width + self.skip {
            return Err(Error::Ragged {
                path: self.job.path.to_owned(),
                row,
                line: line_number,
                found: fields.len(),
                expected: self.width + self.skip,
                why: self.why,
            });
        }
        let fields = &fields[self.skip..];
        self.row.clear();
        let place_in = |column: usize| Place {
            path: self.job.path.to_owned(),
            row,
            line: Some(line_number),
            column,
            name: self.names.get(column).cloned(),
        };
        if let Some(column) = self.label {
            let label = String::from_utf8_lossy(fields[column].trim_ascii()).into_owned();
            if label.is_empty() {
                return Err(Error::NoLabel { place: place_in(column) });
            }
            self.labels.push(label);
        }
        for at in 0..self.dim() {
            let column = self.numbers.as_ref().map_or(at, |numbers| numbers[at]);
            let text = &fields[column];
            let place = || place_in(column);
            let decimal = self.job.options.decimal;
            let drops = self.job.options.missing != Missing::Refuse;
            match parse_with(text.trim_ascii(), decimal) {
                // The row is left out later.
                Ok(value) if drops && value.is_nan() => self.row.push(value),
                Err(NumberError::NotANumber) if drops && is_missing(text) => {
                    self.row.push(f64::NAN);
                }
                Ok(value) if value.is_finite() => self.row.push(value),
                Ok(_) => return Err(Error::NonFinite { place: place(), value: shown(text) }),
                Err(NumberError::Underflow) => {
                    return Err(Error::Underflow { place: place(), value: shown(text) });
                }
                Err(NumberError::NotANumber) => {
                    return Err(Error::NotANumber {
                        place: place(),
                        value: shown(text),
                        hint: hint(text, decimal),
                    });
                }
            }
        }
        Ok(())
    }
}

/// Returns what to do about a field that is no number.
pub(super) fn hint(text: &[u8], decimal: Decimal) -> &'static str {
    let has = |mark| text.contains(&mark) && text.iter().all(|b| b"0123456789,.+-eE".contains(b));
    match text {
        [] => "fill in the missing value, or leave out such rows with --missing drop",
        _ if is_missing(text) => {
            "it stands for a missing value: leave out such rows with --missing drop, or fill it in"
        }
        _ if decimal == Decimal::Comma && has(b'.') => {
            "with --decimal , there is no point in numbers"
        }
        _ if has(b',') => "write the decimal point as `.`, or say --decimal ,",
        _ => "repair it, or select the columns that are coordinates",
    }
}

/// A field as messages show it: text, and not too much of it.
pub(super) fn shown(text: &[u8]) -> String {
    const SHOWN_CHARS_MAX: usize = 40;
    let text = String::from_utf8_lossy(text);
    let mut shown: String = text
        .chars()
        .take(SHOWN_CHARS_MAX)
        .flat_map(|c| c.escape_debug().collect::<Vec<_>>())
        .collect();
    if text.chars().nth(SHOWN_CHARS_MAX).is_some() {
        shown.push('…');
    }
    shown
}
