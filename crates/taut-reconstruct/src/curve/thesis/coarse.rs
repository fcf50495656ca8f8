//! The coarse neighborhood of a sample: a disk in which the samples are flat.
//!
//! *Problem.* The smallest radius r, not less than that of the initial disk, with r / width(strip of the samples within r) ≥ ρ.
//! *Idea.* The width never falls as the disk grows. If the samples within r have width w, no radius below ρ·w will do: the
//! disk jumps there, and the hull of what it held is extended by what came in.
//! *Guarantee.* Exactly that radius; no step is too long, and the last one adds no width.
//! *Trap.* The whole curve is "flat" in a disk large enough. A disk that grew beyond the least feature size tells nothing about the
//! curve near the sample: then there is none.

use super::disks::Growing;
use super::strip::{Strip, least_strip, reduce_to_hull};

/// A coarse neighborhood.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Coarse {
    /// Its radius.
    pub(super) radius: f64,
    /// The strip of its samples.
    pub(super) strip: Strip,
}

/// The coarse neighborhood that grows from a radius `initial`, if its radius is at most `limit`.
pub(super) fn coarse(disk: &mut Growing<'_>, initial: f64, limit: f64, rho: f64) -> Option<Coarse> {
    let (mut radius, mut taken, mut hull) = (initial, 0, Vec::new());
    loop {
        let near = disk.within(radius);
        hull.extend(near[taken..].iter().map(|sample| sample.1));
        taken = near.len();
        reduce_to_hull(&mut hull);
        let strip = least_strip(&hull);
        let needed = rho * strip.width;
        if needed <= radius {
            return Some(Coarse { radius, strip });
        }
        radius = needed;
        if radius > limit {
            return None;
        }
    }
}
