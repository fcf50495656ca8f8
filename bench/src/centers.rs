//! k centers: proven optima of cities and of space, centers among the points, traversals, outliers and streams; queries of trees.

mod case;
pub(crate) mod cities;
mod discrete;
mod free;
mod judgement;
mod outliers;
mod streams;
mod traversal;
mod trees;

use taut_certify::{Centers, CentersVerdict, LowerBound, Placement, Solution};
use taut_enclose::{
    CentersOptions, FarthestFirst, FarthestFirstOptions, StreamingCenters, StreamingOptions,
    centers, farthest_first,
};
use taut_points::{PointSource, Scalar};

use crate::context::pool;
use crate::prelude::*;
use crate::read::plain_read;
use crate::rounds::{self, Opponents, Seen, TIME_COLUMNS};
pub(crate) use case::AREA;
use case::{
    BANDWIDTH, CHECK, CORE_SET, DIFFERS, FACTOR, GERMANY, KNOWN_RADIUS_TOLERANCE, Set, Task,
};
use judgement::{COLUMNS, judge};
