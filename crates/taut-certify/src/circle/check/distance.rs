//! The distance from a point to an edge, with a bound on its error.
//!
//! *Idea.* Differences of coordinates are exact in double-double, and a product of two of them is right to about 2⁻¹⁰³.
//! *Guarantee.* Coordinates are below 4 in size (see [`crate::polygon`]). With |d| the size of the differences between the point and
//! the edge and |e| the length of the edge, the cross product is off by less than 2⁻⁹⁹·|d|·|e|, and so is the position of the projection
//! along the edge: where rounding decides that the projection is at an end, the distance changes by less than 2⁻⁹⁸·|d|. What underflows
//! is below 2⁻¹⁰⁷⁰ in products; divided by |e| ≥ [`EDGE_MIN`] that is below 2⁻⁶⁶⁰, and a root of it is below 2⁻⁵³⁰. All of
//! this is less than [`ERROR_RELATIVE`]·|d| + [`ERROR_ABSOLUTE`].

use crate::arithmetic::{DoubleDouble, Field, Ring, U};

/// Edges shorter than this are taken for points, with their length as an error: 2⁻⁴⁰⁰.
const EDGE_MIN: f64 = f64::from_bits((1023 - 400) << 52);

/// Bound of the rounding errors relative to the differences of coordinates: 2⁻⁹⁴.
const ERROR_RELATIVE: f64 = f64::from_bits((1023 - 94) << 52);

/// Bound of what underflow and the scaling of coordinates can change: 2⁻⁵⁰⁰.
const ERROR_ABSOLUTE: f64 = f64::from_bits((1023 - 500) << 52);

/// A distance and a bound on its error.
#[derive(Clone, Copy, Debug)]
pub(super) struct Distance {
    value: f64,
    error: f64,
}

/// A number that is not above the distance.
pub(super) fn rounded_down(distance: Distance) -> f64 {
    (distance.value - distance.error) * (1.0 - 8.0 * U)
}

/// A bound of the error of a distance.
pub(super) fn error(distance: Distance) -> f64 {
    distance.error
}

/// A number that is not below the distance.
pub(super) fn rounded_up(distance: Distance) -> f64 {
    (distance.value + distance.error) * (1.0 + 8.0 * U)
}

/// Returns the distance from p to the segment from a to b, all in scaled coordinates.
pub(super) fn distance(p: [f64; 2], [a, b]: [[f64; 2]; 2]) -> Distance {
    let difference = |a: [f64; 2], b: [f64; 2]| {
        [DoubleDouble::difference(a[0], b[0]), DoubleDouble::difference(a[1], b[1])]
    };
    let size = |d: &[DoubleDouble; 2]| d[0].high.abs() + d[1].high.abs();
    let dot =
        |u: &[DoubleDouble; 2], v: &[DoubleDouble; 2]| u[0].times(&v[0]).plus(&u[1].times(&v[1]));
    let (d, e) = (difference(p, a), difference(b, a));
    let error = ERROR_RELATIVE * (size(&d) + size(&e)) + ERROR_ABSOLUTE;
    let to = |d: &[DoubleDouble; 2]| dot(d, d).root().rounded();
    if size(&e) < EDGE_MIN {
        return Distance { value: to(&d), error: error + 2.0 * size(&e) };
    }
    let (along, square) = (dot(&d, &e), dot(&e, &e));
    let value = match () {
        () if along.high <= 0.0 => to(&d),
        () if along.minus(&square).high >= 0.0 => to(&difference(p, b)),
        () => {
            let cross = d[0].times(&e[1]).minus(&d[1].times(&e[0]));
            cross.over(&square.root()).rounded().abs()
        }
    };
    Distance { value, error }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_enclosed() {
        let edge = [[0.0, 0.0], [1.0, 0.0]];
        for (p, expected) in
            [([0.5, 0.25], 0.25), ([-0.375, 0.5], 0.625), ([1.75, -1.0], 1.25), ([0.3, 0.0], 0.0)]
        {
            let found = distance(p, edge);
            assert!(rounded_down(found) <= expected && expected <= rounded_up(found), "{p:?}");
            assert!(rounded_up(found) - rounded_down(found) <= 1e-14, "{p:?}");
        }
    }

    #[test]
    fn a_needle_keeps_its_width() {
        // The distance is 2⁻⁶⁰ beside coordinates of about 1, where plain arithmetic has no digit left.
        let width = f64::from_bits((1023 - 60) << 52);
        let edge = [[-1.0, -1.0], [1.0, 1.0]];
        let found = distance([width, -width], edge);
        let expected = width * std::f64::consts::SQRT_2;
        assert!(rounded_down(found) <= expected && expected <= rounded_up(found));
        // Both differences of coordinates have a size of at most 4.
        let most = 2.0 * 8.0 * ERROR_RELATIVE + 1e-14 * expected;
        assert!(rounded_up(found) - rounded_down(found) <= most && most < 1e-8 * expected);
    }

    #[test]
    fn edges_of_no_length_are_points() {
        let tiny = f64::from_bits(1);
        for edge in [[[0.0, 0.0]; 2], [[0.0, 0.0], [tiny, tiny]]] {
            let found = distance([0.75, 1.0], edge);
            assert!(rounded_down(found) <= 1.25 && 1.25 <= rounded_up(found));
        }
    }
}
