//! Rows that were found, as CSV or JSON.

use serde_json::{Map, Value, json};
use taut::enclose::{Diameter, Neighbor, RowPair};

use crate::output::numbers::exact;

/// A table of row numbers and distances.
pub(super) struct Table {
    columns: Vec<&'static str>,
    /// The number of the query, where there is one, then row numbers, then distances.
    lines: Vec<(Vec<u64>, Vec<f64>)>,
}

impl Table {
    /// What each query found, its number first.
    pub(super) fn of_queries(query: &'static str, found: Vec<Vec<Neighbor>>) -> Self {
        let lines = found.into_iter().enumerate().flat_map(|(number, found)| {
            let line =
                move |found: Neighbor| (vec![number as u64, found.row], vec![found.distance]);
            found.into_iter().map(line)
        });
        Table { columns: vec![query, "row", "distance"], lines: lines.collect() }
    }

    pub(super) fn of_pairs(pairs: &[RowPair]) -> Self {
        let lines = pairs.iter().map(|pair| (pair.rows.to_vec(), vec![pair.distance]));
        Table { columns: vec!["row", "other", "distance"], lines: lines.collect() }
    }

    pub(super) fn of_diameter(found: &Diameter) -> Self {
        Table {
            columns: vec!["row", "other", "distance", "upper_bound"],
            lines: vec![(found.rows.to_vec(), vec![found.distance, found.upper_bound])],
        }
    }

    pub(super) fn text(&self, as_json: bool) -> String {
        if as_json { self.json() } else { self.csv() }
    }

    fn csv(&self) -> String {
        let mut text = self.columns.join(",") + "\n";
        for (rows, distances) in &self.lines {
            let numbers = distances.iter().copied().map(exact);
            let fields: Vec<String> = rows.iter().map(u64::to_string).chain(numbers).collect();
            text += &(fields.join(",") + "\n");
        }
        text
    }

    /// A list of objects, one for each line.
    fn json(&self) -> String {
        let object = |(rows, distances): &(Vec<u64>, Vec<f64>)| {
            let values = rows.iter().map(|&row| json!(row));
            let values = values.chain(distances.iter().map(|&distance| json!(distance)));
            let fields = self.columns.iter().map(|&name| name.to_owned()).zip(values);
            Value::Object(fields.collect::<Map<_, _>>())
        };
        let lines: Vec<Value> = self.lines.iter().map(object).collect();
        Value::Array(lines).to_string() + "\n"
    }
}
