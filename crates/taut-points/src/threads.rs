//! Pools of threads of a chosen size: the one place where their number is bounded.

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::InputError;

/// Most threads of a pool. More than any machine has processors only cost memory, and starting them takes ever longer.
pub const THREADS_MAX: usize = 1024;

/// Why there is no pool of this size.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("expected {expected}")]
pub struct ThreadsError {
    /// The numbers of threads that would have been accepted.
    pub expected: &'static str,
}

/// Refuses a number of threads that is 0 or more than [`THREADS_MAX`].
///
/// # Errors
/// [`ThreadsError`] with the range.
pub fn check_threads(threads: usize) -> Result<(), ThreadsError> {
    match (1..=THREADS_MAX).contains(&threads) {
        true => Ok(()),
        false => Err(ThreadsError { expected: "1 to 1024" }),
    }
}

/// Starts a pool of that many threads, 1 to [`THREADS_MAX`].
///
/// ```
/// assert_eq!(taut_points::thread_pool(2)?.current_num_threads(), 2);
/// assert!(taut_points::thread_pool(1_000_000_000).is_err());
/// # Ok::<(), taut_points::ThreadsError>(())
/// ```
///
/// # Errors
/// [`ThreadsError`] where the number is out of range, or the system grants fewer threads.
pub fn thread_pool(threads: usize) -> Result<ThreadPool, ThreadsError> {
    check_threads(threads)?;
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|_| ThreadsError { expected: "as many threads as the system grants" })
}

/// Does `work` on a pool of `threads` threads, or on the pool of the caller where the number is `None`.
///
/// # Errors
/// [`InputError::Option`] as [`thread_pool`]; what `work` says.
pub fn on_threads<R: Send, E: From<InputError> + Send>(
    threads: Option<usize>,
    work: impl FnOnce() -> Result<R, E> + Send,
) -> Result<R, E> {
    let Some(threads) = threads else { return work() };
    // WebAssembly starts no thread, and has the one of the caller.
    if threads == 1 && cfg!(target_family = "wasm") {
        return work();
    }
    let refused = |refused: ThreadsError| InputError::Option {
        name: "threads",
        value: threads.to_string(),
        expected: refused.expected,
    };
    let pool = thread_pool(threads).map_err(refused)?;
    let (mut work, mut found) = (Some(work), None);
    install(&pool, &mut || found = work.take().map(|work| work()));
    found.expect("work that ended has a result")
}

/// Does `work` on the pool; compiled once.
fn install(pool: &ThreadPool, work: &mut (dyn FnMut() + Send)) {
    pool.install(work);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threads_are_capped_before_one_is_started() {
        for wrong in [0, THREADS_MAX + 1, 65_536, 1_000_000_000, usize::MAX] {
            let refused = thread_pool(wrong).unwrap_err();
            assert_eq!(refused.to_string(), format!("expected 1 to {THREADS_MAX}"), "{wrong}");
        }
        assert_eq!(check_threads(THREADS_MAX), Ok(()));
        assert_eq!(thread_pool(3).unwrap().current_num_threads(), 3);
    }
}
