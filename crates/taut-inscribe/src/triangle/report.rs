//! The triangle found, as numbers of the input that no edge enters.

use taut_certify::{InscribedTriangle, Stop};
use taut_predicates::plane::orient;

use super::frame::Frame;
use super::gauge::{Gauge, Triangle, scaled};
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
    /// Twice the area in the frame.
    pub(super) doubled: f64,
    /// Edges that the triangle touches up to rounding, ascending.
    pub(super) touching: Vec<u32>,
}

/// Rounds a triangle and shrinks it as little as keeps edges out; `None` where nothing is left.
pub(super) fn rounded(best: &Triangle, target: &Target<'_>) -> Option<Reported> {
    let frame = target.frame;
    let gauge = Gauge::of(best);
    let tested = 1.0 + TESTED + 64.0 * frame.error * gauge.slope();
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
    let mut shrunk = SHRINK_BITS.rev().map(|bits| {
        scaled(best, 1.0 - f64::from_bits(((1023 - bits) as u64) << 52))
            .map(|p| frame.given_point(p))
    });
    let plain = best.map(|p| frame.given_point(p));
    let corners = [snapped, plain]
        .into_iter()
        .find(|corners| is_in(corners))
        .or_else(|| shrunk.find(is_in))?;
    let doubled = frame.doubled_area(&corners);
    let area = frame.given_area(&corners);
    let has_area = doubled > 0.0;
    has_area.then(|| Reported {
        answer: InscribedTriangle { corners, area },
        doubled: doubled * (1.0 - 4.0 * f64::EPSILON),
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
    let least = target.groups.least_scale(&gauge, f64::INFINITY).max(1.0);
    let most = least * (1.0 + TOUCHING_SLACK) + 16.0 * f64::EPSILON * gauge.slope();
    target.groups.reached(&gauge, most)
}

/// Why the search ended.
pub(super) fn stop(is_complete: bool, gap: f64, epsilon: f64) -> Stop {
    match is_complete {
        _ if gap <= epsilon * (1.0 + GAP_SLACK) => Stop::Converged,
        true => Stop::Rounding,
        false => Stop::NodeBudget,
    }
}
