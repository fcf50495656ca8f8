//! The minimum enclosing ball of points, of balls or of ellipsoids: one problem, one certificate, four methods.
//!
//! A method ([`core_set`], [`thesis`], [`badoiu_clarkson`]) ends with convex multipliers and the pass made from the
//! centre they mean ([`outcome`]); [`proof`] turns that into an answer and its certificate, whatever the method was.

mod active_set;
mod badoiu_clarkson;
mod conic;
mod core_set;
mod factor;
mod of_shapes;
mod options;
mod outcome;
mod proof;
mod run;
mod thesis;
mod working_set;

use taut_certify::{Ball, Items, Solution};
use taut_points::{Monitor, PointSource, Points, Scalar, on_threads};

use crate::Error;
use crate::scan::Scan;
pub use options::{BallMethod, BallOptions};
pub(crate) use proof::reach_up;

/// The smallest ball that encloses `points`, n × d.
///
/// The answer holds every point exactly, and its certificate proves that no ball of radius R/(1 + gap) does. The gap is
/// at most [`BallOptions::epsilon`] unless [`Trace::stop`](taut_certify::Trace::stop) says why not. Duplicates, points
/// in a subspace or on one sphere, and fewer points than dimensions are solved as any others.
///
/// *Cost* of the default method: a few passes of O(nd) (three to five on ordinary data, more on cospherical points),
/// beside O(k²d) for a core-set of k points and O(k²) for each of its steps; memory O(k² + kd) beside the points.
///
/// *Source.* Dual active set on a core-set; see the head of the method's module for the papers.
///
/// ```
/// use taut_enclose::{BallOptions, ball};
///
/// let corners = [0.0f32, 0.0, 3.0, 0.0, 0.0, 4.0];
/// let points = taut_points::Points::new(&corners, 2)?;
/// let found = ball(&points, &BallOptions { epsilon: 0.0, ..Default::default() })?;
/// assert_eq!(found.answer.center, [1.5, 2.0]);
/// assert_eq!(found.answer.radius, 2.5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Error::Empty`], [`Error::Input`], [`Error::Overflow`], [`Error::Input`]; [`Error::Conic`] from the methods
/// that use a conic solver.
pub fn ball<T: Scalar>(
    points: &Points<'_, T>,
    options: &BallOptions,
) -> Result<Solution<Ball>, Error> {
    ball_of_source(points, Items::Points, options, &Monitor::silent())
}

/// The smallest ball that encloses balls, given as rows of d coordinates of the centre and the radius, n × (d + 1).
///
/// Promise, cost and degenerate cases are those of [`ball()`]; a ball of radius 0 is a point.
///
/// # Errors
/// As [`ball()`], and [`Error::NoRadius`], [`Error::NegativeRadius`].
pub fn ball_of_balls<T: Scalar>(
    balls: &Points<'_, T>,
    options: &BallOptions,
) -> Result<Solution<Ball>, Error> {
    ball_of_source(balls, Items::Balls, options, &Monitor::silent())
}

/// The smallest ball that encloses ellipsoids, n × d(d + 3)/2: in each row a centre m and the lower triangle of a shape
/// matrix S, row by row, for the set {m + v : vv′ ⪯ S} ([`Items::Ellipsoids`]).
///
/// S must be positive semidefinite; it may be singular, and 0 for a point. The certificate names the points in which
/// ellipsoids touch; the radius is larger than needed by some units of the last place, so that nothing is outside. The only
/// method is [`BallMethod::CoreSet`].
///
/// *Cost.* O(nd³) once, and a dozen passes of O(nd²); n·d² numbers in memory.
///
/// ```
/// use taut_enclose::{BallOptions, ball_of_ellipsoids};
///
/// // A disc of radius 1 at the origin, and a segment from (0, 3) to (2, 3).
/// let rows = [0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 3.0, 1.0, 0.0, 0.0];
/// let rows = taut_points::Points::new(&rows, 5)?;
/// let found = ball_of_ellipsoids(&rows, &BallOptions::default())?;
/// assert!((found.answer.radius - (1.0 + 13f64.sqrt()) / 2.0).abs() < 1e-8);
/// assert!(found.check(&rows)?.gap <= 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`ball()`], and [`Error::NoShape`], [`Error::NegativeShape`].
pub fn ball_of_ellipsoids<T: Scalar>(
    ellipsoids: &Points<'_, T>,
    options: &BallOptions,
) -> Result<Solution<Ball>, Error> {
    ball_of_source(ellipsoids, Items::Ellipsoids, options, &Monitor::silent())
}

/// The smallest ball that encloses the items of a source of any size, in memory or not.
///
/// One block for each thread is held at a time, beside the core-set, and ellipsoids all at once; the answer is the same, bit by bit, for every
/// medium the rows come from. `monitor` hears of each pass and can stop the work between two blocks or two steps.
///
/// # Errors
/// As [`ball_of_balls()`] and [`ball_of_ellipsoids()`], and [`Error::Input`] when the source fails or `monitor` stops the work.
pub fn ball_of_source(
    source: &dyn PointSource,
    items: Items,
    options: &BallOptions,
    monitor: &Monitor<'_>,
) -> Result<Solution<Ball>, Error> {
    options.check()?;
    on_threads(options.threads, || solve(source, items, options, monitor))
}

fn solve(
    source: &dyn PointSource,
    items: Items,
    options: &BallOptions,
    monitor: &Monitor<'_>,
) -> Result<Solution<Ball>, Error> {
    if items == Items::Ellipsoids {
        return of_shapes::solve(source, options, monitor);
    }
    let mut scan = Scan::new(source, items, monitor)?;
    let outcome = match options.method {
        BallMethod::CoreSet => core_set::solve(&mut scan, options)?,
        BallMethod::ThesisPure => thesis::pure(&mut scan, options)?,
        BallMethod::ThesisFast => thesis::fast(&mut scan, options)?,
        BallMethod::BadoiuClarkson => badoiu_clarkson::solve(&mut scan, options)?,
    };
    proof::prove(&mut scan, outcome, options)
}
