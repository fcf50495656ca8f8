//! Lines with a height each as features of GeoJSON, place by place.
//!
//! *Guarantee.* Coordinates are the shortest decimals that read back to the same bits. No line is held.

use std::path::Path;

use super::Text;
use crate::create::AtomicFile;
use crate::write::OutputFile;
use crate::{Error, Format};

/// A file of lines in the making. Dropped without [`finish`](Self::finish), it leaves no trace.
pub struct LineFile<'a> {
    text: Text<'a>,
    lines: u64,
    places: u64,
}

impl<'a> LineFile<'a> {
    /// Begins the file `path`, which messages show as `shown`; the extensions `.gz`, `.xz` and `.zst` compress.
    ///
    /// # Errors
    /// Those of [`create`](crate::create).
    pub fn create(path: &Path, shown: &'a str) -> Result<Self, Error> {
        let out = OutputFile::create(path, shown, Format::of_path(path).1)?;
        let mut text = Text { bytes: Vec::new(), out };
        text.put("{\"type\": \"FeatureCollection\", \"features\": [");
        Ok(Self { text, lines: 0, places: 0 })
    }

    /// Begins a line of a height.
    ///
    /// # Errors
    /// Those of writing.
    pub fn begin(&mut self, height: f64) -> Result<(), Error> {
        self.text.put(if self.lines == 0 { "\n" } else { ",\n" });
        self.text.put("{\"type\": \"Feature\", \"properties\": {\"height\": ");
        self.text.number(height);
        self.text.put("}, \"geometry\": {\"type\": \"LineString\", \"coordinates\": [");
        (self.lines, self.places) = (self.lines + 1, 0);
        Ok(())
    }

    /// Goes on to a place.
    ///
    /// # Errors
    /// Those of writing.
    pub fn to(&mut self, at: [f64; 2]) -> Result<(), Error> {
        if self.places > 0 {
            self.text.put(", ");
        }
        self.places += 1;
        super::geojson::place(at, &mut self.text);
        self.text.spill()
    }

    /// Ends the line.
    ///
    /// # Errors
    /// Those of writing.
    pub fn end(&mut self) -> Result<(), Error> {
        self.text.put("]}}");
        self.text.spill()
    }

    /// The complete file, not yet in its place.
    ///
    /// # Errors
    /// Those of writing.
    pub fn finish(mut self) -> Result<AtomicFile, Error> {
        self.text.put("\n]}\n");
        self.text.flush()?;
        self.text.out.finish()
    }
}
