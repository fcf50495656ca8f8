//! The exact ball of a working set: an active-set method on the dual, in the coordinates of the Gram matrix.
//!
//! *Problem.* Over λ ≥ 0 with Σλ = 1, maximize Σ λᵢbᵢ − |Σ λᵢpᵢ|²; for points bᵢ = |pᵢ|². With c = Σ λᵢpᵢ and
//! fᵢ = bᵢ − 2pᵢ·c + |c|² the value is h = Σ λᵢfᵢ, and λ is optimal when no fᵢ exceeds h.
//! *Idea.* Keep a support S of affinely independent items and the factor of A = G + σ11ᵀ over it (on the simplex σ
//! changes nothing, and A is definite exactly when S is affinely independent, so no item is special). Take the item
//! with the largest f to the support, go to the stationary point of the new support, and drop whatever would get a
//! negative multiplier on the way. An item that depends on the support is exchanged: weight moves along the null
//! direction until a multiplier is zero.
//! *Guarantee.* The value never falls. Pivots are about |S| and a few on ordinary data.
//! *Trap.* On near-copies of points, rounding can make pairs swap endlessly. When the value has not risen since the
//! last entry, the factor is rebuilt; when that does not help, items that keep entering without progress are barred until it
//! rises again. Choosing the least index instead (Bland's rule) takes eight times the pivots on cube vertices.
//! *Balls.* For a fixed R, minimizing maxᵢ |c − cᵢ|² + 2Rrᵢ − rᵢ² is the same problem with another b; see
//! [`super::core_set`] for the steps in R.
//! *Reference.* Active sets on this dual: Gärtner and Schönherr, SoCG 2000; Fischer, Gärtner and Kutz, ESA 2003, walk
//! the same path in d dimensions.

use taut_kernels::Center;
use taut_kernels::vector::{add_combination, add_scaled, dot};
use taut_points::parallel::ParallelSlice;
use taut_points::{Cancelled, Monitor};

use super::factor::{DIVIDED_MAX, Factor};
use super::working_set::WorkingSet;

/// An item violates when its f exceeds the level by this part of the squared radius. Below 1e-13 the steps of a
/// full-rank cospherical set become exchanges at rounding level (tens of pivots for each one that matters).
pub(super) const VIOLATION_TOLERANCE: f64 = 1e-13;
/// A new item depends on the support when its squared distance to it is below this part of its squared length.
const DEPENDENT_RATIO: f64 = 1e-11;
/// Below this part the squared distance is worked out again from the coordinates.
const RECOMPUTED_RATIO: f64 = 1e-5;
/// Unevenness of f on the support, in units of the tolerance, beyond which the factor itself is doubted.
const MUCH_UNEVEN: f64 = 100.0;
/// Products beyond which a sweep over the Gram matrix costs more than a step, so that each is used for several steps.
const LARGE_SWEEP: usize = 1 << 16;
/// At most this many violators are looked at again between two sweeps.
const SHORTLIST_MAX: usize = 32;
/// One of them is taken while it exceeds the level by this part of what the worst did at the sweep. Measured on cube
/// vertices and noisy spheres, d = 300 to 1500: sweeps fall to a third or less, and total time by a third to a half;
/// without this limit noisy spheres take twice the steps, as what is taken early is dropped again.
const SHORTLIST_EXCESS_RATIO: f64 = 0.8;
/// An item that entered so often without the value rising is barred until it rises. Once is too strict: near the end of
/// a flat dual the value stands still while steps still move the center, and gaps of 1e-10 stay behind.
const VAIN_ENTRIES: u32 = 3;
/// Deletions after which the factor is rebuilt.
const REBUILD_AFTER: u32 = 400;
/// Products beyond which the sweep over the Gram matrix is shared between threads.
const PARALLEL_SWEEP: usize = 1 << 18;

#[derive(Clone)]
pub(super) struct ActiveSet {
    /// Positions in the working set.
    support: Vec<usize>,
    /// Multipliers of the support.
    lambda: Vec<f64>,
    factor: Factor,
    sigma: f64,
    /// R of the balls' problem, relative to the radius offset; irrelevant for points.
    radius: f64,
    deletions: u32,
    /// Deletions in one search for the optimum after which it ends early; none by default.
    patience: Option<u32>,
    /// The last search ended early.
    gave_up: bool,
    /// Items taken to the support so far.
    pub(super) pivots: u64,
    /// Times the factor was rebuilt because the value stood still.
    pub(super) stalls: u64,
}

impl ActiveSet {
    /// The support is item 0 alone; `reach2` is about the squared radius, radii of balls included.
    pub(super) fn new(set: &WorkingSet, reach2: f64) -> Self {
        // Points closer together than the rounding of the radius need not be distinguished.
        let least = f64::EPSILON * f64::EPSILON * reach2;
        let mut active = ActiveSet {
            support: vec![0],
            lambda: vec![1.0],
            factor: Factor::default(),
            sigma: least.max(largest_norm2(set)),
            radius: 0.0,
            deletions: 0,
            patience: None,
            gave_up: false,
            pivots: 0,
            stalls: 0,
        };
        active.rebuild(set);
        active
    }

    /// The support is the first d + 1 items that do not depend on others, at its stationary point from these multipliers;
    /// `earlier` has counted what it took to come here.
    pub(super) fn resting_on(
        set: &WorkingSet,
        reach2: f64,
        lambda: &[f64],
        earlier: &Self,
    ) -> Self {
        let mut active = ActiveSet::new(set, reach2);
        (active.pivots, active.stalls) = (earlier.pivots, earlier.stalls);
        active.support = (0..set.len()).collect();
        active.lambda = lambda.to_vec();
        active.rebuild_with(set, DEPENDENT_RATIO);
        active.settle(set);
        active
    }

    /// Starts from all items: factors their matrix, keeps those with positive multipliers at the stationary point, and settles. Items
    /// that belong to the support may be lost; [`Self::maximize`] takes them again. Where most items belong to it, this takes two
    /// factors and few deletions in place of an entry for each.
    pub(super) fn of_all(set: &WorkingSet, reach2: f64) -> Self {
        let mut active = ActiveSet::new(set, reach2);
        active.support = (0..set.len()).collect();
        active.lambda = vec![1.0; set.len()];
        active.rebuild_with(set, DEPENDENT_RATIO);
        active.lambda = active.factor.stationary();
        if active.lambda.iter().any(|&l| l <= 0.0) {
            let all = active.support.iter().copied().zip(active.lambda.iter().copied());
            (active.support, active.lambda) = all.filter(|(_, l)| *l > 0.0).unzip();
            active.rebuild(set);
            active.settle(set);
        }
        // The first item is no step, as in `new`.
        active.pivots = set.len() as u64 - 1;
        active
    }

    /// Lets [`Self::maximize`] end early, after so many deletions in one call.
    pub(super) fn give_up_after(&mut self, deletions: Option<u32>) {
        self.patience = deletions;
    }

    pub(super) fn gave_up(&self) -> bool {
        self.gave_up
    }

    pub(super) fn support(&self) -> &[usize] {
        &self.support
    }

    pub(super) fn lambda(&self) -> &[f64] {
        &self.lambda
    }

    /// Goes back to an earlier support; what it took to come here stays counted.
    pub(super) fn undo_to(&mut self, earlier: Self) {
        *self = ActiveSet { pivots: self.pivots, stalls: self.stalls, ..earlier };
    }

    /// bᵢ = |cᵢ|² + 2Rrᵢ − rᵢ², with the difference of squares as a product so that near-tangent balls keep digits.
    fn b(&self, set: &WorkingSet, i: usize) -> f64 {
        let r = set.radius(i);
        if r == 0.0 {
            return set.norm2(i);
        }
        let norm = set.norm2(i).sqrt();
        (norm + r) * (norm - r) + 2.0 * self.radius * r
    }

    /// Takes a larger σ where the set has outgrown it: the first balls may lie much closer together than others.
    pub(super) fn widen(&mut self, set: &WorkingSet) {
        let largest = largest_norm2(set);
        if largest > 16.0 * self.sigma {
            self.sigma = largest;
            self.rebuild(set);
        }
    }

    /// Sets R of the balls' problem and settles the support for it.
    pub(super) fn set_radius(&mut self, set: &WorkingSet, radius: f64) {
        self.radius = radius;
        let half_b: Vec<f64> = self.support.iter().map(|&i| self.b(set, i) / 2.0).collect();
        self.factor.set_half_b(&half_b);
        self.settle(set);
    }

    /// Makes λ optimal over the whole working set.
    pub(super) fn maximize(
        &mut self,
        set: &WorkingSet,
        monitor: &Monitor<'_>,
    ) -> Result<(), Cancelled> {
        let mut best = f64::NEG_INFINITY;
        let mut entered: Vec<usize> = vec![];
        let mut vain = vec![0; set.len()];
        let mut rebuilt = false;
        let mut attempts = 0;
        let last = self.patience.map(|patience| self.deletions.saturating_add(patience));
        self.gave_up = false;
        loop {
            monitor.check()?;
            if last.is_some_and(|last| self.deletions > last) {
                self.gave_up = true;
                return Ok(());
            }
            let f = self.values(set);
            let value = dot(&self.lambda, &self.support.iter().map(|&i| f[i]).collect::<Vec<_>>());
            if self.level_out(set, &f, value, &mut attempts) {
                continue;
            }
            if value > best {
                best = value;
                entered.clear();
                vain.fill(0);
                rebuilt = false;
            } else if !rebuilt {
                self.stalls += 1;
                self.rebuild(set);
                self.settle(set);
                rebuilt = true;
                continue;
            } else {
                entered.drain(..).for_each(|i| vain[i] += 1);
            }
            let Some(next) = self.violator(set, &f, value, &vain) else { return Ok(()) };
            entered.push(next);
            attempts = 0;
            self.pivots += 1;
            if self.enter(set, next) {
                self.settle(set);
            } else {
                vain[next] = VAIN_ENTRIES;
            }
            if set.len() * self.support.len() >= LARGE_SWEEP {
                let others = self.worst_violators(set, &f, value, next, &vain);
                self.enter_some_of(set, others, f[next] - value, &mut entered);
            }
        }
    }

    /// Violators other than the one just taken, the worst first, at most [`SHORTLIST_MAX`].
    fn worst_violators(
        &self,
        set: &WorkingSet,
        f: &[f64],
        value: f64,
        taken: usize,
        vain: &[u32],
    ) -> Vec<usize> {
        let violates = |&i: &usize| {
            i != taken && vain[i] < VAIN_ENTRIES && f[i] > value + self.slack(set, i, value)
        };
        let mut list: Vec<usize> = (0..f.len()).filter(violates).collect();
        list.sort_unstable_by(|&i, &j| f[j].total_cmp(&f[i]).then(i.cmp(&j)));
        list.truncate(SHORTLIST_MAX);
        list.retain(|i| !self.support.contains(i));
        list
    }

    /// Takes items of a short list to the support, the worst violator of the moment first, each at most once: between
    /// two sweeps over the whole Gram matrix, which would cost more than everything else, only a few rows are read.
    /// `excess` is by how much the worst of all exceeded the level at the last sweep.
    fn enter_some_of(
        &mut self,
        set: &WorkingSet,
        mut list: Vec<usize>,
        excess: f64,
        entered: &mut Vec<usize>,
    ) {
        let mut lambda = vec![0.0; set.len()];
        while !list.is_empty() {
            lambda.fill(0.0);
            self.support.iter().zip(&self.lambda).for_each(|(&i, &l)| lambda[i] = l);
            let (level, norm2) = self.level(set);
            let f = |i: usize| self.b(set, i) - 2.0 * dot(set.gram_row(i), &lambda) + norm2;
            let worst =
                list.iter().map(|&i| (i, f(i))).reduce(|a, b| if b.1 > a.1 { b } else { a });
            let Some((next, f)) = worst else { return };
            if f <= level + self.slack(set, next, level).max(SHORTLIST_EXCESS_RATIO * excess) {
                return;
            }
            list.retain(|&i| i != next);
            entered.push(next);
            self.pivots += 1;
            if self.enter(set, next) {
                self.settle(set);
            }
        }
    }

    /// The common value of f on the support at its stationary point, and |c|²; from (As)ᵢ = bᵢ/2 + ν both follow
    /// without a look at the Gram matrix.
    pub(super) fn level(&self, set: &WorkingSet) -> (f64, f64) {
        let nu = self.factor.multiplier();
        let half: f64 =
            self.support.iter().zip(&self.lambda).map(|(&i, l)| l * self.b(set, i)).sum::<f64>()
                / 2.0;
        (half + self.sigma - nu, half + nu - self.sigma)
    }

    /// fᵢ of every item: its squared distance from c, for balls with the terms of the radii.
    fn values(&self, set: &WorkingSet) -> Vec<f64> {
        let k = set.len();
        let mut product = vec![0.0; k];
        let sweep = |first: usize, out: &mut [f64]| {
            let end = first + out.len();
            add_combination(out, &self.lambda, |i| &set.gram_row(self.support[i])[first..end]);
        };
        if k * self.support.len() >= PARALLEL_SWEEP {
            product.par_chunks_mut(256).enumerate().for_each(|(part, out)| sweep(part * 256, out));
        } else {
            sweep(0, &mut product);
        }
        let norm2: f64 = self.support.iter().zip(&self.lambda).map(|(&i, l)| l * product[i]).sum();
        (0..k).map(|i| self.b(set, i) - 2.0 * product[i] + norm2).collect()
    }

    /// By how much fᵢ may exceed the level before item i violates the ball.
    fn slack(&self, set: &WorkingSet, i: usize, level: f64) -> f64 {
        match set.radius_offset() {
            0.0 => VIOLATION_TOLERANCE * level,
            // An excess δ of the reach is about 2δ(R − r) of f: ask for the same δ/R as for points.
            offset => VIOLATION_TOLERANCE * (self.radius - set.radius(i)) * (self.radius + offset),
        }
    }

    /// At a stationary point f is the same on all of the support. Where it is not, because the support was nearly
    /// dependent for a while and the factor has lost digits, violators would hide behind the largest f: correct λ, or
    /// rebuild the factor. Says whether λ has changed; `attempts` counts what was done for this support.
    fn level_out(&mut self, set: &WorkingSet, f: &[f64], value: f64, attempts: &mut u32) -> bool {
        let uneven = self.support.iter().map(|&i| (f[i] - value).abs() / self.slack(set, i, value));
        let uneven = uneven.fold(0.0, f64::max);
        let much = uneven > MUCH_UNEVEN;
        *attempts += 1;
        match *attempts {
            1 if uneven > 1.0 => self.correct(f),
            2 if much => {
                self.rebuild(set);
                self.settle(set);
                true
            }
            3 if much => self.correct(f),
            _ => false,
        }
    }

    /// Moves λ so that what is uneven in f on the support evens out; false, and nothing is done, if that would make a
    /// multiplier negative.
    fn correct(&mut self, f: &[f64]) -> bool {
        let halves: Vec<f64> = self.support.iter().map(|&i| f[i] / 2.0).collect();
        self.correct_by(halves)
    }

    /// The same from fᵢ/2 in the order of the support.
    fn correct_by(&mut self, mut halves: Vec<f64>) -> bool {
        let mean = halves.iter().sum::<f64>() / halves.len() as f64;
        halves.iter_mut().for_each(|v| *v -= mean);
        let mut lambda = self.factor.correction(&halves);
        add_scaled(&mut lambda, 1.0, &self.lambda);
        let convex = lambda.iter().all(|&l| l > 0.0);
        if convex {
            self.lambda = lambda;
        }
        convex
    }

    /// The item with the largest f among those outside the support that violate the ball; ties to the lower position.
    fn violator(&self, set: &WorkingSet, f: &[f64], value: f64, vain: &[u32]) -> Option<usize> {
        let level = self.support.iter().map(|&i| f[i]).fold(value, f64::max);
        let mut inside = vec![false; f.len()];
        self.support.iter().for_each(|&i| inside[i] = true);
        let mut found = None;
        let mut largest = f64::NEG_INFINITY;
        for i in 0..f.len() {
            if f[i] > largest
                && !inside[i]
                && vain[i] < VAIN_ENTRIES
                && f[i] > level + self.slack(set, i, level)
            {
                largest = f[i];
                found = Some(i);
            }
        }
        found
    }

    /// Takes item `j` to the support, exchanging it for others while it depends on them. False if it cannot be.
    fn enter(&mut self, set: &WorkingSet, j: usize) -> bool {
        let mut weight = 0.0;
        loop {
            let length2 = set.norm2(j) + self.sigma;
            let a: Vec<f64> =
                self.support.iter().map(|&i| set.gram_row(j)[i] + self.sigma).collect();
            let mut z = self.factor.forward(&a);
            let mut recomputed = None;
            let mut distance2 = length2 - dot(&z, &z);
            if distance2.min(self.factor.smallest_pivot()) < RECOMPUTED_RATIO * length2 {
                let mut y = self.factor.back(z.clone());
                distance2 = self.distance_from_coordinates(set, j, &mut y);
                z = self.factor.times(&y);
                recomputed = Some(y);
            }
            // More than d + 1 affinely independent points do not exist: a fact, where the tolerance is a guess.
            if distance2 > DEPENDENT_RATIO * length2 && self.support.len() <= set.dim() {
                self.factor.append(&z, distance2.sqrt(), self.b(set, j) / 2.0);
                self.support.push(j);
                self.lambda.push(weight);
                return true;
            }
            let y = recomputed.unwrap_or_else(|| self.factor.back(z));
            let Some((blocker, step)) = exchange(&self.lambda, &y) else { return false };
            add_scaled(&mut self.lambda, -step, &y);
            weight += step;
            self.delete(set, blocker);
            let sum = weight + self.lambda.iter().sum::<f64>();
            self.lambda.iter_mut().for_each(|l| *l = l.max(0.0) / sum);
            weight /= sum;
        }
    }

    /// |p_j − P_S y|² + σ(1 − Σy)², with y corrected once: what the Gram matrix gives too coarsely near dependence.
    fn distance_from_coordinates(&self, set: &WorkingSet, j: usize, y: &mut [f64]) -> f64 {
        let residual = |y: &[f64]| {
            let mut e = set.row(j).to_vec();
            let negated: Vec<f64> = y.iter().map(|v| -v).collect();
            add_combination(&mut e, &negated, |i| set.row(self.support[i]));
            (e, 1.0 - y.iter().sum::<f64>())
        };
        let (e, s) = residual(y);
        let right: Vec<f64> =
            self.support.iter().map(|&i| dot(set.row(i), &e) + self.sigma * s).collect();
        let dy = self.factor.back(self.factor.forward(&right));
        add_scaled(y, 1.0, &dy);
        let (e, s) = residual(y);
        dot(&e, &e) + self.sigma * s * s
    }

    /// Goes to the stationary point of the support, dropping what would get a negative multiplier on the way.
    fn settle(&mut self, set: &WorkingSet) {
        loop {
            let s = self.factor.stationary();
            let Some((blocker, step)) = first_zero(&self.lambda, &s) else {
                self.lambda = s;
                return;
            };
            for (l, s) in self.lambda.iter_mut().zip(&s) {
                *l = (*l + step * (s - *l)).max(0.0);
            }
            self.delete(set, blocker);
        }
    }

    fn delete(&mut self, set: &WorkingSet, position: usize) {
        self.support.remove(position);
        self.lambda.remove(position);
        self.deletions += 1;
        if self.deletions.is_multiple_of(REBUILD_AFTER) {
            self.rebuild(set);
        } else {
            self.factor.delete(position);
        }
    }

    /// The factor of the support, afresh. An item that has come to depend on those before it is dropped.
    fn rebuild(&mut self, set: &WorkingSet) {
        self.rebuild_with(set, f64::EPSILON * f64::EPSILON);
    }

    /// The same for a part of the squared length below which the squared distance to those before it is dependence.
    fn rebuild_with(&mut self, set: &WorkingSet, dependent_ratio: f64) {
        if !self.factor_at_once(set) {
            self.factor_one_by_one(set, dependent_ratio);
        }
        self.normalize();
    }

    /// Makes the factor of the support item by item, and drops those that depend on the ones before.
    fn factor_one_by_one(&mut self, set: &WorkingSet, dependent_ratio: f64) {
        self.factor.clear();
        let (support, lambda) =
            (std::mem::take(&mut self.support), std::mem::take(&mut self.lambda));
        for (i, l) in support.into_iter().zip(lambda) {
            if self.support.len() > set.dim() {
                break;
            }
            let a: Vec<f64> =
                self.support.iter().map(|&k| set.gram_row(i)[k] + self.sigma).collect();
            let mut z = self.factor.forward(&a);
            let length2 = set.norm2(i) + self.sigma;
            let mut distance2 = length2 - dot(&z, &z);
            if distance2 < RECOMPUTED_RATIO * length2 {
                let mut y = self.factor.back(z.clone());
                distance2 = self.distance_from_coordinates(set, i, &mut y);
                z = self.factor.times(&y);
            }
            if distance2 > dependent_ratio * length2 {
                self.factor.append(&z, distance2.sqrt(), self.b(set, i) / 2.0);
                self.support.push(i);
                self.lambda.push(l);
            }
        }
    }

    /// Makes the factor of the support by a blocked Cholesky factorization; false where items may depend on others, as their squared
    /// distance to those before is below [`RECOMPUTED_RATIO`] or they are more than d + 1, and where they are few.
    fn factor_at_once(&mut self, set: &WorkingSet) -> bool {
        if self.support.len() > set.dim() + 1 || self.support.len() <= DIVIDED_MAX {
            return false;
        }
        let mut a = Vec::with_capacity(self.support.len() * self.support.len());
        for &i in &self.support {
            let row = set.gram_row(i);
            a.extend(self.support.iter().map(|&j| row[j] + self.sigma));
        }
        let half_b: Vec<f64> = self.support.iter().map(|&i| self.b(set, i) / 2.0).collect();
        let Some(factor) = Factor::of(a, &half_b, RECOMPUTED_RATIO) else { return false };
        self.factor = factor;
        true
    }

    /// Makes the multipliers sum to 1.
    fn normalize(&mut self) {
        let sum: f64 = self.lambda.iter().sum();
        self.lambda.iter_mut().for_each(|l| *l /= sum);
    }

    /// One correction of λ from distances taken in the coordinates: evens them out to the last digits.
    pub(super) fn refine(&mut self, set: &WorkingSet) {
        let center = Center { high: set.combination(&self.support, &self.lambda), low: vec![] };
        let mut halves: Vec<f64> =
            self.support.iter().map(|&i| set.squared_distance(i, &center)).collect();
        for (value, &i) in halves.iter_mut().zip(&self.support) {
            let r = set.radius(i);
            *value = (*value + (2.0 * self.radius - r) * r) / 2.0;
        }
        self.correct_by(halves);
        // What solving left beside 1 is more than the certificate may state.
        self.normalize();
    }
}

/// Any positive σ would do; of the size of the squared norms it takes no digits from them.
fn largest_norm2(set: &WorkingSet) -> f64 {
    (0..set.len()).map(|i| set.norm2(i)).fold(0.0, f64::max)
}

/// Returns how far weight can move along y to the entering item, and who stops it: the least λᵢ/yᵢ, ties to the largest yᵢ.
fn exchange(lambda: &[f64], y: &[f64]) -> Option<(usize, f64)> {
    let mut found: Option<(usize, f64)> = None;
    for i in 0..y.len() {
        if y[i] > 1e-12 {
            let step = lambda[i] / y[i];
            if found.is_none_or(|(k, least)| step < least || (step == least && y[i] > y[k])) {
                found = Some((i, step));
            }
        }
    }
    found
}

/// Where the way from λ to s first meets a zero: None if all of s is positive.
fn first_zero(lambda: &[f64], s: &[f64]) -> Option<(usize, f64)> {
    let mut found: Option<(usize, f64)> = None;
    for i in 0..s.len() {
        if s[i] <= 0.0 {
            let step = if lambda[i] > 0.0 { lambda[i] / (lambda[i] - s[i]) } else { 0.0 };
            if found.is_none_or(|(k, least)| step < least || (step == least && s[i] < s[k])) {
                found = Some((i, step));
            }
        }
    }
    found
}
