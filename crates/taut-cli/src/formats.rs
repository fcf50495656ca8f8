//! `taut formats`: what can be read and written.

use std::fmt::Write;

use taut_io::{Compression, Format};

use crate::exit::Outcome;
use crate::writing;

/// List the formats of points, with what this build reads and writes.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: taut formats")]
pub(crate) struct Args {}

impl Args {
    pub(crate) fn run(&self) -> anyhow::Result<Outcome> {
        writing::say(table().as_bytes())?;
        Ok(Outcome::Done)
    }
}

fn table() -> String {
    let mut text = format!(
        "{:<12}{:<7}{:<7}{:<24}{}\n",
        "format", "read", "write", "extensions", "what it is"
    );
    let word = |able| if able { "yes" } else { "no" };
    for format in Format::ALL {
        let extensions = format.extensions().join(" ");
        let (read, write) = (word(format.can_read()), word(format.can_write()));
        writeln!(
            text,
            "{:<12}{read:<7}{write:<7}{extensions:<24}{}",
            format.name(),
            format.description()
        )
        .expect("text grows");
    }
    let packed: Vec<&str> =
        Compression::ALL.iter().flat_map(|compression| compression.extensions()).copied().collect();
    writeln!(text, "\nEach may be compressed: a further extension {}.", packed.join(", "))
        .expect("text grows");
    text.push_str("Pictures are written as svg, png and html; answers as json.\n");
    text
}
