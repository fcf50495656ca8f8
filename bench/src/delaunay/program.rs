//! Programs that triangulate.

use super::*;

/// Who triangulates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Program {
    /// taut, with so many threads.
    Taut(usize),
    /// A peer, with one thread.
    Peer(Triangulator),
}

/// A peer, as cases name it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Triangulator {
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
            Program::Peer(Triangulator::Cgal) => "CGAL",
            Program::Peer(Triangulator::Spade) => "spade",
            Program::Peer(Triangulator::Delaunator) => "delaunator",
            Program::Peer(Triangulator::Triangle) => "Triangle",
            Program::Peer(Triangulator::Qhull) => "Qhull",
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
        !matches!(self, Program::Peer(Triangulator::Delaunator | Triangulator::Qhull))
    }

    /// How a peer is called; `None` where `bench/setup` did not get it.
    fn command(self, peer: Triangulator, dim: usize, file: &Path) -> Option<Command> {
        let built = peer::folder().join("peers/build");
        let mut command = match peer {
            Triangulator::Cgal => Command::new(built.join(format!("cgal-delaunay-{dim}"))),
            Triangulator::Spade | Triangulator::Delaunator => {
                let mut command = Command::new(built.join("rust/release/peers"));
                command.arg(self.name());
                command
            }
            Triangulator::Triangle | Triangulator::Qhull => {
                let mut command = Command::new(peer::folder().join(".venv/bin/python"));
                command.arg(peer::folder().join("peers/delaunay.py"));
                command.arg(self.name().to_lowercase()).arg(dim.to_string());
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
            Program::Peer(peer) => match self.command(peer, dim, file) {
                Some(command) => process::run(command, limit).with_context(|| self.name()),
                None => Ok(Err(Silence::NotInstalled)),
            },
        }
    }
}
