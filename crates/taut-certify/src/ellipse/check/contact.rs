//! Whether an edge enters an ellipse, exactly.
//!
//! *Idea.* With w(p) = adj(G)·(p − c) the open ellipse is |w| < q, q = det G > 0. An edge from a to b stays out when both ends do
//! and, if the point of the segment w(a)w(b) that is nearest to 0 lies between its ends, also that point does. Its distance is
//! |w(a) × w(b)|/|w(b) − w(a)|, and w(a) × w(b) = q·((a − c) × (b − c)), so that it stays out when
//! ((a − c) × (b − c))² ≥ |w(b) − w(a)|². All these are signs of polynomials of the numbers given.
//! *Guarantee.* Plain arithmetic decides first, then doubled precision, each with a bound of its errors; then whole numbers.
//! With relative errors ε of single operations, components of w are off by less than 4ε of the sums of the sizes of their two terms,
//! and all values below by less than 16ε of the sums of squares of such sums: [`ERRORS`] is eight times that. What underflows is
//! less than [`UNDERFLOW`].

use std::cmp::Ordering;

use super::super::InscribedEllipse;
use crate::arithmetic::{DoubleDouble, Field, Integer, Ring, U, parts};
use crate::polygon::Units;

/// Errors of values, in relative errors of operations and sums of the sizes of terms.
const ERRORS: f64 = 128.0;

/// Bound of what underflow can change, coordinates and axes being below 2¹⁰ in size: 2⁻⁹⁰⁰.
const UNDERFLOW: f64 = f64::from_bits((1023 - 900) << 52);

/// An ellipse, given and scaled.
pub(super) struct Ellipse {
    center: [f64; 2],
    axes: [[f64; 2]; 2],
    scaled_center: [f64; 2],
    scaled_axes: [[f64; 2]; 2],
    factors: [[f64; 2]; 2],
    /// The square of the size in units, rounded down.
    pub(super) square_of_size: f64,
}

impl Ellipse {
    /// Takes an answer whose determinant is provably above 0.
    pub(super) fn of(answer: &InscribedEllipse, units: &Units) -> Option<Self> {
        let scaled = |k: usize, x: f64| units.scaled(k, x);
        let axes = [0, 1].map(|k| answer.axes[k].map(|x| scaled(k, x)));
        let is_moderate = axes.iter().flatten().all(|x| x.abs() < 1024.0);
        let product = |a: f64, b: f64| DoubleDouble::of(a).times(&DoubleDouble::of(b));
        let (one, other) = (product(axes[0][0], axes[1][1]), product(axes[0][1], axes[1][0]));
        let error = ERRORS * DoubleDouble::ROUNDOFF * (one.high.abs() + other.high.abs());
        let determinant = one.minus(&other).high * (1.0 - 4.0 * U) - error - UNDERFLOW;
        // Subnormal numbers would be rounded when they are grown.
        let is_positive = determinant > UNDERFLOW;
        (is_moderate && is_positive).then(|| Ellipse {
            center: answer.center,
            axes: answer.axes,
            scaled_center: [scaled(0, answer.center[0]), scaled(1, answer.center[1])],
            scaled_axes: axes,
            factors: [0, 1].map(|k| units.factors(k)),
            square_of_size: units.grown(determinant) * (1.0 - 4.0 * U),
        })
    }

    /// Whether an edge of the polygon enters the open ellipse.
    pub(super) fn is_entered(&self, edge: [[f64; 2]; 2]) -> bool {
        let scaled = edge.map(|p| [0, 1].map(|k| p[k] * self.factors[k][0] * self.factors[k][1]));
        let is_clear = is_surely_clear::<f64>(self.scaled_center, self.scaled_axes, scaled)
            || is_surely_clear::<DoubleDouble>(self.scaled_center, self.scaled_axes, scaled);
        !is_clear && is_entered_exactly(self.center, self.axes, edge)
    }

    /// The distance of an edge in the norm of the ellipse: 1 on its border. Images are right to doubled precision, the rest is plain.
    pub(super) fn distance(&self, edge: [[f64; 2]; 2]) -> f64 {
        let scaled = edge.map(|p| [0, 1].map(|k| p[k] * self.factors[k][0] * self.factors[k][1]));
        let [[g11, g12], [g21, g22]] = self.scaled_axes.map(|row| row.map(DoubleDouble::of));
        let image = |p: [f64; 2], q: [f64; 2]| {
            let d = [0, 1].map(|k| DoubleDouble::difference(p[k], q[k]));
            let first = g22.times(&d[0]).minus(&g12.times(&d[1]));
            [first, g11.times(&d[1]).minus(&g21.times(&d[0]))].map(|x| x.rounded())
        };
        let (a, e) = (image(scaled[0], self.scaled_center), image(scaled[1], scaled[0]));
        let share = -(a[0] * e[0] + a[1] * e[1]) / (e[0] * e[0] + e[1] * e[1]);
        let share = if share >= 0.0 { share.min(1.0) } else { 0.0 };
        let determinant = g11.times(&g22).minus(&g12.times(&g21)).rounded();
        (a[0] + share * e[0]).hypot(a[1] + share * e[1]) / determinant
    }
}

/// The polynomials of an edge whose signs decide.
struct Values<T> {
    /// |w(a)|² − q² and |w(b)|² − q².
    ends: [T; 2],
    /// w(a)·(w(b) − w(a)) and w(b)·(w(b) − w(a)): the foot is between the ends where the first is below 0 and the second above.
    along: [T; 2],
    /// ((a − c) × (b − c))² − |w(b) − w(a)|².
    foot: T,
}

/// Evaluates for d = a − c, f = b − c and e = b − a.
fn values<T: Ring>([[g11, g12], [g21, g22]]: &[[T; 2]; 2], [d, f, e]: &[[T; 2]; 3]) -> Values<T> {
    let image = |v: &[T; 2]| {
        [g22.times(&v[0]).minus(&g12.times(&v[1])), g11.times(&v[1]).minus(&g21.times(&v[0]))]
    };
    let dot = |u: &[T; 2], v: &[T; 2]| u[0].times(&v[0]).plus(&u[1].times(&v[1]));
    let q = g11.times(g22).minus(&g12.times(g21));
    let square = q.times(&q);
    let [a, b, along] = [image(d), image(f), image(e)];
    let cross = d[0].times(&f[1]).minus(&d[1].times(&f[0]));
    Values {
        ends: [dot(&a, &a).minus(&square), dot(&b, &b).minus(&square)],
        along: [dot(&a, &along), dot(&b, &along)],
        foot: cross.times(&cross).minus(&dot(&along, &along)),
    }
}

/// Whether the errors of this precision leave no doubt that an edge stays out; all in scaled coordinates.
fn is_surely_clear<N: Field>(c: [f64; 2], axes: [[f64; 2]; 2], [a, b]: [[f64; 2]; 2]) -> bool {
    let difference = |p: [f64; 2], q: [f64; 2]| [0, 1].map(|k| N::difference(p[k], q[k]));
    let vectors = [difference(a, c), difference(b, c), difference(b, a)];
    let found = values(&axes.map(|row| row.map(N::of)), &vectors);
    // Sums of the sizes of terms.
    let [[g11, g12], [g21, g22]] = axes.map(|row| row.map(f64::abs));
    let [d, f, e] = vectors.map(|v| v.map(|x| x.rounded().abs()));
    let squares = |v: [f64; 2]| {
        let image = [g22 * v[0] + g12 * v[1], g11 * v[1] + g21 * v[0]];
        image[0] * image[0] + image[1] * image[1]
    };
    let (q, cross) = (g11 * g22 + g12 * g21, d[0] * f[1] + d[1] * f[0]);
    let error = |size: f64| ERRORS * N::ROUNDOFF * size + UNDERFLOW;
    let of_ends = error(squares(d) + squares(f) + q * q);
    let of_along = error(squares(d) + squares(f) + squares(e));
    let of_foot = error(cross * cross + squares(e));
    let is_outer = found.along[0].rounded() >= of_along || found.along[1].rounded() <= -of_along;
    found.ends.iter().all(|end| end.rounded() >= of_ends)
        && (is_outer || found.foot.rounded() >= of_foot)
}

/// Decides with whole numbers.
fn is_entered_exactly(c: [f64; 2], axes: [[f64; 2]; 2], [a, b]: [[f64; 2]; 2]) -> bool {
    let least = |numbers: &[[f64; 2]]| {
        let all = numbers.iter().flatten().filter(|x| **x != 0.0);
        all.map(|x| parts(*x).1).min().unwrap_or(0)
    };
    let (of_points, of_axes) = (least(&[a, b, c]), least(&axes));
    // One scale for all, as the foot compares products of coordinates with products of axes.
    let scale = of_points.min(of_axes);
    let whole = |p: [f64; 2]| p.map(|x| Integer::scaled(x, scale));
    let [a, b, c] = [a, b, c].map(whole);
    let minus = |p: &[Integer; 2], q: &[Integer; 2]| [p[0].minus(&q[0]), p[1].minus(&q[1])];
    let found = values(&axes.map(whole), &[minus(&a, &c), minus(&b, &c), minus(&b, &a)]);
    let is_below = |value: &Integer| value.sign() == Ordering::Less;
    let is_between = is_below(&found.along[0]) && found.along[1].sign() == Ordering::Greater;
    found.ends.iter().any(is_below) || is_between && is_below(&found.foot)
}
