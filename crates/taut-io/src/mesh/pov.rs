//! Scene description of POV-Ray: a `mesh2` by the name `Shape`, for scenes that include the file.
//!
//! Triangles without area are left out, as POV-Ray refuses them. Its coordinates are left-handed: what is written as it is
//! shows a mirror image, unless the scene scales it by −1 along one axis.
//!
//! *Reference.* POV-Ray 3.7 documentation, section Mesh2.

use super::MeshView;
use super::normal::unit_normal;
use crate::Error;
use crate::words::{put_numbers, put_whole};
use crate::write::OutputFile;

pub(super) fn write(mesh: &MeshView<'_>, out: &mut OutputFile<'_>) -> Result<(), Error> {
    let (vertices, triangles) = (mesh.places(), mesh.triangles());
    let has_area = |ids: &&[u32; 3]| unit_normal(ids.map(|id| vertices[id as usize])).is_some();
    let vectors = |name: &str, vectors: &[[f64; 3]], out: &mut OutputFile<'_>| {
        out.put(format!("{name} {{ {}", vectors.len()).as_bytes())?;
        out.each(vectors, |&vector, bytes| {
            bytes.extend_from_slice(b",\n<");
            put_numbers(vector, b",", bytes);
            bytes.push(b'>');
        })?;
        out.put(b"\n}\n")
    };
    out.put(b"#declare Shape = mesh2 {\n")?;
    vectors("vertex_vectors", vertices, out)?;
    if let Some(normals) = mesh.normals {
        vectors("normal_vectors", normals, out)?;
    }
    let count = triangles.iter().filter(has_area).count();
    out.put(format!("face_indices {{ {count}").as_bytes())?;
    out.each(triangles.iter().filter(has_area), |&[a, b, c], bytes| {
        for (before, id) in [(&b",\n<"[..], a), (b",", b), (b",", c)] {
            bytes.extend_from_slice(before);
            put_whole(id.into(), bytes);
        }
        bytes.push(b'>');
    })?;
    out.put(b"\n}\n}\n")
}
