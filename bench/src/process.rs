//! Programs of which each run is a process of its own that prints one line of JSON.
//!
//! So processor time and peak memory are those of one run of one program, a program that crashes takes nothing with it,
//! and one that is too slow is stopped. The line is described in `peers/delaunay.hpp`.

use std::collections::BTreeMap;
use std::io::Read;
use std::process::{Command, Stdio};
use std::sync::mpsc::{RecvTimeoutError, channel};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::meter::Cost;
use crate::prelude::*;

/// What one build cost and found.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Build {
    /// Name and version of the program.
    pub(crate) program: String,
    /// Points it read.
    pub(crate) points: u64,
    /// Finite triangles or tetrahedra; of a curve its edges, of a surface its triangles.
    pub(crate) simplices: u64,
    /// Processor seconds, user and system, of all threads.
    pub(crate) cpu: f64,
    /// Seconds by the clock.
    pub(crate) wall: f64,
    /// Bytes resident at the peak above those before the build; `None` where the system does not tell.
    pub(crate) peak: Option<u64>,
    /// Share of predicates that no filter decided; peers do not tell.
    #[serde(default)]
    pub(crate) exact: Option<f64>,
    /// What else taut counted.
    #[serde(default)]
    pub(crate) counters: BTreeMap<String, u64>,
    /// What taut's checker said, where it was asked.
    #[serde(default)]
    pub(crate) judged: Option<Judged>,
}

/// A triangulation as an answer, judged from the points alone. None of it is part of the build.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Judged {
    /// Processor seconds from the triangulation to the answer in rows of the input, with its certificate.
    pub(crate) answer: f64,
    /// Processor seconds of the check.
    pub(crate) check: f64,
    /// Why it was rejected, if it was.
    pub(crate) rejected: Option<String>,
}

impl Build {
    /// A build of taut.
    pub(crate) fn of_taut<'a>(
        points: usize,
        simplices: u64,
        cost: Cost,
        counters: impl IntoIterator<Item = (&'a str, u64)>,
    ) -> Self {
        let counters = counters.into_iter().map(|(name, count)| (name.to_owned(), count));
        Build {
            program: format!("taut {}", env!("TAUT_BUILT_FROM")),
            points: points as u64,
            simplices,
            cpu: cost.cpu,
            wall: cost.wall,
            peak: cost.peak,
            exact: None,
            counters: counters.collect(),
            judged: None,
        }
    }

    /// Bytes per point at the peak.
    pub(crate) fn bytes_per_point(&self) -> Option<f64> {
        self.peak.map(|peak| peak as f64 / self.points as f64)
    }
}

/// The builds of one program on one input, and why there are no more.
#[derive(Default, Serialize)]
pub(crate) struct Builds {
    pub(crate) builds: Vec<Build>,
    pub(crate) silence: Option<Silence>,
}

impl Builds {
    /// Keeps a build, or why there is none.
    pub(crate) fn keep(&mut self, told: Result<Build, Silence>) {
        match told {
            Ok(build) => self.builds.push(build),
            Err(silence) => self.silence = Some(silence),
        }
    }

    /// A quantity, build by build.
    pub(crate) fn all(&self, of: impl Fn(&Build) -> f64) -> Vec<f64> {
        self.builds.iter().map(of).collect()
    }

    /// The least time by the clock.
    pub(crate) fn wall(&self) -> Option<f64> {
        least(self.builds.iter().map(|build| build.wall))
    }

    /// The least processor time.
    pub(crate) fn cpu(&self) -> Option<f64> {
        least(self.builds.iter().map(|build| build.cpu))
    }

    /// The largest peak, in bytes per point.
    pub(crate) fn bytes_per_point(&self) -> Option<f64> {
        self.builds.iter().filter_map(Build::bytes_per_point).max_by(f64::total_cmp)
    }
}

/// Lets all take turns, forwards and backwards, so that nobody always finds the caches of the same one.
pub(crate) fn by_turns<T>(
    rounds: usize,
    all: &mut [T],
    mut turn: impl FnMut(&mut T) -> Result<()>,
) -> Result<()> {
    for round in 0..rounds {
        match round % 2 {
            0 => all.iter_mut().try_for_each(&mut turn)?,
            _ => all.iter_mut().rev().try_for_each(&mut turn)?,
        }
    }
    Ok(())
}

/// Runs a program to its end, or stops it after `limit`, and reads its line.
pub(crate) fn run<T: DeserializeOwned>(
    mut command: Command,
    limit: Duration,
) -> Result<Result<T, Silence>> {
    // Libraries below Python start threads of their own, which wait by spinning.
    command.env("OMP_NUM_THREADS", "1").env("OPENBLAS_NUM_THREADS", "1");
    let mut child = command.stdin(Stdio::null()).stdout(Stdio::piped()).spawn()?;
    let Some(mut stdout) = child.stdout.take() else { bail!("no pipe") };
    let (send, told) = channel();
    std::thread::spawn(move || {
        let mut text = String::new();
        // Nobody listens any more where the program was stopped.
        let _ = send.send(stdout.read_to_string(&mut text).map(|_| text));
    });
    let text = match told.recv_timeout(limit) {
        Ok(text) => text?,
        Err(RecvTimeoutError::Timeout) => {
            child.kill()?;
            child.wait()?;
            return Ok(Err(Silence::Slow(limit)));
        }
        Err(RecvTimeoutError::Disconnected) => bail!("its output was lost"),
    };
    let status = child.wait()?;
    if !status.success() || text.trim().is_empty() {
        return Ok(Err(Silence::Ended));
    }
    Ok(Ok(serde_json::from_str(&text).with_context(|| text.clone())?))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shell(script: &str, limit: Duration) -> Result<Result<Build, Silence>> {
        let mut command = Command::new("sh");
        command.args(["-c", script]);
        run(command, limit)
    }

    #[test]
    fn a_line_is_read_and_silence_has_a_reason() {
        let line = r#"{"program":"x 1","points":3,"simplices":1,"cpu":0.5,"wall":1,"peak":null}"#;
        let minute = Duration::from_secs(60);
        let build = shell(&format!("echo '{line}'"), minute).unwrap().unwrap();
        assert_eq!((build.points, build.simplices, build.cpu, build.peak), (3, 1, 0.5, None));
        let silence = |script: &str, limit| shell(script, limit).unwrap().unwrap_err();
        assert_eq!(silence("exit 3", minute), Silence::Ended);
        assert_eq!(silence(&format!("echo '{line}'; exit 1"), minute), Silence::Ended);
        let limit = Duration::from_millis(50);
        assert_eq!(silence("exec sleep 60", limit), Silence::Slow(limit));
        assert!(shell("echo nonsense", minute).is_err());
    }

    #[test]
    fn turns_go_forwards_and_backwards() {
        let mut order = vec![];
        let note = |name: &mut char| {
            order.push(*name);
            Ok(())
        };
        by_turns(3, &mut ['a', 'b'], note).unwrap();
        assert_eq!(order, ['a', 'b', 'b', 'a', 'a', 'b']);
    }
}
