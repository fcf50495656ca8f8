//! The formats of shapes and their names.

use std::fmt;
use std::path::Path;
use std::str::FromStr;

use crate::{Compression, Error};

/// A file format of triangles and of points with normals and colours.
///
/// | format | read | written | normals, colours | coordinates |
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
/// make one place of two.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ShapeFormat {
    /// Stanford PLY.
    Ply,
    /// Wavefront OBJ.
    Obj,
    /// Object File Format, as Geomview has it.
    Off,
    /// Stereolithography.
    Stl,
    /// Lines of coordinates, normals and colours.
    Xyz,
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
}

impl ShapeFormat {
    /// Every format.
    pub const ALL: [ShapeFormat; 10] = [
        ShapeFormat::Ply,
        ShapeFormat::Obj,
        ShapeFormat::Off,
        ShapeFormat::Stl,
        ShapeFormat::Xyz,
        ShapeFormat::Glb,
        ShapeFormat::Gltf,
        ShapeFormat::Dxf,
        ShapeFormat::Vrml,
        ShapeFormat::Pov,
    ];

    /// The name, as [`FromStr`] reads it.
    pub fn name(self) -> &'static str {
        match self {
            ShapeFormat::Ply => "ply",
            ShapeFormat::Obj => "obj",
            ShapeFormat::Off => "off",
            ShapeFormat::Stl => "stl",
            ShapeFormat::Xyz => "xyz",
            ShapeFormat::Glb => "glb",
            ShapeFormat::Gltf => "gltf",
            ShapeFormat::Dxf => "dxf",
            ShapeFormat::Vrml => "vrml",
            ShapeFormat::Pov => "pov",
        }
    }

    /// The extensions that mean this format, in lower case and without a dot; the first is the usual one.
    pub fn extensions(self) -> &'static [&'static str] {
        match self {
            ShapeFormat::Ply => &["ply"],
            ShapeFormat::Obj => &["obj"],
            ShapeFormat::Off => &["off"],
            ShapeFormat::Stl => &["stl"],
            ShapeFormat::Xyz => &["xyz", "pts", "xyzn", "xyzrgb"],
            ShapeFormat::Glb => &["glb"],
            ShapeFormat::Gltf => &["gltf"],
            ShapeFormat::Dxf => &["dxf"],
            ShapeFormat::Vrml => &["wrl", "vrml"],
            ShapeFormat::Pov => &["pov", "inc"],
        }
    }

    /// One line for a list of formats.
    pub fn description(self) -> &'static str {
        match self {
            ShapeFormat::Ply => "Stanford PLY, text or binary; normals and colours",
            ShapeFormat::Obj => "Wavefront OBJ, text; normals and colours",
            ShapeFormat::Off => "Object File Format, text; normals and colours",
            ShapeFormat::Stl => "stereolithography, text or binary; equal corners are one vertex",
            ShapeFormat::Xyz => "x y z per line, with normals or colours; an optional count before",
            ShapeFormat::Glb => "glTF 2.0, binary; normals and colours, single precision",
            ShapeFormat::Gltf => "glTF 2.0, JSON; normals and colours, single precision",
            ShapeFormat::Dxf => "AutoCAD drawing of release 12, text; triangles as 3DFACE",
            ShapeFormat::Vrml => "VRML 2.0, text; normals and colours",
            ShapeFormat::Pov => "POV-Ray mesh2, text; normals",
        }
    }

    /// Whether [`open_shape`](crate::open_shape) reads it.
    pub fn can_read(self) -> bool {
        use ShapeFormat::{Obj, Off, Ply, Stl, Xyz};
        matches!(self, Ply | Obj | Off | Stl | Xyz)
    }

    /// Whether [`write_shape`](crate::write_shape) writes it.
    pub fn can_write(self) -> bool {
        self != ShapeFormat::Xyz
    }

    /// Whether it is written with vertices alone, without any triangle.
    pub fn holds_points(self) -> bool {
        use ShapeFormat::{Glb, Gltf, Obj, Off, Ply, Xyz};
        matches!(self, Ply | Obj | Off | Xyz | Glb | Gltf)
    }

    /// The format and compression that the name of a file tells: `bunny.ply.gz` is PLY and gzip.
    pub fn of_path(path: &Path) -> (Option<ShapeFormat>, Option<Compression>) {
        let (inner, compression) = Compression::split(path);
        let format = inner.and_then(|inner| {
            ShapeFormat::ALL.into_iter().find(|format| format.extensions().contains(&&*inner))
        });
        (format, compression)
    }
}

impl fmt::Display for ShapeFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for ShapeFormat {
    type Err = Error;

    /// Reads a name or an extension, in either case.
    fn from_str(text: &str) -> Result<Self, Error> {
        let lower = text.to_ascii_lowercase();
        ShapeFormat::ALL
            .into_iter()
            .find(|format| format.name() == lower || format.extensions().contains(&&*lower))
            .ok_or_else(|| Error::ShapeFormatName { name: text.to_owned() })
    }
}
