//! k equal balls around ellipsoids, each of which lies whole in one of them.
//!
//! *Problem.* Ellipsoids {m + v : vv′ ⪯ S}, k and z: k balls of the least equal radius such that each ellipsoid but z lies in one.
//! *Idea.* An ellipsoid is the group of its points, of which a search over groups needs few. It is made over the few that are known
//! ([`pool`]); then ellipsoids are measured whole from the centers found, and those that reach farther get further points
//! ([`rounds`]), until that makes no difference.
//! *Guarantee.* What no k balls do with the points, they do not do with the ellipsoids: the lower bound and its proof are those of
//! the search. The upper bound is measured on the ellipsoids, from the centers as they are returned.
//! *Cost.* A tree over the points for each of some five to thirty rounds, and some ten looks at all ellipsoids for each.
//! *Reference.* The oracle of farthest points is that of the ball ([`reach`](crate::shapes::reach)); cutting planes for sets of
//! infinitely many points are those of Kelley, J. SIAM 8, 1960.

mod bodies;
mod pool;
mod rounds;

use taut_certify::{Centers, CentersCertificate, Items, PassBounds, Placement, Solution, Trace};
use taut_points::parallel::ParallelSlice;
use taut_points::{InputError, Monitor, OrderBy, PointSource};

use self::bodies::Bodies;
use self::rounds::{Found, Rounds};
use super::item_rows::ItemRows;
use super::items::{Position, Shape};
use super::proof::Proof;
use super::tree::SearchResult;
use super::trivial::TrivialCenters;
use super::{CentersOptions, counters, gap_between, prove, stop_of};
use crate::Error;
use crate::centers::start::Incumbent;
use crate::shapes::Shapes;

/// Ellipsoids that reach this near to the radius, relatively, are measured again from the centers as they are returned.
const BORDER: f64 = 1e-8;

pub(super) fn solve(
    source: &dyn PointSource,
    k: usize,
    options: &CentersOptions<'_>,
    monitor: &Monitor<'_>,
) -> Result<Solution<Centers>, Error> {
    let shapes = Shapes::read(source, Items::Ellipsoids, monitor)?;
    if options.outliers >= shapes.len() as u64 {
        return Err(Error::Input(InputError::Option {
            name: "outliers",
            value: options.outliers.to_string(),
            expected: "less than the number of items, or of their groups",
        }));
    }
    if let Some(found) = of_points(&shapes, k, options) {
        return Ok(found);
    }
    let bodies = Bodies::of(&shapes)?;
    match shapes.dim() {
        2 => solve_in::<[f64; 2]>(&shapes, &bodies, k, options, monitor),
        3 => solve_in::<[f64; 3]>(&shapes, &bodies, k, options, monitor),
        _ => solve_in::<Vec<f64>>(&shapes, &bodies, k, options, monitor),
    }
}

/// The answer of radius 0, where all ellipsoids that are not left out are points at k places.
fn of_points(shapes: &Shapes, k: usize, options: &CentersOptions<'_>) -> Option<Solution<Centers>> {
    let (dim, n) = (shapes.dim(), shapes.len());
    let (points, others): (Vec<usize>, Vec<usize>) = (0..n).partition(|&i| shapes.is_point(i));
    let left = (options.outliers as usize).checked_sub(others.len())?;
    let rows = ItemRows {
        shape: Shape::Points,
        dim,
        columns: dim,
        values: points.iter().flat_map(|&i| shapes.center(i)).copied().collect(),
        groups: vec![],
        hash: shapes.hash(),
    };
    let trivial = TrivialCenters::of(&rows, k, left)?;
    let hash = shapes.hash();
    let mut found = trivial.solution(k, Placement::Free, options, Items::Ellipsoids, hash);
    let answer = &mut found.answer;
    let of_points = answer.outliers.iter().map(|&row| points[row as usize] as u64);
    answer.outliers = of_points.chain(others.iter().map(|&i| i as u64)).collect();
    answer.outliers.sort_unstable();
    if options.assignment && !others.is_empty() {
        let bodies = Bodies::of(shapes).ok()?;
        let served = bodies.served_from(&answer.centers);
        answer.assignment = served.iter().map(|served| served.center as u32).collect();
    }
    Some(found)
}

fn solve_in<P: Position>(
    shapes: &Shapes,
    bodies: &Bodies<'_>,
    k: usize,
    options: &CentersOptions<'_>,
    monitor: &Monitor<'_>,
) -> Result<Solution<Centers>, Error> {
    // More centers than ellipsoids are of no use, but what is proved is proved of as many as were asked for.
    let (most, z) = (k.min(shapes.len()), options.outliers as usize);
    let mut rounds = Rounds::<P>::new(bodies, most, z, monitor);
    let found = rounds.run(options.epsilon, options.max_nodes)?;
    let unit = bodies.scale;
    // Of a scale that is a power of two, nothing is lost but among subnormal numbers.
    let out = |lower: f64| {
        let scaled = lower * unit;
        if scaled / unit > lower { scaled.next_down() } else { scaled }
    };
    let claim = |lower: f64, _: &[u32]| out(lower) / unit;
    let Found { best, numbered, separated, history, .. } = found;
    let search = SearchResult {
        incumbent: Incumbent { centers: best.centers, radius: best.radius },
        proved: found.proved,
        refuted: None,
        core_set: found.core_set,
        stop: found.stop,
        nodes: found.nodes,
        restarts: found.restarts,
        scans: found.scans,
        history,
    };
    let (proof, given_up, why) =
        prove(&claim, &numbered.cloud, &search, separated, most, z, monitor)?;
    let (mut answer, radius) = answer(bodies, &search.incumbent.centers, z, options)?;
    let lower = if proof.lower.is_finite() { out(proof.lower).clamp(0.0, radius) } else { 0.0 };
    answer.lower_bound = lower;
    let gap = gap_between(lower, radius);
    let Proof { core_set, kind, nodes: proof_nodes, .. } = proof;
    // Where nothing is claimed, nothing is shown.
    let points = if lower > 0.0 { numbered.points(&core_set) } else { vec![] };
    let (core_set, directions) = points.into_iter().map(|point| rounds.pool.name(point)).unzip();
    let bounds = |b: &PassBounds| PassBounds {
        lower: (b.lower * unit).min(lower),
        upper: (b.upper * unit).max(radius).min(f64::MAX),
        ..*b
    };
    let trace = Trace {
        method: options.method.name().to_owned(),
        stop: stop_of(gap, search.stop, why, options),
        passes: 1,
        iterations: search.nodes,
        core_set: search.core_set.len() as u64,
        history: search.history.iter().map(bounds).collect(),
        counters: counters(&[
            ("nodes", search.nodes),
            ("restarts", search.restarts),
            ("scans", search.scans),
            ("rounds", found.rounds),
            ("points", rounds.pool.len() as u64),
            ("proof_nodes", proof_nodes),
            ("proofs_given_up", given_up),
        ]),
    };
    let certificate = CentersCertificate {
        items: Items::Ellipsoids,
        weights: false,
        group: None,
        placement: Placement::Free,
        k: k as u64,
        outliers: options.outliers,
        gap,
        core_set,
        directions,
        proof: kind,
        points_hash: shapes.hash(),
    };
    Ok(Solution { answer, certificate, trace })
}

/// The answer but for its lower bound, with every reach measured once more from the centers as they are returned; and its radius.
fn answer<P: Position>(
    bodies: &Bodies<'_>,
    centers: &[P],
    z: usize,
    options: &CentersOptions<'_>,
) -> Result<(Centers, f64), Error> {
    let mut is_used = vec![false; centers.len()];
    bodies.served(centers).iter().for_each(|served| is_used[served.center] = true);
    let used = centers.iter().zip(is_used).filter(|(_, is_used)| *is_used);
    let outside: Vec<Vec<f64>> =
        used.map(|(center, _)| bodies.bring_out(center.as_ref())).collect();
    if outside.iter().flatten().any(|c| !c.is_finite()) {
        return Err(Error::Overflow);
    }
    let served = bodies.served_from(&outside);
    let mut order: Vec<usize> = (0..served.len()).collect();
    order.order_by(&|&a, &b| served[b].reach.total_cmp(&served[a].reach).then(a.cmp(&b)));
    let farthest = order.get(z).map_or(0.0, |&i| served[i].reach);
    let border = farthest * (1.0 - BORDER) - 8.0 * bodies.place_error;
    // Eigenvalues, roots and sums; and what the checker rounds up.
    let rounding = 16.0 * (bodies.dim() + 4) as f64 * f64::EPSILON;
    let exact = |i: usize| bodies.reach_from(i, &outside[served[i].center]) * (1.0 + rounding);
    let near = order[z.min(order.len())..].iter().take_while(|&&i| served[i].reach >= border);
    let near: Vec<usize> = near.copied().collect();
    let reaches: Vec<f64> = near.par_iter().with_min_len(16).map(|&i| exact(i)).collect();
    let largest = reaches.into_iter().fold(0.0, f64::max);
    let radius = largest.next_up();
    if !(radius.is_finite() && radius >= f64::MIN_POSITIVE) {
        return Err(Error::Overflow);
    }
    let is_out = |&&i: &&usize| exact(i) > largest;
    let mut outliers: Vec<u64> =
        order[..z.min(order.len())].iter().filter(is_out).map(|&i| i as u64).collect();
    outliers.sort_unstable();
    let numbers = served.iter().map(|served| served.center as u32);
    let assignment = if options.assignment { numbers.collect() } else { vec![] };
    let answer =
        Centers { centers: outside, rows: vec![], radius, lower_bound: 0.0, outliers, assignment };
    Ok((answer, radius))
}
