//! Work on a chosen number of threads.

use taut_points::{ThreadsError, thread_pool};

use crate::Error;

/// Does `work` on that many threads, or on those of the surrounding pool.
pub(crate) fn on_threads<R: Send>(
    threads: Option<usize>,
    work: impl FnOnce() -> Result<R, Error> + Send,
) -> Result<R, Error> {
    let Some(threads) = threads else { return work() };
    let wrong = |refused: ThreadsError| Error::Option {
        name: "threads",
        value: threads.to_string(),
        expected: refused.expected,
    };
    thread_pool(threads).map_err(wrong)?.install(work)
}
