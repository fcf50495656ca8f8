//! What a case has to reach, and whether it did.

use serde_json::{Value, json};

use crate::stats::{Summary, seconds, times};

/// One thing for taut to reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Goal {
    /// The gap that the checker proved is at most this.
    Gap(f64),
    /// The radius is this to 1e-6, relatively.
    Radius(f64),
    /// The median time by the clock, with the last number of threads, is at most this, in seconds.
    Seconds(f64),
    /// The core-set of the certificate has at most so many rows.
    CoreSet(usize),
    /// The checker takes at most so long.
    Check(f64),
    /// Radii are those of the peer, relatively to this.
    Equal(f64),
    /// Whole passes, one for each centre, would take at least this share of the time when nothing but memory bound them.
    Bandwidth(f64),
    /// The radius is at most the stated factor of the lower bound.
    Factor,
}

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

fn range(summary: Summary) -> String {
    let [median, min, max] = [summary.median, summary.min, summary.max].map(seconds);
    format!("{median} (range {min}–{max}, {} runs)", summary.count)
}

impl Goal {
    /// The goal in words, what was measured, and whether the goal is met (`None`: not measured).
    fn judge(self, found: &Measured) -> (String, String, Option<bool>) {
        let (goal, measured) = match self {
            Goal::Gap(bound) => (
                format!("gap ≤ {bound:e}"),
                found.gap.map(|gap| (format!("{gap:.1e}, verified"), gap <= bound)),
            ),
            Goal::Radius(value) => (
                format!("radius {value} to 1e-6"),
                found.radii.map(|radii| {
                    let off = radii.map(|radius| (radius / value - 1.0).abs());
                    // NaN is within nothing.
                    let met = off.iter().all(|off| *off <= 1e-6);
                    (format!("{:.8}, {:.1e} off", radii[1], off[0].max(off[1])), met)
                }),
            ),
            Goal::Seconds(bound) => (
                format!("at most {} by the clock", seconds(bound)),
                found.clock.map(|time| (range(time), time.median <= bound)),
            ),
            Goal::CoreSet(bound) => (
                format!("at most {bound} rows in the certificate"),
                found.core_set.map(|rows| (rows.to_string(), rows <= bound)),
            ),
            Goal::Check(bound) => (
                format!("checked in at most {}", seconds(bound)),
                found.check.map(|time| (range(time), time.median <= bound)),
            ),
            Goal::Equal(bound) => (
                format!("radii are the peer's to {bound:e}"),
                found.differs.map(|off| (format!("{off:.1e} off"), off <= bound)),
            ),
            Goal::Bandwidth(share) => (
                format!("at least {share} of the bandwidth bound, a plain read for each centre"),
                found.bandwidth.map(|ratio| (times(ratio), ratio >= share)),
            ),
            Goal::Factor => (
                "radius over lower bound at most the factor stated".to_owned(),
                found
                    .factor
                    .map(|ratio| (format!("{} of it at most", times(ratio)), ratio <= 1.0 + 1e-9)),
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

/// Prints each goal with what was measured, and returns the same for the report.
pub(super) fn print(must: &[&[Goal]], aim: &[Goal], found: &Measured) -> Value {
    let all = must.iter().copied().flatten().map(|goal| ("must", goal));
    let all = all.chain(aim.iter().map(|goal| ("aim", goal)));
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
            (Goal::Gap(1e-6), Goal::Gap(1e-7)),
            (Goal::Radius(10.0), Goal::Radius(10.0001)),
            (Goal::Seconds(2.0), Goal::Seconds(1.9)),
            (Goal::CoreSet(200), Goal::CoreSet(199)),
            (Goal::Check(0.5), Goal::Check(0.4)),
            (Goal::Bandwidth(0.7), Goal::Bandwidth(0.8)),
            (Goal::Factor, Goal::Equal(1.0)),
        ] {
            assert_eq!((met(goal), met(other)), (Some(true), Some(false)), "{goal:?}");
        }
        assert_eq!(Goal::Gap(1.0).judge(&Measured::default()).2, None);
    }

    #[test]
    fn a_rejected_answer_meets_nothing() {
        let rejected = Some("outside".to_owned());
        let found = Measured { rejected, clock: Summary::of(&[1e-6]), ..Measured::default() };
        assert_eq!(Goal::Seconds(1.0).judge(&found).2, Some(false));
    }
}
