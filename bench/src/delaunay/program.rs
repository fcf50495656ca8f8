//! Programs that triangulate: each build is a process of its own, which prints one line of JSON.
//!
//! So processor time and peak memory are those of one build by one program, a program that crashes takes nothing with
//! it, and one that is too slow is stopped. The line is described in `peers/delaunay.hpp`.

use std::collections::BTreeMap;
use std::io::Read;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use anyhow::{Context as _, Result, bail};
use serde::{Deserialize, Serialize};

use crate::peer::{Silence, folder};

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

/// Who triangulates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Program {
    /// taut, with so many threads.
    Taut(usize),
    /// A peer, with one thread.
    Peer(Peer),
}

/// A peer, as cases name it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Peer {
    /// `Delaunay_triangulation_2` and `_3` of CGAL.
    Cgal,
    /// `bulk_load` of the crate spade, plane only.
    Spade,
    /// The crate delaunator, plane only.
    Delaunator,
    /// Triangle through Python, plane only.
    Triangle,
    /// Qhull through SciPy.
    Qhull,
}

impl Program {
    /// What the tables call it until it has told its version.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Program::Taut(_) => "taut",
            Program::Peer(Peer::Cgal) => "CGAL",
            Program::Peer(Peer::Spade) => "spade",
            Program::Peer(Peer::Delaunator) => "delaunator",
            Program::Peer(Peer::Triangle) => "Triangle",
            Program::Peer(Peer::Qhull) => "Qhull",
        }
    }

    /// Threads it works with.
    pub(crate) const fn threads(self) -> usize {
        match self {
            Program::Taut(threads) => threads,
            Program::Peer(_) => 1,
        }
    }

    /// Whether its predicates are exact.
    pub(crate) const fn is_exact(self) -> bool {
        !matches!(self, Program::Peer(Peer::Delaunator | Peer::Qhull))
    }

    /// How it is called; `None` where `bench/setup` did not get it. `check` asks taut to judge its answer as well.
    fn command(self, dim: usize, file: &Path, check: bool) -> Result<Option<Command>> {
        let built = folder().join("peers/build");
        let mut command = match self {
            Program::Taut(threads) => {
                let mut command = Command::new(std::env::current_exe()?);
                command.arg("one-delaunay").args(["--dim", &dim.to_string()]);
                command.args(["--threads", &threads.to_string()]);
                if check {
                    command.arg("--check");
                }
                command
            }
            Program::Peer(Peer::Cgal) => Command::new(built.join(format!("cgal-delaunay-{dim}"))),
            Program::Peer(Peer::Spade | Peer::Delaunator) => {
                let mut command = Command::new(built.join("rust/release/peers"));
                command.arg(self.name());
                command
            }
            Program::Peer(Peer::Triangle | Peer::Qhull) => {
                let mut command = Command::new(folder().join(".venv/bin/python"));
                command.arg(folder().join("peers/delaunay.py"));
                command.arg(self.name().to_lowercase()).arg(dim.to_string());
                command
            }
        };
        command.arg(file);
        Ok(Path::new(command.get_program()).exists().then_some(command))
    }

    /// One build of the points in `file`; with `check` taut judges its answer afterwards.
    pub(crate) fn build(
        self,
        dim: usize,
        file: &Path,
        check: bool,
        limit: Duration,
    ) -> Result<Result<Build, Silence>> {
        match self.command(dim, file, check)? {
            Some(command) => run(command, limit).with_context(|| self.name()),
            None => Ok(Err(Silence::NotInstalled)),
        }
    }
}

/// Runs a program to its end, or stops it after `limit`, and reads its line.
pub(crate) fn run(mut command: Command, limit: Duration) -> Result<Result<Build, Silence>> {
    // Libraries below Python start threads of their own, which wait by spinning.
    command.env("OMP_NUM_THREADS", "1").env("OPENBLAS_NUM_THREADS", "1");
    let mut child =
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn()?;
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

    fn shell(script: &str) -> Command {
        let mut command = Command::new("sh");
        command.args(["-c", script]);
        command
    }

    #[test]
    fn a_line_is_read_and_silence_has_a_reason() {
        let line = r#"{"program":"x 1","points":3,"simplices":1,"cpu":0.5,"wall":1,"peak":null}"#;
        let build =
            run(shell(&format!("echo '{line}'")), Duration::from_secs(60)).unwrap().unwrap();
        assert_eq!((build.points, build.simplices, build.cpu, build.peak), (3, 1, 0.5, None));
        let silence = |script: &str, limit| run(shell(script), limit).unwrap().unwrap_err();
        assert_eq!(silence("exit 3", Duration::from_secs(60)), Silence::Ended);
        assert_eq!(
            silence(&format!("echo '{line}'; exit 1"), Duration::from_secs(60)),
            Silence::Ended
        );
        let limit = Duration::from_millis(50);
        assert_eq!(silence("exec sleep 60", limit), Silence::Slow(limit));
        assert!(run(shell("echo nonsense"), Duration::from_secs(60)).is_err());
    }
}
