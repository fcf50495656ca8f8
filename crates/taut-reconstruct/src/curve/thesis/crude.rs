//! The crude form of the method: coarse neighborhoods by eigenvectors, and a tour through their centers.
//!
//! *Problem.* As before, a disk around each sample in which the samples are flat; its center instead of a refined one.
//! *Idea.* Samples come in by distance and their moments are summed: with eigenvalues λ₁ ≥ λ₂ of the covariance matrix the disk is
//! flat where √(λ₁/λ₂) ≥ 2ρ. Samples evenly along 2r and across a width w have λ₁ = r²/3 and λ₂ = w²/12, so that this asks for
//! r/w ≥ ρ. The center is where the line through the mean, along the first eigenvector, comes nearest to the sample.
//! *Guarantee.* None: the mean of a bent stretch lies to one side. O(k log k) for a disk of k samples.
//! *Trap.* The text takes 1/√λ₁ for the width of the strip, which is none; and it says eigenvectors where it means eigenvalues.
//! Moments are of places relative to the sample, so that they are as good far from the origin.

use super::disks::Growing;

/// The center, relative to the sample, and twice the deviation across that noise of this size has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Crude {
    /// The center, relative to the sample.
    pub(super) center: [f64; 2],
    /// The height of a strip that evenly spread samples of the same λ₂ would fill: √(12·λ₂).
    pub(super) height: f64,
}

/// Sums over samples.
#[derive(Clone, Copy, Debug, Default)]
struct Moments {
    count: f64,
    first: [f64; 2],
    second: [f64; 3],
}

impl Moments {
    fn add(&mut self, [x, y]: [f64; 2]) {
        self.count += 1.0;
        self.first[0] += x;
        self.first[1] += y;
        self.second[0] += x * x;
        self.second[1] += x * y;
        self.second[2] += y * y;
    }

    /// Mean, eigenvalues of the covariance matrix, the larger first, and the unit vector of the first.
    fn axes(&self) -> ([f64; 2], [f64; 2], [f64; 2]) {
        let mean = self.first.map(|x| x / self.count);
        let xx = self.second[0] / self.count - mean[0] * mean[0];
        let xy = self.second[1] / self.count - mean[0] * mean[1];
        let yy = self.second[2] / self.count - mean[1] * mean[1];
        let (middle, apart) = (0.5 * (xx + yy), (0.5 * (xx - yy)).hypot(xy));
        let (sin, cos) = (0.5 * xy.atan2(0.5 * (xx - yy))).sin_cos();
        (mean, [middle + apart, (middle - apart).max(0.0)], [cos, sin])
    }
}

/// The center of the first flat disk that grows from a radius `initial`, if its radius is at most `limit`.
pub(super) fn crude(disk: &mut Growing<'_>, initial: f64, limit: f64, rho: f64) -> Option<Crude> {
    let (mut radius, mut taken, mut moments) = (initial, 0, Moments::default());
    loop {
        let near = disk.within(radius);
        let (mut next, before) = (taken, taken);
        while next < near.len() {
            moments.add(near[next].1);
            next += 1;
            // Those of the first disk come in together.
            if before == 0 && next < near.len() {
                continue;
            }
            let (mean, [most, least], [x, y]) = moments.axes();
            if most >= 4.0 * rho * rho * least {
                let offset = mean[1] * x - mean[0] * y;
                return Some(Crude {
                    center: [-y * offset, x * offset],
                    height: (12.0 * least).sqrt(),
                });
            }
        }
        taken = near.len();
        if radius >= limit {
            return None;
        }
        radius = (2.0 * radius).min(limit);
    }
}
