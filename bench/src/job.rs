//! Work of taut that is done in a process of its own, so that its times and its peak memory are its alone.

use std::process::Command;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::prelude::*;
use crate::{ball, curve, delaunay, ellipsoid, oblivious, outofcore, process, surface};

/// What is to be done. It is handed over as JSON on the command line, and prints one line of JSON.
#[derive(Serialize, Deserialize)]
pub(crate) enum Job {
    Ball(ball::file::Task),
    Ellipsoid(ellipsoid::file::Task),
    Delaunay(delaunay::one::Task),
    /// A triangulation on the disk, its check, or what it is compared with.
    OutOfCore(outofcore::one::Task),
    Curve(curve::one::Task),
    Surface(surface::one::Task),
    File(oblivious::one::Task),
}

impl Job {
    /// Does the work that is written in `text` and prints what came of it.
    pub(crate) fn perform(text: &str) -> Result<()> {
        let done = match serde_json::from_str(text)? {
            Job::Ball(task) => json!(task.perform()?),
            Job::Ellipsoid(task) => json!(task.perform()?),
            Job::Delaunay(task) => json!(task.perform()?),
            Job::OutOfCore(task) => json!(task.perform()?),
            Job::Curve(task) => json!(task.perform()?),
            Job::Surface(task) => json!(task.perform()?),
            Job::File(task) => json!(task.perform()?),
        };
        println!("{done}");
        Ok(())
    }

    /// Has the work done in a process of its own.
    pub(crate) fn run<T: DeserializeOwned>(&self, limit: Duration) -> Result<Result<T, Silence>> {
        let mut command = Command::new(std::env::current_exe()?);
        command.arg("job").arg(serde_json::to_string(self)?);
        process::run(command, limit)
    }

    /// The same for as long as it takes.
    pub(crate) fn finish<T: DeserializeOwned>(&self) -> Result<T> {
        self.run(Duration::MAX)?.map_err(|silence| anyhow!("the process of a job {silence}"))
    }
}
