//! The largest inscribed circle of a simple polygon by branch and bound.
//!
//! *Problem.* The point inside a polygon whose distance to the boundary is largest.
//! *Idea.* The signed distance d, positive inside, changes by at most |x − y| between x and y. A square of half
//! diagonal r around c holds no point of distance above d(c) + r, so squares whose bound is not above the best
//! distance found are left out and the others are cut in four.
//! *Guarantee.* The radius is that of a circle in the polygon, up to rounding, and within the tolerance of the largest.
//! *Trap.* Each square needs the nearest edge. An edge farther from c than |d(c)| + 2r is nearest to no point of the
//! square, so that children inherit few edges; if |d(c)| exceeds the distance to a child's center, they inherit the
//! side too, and the whole polygon is read for few squares only. Edges are read in groups of neighbors, each in a disc.
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
    /// The groups of edges among which the nearest one is, for each point of the square.
    groups: Rc<[u32]>,
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
    let edges = Edges::new(polygon);
    let groups: Rc<[u32]> = (0..edges.groups.len() as u32).collect();
    let mut best = Circle { center, radius: 0.0 };
    let mut heap = BinaryHeap::new();
    let mut number = 0;
    let distance = edges.signed(center, edges.nearest(center, &groups));
    heap.push(Square { center, half, distance, bound: f64::INFINITY, number, groups });
    while let Some(square) = heap.pop() {
        if square.bound <= best.radius + tolerance || number > SQUARES_MAX {
            break;
        }
        if square.distance > best.radius {
            best = Circle { center: square.center, radius: square.distance };
        }
        let reach = square.distance.abs() + 2.0 * square.half * std::f64::consts::SQRT_2;
        let groups: Rc<[u32]> = edges.within(square.center, reach, &square.groups);
        let half = 0.5 * square.half;
        for (i, j) in [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)] {
            let center = [square.center[0] + i * half, square.center[1] + j * half];
            let size = edges.nearest(center, &groups);
            let radius = half * std::f64::consts::SQRT_2;
            let distance = if square.distance.abs() > radius {
                size * square.distance.signum()
            } else if size + radius <= best.radius + tolerance {
                // The square is left out on either side.
                continue;
            } else {
                edges.signed(center, size)
            };
            let bound = distance + radius;
            if distance > best.radius {
                best = Circle { center, radius: distance };
            }
            if bound > best.radius + tolerance {
                number += 1;
                let groups = Rc::clone(&groups);
                heap.push(Square { center, half, distance, bound, number, groups });
            }
        }
    }
    (best.radius > 0.0).then_some(best)
}

/// Edges whose distances are calculated together.
const LANES: usize = 4;

/// As many edges of a polygon, number by number, so that one instruction works on several of them.
struct Edges4 {
    start: [[f64; LANES]; 2],
    delta: [[f64; LANES]; 2],
    /// One over the squared length; 0 for an edge without a length.
    inverse: [f64; LANES],
}

impl Edges4 {
    /// The edges from some corners to others.
    fn new(ends: [[[f64; 2]; 2]; LANES]) -> Self {
        let start = [0, 1].map(|axis| ends.map(|[a, _]| a[axis]));
        let delta = [0, 1].map(|axis| ends.map(|[a, b]| b[axis] - a[axis]));
        let inverse = std::array::from_fn(|k| {
            let square = delta[0][k] * delta[0][k] + delta[1][k] * delta[1][k];
            // A square that is too small for its inverse is no length.
            Some(1.0 / square).filter(|inverse| inverse.is_finite()).unwrap_or(0.0)
        });
        Self { start, delta, inverse }
    }

    /// Lowers numbers to the squared distances of a point.
    fn lower(&self, point: [f64; 2], least: &mut [f64; LANES]) {
        let ([ax, ay], [dx, dy]) = (&self.start, &self.delta);
        for k in 0..LANES {
            let (px, py) = (point[0] - ax[k], point[1] - ay[k]);
            let share = (px * dx[k] + py * dy[k]) * self.inverse[k];
            // No number here is NaN, and comparisons take fewer instructions than `clamp` and `min`.
            let share = if share < 0.0 { 0.0 } else { share };
            let share = if share > 1.0 { 1.0 } else { share };
            let (x, y) = (px - share * dx[k], py - share * dy[k]);
            let square = x * x + y * y;
            least[k] = if square < least[k] { square } else { least[k] };
        }
    }
}

/// Neighboring edges and a disc that holds them.
struct Group {
    first: usize,
    end: usize,
    center: [f64; 2],
    radius: f64,
    /// The least and largest second coordinate.
    rows: [f64; 2],
}

/// The edges of a polygon in groups.
struct Edges<'a> {
    corners: &'a [[f64; 2]],
    /// The edges, [`GROUP_EDGES`] for each group; the last one is repeated.
    edges: Vec<Edges4>,
    groups: Vec<Group>,
}

/// Edges in a group: with as many groups as edges in one, a polygon of 300 edges has the least work.
const GROUP_EDGES: usize = 16;

impl<'a> Edges<'a> {
    fn new(polygon: &'a [[f64; 2]]) -> Self {
        let corner = |index: usize| polygon[if index < polygon.len() { index } else { 0 }];
        let edge = |index: usize| [corner(index), corner(index + 1)];
        let edges = (0..polygon.len().next_multiple_of(GROUP_EDGES))
            .step_by(LANES)
            .map(|first| {
                Edges4::new(std::array::from_fn(|k| edge((first + k).min(polygon.len() - 1))))
            })
            .collect();
        let groups = (0..polygon.len())
            .step_by(GROUP_EDGES)
            .map(|first| {
                let end = (first + GROUP_EDGES).min(polygon.len());
                let corners = (first..=end).map(corner);
                let range = |axis: usize| {
                    corners.clone().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], p| {
                        [low.min(p[axis]), high.max(p[axis])]
                    })
                };
                let rows = range(1);
                let center = [range(0), rows].map(|[low, high]| 0.5 * (low + high));
                let square = |p: [f64; 2]| (p[0] - center[0]).powi(2) + (p[1] - center[1]).powi(2);
                let radius = corners.clone().map(square).fold(0.0, f64::max).sqrt();
                Group { first, end, center, radius, rows }
            })
            .collect();
        Self { corners: polygon, edges, groups }
    }

    /// Returns the squared distance of a point to the center of a group.
    fn to_center(&self, point: [f64; 2], group: u32) -> f64 {
        let [x, y] = self.groups[group as usize].center;
        (point[0] - x) * (point[0] - x) + (point[1] - y) * (point[1] - y)
    }

    /// Tests whether the disc of a group comes within a distance of a point, or nearly so: rounding loses none.
    fn is_within(&self, point: [f64; 2], reach: f64, group: u32) -> bool {
        /// Far above the rounding of a squared distance.
        const ROUNDING: f64 = 1.0 + 1e-9;
        let limit = reach + self.groups[group as usize].radius;
        self.to_center(point, group) <= limit * limit * ROUNDING
    }

    /// Returns the groups of which an edge may be within a distance of a point.
    fn within(&self, point: [f64; 2], reach: f64, groups: &[u32]) -> Rc<[u32]> {
        groups.iter().copied().filter(|&group| self.is_within(point, reach, group)).collect()
    }

    /// Returns the distance of a point to the nearest edge of some groups.
    fn nearest(&self, point: [f64; 2], groups: &[u32]) -> f64 {
        let in_group = |group: u32| {
            const FOURS: usize = GROUP_EDGES / LANES;
            let mut least = [f64::INFINITY; LANES];
            let first = group as usize * FOURS;
            self.edges[first..first + FOURS].iter().for_each(|four| four.lower(point, &mut least));
            least.into_iter().fold(f64::INFINITY, f64::min)
        };
        let (mut first, mut least) = (u32::MAX, f64::INFINITY);
        for &group in groups {
            let square = self.to_center(point, group);
            if square < least {
                (first, least) = (group, square);
            }
        }
        let mut square = if first == u32::MAX { f64::INFINITY } else { in_group(first) };
        let mut distance = square.sqrt();
        for &group in groups {
            if group != first && self.is_within(point, distance, group) {
                let found = in_group(group);
                if found < square {
                    (square, distance) = (found, found.sqrt());
                }
            }
        }
        distance
    }

    /// Gives a distance the sign of the side: positive inside, by the parity of crossings.
    fn signed(&self, point: [f64; 2], distance: f64) -> f64 {
        let mut is_inside = false;
        for group in &self.groups {
            if !(group.rows[0]..=group.rows[1]).contains(&point[1]) {
                continue;
            }
            for index in group.first..group.end {
                let next = if index + 1 == self.corners.len() { 0 } else { index + 1 };
                let (a, b) = (self.corners[index], self.corners[next]);
                if (a[1] > point[1]) != (b[1] > point[1]) {
                    let x = a[0] + (point[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
                    is_inside ^= point[0] < x;
                }
            }
        }
        if is_inside { distance } else { -distance }
    }
}
