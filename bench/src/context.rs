//! What all sections of a command share: how often, with how many threads, for how long, and where things go.

use tempfile::TempDir;

use crate::prelude::*;

/// How a section runs.
pub(crate) struct Context {
    /// Rounds.
    pub(crate) runs: usize,
    /// Whether inputs are smaller than the sections say.
    pub(crate) quick: bool,
    /// Numbers of threads taut is run with.
    pub(crate) threads: Vec<usize>,
    /// Peers that take part in the section, where it names them.
    pub(crate) peers: &'static [&'static str],
    /// Seeds of what is drawn.
    pub(crate) seeds: Range<u64>,
    /// After which one run of a peer is stopped.
    pub(crate) limit: Duration,
    /// After which a slow peer takes part in no further round.
    pub(crate) peer_budget: Duration,
    /// Folder for large files, which are kept.
    pub(crate) scratch: Option<PathBuf>,
    /// Folder for files that are not.
    pub(crate) temp: TempDir,
}

impl Context {
    /// The last number of threads: most goals are about it.
    pub(crate) fn last_threads(&self) -> usize {
        self.threads.last().copied().unwrap_or(1)
    }

    /// A pool with the last number of threads.
    pub(crate) fn pool(&self) -> Result<rayon::ThreadPool> {
        pool(self.last_threads())
    }

    /// `usual`, or `quick` where inputs are small.
    pub(crate) fn size<T>(&self, usual: T, quick: T) -> T {
        if self.quick { quick } else { usual }
    }

    /// So many, or a tenth of them where inputs are small.
    pub(crate) fn count(&self, usual: usize) -> usize {
        self.size(usual, usual / 10)
    }

    /// A file that is not kept.
    pub(crate) fn file(&self, name: &str) -> PathBuf {
        self.temp.path().join(name)
    }

    /// The folder for a large file; `None`, after saying so, where none was given and inputs are not small.
    pub(crate) fn folder(&self, room: &str) -> Option<PathBuf> {
        match (&self.scratch, self.quick) {
            (Some(folder), _) => Some(folder.clone()),
            (None, true) => Some(self.temp.path().to_owned()),
            (None, false) => {
                println!("left out: give --scratch FOLDER, with {room} of free disk, for the file");
                None
            }
        }
    }
}

/// A pool of so many threads.
pub(crate) fn pool(threads: usize) -> Result<rayon::ThreadPool> {
    Ok(rayon::ThreadPoolBuilder::new().num_threads(threads).build()?)
}

/// The same, each thread bound to a processor of its own where there are as many; for work that starts no threads itself, as these
/// would be bound to the same processor.
///
/// On the virtual machine of the first runs a second thread that was woken began up to two milliseconds late, often when the first was
/// done, though the other processor was idle. That is half of some of the times measured here.
pub(crate) fn bound_pool(threads: usize) -> Result<rayon::ThreadPool> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    Ok(pool.start_handler(bind).build()?)
}

/// Binds the calling thread to the processor of this rank among those of the process.
#[cfg(target_os = "linux")]
fn bind(rank: usize) {
    use rustix::thread::{CpuSet, sched_getaffinity, sched_setaffinity};
    let Ok(allowed) = sched_getaffinity(None) else { return };
    let count = allowed.count() as usize;
    let mut processors = (0..CpuSet::MAX_CPU).filter(|&processor| allowed.is_set(processor));
    let Some(processor) = processors.nth(rank % count.max(1)) else { return };
    let mut own = CpuSet::new();
    own.set(processor);
    // A system that refuses leaves the thread where it is: times are worse, and answers the same.
    let _ = sched_setaffinity(None, &own);
}

#[cfg(not(target_os = "linux"))]
fn bind(_: usize) {}
