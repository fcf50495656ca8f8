//! The errors of files, worded so that a person can mend it: file, row, column, value, remedy.

mod display;
mod filter;
mod place;
mod raster;
mod stream;
mod system;

use std::io;

use taut_points::ReadError;

use crate::{Compression, Content, Format};

pub(crate) use display::shown_path;
pub use filter::FilterError;
pub use place::{FilePlace, Place};
pub use raster::RasterError;
pub use stream::StreamRowError;

use display::{
    Abbreviated, Printable, columns, format_of, names, names_or_extensions, not_built, not_finite,
};
use place::Row;

/// Why points could not be read or a file could not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// There is no such file, or no such folder to write to.
    #[error("{path}: no such file or folder")]
    NotFound {
        /// The file.
        path: String,
    },
    /// A file of a folder has points of another dimension than the first one.
    #[error(
        "{path} has points of {found} coordinates, {other} of {expected}: files of one folder must have as many"
    )]
    OtherDimension {
        /// The file.
        path: String,
        /// Coordinates of its points.
        found: usize,
        /// The first file.
        other: String,
        /// Coordinates of the points there.
        expected: usize,
    },
    /// Points cannot be kept within a box, or one in each cell of a grid.
    #[error(transparent)]
    Filter(#[from] FilterError),
    /// A raster cannot be written.
    #[error(transparent)]
    Raster(#[from] RasterError),
    /// A folder stands where a file was expected.
    #[error("{path} is a folder: name a file in it")]
    Directory {
        /// The folder.
        path: String,
    },
    /// A file stands where a folder was expected.
    #[error("{path} is a file: name a folder")]
    NoFolder {
        /// The file.
        path: String,
    },
    /// A link stands where a folder was expected: what it leads to would stay, and the link would go.
    #[error("{path} is a link: name the folder to which it leads, or another one")]
    LinkedFolder {
        /// The link.
        path: String,
    },
    /// An earlier folder holds something that its replacement would remove.
    #[error(
        "{path} holds `{}`, which would be removed: name a new or an empty folder",
        Printable(name)
    )]
    OtherFolder {
        /// The folder.
        path: String,
        /// The name of a file or folder in it.
        name: String,
    },
    /// A device stands where a file was expected, and may never end.
    #[error("{path} is a device, which may never end: name a file or a pipe")]
    Device {
        /// The device.
        path: String,
    },
    /// The file system has no room for the output.
    #[error(
        "{path}: at least {bytes} bytes would be written, but its file system has {free} bytes left: write fewer points, or name a folder with more room"
    )]
    NoSpace {
        /// The file.
        path: String,
        /// Fewest bytes of the output.
        bytes: u64,
        /// Bytes that are left.
        free: u64,
    },
    /// The operating system forbids it.
    #[error("{path}: no permission to {action} it")]
    Permission {
        /// The file.
        path: String,
        /// `read` or `write`.
        action: &'static str,
    },
    /// Reading failed.
    #[error("{path}: reading failed: {source}")]
    Read {
        /// The file.
        path: String,
        /// The error of the operating system.
        source: io::Error,
    },
    /// Writing to a device, a pipe or standard output failed, or a file could not be begun.
    #[error("{path}: writing failed: {source}")]
    Write {
        /// The file.
        path: String,
        /// The error of the operating system.
        source: io::Error,
    },
    /// Writing failed; what stood there before is untouched.
    #[error("{path}: writing failed: {source}; an earlier file of that name is as it was")]
    Replace {
        /// The file.
        path: String,
        /// The error of the operating system.
        source: io::Error,
    },
    /// The temporary file for points that do not fit into memory could not be written.
    #[error(
        "{path}: its points need a temporary file in {folder}, and writing that failed: {source}; set TMPDIR to a folder with more room"
    )]
    Spill {
        /// The file whose points were read.
        path: String,
        /// The folder of the temporary file.
        folder: String,
        /// The error of the operating system.
        source: io::Error,
    },
    /// What comes in a stream is no row of as many numbers as are expected.
    #[error(transparent)]
    StreamRow(#[from] StreamRowError),
    /// Not one byte.
    #[error("{path} is empty: it holds no byte")]
    Empty {
        /// The file.
        path: String,
    },
    /// No row of data.
    #[error("{path} holds no point: there is no row of data in it")]
    NoRows {
        /// The file.
        path: String,
    },
    /// The name does not tell which format to write.
    #[error("{path}: the {} cannot be told from the name; {}", format_of(*content), names_or_extensions(*content, |f| f.writes(*content)))]
    UnknownOutput {
        /// The file.
        path: String,
        /// The content that would be written.
        content: Content,
    },
    /// Neither name nor content tells the format.
    #[error("{path}: the {} cannot be told from the name; {}", format_of(*content), names_or_extensions(*content, |f| f.reads(*content)))]
    UnknownFormat {
        /// The file.
        path: String,
        /// The content that would be read.
        content: Content,
    },
    /// No format has this name.
    #[error("`{name}` is no format; the formats are {}", names(|_| true))]
    FormatName {
        /// The name that was asked for.
        name: String,
    },
    /// Such content is not read from this format.
    #[error("{path}: {format} files are {}; read one of {}", if format.is_read() { format!("not read as {content}") } else { "written, not read".to_owned() }, names(|f| f.reads(*content)))]
    NotReadable {
        /// The file.
        path: String,
        /// The format.
        format: Format,
        /// The content that was asked for.
        content: Content,
    },
    /// Such content is not written in this format.
    #[error("{path}: {format} files are {}; write one of {}", if format.is_written() { format!("not written as {content}") } else { "read, not written".to_owned() }, names(|f| f.writes(*content)))]
    NotWritable {
        /// The file.
        path: String,
        /// The format.
        format: Format,
        /// The value that was given.
        content: Content,
    },
    /// A mesh was asked for as content that is none.
    #[error("{path}: {content} are no mesh; ask for a triangulation or a surface")]
    NotMesh {
        /// The file.
        path: String,
        /// The content that was asked for.
        content: Content,
    },
    /// The extension promises normals or colors, which are read but not written.
    #[error(
        "{path}: files with the extension .{extension} hold normals or colors, which points do not have; use the extension .{}", format.extensions()[0]
    )]
    ReadOnlyExtension {
        /// The file.
        path: String,
        /// Its extension, without that of the compression.
        extension: String,
        /// The format.
        format: Format,
    },
    /// The format or the compression was left out of this build.
    #[error("{path}: {}", not_built(.name, .feature))]
    NotBuilt {
        /// The file.
        path: String,
        /// The name of the format or of the compression.
        name: &'static str,
        /// The cargo feature that has it.
        feature: &'static str,
    },
    /// The compressed stream is damaged or ends early.
    #[error(
        "{path}: the {compression} stream is damaged or ends early: {source}; fetch or compress the file again"
    )]
    Compressed {
        /// The file.
        path: String,
        /// The compression.
        compression: Compression,
        /// The error of the decoder.
        source: io::Error,
    },
    /// A row has more or fewer columns than the first.
    #[error("{path}: {} has {}, but {expected} {} expected {why}: add or remove values there", Row(*row, Some(*line)), columns(*found), if *expected == 1 { "is" } else { "are" })]
    Ragged {
        /// The file.
        path: String,
        /// The row, from 1.
        row: u64,
        /// The line, from 1.
        line: u64,
        /// Columns of this row.
        found: usize,
        /// Columns of the first.
        expected: usize,
        /// The reason for the number expected.
        why: &'static str,
    },
    /// A point of a list column has another dimension than the first.
    #[error(
        "{path}: row {row} of column `{}` is a list of {found} values, but the first has {expected}: all points must have one dimension",
        Printable(column)
    )]
    RaggedList {
        /// The file.
        path: String,
        /// The row, from 1.
        row: u64,
        /// The column.
        column: String,
        /// Values in this list.
        found: usize,
        /// Values in the first.
        expected: usize,
    },
    /// A field of text is not a number.
    #[error("{place}: `{value}` is not a number; {hint}")]
    NotANumber {
        /// Where.
        place: Place,
        /// The field, shortened if long.
        value: String,
        /// The remedy.
        hint: &'static str,
    },
    /// A number is NaN, infinite, or too large for its type.
    #[error("{place}: {}", not_finite(value))]
    NonFinite {
        /// Where.
        place: Place,
        /// The value.
        value: String,
    },
    /// A row has no label.
    #[error("{place}: the label is missing: fill it in, or remove that row")]
    NoLabel {
        /// Where.
        place: Place,
    },
    /// A number other than 0 that would be read as 0.
    #[error("{place}: `{value}` {}: write 0, or scale that column", crate::number::UNDERFLOW)]
    Underflow {
        /// Where.
        place: Place,
        /// The field, shortened if long.
        value: String,
    },
    /// A value is missing (null).
    #[error(
        "{place}: the value is missing (null), and all coordinates must be given: fill it in, or leave out such rows with --missing drop"
    )]
    Missing {
        /// Where.
        place: Place,
    },
    /// An integer that no `f64` holds exactly.
    #[error("{place}: the integer {value} is not exact as f64: scale or shift that column")]
    Inexact {
        /// Where.
        place: Place,
        /// The integer.
        value: String,
    },
    /// The first row holds both names and numbers, so it is neither a header nor a point.
    #[error(
        "{path}: row 1 (line {line}) mixes numbers with other text (`{value}` in column {column}, counted from 0): say whether it is a header, select the numeric columns, or repair the value"
    )]
    MixedHeader {
        /// The file.
        path: String,
        /// The line, from 1.
        line: u64,
        /// The first column that is no number.
        column: usize,
        /// Its text.
        value: String,
    },
    /// A field of the first row looks like a value that went wrong, so the row is neither a header nor a point.
    #[error(
        "{path}: row 1 (line {line}), column {column} (counted from 0) holds `{value}`, which is no number and hardly a name: repair the value, say with --header whether the row is a header, or leave out rows that lack a value with --missing drop"
    )]
    DoubtfulHeader {
        /// The file.
        path: String,
        /// The line, from 1.
        line: u64,
        /// The column.
        column: usize,
        /// Its text.
        value: String,
    },
    /// A line of text is too long to be one.
    #[error(
        "{path}: line {line} is longer than {limit} bytes, the longest line that is read{}: write a point per line, or check that the file is text",
        if *limit < crate::LONGEST_LINE { " with so little memory" } else { "" }
    )]
    LongLine {
        /// The file.
        path: String,
        /// The line, from 1.
        line: u64,
        /// Most bytes of a line: [`LONGEST_LINE`](crate::LONGEST_LINE), or less where memory is limited.
        limit: usize,
    },
    /// A quoted field has no end.
    #[error(
        "{path}: a quote that opens on line {line} never closes: add the closing quote, or remove the opening one"
    )]
    OpenQuote {
        /// The file.
        path: String,
        /// The line, from 1.
        line: u64,
    },
    /// A selection of columns cannot be read.
    #[error("columns `{text}`: expected {expected}, such as `x,y,z`, `0-2,5` or `1-`")]
    Columns {
        /// The selection.
        text: String,
        /// The values that would have been accepted.
        expected: &'static str,
    },
    /// A column of this number does not exist.
    #[error("{path}: there is no column {number}: it has {}, counted from 0", columns(*width))]
    ColumnNumber {
        /// The file.
        path: String,
        /// The number asked for.
        number: usize,
        /// The number of them.
        width: usize,
    },
    /// A column of this name does not exist.
    #[error("{path}: there is no column `{}`; there {} {}", Printable(name), if known.len() == 1 { "is" } else { "are" }, Abbreviated(known))]
    ColumnName {
        /// The file.
        path: String,
        /// The name asked for.
        name: String,
        /// The names there are.
        known: Vec<String>,
    },
    /// A column was asked for by name, but the file has no names.
    #[error(
        "{path}: column `{}` was asked for by name, but the file has no header: select columns by number, counted from 0",
        Printable(name)
    )]
    NoNames {
        /// The file.
        path: String,
        /// The name asked for.
        name: String,
    },
    /// A selected column does not hold numbers.
    #[error(
        "{path}: column `{}` holds {kind}, not numbers: select other columns",
        Printable(column)
    )]
    NotNumeric {
        /// The file.
        path: String,
        /// The column.
        column: String,
        /// Its type.
        kind: String,
    },
    /// No column holds numbers, or several could be the points.
    #[error(
        "{path}: {problem} among its columns {}: select the columns that are coordinates",
        Abbreviated(columns)
    )]
    NoCoordinates {
        /// The file.
        path: String,
        /// The thing that was not found.
        problem: &'static str,
        /// The columns there are, with types.
        columns: Vec<String>,
    },
    /// The file is not what its format demands.
    #[error("{path} is damaged or no {format} file: {place}{problem}")]
    Damaged {
        /// The file.
        path: String,
        /// The format.
        format: Format,
        /// Where, as far as the problem does not say it.
        place: FilePlace,
        /// The problem.
        problem: String,
    },
    /// A problem of TSPLIB whose coordinates are places on the earth.
    #[error(
        "{path}: line {line} says `EDGE_WEIGHT_TYPE: GEO`: its coordinates are latitude and longitude, written as degrees and minutes (DDD.MM), not points of the plane; project them, and write `EDGE_WEIGHT_TYPE: EUC_2D`"
    )]
    Geographic {
        /// The file.
        path: String,
        /// The line, from 1.
        line: u64,
    },
    /// The feature that was chosen is not there, or several could be meant.
    #[error("{path}: {problem}")]
    Feature {
        /// The file.
        path: String,
        /// The problem with its features.
        problem: String,
    },
    /// A feature was chosen, but files of this format have none.
    #[error(
        "{path}: {format} files have no features to choose from: leave out --select, which is for {}",
        names(|f| f.has_features())
    )]
    NoFeatures {
        /// The file.
        path: String,
        /// The format.
        format: Format,
    },
    /// Classes were chosen of a format without.
    #[error("{path}: {format} files have no classes: leave out --classes, which is for {}", names(|f| f.has_classes()))]
    NoClasses {
        /// The file.
        path: String,
        /// The format.
        format: Format,
    },
    /// The file holds another number of values or rows than it says.
    #[error(
        "{path} is {}: its {format} header promises {expected} {}, but there {} {found}",
        if found < expected { "cut short or damaged" } else { "longer than it says or damaged" },
        if *expected == 1 { unit.0 } else { unit.1 }, if *found == 1 { "is" } else { "are" }
    )]
    Count {
        /// The file.
        path: String,
        /// The format.
        format: Format,
        /// The value that the header claims.
        expected: u64,
        /// The value found.
        found: u64,
        /// Of what: the word for one, and for more.
        unit: (&'static str, &'static str),
    },
    /// An array whose element type or shape is not that of points.
    #[error("{path}: {problem}; {remedy}")]
    Array {
        /// The file.
        path: String,
        /// The problem with its contents.
        problem: String,
        /// The way to make it points.
        remedy: &'static str,
    },
    /// A part of the file must be held in memory as a whole, and is larger than allowed.
    #[error(
        "{path}: {problem} must be held in memory, which takes at least {bytes} bytes, but {memory} are allowed: {remedy}"
    )]
    TooLarge {
        /// The file.
        path: String,
        /// The part.
        problem: &'static str,
        /// Bytes needed, as far as they are known.
        bytes: u64,
        /// Bytes allowed for it.
        memory: u64,
        /// The remedy.
        remedy: &'static str,
    },
    /// The system gives no memory for the points.
    #[error(
        "{path}: out of memory: its points take {bytes} bytes or more, which the system does not give: limit the memory for points (--memory), so that they are read from disk"
    )]
    OutOfMemory {
        /// The file.
        path: String,
        /// Bytes of the points read so far.
        bytes: u64,
    },
    /// Raw values without a layout, or with a dimension of 0.
    #[error(
        "{path}: raw values tell neither dimension nor type: give both (dimension at least 1, f32 or f64)"
    )]
    RawLayout {
        /// The file.
        path: String,
    },
    /// Raw values that do not make whole points.
    #[error(
        "{path}: {bytes} bytes after the first {offset} do not make whole points of {size} bytes: {rest} are left over; check dimension, type and offset"
    )]
    RawRagged {
        /// The file.
        path: String,
        /// Bytes of values.
        bytes: u64,
        /// Bytes before them.
        offset: u64,
        /// Bytes of a point.
        size: u64,
        /// Bytes left over.
        rest: u64,
    },
    /// The format holds points of another dimension.
    #[error(
        "{path}: {format} files hold points of dimension {expected}, not {dim}{}",
        if *format == Format::Xyz { ": write another format" } else { "" }
    )]
    Dimension {
        /// The file.
        path: String,
        /// The format.
        format: Format,
        /// The dimension it holds, or several.
        expected: &'static str,
        /// The dimension of the points.
        dim: usize,
    },
    /// Names for another number of columns than the points have.
    #[error("{path}: {names} column name{} given for points of dimension {dim}", if *names == 1 { " was" } else { "s were" })]
    Names {
        /// The file.
        path: String,
        /// The number of names.
        names: usize,
        /// The dimension.
        dim: usize,
    },
    /// The format has no place for such simplices.
    #[error("{path}: {format} files hold no {}; write one of {}", crate::mesh::nouns(*width), names(|f| f.writes(Content::Triangulation) && f.holds_simplices(*width)))]
    MeshWidth {
        /// The file.
        path: String,
        /// The format.
        format: Format,
        /// Vertices of a simplex.
        width: usize,
    },
    /// A file of a mesh is of a kind that is not read.
    #[error("{path}: {place}{problem}, which is not read: write the mesh {remedy}")]
    Unsupported {
        /// The file.
        path: String,
        /// Where.
        place: FilePlace,
        /// The problem.
        problem: String,
        /// The way to write it instead.
        remedy: &'static str,
    },
    /// There is no simplex in a file of a triangulation, or no vertex in that of a surface.
    #[error("{path} holds no {missing}")]
    EmptyMesh {
        /// The file.
        path: String,
        /// `simplex`, `vertex` or `triangle`.
        missing: &'static str,
    },
    /// Normals or colors for another number of vertices.
    #[error("{path}: {found} {what} were given for {vertices} vertices: give one for each")]
    MeshAttributes {
        /// The file.
        path: String,
        /// The thing that was given.
        what: &'static str,
        /// The number of them.
        found: usize,
        /// The number of vertices.
        vertices: usize,
    },
    /// A normal is not finite.
    #[error(
        "{path}: coordinate {column} of normal {vertex}, both counted from 0, is {value}: all must be finite"
    )]
    MeshNormal {
        /// The file.
        path: String,
        /// The vertex, from 0.
        vertex: usize,
        /// The coordinate: 0, 1 or 2.
        column: usize,
        /// Its value.
        value: f64,
    },
    /// The format has no place for vertices without triangles, or there are not even vertices.
    #[error("{path}: there is no triangle to write; vertices alone are written as {}", names(|f| f.holds_bare_vertices()))]
    NoTriangles {
        /// The file.
        path: String,
    },
    /// The single precision of the format would move a vertex by a visible part of the mesh.
    #[error(
        "{path}: coordinate {column} of vertex {vertex}, both counted from 0, is {value:?}, which the single precision of {format} moves by more than 1/8192 of the mesh's longest side: move the mesh nearer to the origin, or write ply, obj or off"
    )]
    MeshPrecision {
        /// The file.
        path: String,
        /// The format.
        format: Format,
        /// The vertex, from 0.
        vertex: usize,
        /// The coordinate: 0, 1 or 2.
        column: usize,
        /// Its value.
        value: f64,
    },
    /// A coordinate does not fit into the single precision of the format.
    #[error(
        "{path}: coordinate {column} of vertex {vertex}, both counted from 0, is {value:?}, too large for the single precision of {format}: scale the mesh, or write ply, obj or off"
    )]
    MeshRange {
        /// The file.
        path: String,
        /// The format.
        format: Format,
        /// The vertex, from 0.
        vertex: usize,
        /// The coordinate: 0, 1 or 2.
        column: usize,
        /// Its value.
        value: f64,
    },
    /// A binary file of glTF would be longer than its header can say.
    #[error("{path}: glb files hold 4 GiB at most, and this mesh takes more: write it as ply")]
    MeshTooLarge {
        /// The file.
        path: String,
    },
    /// A block of points could not be delivered.
    #[error(transparent)]
    Points(#[from] ReadError),
}
