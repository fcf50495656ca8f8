//! `taut formats`: what can be read and written.

use taut_io::{Compression, Content, Format};

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
            word(format.reads(Content::Points)).to_owned(),
            word(format.writes(Content::Points)).to_owned(),
            extensions,
        ]
    };
    let head = ["format", "read", "write", "extensions"].map(str::to_owned);
    let rows: Vec<[String; 4]> =
        std::iter::once(head).chain(Format::of(Content::Points).map(row)).collect();
    let notes = Format::of(Content::Points).map(|format| format.description(Content::Points));
    let notes = std::iter::once("what it is").chain(notes);
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
    let built = Compression::ALL.into_iter().filter(|packed| packed.is_built());
    let packed: Vec<&str> = built.flat_map(|packed| packed.extensions()).copied().collect();
    text += &format!(
        "\nAny of them may be compressed, with one of {} as a further extension.\n",
        packed.join(", ")
    );
    for (title, content) in [
        ("Meshes of triangulations", Content::Triangulation),
        ("Curves alone", Content::Curves),
        ("Surfaces alone", Content::Surface),
    ] {
        text += &format!("\n{title}, compressed likewise:\n");
        for format in Format::of(content).filter(|format| format.writes(content)) {
            text += &format!("{:<9}{}\n", format.name(), format.description(content));
        }
    }
    text += "\nAnswers are written as json, pictures as svg, png and html.\n";
    text
}
