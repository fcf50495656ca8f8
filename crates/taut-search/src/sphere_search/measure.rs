//! Distances as keys that can be compared: squares, squares of any size, and distances less the radii of balls.
//!
//! *Problem.* Squares are the fastest keys, but the square of 10¹⁵⁵ is infinite and that of 10⁻¹⁶³ is zero.
//! *Idea.* A search is written once over [`Measure`]. [`Squares`] serves coordinates whose squares neither overflow nor lose
//! digits ([`is_plain`]); [`WideSquares`] keeps an exponent of its own beside each sum and serves all others; [`Surfaces`] turns
//! either into distances to the surfaces of balls.
//! *Guarantee.* Both squares are ((x² + y²) + z²) + … of differences in `f64`, with the rounding of an unbounded exponent: they
//! order rows alike. Rounding is monotone, so the key of a box is never above that of a point in it.
//! *Trap.* Fused multiplication would round once less for some instruction sets; nothing here is fused.

use std::fmt::Debug;

use taut_points::{exponent_of, times_two_to, two_to};

/// Relative slack of a bound that comes from a ball, above its few roundings.
pub(super) const BALL_SLACK: f64 = 1.0 + 1.0 / (1u64 << 40) as f64;

/// How distances are compared.
pub(super) trait Measure: Copy + Send + Sync + 'static {
    /// Ordered as distances are.
    type Key: Copy + PartialOrd + Send + Sync + Debug;
    /// Below every key.
    const BELOW_ALL: Self::Key;
    /// At least every key.
    const ABOVE_ALL: Self::Key;

    /// The keys of `L` vectors; `differences(axis, scale)` returns one coordinate of each, times `scale`.
    fn keys<const L: usize>(
        dim: usize,
        differences: impl Fn(usize, f64) -> [f64; L],
    ) -> [Self::Key; L];

    /// Adds lengths to the distances, where rows have radii.
    fn lengthen<const L: usize>(
        keys: [Self::Key; L],
        lengths: impl Fn(usize) -> f64,
    ) -> [Self::Key; L];

    /// The distance, infinite beyond the largest `f64`.
    fn distance(key: Self::Key) -> f64;

    /// The key of a distance that is rounded up.
    fn key_above(distance: f64) -> Self::Key;

    /// A key that is at most that of a vector with such a coordinate, which is not negative.
    fn key_along(coordinate: f64) -> Self::Key;

    /// Tests whether the distance of a key is at most `reach`, or above it by less than the slack of a bound.
    fn is_reached(key: Self::Key, reach: f64) -> bool;

    /// Returns what [`Measure::is_within`] compares keys with.
    fn limit(distance: f64) -> f64;

    /// Tests whether the distance of `key`, as calculated, is at most the one of `limit`.
    fn is_within(key: Self::Key, limit: f64) -> bool;

    /// A bit for each lane that [`Measure::is_within`] may pass, once its distance is shortened by a length: all that it does pass,
    /// and hardly others. Of [`Squares`], and of their surfaces, it takes no roots.
    #[inline(always)]
    fn lanes_near<const L: usize>(
        dim: usize,
        differences: impl Fn(usize, f64) -> [f64; L],
        _lengths: impl Fn(usize) -> f64,
        limit: f64,
    ) -> u32 {
        let keys = Self::keys(dim, differences);
        let mut near = 0;
        for lane in 0..L {
            near |= u32::from(Self::is_within(keys[lane], limit)) << lane;
        }
        near
    }
}

/// Tests whether the squares of differences of such coordinates are neither infinite nor inexact beyond rounding: each is zero, or
/// between 2⁻⁴⁰⁰ and 2⁵⁰⁰, so that a difference is zero or more than 2⁻⁴⁵³.
pub(super) fn is_plain(coordinates: &[f64]) -> bool {
    let plain = |x: &f64| x.abs() >= two_to(-400) && x.abs() <= two_to(500) || *x == 0.0;
    coordinates.iter().all(plain)
}

/// Squared distances.
#[derive(Clone, Copy)]
pub(super) struct Squares;

impl Measure for Squares {
    type Key = f64;
    const BELOW_ALL: f64 = -1.0;
    const ABOVE_ALL: f64 = f64::INFINITY;

    #[inline(always)]
    fn keys<const L: usize>(dim: usize, differences: impl Fn(usize, f64) -> [f64; L]) -> [f64; L] {
        let mut sums = [0.0; L];
        for axis in 0..dim {
            let differences = differences(axis, 1.0);
            for lane in 0..L {
                sums[lane] += differences[lane] * differences[lane];
            }
        }
        sums
    }

    #[inline(always)]
    fn lengthen<const L: usize>(keys: [f64; L], _: impl Fn(usize) -> f64) -> [f64; L] {
        keys
    }

    #[inline(always)]
    fn distance(key: f64) -> f64 {
        key.sqrt()
    }

    #[inline(always)]
    fn key_above(distance: f64) -> f64 {
        distance * distance * BALL_SLACK
    }

    #[inline(always)]
    fn key_along(coordinate: f64) -> f64 {
        coordinate * coordinate
    }

    #[inline(always)]
    fn is_reached(key: f64, reach: f64) -> bool {
        key <= Squares::key_above(reach)
    }

    /// The largest square whose root is at most the distance.
    fn limit(distance: f64) -> f64 {
        if distance < 0.0 {
            return -1.0;
        }
        let mut square = distance * distance;
        while square.sqrt() > distance {
            square = square.next_down();
        }
        while square < f64::MAX && square.next_up().sqrt() <= distance {
            square = square.next_up();
        }
        square
    }

    #[inline(always)]
    fn is_within(key: f64, limit: f64) -> bool {
        key <= limit
    }
}

/// A squared distance of any size: `sum`·4^`exponent`, with the sum in [1, 4) or 0.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub(super) struct WideSquare {
    exponent: i32,
    sum: f64,
}

/// Squared distances of any size.
#[derive(Clone, Copy)]
pub(super) struct WideSquares;

impl WideSquares {
    fn key<const L: usize>(
        dim: usize,
        lane: usize,
        differences: &impl Fn(usize, f64) -> [f64; L],
    ) -> WideSquare {
        let largest = |scale: f64| {
            (0..dim).fold(0.0f64, |most, axis| most.max(differences(axis, scale)[lane].abs()))
        };
        let (mut scale, mut most) = (1.0, largest(1.0));
        let mut exponent = 0;
        if most == f64::INFINITY {
            (scale, exponent) = (0.25, 2);
            most = largest(scale);
        }
        if most == 0.0 {
            return WideSquare { exponent: i32::MIN, sum: 0.0 };
        }
        // Of the largest difference.
        let own = exponent_of(most);
        let sum = (0..dim).fold(0.0, |sum, axis| {
            let unit = times_two_to(differences(axis, scale)[lane], -own);
            sum + unit * unit
        });
        exponent += own;
        // Powers of 4 alone are taken out: the sum of the squares of units is at least 1.
        let fours = exponent_of(sum) / 2;
        WideSquare { exponent: exponent + fours, sum: sum * two_to(-2 * fours) }
    }
}

impl Measure for WideSquares {
    type Key = WideSquare;
    const BELOW_ALL: WideSquare = WideSquare { exponent: i32::MIN, sum: -1.0 };
    const ABOVE_ALL: WideSquare = WideSquare { exponent: i32::MAX, sum: f64::INFINITY };

    fn keys<const L: usize>(
        dim: usize,
        differences: impl Fn(usize, f64) -> [f64; L],
    ) -> [WideSquare; L] {
        std::array::from_fn(|lane| WideSquares::key(dim, lane, &differences))
    }

    fn lengthen<const L: usize>(
        keys: [WideSquare; L],
        _: impl Fn(usize) -> f64,
    ) -> [WideSquare; L] {
        keys
    }

    fn distance(key: WideSquare) -> f64 {
        if key.sum == 0.0 { 0.0 } else { times_two_to(key.sum.sqrt(), key.exponent) }
    }

    fn key_above(_: f64) -> WideSquare {
        // Balls do not bound these: their boxes do.
        WideSquares::ABOVE_ALL
    }

    fn key_along(_: f64) -> WideSquare {
        WideSquare { exponent: i32::MIN, sum: 0.0 }
    }

    fn is_reached(key: WideSquare, reach: f64) -> bool {
        WideSquares::distance(key) <= reach
    }

    fn limit(distance: f64) -> f64 {
        distance
    }

    fn is_within(key: WideSquare, limit: f64) -> bool {
        WideSquares::distance(key) <= limit
    }
}

/// Distances with the radii of balls added or taken away.
#[derive(Clone, Copy)]
pub(super) struct Surfaces<M>(std::marker::PhantomData<M>);

impl<M: Measure> Measure for Surfaces<M> {
    type Key = f64;
    const BELOW_ALL: f64 = f64::NEG_INFINITY;
    const ABOVE_ALL: f64 = f64::INFINITY;

    #[inline(always)]
    fn keys<const L: usize>(dim: usize, differences: impl Fn(usize, f64) -> [f64; L]) -> [f64; L] {
        let keys = M::keys(dim, differences);
        let mut distances = [0.0; L];
        for lane in 0..L {
            distances[lane] = M::distance(keys[lane]);
        }
        distances
    }

    #[inline(always)]
    fn lengthen<const L: usize>(mut keys: [f64; L], lengths: impl Fn(usize) -> f64) -> [f64; L] {
        for (lane, key) in keys.iter_mut().enumerate() {
            *key += lengths(lane);
        }
        keys
    }

    #[inline(always)]
    fn distance(key: f64) -> f64 {
        key
    }

    #[inline(always)]
    fn key_above(distance: f64) -> f64 {
        distance * BALL_SLACK
    }

    #[inline(always)]
    fn key_along(coordinate: f64) -> f64 {
        M::distance(M::key_along(coordinate))
    }

    #[inline(always)]
    fn is_reached(key: f64, reach: f64) -> bool {
        key <= reach
    }

    fn limit(distance: f64) -> f64 {
        distance
    }

    #[inline(always)]
    fn is_within(key: f64, limit: f64) -> bool {
        key <= limit
    }

    #[inline(always)]
    fn lanes_near<const L: usize>(
        dim: usize,
        differences: impl Fn(usize, f64) -> [f64; L],
        lengths: impl Fn(usize) -> f64,
        limit: f64,
    ) -> u32 {
        let keys = M::keys(dim, differences);
        let mut near = 0;
        for lane in 0..L {
            let length = lengths(lane);
            // Beyond the roundings of both sums; not a number for a limit of −∞, which nothing is within.
            let reach = (limit + length) + (limit.abs() + length) * (BALL_SLACK - 1.0);
            near |= u32::from((reach >= 0.0) & M::is_reached(keys[lane], reach)) << lane;
        }
        near
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(p: &[f64], q: &[f64]) -> WideSquare {
        WideSquares::keys(p.len(), |axis, scale| [p[axis] * scale - q[axis] * scale])[0]
    }

    #[test]
    fn wide_squares_are_squares_where_these_are_plain() {
        let values = [0.0, 1.0, -3.5, 0.1, 1e-100, -1e100, 7e30, 2.0, 1.9999999999999998];
        for &a in &values {
            for &b in &values {
                for &c in &values {
                    let plain = Squares::keys(3, |axis, _| [[a - b, b - c, c - a][axis]])[0];
                    let wide = square(&[a, b, c], &[b, c, a]);
                    assert_eq!(wide.sum * 4f64.powi(wide.exponent.max(-600)), plain);
                    assert_eq!(WideSquares::distance(wide), plain.sqrt());
                }
            }
        }
    }

    #[test]
    fn wide_squares_have_the_order_of_distances_of_any_size() {
        let sizes = [0.0, 5e-324, 1e-310, 1e-300, 3e-162, 1e-9, 1.0, 1e9, 1e155, 1e300, f64::MAX];
        let squares = sizes.map(|x| square(&[x, x / 2.0], &[0.0, 0.0]));
        assert!(squares.is_sorted_by(|a, b| a < b), "{squares:?}");
        assert!(square(&[f64::MAX], &[-f64::MAX]) > square(&[f64::MAX], &[0.0]));
        assert_eq!(WideSquares::distance(square(&[f64::MAX], &[-f64::MAX])), f64::INFINITY);
        assert_eq!(WideSquares::distance(square(&[5e-324], &[0.0])), 5e-324);
        assert_eq!(WideSquares::distance(square(&[3e-310, 4e-310], &[0.0; 2])), 5e-310);
    }

    #[test]
    fn a_limit_is_the_last_square_within() {
        for distance in [0.0, 1.0, 0.1, 3.0, 1e-100, 1e100, 1.0 / 3.0, 1e200, f64::INFINITY] {
            let limit = Squares::limit(distance);
            assert!(limit.sqrt() <= distance);
            assert!(limit >= f64::MAX || limit.next_up().sqrt() > distance, "{distance}");
        }
        assert!(!Squares::is_within(0.0, Squares::limit(-1e-300)));
    }
}
