//! One row as a point, a ball or an ellipsoid {m + v : vvᵀ ⪯ S}.
//!
//! *Trap.* Rounding the entries of a singular S to numbers of u makes some of its eigenvalues negative, and no v has
//! vvᵀ ⪯ S then. With D the diagonal of S, what is meant is taken to be {m + v : vvᵀ ⪯ S + 2τD} for the τ that
//! [`Item::deficit`] finds: a few u where the entries are right to the last digit. Nothing else is added to any item.

use taut_points::ScalarKind;

use super::frame::{Frame, power_of_two_below};
use crate::arithmetic::{DoubleDouble, Field, U, factorise};
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

    /// A τ such that S + τD is positive semidefinite, D being the diagonal of S: 0 where S is known to be.
    ///
    /// Rows and columns are brought to sizes of about 1 by powers of two, S′ = PSP and D′ = PDP. The pivots of
    /// S′ + (τ − e)D′ being positive proves the claim, as factorising is off by less than e·D′. The τ found is at most
    /// four times the least and 16du more, so that who knows eigenvalues in plain `f64` need not find it exactly.
    pub(crate) fn deficit(&self) -> f64 {
        let Item::Ellipsoid(center, shape) = self else { return 0.0 };
        let dim = center.len();
        let width = |j: usize| shape[j * (j + 3) / 2].sqrt();
        let wide: Vec<usize> = (0..dim).filter(|&j| width(j) > 0.0).collect();
        let n = wide.len();
        let mut lower = Vec::with_capacity(n * (n + 1) / 2);
        for (a, &j) in wide.iter().enumerate() {
            for &k in &wide[..=a] {
                let (j, k, entry) =
                    (j.max(k), j.min(k), shape[j.max(k) * (j.max(k) + 1) / 2 + j.min(k)]);
                lower.push(entry / power_of_two_below(width(j)) / power_of_two_below(width(k)));
            }
        }
        if is_semidefinite_by::<f64>(&lower, n, 0.0)
            || is_semidefinite_by::<DoubleDouble>(&lower, n, 0.0)
        {
            return 0.0;
        }
        let mut tau = U / 8.0;
        while !is_semidefinite_by::<DoubleDouble>(&lower, n, tau) {
            tau *= 2.0;
            if tau > 1.0 {
                return f64::INFINITY;
            }
        }
        2.0 * tau + 16.0 * n as f64 * U
    }

    /// Refuses negative radii, and shapes with negative eigenvalues beyond what rounding of entries of this kind explains.
    pub(crate) fn is_valid(&self, row: u64, kind: ScalarKind) -> Result<(), Violation> {
        match self {
            Item::Ball(_, value) if *value < 0.0 => {
                Err(Violation::NegativeRadius { row, value: *value })
            }
            Item::Ellipsoid(center, shape) if !is_semidefinite(shape, center.len(), kind) => {
                Err(Violation::NegativeShape { row })
            }
            _ => Ok(()),
        }
    }
}

/// Whether the pivots of S + (τ − e)D are positive, for a lower triangle with diagonal entries in [1, 4].
fn is_semidefinite_by<N: Field>(lower: &[f64], n: usize, tau: f64) -> bool {
    // Twice the bound of `factorise` for a trace of 4n(1 + τ), and what forming the diagonal costs.
    let e = 64.0 * ((n + 4) * (n + 4)) as f64 * N::ROUNDOFF;
    let mut matrix: Vec<N> = lower.iter().map(|&v| N::of(v)).collect();
    for j in 0..n {
        let at = j * (j + 3) / 2;
        let added = N::of(tau).minus(&N::of(e)).times(&matrix[at]);
        matrix[at] = matrix[at].plus(&added);
    }
    factorise(&mut matrix, n)
}

/// Whether S is positive semidefinite but for rounding: with D the diagonal of S, whether D^−½SD^−½ + τI is, where
/// τ = 32(d + 8)²u is more than any rounding of `f64` entries and of the factorisation comes to. Entries of `f32` are off by
/// 2⁻²⁴ of themselves, and so are those of the diagonal: 2d·2⁻²⁴ in norm, and twice that is granted.
fn is_semidefinite(shape: &[f64], dim: usize, kind: ScalarKind) -> bool {
    let width = |j: usize| shape[j * (j + 3) / 2].sqrt();
    let of_entries = match kind {
        ScalarKind::F32 => 4.0 * dim as f64 * f64::from(f32::EPSILON / 2.0),
        ScalarKind::F64 => 0.0,
    };
    let tau = 32.0 * ((dim + 8) * (dim + 8)) as f64 * U + of_entries;
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
            assert!(is_semidefinite(&good, 2, ScalarKind::F64), "{good:?}");
        }
        // Rounding a third three times leaves a determinant of −1e-17 or so.
        assert!(is_semidefinite(&[1.0 / 3.0, 0.1, 0.03], 2, ScalarKind::F64));
        // One unit in the last place of an `f32` is a slip there, and more than rounding of an `f64`.
        let slipped = [1.0, f64::from(1.0f32 + f32::EPSILON), 1.0];
        assert!(is_semidefinite(&slipped, 2, ScalarKind::F32));
        assert!(!is_semidefinite(&slipped, 2, ScalarKind::F64));
        for bad in [[1.0, 1.001, 1.0], [-1.0, 0.0, 1.0], [0.0, 1e-9, 1.0], [0.0, 0.0, -1e-9]] {
            assert!(!is_semidefinite(&bad, 2, ScalarKind::F32), "{bad:?}");
        }
    }

    /// Of a matrix of two rows and correlation 1 + τ, τ is the least that helps.
    #[test]
    fn the_deficit_is_that_of_the_least_eigenvalue() {
        for (shape, tau) in [
            ([1.0, 0.5, 1.0], 0.0),
            ([1e300, 0.0, 1e-300], 0.0),
            ([0.0, 0.0, 3.0], 0.0),
            ([1.0, 1.0 + 1e-9, 1.0], 1e-9),
            ([4e200, 2.0 * (1.0 + 3e-12), 1e-200], 3e-12),
        ] {
            let found = Item::Ellipsoid(&[0.0, 0.0], &shape).deficit();
            assert!(found >= tau && found <= 4.1 * tau, "{shape:?}: {found}");
        }
        // Singular to the last bit, which no factorisation in rounded numbers shows.
        assert!(Item::Ellipsoid(&[0.0, 0.0], &[4.0, 2.0, 1.0]).deficit() <= 33.0 * U);
    }
}
