//! The power of two by which differences are multiplied, so that squares neither over- nor underflow.

/// A multiplication by 2ᵏ and its inverse; k = 0 for radii between 2⁻²⁰⁰ and 2²⁰⁰, whose squares are far from the ends
/// of the range of `f64`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale {
    /// 2ᵏ.
    pub(super) up: f64,
    /// 2⁻ᵏ.
    pub(super) down: f64,
}

impl Scale {
    /// Brings `radius` to [1, 2); to [2, 4) at the very top of the range, where 2⁻¹⁰²³ is not a normal number. Radii
    /// below 2⁻¹⁰⁰⁰ are multiplied by 2¹⁰⁰⁰: that makes them 2⁻⁷⁴ at least and leaves all differences exact. A radius
    /// of 0 is not scaled.
    pub(super) fn of(radius: f64) -> Self {
        let exponent = 1023 - (radius.to_bits() >> 52) as i64;
        if radius == 0.0 || exponent.abs() <= 200 {
            return Scale { up: 1.0, down: 1.0 };
        }
        let exponent = exponent.clamp(-1022, 1000);
        Scale { up: power(exponent), down: power(-exponent) }
    }

    /// Returns true if the factor is not 1.
    pub(super) fn is_needed(self) -> bool {
        self.up != 1.0
    }
}

/// 2ᵏ for −1022 ≤ k ≤ 1023.
fn power(k: i64) -> f64 {
    f64::from_bits(((k + 1023) as u64) << 52)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_far_radius_is_brought_near_one() {
        for radius in [1e62, 1e-62, 1e300, 1e-300, f64::MAX] {
            let scale = Scale::of(radius);
            assert_eq!(scale.up * scale.down, 1.0);
            assert!((1.0..4.0).contains(&(radius * scale.up)), "{radius:e}");
            assert_eq!(radius * scale.up * scale.down, radius);
        }
        let least = f64::from_bits(1);
        assert_eq!(least * Scale::of(least).up, power(-74));
        assert!(!Scale::of(1e60).is_needed() && !Scale::of(0.0).is_needed());
    }
}
