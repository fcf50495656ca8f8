//! The minimum enclosing ball of ellipsoids: exact balls of touching points.
//!
//! *Problem.* Items {m + v : vv′ ⪯ S}: the ball of least radius that encloses them all.
//! *Idea.* It is the ball of the points of all items. The working set holds some of these points, each known by its item
//! and a direction; its exact ball is that of the default method for points ([`active_set`](super::active_set)); a pass
//! asks every item for its farthest point from the center ([`reach`]), and those outside join the set.
//! *Guarantee.* Lower bounds never fall; it stops at R ≤ (1 + ε)·r. The axes of an item do not change from pass to pass:
//! they are found once, in O(d³), and a pass costs O(d²) for each item and a few steps of O(d).
//! *Trap.* Where an item touches in a circle, any point of it is farthest: so an item names several points at once.
//! *Reference.* The oracle is the trust-region problem; Moré and Sorensen, SIAM J. Sci. Stat. Comput. 4(3), 1983.

use taut_certify::{Ball, BallCertificate, Items, PassBounds, Solution, Stop, Trace};
use taut_kernels::vector::{add_scaled, dot};
use taut_kernels::{Center, DoubleDouble};
use taut_points::parallel::{IntoParallel, ParallelSlice};
use taut_points::{InputError, Monitor, OrderBy, PointSource, ReadError};

use super::active_set::{ActiveSet, VIOLATION_TOLERANCE};
use super::core_set::{ROUNDING, solve_working_set};
use super::working_set::WorkingSet;
use super::{BallMethod, BallOptions};
use crate::Error;
use crate::shapes::Shapes;
use crate::shapes::axes::{Axes, diagonal, units};
use crate::shapes::eigen::eigen;
use crate::shapes::frame::{Framed, Map};
use crate::shapes::reach::{alternatives, farthest};

/// Points that join after a pass, at most, for each dimension.
const BATCH: usize = 4;
/// A point of an item is named beside its farthest if it lies outside by this part of what that does.
const NEAR_POINT_RATIO: f64 = 0.1;
/// This many passes without a better gap show that rounding is in the way.
const STALE_PASSES_MAX: u32 = 4;
/// Items that reach this near the border, relatively, are measured again from the center as it is returned.
const BORDER_TOLERANCE: f64 = 1e-8;
/// A center beyond this many radii is kept in two terms.
const FAR_OFF: f64 = 8.0;

/// A point of an item by its direction.
#[derive(Clone)]
struct SupportPoint {
    item: usize,
    direction: Vec<f64>,
}

/// The result of a pass: squared reaches, and the points outside, the farthest first.
struct PassResult {
    squares: Vec<f64>,
    farthest: f64,
    outside: Vec<(f64, SupportPoint)>,
}

/// The best multipliers so far.
struct Best {
    gap: f64,
    squares: Vec<f64>,
    center: Vec<f64>,
    support: Vec<(SupportPoint, f64)>,
}

pub(super) fn solve(
    source: &dyn PointSource,
    options: &BallOptions<'_>,
    monitor: &Monitor<'_>,
) -> Result<Solution<Ball>, Error> {
    if options.method != BallMethod::CoreSet {
        return Err(Error::Input(InputError::Option {
            name: "method",
            value: options.method.name().to_owned(),
            expected: "core-set, the one method for ellipsoids",
        }));
    }
    let shapes = Shapes::read(source, Items::Ellipsoids, monitor)?;
    let (origin, scale) = units(&shapes)?;
    let dim = shapes.dim();
    let unit: Vec<f64> = diagonal(dim, 1.0 / scale);
    let framed = Framed::of(&shapes, Map { matrix: &unit, center: &origin });
    if !framed.is_finite() {
        return Err(Error::Overflow);
    }
    let axes = Axes::of_all(&framed);
    let start = pass(&framed, &axes, &vec![0.0; dim], 0.0, &vec![vec![]; shapes.len()]);
    let mut trace =
        Trace { method: options.method.name().to_owned(), passes: 2, ..Trace::default() };
    let mut support_points: Vec<SupportPoint> = vec![];
    let mut set = WorkingSet::new(vec![0.0; dim], 0.0);
    let batch = options.batch.unwrap_or(BATCH * dim).max(2);
    add(&framed, &mut set, &mut support_points, start.outside, batch);
    if set.len() == 0 {
        // Everything is the origin, which is a row.
        let support = vec![(SupportPoint { item: 0, direction: vec![0.0; dim] }, 1.0)];
        let best = Best { gap: 0.0, squares: start.squares, center: vec![0.0; dim], support };
        trace.core_set = 1;
        return prove(&shapes, &origin, scale, best, trace, options);
    }
    let mut active = ActiveSet::new(&set, start.farthest);
    let mut best: Option<Best> = None;
    let wanted = if options.epsilon > 0.0 { options.epsilon } else { ROUNDING };
    let (mut radius, mut stale) = (0.0, 0);
    trace.stop = loop {
        radius = solve_working_set(&mut active, &set, radius, monitor).map_err(ReadError::from)?;
        active.refine(&set);
        let center = set.combination(active.support(), active.lambda());
        trace.passes += 1;
        monitor.pass(trace.passes, shapes.len() as u64);
        monitor.check().map_err(ReadError::from)?;
        let mut seeds = vec![vec![]; shapes.len()];
        for support_point in active.support().iter().map(|&i| &support_points[set.id(i) as usize]) {
            seeds[support_point.item].push(&support_point.direction[..]);
        }
        let found = pass(&framed, &axes, &center, radius * radius, &seeds);
        monitor.points(shapes.len() as u64);
        let upper = found.farthest.sqrt();
        trace.history.push(PassBounds {
            lower: radius * scale,
            upper: (upper * scale).min(f64::MAX),
            working_set: set.len() as u64,
        });
        let gap = if upper <= radius { 0.0 } else { upper / radius - 1.0 };
        let is_better = best.as_ref().is_none_or(|best| gap < best.gap);
        stale = if is_better { 0 } else { stale + 1 };
        let outside = found.outside;
        if is_better {
            let support = active.support().iter().zip(active.lambda());
            let named = |(&i, &l): (&usize, &f64)| (support_points[set.id(i) as usize].clone(), l);
            best = Some(Best {
                gap,
                squares: found.squares,
                center,
                support: support.map(named).collect(),
            });
        }
        let reached = best.as_ref().map_or(f64::INFINITY, |best| best.gap);
        if reached <= wanted {
            break Stop::Converged;
        }
        if outside.is_empty() || stale >= STALE_PASSES_MAX && reached < 1e-6 {
            break Stop::Rounding;
        }
        if trace.passes >= options.max_passes && radius > 0.0 {
            break Stop::PassBudget;
        }
        add(&framed, &mut set, &mut support_points, outside, batch);
        active.widen(&set);
    };
    trace.iterations = active.pivots;
    trace.core_set = set.len() as u64;
    let best = best.expect("the loop ends after a pass");
    prove(&shapes, &origin, scale, best, trace, options)
}

/// Takes the first of the points found to the working set.
fn add(
    framed: &Framed,
    set: &mut WorkingSet,
    support_points: &mut Vec<SupportPoint>,
    found: Vec<(f64, SupportPoint)>,
    most: usize,
) {
    let first = support_points.len();
    support_points.extend(found.into_iter().take(most).map(|found| found.1));
    let ids: Vec<u64> = (first as u64..support_points.len() as u64).collect();
    let rows: Vec<f64> = support_points[first..]
        .iter()
        .flat_map(|t| framed.touching(t.item, &t.direction))
        .collect();
    set.add(&ids, rows, false);
}

/// Asks every item for its farthest point from a center.
fn pass(
    framed: &Framed,
    axes: &[Axes],
    center: &[f64],
    square: f64,
    seeds: &[Vec<&[f64]>],
) -> PassResult {
    let beyond = square * (1.0 + VIOLATION_TOLERANCE);
    let each: Vec<(f64, Vec<(f64, SupportPoint)>)> = (0..framed.len())
        .into_par_iter()
        .with_min_len(32)
        .map(|i| {
            let axes = &axes[i];
            let h = axes.along(framed.center(i), center);
            let best = farthest(&axes.squares, &h);
            let mut support_points = vec![];
            if best.square > beyond {
                let worth = square + NEAR_POINT_RATIO * (best.square - square);
                let seeds: Vec<Vec<f64>> = seeds[i].iter().map(|a| seed(axes, a)).collect();
                alternatives(&axes.squares, &h, &best, &seeds, |square, beta| {
                    if square >= worth {
                        let direction = axes.direction(beta);
                        support_points.push((square, SupportPoint { item: i, direction }));
                    }
                });
            }
            (best.square, support_points)
        })
        .collect();
    let mut found = PassResult { squares: vec![], farthest: 0.0, outside: vec![] };
    for (square, support_points) in each {
        found.farthest = found.farthest.max(square);
        found.squares.push(square);
        found.outside.extend(support_points);
    }
    found.outside.order_by(&|a, b| b.0.total_cmp(&a.0));
    found
}

/// A point of an item by z along its axes, up to length: Λ^½ times the direction.
fn seed(axes: &Axes, direction: &[f64]) -> Vec<f64> {
    let rows = axes.directions.chunks_exact(direction.len());
    rows.zip(&axes.squares).map(|(v, l)| l.max(0.0).sqrt() * dot(v, direction)).collect()
}

/// Both bounds again, from the center as it is returned.
fn prove(
    shapes: &Shapes,
    origin: &Center,
    scale: f64,
    best: Best,
    mut trace: Trace,
    options: &BallOptions<'_>,
) -> Result<Solution<Ball>, Error> {
    let dim = shapes.dim();
    let farthest_of = best.squares.iter().copied().fold(0.0, f64::max);
    let center = settled(origin, scale, &best.center, scale * farthest_of.sqrt());
    let unit = diagonal(dim, 1.0 / scale);
    let map = Map { matrix: &unit, center: &center };
    let near =
        (0..shapes.len()).filter(|&i| best.squares[i] >= farthest_of * (1.0 - BORDER_TOLERANCE));
    let near: Vec<usize> = near.collect();
    let squares: Vec<f64> = near
        .par_iter()
        .with_min_len(16)
        .map(|&i| {
            let (lambda, vectors) = eigen(&mut map.shape_of(shapes, i), dim);
            let offset = map.center_of(shapes, i);
            let h: Vec<f64> = vectors.chunks_exact(dim).map(|v| dot(v, &offset)).collect();
            farthest(&lambda, &h).square
        })
        .collect();
    let largest = squares.into_iter().fold(0.0, f64::max);
    // Eigenvalues, roots and sums; and what the checker rounds up.
    let rounding = 16.0 * (dim + 4) as f64 * f64::EPSILON;
    let radius = scale * largest.sqrt() * (1.0 + rounding);
    if !radius.is_finite() {
        return Err(Error::Overflow);
    }
    let mut support: Vec<(SupportPoint, f64)> =
        best.support.into_iter().filter(|entry| entry.1 > 0.0).collect();
    support.order_by_key(|entry| entry.0.item);
    let total: f64 = support.iter().map(|entry| entry.1).sum();
    let (mut mean, mut square) = (vec![0.0; dim], 0.0);
    for (support_point, lambda) in &support {
        let y = map.touching(shapes, support_point.item, &support_point.direction);
        square += lambda / total * dot(&y, &y);
        add_scaled(&mut mean, lambda / total, &y);
    }
    let lower = (square - dot(&mean, &mean)).max(0.0).sqrt();
    let gap = match radius {
        0.0 => 0.0,
        _ => (radius / scale / lower - 1.0).max(0.0) + rounding,
    };
    if trace.stop == Stop::Converged && gap > options.epsilon.max(ROUNDING) {
        trace.stop = Stop::Rounding;
    }
    let certificate = BallCertificate {
        items: Items::Ellipsoids,
        support: support.iter().map(|entry| entry.0.item as u64).collect(),
        multipliers: support.iter().map(|entry| entry.1 / total).collect(),
        directions: support.into_iter().map(|entry| entry.0.direction).collect(),
        gap: gap.min(f64::MAX),
        points_hash: shapes.hash(),
    };
    let answer = Ball { center: center.high, center_tail: center.low, radius };
    Ok(Solution { answer, certificate, trace })
}

/// The center in the space of the items; in two terms where rounding it to one could be seen.
fn settled(origin: &Center, scale: f64, center: &[f64], radius: f64) -> Center {
    let terms: Vec<DoubleDouble> =
        origin.high.iter().zip(center).map(|(&o, &c)| DoubleDouble::sum(o, c * scale)).collect();
    let high: Vec<f64> = terms.iter().map(|term| term.high).collect();
    let is_far = high.iter().any(|c| c.abs() > FAR_OFF * radius);
    let low = if is_far { terms.iter().map(|term| term.low).collect() } else { vec![] };
    Center { high, low }
}
