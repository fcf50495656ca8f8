//! Options to read points.

use std::path::PathBuf;

use taut_points::ScalarKind;

use crate::{Columns, Format};

/// Options to read points. Write `ReadOptions { memory: Some(1 << 30), ..Default::default() }`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadOptions {
    /// The format; by default that of the extension, or of the first bytes on standard input (CSV if they say nothing).
    pub format: Option<Format>,
    /// The columns that are coordinates, in this order; by default all (of parquet and arrow: all numeric ones).
    pub columns: Option<Columns>,
    /// A column of labels, by name or by number from 0: no coordinate, whatever the selection. In CSV, TSV and whitespace labels are
    /// any text; in other formats they are numbers. They are in [`Input::labels`](crate::Input::labels).
    pub label: Option<String>,
    /// States whether the first row of a text file holds names. Default [`Header::Auto`].
    pub header: Header,
    /// Most bytes of points held in memory; what is larger stays in its file or goes to a temporary one. Default: all.
    ///
    /// Uncompressed npy and raw files that fit are mapped, not copied: they must not change meanwhile, see
    /// [`MappedSource`](taut_points::MappedSource). Besides its points, the reader of parquet holds one batch of rows
    /// with the pages it comes from, whatever their size. What must be held whole is refused where it is too large: a line of
    /// text or a point of an array of more than an eighth of this memory, vertices and triangles of a mesh of more than half,
    /// a message of arrow or an array in Fortran order of more than all of it. All but the last may have 1 MiB in any case.
    pub memory: Option<u64>,
    /// The feature of a GeoJSON, WKT or SVG file whose positions are read; by default the only one.
    pub feature: Option<Feature>,
    /// The classes of points to keep, of a LAS or LAZ file; by default all. Points are numbered after that.
    pub classes: Option<Vec<u8>>,
    /// Shape and type of raw values, which no raw file tells itself. Needed for [`Format::Raw`] only.
    pub raw: Option<RawLayout>,
    /// Folder of temporary files. Default: that of the system.
    pub temp_dir: Option<PathBuf>,
}

/// One feature of a file that has several.
///
/// ```
/// use taut_io::Feature;
/// assert_eq!("3".parse(), Ok(Feature::Number(3)));
/// assert_eq!("Kenya".parse(), Ok(Feature::Name("Kenya".to_owned())));
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Feature {
    /// The number of a feature of GeoJSON, a geometry of WKT or a path of SVG, from 0.
    Number(u64),
    /// The property `name` (in either case) of a feature of GeoJSON, or the `id` of a path of SVG.
    Name(String),
}

impl std::str::FromStr for Feature {
    type Err = std::convert::Infallible;

    /// Reads digits as a number, and any other text as a name.
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Ok(text.parse().map_or_else(|_| Feature::Name(text.to_owned()), Feature::Number))
    }
}

/// States whether the first row of a text file holds the names of the columns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Header {
    /// It does if none of its selected fields is a number. Refused are a row with both names and numbers, and one with a
    /// field that begins as a number but is none (`1O`) or that stands for a missing one (`NA`, `null`, `?`, nothing).
    #[default]
    Auto,
    /// It does.
    Present,
    /// It does not: the first row is a point.
    Absent,
}

/// The way in which little-endian values without a header lie in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct RawLayout {
    /// Dimension d of a point, at least 1.
    pub dim: usize,
    /// Type of a coordinate.
    pub scalar: ScalarKind,
    /// Bytes before the first coordinate.
    pub offset: u64,
}
