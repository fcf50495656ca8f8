//! One round: all threads insert, then one inserts what is left.

use std::sync::atomic::AtomicU8;
use std::sync::atomic::Ordering::Relaxed;

use rayon::prelude::*;
use taut_points::Monitor;

use super::Holder;
use super::held::Owners;
use super::runs::Runs;
use crate::Error;
use crate::kernel::{Kernel, TooMany};

/// Attempts after which a thread looks how many of them failed.
const ATTEMPTS_MIN: u64 = 512;
/// The rest of a round is left to one thread if more than one attempt in so many fails.
const FAILED_SHARE: u64 = 20;

/// How far an insertion of several sites came.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Inserted {
    /// To the end.
    All,
    /// There is no room for the simplices of the site at this place.
    Full(usize),
}

/// What one thread did so far.
#[derive(Default)]
pub(crate) struct Progress {
    /// Sites that were not inserted, as other threads held what they need.
    pub(crate) deferred: Vec<u32>,
    /// Insertions begun.
    pub(crate) attempts: u64,
    /// Those given up.
    pub(crate) failed: u64,
}

/// A mesh that several threads insert into.
pub(crate) trait SharedMesh<const D: usize, const V: usize>: Kernel<D, V> {
    /// All that threads share.
    type View<'a>: Sync
    where
        Self: 'a;
    /// What each has for itself.
    type Worker: Send;

    /// Least number of sites of a round for each thread.
    const SITES_MIN: usize;

    /// The mesh, and so many workers.
    fn share(&mut self, threads: usize) -> (Self::View<'_>, &Owners, &mut [Self::Worker]);

    /// Ends what [`share`](Self::share) began.
    fn end_sharing(&mut self);

    /// Makes room for more simplices.
    fn grow(&mut self) -> Result<(), TooMany>;

    /// Inserts sites, as one of several threads.
    fn insert_concurrently(
        view: &Self::View<'_>,
        worker: &mut Self::Worker,
        holder: &mut Holder<'_>,
        sites: &[u32],
        progress: &mut Progress,
    ) -> Inserted;
}

/// Lets walks begin in simplices: who may change a mesh alone gives each thread whose last one was destroyed by another, or taken
/// back, that of a thread which still has it, or any of the first `count` slots.
pub(crate) fn repair_beginnings<'a>(
    beginnings: impl Iterator<Item = &'a mut u32>,
    count: usize,
    is_live: impl Fn(u32) -> bool,
) {
    let mut beginnings: Vec<&mut u32> = beginnings.collect();
    let live = beginnings.iter().map(|begin| **begin).find(|&t| is_live(t));
    let live = live.or_else(|| (0..count as u32).find(|&t| is_live(t)));
    let live = live.expect("a mesh has simplices");
    for begin in beginnings.iter_mut().filter(|begin| !is_live(***begin)) {
        **begin = live;
    }
}

/// Why threads stop before all is inserted.
const GO_ON: u8 = 0;
const FULL: u8 = 1;
const CONTENTION: u8 = 2;
const STOPPED: u8 = 3;

/// Inserts the sites `nth(0)`, … `nth(count − 1)` but those of `started`, on so many threads, each along its run of them or
/// backward.
pub(crate) fn insert_round<const D: usize, const V: usize, K: SharedMesh<D, V>>(
    kernel: &mut K,
    count: u32,
    nth: impl Fn(u32) -> u32 + Sync,
    started: &[u32; V],
    (threads, backward): (usize, bool),
    monitor: &Monitor<'_>,
) -> Result<(), Error> {
    // A record of which a part was never written seems to have site 0, which must be no news to the owners.
    debug_assert!(started.contains(&0), "a mesh starts with the first site");
    let runs = Runs::new(count, threads, backward);
    let mut left: Vec<u32> = Vec::new();
    loop {
        let why = AtomicU8::new(GO_ON);
        let deferred: Vec<Vec<u32>> = {
            let (view, owners, workers) = kernel.share(threads);
            let work = |(thread, worker): (usize, &mut K::Worker)| {
                #[cfg(test)]
                let begin = std::time::Instant::now();
                let mut holder = owners.holder(thread);
                let mut progress = Progress::default();
                let mut sites = Vec::new();
                while why.load(Relaxed) == GO_ON
                    && let Some(block) = runs.take(thread)
                {
                    sites.clear();
                    sites.extend(block.places().map(&nth).filter(|site| !started.contains(site)));
                    let done =
                        K::insert_concurrently(&view, worker, &mut holder, &sites, &mut progress);
                    if let Inserted::Full(at) = done {
                        progress.deferred.extend(&sites[at..]);
                        why.store(FULL, Relaxed);
                    }
                    monitor.points(sites.len() as u64);
                    if monitor.check().is_err() {
                        why.store(STOPPED, Relaxed);
                    }
                    if progress.attempts > ATTEMPTS_MIN
                        && progress.failed * FAILED_SHARE > progress.attempts
                    {
                        why.store(CONTENTION, Relaxed);
                    }
                }
                holder.release();
                #[cfg(test)]
                in_turn::note(thread, begin.elapsed());
                progress.deferred
            };
            workers.par_iter_mut().with_max_len(1).enumerate().map(work).collect()
        };
        left.extend(deferred.into_iter().flatten());
        kernel.end_sharing();
        match why.into_inner() {
            FULL => kernel.grow()?,
            STOPPED => monitor.check()?,
            _ => break,
        }
    }
    // Along the curve, so that walks are short.
    let deferred = left.len();
    left.extend(runs.rest().map(&nth).filter(|site| !started.contains(site)));
    left.sort_unstable();
    for sites in left.chunks(1 << 16) {
        kernel.insert(sites)?;
        monitor.check()?;
    }
    monitor.points((left.len() - deferred) as u64);
    Ok(())
}

/// For the time that more threads than there are processors would take: the parts of threads are done one after the other, and timed.
#[cfg(test)]
pub(super) mod in_turn {
    use std::sync::Mutex;
    use std::sync::atomic::AtomicBool;
    use std::sync::atomic::Ordering::Relaxed;
    use std::time::Duration;

    /// While this holds, threads do their own runs only, and are not held up.
    pub(in super::super) static ON: AtomicBool = AtomicBool::new(false);

    /// For each round the times of its threads.
    pub(in super::super) static ROUNDS: Mutex<Vec<Vec<Duration>>> = Mutex::new(Vec::new());

    pub(super) fn note(thread: usize, time: Duration) {
        if ON.load(Relaxed) {
            let mut rounds = ROUNDS.lock().expect("nobody panics here");
            if thread == 0 {
                rounds.push(Vec::new());
            }
            rounds.last_mut().expect("thread 0 is the first").push(time);
        }
    }
}
