//! The stops about shapes inside others: an ellipse in a polygon, bodies in a mesh.

use taut::inscribe::{
    BodiesOptions, BodyShape, EllipseOptions, inscribed_bodies, inscribed_ellipse,
};

use super::stations::Station;
use super::{Stop, checked_and_drawn};
use crate::input::reading::Opened;
use crate::output::numbers::{count, gap, short};
use crate::watch::Watch;

/// Facet events of a search: enough for a small mesh, and soon done.
const EVENTS: u64 = 20_000;

/// Units of the grid by which facets are moved outward for the doctored answer: from a hundredth of the longest side.
const MOVED_UNITS: i64 = 1 << 17;

pub(super) fn ellipse(station: &Station, ring: &Opened, watch: &Watch) -> anyhow::Result<Stop> {
    let found = watch
        .during("solving", |monitor| {
            let options = EllipseOptions { monitor: *monitor, ..EllipseOptions::default() };
            inscribed_ellipse(ring.source(), &options)
        })
        .map_err(|error| ring.explain(error))?;
    let doctor = || {
        let mut doctored = found.clone();
        doctored.answer.axes.iter_mut().for_each(|row| row[0] *= 1.001);
        doctored.answer.area *= 1.001;
        doctored
    };
    checked_and_drawn(station, &found, ring, watch, ("a thousandth longer", &doctor), |verdict| {
        let area = short(found.answer.area);
        match verdict {
            Some(proved) => format!("area {area:<12} gap {}", gap(proved.gap)),
            None => format!("area {area}"),
        }
    })
}

pub(super) fn bodies(
    station: &Station,
    number: usize,
    mesh: &Opened,
    watch: &Watch,
) -> anyhow::Result<Stop> {
    let found = watch
        .during("solving", |monitor| {
            let options = BodiesOptions {
                shape: BodyShape::Dop(18),
                count: number,
                events: EVENTS,
                monitor: *monitor,
                ..BodiesOptions::default()
            };
            inscribed_bodies(mesh.source(), &options)
        })
        .map_err(|error| mesh.explain(error))?;
    let doctor = || {
        let mut doctored = found.clone();
        for body in doctored.answer.bodies.iter_mut().take(1) {
            body.offsets.iter_mut().for_each(|offset| *offset += MOVED_UNITS);
        }
        doctored
    };
    checked_and_drawn(station, &found, mesh, watch, ("a body grown", &doctor), |_| {
        let volume: f64 = found.answer.bodies.iter().map(|body| body.volume).sum();
        let bodies = count(found.answer.bodies.len() as u64);
        format!("{bodies} bodies, their volumes add up to {}", short(volume))
    })
}
