//! The Delaunay triangulation.

use serde_json::Value;
use taut::certify::Triangulation;
use taut::delaunay::InsertionOrder;
use taut::{DelaunayOptions, Monitor, PointSource, Solution, delaunay};
use taut_io::{MeshOptions, MeshView, mesh_bytes};

use crate::input::Opened;
use crate::options::{self, Options};
use crate::shape::{Found, Shape};

pub(super) fn options() -> Vec<Value> {
    let help = "In which order points are inserted; the answer does not depend on it";
    vec![options::choice::<InsertionOrder>("order", help, |_| true)]
}

pub(super) fn solve(
    points: &Opened,
    options: &Options,
    monitor: &Monitor<'_>,
) -> Result<Box<dyn Shape>, String> {
    let options = DelaunayOptions {
        order: options.choice("order")?,
        monitor: *monitor,
        ..DelaunayOptions::default()
    };
    let found = delaunay(points.source(), &options).map_err(|error| points.explain(error))?;
    Ok(Found::boxed(found, file))
}

fn file(
    found: &Solution<Triangulation>,
    source: &dyn PointSource,
    name: &str,
) -> Result<Vec<u8>, String> {
    let (simplices, width) = (&found.answer.simplices, found.answer.vertices_per_simplex());
    if width == 0 {
        return Err("there are no points, so there is no mesh".to_owned());
    }
    let mesh = MeshView::on_points(source, simplices, width);
    mesh_bytes(&mesh, name, &MeshOptions::default(), &Monitor::silent()).map_err(|e| e.to_string())
}
