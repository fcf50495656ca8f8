//! The checker of robust ellipsoids, in arithmetic of its own.
//!
//! *Problem.* Given points, a list of those kept, center, scatter and flags: are they what the method makes of the
//! points kept, and do the points kept leave nothing to improve by a C-step?
//! *Idea.* Everything is judged in the frame of the answer, y = F(x − c), where scatters are nearly multiples of I. Each
//! pass hashes what it reads ([`passes`]).
//! 1. Doubled precision: moments of the rows kept and of those not weighed out. From these: center, scatter, objective;
//!    factors by series of their own ([`factors`]). A hull must be as thin as that of an ellipsoid by itself.
//! 2. Flags: exactly the rows outside, but for what evaluating |F(x − c)| in `f64` may be off by.
//! 3. By `mve` and `trim`, the checker of ellipsoids judges that around the rows kept.
//! 4. Distances in the metric of the rows kept, or of the ellipsoid around them, but where r = 0. No row kept may be
//!    farther than a row left out, and the rows weighed out must be those beyond the quantile. Fewer than h rows may lie
//!    strictly inside that ellipsoid, as a C-step would lead on otherwise; one that is not known to be nearly the smallest is
//!    refused, since no row would be known to lie inside.
//!
//! *Not judged.* Whether other rows would do better than those kept: no polynomial proof of that is known.
//! *Tolerances.* [`slack`]: numbers may be off by what `f64` leaves of them.

mod cursor;
mod factors;
mod lists;
mod passes;
mod scatter;
mod slack;
mod sums;

use taut_points::{Monitor, PointSource};

use self::factors::{beyond, consistency, quantile, small_sample};
use self::passes::{KeptMetric, Passes};
use self::slack::Slack;
use self::sums::Metric;
use super::{
    RobustCertificate, RobustEllipsoid, RobustMethod, RobustScale, RobustVerdict, Unweighted,
};
use crate::ellipsoid::check as enclosing;
use crate::ellipsoid::check::agreement;
use crate::ellipsoid::check::frame::Frame;
use crate::ellipsoid::check::hull::HullTest;
use crate::{CheckError, Enclosure, Violation};

/// Rows nearer than this to the border of the ellipsoid around the rows kept may be on it.
const ON_BORDER: f64 = 1e-6;
/// The largest gap in log-volume of the ellipsoid around the rows kept: with a looser one, too few rows are known to lie
/// strictly inside to tell whether a C-step leads on. A little more than the 0.01 that solvers may be asked for.
const ENCLOSURE_GAP_MAX: f64 = 0.011;
/// A hull that was laid through some rows may be stated wider by up to this factor, so that it holds others as near to
/// it.
const HULL_WIDENING_MAX: f64 = 4.0;
/// The error of 1 − level beside its last digits: `level` and the probability of a quantile are numbers near 1.
const LEVEL_TOLERANCE: f64 = 4e-16;

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
    let passes = Passes { answer, certificate, frame: &frame, hull: hull.as_ref() };
    let n = source.len();
    monitor.pass(1, n);
    let sums = passes.moments(source, monitor)?;
    if let Some(hull) = &hull {
        hull.is_flat_for(&sums.extents, &sums.coordinates, HULL_WIDENING_MAX)?;
    }
    monitor.pass(2, n);
    let flag_excess = passes.flags(source, monitor)?;
    let (rank, slack) = (frame.rank, Slack::of(&frame, &sums.extents));
    let is_trimmed = certificate.method == RobustMethod::Trim;

    reweighting(certificate, sums.kept.count == sums.on_hull, rank)?;
    factors(certificate, n, sums.on_hull, rank)?;
    // S = (F′F)⁻¹/border.
    let border = if is_trimmed { 1.0 / certificate.raw_scale } else { certificate.cutoff };
    scatter::check(answer, &frame, hull.as_ref(), border, slack.of_shapes)?;
    // ln det S and what was minimized, from ln |det F|, or that of F within the hull.
    let log_factor = agreement::log_unit_ball(rank).iter().sum::<f64>() - log_volume;
    let log_det = if rank == 0 { 0.0 } else { -2.0 * log_factor - rank as f64 * border.ln() };
    let agree_in_logarithm = |what: &str, claimed: f64, found: f64| {
        agree(what, claimed, found, slack.of_logarithms(found, rank))
    };
    agree_in_logarithm("the log-determinant", answer.log_det, log_det)?;
    let raw = Metric::of(&sums.kept, rank);
    let objective = match (&certificate.enclosure, &raw) {
        (Some(Enclosure { ellipsoid, .. }), _) => ellipsoid.log_volume,
        (None, Some(raw)) => raw.log_det() - 2.0 * log_factor,
        (None, None) => {
            let (what, found) = ("the objective".into(), f64::NEG_INFINITY);
            return Err(Violation::Estimate { what, claimed: certificate.objective, found }.into());
        }
    };
    agree_in_logarithm("the objective", certificate.objective, objective)?;

    let factor = certificate.scale * certificate.cutoff;
    let reweighted = certificate.unweighted.is_none() && rank > 0;
    match &certificate.enclosure {
        Some(enclosure) if is_trimmed => same(answer, enclosure, 1.0, 0.0)?,
        Some(enclosure) if !reweighted && rank > 0 => {
            same(answer, enclosure, factor, slack.of_shapes)?;
        }
        _ => sums.weighed.is_standard(factor, rank, &slack)?,
    }
    let enclosure = match &certificate.enclosure {
        Some(Enclosure { ellipsoid, certificate }) => {
            Some(enclosing::check(ellipsoid, certificate, source, monitor, 3)?)
        }
        None => None,
    };
    if let Some(proved) = enclosure.filter(|proved| rank > 0 && proved.gap > ENCLOSURE_GAP_MAX) {
        let (gap, most) = (proved.gap, ENCLOSURE_GAP_MAX);
        return Err(Violation::LooseEnclosure { gap, most }.into());
    }
    if rank > 0 {
        let frame = certificate.enclosure.as_ref().map(|e| Frame::of(&e.ellipsoid));
        let around = match (&frame, &raw) {
            (Some(frame), _) => {
                // What is proved of its volume does not tell ellipsoids within the gap apart.
                let gap = enclosure.map_or(0.0, |proved| proved.gap);
                Some(KeptMetric::Ellipsoid { frame, inside: 1.0 - ON_BORDER - gap })
            }
            (None, raw) => raw.as_ref().map(KeptMetric::Moments),
        };
        if let Some(around) = around {
            monitor.pass(if enclosure.is_some() { 4 } else { 3 }, n);
            passes.distances(source, monitor, &around, &slack)?;
        }
    }
    Ok(RobustVerdict {
        objective,
        enclosure,
        wanted: certificate.kept,
        kept: sums.kept.count,
        on_hull: sums.on_hull,
        flag_excess,
        slack: slack.of_places,
        reweighted,
        rank,
    })
}

/// Tests whether the reason why points are not weighed again, if one is given, may be true; and then the lists and factors are
/// those of the points kept.
fn reweighting(
    certificate: &RobustCertificate,
    all_kept: bool,
    rank: usize,
) -> Result<(), Violation> {
    let is_trimmed = certificate.method == RobustMethod::Trim;
    let Some(why) = certificate.unweighted else {
        // By `trim` nothing is ever weighed.
        let reason = Unweighted::Trimmed.reason();
        return if is_trimmed { Err(Violation::Reweighting { reason }) } else { Ok(()) };
    };
    let may_be = match why {
        Unweighted::Trimmed => is_trimmed,
        Unweighted::AllKept => !is_trimmed && rank > 0 && all_kept,
        // The distances tell.
        Unweighted::Flat => !is_trimmed && rank > 0,
    };
    let repeats = certificate.weighed_out == certificate.left_out
        && certificate.scale == certificate.raw_scale;
    match may_be && (is_trimmed || repeats) {
        true => Ok(()),
        false => Err(Violation::Reweighting { reason: why.reason() }),
    }
}

fn agree(what: &str, claimed: f64, found: f64, tolerance: f64) -> Result<(), Violation> {
    let agrees = (claimed - found).abs() <= tolerance && tolerance.is_finite();
    if agrees { Ok(()) } else { Err(Violation::Estimate { what: what.into(), claimed, found }) }
}

/// Tests whether quantile and factors are those of the literature.
fn factors(
    certificate: &RobustCertificate,
    rows: u64,
    on_hull: u64,
    rank: usize,
) -> Result<(), Violation> {
    let RobustCertificate { method, level, cutoff, raw_scale, scale, scaled_by, .. } = *certificate;
    if scaled_by != RobustScale::Share && (certificate.unweighted.is_some() || rank == 0) {
        let reason = certificate.unweighted.map_or("they are equal", Unweighted::reason);
        return Err(Violation::Reweighting { reason });
    }
    if rank == 0 {
        agree("the quantile", cutoff, 0.0, 0.0)?;
        agree("the factor of the scatter of the points kept", raw_scale, 1.0, 0.0)?;
        let wanted = if method == RobustMethod::Trim { 0.0 } else { 1.0 };
        return agree("the factor of the scatter", scale, wanted, 0.0);
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
    let last = match scaled_by {
        RobustScale::Level => consistency(level, rank),
        RobustScale::Share if left == n => 1.0,
        RobustScale::Share => last,
    };
    let kept = "the factor of the scatter of the points kept";
    agree(kept, raw_scale, first, Slack::of_factor(first))?;
    if method == RobustMethod::Trim {
        agree("the level", level, 1.0, 0.0)?;
        agree("the quantile", cutoff, 0.0, 0.0)?;
        return agree("the factor of the scatter", scale, 0.0, 0.0);
    }
    // Compared on the side that is left over: near a level of 1, the difference from it is what tells.
    let rest = 1.0 - level;
    let what = "what the level leaves of normal points";
    agree(what, rest, beyond(cutoff, rank), Slack::of_factor(rest) + LEVEL_TOLERANCE)?;
    match certificate.unweighted {
        None => agree("the factor of the scatter", scale, last, Slack::of_factor(last)),
        Some(_) => Ok(()),
    }
}

/// Tests whether the answer is the ellipsoid around the rows kept, with F′F divided by `factor`.
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
            what: "the first coordinate of the center".into(),
            claimed: one.center[0],
            found: other.center[0],
        });
    }
    for (j, (row, theirs)) in one.matrix.iter().zip(&other.matrix).enumerate() {
        for (k, (&q, &r)) in row.iter().zip(theirs).enumerate() {
            // Roots first: the product of two entries can leave the range of numbers.
            let size = one.matrix[j][j].sqrt() * one.matrix[k][k].sqrt();
            let subnormal = f64::MIN_POSITIVE * f64::EPSILON;
            let tolerance = if slack == 0.0 { 0.0 } else { slack * size + subnormal };
            agree(&format!("entry ({j}, {k}) of the matrix"), q, r / factor, tolerance)?;
        }
    }
    Ok(())
}
