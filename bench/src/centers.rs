//! k centers: proven optima of cities and of space, centers among the points, traversals, outliers and streams.

mod case;
mod cities;
mod discrete;
mod free;
mod goals;
mod judgement;
mod outliers;
mod streams;
mod traversal;

use crate::prelude::*;
use case::{AREA, Kind};

/// Runs the sections that were asked for.
pub(crate) fn run(options: &Options) -> Result<()> {
    AREA.run(options, |context, out, section| match section.kind {
        Kind::Free(tasks) => free::run(context, out, tasks),
        Kind::Discrete => discrete::run(context, out),
        Kind::Traversal => traversal::run(context, out),
        Kind::Outliers => outliers::run(context, out),
        Kind::Streams => streams::run(context, out),
    })
}
