//! Places on the curve, some of the noise's width apart, with the tangent there and the width itself.
//!
//! *Problem.* Noise turns the curve into a band. Find out how long a window must be to show which way the band runs, and put a
//! seed on its middle line every now and then, everywhere.
//! *Idea.* Points are taken in the order of their density, densest first. Around one that is not yet accounted for, windows
//! grow until the points in it are [`FLATNESS_MIN`] times as long as their residuals from a parabola are wide, by more than chance:
//! a blob inside the band is about twice as long as wide. The window is centered again on its parabola, and the seed there accounts
//! for all points of the slab around it. What is left when density has fallen to a fraction are outliers.
//! *Guarantee.* A function of the point set that turns and scales with it; every point of the slab of a seed is accounted for,
//! so a curve without gaps gets seeds without gaps. O(n) work in windows beside the search for neighbors.
//! *Trap.* Windows around a sample, not around the middle line, are askew by up to the noise. A window that may grow without
//! end swallows the whole curve, which is flat beside its own size: it stops at the first that is flat enough, its residuals must
//! look like noise, and what is much wider than the windows within it is dropped. Of a hundred thousand windows some of a few points
//! are flat by chance: they must stay so when they are longer, and those that longer ones hold are no seeds.
//! *Reference.* The coarse disk of Cheng, Funke, Golin, Kumar, Poon and Ramos, with a parabola in place of the strip, so that it
//! needs no feature size to be 1.

use std::cmp::Ordering;

use taut_oblivious::hilbert_order;
use taut_points::Monitor;
use taut_points::parallel::ParallelSlice;

use super::local::{Parabola, Window};
use super::parameters::{
    ALIGNED_SEEDS_MIN, ALONG_COS_MIN, ALONG_WINDOWS, BARREN_RATIO, BESIDE_DENSITY_RATIO_MAX,
    BEST_FLATNESS_MIN, COARSE_RATIO_MIN, CONFIRMED_FLATNESS_RATIO, CONFIRMING_RATIO,
    DENSITY_NEIGHBORS, DENSITY_RATIO_MAX, FLATNESS_MIN, LENGTH_RATIO_MIN, LENGTHS_TRIED,
    NEUMANN_RATIO_MIN, POINTS_PER_CURVE_POINT_MAX, SAMPLE_FLATNESS_RATIO, SAMPLE_POINTS,
    SEED_WINDOW_GROWTH, SLAB_DEVIATIONS_MAX, SLAB_LENGTH_RATIO, SPACING_RATIO_MAX,
    SPLIT_SLAB_DEVIATIONS_MAX, SPLITS_MAX, SURE_POINTS_MIN, VAIN_POINTS_RATIO_MAX, WIDTH_RATIO_MIN,
    WINDOW_RATIO_MAX,
};
use super::split::{SPLIT_POINTS_MIN, evidence_min, split};
use crate::Error;
use crate::curve::index::{Index, distance2};

type Point = [f64; 2];

/// Stands for no seed.
const NONE: u32 = u32::MAX;
/// Stands for no seed that could be found.
const NO_SEED: u32 = NONE - 1;

/// A place on the curve.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seed {
    /// The place.
    pub(super) at: Point,
    /// The unit tangent, either way.
    pub(super) tangent: Point,
    /// How the curve bends to the left of the tangent: u along it, the curve is at bend·u².
    pub(super) bend: f64,
    /// Radius of its window.
    pub(super) reach: f64,
    /// Standard deviation of the residuals.
    pub(super) deviation: f64,
    /// Points of its window for its length.
    pub(super) density: f64,
}

impl Seed {
    /// Returns the seed with its tangent the other way.
    pub(super) fn reversed(&self) -> Self {
        Self { tangent: self.tangent.map(|x| -x), bend: -self.bend, ..*self }
    }

    /// The place of a point in the frame of the seed: along the tangent, and to its left.
    pub(super) fn local(&self, at: Point) -> Point {
        let ([x, y], [tx, ty]) = ([at[0] - self.at[0], at[1] - self.at[1]], self.tangent);
        [x * tx + y * ty, y * tx - x * ty]
    }

    /// The direction of its parabola where it is next to a point, no farther along than its window goes.
    pub(super) fn direction_beside(&self, at: Point) -> Point {
        let slope = 2.0 * self.bend * self.local(at)[0].clamp(-self.reach, self.reach);
        let ([tx, ty], norm) = (self.tangent, slope.hypot(1.0));
        [(tx - slope * ty) / norm, (ty + slope * tx) / norm]
    }

    /// The seed some length on along its parabola.
    pub(super) fn ahead(&self, length: f64) -> Self {
        let slope = 2.0 * self.bend * length;
        let norm = slope.hypot(1.0);
        let [tx, ty] = self.tangent;
        let at = [self.at[0] + length * tx, self.at[1] + length * ty];
        Self { at, ..*self }.turned(self.bend * length * length, [1.0 / norm, slope / norm])
    }

    /// The seed moved to its left, its tangent turned to a direction of its frame.
    pub(super) fn turned(&self, left: f64, [along, across]: Point) -> Self {
        let [tx, ty] = self.tangent;
        Self {
            at: [self.at[0] - left * ty, self.at[1] + left * tx],
            tangent: [along * tx - across * ty, along * ty + across * tx],
            ..*self
        }
    }

    /// Whether a place is on its strand, as far as its parabola can tell: beyond the window it goes on straight.
    fn is_beside(&self, at: Point) -> bool {
        let [u, v] = self.local(at);
        let near = u.clamp(-self.reach, self.reach);
        let off = v - self.bend * near * (2.0 * u - near);
        off.abs() <= SLAB_DEVIATIONS_MAX * self.deviation
    }

    /// Whether its window shows that another one is flat by chance.
    fn is_longer(&self, other: &Seed) -> bool {
        self.reach > LENGTH_RATIO_MIN * other.reach
            && self.deviation > WIDTH_RATIO_MIN * other.deviation
    }
}

/// A window's least length, in units in which all points are near 1: the square of a shorter one may be 0, and 0 never grows.
const REACH_MIN: f64 = 1e-150;

/// The seeds of all curves, in the order in which they were found.
pub(super) fn seeds(
    points: &[Point],
    index: &Index<'_>,
    monitor: &Monitor<'_>,
) -> Result<Vec<Seed>, Error> {
    let spacing = spacings(index);
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    order.par_sort_unstable_by(|&i, &j| {
        let ((a, all_a), (b, all_b)) = (spacing[i as usize], spacing[j as usize]);
        a.total_cmp(&b).then(all_a.total_cmp(&all_b)).then(i.cmp(&j))
    });
    let mut rank = vec![0; points.len()];
    order.iter().zip(0..).for_each(|(&i, place)| rank[i as usize] = place);
    let mut search = Search::new(points, index, &rank);
    for round in 0..2 {
        search.round(&order, &spacing, monitor)?;
        // Once more for what windows account for that turned out to be coarse, now that the width of the band is known.
        if round > 0 || !search.drop_coarse() {
            break;
        }
    }
    Ok(apart(search.seeds.into_iter().flatten().collect()))
}

/// The seeds that are not beside an earlier one, as two samples on either side of the band lead to one place, nor flat by chance.
fn apart(seeds: Vec<Seed>) -> Vec<Seed> {
    let order = hilbert_order(seeds.len(), |i| seeds[i].at);
    let mut number = vec![0; seeds.len()];
    let mut places = Vec::with_capacity(seeds.len());
    for (place, &i) in order.iter().enumerate() {
        number[i as usize] = place;
        places.push(seeds[i as usize].at);
    }
    let index = Index::new(&places);
    let mut beside = vec![false; seeds.len()];
    for (i, seed) in seeds.iter().enumerate() {
        if !beside[number[i]] {
            let apart = 0.5 * SLAB_LENGTH_RATIO * seed.reach;
            // A long window reaches the seeds of another strand, which stay.
            index.within(seed.at, apart * apart, &mut |place| {
                beside[place as usize] |= seed.is_beside(places[place as usize]);
            });
            beside[number[i]] = false;
        }
    }
    // How many slabs a seed lies in, its own among them, and how many of those show that it is flat by chance.
    let mut slabs = vec![[0u32; 2]; seeds.len()];
    for seed in &seeds {
        let [tx, ty] = seed.tangent;
        index.within(seed.at, seed.reach * seed.reach, &mut |place| {
            let (other, at) = (&seeds[order[place as usize] as usize], places[place as usize]);
            let across = (at[1] - seed.at[1]) * tx - (at[0] - seed.at[0]) * ty;
            if across.abs() <= SLAB_DEVIATIONS_MAX * seed.deviation {
                slabs[place as usize][0] += 1;
                slabs[place as usize][1] += u32::from(seed.is_longer(other));
            }
        });
    }
    let (mut around, mut aligned): (Vec<u32>, Vec<u32>) = (Vec::new(), Vec::new());
    let middle = |around: &[u32], of: &dyn Fn(&Seed) -> f64| {
        let mut values: Vec<f64> =
            around.iter().map(|&p| of(&seeds[order[p as usize] as usize])).collect();
        values.sort_unstable_by(f64::total_cmp);
        values[values.len() / 2]
    };
    for (i, seed) in seeds.iter().enumerate() {
        around.clear();
        let far = LENGTH_RATIO_MIN * seed.reach;
        index.within(seed.at, far * far, &mut |place| around.push(place));
        // A curve beside a denser one has its own seeds, one after the other; a seed beside the band has none.
        aligned.clear();
        aligned.extend(around.iter().copied().filter(|&p| seed.is_beside(places[p as usize])));
        let own = if aligned.len() >= ALIGNED_SEEDS_MIN { &aligned } else { &around };
        let own = middle(own, &|s| s.density);
        let all = middle(&around, &|s| s.density);
        around.retain(|&p| {
            distance2(places[p as usize], seed.at) <= (ALONG_WINDOWS * seed.reach).powi(2)
        });
        // At a hairpin the strands beside a seed run across its tangent, but along its parabola.
        let along = middle(&around, &|s| {
            let [x, y] = seed.direction_beside(s.at);
            (s.tangent[0] * x + s.tangent[1] * y).abs()
        });
        let [slabs, longer] = slabs[number[i]];
        if 2 * longer >= slabs
            || seed.density * DENSITY_RATIO_MAX < own
            || seed.density * BESIDE_DENSITY_RATIO_MAX < all
            || along < ALONG_COS_MIN
        {
            beside[number[i]] = true;
        }
    }
    let mut places = number.into_iter();
    seeds.into_iter().filter(|_| places.next().is_some_and(|place| !beside[place])).collect()
}

/// For each point the distance of its [`DENSITY_NEIGHBORS`]-th neighbor, and the sum of the squared distances of all.
///
/// Two points are often the eighth of each other. Then the sum decides which is denser: numbers of points turn with nothing.
fn spacings(index: &Index<'_>) -> Vec<(f64, f64)> {
    index.neighbors_of_all(DENSITY_NEIGHBORS + 1, |found| {
        let last = found.last().map_or(0.0, |last| last.0.sqrt());
        (last, found.iter().map(|near| near.0).sum())
    })
}

/// The value that nine tenths of ascending numbers do not exceed.
#[derive(Default)]
struct Quantile {
    values: Vec<f64>,
}

impl Quantile {
    fn push(&mut self, value: f64) {
        self.values.push(value);
    }

    /// None for fewer than so many numbers.
    fn value(&self, fewest: usize) -> Option<f64> {
        (self.values.len() >= fewest).then(|| self.values[self.values.len() * 9 / 10])
    }
}

struct Search<'a> {
    points: &'a [Point],
    index: &'a Index<'a>,
    /// The place of each point in the order of density.
    rank: &'a [u32],
    /// The seeds found, none where one was dropped again.
    seeds: Vec<Option<Seed>>,
    /// For each point the seed that accounts for it, [`NONE`] or [`NO_SEED`].
    covered: Vec<u32>,
    window: Window,
    ids: Vec<u32>,
    /// How many points the window had before points of other strands were left out of it.
    seen: usize,
    /// Places along a parabola and residuals.
    along: Vec<Point>,
    residuals: Vec<f64>,
    /// Points of the largest windows where none was flat.
    vain: usize,
    /// The least evidence for two strands in a window.
    evidence_min: f64,
}

impl<'a> Search<'a> {
    fn new(points: &'a [Point], index: &'a Index<'a>, rank: &'a [u32]) -> Self {
        let covered = vec![NONE; points.len()];
        Self {
            points,
            index,
            rank,
            seeds: Vec::new(),
            covered,
            window: Window::default(),
            ids: Vec::new(),
            seen: 0,
            along: Vec::new(),
            residuals: Vec::new(),
            vain: 0,
            evidence_min: evidence_min(points.len()),
        }
    }

    /// Seeds until all points are accounted for but those that are too sparse.
    fn round(
        &mut self,
        order: &[u32],
        spacing: &[(f64, f64)],
        monitor: &Monitor<'_>,
    ) -> Result<(), Error> {
        let mut done = Quantile::default();
        let fewest = (order.len() / POINTS_PER_CURVE_POINT_MAX).max(30);
        for (count, &i) in order.iter().enumerate() {
            let i = i as usize;
            if count % 4096 == 0 {
                monitor.check()?;
            }
            if self.covered[i] != NONE {
                // Many in one place are no curve, and do not tell how dense curves are.
                if self.covered[i] != NO_SEED {
                    done.push(spacing[i].0);
                }
                continue;
            }
            if done.value(fewest).is_some_and(|usual| spacing[i].0 > SPACING_RATIO_MAX * usual) {
                break;
            }
            let Some((parabola, reach)) = self.flat(self.points[i], spacing[i].0) else {
                self.give_up(i);
                continue;
            };
            self.cover(&parabola, reach);
            self.covered[i] = self.seeds.len() as u32;
            self.seeds.push(Some(Seed {
                at: parabola.projection(),
                tangent: parabola.direction(),
                bend: parabola.bend(),
                reach,
                deviation: parabola.variance.sqrt(),
                density: parabola.kept as f64 / reach,
            }));
        }
        Ok(())
    }

    /// Drops seeds of windows that hold many others of much less deviation: curves wind within them. Says whether there are any.
    fn drop_coarse(&mut self) -> bool {
        let seeds = &mut self.seeds;
        let places: Vec<Point> = seeds.iter().flatten().map(|seed| seed.at).collect();
        let order = hilbert_order(places.len(), |i| places[i]);
        let places: Vec<Point> = order.iter().map(|&i| places[i as usize]).collect();
        let index = Index::new(&places);
        let deviations: Vec<f64> = seeds.iter().flatten().map(|seed| seed.deviation).collect();
        let mut within = Vec::new();
        let mut dropped = false;
        for seed in seeds.iter_mut() {
            let Some(Seed { at, reach, deviation, .. }) = *seed else { continue };
            within.clear();
            index.within(at, reach * reach, &mut |place| {
                within.push(deviations[order[place as usize] as usize]);
            });
            if deviation > COARSE_RATIO_MIN * median(&mut within) {
                (*seed, dropped) = (None, true);
            }
        }
        for seed in &mut self.covered {
            if *seed != NONE && self.seeds.get(*seed as usize).is_none_or(Option::is_none) {
                *seed = NONE;
            }
        }
        dropped
    }

    /// Whether the window just fitted is wide beside the band of the points in it that seeds account for, if those are many.
    fn is_coarse(&mut self, parabola: &Parabola) -> bool {
        let known =
            self.ids.iter().filter_map(|&i| self.seeds.get(self.covered[i as usize] as usize));
        let mut known: Vec<f64> = known.flatten().map(|seed| seed.deviation).collect();
        known.len() * 4 > self.ids.len()
            && parabola.variance.sqrt() > COARSE_RATIO_MIN * median(&mut known)
    }

    fn fit(&mut self, at: Point, reach: f64) -> Option<Parabola> {
        self.look(at, reach);
        self.fit_one_band(at)
    }

    /// The parabola of the strand in the middle of the window: where residuals are those of two, those of the other one are left out.
    fn fit_one_band(&mut self, at: Point) -> Option<Parabola> {
        let points = self.points;
        let mut parabola = self.window.fit(at, self.ids.iter().map(|&i| points[i as usize]))?;
        for _ in 0..SPLITS_MAX {
            if self.ids.len() < SPLIT_POINTS_MIN {
                break;
            }
            self.residuals.clear();
            self.residuals.extend(self.window.local.iter().map(|&p| parabola.residual(p)));
            let Some(middle) = split(&mut self.residuals, self.evidence_min) else { break };
            let is_above = parabola.residual(parabola.local(at)) > middle;
            let mut local = self.window.local.iter();
            self.ids.retain(|_| {
                local.next().is_some_and(|&p| (parabola.residual(p) > middle) == is_above)
            });
            parabola = self.window.fit(at, self.ids.iter().map(|&i| points[i as usize]))?;
        }
        Some(parabola)
    }

    /// Finds the points of a window.
    fn look(&mut self, at: Point, reach: f64) {
        let ids = &mut self.ids;
        ids.clear();
        self.index.within(at, reach * reach, &mut |i| ids.push(i));
        self.seen = ids.len();
    }

    /// The same as [`fit`](Self::fit), or none where a sample of the points shows that the window is far from as flat as `least`.
    ///
    /// Most windows of many points are on the way to longer ones, or without success; they took two thirds of the time of seeds.
    fn fit_if_flat(&mut self, at: Point, reach: f64, least: f64) -> Option<Parabola> {
        self.look(at, reach);
        let points = self.points;
        let step = (self.ids.len() / SAMPLE_POINTS) as u32;
        if step > 1 {
            // Every so many in the order of density: that is the same however the points are turned.
            let in_sample = |i: &&u32| self.rank[**i as usize].is_multiple_of(step);
            let sample = self.ids.iter().filter(in_sample).map(|&i| points[i as usize]);
            let sampled = self.window.fit(at, sample)?;
            if flatness(&sampled, reach) < SAMPLE_FLATNESS_RATIO * least {
                return None;
            }
        }
        self.fit_one_band(at)
    }

    /// The first window that is flat, centered on its parabola; or the flattest, where none is flat enough.
    fn flat(&mut self, start: Point, spacing: f64) -> Option<(Parabola, f64)> {
        let most = (self.points.len() / 3).max(DENSITY_NEIGHBORS);
        // Not the spacing itself, at which the last neighbor is inside or outside as rounding will have it.
        let mut reach = (SEED_WINDOW_GROWTH * spacing).max(REACH_MIN);
        let mut best: Option<(f64, Parabola, f64)> = None;
        let mut longest = f64::INFINITY;
        loop {
            let least = best.map_or(BEST_FLATNESS_MIN, |(most, ..)| most);
            if let Some(parabola) = self.fit_if_flat(start, reach, least) {
                let flatness = flatness(&parabola, reach);
                if flatness >= least && (!self.is_filled(&parabola) || self.is_coarse(&parabola)) {
                    longest = longest.min(WINDOW_RATIO_MAX * reach);
                } else if flatness >= least && self.stays_flat(start, reach, &parabola, flatness) {
                    best = Some((flatness, parabola, reach));
                    if flatness >= FLATNESS_MIN {
                        break;
                    }
                    longest = WINDOW_RATIO_MAX * reach;
                }
            }
            let seen = self.seen;
            if seen > most || seen == self.points.len() || reach > longest {
                break;
            }
            reach *= SEED_WINDOW_GROWTH;
        }
        let (as_flat, mut parabola, mut reach) = best?;
        for _ in 0..2 {
            parabola = self.centered(
                parabola.projection(),
                &mut reach,
                CONFIRMED_FLATNESS_RATIO * as_flat,
            )?;
        }
        let projection = parabola.projection();
        (distance2(projection, start) <= (0.5 * reach).powi(2) && self.is_filled(&parabola))
            .then_some((parabola, reach))
    }

    /// The window around a place that is as flat as `least`, shorter if need be.
    ///
    /// What was left out of the window around a sample as off its curve, such as part of another one, may be within that around the curve.
    fn centered(&mut self, at: Point, reach: &mut f64, least: f64) -> Option<Parabola> {
        for _ in 0..LENGTHS_TRIED {
            let parabola = self.fit(at, *reach)?;
            if flatness(&parabola, *reach) >= least {
                return Some(parabola);
            }
            *reach /= SEED_WINDOW_GROWTH;
        }
        None
    }

    /// Whether residuals are noise: those next to each other along the parabola differ as any two do.
    ///
    /// Where the curve winds or bends within the window they do not, as its own course is what they show. The mean square of
    /// their differences is twice their variance where they are noise (von Neumann 1941).
    fn is_filled(&mut self, parabola: &Parabola) -> bool {
        let most = SLAB_DEVIATIONS_MAX * parabola.variance.sqrt();
        let along = &mut self.along;
        along.clear();
        along.extend(self.window.local.iter().map(|&p| [p[0], parabola.residual(p)]));
        along.retain(|p| p[1].abs() <= most);
        // A hot loop: with the sort that is compiled once for all types it took a fifth of the time of seeds.
        along.sort_unstable_by(|a, b| match a[0] < b[0] || a[0] == b[0] && a[1] < b[1] {
            true => Ordering::Less,
            false if a == b => Ordering::Equal,
            false => Ordering::Greater,
        });
        let squares: f64 = along.iter().map(|p| p[1] * p[1]).sum();
        let steps: f64 = along.windows(2).map(|p| (p[1][1] - p[0][1]).powi(2)).sum();
        steps >= 2.0 * NEUMANN_RATIO_MIN * squares
    }

    /// Whether a window of few points is as flat as it is not by chance: a longer one is nearly so.
    fn stays_flat(&mut self, start: Point, reach: f64, found: &Parabola, as_flat: f64) -> bool {
        if found.kept >= SURE_POINTS_MIN {
            return true;
        }
        let longer = CONFIRMING_RATIO * reach;
        let least = CONFIRMED_FLATNESS_RATIO * as_flat.min(FLATNESS_MIN);
        self.fit(start, longer).is_some_and(|p| flatness(&p, longer) >= least)
    }

    /// Marks a point where no window is flat.
    ///
    /// After some of these the points around it, too, up to a share of the largest window, which is much the same for them: a cloud
    /// that is no curve at all would be looked at as a whole from each of its points.
    fn give_up(&mut self, i: usize) {
        let covered = &mut self.covered;
        covered[i] = NO_SEED;
        self.vain += self.ids.len();
        if self.vain > VAIN_POINTS_RATIO_MAX * self.points.len() {
            let at = self.points[i];
            let far =
                |most: f64, &other: &u32| most.max(distance2(at, self.points[other as usize]));
            let near2 = BARREN_RATIO * BARREN_RATIO * self.ids.iter().fold(0.0, far);
            self.index.within(at, near2, &mut |i| covered[i as usize] = NO_SEED);
        }
    }

    /// Marks the points of the slab for the next seed.
    fn cover(&mut self, parabola: &Parabola, reach: f64) {
        // Beside another strand no farther than the edge of uniform noise, lest that strand get no seed of its own.
        let is_split = self.ids.len() < self.seen;
        let deviations = if is_split { SPLIT_SLAB_DEVIATIONS_MAX } else { SLAB_DEVIATIONS_MAX };
        let width = deviations * parabola.variance.sqrt();
        for (&i, &local) in self.ids.iter().zip(&self.window.local) {
            if local[0].abs() <= SLAB_LENGTH_RATIO * reach
                && parabola.residual(local).abs() <= width
            {
                self.covered[i as usize] = self.seeds.len() as u32;
            }
        }
    }
}

/// The value in the middle of some, at least one.
fn median(values: &mut [f64]) -> f64 {
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Length over width, with the width that noise has at most but for one chance in a hundred.
fn flatness(parabola: &Parabola, reach: f64) -> f64 {
    let free = parabola.kept as f64 - 3.0;
    if free < 2.0 {
        return 0.0;
    }
    // The 1 % quantile of χ² with that many degrees of freedom, over their number (Wilson and Hilferty 1931).
    let spread = 2.0 / (9.0 * free);
    let quantile = (1.0 - spread - 2.326 * spread.sqrt()).max(0.0).powi(3);
    reach / (parabola.variance / quantile).sqrt()
}
