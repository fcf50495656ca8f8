//! The minimum enclosing ball of points or of balls.

mod frank_wolfe;
mod options;

use taut_certify::{Ball, Items, Solution};
use taut_points::{Monitor, PointSource, Points, Scalar};

use crate::Error;
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
    frank_wolfe::solve(source, items, options, monitor)
}
