//! The formats of points, meshes and curves, and how a file tells which one it has.

mod table;

use std::fmt;
use std::path::Path;
use std::str::FromStr;

use crate::Error;
use table::{Access, Entry, READ_ONLY_EXTENSIONS, TABLE};

/// The content of a file, or the content that is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Content {
    /// Points of any dimension.
    Points,
    /// Simplices of one dimension on given points: vertices are the points in their order.
    Triangulation,
    /// Triangles in space on vertices of their own, or vertices alone, with normals and colors.
    Surface,
    /// Curves of the plane.
    Curves,
}

impl fmt::Display for Content {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Content::Points => "points",
            Content::Triangulation => "triangulations",
            Content::Surface => "surfaces",
            Content::Curves => "curves",
        })
    }
}

/// A file format. The table says what each one holds of a surface; `taut formats` lists the rest.
///
/// | format | read | written | normals, colors | coordinates |
/// |---|---|---|---|---|
/// | ply, text or binary of either byte order | yes | text, binary little-endian | both | exact |
/// | obj | yes | yes | both | exact |
/// | off | yes | yes | both | exact |
/// | stl | text, binary | text, binary | neither | text exact, binary in single precision |
/// | xyz, pts | yes | no: see [`write_points`](crate::write_points) | both | exact |
/// | glb, gltf | no | yes | both | single precision |
/// | dxf, of release 12 | no | yes | neither | exact |
/// | vrml 2.0 | no | yes | both | exact |
/// | pov, as `mesh2` | no | yes | normals | exact |
///
/// Exact is what reads back to the same bits. A binary stl file, glb and gltf round coordinates to single precision, which can
/// make one place of two; a surface so far from the origin that this would be seen is not written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// Text, a point per line, columns parted by commas (or semicolons or tabs, found in the first row); of curves, a row
    /// for each vertex.
    Csv,
    /// Text, columns parted by tabs.
    Tsv,
    /// Text, columns parted by any number of spaces and tabs.
    Whitespace,
    /// A NumPy array.
    Npy,
    /// Stanford PLY.
    Ply,
    /// Wavefront OBJ.
    Obj,
    /// Object File Format, as Geomview has it.
    Off,
    /// Stereolithography.
    Stl,
    /// Three coordinates per line, with normals and colors, or with element symbols and a count line.
    Xyz,
    /// Unstructured grid of VTK, in XML with raw data appended.
    Vtu,
    /// Apache Parquet: points, or simplices as rows of ids.
    Parquet,
    /// Arrow IPC, file or stream.
    Arrow,
    /// A problem of TSPLIB with coordinates.
    Tsplib,
    /// Little-endian values without a header.
    Raw,
    /// glTF 2.0 in one binary file.
    Glb,
    /// glTF 2.0 as JSON, with its buffer in it.
    Gltf,
    /// Drawing Exchange Format of AutoCAD, release 12, as text.
    Dxf,
    /// Virtual Reality Modeling Language 2.0.
    Vrml,
    /// Scene description of the Persistence of Vision Raytracer.
    Pov,
    /// Polygons with their holes, line strings and points, as in RFC 7946.
    GeoJson,
    /// One path of SVG.
    Svg,
    /// Well-known text of geometries.
    Wkt,
    /// Laser scans as the American Society for Photogrammetry and Remote Sensing has them, also compressed as LAZ.
    Las,
    /// Clouds of the Point Cloud Library.
    Pcd,
    /// An archive of NumPy arrays.
    Npz,
    /// Points, lines and polygons of ESRI: the file `.shp`.
    Shapefile,
}

impl Format {
    fn entry(self) -> &'static Entry {
        &TABLE[self as usize]
    }

    /// The formats of some content, whether read or written, in a fixed order.
    pub fn of(content: Content) -> impl Iterator<Item = Format> {
        Format::all().filter(move |format| format.holds(content))
    }

    /// Every format.
    pub fn all() -> impl Iterator<Item = Format> {
        TABLE.iter().map(|entry| entry.format)
    }

    /// The name, as [`FromStr`] reads it.
    pub fn name(self) -> &'static str {
        self.entry().name
    }

    /// The extensions that mean this format, in lower case and without a dot; the first is the usual one.
    pub fn extensions(self) -> &'static [&'static str] {
        self.entry().extensions
    }

    fn access(self, content: Content) -> Option<(Access, &'static str)> {
        let uses = self.entry().uses.iter();
        uses.copied().find(|(held, ..)| *held == content).map(|(_, access, line)| (access, line))
    }

    /// One line for a list of the formats of some content; empty where it holds none of that.
    pub fn description(self, content: Content) -> &'static str {
        self.access(content).map_or("", |(_, line)| line)
    }

    /// Tests whether some build reads or writes such content in this format.
    pub fn holds(self, content: Content) -> bool {
        self.access(content).is_some()
    }

    /// Returns true if this build supports the format.
    pub fn is_built(self) -> bool {
        cfg!(feature = "arrow") || !matches!(self, Format::Parquet | Format::Arrow)
    }

    /// Returns true if this build reads such content from it.
    pub fn reads(self, content: Content) -> bool {
        let access = self.access(content).map(|(access, _)| access);
        self.is_built() && matches!(access, Some(Access::Read | Access::Both))
    }

    /// Returns true if this build writes such content to it.
    pub fn writes(self, content: Content) -> bool {
        let access = self.access(content).map(|(access, _)| access);
        self.is_built() && matches!(access, Some(Access::Write | Access::Both))
    }

    pub(crate) fn is_read(self) -> bool {
        self.entry().uses.iter().any(|(_, access, _)| *access != Access::Write)
    }

    pub(crate) fn is_written(self) -> bool {
        self.entry().uses.iter().any(|(_, access, _)| *access != Access::Read)
    }

    /// Returns true if it is a text with columns.
    pub(crate) fn is_delimited(self) -> bool {
        matches!(self, Format::Csv | Format::Tsv | Format::Whitespace)
    }

    /// Returns true if its reader knows of a column of labels.
    pub(crate) fn reads_labels(self) -> bool {
        self.is_delimited() || matches!(self, Format::Parquet | Format::Arrow)
    }

    /// Returns true if its points have classes to choose from.
    pub(crate) fn has_classes(self) -> bool {
        self == Format::Las
    }

    /// Returns true if its reader leaves out points by itself.
    pub(crate) fn filters_as_it_reads(self) -> bool {
        self == Format::Las
    }

    /// Returns true if its points can be those of one feature among several.
    pub(crate) fn has_features(self) -> bool {
        matches!(
            self,
            Format::GeoJson | Format::Svg | Format::Wkt | Format::Npz | Format::Shapefile
        )
    }

    /// Returns true if a mesh in it can have simplices of so many vertices; a format of surfaces alone has triangles.
    pub fn holds_simplices(self, width: usize) -> bool {
        match self {
            Format::Ply | Format::Vtu | Format::Parquet => (1..=4).contains(&width),
            Format::Obj | Format::Off => (1..=3).contains(&width),
            _ => self.holds(Content::Surface) && width == 3,
        }
    }

    /// Returns true if it is written as a surface with vertices alone, without any triangle.
    pub fn holds_bare_vertices(self) -> bool {
        use Format::{Glb, Gltf, Obj, Off, Ply};
        matches!(self, Ply | Obj | Off | Glb | Gltf)
    }

    /// The format and compression that the name of a file tells: `points.csv.gz` is CSV and gzip.
    pub fn of_path(path: &Path) -> (Option<Format>, Option<Compression>) {
        let (inner, compression) = Compression::split(path);
        let format = inner
            .and_then(|inner| Format::all().find(|known| known.extensions().contains(&&*inner)));
        (format, compression)
    }

    /// The format that the name of a file tells, if that can hold the content.
    pub fn of_path_for(path: &Path, content: Content) -> Option<Format> {
        Format::of_path(path).0.filter(|format| format.holds(content))
    }
}

/// The format and the compression in which `content` goes to `path`: the given format, or that of the name; of points to standard
/// output it is CSV.
pub(crate) fn format_to_write(
    path: &Path,
    shown: &str,
    given: Option<Format>,
    content: Content,
) -> Result<(Format, Option<Compression>), Error> {
    let (named, compression) = Format::of_path(path);
    let usual = content == Content::Points && path.as_os_str() == "-";
    match given.or(named).or(usual.then_some(Format::Csv)) {
        None => Err(Error::UnknownOutput { path: shown.to_owned(), content }),
        Some(format) if !format.writes(content) => Err(Error::not_writable(shown, format, content)),
        Some(format) => match Compression::split(path).0 {
            Some(extension)
                if named == Some(format) && READ_ONLY_EXTENSIONS.contains(&&*extension) =>
            {
                Err(Error::ReadOnlyExtension { path: shown.to_owned(), extension, format })
            }
            _ => match compression.filter(|compression| !compression.is_built()) {
                Some(compression) => Err(Error::not_built(shown, compression)),
                None => Ok((format, compression)),
            },
        },
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
        Format::all()
            .find(|format| format.name() == lower || format.extensions().contains(&&*lower))
            .ok_or_else(|| Error::FormatName { name: text.to_owned() })
    }
}

/// The way in which a file is compressed as a whole.
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

    /// Returns true if this build supports the compression.
    pub fn is_built(self) -> bool {
        match self {
            Compression::Gzip => true,
            Compression::Xz => cfg!(feature = "xz"),
            Compression::Zstd => cfg!(feature = "zstd"),
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
