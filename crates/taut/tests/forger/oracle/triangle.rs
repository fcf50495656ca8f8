//! The triangle in a polygon, in fractions.
//!
//! *Decided.* Whether the triangle is inside by the even-odd rule, no edge enters it, and the area and the gap are what they are said to
//! be: exact. Whether no triangle is larger than the upper bound: refuted by any triangle inside with a larger area. The best ones of a
//! random search in plain arithmetic are checked in fractions.

use num_rational::BigRational;
use num_traits::{One, Signed, Zero};
use taut::certify::{InscribedTriangle, Solution, TriangleVerdict};

use super::Truth;
use super::circle::{Point, crosses_above, edges, exact, is_inside};

use crate::random::Random;

/// Starts of the random search.
const STARTS_TRIED: usize = 40;

/// Changes of each start.
const STEPS_OF_A_START: usize = 400;

/// How much the triangles of the search are shrunk, so that plain arithmetic does not let edges into them.
const SHRUNK: f64 = 1.0 - 1e-9;

/// Three corners, counterclockwise where they turn left.
type Corners = [[f64; 2]; 3];

/// Knows the truth about the triangles in one polygon.
pub struct TriangleOracle {
    edges: Vec<[Point; 2]>,
    /// Twice the area of the best triangle found, which is inside.
    best: BigRational,
}

/// Twice the area of p, q, w: above 0 where they turn left.
fn turn(p: &Point, q: &Point, w: &Point) -> BigRational {
    (&p[0] - &w[0]) * (&q[1] - &w[1]) - (&p[1] - &w[1]) * (&q[0] - &w[0])
}

/// The pairs of corners from each to the next.
fn sides(corners: &[Point; 3]) -> [[&Point; 2]; 3] {
    let [p, q, r] = corners;
    [[p, q], [q, r], [r, p]]
}

/// The share of the way at which an edge comes to lie left of a side, and the share at which it ceases to.
fn shares_left(values: &[BigRational; 2]) -> Option<[BigRational; 2]> {
    let [from, to] = values;
    let (zero, one) = (BigRational::zero(), BigRational::one());
    match (from.is_positive(), to.is_positive()) {
        (true, true) => Some([zero, one]),
        (false, false) => None,
        (false, true) => Some([from / (from - to), one]),
        (true, false) => Some([zero, from / (from - to)]),
    }
}

impl TriangleOracle {
    /// Prepares to judge triangles in the rings of these rows.
    pub fn new(values: &[f64], columns: usize) -> Self {
        let plain = edges(values, columns);
        let of_edge = |edge: &[[f64; 2]; 2]| edge.map(|p| p.map(exact));
        let mut oracle = TriangleOracle {
            edges: plain.iter().map(of_edge).collect(),
            best: BigRational::zero(),
        };
        for corners in candidates(&plain) {
            let corners = corners.map(|p| p.map(exact));
            let [p, q, r] = &corners;
            let doubled = turn(p, q, r);
            if doubled > oracle.best && oracle.is_in(&corners) {
                oracle.best = doubled;
            }
        }
        oracle
    }

    /// Whether a triangle that turns left is inside, and no edge enters.
    fn is_in(&self, corners: &[Point; 3]) -> bool {
        let three = BigRational::one() + BigRational::one() + BigRational::one();
        let mean = [0, 1].map(|k| (&corners[0][k] + &corners[1][k] + &corners[2][k]) / &three);
        let crossed = self.edges.iter().filter(|edge| crosses_above(edge, &mean)).count();
        crossed % 2 == 1 && !self.edges.iter().any(|edge| enters(edge, corners))
    }

    /// Judges every claim of an answer that the checker let pass.
    pub fn judge(&self, found: &Solution<InscribedTriangle>, verdict: &TriangleVerdict) -> Truth {
        let (answer, numbers) = (&found.answer, [verdict.lower, verdict.upper, verdict.gap]);
        let fields = answer.corners.as_flattened().iter().chain(&numbers);
        let are_numbers = fields.chain([&answer.area]).all(|x| x.is_finite());
        if !(are_numbers && verdict.lower > 0.0 && verdict.gap >= 0.0) {
            return Truth::False(format!(
                "{answer:?} and {verdict:?} are no numbers of a triangle"
            ));
        }
        let corners = answer.corners.map(|p| p.map(exact));
        let [p, q, r] = &corners;
        let area = turn(p, q, r) * exact(0.5);
        if !area.is_positive() {
            return Truth::False("the corners do not turn left".into());
        }
        let [lower, upper, gap] = numbers.map(exact);
        Truth::claim(self.is_in(&corners), || "the triangle is not in the polygon".into())
            .and(|| Truth::claim(lower <= area, || "the area is less than the lower bound".into()))
            .and(|| {
                let holds = (exact(answer.area) - &area).abs() <= exact(1e-13) * &lower;
                Truth::claim(holds, || "the area is not that of the corners".into())
            })
            .and(|| {
                Truth::claim(&self.best * exact(0.5) <= upper, || {
                    format!("there is a triangle larger than {:?}", verdict.upper)
                })
            })
            .and(|| {
                // The bracket is rounded twice: to the lower and to the upper bound.
                let most = (BigRational::one() + &gap) * &lower * exact(1.0 + 1e-14);
                Truth::claim(upper <= most, || format!("the gap is more than {:?}", verdict.gap))
            })
            .and(|| self.touching(found, &corners))
    }

    /// Whether the triangle reaches each touching edge when it grows as little as it is said to.
    fn touching(&self, found: &Solution<InscribedTriangle>, corners: &[Point; 3]) -> Truth {
        let scale = exact(1.0 + 2e-9) + exact(found.certificate.gap);
        let three = exact(3.0);
        let mean = [0, 1].map(|k| (&corners[0][k] + &corners[1][k] + &corners[2][k]) / &three);
        let grown = |p: &Point| [0, 1].map(|k| &mean[k] + &scale * (&p[k] - &mean[k]));
        let grown = [grown(&corners[0]), grown(&corners[1]), grown(&corners[2])];
        for &row in &found.certificate.touching {
            if !enters(&self.edges[row as usize], &grown) {
                return Truth::False(format!("edge {row} is not touched"));
            }
        }
        Truth::claim(!found.certificate.touching.is_empty(), || "no edge touches".into())
    }
}

/// Whether a point of an edge is in the open triangle.
fn enters([a, b]: &[Point; 2], corners: &[Point; 3]) -> bool {
    let (mut from, mut to) = (BigRational::zero(), BigRational::one());
    for [p, q] in sides(corners) {
        let Some([first, last]) = shares_left(&[turn(p, q, a), turn(p, q, b)]) else {
            return false;
        };
        from = if first > from { first } else { from };
        to = if last < to { last } else { to };
    }
    // An edge of no length is all in or all out, by the signs alone.
    from < to
}

/// Triangles that may be large: each the best of a random search; in plain arithmetic and proved by nobody.
fn candidates(edges: &[[[f64; 2]; 2]]) -> Vec<Corners> {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for [p, _] in edges {
        for k in 0..2 {
            (low[k], high[k]) = (low[k].min(p[k]), high[k].max(p[k]));
        }
    }
    let extent = [high[0] - low[0], high[1] - low[1]];
    let unit = |p: [f64; 2]| [0, 1].map(|k| (p[k] - low[k]) / extent[k]);
    let unit: Vec<[[f64; 2]; 2]> = edges.iter().map(|edge| edge.map(unit)).collect();
    let mut random = Random::new("triangles", edges.len() as u64);
    let mut found = vec![];
    for _ in 0..STARTS_TRIED {
        let mut here = [(); 3].map(|()| [random.unit(), random.unit()]);
        let (mut grown, mut step) = (largest(here, &unit), 0.5);
        for _ in 0..STEPS_OF_A_START {
            let next = here.map(|p| p.map(|x| x + step * random.signed()));
            let other = largest(next, &unit);
            if other.0 > grown.0 {
                (here, grown) = (other.1, other);
            } else {
                step *= 0.98;
            }
        }
        let mean = [0, 1].map(|k| (here[0][k] + here[1][k] + here[2][k]) / 3.0);
        let given = |p: [f64; 2]| {
            [0, 1].map(|k| low[k] + extent[k] * (mean[k] + SHRUNK * (p[k] - mean[k])))
        };
        found.push(grown.1.map(given));
    }
    found.retain(|corners| corners.as_flattened().iter().all(|x| x.is_finite()));
    found
}

/// The largest image of a triangle from its centroid that no edge enters, and twice its area; 0 for one outside.
fn largest(corners: Corners, edges: &[[[f64; 2]; 2]]) -> (f64, Corners) {
    let cross = |p: [f64; 2], q: [f64; 2], w: [f64; 2]| {
        (p[0] - w[0]) * (q[1] - w[1]) - (p[1] - w[1]) * (q[0] - w[0])
    };
    let [p, q, r] = corners;
    let (doubled, mean) = (cross(p, q, r), [0, 1].map(|k| (p[k] + q[k] + r[k]) / 3.0));
    if doubled.is_nan() || doubled <= 0.0 || !is_inside(edges, mean) {
        return (0.0, corners);
    }
    let mut scale = f64::INFINITY;
    for &[a, b] in edges {
        let scales = |w: [f64; 2]| {
            [[p, q], [q, r], [r, p]].map(|[p, q]| 1.0 - 3.0 * cross(p, q, w) / doubled)
        };
        let (from, to) = (scales(a), scales(b));
        let at = |t: f64| {
            (0..3).map(|k| from[k] + t * (to[k] - from[k])).fold(f64::NEG_INFINITY, f64::max)
        };
        scale = scale.min(at(0.0)).min(at(1.0));
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            let t = (from[i] - from[j]) / ((from[i] - from[j]) - (to[i] - to[j]));
            if t > 0.0 && t < 1.0 {
                scale = scale.min(at(t));
            }
        }
    }
    let grown = corners.map(|p| [0, 1].map(|k| mean[k] + scale * (p[k] - mean[k])));
    (doubled * scale * scale, grown)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_triangle_of_a_square_is_nearly_found() {
        let oracle = TriangleOracle::new(&[0.0, 0.0, 2.0, 0.0, 2.0, 2.0, 0.0, 2.0], 2);
        assert!(oracle.best <= exact(4.0) && oracle.best >= exact(3.9));
    }

    #[test]
    fn edges_enter_or_touch() {
        let corners = [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]].map(|p| p.map(exact));
        for (edge, is_in) in [
            ([[-1.0, 1.0], [5.0, 1.0]], true),
            ([[1.0, 1.0], [1.0, 1.0]], true),
            ([[2.0, 2.0], [2.0, 2.0]], false),
            ([[4.0, 0.0], [0.0, 4.0]], false),
            ([[2.0, 2.0], [9.0, 9.0]], false),
        ] {
            assert_eq!(enters(&edge.map(|p| p.map(exact)), &corners), is_in, "{edge:?}");
        }
    }
}
