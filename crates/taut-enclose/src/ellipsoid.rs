//! The minimum volume enclosing ellipsoid of points: one problem, one certificate, several methods.
//!
//! A method ([`rounds`], [`first_order`]) ends with convex multipliers and the pass made with the ellipsoid they mean ([`outcome`]);
//! [`proof`] turns that into an answer and its certificate, whatever the method was.

mod batch;
mod counters;
pub(crate) mod dense;
mod factor;
mod first_order;
mod flat;
mod initial;
mod interior;
mod newton;
mod nnls;
mod of_shapes;
mod options;
pub(crate) mod outcome;
mod pool;
mod proof;
mod rounds;
mod sample;
mod shortlist;
pub(crate) mod survey;
mod whitener;

use taut_certify::{Ellipsoid, Items, Solution};
use taut_points::{Monitor, PointSource, Points, Scalar, on_threads};

use self::flat::Look;
use self::outcome::Outcome;
use self::sample::Sample;
use self::survey::Survey;
use self::whitener::Whitener;
use crate::Error;
pub use batch::{ellipsoids, ellipsoids_of_sources};
pub(crate) use dense::cholesky;
pub use options::{EllipsoidMethod, EllipsoidOptions};
pub(crate) use outcome::log_unit_ball;

/// Gap that rounding leaves, for each dimension.
const ROUNDING: f64 = 5e-15;

/// The ellipsoid of least volume that encloses `points`, n × d.
///
/// The answer holds every point, and its certificate proves that no enclosing ellipsoid has a log-volume less by more
/// than the gap. The gap is at most [`EllipsoidOptions::epsilon`] unless [`Trace::stop`](taut_certify::Trace::stop) says
/// why not. Points in an affine subspace are solved in that subspace, and the answer says so
/// ([`Ellipsoid::hull`]); duplicates, few points and far-off points are solved as any others.
///
/// *Cost* of the default method: for 65 536 points or more in up to ten dimensions, one pass of O(nd²) or two; else three
/// to five passes on ordinary data, about a dozen where all points lie near one ellipsoid. Beside that, a problem of a
/// few times d² points in memory.
///
/// ```
/// use taut_enclose::{EllipsoidOptions, ellipsoid};
///
/// let corners = [0.0f32, 0.0, 4.0, 0.0, 4.0, 2.0, 0.0, 2.0, 1.0, 1.0];
/// let points = taut_points::Points::new(&corners, 2)?;
/// let found = ellipsoid(&points, &EllipsoidOptions::default())?;
/// // The ellipse through the corners of a rectangle: half axes √2 times those of the rectangle.
/// assert!((found.answer.log_volume - (4.0 * std::f64::consts::PI).ln()).abs() < 1e-12);
/// assert!((found.answer.matrix[0][0] - 1.0 / 8.0).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Error::Empty`], [`Error::Input`], [`Error::Overflow`], [`Error::Input`].
pub fn ellipsoid<T: Scalar>(
    points: &Points<'_, T>,
    options: &EllipsoidOptions,
) -> Result<Solution<Ellipsoid>, Error> {
    ellipsoid_of_source(points, options, &Monitor::silent())
}

/// The ellipsoid of least volume that encloses `balls`, n × (d + 1): in each row a centre and a radius ≥ 0.
///
/// As [`ellipsoid_of_ellipsoids`] for Sᵢ = rᵢ²I.
///
/// # Errors
/// As [`ellipsoid_of_items`].
pub fn ellipsoid_of_balls<T: Scalar>(
    balls: &Points<'_, T>,
    options: &EllipsoidOptions,
) -> Result<Solution<Ellipsoid>, Error> {
    ellipsoid_of_items(balls, Items::Balls, options, &Monitor::silent())
}

/// The ellipsoid of least volume that encloses `ellipsoids`, n × d(d + 3)/2: in each row a centre m and the lower
/// triangle of a shape matrix S, row by row, for the set {m + v : vv′ ⪯ S} ([`Items::Ellipsoids`]).
///
/// S must be positive semidefinite; it may be singular, and 0 for a point. The certificate names the points in which
/// items touch. The only method is [`EllipsoidMethod::Newton`].
///
/// *Cost.* A dozen passes or two over the items, each of O(d³) for items near the border and O(d²) for others; n·d²
/// numbers in memory.
///
/// ```
/// use taut_enclose::{EllipsoidOptions, ellipsoid_of_ellipsoids};
///
/// // Two unit discs, the centres 2 apart.
/// let discs = [-1.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0, 0.0, 1.0];
/// let discs = taut_points::Points::new(&discs, 5)?;
/// let found = ellipsoid_of_ellipsoids(&discs, &EllipsoidOptions::default())?;
/// assert!(found.answer.norm(&[2.0, 0.0]) < 1.0 && found.answer.norm(&[1.0, 1.0]) < 1.0);
/// assert!(found.check(&discs)?.gap <= 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`ellipsoid_of_items`].
pub fn ellipsoid_of_ellipsoids<T: Scalar>(
    ellipsoids: &Points<'_, T>,
    options: &EllipsoidOptions,
) -> Result<Solution<Ellipsoid>, Error> {
    ellipsoid_of_items(ellipsoids, Items::Ellipsoids, options, &Monitor::silent())
}

/// The ellipsoid of least volume that encloses the items of a source.
///
/// Points are read as [`ellipsoid_of_source`] does; balls and ellipsoids are held in memory. `monitor` hears of each
/// pass and can stop the work.
///
/// # Errors
/// As [`ellipsoid_of_source`], and [`Error::NoRadius`], [`Error::NegativeRadius`], [`Error::NoShape`],
/// [`Error::NegativeShape`].
pub fn ellipsoid_of_items(
    source: &dyn PointSource,
    items: Items,
    options: &EllipsoidOptions,
    monitor: &Monitor<'_>,
) -> Result<Solution<Ellipsoid>, Error> {
    options.check()?;
    on_threads(options.threads, || match items {
        Items::Points => solve(source, options, monitor),
        Items::Balls | Items::Ellipsoids => of_shapes::solve(source, items, options, monitor),
    })
}

/// The ellipsoid of least volume that encloses the points of a source of any size, in memory or not.
///
/// One block for each thread is held at a time, beside the pool; the answer is the same, bit by bit, for every medium
/// the rows come from. `monitor` hears of each pass and can stop the work between two blocks or two steps.
///
/// # Errors
/// As [`ellipsoid()`], and [`Error::Input`] when the source fails or `monitor` stops the work.
pub fn ellipsoid_of_source(
    source: &dyn PointSource,
    options: &EllipsoidOptions,
    monitor: &Monitor<'_>,
) -> Result<Solution<Ellipsoid>, Error> {
    ellipsoid_of_items(source, Items::Points, options, monitor)
}

fn solve(
    source: &dyn PointSource,
    options: &EllipsoidOptions,
    monitor: &Monitor<'_>,
) -> Result<Solution<Ellipsoid>, Error> {
    let mut survey = Survey::new(source, monitor)?;
    match flat::look(&mut survey, options)? {
        Look::Flat(found) => Ok(*found),
        Look::Full(sample, whitener) => {
            let outcome = method(&mut survey, &sample, whitener, options)?;
            proof::prove(&mut survey, outcome, options)
        }
    }
}

/// Solves a set that does not lie in a hyperplane.
fn method(
    survey: &mut Survey<'_>,
    sample: &Sample,
    whitener: Whitener,
    options: &EllipsoidOptions,
) -> Result<Outcome, Error> {
    match options.method {
        EllipsoidMethod::Newton => rounds::solve(survey, sample, whitener, options),
        _ => first_order::solve(survey, sample, options),
    }
}
