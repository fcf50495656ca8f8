//! `taut formats`: what can be read and written.

use taut_io::{Compression, Format, MeshFormat, PolylineFormat, ShapeFormat};

use crate::exit::Outcome;
use crate::output::writing;

/// List the formats of points, meshes and curves, with what this build reads and writes.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: taut formats")]
pub(crate) struct Args {}

impl Args {
    pub(crate) fn run(&self) -> anyhow::Result<Outcome> {
        writing::print(table().as_bytes())?;
        Ok(Outcome::Done)
    }
}

fn table() -> String {
    let word = |able| if able { "yes" } else { "no" };
    let row = |format: Format| {
        let extensions = format.extensions().join(" ");
        [
            format.name().to_owned(),
            word(format.can_read()).to_owned(),
            word(format.can_write()).to_owned(),
            extensions,
        ]
    };
    let head = ["format", "read", "write", "extensions"].map(str::to_owned);
    let rows: Vec<[String; 4]> = std::iter::once(head).chain(Format::ALL.map(row)).collect();
    let notes = std::iter::once("what it is").chain(Format::ALL.map(Format::description));
    let widths: [usize; 4] =
        std::array::from_fn(|i| rows.iter().map(|row| row[i].len()).max().unwrap_or(0));

    let mut text = String::new();
    for (row, note) in rows.iter().zip(notes) {
        for (cell, width) in row.iter().zip(widths) {
            text += &format!("{cell:<width$}  ");
        }
        text += note;
        text.push('\n');
    }
    let packed: Vec<&str> =
        Compression::ALL.iter().flat_map(|packed| packed.extensions()).copied().collect();
    text += &format!(
        "\nAny of them may be compressed, with one of {} as a further extension.\n",
        packed.join(", ")
    );
    text += "\nMeshes of triangulations, compressed likewise:\n";
    for format in MeshFormat::ALL.into_iter().filter(|format| format.is_built()) {
        text += &format!("{:<9}{}\n", format.name(), format.description());
    }
    text += "\nCurves alone, compressed likewise:\n";
    for format in PolylineFormat::ALL {
        text += &format!("{:<9}{}\n", format.name(), format.description());
    }
    text += "\nSurfaces alone, compressed likewise:\n";
    for format in ShapeFormat::ALL.into_iter().filter(|format| format.can_write()) {
        text += &format!("{:<9}{}\n", format.name(), format.description());
    }
    text += "\nAnswers are written as json, pictures as svg, png and html.\n";
    text
}
