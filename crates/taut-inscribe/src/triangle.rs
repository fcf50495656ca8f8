//! The largest triangle in a polygon.
//!
//! *Problem.* Find the triangle of the largest area whose inner points are inside and that no edge enters.
//! *Idea.* Branch and bound over boxes of the three corners ([`search`]). If a point w of an edge is left of two sides for all positions of
//! the corners in their boxes, it must not be left of the third side, pq: (p − w) × (q − w) ≤ 0. A corner is in a half-plane that
//! holds the part of the polygon in its box ([`tile`]). The doubled area and such terms are linear in each coordinate alone, and with
//! weights λ ≥ 0 their sum is largest at corners of the boxes ([`bound`]). The weights solve a linear program with nine rows
//! ([`program`](crate::program)); its dual is the step of a local ascent ([`ascent`]).
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
mod groups;
mod lines;
mod options;
mod report;
mod rows;
mod search;
mod starts;
mod thesis;
mod tile;
mod tree;

use std::collections::BTreeMap;

use taut_certify::{InscribedTriangle, Solution, Trace, TriangleCertificate};
use taut_points::PointSource;

pub use self::options::{TriangleMethod, TriangleOptions, TriangleThesisOptions};
use crate::Error;
use crate::levels::Levels;
use crate::polygon::{Polygon, is_measurable};
use crate::units::Units;

use self::frame::Frame;
use self::groups::Groups;
use self::report::Target;

/// Finds the triangle of the largest area in a polygon.
///
/// Points (x, y) are the vertices of one ring in order; points (x, y, r) those of several rings, r being the number of the ring:
/// 0, 1, and so on. Inside is what an odd number of rings wind around. The last vertex of a ring may repeat its first. The points
/// are read once and kept in memory.
///
/// # Errors
/// [`Error::NotSimple`] with two edges that meet, [`Error::RingNumber`], [`Error::TooFewVertices`], [`Error::TooThin`],
/// [`Error::Area`] when the area is no normal number, and [`Error::Input`] for bad points or options, for samples without a triangle,
/// and for what reading says.
pub fn inscribed_triangle(
    polygon: &dyn PointSource,
    options: &TriangleOptions<'_>,
) -> Result<Solution<InscribedTriangle>, Error> {
    options::check(options)?;
    let polygon = Polygon::read(polygon, &options.monitor)?;
    let frame = Frame::of(Units::of(&polygon.edges));
    let groups = Groups::of(&frame.edges);
    let target = Target { frame: &frame, groups, edges: &polygon.edges };
    // Before the search, which takes longer and is of no use without a sample.
    let sampled = match &options.method {
        TriangleMethod::BranchAndBound => None,
        TriangleMethod::Thesis(thesis) => {
            let levels = Levels::of(&frame.edges, frame.extent[1]);
            let sampled = thesis::sampled(&target, &levels, thesis, &options.monitor)?;
            Some(sampled.ok_or(Error::NoneAmongSamples {
                method: options.method.name(),
                samples: thesis.sample_count,
            })?)
        }
    };
    let found = search::search(&target, options)?;
    let best = found.best.ok_or(Error::TooThin)?;
    let best_doubled = best.doubled;
    let reported = sampled.unwrap_or(best);
    let gap_of =
        |doubled: f64| ((found.upper / doubled) * (1.0 + 16.0 * f64::EPSILON) - 1.0).max(0.0);
    if !is_measurable(reported.answer.area, gap_of(reported.doubled)) {
        return Err(Error::Area);
    }
    let certificate = TriangleCertificate {
        touching: reported.touching.iter().map(|&edge| polygon.rows[edge as usize]).collect(),
        skew: frame.skew(),
        root: frame.root(),
        leaves: found.log.leaves.iter().map(|leaf| leaf.numbers(&polygon.rows)).collect(),
        tree: found.log.tree,
        gap: gap_of(reported.doubled),
        points_hash: polygon.points_hash,
    };
    let counters = [
        ("cells", certificate.tree.len() as u64),
        ("ascents", found.ascents),
        ("vertices", polygon.rows.len() as u64),
    ];
    let trace = Trace {
        method: options.method.name().to_owned(),
        stop: report::stop(found.is_complete, gap_of(best_doubled), options.epsilon),
        passes: 1,
        iterations: certificate.tree.len() as u64,
        core_set: certificate.touching.len() as u64,
        history: vec![],
        counters: BTreeMap::from(counters.map(|(name, count)| (name.to_owned(), count))),
    };
    Ok(Solution { answer: reported.answer, certificate, trace })
}
