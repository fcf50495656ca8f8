//! Work on a chosen number of threads.

use crate::Error;

/// Does `work` on that many threads, or on those of the surrounding pool.
pub(crate) fn on_threads<R: Send>(
    threads: Option<usize>,
    work: impl FnOnce() -> Result<R, Error> + Send,
) -> Result<R, Error> {
    let Some(threads) = threads else { return work() };
    let wrong = |expected| Error::Option { name: "threads", value: threads.to_string(), expected };
    if threads == 0 {
        return Err(wrong("at least 1"));
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|_| wrong("as many threads as the system grants"))?.install(work)
}
