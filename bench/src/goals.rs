//! Goals: a quantity, a direction, a bound and its unit, and what was measured of the quantity.

use std::collections::BTreeMap;

use crate::prelude::*;

/// A bound for a quantity. What must be reached and what is an aim stand in two lists.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Goal {
    /// The quantity, as it is read of what was measured and said in the report.
    pub(crate) what: Quantity,
    pub(crate) direction: Direction,
    pub(crate) bound: f64,
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

/// How a value is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Unit {
    /// A number as it is.
    Plain,
    /// A number with so many digits after the point.
    Fixed(usize),
    /// A small number, with a power of ten.
    Power,
    /// The same with one digit more.
    Error,
    Seconds,
    /// Seconds, in nanoseconds.
    Nanoseconds,
    /// A ratio.
    Times,
    /// A share, in percent.
    Percent,
    /// Bytes, in MiB.
    Memory,
}

impl Unit {
    /// The value in words.
    pub(crate) fn show(self, value: f64) -> String {
        match self {
            Unit::Plain => value.to_string(),
            Unit::Fixed(digits) => format!("{value:.digits$}"),
            Unit::Power => format!("{value:.1e}"),
            Unit::Error => format!("{value:.2e}"),
            Unit::Seconds => seconds(value),
            Unit::Nanoseconds => format!("{:.2} ns", 1e9 * value),
            Unit::Times => times(value),
            Unit::Percent => format!("{:.2} %", 100.0 * value),
            Unit::Memory => format!("{:.1} MiB", value / f64::from(1 << 20)),
        }
    }
}

/// Something that is measured, and how it is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Quantity {
    name: &'static str,
    unit: Unit,
}

pub(crate) const GAP: Quantity = Quantity::new("verified gap", Unit::Power);
pub(crate) const SECONDS: Quantity = Quantity::new("time by the clock", Unit::Seconds);
pub(crate) const PASSES: Quantity = Quantity::new("passes over all points", Unit::Plain);
pub(crate) const MEMORY: Quantity = Quantity::new("peak memory of the process", Unit::Memory);
pub(crate) const RADIUS: Quantity = Quantity::new("radius", Unit::Power);

impl Quantity {
    pub(crate) const fn new(name: &'static str, unit: Unit) -> Self {
        Quantity { name, unit }
    }

    /// The goal that it is at most this.
    pub(crate) const fn at_most(self, bound: f64) -> Goal {
        Goal { what: self, direction: Direction::AtMost, bound, peers: &[] }
    }

    /// The goal that it is at least this.
    pub(crate) const fn at_least(self, bound: f64) -> Goal {
        Goal { what: self, direction: Direction::AtLeast, bound, peers: &[] }
    }

    /// The goal that it is this, to a relative tolerance.
    pub(crate) const fn near(self, value: f64, tolerance: f64) -> Goal {
        Goal { what: self, direction: Direction::Near(value), bound: tolerance, peers: &[] }
    }
}

impl Goal {
    /// The same beside these peers.
    pub(crate) const fn beside(self, peers: &'static [&'static str]) -> Self {
        Goal { peers, ..self }
    }

    /// The goal in words.
    fn words(&self) -> String {
        let bound = match self.what.unit {
            Unit::Power => format!("{:e}", self.bound),
            unit => unit.show(self.bound),
        };
        let beside = match self.peers {
            [] => String::new(),
            peers => format!(" (beside {})", peers.join(" and ")),
        };
        let what = self.what.name;
        match self.direction {
            Direction::AtMost => format!("{what}{beside} at most {bound}"),
            Direction::AtLeast => format!("{what}{beside} at least {bound}"),
            Direction::Near(value) => format!("{what}{beside} {value} to {bound}"),
        }
    }

    /// How far a value is on the wrong side; NaN is farther than any number.
    fn badness(&self, value: f64) -> f64 {
        let badness = match self.direction {
            Direction::AtMost => value,
            Direction::AtLeast => -value,
            Direction::Near(target) => (value / target - 1.0).abs(),
        };
        if badness.is_nan() { f64::INFINITY } else { badness }
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
    pub(crate) fn judge(&self, found: &Found) -> (String, String, Option<bool>) {
        let (measured, met) = match (&found.rejected, found.worst(self)) {
            // Nothing is believed of an answer that is wrong.
            (Some(why), _) => (format!("REJECTED by the checker: {why}"), Some(false)),
            (None, Some((value, said))) => {
                let said = said.clone().unwrap_or_else(|| self.what.unit.show(*value));
                (said, Some(self.is_met_by(*value)))
            }
            (None, None) => ("no answer".to_owned(), None),
        };
        (self.words(), measured, met)
    }
}

/// A value, and what is to be said of it if not the value alone.
type Statement = (f64, Option<String>);

/// What was measured, quantity by quantity. Of several inputs the worst counts.
#[derive(Clone, Debug, Default)]
pub(crate) struct Found {
    rejected: Option<String>,
    /// `None` where a quantity of one of the inputs is not known: then nothing is.
    values: BTreeMap<&'static str, Vec<Option<Statement>>>,
}

impl Found {
    /// What the checker says: why it rejects the answer, or the gap that it proves.
    pub(crate) fn proved(verdict: Result<f64, String>) -> Self {
        let mut found = Found::default();
        found.check(verdict);
        found
    }

    /// Adds what the checker says of one more answer.
    pub(crate) fn check(&mut self, verdict: Result<f64, String>) {
        self.add(GAP, verdict.as_ref().ok().copied());
        self.reject(verdict.err());
    }

    /// The answer is wrong, if there is a reason.
    pub(crate) fn reject(&mut self, why: Option<String>) {
        self.rejected = self.rejected.take().or(why);
    }

    /// Adds a value.
    pub(crate) fn add(&mut self, what: Quantity, value: impl Into<Option<f64>>) {
        let value = value.into().map(|value| (value, None));
        self.values.entry(what.name).or_default().push(value);
    }

    /// Adds a value, with what is to be said of it.
    pub(crate) fn add_with_text(&mut self, what: Quantity, value: Option<(f64, String)>) {
        let value = value.map(|(value, said)| (value, Some(said)));
        self.values.entry(what.name).or_default().push(value);
    }

    /// Adds the median of several runs.
    pub(crate) fn median(
        &mut self,
        what: Quantity,
        runs: Option<Summary>,
        show: fn(f64) -> String,
    ) {
        self.add_with_text(what, runs.map(|runs| (runs.median, range(runs, show))));
    }

    /// Leaves out a quantity that does not count.
    pub(crate) fn forget(&mut self, what: Quantity) {
        self.values.remove(what.name);
    }

    /// Adds all that was found of another input.
    pub(crate) fn join(&mut self, other: Found) {
        self.reject(other.rejected);
        for (what, values) in other.values {
            self.values.entry(what).or_default().extend(values);
        }
    }

    /// The value that is farthest on the wrong side.
    fn worst(&self, goal: &Goal) -> Option<&Statement> {
        let all = self.values.get(goal.what.name)?.iter().map(Option::as_ref);
        let all: Vec<&Statement> = all.collect::<Option<_>>()?;
        all.into_iter().max_by(|a, b| goal.badness(a.0).total_cmp(&goal.badness(b.0)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPEED: Quantity = Quantity::new("faster", Unit::Times);
    const FASTER: Goal = SPEED.at_least(2.0);

    fn met(goal: Goal, found: &Found) -> Option<bool> {
        goal.judge(found).2
    }

    #[test]
    fn the_worst_of_several_counts() {
        let mut found = Found::proved(Ok(1e-13));
        found.check(Ok(1e-11));
        found.add(SECONDS, 2.0);
        found.add(SPEED, 2.5);
        let mut other = Found::default();
        other.add(SPEED, 1.5);
        found.join(other);
        assert_eq!(met(GAP.at_most(1e-12), &found), Some(false));
        assert_eq!(met(GAP.at_most(1e-11), &found), Some(true));
        assert_eq!(met(SECONDS.at_most(2.0), &found), Some(true));
        assert_eq!(met(SECONDS.at_most(1.9), &found), Some(false));
        assert_eq!(met(FASTER, &found), Some(false));
        assert_eq!(met(PASSES.at_most(3.0), &found), None);
        found.add(SECONDS, None);
        assert_eq!(met(SECONDS.at_most(2.0), &found), None);
    }

    #[test]
    fn nan_is_worse_than_any_number() {
        for pair in [[f64::NAN, 1.0], [1.0, f64::NAN]] {
            let mut found = Found::default();
            for value in pair {
                found.add(RADIUS, value);
                found.add(SECONDS, value);
                found.add(SPEED, 9.0 * value);
            }
            for goal in [RADIUS.near(1.0, 1e-9), SECONDS.at_most(2.0), FASTER] {
                assert_eq!(met(goal, &found), Some(false), "{goal:?}");
            }
        }
    }

    #[test]
    fn a_radius_is_met_on_both_sides() {
        let mut found = Found::default();
        found.add(RADIUS, 10.0);
        found.add(RADIUS, 9.999995);
        assert_eq!(met(RADIUS.near(10.0, 1e-6), &found), Some(true));
        assert_eq!(met(RADIUS.near(10.0001, 1e-6), &found), Some(false));
    }

    #[test]
    fn a_rejected_answer_meets_nothing() {
        let mut found = Found::proved(Err("outside".to_owned()));
        found.add(SECONDS, 1e-6);
        assert_eq!(met(SECONDS.at_most(1.0), &found), Some(false));
    }
}
