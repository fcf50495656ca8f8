//! The formats, their names, and how a file tells which one it has.

use std::fmt;
use std::path::Path;
use std::str::FromStr;

use crate::{Error, ShapeFormat};

/// A file format of points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// Text, a point per line, columns parted by commas (or semicolons or tabs, found in the first row).
    Csv,
    /// Text, columns parted by tabs.
    Tsv,
    /// Text, columns parted by any number of spaces and tabs.
    Whitespace,
    /// A NumPy array.
    Npy,
    /// Apache Parquet.
    Parquet,
    /// Arrow IPC, file or stream.
    Arrow,
    /// A problem of TSPLIB with coordinates.
    Tsplib,
    /// Three coordinates per line, with or without element symbols and a count line.
    Xyz,
    /// Positions of GeoJSON, or the outer ring of one polygon.
    GeoJson,
    /// The vertices of a Stanford PLY file.
    Ply,
    /// The vertices of a Wavefront OBJ file.
    Obj,
    /// The vertices of an Object File Format file.
    Off,
    /// The corners of a stereolithography file, equal ones once.
    Stl,
    /// Little-endian values without a header.
    Raw,
}

impl Format {
    /// Every format.
    pub const ALL: [Format; 14] = [
        Format::Csv,
        Format::Tsv,
        Format::Whitespace,
        Format::Npy,
        Format::Parquet,
        Format::Arrow,
        Format::Tsplib,
        Format::Xyz,
        Format::GeoJson,
        Format::Ply,
        Format::Obj,
        Format::Off,
        Format::Stl,
        Format::Raw,
    ];

    /// The name, as [`FromStr`] reads it.
    pub fn name(self) -> &'static str {
        match self {
            Format::Csv => "csv",
            Format::Tsv => "tsv",
            Format::Whitespace => "whitespace",
            Format::Npy => "npy",
            Format::Parquet => "parquet",
            Format::Arrow => "arrow",
            Format::Tsplib => "tsplib",
            Format::Xyz => "xyz",
            Format::GeoJson => "geojson",
            Format::Ply => "ply",
            Format::Obj => "obj",
            Format::Off => "off",
            Format::Stl => "stl",
            Format::Raw => "raw",
        }
    }

    /// The extensions that mean this format, in lower case and without a dot.
    pub fn extensions(self) -> &'static [&'static str] {
        match self {
            Format::Csv => &["csv"],
            Format::Tsv => &["tsv", "tab"],
            Format::Whitespace => &["txt", "dat", "xy", "asc"],
            Format::Npy => &["npy"],
            Format::Parquet => &["parquet", "pq"],
            Format::Arrow => &["arrow", "arrows", "feather", "ipc"],
            Format::Tsplib => &["tsp"],
            Format::Xyz => &["xyz", "pts"],
            Format::GeoJson => &["geojson"],
            Format::Ply => &["ply"],
            Format::Obj => &["obj"],
            Format::Off => &["off"],
            Format::Stl => &["stl"],
            Format::Raw => &["raw", "bin", "f32", "f64"],
        }
    }

    /// One line for a list of formats.
    pub fn description(self) -> &'static str {
        match self {
            Format::Csv => "comma-separated text (also ; and tab), header found or not, # comments",
            Format::Tsv => "tab-separated text",
            Format::Whitespace => "text, columns parted by spaces and tabs",
            Format::Npy => "NumPy array, n × d or n; f4, f8 and integers, either byte order",
            Format::Parquet => "Apache Parquet, numeric columns or one list column",
            Format::Arrow => {
                "Arrow IPC (Feather), file or stream, numeric columns or one list column"
            }
            Format::Tsplib => "TSPLIB problem with a NODE_COORD_SECTION, not on the earth (GEO)",
            Format::Xyz => {
                "x y z per line, optional element symbol, optional count and comment lines"
            }
            Format::GeoJson => "GeoJSON: positions, or the ring of one polygon without holes",
            Format::Ply => "Stanford PLY, text or binary: its vertices",
            Format::Obj => "Wavefront OBJ, text: its vertices",
            Format::Off => "Object File Format, text: its vertices",
            Format::Stl => "stereolithography, text or binary: its corners, equal ones once",
            Format::Raw => "little-endian f32 or f64 without a header; needs dimension and type",
        }
    }

    /// Whether [`open`](crate::open) reads it in this build.
    pub fn can_read(self) -> bool {
        cfg!(feature = "arrow") || !matches!(self, Format::Parquet | Format::Arrow)
    }

    /// Whether [`write_points`](crate::write_points) writes it in this build.
    pub fn can_write(self) -> bool {
        let shape = self.shape().is_some();
        !shape && !matches!(self, Format::Tsplib | Format::GeoJson) && self.can_read()
    }

    /// Of a format of shapes, which.
    pub(crate) fn shape(self) -> Option<ShapeFormat> {
        match self {
            Format::Ply => Some(ShapeFormat::Ply),
            Format::Obj => Some(ShapeFormat::Obj),
            Format::Off => Some(ShapeFormat::Off),
            Format::Stl => Some(ShapeFormat::Stl),
            _ => None,
        }
    }

    /// The format and compression that the name of a file tells: `points.csv.gz` is CSV and gzip.
    pub fn of_path(path: &Path) -> (Option<Format>, Option<Compression>) {
        let (inner, compression) = Compression::split(path);
        let format = inner.and_then(|inner| {
            Format::ALL.into_iter().find(|format| format.extensions().contains(&inner.as_str()))
        });
        (format, compression)
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Format {
    type Err = Error;

    /// Reads a name or an extension, in either case.
    fn from_str(text: &str) -> Result<Self, Error> {
        let lower = text.to_ascii_lowercase();
        Format::ALL
            .into_iter()
            .find(|format| format.name() == lower || format.extensions().contains(&lower.as_str()))
            .ok_or_else(|| Error::FormatName { name: text.to_owned() })
    }
}

/// How a file is compressed as a whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Compression {
    /// `.gz`
    Gzip,
    /// `.xz`
    Xz,
    /// `.zst`
    Zstd,
}

impl Compression {
    /// Every compression.
    pub const ALL: [Compression; 3] = [Compression::Gzip, Compression::Xz, Compression::Zstd];

    /// The name.
    pub fn name(self) -> &'static str {
        match self {
            Compression::Gzip => "gzip",
            Compression::Xz => "xz",
            Compression::Zstd => "zstd",
        }
    }

    /// The extensions that mean this compression; the first is the usual one.
    pub fn extensions(self) -> &'static [&'static str] {
        match self {
            Compression::Gzip => &["gz"],
            Compression::Xz => &["xz"],
            Compression::Zstd => &["zst", "zstd"],
        }
    }

    /// The extension of a file, in lower case and without that of a compression, and the compression.
    pub(crate) fn split(path: &Path) -> (Option<String>, Option<Compression>) {
        let extension = |path: &Path| Some(path.extension()?.to_str()?.to_ascii_lowercase());
        let last = extension(path);
        let compression = last
            .as_deref()
            .and_then(|last| Compression::ALL.into_iter().find(|c| c.extensions().contains(&last)));
        let inner = match compression {
            Some(_) => path.file_stem().and_then(|stem| extension(Path::new(stem))),
            None => last,
        };
        (inner, compression)
    }

    /// The compression whose files begin with these bytes.
    pub(crate) fn of_magic(bytes: &[u8]) -> Option<Compression> {
        let magic: [(&[u8], Compression); 3] = [
            (&[0x1f, 0x8b], Compression::Gzip),
            (&[0xfd, b'7', b'z', b'X', b'Z', 0], Compression::Xz),
            (&[0x28, 0xb5, 0x2f, 0xfd], Compression::Zstd),
        ];
        magic.into_iter().find(|(magic, _)| bytes.starts_with(magic)).map(|(_, found)| found)
    }
}

impl fmt::Display for Compression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}
