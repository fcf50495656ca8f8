//! Searches where the squares of differences overflow or vanish.
//!
//! *Problem.* The square of 10¹⁵⁵ is infinite and that of 10⁻¹⁶³ is zero: points at different distances look equally near.
//! *Idea.* A squared distance is kept as one of three bands and a number: differences whose largest is huge, or tiny, are
//! scaled by 2⁻⁶⁰⁰, or 2⁶⁰⁰, before they are squared. A sum that belongs to the band beside is moved there, so that bands
//! and then numbers have the order of distances.
//! *Guarantee.* As of the other searches, for all finite coordinates: the smallest squared distance as calculated, to
//! rounding, and of several the lowest row.
//! *Trap.* A side is left out by a bound that may have been calculated in another band than the points behind it; it is
//! lowered by more than all roundings.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use taut_points::two_to;

use super::query::{Candidate, keep};
use super::{BUCKET_SIZE, IS_BUCKET, KdTree, Nearest, Node};
use crate::Probe;

/// A difference of so much or more is scaled down.
const DIFFERENCE_MAX: f64 = two_to(500);
/// A largest difference below that is scaled up.
const DIFFERENCE_MIN: f64 = two_to(-450);
/// Small differences are scaled by this.
const SCALE_UP: f64 = two_to(600);
/// Large differences are scaled by this, the inverse.
const SCALE_DOWN: f64 = two_to(-600);
/// More than what roundings make of a bound.
const BOUND_FACTOR: f64 = 1.0 - two_to(-40);

/// Tests whether the squares of differences of such coordinates are neither infinite nor too small to be exact to rounding: each
/// is zero, or between 2⁻⁴⁰⁰ and 2⁵⁰⁰, so that a difference is zero or more than 2⁻⁴⁵³.
#[inline(always)]
pub(super) fn is_plain<const D: usize>(place: [f64; D]) -> bool {
    place.iter().fold(true, |all, x| {
        all & ((x.abs() >= two_to(-400)) & (x.abs() <= DIFFERENCE_MAX) | (*x == 0.0))
    })
}

/// A squared distance: `scaled` · 2^(1200 · `band`), not negative. Bands beside 0 begin where 0 is safe no more.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Square {
    band: i8,
    /// The bits of the number, which have its order.
    scaled: u64,
}

impl Square {
    fn between<const D: usize>(p: [f64; D], q: [f64; D]) -> Self {
        let sum = |difference: &dyn Fn(usize) -> f64| {
            let first = difference(0) * difference(0);
            (1..D).fold(first, |sum, i| sum + difference(i) * difference(i))
        };
        let largest = (0..D).fold(0.0f64, |largest, i| largest.max((p[i] - q[i]).abs()));
        let (band, sum) = if largest >= DIFFERENCE_MAX {
            // Scaled first: the difference itself may be infinite.
            (1, sum(&|i| p[i] * SCALE_DOWN - q[i] * SCALE_DOWN))
        } else if largest < DIFFERENCE_MIN {
            (-1, sum(&|i| (p[i] - q[i]) * SCALE_UP))
        } else {
            (0, sum(&|i| p[i] - q[i]))
        };
        // 2⁻⁹⁰⁰ and 2¹⁰⁰⁰, the squares of the borders; scaling is exact there.
        let moves = match band {
            -1 => sum >= two_to(300),
            0 => sum >= two_to(1000),
            _ => false,
        };
        let (band, sum) =
            if moves { (band + 1, sum * SCALE_DOWN * SCALE_DOWN) } else { (band, sum) };
        Self { band, scaled: sum.to_bits() }
    }

    /// As a number, which may be infinite or zero where the distance is not.
    fn value(self) -> f64 {
        let scaled = f64::from_bits(self.scaled);
        match self.band {
            1 => scaled * SCALE_UP * SCALE_UP,
            0 => scaled,
            _ => scaled * SCALE_DOWN * SCALE_DOWN,
        }
    }

    fn lowered(self) -> Self {
        Self { scaled: (f64::from_bits(self.scaled) * BOUND_FACTOR).to_bits(), ..self }
    }
}

impl<const D: usize> KdTree<D> {
    /// The `k` points nearest to a place with any coordinates, by distance and then as `ties` says; none if a coordinate is
    /// not a number.
    pub(super) fn nearest_wide<F: Fn(u32, u32) -> Ordering + Copy, P: Probe>(
        &self,
        place: [f64; D],
        k: usize,
        ties: F,
        probe: &mut P,
    ) -> Vec<Nearest> {
        if k == 0 || self.len == 0 || place.iter().any(|x| x.is_nan()) {
            return Vec::new();
        }
        if place.iter().any(|x| x.is_infinite()) {
            // All are equally far.
            let mut rows: Vec<u32> = (0..self.len as u32).collect();
            rows.sort_unstable_by(|&a, &b| ties(a, b));
            return rows
                .into_iter()
                .take(k)
                .map(|row| Nearest { row, distance2: f64::INFINITY })
                .collect();
        }
        let (nodes, rows) = (self.nodes.words(), self.rows.words());
        let coordinates = self.coordinates.words();
        // The farthest on top.
        let mut found: BinaryHeap<Candidate<Square, F>> = BinaryHeap::new();
        // Sides, and the corner of each that is nearest to the place.
        let mut waiting = vec![(self.root, place)];
        while let Some((mut child, corner)) = waiting.pop() {
            let reach = found.peek().filter(|_| found.len() == k).map(|farthest| farthest.square);
            let too_far = |corner: [f64; D]| {
                reach.is_some_and(|reach| Square::between(place, corner).lowered() > reach)
            };
            if too_far(corner) {
                continue;
            }
            while child & IS_BUCKET == 0 {
                let at = child as usize;
                probe.read(&nodes[at..=at]);
                let node = Node::of_words(nodes[at]);
                let before = place[node.axis()] < node.split;
                let (near, far) =
                    if before { (node.left(), node.right) } else { (node.right, node.left()) };
                let mut beyond = corner;
                beyond[node.axis()] = node.split;
                if !too_far(beyond) {
                    waiting.push((far, beyond));
                }
                child = near;
            }
            let bucket = (child & !IS_BUCKET) as usize;
            let points = &coordinates[bucket * BUCKET_SIZE * D..][..BUCKET_SIZE * D];
            let rows = &rows[bucket * BUCKET_SIZE..][..BUCKET_SIZE];
            probe.read(points);
            probe.read(rows);
            for (i, &row) in rows.iter().enumerate().filter(|(_, row)| **row != u32::MAX) {
                let point = std::array::from_fn(|axis| points[axis * BUCKET_SIZE + i]);
                keep(&mut found, k, Candidate { square: Square::between(place, point), row, ties });
            }
        }
        let nearest = |c: Candidate<Square, F>| Nearest { row: c.row, distance2: c.square.value() };
        found.into_sorted_vec().into_iter().map(nearest).collect()
    }
}
