//! k equal balls around all items, as small as can be, with a lower bound that others can confirm.
//!
//! A method ([`tree`], [`thesis`], a traversal) ends with centers, a core-set and radii that trees over the core-set have shown
//! to be too small; [`proof`] proves one of these again, in a form that can be checked, and [`answer`] measures every item from the
//! centers as they are returned.

mod answer;
mod avoiding_ball;
mod cloud;
mod clusters;
mod conflict;
mod depth_first;
mod grouping;
mod in_parts;
mod item_rows;
mod items;
mod links;
mod lloyd;
mod nearest;
mod nogoods;
mod of_ellipsoids;
mod options;
mod proof;
mod proof_tree;
mod read;
mod rows;
mod small_ball;
mod start;
mod subsearch;
mod thesis;
mod tree;
mod trivial;

use std::collections::BTreeMap;

use taut_certify::{
    Centers, CentersCertificate, Items, PassBounds, Placement, Solution, Stop, Trace,
};
use taut_points::{InputError, Monitor, PointSource, on_threads, two_to};

use self::cloud::Cloud;
use self::item_rows::ItemRows;
use self::items::Position;
use self::proof::Proof;
use self::read::Table;
use self::start::Start;
use self::tree::{ProvedBound, SearchResult};
use self::trivial::TrivialCenters;
use crate::farthest_first::farthest_first_in_blocks;
use crate::separated_set::claimed;
use crate::streaming::centers_in_two_passes;
use crate::{Error, FarthestFirstOptions};
pub(crate) use answer::reach_of;
pub(crate) use nearest::EXACT_DISTANCES;
pub use options::{CentersMethod, CentersOptions};

/// The least relative gap that is sought; proofs take 1e-12 of it.
const GAP_MIN: f64 = 5e-12;
/// Gaps up to this are rounding, if `epsilon` is 0.
const ROUNDING: f64 = 2e-11;
/// Bounds below this, in the units of the search, rest on squares that may have lost digits.
const LEAST_PROVED: f64 = two_to(-480);
/// A proof may take so many times the nodes of the search that came before it, and so many more.
const PROOF_FACTOR: u64 = 20;
const PROOF_NODES: u64 = 10_000;

/// k centers such that no point of `points`, n × d, is farther than `radius` from the nearest, with a radius at most 1 + ε times the
/// least possible.
///
/// With [`CentersOptions::inputs`] rows are balls or ellipsoids in place of points, each of which one ball of that radius holds whole.
/// Rows with one value in the column [`CentersOptions::group`] are a group, such as the vertices of a polytope: all of them are within
/// `radius` of one center.
///
/// The problem is NP-hard; the time is exponential in k, and proofs are what takes it. In the plane gaps of 1e-6 are proved up to k
/// of about 12, and 1 % up to about 15; in space 1 % up to about 10. Whatever the k, the search can be stopped
/// ([`CentersOptions::max_nodes`]) and returns centers with the gap proved so far, at worst that of farthest-first traversal, a
/// factor of 2 (with weights or outliers there is no such promise). Duplicates, points on a line and k ≥ n are solved as any others.
///
/// *Cost.* Nodes of some 5 to 50 µs in the plane and in space, and of milliseconds in hundreds of dimensions, where for
/// k = 1 [`ball()`](crate::ball()) is far better: about a thousand for k = 5, 10⁴ for k = 10, 10⁵ for k = 15 in the plane at 1 %. All points are
/// in memory as `f64`, three times as they are put in order and twice from then on; a look at all of them takes a small part of
/// them on average in few dimensions.
///
/// *Source.* See the head of the method's module.
///
/// ```
/// use taut_enclose::{CentersOptions, centers};
///
/// // Two pairs, far from each other.
/// let points = [0.0, 0.0, 0.0, 2.0, 9.0, 0.0, 9.0, 1.0];
/// let points = taut_points::Points::new(&points, 2)?;
/// let found = centers(&points, 2, &CentersOptions { epsilon: 1e-6, ..Default::default() })?;
/// assert_eq!(found.answer.radius, 1.0);
/// assert!(found.answer.lower_bound > 0.999_999);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Error::Empty`], [`Error::Overflow`]; [`Error::Input`], also when the source fails or the monitor stops the work; with
/// weights [`Error::NoWeight`] and [`Error::NonPositiveWeight`]; of balls [`Error::NoRadius`] and [`Error::NegativeRadius`]; of
/// ellipsoids [`Error::NoShape`] and [`Error::NegativeShape`].
pub fn centers(
    source: &dyn PointSource,
    k: usize,
    options: &CentersOptions<'_>,
) -> Result<Solution<Centers>, Error> {
    options.check(k)?;
    let (items, monitor) = (options.inputs, &options.monitor);
    on_threads(options.threads, || {
        let is_plain = items == Items::Points
            && !options.weights
            && options.outliers == 0
            && options.group.is_none();
        if options.method == CentersMethod::FarthestFirst && is_plain {
            match traversed(source, k as u64, options, monitor) {
                // Sizes that no one scale holds are for those who have all points in memory.
                Err(Error::Overflow) if source.elsewhere().is_none() => {}
                found => return found,
            }
        }
        if let Some(elsewhere) = source.elsewhere() {
            return in_parts::solve(source, elsewhere, k, options, monitor);
        }
        if items == Items::Ellipsoids {
            return of_ellipsoids::solve(source, k, options, monitor);
        }
        if let CentersMethod::Stream(streaming) = options.method {
            return centers_in_two_passes(source, k, options.placement, &streaming, monitor);
        }
        solve(source, items, k, options, monitor)
    })
}

/// The first k points of a traversal.
fn traversed(
    source: &dyn PointSource,
    k: u64,
    options: &CentersOptions<'_>,
    monitor: &Monitor<'_>,
) -> Result<Solution<Centers>, Error> {
    let traversal = FarthestFirstOptions { monitor: *monitor, ..FarthestFirstOptions::default() };
    let order = farthest_first_in_blocks(source, k, &traversal)?;
    let mut found = order.solution(k, options.placement, source)?;
    if options.assignment {
        found.answer.assignment = nearest::assignment(source, &found.answer.centers, monitor)?;
        found.trace.passes += 1;
    }
    Ok(found)
}

fn solve(
    source: &dyn PointSource,
    items: Items,
    k: usize,
    options: &CentersOptions<'_>,
    monitor: &Monitor<'_>,
) -> Result<Solution<Centers>, Error> {
    let rows = ItemRows::read(source, items, options.weights, options.group, monitor)?;
    if options.outliers >= rows.group_count() as u64 {
        return Err(Error::Input(InputError::Option {
            name: "outliers",
            value: options.outliers.to_string(),
            expected: "less than the number of items, or of their groups",
        }));
    }
    let trivial = |rows: &ItemRows| {
        let trivial = TrivialCenters::of(rows, k, options.outliers as usize)?;
        Some(trivial.solution(k, options.placement, options, items, rows.hash))
    };
    if options.placement == Placement::Rows {
        return match trivial(&rows) {
            Some(found) => Ok(found),
            None => rows::solve(rows, items, k, options, monitor),
        };
    }
    let table = Table::of(rows)?;
    if let Some(found) = trivial(&table.rows) {
        return Ok(found);
    }
    match table.rows.dim {
        2 => solve_in::<[f64; 2]>(&table, items, k, options, monitor),
        3 => solve_in::<[f64; 3]>(&table, items, k, options, monitor),
        _ => solve_in::<Vec<f64>>(&table, items, k, options, monitor),
    }
}

fn solve_in<P: Position>(
    table: &Table,
    items: Items,
    k: usize,
    options: &CentersOptions<'_>,
    monitor: &Monitor<'_>,
) -> Result<Solution<Centers>, Error> {
    let mut cloud = Cloud::<P>::new(table.items(), &table.rows.groups);
    cloud.is_grouped = options.group.is_some();
    // More centers than items are of no use, but what is proved is proved of as many as were asked for.
    let asked = k;
    let k = k.min(cloud.group_count());
    let z = options.outliers as usize;
    let target = (options.epsilon - GAP_MIN).max(GAP_MIN);
    let start = start::start(&cloud, k, z, monitor)?;
    let separated = start.separated.clone();
    let found = match options.method {
        CentersMethod::Tree => {
            tree::solve(&cloud, start, k, z, target, options.max_nodes, monitor)?
        }
        CentersMethod::Thesis => {
            thesis::solve(&cloud, start.plain, k, target, options.max_nodes, monitor)?
        }
        // Streams are not held in memory, and so do not come here.
        CentersMethod::FarthestFirst | CentersMethod::Stream(_) => of_traversal(start),
    };
    let unit = table.scale * table.weight_scale;
    let claim = |lower, core_set: &[u32]| lower_bound(lower, core_set, table, &cloud) * unit;
    let (proof, given_up, why) = prove(&claim, &cloud, &found, separated, k, z, monitor)?;
    let answered = answer::answer(table, &cloud, &found.incumbent.centers, z, options.assignment)?;
    finish(table, &cloud, items, asked, options, found, proof, (given_up, why), answered)
}

/// Centers of the traversal, with its own bound.
fn of_traversal<P: Position>(start: Start<P>) -> SearchResult<P> {
    let core_set = start.separated;
    let (lower, upper, working_set) = (start.lower, start.plain.radius, core_set.len() as u64);
    SearchResult {
        incumbent: start.plain,
        proved: vec![],
        refuted: None,
        core_set,
        stop: Stop::Converged,
        nodes: 0,
        restarts: 0,
        scans: 0,
        history: vec![PassBounds { lower, upper, working_set }],
    }
}

/// The largest of the radii shown that can be proved again; how many could not, and why not the largest of all. `claim` is that of
/// [`Proof::by_tree`].
fn prove<P: Position>(
    claim: &dyn Fn(f64, &[u32]) -> f64,
    cloud: &Cloud<P>,
    found: &SearchResult<P>,
    separated: Vec<u32>,
    k: usize,
    z: usize,
    monitor: &Monitor<'_>,
) -> Result<(Proof, u64, Option<Stop>), Error> {
    let plain = match separated.is_empty() {
        true => Proof::none(),
        false => Proof::separated(cloud, separated, monitor)?,
    };
    let mut budget = found.nodes.saturating_mul(PROOF_FACTOR).saturating_add(PROOF_NODES);
    let recorded =
        found.refuted.as_ref().map(|(lower, refutation)| Proof::by_nogoods(*lower, refutation));
    let plain = recorded.filter(|recorded| recorded.lower > plain.lower).unwrap_or(plain);
    let (mut given_up, mut why) = (0, None);
    for &ProvedBound { threshold, items } in found.proved.iter().rev() {
        if threshold <= plain.lower {
            break;
        }
        let core_set = &found.core_set[..items];
        match Proof::by_tree(cloud, core_set, threshold, k, z, budget, claim, monitor)? {
            Ok(proof) if proof.lower >= plain.lower => return Ok((proof, given_up, why)),
            tried => why = why.or(Some(tried.err().unwrap_or(Stop::Rounding))),
        }
        given_up += 1;
        // All tries together cost no more than two of the first.
        budget /= 2;
    }
    Ok((plain, given_up, why))
}

fn finish<P: Position>(
    table: &Table,
    cloud: &Cloud<P>,
    items: Items,
    k: usize,
    options: &CentersOptions<'_>,
    found: SearchResult<P>,
    proof: Proof,
    (given_up, why): (u64, Option<Stop>),
    answered: answer::ItemReport,
) -> Result<Solution<Centers>, Error> {
    let unit = table.scale * table.weight_scale;
    if !(unit > 0.0 && unit.is_finite()) {
        return Err(Error::Overflow);
    }
    let radius = answered.radius;
    let lower = lower_bound(proof.lower, &proof.core_set, table, cloud).min(radius);
    let gap = gap_between(lower, radius);
    let stop = stop_of(gap, found.stop, why, options);
    let events = [
        ("nodes", found.nodes),
        ("restarts", found.restarts),
        ("scans", found.scans),
        ("proof_nodes", proof.nodes),
        ("proofs_given_up", given_up),
    ];
    // The bounds shown on the way, as far as they are proved in the end.
    let bounds = |b: &PassBounds| PassBounds {
        lower: (b.lower / unit).min(lower),
        upper: (b.upper / unit).max(radius).min(f64::MAX),
        ..*b
    };
    let trace = Trace {
        method: options.method.name().to_owned(),
        stop,
        passes: 1,
        iterations: found.nodes,
        core_set: found.core_set.len() as u64,
        history: found.history.iter().map(bounds).collect(),
        counters: counters(&events),
    };
    // Where nothing is claimed, nothing is shown.
    let core_set = if lower > 0.0 { proof.core_set } else { vec![] };
    let answer = Centers {
        centers: answered.centers,
        rows: vec![],
        radius,
        lower_bound: lower,
        outliers: answered.outliers,
        assignment: answered.assignment,
    };
    let certificate = CentersCertificate {
        items,
        weights: options.weights,
        group: options.group.map(|column| column as u64),
        placement: options.placement,
        k: k as u64,
        outliers: options.outliers,
        gap,
        core_set: core_set.into_iter().map(|item| cloud.rows[item as usize]).collect(),
        directions: vec![],
        proof: proof.kind,
        points_hash: table.rows.hash,
    };
    Ok(Solution { answer, certificate, trace })
}

/// radius/lower − 1, rounded up.
fn gap_between(lower: f64, radius: f64) -> f64 {
    match radius {
        0.0 => 0.0,
        // JSON knows no infinity.
        _ if lower <= 0.0 => f64::MAX,
        _ => ((radius / lower).next_up() - 1.0).next_up().min(f64::MAX),
    }
}

/// Why a search ended, if its proof is of this gap; `why` is the reason that nothing better was proved.
fn stop_of(gap: f64, found: Stop, why: Option<Stop>, options: &CentersOptions<'_>) -> Stop {
    let wanted = if options.epsilon > 0.0 { options.epsilon } else { ROUNDING };
    match found {
        _ if gap <= wanted || options.method == CentersMethod::FarthestFirst => Stop::Converged,
        Stop::Converged => why.unwrap_or(Stop::Rounding),
        stop => stop,
    }
}

/// The events that occurred, by name.
fn counters(events: &[(&str, u64)]) -> BTreeMap<String, u64> {
    let occurred = events.iter().filter(|(_, count)| *count > 0);
    occurred.map(|&(name, count)| (name.to_owned(), count)).collect()
}

/// Returns what a proof shows, in the units of the rows and less by what rounding there may have added; 0 where it may have added anything.
fn lower_bound<P: Position>(proved: f64, core_set: &[u32], table: &Table, cloud: &Cloud<P>) -> f64 {
    let weights = core_set.iter().map(|&item| cloud.items.weight(item as usize));
    let weight = weights.fold(0.0, f64::max);
    if proved < LEAST_PROVED * weight {
        return 0.0;
    }
    let unit = table.scale * table.weight_scale;
    let lower = proved / unit;
    claimed(
        if lower * unit > proved { lower.next_down() } else { lower },
        weight / table.weight_scale,
    )
}
