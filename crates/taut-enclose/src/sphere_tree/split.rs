//! Points in two sets, so that the larger of their two balls is small.
//!
//! *Idea.* Two points far apart, found by going twice to the farthest; every point goes with the nearer of them. Then, as in
//! Lloyd's method, the balls of both sets, and every point to the nearer center, as long as the larger ball shrinks.
//! *Guarantee.* Neither set is empty. The first two sets have at most twice the radius of the best ones.
//! *Trap.* Sizes of all kinds meet in one tree: distances are taken in units of the ball at hand.

use taut_certify::Ball;
use taut_points::{Points, Scalar, exponent_of, two_to};

use crate::{BallOptions, Error, ball};

/// Most times that centers are moved; few sets ask for more than five.
const MOVES_MAX: usize = 8;
/// A ball that only says which of two sets is nearer need not be exact.
const EPSILON: f64 = 1e-4;

/// For each point whether it is in the first of two sets, neither of them empty; none if no two points can be told apart.
/// `enclosing` is the smallest ball around all.
pub(super) fn two_centers<T: Scalar>(
    points: &Points<'_, T>,
    enclosing: &Ball,
) -> Result<Option<Vec<bool>>, Error> {
    let units = Units::of(enclosing.radius);
    let first = units.farthest(points, &enclosing.center);
    let first = wide(points.row(first));
    let second = wide(points.row(units.farthest(points, &first)));
    let mut sides = units.sides(points, &first, &second);
    if sides.iter().all(|&side| side) {
        return Ok(None);
    }
    let mut balls = balls_of(points, &sides)?;
    for _ in 0..MOVES_MAX {
        let moved = units.sides(points, &balls[0].center, &balls[1].center);
        if moved == sides || moved.iter().all(|&side| side == moved[0]) {
            break;
        }
        let smaller = balls_of(points, &moved)?;
        if larger(&smaller) >= larger(&balls) {
            break;
        }
        (sides, balls) = (moved, smaller);
    }
    Ok(Some(sides))
}

fn larger(balls: &[Ball; 2]) -> f64 {
    balls[0].radius.max(balls[1].radius)
}

fn wide<T: Scalar>(row: &[T]) -> Vec<f64> {
    row.iter().map(|&v| v.into()).collect()
}

/// The balls around both sets.
fn balls_of<T: Scalar>(points: &Points<'_, T>, sides: &[bool]) -> Result<[Ball; 2], Error> {
    let of = |side: bool| {
        let rows = points.rows().zip(sides).filter(|&(_, &s)| s == side);
        let values: Vec<T> = rows.flat_map(|(row, _)| row).copied().collect();
        let points = Points::new(&values, points.dim()).expect("the rows are whole");
        let options = BallOptions { epsilon: EPSILON, ..BallOptions::default() };
        ball(&points, &options).map(|found| found.answer)
    };
    Ok([of(true)?, of(false)?])
}

/// The units of a ball: distances within it come to about 1.
#[derive(Clone, Copy)]
struct Units {
    /// ½ where differences may overflow.
    before: f64,
    after: f64,
}

impl Units {
    fn of(radius: f64) -> Self {
        let before = if radius > f64::MAX / 8.0 { 0.5 } else { 1.0 };
        Units { before, after: two_to((-exponent_of(radius)).clamp(-1000, 1000)) }
    }

    fn square<T: Scalar>(self, row: &[T], center: &[f64]) -> f64 {
        let Units { before, after } = self;
        row.iter()
            .zip(center)
            .map(|(&x, c)| ((x.into() * before - c * before) * after).powi(2))
            .sum()
    }

    /// The row farthest from `center`, the first of several.
    fn farthest<T: Scalar>(self, points: &Points<'_, T>, center: &[f64]) -> usize {
        let mut farthest = (0, -1.0);
        for (i, row) in points.rows().enumerate() {
            let square = self.square(row, center);
            if square > farthest.1 {
                farthest = (i, square);
            }
        }
        farthest.0
    }

    /// Tests whether each point is as near to `first` as to `second`.
    fn sides<T: Scalar>(self, points: &Points<'_, T>, first: &[f64], second: &[f64]) -> Vec<bool> {
        points.rows().map(|row| self.square(row, first) <= self.square(row, second)).collect()
    }
}
