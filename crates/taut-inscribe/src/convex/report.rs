//! The body found, as corners of the input that no edge enters.

use taut_points::OrderBy;
use taut_predicates::plane::orient;

use super::region::{Region, cross, minus};
use crate::polygon::{Segment, is_inside};
use crate::units::Units;

/// First share by which a body is shrunk towards its centroid where rounding lets edges into it, and the factor of the next ones.
const SHRINKING: (f64, f64) = (1e-15, 4.0);

/// Largest share.
const SHRINKING_MAX: f64 = 1e-3;

/// Corners and a point inside.
pub(super) struct Reported {
    /// Counterclockwise, no three of them on a line.
    pub(super) corners: Vec<[f64; 2]>,
    pub(super) inside: [f64; 2],
}

/// Rounds a body in units and shrinks it until no edge enters it, by exact signs; `None` where nothing is left.
pub(super) fn rounded(body: &Region, units: &Units, edges: &[Segment]) -> Option<Reported> {
    let centroid = body.moments()?.centroid;
    let inside = units.given_point(centroid);
    let mut share = 0.0;
    while share <= SHRINKING_MAX {
        let shrunk = |p: [f64; 2]| [0, 1].map(|k| p[k] + share * (centroid[k] - p[k]));
        let given = body.corners.iter().map(|&p| units.given_point(shrunk(p)));
        let corners = hull(given.collect());
        let holds = corners.len() >= 3
            && is_inside(edges.iter().copied(), inside)
            && sides(&corners).all(|[a, b]| turns_left(a, b, inside));
        if holds && !edges.iter().any(|&edge| enters(edge, &corners)) {
            return Some(Reported { corners, inside });
        }
        share = if share == 0.0 { SHRINKING.0 } else { SHRINKING.1 * share };
    }
    None
}

/// The area, up to rounding.
pub(super) fn area(corners: &[[f64; 2]]) -> f64 {
    let first = corners[0];
    let pieces = corners.windows(2);
    pieces.map(|pair| 0.5 * cross(minus(pair[0], first), minus(pair[1], first))).sum()
}

/// A bound of the error of [`area`]: each product of differences is off by less than 4 roundings, and each sum by one of the terms so far.
pub(super) fn area_error(corners: &[[f64; 2]]) -> f64 {
    let first = corners[0];
    let size = |pair: &[[f64; 2]]| {
        let ([a, b], [c, d]) = (minus(pair[0], first), minus(pair[1], first));
        0.5 * ((a * d).abs() + (b * c).abs())
    };
    let terms: f64 = corners.windows(2).map(size).sum();
    (4.0 + corners.len() as f64) * f64::EPSILON * terms
}

/// The strictly convex hull of points, counterclockwise, by exact signs.
pub(super) fn hull(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.order_by(&|p, q| p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1])));
    points.dedup();
    let chain = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut kept: Vec<[f64; 2]> = vec![];
        for p in points {
            while let [.., o, q] = kept[..] {
                if turns_left(o, q, p) {
                    break;
                }
                kept.pop();
            }
            kept.push(p);
        }
        kept.pop();
        kept
    };
    let mut hull = chain(&mut points.iter().copied());
    hull.extend(chain(&mut points.iter().rev().copied()));
    hull
}

fn sides(corners: &[[f64; 2]]) -> impl Iterator<Item = Segment> {
    let next = |i: usize| corners[if i + 1 == corners.len() { 0 } else { i + 1 }];
    corners.iter().enumerate().map(move |(i, &corner)| [corner, next(i)])
}

fn turns_left(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> bool {
    orient(a, b, c).is_positive()
}

/// Whether an edge enters the open convex polygon: no side has it behind, and it has corners on both sides.
fn enters(edge: Segment, corners: &[[f64; 2]]) -> bool {
    let [low, high] = [f64::min, f64::max]
        .map(|most| [0, 1].map(|k| corners.iter().map(|p| p[k]).reduce(most).unwrap_or_default()));
    let is_apart =
        |k: usize| edge[0][k].max(edge[1][k]) <= low[k] || edge[0][k].min(edge[1][k]) >= high[k];
    if is_apart(0) || is_apart(1) {
        return false;
    }
    let is_behind = |[a, b]: Segment| edge.iter().all(|&end| !turns_left(a, b, end));
    let [a, b] = edge;
    let has_left = corners.iter().any(|&corner| turns_left(a, b, corner));
    let has_right = corners.iter().any(|&corner| turns_left(b, a, corner));
    has_left && has_right && !sides(corners).any(is_behind)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];

    #[test]
    fn edges_may_touch_but_not_enter() {
        for (edge, expected) in [
            ([[0.5, 0.5], [0.6, 0.7]], true),
            ([[-1.0, 1.0], [3.0, 1.5]], true),
            ([[-1.0, -1.0], [3.0, 3.0]], true),
            ([[0.0, 0.0], [2.0, 0.0]], false),
            ([[2.0, -1.0], [2.0, 3.0]], false),
            ([[-1.0, 1.0], [1.0, -1.0]], false),
            ([[1.0, 2.0], [1.0, 3.0]], false),
            ([[3.0, 1.0], [2.5, 0.0]], false),
            ([[-1.0, 2.5], [2.5, -1.0]], true),
        ] {
            assert_eq!(enters(edge, &SQUARE), expected, "{edge:?}");
            assert_eq!(enters([edge[1], edge[0]], &SQUARE), expected, "{edge:?}");
        }
    }

    #[test]
    fn a_hull_has_no_three_corners_on_a_line() {
        let mut points = SQUARE.to_vec();
        points.extend([[1.0, 0.0], [1.0, 1.0], [0.0, 0.0], [2.0, 1.0]]);
        assert_eq!(hull(points), SQUARE);
        assert_eq!(area(&SQUARE), 4.0);
    }
}
