//! Virtual Reality Modeling Language 2.0, which is VRML97: one `IndexedFaceSet`, seen from both sides.
//!
//! *Reference.* ISO/IEC 14772-1:1997.

use super::MeshView;
use super::colors::fraction;
use crate::Error;
use crate::words::{put_numbers, put_whole};
use crate::write::OutputFile;

pub(super) fn write(mesh: &MeshView<'_>, out: &mut OutputFile<'_>) -> Result<(), Error> {
    let vectors = |vectors: &[[f64; 3]], out: &mut OutputFile<'_>| {
        out.each(vectors, |&vector, bytes| {
            put_numbers(vector, b" ", bytes);
            bytes.extend_from_slice(b",\n");
        })
    };
    out.put(b"#VRML V2.0 utf8\nShape {\nappearance Appearance { material Material { } }\n")?;
    out.put(b"geometry IndexedFaceSet {\nsolid FALSE\ncoord Coordinate { point [\n")?;
    vectors(mesh.places(), out)?;
    out.put(b"] }\n")?;
    if let Some(normals) = mesh.normals {
        out.put(b"normal Normal { vector [\n")?;
        vectors(normals, out)?;
        out.put(b"] }\n")?;
    }
    if let Some(colors) = mesh.colors {
        out.put(b"color Color { color [\n")?;
        out.each(colors, |&color, bytes| {
            put_numbers(color.map(fraction), b" ", bytes);
            bytes.extend_from_slice(b",\n");
        })?;
        out.put(b"] }\n")?;
    }
    out.put(b"coordIndex [\n")?;
    out.each(mesh.triangles(), |&ids, bytes| {
        for id in ids {
            put_whole(id.into(), bytes);
            bytes.push(b',');
        }
        // −1 ends a face.
        bytes.extend_from_slice(b"-1,\n");
    })?;
    out.put(b"]\n}\n}\n")
}
