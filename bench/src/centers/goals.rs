//! What goals of k centres ask for.

use crate::goals::{self, GAP, Goal, RADIUS, SECONDS, Unit, range};
use crate::stats::{Summary, seconds, times};

/// The radii that cases name are known to so many digits.
const KNOWN_RADIUS_TOLERANCE: f64 = 1e-6;
/// Rounding in a factor, which a maximum may meet exactly.
const FACTOR_ROUNDING: f64 = 1e-9;

const CORE_SET: &str = "rows in the certificate";
const CHECK: &str = "time of the check";
const DIFFERS: &str = "relative difference of radii to the peer's";
const BANDWIDTH: &str = "share of the bandwidth bound, a plain read for each centre";
const FACTOR: &str = "radius over lower bound, over the factor stated";

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

/// Whole passes, one for each centre, would take at least this share of the time when nothing but memory bound them.
pub(super) const fn bandwidth(bound: f64) -> Goal {
    Goal::at_least(BANDWIDTH, bound, Unit::Times)
}

/// The radius is at most the stated factor of the lower bound.
pub(super) const FACTOR_GOAL: Goal = Goal::at_most(FACTOR, 1.0 + FACTOR_ROUNDING, Unit::Times);

/// What was measured, as far as goals ask for it: of several inputs the worst.
#[derive(Clone, Debug, Default)]
pub(super) struct Measured {
    /// Why the checker rejected an answer, if it did one.
    pub(super) rejected: Option<String>,
    /// Proved gap, the largest.
    pub(super) gap: Option<f64>,
    /// Smallest and largest radius.
    pub(super) radii: Option<[f64; 2]>,
    /// Time by the clock, with the last number of threads.
    pub(super) clock: Option<Summary>,
    /// Rows in the largest core-set.
    pub(super) core_set: Option<usize>,
    /// Time of the checker by the clock.
    pub(super) check: Option<Summary>,
    /// How far a radius is off the peer's, relatively.
    pub(super) differs: Option<f64>,
    /// The time of one plain pass for each centre over the time taken: the least.
    pub(super) bandwidth: Option<f64>,
    /// The measured factor over the stated one: the largest.
    pub(super) factor: Option<f64>,
}

impl goals::Measured for Measured {
    fn rejected(&self) -> Option<&str> {
        self.rejected.as_deref()
    }

    fn read(&self, goal: &Goal) -> Option<(f64, String)> {
        let power = |value: f64| (value, format!("{value:.1e}"));
        let ratio = |value: f64| (value, times(value));
        match goal.what {
            GAP => self.gap.map(power),
            // The one that is farther off, where one is: NaN is.
            RADIUS => self.radii.map(|[least, most]| {
                let is_near = |radius| goal.is_met_by(radius);
                let radius = if is_near(most) { least } else { most };
                (radius, format!("{radius:.8}"))
            }),
            SECONDS => self.clock.map(|time| (time.median, range(time, seconds))),
            CORE_SET => self.core_set.map(|rows| (rows as f64, rows.to_string())),
            CHECK => self.check.map(|time| (time.median, range(time, seconds))),
            DIFFERS => self.differs.map(power),
            BANDWIDTH => self.bandwidth.map(ratio),
            FACTOR => self.factor.map(ratio),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn goals_are_met_up_to_their_bound_and_no_further() {
        let found = Measured {
            gap: Some(1e-6),
            radii: Some([9.999995, 10.0]),
            clock: Summary::of(&[1.0, 2.0, 30.0]),
            core_set: Some(200),
            check: Summary::of(&[0.5]),
            bandwidth: Some(0.7),
            differs: Some(f64::NAN),
            factor: Some(1.0),
            ..Measured::default()
        };
        let met = |goal: Goal| goal.judge(&found).2;
        for (goal, other) in [
            (Goal::gap(1e-6), Goal::gap(1e-7)),
            (radius(10.0), radius(10.0001)),
            (Goal::seconds(2.0), Goal::seconds(1.9)),
            (core_set(200), core_set(199)),
            (check(0.5), check(0.4)),
            (bandwidth(0.7), bandwidth(0.8)),
            (FACTOR_GOAL, equal(1.0)),
        ] {
            assert_eq!((met(goal), met(other)), (Some(true), Some(false)), "{goal:?}");
        }
        assert_eq!(Goal::gap(1.0).judge(&Measured::default()).2, None);
    }

    #[test]
    fn a_rejected_answer_meets_nothing() {
        let rejected = Some("outside".to_owned());
        let found = Measured { rejected, clock: Summary::of(&[1e-6]), ..Measured::default() };
        assert_eq!(Goal::seconds(1.0).judge(&found).2, Some(false));
    }
}
