//! The largest rectangle along the axes in a polygon.
//!
//! *Problem.* Find the rectangle [x₀, x₁] × [y₀, y₁] of the largest area in the inside of a polygon with holes.
//! *Idea.* Branch and bound over boxes of (x₀, y₀, x₁, y₁). All rectangles of a box contain its core, the intersection of them, and lie in
//! its hull, the union ([`cell`]). A box is done when the hull is too small, an edge enters the core, or a corner of all
//! rectangles is outside ([`search`]). Incumbents come from strips: for given y₀ and y₁ the longest free interval ([`strip`]).
//! *Guarantee.* largest area ≤ (1 + ε)·area, from the leaves of the subdivision, which are the certificate. All tests are exact signs
//! of the numbers given; only areas are rounded.
//! *Cost.* A box costs the edges that meet its hull. Where corners touch slanted edges about ε^(−1/2) boxes for each direction in
//! which the area is stationary.
//! *Reference.* For the problem, Daniels, Milenkovic and Roth, Finding the largest area axis-parallel rectangle in a polygon, Comput. Geom.
//! 7, 1997; the subdivision is new here.

mod cell;
mod search;
mod strip;
mod tree;

use std::collections::BTreeMap;

use taut_certify::{InscribedRectangle, RectangleCertificate, Solution, Stop, Trace};
use taut_points::{InputError, Monitor, PointSource, shown_number};

use crate::Error;
use crate::polygon::{Polygon, is_measurable};

use self::cell::Rectangle;

/// How to look for the rectangle. Write `RectangleOptions { epsilon: 1e-2, ..Default::default() }`.
#[derive(Clone)]
pub struct RectangleOptions<'a> {
    /// Proved relative gap of the area to reach, in (0, 1): largest area ≤ (1 + ε)·area. Default 1e-3.
    pub epsilon: f64,
    /// Most cells of the certificate; where ε takes more, a larger gap is proved. At least 1, by default a million.
    pub max_cells: u64,
    /// Watches the work and can stop it. Default [`Monitor::silent`].
    pub monitor: Monitor<'a>,
}

impl Default for RectangleOptions<'_> {
    fn default() -> Self {
        RectangleOptions { epsilon: 1e-3, max_cells: 1_000_000, monitor: Monitor::silent() }
    }
}

/// Finds the largest rectangle with sides along the axes in a polygon.
///
/// Points (x, y) are the vertices of one ring in order; points (x, y, r) those of several rings, r being the number of the ring:
/// 0, 1, and so on. Inside is what an odd number of rings wind around. The last vertex of a ring may repeat its first. The points
/// are read once and kept in memory.
///
/// # Errors
/// [`Error::NotSimple`] with two edges that meet, [`Error::RingNumber`], [`Error::TooFewVertices`], [`Error::TooThin`],
/// [`Error::Area`] when the area is no normal number, and [`Error::Input`] for bad points or options, and for what reading says.
pub fn inscribed_rectangle(
    polygon: &dyn PointSource,
    options: &RectangleOptions<'_>,
) -> Result<Solution<InscribedRectangle>, Error> {
    check_options(options)?;
    let polygon = Polygon::read(polygon, &options.monitor)?;
    if !Rectangle::around(&polygon.edges).area().is_normal() {
        return Err(Error::Area);
    }
    let found = search::search(&polygon.edges, options)?;
    let best = found.best.ok_or(Error::TooThin)?;
    let area = best.area();
    // Three roundings of each area, and one of the quotient.
    let gap = ((found.upper / area) * (1.0 + 8.0 * f64::EPSILON) - 1.0).max(0.0);
    if !is_measurable(area, gap) {
        return Err(Error::Area);
    }
    let row = |edge: u32| polygon.rows[edge as usize];
    let certificate = RectangleCertificate {
        tree: found.log.tree,
        edges: found.log.edges.into_iter().map(row).collect(),
        gap,
        points_hash: polygon.points_hash,
    };
    let counters = [
        ("cells", certificate.tree.len() as u64),
        ("strips", found.strips),
        ("vertices", polygon.rows.len() as u64),
    ];
    let stop = match found.is_complete {
        _ if certificate.gap <= options.epsilon * (1.0 + 1e-9) => Stop::Converged,
        true => Stop::Rounding,
        false => Stop::NodeBudget,
    };
    let trace = Trace {
        method: "branch-and-bound".to_owned(),
        stop,
        passes: 1,
        iterations: certificate.tree.len() as u64,
        core_set: certificate.edges.len() as u64,
        history: vec![],
        counters: BTreeMap::from(counters.map(|(name, count)| (name.to_owned(), count))),
    };
    let answer = InscribedRectangle { low: best.low, high: best.high, area };
    Ok(Solution { answer, certificate, trace })
}

fn check_options(options: &RectangleOptions<'_>) -> Result<(), InputError> {
    let wrong = |name, value, expected| Err(InputError::Option { name, value, expected });
    if !(options.epsilon > 0.0 && options.epsilon < 1.0) {
        return wrong("epsilon", shown_number(options.epsilon), "a number above 0 and below 1");
    }
    if options.max_cells == 0 {
        return wrong("max_cells", "0".to_owned(), "at least 1");
    }
    Ok(())
}
