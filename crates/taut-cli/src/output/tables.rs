//! Parts of an answer as tables: centers, assignments, outliers, core-sets, orders.
//!
//! *Names.* Rows are numbered as in the file, from 0 as in JSON; where rows have names, a second column has these.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use anyhow::{anyhow, bail};
use taut_io::{Column, Format, Table, table_formats};

use crate::input::reading::Opened;
use crate::output::writing::{self, Outputs};

/// The name of a table and the file that it goes to.
#[derive(Clone, Debug)]
struct TableFile {
    name: String,
    path: PathBuf,
}

impl FromStr for TableFile {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts =
            text.split_once('=').filter(|(name, path)| !name.is_empty() && !path.is_empty());
        let (name, path) =
            parts.ok_or("expected the name of a table, = and a file, such as outliers=out.csv")?;
        Ok(TableFile { name: name.to_owned(), path: path.into() })
    }
}

/// The option for tables, of subcommands whose answers have some.
#[derive(Clone, Debug, Default, clap::Args)]
pub(crate) struct TableFiles {
    /// Write a part of the answer as a table, .csv, .tsv, .npy, .parquet or .arrow: NAME is centers, assignment, outliers, support,
    /// core-set or order, as far as the answer has it; may be given several times
    #[arg(long = "table", value_name = "NAME=FILE", help_heading = "Writing")]
    files: Vec<TableFile>,
}

/// The tables of an answer, by name; the first is what `-o` writes where its name is that of a table.
pub(crate) type Tables = Vec<(&'static str, Table)>;

impl TableFiles {
    /// Tests whether the table of a name is asked for.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.files.iter().any(|file| file.name == name)
    }

    /// Tests whether any table is asked for.
    pub(crate) fn is_asked(&self) -> bool {
        !self.files.is_empty()
    }

    /// The files, which may not be written over.
    pub(crate) fn paths(&self) -> Vec<&Path> {
        self.files.iter().map(|file| &*file.path).collect()
    }

    /// Refuses names of tables that an answer of this kind never has, and files that are no tables.
    pub(crate) fn check(&self, known: &[&str]) -> anyhow::Result<()> {
        for TableFile { name, path } in &self.files {
            if !known.contains(&&**name) {
                bail!("option `--table` is {name}: expected {}", known.join(", "));
            }
            if !is_table(path) {
                bail!("{}: tables are {}; name one of these", path.display(), extensions());
            }
        }
        Ok(())
    }

    /// Prepares the tables that are asked for.
    pub(crate) fn write(&self, tables: &Tables, outputs: &mut Outputs) -> anyhow::Result<()> {
        for TableFile { name, path } in &self.files {
            let table = tables.iter().find(|(known, _)| known == name);
            let (_, table) = table.ok_or_else(|| anyhow!("this answer has no table `{name}`"))?;
            outputs.add_table(path, table)?;
        }
        Ok(())
    }
}

/// Tests whether the name of a file is that of a table.
pub(crate) fn is_table(path: &Path) -> bool {
    !writing::is_stream(path)
        && Format::of_path(path)
            .0
            .is_some_and(|format| table_formats().any(|table| table == format))
}

/// The extensions of tables, for messages.
pub(crate) fn extensions() -> String {
    let names: Vec<String> =
        table_formats().map(|format| format!(".{}", format.extensions()[0])).collect();
    names.join(", ")
}

/// A table of rows of the file, with their names where they have some.
pub(crate) fn rows(points: &Opened, rows: &[u64]) -> Table {
    let in_file = rows.iter().map(|&row| points.row(row) - 1).collect();
    let table = Table::new().with("row", Column::Whole(in_file));
    let labels = points.labels();
    match labels.is_empty() {
        true => table,
        false => {
            let name = |&row: &u64| labels.get(row as usize).cloned().unwrap_or_default();
            table.with("id", Column::Text(rows.iter().map(name).collect()))
        }
    }
}

/// The table with the coordinates of places, a column each.
pub(crate) fn with_places(table: Table, points: &Opened, places: &[Vec<f64>]) -> Table {
    let dim = places.first().map_or(0, Vec::len);
    let names = points.names(dim);
    (0..dim).fold(table, |table, column| {
        let name = names.get(column).cloned().unwrap_or_else(|| format!("x{column}"));
        let values = places.iter().map(|place| place[column]).collect();
        table.with(name, Column::Real(values))
    })
}
