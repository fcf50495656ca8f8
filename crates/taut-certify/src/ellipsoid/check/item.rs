//! One row as a point, a ball or an ellipsoid {m + v : vvᵀ ⪯ S}.

use super::frame::Frame;
use crate::arithmetic::{Field, U, factorise};
use crate::{Items, Violation};

/// One row.
pub(crate) enum Item<'a> {
    Point(&'a [f64]),
    /// Centre and radius: S = r²I.
    Ball(&'a [f64], f64),
    /// Centre and the lower triangle of S, row by row.
    Ellipsoid(&'a [f64], &'a [f64]),
}

impl<'a> Item<'a> {
    pub(crate) fn of(items: Items, dim: usize, row: &'a [f64]) -> Self {
        let (center, shape) = row.split_at(dim);
        match items {
            Items::Points => Item::Point(center),
            Items::Balls => Item::Ball(center, shape[0]),
            Items::Ellipsoids => Item::Ellipsoid(center, shape),
        }
    }

    pub(crate) fn center(&self) -> &'a [f64] {
        match self {
            Item::Point(center) | Item::Ball(center, _) | Item::Ellipsoid(center, _) => center,
        }
    }

    /// Whether S = 0.
    pub(crate) fn is_point(&self) -> bool {
        match self {
            Item::Point(_) => true,
            Item::Ball(_, radius) => *radius == 0.0,
            Item::Ellipsoid(_, shape) => shape.iter().all(|&v| v == 0.0),
        }
    }

    /// Entry (j, k) of S·s², for j ≥ k.
    #[inline(always)]
    pub(crate) fn shape<N: Field>(&self, j: usize, k: usize, scale: f64) -> N {
        match self {
            Item::Ball(_, radius) if j == k => {
                let radius = N::of(radius * scale);
                radius.times(&radius)
            }
            Item::Ellipsoid(_, shape) => {
                N::of(shape[j * (j + 1) / 2 + k]).scaled(scale).scaled(scale)
            }
            Item::Point(_) | Item::Ball(..) => N::of(0.0),
        }
    }

    /// √Sⱼⱼ·s: how far the item reaches from its own centre along axis j. Rounded up.
    pub(crate) fn width(&self, j: usize, scale: f64) -> f64 {
        let width = match self {
            Item::Point(_) => 0.0,
            Item::Ball(_, radius) => *radius,
            Item::Ellipsoid(_, shape) => shape[j * (j + 3) / 2].sqrt(),
        };
        width * scale * (1.0 + 4.0 * U)
    }

    /// How far the item reaches from the centre of the frame, by coordinate, times s; rounded up.
    pub(crate) fn extents(&self, frame: &Frame<'_>) -> Vec<f64> {
        let offset = frame.offset::<f64>(self.center());
        let reach =
            |(j, x): (usize, &f64)| (x.abs() + self.width(j, frame.scale)) * (1.0 + 8.0 * U);
        offset.iter().enumerate().map(reach).collect()
    }

    /// Refuses negative radii, and shapes with negative eigenvalues beyond what rounding explains.
    pub(crate) fn is_valid(&self, row: u64) -> Result<(), Violation> {
        match self {
            Item::Ball(_, value) if *value < 0.0 => {
                Err(Violation::NegativeRadius { row, value: *value })
            }
            Item::Ellipsoid(center, shape) if !is_semidefinite(shape, center.len()) => {
                Err(Violation::NegativeShape { row })
            }
            _ => Ok(()),
        }
    }
}

/// Whether S is positive semidefinite but for rounding: with D the diagonal of S, whether D^−½SD^−½ + τI is, where
/// τ = 32(d + 8)²u is more than any rounding of the entries and of the factorisation comes to.
fn is_semidefinite(shape: &[f64], dim: usize) -> bool {
    let width = |j: usize| shape[j * (j + 3) / 2].sqrt();
    let tau = 32.0 * ((dim + 8) * (dim + 8)) as f64 * U;
    let mut correlations = Vec::with_capacity(shape.len());
    for j in 0..dim {
        for k in 0..=j {
            let value = shape[j * (j + 1) / 2 + k];
            let correlation = match (width(j), width(k)) {
                (wj, wk) if wj.is_nan() || wk.is_nan() => return false,
                (wj, wk) if wj == 0.0 || wk == 0.0 => {
                    if value != 0.0 {
                        return false;
                    }
                    0.0
                }
                (wj, wk) => value / wj / wk,
            };
            correlations.push(if j == k { 1.0 + tau } else { correlation });
        }
    }
    factorise(&mut correlations, dim)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_with_negative_eigenvalues_are_refused_and_flat_ones_are_not() {
        for good in [
            [1.0, 0.0, 1.0],
            [1.0, 1.0, 1.0],
            [0.0, 0.0, 0.0],
            [4.0, -2.0, 1.0],
            [1e300, 0.0, 1e-300],
        ] {
            assert!(is_semidefinite(&good, 2), "{good:?}");
        }
        // Rounding a third three times leaves a determinant of −1e-17 or so.
        assert!(is_semidefinite(&[1.0 / 3.0, 0.1, 0.03], 2));
        for bad in [[1.0, 1.001, 1.0], [-1.0, 0.0, 1.0], [0.0, 1e-9, 1.0], [0.0, 0.0, -1e-9]] {
            assert!(!is_semidefinite(&bad, 2), "{bad:?}");
        }
    }
}
