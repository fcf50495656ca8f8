//! Shapes: what is written is read back, by us and by others, and what is damaged is refused.

mod damaged;
mod golden;
mod judges;
mod refusals;
mod round_trip;

use std::path::Path;

use taut_io::{Encoding, Error, Shape, ShapeFormat, ShapeOptions, open_shape_bytes, write_shape};

/// A vertex repeated, one that no triangle uses, a negative zero, and numbers that need all their digits.
fn sample() -> Shape {
    Shape {
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
fn with(normals: bool, colors: bool) -> Shape {
    let each = |i: usize| [0.1 * i as f64, -1.0 / 3.0, (i as f64).exp()];
    let shape = sample();
    let n = shape.vertices.len();
    Shape {
        normals: normals.then(|| (0..n).map(each).collect()),
        colors: colors.then(|| (0..n).map(|i| [i as u8, 255 - i as u8, 128]).collect()),
        ..shape
    }
}

/// The four of them.
fn samples() -> [Shape; 4] {
    [with(false, false), with(true, false), with(false, true), with(true, true)]
}

/// A shape that single precision holds, on vertices that are all used, in the order of their use, and all different.
fn single() -> Shape {
    Shape {
        vertices: vec![[0.5, 0.0, 3.0], [0.25, 1.0, 1.0], [-8.0, 2.0, 4.5], [1.0, 7.0, 1024.0]],
        triangles: vec![[0, 1, 2], [2, 1, 3], [3, 0, 2]],
        ..Default::default()
    }
}

/// Bits of all coordinates, and the rest.
fn bits(shape: &Shape) -> impl PartialEq + std::fmt::Debug + use<> {
    let of = |places: &[[f64; 3]]| -> Vec<[u64; 3]> {
        places.iter().map(|at| at.map(f64::to_bits)).collect()
    };
    let normals = shape.normals.as_deref().map(of);
    (of(&shape.vertices), shape.triangles.clone(), normals, shape.colors.clone())
}

fn write_with(shape: &Shape, path: &Path, encoding: Encoding) -> Result<(), Error> {
    write_shape(&shape.view().unwrap(), path, &ShapeOptions { encoding, ..Default::default() })
}

/// The bytes of a file of the given name.
fn bytes_of(shape: &Shape, name: &str, encoding: Encoding) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    write_with(shape, &path, encoding).unwrap();
    std::fs::read(path).unwrap()
}

fn text_of(shape: &Shape, name: &str) -> String {
    String::from_utf8(bytes_of(shape, name, Encoding::Text)).unwrap()
}

fn read(name: &str, bytes: impl Into<Vec<u8>>) -> Result<Shape, Error> {
    open_shape_bytes(bytes.into(), name, None)
}

fn message(read: Result<Shape, Error>) -> String {
    read.expect_err("this should not have been read").to_string()
}

const ENCODINGS: [Encoding; 2] = [Encoding::Binary, Encoding::Text];

fn written() -> impl Iterator<Item = ShapeFormat> {
    ShapeFormat::ALL.into_iter().filter(|format| format.can_write())
}
