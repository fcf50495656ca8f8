//! The surface through points of space.

use serde_json::Value;
use taut::certify::{Surface, SurfaceMethod as Kind};
use taut::points::Scratch;
use taut::reconstruct::{Denoise, SurfaceMode};
use taut::{Monitor, PointSource, Solution, SurfaceMethod, SurfaceOptions, surface};
use taut_io::{Mesh, MeshOptions, mesh_bytes};

use crate::input::Opened;
use crate::options::{self, Options};
use crate::shape::{Found, Shape};

pub(super) fn options() -> Vec<Value> {
    vec![
        options::choice::<Kind>("method", "The way to find it", |_| true),
        options::flag("open", "Sheets may end where their samples end, by the method tree"),
        options::flag("denoise", "Take noise out of the points first"),
    ]
}

pub(super) fn solve(
    points: &Opened,
    options: &Options,
    monitor: &Monitor<'_>,
) -> Result<Box<dyn Shape>, String> {
    let method = match options.choice("method")? {
        Kind::Tree if options.flag("open") => SurfaceMethod::Tree(SurfaceMode::Open),
        Kind::Tree => SurfaceMethod::Tree(SurfaceMode::Closed),
        _ if options.flag("open") => return Err("option `open` is of the method tree".to_owned()),
        Kind::Thesis => SurfaceMethod::Thesis(Default::default()),
        Kind::Alpha => SurfaceMethod::Alpha(None),
        Kind::Hull => SurfaceMethod::Hull(Default::default()),
    };
    let denoise = options.flag("denoise").then(Denoise::default);
    let options = SurfaceOptions { method, denoise, monitor: *monitor, ..Default::default() };
    let found = surface(points.source(), &options).map_err(|error| points.explain(error))?;
    Ok(Found::boxed(found, file))
}

fn file(
    found: &Solution<Surface>,
    source: &dyn PointSource,
    name: &str,
) -> Result<Vec<u8>, String> {
    let vertices = match found.answer.vertices.is_empty() {
        true => places(source)?,
        false => found.answer.vertices.clone(),
    };
    let mesh = Mesh::of_triangles(vertices, &found.answer.triangles);
    let view = mesh.view().map_err(|error| error.to_string())?;
    mesh_bytes(&view, name, &MeshOptions::default(), &Monitor::silent()).map_err(|e| e.to_string())
}

fn places(source: &dyn PointSource) -> Result<Vec<[f64; 3]>, String> {
    let mut scratch = Scratch::new();
    let rows = source.read(0..source.len(), &mut scratch).map_err(|error| error.to_string())?;
    let mut place = [0.0; 3];
    Ok((0..rows.len())
        .map(|row| {
            rows.copy_row(row, &mut place);
            place
        })
        .collect())
}
