//! Curves through points of the plane.

use serde_json::Value;
use taut::certify::Curve;
use taut::reconstruct::Ends;
use taut::{CurveMethod, CurveOptions, Monitor, PointSource, Solution, curve};
use taut_io::{Polyline, polylines_bytes};

use crate::input::Opened;
use crate::options::{self, Options};
use crate::shape::{Found, Shape};

pub(super) fn options() -> Vec<Value> {
    vec![
        options::choice::<CurveMethod>("method", "The way to find them", |_| true),
        options::flag("open", "A curve ends where its samples end: no gap is closed"),
    ]
}

pub(super) fn solve(
    points: &Opened,
    options: &Options,
    monitor: &Monitor<'_>,
) -> Result<Box<dyn Shape>, String> {
    let options = CurveOptions {
        method: options.choice("method")?,
        ends: if options.flag("open") { Ends::Open } else { Ends::Auto },
        monitor: *monitor,
        ..CurveOptions::default()
    };
    let found = curve(points.source(), &options).map_err(|error| points.explain(error))?;
    Ok(Found::boxed(found, file))
}

fn file(found: &Solution<Curve>, _: &dyn PointSource, name: &str) -> Result<Vec<u8>, String> {
    let curves: Vec<Polyline<'_>> = found
        .answer
        .curves
        .iter()
        .map(|curve| Polyline { vertices: &curve.vertices, closed: curve.closed })
        .collect();
    polylines_bytes(&curves, name).map_err(|error| error.to_string())
}
