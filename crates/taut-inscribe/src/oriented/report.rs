//! The rectangle found, as numbers of the input that no edge enters.

use taut_certify::InscribedOrientedRectangle;
use taut_points::two_to;

use crate::levels::is_left;
use crate::polygon::Segment;
use crate::units::Units;

use super::ascent::Candidate;
use super::cell::SLOPE;
use super::search::Target;

/// Shares by which a rectangle is shrunk until edges are clear of it, as powers of two: from the first to the last.
const SHRINK_BITS: std::ops::RangeInclusive<i32> = 12..=50;

/// How clear edges have to be, relative to the terms of a test: four times the error bound of a checker.
const CLEARANCE_WANTED: f64 = 32.0 * f64::EPSILON;

/// Smallest square of a half side, and smallest size of a vector along an edge whose line is looked at, where the largest coordinate of the
/// polygon is from 1 to 2: a checker takes 2⁻⁴⁰⁰, as products of smaller numbers underflow.
const TESTED_MIN: f64 = two_to(-390);

/// An answer.
pub(super) struct Reported {
    pub(super) answer: InscribedOrientedRectangle,
    /// A lower bound of the area in units.
    pub(super) in_units: f64,
}

/// Rounds a rectangle and shrinks it as little as keeps edges clear; `None` where nothing is left.
pub(super) fn rounded(best: &Candidate, target: &Target<'_>) -> Option<Reported> {
    let (units, edges) = (target.units, target.given);
    let center = best.center();
    let center = units.given_point([0, 1].map(|k| center[k] + target.pivot[k]));
    let is_inside = edges.iter().filter(|&&edge| is_left(edge, center)).count() % 2 == 1;
    let halves = [0, 1].map(|k| 0.5 * (best.at[k] + best.at[k + 2]));
    let m = best.at[SLOPE];
    // Heights are lengths times the root of 1 + m².
    let square = 1.0 + m * m;
    let (long, normal, ratio) = match halves[0] >= halves[1] {
        true => (halves[0], [1.0, m], halves[1] / halves[0]),
        false => (halves[1], [-m, 1.0], halves[0] / halves[1]),
    };
    let found = SHRINK_BITS.rev().find_map(|bits| {
        let share = 1.0 - two_to(-bits);
        let axis = [0, 1].map(|k| units.given_length(k, share * long * normal[k] / square));
        // What is thin is also made thinner, as rounding of its direction moves its sides by a share of the longer one.
        let ratio = ratio * share;
        let scaled = [0, 1].map(|k| units.scaled(k, axis[k]));
        let given =
            Given { center: [0, 1].map(|k| units.scaled(k, center[k])), axis: scaled, ratio };
        let is_tested = given.square() * ratio * ratio >= TESTED_MIN;
        let is_clear = is_tested && edges.iter().all(|&edge| given.is_clear_of(edge, units));
        is_clear.then_some((axis, given))
    });
    let (axis, given) = found.filter(|_| is_inside)?;
    let in_units = 4.0 * given.ratio * given.square() * units.growth(0) * units.growth(1);
    let area = units.given_area(in_units);
    let in_units = in_units * (1.0 - 16.0 * f64::EPSILON);
    let answer = InscribedOrientedRectangle { center, axis, ratio: given.ratio, area };
    (in_units > 0.0).then_some(Reported { answer, in_units })
}

/// A rectangle of the input, scaled by the factors of units.
struct Given {
    center: [f64; 2],
    axis: [f64; 2],
    ratio: f64,
}

impl Given {
    fn square(&self) -> f64 {
        self.axis[0] * self.axis[0] + self.axis[1] * self.axis[1]
    }

    /// Whether an edge is beyond a side, or all corners are on one side of it, by more than rounding.
    fn is_clear_of(&self, edge: Segment, units: &Units) -> bool {
        let given = edge.map(|w| [0, 1].map(|k| units.scaled(k, w[k])));
        let [p, q] = given.map(|w| [0, 1].map(|k| w[k] - self.center[k]));
        let a = self.axis;
        let b = [-self.ratio * a[1], self.ratio * a[0]];
        // Above the first side: a·w ≥ |a|², above the second: b·w ≥ |b|², and so on.
        let is_beyond = |normal: [f64; 2]| {
            let far = normal[0] * normal[0] + normal[1] * normal[1];
            [p, q].iter().all(|w| {
                let (x, y) = (normal[0] * w[0], normal[1] * w[1]);
                x + y - far > CLEARANCE_WANTED * (x.abs() + y.abs() + far)
            })
        };
        if [a, b, a.map(|x| -x), b.map(|x| -x)].into_iter().any(is_beyond) {
            return true;
        }
        let along = [0, 1].map(|k| given[1][k] - given[0][k]);
        if along.iter().all(|x| x.abs() < TESTED_MIN) {
            return false;
        }
        let turns = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)].map(|(x, y)| {
            let corner = [0, 1].map(|k| x * a[k] + y * b[k] - p[k]);
            let size = |k: usize| p[k].abs() + a[0].abs() + a[1].abs() + along[k].abs();
            let error = CLEARANCE_WANTED * (along[0].abs() * size(1) + along[1].abs() * size(0));
            (along[0] * corner[1] - along[1] * corner[0], error)
        });
        turns.iter().all(|(value, error)| value > error)
            || turns.iter().all(|(value, error)| -value > *error)
    }
}
