//! Rectangles from strips: the longest free interval around a point between two levels.

use crate::polygon::Segment;

use super::cell::Rectangle;

/// Steps of a polish that halve the change.
const HALVINGS: usize = 50;

/// The largest rectangle that has the extent of `given` along one axis and contains its center; the edges are all that meet
/// `within`, beyond which it does not reach. By plain arithmetic: ends may be off by rounding.
pub(super) fn widened(
    given: &Rectangle,
    axis: usize,
    within: &Rectangle,
    edges: impl Iterator<Item = Segment>,
) -> Rectangle {
    let other = 1 - axis;
    let [low, high] = [given.low[axis], given.high[axis]];
    let center = given.center()[other];
    let mut found = *given;
    (found.low[other], found.high[other]) = (within.low[other], within.high[other]);
    for [a, b] in edges {
        let (p, q) = if a[axis] <= b[axis] { (a, b) } else { (b, a) };
        if q[axis] <= low || p[axis] >= high {
            continue;
        }
        let at = |level: f64| {
            let share = (level - p[axis]) / (q[axis] - p[axis]);
            p[other] + share * (q[other] - p[other])
        };
        let from = if p[axis] < low { at(low) } else { p[other] };
        let to = if q[axis] > high { at(high) } else { q[other] };
        // A part on both sides of the center leaves nothing.
        if from.max(to) <= center {
            found.low[other] = found.low[other].max(from.max(to));
        } else if from.min(to) >= center {
            found.high[other] = found.high[other].min(from.min(to));
        } else {
            (found.low[other], found.high[other]) = (center, center);
        }
    }
    found
}

/// A local optimum: levels are moved by steps that halve, and the rectangle is widened between them.
pub(super) fn polished(start: &Rectangle, whole: &Rectangle, edges: &[Segment]) -> Rectangle {
    let mut best = *start;
    for axis in 0..2 {
        let mut step = 0.25 * (best.high[axis] - best.low[axis]);
        for _ in 0..HALVINGS {
            let mut improved = false;
            for (low, high) in
                [(-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0), (1.0, 1.0), (-1.0, -1.0)]
            {
                let mut next = best;
                next.low[axis] = (next.low[axis] + low * step).max(whole.low[axis]);
                next.high[axis] = (next.high[axis] + high * step).min(whole.high[axis]);
                if next.low[axis] >= next.high[axis] {
                    continue;
                }
                let next = widened(&next, axis, whole, edges.iter().copied());
                if next.area() > best.area() {
                    (best, improved) = (next, true);
                }
            }
            if !improved {
                step *= 0.5;
            }
        }
    }
    best
}
