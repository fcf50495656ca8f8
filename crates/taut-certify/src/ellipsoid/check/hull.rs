//! The affine hull of a rank-deficient set: orthonormal, spanning the rows of the factor, and no farther from any item
//! than stated.
//!
//! *Tolerances.* With u = 2⁻⁵³: an orthonormal basis written down as `f64` has products BBᵀ that differ from I by less
//! than 16(d + 4)u; a point of such a hull then appears to lie off it by up to 32(d + 4)√(r + 1)·u times its distance
//! from c, and so do the rows of F. The width of a flat ellipsoid is a root, so that of this part it is the root.
//! *What counts as flat.* A set whose distance from the hull is less than 1e-10 of its extent (for ellipsoids 1e-6, since a
//! shape matrix knows half as many digits of a short axis, and 1e-3·√d in single precision, where a row may stand for a
//! shape thicker by √(16d·2⁻²⁴)), or could come from rounding its coordinates. Rounding moves
//! coordinate j by u·|xⱼ|, and so a point off the hull by u·|xⱼ|·|(I − BᵀB)eⱼ|, and that of a point of the basis is seen
//! several times larger at others: 128√d·u·√Σⱼ(max |xⱼ|·|(I − BᵀB)eⱼ|)² is granted. A large coordinate along the hull
//! excuses nothing.

use taut_points::ScalarKind;

use super::super::Hull;
use super::enclosure::Enclosed;
use super::frame::{Frame, span_rounding};
use super::item::Item;
use crate::arithmetic::{Compensated, Known, U};
use crate::{Items, Violation};

/// One hull, ready to be compared with items.
pub(crate) struct HullTest<'a> {
    hull: &'a Hull,
    /// 32(d + 4)√(r + 1)·u.
    rounding: f64,
}

impl<'a> HullTest<'a> {
    pub(crate) fn of(frame: &Frame<'_>, hull: &'a Hull) -> Self {
        HullTest { hull, rounding: span_rounding(frame.dim, frame.rank) }
    }

    /// Tests whether the basis is orthonormal and spans the rows of the factor.
    pub(crate) fn check(&self, frame: &Frame<'_>) -> Result<(), Violation> {
        let basis = &self.hull.basis;
        let tolerance = 16.0 * (frame.dim + 4) as f64 * U;
        for (i, row) in basis.iter().enumerate() {
            for (j, other) in basis[..=i].iter().enumerate() {
                let mut sum = Compensated::default();
                row.iter().zip(other).for_each(|(&a, &b)| sum.add_product(a, b));
                sum.add(if i == j { -1.0 } else { 0.0 });
                let Known { high, .. } = sum.known();
                let is_orthonormal = high.abs() <= tolerance;
                if !is_orthonormal {
                    return Err(Violation::Basis { first: j, second: i, off: high });
                }
            }
        }
        for row in 0..frame.rank {
            let factor = frame.full_row(row);
            let off = length(&self.off(factor));
            let is_spanned = off <= self.rounding * length(factor);
            if !is_spanned {
                return Err(Violation::Span { row, off: off / length(factor) });
            }
        }
        Ok(())
    }

    /// (I − BᵀB)x.
    pub(crate) fn off(&self, x: &[f64]) -> Vec<f64> {
        let mut rest = x.to_vec();
        for row in &self.hull.basis {
            let along: f64 = row.iter().zip(x).map(|(b, x)| b * x).sum();
            rest.iter_mut().zip(row).for_each(|(rest, b)| *rest -= along * b);
        }
        rest
    }

    /// Checks that the item is as near to the hull as it must be; returns how far off it is at most.
    ///
    /// The distance as plain arithmetic finds it may exceed the stated one by rounding, and be off by as much again.
    pub(super) fn judge(
        &self,
        row: u64,
        item: &Item<'_>,
        frame: &Frame<'_>,
    ) -> Result<f64, Violation> {
        let offset = frame.offset::<f64>(item.center());
        let (mut distance, mut tolerance) = (length(&self.off(&offset)), length(&offset));
        if !item.is_point() {
            distance += self.thickness(item, frame);
            let widths: Vec<f64> = (0..frame.dim).map(|j| item.width(j, frame.scale)).collect();
            tolerance += length(&widths) / self.rounding.sqrt();
        }
        let allowed = self.hull.distance * frame.scale + self.rounding * tolerance;
        // Where either overflows nothing is known of how far the item lies off.
        let is_near = distance <= allowed && allowed.is_finite();
        if is_near {
            let proved = (distance + 2.0 * self.rounding * tolerance) * (1.0 + 16.0 * U);
            return Ok((proved / frame.scale).next_up());
        }
        let (distance, claimed) = (distance / frame.scale, self.hull.distance);
        Err(Violation::OffHull { row, distance, claimed })
    }

    /// Returns true if a point is farther off the hull than stated, whatever rounding does.
    pub(super) fn is_off(&self, point: &[f64], frame: &Frame<'_>) -> bool {
        let offset = frame.offset::<f64>(point);
        let (distance, reach) = (length(&self.off(&offset)), length(&offset));
        distance > self.hull.distance * frame.scale + self.rounding * reach && distance.is_finite()
    }

    /// Returns true if a point lies within the stated distance of the hull, as plain arithmetic finds it, whatever its size.
    pub(crate) fn is_within(&self, point: &[f64], frame: &Frame<'_>) -> bool {
        let (offset, k) = frame.small_offset(point);
        let allowed = self.hull.distance * 2f64.powi(-(k / 2)) * 2f64.powi(-(k - k / 2));
        length(&self.off(&offset)) <= allowed
    }

    /// The root of the trace of (I − BᵀB)S(I − BᵀB), times s: how far the item reaches off its own center at most.
    fn thickness(&self, item: &Item<'_>, frame: &Frame<'_>) -> f64 {
        let dim = frame.dim;
        let entry = |j: usize, k: usize| item.shape::<f64>(j.max(k), j.min(k), [frame.scale; 2]);
        let columns: Vec<Vec<f64>> = (0..dim)
            .map(|k| self.off(&(0..dim).map(|j| entry(j, k)).collect::<Vec<_>>()))
            .collect();
        let trace: f64 = (0..dim)
            .map(|j| self.off(&columns.iter().map(|column| column[j]).collect::<Vec<_>>())[j])
            .sum();
        if trace.is_nan() { f64::INFINITY } else { trace.max(0.0).sqrt() }
    }

    /// Tests whether the set is flat enough to be called so.
    pub(super) fn is_flat(
        &self,
        items: Items,
        kind: ScalarKind,
        enclosed: &Enclosed,
    ) -> Result<(), Violation> {
        let extents: Vec<f64> =
            enclosed.lows.iter().zip(&enclosed.highs).map(|(l, h)| 0.5 * h - 0.5 * l).collect();
        let largest: Vec<f64> =
            enclosed.lows.iter().zip(&enclosed.highs).map(|(l, h)| l.abs().max(h.abs())).collect();
        let part = match (items, kind) {
            (Items::Ellipsoids, ScalarKind::F64) => 1e-6,
            (Items::Ellipsoids, ScalarKind::F32) => 1e-3 * (extents.len() as f64).sqrt(),
            _ => 1e-10,
        };
        // A quarter of the extents has a length where that of the extents itself overflows.
        let quarters: Vec<f64> = extents.iter().map(|x| 0.25 * x).collect();
        self.is_thin(4.0 * part * length(&quarters) + self.rounding_of(&largest))
    }

    /// As [`HullTest::is_flat`] for points that were picked because they lie near a hull of others: these reach up to
    /// `wider` times as far off it.
    pub(crate) fn is_flat_for(
        &self,
        extents: &[f64],
        largest: &[f64],
        wider: f64,
    ) -> Result<(), Violation> {
        self.is_thin(wider * (1e-10 * length(extents) + self.rounding_of(largest)))
    }

    /// Returns what rounding explains for points whose coordinates are at most these: of each column what is seen of it off the
    /// hull.
    fn rounding_of(&self, largest: &[f64]) -> f64 {
        let dim = largest.len();
        let seen = |j: usize| {
            let mut unit = vec![0.0; dim];
            unit[j] = 1.0;
            largest[j] * length(&self.off(&unit))
        };
        128.0 * (dim as f64).sqrt() * U * length(&(0..dim).map(seen).collect::<Vec<_>>())
    }

    fn is_thin(&self, allowed: f64) -> Result<(), Violation> {
        // A set whose extent is beyond the largest number is not known to be flat.
        match self.hull.distance <= allowed && allowed.is_finite() {
            true => Ok(()),
            false => Err(Violation::NotFlat { distance: self.hull.distance, allowed }),
        }
    }
}

/// The length of a vector, whatever its size; NaN if an entry is.
pub(crate) fn length(x: &[f64]) -> f64 {
    if x.iter().any(|v| v.is_nan()) {
        return f64::NAN;
    }
    let largest = x.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    if largest == 0.0 || largest.is_infinite() {
        return largest;
    }
    largest * x.iter().map(|v| (v / largest).powi(2)).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_entry_is_dropped_from_a_length() {
        assert_eq!(length(&[3e300, 0.0, -4e300]), 5e300);
        assert_eq!(length(&[f64::NEG_INFINITY, 1.0]), f64::INFINITY);
        assert!(length(&[1.0, f64::NAN]).is_nan() && length(&[f64::NAN, f64::INFINITY]).is_nan());
    }
}
