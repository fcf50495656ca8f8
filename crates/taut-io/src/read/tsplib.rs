//! Problems of TSPLIB: keywords, then a NODE_COORD_SECTION of `number x y` or `number x y z` lines.
//!
//! *Trap.* Problems of type GEO give latitude and longitude, degrees and minutes as one number. They are no points of the
//! plane and are refused. All other types with coordinates (EUC, MAX, MAN, CEIL, ATT, XRAY; 2D and 3D) differ in how the
//! length of an edge is rounded or measured, and their coordinates are points as they stand.
//! *Reference.* Reinelt, TSPLIB 95 (file format, section 1).

use std::io::BufRead;

use super::Decoded;
use super::lines::Lines;
use super::rows::{Delimiter, Rows, is_number, shown, split};
use crate::input::Job;
use crate::sink::Sink;
use crate::{Error, FilePlace, Format};

pub(super) fn read(job: &Job<'_>, stream: Box<dyn BufRead>) -> Result<Decoded, Error> {
    let mut lines = Lines::new(stream, job);
    let n = dimension(job, &mut lines)?;
    let Some(first) = lines.next_data()?.filter(|(_, line)| is_node(line)) else {
        return Err(Error::NoRows { path: job.path.to_owned() });
    };
    let width = match split(first.1, Delimiter::White).len() {
        fields @ 3..=4 => fields - 1,
        fields => {
            let problem = format!(
                "line {} has {fields} values, not a node number and 2 or 3 coordinates",
                first.0
            );
            return Err(damaged(job, problem));
        }
    };
    let mut rows = Rows::new(job, Delimiter::White, 1, width);
    rows.names = ["x", "y", "z"][..width].iter().map(|&name| name.to_owned()).collect();
    if let Some(columns) = &job.options.columns {
        rows.numbers = Some(columns.resolve(job.path, &rows.names, width)?);
    }
    let mut sink = Sink::new(job, rows.dim());
    let mut next = Some(first);
    while let Some(node) = next.filter(|(_, line)| is_node(line)) {
        rows.push(node, &mut sink)?;
        next = lines.next_data()?;
    }
    let found = sink.len();
    if found != n {
        let path = job.path.to_owned();
        return Err(Error::Count {
            path,
            format: Format::Tsplib,
            expected: n,
            found,
            unit: ("node", "nodes"),
        });
    }
    let (columns, numbers) = (rows.coordinate_names(), rows.numbers.take());
    Ok(Decoded { source: sink.finish()?, columns, numbers, labels: Vec::new() })
}

/// Reads up to the coordinates and returns what DIMENSION says; refuses coordinates on a sphere.
fn dimension(job: &Job<'_>, lines: &mut Lines<'_>) -> Result<u64, Error> {
    let mut n = None;
    while let Some((number, line)) = lines.next_data()? {
        let line = String::from_utf8_lossy(line);
        let (key, value) = line.split_once(':').unwrap_or((&line, ""));
        match key.trim() {
            "NODE_COORD_SECTION" => {
                return n.ok_or_else(|| damaged(job, "it has no DIMENSION".to_owned()));
            }
            "EDGE_WEIGHT_TYPE" if value.trim() == "GEO" => {
                return Err(Error::Geographic { path: job.path.to_owned(), line: number });
            }
            "DIMENSION" => {
                n = Some(value.trim().parse().map_err(|_| {
                    let value = shown(value.trim().as_bytes());
                    damaged(job, format!("DIMENSION on line {number} is `{value}`, not a count"))
                })?);
            }
            _ => {}
        }
    }
    Err(damaged(job, "it has no NODE_COORD_SECTION, so no coordinates".to_owned()))
}

/// Returns true if a line is a node: EOF, `-1` and the next section end the list.
fn is_node(line: &[u8]) -> bool {
    let line = line.trim_ascii();
    line != b"-1" && line.split(|b| b.is_ascii_whitespace()).next().is_some_and(is_number)
}

fn damaged(job: &Job<'_>, problem: String) -> Error {
    Error::Damaged {
        path: job.path.to_owned(),
        format: Format::Tsplib,
        place: FilePlace::File,
        problem,
    }
}
