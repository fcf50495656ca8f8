//! Goals of a section, printed as they are judged and kept for the report.

use serde_json::{Value, json};

use crate::stats::times;

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
