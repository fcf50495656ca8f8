//! What goals of the minimum enclosing ball ask for.

use taut_certify::{Stop, Verdict};

use super::paired::Paired;
use crate::goals::{self, GAP, Goal, MEMORY, PASSES, RADIUS, SECONDS, Unit, range};
use crate::stats::{Summary, seconds, times};

const BUDGET_STOPS: &str = "runs that a budget stopped";
const READS: &str = "plain reads of the same memory in the time taken";
const FASTER: &str = "time of the fastest peer over ours";
const SHARE: &str = "our time over that of each peer";
const UNEXPLAINED: &str = "answers outside our certified bracket and not shown to be wrong";
const OF_CAT: &str = "speed of each pass over that of cat";

/// No budget was used up.
pub(super) const CONVERGED: Goal = Goal::at_most(BUDGET_STOPS, 0.0, Unit::Plain);

/// The median time is at most so many plain reads of the same memory.
pub(super) const fn reads(bound: f64) -> Goal {
    Goal::at_most(READS, bound, Unit::Times)
}

/// At least so many times faster than the fastest of these peers.
pub(super) const fn faster(peers: &'static [&'static str], bound: f64) -> Goal {
    Goal { peers, ..Goal::at_least(FASTER, bound, Unit::Times) }
}

/// At most this share of the time of each of these peers.
pub(super) const fn share(peers: &'static [&'static str], bound: f64) -> Goal {
    Goal { peers, ..Goal::at_most(SHARE, bound, Unit::Times) }
}

/// Each of these peers gave the ball we proved, or what is wrong with its own is shown.
pub(super) const fn judged(peers: &'static [&'static str]) -> Goal {
    Goal { peers, ..Goal::at_most(UNEXPLAINED, 0.0, Unit::Plain) }
}

/// Each pass runs at least at this share of the speed of `cat`.
pub(super) const fn share_of_cat(bound: f64) -> Goal {
    Goal::at_least(OF_CAT, bound, Unit::Times)
}

/// What was measured of one input, as far as goals ask for it.
#[derive(Default)]
pub(super) struct Measured<'a> {
    /// Verified by the checker; `None` when it rejected the answer.
    pub(super) verdict: Option<Verdict>,
    /// Reads of all points.
    pub(super) passes: u64,
    /// Why the solver stopped.
    pub(super) stop: Stop,
    /// Times of taut, and of peers and plain reads beside it.
    pub(super) paired: Option<&'a Paired>,
    /// Peak memory, bytes.
    pub(super) peak: Option<u64>,
    /// Speed of passes over speed of `cat`.
    pub(super) of_cat: Option<Summary>,
}

impl goals::Measured for Measured<'_> {
    fn rejected(&self) -> Option<&str> {
        self.verdict.is_none().then_some("see the table")
    }

    fn read(&self, goal: &Goal) -> Option<(f64, String)> {
        let beside = |summary: Summary, said: String| (summary.median, said);
        match goal.what {
            GAP => self.verdict.map(|v| (v.gap, format!("{:.1e}", v.gap))),
            RADIUS => self.verdict.map(|v| (v.upper, format!("{:.13}", v.upper))),
            BUDGET_STOPS => {
                let stops = f64::from(u8::from(self.stop != Stop::Converged));
                Some((stops, format!("{:?}", self.stop).to_lowercase()))
            }
            PASSES => Some((self.passes as f64, self.passes.to_string())),
            SECONDS => self.paired?.taut_time().map(|s| beside(s, range(s, seconds))),
            READS => self.paired?.reads().map(|s| beside(s, range(s, times))),
            FASTER => {
                let (name, summary, note) = self.paired?.fastest(goal.peers)?;
                let said = format!("{} against {name}{note}", range(summary, times));
                Some(beside(summary, said))
            }
            SHARE => {
                let one = |peer: &&'static str| {
                    let (name, s, note) = self.paired?.fastest(&[peer])?;
                    let said = format!("1 / {} of {name}{note}", range(s, times));
                    Some((1.0 / s.median, said))
                };
                goals::worst_of(goal.peers.iter().filter_map(one))
            }
            UNEXPLAINED => {
                let all = self.paired?.judgements(goal.peers);
                goals::worst_of(all.iter().map(|(name, judged)| (0.0, format!("{name} {judged}"))))
            }
            MEMORY => self.peak.map(|peak| (peak as f64, format!("{} MiB", peak >> 20))),
            OF_CAT => self.of_cat.map(|s| (s.min, format!("slowest: {}", range(s, times)))),
            _ => None,
        }
    }
}
