//! The rows of a point set along a curve, with the certificate: the order in which sites are numbered, for those who
//! want it by itself.

use taut_certify::{Order, OrderCertificate, OrderCurve, Solution, Trace};
use taut_oblivious::{hilbert_order, morton_order};
use taut_points::{
    InputError, Monitor, PointSource, Points, Rows, Scalar, Scratch, hash_points, on_threads,
};

use crate::Error;

/// Options to order points; [`Default`] is what most people want.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OrderOptions<'a> {
    /// Along which curve. Default [`OrderCurve::Hilbert`].
    pub curve: OrderCurve,
    /// Threads to use, 1 to 1024; `None` takes those of the current rayon pool. The answer does not depend on it.
    pub threads: Option<usize>,
    /// Watches the work and can stop it before it begins. Default [`Monitor::silent`].
    pub monitor: Monitor<'a>,
}

/// The rows of points of the plane or of space in the order of a Hilbert curve through them, or in Z-order.
///
/// The order depends on the set of points alone; equal points are side by side, the first row first. O(n log n);
/// 12 bytes a point while it runs, beside the points themselves.
///
/// # Errors
/// [`Error::Input`] for other dimensions than two and three, for 2³² points or more, for points that are not finite, when
/// the source fails and when the monitor stops the work.
///
/// ```
/// use taut_delaunay::{OrderOptions, spatial_order};
/// use taut_points::Points;
///
/// let square = Points::new(&[0.0, 0.0, 1.0, 1.0, 0.0, 1.0, 1.0, 0.0], 2)?;
/// let found = spatial_order(&square, &OrderOptions::default())?;
/// assert_eq!(found.answer.rows, [0, 2, 1, 3]);                 // along the sides, never across
/// assert!(found.check(&square).is_ok());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn spatial_order(
    source: &dyn PointSource,
    options: &OrderOptions<'_>,
) -> Result<Solution<Order>, Error> {
    on_threads(options.threads, || solve(source, options.curve, &options.monitor))
}

fn solve(
    source: &dyn PointSource,
    curve: OrderCurve,
    monitor: &Monitor<'_>,
) -> Result<Solution<Order>, Error> {
    let dim = source.dim();
    if !(2..=3).contains(&dim) {
        return Err(Error::Input(InputError::Dimension {
            dim,
            expected: "2, the plane, or 3, space",
        }));
    }
    let most = u64::from(u32::MAX);
    if source.len() > most {
        return Err(Error::Input(InputError::TooManyPoints { points: source.len(), most }));
    }
    monitor.check()?;
    let mut scratch = Scratch::new();
    let rows = source.read(0..source.len(), &mut scratch)?;
    rows.check_finite(0)?;
    let rows = match rows {
        Rows::F32(points) => order(&points, curve),
        Rows::F64(points) => order(&points, curve),
    };
    let points_hash = hash_points(source, monitor)?;
    Ok(Solution {
        answer: Order { curve, rows: rows.into_iter().map(u64::from).collect() },
        certificate: OrderCertificate { points_hash },
        trace: Trace { method: "grids".to_owned(), passes: 1, ..Trace::default() },
    })
}

fn order<T: Scalar>(points: &Points<'_, T>, curve: OrderCurve) -> Vec<u32> {
    let plane = |i: usize| std::array::from_fn(|axis| points.row(i)[axis].into());
    let space = |i: usize| std::array::from_fn(|axis| points.row(i)[axis].into());
    match (curve, points.dim()) {
        (OrderCurve::Hilbert, 2) => hilbert_order::<2>(points.len(), plane),
        (OrderCurve::Hilbert, _) => hilbert_order::<3>(points.len(), space),
        (OrderCurve::Morton, 2) => morton_order::<2>(points.len(), plane),
        (OrderCurve::Morton, _) => morton_order::<3>(points.len(), space),
    }
}
