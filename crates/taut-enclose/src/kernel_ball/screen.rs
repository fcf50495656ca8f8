//! A pass over all points for those outside a ball of the feature space.
//!
//! *Problem.* Of all points x, which have |φ(x) − c|² = Σ λᵢρ(x, xᵢ) − D above a level?
//! *Idea, Gaussian.* For a group G of the support with weight Λ = Σ λᵢ, mean m = Σ λᵢxᵢ/Λ and variance v = Σ λᵢ|xᵢ − m|²/Λ, Jensen's
//! inequality for the convex function e^{−γs} gives Σ λᵢρ(x, xᵢ) ≤ 2Λ(1 − exp(−γ(|x − m|² + v))). With one group that is a bound on
//! |x − m|², so that one distance and a comparison prove most points to be inside. Those left over are tried with the groups
//! of a tree over the support, 8 and then as many as have 16 to 32 points each. Then, from the nearest group on, the bound of a group gives way
//! to the sum of its terms, until the point is inside; only of points outside are all terms summed up. Where a kernel is narrow, few
//! groups are near a point. What a pass finds is kept for the next ones ([`distance_bounds`](super::distance_bounds)).
//! *Idea, linear.* |φ(x) − c|² = |x − m|²: one group is exact.
//! *Guarantee.* No point above the level is passed over but by rounding, which the checker allows for.

use std::sync::{Mutex, PoisonError};

use taut_certify::Kernel;
use taut_kernels::{Center as Mean, squared_distances};
use taut_points::{Monitor, OrderBy, PointSource, Rows, map_blocks};

use super::cluster::Cluster;
use super::decay::decay_all;
use super::distance_bounds::DistanceBounds;
use super::features::Features;
use crate::Error;
use crate::top::{Far, Top};

/// Members of a group of the finest level, at least.
const MEMBERS_MIN: usize = 16;
/// Groups of the level before the finest, where that has more.
const MIDDLE_GROUPS: usize = 8;

/// Groups of a rough center.
const ROUGH_GROUPS: usize = 8;

/// A row is left when its bound B of Σ λᵢρ is so far below the level L that B ≤ L − `MARGIN`·L(1 − L/2), so that the next pass, with a center
/// that has moved a little, need not look at it. Of 20,000 points with a support of 2,363 the last passes then take a half and a tenth of
/// the time; with twice the margin the earlier ones lose as much.
const MARGIN: f64 = 0.05;

/// Up to so many times the variance a mean has its squared distance from the origin without a second term for what rounding takes.
const NEAR_ORIGIN: f64 = 64.0;

/// A group of the support: its weight, mean and variance.
struct Group {
    weight: f64,
    mean: Mean,
    /// v.
    variance: f64,
    /// Its points, as places of the support.
    members: Vec<usize>,
}

/// A center in the feature space.
pub(super) struct Center {
    kernel: Kernel,
    dim: usize,
    support: Features,
    lambda: Vec<f64>,
    /// D.
    pub(super) spread: f64,
    /// Coarse to fine.
    levels: Vec<Vec<Group>>,
    /// A point of the support, from which the coordinates of the next two are counted.
    origin: Vec<f64>,
    /// The means of the finest groups, and their members group by group.
    means: Cluster,
    members: Cluster,
    /// Where the members of each of these groups begin, and where the last end.
    starts: Vec<usize>,
}

/// What a pass found.
pub(super) struct Found {
    /// The points above the level, farthest first, as many as were asked for.
    pub(super) far: Vec<Far>,
    /// The sum over them of the squared distance less the level.
    pub(super) excess: f64,
    /// No squared distance is larger.
    pub(super) largest: f64,
    /// The largest K(x, x), for kernels that are no function of a distance; else 0.
    pub(super) own: f64,
}

impl Center {
    pub(super) fn new(
        kernel: Kernel,
        dim: usize,
        support: Features,
        lambda: Vec<f64>,
        spread: f64,
    ) -> Self {
        let mut center = Center::bare(kernel, dim, support, lambda, spread);
        let places: Vec<usize> = (0..center.lambda.len()).collect();
        match kernel {
            Kernel::Gaussian { .. } => {
                let finest = (places.len() / MEMBERS_MIN + 1).next_power_of_two() / 2;
                let mut numbers = vec![1];
                numbers.extend([MIDDLE_GROUPS].iter().filter(|&&number| number < finest));
                numbers.extend(Some(finest).filter(|&number| number > 1));
                for count in numbers {
                    let mut groups = vec![];
                    center.split(places.clone(), count, &mut groups);
                    center.levels.push(groups);
                }
                center.lay_out();
            }
            Kernel::Linear => center.levels.push(vec![center.group(&places)]),
            _ => {}
        }
        center
    }

    /// A center of a few points near the mean of a sample: the means of its groups, without D. Where means are no points of the
    /// feature space, it is the sample itself.
    pub(super) fn rough(kernel: Kernel, dim: usize, sample: Features) -> Self {
        let count = sample.len();
        let center = Center::bare(kernel, dim, sample, vec![1.0 / count as f64; count], 0.0);
        let number = match kernel {
            Kernel::Gaussian { .. } => ROUGH_GROUPS,
            Kernel::Linear => 1,
            _ => return center,
        };
        let mut groups = vec![];
        center.split((0..count).collect(), number, &mut groups);
        let rows = groups.iter().flat_map(|group| group.mean.high.clone()).collect();
        let support = Features { ids: vec![0; groups.len()], rows, ..Features::default() };
        let lambda = groups.iter().map(|group| group.weight).collect();
        Center::bare(kernel, dim, support, lambda, 0.0)
    }

    fn bare(kernel: Kernel, dim: usize, support: Features, lambda: Vec<f64>, spread: f64) -> Self {
        let [means, members] = [(); 2].map(|()| Cluster::new(dim));
        let (levels, starts, origin) = (vec![], vec![], vec![]);
        Center { kernel, dim, support, lambda, spread, levels, origin, means, members, starts }
    }

    /// Puts the coordinates of the finest groups where passes want them.
    fn lay_out(&mut self) {
        let Some(finest) = self.levels.last() else { return };
        self.origin = self.support.row(0, self.dim).to_vec();
        let from_origin = |high: &[f64], low: &[f64]| -> Vec<f64> {
            let low = low.iter().copied().chain(std::iter::repeat(0.0));
            high.iter().zip(&self.origin).zip(low).map(|((x, o), low)| x - o + low).collect()
        };
        let means = finest.iter().map(|group| {
            (from_origin(&group.mean.high, &group.mean.low), group.weight, group.variance)
        });
        self.means.extend(means);
        self.starts.push(0);
        for group in finest {
            let point =
                |&i: &usize| (from_origin(self.support.row(i, self.dim), &[]), self.lambda[i], 0.0);
            self.members.extend(group.members.iter().map(point));
            self.starts.push(self.members.len());
        }
    }

    /// The group of some places, of which there is at least one.
    fn group(&self, places: &[usize]) -> Group {
        let weight: f64 = places.iter().map(|&i| self.lambda[i]).sum();
        // From one of the points, so that what rounding takes is small beside the distances, and not only beside the coordinates.
        let origin = self.support.row(places[0], self.dim);
        let mut mean = vec![0.0; self.dim];
        for &i in places {
            let row = self.support.row(i, self.dim).iter().zip(origin);
            mean.iter_mut()
                .zip(row)
                .for_each(|(m, (x, o))| *m += self.lambda[i] / weight * (x - o));
        }
        let squared = |i: usize| {
            let row = self.support.row(i, self.dim).iter().zip(origin);
            row.zip(&mean).map(|((x, o), m)| (x - o - m) * (x - o - m)).sum::<f64>()
        };
        let variance = places.iter().map(|&i| self.lambda[i] / weight * squared(i)).sum();
        let high: Vec<f64> = origin.iter().zip(&mean).map(|(o, m)| o + m).collect();
        let is_near = high.iter().map(|m| m * m).sum::<f64>() <= NEAR_ORIGIN * variance;
        let low = match is_near {
            true => vec![],
            false => high
                .iter()
                .zip(origin)
                .zip(&mean)
                .map(|((h, o), m)| sum_error(*o, *m, *h))
                .collect(),
        };
        Group { weight, mean: Mean { high, low }, variance, members: places.to_vec() }
    }

    /// Splits a group at the median of its widest coordinate, until there are `count`.
    fn split(&self, mut places: Vec<usize>, count: usize, groups: &mut Vec<Group>) {
        if count == 1 || places.len() < 2 {
            groups.push(self.group(&places));
            return;
        }
        let value = |i: usize, column: usize| self.support.row(i, self.dim)[column];
        let extent = |column: usize| {
            let values = || places.iter().map(|&i| value(i, column));
            values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
        };
        let extents: Vec<f64> = (0..self.dim).map(extent).collect();
        let widest =
            (0..self.dim).fold(0, |best, j| if extents[j] > extents[best] { j } else { best });
        places.order_by(&|&i, &j| value(i, widest).total_cmp(&value(j, widest)).then(i.cmp(&j)));
        let rest = places.split_off(places.len() / 2);
        self.split(places, count / 2, groups);
        self.split(rest, count / 2, groups);
    }

    /// Reads all rows for those whose squared distance is above `level`; lists at most `keep` of them. Rows that `bounds` proves to be
    /// inside are not looked at, and what is found of the others is put there.
    pub(super) fn pass(
        &self,
        source: &dyn PointSource,
        level: f64,
        keep: usize,
        bounds: Option<&mut DistanceBounds>,
        monitor: &Monitor<'_>,
    ) -> Result<Found, Error> {
        let before = bounds.as_deref();
        let blocks = map_blocks(source, monitor, |first, rows| {
            let squares = match before {
                Some(bounds) => bounds.squares(first, rows.len()),
                None => vec![f64::INFINITY; rows.len()],
            };
            let mut block =
                Block { first, squares, largest: 0.0, top: Top::new(keep), excess: 0.0, own: 0.0 };
            self.look(&rows, level, &mut block)?;
            block.largest = block.squares.iter().fold(0.0, |most: f64, &square| most.max(square));
            // Files may have more rows than numbers fit in memory.
            let kept = |bounds: &DistanceBounds| {
                block.squares.iter().map(|&square| bounds.kept(square)).collect()
            };
            block.squares = before.map_or_else(Vec::new, kept);
            Ok::<_, Error>(block)
        })?;
        let mut found = Found { far: vec![], excess: 0.0, largest: 0.0, own: 0.0 };
        let (mut top, mut kept) = (Top::new(keep), vec![]);
        for block in blocks {
            found.excess += block.excess;
            found.largest = found.largest.max(block.largest);
            found.own = found.own.max(block.own);
            top.merge(block.top);
            kept.push(block.squares);
        }
        found.far = top.into_sorted();
        if let Some(bounds) = bounds {
            bounds.replace(&kept);
        }
        Ok(found)
    }

    /// The `keep` rows that are farthest, by all terms of all rows: for a center of a few points.
    pub(super) fn farthest(
        &self,
        source: &dyn PointSource,
        keep: usize,
        monitor: &Monitor<'_>,
    ) -> Result<Vec<u64>, Error> {
        // Each list takes its turn: lists of all blocks would be more than the points of a large file.
        let all = Mutex::new(Top::new(keep));
        map_blocks(source, monitor, |first, rows| {
            let (mut sums, mut terms) = (vec![0.0; rows.len()], vec![0.0; rows.len()]);
            let features = match self.kernel {
                Kernel::Gaussian { .. } | Kernel::Linear => Features::default(),
                kernel => Features::block(kernel, first, &rows, self.dim),
            };
            for (i, lambda) in self.lambda.iter().enumerate() {
                if features.len() > 0 {
                    features.distances_from(self.kernel, &self.support, i, self.dim, &mut terms);
                } else {
                    let high = self.support.row(i, self.dim).to_vec();
                    self.squares(&rows, &Mean { high, low: vec![] }, &mut terms);
                    if let Kernel::Gaussian { gamma } = self.kernel {
                        decay_all(gamma, &mut terms);
                    }
                }
                sums.iter_mut().zip(&terms).for_each(|(sum, rho)| *sum += lambda * rho);
            }
            let mut top = Top::new(keep);
            for (id, &reach2) in (first..).zip(&sums) {
                if !reach2.is_finite() {
                    return Err(Error::Overflow);
                }
                top.offer(Far { id, reach2 });
            }
            all.lock().unwrap_or_else(PoisonError::into_inner).merge(top);
            Ok::<_, Error>(())
        })?;
        let all = all.into_inner().unwrap_or_else(PoisonError::into_inner);
        Ok(all.into_sorted().into_iter().map(|far| far.id).collect())
    }

    /// |x − m|² of all rows x.
    fn squares(&self, rows: &Rows<'_>, mean: &Mean, out: &mut [f64]) {
        match rows {
            Rows::F32(points) => squared_distances(points.values(), self.dim, mean, out),
            Rows::F64(points) => squared_distances(points.values(), self.dim, mean, out),
        }
    }

    fn look(&self, rows: &Rows<'_>, level: f64, block: &mut Block) -> Result<(), Error> {
        let mean_level = level + self.spread;
        let mut left = self.open_rows(rows, level, block)?;
        match self.levels.split_last() {
            Some((finest, coarser)) if !coarser.is_empty() => {
                for groups in &coarser[1..] {
                    self.screen(groups, mean_level, &mut left, block);
                }
                self.refine(finest, mean_level, &left, block)
            }
            _ => self.measure(&left, level, block),
        }
    }

    /// The rows that neither their bound so far nor one distance proves to be inside.
    fn open_rows(&self, rows: &Rows<'_>, level: f64, block: &mut Block) -> Result<Features, Error> {
        let mut left = Features::default();
        // Not so for what is no number.
        let is_inside = |square: f64| square <= level;
        let open = block.squares.iter().filter(|&&square| !is_inside(square)).count();
        let coarsest = self.levels.first().and_then(|groups| groups.first());
        // For a few rows the copy is cheaper than the distances of all.
        if let Some(group) = coarsest
            && 4 * open > rows.len()
        {
            let mut squares = vec![0.0; rows.len()];
            self.squares(rows, &group.mean, &mut squares);
            if squares.iter().any(|square| !square.is_finite()) {
                return Err(Error::Overflow);
            }
            if let Kernel::Gaussian { gamma } = self.kernel {
                squares.iter_mut().for_each(|s| *s += group.variance);
                decay_all(gamma, &mut squares);
                squares.iter_mut().for_each(|s| *s -= self.spread);
            }
            for (bound, square) in block.squares.iter_mut().zip(squares) {
                *bound = if square < *bound { square } else { *bound };
            }
        }
        for k in (0..rows.len()).filter(|&k| !is_inside(block.squares[k])) {
            let start = left.rows.len();
            left.rows.resize(start + self.dim, 0.0);
            rows.copy_row(k, &mut left.rows[start..]);
            left.ids.push(block.first + k as u64);
        }
        left.complete(self.kernel, self.dim);
        block.own = left.own_largest();
        Ok(left)
    }

    /// Drops rows that the bound of the groups proves to be at most at the level.
    fn screen(&self, groups: &[Group], mean_level: f64, left: &mut Features, block: &mut Block) {
        let Kernel::Gaussian { gamma } = self.kernel else { return };
        let mut sums = vec![0.0; left.len()];
        let mut distances = vec![0.0; left.len()];
        for group in groups {
            squared_distances(&left.rows, self.dim, &group.mean, &mut distances);
            distances.iter_mut().for_each(|s| *s += group.variance);
            decay_all(gamma, &mut distances);
            sums.iter_mut().zip(&distances).for_each(|(sum, rho)| *sum += group.weight * rho);
        }
        for (&id, sum) in left.ids.iter().zip(&sums) {
            block.bound(id, sum - self.spread);
        }
        let stays: Vec<usize> =
            (0..left.len()).filter(|&k| sums[k] > mean_level || sums[k].is_nan()).collect();
        *left = left.subset(&stays, self.dim);
    }

    /// Puts sums in the place of the bounds of groups, the nearest first, until a row is known to be inside, or all are summed up.
    fn refine(
        &self,
        groups: &[Group],
        mean_level: f64,
        left: &Features,
        block: &mut Block,
    ) -> Result<(), Error> {
        let Kernel::Gaussian { gamma } = self.kernel else { return Ok(()) };
        let (means, members) = (&self.means, &self.members);
        let mut near = vec![0.0; means.len()];
        let enough = mean_level - MARGIN * mean_level * (1.0 - mean_level / 2.0).max(0.0);
        let mut row = vec![0.0; self.dim];
        for (&id, given) in left.ids.iter().zip(left.rows.chunks_exact(self.dim)) {
            for ((x, given), o) in row.iter_mut().zip(given).zip(&self.origin) {
                *x = given - o;
            }
            means.terms(gamma, &row, &mut near);
            let mut sum: f64 = near.iter().zip(means.weights()).map(|(rho, w)| w * rho).sum();
            near[groups.len()..].fill(f64::INFINITY);
            for _ in groups {
                if sum <= enough {
                    break;
                }
                // A few groups decide about most rows: an order of all costs more.
                let nearest = least(&near);
                let places = self.starts[nearest]..self.starts[nearest + 1];
                let exact = members.sum(gamma, &row, places.start, places.end);
                sum += exact - groups[nearest].weight * near[nearest];
                near[nearest] = f64::INFINITY;
            }
            block.offer(id, sum - self.spread, mean_level - self.spread)?;
        }
        Ok(())
    }

    /// Finds the squared distances of the rows that are left, term by term.
    fn measure(&self, left: &Features, level: f64, block: &mut Block) -> Result<(), Error> {
        if left.len() == 0 {
            return Ok(());
        }
        let mut sums = vec![0.0; left.len()];
        let mut distances = vec![0.0; left.len()];
        if self.kernel == Kernel::Linear {
            let group = &self.levels[0][0];
            squared_distances(&left.rows, self.dim, &group.mean, &mut sums);
        } else {
            for (i, lambda) in self.lambda.iter().enumerate() {
                left.distances_from(self.kernel, &self.support, i, self.dim, &mut distances);
                sums.iter_mut().zip(&distances).for_each(|(sum, rho)| *sum += lambda * rho);
            }
            sums.iter_mut().for_each(|sum| *sum -= self.spread);
        }
        left.ids.iter().zip(&sums).try_for_each(|(&id, &square)| block.offer(id, square, level))
    }
}

/// What rounding took from a + b when `sum` was made of them (Knuth).
fn sum_error(a: f64, b: f64, sum: f64) -> f64 {
    let part = sum - a;
    (a - (sum - part)) + (b - part)
}

/// The place of the least value, which is the first of equal ones. There are eights of values, none of them NaN.
fn least(values: &[f64]) -> usize {
    let mut lanes = [f64::INFINITY; 8];
    for eight in values.chunks_exact(8) {
        for (lane, &value) in lanes.iter_mut().zip(eight) {
            *lane = if value < *lane { value } else { *lane };
        }
    }
    let least = lanes.iter().fold(f64::INFINITY, |least, &lane| least.min(lane));
    let has_least = |eight: &[f64]| eight.iter().fold(false, |has, &value| has | (value == least));
    let first = values.chunks_exact(8).position(has_least).unwrap_or(0) * 8;
    first + values[first..].iter().position(|&value| value == least).unwrap_or(0)
}

/// What a pass finds in a block of rows.
struct Block {
    first: u64,
    /// No squared distance is larger, row by row.
    squares: Vec<f64>,
    /// The largest of these.
    largest: f64,
    top: Top,
    excess: f64,
    own: f64,
}

impl Block {
    /// Takes a bound of the squared distance of a row.
    fn bound(&mut self, id: u64, square: f64) {
        let bound = &mut self.squares[(id - self.first) as usize];
        *bound = bound.min(square);
    }

    /// Takes a row with its squared distance, or a bound of it that is not above the level.
    fn offer(&mut self, id: u64, square: f64, level: f64) -> Result<(), Error> {
        if !square.is_finite() {
            return Err(Error::Overflow);
        }
        if square > level {
            self.squares[(id - self.first) as usize] = square;
            self.excess += square - level;
            self.top.offer(Far { id, reach2: square });
        } else {
            self.bound(id, square);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use taut_points::{Distribution, Points, generate};

    use super::super::distance_bounds::PreviousMultipliers;
    use super::super::pairs::Pairs;
    use super::*;

    /// Rounds of a search over 3,000 points: each pass is compared with one without bounds, and with all distances.
    #[test]
    fn passes_with_bounds_find_what_all_distances_show() {
        let (n, dim) = (3000u64, 4);
        let mut values: Vec<f64> = generate(Distribution::Normal, n as usize, dim, 9).unwrap();
        values.chunks_mut(dim).for_each(|row| row[0] += 1e5);
        let points = Points::new(&values, dim).unwrap();
        let silent = Monitor::silent();
        for kernel in
            [Kernel::Gaussian { gamma: 0.02 }, Kernel::Gaussian { gamma: 2.0 }, Kernel::Linear]
        {
            let read = |ids: Vec<u64>| Features::read(kernel, &points, ids).unwrap();
            let all = read((0..n).collect());
            let mut lambda = vec![0.0; 400];
            lambda[0] = 1.0;
            let mut pairs = Pairs::new(kernel, dim, read((0..400).collect()), lambda, 1.0);
            let mut bounds = DistanceBounds::new(n).unwrap();
            for (round, tolerance) in [0.3, 1e-2, 1e-4, 1e-6].into_iter().enumerate() {
                let before = PreviousMultipliers::of(&pairs);
                pairs.maximize(tolerance, false, &silent).unwrap();
                bounds.move_center(before.displacement(&pairs));
                let places = pairs.support();
                let lambda: Vec<f64> = places.iter().map(|&i| pairs.lambda[i]).collect();
                let support = pairs.features.subset(&places, dim);
                let mut squares = vec![-pairs.spread(); n as usize];
                let mut column = squares.clone();
                for (i, lambda) in lambda.iter().enumerate() {
                    all.distances_from(kernel, &support, i, dim, &mut column);
                    squares.iter_mut().zip(&column).for_each(|(sum, rho)| *sum += lambda * rho);
                }
                let center = Center::new(kernel, dim, support, lambda, pairs.spread());
                // The level of a hard ball, and lower ones, as soft balls have them.
                let level = pairs.spread() * [1.0, 0.7, 1.0, 0.9][round];
                let with = center.pass(&points, level, 10_000, Some(&mut bounds), &silent).unwrap();
                let without = center.pass(&points, level, 10_000, None, &silent).unwrap();
                // Rows so near to the level that rounding decides are anywhere.
                let room = 1e-9 * pairs.spread();
                for found in [&with, &without] {
                    let mut ids: Vec<u64> = found.far.iter().map(|far| far.id).collect();
                    ids.sort_unstable();
                    let is_found = |id: u64| ids.binary_search(&id).is_ok();
                    for (id, &square) in (0..).zip(&squares) {
                        let is_near = (square - level).abs() <= room;
                        assert!(is_near || is_found(id) == (square > level), "{kernel:?} {id}");
                    }
                    let excess: f64 = squares.iter().map(|s| (s - level).max(0.0)).sum();
                    assert!((found.excess - excess).abs() <= 1e-8 * (excess + level), "{kernel:?}");
                    let largest = squares.iter().copied().fold(0.0, f64::max);
                    assert!(found.largest >= largest - room, "{kernel:?}");
                    assert!(found.largest <= largest.max(level) + room, "{kernel:?}");
                }
                let known: Vec<u64> = pairs.features.ids.clone();
                let new = with.far.iter().map(|far| far.id).filter(|id| !known.contains(id));
                pairs = pairs.replace(read(new.take(300).collect()), round % 2 == 1);
            }
        }
    }
}
