//! The nearest of many templates, exactly.
//!
//! *Idea.* Each mean m is clamped to a box, and coded by whole numbers c of seven bits on a grid with the step s. Clamping brings no two
//! points further apart, so with the rounding errors e of m and of the probe z, |z − m| ≥ s·|c(z) − c(m)| − e(z) − e(m). The right side
//! costs one byte of memory for each coordinate, and proves that nearly all templates are farther than the best one found so far. For
//! the others the distance is calculated in double precision.
//! *Guarantee.* The answer is that of all distances in double precision, the lowest place of equal ones: the slacks below are more than
//! the rounding of these distances, of e and of the limit.
//! *Trap.* Where most templates are nearly at one distance of the probe, all distances are calculated: the answer is the same, later.

use super::screen::{BLOCK, CODE_MAX, GROUP, Visitor, screen};
use super::{Template, check_probe, distance, weight};
use crate::Error;

/// How many standard deviations of the widest coordinate the box reaches to each side.
const BOX_DEVIATIONS: f64 = 3.0;
/// The least step: squares of differences of this size do not underflow.
const STEP_MIN: f64 = 1e-100;
/// Relative slack for sums of [`super::DIM_MAX`] squares and the few operations after them: 520 roundings of 2⁻⁵³ are 5.8e-14.
const ROUNDING_SLACK: f64 = 1e-12;
/// Slack for a point of the grid, in sizes of the box's coordinates: three roundings of 2⁻⁵³ are 3.4e-16.
const GRID_SLACK: f64 = 1e-15;
/// One block of so many gives a first bound for the distance of the nearest template.
const SAMPLED_BLOCKS: usize = 32;

/// Templates in memory, as plain numbers, ready for searching.
#[derive(Clone, Debug)]
pub struct Index {
    dim: usize,
    /// Row after row.
    means: Vec<f32>,
    scans: Vec<u32>,
    grid: Grid,
    /// Block after block, coordinate after coordinate, padded with copies of the last template and with coordinates of 0.
    codes: Vec<u8>,
    blocks: Vec<BlockBound>,
}

/// The template that is nearest to a probe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Its place in the index, from 0.
    pub place: usize,
    /// Its [`Template::distance`].
    pub distance: f64,
}

/// Where the codes are points of the space.
#[derive(Clone, Debug)]
struct Grid {
    /// The lower corner of the box.
    low: Vec<f64>,
    step: f64,
    /// The slack for the rounding of a point of the grid.
    slack: f64,
}

/// What all templates of a block have.
#[derive(Clone, Copy, Debug)]
struct BlockBound {
    /// The largest distance of a clamped mean from its code.
    rounding: f64,
    /// The least weight.
    weight: f64,
}

impl Index {
    /// Takes templates; their places are those in the list.
    ///
    /// # Errors
    /// [`Error::Dimension`] where their dimensions differ.
    pub fn new(templates: &[Template]) -> Result<Self, Error> {
        let dim = templates.first().map_or(1, |first| first.mean().len());
        let mut means = Vec::with_capacity(templates.len() * dim);
        for template in templates {
            if template.mean().len() != dim {
                return Err(Error::Dimension { found: template.mean().len(), expected: dim });
            }
            means.extend_from_slice(template.mean());
        }
        Ok(Index::build(means, templates.iter().map(Template::scans).collect(), dim))
    }

    /// Takes the means of templates, row after row, and the numbers of their scans.
    ///
    /// # Errors
    /// Those of [`Template::from_parts`], and [`Error::LabelCount`] where the numbers of rows and of `scans` differ.
    pub fn from_parts(means: Vec<f32>, scans: Vec<u32>, dim: usize) -> Result<Self, Error> {
        if !(1..=super::DIM_MAX).contains(&dim) {
            return Err(Error::option("features", dim.to_string(), "from 1 to 512"));
        }
        if means.len() != scans.len().saturating_mul(dim) {
            return Err(Error::LabelCount { labels: scans.len(), points: means.len() / dim });
        }
        if let Some(bad) = scans.iter().find(|&scans| !(1..=super::SCANS_MAX).contains(scans)) {
            return Err(Error::option("scans", bad.to_string(), "from 1 to 1000"));
        }
        if !means.iter().all(|x| x.is_finite()) {
            return Err(Error::Overflow);
        }
        Ok(Index::build(means, scans, dim))
    }

    fn build(means: Vec<f32>, scans: Vec<u32>, dim: usize) -> Self {
        let grid = Grid::of(&means, dim);
        let padded = dim.next_multiple_of(GROUP);
        let count = scans.len().div_ceil(BLOCK);
        let mut codes = vec![0; count * padded * BLOCK];
        let mut blocks = Vec::with_capacity(count);
        for (number, codes) in codes.chunks_exact_mut(padded * BLOCK).enumerate() {
            let mut bound = BlockBound { rounding: 0.0, weight: f64::INFINITY };
            for lane in 0..BLOCK {
                let place = (number * BLOCK + lane).min(scans.len() - 1);
                let mean = &means[place * dim..(place + 1) * dim];
                let rounding = grid.code(mean.iter().map(|&x| f64::from(x)), |j, code| {
                    codes[j * BLOCK + lane] = code
                });
                bound.rounding = bound.rounding.max(rounding);
                bound.weight = bound.weight.min(weight(scans[place]));
            }
            blocks.push(bound);
        }
        Index { dim, means, scans, grid, codes, blocks }
    }

    /// The number of templates.
    pub fn len(&self) -> usize {
        self.scans.len()
    }

    /// Whether there are no templates.
    pub fn is_empty(&self) -> bool {
        self.scans.is_empty()
    }

    /// Finds the template with the least distance from a mapped probe, the first of equal ones; none where that is more than `limit`.
    ///
    /// # Errors
    /// [`Error::Dimension`], and [`Error::Input`] for a probe with NaN or infinities and for a limit of NaN.
    pub fn nearest(&self, probe: &[f64], limit: f64) -> Result<Option<Nearest>, Error> {
        if limit.is_nan() {
            return Err(Error::option("limit", "NaN".to_owned(), "a number"));
        }
        if self.is_empty() {
            return Ok(None);
        }
        check_probe(probe, self.dim)?;
        let mut query = vec![0; self.dim.next_multiple_of(GROUP)];
        let rounding = self.grid.code(probe.iter().copied(), |j, code| query[j] = code);
        let mut sample = Sample { place: 0, sum: u32::MAX };
        screen(&self.codes, &query, SAMPLED_BLOCKS, &mut sample);
        let place = sample.place.min(self.len() - 1);
        let bound = self.distance(place, probe).min(limit);
        let mut search = Search { index: self, probe, rounding, bound, best: None };
        screen(&self.codes, &query, 1, &mut search);
        Ok(search.best)
    }

    fn distance(&self, place: usize, probe: &[f64]) -> f64 {
        let mean = &self.means[place * self.dim..(place + 1) * self.dim];
        distance(mean, weight(self.scans[place]), probe)
    }
}

impl Grid {
    /// A grid around the means of all coordinates.
    fn of(means: &[f32], dim: usize) -> Self {
        let rows = (means.len() / dim).max(1) as f64;
        let (mut centers, mut variances) = (vec![0.0; dim], vec![0.0; dim]);
        for row in means.chunks_exact(dim) {
            centers.iter_mut().zip(row).for_each(|(center, &x)| *center += f64::from(x) / rows);
        }
        for row in means.chunks_exact(dim) {
            for ((variance, &x), center) in variances.iter_mut().zip(row).zip(&centers) {
                let rest = f64::from(x) - center;
                *variance += rest * rest / rows;
            }
        }
        let deviation = variances.into_iter().fold(0.0, f64::max).sqrt();
        let step = (2.0 * BOX_DEVIATIONS * deviation / f64::from(CODE_MAX)).max(STEP_MIN);
        let low: Vec<f64> =
            centers.iter().map(|center| center - step * f64::from(CODE_MAX) / 2.0).collect();
        let size = low.iter().fold(0.0, |size: f64, low| size.max(low.abs()));
        let slack = (dim as f64).sqrt() * (size + step * f64::from(CODE_MAX)) * GRID_SLACK;
        Grid { low, step, slack }
    }

    /// Gives each coordinate of a point its code; returns a bound for the distance of the clamped point from the coded one.
    fn code(&self, point: impl Iterator<Item = f64>, mut put: impl FnMut(usize, u8)) -> f64 {
        let mut squares = 0.0;
        for (j, (x, &low)) in point.zip(&self.low).enumerate() {
            let clamped = x.clamp(low, low + self.step * f64::from(CODE_MAX));
            let code = ((clamped - low) / self.step).round().min(f64::from(CODE_MAX));
            let rest = clamped - (low + self.step * code);
            squares += rest * rest;
            // From 0 to 127.
            put(j, code as u8);
        }
        squares.sqrt() * (1.0 + ROUNDING_SLACK) + self.slack
    }
}

/// The template with the least sum of squares among some blocks.
struct Sample {
    place: usize,
    sum: u32,
}

impl Visitor for Sample {
    fn limit(&self, _: usize) -> u32 {
        self.sum
    }

    fn visit(&mut self, block: usize, sums: &[u32; BLOCK]) {
        for (lane, &sum) in sums.iter().enumerate() {
            if sum < self.sum {
                (self.place, self.sum) = (block * BLOCK + lane, sum);
            }
        }
    }
}

/// The search for the nearest template, in the order of places.
struct Search<'a> {
    index: &'a Index,
    probe: &'a [f64],
    /// A bound for the distance of the clamped probe from its code.
    rounding: f64,
    /// Larger distances are of no interest.
    bound: f64,
    best: Option<Nearest>,
}

impl Visitor for Search<'_> {
    /// A larger sum of squares proves that the distance is more than the bound.
    fn limit(&self, block: usize) -> u32 {
        let BlockBound { rounding, weight } = self.index.blocks[block];
        let reach =
            (self.bound / weight).sqrt() * (1.0 + ROUNDING_SLACK) + rounding + self.rounding;
        let steps = reach / self.index.grid.step;
        let squares = steps * steps * (1.0 + 10.0 * ROUNDING_SLACK);
        // Written so that NaN, of a bound below 0, excludes nothing here: no distance is within such a bound.
        match squares < f64::from(u32::MAX) {
            true => squares as u32,
            false => u32::MAX,
        }
    }

    fn visit(&mut self, block: usize, sums: &[u32; BLOCK]) {
        let limit = self.limit(block);
        for (lane, &sum) in sums.iter().enumerate() {
            let place = block * BLOCK + lane;
            if sum > limit || place >= self.index.len() {
                continue;
            }
            let distance = self.index.distance(place, self.probe);
            let is_better = match self.best {
                None => distance <= self.bound,
                Some(best) => distance < best.distance,
            };
            if is_better {
                self.best = Some(Nearest { place, distance });
                self.bound = distance;
            }
        }
    }
}
