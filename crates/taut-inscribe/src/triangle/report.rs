//! The triangle found, as numbers of the input that no edge enters.

use taut_certify::{InscribedTriangle, Stop};
use taut_points::two_to;
use taut_predicates::plane::orient;

use super::frame::Frame;
use super::gauge::{self, Gauge, Triangle, scaled};
use super::groups::Groups;
use crate::levels::is_left;
use crate::polygon::Segment;

/// How near to the least scale at which the triangle reaches an edge that of a touching edge is, relatively.
const TOUCHING_SLACK: f64 = 1e-10;

/// How near to a vertex a corner is moved there, in the frame, if no edge then enters.
const SNAP: f64 = 1e-10;

/// Shares by which a triangle is shrunk until no edge enters, as powers of two: from the first to the last.
const SHRINK_BITS: std::ops::RangeInclusive<i32> = 12..=50;

/// The scale up to which edges are tested exactly, less 1, besides errors of coordinates.
const TESTED: f64 = 1e-6;

/// The error of scales above which those in the frame do not tell which edges are near.
const ERROR_MAX: f64 = 0.5;

/// Share of a gap by which rounding may miss it.
const GAP_SLACK: f64 = 1e-9;

/// The polygon, in the coordinates of the search and as given.
pub(super) struct Target<'a> {
    pub(super) frame: &'a Frame,
    /// The edges of the frame.
    pub(super) groups: Groups,
    /// The edges as given.
    pub(super) edges: &'a [Segment],
}

/// An answer.
#[derive(Clone, Debug)]
pub(super) struct Reported {
    pub(super) answer: InscribedTriangle,
    /// A lower bound of twice the area in the frame.
    pub(super) doubled: f64,
    /// Edges that the triangle touches up to rounding, ascending.
    pub(super) touching: Vec<u32>,
}

/// Rounds a triangle and shrinks it as little as keeps edges out; `None` where nothing is left.
pub(super) fn rounded(best: &Triangle, target: &Target<'_>) -> Option<Reported> {
    let frame = target.frame;
    let gauge = Gauge::of(best);
    // Corners are moved by rounding and to vertices. Far from the origin, and where numbers are subnormal, that can be far.
    let tested = 1.0 + TESTED + (64.0 * frame.rounding() + 2.0 * SNAP) * gauge.slope();
    let near = target.groups.reached(&gauge, tested);
    let is_in = |corners: &Triangle| {
        let given: Vec<Segment> = near.iter().map(|&edge| target.edges[edge as usize]).collect();
        is_in_polygon(corners, &given, target.edges)
    };
    let snapped = best.map(|p| {
        let is_there = |&&edge: &&u32| {
            let q = frame.edges[edge as usize][0];
            (p[0] - q[0]).abs() <= SNAP && (p[1] - q[1]).abs() <= SNAP
        };
        near.iter()
            .find(is_there)
            .map_or_else(|| frame.given_point(p), |&edge| target.edges[edge as usize][0])
    });
    let mut shrunk = SHRINK_BITS
        .rev()
        .map(|bits| scaled(best, 1.0 - two_to(-bits)).map(|p| frame.given_point(p)));
    let plain = best.map(|p| frame.given_point(p));
    let corners = [snapped, plain]
        .into_iter()
        .find(|corners| is_in(corners))
        .or_else(|| shrunk.find(is_in))?;
    let doubled = frame.doubled_below(&corners);
    let area = frame.given_area(&corners);
    let has_area = doubled > 0.0;
    has_area.then(|| Reported {
        answer: InscribedTriangle { corners, area },
        doubled,
        touching: touching(&corners, target),
    })
}

/// Whether a triangle turns left, none of the edges near it enters it, and its centroid is inside, by exact signs.
fn is_in_polygon(corners: &Triangle, near: &[Segment], all: &[Segment]) -> bool {
    let [p, q, r] = *corners;
    // Rounded as by the checker, which has to find the same point inside.
    let center = [0, 1].map(|k| p[k] / 3.0 + q[k] / 3.0 + r[k] / 3.0);
    let sides = [[p, q], [q, r], [r, p]];
    let holds = |w: [f64; 2]| sides.iter().all(|&[p, q]| orient(p, q, w).is_positive());
    let is_clear = |&[a, b]: &Segment| {
        let right =
            |&[p, q]: &Segment| !orient(p, q, a).is_positive() && !orient(p, q, b).is_positive();
        let signs = corners.map(|corner| orient(a, b, corner));
        sides.iter().any(right)
            || signs.iter().all(|sign| !sign.is_positive())
            || signs.iter().all(|sign| !sign.is_negative())
    };
    let is_finite = corners.as_flattened().iter().all(|x| x.is_finite());
    is_finite
        && orient(p, q, r).is_positive()
        && holds(center)
        && near.iter().all(is_clear)
        && all.iter().filter(|&&edge| is_left(edge, center)).count() % 2 == 1
}

/// The edges that a triangle touches, or comes nearest to.
fn touching(corners: &Triangle, target: &Target<'_>) -> Vec<u32> {
    let gauge = Gauge::of(&corners.map(|p| target.frame.point(p)));
    let error = 64.0 * target.frame.error * gauge.slope();
    // In a needle the coordinates of the frame do not tell which edges are touched.
    let near = match error < ERROR_MAX {
        true => {
            let least = target.groups.least_scale(&gauge, f64::INFINITY).max(1.0);
            target.groups.reached(&gauge, least * (1.0 + TESTED) + error)
        }
        false => (0..target.edges.len() as u32).collect(),
    };
    let scales = near.into_iter().map(|edge| (edge, scale_to_reach(corners, edge, target)));
    let scales: Vec<(u32, f64)> = scales.collect();
    let least = scales.iter().fold(f64::INFINITY, |least, &(_, scale)| scale.min(least)).max(1.0);
    let is_touched = |&(_, scale): &(u32, f64)| scale <= least * (1.0 + TOUCHING_SLACK);
    scales.into_iter().filter(is_touched).map(|(edge, _)| edge).collect()
}

/// The scale at which a triangle of the input reaches an edge from its centroid, accurate.
fn scale_to_reach(&[p, q, r]: &Triangle, edge: u32, target: &Target<'_>) -> f64 {
    let (frame, ends) = (target.frame, target.edges[edge as usize]);
    let whole = frame.turn(q, r, p);
    let sides = [[p, q], [q, r], [r, p]];
    let [from, to] = ends.map(|end| sides.map(|[p, q]| 1.0 - 3.0 * frame.turn(p, q, end) / whole));
    gauge::least_between(from, to)
}

/// Why the search ended.
pub(super) fn stop(is_complete: bool, gap: f64, epsilon: f64) -> Stop {
    match is_complete {
        _ if gap <= epsilon * (1.0 + GAP_SLACK) => Stop::Converged,
        true => Stop::Rounding,
        false => Stop::NodeBudget,
    }
}
