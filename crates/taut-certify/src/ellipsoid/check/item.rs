//! One row as a point, a ball or an ellipsoid {m + v : vvᵀ ⪯ S}.
//!
//! *Trap.* Rounding the entries of a singular S makes some of its eigenvalues negative, and no v has vvᵀ ⪯ S then. With D
//! the diagonal of S, such a row stands for {m + v : vvᵀ ⪯ S + 2τD}, where τ is the least of the powers 2⁻⁵⁶, 2⁻⁵⁵, … with
//! S + τD positive semidefinite, as factorizing in doubled precision finds it. Enclosure and lower bound both take this one
//! shape: two shapes would prove two answers that exclude each other.

use taut_points::ScalarKind;

use super::frame::{Frame, power_of_two_below};
use crate::arithmetic::{DoubleDouble, Field, U, factorize};
use crate::{Items, Violation};

/// One row.
pub(crate) enum Item<'a> {
    Point(&'a [f64]),
    /// Center and radius: S = r²I.
    Ball(&'a [f64], f64),
    Ellipsoid(Shape<'a>),
}

/// An ellipsoid {m + v : vvᵀ ⪯ S + 2τD}.
pub(crate) struct Shape<'a> {
    center: &'a [f64],
    /// The lower triangle of S, row by row.
    lower: &'a [f64],
    /// 2τ: 0 where S is known to be positive semidefinite, infinite where no τ ≤ 1 makes it so.
    thickening: f64,
}

impl<'a> Item<'a> {
    pub(crate) fn of(items: Items, dim: usize, row: &'a [f64]) -> Self {
        let (center, shape) = row.split_at(dim);
        match items {
            Items::Points => Item::Point(center),
            Items::Balls => Item::Ball(center, shape[0]),
            Items::Ellipsoids => {
                let thickening = thickening(shape, dim);
                Item::Ellipsoid(Shape { center, lower: shape, thickening })
            }
        }
    }

    pub(crate) fn center(&self) -> &'a [f64] {
        match self {
            Item::Point(center) | Item::Ball(center, _) => center,
            Item::Ellipsoid(shape) => shape.center,
        }
    }

    /// Returns true if S = 0.
    pub(crate) fn is_point(&self) -> bool {
        match self {
            Item::Point(_) => true,
            Item::Ball(_, radius) => *radius == 0.0,
            Item::Ellipsoid(shape) => shape.lower.iter().all(|&v| v == 0.0),
        }
    }

    /// Entry (j, k) of S + 2τD times two powers of two, for j ≥ k.
    #[inline(always)]
    pub(crate) fn shape<N: Field>(&self, j: usize, k: usize, [first, second]: [f64; 2]) -> N {
        match self {
            Item::Ball(_, radius) if j == k => N::of(radius * first).times(&N::of(radius * second)),
            Item::Ellipsoid(shape) => {
                let entry = N::of(shape.lower[j * (j + 1) / 2 + k]).scaled(first).scaled(second);
                match j == k && shape.thickening > 0.0 {
                    true => entry.plus(&N::of(shape.thickening).times(&entry)),
                    false => entry,
                }
            }
            Item::Point(_) | Item::Ball(..) => N::of(0.0),
        }
    }

    /// √((1 + 2τ)Sⱼⱼ)·s: how far the item reaches from its own center along axis j. Rounded up.
    pub(crate) fn width(&self, j: usize, scale: f64) -> f64 {
        let width = match self {
            Item::Point(_) => 0.0,
            Item::Ball(_, radius) => *radius,
            Item::Ellipsoid(shape) => {
                (shape.lower[j * (j + 3) / 2] * (1.0 + shape.thickening)).sqrt()
            }
        };
        width * scale * (1.0 + 8.0 * U)
    }

    /// Returns how far the item reaches from the center of the frame, by coordinate, times s; rounded up.
    pub(crate) fn extents(&self, frame: &Frame<'_>) -> Vec<f64> {
        let offset = frame.offset::<f64>(self.center());
        let reach =
            |(j, x): (usize, &f64)| (x.abs() + self.width(j, frame.scale)) * (1.0 + 8.0 * U);
        offset.iter().enumerate().map(reach).collect()
    }

    /// Refuses negative radii, and shapes with negative eigenvalues beyond what rounding of entries of this kind explains.
    pub(crate) fn is_valid(&self, row: u64, kind: ScalarKind) -> Result<(), Violation> {
        match self {
            Item::Ball(_, value) if *value < 0.0 => {
                Err(Violation::NegativeRadius { row, value: *value })
            }
            Item::Ellipsoid(Shape { thickening: 0.0, .. }) => Ok(()),
            Item::Ellipsoid(shape) => {
                let is_valid = shape.thickening.is_finite()
                    && is_semidefinite(shape.lower, shape.center.len(), kind);
                if is_valid { Ok(()) } else { Err(Violation::NegativeShape { row }) }
            }
            _ => Ok(()),
        }
    }
}

/// 2τ for the lower triangle of S, row by row.
///
/// Rows and columns are brought to sizes of about 1 by powers of two, S′ = PSP and D′ = PDP. The pivots of S′ + (τ − e)D′
/// being positive proves that S + τD is positive semidefinite, as factorizing is off by less than e·D′.
fn thickening(shape: &[f64], dim: usize) -> f64 {
    let diagonal = |j: usize| shape[j * (j + 3) / 2];
    let wide: Vec<usize> = (0..dim).filter(|&j| diagonal(j) > 0.0).collect();
    let zeros = (0..dim).filter(|&j| diagonal(j) <= 0.0);
    // Beside a diagonal entry of 0 nothing else may stand in its row and column, and none may be negative.
    let has_other =
        |j: usize| (0..dim).any(|k| shape[j.max(k) * (j.max(k) + 1) / 2 + j.min(k)] != 0.0);
    if zeros.into_iter().any(has_other) {
        return f64::INFINITY;
    }
    let powers: Vec<f64> = wide.iter().map(|&j| power_of_two_below(diagonal(j).sqrt())).collect();
    let n = wide.len();
    let mut lower = Vec::with_capacity(n * (n + 1) / 2);
    for (a, &j) in wide.iter().enumerate() {
        for (b, &k) in wide[..=a].iter().enumerate() {
            lower.push(shape[j * (j + 1) / 2 + k] / powers[a] / powers[b]);
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
    2.0 * tau
}

/// Returns true if the pivots of S + (τ − e)D are positive, for a lower triangle with diagonal entries in [1, 4].
fn is_semidefinite_by<N: Field>(lower: &[f64], n: usize, tau: f64) -> bool {
    // Twice the bound of `factorize` for a trace of 4n(1 + τ), and what forming the diagonal costs.
    let e = 64.0 * ((n + 4) * (n + 4)) as f64 * N::ROUNDOFF;
    let mut matrix: Vec<N> = lower.iter().map(|&v| N::of(v)).collect();
    for j in 0..n {
        let at = j * (j + 3) / 2;
        let added = N::of(tau).minus(&N::of(e)).times(&matrix[at]);
        matrix[at] = matrix[at].plus(&added);
    }
    factorize(&mut matrix, n)
}

/// Tests whether S is positive semidefinite but for rounding: with D the diagonal of S, whether D^−½SD^−½ + τI is, where
/// τ = 32(d + 8)²u is more than any rounding of `f64` entries and of the factorization comes to. Entries of `f32` are off by
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
    factorize(&mut correlations, dim)
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

    /// For a matrix of two rows and correlation 1 + δ, the least τ that helps is δ.
    #[test]
    fn the_thickening_is_that_of_the_least_eigenvalue() {
        for (shape, least) in [
            ([1.0, 0.5, 1.0], 0.0),
            ([1e300, 0.0, 1e-300], 0.0),
            ([0.0, 0.0, 3.0], 0.0),
            ([1.0, 1.0 + 1e-9, 1.0], 1e-9),
            ([4e200, 2.0 * (1.0 + 3e-12), 1e-200], 3e-12),
        ] {
            let found = thickening(&shape, 2);
            assert!(found >= 2.0 * least && found <= 4.0 * least, "{shape:?}: {found}");
        }
        // Singular to the last bit, which no factorization in rounded numbers shows.
        assert_eq!(thickening(&[4.0, 2.0, 1.0], 2), U / 4.0);
        for bad in [[-1.0, 0.0, 1.0], [0.0, 1e-9, 1.0], [0.0, 0.0, -1e-9]] {
            assert_eq!(thickening(&bad, 2), f64::INFINITY, "{bad:?}");
        }
    }
}
