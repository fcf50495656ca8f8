//! Everything that was measured, as JSON for those who want to recompute.

use crate::machine;
use crate::prelude::*;

/// Collects what is measured.
pub(crate) struct Report {
    machine: Value,
    cases: Vec<Value>,
}

impl Report {
    /// Begins a report and prints what it was measured on.
    pub(crate) fn begin() -> Self {
        let machine = machine::describe();
        println!("Machine and versions: {machine}\n");
        Report { machine, cases: Vec::new() }
    }

    /// Adds a section.
    pub(crate) fn add(&mut self, case: Value) {
        self.cases.push(case);
    }

    /// Writes everything to `path`, if there is one.
    pub(crate) fn write(&self, path: Option<&Path>) -> Result<()> {
        let Some(path) = path else { return Ok(()) };
        let whole = json!({ "machine": self.machine, "cases": self.cases });
        Ok(std::fs::write(path, serde_json::to_string_pretty(&whole)? + "\n")?)
    }
}
