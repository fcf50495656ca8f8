//! The rectangle of the answer, and edges apart from it.
//!
//! *Rounding.* Coordinates scaled by the factors of the units are exact, and differences of them are right to u of themselves. Each test is
//! a sum of at most twelve products of two or three such numbers: it is right to 16u times the sum of the sizes of its products, as
//! products that underflow are much smaller than u times [`SQUARE_MIN`], and lines of edges shorter than [`ALONG_MIN`] are not looked at.

use super::super::InscribedOrientedRectangle;
use crate::arithmetic::U;
use crate::polygon::Units;

/// Smallest square of a half side, where the largest coordinate of the polygon is from 1 to 2: 2⁻⁴⁰⁰.
const SQUARE_MIN: f64 = f64::from_bits((1023 - 400) << 52);

/// Smallest size of a vector along an edge whose line is looked at: 2⁻⁴⁰⁰. Half sides are at least 2⁻²⁰⁰ long, so that products with it are
/// far above those that underflow.
const ALONG_MIN: f64 = f64::from_bits((1023 - 400) << 52);

/// A bound of the relative errors of tests.
const TEST_ERROR: f64 = 16.0 * U;

/// The rectangle, scaled by the factors of the units.
pub(super) struct Given {
    center: [f64; 2],
    axis: [f64; 2],
    ratio: f64,
}

impl Given {
    /// `None` if half sides are too short.
    pub(super) fn of(answer: &InscribedOrientedRectangle, units: &Units) -> Option<Self> {
        let scaled = |p: [f64; 2]| [0, 1].map(|k| units.scaled(k, p[k]));
        let given =
            Given { center: scaled(answer.center), axis: scaled(answer.axis), ratio: answer.ratio };
        let square = given.square() * given.ratio * given.ratio;
        let is_moderate = square >= SQUARE_MIN && given.square().is_finite();
        is_moderate.then_some(given)
    }

    fn square(&self) -> f64 {
        self.axis[0] * self.axis[0] + self.axis[1] * self.axis[1]
    }

    /// A lower bound of the area, in units.
    pub(super) fn area_below(&self, units: &Units) -> f64 {
        units.grown(4.0 * self.ratio * self.square()) * (1.0 - 8.0 * U)
    }

    /// Whether an edge surely does not enter the open rectangle.
    pub(super) fn is_clear_of(&self, edge: [[f64; 2]; 2], units: &Units) -> bool {
        let [p, q] = edge.map(|w| [0, 1].map(|k| units.scaled(k, w[k]) - self.center[k]));
        let [ax, ay] = self.axis;
        let r = self.ratio;
        let sides = [
            ([ax, ay], self.square()),
            ([-ay, ax], r * self.square()),
            ([-ax, -ay], self.square()),
            ([ay, -ax], r * self.square()),
        ];
        let is_beyond = |&([x, y], far): &([f64; 2], f64)| {
            [p, q].iter().all(|w| {
                let sizes = (x * w[0]).abs() + (y * w[1]).abs() + far;
                x * w[0] + y * w[1] - far >= TEST_ERROR * sizes
            })
        };
        if sides.iter().any(is_beyond) {
            return true;
        }
        // The vector along the edge is that of the scaled numbers themselves, not that of the differences.
        let along = [0, 1].map(|k| units.scaled(k, edge[1][k]) - units.scaled(k, edge[0][k]));
        // The line of an edge that is shorter has no sides: products with it vanish, and so do the errors.
        if along.iter().all(|x| x.abs() < ALONG_MIN) {
            return false;
        }
        let turn = |[x, y]: [f64; 2]| {
            let corner = [x * ax - y * r * ay - p[0], x * ay + y * r * ax - p[1]];
            let size = |k: usize| p[k].abs() + ax.abs() + ay.abs() + along[k].abs();
            let sizes = along[0].abs() * size(1) + along[1].abs() * size(0);
            let value = along[0] * corner[1] - along[1] * corner[0];
            (value, TEST_ERROR * sizes)
        };
        let turns = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]].map(turn);
        turns.iter().all(|(value, error)| value >= error)
            || turns.iter().all(|(value, error)| -value >= *error)
    }
}
