//! Text: a point per line.

use taut_points::{Rows, Scalar};

use super::{OutputFile, Points};
use crate::Error;

pub(super) fn write(
    points: &Points<'_>,
    delimiter: u8,
    out: &mut OutputFile<'_>,
) -> Result<(), Error> {
    if let Some(header) = header(points.columns, delimiter) {
        out.put(&header)?;
    }
    let mut text = Vec::new();
    points.blocks(|rows| {
        text.clear();
        match rows {
            Rows::F32(rows) => lines(rows.rows(), delimiter, &mut text),
            Rows::F64(rows) => lines(rows.rows(), delimiter, &mut text),
        }
        out.put(&text)
    })
}

fn lines<'a, T: Scalar>(rows: impl Iterator<Item = &'a [T]>, delimiter: u8, text: &mut Vec<u8>) {
    let mut buffer = zmij::Buffer::new();
    for row in rows {
        for (j, &value) in row.iter().enumerate() {
            if j > 0 {
                text.push(delimiter);
            }
            let wide: f64 = value.into();
            let digits = buffer.format(wide);
            text.extend_from_slice(digits.strip_suffix(".0").unwrap_or(digits).as_bytes());
        }
        text.push(b'\n');
    }
}

/// The line of names; none when there are no names, or when one reads like a number and so the line like a point.
fn header(columns: &[String], delimiter: u8) -> Option<Vec<u8>> {
    let numeric = |name: &String| {
        fast_float2::parse::<f64, _>(name.trim()).is_ok()
            || crate::read::is_failed_value(name.trim().as_bytes())
    };
    if columns.is_empty() || columns.iter().any(numeric) {
        return None;
    }
    let mut line = Vec::new();
    for (j, name) in columns.iter().enumerate() {
        if j > 0 {
            line.push(delimiter);
        }
        name_to_text(name, delimiter, &mut line);
    }
    line.push(b'\n');
    Some(line)
}

/// Appends a name, in quotes where it holds what could be taken for something else.
pub(super) fn name_to_text(name: &str, delimiter: u8, line: &mut Vec<u8>) {
    let plain = !name.is_empty()
        && name
            .bytes()
            .all(|b| b != delimiter && !b.is_ascii_whitespace() && !b"\"#,;".contains(&b));
    match plain {
        true => line.extend_from_slice(name.as_bytes()),
        false => {
            line.push(b'"');
            line.extend_from_slice(name.replace('"', "\"\"").as_bytes());
            line.push(b'"');
        }
    }
}
