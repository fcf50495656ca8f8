//! The convex polygon in a polygon, in fractions.
//!
//! *Decided.* Whether the corners are those of a convex polygon, no edge enters it, it is inside by the even-odd rule, and the area and
//! the gap are what they are said to be: exact. Whether no convex set is larger than the upper bound: refuted by a convex polygon
//! with a larger area, of which it is decided that it is inside. Those tried are what the solver finds and some triangles.

use num_rational::BigRational;
use num_traits::{One, Signed, Zero};
use taut::Points;
use taut::certify::{ConvexPolygon, ConvexVerdict, Solution};
use taut::inscribe::{ConvexOptions, inscribed_polygon};

use super::Truth;
use super::circle::{Point, crosses_above, edges, exact};

/// Largest number of corners of which all pairs are looked at.
const CORNERS_MAX: usize = 200;

/// Knows the truth about the convex polygons in one polygon.
pub struct ConvexOracle {
    edges: Vec<[Point; 2]>,
    /// The area of the best convex polygon found, which is inside.
    best: BigRational,
}

fn turn(a: &Point, b: &Point, c: &Point) -> BigRational {
    (&b[0] - &a[0]) * (&c[1] - &a[1]) - (&b[1] - &a[1]) * (&c[0] - &a[0])
}

fn sides(corners: &[Point]) -> impl Iterator<Item = (&Point, &Point)> {
    corners.iter().zip(corners.iter().cycle().skip(1))
}

/// Whether every other corner is strictly to the left of each side.
fn is_convex(corners: &[Point]) -> bool {
    let n = corners.len();
    n >= 3
        && (0..n).all(|i| {
            let (a, b) = (&corners[i], &corners[(i + 1) % n]);
            (2..n).all(|k| turn(a, b, &corners[(i + k) % n]).is_positive())
        })
}

fn area(corners: &[Point]) -> BigRational {
    let pairs = corners[1..].windows(2);
    let twice: BigRational = pairs.map(|pair| turn(&corners[0], &pair[0], &pair[1])).sum();
    twice / exact(2.0)
}

impl ConvexOracle {
    /// Prepares to judge convex polygons in the rings of these rows.
    pub fn new(values: &[f64], columns: usize) -> Self {
        let plain = edges(values, columns);
        let of_edge = |edge: &[[f64; 2]; 2]| edge.map(|p| p.map(exact));
        let edges: Vec<[Point; 2]> = plain.iter().map(of_edge).collect();
        let mut oracle = ConvexOracle { edges, best: BigRational::zero() };
        let solved = Points::new(values, columns)
            .ok()
            .and_then(|points| inscribed_polygon(&points, &ConvexOptions::default()).ok());
        let mut tried: Vec<Vec<[f64; 2]>> = solved.into_iter().map(|f| f.answer.vertices).collect();
        let n = plain.len();
        for i in 0..n.min(40) {
            for (j, k) in [(1, 2), (n / 3, 2 * n / 3), (n / 4, n / 2)] {
                let [a, b, c] = [i, (i + j) % n, (i + k) % n].map(|at| plain[at][0]);
                tried.extend([vec![a, b, c], vec![a, c, b]]);
            }
        }
        for corners in tried {
            let corners: Vec<Point> = corners.into_iter().map(|p| p.map(exact)).collect();
            if is_convex(&corners) && oracle.holds(&corners) {
                oracle.best = area(&corners).max(oracle.best);
            }
        }
        oracle
    }

    /// Whether a convex polygon is inside: no edge enters it, and one of its points is inside.
    fn holds(&self, corners: &[Point]) -> bool {
        let enters = |edge: &&[Point; 2]| Self::enters(corners, edge);
        let third = BigRational::one() / exact(3.0);
        let middle = [0, 1].map(|k| (&corners[0][k] + &corners[1][k] + &corners[2][k]) * &third);
        let crossed = self.edges.iter().filter(|edge| crosses_above(edge, &middle)).count();
        crossed % 2 == 1 && !self.edges.iter().any(|edge| enters(&edge))
    }

    /// Whether a part of an edge is strictly to the left of all sides.
    fn enters(corners: &[Point], [a, b]: &[Point; 2]) -> bool {
        let (mut from, mut to) = (BigRational::zero(), BigRational::one());
        for (p, q) in sides(corners) {
            let (here, there) = (turn(p, q, a), turn(p, q, b));
            if !here.is_positive() && !there.is_positive() {
                return false;
            }
            if here.is_positive() && there.is_positive() {
                continue;
            }
            let share = &here / (&here - &there);
            if here.is_positive() {
                to = to.min(share);
            } else {
                from = from.max(share);
            }
        }
        from < to
    }

    /// Judges every claim of an answer that the checker let pass.
    pub fn judge(&self, found: &Solution<ConvexPolygon>, verdict: &ConvexVerdict) -> Truth {
        let (answer, numbers) = (&found.answer, [verdict.lower, verdict.upper, verdict.gap]);
        let fields = answer.vertices.as_flattened().iter().chain(&numbers);
        let are_numbers = fields.chain([&answer.area]).all(|x| x.is_finite());
        if !(are_numbers && verdict.lower > 0.0 && verdict.gap >= 0.0) {
            return Truth::False(format!("{verdict:?} has no numbers of a convex polygon"));
        }
        if answer.vertices.len() > CORNERS_MAX {
            return Truth::Undecided("too many corners".into());
        }
        let corners: Vec<Point> = answer.vertices.iter().map(|p| p.map(exact)).collect();
        if !is_convex(&corners) {
            return Truth::False("the polygon is not convex".into());
        }
        let found = area(&corners);
        let [lower, upper, gap] = numbers.map(exact);
        Truth::claim(self.holds(&corners), || "the convex polygon is not inside".into())
            .and(|| Truth::claim(lower <= found, || "the area is less than the lower bound".into()))
            .and(|| {
                let holds = (exact(answer.area) - &found).abs() <= exact(1e-9) * &found;
                Truth::claim(holds, || "the area is not that of the corners".into())
            })
            .and(|| {
                Truth::claim(self.best <= upper, || {
                    format!("there is a convex polygon larger than {:?}", verdict.upper)
                })
            })
            .and(|| {
                let most = (BigRational::one() + &gap) * &lower * exact(1.0 + 1e-14);
                Truth::claim(upper <= most, || format!("the gap is more than {:?}", verdict.gap))
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_square_is_its_own_best_and_its_hole_is_kept_out() {
        let square = [0.0, 0.0, 2.0, 0.0, 2.0, 2.0, 0.0, 2.0];
        let oracle = ConvexOracle::new(&square, 2);
        assert!(oracle.best <= exact(4.0) && oracle.best >= exact(3.999));
        let corners = [[0.0, 0.0], [3.0, 0.0], [0.0, 3.0]].map(|p| p.map(exact));
        assert!(is_convex(&corners) && !oracle.holds(&corners));
    }
}
