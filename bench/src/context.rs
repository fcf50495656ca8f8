//! What all cases of a command share, and how they are run one after another.

use std::path::PathBuf;
use std::time::Duration;

use anyhow::{Result, ensure};
use serde_json::json;
use tempfile::TempDir;

use crate::cases::Named;
use crate::report::Report;

/// How often, with how many threads, for how long, and where things go.
pub(crate) struct Context {
    /// Rounds.
    pub(crate) runs: usize,
    /// Whether inputs are smaller than the cases say.
    pub(crate) quick: bool,
    /// Numbers of threads taut is run with.
    pub(crate) threads: Vec<usize>,
    /// After which one run of a peer is stopped.
    pub(crate) limit: Duration,
    /// After which a slow peer takes part in no further round.
    pub(crate) peer_budget: Duration,
    /// Folder for large files, which are kept.
    pub(crate) scratch: Option<PathBuf>,
    /// Folder for files that are not.
    pub(crate) temp: TempDir,
    /// What is measured.
    pub(crate) report: Report,
}

impl Context {
    /// Begins the report, and says so where inputs are small.
    pub(crate) fn begin(
        runs: usize,
        quick: bool,
        threads: &[usize],
        [limit, peer_budget]: [u64; 2],
        scratch: Option<&PathBuf>,
    ) -> Result<Self> {
        ensure!(
            runs > 0 && !threads.is_empty() && !threads.contains(&0),
            "at least one run and one thread"
        );
        let context = Context {
            runs,
            quick,
            threads: threads.to_vec(),
            limit: Duration::from_secs(limit),
            peer_budget: Duration::from_secs(peer_budget),
            scratch: scratch.cloned(),
            temp: TempDir::new()?,
            report: Report::begin(),
        };
        if quick {
            println!("Quick: inputs are smaller than the cases say. Not to be quoted.\n");
        }
        Ok(context)
    }

    /// Runs cases in order; what was measured is written after each.
    pub(crate) fn run_all<'a, C: Named>(
        &mut self,
        cases: Vec<&'a C>,
        json: Option<&PathBuf>,
        run: impl Fn(&mut Self, &'a C) -> Result<()>,
    ) -> Result<()> {
        for case in cases {
            let [name, about] = case.head();
            println!("## {name}\n{about}\n");
            run(self, case)?;
            println!();
            if let Some(path) = json {
                self.report.write(path)?;
            }
        }
        Ok(())
    }

    /// The folder for a large file; `None`, after saying so, where none was given and inputs are not small.
    pub(crate) fn folder(&mut self, case: &str, room: &str) -> Option<PathBuf> {
        match (&self.scratch, self.quick) {
            (Some(folder), _) => Some(folder.clone()),
            (None, true) => Some(self.temp.path().to_owned()),
            (None, false) => {
                println!("left out: give --scratch FOLDER, with {room} of free disk, for the file");
                self.report.add(json!({ "name": case, "left_out": "no --scratch" }));
                None
            }
        }
    }
}
