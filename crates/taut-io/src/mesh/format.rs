//! The formats of meshes and their names.

use std::fmt;
use std::path::Path;
use std::str::FromStr;

use crate::{Compression, Error};

/// A file format of simplicial meshes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MeshFormat {
    /// Stanford PLY, binary and little-endian.
    Ply,
    /// Wavefront OBJ.
    Obj,
    /// Object File Format, as Geomview has it.
    Off,
    /// Unstructured grid of VTK, in XML with raw data appended.
    Vtu,
    /// Apache Parquet: the simplices alone, as rows of ids.
    Parquet,
}

impl MeshFormat {
    /// Every format.
    pub const ALL: [MeshFormat; 5] =
        [MeshFormat::Ply, MeshFormat::Obj, MeshFormat::Off, MeshFormat::Vtu, MeshFormat::Parquet];

    /// The name, as [`FromStr`] reads it; it is the extension too.
    pub fn name(self) -> &'static str {
        match self {
            MeshFormat::Ply => "ply",
            MeshFormat::Obj => "obj",
            MeshFormat::Off => "off",
            MeshFormat::Vtu => "vtu",
            MeshFormat::Parquet => "parquet",
        }
    }

    /// One line for a list of formats.
    pub fn description(self) -> &'static str {
        match self {
            MeshFormat::Ply => "Stanford PLY, binary little-endian; edges, triangles, tetrahedra",
            MeshFormat::Obj => "Wavefront OBJ, text; edges and triangles",
            MeshFormat::Off => "Object File Format, text; edges and triangles",
            MeshFormat::Vtu => "VTK unstructured grid for ParaView; edges, triangles, tetrahedra",
            MeshFormat::Parquet => "Apache Parquet, columns v0, v1, … of ids, without coordinates",
        }
    }

    /// Whether this build reads and writes it.
    pub fn is_built(self) -> bool {
        cfg!(feature = "arrow") || self != MeshFormat::Parquet
    }

    /// Whether it can hold simplices of so many vertices.
    pub fn holds(self, width: usize) -> bool {
        match self {
            MeshFormat::Obj | MeshFormat::Off => (1..=3).contains(&width),
            _ => (1..=4).contains(&width),
        }
    }

    /// The format and compression that the name of a file tells: `mesh.ply.gz` is PLY and gzip.
    pub fn of_path(path: &Path) -> (Option<MeshFormat>, Option<Compression>) {
        let (inner, compression) = Compression::split(path);
        let format = inner
            .and_then(|inner| MeshFormat::ALL.into_iter().find(|format| format.name() == inner));
        (format, compression)
    }
}

impl fmt::Display for MeshFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for MeshFormat {
    type Err = Error;

    /// Reads a name, in either case.
    fn from_str(text: &str) -> Result<Self, Error> {
        MeshFormat::ALL
            .into_iter()
            .find(|format| text.eq_ignore_ascii_case(format.name()))
            .ok_or_else(|| Error::MeshFormatName { name: text.to_owned() })
    }
}
