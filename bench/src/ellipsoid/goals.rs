//! What a case has to reach, and whether it did.

use serde_json::{Value, json};

use crate::stats::{seconds, times};

/// One thing for taut to reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Goal {
    /// The gap that the checker proved is at most this.
    Gap(f64),
    /// The log-volume lies at most so far outside the bracket that is known.
    Bracket(f64),
    /// The least time by the clock, with the last number of threads, is at most this, in seconds.
    Seconds(f64),
    /// At least so many times faster than the peer by the clock, least over least.
    Faster(f64),
    /// What is minimised is at most that of the peer, to rounding.
    Objective,
    /// The rows flagged are those of the literature.
    Flags,
    /// The rows weighed out are those that the peer weighs out.
    PeerFlags,
    /// Radius or volume is that of the peer, relatively to this.
    Agreement(f64),
    /// So many reads of all points at most.
    Passes(u64),
    /// Peak memory of the process is at most this, in bytes.
    Memory(u64),
}

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

impl Goal {
    /// The goal in words, what was measured, and whether the goal is met (`None`: not measured).
    fn judge(self, found: &Measured) -> (String, String, Option<bool>) {
        let (goal, measured) = match self {
            Goal::Gap(bound) => (
                format!("gap ≤ {bound:e}"),
                found.gap.map(|gap| (format!("{gap:.1e}, verified"), gap <= bound)),
            ),
            Goal::Bracket(bound) => (
                format!("log-volume in the known bracket to {bound:e}"),
                found.outside.map(|off| (format!("{off:.1e} outside"), off <= bound)),
            ),
            Goal::Seconds(bound) => (
                format!("at most {} by the clock", seconds(bound)),
                found.clock.map(|least| {
                    let shown = |time: Option<f64>| time.map_or("not measured".into(), seconds);
                    let said = format!(
                        "{} (processors: {} of all threads, {} with one thread)",
                        seconds(least),
                        shown(found.processors),
                        shown(found.one_thread),
                    );
                    (said, least <= bound)
                }),
            ),
            Goal::Faster(factor) => (
                format!("at least {factor} times faster than the peer"),
                found.faster.map(|ratio| (times(ratio), ratio >= factor)),
            ),
            Goal::Objective => (
                "what is minimised is no more than the peer's".to_owned(),
                found.objective.map(|more| (format!("{more:+.1e}"), more <= 1e-11)),
            ),
            Goal::Flags => (
                "the rows flagged are those published".to_owned(),
                found.other_flags.as_deref().map(without_others),
            ),
            Goal::PeerFlags => (
                "the rows weighed out are the peer's, for the same h".to_owned(),
                found.other_than_peer.as_deref().map(without_others),
            ),
            Goal::Agreement(bound) => (
                format!("agrees with the peer to {bound:e}"),
                found.differs.map(|off| (format!("{off:.1e}"), off <= bound)),
            ),
            Goal::Passes(bound) => (
                format!("at most {bound} passes"),
                found.passes.map(|passes| (passes.to_string(), passes <= bound)),
            ),
            Goal::Memory(bound) => (
                format!("at most {} MiB of memory", bound >> 20),
                found.peak.map(|peak| (format!("{} MiB", peak >> 20), peak <= bound)),
            ),
        };
        match (&found.rejected, measured) {
            // Nothing is believed of an answer that is wrong.
            (Some(why), _) => (goal, format!("REJECTED by the checker: {why}"), Some(false)),
            (None, Some((said, met))) => (goal, said, Some(met)),
            (None, None) => (goal, "no answer".to_owned(), None),
        }
    }
}

/// Whether there are sets with other rows, in words.
fn without_others(sets: &[String]) -> (String, bool) {
    match sets {
        [] => ("all".to_owned(), true),
        sets => (format!("others for {}", sets.join(", ")), false),
    }
}

/// Prints each goal with what was measured, and returns the same for the report.
pub(super) fn print(must: &[&[Goal]], aim: &[&[Goal]], found: &Measured) -> Value {
    let all = must.iter().copied().flatten().map(|goal| ("must", goal));
    let all = all.chain(aim.iter().copied().flatten().map(|goal| ("aim", goal)));
    let lines = all.map(|(kind, goal)| {
        let (goal, measured, met) = goal.judge(found);
        let word = match met {
            Some(true) => "met",
            Some(false) => "NOT MET",
            None => "not measured",
        };
        println!("- {kind}: {goal}: {measured}: {word}");
        json!({ "kind": kind, "goal": goal, "measured": measured, "met": met })
    });
    lines.collect()
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
        assert_eq!(Goal::Gap(1e-12).judge(&worst).2, Some(false));
        assert_eq!(Goal::Seconds(2.0).judge(&worst).2, Some(true));
        assert_eq!(Goal::Faster(2.0).judge(&worst).2, Some(false));
        assert_eq!(Goal::Passes(3).judge(&worst).2, None);
        let unknown = Measured::worst([of(None, Some(1.0)), of(Some(1e-13), None)]).unwrap();
        assert_eq!((unknown.gap, unknown.clock), (None, None));
        for pair in [[Some(f64::NAN), Some(1.0)], [Some(1.0), Some(f64::NAN)]] {
            let odd = Measured::worst(pair.map(|gap| of(gap, None))).unwrap();
            assert_eq!(Goal::Gap(1.0).judge(&odd).2, Some(false));
        }
    }

    #[test]
    fn a_rejected_answer_meets_nothing() {
        let rejected = Some("outside".to_owned());
        let found = Measured { rejected, clock: Some(1e-6), ..Measured::default() };
        assert_eq!(Goal::Seconds(1.0).judge(&found).2, Some(false));
    }
}
