//! From a method's outcome to an answer with a certificate: both bounds again, from the items and multipliers alone.
//!
//! *Upper.* The pass from the returned centre gives every reach to a known relative error. The items that could reach
//! farthest are measured again in double-double, and the radius is rounded up from the largest; where more items are
//! cospherical than a pass lists, the error bound of the pass is added instead.
//! *Lower.* r² = Σ λᵢ|pᵢ − c|² − |c − Σ λᵢpᵢ|² with Σλ = 1, in double-double; for balls the bound of
//! [`super::core_set`]. Nothing is taken from the solver's state.

use taut_certify::{Ball, BallCertificate, Items, PassBounds, Solution, Stop, Trace};

use super::BallOptions;
use super::outcome::{Candidate, Outcome};
use crate::Error;
use crate::kernel::{Center, DoubleDouble, exact_squared_distance, relative_error};
use crate::scan::{Query, Scan};

pub(super) fn prove(
    scan: &mut Scan<'_>,
    outcome: Outcome,
    options: &BallOptions,
) -> Result<Solution<Ball>, Error> {
    let (mut best, outcome) = outcome.into_best();
    sort_by_id(&mut best);
    settle_center(scan, &mut best)?;
    let rows = scan.rows(&best.support)?;
    let upper = upper_bound(scan, &best)?;
    let lower = lower_bound(scan, &best, &rows);
    let scale = scan.scale();
    let radius = unscale_up(upper, scale);
    if !radius.is_finite() || best.center.high.iter().any(|c| !(c / scale).is_finite()) {
        return Err(Error::Overflow);
    }
    let gap = match radius {
        0.0 => 0.0,
        // Against the radius as it is returned: below 1e-308 rounding it up costs digits.
        _ => DoubleDouble::from(radius * scale).div(lower).sub(1.0.into()).round_up().max(0.0),
    };
    let mut stop = outcome.stop.expect("a method says why it stopped");
    if stop == Stop::Converged && options.epsilon > 0.0 && gap > options.epsilon {
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
    let answer = Ball {
        center: unscale(&best.center.high, scale),
        center_tail: unscale(&best.center.low, scale),
        radius,
    };
    let certificate = BallCertificate {
        items: scan.items(),
        support: best.support,
        multipliers: best.lambda,
        gap,
        points_hash: scan.hash(),
    };
    Ok(Solution { answer, certificate, trace })
}

fn unscale(values: &[f64], scale: f64) -> Vec<f64> {
    values.iter().map(|v| v / scale).collect()
}

/// value / scale; where that cannot be exact, because it is subnormal, rounded up.
fn unscale_up(value: f64, scale: f64) -> f64 {
    let unscaled = value / scale;
    if unscaled * scale < value { unscaled.next_up() } else { unscaled }
}

/// Makes the centre one that survives being scaled back. Only subnormal coordinates do not: then the centre is the
/// rounded one, and one more pass finds what is farthest from that.
fn settle_center(scan: &mut Scan<'_>, best: &mut Candidate) -> Result<(), Error> {
    let scale = scan.scale();
    let rescale =
        |values: &[f64]| -> Vec<f64> { values.iter().map(|v| v / scale * scale).collect() };
    let center = Center { high: rescale(&best.center.high), low: rescale(&best.center.low) };
    if center == best.center {
        return Ok(());
    }
    let keep = best.found.far.len().max(64);
    let query =
        Query { center: &center, above: best.found.listed_above / 2.0, keep, by_face_above: None };
    best.found = scan.farthest(query)?;
    best.center = center;
    Ok(())
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

/// The coordinates of an item and its radius, 0 for a point.
fn split<'r>(scan: &Scan<'_>, row: &'r [f64]) -> (&'r [f64], f64) {
    match scan.items() {
        Items::Points => (row, 0.0),
        Items::Balls => (&row[..scan.dim()], row[scan.dim()]),
    }
}

/// The smallest radius from the centre, rounded up, that is proved to hold all items.
fn upper_bound(scan: &Scan<'_>, best: &Candidate) -> Result<f64, Error> {
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
    let rows = scan.rows(&ids)?;
    let columns = rows.len() / ids.len();
    let mut upper = 0.0f64;
    for row in rows.chunks_exact(columns) {
        let (x, r) = split(scan, row);
        let reach = reach_up(exact_squared_distance(x, &best.center), r);
        // Beside a reach of about 1 what a vanishing square leaves out is far less than one unit of the last place.
        upper =
            upper.max(if has_vanishing_square(x, &best.center) { reach.next_up() } else { reach });
    }
    if !all_listed && found.farthest.reach2 > 0.0 {
        upper = upper.max((found.farthest.reach2 * (1.0 + error)).sqrt().next_up());
    }
    Ok(upper)
}

/// Whether some difference is not 0, but so small that its square loses digits to the end of the range.
fn has_vanishing_square(x: &[f64], center: &Center) -> bool {
    x.iter().zip(&center.high).any(|(x, c)| x != c && (x - c).abs() < 2f64.powi(-450))
}

/// The smallest `f64` radius that is not below √distance² + r.
fn reach_up(distance2: DoubleDouble, r: f64) -> f64 {
    let mut reach = distance2.sqrt().add(r.into()).round_up();
    // The root carries one rounding of its own: make sure of (reach − r)² ≥ distance², and of no more than needed.
    let holds = |reach: f64| DoubleDouble::sum(reach, -r).square() >= distance2;
    while reach > r && holds(reach.next_down()) {
        reach = reach.next_down();
    }
    while !holds(reach) {
        reach = reach.next_up();
    }
    reach
}

/// The bound that the multipliers prove, rounded to double-double.
fn lower_bound(scan: &Scan<'_>, best: &Candidate, rows: &[f64]) -> DoubleDouble {
    let columns = rows.len() / best.support.len();
    let total = best.lambda.iter().fold(DoubleDouble::ZERO, |sum, &l| sum.add(l.into()));
    let weights: Vec<DoubleDouble> =
        best.lambda.iter().map(|&l| DoubleDouble::from(l).div(total)).collect();
    let mut mean = DoubleDouble::ZERO;
    for (row, &w) in rows.chunks_exact(columns).zip(&weights) {
        mean = mean.add(w.mul(split(scan, row).1.into()));
    }
    let mut inner = DoubleDouble::ZERO;
    for (row, &w) in rows.chunks_exact(columns).zip(&weights) {
        let (x, r) = split(scan, row);
        let spread = DoubleDouble::from(r).sub(mean).square();
        inner = inner.add(w.mul(exact_squared_distance(x, &best.center).sub(spread)));
    }
    let inner = inner.sub(distance2_from_mean(scan, &best.center, rows, &weights));
    let bound = mean.add(inner.sqrt());
    // No ball is smaller than one it holds.
    let largest = rows.chunks_exact(columns).map(|row| split(scan, row).1).fold(0.0, f64::max);
    if bound < largest.into() { largest.into() } else { bound }
}

/// |c − Σ λᵢcᵢ|²: what the returned centre, being rounded, lies beside the one the multipliers mean.
fn distance2_from_mean(
    scan: &Scan<'_>,
    center: &Center,
    rows: &[f64],
    weights: &[DoubleDouble],
) -> DoubleDouble {
    let columns = rows.len() / weights.len();
    let mut sum = DoubleDouble::ZERO;
    for j in 0..scan.dim() {
        let mut difference = DoubleDouble::ZERO;
        for (row, &w) in rows.chunks_exact(columns).zip(weights) {
            let low = if center.low.is_empty() { 0.0 } else { center.low[j] };
            difference =
                difference.add(w.mul(DoubleDouble::sum(row[j], -center.high[j]).sub(low.into())));
        }
        sum = sum.add(difference.square());
    }
    sum
}
