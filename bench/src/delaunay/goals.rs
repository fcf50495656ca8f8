//! What a case has to reach, and whether it did.

use serde_json::{Value, json};

use super::program::Program;
use super::rounds::Rounds;
use crate::stats::times;

/// One thing for taut to reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Goal {
    /// Processor time of one thread is at most this share of CGAL's.
    OfCgal(f64),
    /// Processor time per point of one thread is at most so many times that for a uniform set of the same size.
    OfUniform(f64),
    /// The peak above the input is at most so many bytes per point, with any number of threads.
    Bytes(f64),
    /// At most this share of predicates gets to an exact stage.
    ExactRate(f64),
    /// The check of the answer takes at most this share of the processor time of the build, with one thread.
    Check(f64),
    /// Two threads are at least so many times faster than one, by the clock, in the median of all rounds.
    Speedup(f64),
}

impl Goal {
    /// The goal in words, what was measured, and whether the goal is met (`None`: not measured).
    fn judge(self, found: &Rounds) -> (String, String, Option<bool>) {
        let one = Program::Taut(1);
        let (goal, measured) = match self {
            Goal::OfCgal(share) => (
                format!("at most {share} of the processor time of CGAL"),
                found.of_cgal(one).map(|(least, range)| {
                    let said = format!(
                        "{} (range {}–{}, {} rounds)",
                        times(least),
                        times(range.min),
                        times(range.max),
                        range.count
                    );
                    (said, least <= share)
                }),
            ),
            Goal::OfUniform(factor) => (
                format!("at most {factor} times a uniform set of this size, per point"),
                found.of_uniform(one).map(|ratio| (times(ratio), ratio <= factor)),
            ),
            Goal::Bytes(bound) => {
                let all = found.threads().into_iter().map(|t| found.bytes(Program::Taut(t)));
                let all: Option<Vec<f64>> = all.collect();
                let most = all.and_then(|all| all.into_iter().max_by(f64::total_cmp));
                (
                    format!("at most {bound} B per point above the input"),
                    most.map(|most| (format!("{most:.1} B"), most <= bound)),
                )
            }
            Goal::ExactRate(bound) => (
                format!("at most {bound:e} of all predicates decided exactly"),
                found.exact(one).map(|share| (format!("{share:.1e}"), share <= bound)),
            ),
            Goal::Check(share) => (
                format!("the check takes at most {share} of the processor time of the build"),
                found.check(one).map(|ratio| (times(ratio), ratio <= share)),
            ),
            Goal::Speedup(factor) => (
                format!("two threads at least {factor} times faster"),
                found.speedup().map(|s| {
                    let said = format!(
                        "{} (range {}–{}, {} rounds)",
                        times(s.median),
                        times(s.min),
                        times(s.max),
                        s.count
                    );
                    (said, s.median >= factor)
                }),
            ),
        };
        let (said, met) = measured.map_or((None, None), |(said, met)| (Some(said), Some(met)));
        (goal, said.unwrap_or("no answer".to_owned()), met)
    }
}

/// Prints each goal with what was measured, and returns the same for the report.
pub(super) fn print(must: &[Goal], aim: &[Goal], found: &Rounds) -> Value {
    let all = must.iter().map(|goal| ("must", goal)).chain(aim.iter().map(|goal| ("aim", goal)));
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
