//! The refined neighborhood of a sample: a slab across the curve, turned until its samples are lowest, and their center.
//!
//! *Problem.* The slab has the sample in its middle and a width W; two lines across it enclose its samples in a rectangle. Turn it
//! by an angle in [−π/10, π/10] so that the rectangle is lowest; its center is s*.
//! *Idea.* The height at an angle is one pass over the samples that can be in the slab at all; the angles are π/100 apart. Which of them
//! is lowest is chance where heights differ by less than chance makes them differ: the height of m uniform samples falls short of
//! that of their band by a share of 2/(m + 1). So s* is the mean of the centers of all rectangles at most that much higher.
//! *Guarantee.* The height found is that of a rectangle tried, and at most W·π/200 above the least one.
//! *Trap.* The slab as printed is infinite and meets other parts of a closed curve: only samples of the coarse disk count. The center
//! of the lowest rectangle alone follows the noise, the more so the finer the angles: a seventh more error on the test curves.

use std::f64::consts::PI;

use super::disks::Sample;
use super::strip::Strip;

/// The slab turns by this much to either side, in radians.
const SLAB_TURN: f64 = PI / 10.0;
/// This many angles are tried to either side of the strip's own.
const ANGLES_PER_SIDE: i32 = 10;

/// The rectangle around the samples of the slab.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rectangle {
    /// Its height, along the slab.
    pub(super) height: f64,
    /// Its center, or the mean with those of others nearly as low, relative to the sample.
    pub(super) center: [f64; 2],
}

/// The lowest rectangle; `near` are the samples of the coarse disk.
pub(super) fn refined(near: &[Sample], strip: Strip, width: f64) -> Rectangle {
    let half = 0.5 * width;
    let ([x, y], (sin, cos)) = (strip.along, SLAB_TURN.sin_cos());
    let candidates = Candidates::of(near.iter().filter_map(|&(_, [dx, dy])| {
        // In the frame of the strip; those that are in no turned slab are left out, with a margin for rounding.
        let (u, v) = (x * dx + y * dy, x * dy - y * dx);
        (cos * u.abs() <= 1.000_001 * half + sin * v.abs()).then_some([u, v])
    }));
    let tried = (-ANGLES_PER_SIDE..=ANGLES_PER_SIDE).map(|k| {
        let angle = SLAB_TURN * f64::from(k) / f64::from(ANGLES_PER_SIDE);
        let (low, high) = candidates.enclose(half, angle);
        (angle, high - low, 0.5 * (low + high))
    });
    let tried: Vec<(f64, f64, f64)> = tried.collect();
    let lowest =
        tried.iter().min_by(|a, b| a.1.total_cmp(&b.1).then(a.0.abs().total_cmp(&b.0.abs())));
    let &(angle, height, _) = lowest.unwrap_or(&(0.0, 0.0, 0.0));
    let as_low = height * (1.0 + 2.0 / (candidates.count(half, angle) + 1) as f64);
    let (mut sum, mut count) = ([0.0; 2], 0u32);
    for &(angle, _, offset) in tried.iter().filter(|tried| tried.1 <= as_low) {
        // Along the normal of the turned strip, (−sin, cos) in its frame.
        let (sin, cos) = angle.sin_cos();
        sum = [sum[0] - sin * offset, sum[1] + cos * offset];
        count += 1;
    }
    let [u, v] = sum.map(|sum| sum / f64::from(count.max(1)));
    Rectangle { height, center: [x * u - y * v, y * u + x * v] }
}

/// Samples in groups of four, which vector instructions take at once. What is left of the last group is the sample in the middle.
struct Candidates {
    groups: Vec<([f64; 4], [f64; 4])>,
    samples: usize,
}

impl Candidates {
    fn of(samples: impl Iterator<Item = [f64; 2]>) -> Self {
        let (mut groups, mut count): (Vec<([f64; 4], [f64; 4])>, _) = (Vec::new(), 0);
        for (i, [u, v]) in samples.enumerate() {
            count = i + 1;
            if i % 4 == 0 {
                groups.push(([0.0; 4], [0.0; 4]));
            }
            if let Some((us, vs)) = groups.last_mut() {
                (us[i % 4], vs[i % 4]) = (u, v);
            }
        }
        Self { groups, samples: count }
    }

    /// How low and how high the samples reach in the slab turned by an angle.
    fn enclose(&self, half: f64, angle: f64) -> (f64, f64) {
        let (sin, cos) = angle.sin_cos();
        let (mut low, mut high) = ([0.0f64; 4], [0.0f64; 4]);
        for (us, vs) in &self.groups {
            for lane in 0..4 {
                let (u, v) = (us[lane], vs[lane]);
                let (along, across) = (cos * u + sin * v, cos * v - sin * u);
                // The sample in the middle is in the slab, at 0, which makes 0 neutral for the others.
                let across = if along.abs() <= half { across } else { 0.0 };
                low[lane] = if across < low[lane] { across } else { low[lane] };
                high[lane] = if across > high[lane] { across } else { high[lane] };
            }
        }
        (low.into_iter().fold(0.0, f64::min), high.into_iter().fold(0.0, f64::max))
    }

    /// How many samples are in the slab turned by an angle.
    fn count(&self, half: f64, angle: f64) -> usize {
        let (sin, cos) = angle.sin_cos();
        let places = self.groups.iter().flat_map(|(us, vs)| us.iter().zip(vs)).take(self.samples);
        places.filter(|&(u, v)| (cos * u + sin * v).abs() <= half).count()
    }
}
