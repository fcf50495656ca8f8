//! Farthest-first traversal: an order of points whose every beginning is a good set of centers.
//!
//! *Problem.* For each k ≤ `count` at once, k of n points such that all points are near one of them.
//! *Idea.* Each next point is the one that is farthest from all before it. That it is so far away proves, with those before
//! it, that no k balls of half the radius hold all points.
//! *Guarantee.* The first k points have at most twice the radius of the best k centers, wherever those may be, for every k.
//! Distances are those of the kernel, and of equal ones the lower row is taken: what is skipped on the way changes nothing.
//! *How it is fast.* In three ways that skip what cannot matter, [`lazy`] for all points, [`boxes`] in up to three
//! dimensions, [`rows`] in more; [`blocks`] is for points that are not in memory, [`parts`] for those that lie elsewhere.
//! *Reference.* Gonzalez, Theoretical Computer Science 38, 1985.

mod blocks;
mod boxes;
mod chosen;
mod lazy;
mod parts;
mod prefix;
mod rows;

use taut_certify::Trace;
use taut_points::{
    Elsewhere, InputError, Monitor, PointSource, Points, PointsHash, Rows, Scalar, on_threads,
};

use crate::Error;
use crate::frame::{Frame, frame_pass};
use lazy::Job;
pub(crate) use parts::Shortlist;

/// Up to this many dimensions a box around neighbors says enough about them. Beyond, boxes are nearly as large as the whole.
const DIM_OF_BOXES_MAX: usize = 3;

/// Options to go through the points. Write `FarthestFirstOptions { start: 7, ..Default::default() }`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FarthestFirstOptions<'a> {
    /// The row of the first point, below n. Default 0.
    pub start: u64,
    /// Threads, 1 to 1024; `None` for those of the surrounding pool. The order does not depend on it.
    pub threads: Option<usize>,
    /// Watches the work and can stop it. Default [`Monitor::silent`].
    pub monitor: Monitor<'a>,
}

/// Points in farthest-first order, and how far the others are from each beginning of it.
#[derive(Clone, Debug, PartialEq)]
pub struct FarthestFirst {
    /// Rows, each the one farthest from all before it. Shorter than asked for where all other points are copies of these.
    pub order: Vec<u64>,
    /// `radii[k − 1]` is the largest distance of a point to the nearest of the first k, never more than the one before it.
    /// No k balls of a radius below its half hold all points. To (d/16 + 10)·2⁻⁵³ of its size.
    pub radii: Vec<f64>,
    /// The row that would come next; `None` where all points are copies of those in `order`.
    pub next: Option<u64>,
    /// The hash of the points.
    pub points_hash: PointsHash,
    /// The way in which it came about. `passes` counts reads of a part of the points by their share; the counter `distances` says how
    /// many were evaluated, of the n·count that there are, and `parts` how often a part of the points was looked at.
    pub trace: Trace,
}

/// The first `count` points of a source of any size in farthest-first order.
///
/// It ends before `count` when all other points are copies of those it has, with a radius of 0; n may be less than `count`.
///
/// *Cost.* O(n·count·d) at worst, and far less where distances can be ruled out: for 1000 of ten million points of a cube in
/// space 6 distances are evaluated for each point, for 1000 of a million normal points in 128 dimensions 11, as
/// `bench centers` counts them. Memory beside the points: n numbers of 8 bytes, and 8 bytes more for each point in four
/// dimensions or more; in up to three, n·d numbers and, to begin with, 16 bytes for each point.
/// Points that are not in memory take 8 bytes each and a block for each thread; a block is read again only when the next
/// point may be in it, so there are far fewer passes than points asked for. The order is the same, bit by bit.
///
/// *Source.* Gonzalez 1985; skipped are distances that cannot matter, as in the accelerated greedy of Minoux (1978) and by
/// the triangle inequality (Elkan 2003).
///
/// ```
/// use taut_enclose::{FarthestFirstOptions, farthest_first};
///
/// let towns = [0.0, 0.0, 1.0, 0.0, 10.0, 0.0, 10.0, 2.0];
/// let towns = taut_points::Points::new(&towns, 2)?;
/// let found = farthest_first(&towns, 3, &FarthestFirstOptions::default())?;
/// assert_eq!(found.order, [0, 3, 2]);
/// assert_eq!(found.radii[1..], [2.0, 1.0]);
/// assert_eq!(found.next, Some(1));                         // 1 away from point 0: no three balls are smaller than ½
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Error::Empty`], [`Error::Input`] when `count` is 0, an option is out of range, the source fails or the monitor stops the work;
/// [`Error::Overflow`] when a radius is beyond the largest `f64`, or the points that are left differ from those in the
/// order by less than 2⁻²⁵⁰ of the extent of all.
pub fn farthest_first(
    source: &dyn PointSource,
    count: u64,
    options: &FarthestFirstOptions<'_>,
) -> Result<FarthestFirst, Error> {
    match source.in_memory() {
        Some(Rows::F32(points)) => of_points(&points, count, options),
        Some(Rows::F64(points)) => of_points(&points, count, options),
        None => farthest_first_in_blocks(source, count, options),
    }
}

/// The order of points in memory.
fn of_points<T: Scalar>(
    points: &Points<'_, T>,
    count: u64,
    options: &FarthestFirstOptions<'_>,
) -> Result<FarthestFirst, Error> {
    on_threads(options.threads, || {
        let job = prepare(points, count, options)?;
        if points.dim() <= DIM_OF_BOXES_MAX && u32::try_from(points.len()).is_ok() {
            return job.run(boxes::leaves(points, &job.frame));
        }
        if job.frame.is_plain() {
            return job.run(rows::leaves(points));
        }
        let copy = job.frame.copy(points);
        let copy = Points::new(&copy, points.dim()).expect("the shape is that of the points");
        job.run(rows::leaves(&copy))
    })
}

/// The same order, with one block for each thread in memory, wherever the points are.
pub(crate) fn farthest_first_in_blocks(
    source: &dyn PointSource,
    count: u64,
    options: &FarthestFirstOptions<'_>,
) -> Result<FarthestFirst, Error> {
    on_threads(options.threads, || {
        let job = prepare(source, count, options)?;
        match source.elsewhere() {
            Some(elsewhere) => parts::run(&job, elsewhere),
            None => job.run(blocks::leaves(source, &job.frame)),
        }
    })
}

/// The same order of points that lie elsewhere, and the units of its distances.
pub(crate) fn farthest_first_in_parts(
    source: &dyn PointSource,
    elsewhere: &dyn Elsewhere,
    count: u64,
    options: &FarthestFirstOptions<'_>,
) -> Result<(FarthestFirst, Frame), Error> {
    parts::with_frame(prepare(source, count, options)?, elsewhere)
}

/// Looks at the options and at every coordinate.
fn prepare<'a>(
    source: &'a dyn PointSource,
    count: u64,
    options: &'a FarthestFirstOptions<'_>,
) -> Result<Job<'a>, Error> {
    if count == 0 {
        return Err(Error::Input(InputError::Option {
            name: "count",
            value: "0".into(),
            expected: "at least 1",
        }));
    }
    if source.is_empty() {
        return Err(Error::Empty);
    }
    if options.start >= source.len() {
        return Err(Error::Input(InputError::Option {
            name: "start",
            value: options.start.to_string(),
            expected: "the number of a row, from 0 and below the number of rows",
        }));
    }
    let frame_pass = frame_pass(source, &options.monitor)?;
    Ok(Job {
        source,
        monitor: &options.monitor,
        count,
        start: options.start,
        frame: frame_pass.frame,
        points_hash: frame_pass.hash,
    })
}
