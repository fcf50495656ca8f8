//! The largest triangle in a polygon.
//!
//! *Problem.* Find the triangle of the largest area whose inner points are inside and that no edge enters.
//! *Idea.* Branch and bound over boxes of the three corners ([`search`]). If a point w of an edge is left of two sides for all positions of
//! the corners in their boxes, it must not be left of the third side, pq: (p − w) × (q − w) ≤ 0. A corner is in a half-plane that
//! holds the part of the polygon in its box ([`tile`]). The doubled area and such terms are linear in each coordinate alone, and with
//! weights λ ≥ 0 their sum is largest at corners of the boxes ([`bound`]). The weights solve a linear program with nine rows
//! ([`program`]); its dual is the step of a local ascent ([`ascent`]).
//! *Guarantee.* largest area ≤ (1 + ε)·area, from the leaves of the subdivision, which are the certificate. No triangle is reported
//! that an edge enters.
//! *Trap.* A triangle can lie in a bay, outside, with no vertex in it: no edge tells, only a point of it. An edge can cut off a corner with
//! no vertex in the triangle. Weights by the gradient of the area alone would never split a direction in which it is 0.
//! *Reference.* Van der Hoog, Keikha, Löffler, Mohades and Urhausen, Inf. Process. Lett. 161, 2020, for convex polygons,
//! and for what is wrong with the linear-time algorithm of 1979. The bounds for polygons with holes are new here.

mod ascent;
mod bound;
mod cell;
mod frame;
mod gauge;
mod lines;
mod method;
mod program;
mod reach;
mod report;
mod rows;
mod sampled;
mod search;
mod starts;
mod tile;
mod tree;

use std::collections::BTreeMap;

use taut_certify::{InscribedTriangle, Solution, Trace, TriangleCertificate};
use taut_points::{InputError, Monitor, PointSource, shown_number};

use crate::Error;
use crate::groups::Groups;
use crate::polygon::Polygon;
use crate::units::Units;

use self::frame::Frame;
use self::report::Target;

pub use self::method::{TriangleMethod, TriangleThesisOptions};

/// How to look for the triangle. Write `TriangleOptions { epsilon: 1e-6, ..Default::default() }`.
#[derive(Clone)]
pub struct TriangleOptions<'a> {
    /// How the triangle is found. Default [`TriangleMethod::BranchAndBound`].
    pub method: TriangleMethod,
    /// Proved relative gap of the area to reach, in (0, 1): largest area ≤ (1 + ε)·area. For other methods than the default it is the gap
    /// of the largest triangle that the search of the bound finds. Default 1e-3.
    pub epsilon: f64,
    /// Most cells of the certificate; where ε takes more, a larger gap is proved. At least 1, by default a million.
    pub max_cells: u64,
    /// Watches the work and can stop it. Default [`Monitor::silent`].
    pub monitor: Monitor<'a>,
}

impl Default for TriangleOptions<'_> {
    fn default() -> Self {
        TriangleOptions {
            method: TriangleMethod::default(),
            epsilon: 1e-3,
            max_cells: 1_000_000,
            monitor: Monitor::silent(),
        }
    }
}

/// Finds the triangle of the largest area in a polygon.
///
/// Points (x, y) are the vertices of one ring in order; points (x, y, r) those of several rings, r being the number of the ring:
/// 0, 1, and so on. Inside is what an odd number of rings wind around. The last vertex of a ring may repeat its first. The points
/// are read once and kept in memory.
///
/// # Errors
/// [`Error::NotSimple`] with two edges that meet, [`Error::RingNumber`], [`Error::TooFewVertices`], [`Error::TooThin`],
/// [`Error::Area`] when the area is no normal number, and [`Error::Input`] for bad points or options, and for what reading says.
pub fn inscribed_triangle(
    polygon: &dyn PointSource,
    options: &TriangleOptions<'_>,
) -> Result<Solution<InscribedTriangle>, Error> {
    check_options(options)?;
    let polygon = Polygon::read(polygon, &options.monitor)?;
    let frame = Frame::of(Units::of(&polygon.edges));
    let groups = Groups::of(&frame.edges);
    let target = Target { frame: &frame, groups, edges: &polygon.edges };
    let mut counters = BTreeMap::new();
    let mut count = |name: &str, count: u64| counters.insert(name.to_owned(), count);
    let sampled = match options.method {
        TriangleMethod::BranchAndBound => None,
        TriangleMethod::Thesis(thesis) => {
            let found = sampled::largest(&target, &thesis, &options.monitor)?;
            count("samples", thesis.sample_count);
            count("visible pairs", found.visible_pairs);
            let (method, samples) = (options.method.name(), thesis.sample_count);
            Some(found.reported.ok_or(Error::NoneAmongSamples { method, samples })?)
        }
    };
    let found = search::search(&target, options)?;
    let best = found.best.ok_or(Error::TooThin)?;
    let reached = found.upper / best.doubled - 1.0;
    let reported = sampled.unwrap_or(best);
    if !reported.answer.area.is_normal() {
        return Err(Error::Area);
    }
    let ratio = found.upper / reported.doubled;
    let certificate = TriangleCertificate {
        touching: reported.touching.iter().map(|&edge| polygon.rows[edge as usize]).collect(),
        skew: frame.skew(),
        root: frame.root(),
        leaves: found.log.leaves.iter().map(|leaf| leaf.numbers(&polygon.rows)).collect(),
        tree: found.log.tree,
        gap: (ratio * (1.0 + 16.0 * f64::EPSILON) - 1.0).max(0.0),
        points_hash: polygon.points_hash,
    };
    count("cells", certificate.tree.len() as u64);
    count("ascents", found.ascents);
    count("vertices", polygon.rows.len() as u64);
    let trace = Trace {
        method: options.method.name().to_owned(),
        stop: report::stop(found.is_complete, reached, options.epsilon),
        passes: 1,
        iterations: certificate.tree.len() as u64,
        core_set: certificate.touching.len() as u64,
        history: vec![],
        counters,
    };
    Ok(Solution { answer: reported.answer, certificate, trace })
}

fn check_options(options: &TriangleOptions<'_>) -> Result<(), InputError> {
    let wrong = |name, value, expected| Err(InputError::Option { name, value, expected });
    if !(options.epsilon > 0.0 && options.epsilon < 1.0) {
        return wrong("epsilon", shown_number(options.epsilon), "a number above 0 and below 1");
    }
    if options.max_cells == 0 {
        return wrong("max_cells", "0".to_owned(), "at least 1");
    }
    if let TriangleMethod::Thesis(thesis) = options.method {
        thesis.check()?;
    }
    Ok(())
}
