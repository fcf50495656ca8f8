//! The ellipsoid of least volume.

use serde_json::Value;
use taut::{EllipsoidMethod, EllipsoidOptions, Monitor, ellipsoid};

use crate::input::Opened;
use crate::options::{self, Options};
use crate::shape::{Found, Shape};

pub(super) fn options() -> Vec<Value> {
    vec![
        options::number(
            "epsilon",
            EllipsoidOptions::default().epsilon,
            "Proved gap of the log-volume to reach, in [0, 1)",
        ),
        options::choice::<EllipsoidMethod>("method", "The way to find it", |_| true),
    ]
}

pub(super) fn solve(
    points: &Opened,
    options: &Options,
    monitor: &Monitor<'_>,
) -> Result<Box<dyn Shape>, String> {
    let usual = EllipsoidOptions::default();
    let options = EllipsoidOptions {
        epsilon: options.number("epsilon", usual.epsilon)?,
        method: options.choice("method")?,
        monitor: *monitor,
        ..usual
    };
    let found = ellipsoid(points.source(), &options).map_err(|error| points.explain(error))?;
    Ok(Found::boxed(found, super::no_file))
}
