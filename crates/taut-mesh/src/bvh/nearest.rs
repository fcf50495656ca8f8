//! The triangle next to a point.
//!
//! *Problem.* Given p, find the triangle of least distance and that distance.
//! *Idea.* Go down the tree into the nearer box first, and turn back where a box is farther than the best triangle so far. The
//! nearest point of a triangle is the projection of p if that lies within, else it is on a side; the projection is a mean of the corners
//! with the areas of the opposite parts as weights.
//! *Guarantee.* Exact up to rounding, for triangles without area too: what is called nearest is always a mean of corners, so
//! the distance is never that of a point beyond the triangle. Of triangles at one distance the one of the lowest number is
//! found.
//! *Trap.* The distance from the plane of a needle is noise, and can be far too small: it is never used.

use super::{Bounds, Bvh, Stack};

/// A triangle, and how far away it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Nearest {
    pub(crate) square: f64,
    pub(crate) number: u32,
}

impl Bounds {
    /// The square of the distance of a point from the box.
    fn square_distance(&self, p: &[f64; 3]) -> f64 {
        let beyond = |k: usize| (self.low[k] - p[k]).max(p[k] - self.high[k]).max(0.0);
        beyond(0) * beyond(0) + beyond(1) * beyond(1) + beyond(2) * beyond(2)
    }
}

impl Bvh {
    /// The triangle next to a point; `None` if there are no triangles. Coordinates whose fourth powers are finite.
    pub(crate) fn nearest(&self, p: &[f64; 3]) -> Option<Nearest> {
        let root = self.nodes.first()?.bounds.square_distance(p);
        let mut best = Nearest { square: f64::INFINITY, number: u32::MAX };
        let mut open = Stack::of((root, 0u32));
        while let Some((square, at)) = open.pop() {
            if square > best.square {
                continue;
            }
            let node = &self.nodes[at as usize];
            if node.second == 0 {
                for place in node.begin as usize..node.end as usize {
                    if self.bounds[place].square_distance(p) > best.square {
                        continue;
                    }
                    let square = square_distance(p, &self.corners[place]);
                    let number = self.numbers[place];
                    if square < best.square || square == best.square && number < best.number {
                        best = Nearest { square, number };
                    }
                }
            } else {
                let far = |node: u32| (self.nodes[node as usize].bounds.square_distance(p), node);
                let (first, second) = (far(at + 1), far(node.second));
                let (near, far) =
                    if second.0 < first.0 { (second, first) } else { (first, second) };
                open.push(far);
                open.push(near);
            }
        }
        Some(best)
    }
}

fn less(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Perpendicular to the triangle, as long as twice its area.
pub(crate) fn normal([a, b, c]: &[[f64; 3]; 3]) -> [f64; 3] {
    cross(less(*b, *a), less(*c, *a))
}

fn square_distance(p: &[f64; 3], triangle: &[[f64; 3]; 3]) -> f64 {
    let n = normal(triangle);
    // As seen from p.
    let [a, b, c] = triangle.map(|q| less(q, *p));
    let sides = side(a, b).min(side(b, c)).min(side(c, a));
    let weights = [dot(cross(b, c), n), dot(cross(c, a), n), dot(cross(a, b), n)];
    let sum = weights[0] + weights[1] + weights[2];
    if sum > 0.0 && weights.iter().all(|&weight| weight >= 0.0) {
        let [u, v, w] = weights.map(|weight| weight / sum);
        let projection: [f64; 3] = std::array::from_fn(|k| u * a[k] + v * b[k] + w * c[k]);
        return sides.min(dot(projection, projection));
    }
    sides
}

/// The square of the distance of the origin from a segment.
fn side(a: [f64; 3], b: [f64; 3]) -> f64 {
    let along = less(b, a);
    let length = dot(along, along);
    let share = if length > 0.0 { (-dot(a, along) / length).clamp(0.0, 1.0) } else { 0.0 };
    let projection: [f64; 3] = std::array::from_fn(|k| a[k] + share * along[k]);
    dot(projection, projection)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Distance from a segment: from the line if the angles at both ends are sharp, else from the nearer end.
    fn from_side(p: [f64; 3], a: [f64; 3], b: [f64; 3]) -> f64 {
        let norm = |v: [f64; 3]| dot(v, v).sqrt();
        let ends = norm(less(p, a)).min(norm(less(p, b)));
        let sharp = dot(less(p, a), less(b, a)) > 0.0 && dot(less(p, b), less(a, b)) > 0.0;
        if sharp { norm(cross(less(p, a), less(b, a))) / norm(less(b, a)) } else { ends }
    }

    /// Distance from a triangle: from the plane if p is above the inner side of all three sides, else from a side.
    fn plain_distance(p: [f64; 3], t: [[f64; 3]; 3]) -> f64 {
        let n = cross(less(t[1], t[0]), less(t[2], t[0]));
        let around = [(0, 1), (1, 2), (2, 0)];
        let above = |(i, j): (usize, usize)| dot(cross(n, less(t[j], t[i])), less(p, t[i])) >= 0.0;
        if n != [0.0; 3] && around.into_iter().all(above) {
            return dot(less(p, t[0]), n).abs() / dot(n, n).sqrt();
        }
        around.map(|(i, j)| from_side(p, t[i], t[j])).into_iter().fold(f64::INFINITY, f64::min)
    }

    proptest! {
        /// Whole numbers for corners bring points, segments and copies; points lie within and far outside.
        #[test]
        fn the_nearest_triangle_is_that_of_all(
            soup in prop::collection::vec(prop::collection::vec(-4i8..5, 9), 1..50),
            points in prop::collection::vec([-6i8..7, -6i8..7, -6i8..7], 10),
            inner in 0.0..1.0f64,
            far in 0usize..2,
        ) {
            let triangles: Vec<(u32, [[f64; 3]; 3])> = (0..)
                .zip(&soup)
                .map(|(number, v)| {
                    let x = |k: usize| f64::from(v[k]);
                    (number, [[x(0), x(1), x(2)], [x(3), x(4), x(5)], [x(6), x(7), x(8)]])
                })
                .collect();
            let tree = Bvh::new(&triangles);
            for p in points {
                let stretch = [1.0, 40.0][far];
                let p = p.map(|x| stretch * (f64::from(x) + inner));
                let near = tree.nearest(&p).unwrap();
                let all: Vec<f64> = triangles.iter().map(|t| plain_distance(p, t.1)).collect();
                let least = all.iter().copied().fold(f64::INFINITY, f64::min);
                // Coordinates up to 280 and a few dozen roundings.
                prop_assert!((near.square.sqrt() - least).abs() < 1e-10, "{near:?}, not {least}");
                prop_assert!((all[near.number as usize] - least).abs() < 1e-10);
            }
        }
    }

    #[test]
    fn of_equals_the_first_is_found() {
        let one = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let triangles: Vec<_> = (0..100).map(|k| (99 - k, one)).collect();
        let near = Bvh::new(&triangles).nearest(&[0.25, 0.25, 2.0]).unwrap();
        assert_eq!(near, Nearest { square: 4.0, number: 0 });
        assert_eq!(Bvh::new(&[]).nearest(&[0.0; 3]), None);
    }

    /// The projection of a point on the plane of a needle may be wrong by much of its length, but not the distance.
    #[test]
    fn needles_keep_their_distance() {
        for k in 0..200 {
            let t = f64::from(k) / 200.0;
            let needle =
                [[0.1, 0.3, 0.7], [1.1, 0.8, 0.1], [0.1 + t, 0.3 + 0.5 * t, 0.7 - 0.6 * t]];
            let tree = Bvh::new(&[(0, needle)]);
            for p in [[0.0, 1.0, 1.0], [0.5, 0.5, 0.5], [3.0, -1.0, 2.0]] {
                let side = from_side(p, needle[0], needle[1]);
                let near = tree.nearest(&p).unwrap();
                assert!((near.square.sqrt() - side).abs() < 1e-14, "{t} {p:?}");
            }
        }
    }
}
