//! The minimum volume enclosing ellipsoid of balls or ellipsoids: pools of touching points.
//!
//! *Problem.* Items {m + v : vv′ ⪯ S}: the ellipsoid of least volume that encloses them all.
//! *Idea.* It is that of the points of all items, of which there is no end; but the methods for points only ask who lies
//! outside. So the pool holds points of items, each known by its item and a direction; its ellipsoid is found as for
//! points ([`newton`]), a pass asks every item for its farthest point ([`reach`]), those outside join the pool, and so
//! on until none is outside by more than the wanted gap. The multipliers of the pool prove the bound.
//! *Guarantee.* Lower bounds never fall. All items are brought once to a frame in which a sample of them is round, with
//! twice the digits; there, neither units nor the ratio of axes matter.
//! *Cost.* O(r³) for an item that may reach outside, O(r²) for any other, in each of a dozen passes or two.
//! *Trap.* Where an item touches in a circle, as a ball does that lies on an axis of the answer, its farthest point is
//! any of a continuum; a method that is told one at a time crawls along. So an item names several points at once.
//! *Reference.* Yıldırım, SIAM J. Optim. 17(3), 2006, for core-sets of ellipsoids; the oracle is the trust-region
//! problem.

use rayon::prelude::*;
use taut_certify::{
    Ellipsoid, EllipsoidCertificate, Hull, Items, PassBounds, Solution, Stop, Trace,
};
use taut_points::{Monitor, OwnedPoints, PointSource, ReadError};

use super::counters::Counters;
use super::dense::forward;
use super::flat::{self, Look, lifted};
use super::newton::{self, gap};
use super::outcome::{log_unit_ball, trial_log_volume};
use super::pool::Pool;
use super::proof::{LOGARITHMS, answer, lower_gap};
use super::rounds::center_of;
use super::sample::Sample;
use super::survey::Survey;
use super::whitener::{Rebased, Whitener};
use super::{EllipsoidMethod, EllipsoidOptions, ROUNDING};
use crate::Error;
use crate::kernel::vector::{add_scaled, dot};
use crate::kernel::{Center, DoubleDouble};
use crate::shapes::Shapes;
use crate::shapes::eigen::eigen;
use crate::shapes::frame::{Framed, Map};
use crate::shapes::reach::{alternatives, farthest};

/// Points of the first pool, for each of the d(d + 3)/2 that can be needed; and points that may join after a pass.
const FIRST: usize = 4;
const LATER: usize = 2;
/// Items of a sample from which an affine basis is taken.
const SAMPLE: usize = 200;
/// A point of an item is named beside its farthest if it lies outside by this part of what that does.
const WORTH: f64 = 0.1;
/// A point of the pool with no multiplier whose |y|² is below this part of d is of no use any more.
const USEFUL: f64 = 0.98;
/// Passes without a better gap that show that rounding is in the way, of gaps below [`SMALL`].
const STALE: u32 = 4;
const SMALL: f64 = 1e-6;
/// Items that reach this near the border, relatively, are measured again with twice the digits.
const NEAR: f64 = 1e-8;

/// Solves the items of a source.
pub(super) fn solve(
    source: &dyn PointSource,
    items: Items,
    options: &EllipsoidOptions,
    monitor: &Monitor<'_>,
) -> Result<Solution<Ellipsoid>, Error> {
    if options.method != EllipsoidMethod::Newton {
        return Err(Error::Option {
            name: "method",
            value: options.method.name().to_owned(),
            expected: "newton, the one method for balls and ellipsoids",
        });
    }
    let shapes = Shapes::read(source, items, monitor)?;
    let generators = generators(&shapes)?;
    let silent = Monitor { cancel: monitor.cancel, ..Monitor::silent() };
    let mut survey = Survey::new(&generators, &silent)?;
    match flat::look(&mut survey, options)? {
        Look::Full(sample, whitener) => {
            let dim = shapes.dim();
            let base = Base {
                center: center_of(&sample.origin, &whitener),
                matrix: whitener.matrix().to_vec(),
                lower: whitener.matrix().to_vec(),
                directions: None,
                rank: dim,
            };
            base.solve(&shapes, options, monitor)
        }
        Look::Flat(found) => in_flat(&shapes, &found, &generators, options, monitor),
    }
}

/// Points of the items that span what they span.
fn generators(shapes: &Shapes) -> Result<OwnedPoints<f64>, Error> {
    let mut values = vec![];
    for i in 0..shapes.len() {
        let center = shapes.center(i);
        let axes = shapes.factor(i);
        if axes.len() == 0 {
            values.extend_from_slice(center);
        }
        for axis in axes {
            for sign in [1.0, -1.0] {
                values.extend(center.iter().zip(axis).map(|(m, e)| m + sign * e));
            }
        }
    }
    if values.iter().any(|v| !v.is_finite()) {
        return Err(Error::Overflow);
    }
    Ok(OwnedPoints::new(values, shapes.dim()).expect("whole rows, one at least"))
}

/// Coordinates y = P(x − o) in which the items are round, all in all.
struct Base {
    center: Center,
    /// P, r × d.
    matrix: Vec<f64>,
    /// P as seen from the hull, lower triangular, r × r: P = LB.
    lower: Vec<f64>,
    /// B, r × d, where the items lie in a hull.
    directions: Option<Vec<f64>>,
    rank: usize,
}

/// A point of an item by its direction in the base.
#[derive(Clone)]
struct Touch {
    item: usize,
    direction: Vec<f64>,
}

/// The points of a pool by their numbers.
struct Touches {
    list: Vec<Touch>,
}

/// What a pass found.
struct Found {
    /// The largest |y|² of any item, and that of each item or a bound on it.
    largest: f64,
    squares: Vec<f64>,
    /// Points outside, the farthest first.
    outside: Vec<(f64, Touch)>,
}

/// The best multipliers so far, and what they mean.
struct Best {
    largest: f64,
    squares: Vec<f64>,
    matrix: Vec<f64>,
    center: Vec<f64>,
    support: Vec<(Touch, f64)>,
}

impl Base {
    fn solve(
        &self,
        shapes: &Shapes,
        options: &EllipsoidOptions,
        monitor: &Monitor<'_>,
    ) -> Result<Solution<Ellipsoid>, Error> {
        let framed = Framed::of(shapes, Map { matrix: &self.matrix, center: &self.center });
        if !framed.is_finite() {
            return Err(Error::Overflow);
        }
        let rank = self.rank;
        let wanted = options.epsilon.max(ROUNDING * rank as f64);
        let mut counters = Counters::default();
        let mut whitener = Whitener::of_scales(&vec![1.0; rank]);
        let axes = axes(&framed);
        let widths: Vec<f64> = axes.iter().map(Axes::longest).collect();
        let (mut pool, mut touches) = first_pool(&framed, axes);
        let later = LATER * (rank + 1) * (rank + 2) / 2;
        let later = later.max(64);
        let mut best: Option<Best> = None;
        let mut history = vec![];
        let mut tolerance = 1e-2;
        let (mut passes, mut stale) = (1, 0);
        let base_logs: f64 = (0..rank).map(|a| self.lower[a * rank + a].ln()).sum();
        let stop = loop {
            newton::solve(&mut pool, &mut whitener, tolerance, &mut counters, monitor)?;
            passes += 1;
            monitor.pass(passes, shapes.len() as u64);
            monitor.check().map_err(ReadError::from)?;
            let matrix = whitener.matrix();
            let center = whitener.center();
            let seeds = touches.seeds(&pool, shapes.len());
            let found = pass(&framed, &widths, matrix, &center, &seeds);
            monitor.points(shapes.len() as u64);
            if !found.largest.is_finite() {
                return Err(Error::Overflow);
            }
            let lower = trial_log_volume(rank, matrix) - base_logs;
            let reached = gap(rank, found.largest);
            history.push(PassBounds {
                lower,
                upper: lower + reached,
                working_set: pool.len() as u64,
            });
            let is_better = best.as_ref().is_none_or(|best| found.largest < best.largest);
            stale = if is_better { 0 } else { stale + 1 };
            let outside = found.outside;
            if is_better {
                best = Some(Best {
                    largest: found.largest,
                    squares: found.squares,
                    matrix: matrix.to_vec(),
                    center,
                    support: touches.support(&pool),
                });
            }
            let best_gap = best.as_ref().map_or(f64::INFINITY, |best| gap(rank, best.largest));
            if best_gap <= wanted {
                break Stop::Converged;
            }
            if passes >= options.max_passes {
                break Stop::PassBudget;
            }
            if stale >= STALE && best_gap < SMALL || outside.is_empty() && tolerance == 0.0 {
                break Stop::Rounding;
            }
            drop_useless(&mut pool, &whitener);
            let sharper = if 1e-2 * reached < 1e-3 {
                (1e-2 * reached).max(0.1 * wanted)
            } else {
                1e-2 * reached
            };
            tolerance = if outside.is_empty() { 0.0 } else { sharper };
            for (_, touch) in outside.into_iter().take(later) {
                let point = framed.touching(touch.item, &touch.direction);
                pool.push(touches.list.len() as u64, &point, 0.0);
                touches.list.push(touch);
            }
        };
        let best = best.expect("the loop ends after a pass");
        counters.others.insert("touching-points".into(), touches.list.len() as u64);
        let trace = Trace {
            method: options.method.name().to_owned(),
            stop,
            passes,
            iterations: counters.steps,
            core_set: pool.len() as u64,
            history,
            counters: counters.into_named(),
        };
        self.prove(shapes, best, trace, options)
    }

    /// F for the matrix M of the base: s·MP, r × d.
    fn factor(&self, matrix: &[f64], scale: f64) -> Vec<f64> {
        let (rank, dim) = (self.rank, self.center.dim());
        let mut factor = vec![0.0; rank * dim];
        for (a, row) in factor.chunks_exact_mut(dim).enumerate() {
            for b in 0..=a {
                let other = &self.matrix[b * dim..(b + 1) * dim];
                add_scaled(row, matrix[a * rank + b], other);
            }
            row.iter_mut().for_each(|v| *v *= scale);
        }
        factor
    }

    /// The point y of the base in the space of the items.
    fn back(&self, y: &[f64]) -> Center {
        let dim = self.center.dim();
        let mut inner = y.to_vec();
        forward(&self.lower, self.rank, &mut inner);
        let x = match &self.directions {
            None => inner,
            Some(directions) => {
                let mut x = vec![0.0; dim];
                for (&z, row) in inner.iter().zip(directions.chunks_exact(dim)) {
                    add_scaled(&mut x, z, row);
                }
                x
            }
        };
        let tail = |j: usize| self.center.low.get(j).copied().unwrap_or(0.0);
        let terms: Vec<DoubleDouble> = (0..dim)
            .map(|j| DoubleDouble { high: self.center.high[j], low: tail(j) }.add(x[j].into()))
            .collect();
        Center {
            high: terms.iter().map(|term| term.high).collect(),
            low: terms.iter().map(|term| term.low).collect(),
        }
    }

    /// From multipliers to an answer: containment is measured with F as it will be returned.
    fn prove(
        &self,
        shapes: &Shapes,
        best: Best,
        mut trace: Trace,
        options: &EllipsoidOptions,
    ) -> Result<Solution<Ellipsoid>, Error> {
        let rank = self.rank;
        let center = self.back(&best.center);
        let near: Vec<usize> =
            (0..shapes.len()).filter(|&i| best.squares[i] >= best.largest * (1.0 - NEAR)).collect();
        // What a reach found from exact coordinates may be off by: eigenvalues, roots and sums.
        let rounding = 16.0 * (rank + 4) as f64 * f64::EPSILON;
        let mut scale = (1.0 - rounding) / best.largest.sqrt();
        let mut factor = self.factor(&best.matrix, scale);
        let mut excess = 0.0;
        for _ in 0..4 {
            let map = Map { matrix: &factor, center: &center };
            let squares: Vec<f64> = near
                .par_iter()
                .with_min_len(16)
                .map(|&i| square(&map.shape_of(shapes, i), &map.center_of(shapes, i)))
                .collect();
            let largest = squares.into_iter().fold(0.0, f64::max);
            excess = (largest.sqrt() - 1.0 + rounding).max(0.0);
            if excess == 0.0 {
                break;
            }
            scale *= (1.0 - 2.0 * rounding) / largest.sqrt();
            factor = self.factor(&best.matrix, scale);
        }
        let dim = shapes.dim();
        let map = Map { matrix: &factor, center: &center };
        let mut support: Vec<(usize, Vec<f64>, f64)> = best
            .support
            .into_iter()
            .map(|(touch, u)| (touch.item, self.direction(&touch.direction), u))
            .collect();
        support.sort_by_key(|entry| entry.0);
        let images: Vec<f64> =
            support.iter().flat_map(|(i, a, _)| map.touching(shapes, *i, a)).collect();
        let multipliers: Vec<f64> = support.iter().map(|entry| entry.2).collect();
        let lower = lower_gap(&images, &multipliers, rank);
        let gap = (lower + rank as f64 * (excess + LOGARITHMS)).min(f64::MAX);
        let hull = self.hull(shapes, &center);
        let log_volume = match self.directions {
            None => log_unit_ball(rank) - (0..rank).map(|a| factor[a * dim + a].ln()).sum::<f64>(),
            Some(_) => {
                let diagonal = |m: &[f64]| (0..rank).map(|a| m[a * rank + a].ln()).sum::<f64>();
                let logs = diagonal(&best.matrix) + diagonal(&self.lower);
                log_unit_ball(rank) - logs - rank as f64 * scale.ln()
            }
        };
        if trace.stop == Stop::Converged && gap > options.epsilon.max(4.0 * ROUNDING * rank as f64)
        {
            trace.stop = Stop::Rounding;
        }
        let certificate = EllipsoidCertificate {
            items: shapes.items(),
            support: support.iter().map(|entry| entry.0 as u64).collect(),
            multipliers,
            directions: support.into_iter().map(|entry| entry.1).collect(),
            left_out: vec![],
            gap,
            points_hash: shapes.hash(),
        };
        Ok(Solution { answer: answer(&factor, center, log_volume, hull)?, certificate, trace })
    }

    /// A direction of the base in the space of the items: P′a, of length 1 in its largest coordinate.
    fn direction(&self, a: &[f64]) -> Vec<f64> {
        let dim = self.center.dim();
        let mut direction = vec![0.0; dim];
        for (&a, row) in a.iter().zip(self.matrix.chunks_exact(dim)) {
            add_scaled(&mut direction, a, row);
        }
        let largest = direction.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        if largest > 0.0 {
            direction.iter_mut().for_each(|v| *v /= largest);
        }
        direction
    }

    /// The hull with the largest distance of any item from it.
    fn hull(&self, shapes: &Shapes, center: &Center) -> Option<Hull> {
        let directions = self.directions.as_ref()?;
        let dim = shapes.dim();
        let basis: Vec<Vec<f64>> = directions.chunks_exact(dim).map(<[f64]>::to_vec).collect();
        Some(Hull { distance: distance(shapes, center, &basis), basis })
    }
}

impl Touches {
    /// The directions of the points with a multiplier, by item.
    fn seeds(&self, pool: &Pool, items: usize) -> Vec<Vec<&[f64]>> {
        let mut seeds = vec![vec![]; items];
        let weighted = pool.ids().iter().zip(pool.weights()).filter(|(_, u)| **u > 0.0);
        for touch in weighted.map(|(&id, _)| &self.list[id as usize]) {
            seeds[touch.item].push(&touch.direction[..]);
        }
        seeds
    }

    /// The points with a multiplier.
    fn support(&self, pool: &Pool) -> Vec<(Touch, f64)> {
        let weighted = pool.ids().iter().zip(pool.weights()).filter(|(_, u)| **u > 0.0);
        weighted.map(|(&id, &u)| (self.list[id as usize].clone(), u)).collect()
    }
}

/// The largest |y|² of an ellipsoid given by its matrix and centre.
fn square(shape: &[f64], center: &[f64]) -> f64 {
    let rank = center.len();
    let (lambda, vectors) = eigen(&mut shape.to_vec(), rank);
    let h: Vec<f64> = vectors.chunks_exact(rank.max(1)).map(|v| dot(v, center)).collect();
    farthest(&lambda, &h).square
}

/// Squares of half axes, and their directions as rows.
struct Axes {
    squares: Vec<f64>,
    directions: Vec<f64>,
}

impl Axes {
    /// The longest half axis, rounded up.
    fn longest(&self) -> f64 {
        self.squares.iter().copied().fold(0.0, f64::max).sqrt() * (1.0 + 1e-12)
    }
}

fn axes(framed: &Framed) -> Vec<Axes> {
    let axes = |i: usize| {
        let (squares, directions) = eigen(&mut framed.shape(i).to_vec(), framed.rank);
        Axes { squares, directions }
    };
    (0..framed.len()).into_par_iter().with_min_len(32).map(axes).collect()
}

/// Equal weights on ends of axes that lie far out, on an affine basis, and on what is extreme in a sample.
fn first_pool(framed: &Framed, axes: Vec<Axes>) -> (Pool, Touches) {
    let rank = framed.rank;
    let mut list = vec![];
    let mut points = vec![];
    for (i, axes) in axes.into_iter().enumerate() {
        let before = list.len();
        for (&square, v) in axes.squares.iter().zip(axes.directions.chunks_exact(rank)) {
            // An axis that rounding may have made is none.
            if square > 1e-14 {
                list.push(Touch { item: i, direction: v.to_vec() });
                list.push(Touch { item: i, direction: v.iter().map(|v| -v).collect() });
            }
        }
        if list.len() == before {
            list.push(Touch { item: i, direction: vec![0.0; rank] });
        }
        points.extend(list[before..].iter().map(|t| framed.touching(t.item, &t.direction)));
    }
    let mut order: Vec<usize> = (0..points.len()).collect();
    let leverages: Vec<f64> = points.iter().map(|y| dot(y, y)).collect();
    order.sort_by(|&a, &b| leverages[b].total_cmp(&leverages[a]));
    let size = FIRST * (rank + 1) * (rank + 2) / 2;
    let mut chosen: Vec<usize> = order.iter().take(size).copied().collect();
    let step = framed.len().div_ceil(SAMPLE);
    let mut sample = Sample { origin: vec![0.0; rank], pool: Pool::new(rank) };
    for (at, touch) in list.iter().enumerate() {
        if touch.item.is_multiple_of(step) {
            sample.pool.push(at as u64, &points[at], 1.0);
        }
    }
    let spread = sample.spread(sample.pool.blocks());
    chosen.extend(spread.into_iter().map(|i| sample.pool.ids()[i] as usize));
    let mut pool = Pool::new(rank);
    for at in chosen {
        pool.push(at as u64, &points[at], 1.0);
    }
    pool.normalise();
    (pool, Touches { list })
}

/// Asks every item for its farthest point from the centre in the metric of M.
fn pass(
    framed: &Framed,
    widths: &[f64],
    matrix: &[f64],
    center: &[f64],
    seeds: &[Vec<&[f64]>],
) -> Found {
    let rank = framed.rank;
    let stretch = stretch(matrix, rank);
    let border = rank as f64;
    let each: Vec<(f64, Vec<(f64, Touch)>)> = (0..framed.len())
        .into_par_iter()
        .with_min_len(32)
        .map(|i| item(framed, i, matrix, center, stretch * widths[i], border, &seeds[i]))
        .collect();
    let mut found = Found { largest: border, squares: vec![], outside: vec![] };
    for (square, touches) in each {
        found.largest = if square.is_nan() { f64::INFINITY } else { found.largest.max(square) };
        found.squares.push(square);
        found.outside.extend(touches);
    }
    found.outside.sort_by(|a, b| b.0.total_cmp(&a.0));
    found
}

/// The largest |Mv| over |v| ≤ 1, rounded up.
fn stretch(matrix: &[f64], rank: usize) -> f64 {
    let mut product = vec![0.0; rank * rank];
    for a in 0..rank {
        for b in 0..rank {
            product[a * rank + b] =
                dot(&matrix[a * rank..(a + 1) * rank], &matrix[b * rank..(b + 1) * rank]);
        }
    }
    let (lambda, _) = eigen(&mut product, rank);
    lambda.into_iter().fold(0.0, f64::max).sqrt() * (1.0 + 1e-12)
}

/// |y|² of the farthest point of one item, or a bound below the border; and its points outside.
fn item(
    framed: &Framed,
    i: usize,
    matrix: &[f64],
    center: &[f64],
    width: f64,
    border: f64,
    seeds: &[&[f64]],
) -> (f64, Vec<(f64, Touch)>) {
    let rank = framed.rank;
    let offset: Vec<f64> = framed.center(i).iter().zip(center).map(|(m, c)| m - c).collect();
    let image: Vec<f64> =
        (0..rank).map(|a| dot(&matrix[a * rank..a * rank + a + 1], &offset[..=a])).collect();
    let simply = (dot(&image, &image).sqrt() + width).powi(2);
    if simply < border * (1.0 - 1e-3) {
        return (simply, vec![]);
    }
    let mut shape = vec![0.0; rank * rank];
    let mut product = vec![0.0; rank];
    for a in 0..rank {
        product.fill(0.0);
        for (b, row) in framed.shape(i).chunks_exact(rank).enumerate().take(a + 1) {
            add_scaled(&mut product, matrix[a * rank + b], row);
        }
        for b in 0..=a {
            let value = dot(&matrix[b * rank..b * rank + b + 1], &product[..=b]);
            shape[a * rank + b] = value;
            shape[b * rank + a] = value;
        }
    }
    let (lambda, vectors) = eigen(&mut shape, rank);
    let h: Vec<f64> = vectors.chunks_exact(rank).map(|v| dot(v, &image)).collect();
    let best = farthest(&lambda, &h);
    let mut touches = vec![];
    let beyond = border * (1.0 + 1e-14);
    if best.square > beyond {
        let worth = border + WORTH * (best.square - border);
        let seeds: Vec<Vec<f64>> =
            seeds.iter().map(|a| seed(framed.shape(i), matrix, &lambda, &vectors, a)).collect();
        alternatives(&lambda, &h, &best, &seeds, |square, beta| {
            if square >= worth {
                touches.push((
                    square,
                    Touch { item: i, direction: direction(matrix, &vectors, beta) },
                ));
            }
        });
    }
    (best.square, touches)
}

/// A point that touched in the direction a, by z along the axes of its item, up to length: Λ^−½V′MSa.
fn seed(shape: &[f64], matrix: &[f64], lambda: &[f64], vectors: &[f64], a: &[f64]) -> Vec<f64> {
    let rank = a.len();
    let v: Vec<f64> = shape.chunks_exact(rank).map(|row| dot(row, a)).collect();
    let image: Vec<f64> = matrix.chunks_exact(rank).map(|row| dot(row, &v)).collect();
    let z = |(axis, &l): (&[f64], &f64)| if l > 0.0 { dot(axis, &image) / l.sqrt() } else { 0.0 };
    vectors.chunks_exact(rank).zip(lambda).map(z).collect()
}

/// M′Vβ, of length 1.
fn direction(matrix: &[f64], vectors: &[f64], beta: &[f64]) -> Vec<f64> {
    let rank = beta.len();
    let mut b = vec![0.0; rank];
    for (&beta, v) in beta.iter().zip(vectors.chunks_exact(rank)) {
        add_scaled(&mut b, beta, v);
    }
    let mut direction = vec![0.0; rank];
    for (&b, row) in b.iter().zip(matrix.chunks_exact(rank)) {
        add_scaled(&mut direction, b, row);
    }
    let norm = dot(&direction, &direction).sqrt();
    if norm > 0.0 {
        direction.iter_mut().for_each(|v| *v /= norm);
    }
    direction
}

/// Points with no multiplier, well inside, leave the pool.
fn drop_useless(pool: &mut Pool, whitener: &Whitener) {
    let dim = pool.dim() as f64;
    let leverages = whitener.apply(pool).leverages;
    let weights = pool.weights().to_vec();
    pool.retain(|i| weights[i] > 0.0 || leverages[i] > USEFUL * dim);
}

/// Items that lie in an affine subspace, which `found` knows.
fn in_flat(
    shapes: &Shapes,
    found: &Solution<Ellipsoid>,
    generators: &OwnedPoints<f64>,
    options: &EllipsoidOptions,
    monitor: &Monitor<'_>,
) -> Result<Solution<Ellipsoid>, Error> {
    let answer = &found.answer;
    let rank = answer.rank();
    let center = Center { high: answer.center.clone(), low: answer.center_tail.clone() };
    let basis = answer.hull.as_ref().map_or(vec![], |hull| hull.basis.concat());
    if rank == 0 {
        return Ok(single(shapes, found));
    }
    let map = Map { matrix: &basis, center: &center };
    let points = generators.view();
    let images = points.rows().flat_map(|row| map.point(row)).collect();
    let projected = OwnedPoints::new(images, rank).expect("whole rows, one at least");
    let silent = Monitor::silent();
    let survey = Survey::new(&projected, &silent)?;
    let sample = Sample::new(&survey)?;
    let (whitener, how) = sample.whitener(&sample.extents());
    if how == Rebased::Never {
        return Err(Error::Overflow);
    }
    let origin = center_of(&sample.origin, &whitener);
    let mut matrix = vec![0.0; rank * shapes.dim()];
    for (row, m) in matrix.chunks_exact_mut(shapes.dim()).zip(whitener.matrix().chunks_exact(rank))
    {
        for (&m, direction) in m.iter().zip(basis.chunks_exact(shapes.dim())) {
            add_scaled(row, m, direction);
        }
    }
    let mut lifted = lifted(&center.high, &basis, &origin);
    lifted.low.iter_mut().zip(&center.low).for_each(|(low, tail)| *low += tail);
    let base = Base {
        center: lifted,
        matrix,
        lower: whitener.matrix().to_vec(),
        directions: Some(basis),
        rank,
    };
    base.solve(shapes, options, monitor)
}

/// Items that are all one point.
fn single(shapes: &Shapes, found: &Solution<Ellipsoid>) -> Solution<Ellipsoid> {
    let answer = found.answer.clone();
    let certificate = EllipsoidCertificate {
        items: shapes.items(),
        directions: vec![vec![0.0; shapes.dim()]],
        points_hash: shapes.hash(),
        ..found.certificate.clone()
    };
    let trace = Trace { passes: 1, ..found.trace.clone() };
    Solution { answer, certificate, trace }
}

/// How far items lie from a hull at most, rounded up.
fn distance(shapes: &Shapes, center: &Center, basis: &[Vec<f64>]) -> f64 {
    let dim = shapes.dim();
    let off = |x: &mut [f64]| {
        for row in basis {
            let product = dot(x, row);
            add_scaled(x, -product, row);
        }
    };
    let mut distance = 0.0f64;
    let mut reach = 0.0f64;
    for i in 0..shapes.len() {
        let tail = |j: usize| center.low.get(j).copied().unwrap_or(0.0);
        let parts = shapes.center(i).iter().zip(&center.high).enumerate();
        let mut x: Vec<f64> = parts.map(|(j, (m, c))| (m - c) - tail(j)).collect();
        reach = x.iter().fold(reach, |most, v| most.max(v.abs()));
        off(&mut x);
        // (I − B′B)S(I − B′B), of which the trace is the square of how far the item reaches off its own centre.
        let mut rows: Vec<Vec<f64>> =
            (0..dim).map(|j| (0..dim).map(|k| shapes.entry(i, j, k).high).collect()).collect();
        rows.iter_mut().for_each(|row| off(row));
        let column = |j: usize| {
            let mut column: Vec<f64> = rows.iter().map(|row| row[j]).collect();
            off(&mut column);
            column[j]
        };
        let trace: f64 = (0..dim).map(column).sum();
        distance = distance.max(dot(&x, &x).sqrt() + trace.max(0.0).sqrt());
    }
    let rounding = 4.0 * f64::EPSILON * (dim as f64).sqrt() * (dim + basis.len()) as f64;
    distance * (1.0 + 1e-12) + rounding * reach
}
