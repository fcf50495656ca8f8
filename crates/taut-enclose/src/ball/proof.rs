//! From a method's outcome to an answer with a certificate: both bounds again, from the items and multipliers alone.
//!
//! *Upper.* The pass from the returned center gives every reach to a known relative error. The items that could reach
//! farthest are measured again in double-double, and the radius is rounded up from the largest; where more items are
//! cospherical than a pass lists, the error bound of the pass is added instead.
//! *Lower.* r² = Σ λᵢ|pᵢ − c|² − |c − Σ λᵢpᵢ|² with Σλ = 1, in double-double; for balls the bound of
//! [`super::core_set`]. Nothing is taken from the solver's state.

use taut_certify::{Ball, BallCertificate, PassBounds, Solution, Stop, Trace};
use taut_kernels::{Center, Difference, DoubleDouble, relative_error, vanishes};
use taut_points::parallel::ParallelSlice;
use taut_points::{OrderBy, ReadError, two_to};

use super::BallOptions;
use super::core_set::ROUNDING;
use super::outcome::{Candidate, Outcome};
use crate::Error;
use crate::item_reader::{ItemReader, Query};

pub(super) fn prove(
    reader: &mut ItemReader<'_>,
    outcome: Outcome,
    options: &BallOptions<'_>,
) -> Result<Solution<Ball>, Error> {
    let (mut best, outcome) = outcome.into_best();
    sort_by_id(&mut best);
    let center = settle_center(reader, &mut best)?;
    if center.high.iter().any(|c| !c.is_finite()) {
        return Err(Error::Overflow);
    }
    let total = best.lambda.iter().fold(DoubleDouble::ZERO, |sum, &l| sum + l.into());
    let weights: Vec<DoubleDouble> =
        best.lambda.iter().map(|&l| DoubleDouble::from(l) / total).collect();
    let support = Measurement::new(reader, &best.support, &weights, &center)?;
    let upper = upper_bound(reader, &best, &support, &center)?;
    let lower = lower_bound(&weights, &support);
    let scale = reader.scale();
    let radius = unscale_up(upper, scale);
    if !radius.is_finite() {
        return Err(Error::Overflow);
    }
    // Against the radius as it is returned: below 1e-308 rounding it up costs digits.
    let gap = match radius {
        0.0 => 0.0,
        // JSON knows no infinity.
        _ if lower.high <= 0.0 => f64::MAX,
        _ => (DoubleDouble::from(radius * scale) / lower - 1.0.into()).round_up().max(0.0),
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
        passes: reader.passes(),
        iterations: outcome.iterations,
        core_set: outcome.core_set,
        history: outcome.history.into_iter().map(bounds).collect(),
        counters: outcome.counters,
    };
    let answer = Ball { center: center.high, center_tail: center.low, radius };
    let certificate = BallCertificate {
        items: reader.items(),
        support: best.support,
        multipliers: best.lambda,
        directions: vec![],
        gap,
        points_hash: reader.hash(),
    };
    Ok(Solution { answer, certificate, trace })
}

/// value / scale; where that cannot be exact, because it is subnormal, rounded up.
fn unscale_up(value: f64, scale: f64) -> f64 {
    let unscaled = value / scale;
    if unscaled * scale < value { unscaled.next_up() } else { unscaled }
}

/// The center as it will be returned, in the units of the source. Where it is not the one the pass was made from, as
/// subnormal coordinates and points far from the origin of a scaled reader round it, one more pass is made from it.
fn settle_center(reader: &mut ItemReader<'_>, best: &mut Candidate) -> Result<Center, Error> {
    let outside = reader.outside(&best.center);
    let inside = reader.inside(&outside);
    if inside != best.center {
        let keep = best.found.far.len().max(64);
        let above = best.found.listed_above / 2.0;
        best.found =
            reader.farthest(Query { center: &inside, above, keep, by_face_above: None })?;
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
    pairs.order_by_key(|pair| pair.0);
    (best.support, best.lambda) = pairs.into_iter().unzip();
}

/// Rows that are measured together: fixed, so that sums do not depend on threads.
const ROWS_AT_ONCE: usize = 16;

/// Items measured from the returned center in double-double; in the units of the reader.
struct Measurement {
    items: Vec<Measured>,
    /// Σ wᵢ(cᵢ − c), coordinate by coordinate.
    beside: Vec<DoubleDouble>,
}

struct Measured {
    squared: DoubleDouble,
    /// Radius; 0 for a point.
    r: f64,
    /// |x − c| + r, rounded up.
    reach: f64,
}

impl Measurement {
    /// Measures the items with the given numbers; `weights` is one for each of them, or empty.
    fn new(
        reader: &ItemReader<'_>,
        ids: &[u64],
        weights: &[DoubleDouble],
        center: &Center,
    ) -> Result<Self, Error> {
        debug_assert!(weights.is_empty() || weights.len() == ids.len());
        let columns = reader.columns();
        // Rows in memory are copied by each part; those of other sources are read once, by this thread.
        let read = if reader.is_in_memory() { None } else { Some(reader.rows_as_given(ids)?) };
        let part = |(k, ids): (usize, &[u64])| -> Result<Measurement, Error> {
            reader.monitor().check().map_err(ReadError::from)?;
            let first = k * ROWS_AT_ONCE;
            let copied;
            let rows = match &read {
                Some(rows) => &rows[first * columns..(first + ids.len()) * columns],
                None => {
                    copied = reader.rows_as_given(ids)?;
                    &copied[..]
                }
            };
            let mut items = vec![];
            let mut beside =
                vec![DoubleDouble::ZERO; if weights.is_empty() { 0 } else { reader.dim() }];
            for (i, row) in rows.chunks_exact(columns).enumerate() {
                let (x, radius) = row.split_at(reader.dim());
                let difference = Difference::new(x, center, reader.scale());
                items.push(Measured::new(
                    &difference,
                    radius.first().copied().unwrap_or(0.0),
                    reader.scale(),
                ));
                if let Some(&weight) = weights.get(first + i) {
                    difference.add_times(weight, &mut beside);
                }
            }
            Ok(Measurement { items, beside })
        };
        let parts: Result<Vec<Measurement>, Error> = if ids.len() <= ROWS_AT_ONCE {
            ids.chunks(ROWS_AT_ONCE).enumerate().map(part).collect()
        } else {
            ids.par_chunks(ROWS_AT_ONCE).enumerate().map(part).collect()
        };
        let mut all = Measurement { items: vec![], beside: vec![DoubleDouble::ZERO; reader.dim()] };
        for part in parts? {
            all.items.extend(part.items);
            for (sum, more) in all.beside.iter_mut().zip(part.beside) {
                *sum = *sum + more;
            }
        }
        Ok(all)
    }
}

/// The smallest radius from the center, rounded up, that is proved to hold all items.
fn upper_bound(
    reader: &ItemReader<'_>,
    best: &Candidate,
    support: &Measurement,
    center: &Center,
) -> Result<f64, Error> {
    let error = relative_error(reader.dim());
    let found = &best.found;
    let threshold = found.farthest.reach2 * (1.0 - 2.0 * error);
    let near = found.far.iter().take_while(|far| far.reach2 >= threshold).map(|far| far.id);
    let mut others: Vec<u64> = near.filter(|id| best.support.binary_search(id).is_err()).collect();
    // Equal reaches at the end of a full list may go on behind it, hence "below" and not "at most".
    let all_listed = found.listed_above < threshold;
    let farthest = found.farthest.id;
    if best.support.binary_search(&farthest).is_err() && !others.contains(&farthest) {
        others.push(farthest);
    }
    let others = Measurement::new(reader, &others, &[], center)?;
    let mut upper =
        support.items.iter().chain(&others.items).map(|item| item.reach).fold(0.0, f64::max);
    if !all_listed && found.farthest.reach2 > 0.0 {
        upper = upper.max((found.farthest.reach2 * (1.0 + error)).sqrt().next_up());
    }
    Ok(upper)
}

impl Measured {
    /// An item at this difference from the center, of the given radius before scaling.
    fn new(difference: &Difference, given: f64, scale: f64) -> Self {
        let squared = difference.squared();
        let r = given * scale;
        let reach = reach_up(difference, squared, r);
        // Digits that are lost at the lower end of the range are far less than one unit of the last place.
        let lost = difference.vanishes || vanishes(r) || r / scale != given;
        Measured { squared, r, reach: if lost { reach.next_up() } else { reach } }
    }
}

/// The smallest `f64` radius that is not below |x − c| + r; infinite where that is no `f64`.
pub(crate) fn reach_up(difference: &Difference, squared: DoubleDouble, r: f64) -> f64 {
    if !(squared.high + r).is_finite() {
        return f64::INFINITY;
    }
    // More than double-double can be off by, in parts of the square: what is nearer is a tie, to be told exactly.
    let doubt = squared.high * (difference.dim() as f64 + 8.0) * two_to(-98);
    let holds = |reach: f64| {
        let beyond = (DoubleDouble::sum(reach, -r).square() - squared).high;
        if beyond.abs() > doubt { beyond > 0.0 } else { difference.is_within(reach, r) }
    };
    // The root carries one rounding of its own: make sure that the reach holds, and that nothing less does.
    let mut reach = (squared.sqrt() + r.into()).round_up();
    while reach > r && holds(reach.next_down()) {
        reach = reach.next_down();
    }
    while reach < f64::INFINITY && !holds(reach) {
        reach = reach.next_up();
    }
    reach
}

/// The bound that the multipliers prove, in double-double; `weights` are they, divided by their sum.
fn lower_bound(weights: &[DoubleDouble], support: &Measurement) -> DoubleDouble {
    let items = || weights.iter().zip(&support.items);
    let mean = items().fold(DoubleDouble::ZERO, |sum, (w, item)| sum + *w * item.r.into());
    let mut inner = DoubleDouble::ZERO;
    for (w, item) in items() {
        let spread = (DoubleDouble::from(item.r) - mean).square();
        inner = inner + *w * (item.squared - spread);
    }
    // The offset of the returned center, being rounded, from the one that the multipliers mean.
    let inner = support.beside.iter().fold(inner, |inner, sum| inner - sum.square());
    let bound = mean + inner.sqrt();
    // No ball is smaller than one it holds.
    let largest = support.items.iter().map(|item| item.r).fold(0.0, f64::max);
    if bound < largest.into() { largest.into() } else { bound }
}
