//! The largest circle in a polygon.
//!
//! *Problem.* The clearance of a point q is its distance to the nearest edge, d(q) = minᵢ dist(q, eᵢ). Find the center inside
//! with the largest clearance.
//! *Idea.* Branch and bound over cells of the bounding box ([`search`]). For weights λ ≥ 0 with Σ λᵢ = 1 the clearance is at most
//! Σ λᵢ·dist(q, eᵢ), which is convex and so largest at a corner of the cell. The best weights of a cell are a solution of a small
//! linear program ([`weights`]). At a local optimum the normals of the touching edges are balanced, Σ λᵢnᵢ = 0, so that the bound
//! is off by the square of the size of the cell only, and by nothing where edges are touched between their ends: a cell
//! around the optimum closes before it is small. The edges of the weights also give the center, by Newton's method ([`polish`]).
//! *Guarantee.* largest radius ≤ (1 + ε)·radius, from the leaves of the subdivision, which are the certificate. No circle is
//! reported that an edge enters.
//! *Trap.* Far from the origin, or in a needle, no point in double precision is as good as the best center: the search then ends
//! at cells that have no middle, with the gap that is left.
//! *Reference.* Garcia-Castellanos and Lombardo, Poles of inaccessibility, Scottish Geographical J. 123(3), 2007, and the
//! program polylabel, for cells with d(center) + half a diagonal as the bound; the weights are new here.

mod cell;
mod distance;
mod log;
mod polish;
mod queries;
mod search;
mod weights;

use std::collections::BTreeMap;

use taut_certify::{CircleCertificate, InscribedCircle, Solution, Trace};
use taut_points::{InputError, Monitor, PointSource, shown_number};

use crate::Error;
use crate::polygon::{Polygon, is_inside};

use self::distance::Edges;

/// The largest excess of the distance of a touching edge over the radius, relative to the radius; rounding of the center comes on top.
const TOUCHING_SLACK: f64 = 1e-10;

/// Absolute rounding errors of distances in plain arithmetic, coordinates being below 2 in size: 16u.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Options to look for the circle. Write `CircleOptions { epsilon: 1e-6, ..Default::default() }`.
#[derive(Clone)]
pub struct CircleOptions<'a> {
    /// Proved relative gap to reach, in (0, 1): largest radius ≤ (1 + ε)·radius. Default 1e-9.
    pub epsilon: f64,
    /// Most cells of the certificate; where ε takes more, a larger gap is proved. At least 1, by default a million.
    pub max_cells: u64,
    /// Watches the work and can stop it. Default [`Monitor::silent`].
    pub monitor: Monitor<'a>,
}

impl Default for CircleOptions<'_> {
    fn default() -> Self {
        CircleOptions { epsilon: 1e-9, max_cells: 1_000_000, monitor: Monitor::silent() }
    }
}

/// Finds the largest circle in a polygon.
///
/// The points (x, y) are the vertices of one ring in order; points (x, y, r) those of several rings, r being the number of the ring:
/// 0, 1, and so on. Inside is what an odd number of rings wind around. The last vertex of a ring may repeat its first. Center and
/// radius are in the unit of the points, which are read once and kept in memory. The method is that of the head of this module:
/// cells with weights on edges as bounds.
///
/// # Cost
/// About O(n) for the test of the rings of outlines, and for each cell of the search O(log n) and its near edges; tens to hundreds
/// of cells for outlines of countries.
///
/// # Errors
/// [`Error::NotSimple`] with two edges that meet, [`Error::RingNumber`], [`Error::TooFewVertices`], [`Error::TooThin`], and
/// [`Error::Input`] for bad points or options, and for what reading says.
pub fn inscribed_circle(
    polygon: &dyn PointSource,
    options: &CircleOptions<'_>,
) -> Result<Solution<InscribedCircle>, Error> {
    check_options(options)?;
    let polygon = Polygon::read(polygon, &options.monitor)?;
    let edges = Edges::of(&polygon.edges, &polygon.runs);
    let found = search::search(&edges, options)?;
    let radius = edges.unscaled_down(found.radius);
    if found.center.is_none() || radius <= 0.0 {
        return Err(Error::TooThin);
    }
    if radius < RADIUS_MIN {
        return Err(Error::Area);
    }
    let center = found.center.unwrap_or_default();
    // In units of the last place of the coordinates the center may be rounded out of a needle.
    if !is_inside(polygon.edges.iter().copied(), center) {
        return Err(Error::TooThin);
    }
    let point = edges.scaled(center);
    let rounding = 2.0 * f64::EPSILON * (point[0].abs() + point[1].abs());
    let most = found.radius * (1.0 + TOUCHING_SLACK) + rounding;
    let mut touching = vec![];
    edges.within(point, most + ROUNDING, usize::MAX, &mut touching);
    // In a needle plain distances may be off by more than the radius.
    touching.retain(|&edge| edges.accurate(point, edge) - edges.error(point, edge) <= most);
    let certificate = CircleCertificate {
        touching: touching.iter().map(|&edge| polygon.rows[edge as usize]).collect(),
        tree: found.log.tree,
        leaves: found.log.leaves.into_iter().map(|leaf| leaf.numbers(&polygon.rows)).collect(),
        gap: ((found.upper / found.radius) * (1.0 + 8.0 * f64::EPSILON) - 1.0).max(0.0),
        points_hash: polygon.points_hash,
    };
    let counters = [
        ("cells", certificate.tree.len() as u64),
        ("searches", found.searches),
        ("vertices", polygon.rows.len() as u64),
    ];
    let trace = Trace {
        method: "branch-and-bound".to_owned(),
        stop: found.stop,
        passes: 1,
        iterations: found.cells,
        core_set: certificate.touching.len() as u64,
        history: vec![],
        counters: BTreeMap::from(counters.map(|(name, count)| (name.to_owned(), count))),
    };
    Ok(Solution { answer: InscribedCircle { center, radius }, certificate, trace })
}

/// Radii below this have too few digits left for the gap that is proved.
const RADIUS_MIN: f64 = f64::MIN_POSITIVE / 4.0;

fn check_options(options: &CircleOptions<'_>) -> Result<(), InputError> {
    let wrong = |name, value, expected| Err(InputError::Option { name, value, expected });
    if !(options.epsilon > 0.0 && options.epsilon < 1.0) {
        return wrong("epsilon", shown_number(options.epsilon), "a number above 0 and below 1");
    }
    if options.max_cells == 0 {
        return wrong("max_cells", "0".to_owned(), "at least 1");
    }
    Ok(())
}
