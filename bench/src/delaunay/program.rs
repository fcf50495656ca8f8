//! Programs that triangulate.

use super::*;

/// Who triangulates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Program {
    /// taut, with so many threads.
    Taut(usize),
    /// A peer, with one thread.
    Peer(&'static str),
}

/// `Delaunay_triangulation_2` and `_3` of CGAL.
pub(crate) const CGAL: &str = "CGAL";
/// `bulk_load` of the crate spade, plane only.
pub(super) const SPADE: &str = "spade";
/// The crate delaunator, plane only.
pub(super) const DELAUNATOR: &str = "delaunator";
/// Triangle through Python, plane only.
pub(super) const TRIANGLE: &str = "Triangle";
/// Qhull through SciPy.
pub(super) const QHULL: &str = "Qhull";

impl Program {
    /// What the tables call it until it has told its version.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Program::Taut(_) => "taut",
            Program::Peer(name) => name,
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
    pub(crate) fn is_exact(self) -> bool {
        !matches!(self, Program::Peer(DELAUNATOR | QHULL))
    }

    /// How a peer is called; `None` where `bench/setup` did not get it.
    fn command(self, dim: usize, file: &Path) -> Option<Command> {
        let (folder, name) = (peer::folder(), self.name());
        let mut command = match name {
            CGAL => Command::new(folder.join(format!("peers/build/cgal-delaunay-{dim}"))),
            SPADE | DELAUNATOR => {
                let mut command = Command::new(folder.join("peers/build/rust/release/peers"));
                command.arg(name);
                command
            }
            _ => {
                let mut command = Command::new(folder.join(".venv/bin/python"));
                command.arg(folder.join("peers/delaunay.py"));
                command.arg(name.to_lowercase()).arg(dim.to_string());
                command
            }
        };
        command.arg(file).stderr(Stdio::null());
        Path::new(command.get_program()).exists().then_some(command)
    }

    /// One build of the points in `file`; with `check` taut judges its answer afterwards.
    pub(crate) fn build(
        self,
        dim: usize,
        file: &Path,
        check: bool,
        limit: Duration,
    ) -> Result<Result<Build, Silence>> {
        match self {
            Program::Taut(threads) => {
                Job::Delaunay(Task { dim, threads, check, file: file.to_owned() }).run(limit)
            }
            Program::Peer(_) => match self.command(dim, file) {
                Some(command) => process::run(command, limit).with_context(|| self.name()),
                None => Ok(Err(Silence::NotInstalled)),
            },
        }
    }
}
