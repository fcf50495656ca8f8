//! The ellipse in a polygon, in fractions.
//!
//! *Decided.* Whether the center is inside by the even-odd rule, no edge enters the ellipse, and the area and the gap are what they
//! are said to be: exact, with π between two neighbors in `f64`. Whether no ellipse is larger than the upper bound: refuted by any
//! ellipse inside with a larger area. The best one of a random search in plain arithmetic is checked in fractions.

use num_rational::BigRational;
use num_traits::{One, Signed, Zero};
use taut::certify::{EllipseVerdict, InscribedEllipse, Solution};

use super::Truth;
use super::circle::{Point, crosses_above, edges, exact, is_inside};

use crate::random::Random;

/// Starts of the random search.
const STARTS: usize = 40;

/// Changes of each start.
const STEPS_PER_START: usize = 300;

/// How much the ellipses of the search are shrunk, so that plain arithmetic does not let edges into them.
const SHRUNK: f64 = 1.0 - 1e-9;

/// Knows the truth about the ellipses in one polygon.
pub struct EllipseOracle {
    edges: Vec<[Point; 2]>,
    /// The determinant of the best ellipse found, which is inside.
    best: BigRational,
}

/// The center c and the matrix G of an ellipse {c + Gz : |z| ≤ 1}.
struct Exact {
    center: Point,
    axes: [Point; 2],
}

impl Exact {
    fn of(center: [f64; 2], axes: [[f64; 2]; 2]) -> Self {
        Exact { center: center.map(exact), axes: axes.map(|row| row.map(exact)) }
    }

    fn determinant(&self) -> BigRational {
        let [[a, b], [c, d]] = &self.axes;
        a * d - b * c
    }

    /// The squared distance of an edge in the norm of the ellipse, whose determinant is not 0.
    fn squared_distance(&self, [a, b]: &[Point; 2]) -> BigRational {
        let determinant = self.determinant();
        let image = |p: &Point| {
            let d = [&p[0] - &self.center[0], &p[1] - &self.center[1]];
            let [[g11, g12], [g21, g22]] = &self.axes;
            [(g22 * &d[0] - g12 * &d[1]) / &determinant, (g11 * &d[1] - g21 * &d[0]) / &determinant]
        };
        let (a, b) = (image(a), image(b));
        let e = [&b[0] - &a[0], &b[1] - &a[1]];
        let dot = |u: &Point, v: &Point| &u[0] * &v[0] + &u[1] * &v[1];
        let square = dot(&e, &e);
        if square.is_zero() || !dot(&a, &e).is_negative() {
            return dot(&a, &a);
        }
        if !dot(&b, &e).is_positive() {
            return dot(&b, &b);
        }
        let cross = &a[0] * &b[1] - &a[1] * &b[0];
        &cross * &cross / square
    }
}

impl EllipseOracle {
    /// Prepares to judge ellipses in the rings of these rows.
    pub fn new(values: &[f64], columns: usize) -> Self {
        let plain = edges(values, columns);
        let of_edge = |edge: &[[f64; 2]; 2]| edge.map(|p| p.map(exact));
        let mut oracle =
            EllipseOracle { edges: plain.iter().map(of_edge).collect(), best: BigRational::zero() };
        for (center, axes) in candidates(&plain) {
            let ellipse = Exact::of(center, axes);
            let determinant = ellipse.determinant();
            if determinant > oracle.best && oracle.is_in(&ellipse) {
                oracle.best = determinant;
            }
        }
        oracle
    }

    /// Whether the center is inside and no edge enters.
    fn is_in(&self, ellipse: &Exact) -> bool {
        let crossed = self.edges.iter().filter(|edge| crosses_above(edge, &ellipse.center));
        let is_clear = |edge: &[Point; 2]| ellipse.squared_distance(edge) >= BigRational::one();
        crossed.count() % 2 == 1 && self.edges.iter().all(is_clear)
    }

    /// Judges every claim of an answer that the checker let pass.
    pub fn judge(&self, found: &Solution<InscribedEllipse>, verdict: &EllipseVerdict) -> Truth {
        let (answer, numbers) = (&found.answer, [verdict.lower, verdict.upper, verdict.gap]);
        let fields = answer.center.iter().chain(answer.axes.as_flattened()).chain(&numbers);
        let are_numbers = fields.chain([&answer.area]).all(|x| x.is_finite());
        if !(are_numbers && verdict.lower > 0.0 && verdict.gap >= 0.0) {
            return Truth::False(format!(
                "{answer:?} and {verdict:?} are no numbers of an ellipse"
            ));
        }
        let ellipse = Exact::of(answer.center, answer.axes);
        let determinant = ellipse.determinant();
        if !determinant.is_positive() {
            return Truth::False("the determinant is not above 0".into());
        }
        let pi = [std::f64::consts::PI, std::f64::consts::PI.next_up()].map(exact);
        let [lower, upper, gap] = numbers.map(exact);
        Truth::claim(self.is_in(&ellipse), || "the ellipse is not in the polygon".into())
            .and(|| {
                let holds = lower <= &determinant * &pi[1];
                Truth::claim(holds, || "the area is less than the lower bound".into())
            })
            .and(|| {
                let slack = exact(1e-13) * &lower;
                let holds = (exact(answer.area) - &determinant * &pi[0]).abs() <= slack;
                Truth::claim(holds, || "the area is not that of the axes".into())
            })
            .and(|| {
                Truth::claim(&self.best * &pi[0] <= upper, || {
                    format!("there is an ellipse larger than {:?}", verdict.upper)
                })
            })
            .and(|| {
                // The bracket is rounded twice: to the lower and to the upper bound.
                let most = (BigRational::one() + &gap) * &lower * exact(1.0 + 1e-14);
                Truth::claim(upper <= most, || format!("the gap is more than {:?}", verdict.gap))
            })
            .and(|| self.touching(found, &ellipse))
    }

    /// Whether each touching edge is as near as it is said to be.
    fn touching(&self, found: &Solution<InscribedEllipse>, ellipse: &Exact) -> Truth {
        let most = exact(1.0 + 2e-9) + exact(found.certificate.gap);
        let most = &most * &most;
        for &row in &found.certificate.touching {
            if ellipse.squared_distance(&self.edges[row as usize]) > most {
                return Truth::False(format!("edge {row} is not touched"));
            }
        }
        Truth::claim(!found.certificate.touching.is_empty(), || "no edge touches".into())
    }
}

/// Ellipses that may be large: each the best of a random search, by center and matrix; in plain arithmetic and proved by nobody.
fn candidates(edges: &[[[f64; 2]; 2]]) -> Vec<([f64; 2], [[f64; 2]; 2])> {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for [p, _] in edges {
        for k in 0..2 {
            (low[k], high[k]) = (low[k].min(p[k]), high[k].max(p[k]));
        }
    }
    let extent = [high[0] - low[0], high[1] - low[1]];
    let unit = |p: [f64; 2]| [0, 1].map(|k| (p[k] - low[k]) / extent[k]);
    let unit: Vec<[[f64; 2]; 2]> = edges.iter().map(|edge| edge.map(unit)).collect();
    let mut random = Random::new("ellipses", edges.len() as u64);
    let mut found = vec![];
    for _ in 0..STARTS {
        let mut here = [random.unit(), random.unit(), 0.0, 1.0];
        let (mut size, mut step) = (size_of(here, &unit), 0.5);
        for _ in 0..STEPS_PER_START {
            let mut change = || step * random.signed();
            let next = [
                here[0] + change(),
                here[1] + change(),
                here[2] + change(),
                here[3] * change().exp(),
            ];
            let other = size_of(next, &unit);
            if other > size {
                (here, size) = (next, other);
            } else {
                step *= 0.97;
            }
        }
        let ([x, y, s, t], size) = (here, size * SHRUNK);
        let root = t.sqrt();
        let axes = [
            [size / root * extent[0], 0.0],
            [-size * s / root * extent[1], size * root * extent[1]],
        ];
        found.push(([low[0] + x * extent[0], low[1] + y * extent[1]], axes));
    }
    let is_finite = |found: &([f64; 2], [[f64; 2]; 2])| {
        found.0.iter().chain(found.1.as_flattened()).all(|x| x.is_finite())
    };
    found.retain(is_finite);
    found
}

/// The largest size of the ellipses of a center and shape (x, y, s, t): |w|² = t·w₁² + (w₂ + s·w₁)²/t.
fn size_of([x, y, s, t]: [f64; 4], edges: &[[[f64; 2]; 2]]) -> f64 {
    if !is_inside(edges, [x, y]) {
        return 0.0;
    }
    let root = t.sqrt();
    let image = |p: [f64; 2]| {
        let w = [p[0] - x, p[1] - y];
        [root * w[0], (w[1] + s * w[0]) / root]
    };
    let distance = |edge: &[[f64; 2]; 2]| {
        let [a, b] = edge.map(image);
        let e = [b[0] - a[0], b[1] - a[1]];
        let share = -(a[0] * e[0] + a[1] * e[1]) / (e[0] * e[0] + e[1] * e[1]);
        let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 };
        (a[0] + share * e[0]).hypot(a[1] + share * e[1])
    };
    edges.iter().map(distance).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_ellipse_of_a_square_is_nearly_found() {
        let oracle = EllipseOracle::new(&[0.0, 0.0, 2.0, 0.0, 2.0, 2.0, 0.0, 2.0], 2);
        assert!(oracle.best <= BigRational::one() && oracle.best >= exact(0.99));
    }
}
