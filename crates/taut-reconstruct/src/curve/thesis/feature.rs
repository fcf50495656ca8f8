//! The least local feature size, estimated from samples: the unit in which the formulas of the thesis hold.
//!
//! *Problem.* √radius(D) and W^(1/3) are lengths only if the least distance of the curve from its medial axis is 1. Nobody tells
//! that unit, and an answer must follow its input when that is scaled, turned or moved.
//! *Idea.* Around a sample the samples within r fill a strip of width w(r) = 2δ + r²/(2R) where the curve bends with radius R. The
//! flatness r/w is greatest at r = 2√(δR), where w = 4δ: there R = r²/w. Another part of the curve, at a distance of 2f, ends the
//! flatness as soon as r reaches it. So each look at a sample gives min(r²/w at the flattest r, half of the r at which the
//! samples are round); of probes at samples spread evenly over the order by radius(D), which turns with the input, a low quantile
//! is the estimate.
//! *Guarantee.* None. With it the method finds the test curves at δ = 1/144 of the true one (`bench curve theorem`); the option
//! `feature` replaces it.
//! *Trap.* Within r < δ samples are a round blob: roundness counts only after flatness. Where the noise is so large that a look never
//! becomes flat it says nothing, and an estimate from the other probes alone is too large.

use taut_points::{Monitor, OrderBy};

use super::disks::{Disks, Growing};
use super::strip::{least_strip, reduce_to_hull};
use super::{each, spread};
use crate::Error;

/// This many probes are taken; the estimate is their quantile 1/`QUANTILE_DIVISOR`.
const PROBE_COUNT: usize = 256;
const QUANTILE_DIVISOR: usize = 100;
/// Each disk of a look is so much larger than the one before.
const DISK_GROWTH: f64 = 1.15;
/// Samples are flat from this radius by width on: half of what δ = 1/144 gives, 1/(2√δ) = 6.
const FLATNESS_MIN: f64 = 3.0;
/// They are round below this; an arc as long as its radius has 2, two parallel lines a little more than 1.
const ROUNDNESS_MAX: f64 = 1.25;

/// The estimate; without a bend in sight it is the extent of the samples, and 0 only if there is none.
pub(super) fn least_feature(
    disks: &Disks<'_>,
    radii: &[f64],
    monitor: &Monitor<'_>,
) -> Result<f64, Error> {
    let n = radii.len();
    let extent = spread(disks.samples);
    let mut order: Vec<usize> = (0..n).collect();
    // In single precision: of two samples, each the K-th nearest of the other, rounding may put either first. They may be each other's
    // nearest, too, but then the next ones differ.
    order.order_by(&|&a, &b| {
        let nearest = |count| {
            let [a, b] = [a, b].map(|sample| disks.radius(sample, count) as f32);
            a.total_cmp(&b)
        };
        let first = (radii[a] as f32).total_cmp(&(radii[b] as f32));
        (2..=4).fold(first, |order, count| order.then_with(|| nearest(count)))
    });
    let probes: Vec<usize> = order.into_iter().step_by(n.div_ceil(PROBE_COUNT).max(1)).collect();
    let mut found =
        each(probes.len(), monitor, |i| probe(disks, probes[i], radii[probes[i]], extent))?;
    found.sort_by(f64::total_cmp);
    Ok(found.get(found.len() / QUANTILE_DIVISOR).copied().unwrap_or(0.0))
}

/// What one sample sees, in disks from a radius on.
fn probe(disks: &Disks<'_>, sample: usize, start: f64, extent: f64) -> f64 {
    let mut disk = Growing::around(disks, sample);
    // Beyond `start` lies a sample, and rounding may put it within or without.
    let (mut radius, mut taken, mut hull) = (DISK_GROWTH * start, 0, Vec::new());
    let (mut flattest, mut feature) = (0.0, extent);
    while radius > 0.0 && radius < 2.0 * extent {
        let near = disk.within(radius);
        hull.extend(near[taken..].iter().map(|sample| sample.1));
        taken = near.len();
        reduce_to_hull(&mut hull);
        let flatness = radius / least_strip(&hull).width;
        if flatness > flattest {
            (flattest, feature) = (flatness, (flatness * radius).min(extent));
        }
        if flattest >= FLATNESS_MIN && (flatness < ROUNDNESS_MAX || radius >= 2.0 * feature) {
            return feature.min(0.5 * radius);
        }
        radius *= DISK_GROWTH;
    }
    if flattest >= FLATNESS_MIN { feature } else { extent }
}
