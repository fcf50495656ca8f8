//! A pass over all points for those outside a ball of the feature space.
//!
//! *Problem.* Of all points x, which have |φ(x) − c|² = Σ λᵢρ(x, xᵢ) − D above a level?
//! *Idea, Gaussian.* For a group G of the support with weight Λ = Σ λᵢ, mean m = Σ λᵢxᵢ/Λ and spread v = Σ λᵢ|xᵢ − m|²/Λ, Jensen's
//! inequality for the convex function e^{−γs} gives Σ λᵢρ(x, xᵢ) ≤ 2Λ(1 − exp(−γ(|x − m|² + v))). With one group that is a bound on
//! |x − m|², so that one distance and a comparison prove most points to be inside. Those left over are tried with the 8 and the 64
//! groups of a tree over the support. Then, from the nearest group on, the bound of a group gives way to the sum of its terms, until
//! the point is inside; only of points outside are all terms summed up. Where a kernel is narrow, few groups are near a point.
//! *Idea, linear.* |φ(x) − c|² = |x − m|²: one group is exact.
//! *Guarantee.* No point above the level is passed over but by rounding, which the checker allows for.

use taut_certify::Kernel;
use taut_points::{
    BlockHash, InputError, Monitor, PointSource, PointsHash, Rows, hash_block, map_blocks,
};

use super::decay::{decay, decay_all};
use super::features::Features;
use crate::Error;
use crate::kernel::{Center as Mean, squared_distances};
use crate::top::{Far, Top};

/// Numbers of groups: those that the support has at least four times as many points as.
const GROUPS: [usize; 3] = [1, 8, 64];

/// Groups of a rough center, at most.
const ROUGH_GROUPS: usize = 8;

/// A group of the support: its weight, mean and spread.
struct Group {
    weight: f64,
    mean: Mean,
    spread: f64,
    /// Its points and their multipliers, in groups of the finest level.
    members: Features,
    lambda: Vec<f64>,
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

/// What a first pass finds beside.
pub(super) struct First {
    pub(super) hash: PointsHash,
    /// Whether all points are the same.
    pub(super) is_one_point: bool,
}

/// Checks and hashes all rows.
pub(super) fn first_pass(source: &dyn PointSource, monitor: &Monitor<'_>) -> Result<First, Error> {
    monitor.pass(1, source.len());
    let dim = source.dim();
    let first = taut_points::gather(source, &[0])?;
    let blocks = map_blocks(source, monitor, |number, rows| {
        if let Some((row, column, value)) = rows.first_non_finite() {
            let row = number + row as u64;
            return Err(Error::Input(InputError::NonFinite { row, column, value }));
        }
        let mut row = vec![0.0; dim];
        let mut spread = 0.0f64;
        for k in 0..rows.len() {
            rows.copy_row(k, &mut row);
            spread = row.iter().zip(&first).fold(spread, |most, (x, y)| most.max((x - y).abs()));
        }
        Ok::<(BlockHash, f64), Error>((hash_block(&rows), spread))
    })?;
    let spread = blocks.iter().map(|block| block.1).fold(0.0, f64::max);
    // Two rows are at most twice as far apart as one is from the first.
    if !(4.0 * spread * spread * dim as f64).is_finite() {
        return Err(Error::Overflow);
    }
    let hash = PointsHash::of_blocks(source.len(), dim, blocks.iter().map(|block| block.0));
    Ok(First { hash, is_one_point: spread == 0.0 })
}

impl Center {
    pub(super) fn new(
        kernel: Kernel,
        dim: usize,
        support: Features,
        lambda: Vec<f64>,
        spread: f64,
    ) -> Self {
        let mut center = Center { kernel, dim, support, lambda, spread, levels: vec![] };
        let places: Vec<usize> = (0..center.lambda.len()).collect();
        match kernel {
            Kernel::Gaussian { .. } => {
                let is_worth = |&&count: &&usize| count == 1 || 4 * count <= places.len();
                for &count in GROUPS.iter().filter(is_worth) {
                    let mut groups = vec![];
                    center.split(places.clone(), count, &mut groups);
                    center.levels.push(groups);
                }
            }
            Kernel::Linear => center.levels.push(vec![center.group(&places)]),
            _ => {}
        }
        center
    }

    fn group(&self, places: &[usize]) -> Group {
        let weight: f64 = places.iter().map(|&i| self.lambda[i]).sum();
        let mut mean = vec![0.0; self.dim];
        for &i in places {
            let row = self.support.row(i, self.dim);
            mean.iter_mut().zip(row).for_each(|(m, x)| *m += self.lambda[i] / weight * x);
        }
        let squared = |i: usize| {
            let row = self.support.row(i, self.dim);
            row.iter().zip(&mean).map(|(x, m)| (x - m) * (x - m)).sum::<f64>()
        };
        let spread = places.iter().map(|&i| self.lambda[i] / weight * squared(i)).sum();
        let members = self.support.subset(places, self.dim);
        let lambda = places.iter().map(|&i| self.lambda[i]).collect();
        Group { weight, mean: Mean { high: mean, low: vec![] }, spread, members, lambda }
    }

    /// A center of a few points in the place of this one: the means of its groups, with their weights.
    pub(super) fn rough(&self) -> Self {
        let groups = self.levels.iter().rev().find(|groups| groups.len() <= ROUGH_GROUPS);
        let Some(groups) = groups.filter(|_| self.kernel != Kernel::Linear) else {
            return Center::new(
                self.kernel,
                self.dim,
                self.support.clone(),
                self.lambda.clone(),
                self.spread,
            );
        };
        let rows = groups.iter().flat_map(|group| group.mean.high.clone()).collect();
        let support = Features { ids: vec![0; groups.len()], rows, ..Features::default() };
        let lambda = groups.iter().map(|group| group.weight).collect();
        Center::new(self.kernel, self.dim, support, lambda, 0.0)
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
        places.sort_by(|&i, &j| value(i, widest).total_cmp(&value(j, widest)).then(i.cmp(&j)));
        let rest = places.split_off(places.len() / 2);
        self.split(places, count / 2, groups);
        self.split(rest, count / 2, groups);
    }

    /// Reads all rows for those whose squared distance is above `level`; lists at most `keep` of them.
    pub(super) fn pass(
        &self,
        source: &dyn PointSource,
        level: f64,
        keep: usize,
        monitor: &Monitor<'_>,
    ) -> Result<Found, Error> {
        let blocks = map_blocks(source, monitor, |first, rows| {
            let mut block = Block { top: Top::new(keep), excess: 0.0, largest: 0.0, own: 0.0 };
            self.look(first, &rows, level, &mut block)?;
            Ok::<_, Error>(block)
        })?;
        let mut all = Block { top: Top::new(keep), excess: 0.0, largest: 0.0, own: 0.0 };
        for block in blocks {
            all.top.merge(block.top);
            all.excess += block.excess;
            all.largest = all.largest.max(block.largest);
            all.own = all.own.max(block.own);
        }
        Ok(Found {
            far: all.top.into_sorted(),
            excess: all.excess,
            largest: all.largest,
            own: all.own,
        })
    }

    fn look(
        &self,
        first: u64,
        rows: &Rows<'_>,
        level: f64,
        block: &mut Block,
    ) -> Result<(), Error> {
        let mut left = Features::default();
        let mut distances = vec![0.0; rows.len()];
        let mean_level = level + self.spread;
        let copy = |k: usize, left: &mut Features| {
            let start = left.rows.len();
            left.rows.resize(start + self.dim, 0.0);
            rows.copy_row(k, &mut left.rows[start..]);
            left.ids.push(first + k as u64);
        };
        match self.levels.first().and_then(|groups| groups.first()) {
            None => (0..rows.len()).for_each(|k| copy(k, &mut left)),
            Some(group) => {
                match rows {
                    Rows::F32(points) => {
                        squared_distances(points.values(), self.dim, &group.mean, &mut distances)
                    }
                    Rows::F64(points) => {
                        squared_distances(points.values(), self.dim, &group.mean, &mut distances)
                    }
                }
                let limit = match self.kernel {
                    // 2(1 − exp(−γ(s + v))) ≤ level, solved for s.
                    Kernel::Gaussian { gamma } if mean_level < 2.0 => {
                        -(-mean_level / 2.0).ln_1p() / gamma - group.spread
                    }
                    Kernel::Gaussian { .. } => f64::INFINITY,
                    _ => level,
                };
                let mut inside = f64::NEG_INFINITY;
                for (k, &square) in distances.iter().enumerate() {
                    if square <= limit {
                        inside = if square > inside { square } else { inside };
                    } else {
                        copy(k, &mut left);
                    }
                    if !square.is_finite() {
                        return Err(Error::Overflow);
                    }
                }
                let bound = match self.kernel {
                    _ if inside < 0.0 => 0.0,
                    Kernel::Gaussian { gamma } => {
                        2.0 * decay(gamma * (inside + group.spread)) - self.spread
                    }
                    _ => inside,
                };
                block.largest = block.largest.max(bound);
            }
        }
        left.complete(self.kernel, self.dim);
        block.own = left.own_largest();
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

    /// Drops rows that the bound of the groups proves to be at most at the level.
    fn screen(&self, groups: &[Group], mean_level: f64, left: &mut Features, block: &mut Block) {
        let Kernel::Gaussian { gamma } = self.kernel else { return };
        let mut sums = vec![0.0; left.len()];
        let mut distances = vec![0.0; left.len()];
        for group in groups {
            squared_distances(&left.rows, self.dim, &group.mean, &mut distances);
            distances.iter_mut().for_each(|s| *s += group.spread);
            decay_all(gamma, &mut distances);
            sums.iter_mut().zip(&distances).for_each(|(sum, rho)| *sum += group.weight * rho);
        }
        let stays: Vec<usize> =
            (0..left.len()).filter(|&k| sums[k] > mean_level || sums[k].is_nan()).collect();
        let inside = sums.iter().filter(|&&sum| sum <= mean_level).fold(0.0, |a: f64, &b| a.max(b));
        block.largest = block.largest.max(inside - self.spread);
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
        let means: Vec<f64> = groups.iter().flat_map(|group| &group.mean.high).copied().collect();
        let largest = groups.iter().map(|group| group.lambda.len()).max().unwrap_or(0);
        let (mut near, mut terms) = (vec![0.0; groups.len()], vec![0.0; largest]);
        let mut left_over: Vec<usize> = vec![];
        for (&id, row) in left.ids.iter().zip(left.rows.chunks_exact(self.dim)) {
            let row = Mean { high: row.to_vec(), low: vec![] };
            squared_distances(&means, self.dim, &row, &mut near);
            near.iter_mut().zip(groups).for_each(|(s, group)| *s += group.spread);
            left_over.clear();
            left_over.extend(0..groups.len());
            decay_all(gamma, &mut near);
            let mut sum: f64 = near.iter().zip(groups).map(|(rho, group)| group.weight * rho).sum();
            let mut is_inside = sum <= mean_level;
            while !is_inside && !left_over.is_empty() {
                // A few groups decide about most rows: no order of all is needed.
                let nearest = (1..left_over.len()).fold(0, |best, i| {
                    if near[left_over[i]] < near[left_over[best]] { i } else { best }
                });
                let g = left_over.swap_remove(nearest);
                let group = &groups[g];
                let terms = &mut terms[..group.lambda.len()];
                squared_distances(&group.members.rows, self.dim, &row, terms);
                decay_all(gamma, terms);
                let exact: f64 = terms.iter().zip(&group.lambda).map(|(rho, l)| l * rho).sum();
                sum += exact - group.weight * near[g];
                is_inside = sum <= mean_level;
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

struct Block {
    top: Top,
    excess: f64,
    largest: f64,
    own: f64,
}

impl Block {
    /// Takes a row with its squared distance, or a bound of it that is not above the level.
    fn offer(&mut self, id: u64, square: f64, level: f64) -> Result<(), Error> {
        if !square.is_finite() {
            return Err(Error::Overflow);
        }
        self.largest = self.largest.max(square);
        if square > level {
            self.excess += square - level;
            self.top.offer(Far { id, reach2: square });
        }
        Ok(())
    }
}
