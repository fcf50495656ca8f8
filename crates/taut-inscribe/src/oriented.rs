//! The largest rectangle of any direction in a polygon.
//!
//! *Problem.* Find the rectangle of the largest area, its sides in any direction, whose inner points are inside and that no edge enters.
//! *Idea.* With u₀ = (1, m) and each next uₖ a quarter turn further, a rectangle is {q : uₖ·q ≤ sₖ}, and its area is
//! (s₀ + s₂)(s₁ + s₃)/(1 + m²). Branch and bound over boxes of (s₀, s₁, s₂, s₃, m) ([`search`]). A point of an edge that is below three
//! sides of all rectangles of a box is not below the fourth, which is linear in m and that offset; a corner is behind the part of the
//! boundary that leads around it ([`rows`]). For a bound U the excess (s₀ + s₂)(s₁ + s₃) − U(1 + m²) plus such terms with
//! weights λ ≥ 0 is largest at ends of the ranges of the offsets. The weights solve a linear program with five rows
//! ([`program`](crate::program)); its dual is the step of a local ascent ([`ascent`]).
//! *Guarantee.* largest area ≤ (1 + ε)·area, from the leaves of the subdivision, which are the certificate. No rectangle is reported that
//! an edge enters.
//! *Trap.* Each axis may not have its own units, as angles would change. The rectangle that touches edges is shrunk by some roundings, as
//! no test for a direction that is rounded is exact.
//! *Reference.* For the problem, Choi, Lee and Ahn, Maximum-area rectangles in a simple polygon, FSTTCS 2019, exact and in
//! O(n³ log n); the bounds here are new.

mod ascent;
mod cell;
mod report;
mod rows;
mod search;
mod tree;

use std::collections::BTreeMap;

use taut_certify::{
    InscribedOrientedRectangle, OrientedRectangleCertificate, Solution, Stop, Trace,
};
use taut_points::{InputError, Monitor, PointSource, shown_number, two_to};

use crate::Error;
use crate::levels::Levels;
use crate::polygon::{Polygon, is_measurable};
use crate::units::Units;

use self::rows::Boundary;
use self::search::Target;

/// A bound of the errors of coordinates in units, less those of the pivot, here and in a checker: 2⁻⁵⁰.
const COORDINATE_ERROR: f64 = two_to(-50);

/// Share of a gap by which rounding may miss it.
const GAP_SLACK: f64 = 1e-9;

/// How to look for the rectangle. Write `OrientedRectangleOptions { epsilon: 1e-2, ..Default::default() }`.
#[derive(Clone)]
pub struct OrientedRectangleOptions<'a> {
    /// Proved relative gap of the area to reach, in (0, 1): largest area ≤ (1 + ε)·area. Default 1e-3.
    pub epsilon: f64,
    /// Most cells of the certificate; where ε takes more, a larger gap is proved. At least 1, by default a million.
    pub max_cells: u64,
    /// Watches the work and can stop it. Default [`Monitor::silent`].
    pub monitor: Monitor<'a>,
}

impl Default for OrientedRectangleOptions<'_> {
    fn default() -> Self {
        OrientedRectangleOptions { epsilon: 1e-3, max_cells: 1_000_000, monitor: Monitor::silent() }
    }
}

/// Finds the largest rectangle of any direction in a polygon.
///
/// Points (x, y) are the vertices of one ring in order; points (x, y, r) those of several rings, r being the number of the ring:
/// 0, 1, and so on. Inside is what an odd number of rings wind around. The last vertex of a ring may repeat its first. The points
/// are read once and kept in memory.
///
/// # Errors
/// [`Error::NotSimple`] with two edges that meet, [`Error::RingNumber`], [`Error::TooFewVertices`], [`Error::TooThin`],
/// [`Error::Area`] when the area is no normal number, and [`Error::Input`] for bad points or options, and for what reading says.
pub fn inscribed_oriented_rectangle(
    polygon: &dyn PointSource,
    options: &OrientedRectangleOptions<'_>,
) -> Result<Solution<InscribedOrientedRectangle>, Error> {
    check_options(options)?;
    let polygon = Polygon::read(polygon, &options.monitor)?;
    if !box_area(&polygon.edges).is_normal() {
        return Err(Error::Area);
    }
    let units = Units::square(&polygon.edges);
    let pivot = units.extent.map(|x| 0.5 * x);
    let about = |edge: &[[f64; 2]; 2]| edge.map(|p| [p[0] - pivot[0], p[1] - pivot[1]]);
    let moved = units.edges.iter().map(about).collect();
    let target = Target {
        units: &units,
        given: &polygon.edges,
        boundary: Boundary::of(moved, &polygon.edges, COORDINATE_ERROR),
        pivot,
        levels: Levels::of(&units.edges, units.extent[1]),
    };
    let found = search::search(&target, options)?;
    let reported = found.best.ok_or(Error::TooThin)?;
    let ratio = found.upper / reported.in_units;
    let gap = (ratio * (1.0 + 16.0 * f64::EPSILON) - 1.0).max(0.0);
    if !is_measurable(reported.answer.area, gap) {
        return Err(Error::Area);
    }
    let log = tree::log(&found.nodes, &polygon.rows);
    let certificate = OrientedRectangleCertificate {
        pivot,
        tree: log.tree,
        leaves: log.leaves,
        gap,
        points_hash: polygon.points_hash,
    };
    let counters = [
        ("cells", certificate.tree.len() as u64),
        ("ascents", found.ascents),
        ("vertices", polygon.rows.len() as u64),
    ];
    let stop = match found.is_complete {
        _ if certificate.gap <= options.epsilon * (1.0 + GAP_SLACK) => Stop::Converged,
        true => Stop::Rounding,
        false => Stop::NodeBudget,
    };
    let trace = Trace {
        method: "branch-and-bound".to_owned(),
        stop,
        passes: 1,
        iterations: certificate.tree.len() as u64,
        core_set: certificate.leaves.len() as u64,
        history: vec![],
        counters: BTreeMap::from(counters.map(|(name, count)| (name.to_owned(), count))),
    };
    Ok(Solution { answer: reported.answer, certificate, trace })
}

/// The area of the bounding box: where that is no normal number, the area of no rectangle inside is one.
fn box_area(edges: &[[[f64; 2]; 2]]) -> f64 {
    let extent = |k: usize| {
        let values = || edges.iter().map(|edge| edge[0][k]);
        values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
    };
    extent(0) * extent(1)
}

fn check_options(options: &OrientedRectangleOptions<'_>) -> Result<(), InputError> {
    let wrong = |name, value, expected| Err(InputError::Option { name, value, expected });
    if !(options.epsilon > 0.0 && options.epsilon < 1.0) {
        return wrong("epsilon", shown_number(options.epsilon), "a number above 0 and below 1");
    }
    if options.max_cells == 0 {
        return wrong("max_cells", "0".to_owned(), "at least 1");
    }
    Ok(())
}
