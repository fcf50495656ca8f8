//! The strip of least width around points.
//!
//! *Problem.* Two parallel lines as near to each other as possible with all points between them.
//! *Idea.* One of the lines holds an edge of the convex hull: for each edge in turn, the farthest vertex moves on around the hull
//! (rotating calipers).
//! *Guarantee.* To rounding of doubles; O(m log m). A hull may be extended by further points: what was inside stays out of it.
//! *Trap.* On edges that are parallel to rounding the farthest vertex may be either of two; it never turns more than twice around.
//! *Reference.* Andrew 1979 for the hull; Houle and Toussaint 1988 for the width.

use taut_points::OrderBy;

/// The strip.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Strip {
    /// The distance of its lines.
    pub(super) width: f64,
    /// The unit vector along them.
    pub(super) along: [f64; 2],
}

fn cross(o: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0])
}

/// Leaves of the points the vertices of their convex hull, counter-clockwise from the leftmost.
pub(super) fn reduce_to_hull(points: &mut Vec<[f64; 2]>) {
    points.order_by(&|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    points.dedup();
    if points.len() < 3 {
        return;
    }
    let mut hull: Vec<[f64; 2]> = Vec::with_capacity(32);
    let mut chain = |order: &mut dyn Iterator<Item = [f64; 2]>| {
        let start = hull.len();
        for p in order {
            while hull.len() >= start + 2
                && cross(hull[hull.len() - 2], hull[hull.len() - 1], p) <= 0.0
            {
                hull.pop();
            }
            hull.push(p);
        }
        hull.pop();
    };
    chain(&mut points.iter().copied());
    chain(&mut points.iter().rev().copied());
    *points = hull;
}

/// The strip of least width around a convex polygon. Of two points or one it has no width.
pub(super) fn least_strip(hull: &[[f64; 2]]) -> Strip {
    let m = hull.len();
    let mut least = Strip { width: f64::INFINITY, along: [1.0, 0.0] };
    let mut far = 1;
    for i in 0..m {
        let (a, b) = (hull[i], hull[(i + 1) % m]);
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        if length == 0.0 {
            continue;
        }
        let mut height = cross(a, b, hull[far % m]);
        while far < i + m {
            let next = cross(a, b, hull[(far + 1) % m]);
            if next < height {
                break;
            }
            (far, height) = (far + 1, next);
        }
        let width = (height / length).max(0.0);
        if width < least.width {
            least = Strip { width, along: [(b[0] - a[0]) / length, (b[1] - a[1]) / length] };
        }
    }
    if least.width.is_finite() { least } else { Strip { width: 0.0, ..least } }
}
