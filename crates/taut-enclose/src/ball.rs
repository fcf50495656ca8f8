//! The minimum enclosing ball of points, of balls or of ellipsoids: one problem, one certificate, four methods.
//!
//! A method ([`core_set`], [`thesis`], [`badoiu_clarkson`]) ends with convex multipliers and the pass made from the
//! center they mean ([`outcome`]); [`proof`] turns that into an answer and its certificate, whatever the method was.

mod active_set;
mod badoiu_clarkson;
#[cfg(feature = "conic")]
mod conic;
mod core_set;
mod factor;
mod interior;
mod interior_rounds;
mod of_shapes;
mod options;
mod outcome;
mod proof;
mod run;
mod shortlist;
#[cfg(feature = "conic")]
mod thesis;
mod working_set;

use taut_certify::{Ball, Items, Solution};
#[cfg(not(feature = "conic"))]
use taut_points::InputError;
use taut_points::{PointSource, on_threads};

use crate::Error;
use crate::item_reader::ItemReader;
pub use options::{BallMethod, BallOptions};
pub(crate) use proof::reach_up;

/// The smallest ball that encloses points, balls or ellipsoids, of a source of any size.
///
/// `source` holds n points of dimension d; or n balls, as rows of a center and a radius ≥ 0; or n ellipsoids, as rows of a
/// center m and the lower triangle of a shape matrix S, row by row, for the set {m + v : vv′ ⪯ S}.
/// [`BallOptions::inputs`] says which; [`Items`] has the details. A ball of radius 0 is a point, and S may be singular.
///
/// The answer holds every input exactly, and its certificate proves that no ball of radius R/(1 + gap) does. The gap is
/// at most [`BallOptions::epsilon`] unless [`Trace::stop`](taut_certify::Trace::stop) says why not. Duplicates, points
/// in a subspace or on one sphere, and fewer points than dimensions are solved as any others. Around ellipsoids the
/// radius is larger than needed by some units of the last place, so that nothing is outside, and the only method is
/// [`BallMethod::CoreSet`]. The answer is the same, bit by bit, for every medium the rows come from.
///
/// *Cost* of the default method: for 65 536 points or more in three to 32 dimensions, one pass of O(nd) on ordinary data; else
/// three to five, and more on cospherical points; beside O(k²d) for a core-set of k points and O(k²) for each of its steps, and near a sphere about 40 steps of O(kd²);
/// in memory, O(k² + kd) and one block for each thread. For ellipsoids O(nd³) once and a dozen passes of O(nd²), with n·d² numbers in memory.
///
/// *Source.* Dual active set on a core-set; see the head of the method's module for the papers.
///
/// ```
/// use taut_certify::Items;
/// use taut_enclose::{BallOptions, ball};
/// use taut_points::Points;
///
/// let corners = [0.0f32, 0.0, 3.0, 0.0, 0.0, 4.0];
/// let points = Points::new(&corners, 2)?;
/// let found = ball(&points, &BallOptions { epsilon: 0.0, ..Default::default() })?;
/// assert_eq!(found.answer.center, [1.5, 2.0]);
/// assert_eq!(found.answer.radius, 2.5);
///
/// // A disc of radius 1 at the origin, and a segment from (0, 3) to (2, 3).
/// let rows = [0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 3.0, 1.0, 0.0, 0.0];
/// let rows = Points::new(&rows, 5)?;
/// let found = ball(&rows, &BallOptions { inputs: Items::Ellipsoids, ..Default::default() })?;
/// assert!((found.answer.radius - (1.0 + 13f64.sqrt()) / 2.0).abs() < 1e-8);
/// assert!(found.check(&rows)?.gap <= 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Error::Empty`], [`Error::Overflow`]; [`Error::Input`], also when the source fails or the monitor stops the work;
/// [`Error::Conic`] from the methods that use a conic solver; [`Error::NoRadius`], [`Error::NegativeRadius`];
/// [`Error::NoShape`], [`Error::NegativeShape`].
pub fn ball(source: &dyn PointSource, options: &BallOptions<'_>) -> Result<Solution<Ball>, Error> {
    options.check()?;
    on_threads(options.threads, || solve(source, options))
}

fn solve(source: &dyn PointSource, options: &BallOptions<'_>) -> Result<Solution<Ball>, Error> {
    if options.inputs == Items::Ellipsoids {
        return of_shapes::solve(source, options, &options.monitor);
    }
    let mut reader = ItemReader::new(source, options.inputs, &options.monitor)?;
    let outcome = match options.method {
        BallMethod::CoreSet => core_set::solve(&mut reader, options)?,
        #[cfg(feature = "conic")]
        BallMethod::ThesisPure => thesis::pure(&mut reader, options)?,
        #[cfg(feature = "conic")]
        BallMethod::ThesisFast => thesis::fast(&mut reader, options)?,
        #[cfg(not(feature = "conic"))]
        method @ (BallMethod::ThesisPure | BallMethod::ThesisFast) => {
            return Err(Error::Input(InputError::Option {
                name: "method",
                value: method.name().to_owned(),
                expected: "core-set or badoiu-clarkson, as this program is built without a conic solver",
            }));
        }
        BallMethod::BadoiuClarkson => badoiu_clarkson::solve(&mut reader, options)?,
    };
    proof::prove(&mut reader, outcome, options)
}
