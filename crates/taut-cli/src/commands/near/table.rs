//! Rows that were found, as CSV or JSON.

use serde_json::{Map, Value, json};
use taut::enclose::{Diameter, Neighbor, RowPair};

use crate::input::reading::Opened;
use crate::output::numbers::exact;

/// A table of row numbers and distances.
pub(super) struct Table {
    columns: Vec<&'static str>,
    lines: Vec<Line>,
}

/// The number of the query, where there is one, then row numbers, then distances, and the names of the rows where they have some.
struct Line {
    rows: [u64; 2],
    distances: Vec<f64>,
    names: Vec<String>,
}

impl Line {
    fn new(rows: [u64; 2], distances: Vec<f64>) -> Self {
        Line { rows, distances, names: vec![] }
    }
}

impl Table {
    /// What each query found, its number first.
    pub(super) fn of_queries(query: &'static str, found: Vec<Vec<Neighbor>>) -> Self {
        let lines = found.into_iter().enumerate().flat_map(|(number, found)| {
            let line =
                move |found: Neighbor| Line::new([number as u64, found.row], vec![found.distance]);
            found.into_iter().map(line)
        });
        Table { columns: vec![query, "row", "distance"], lines: lines.collect() }
    }

    pub(super) fn of_pairs(pairs: &[RowPair]) -> Self {
        let lines = pairs.iter().map(|pair| Line::new(pair.rows, vec![pair.distance]));
        Table { columns: vec!["row", "other", "distance"], lines: lines.collect() }
    }

    pub(super) fn of_diameter(found: &Diameter) -> Self {
        Table {
            columns: vec!["row", "other", "distance", "upper_bound"],
            lines: vec![Line::new(found.rows, vec![found.distance, found.upper_bound])],
        }
    }

    /// The table with rows as they are numbered in their files, and with their names where they have some; each of the two
    /// columns of rows is of a file of its own.
    pub(super) fn of_files(mut self, files: [&Opened; 2]) -> Self {
        let is_named = files.iter().any(|file| !file.labels().is_empty());
        if is_named {
            self.columns.extend(match self.columns[0] {
                "query" => ["query_id", "row_id"],
                "ray" => ["ray_id", "row_id"],
                _ => ["row_id", "other_id"],
            });
        }
        for line in &mut self.lines {
            for (row, file) in line.rows.iter_mut().zip(files) {
                if is_named {
                    let name = usize::try_from(*row).ok().and_then(|row| file.labels().get(row));
                    line.names.push(name.cloned().unwrap_or_default());
                }
                *row = file.row(*row) - 1;
            }
        }
        self
    }

    pub(super) fn text(&self, as_json: bool) -> String {
        if as_json { self.json() } else { self.csv() }
    }

    fn csv(&self) -> String {
        let mut text = self.columns.join(",") + "\n";
        for Line { rows, distances, names } in &self.lines {
            let numbers = rows.iter().map(u64::to_string);
            let numbers = numbers.chain(distances.iter().copied().map(exact));
            let names = names.iter().map(|name| quoted(name));
            let fields: Vec<String> = numbers.chain(names).collect();
            text += &(fields.join(",") + "\n");
        }
        text
    }

    /// A list of objects, one for each line.
    fn json(&self) -> String {
        let object = |Line { rows, distances, names }: &Line| {
            let values = rows.iter().map(|&row| json!(row));
            let values = values.chain(distances.iter().map(|&distance| json!(distance)));
            let values = values.chain(names.iter().map(|name| json!(name)));
            let fields = self.columns.iter().map(|&name| name.to_owned()).zip(values);
            Value::Object(fields.collect::<Map<_, _>>())
        };
        let lines: Vec<Value> = self.lines.iter().map(object).collect();
        Value::Array(lines).to_string() + "\n"
    }
}

/// A name as CSV has it: between quotes where it holds a delimiter or a quote.
fn quoted(name: &str) -> String {
    match name.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", name.replace('"', "\"\"")),
        false => name.to_owned(),
    }
}
