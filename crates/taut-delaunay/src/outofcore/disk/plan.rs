//! How many leaves, from the memory that is allowed, and the bytes that will be needed.
//!
//! *Idea.* A part of the memory is set aside for what does not grow with a leaf. A third of the rest, and half of it in space, is
//! the largest leaf, whatever the number of threads, so that the tree, and with it every byte of the output, does not depend
//! on it; threads beyond those that leaves have room for wait. Leaves are no larger than fronts ask for, so that much memory
//! means many leaves at once. As a sample cuts unevenly they are planned smaller, by three standard deviations of the count of
//! a leaf, and what is larger yet is cut again.
//! *Measured.* Bytes a site: peak memory beside two leaves of uniform points at a time, example `outofcore`: 109 in the
//! plane (3·10⁷ points in 128 leaves), less than 330 in space.

use super::sample::SAMPLE_POINTS;
use crate::Error;
use crate::outofcore::tree::{FINE_LEVELS, LEVELS_MAX};
use taut_points::InputError;

/// Memory for the program, the stacks and small tables.
const BASE_BYTES: u64 = 16 << 20;

/// Least memory, beyond which there is no room for leaves.
pub(in crate::outofcore) const MEMORY_MIN: u64 = 64 << 20;

/// Leaves of the largest size that fit into memory at the same time, or more. (Measured in space, 10⁷ uniform points within 1 GiB:
/// 8 leaves, two at once, take 1.25 times the processor time of the build in memory.)
const fn leaves_at_once(d: usize) -> u64 {
    if d == 2 { LEAVES_AT_ONCE_MAX } else { 2 }
}

const LEAVES_AT_ONCE_MAX: u64 = 3;

/// Most points of a leaf where memory has room for more: fronts are then 1.1 % of the points in the plane and 5 % in space.
/// (Measured in the plane, 3·10⁶ uniform points: leaves of a fourth of the size take 6 % less processor time, as their arrays
/// stay in the cache and with the allocator. In space, 10⁷ uniform points: 8 leaves take 13 % less than 16, as half of the sites go up.)
const fn leaf_points_max(d: usize) -> u64 {
    if d == 2 { 1 << 18 } else { 1 << 21 }
}

/// Buckets beyond which leaves become larger instead: all are open at the same time, and systems allow 1024 files.
const BUCKETS_WANTED: u64 = 512;

/// Most buckets: each is a file that is written to.
const BUCKET_LEVELS_MAX: u32 = 12;

/// Bytes of a write buffer of one bucket and one thread, at least and at most.
const BUFFER_BYTES: [u64; 2] = [4 << 10, 128 << 10];

/// Peak bytes of memory for each site of a node.
pub(in crate::outofcore) const fn site_bytes(d: usize) -> u64 {
    if d == 2 { 128 } else { 350 }
}

/// Simplices for each site, times 100: those of uniform points.
const fn simplices_percent(d: usize) -> u64 {
    if d == 2 { 200 } else { 677 }
}

/// Least levels of a tree whose leaves hold at most so many points in all likelihood, with the medians of the sample as cuts: the
/// share of a leaf among 2^levels then has a standard deviation of √(2^levels/m) of itself for a sample of m points.
fn levels(points: u64, leaf_points: u64) -> u32 {
    let fits = |levels: u32| {
        let margin = 3.0 * ((1u64 << levels) as f64 / SAMPLE_POINTS as f64).sqrt();
        (points >> levels) as f64 <= leaf_points as f64 * (1.0 - margin.min(0.2))
    };
    (0..u64::BITS)
        .find(|&levels| levels == 0 && points <= leaf_points || fits(levels))
        .unwrap_or(u64::BITS)
}

/// What is done with so many points in so much memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DiskPlan {
    /// 2^levels buckets are written at first.
    pub levels: u32,
    /// Most points of a leaf.
    pub leaf_points: u64,
    /// Fronts side by side with more sites are triangulated below the root.
    pub merge_above: u64,
    /// Bytes of memory for nodes that run at the same time.
    pub node_budget: u64,
    /// Bytes of the write buffer of one bucket and one thread.
    pub buffer_bytes: u64,
    /// Bytes of a row in tiles and buckets: 4 up to 2³² points, else 8.
    pub row_bytes: u32,
    /// Bytes on the disk while points are distributed.
    pub bucket_bytes: u64,
    /// Bytes of all tiles, as for uniform points.
    pub output_bytes: u64,
}

impl DiskPlan {
    /// The plan for `points` points of dimension `d`, within `memory` bytes on `threads` threads.
    pub(in crate::outofcore) fn new(
        points: u64,
        d: usize,
        memory: u64,
        threads: usize,
    ) -> Result<Self, Error> {
        let refused = |expected| {
            let value = memory.to_string();
            Error::Input(InputError::Option { name: "memory", value, expected })
        };
        if memory < MEMORY_MIN {
            return Err(refused("at least 67108864, which is 64 MiB"));
        }
        let node_budget = memory - memory / 8 - BASE_BYTES;
        let wanted = leaf_points_max(d).max((points / BUCKETS_WANTED).saturating_mul(5) / 4);
        let leaf_points = (node_budget / leaves_at_once(d) / site_bytes(d)).min(wanted);
        let levels = levels(points, leaf_points);
        // All threads' buffers take at most a quarter of the memory; no node runs while points are distributed.
        let buffers = (threads as u64) << levels.min(LEVELS_MAX);
        let buffer_bytes = (memory / 4 / buffers).min(BUFFER_BYTES[1]);
        if levels > BUCKET_LEVELS_MAX || buffer_bytes < BUFFER_BYTES[0] {
            return Err(refused("more: so many points do not fit with fewer than 4096 buckets"));
        }
        let row_bytes = if points <= 1 << 32 { 4 } else { 8 };
        let record = 8 * d as u64 + u64::from(row_bytes);
        let simplex_words = 2 * (d as u64 + 1);
        let simplices = points.saturating_mul(simplices_percent(d)) / 100;
        Ok(Self {
            levels,
            leaf_points,
            merge_above: (points >> levels) / 4,
            node_budget,
            buffer_bytes,
            row_bytes,
            bucket_bytes: points.saturating_mul(record),
            output_bytes: simplices
                .saturating_mul(4 * simplex_words)
                // A tenth more: sites that two tiles have, links and fronts.
                .saturating_add(points.saturating_mul(record))
                / 10
                * 11,
        })
    }

    /// The levels of the router.
    pub(in crate::outofcore) fn router_levels(&self) -> u32 {
        self.levels + FINE_LEVELS
    }

    /// Bytes of free space to begin with. Buckets go as their tiles come, and a tile is larger than its bucket, so the end
    /// is the peak, but for the buckets of the last leaves.
    pub fn disk_bytes(&self) -> u64 {
        let leaf = self.bucket_bytes >> self.levels;
        let open = leaf.saturating_mul(LEAVES_AT_ONCE_MAX);
        self.bucket_bytes.max(self.output_bytes.saturating_add(open))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn leaves_fit_several_times_and_do_not_depend_on_threads() {
        for (points, d, memory) in [
            (100_000_000, 2, 512 << 20),
            (10_000_000, 3, 1 << 30),
            (1_000_000_000, 2, 1 << 30),
            (1_000_000_000, 2, 1 << 36),
        ] {
            let plan = DiskPlan::new(points, d, memory, 2).unwrap();
            assert!(
                leaves_at_once(d) * plan.leaf_points * site_bytes(d) <= memory - memory / 8,
                "{plan:?}"
            );
            assert!(points >> plan.levels < plan.leaf_points, "{plan:?}");
            let other = DiskPlan::new(points, d, memory, 8).unwrap();
            assert_eq!(
                (plan.levels, plan.merge_above, plan.leaf_points),
                (other.levels, other.merge_above, other.leaf_points)
            );
        }
        assert!(DiskPlan::new(10, 2, MEMORY_MIN - 1, 1).is_err());
        assert!(DiskPlan::new(u64::MAX, 3, 1 << 30, 1).is_err());
        assert_eq!(DiskPlan::new(0, 2, 1 << 30, 1).unwrap().levels, 0);
        let whole = DiskPlan::new(10, 2, 1 << 30, 1).unwrap().leaf_points;
        assert_eq!(DiskPlan::new(whole, 2, 1 << 30, 1).unwrap().levels, 0);
        assert_eq!(DiskPlan::new(whole + 1, 2, 1 << 30, 1).unwrap().levels, 1);
        // 2^9 leaves of 2^8 points of the sample each vary by 19 % at three standard deviations.
        assert_eq!((levels(400 << 10, 1 << 10), levels(430 << 10, 1 << 10)), (9, 10));
        assert_eq!(DiskPlan::new(1 << 33, 2, 1 << 36, 1).unwrap().row_bytes, 8);
    }
}
