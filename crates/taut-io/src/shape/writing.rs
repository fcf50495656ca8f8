//! A shape to a file, whatever its format.

use std::path::Path;

use super::{ShapeFormat, ShapeView, dxf, gltf, obj, off, ply, pov, stl, vrml};
use crate::Error;
use crate::create::AtomicFile;
use crate::error::shown_path;
use crate::write::Out;

/// How to write a shape. Write `ShapeOptions { encoding: Encoding::Text, ..Default::default() }`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ShapeOptions {
    /// The format; by default that of the extension.
    pub format: Option<ShapeFormat>,
    /// How ply and stl are written, which know both ways. Default [`Encoding::Binary`].
    pub encoding: Encoding,
}

/// Numbers as bytes or as decimals.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Encoding {
    /// As bytes: shorter and faster.
    #[default]
    Binary,
    /// As decimals that read back to the same bits.
    Text,
}

/// Writes a shape to `path`, as [`shape_file`] and [`AtomicFile::commit`].
///
/// ```
/// use taut_io::{ShapeOptions, ShapeView, open_shape, write_shape};
/// use taut_mesh::TriangleMesh;
///
/// let vertices = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.1, 0.0]];
/// let mesh = TriangleMesh::new(&vertices, &[[0, 1, 2]])?;
/// let path = std::env::temp_dir().join(format!("taut-{}.ply", std::process::id()));
/// write_shape(&ShapeView::from(mesh), &path, &ShapeOptions::default())?;
/// assert_eq!(open_shape(&path, None)?.vertices, vertices);
/// # std::fs::remove_file(path)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`shape_file`], and those of the commit; an earlier file of that name is then as it was.
pub fn write_shape(
    shape: &ShapeView<'_>,
    path: &Path,
    options: &ShapeOptions,
) -> Result<(), Error> {
    shape_file(shape, path, options)?.commit()
}

/// The file that [`write_shape`] writes, complete, but not yet in its place; `-` is standard output. The extensions `.gz`,
/// `.xz` and `.zst` compress.
///
/// # Errors
/// Before anything is written: [`Error::UnknownShape`] and [`Error::ShapeNotWritable`] of the format,
/// [`Error::ShapeAttributes`], [`Error::ShapeNormal`], [`Error::ShapePoints`] and [`Error::ShapeRange`] of the shape. Then
/// [`Error::ShapeTooLarge`] and those of [`create`](crate::create) and of writing.
pub fn shape_file(
    shape: &ShapeView<'_>,
    path: &Path,
    options: &ShapeOptions,
) -> Result<AtomicFile, Error> {
    let shown = shown_path(path);
    let (named, compression) = ShapeFormat::of_path(path);
    let format = options.format.or(named);
    let format = format.ok_or_else(|| Error::UnknownShape { path: shown.clone() })?;
    check(shape, &shown, format, options.encoding)?;
    let mut out = Out::create(path, &shown, compression)?;
    match format {
        ShapeFormat::Ply => ply::write(shape, options.encoding, &mut out)?,
        ShapeFormat::Obj => obj::write(shape, &mut out)?,
        ShapeFormat::Off => off::write(shape, &mut out)?,
        ShapeFormat::Stl => stl::write(shape, options.encoding, &mut out)?,
        ShapeFormat::Glb => gltf::write_binary(shape, &mut out)?,
        ShapeFormat::Gltf => gltf::write_json(shape, &mut out)?,
        ShapeFormat::Dxf => dxf::write(shape, &mut out)?,
        ShapeFormat::Vrml => vrml::write(shape, &mut out)?,
        ShapeFormat::Pov => pov::write(shape, &mut out)?,
        ShapeFormat::Xyz => return Err(Error::ShapeNotWritable { path: shown, format }),
    }
    out.finish()
}

/// Refuses what the format cannot hold.
fn check(
    shape: &ShapeView<'_>,
    shown: &str,
    format: ShapeFormat,
    encoding: Encoding,
) -> Result<(), Error> {
    let path = || shown.to_owned();
    let vertices = shape.mesh.vertices();
    if !format.can_write() {
        return Err(Error::ShapeNotWritable { path: path(), format });
    }
    let given =
        [("normals", shape.normals.map(<[_]>::len)), ("colours", shape.colors.map(<[_]>::len))];
    for (what, found) in given {
        if let Some(found) = found.filter(|&found| found != vertices.len()) {
            return Err(Error::ShapeAttributes {
                path: path(),
                what,
                found,
                vertices: vertices.len(),
            });
        }
    }
    let normals = shape.normals.unwrap_or_default().as_flattened();
    if let Some(place) = normals.iter().position(|value| !value.is_finite()) {
        let (vertex, column, value) = (place / 3, place % 3, normals[place]);
        return Err(Error::ShapeNormal { path: path(), vertex, column, value });
    }
    if shape.mesh.triangles().is_empty() && (vertices.is_empty() || !format.holds_points()) {
        return Err(Error::ShapePoints { path: path(), format });
    }
    let single = match format {
        ShapeFormat::Glb | ShapeFormat::Gltf => true,
        ShapeFormat::Stl => encoding == Encoding::Binary,
        _ => false,
    };
    let flat = vertices.as_flattened();
    match flat.iter().position(|&value| single && !(value as f32).is_finite()) {
        None => Ok(()),
        Some(place) => {
            let (vertex, column, value) = (place / 3, place % 3, flat[place]);
            Err(Error::ShapeRange { path: path(), format, vertex, column, value })
        }
    }
}
