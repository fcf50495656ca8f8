//! A large convex polygon in a polygon ("potato peeling").
//!
//! *Problem.* Find the convex polygon of the largest area in the inside of a polygon with holes. The exact algorithm takes O(n⁷)
//! (Chang and Yap); this one finds a local optimum and proves how far it can be from the largest.
//! *Idea.* From local ellipses the nearest edges carve a body; each side is then turned about the corner that it touches until
//! that is the middle of it ([`pivot`]); rounds of ruin and recreation go on from there ([`search`]).
//! *Bound.* The largest ellipse in a convex body has at least π/(3√3) of its area, and the bound of ellipses is proved
//! ([`inscribed_ellipse`](crate::inscribed_ellipse())). The convex hull of the polygon is a second bound.
//! *Guarantee.* The answer is inside by exact signs; largest area ≤ (1 + gap)·area, with a gap of up to 65 % even where the
//! answer is the largest.
//! *References.* Chang and Yap, A polynomial solution for the potato-peeling problem, Discrete Comput. Geom. 1, 1986. The ratio:
//! Behrend, Über einige Affininvarianten konvexer Bereiche, Math. Ann. 113, 1937.

mod carve;
mod pivot;
mod region;
mod report;
mod search;

use std::collections::BTreeMap;

use taut_certify::{ConvexCertificate, ConvexPolygon, Solution, Stop, Trace};
use taut_points::{InputError, Monitor, PointSource};

use crate::Error;
use crate::ellipse::{self, EllipseOptions};
use crate::polygon::{Polygon, is_measurable};
use crate::units::Units;

/// Ratio of areas of a triangle and its largest ellipse, 3√3/π, rounded up.
const RATIO_MAX: f64 = 1.653_986_686_265_376_4;

/// What rounding can change in the gap, relatively.
const GAP_SLACK: f64 = 1e-9;

/// How to look for the polygon. Write `ConvexOptions { rounds: 0, ..Default::default() }`.
#[derive(Clone)]
pub struct ConvexOptions<'a> {
    /// Rounds of ruin and recreation for each of the best bodies. Default 200.
    pub rounds: u64,
    /// Local ellipses to start from. At least 1, by default 32.
    pub starts: u64,
    /// Seed of the rounds. Default 1.
    pub seed: u64,
    /// Proved relative gap of the largest ellipse, which is the bound, in (0, 1). Default 1e-2.
    pub epsilon: f64,
    /// Watches the work and can stop it. Default [`Monitor::silent`].
    pub monitor: Monitor<'a>,
}

impl Default for ConvexOptions<'_> {
    fn default() -> Self {
        ConvexOptions {
            rounds: 200,
            starts: 32,
            seed: 1,
            epsilon: 1e-2,
            monitor: Monitor::silent(),
        }
    }
}

/// Finds a large convex polygon in a polygon.
///
/// Points (x, y) are the vertices of one ring in order; points (x, y, r) those of several rings, r being the number of the ring:
/// 0, 1, and so on. Inside is what an odd number of rings wind around. The last vertex of a ring may repeat its first. The points
/// are read once and kept in memory.
///
/// # Errors
/// [`Error::NotSimple`] with two edges that meet, [`Error::RingNumber`], [`Error::TooFewVertices`], [`Error::TooThin`],
/// [`Error::Area`] when the area is no normal number, and [`Error::Input`] for bad points or options, and for what reading says.
pub fn inscribed_polygon(
    polygon: &dyn PointSource,
    options: &ConvexOptions<'_>,
) -> Result<Solution<ConvexPolygon>, Error> {
    let Some(starts) = usize::try_from(options.starts).ok().filter(|&starts| starts > 0) else {
        let (name, value) = ("starts", options.starts.to_string());
        return Err(InputError::Option { name, value, expected: "at least 1" }.into());
    };
    let of_ellipse = EllipseOptions {
        epsilon: options.epsilon,
        monitor: options.monitor,
        ..EllipseOptions::default()
    };
    ellipse::check_options(&of_ellipse)?;
    let polygon = Polygon::read(polygon, &options.monitor)?;
    let units = Units::of(&polygon.edges);
    let ellipse = ellipse::solved(&polygon, &units, &of_ellipse)?;
    let found = search::search(&units, starts, options.rounds, options.seed, &options.monitor)?;
    let body = found.ok_or(Error::TooThin)?;
    let reported = report::rounded(&body.region, &units, &polygon.edges).ok_or(Error::TooThin)?;
    let area = report::area(&reported.corners);
    let by_ellipse = ellipse.answer.area * (1.0 + ellipse.certificate.gap) * RATIO_MAX;
    let hull = report::hull(polygon.edges.iter().map(|edge| edge[0]).collect());
    let upper = by_ellipse.min(report::area(&hull) + report::area_error(&hull));
    let lower = area - report::area_error(&reported.corners);
    let gap = ((upper / lower) * (1.0 + GAP_SLACK) - 1.0).max(0.0);
    if !is_measurable(area, gap) {
        return Err(Error::Area);
    }
    if lower <= 0.0 {
        return Err(Error::TooThin);
    }
    let counters =
        [("cells", ellipse.certificate.tree.len() as u64), ("vertices", polygon.rows.len() as u64)];
    let trace = Trace {
        method: "carve".to_owned(),
        stop: Stop::Converged,
        passes: 1,
        iterations: options.rounds,
        core_set: reported.corners.len() as u64,
        history: vec![],
        counters: BTreeMap::from(counters.map(|(name, count)| (name.to_owned(), count))),
    };
    let certificate = ConvexCertificate {
        inside: reported.inside,
        gap,
        ellipse: ellipse.answer,
        ellipse_certificate: ellipse.certificate,
    };
    Ok(Solution { answer: ConvexPolygon { vertices: reported.corners, area }, certificate, trace })
}
