//! Half-planes that keep all edges out, the nearest edge first.
//!
//! *Idea.* In the order of their distance from a center, in a given metric, each edge that still enters the region is cut off by
//! the line through its nearest point that is tangent to the ball of the metric there. The edge lies behind that line as a whole.
//! *Reference.* Deits and Tedrake, Computing large convex regions of obstacle-free space through semidefinite programming (IRIS),
//! Algorithmic Foundations of Robotics XI, 2015, section 3.2: the half-planes of one step.

use taut_points::OrderBy;

use super::region::{Region, Side, dot, minus};
use crate::polygon::Segment;

/// A norm |w|² = m₀w₁² + 2m₁w₁w₂ + m₂w₂².
#[derive(Clone, Copy, Debug)]
pub(super) struct Metric(pub(super) [f64; 3]);

impl Metric {
    /// The metric whose unit ball is like a body of these second moments; the plain one where they are degenerate.
    pub(super) fn of_moments([xx, xy, yy]: [f64; 3]) -> Self {
        let determinant = xx * yy - xy * xy;
        match determinant > 0.0 {
            true => Metric([yy / determinant, -xy / determinant, xx / determinant]),
            false => Metric([1.0, 0.0, 1.0]),
        }
    }

    /// The gradient of |w|²/2.
    fn applied(&self, w: [f64; 2]) -> [f64; 2] {
        let [m, n, o] = self.0;
        [m * w[0] + n * w[1], n * w[0] + o * w[1]]
    }

    /// The vector from a point to the nearest one of an edge, and the square of its norm.
    fn nearest(&self, center: [f64; 2], [a, b]: Segment) -> ([f64; 2], f64) {
        let (d, e) = (minus(a, center), minus(b, a));
        let along = self.applied(e);
        let share = -dot(d, along) / dot(e, along);
        let share = if share >= 0.0 { share.min(1.0) } else { 0.0 };
        let way = [d[0] + share * e[0], d[1] + share * e[1]];
        (way, dot(way, self.applied(way)))
    }
}

/// The sides that cut off all edges of a list from a region, and what remains of it.
///
/// Edges that reach in by less than `depth` count as outside. `None` where the center is on an edge, nothing remains, or rounding fails.
pub(super) fn carve(
    region: &Region,
    mut sides: Vec<Side>,
    center: [f64; 2],
    metric: Metric,
    edges: impl Iterator<Item = Segment>,
    depth: f64,
) -> Option<(Region, Vec<Side>)> {
    let enters = |sides: &[Side], edge: Segment| {
        Region::inner_part(sides.iter().copied(), edge, depth).is_some()
    };
    let mut near: Vec<(f64, [f64; 2], Segment)> = edges
        .filter(|&edge| enters(&sides, edge))
        .map(|edge| {
            let (way, square) = metric.nearest(center, edge);
            (square, way, edge)
        })
        .collect();
    near.order_by(&|one, other| one.0.total_cmp(&other.0));
    let mut region = region.clone();
    for (_, way, edge) in near {
        if !enters(&sides, edge) {
            continue;
        }
        let point = [center[0] + way[0], center[1] + way[1]];
        let side = Side::through(point, metric.applied(way))?;
        region = region.clipped(&side);
        sides.push(side);
        // A metric that is too long rounds the line away from the edge, or over the center.
        if region.corners.is_empty() || side.excess(center) >= 0.0 || enters(&sides, edge) {
            return None;
        }
    }
    Some((region, sides))
}
