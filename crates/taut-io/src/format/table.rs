//! The table of formats: name, extensions, and what each format holds.

use super::Content::{self, Curves, Points, Surface, Triangulation};
use super::Format;

/// The operations on some content in a format.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Access {
    Read,
    Write,
    Both,
}

use Access::{Both, Read, Write};

/// Extensions under which normals or colors follow the coordinates. Points are read from such files, never written to them.
pub(super) const READ_ONLY_EXTENSIONS: [&str; 2] = ["xyzn", "xyzrgb"];

/// A row of the table.
pub(super) struct Entry {
    pub(super) format: Format,
    pub(super) name: &'static str,
    pub(super) extensions: &'static [&'static str],
    /// Per content: the access, and one line for a list of formats.
    pub(super) uses: &'static [(Content, Access, &'static str)],
}

const fn entry(
    format: Format,
    name: &'static str,
    extensions: &'static [&'static str],
    uses: &'static [(Content, Access, &'static str)],
) -> Entry {
    Entry { format, name, extensions, uses }
}

/// Every format, in the order of [`Format`].
pub(super) const TABLE: [Entry; 26] = [
    entry(
        Format::Csv,
        "csv",
        &["csv"],
        &[
            (
                Points,
                Both,
                "comma-separated text (also ; and tab), header found or not, # comments",
            ),
            (
                Curves,
                Write,
                "a row for each vertex, in order: curve (from 0), closed (1 or 0), x, y",
            ),
        ],
    ),
    entry(Format::Tsv, "tsv", &["tsv", "tab"], &[(Points, Both, "tab-separated text")]),
    entry(
        Format::Whitespace,
        "whitespace",
        &["txt", "dat", "xy", "asc"],
        &[(Points, Both, "text, columns parted by spaces and tabs")],
    ),
    entry(
        Format::Npy,
        "npy",
        &["npy"],
        &[(Points, Both, "NumPy array, n × d or n; f4, f8 and integers, either byte order")],
    ),
    entry(
        Format::Ply,
        "ply",
        &["ply"],
        &[
            (Points, Read, "Stanford PLY, text or binary: its vertices"),
            (Triangulation, Both, "Stanford PLY, text or binary; edges, triangles, tetrahedra"),
            (Surface, Both, "Stanford PLY, text or binary; normals and colors"),
        ],
    ),
    entry(
        Format::Obj,
        "obj",
        &["obj"],
        &[
            (Points, Read, "Wavefront OBJ, text: its vertices"),
            (Triangulation, Both, "Wavefront OBJ, text; edges and triangles"),
            (Surface, Both, "Wavefront OBJ, text; normals and colors"),
        ],
    ),
    entry(
        Format::Off,
        "off",
        &["off"],
        &[
            (Points, Read, "Object File Format, text: its vertices"),
            (Triangulation, Both, "Object File Format, text; edges and triangles"),
            (Surface, Both, "Object File Format, text; normals and colors"),
        ],
    ),
    entry(
        Format::Stl,
        "stl",
        &["stl"],
        &[
            (Points, Read, "stereolithography, text or binary: its corners, equal ones once"),
            (Surface, Both, "stereolithography, text or binary; equal corners are one vertex"),
        ],
    ),
    entry(
        Format::Xyz,
        "xyz",
        &["xyz", "pts", "xyzn", "xyzrgb"],
        &[
            (
                Points,
                Both,
                "x y z per line, optional element symbol, optional count and comment lines",
            ),
            (Surface, Read, "x y z per line, with normals or colors; an optional count before"),
        ],
    ),
    entry(
        Format::Vtu,
        "vtu",
        &["vtu"],
        &[(
            Triangulation,
            Both,
            "VTK unstructured grid for ParaView; edges, triangles, tetrahedra",
        )],
    ),
    entry(
        Format::Parquet,
        "parquet",
        &["parquet", "pq"],
        &[
            (
                Points,
                Both,
                "Apache Parquet, numeric columns or one list column; the geometries of GeoParquet",
            ),
            (Triangulation, Both, "Apache Parquet, columns v0, v1, … of ids, without coordinates"),
        ],
    ),
    entry(
        Format::Arrow,
        "arrow",
        &["arrow", "arrows", "feather", "ipc"],
        &[(
            Points,
            Both,
            "Arrow IPC (Feather), file or stream, numeric columns or one list column",
        )],
    ),
    entry(
        Format::Tsplib,
        "tsplib",
        &["tsp"],
        &[(Points, Read, "TSPLIB problem with a NODE_COORD_SECTION, not on the earth (GEO)")],
    ),
    entry(
        Format::Raw,
        "raw",
        &["raw", "bin", "f32", "f64"],
        &[(Points, Both, "little-endian f32 or f64 without a header; needs dimension and type")],
    ),
    entry(
        Format::Glb,
        "glb",
        &["glb"],
        &[(Surface, Write, "glTF 2.0, binary; normals and colors, single precision")],
    ),
    entry(
        Format::Gltf,
        "gltf",
        &["gltf"],
        &[(Surface, Write, "glTF 2.0, JSON; normals and colors, single precision")],
    ),
    entry(
        Format::Dxf,
        "dxf",
        &["dxf"],
        &[(Surface, Write, "AutoCAD drawing of release 12, text; triangles as 3DFACE")],
    ),
    entry(
        Format::Vrml,
        "vrml",
        &["wrl", "vrml"],
        &[(Surface, Write, "VRML 2.0, text; normals and colors")],
    ),
    entry(Format::Pov, "pov", &["pov", "inc"], &[(Surface, Write, "POV-Ray mesh2, text; normals")]),
    entry(
        Format::GeoJson,
        "geojson",
        &["geojson"],
        &[
            (Points, Read, "positions, or the rings of one polygon; --select chooses it"),
            (
                Curves,
                Write,
                "loops as polygons, those within as their holes; open curves as line strings",
            ),
        ],
    ),
    entry(
        Format::Svg,
        "svg",
        &["svg"],
        &[
            (Points, Read, "the subpaths of one path as rings, curves as chords"),
            (Curves, Write, "all curves as one path, in coordinates of the input"),
        ],
    ),
    entry(
        Format::Wkt,
        "wkt",
        &["wkt"],
        &[(Points, Read, "well-known text: positions, or the rings of one polygon")],
    ),
    entry(
        Format::Las,
        "las",
        &["las", "laz"],
        &[(
            Points,
            Read,
            "LAS and LAZ of laser scans: x, y, z by the scale and offset of the file",
        )],
    ),
    entry(
        Format::Pcd,
        "pcd",
        &["pcd"],
        &[(
            Points,
            Read,
            "clouds of the Point Cloud Library: ascii, binary and compressed; x, y, z",
        )],
    ),
    entry(
        Format::Npz,
        "npz",
        &["npz"],
        &[(Points, Read, "archive of NumPy arrays; --select chooses one")],
    ),
    entry(
        Format::Shapefile,
        "shapefile",
        &["shp"],
        &[(
            Points,
            Read,
            "points, or the vertices of lines and polygons; --select chooses one shape",
        )],
    ),
];

#[cfg(test)]
mod tests {
    use super::*;

    /// [`Format::entry`] indexes the table by the number of the format.
    #[test]
    fn rows_stand_in_the_order_of_the_enum_and_no_extension_is_in_two() {
        let mut extensions: Vec<&str> = Vec::new();
        for (number, entry) in TABLE.iter().enumerate() {
            assert_eq!(entry.format as usize, number, "{}", entry.name);
            extensions.extend(entry.extensions);
        }
        let count = extensions.len();
        extensions.sort();
        extensions.dedup();
        assert_eq!(extensions.len(), count);
    }
}
