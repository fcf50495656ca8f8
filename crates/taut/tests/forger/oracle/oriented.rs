//! The rectangle of any direction in a polygon, in fractions.
//!
//! *Decided.* Whether no edge enters the rectangle, it is inside by the even-odd rule, and the area and the gap are what they are said to be:
//! exact. Whether no rectangle is larger than the upper bound: refuted by a larger one, of which it is decided that it is inside.
//! Those tried are found by a random search in plain arithmetic, and shrunk a little.

use num_rational::BigRational;
use num_traits::{One, Signed, Zero};
use taut::certify::{InscribedOrientedRectangle, OrientedRectangleVerdict, Solution};

use super::Truth;
use super::circle::{Point, crosses_above, edges, exact, is_inside};
use crate::random::Random;

/// Starts of the random search, and changes of each.
const TRIED: (usize, usize) = (30, 200);

/// How much the rectangles of the search are shrunk, so that plain arithmetic does not let edges into them.
const SHRUNK: f64 = 1.0 - 1e-9;

/// Knows the truth about the rectangles in one polygon.
pub struct OrientedOracle {
    edges: Vec<[Point; 2]>,
    /// The area of the best rectangle found, which is inside.
    best: BigRational,
}

/// A rectangle: all c + x·a + y·r·a⊥ with x and y from −1 to 1.
struct Exact {
    center: Point,
    axis: Point,
    ratio: BigRational,
}

impl Exact {
    fn of(center: [f64; 2], axis: [f64; 2], ratio: f64) -> Self {
        Exact { center: center.map(exact), axis: axis.map(exact), ratio: exact(ratio) }
    }

    fn square(&self) -> BigRational {
        &self.axis[0] * &self.axis[0] + &self.axis[1] * &self.axis[1]
    }

    fn area(&self) -> BigRational {
        exact(4.0) * &self.ratio * self.square()
    }

    /// How far a point is below each side: above 0 for all of them if it is in the rectangle.
    fn depths(&self, w: &Point) -> [BigRational; 4] {
        let [x, y] = [&w[0] - &self.center[0], &w[1] - &self.center[1]];
        let along = &x * &self.axis[0] + &y * &self.axis[1];
        let across = &y * &self.axis[0] - &x * &self.axis[1];
        let (long, short) = (self.square(), &self.ratio * self.square());
        [&long - &along, &long + &along, &short - &across, &short + &across]
    }

    /// Whether a point of an edge is in the open rectangle.
    fn is_entered(&self, [a, b]: &[Point; 2]) -> bool {
        let (mut from, mut to) = (BigRational::zero(), BigRational::one());
        for (here, there) in self.depths(a).into_iter().zip(self.depths(b)) {
            match (here.is_positive(), there.is_positive()) {
                (true, true) => (),
                (false, false) => return false,
                (true, false) => to = to.min(&here / (&here - &there)),
                (false, true) => from = from.max(&here / (&here - &there)),
            }
        }
        // An edge of no length is all in or all out.
        from < to
    }
}

impl OrientedOracle {
    /// Prepares to judge rectangles in the rings of these rows.
    pub fn new(values: &[f64], columns: usize) -> Self {
        let plain = edges(values, columns);
        let of_edge = |edge: &[[f64; 2]; 2]| edge.map(|p| p.map(exact));
        let edges: Vec<[Point; 2]> = plain.iter().map(of_edge).collect();
        let mut oracle = OrientedOracle { edges, best: BigRational::zero() };
        for (center, axis, ratio) in candidates(&plain) {
            let found = Exact::of(center, axis, ratio);
            if found.area() > oracle.best && oracle.holds(&found) {
                oracle.best = found.area();
            }
        }
        oracle
    }

    fn holds(&self, found: &Exact) -> bool {
        let crossed = self.edges.iter().filter(|edge| crosses_above(edge, &found.center)).count();
        crossed % 2 == 1 && !self.edges.iter().any(|edge| found.is_entered(edge))
    }

    /// Judges every claim of an answer that the checker let pass.
    pub fn judge(
        &self,
        found: &Solution<InscribedOrientedRectangle>,
        verdict: &OrientedRectangleVerdict,
    ) -> Truth {
        let (answer, numbers) = (&found.answer, [verdict.lower, verdict.upper, verdict.gap]);
        let fields = answer.center.iter().chain(&answer.axis).chain(&numbers);
        let are_numbers = fields.chain([&answer.area, &answer.ratio]).all(|x| x.is_finite());
        let is_shape = answer.ratio > 0.0 && answer.ratio <= 1.0 && answer.axis != [0.0; 2];
        if !(are_numbers && is_shape && verdict.lower > 0.0 && verdict.gap >= 0.0) {
            return Truth::False(format!("{answer:?} and {verdict:?} are no rectangle"));
        }
        let given = Exact::of(answer.center, answer.axis, answer.ratio);
        let area = given.area();
        let [lower, upper, gap] = numbers.map(exact);
        Truth::claim(self.holds(&given), || "the rectangle is not inside".into())
            .and(|| Truth::claim(lower <= area, || "the area is less than the lower bound".into()))
            .and(|| {
                let holds = (exact(answer.area) - &area).abs() <= exact(1e-13) * &area;
                Truth::claim(holds, || "the area is not that of the sides".into())
            })
            .and(|| {
                Truth::claim(self.best <= upper, || {
                    format!("there is a rectangle larger than {:?}", verdict.upper)
                })
            })
            .and(|| {
                // The bracket is rounded twice.
                let most = (BigRational::one() + &gap) * &lower * exact(1.0 + 1e-14);
                Truth::claim(upper <= most, || format!("the gap is more than {:?}", verdict.gap))
            })
    }
}

/// Rectangles that may be large, by center, axis and ratio: each the best of a random search; proved by nobody.
fn candidates(edges: &[[[f64; 2]; 2]]) -> Vec<([f64; 2], [f64; 2], f64)> {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for [p, _] in edges {
        for k in 0..2 {
            (low[k], high[k]) = (low[k].min(p[k]), high[k].max(p[k]));
        }
    }
    let extent = (high[0] - low[0]).max(high[1] - low[1]);
    let unit = |p: [f64; 2]| [0, 1].map(|k| (p[k] - low[k]) / extent);
    let unit: Vec<[[f64; 2]; 2]> = edges.iter().map(|edge| edge.map(unit)).collect();
    let mut random = Random::new("oriented rectangles", edges.len() as u64);
    let mut found = vec![];
    for _ in 0..TRIED.0 {
        // The center, the angle in radians, and the logarithm of the ratio of the half sides.
        let mut here = [random.unit(), random.unit(), 3.0 * random.signed(), random.signed()];
        let (mut scale, mut step) = (largest(here, &unit), 0.5);
        for _ in 0..TRIED.1 {
            let next = here.map(|x| x + step * random.signed());
            let other = largest(next, &unit);
            if other * other * next[3].exp() > scale * scale * here[3].exp() {
                (here, scale) = (next, other);
            } else {
                step *= 0.97;
            }
        }
        let [x, y, angle, log] = here;
        let (sine, cosine) = angle.sin_cos();
        let long = SHRUNK * scale * extent;
        let center = [low[0] + extent * x, low[1] + extent * y];
        found.push((center, [long * cosine, long * sine], SHRUNK * log.exp()));
    }
    found.retain(|(center, axis, ratio)| {
        center.iter().chain(axis).all(|x| x.is_finite()) && axis[0] != 0.0 && *ratio > 0.0
    });
    found
}

/// The largest half side along an angle, for a center and a ratio, with which no edge enters; 0 outside.
fn largest([x, y, angle, log]: [f64; 4], edges: &[[[f64; 2]; 2]]) -> f64 {
    if !is_inside(edges, [x, y]) {
        return 0.0;
    }
    let (sine, cosine) = angle.sin_cos();
    let ratio = log.exp();
    let map = |w: [f64; 2]| {
        let d = [w[0] - x, w[1] - y];
        [d[0] * cosine + d[1] * sine, (d[1] * cosine - d[0] * sine) / ratio]
    };
    let of_edge = |edge: &[[f64; 2]; 2]| {
        let [a, b] = edge.map(map);
        let size = |share: f64| {
            [0, 1].map(|k| (a[k] + share * (b[k] - a[k])).abs()).into_iter().fold(0.0, f64::max)
        };
        // The size is convex along the edge: thirds close in on the least.
        let (mut from, mut to) = (0.0f64, 1.0f64);
        for _ in 0..60 {
            let (one, other) = (from + (to - from) / 3.0, to - (to - from) / 3.0);
            if size(one) <= size(other) { to = other } else { from = one }
        }
        size(0.5 * (from + to)).min(size(0.0)).min(size(1.0))
    };
    edges.iter().map(of_edge).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn most_of_a_square_is_found() {
        let oracle = OrientedOracle::new(&[1.0, 0.0, 2.0, 1.0, 1.0, 2.0, 0.0, 1.0], 2);
        assert!(oracle.best <= exact(2.0) && oracle.best >= exact(1.8));
    }

    #[test]
    fn edges_enter_or_touch() {
        let found = Exact::of([0.0, 0.0], [1.0, 1.0], 0.5);
        for (edge, is_in) in [
            ([[-3.0, 0.0], [3.0, 0.0]], true),
            ([[0.5, 0.5], [0.5, 0.5]], true),
            ([[2.0, 0.0], [0.0, 2.0]], false),
            ([[-1.0, 0.0], [0.0, 1.0]], false),
            ([[1.5, 1.5], [2.0, 2.0]], false),
        ] {
            assert_eq!(found.is_entered(&edge.map(|p| p.map(exact))), is_in, "{edge:?}");
        }
    }
}
