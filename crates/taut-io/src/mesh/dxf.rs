//! Drawing Exchange Format as text, of AutoCAD release 12: an entity `3DFACE` for each triangle.
//!
//! A group is two lines, a code and its value. The header names the release (`AC1009`), without which some programs guess;
//! tables may be left out, and all is on layer 0. A `3DFACE` has four corners, of which a triangle repeats the third.
//!
//! *Reference.* Autodesk, DXF group codes of AutoCAD release 12, 1992.

use super::MeshView;
use crate::Error;
use crate::words::put_number;
use crate::write::OutputFile;

const HEAD: &[u8] =
    b"0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n";

pub(super) fn write(mesh: &MeshView<'_>, out: &mut OutputFile<'_>) -> Result<(), Error> {
    let vertices = mesh.places();
    out.put(HEAD)?;
    out.each(mesh.triangles(), |&[a, b, c], bytes| {
        bytes.extend_from_slice(b"0\n3DFACE\n8\n0\n");
        for (corner, id) in [a, b, c, c].into_iter().enumerate() {
            for (axis, value) in vertices[id as usize].into_iter().enumerate() {
                // Codes 10, 20, 30 are the first corner, 11, 21, 31 the second, and so on.
                bytes.extend([b'1' + axis as u8, b'0' + corner as u8, b'\n']);
                put_number(value, bytes);
                bytes.push(b'\n');
            }
        }
    })?;
    out.put(b"0\nENDSEC\n0\nEOF\n")
}
