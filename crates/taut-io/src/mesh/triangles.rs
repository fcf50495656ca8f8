//! The triangles of a mesh as points of dimension 9.

use std::path::Path;

use taut_points::{OwnedPoints, PointSource};

use super::open_mesh;
use crate::{Content, Error, Format, Input, ReadOptions, open};

/// Opens the triangles of a mesh: each row has the three coordinates of each of three corners, in the order of the file.
///
/// Formats of surfaces are read as by [`open_mesh`]; of any other format each row is a triangle, as by [`open`].
///
/// # Errors
/// Those of [`open_mesh`] and [`open`]; [`Error::EmptyMesh`] for a mesh without triangles.
pub fn open_triangles(path: &Path, options: &ReadOptions) -> Result<Input, Error> {
    let format = options.format.or(Format::of_path(path).0);
    let Some(format) = format.filter(|format| format.reads(Content::Surface)) else {
        return open(path, options);
    };
    if options.feature.is_some() {
        return Err(Error::NoFeatures { path: crate::error::shown_path(path), format });
    }
    let mesh = open_mesh(path, Content::Surface, Some(format))?;
    let vertices = mesh.triangles().as_flattened();
    let corners = vertices.iter().flat_map(|&vertex| mesh.vertices[vertex as usize]);
    let shown = crate::error::shown_path(path);
    let points = OwnedPoints::new(corners.collect::<Vec<f64>>(), 9).ok();
    let Some(points) = points.filter(|points| points.len() > 0) else {
        return Err(Error::EmptyMesh { path: shown, missing: "triangle" });
    };
    Ok(Input::of_mesh(Box::new(points), format, shown))
}
