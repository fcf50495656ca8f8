//! Many small problems at once: an ellipsoid for each of many point sets.
//!
//! *Idea.* Sets are independent, so threads share out sets instead of blocks of one set; a set of one block is solved by
//! one thread without any other hearing of it.
//! *Guarantee.* Each answer is that of its set alone, byte by byte, for any number of threads; of several sets that cannot
//! be solved the first is named.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::iter::{IntoParallelIterator, ParallelIterator};
use taut_certify::{Ellipsoid, Solution};
use taut_points::{InputError, Monitor, PointSource, ReadError, on_threads};

use super::{EllipsoidOptions, solve};
use crate::Error;

/// The ellipsoid of least volume of each of `sets`, in their order; sets may differ in size and dimension.
///
/// Each is the answer of [`ellipsoid()`](super::ellipsoid) for that set, with a certificate of its own. Cut a table of
/// points into sets by views of its rows. The monitor is told of one pass over all points.
///
/// *Cost.* That of the sets, shared by all threads.
///
/// ```
/// use taut_enclose::{EllipsoidOptions, ellipsoids};
/// use taut_points::Points;
///
/// // A triangle, a segment and a single point, one after the other in one table of six rows.
/// let table = [0.0, 0.0, 2.0, 0.0, 0.0, 2.0, 5.0, 5.0, 7.0, 5.0, 9.0, 9.0];
/// let starts = [0, 3, 5, 6];
/// let cut = |ends: &[usize]| Points::new(&table[2 * ends[0]..2 * ends[1]], 2);
/// let sets = starts.windows(2).map(cut).collect::<Result<Vec<_>, _>>()?;
///
/// let found = ellipsoids(&sets, &EllipsoidOptions::default())?;
/// let ranks: Vec<usize> = found.iter().map(|found| found.answer.rank()).collect();
/// assert_eq!(ranks, [2, 1, 0]);
/// for (found, set) in found.iter().zip(&sets) {
///     assert!(found.check(set)?.gap <= 1e-9);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Error::Set`] with the number of the first set that cannot be solved, and why; [`Error::Input`] when an option is
/// out of range or the monitor stops the work.
pub fn ellipsoids<S: PointSource>(
    sets: &[S],
    options: &EllipsoidOptions<'_>,
) -> Result<Vec<Solution<Ellipsoid>>, Error> {
    let monitor = &options.monitor;
    options.check()?;
    monitor.pass(1, sets.iter().map(PointSource::len).sum());
    let within = Monitor { cancel: monitor.cancel, ..Monitor::silent() };
    // Sets beyond one that failed are not begun; all before it are, so that the first is known.
    let failed = AtomicUsize::new(usize::MAX);
    let one = |set: usize| {
        if set > failed.load(Ordering::Relaxed) {
            return None;
        }
        let found = monitor
            .check()
            .map_err(|cancelled| ReadError::from(cancelled).into())
            .and_then(|()| solve(&sets[set], options, &within));
        match &found {
            Ok(_) => monitor.points(sets[set].len()),
            Err(_) => {
                failed.fetch_min(set, Ordering::Relaxed);
            }
        }
        Some(found)
    };
    let found: Vec<Option<Result<Solution<Ellipsoid>, Error>>> =
        on_threads(options.threads, || {
            Ok::<_, Error>((0..sets.len()).into_par_iter().map(one).collect())
        })?;
    let found = found.into_iter().enumerate();
    found
        .filter_map(|(set, found)| found.map(|found| found.map_err(|error| named(set, error))))
        .collect()
}

/// The error of one set, with its number, unless it is about all of them.
fn named(set: usize, error: Error) -> Error {
    match error {
        Error::Input(InputError::Read(ReadError::Cancelled(_)) | InputError::Cancelled(_)) => error,
        error => Error::Set { set: set as u64, error: Box::new(error) },
    }
}
