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

use taut_certify::{Centers, CentersVerdict, Items, LowerBound, Placement, Solution};
use taut_enclose::{
    CentersOptions, Cover, CoverOptions, FarthestFirst, FarthestFirstOptions, centers,
    farthest_first,
};
use taut_points::{PointSource, Scalar};

use crate::context::pool;
use crate::prelude::*;
use crate::read::plain_read;
use crate::rounds::{Beside, Seen, TIME_COLUMNS};
use case::{AREA, GERMANY, Kind, Set, Task};
use goals::{BANDWIDTH, CHECK, CORE_SET, DIFFERS, FACTOR, FACTOR_ROUNDING, KNOWN_RADIUS_TOLERANCE};
use judgement::{COLUMNS, judge};

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
