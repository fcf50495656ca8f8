//! What goals of the minimum enclosing ball ask for.

use taut_certify::Stop;

use crate::prelude::*;

pub(super) const BUDGET_STOPS: &str = "runs that a budget stopped";
pub(super) const READS: &str = "plain reads of the same memory in the time taken";
pub(super) const FASTER: &str = "time of the fastest peer over ours";
pub(super) const SHARE: &str = "our time over that of each peer";
pub(super) const UNEXPLAINED: &str =
    "answers outside our certified bracket and not shown to be wrong";
pub(super) const OF_CAT: &str = "speed of each pass over that of cat";

/// No budget was used up.
pub(super) const CONVERGED: Goal = Goal::at_most(BUDGET_STOPS, 0.0, Unit::Plain);

/// The median time is at most so many plain reads of the same memory.
pub(super) const fn reads(bound: f64) -> Goal {
    Goal::at_most(READS, bound, Unit::Times)
}

/// At least so many times faster than the fastest of these peers.
pub(super) const fn faster(peers: &'static [&'static str], bound: f64) -> Goal {
    Goal::at_least(FASTER, bound, Unit::Times).beside(peers)
}

/// At most this share of the time of each of these peers.
pub(super) const fn share(peers: &'static [&'static str], bound: f64) -> Goal {
    Goal::at_most(SHARE, bound, Unit::Times).beside(peers)
}

/// Each of these peers gave the ball we proved, or what is wrong with its own is shown.
pub(super) const fn judged(peers: &'static [&'static str]) -> Goal {
    Goal::at_most(UNEXPLAINED, 0.0, Unit::Plain).beside(peers)
}

/// Each pass runs at least at this share of the speed of `cat`.
pub(super) const fn share_of_cat(bound: f64) -> Goal {
    Goal::at_least(OF_CAT, bound, Unit::Times)
}

/// Whether a budget stopped a run, as a goal asks for it.
pub(super) fn stops(stop: Stop) -> (f64, String) {
    (f64::from(u8::from(stop != Stop::Converged)), format!("{stop:?}").to_lowercase())
}
