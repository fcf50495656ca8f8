//! From a method's outcome to an answer with a certificate: both bounds again, from the items and multipliers alone.
//!
//! *Upper.* The pass from the returned centre gives every reach to a known relative error. The items that could reach
//! farthest are measured again in double-double, and the radius is rounded up from the largest; where more items are
//! cospherical than a pass lists, the error bound of the pass is added instead.
//! *Lower.* r² = Σ λᵢ|pᵢ − c|² − |c − Σ λᵢpᵢ|² with Σλ = 1, in double-double; for balls the bound of
//! [`super::core_set`]. Nothing is taken from the solver's state.

use taut_certify::{Ball, BallCertificate, Items, PassBounds, Solution, Stop, Trace};
use taut_points::ReadError;

use super::BallOptions;
use super::core_set::ROUNDING;
use super::outcome::{Candidate, Outcome};
use crate::Error;
use crate::kernel::{Center, Difference, DoubleDouble, relative_error, vanishes};
use crate::scan::{Query, Scan};

pub(super) fn prove(
    scan: &mut Scan<'_>,
    outcome: Outcome,
    options: &BallOptions,
) -> Result<Solution<Ball>, Error> {
    let (mut best, outcome) = outcome.into_best();
    sort_by_id(&mut best);
    let center = settle_center(scan, &mut best)?;
    if center.high.iter().any(|c| !c.is_finite()) {
        return Err(Error::Overflow);
    }
    let upper = upper_bound(scan, &best, &center)?;
    let lower = lower_bound(scan, &best, &center)?;
    let scale = scan.scale();
    let radius = unscale_up(upper, scale);
    if !radius.is_finite() {
        return Err(Error::Overflow);
    }
    // Against the radius as it is returned: below 1e-308 rounding it up costs digits.
    let gap = match radius {
        0.0 => 0.0,
        // JSON knows no infinity.
        _ if lower.high <= 0.0 => f64::MAX,
        _ => DoubleDouble::from(radius * scale).div(lower).sub(1.0.into()).round_up().max(0.0),
    };
    let wanted = if options.epsilon > 0.0 { options.epsilon } else { ROUNDING };
    let mut stop = outcome.stop.expect("a method says why it stopped");
    if stop == Stop::Converged && gap > wanted {
        stop = Stop::Rounding;
    }
    // An early ball may exceed what `f64` can say, and JSON knows no infinity.
    let said = |value: f64| (value / scale).min(f64::MAX);
    let bounds = |b: PassBounds| PassBounds { lower: said(b.lower), upper: said(b.upper), ..b };
    let trace = Trace {
        method: options.method.name().to_owned(),
        stop,
        passes: scan.passes(),
        iterations: outcome.iterations,
        core_set: outcome.core_set,
        history: outcome.history.into_iter().map(bounds).collect(),
        counters: outcome.counters,
    };
    let answer = Ball { center: center.high, center_tail: center.low, radius };
    let certificate = BallCertificate {
        items: scan.items(),
        support: best.support,
        multipliers: best.lambda,
        gap,
        points_hash: scan.hash(),
    };
    Ok(Solution { answer, certificate, trace })
}

/// value / scale; where that cannot be exact, because it is subnormal, rounded up.
fn unscale_up(value: f64, scale: f64) -> f64 {
    let unscaled = value / scale;
    if unscaled * scale < value { unscaled.next_up() } else { unscaled }
}

/// The centre as it will be returned, in the units of the source. Where it is not the one the pass was made from, as
/// subnormal coordinates and points far from the origin of a scaled scan round it, one more pass is made from it.
fn settle_center(scan: &mut Scan<'_>, best: &mut Candidate) -> Result<Center, Error> {
    let outside = scan.outside(&best.center);
    let inside = scan.inside(&outside);
    if inside != best.center {
        let keep = best.found.far.len().max(64);
        let above = best.found.listed_above / 2.0;
        best.found = scan.farthest(Query { center: &inside, above, keep, by_face_above: None })?;
        best.center = inside;
    }
    Ok(outside)
}

fn sort_by_id(best: &mut Candidate) {
    let mut pairs: Vec<(u64, f64)> = best
        .support
        .iter()
        .copied()
        .zip(best.lambda.iter().copied())
        .filter(|pair| pair.1 > 0.0)
        .collect();
    pairs.sort_unstable_by_key(|pair| pair.0);
    (best.support, best.lambda) = pairs.into_iter().unzip();
}

/// The coordinates of an item as given, and its radius in the units of the scan: 0 for a point.
fn split<'r>(scan: &Scan<'_>, row: &'r [f64]) -> (&'r [f64], f64) {
    match scan.items() {
        Items::Points => (row, 0.0),
        Items::Balls => (&row[..scan.dim()], row[scan.dim()] * scan.scale()),
    }
}

/// The smallest radius from the centre, rounded up, that is proved to hold all items; in the units of the scan.
fn upper_bound(scan: &Scan<'_>, best: &Candidate, center: &Center) -> Result<f64, Error> {
    let error = relative_error(scan.dim());
    let found = &best.found;
    let threshold = found.farthest.reach2 * (1.0 - 2.0 * error);
    let mut ids: Vec<u64> =
        found.far.iter().take_while(|far| far.reach2 >= threshold).map(|far| far.id).collect();
    // Equal reaches at the end of a full list may go on behind it, hence "below" and not "at most".
    let all_listed = found.listed_above < threshold;
    if !ids.contains(&found.farthest.id) {
        ids.push(found.farthest.id);
    }
    let rows = scan.rows_as_given(&ids)?;
    let columns = rows.len() / ids.len();
    let mut upper = 0.0f64;
    for row in rows.chunks_exact(columns) {
        scan.monitor().check().map_err(ReadError::from)?;
        let (x, r) = split(scan, row);
        let difference = Difference::new(x, center, scan.scale());
        let reach = reach_up(&difference, r);
        // A radius, too, can be so much smaller than the ball that it loses digits.
        let lost = vanishes(r) || row[scan.dim()..].iter().any(|given| r / scan.scale() != *given);
        upper = upper.max(if difference.vanishes || lost { reach.next_up() } else { reach });
    }
    if !all_listed && found.farthest.reach2 > 0.0 {
        upper = upper.max((found.farthest.reach2 * (1.0 + error)).sqrt().next_up());
    }
    Ok(upper)
}

/// The smallest `f64` radius that is not below |x − c| + r; infinite where that is no `f64`.
fn reach_up(difference: &Difference, r: f64) -> f64 {
    let distance2 = difference.squared();
    if !(distance2.high + r).is_finite() {
        return f64::INFINITY;
    }
    // More than double-double can be off by, in parts of the square: what is nearer is a tie, to be told exactly.
    let doubt = distance2.high * (difference.dim() as f64 + 8.0) * 2f64.powi(-98);
    let holds = |reach: f64| {
        let beyond = DoubleDouble::sum(reach, -r).square().sub(distance2).high;
        if beyond.abs() > doubt { beyond > 0.0 } else { difference.is_within(reach, r) }
    };
    // The root carries one rounding of its own: make sure that the reach holds, and that nothing less does.
    let mut reach = distance2.sqrt().add(r.into()).round_up();
    while reach > r && holds(reach.next_down()) {
        reach = reach.next_down();
    }
    while reach < f64::INFINITY && !holds(reach) {
        reach = reach.next_up();
    }
    reach
}

/// The bound that the multipliers prove, in double-double and in the units of the scan.
fn lower_bound(scan: &Scan<'_>, best: &Candidate, center: &Center) -> Result<DoubleDouble, Error> {
    let rows = scan.rows_as_given(&best.support)?;
    let columns = rows.len() / best.support.len();
    let total = best.lambda.iter().fold(DoubleDouble::ZERO, |sum, &l| sum.add(l.into()));
    let weighted: Vec<(DoubleDouble, &[f64], f64)> = best
        .lambda
        .iter()
        .zip(rows.chunks_exact(columns))
        .map(|(&l, row)| {
            let (x, r) = split(scan, row);
            (DoubleDouble::from(l).div(total), x, r)
        })
        .collect();
    let mean =
        weighted.iter().fold(DoubleDouble::ZERO, |sum, (w, _, r)| sum.add(w.mul((*r).into())));
    let mut inner = DoubleDouble::ZERO;
    // Σ λᵢ(cᵢ − c): what the returned centre, being rounded, lies beside the one the multipliers mean.
    let mut beside = vec![DoubleDouble::ZERO; scan.dim()];
    for (w, x, r) in &weighted {
        let difference = Difference::new(x, center, scan.scale());
        let spread = DoubleDouble::from(*r).sub(mean).square();
        inner = inner.add(w.mul(difference.squared().sub(spread)));
        for (j, sum) in beside.iter_mut().enumerate() {
            *sum = sum.add(w.mul(difference.coordinate(j)));
        }
    }
    let inner = beside.into_iter().fold(inner, |inner, sum| inner.sub(sum.square()));
    let bound = mean.add(inner.sqrt());
    // No ball is smaller than one it holds.
    let largest = weighted.iter().map(|(_, _, r)| *r).fold(0.0, f64::max);
    Ok(if bound < largest.into() { largest.into() } else { bound })
}
