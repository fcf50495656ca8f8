//! The checker of the ellipsoid, in arithmetic of its own.
//!
//! *Problem.* Given rows that stand for points, balls or ellipsoids, an ellipsoid E = {x : |F(x − c)| ≤ 1} with F of r
//! rows, and multipliers uᵢ > 0 on a few rows, prove that E encloses all rows but those left out, and that no enclosing
//! ellipsoid has a log-volume below that of E by more than the gap.
//! *Idea.* Everything is judged in the frame of the answer, y = F(x − c), where E is the unit ball and a good answer
//! makes all matrices nearly I. So neither scale, offset nor the ratio of the axes costs digits.
//! - Upper bound: |y| ≤ 1 + excess for all rows, in one pass: [`enclosure`], for balls and ellipsoids [`reach`]. E enlarged
//!   by 1 + excess encloses them, so r·log(1 + excess) is added to the gap.
//! - Lower bound: −½ log det W for the weighted covariance W of the support, in doubled precision: [`lower_bound`].
//! - The rest of the answer says the same in other words: matrix and log-volume in [`agreement`], the flat in [`hull`].
//!
//! *Flat sets.* With r < d rows in F the images y are those of the projection to the hull, and the claim is about them:
//! no ellipsoid of dimension r that encloses the projections has less volume. That the set is flat is itself judged.
//! *Rows left out.* They take no part in anything but the hash; each must reach outside, so that the list is exactly
//! that of the rows not enclosed.
//! *Order.* Structure, agreement, one pass (finite rows, hash, enclosure), then the support rows as that pass read them (gap).
//! *Cost.* A pass of nr(d + 1)/2 multiplications for a triangular F and points, O(n(rd² + r³)) for ellipsoids;
//! O(kr²) for k rows of support and O(dr² + r³), in doubled precision. Memory: O(d²) beside a block for each thread.
//! *Tolerances.* They only ask that stated numbers are what they are said to be, up to what writing them down as `f64`
//! costs, and weaken neither bound; each is derived where it stands.

pub(crate) mod agreement;
pub(crate) mod enclosure;
pub(crate) mod frame;
pub(crate) mod hull;
pub(crate) mod item;
pub(crate) mod lower_bound;
mod panel;
pub(crate) mod parts;
pub(crate) mod reach;
pub(crate) mod structure;

use taut_points::{Monitor, PointSource};

use self::agreement::{Difference, LogVolume};
use self::enclosure::{Enclosed, Enclosure};
use self::frame::Frame;
use self::hull::HullTest;
use super::{Ellipsoid, EllipsoidCertificate, EllipsoidVerdict};
use crate::arithmetic::U;
use crate::hashed_pass::KeptRows;
use crate::{CheckError, Violation};

/// The amount by which the gap claimed may fall short of the gap proved, relatively and for each dimension.
///
/// A solver finds its gap in arithmetic of its own, from an ellipsoid of which each axis is rounded by a few units in the
/// last place.
const GAP_SLACK: (f64, f64) = (1e-9, 2e-15);

/// By how much a gap may be negative, for each dimension: items may reach outside by 1e-12, and what rounding the entries
/// of a singular shape matrix does to the points it touches at is less.
const GAP_BELOW: f64 = 1e-12;

/// `pass` is the number of the pass over the points that it makes, for the monitor.
pub(crate) fn check(
    ellipsoid: &Ellipsoid,
    certificate: &EllipsoidCertificate,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
    pass: u64,
) -> Result<EllipsoidVerdict, CheckError> {
    structure::check(ellipsoid, certificate, source.len(), source.dim())?;
    let frame = Frame::of(ellipsoid);
    let difference = agreement::matrix(ellipsoid, &frame)?;
    let hull = ellipsoid.hull.as_ref().map(|hull| HullTest::of(&frame, hull));
    if let Some(hull) = &hull {
        hull.check(&frame)?;
    }
    let log_volume = agreement::log_volume(ellipsoid, &frame)?;
    monitor.pass(pass, source.len());
    let enclosure = Enclosure::of(&frame, hull.as_ref(), certificate);
    let (enclosed, support) = enclosure.check(source, certificate, monitor)?;
    if let Some(hull) = &hull {
        hull.is_flat(certificate.items, source.scalar(), &enclosed)?;
    }
    let stated = Stated { frame: &frame, difference, log_volume };
    conclude(certificate, &stated, &enclosed, &support, monitor)
}

/// The frame of an answer, and how far what it states besides is from that.
struct Stated<'a> {
    frame: &'a Frame<'a>,
    difference: Difference,
    log_volume: LogVolume,
}

/// The verdict, once all items are known to be enclosed.
fn conclude(
    certificate: &EllipsoidCertificate,
    stated: &Stated<'_>,
    enclosed: &Enclosed,
    support: &KeptRows,
    monitor: &Monitor<'_>,
) -> Result<EllipsoidVerdict, CheckError> {
    let Stated { frame, difference, log_volume } = stated;
    let rank = frame.rank as f64;
    let enlarged = rank * enclosed.excess;
    let gap =
        (lower_bound::gap(frame, certificate, support, monitor)? + enlarged) * (1.0 + 4.0 * U);
    let (relative, absolute) = GAP_SLACK;
    let is_proved = gap <= certificate.gap * (1.0 + relative) + absolute * rank && gap.is_finite();
    if !is_proved {
        return Err(Violation::LogGap { claimed: certificate.gap, proved: gap }.into());
    }
    if gap < -GAP_BELOW * rank {
        return Err(Violation::NegativeGap { gap }.into());
    }
    let gap = gap.max(0.0);
    let LogVolume { value, error } = *log_volume;
    // A single point has log-volume 0, and nothing is rounded.
    let (lower, upper) = match frame.rank {
        0 => (0.0, 0.0),
        _ => {
            let below = error + (gap - enlarged).max(0.0);
            let above = error + enlarged;
            let rounding = |side: f64| 4.0 * U * (value.abs() + side);
            (value - (below + rounding(below)), value + (above + rounding(above)))
        }
    };
    let twice = enclosed.excess * (2.0 + enclosed.excess);
    let matrix_excess = (difference.bound(&enclosed.extents) + twice) * (1.0 + 16.0 * U);
    Ok(EllipsoidVerdict {
        lower,
        upper,
        gap,
        excess: enclosed.excess,
        matrix_excess: if matrix_excess.is_nan() { f64::INFINITY } else { matrix_excess },
        off_hull: enclosed.off_hull,
        rank: frame.rank,
    })
}
