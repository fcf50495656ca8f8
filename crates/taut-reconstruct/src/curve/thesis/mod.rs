//! Curves through noisy samples by the algorithm of the thesis, and by its crude form.
//!
//! *Problem.* Samples of disjoint smooth closed curves, each moved along the normal by at most δ; neither δ nor the curves are known.
//! *Idea.* (1) D holds s and K = ⌈(ln n)^(1+ω)⌉ samples around it, and initial(s) has radius √radius(D). (2) coarse(s) grows from it until
//! radius / width(strip(s)) ≥ ρ ([`coarse`]). (3) refined(s), a slab across it of width W = min(√radius(initial), radius(coarse)/3),
//! is turned until the rectangle around its samples is lowest; s* is the center of that ([`refined`]). (4) By decreasing W, each
//! center deletes those within W^(1/3) of it ([`pruning`]). (5) NN-Crust of the centers left.
//! *Guarantee.* For δ ≤ 1/(9ρ²) of the least local feature size and ρ ≥ 4: the curves are those sampled, and the answer tends to
//! them, with a probability that tends to 1 as n grows. No answer crosses itself.
//! *Trap.* Gaps of the text, and how they are closed: lengths are in units of the least local feature size, so that it is an option, or
//! estimated ([`feature`]); the slab keeps to samples of the coarse disk; a disk that does not hold D (samples too sparse for √ to
//! enlarge it), or that grew beyond the unit (it may then hold the whole curve and call it flat), is none, and its sample is set
//! aside as an outlier; edges that NN-Crust leaves crossing are repaired.
//! *Reference.* Section 4.1 of the thesis: Cheng, Funke, Golin, Kumar, Poon and Ramos, SCG 2003 and Computational Geometry 31, 2005.

mod coarse;
mod crude;
mod disks;
mod feature;
mod pruning;
mod refined;
mod strip;
#[cfg(test)]
mod tests;

use taut_points::parallel::IntoParallel;
use taut_points::{Monitor, exponent_of, times_two_to};

use super::answer::Outcome;
use super::cloud::Cloud;
use super::{CurveMethod, CurveOptions, CurveThesisOptions, clean, tour};
use crate::Error;
use coarse::coarse;
use crude::crude;
use disks::{Disks, Growing};
use refined::refined;

/// What is known of a sample.
#[derive(Clone, Copy, Debug)]
struct Estimate {
    /// s*.
    center: [f64; 2],
    /// W, the width of the slab; 0 in the crude form.
    width: f64,
    /// The height of the rectangle.
    height: f64,
    /// The distance of s from s*.
    way: f64,
}

/// The samples in units that are safe to square, the unit of the formulas, and the first disks.
struct Start {
    scale: Scale,
    samples: Vec<[f64; 2]>,
    unit: f64,
    /// radius(initial(s)), where that disk holds D.
    initial: Vec<Option<f64>>,
}

impl Start {
    fn of(cloud: &Cloud, how: &CurveThesisOptions, monitor: &Monitor<'_>) -> Result<Self, Error> {
        let scale = Scale::of(&cloud.sites);
        let samples: Vec<[f64; 2]> =
            cloud.sites.iter().map(|site| site.map(|x| scale.down(x))).collect();
        let disks = Disks::over(&samples);
        let count = first_count(samples.len(), how.omega);
        let radii = each(samples.len(), monitor, |s| disks.radius(s, count))?;
        let unit = match how.feature {
            Some(feature) => scale.down(feature),
            None => feature::least_feature(&disks, &radii, monitor)?,
        };
        let initial = radii.iter().map(|radius| {
            let initial = (radius * unit).sqrt();
            (initial >= *radius).then_some(initial)
        });
        Ok(Self { scale, initial: initial.collect(), unit, samples })
    }

    /// For each sample with a first disk, the center and the height that something makes of it; the others are outliers.
    fn estimates(
        &self,
        monitor: &Monitor<'_>,
        of: impl Fn(&mut Growing<'_>, f64) -> Option<Estimate> + Sync,
    ) -> Result<(Vec<Estimate>, Vec<u32>), Error> {
        let disks = Disks::over(&self.samples);
        let found = each(self.samples.len(), monitor, |s| {
            let found = of(&mut Growing::around(&disks, s), self.initial[s]?)?;
            let ([x, y], [dx, dy]) = (self.samples[s], found.center);
            Some(Estimate { center: [x + dx, y + dy], way: dx.hypot(dy), ..found })
        })?;
        let outliers = (0u32..).zip(&found).filter(|(_, found)| found.is_none());
        let outliers = outliers.map(|(s, _)| s).collect();
        Ok((found.into_iter().flatten().collect(), outliers))
    }

    /// Centers in the units of the input.
    fn up(&self, estimates: &[Estimate]) -> Vec<[f64; 2]> {
        estimates.iter().map(|found| found.center.map(|x| self.scale.up(x))).collect()
    }

    /// The outcome of what was made of the centers.
    fn finish(
        &self,
        mut outcome: Outcome,
        estimates: &[Estimate],
        outliers: Vec<u32>,
        method: CurveMethod,
    ) -> Outcome {
        outcome.curves.iter_mut().for_each(|curve| curve.rows.clear());
        let all = || (0..self.samples.len() as u32).collect();
        outcome.outliers = if outcome.curves.is_empty() { all() } else { outliers };
        let mut heights: Vec<f64> = estimates.iter().map(|found| found.height).collect();
        outcome.noise = self.scale.up(0.5 * median(&mut heights));
        outcome.method = method.name();
        // Why samples have no center: their first disk is larger than the formulas enlarge it to, or no disk was flat.
        let sparse = self.initial.iter().filter(|initial| initial.is_none()).count();
        let other = self.samples.len() - estimates.len() - sparse;
        let counters = [
            ("centers", estimates.len()),
            ("samples_too_sparse", sparse),
            ("samples_not_flat", other),
        ];
        let counters = counters.map(|(name, count)| (name.to_owned(), count as u64));
        outcome.counters.extend(counters);
        outcome
    }
}

/// The curve through pruned centers.
pub(super) fn thesis(
    cloud: &Cloud,
    how: &CurveThesisOptions,
    options: &CurveOptions<'_>,
    monitor: &Monitor<'_>,
) -> Result<Outcome, Error> {
    let start = Start::of(cloud, how, monitor)?;
    let unit = start.unit;
    let (estimates, outliers) = start.estimates(monitor, |disk, initial| {
        let coarse = coarse(disk, initial, initial.max(unit), how.rho)?;
        let width = (initial * unit).sqrt().min(coarse.radius / 3.0);
        let rectangle = refined(disk.within(coarse.radius), coarse.strip, width);
        Some(Estimate { center: rectangle.center, width, height: rectangle.height, way: 0.0 })
    })?;
    let centers: Vec<[f64; 2]> = estimates.iter().map(|found| found.center).collect();
    let reach = |i: usize| (estimates[i].width * unit * unit).cbrt();
    let selected = pruning::select(
        &centers,
        |i| {
            let found = &estimates[i];
            [found.width, found.height, found.way]
        },
        reach,
    );
    monitor.check()?;
    let selected: Vec<Estimate> = selected.into_iter().map(|i| estimates[i]).collect();
    let left = Cloud::of(&start.up(&selected));
    let outcome = clean::solve(&left, CurveMethod::NnCrust, options.ends, monitor)?;
    let mut outcome = start.finish(outcome, &estimates, outliers, options.method);
    outcome.counters.insert("centers_selected".into(), selected.len() as u64);
    Ok(outcome)
}

/// The tour through all crude centers.
pub(super) fn thesis_crude(
    cloud: &Cloud,
    how: &CurveThesisOptions,
    options: &CurveOptions<'_>,
    monitor: &Monitor<'_>,
) -> Result<Outcome, Error> {
    let start = Start::of(cloud, how, monitor)?;
    let (estimates, outliers) = start.estimates(monitor, |disk, initial| {
        let found = crude(disk, initial, initial.max(start.unit), how.rho)?;
        Some(Estimate { center: found.center, width: 0.0, height: found.height, way: 0.0 })
    })?;
    let mut outcome = tour::tour(&Cloud::of(&start.up(&estimates)), options, monitor)?;
    // The bound is about tours of centers, which are no rows: nobody could check it.
    outcome.tour = None;
    Ok(start.finish(outcome, &estimates, outliers, options.method))
}

/// K + 1 for K = ⌈(ln n)^(1 + ω)⌉: a sample counts among those around it. At least 2 and at most n.
fn first_count(n: usize, omega: f64) -> usize {
    let count = (n.max(1) as f64).ln().powf(1.0 + omega).ceil();
    (count as usize).saturating_add(1).max(2).min(n.max(1))
}

/// The diagonal of the box around points.
fn spread(points: &[[f64; 2]]) -> f64 {
    let mut sides = [0, 1].map(|k| {
        let of = points.iter().map(|p| p[k]);
        of.clone().fold(f64::NEG_INFINITY, f64::max) - of.fold(f64::INFINITY, f64::min)
    });
    sides.iter_mut().for_each(|side| *side = side.max(0.0));
    sides[0].hypot(sides[1])
}

/// Samples between two looks at the monitor.
const BLOCK: usize = 1 << 14;

/// Something for each of n samples, by all threads.
fn each<T: Send>(
    n: usize,
    monitor: &Monitor<'_>,
    of: impl Fn(usize) -> T + Sync,
) -> Result<Vec<T>, Error> {
    let mut all = Vec::with_capacity(n);
    for start in (0..n).step_by(BLOCK) {
        monitor.check()?;
        let block = start..n.min(start + BLOCK);
        all.append(&mut block.into_par_iter().with_min_len(1 << 6).map(&of).collect());
    }
    Ok(all)
}

fn median(values: &mut [f64]) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// A power of two by which coordinates are divided, so that the largest is near 1 and squares neither overflow nor vanish.
#[derive(Clone, Copy, Debug)]
struct Scale {
    exponent: i32,
}

impl Scale {
    fn of(sites: &[[f64; 2]]) -> Self {
        let largest = sites.as_flattened().iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        Self { exponent: if largest > 0.0 { exponent_of(largest) } else { 0 } }
    }

    fn down(self, x: f64) -> f64 {
        times_two_to(x, -self.exponent)
    }

    fn up(self, x: f64) -> f64 {
        times_two_to(x, self.exponent)
    }
}
