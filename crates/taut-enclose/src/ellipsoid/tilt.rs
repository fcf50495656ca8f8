//! Bounds the difference between F(x − c) and the image of the projection of x to the hull of a flat set.
//!
//! The claim about a flat set is about projections to its hull. Rounding makes the rows of F lean out of the hull, and items lie
//! off it by what counts as flat: the difference is at most |F(I − B′B)| times the distance of x from the hull. Where an axis
//! inside the hull is short, F has large entries, and this is more than the rounding of an image.

use taut_certify::Hull;
use taut_kernels::DoubleDouble;
use taut_kernels::vector::dot;

pub(super) struct Tilt {
    /// The root of Σ|(I − B′B)f|² over the rows f of F.
    lean: f64,
    /// The largest distance of an item from the hull.
    distance: f64,
    /// The part of an offset, or of the square of a width, that rounding can show as distance from the hull; that of the checker.
    rounding: f64,
}

impl Tilt {
    pub(super) fn new(factor: &[f64], hull: Option<&Hull>) -> Self {
        let Some(hull) = hull.filter(|hull| !hull.basis.is_empty()) else {
            return Tilt { lean: 0.0, distance: 0.0, rounding: 0.0 };
        };
        let dim = hull.basis[0].len();
        let leans: Vec<f64> =
            factor.chunks_exact(dim).map(|row| off_hull(&hull.basis, row)).collect();
        let rank = hull.basis.len() as f64;
        let rounding = 16.0 * (dim + 4) as f64 * (rank + 1.0).sqrt() * f64::EPSILON;
        Tilt { lean: dot(&leans, &leans).sqrt(), distance: hull.distance, rounding }
    }

    /// Bounds the difference for the points of an item whose center is this far from that of the ellipsoid and whose width is this; both are
    /// summed over the coordinates.
    pub(super) fn error(&self, offset: f64, width: f64) -> f64 {
        if self.lean == 0.0 {
            return 0.0;
        }
        // Once for the offset of the point, once for the reach of the item.
        let off =
            2.0 * (self.distance + self.rounding * (offset + width) + self.rounding.sqrt() * width);
        self.lean * off
    }
}

/// |(I − B′B)f| of a row.
fn off_hull(basis: &[Vec<f64>], row: &[f64]) -> f64 {
    let mut rest: Vec<DoubleDouble> = row.iter().map(|&v| v.into()).collect();
    for direction in basis {
        let product = direction
            .iter()
            .zip(row)
            .fold(DoubleDouble::ZERO, |sum, (&b, &f)| sum + DoubleDouble::product(b, f));
        for (rest, &b) in rest.iter_mut().zip(direction) {
            *rest = *rest - product * b.into();
        }
    }
    rest.iter().map(|v| v.high * v.high).sum::<f64>().sqrt()
}
