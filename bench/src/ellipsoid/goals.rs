//! What goals of ellipsoids ask for.

use crate::goals::{self, GAP, Goal, MEMORY, PASSES, SECONDS, Unit};
use crate::stats::{seconds, times};

const OUTSIDE: &str = "log-volume outside the known bracket";
const FASTER: &str = "time of the peer over ours";
const OBJECTIVE: &str = "what is minimised, less what the peer reached";
const OTHER_FLAGS: &str = "sets with other flagged rows than published";
const OTHER_THAN_PEER: &str = "sets with other rows weighed out than the peer's, for the same h";
const DIFFERS: &str = "relative difference to the peer";

/// Rounding in what is minimised, below which two answers are equally good.
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

/// What is minimised is at most that of the peer, to rounding.
pub(super) const OBJECTIVE_GOAL: Goal = Goal::at_most(OBJECTIVE, OBJECTIVE_ROUNDING, Unit::Power);
/// The rows flagged are those of the literature.
pub(super) const FLAGS_GOAL: Goal = Goal::at_most(OTHER_FLAGS, 0.0, Unit::Plain);
/// The rows weighed out are those that the peer weighs out.
pub(super) const PEER_FLAGS_GOAL: Goal = Goal::at_most(OTHER_THAN_PEER, 0.0, Unit::Plain);

/// What was measured, as far as goals ask for it: of several sets or seeds the worst.
#[derive(Clone, Debug, Default)]
pub(super) struct Measured {
    /// Why the checker rejected an answer, if it did one.
    pub(super) rejected: Option<String>,
    /// Proved gap.
    pub(super) gap: Option<f64>,
    /// How far the log-volume lies outside the known bracket.
    pub(super) outside: Option<f64>,
    /// Least processor time of all threads, with the last number of them.
    pub(super) processors: Option<f64>,
    /// Least processor time with one thread.
    pub(super) one_thread: Option<f64>,
    /// Least time by the clock, with the last number of threads.
    pub(super) clock: Option<f64>,
    /// The peer's time by the clock over ours, least over least.
    pub(super) faster: Option<f64>,
    /// What we minimised less what the peer reached.
    pub(super) objective: Option<f64>,
    /// Sets with flags other than those of the literature.
    pub(super) other_flags: Option<Vec<String>>,
    /// Sets of which the peer weighs out other rows.
    pub(super) other_than_peer: Option<Vec<String>>,
    /// Relative difference to radius or volume of the peer.
    pub(super) differs: Option<f64>,
    /// Reads of all points.
    pub(super) passes: Option<u64>,
    /// Peak memory, bytes.
    pub(super) peak: Option<u64>,
}

/// The larger of two measurements; one of which nothing is known leaves nothing known. NaN is worse than any number.
fn worse(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    let (a, b) = (a?, b?);
    Some(if a >= b || a.is_nan() { a } else { b })
}

impl Measured {
    /// The worst of several; `None` of none.
    pub(super) fn worst(all: impl IntoIterator<Item = Measured>) -> Option<Measured> {
        all.into_iter().reduce(|a, b| Measured {
            rejected: a.rejected.or(b.rejected),
            gap: worse(a.gap, b.gap),
            outside: worse(a.outside, b.outside),
            processors: worse(a.processors, b.processors),
            one_thread: worse(a.one_thread, b.one_thread),
            clock: worse(a.clock, b.clock),
            faster: a.faster.zip(b.faster).map(|(a, b)| a.min(b)),
            objective: worse(a.objective, b.objective),
            other_flags: a.other_flags.zip(b.other_flags).map(|(a, b)| [a, b].concat()),
            other_than_peer: a.other_than_peer.zip(b.other_than_peer).map(|(a, b)| [a, b].concat()),
            differs: worse(a.differs, b.differs),
            passes: a.passes.max(b.passes),
            peak: a.peak.max(b.peak),
        })
    }
}

impl goals::Measured for Measured {
    fn rejected(&self) -> Option<&str> {
        self.rejected.as_deref()
    }

    fn read(&self, goal: &Goal) -> Option<(f64, String)> {
        let said = |value: Option<f64>, show: &dyn Fn(f64) -> String| {
            value.map(|value| (value, show(value)))
        };
        let power = |value: f64| format!("{value:.1e}");
        match goal.what {
            GAP => said(self.gap, &power),
            OUTSIDE => said(self.outside, &power),
            SECONDS => said(self.clock, &|least| {
                let shown = |time: Option<f64>| time.map_or("not measured".into(), seconds);
                format!(
                    "{} (processors: {} of all threads, {} with one thread)",
                    seconds(least),
                    shown(self.processors),
                    shown(self.one_thread),
                )
            }),
            FASTER => said(self.faster, &times),
            OBJECTIVE => said(self.objective, &power),
            OTHER_FLAGS => self.other_flags.as_deref().map(counted),
            OTHER_THAN_PEER => self.other_than_peer.as_deref().map(counted),
            DIFFERS => said(self.differs, &power),
            PASSES => said(self.passes.map(|passes| passes as f64), &|passes| passes.to_string()),
            MEMORY => self.peak.map(|peak| (peak as f64, format!("{} MiB", peak >> 20))),
            _ => None,
        }
    }
}

/// How many sets there are, and which.
fn counted(sets: &[String]) -> (f64, String) {
    let said = if sets.is_empty() { "none".to_owned() } else { sets.join(", ") };
    (sets.len() as f64, said)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_of_several_counts() {
        let of = |gap, time| Measured { gap, clock: time, faster: time, ..Measured::default() };
        let worst = Measured::worst([of(Some(1e-13), Some(2.0)), of(Some(1e-11), Some(1.0))]);
        let worst = worst.unwrap();
        assert_eq!((worst.gap, worst.clock, worst.faster), (Some(1e-11), Some(2.0), Some(1.0)));
        assert_eq!(Goal::gap(1e-12).judge(&worst).2, Some(false));
        assert_eq!(Goal::seconds(2.0).judge(&worst).2, Some(true));
        assert_eq!(faster(2.0).judge(&worst).2, Some(false));
        assert_eq!(Goal::passes(3).judge(&worst).2, None);
        let unknown = Measured::worst([of(None, Some(1.0)), of(Some(1e-13), None)]).unwrap();
        assert_eq!((unknown.gap, unknown.clock), (None, None));
        for pair in [[Some(f64::NAN), Some(1.0)], [Some(1.0), Some(f64::NAN)]] {
            let odd = Measured::worst(pair.map(|gap| of(gap, None))).unwrap();
            assert_eq!(Goal::gap(1.0).judge(&odd).2, Some(false));
        }
    }

    #[test]
    fn a_rejected_answer_meets_nothing() {
        let rejected = Some("outside".to_owned());
        let found = Measured { rejected, clock: Some(1e-6), ..Measured::default() };
        assert_eq!(Goal::seconds(1.0).judge(&found).2, Some(false));
    }
}
