//! The refined neighbourhood of a sample: a slab across the curve, turned until its samples are lowest, and their centre.
//!
//! *Problem.* The slab has the sample in its middle and a width W; two lines across it enclose its samples in a rectangle. Turn it
//! by an angle in [−π/10, π/10] so that the rectangle is lowest; its centre is s*.
//! *Idea.* The height at an angle is one pass over the samples that can be in the slab at all; the angles are π/40 apart. An angle
//! wrong by dθ changes the height by at most W·dθ, and moves the centre, as the sample is in the middle, along the curve only.
//! *Guarantee.* The height found is that of the rectangle told, and at most W·π/80 above the least one.
//! *Trap.* The slab as printed is infinite and meets other parts of a closed curve: only samples of the coarse disk count. Angles
//! finer than these follow the noise: to a 10 000th of a radian the centres on a circle are a quarter worse.

use std::f64::consts::PI;

use super::disks::Sample;
use super::strip::Strip;

/// The slab turns by this much to either side.
const TURN: f64 = PI / 10.0;
/// Angles to either side of the strip's own.
const ANGLES: i32 = 4;

/// The rectangle around the samples of the slab.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rectangle {
    /// Its height, along the slab.
    pub(super) height: f64,
    /// Its centre, relative to the sample.
    pub(super) center: [f64; 2],
}

/// The lowest rectangle; `near` are the samples of the coarse disk.
pub(super) fn refined(near: &[Sample], strip: Strip, width: f64) -> Rectangle {
    let half = 0.5 * width;
    let ([x, y], (sin, cos)) = (strip.along, TURN.sin_cos());
    let candidates = Candidates::of(near.iter().filter_map(|&(_, [dx, dy])| {
        // In the frame of the strip; those that are in no turned slab are left out, with a margin for rounding.
        let (u, v) = (x * dx + y * dy, x * dy - y * dx);
        (cos * u.abs() <= 1.000_001 * half + sin * v.abs()).then_some([u, v])
    }));
    let (mut best_angle, mut least) = (0.0, candidates.enclose(half, 0.0));
    for k in (1..=ANGLES).flat_map(|k| [-k, k]) {
        let angle = TURN * f64::from(k) / f64::from(ANGLES);
        let found = candidates.enclose(half, angle);
        if found.1 - found.0 < least.1 - least.0 {
            (best_angle, least) = (angle, found);
        }
    }
    let (sin, cos) = best_angle.sin_cos();
    // The normal of the turned strip: the strip's own is (−y, x).
    let offset = 0.5 * (least.0 + least.1);
    let [u, v] = [-sin * offset, cos * offset];
    Rectangle { height: least.1 - least.0, center: [x * u - y * v, y * u + x * v] }
}

/// Samples in groups of four, which vector instructions take at once. What is left of the last group is the sample in the middle.
struct Candidates(Vec<([f64; 4], [f64; 4])>);

impl Candidates {
    fn of(samples: impl Iterator<Item = [f64; 2]>) -> Self {
        let mut groups: Vec<([f64; 4], [f64; 4])> = Vec::new();
        for (i, [u, v]) in samples.enumerate() {
            if i % 4 == 0 {
                groups.push(([0.0; 4], [0.0; 4]));
            }
            if let Some((us, vs)) = groups.last_mut() {
                (us[i % 4], vs[i % 4]) = (u, v);
            }
        }
        Self(groups)
    }

    /// How low and how high the samples reach in the slab turned by an angle.
    fn enclose(&self, half: f64, angle: f64) -> (f64, f64) {
        let (sin, cos) = angle.sin_cos();
        let (mut low, mut high) = ([0.0f64; 4], [0.0f64; 4]);
        for (us, vs) in &self.0 {
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
}
