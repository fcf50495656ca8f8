//! The minimum enclosing ball of points or of balls.

mod active_set;
mod badoiu_clarkson;
mod conic;
mod core_set;
mod factor;
mod options;
mod outcome;
mod proof;
mod run;
mod thesis;
mod working_set;

use taut_certify::{Ball, Items, Solution};
use taut_points::{Monitor, PointSource, Points, Scalar};

use crate::Error;
use crate::scan::Scan;
pub use options::{BallMethod, BallOptions};

/// The smallest ball that encloses `points`.
///
/// # Errors
/// [`Error::Empty`], [`Error::NonFinite`], [`Error::Overflow`], [`Error::Option`].
pub fn ball<T: Scalar>(
    points: &Points<'_, T>,
    options: &BallOptions,
) -> Result<Solution<Ball>, Error> {
    ball_of_source(points, Items::Points, options, &Monitor::silent())
}

/// The smallest ball that encloses balls, given as rows of d coordinates of the centre and the radius.
///
/// # Errors
/// As [`ball()`], and [`Error::NoRadius`], [`Error::NegativeRadius`].
pub fn ball_of_balls<T: Scalar>(
    balls: &Points<'_, T>,
    options: &BallOptions,
) -> Result<Solution<Ball>, Error> {
    ball_of_source(balls, Items::Balls, options, &Monitor::silent())
}

/// The smallest ball that encloses the items of a source of any size.
///
/// # Errors
/// As [`ball_of_balls()`], and [`Error::Read`] when the source fails or `monitor` stops the work.
pub fn ball_of_source(
    source: &dyn PointSource,
    items: Items,
    options: &BallOptions,
    monitor: &Monitor<'_>,
) -> Result<Solution<Ball>, Error> {
    options.check()?;
    let Some(threads) = options.threads else { return solve(source, items, options, monitor) };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(|_| {
        Error::Option {
            name: "threads",
            value: threads.to_string(),
            expected: "as many threads as the system grants",
        }
    })?;
    pool.install(|| solve(source, items, options, monitor))
}

fn solve(
    source: &dyn PointSource,
    items: Items,
    options: &BallOptions,
    monitor: &Monitor<'_>,
) -> Result<Solution<Ball>, Error> {
    let mut scan = Scan::new(source, items, monitor)?;
    let outcome = match options.method {
        BallMethod::CoreSet => core_set::solve(&mut scan, options)?,
        BallMethod::ThesisPure => thesis::pure(&mut scan, options)?,
        BallMethod::ThesisFast => thesis::fast(&mut scan, options)?,
        BallMethod::BadoiuClarkson => badoiu_clarkson::solve(&mut scan, options)?,
    };
    proof::prove(&mut scan, outcome, options)
}
