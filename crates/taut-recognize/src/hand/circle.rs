//! The largest inscribed circle of a simple polygon by branch and bound.
//!
//! *Problem.* The point inside a polygon whose distance to the boundary is largest.
//! *Idea.* The signed distance d, positive inside, changes by at most |x − y| between x and y. A square of half
//! diagonal r around c holds no point of distance above d(c) + r, so squares whose bound is not above the best
//! distance found are left out and the others are cut in four.
//! *Guarantee.* The radius is that of a circle in the polygon, up to rounding, and within the tolerance of the largest.
//! *Trap.* Each square needs the nearest edge. An edge farther from c than |d(c)| + 2r is nearest to no point of the
//! square, so that children inherit few edges; if |d(c)| exceeds the distance to a child's center, they inherit the
//! side too, and the whole polygon is read for few squares only.
//! *Reference.* Mapbox, polylabel, 2016; bounds and inheritance as above.

use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::rc::Rc;

/// A circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// Its center.
    pub center: [f64; 2],
    /// Its radius.
    pub radius: f64,
}

/// Squares that are looked at for one polygon, at most; hands need some hundreds.
const SQUARES_MAX: usize = 100_000;

/// One square of the search.
struct Square {
    center: [f64; 2],
    half: f64,
    distance: f64,
    /// The largest distance that a point of the square can have.
    bound: f64,
    /// When it came to the heap: of equals, the first is taken first.
    number: usize,
    /// The edges among which the nearest one is, for each point of the square.
    edges: Rc<[u32]>,
}

impl Ord for Square {
    fn cmp(&self, other: &Self) -> Ordering {
        self.bound.total_cmp(&other.bound).then(other.number.cmp(&self.number))
    }
}

impl PartialOrd for Square {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Square {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Square {}

/// Returns a circle inside a closed polygon whose radius is within `tolerance` of the largest; `None` if no point
/// inside is farther from the boundary than the tolerance, or if the polygon has less than three corners.
#[must_use]
pub fn inscribed_circle(polygon: &[[f64; 2]], tolerance: f64) -> Option<Circle> {
    if polygon.len() < 3 || !polygon.iter().flatten().all(|value| value.is_finite()) {
        return None;
    }
    let range = |axis: usize| {
        let values = polygon.iter().map(move |point| point[axis]);
        (values.clone().fold(f64::INFINITY, f64::min), values.fold(f64::NEG_INFINITY, f64::max))
    };
    let (x, y) = (range(0), range(1));
    let half = 0.5 * (x.1 - x.0).max(y.1 - y.0);
    let center = [0.5 * (x.0 + x.1), 0.5 * (y.0 + y.1)];
    let all: Rc<[u32]> = (0..polygon.len() as u32).collect();
    let mut best = Circle { center, radius: 0.0 };
    let mut heap = BinaryHeap::new();
    let mut number = 0;
    let distance = signed(polygon, center, nearest(polygon, center, &all));
    heap.push(Square { center, half, distance, bound: f64::INFINITY, number, edges: all });
    while let Some(square) = heap.pop() {
        if square.bound <= best.radius + tolerance || number > SQUARES_MAX {
            break;
        }
        if square.distance > best.radius {
            best = Circle { center: square.center, radius: square.distance };
        }
        let reach = square.distance.abs() + 2.0 * square.half * std::f64::consts::SQRT_2;
        let edges: Rc<[u32]> = square
            .edges
            .iter()
            .copied()
            .filter(|&edge| squared_to_edge(polygon, square.center, edge) <= reach * reach)
            .collect();
        let half = 0.5 * square.half;
        for (i, j) in [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)] {
            let center = [square.center[0] + i * half, square.center[1] + j * half];
            let size = nearest(polygon, center, &edges);
            let radius = half * std::f64::consts::SQRT_2;
            let distance = if square.distance.abs() > radius {
                size * square.distance.signum()
            } else if size + radius <= best.radius + tolerance {
                // The square is left out on either side.
                continue;
            } else {
                signed(polygon, center, size)
            };
            let bound = distance + radius;
            if distance > best.radius {
                best = Circle { center, radius: distance };
            }
            if bound > best.radius + tolerance {
                number += 1;
                let edges = Rc::clone(&edges);
                heap.push(Square { center, half, distance, bound, number, edges });
            }
        }
    }
    (best.radius > 0.0).then_some(best)
}

/// Returns the distance of a point to the nearest of some edges.
fn nearest(polygon: &[[f64; 2]], point: [f64; 2], edges: &[u32]) -> f64 {
    edges
        .iter()
        .map(|&edge| squared_to_edge(polygon, point, edge))
        .fold(f64::INFINITY, f64::min)
        .sqrt()
}

/// Returns the squared distance of a point to an edge.
fn squared_to_edge(polygon: &[[f64; 2]], point: [f64; 2], edge: u32) -> f64 {
    let index = edge as usize;
    let a = polygon[index];
    let b = polygon[if index + 1 == polygon.len() { 0 } else { index + 1 }];
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let (px, py) = (point[0] - a[0], point[1] - a[1]);
    let square = dx * dx + dy * dy;
    let share = if square > 0.0 { ((px * dx + py * dy) / square).clamp(0.0, 1.0) } else { 0.0 };
    (px - share * dx).powi(2) + (py - share * dy).powi(2)
}

/// Gives a distance the sign of the side: positive inside, by the parity of crossings.
fn signed(polygon: &[[f64; 2]], point: [f64; 2], distance: f64) -> f64 {
    let mut is_inside = false;
    let mut a = polygon[polygon.len() - 1];
    for &b in polygon {
        if (a[1] > point[1]) != (b[1] > point[1]) {
            let x = a[0] + (point[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
            is_inside ^= point[0] < x;
        }
        a = b;
    }
    if is_inside { distance } else { -distance }
}
