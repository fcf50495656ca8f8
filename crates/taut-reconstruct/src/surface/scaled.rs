//! Points in coordinates of magnitude 1.
//!
//! *Guarantee.* Multiplied by a power of two, which loses nothing that a surface could show: whatever is measured on them does not depend
//! on the unit, and neither products of six lengths nor reciprocals leave the range of numbers.

use taut_points::parallel::ParallelSlice;
use taut_points::{exponent_of, two_to_in_steps};

use super::spheres::Point;

/// A power of two that brings points to magnitude 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scale {
    /// In one step and a step of 1 where it can be, so that what is too small for all its digits is rounded once, to the same number
    /// whatever the unit was; in two where the power is beyond all numbers, as then everything grows and nothing is rounded.
    steps: [f64; 2],
}

impl Scale {
    /// That of finite points.
    pub(super) fn of(points: &[Point]) -> Self {
        let largest = |p: &Point| p.iter().fold(0.0f64, |most, x| most.max(x.abs()));
        let most = points.par_iter().with_min_len(1 << 13).map(largest).reduce(|| 0.0, f64::max);
        Self::by(if most > 0.0 { -exponent_of(most) } else { 0 })
    }

    fn by(exponent: i32) -> Self {
        Self { steps: two_to_in_steps(exponent) }
    }

    pub(super) fn apply(self, point: Point) -> Point {
        point.map(|x| x * self.steps[0] * self.steps[1])
    }

    /// The scale that undoes this one.
    pub(super) fn inverse(self) -> Self {
        Self { steps: self.steps.map(|step| 1.0 / step) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_numbers_are_rounded_alike_in_every_unit() {
        for k in 1..4000u64 {
            let x = f64::from_bits(k * 7919);
            for (down, up) in [(26, 7), (300, 299), (1000, 23), (1023, 0)] {
                let unit = 2f64.powi(up);
                let point = [x, -x, 1e8];
                let there = Scale::by(-down - up).apply(point.map(|x| x * unit));
                if down + up <= 1023 {
                    assert_eq!(Scale::by(-down).apply(point), there);
                }
            }
        }
    }

    #[test]
    fn scaling_there_and_back_changes_nothing() {
        for x in [1.0, 3e300, 7e-320, -0.1] {
            let scale = Scale::of(&[[x, 0.0, 0.0]]);
            let [y, ..] = scale.apply([x, 0.0, 0.0]);
            assert!((1.0..2.0).contains(&y.abs()));
            assert_eq!(scale.inverse().apply([y, 0.0, 0.0])[0], x);
        }
    }
}
