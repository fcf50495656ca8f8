//! Goals of a case or a section, printed as they are judged and kept for the report.

use serde_json::{Value, json};

use crate::stats::{Summary, seconds, times};

/// Something to reach: a quantity, a direction, a bound and its unit. What must be reached and what is an aim stand in two lists.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Goal {
    /// The quantity, as it is read of what was measured and said in the report.
    pub(crate) what: &'static str,
    pub(crate) direction: Direction,
    pub(crate) bound: f64,
    pub(crate) unit: Unit,
    /// The peers that the quantity compares with.
    pub(crate) peers: &'static [&'static str],
}

/// On which side of its bound a quantity has to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Direction {
    AtMost,
    AtLeast,
    /// The relative difference to this value is at most the bound.
    Near(f64),
}

/// How a bound is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Unit {
    /// A number as it is.
    Plain,
    /// A small number, with a power of ten.
    Power,
    Seconds,
    /// A ratio.
    Times,
    /// Bytes, in MiB.
    Memory,
}

pub(crate) const GAP: &str = "verified gap";
pub(crate) const SECONDS: &str = "time by the clock";
pub(crate) const PASSES: &str = "passes over all points";
pub(crate) const MEMORY: &str = "peak memory of the process";
pub(crate) const RADIUS: &str = "radius";

impl Goal {
    const fn new(what: &'static str, direction: Direction, bound: f64, unit: Unit) -> Self {
        Goal { what, direction, bound, unit, peers: &[] }
    }

    pub(crate) const fn at_most(what: &'static str, bound: f64, unit: Unit) -> Self {
        Goal::new(what, Direction::AtMost, bound, unit)
    }

    pub(crate) const fn at_least(what: &'static str, bound: f64, unit: Unit) -> Self {
        Goal::new(what, Direction::AtLeast, bound, unit)
    }

    pub(crate) const fn gap(bound: f64) -> Self {
        Goal::at_most(GAP, bound, Unit::Power)
    }

    pub(crate) const fn seconds(bound: f64) -> Self {
        Goal::at_most(SECONDS, bound, Unit::Seconds)
    }

    pub(crate) const fn passes(bound: u32) -> Self {
        Goal::at_most(PASSES, bound as f64, Unit::Plain)
    }

    /// At most so many bytes.
    pub(crate) const fn memory(bound: u32) -> Self {
        Goal::at_most(MEMORY, bound as f64, Unit::Memory)
    }

    /// This radius, to a relative tolerance.
    pub(crate) const fn radius(value: f64, tolerance: f64) -> Self {
        Goal::new(RADIUS, Direction::Near(value), tolerance, Unit::Power)
    }

    /// The goal in words.
    fn words(&self) -> String {
        let bound = match self.unit {
            Unit::Plain => self.bound.to_string(),
            Unit::Power => format!("{:e}", self.bound),
            Unit::Seconds => seconds(self.bound),
            Unit::Times => times(self.bound),
            Unit::Memory => format!("{} MiB", self.bound / f64::from(1 << 20)),
        };
        let beside = match self.peers {
            [] => String::new(),
            peers => format!(" (beside {})", peers.join(" and ")),
        };
        let what = self.what;
        match self.direction {
            Direction::AtMost => format!("{what}{beside} at most {bound}"),
            Direction::AtLeast => format!("{what}{beside} at least {bound}"),
            Direction::Near(value) => format!("{what}{beside} {value} to {bound}"),
        }
    }

    /// Whether a value reaches the goal; NaN reaches none.
    pub(crate) fn is_met_by(&self, value: f64) -> bool {
        match self.direction {
            Direction::AtMost => value <= self.bound,
            Direction::AtLeast => value >= self.bound,
            Direction::Near(target) => (value / target - 1.0).abs() <= self.bound,
        }
    }

    /// The goal in words, what was measured, and whether the goal is met (`None`: not measured).
    pub(crate) fn judge(&self, found: &impl Measured) -> (String, String, Option<bool>) {
        match (found.rejected(), found.read(self)) {
            // Nothing is believed of an answer that is wrong.
            (Some(why), _) => {
                (self.words(), format!("REJECTED by the checker: {why}"), Some(false))
            }
            (None, Some((value, said))) => (self.words(), said, Some(self.is_met_by(value))),
            (None, None) => (self.words(), "no answer".to_owned(), None),
        }
    }
}

/// What was measured of a case.
pub(crate) trait Measured {
    /// Why the checker rejected an answer, if it did one.
    fn rejected(&self) -> Option<&str>;

    /// The quantity of a goal, and what to say of it; `None` where it was not measured.
    fn read(&self, goal: &Goal) -> Option<(f64, String)>;
}

/// Median and range of several runs.
pub(crate) fn range(summary: Summary, show: fn(f64) -> String) -> String {
    let Summary { median, min, max, count } = summary;
    format!("{} (range {}–{}, {count} runs)", show(median), show(min), show(max))
}

/// The largest of several values, with all that is said of them; `None` of none.
pub(crate) fn worst_of(all: impl Iterator<Item = (f64, String)>) -> Option<(f64, String)> {
    all.reduce(|(a, first), (b, second)| (a.max(b), format!("{first}; {second}")))
}

/// Prints each goal with what was measured, and returns the same for the report.
pub(crate) fn print(must: &[&[Goal]], aim: &[&[Goal]], found: &impl Measured) -> Value {
    let mut goals = Goals::default();
    for (kind, lists) in [("must", must), ("aim", aim)] {
        for goal in lists.iter().copied().flatten() {
            let (goal, measured, met) = goal.judge(found);
            goals.line(kind, goal, measured, met);
        }
    }
    goals.json()
}

/// The goals of one section.
#[derive(Default)]
pub(crate) struct Goals {
    lines: Vec<Value>,
}

impl Goals {
    /// What has to be reached; `met` is `None` where it was not measured.
    pub(crate) fn must(&mut self, goal: String, measured: String, met: impl Into<Option<bool>>) {
        self.line("must", goal, measured, met.into());
    }

    /// What is hoped for.
    pub(crate) fn aim(&mut self, goal: String, measured: String, met: impl Into<Option<bool>>) {
        self.line("aim", goal, measured, met.into());
    }

    /// A value that must be at most one bound, and is hoped to be at most another.
    pub(crate) fn at_most(
        &mut self,
        what: &str,
        value: Option<f64>,
        (must, aim): (f64, Option<f64>),
        show: impl Fn(f64) -> String,
    ) {
        let measured = value.map_or("not measured".to_owned(), &show);
        // NaN is at most nothing.
        let goal = |bound: f64| format!("{what} at most {}", show(bound));
        self.must(goal(must), measured.clone(), value.map(|value| value <= must));
        if let Some(aim) = aim {
            self.aim(goal(aim), measured, value.map(|value| value <= aim));
        }
    }

    /// A ratio that must be at least one bound, and is hoped to be at least another; NaN was not measured.
    pub(crate) fn at_least(&mut self, what: &str, value: f64, (must, aim): (f64, Option<f64>)) {
        let met = |bound| (!value.is_nan()).then_some(value >= bound);
        let goal = |bound: f64| format!("{what} at least {}", times(bound));
        self.must(goal(must), times(value), met(must));
        if let Some(aim) = aim {
            self.aim(goal(aim), times(value), met(aim));
        }
    }

    fn line(&mut self, kind: &str, goal: String, measured: String, met: Option<bool>) {
        let word = match met {
            Some(true) => "met",
            Some(false) => "NOT MET",
            None => "not measured",
        };
        println!("- {kind}: {goal}: {measured}: {word}");
        self.lines.push(json!({ "kind": kind, "goal": goal, "measured": measured, "met": met }));
    }

    /// For the report.
    pub(crate) fn json(self) -> Value {
        self.lines.into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bound_is_met_up_to_itself_and_not_by_nan() {
        let mut goals = Goals::default();
        goals.at_most("error", Some(2.0), (2.0, Some(1.0)), |v| v.to_string());
        goals.at_most("error", Some(f64::NAN), (2.0, None), |v| v.to_string());
        goals.at_most("error", None, (2.0, None), |v| v.to_string());
        let lines = goals.json();
        let met: Vec<_> = lines.as_array().unwrap().iter().map(|line| &line["met"]).collect();
        assert_eq!(met, [&json!(true), &json!(false), &json!(false), &Value::Null]);
        assert_eq!(lines[1]["goal"], "error at most 1");
    }

    #[test]
    fn a_ratio_is_met_from_its_bound_on() {
        let mut goals = Goals::default();
        goals.at_least("speed", 2.0, (2.0, Some(2.5)));
        goals.at_least("speed", f64::NAN, (2.0, None));
        let lines = goals.json();
        let met: Vec<_> = lines.as_array().unwrap().iter().map(|line| &line["met"]).collect();
        assert_eq!(met, [&json!(true), &json!(false), &Value::Null]);
    }
}
