//! Surfaces: what is written is read back, by us and by others, and what is damaged is refused.

mod damaged;
mod golden;
mod judges;
mod refusals;
mod round_trip;

use std::path::Path;

use taut_io::{
    Content, Encoding, Error, Format, Mesh, MeshOptions, open_mesh, open_mesh_bytes, write_mesh,
};
use taut_points::Monitor;

/// A surface with its triangles as triples.
#[derive(Clone, Debug, Default, PartialEq)]
struct Surface {
    vertices: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    normals: Option<Vec<[f64; 3]>>,
    colors: Option<Vec<[u8; 3]>>,
}

impl Surface {
    fn mesh(&self) -> Mesh {
        let (normals, colors) = (self.normals.clone(), self.colors.clone());
        Mesh { normals, colors, ..Mesh::of_triangles(self.vertices.clone(), &self.triangles) }
    }
}

impl From<Mesh> for Surface {
    fn from(mesh: Mesh) -> Self {
        let triangles = mesh.triangles().to_vec();
        let Mesh { vertices, normals, colors, .. } = mesh;
        Surface { vertices, triangles, normals, colors }
    }
}

/// A vertex repeated, one that no triangle uses, a negative zero, and numbers that need all their digits.
fn sample() -> Surface {
    Surface {
        vertices: vec![
            [0.1, -0.0, 3.0],
            [1.0 / 3.0, 5e-324, 1.0],
            [0.1, -0.0, 3.0],
            [-1e300, 2.0, 4.5],
            [1e-9, 7.0, 1e22],
            [8.0, 9.0, -1.0],
        ],
        triangles: vec![[0, 1, 3], [4, 3, 1], [2, 4, 0], [1, 1, 4]],
        normals: None,
        colors: None,
    }
}

/// The sample with what a vertex can have.
fn with(normals: bool, colors: bool) -> Surface {
    let each = |i: usize| [0.1 * i as f64, -1.0 / 3.0, (i as f64).exp()];
    let shape = sample();
    let n = shape.vertices.len();
    Surface {
        normals: normals.then(|| (0..n).map(each).collect()),
        colors: colors.then(|| (0..n).map(|i| [i as u8, 255 - i as u8, 128]).collect()),
        ..shape
    }
}

/// The four of them.
fn samples() -> [Surface; 4] {
    [with(false, false), with(true, false), with(false, true), with(true, true)]
}

/// A shape that single precision holds, on vertices that are all used, in the order of their use, and all different.
fn single() -> Surface {
    Surface {
        vertices: vec![[0.5, 0.0, 3.0], [0.25, 1.0, 1.0], [-8.0, 2.0, 4.5], [1.0, 7.0, 1024.0]],
        triangles: vec![[0, 1, 2], [2, 1, 3], [3, 0, 2]],
        ..Default::default()
    }
}

/// Bits of all coordinates, and the rest.
fn bits(shape: &Surface) -> impl PartialEq + std::fmt::Debug + use<> {
    let of = |places: &[[f64; 3]]| -> Vec<[u64; 3]> {
        places.iter().map(|at| at.map(f64::to_bits)).collect()
    };
    let normals = shape.normals.as_deref().map(of);
    (of(&shape.vertices), shape.triangles.clone(), normals, shape.colors.clone())
}

fn write_with(shape: &Surface, path: &Path, encoding: Encoding) -> Result<(), Error> {
    write_to(shape, path, &MeshOptions { encoding, ..Default::default() })
}

fn write_to(shape: &Surface, path: &Path, options: &MeshOptions) -> Result<(), Error> {
    write_mesh(&shape.mesh().view().unwrap(), path, options, &Monitor::silent())
}

/// The bytes of a file of the given name.
fn bytes_of(shape: &Surface, name: &str, encoding: Encoding) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    write_with(shape, &path, encoding).unwrap();
    std::fs::read(path).unwrap()
}

fn text_of(shape: &Surface, name: &str) -> String {
    String::from_utf8(bytes_of(shape, name, Encoding::Text)).unwrap()
}

fn read(name: &str, bytes: impl Into<Vec<u8>>) -> Result<Surface, Error> {
    open_mesh_bytes(bytes.into(), name, Content::Surface, None).map(Surface::from)
}

fn open_surface(path: &Path, format: Option<Format>) -> Result<Surface, Error> {
    open_mesh(path, Content::Surface, format).map(Surface::from)
}

fn message(read: Result<Surface, Error>) -> String {
    read.expect_err("this should not have been read").to_string()
}

const ENCODINGS: [Encoding; 2] = [Encoding::Binary, Encoding::Text];

fn written() -> impl Iterator<Item = Format> {
    Format::all().filter(|format| format.writes(Content::Surface))
}
