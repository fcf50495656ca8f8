//! Points in memory, from bytes or from a formula.

use serde_json::{Value, json};
use taut::PointSource;
use taut::points::InputError;
use taut_io::{Input, ReadOptions, open_bytes};

/// Points with their name.
pub(crate) struct Opened {
    points: Origin,
    name: String,
}

enum Origin {
    File(Box<Input>),
    Formula(Box<dyn PointSource>),
}

impl std::fmt::Debug for Opened {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Opened").field("name", &self.name).finish_non_exhaustive()
    }
}

impl Opened {
    /// Reads the bytes of a file.
    pub(crate) fn read(bytes: Vec<u8>, name: &str) -> Result<Self, String> {
        let input = open_bytes(bytes, name, &ReadOptions::default()).map_err(|e| e.to_string())?;
        let name = input.path.clone();
        Ok(Opened { points: Origin::File(Box::new(input)), name })
    }

    /// Points that are calculated.
    pub(crate) fn made(source: Box<dyn PointSource>, name: &str) -> Self {
        Opened { points: Origin::Formula(source), name: name.to_owned() }
    }

    pub(crate) fn source(&self) -> &dyn PointSource {
        match &self.points {
            Origin::File(input) => &*input.source,
            Origin::Formula(source) => &**source,
        }
    }

    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    /// Names of the first `dim` coordinates, as far as the file has some.
    pub(crate) fn columns(&self, dim: usize) -> Vec<String> {
        match &self.points {
            Origin::File(input) => input.columns.iter().take(dim).cloned().collect(),
            Origin::Formula(_) => Vec::new(),
        }
    }

    pub(crate) fn describe(&self) -> Value {
        let source = self.source();
        json!({ "name": self.name, "rows": source.len(), "columns": source.dim() })
    }

    /// Returns what a solver refused, with the place in the file, which it cannot know.
    pub(crate) fn explain(&self, error: impl Into<taut::Error>) -> String {
        match (error.into(), &self.points) {
            (
                taut::Error::Input(InputError::NonFinite { row, column, value }),
                Origin::File(input),
            ) => {
                let place = input.describe_cell(row, column);
                format!("{place}: the value is {value}, and all coordinates must be finite")
            }
            (other, _) => format!("{}: {other}", self.name),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The file of a NumPy array of two rows and two columns.
    fn npy(values: [f64; 4]) -> Vec<u8> {
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 2), }";
        let padded = format!("{header:<117}\n");
        bytes.extend(u16::try_from(padded.len()).unwrap().to_le_bytes());
        bytes.extend(padded.as_bytes());
        values.iter().for_each(|value| bytes.extend(value.to_le_bytes()));
        bytes
    }

    #[test]
    fn the_formats_of_the_page_are_read() {
        let ply = b"ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n\
                    property float z\nend_header\n0 1 2\n3 4 5\n";
        let geo = br#"{"type":"MultiPoint","coordinates":[[0,1],[2,3]]}"#;
        for (name, bytes, dim) in [
            ("a.csv", b"x,y\n0,1\n2,3\n".to_vec(), 2),
            ("a.npy", npy([0.0, 1.0, 2.0, 3.0]), 2),
            ("a.ply", ply.to_vec(), 3),
            ("a.xyz", b"0 1 2\n3 4 5\n".to_vec(), 3),
            ("a.geojson", geo.to_vec(), 2),
        ] {
            let opened = Opened::read(bytes, name).unwrap();
            assert_eq!((opened.source().len(), opened.source().dim()), (2, dim), "{name}");
        }
    }

    #[test]
    fn a_number_that_is_none_is_named_with_its_row() {
        let words = Opened::read(b"x,y\n0,1\nnan,3\n".to_vec(), "a.csv").unwrap_err();
        assert!(words.contains("a.csv") && words.contains("row 2"), "{words}");
        // Text is read as a whole when it is opened, arrays when they are solved.
        let opened = Opened::read(npy([0.0, 1.0, f64::NAN, 3.0]), "a.npy").unwrap();
        let refused = taut::ball(opened.source(), &taut::BallOptions::default()).unwrap_err();
        let words = opened.explain(refused);
        assert!(words.contains("a.npy") && words.contains("row 2"), "{words}");
    }
}
