//! The checker of robust ellipsoids, in arithmetic of its own.
//!
//! *Problem.* Given points, a list of those kept, centre, scatter and flags: are they what the method makes of the
//! points kept, and do the points kept leave nothing to improve by a C-step?
//! *Idea.* Everything is judged in the frame of the answer, y = F(x − c), where scatters are nearly multiples of I.
//! 1. One pass in doubled precision: hash, moments of the rows kept and of those not weighed out, flags.
//! 2. From these: centre, scatter, objective; factors by series of their own ([`factors`]).
//! 3. A second pass: distances in the metric of the rows kept. No row kept may be farther than a row left out, and the
//!    rows weighed out must be those beyond the quantile.
//!
//! By `mve` and `trim` the ellipsoid around the rows kept is judged by the checker of ellipsoids, which makes its own
//! pass, and takes the place of the first metric.
//! *Not judged.* Whether other rows would do better than those kept: no polynomial proof of that is known.
//! *Tolerances.* Rows at a border may be on either side of it by [`SLACK`], and by what the digits of the coordinates
//! leave open; numbers may be off by as much.

mod factors;
mod lists;
mod moments;
mod scatter;

use taut_points::{Monitor, PointSource};

use self::factors::{consistency, probability, quantile, small_sample};
use self::moments::{Metric, Scan};
use super::{RobustCertificate, RobustEllipsoid, RobustMethod, RobustVerdict};
use crate::ellipsoid::check as enclosing;
use crate::ellipsoid::check::agreement;
use crate::ellipsoid::check::frame::Frame;
use crate::ellipsoid::check::hull::HullTest;
use crate::{CheckError, Enclosure, Violation};

/// What `f64` arithmetic of a solver may be off by, relatively.
const SLACK: f64 = 1e-9;

pub(super) fn check(
    answer: &RobustEllipsoid,
    certificate: &RobustCertificate,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<RobustVerdict, CheckError> {
    lists::check(answer, certificate, source)?;
    let ellipsoid = answer.ellipsoid();
    let frame = Frame::of(&ellipsoid);
    agreement::matrix(&ellipsoid, &frame)?;
    let hull = ellipsoid.hull.as_ref().map(|hull| HullTest::of(&frame, hull));
    if let Some(hull) = &hull {
        hull.check(&frame)?;
    }
    let log_volume = agreement::log_volume(&ellipsoid, &frame)?.value;
    let scan = Scan { answer, certificate, frame: &frame, hull: hull.as_ref() };
    monitor.pass(1, source.len());
    let sums = scan.first(source, monitor)?;
    let (rank, slack) = (frame.rank, sums.slack(&frame, SLACK));
    let is_trimmed = certificate.method == RobustMethod::Trim;

    let reweighted = factors(certificate, source.len(), sums.on_hull, rank)?;
    // S = (F′F)⁻¹/border.
    let border = if is_trimmed { 1.0 / certificate.raw_scale } else { certificate.cutoff };
    scatter::check(answer, &frame, hull.as_ref(), border, slack)?;
    // ln det S and what was minimised, from ln |det F|, or that of F within the hull.
    let log_factor = agreement::log_unit_ball(rank).iter().sum::<f64>() - log_volume;
    let log_det = if rank == 0 { 0.0 } else { -2.0 * log_factor - rank as f64 * border.ln() };
    let tolerance = |value: f64| SLACK * (1.0 + value.abs()) + rank as f64 * slack;
    agree("the log-determinant", answer.log_det, log_det, tolerance(log_det))?;
    let raw = Metric::of(&sums.kept, rank);
    let objective = match (&certificate.enclosure, &raw) {
        (Some(Enclosure { ellipsoid, .. }), _) => ellipsoid.log_volume,
        (None, Some(raw)) => raw.log_det() - 2.0 * log_factor,
        (None, None) => f64::NEG_INFINITY,
    };
    agree("the objective", certificate.objective, objective, tolerance(objective))?;

    match &certificate.enclosure {
        Some(enclosure) if is_trimmed => same(answer, enclosure, 1.0, 0.0)?,
        Some(enclosure) if !reweighted && rank > 0 => {
            same(answer, enclosure, certificate.scale * certificate.cutoff, slack)?;
        }
        _ => sums.weighed.is_standard(certificate.scale * certificate.cutoff, rank, slack)?,
    }
    let around = certificate.enclosure.as_ref().map(|e| Frame::of(&e.ellipsoid));
    if rank > 0 && !is_trimmed {
        monitor.pass(2, source.len());
        scan.second(source, monitor, around.as_ref(), raw.as_ref(), reweighted, slack)?;
    }
    let enclosure = match &certificate.enclosure {
        Some(Enclosure { ellipsoid, certificate }) => {
            Some(enclosing::check(ellipsoid, certificate, source, monitor)?)
        }
        None => None,
    };
    Ok(RobustVerdict { objective, enclosure, on_hull: sums.on_hull, reweighted, rank })
}

fn agree(what: &str, claimed: f64, found: f64, tolerance: f64) -> Result<(), Violation> {
    let agrees = (claimed - found).abs() <= tolerance;
    if agrees { Ok(()) } else { Err(Violation::Estimate { what: what.into(), claimed, found }) }
}

/// Whether quantile and factors are those of the literature, and whether rows were weighed out at all.
fn factors(
    certificate: &RobustCertificate,
    rows: u64,
    on_hull: u64,
    rank: usize,
) -> Result<bool, Violation> {
    let RobustCertificate { method, level, cutoff, raw_scale, scale, .. } = *certificate;
    if rank == 0 {
        agree("the quantile", cutoff, 0.0, 0.0)?;
        agree("the factor of the scatter of the points kept", raw_scale, 1.0, 0.0)?;
        let wanted = if method == RobustMethod::Trim { 0.0 } else { 1.0 };
        agree("the factor of the scatter", scale, wanted, 0.0)?;
        return Ok(false);
    }
    let (h, n) = (certificate.kept as usize, on_hull as usize);
    let left = (rows - certificate.weighed_out.len() as u64) as usize;
    let part = |k: usize| k as f64 / n as f64;
    let (first, last) = match method {
        RobustMethod::Mcd => (
            consistency(part(h), rank) * small_sample(false, h, n, rank),
            consistency(part(left), rank) * small_sample(true, h, n, rank),
        ),
        RobustMethod::Mve | RobustMethod::Trim => {
            // The border holds h/(n + 1) of normal points; Rousseeuw and van Zomeren's factor for small samples.
            let small = if n > rank { 1.0 + 15.0 / (n - rank) as f64 } else { 1.0 };
            (
                small * small / quantile(h as f64 / (n as f64 + 1.0), rank),
                consistency(part(left), rank),
            )
        }
    };
    let last = if left == n { 1.0 } else { last };
    agree("the factor of the scatter of the points kept", raw_scale, first, SLACK * first)?;
    if method == RobustMethod::Trim {
        agree("the level", level, 1.0, 0.0)?;
        agree("the quantile", cutoff, 0.0, 0.0)?;
        agree("the factor of the scatter", scale, 0.0, 0.0)?;
        return Ok(false);
    }
    agree("the level", level, probability(cutoff, rank), 1e-13 * (10 + rank) as f64)?;
    if scale == raw_scale && certificate.weighed_out == certificate.left_out {
        return Ok(false);
    }
    agree("the factor of the scatter", scale, last, SLACK * last)?;
    Ok(true)
}

/// Whether the answer is the ellipsoid around the rows kept, with F′F divided by `factor`.
fn same(
    answer: &RobustEllipsoid,
    enclosure: &Enclosure,
    factor: f64,
    slack: f64,
) -> Result<(), Violation> {
    let (one, other) = (answer.ellipsoid(), &enclosure.ellipsoid);
    let hulls =
        one.hull.as_ref().map(|h| h.basis.len()) == other.hull.as_ref().map(|h| h.basis.len());
    agree("the dimension of the hull", one.rank() as f64, other.rank() as f64, 0.0)?;
    if !hulls
        || one.center != other.center
        || (slack == 0.0 && one.center_tail != other.center_tail)
    {
        return Err(Violation::Estimate {
            what: "the first coordinate of the centre".into(),
            claimed: one.center[0],
            found: other.center[0],
        });
    }
    for (j, (row, theirs)) in one.matrix.iter().zip(&other.matrix).enumerate() {
        for (k, (&q, &r)) in row.iter().zip(theirs).enumerate() {
            let size = (one.matrix[j][j] * one.matrix[k][k]).sqrt();
            let tolerance = if slack == 0.0 { 0.0 } else { slack * size };
            agree(&format!("entry ({j}, {k}) of the matrix"), q, r / factor, tolerance)?;
        }
    }
    Ok(())
}
