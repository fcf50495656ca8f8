//! The largest excess of the areas of a cell over a bound.
//!
//! *Bound.* Where (s₀ + s₂)(s₁ + s₃) − U(1 + m²) plus terms that are not negative is below 0, the area is below U. For each m the sum is
//! linear in each offset alone, so that it is largest where offsets are ends of their ranges; there it is a polynomial of degree 2
//! in m.
//! *Rounding.* Terms have up to four products of at most 9 in size for a weight of 1, and at most 16 of them are added. Together with
//! errors of heights these are off by less than 2⁻⁴¹ times the sum of 1 and all weights.

use super::cell::{Cell, height_parts, largest};

/// Bound of the errors for a weight of 1: 2⁻⁴¹.
const TERM_ERROR: f64 = f64::from_bits((1023 - 41) << 52);

/// Most conditions of a leaf, as [`TERM_ERROR`] supposes.
pub(super) const PARTS_MAX: usize = 16;

/// A polynomial c₀ + c₁m + c₂m² + Σ (αₖ + βₖm)sₖ: conditions with weights.
#[derive(Default)]
pub(super) struct Terms {
    constant: [f64; 3],
    of_side: [[f64; 2]; 4],
    weights: f64,
}

impl Terms {
    /// Adds that a point is not below a side.
    pub(super) fn add_point(&mut self, side: usize, w: [f64; 2], weight: f64) {
        let [constant, linear] = height_parts(side, w);
        self.constant[0] += weight * constant;
        self.constant[1] += weight * linear;
        self.of_side[side][0] -= weight;
        self.weights += weight;
    }

    /// Adds that the corner between a side and the next one is in a half-plane n·p ≤ h.
    pub(super) fn add_corner(&mut self, side: usize, normal: [f64; 2], offset: f64, weight: f64) {
        // With p = (sₖuₖ + sₖ₊₁uₖ₊₁)/(1 + m²).
        self.constant[0] += weight * offset;
        self.constant[2] += weight * offset;
        for side in [side, (side + 1) % 4] {
            let [constant, linear] = height_parts(side, normal);
            self.of_side[side][0] -= weight * constant;
            self.of_side[side][1] -= weight * linear;
        }
        self.weights += weight;
    }

    /// Whether no rectangle of a cell that obeys the conditions has more than an area.
    pub(super) fn bound(&self, cell: &Cell, area: f64) -> bool {
        let excess = (0..16).map(|corner: usize| {
            let s = [0, 1, 2, 3].map(|k| cell.offsets[k][corner >> k & 1]);
            let mut sum = self.constant;
            sum[0] += (s[0] + s[2]) * (s[1] + s[3]) - area;
            sum[2] -= area;
            for (s, [constant, linear]) in s.into_iter().zip(self.of_side) {
                sum[0] += constant * s;
                sum[1] += linear * s;
            }
            largest(sum, cell.slopes)
        });
        // All have to be below: NaN is not.
        excess.into_iter().all(|most| most + TERM_ERROR * (1.0 + self.weights) <= 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_bounds_a_side() {
        // Squares |x|, |y| ≤ s with s in [1, 2] and no slope, and a point at x = 1.5: s₀ ≤ 1.5.
        let cell = Cell { offsets: [[1.0, 2.0]; 4], slopes: [-1e-9, 1e-9] };
        assert!(Terms::default().bound(&cell, 16.1) && !Terms::default().bound(&cell, 15.9));
        let mut terms = Terms::default();
        terms.add_point(0, [1.5, 0.0], 4.0);
        assert!(terms.bound(&cell, 14.1) && !terms.bound(&cell, 13.9));
        let mut terms = Terms::default();
        terms.add_corner(0, [1.0, 1.0], 3.0, 4.0);
        // At s₀ = s₁ = 1, where 3·3 has (s₀ + s₁ − 3)·4 = −4 subtracted.
        assert!(terms.bound(&cell, 13.1) && !terms.bound(&cell, 12.9));
    }
}
