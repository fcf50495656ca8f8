//! What a section leaves behind: tables on the terminal, goals as they are judged, and all of it for the report.

use serde_json::Map;

use crate::prelude::*;

/// Tables, goals and values of a section, part by part.
pub(crate) struct Outcome {
    /// What must be reached by each input, and what is hoped for.
    pub(crate) lists: [&'static [Goal]; 2],
    /// Goals of the part that is not closed, as they are printed, and for the report.
    lines: Vec<(String, Value)>,
    kept: Map<String, Value>,
    parts: Vec<Value>,
}

impl Outcome {
    pub(crate) fn new(lists: [&'static [Goal]; 2]) -> Self {
        Outcome { lists, lines: vec![], kept: Map::new(), parts: vec![] }
    }

    /// Prints a table below what is said of it, and keeps its rows.
    pub(crate) fn table(&mut self, caption: &str, table: Table) {
        println!("{caption}{}{table}", if caption.is_empty() { "" } else { "\n\n" });
        let rows = json!({ "what": caption, "rows": table.into_json() });
        match self.kept.get_mut("tables") {
            Some(Value::Array(tables)) => tables.push(rows),
            _ => self.keep("tables", json!([rows])),
        }
    }

    /// Keeps a value for the report.
    pub(crate) fn keep(&mut self, key: &str, value: Value) {
        self.kept.insert(key.to_owned(), value);
    }

    /// Says in the report that the input is missing.
    pub(crate) fn left_out(&mut self) -> Result<()> {
        self.keep("left_out", json!("the input is not there"));
        Ok(())
    }

    /// Judges what was measured by the goals of the section.
    pub(crate) fn judge(&mut self, found: &Found) {
        self.judge_by(self.lists, found);
    }

    /// Judges what was measured by what must be reached and what is hoped for.
    pub(crate) fn judge_by(&mut self, [must, aim]: [&[Goal]; 2], found: &Found) {
        for (kind, goals) in [("must", must), ("aim", aim)] {
            for goal in goals {
                let (words, measured, met) = goal.judge(found);
                self.line(kind, words, measured, met);
            }
        }
    }

    /// What has to be reached; `met` is `None` where it was not measured.
    pub(crate) fn must(
        &mut self,
        goal: impl Into<String>,
        measured: impl ToString,
        met: impl Into<Option<bool>>,
    ) {
        self.line("must", goal.into(), measured.to_string(), met.into());
    }

    /// What is hoped for.
    pub(crate) fn aim(
        &mut self,
        goal: impl Into<String>,
        measured: impl ToString,
        met: impl Into<Option<bool>>,
    ) {
        self.line("aim", goal.into(), measured.to_string(), met.into());
    }

    /// A value that must be at most one bound, and is hoped to be at most another.
    pub(crate) fn at_most(
        &mut self,
        what: impl Into<String>,
        value: impl Into<Option<f64>>,
        bounds: impl Into<Bounds>,
        unit: Unit,
    ) {
        // NaN is at most nothing.
        self.bounded(what, "at most", value.into(), bounds, unit, |value, bound| value <= bound);
    }

    /// A value that must be at least one bound, and is hoped to be at least another; NaN was not measured.
    pub(crate) fn at_least(
        &mut self,
        what: impl Into<String>,
        value: impl Into<Option<f64>>,
        bounds: impl Into<Bounds>,
        unit: Unit,
    ) {
        let value = value.into().filter(|value| !value.is_nan());
        self.bounded(what, "at least", value, bounds, unit, |value, bound| value >= bound);
    }

    fn bounded(
        &mut self,
        what: impl Into<String>,
        side: &str,
        value: Option<f64>,
        bounds: impl Into<Bounds>,
        unit: Unit,
        is_met: impl Fn(f64, f64) -> bool,
    ) {
        let (what, Bounds { must, aim }) = (what.into(), bounds.into());
        let measured = value.map_or("not measured".to_owned(), |value| unit.show(value));
        for (kind, bound) in [("must", must), ("aim", aim)] {
            let Some(bound) = bound else { continue };
            let goal = format!("{what} {side} {}", unit.show(bound));
            self.line(kind, goal, measured.clone(), value.map(|value| is_met(value, bound)));
        }
    }

    fn line(&mut self, kind: &str, goal: String, measured: String, met: Option<bool>) {
        let word = match met {
            Some(true) => "met",
            Some(false) => "NOT MET",
            None => "not measured",
        };
        let line = format!("- {kind}: {goal}: {measured}: {word}");
        let value = json!({ "kind": kind, "goal": goal, "measured": measured, "met": met });
        self.lines.push((line, value));
    }

    /// Prints the goals so far, and puts what was kept so far under one name in the report.
    pub(crate) fn close(&mut self, what: &str) {
        let part = self.take(what);
        self.parts.push(part);
    }

    fn take(&mut self, name: &str) -> Value {
        let mut part = std::mem::take(&mut self.kept);
        let (lines, values): (Vec<String>, Vec<Value>) = self.lines.drain(..).unzip();
        if !lines.is_empty() {
            println!("{}\n", lines.join("\n"));
        }
        part.insert("name".to_owned(), json!(name));
        part.insert("goals".to_owned(), values.into());
        part.into()
    }

    /// Prints the goals that are left; everything, for the report.
    pub(crate) fn finish(mut self, name: &str) -> Value {
        let mut whole = self.take(name);
        whole["parts"] = self.parts.into();
        whole
    }
}

/// What a value must reach, and what is hoped for.
pub(crate) struct Bounds {
    must: Option<f64>,
    aim: Option<f64>,
}

impl From<f64> for Bounds {
    fn from(must: f64) -> Self {
        Bounds { must: Some(must), aim: None }
    }
}

impl From<[f64; 2]> for Bounds {
    fn from([must, aim]: [f64; 2]) -> Self {
        Bounds { must: Some(must), aim: Some(aim) }
    }
}

/// A bound that is hoped for alone.
pub(crate) fn aim_only(aim: f64) -> Bounds {
    Bounds { must: None, aim: Some(aim) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn met(out: Outcome) -> Vec<Value> {
        let whole = out.finish("all");
        whole["goals"].as_array().unwrap().iter().map(|line| line["met"].clone()).collect()
    }

    #[test]
    fn a_bound_is_met_up_to_itself_and_not_by_nan() {
        let mut out = Outcome::new([&[]; 2]);
        out.at_most("error", 2.0, [2.0, 1.0], Unit::Plain);
        out.at_most("error", f64::NAN, 2.0, Unit::Plain);
        out.at_most("error", None, aim_only(2.0), Unit::Plain);
        assert_eq!(out.lines[1].1["goal"], "error at most 1");
        assert_eq!(met(out), [json!(true), json!(false), json!(false), Value::Null]);
    }

    #[test]
    fn a_ratio_is_met_from_its_bound_on() {
        let mut out = Outcome::new([&[]; 2]);
        out.at_least("speed", 2.0, [2.0, 2.5], Unit::Times);
        out.at_least("speed", f64::NAN, 2.0, Unit::Times);
        assert_eq!(met(out), [json!(true), json!(false), Value::Null]);
    }

    #[test]
    fn parts_have_their_own_goals_and_tables() {
        const MUST: &[Goal] = &[GAP.at_most(1e-9)];
        let mut out = Outcome::new([MUST, &[]]);
        let mut table = Table::new("n | time:s");
        table.push(json!({ "n": 3, "time": 0.5, "all": [0.5, 0.6] }));
        out.table("three", table);
        out.judge(&Found::proved(Ok(1e-10)));
        out.close("first");
        out.must("no", 1, false);
        let whole = out.finish("all");
        assert_eq!(whole["parts"][0]["tables"][0]["rows"][0]["all"][1], 0.6);
        assert_eq!(whole["parts"][0]["goals"][0]["met"], true);
        assert_eq!(whole["goals"].as_array().unwrap().len(), 1);
    }
}
