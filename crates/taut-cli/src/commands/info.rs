//! `taut info`: what a file holds, before anything is done with it.

use std::path::Path;

use serde_json::{Value, json};
use taut_io::{ColumnDescription, Content, Description, Format, describe, open_mesh};

use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::reading::{Points, Reading};
use crate::output::numbers::{count, counted, exact};
use crate::output::writing;

/// Describe a file: rows, columns, types, bounds, duplicates and missing values.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Rows that lack a value are counted, not refused; which words stand for a missing value is told by docs/tables.md.
Exit: 0 done · 2 bad input or usage
Example: taut info towns.csv
         taut info scan.laz --json")]
pub(crate) struct Args {
    #[command(flatten)]
    points: Points,
    /// Print JSON instead of the summary
    #[arg(long, help_heading = "Writing")]
    json: bool,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    effort: Effort,
}

impl Args {
    pub(crate) fn run(&self) -> anyhow::Result<Outcome> {
        self.effort.start()?;
        let path = &self.points.path;
        let found = describe(path, &self.reading.options()?)?;
        let triangles = triangles(path, self.reading.format())?;
        let text = match self.json {
            true => format!("{:#}\n", to_json(&found, triangles)),
            false => to_text(&self.points.path, &found, triangles),
        };
        if self.json || !self.effort.quiet {
            writing::print(text.as_bytes())?;
        }
        Ok(Outcome::Done)
    }
}

/// The triangles of a file that can be a mesh, if it has some.
fn triangles(path: &Path, format: Option<Format>) -> anyhow::Result<Option<u64>> {
    let format = format.or(Format::of_path(path).0);
    let is_mesh = format.is_some_and(|format| format.reads(Content::Surface));
    if !is_mesh || format == Some(Format::Xyz) || writing::is_stream(path) || path.is_dir() {
        return Ok(None);
    }
    let mesh = open_mesh(path, Content::Surface, format)?;
    Ok(Some(mesh.triangles().len() as u64).filter(|&triangles| triangles > 0))
}

fn to_json(found: &Description, triangles: Option<u64>) -> Value {
    let column = |column: &ColumnDescription| {
        json!({
            "name": column.name,
            "type": column.kind.name(),
            "missing": column.missing,
            "least": column.range.map(|[least, _]| least),
            "largest": column.range.map(|[_, largest]| largest),
        })
    };
    json!({
        "format": found.format.name(),
        "rows": found.rows,
        "columns": found.columns.iter().map(column).collect::<Vec<_>>(),
        "duplicates": found.duplicates,
        "incomplete": found.incomplete,
        "triangles": triangles,
    })
}

fn to_text(path: &Path, found: &Description, triangles: Option<u64>) -> String {
    let name = match writing::is_stream(path) {
        true => "standard input".to_owned(),
        false => path.display().to_string(),
    };
    let (rows, columns) =
        (counted(found.rows, "row"), counted(found.columns.len() as u64, "column"));
    let mut text = format!("{}: {rows}, {columns}, {}\n", writing::printable(&name), found.format);
    let head = ["column", "type", "missing", "least", "largest"].map(str::to_owned);
    let cells = found.columns.iter().map(|column| {
        let [least, largest] = match column.range {
            Some(range) => range.map(exact),
            None => ["-", "-"].map(str::to_owned),
        };
        let name = writing::printable(&column.name);
        [name, column.kind.name().to_owned(), count(column.missing), least, largest]
    });
    let lines: Vec<[String; 5]> = std::iter::once(head).chain(cells).collect();
    let widths: [usize; 5] = std::array::from_fn(|at| {
        lines.iter().map(|line| line[at].chars().count()).max().unwrap_or(0)
    });
    for line in &lines {
        let cells = line.iter().zip(widths).map(|(cell, width)| format!("{cell:<width$}"));
        text += &format!("  {}\n", cells.collect::<Vec<_>>().join("  ").trim_end());
    }
    text += &match found.duplicates {
        Some(duplicates) => format!("duplicates  {}\n", count(duplicates)),
        None => "duplicates  not counted: too many rows\n".to_owned(),
    };
    text += &format!("incomplete  {}\n", count(found.incomplete));
    if let Some(triangles) = triangles {
        text += &format!("triangles   {}\n", count(triangles));
    }
    text
}
