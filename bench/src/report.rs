//! What a run leaves behind: tables on the terminal, and everything as JSON for those who want to recompute.

use std::path::Path;

use anyhow::Result;
use serde_json::{Value, json};

use crate::machine;

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

    /// Adds a case.
    pub(crate) fn add(&mut self, case: Value) {
        self.cases.push(case);
    }

    /// Writes everything to `path`.
    pub(crate) fn write(&self, path: &Path) -> Result<()> {
        let whole = json!({ "machine": self.machine, "cases": self.cases });
        Ok(std::fs::write(path, serde_json::to_string_pretty(&whole)? + "\n")?)
    }
}
