//! Tables that line up on a terminal and are Markdown as they stand, and whose rows go to the report.

use crate::prelude::*;

/// Rows of values under a head.
pub(crate) struct Table {
    columns: Vec<(String, Unit)>,
    rows: Vec<Value>,
}

impl Table {
    /// A table with these columns: names between bars, a unit behind the colon where values are to be shown in one.
    ///
    /// Units are `s` (seconds), `ns` (seconds as nanoseconds), `x` (a ratio), `e` and `ee` (a power of ten, with one digit
    /// or two), `%` (a share), `MiB` (bytes), and a digit, so many of them after the point.
    pub(crate) fn new(columns: &str) -> Self {
        let column = |text: &str| {
            let (name, unit) = text.rsplit_once(':').unwrap_or((text, ""));
            let unit = match unit {
                "" => Unit::Plain,
                "s" => Unit::Seconds,
                "ns" => Unit::Nanoseconds,
                "x" => Unit::Times,
                "e" => Unit::Power,
                "ee" => Unit::Error,
                "%" => Unit::Percent,
                "MiB" => Unit::Memory,
                // A name with a colon in it.
                digits => match digits.parse() {
                    Ok(digits) => Unit::Fixed(digits),
                    Err(_) => return (text.to_owned(), Unit::Plain),
                },
            };
            (name.to_owned(), unit)
        };
        Table { columns: columns.split(" | ").map(column).collect(), rows: vec![] }
    }

    /// Adds a row: a list of values, or an object whose fields are found by the names of columns. Other fields go to the
    /// report alone.
    pub(crate) fn push(&mut self, row: impl Into<Value>) {
        let row = match row.into() {
            Value::Array(values) => {
                let names = self.columns.iter().map(|(name, _)| name.clone());
                names.zip(values).collect()
            }
            row => row,
        };
        self.rows.push(row);
    }

    /// The rows, for the report.
    pub(crate) fn into_json(self) -> Value {
        self.rows.into()
    }

    /// What a cell shows.
    fn cell(value: &Value, unit: Unit) -> String {
        match value {
            Value::Null => String::new(),
            Value::String(text) => text.clone(),
            Value::Bool(is) => if *is { "yes" } else { "no" }.to_owned(),
            Value::Number(number) if number.is_f64() || unit != Unit::Plain => {
                number.as_f64().map_or(String::new(), |value| unit.show(value))
            }
            Value::Number(number) => number.to_string(),
            Value::Array(values) => {
                let cells: Vec<String> =
                    values.iter().map(|value| Table::cell(value, unit)).collect();
                cells.join(" ")
            }
            // A summary of several runs.
            Value::Object(_) => {
                let [median, min, max] =
                    ["median", "min", "max"].map(|key| Table::cell(&value[key], unit));
                format!("{median} ({min}–{max})")
            }
        }
    }
}

impl std::fmt::Display for Table {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let cells = |row: &Value| -> Vec<String> {
            self.columns.iter().map(|(name, unit)| Table::cell(&row[name], *unit)).collect()
        };
        let mut rows: Vec<Vec<String>> =
            vec![self.columns.iter().map(|(name, _)| name.clone()).collect()];
        rows.extend(self.rows.iter().map(cells));
        let widths: Vec<usize> = (0..self.columns.len())
            .map(|c| rows.iter().map(|row| row[c].chars().count()).max().unwrap_or(0).max(3))
            .collect();
        for (at, row) in rows.iter().enumerate() {
            for (cell, &width) in row.iter().zip(&widths) {
                write!(f, "| {cell:<width$} ")?;
            }
            writeln!(f, "|")?;
            if at == 0 {
                for width in &widths {
                    write!(f, "|{}", "-".repeat(width + 2))?;
                }
                writeln!(f, "|")?;
            }
        }
        Ok(())
    }
}

/// One object with the fields of several, for a row that is put together.
pub(crate) fn joined<const N: usize>(parts: [Value; N]) -> Value {
    let fields = parts.into_iter().filter_map(|part| match part {
        Value::Object(fields) => Some(fields),
        _ => None,
    });
    fields.flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_line_up_and_the_head_is_ruled() {
        assert_eq!(Table::new("taut: all").columns, [("taut: all".to_owned(), Unit::Plain)]);
        let mut table = Table::new("who | time:ns");
        table.push(json!(["somebody", 1e-9]));
        table.push(json!({ "who": 7, "more": [1] }));
        assert_eq!(
            table.to_string(),
            "| who      | time    |\n|----------|---------|\n| somebody | 1.00 ns |\n| 7        \
                |         |\n"
        );
        assert_eq!(
            table.into_json(),
            json!([{ "who": "somebody", "time": 1e-9 }, { "who": 7, "more": [1] }])
        );
    }

    #[test]
    fn values_are_shown_in_their_unit() {
        let cell = |value, unit| Table::cell(&value, unit);
        assert_eq!(cell(json!(0.5), Unit::Percent), "50.00 %");
        assert_eq!(cell(json!(true), Unit::Plain), "yes");
        assert_eq!(cell(json!(Summary::of(&[2.0, 1.0, 3.0])), Unit::Times), "2.00 (1.00–3.00)");
        assert_eq!(cell(json!([1, 2]), Unit::Plain), "1 2");
        assert_eq!(cell(json!(f64::NAN), Unit::Seconds), "");
    }
}
