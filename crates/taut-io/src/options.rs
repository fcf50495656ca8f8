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
    /// True to take, of the columns of a text file, those that hold numbers alone, and to pass over all others. Not beside `columns`.
    pub numeric: bool,
    /// What becomes of rows that lack a value. Default [`Missing::Refuse`].
    pub missing: Missing,
    /// The mark before the decimals of numbers in text. Default [`Decimal::Point`].
    pub decimal: Decimal,
    /// A column of labels, by name or by number from 0: no coordinate, whatever the selection. In CSV, TSV,
    /// whitespace, parquet and arrow labels are any text; in other formats they are numbers. They are in
    /// [`Input::labels`](crate::Input::labels).
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
    /// The feature of a GeoJSON, WKT or SVG file, the array of an npz file or the shape of a shapefile that is read; by default the
    /// only one, and of a shapefile all.
    pub feature: Option<Feature>,
    /// The classes of points to keep, of a LAS or LAZ file; by default all. Points are numbered after that.
    pub classes: Option<Vec<u8>>,
    /// A box: points outside are left out. Points are numbered after that.
    pub bounds: Option<Bounds>,
    /// One point is kept in each cell of a grid, the first. Points are numbered after that. The table of cells takes part in
    /// [`memory`](Self::memory): about a byte a cell where points are dense, and 64 where each is alone.
    pub thinning: Option<Thinning>,
    /// Shape and type of raw values, which no raw file tells itself. Needed for [`Format::Raw`] only.
    pub raw: Option<RawLayout>,
    /// Folder of temporary files. Default: that of the system.
    pub temp_dir: Option<PathBuf>,
}

/// A box along the axes, whose border belongs to it: the first coordinates of points are compared.
///
/// ```
/// use taut_io::Bounds;
/// let bounds: Bounds = "0,-5,10,5".parse()?;
/// assert_eq!((bounds.low, bounds.high), (vec![0.0, -5.0], vec![10.0, 5.0]));
/// assert!("0,-5,10".parse::<Bounds>().is_err());
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Bounds {
    /// The least coordinates.
    pub low: Vec<f64>,
    /// The largest, as many.
    pub high: Vec<f64>,
}

impl std::str::FromStr for Bounds {
    type Err = String;

    /// Reads the least coordinates, then the largest, with commas between.
    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || {
            "expected the least coordinates, then the largest, such as XMIN,YMIN,XMAX,YMAX"
                .to_owned()
        };
        let numbers = text.split(',').map(|part| part.trim().parse::<f64>().map_err(|_| wrong()));
        let numbers = numbers.collect::<Result<Vec<f64>, String>>()?;
        if numbers.is_empty() || !numbers.len().is_multiple_of(2) {
            return Err(wrong());
        }
        let (low, high) = numbers.split_at(numbers.len() / 2);
        // NaN is in no order.
        match low.iter().zip(high).all(|(low, high)| low <= high) {
            true => Ok(Bounds { low: low.to_vec(), high: high.to_vec() }),
            false => Err("a least coordinate is more than the largest".to_owned()),
        }
    }
}

/// A grid of cells, of whose points the first is kept.
#[derive(Clone, Debug, PartialEq)]
pub struct Thinning {
    /// The side of a cell, more than 0; cells begin at its multiples.
    pub cell: f64,
    /// A coordinate that is no axis of the grid, such as a height: its name or its number from 0. Default none.
    pub except: Option<String>,
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
    /// The number of a feature of GeoJSON, a geometry of WKT, a path of SVG, an array of npz or a shape of a shapefile, from 0.
    Number(u64),
    /// The property `name` (in either case) of a feature of GeoJSON, the `id` of a path of SVG, or the name of an array of npz.
    Name(String),
}

impl std::str::FromStr for Feature {
    type Err = std::convert::Infallible;

    /// Reads digits as a number, and any other text as a name.
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Ok(text.parse().map_or_else(|_| Feature::Name(text.to_owned()), Feature::Number))
    }
}

/// What becomes of rows that lack the value of a coordinate.
///
/// A value is missing if it is NaN, null, or in text nothing or one of the words that tables have for it: `NA`, `N/A`, `#N/A`,
/// `<NA>`, `null`, `none`, `NaN`, `?`, `.` and `-`, in either case.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Missing {
    /// They are an error, which names the first.
    #[default]
    Refuse,
    /// They are left out. Places are told by the rows of the file all the same.
    Drop,
    /// They are kept, with NaN for what is missing: for those who count it.
    Keep,
}

/// The mark before the decimals of numbers in text.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Decimal {
    /// `1.5`
    #[default]
    Point,
    /// `1,5`. A number with a point is refused then: the point could part thousands.
    Comma,
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
