//! The minimum volume enclosing ellipsoid of points: one problem, one certificate, several methods.
//!
//! A method ([`rounds`], [`first_order`]) ends with convex multipliers and the pass made with the ellipsoid they mean ([`outcome`]);
//! [`proof`] turns that into an answer and its certificate, whatever the method was.

mod batch;
mod counters;
pub(crate) mod dense;
mod first_order;
mod flat;
mod fourth_moments;
mod initial;
mod interior;
mod newton;
mod nnls;
mod of_shapes;
mod options;
pub(crate) mod outcome;
pub(crate) mod point_reader;
mod proof;
pub(crate) mod question;
mod rounds;
mod sample;
mod shortlist;
mod tilt;
mod whitener;
mod working_set;

use taut_certify::{Ellipsoid, Items, Solution};
use taut_points::{Monitor, PointSource, on_threads};

use self::flat::RankResult;
use self::outcome::Outcome;
use self::point_reader::PointReader;
use self::sample::Sample;
use self::whitener::Whitener;
use crate::Error;
pub use batch::ellipsoids;
pub use options::{EllipsoidMethod, EllipsoidOptions};

/// Gap that rounding leaves, for each dimension.
const ROUNDING: f64 = 5e-15;

/// The ellipsoid of least volume that encloses points, balls or ellipsoids, of a source of any size.
///
/// `source` holds n points of dimension d; or n balls, as rows of a center and a radius ≥ 0; or n ellipsoids, as rows of a
/// center m and the lower triangle of a shape matrix S, row by row, for the set {m + v : vv′ ⪯ S}.
/// [`EllipsoidOptions::inputs`] says which; [`Items`] has the details. S may be singular.
///
/// The answer holds every input, and its certificate proves that no enclosing ellipsoid has a log-volume less by more
/// than the gap. The gap is at most [`EllipsoidOptions::epsilon`] unless [`Trace::stop`](taut_certify::Trace::stop) says
/// why not. Points in an affine subspace are solved in that subspace, and the answer says so
/// ([`Ellipsoid::hull`]); duplicates, few points and far-off points are solved as any others. The only method for balls
/// and ellipsoids is [`EllipsoidMethod::Newton`]. The answer is the same, bit by bit, for every medium the rows come from.
///
/// *Cost* of the default method: for 65 536 points or more in up to ten dimensions, one pass of O(nd²) or two; else three
/// to five passes on ordinary data, about a dozen where all points lie near one ellipsoid. Beside that, a problem of a
/// few times d² points in memory, and one block for each thread. For balls and ellipsoids a dozen passes or two, each of
/// O(d³) for an input near the border and O(d²) for any other; n·d² numbers in memory.
///
/// ```
/// use taut_certify::Items;
/// use taut_enclose::{EllipsoidOptions, ellipsoid};
/// use taut_points::Points;
///
/// let corners = [0.0f32, 0.0, 4.0, 0.0, 4.0, 2.0, 0.0, 2.0, 1.0, 1.0];
/// let points = Points::new(&corners, 2)?;
/// let found = ellipsoid(&points, &EllipsoidOptions::default())?;
/// // The ellipse through the corners of a rectangle: half axes √2 times those of the rectangle.
/// assert!((found.answer.log_volume - (4.0 * std::f64::consts::PI).ln()).abs() < 1e-12);
/// assert!((found.answer.matrix[0][0] - 1.0 / 8.0).abs() < 1e-12);
///
/// // Two unit discs, the centers 2 apart.
/// let discs = [-1.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0, 0.0, 1.0];
/// let discs = Points::new(&discs, 5)?;
/// let options = EllipsoidOptions { inputs: Items::Ellipsoids, ..Default::default() };
/// let found = ellipsoid(&discs, &options)?;
/// assert!(found.answer.norm(&[2.0, 0.0]) < 1.0 && found.answer.norm(&[1.0, 1.0]) < 1.0);
/// assert!(found.check(&discs)?.gap <= 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Error::Empty`], [`Error::Overflow`]; [`Error::Input`], also when the source fails or the monitor stops the work;
/// [`Error::NoRadius`], [`Error::NegativeRadius`]; [`Error::NoShape`], [`Error::NegativeShape`].
pub fn ellipsoid(
    source: &dyn PointSource,
    options: &EllipsoidOptions<'_>,
) -> Result<Solution<Ellipsoid>, Error> {
    options.check()?;
    on_threads(options.threads, || solve(source, options, &options.monitor))
}

/// Solves one set, without a look at the options.
fn solve(
    source: &dyn PointSource,
    options: &EllipsoidOptions<'_>,
    monitor: &Monitor<'_>,
) -> Result<Solution<Ellipsoid>, Error> {
    if options.inputs != Items::Points {
        return of_shapes::solve(source, options, monitor);
    }
    let mut reader = PointReader::new(source, monitor)?;
    match flat::decide_rank(&mut reader, options)? {
        RankResult::Flat(found) => Ok(*found),
        RankResult::Full(sample, whitener) => {
            let outcome = method(&mut reader, &sample, whitener, options)?;
            proof::prove(&mut reader, outcome, options)
        }
    }
}

/// Solves a set that does not lie in a hyperplane.
fn method(
    reader: &mut PointReader<'_>,
    sample: &Sample,
    whitener: Whitener,
    options: &EllipsoidOptions<'_>,
) -> Result<Outcome, Error> {
    match options.method {
        EllipsoidMethod::Newton => rounds::solve(reader, sample, whitener, options),
        _ => first_order::solve(reader, sample, options),
    }
}
