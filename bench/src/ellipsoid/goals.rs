//! What goals of ellipsoids ask for.

use crate::prelude::*;

pub(super) const OUTSIDE: &str = "log-volume outside the known bracket";
pub(super) const FASTER: &str = "time of the peer over ours";
pub(super) const OBJECTIVE: &str = "what is minimized, less what the peer reached";
pub(super) const OTHER_FLAGS: &str = "sets with other flagged rows than published";
pub(super) const OTHER_THAN_PEER: &str =
    "sets with other rows weighed out than the peer's, for the same h";
pub(super) const DIFFERS: &str = "relative difference to the peer";

/// Rounding in what is minimized, below which two answers are equally good.
const OBJECTIVE_ROUNDING: f64 = 1e-11;

/// The log-volume lies at most so far outside the bracket that is known.
pub(super) const fn bracket(bound: f64) -> Goal {
    Goal::at_most(OUTSIDE, bound, Unit::Power)
}

/// At least so many times faster than the peer by the clock, least over least.
pub(super) const fn faster(bound: f64) -> Goal {
    Goal::at_least(FASTER, bound, Unit::Times)
}

/// Radius or volume is that of the peer, relatively to this.
pub(super) const fn agreement(bound: f64) -> Goal {
    Goal::at_most(DIFFERS, bound, Unit::Power)
}

/// What is minimized is at most that of the peer, to rounding.
pub(super) const OBJECTIVE_GOAL: Goal = Goal::at_most(OBJECTIVE, OBJECTIVE_ROUNDING, Unit::Power);
/// The rows flagged are those of the literature.
pub(super) const FLAGS_GOAL: Goal = Goal::at_most(OTHER_FLAGS, 0.0, Unit::Plain);
/// The rows weighed out are those that the peer weighs out.
pub(super) const PEER_FLAGS_GOAL: Goal = Goal::at_most(OTHER_THAN_PEER, 0.0, Unit::Plain);
