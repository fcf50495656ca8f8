//! What goals of k centers ask for.

use crate::prelude::*;

/// The radii that cases name are known to so many digits.
const KNOWN_RADIUS_TOLERANCE: f64 = 1e-6;
/// Rounding in a factor, which a maximum may meet exactly.
const FACTOR_ROUNDING: f64 = 1e-9;

pub(super) const CORE_SET: &str = "rows in the certificate";
pub(super) const CHECK: &str = "time of the check";
pub(super) const DIFFERS: &str = "relative difference of radii to the peer's";
pub(super) const BANDWIDTH: &str = "share of the bandwidth bound, a plain read for each center";
pub(super) const FACTOR: &str = "radius over lower bound, over the factor stated";

/// The radius is this.
pub(super) const fn radius(value: f64) -> Goal {
    Goal::radius(value, KNOWN_RADIUS_TOLERANCE)
}

/// The core-set of the certificate has at most so many rows.
pub(super) const fn core_set(bound: u32) -> Goal {
    Goal::at_most(CORE_SET, bound as f64, Unit::Plain)
}

/// The checker takes at most so long.
pub(super) const fn check(bound: f64) -> Goal {
    Goal::at_most(CHECK, bound, Unit::Seconds)
}

/// Radii are those of the peer, relatively to this.
pub(super) const fn equal(bound: f64) -> Goal {
    Goal::at_most(DIFFERS, bound, Unit::Power)
}

/// Whole passes, one for each center, would take at least this share of the time when nothing but memory bound them.
pub(super) const fn bandwidth(bound: f64) -> Goal {
    Goal::at_least(BANDWIDTH, bound, Unit::Times)
}

/// The radius is at most the stated factor of the lower bound.
pub(super) const FACTOR_GOAL: Goal = Goal::at_most(FACTOR, 1.0 + FACTOR_ROUNDING, Unit::Times);
