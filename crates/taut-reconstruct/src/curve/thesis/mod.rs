mod coarse;
mod disks;
mod feature;
mod pruning;
mod refined;
mod strip;

use rayon::prelude::*;
use taut_points::Monitor;

use super::answer::Outcome;
use super::clean;
use super::cloud::Cloud;
use super::{CurveMethod, CurveOptions};
use crate::Error;
use coarse::coarse;
use disks::{Disks, Growing};
use refined::refined;

/// What is known of a sample.
#[derive(Clone, Copy, Debug)]
struct Estimate {
    center: [f64; 2],
    width: f64,
    height: f64,
}

/// The curve through pruned centres.
pub(super) fn thesis(
    cloud: &Cloud,
    options: &CurveOptions,
    monitor: &Monitor<'_>,
) -> Result<Outcome, Error> {
    let scale = Scale::of(&cloud.sites);
    let samples = scale.down(&cloud.sites);
    let disks = Disks::over(&samples);
    let count = first_count(samples.len(), options.omega);
    let radii = first_radii(&disks, count, monitor)?;
    let unit = match options.feature {
        Some(feature) => scale.down_length(feature),
        None => feature::least(&samples, &radii, monitor)?,
    };
    let estimates = each(samples.len(), monitor, |s| {
        let initial = (radii[s] * unit).sqrt();
        if initial < radii[s] {
            return None;
        }
        let mut disk = Growing::around(&disks, s);
        let coarse = coarse(&mut disk, initial, initial.max(unit), options.rho)?;
        let width = (initial * unit).sqrt().min(coarse.radius / 3.0);
        let rectangle = refined(disk.within(coarse.radius), coarse.strip, width);
        let [x, y] = samples[s];
        let center = [x + rectangle.center[0], y + rectangle.center[1]];
        Some(Estimate { center, width, height: rectangle.height })
    })?;
    let outliers =
        (0u32..).zip(&estimates).filter(|(_, found)| found.is_none()).map(|(s, _)| s).collect();
    let estimates: Vec<Estimate> = estimates.into_iter().flatten().collect();
    let centers: Vec<[f64; 2]> = estimates.iter().map(|found| found.center).collect();
    let reach = |i: usize| (estimates[i].width * unit * unit).cbrt();
    let selected = pruning::select(&centers, |i| estimates[i].width, reach);
    monitor.check()?;
    let selected: Vec<[f64; 2]> = selected.into_iter().map(|i| centers[i]).collect();
    let mut outcome =
        clean::solve(&Cloud::of(&selected), CurveMethod::NnCrust, options.ends, monitor)?;
    let mut heights: Vec<f64> = estimates.iter().map(|found| found.height).collect();
    finish(&mut outcome, cloud, outliers, scale);
    outcome.method = options.method.name();
    outcome.noise = scale.up(0.5 * median(&mut heights));
    outcome.counters.insert("centers".into(), centers.len() as u64);
    outcome.counters.insert("centers_selected".into(), selected.len() as u64);
    Ok(outcome)
}

/// Back to the units of the input.
fn finish(outcome: &mut Outcome, cloud: &Cloud, outliers: Vec<u32>, scale: Scale) {
    for curve in &mut outcome.curves {
        curve.rows.clear();
        curve.vertices.iter_mut().flatten().for_each(|v| *v = scale.up(*v));
    }
    outcome.outliers =
        if outcome.curves.is_empty() { (0..cloud.sites.len() as u32).collect() } else { outliers };
}

/// K = ⌈(ln n)^(1 + ω)⌉, at least 2 and at most n.
fn first_count(n: usize, omega: f64) -> usize {
    let count = (n.max(1) as f64).ln().powf(1.0 + omega).ceil();
    (count as usize).max(2).min(n.max(1))
}

/// radius(D) of each sample.
fn first_radii(disks: &Disks<'_>, count: usize, monitor: &Monitor<'_>) -> Result<Vec<f64>, Error> {
    each(disks.samples.len(), monitor, |s| disks.radius(s, count))
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
        all.par_extend(block.into_par_iter().with_min_len(1 << 6).map(&of));
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
        Self { exponent: if largest > 0.0 { largest.log2().floor() as i32 } else { 0 } }
    }

    fn down(self, sites: &[[f64; 2]]) -> Vec<[f64; 2]> {
        sites.iter().map(|site| site.map(|x| self.down_length(x))).collect()
    }

    fn down_length(self, x: f64) -> f64 {
        times(x, -self.exponent)
    }

    fn up(self, x: f64) -> f64 {
        times(x, self.exponent)
    }
}

/// x·2ᵏ, in two steps as the factor itself may be out of range.
fn times(x: f64, k: i32) -> f64 {
    x * 2f64.powi(k / 2) * 2f64.powi(k - k / 2)
}
