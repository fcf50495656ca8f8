//! Searches of a kd-tree.
//!
//! Idea: down to the bucket of the place first, keeping the other sides with the distances, axis by axis, from the place
//! to them; then those sides that are not farther than the nearest point so far. Their buckets are far apart in memory, so
//! several are asked for before the first of them is looked at: walking down to them needs no points.
//! Guarantee: the smallest squared distance as calculated, ((x² + y²) + z²) of differences in `f64`, and of several the
//! lowest row. The distance to a side is calculated in the same order from differences that are not larger, and rounding
//! is monotone; so no side is left out that holds a point as near. Coordinates whose squares overflow or vanish are left
//! to `wide`.
//! Trap: distances that are kept up to date by adding and subtracting squares are not monotone: they can exceed that of a
//! point behind the side by a rounding.

use std::array::from_fn;
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::hint::select_unpredictable;

use taut_points::parallel::ParallelSlice;

use super::wide::is_plain;
use super::{BUCKET_SIZE, IS_BUCKET, KdTree, Node};
use crate::level::{Level, prefetch};
use crate::{NoProbe, Probe, hilbert_order};

/// A point found near a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// The row of the point.
    pub row: u32,
    /// The square of its distance from the place; infinite beyond 10³⁰⁸, and rounded or zero below 10⁻³⁰⁸.
    pub distance2: f64,
}

/// Coordinates worked on at once.
const LANES: usize = 8;
/// Other sides that can wait: one a level, and no more levels than bits of a row.
const DEPTH_MAX: usize = 32;
/// This many buckets are asked for before the first of them is looked at: with the reach that the first bucket of all
/// gave, two or three more are near enough on average.
const BUCKETS_AHEAD: usize = 8;
/// Up to this many nearest points are kept in order; more are kept in a heap.
const ORDERED_LIST_MAX: usize = 64;
/// Places that one task of [`KdTree::nearest_all`] searches for.
const TASK: usize = 1 << 12;

/// A side that may hold nearer points.
#[derive(Clone, Copy)]
struct Side<const D: usize> {
    child: u32,
    /// Squared distance from the place.
    distance2: f64,
    /// Its distance along each axis.
    offsets: [f64; D],
}

/// The points that a search keeps.
trait NearestSet {
    /// The largest squared distance at which a point may still count.
    fn reach(&self) -> f64;

    /// Receives the squared distances and rows of a bucket.
    fn offer(&mut self, distances: &[[f64; LANES]; BUCKET_SIZE / LANES], rows: &[u32; BUCKET_SIZE]);
}

/// The nearest point so far.
struct NearestOne(Nearest);

impl NearestSet for NearestOne {
    #[inline(always)]
    fn reach(&self) -> f64 {
        self.0.distance2
    }

    #[inline(always)]
    fn offer(
        &mut self,
        distances: &[[f64; LANES]; BUCKET_SIZE / LANES],
        rows: &[u32; BUCKET_SIZE],
    ) {
        let mut least = [f64::INFINITY; LANES];
        for lane in distances {
            for i in 0..LANES {
                least[i] = if lane[i] < least[i] { lane[i] } else { least[i] };
            }
        }
        // Most buckets hold nothing nearer, which one comparison of all lanes tells.
        if !least.iter().fold(false, |any, &d| any | (d <= self.0.distance2)) {
            return;
        }
        for half in [LANES / 2, LANES / 4, LANES / 8] {
            for i in 0..half {
                least[i] = if least[i + half] < least[i] { least[i + half] } else { least[i] };
            }
        }
        let least = least[0];
        let all = distances.as_flattened().iter().zip(rows);
        let row = all.filter(|&(&d, _)| d == least).fold(u32::MAX, |a, (_, &row)| a.min(row));
        if least < self.0.distance2 || row < self.0.row {
            self.0 = Nearest { row, distance2: least };
        }
    }
}

/// The k nearest points so far, the farthest on top.
struct NearestHeap<F> {
    heap: BinaryHeap<Candidate<u64, F>>,
    k: usize,
    ties: F,
}

/// A point that may be among the nearest: a squared distance as something of the same order, the row, and the order of
/// rows that are equally far.
#[derive(Clone, Copy)]
pub(super) struct Candidate<S, F> {
    pub(super) square: S,
    pub(super) row: u32,
    pub(super) ties: F,
}

impl<S: Ord, F: Fn(u32, u32) -> Ordering> Ord for Candidate<S, F> {
    #[inline(always)]
    fn cmp(&self, other: &Self) -> Ordering {
        self.square.cmp(&other.square).then_with(|| (self.ties)(self.row, other.row))
    }
}

impl<S: Ord, F: Fn(u32, u32) -> Ordering> PartialOrd for Candidate<S, F> {
    #[inline(always)]
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<S: Ord, F: Fn(u32, u32) -> Ordering> PartialEq for Candidate<S, F> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl<S: Ord, F: Fn(u32, u32) -> Ordering> Eq for Candidate<S, F> {}

/// Takes a candidate among the k least.
#[inline(always)]
pub(super) fn keep<S: Ord, F: Fn(u32, u32) -> Ordering>(
    heap: &mut BinaryHeap<Candidate<S, F>>,
    k: usize,
    candidate: Candidate<S, F>,
) {
    if heap.len() < k {
        heap.push(candidate);
    } else if let Some(mut farthest) = heap.peek_mut()
        && candidate < *farthest
    {
        *farthest = candidate;
    }
}

impl<F: Fn(u32, u32) -> Ordering + Copy> NearestSet for NearestHeap<F> {
    #[inline(always)]
    fn reach(&self) -> f64 {
        match self.heap.peek() {
            Some(farthest) if self.heap.len() == self.k => f64::from_bits(farthest.square),
            _ => f64::INFINITY,
        }
    }

    #[inline(always)]
    fn offer(
        &mut self,
        distances: &[[f64; LANES]; BUCKET_SIZE / LANES],
        rows: &[u32; BUCKET_SIZE],
    ) {
        for (distance2, row) in within(self.reach(), distances, rows) {
            if distance2 <= self.reach() {
                let candidate = Candidate { square: distance2.to_bits(), row, ties: self.ties };
                keep(&mut self.heap, self.k, candidate);
            }
        }
    }
}

/// The k nearest points so far, where these are few: in order, which costs less than a heap up to [`ORDERED_LIST_MAX`].
struct NearestList<F> {
    /// Squared distances as bits, which have their order, and rows.
    found: Vec<(u64, u32)>,
    k: usize,
    ties: F,
}

impl<F: Fn(u32, u32) -> Ordering + Copy> NearestSet for NearestList<F> {
    #[inline(always)]
    fn reach(&self) -> f64 {
        self.found.get(self.k - 1).map_or(f64::INFINITY, |&(bits, _)| f64::from_bits(bits))
    }

    #[inline(always)]
    fn offer(
        &mut self,
        distances: &[[f64; LANES]; BUCKET_SIZE / LANES],
        rows: &[u32; BUCKET_SIZE],
    ) {
        for (distance2, row) in within(self.reach(), distances, rows) {
            let bits = distance2.to_bits();
            let mut place = self.found.partition_point(|&(other, _)| other < bits);
            let is_before = |&&(other, its): &&(u64, u32)| {
                other == bits && (self.ties)(its, row) == Ordering::Less
            };
            place += self.found[place..].iter().take_while(is_before).count();
            if place < self.k {
                self.found.truncate(self.k - 1);
                self.found.insert(place, (bits, row));
            }
        }
    }
}

/// The points of a bucket that are not farther than a reach. All are compared at once, as most are too far.
#[inline(always)]
fn within(
    reach: f64,
    distances: &[[f64; LANES]; BUCKET_SIZE / LANES],
    rows: &[u32; BUCKET_SIZE],
) -> impl Iterator<Item = (f64, u32)> {
    let distances = distances.as_flattened();
    let bit = |(i, &distance2): (usize, &f64)| u32::from(distance2 <= reach) << i;
    let mut near = distances.iter().enumerate().map(bit).fold(0, |all, bit| all | bit);
    let next = move || {
        let i = near.trailing_zeros() as usize;
        near &= near.wrapping_sub(1);
        (i < BUCKET_SIZE).then(|| (distances[i], rows[i]))
    };
    // Where there is no point, the distance is infinite.
    std::iter::from_fn(next).filter(|&(_, row)| row != u32::MAX)
}

impl<const D: usize> KdTree<D> {
    /// The point nearest to `place`, of several equally near the one of the lowest row; none if there are no points, or a
    /// coordinate of `place` is not a number. O(log n) on average for points in general position.
    pub fn nearest(&self, place: [f64; D]) -> Option<Nearest> {
        self.nearest_instrumented(place, &mut NoProbe)
    }

    /// [`KdTree::nearest`], recorded by a probe.
    pub fn nearest_instrumented<P: Probe>(
        &self,
        place: [f64; D],
        probe: &mut P,
    ) -> Option<Nearest> {
        if !(self.plain && is_plain(place)) {
            return self.nearest_wide(place, 1, |a, b| a.cmp(&b), probe).first().copied();
        }
        let mut found = NearestOne(Nearest { row: u32::MAX, distance2: f64::INFINITY });
        self.search(Level::best(), place, &mut found, probe);
        (found.0.row != u32::MAX).then_some(found.0)
    }

    /// The `k` points nearest to `place`, or all if there are fewer, by distance and then by row.
    pub fn nearest_k(&self, place: [f64; D], k: usize) -> Vec<Nearest> {
        self.nearest_k_instrumented(place, k, &mut NoProbe)
    }

    /// [`KdTree::nearest_k`], recorded by a probe.
    pub fn nearest_k_instrumented<P: Probe>(
        &self,
        place: [f64; D],
        k: usize,
        probe: &mut P,
    ) -> Vec<Nearest> {
        self.several(place, k, |a, b| a.cmp(&b), probe)
    }

    /// The `k` points nearest to `place`, by distance and then by an order of rows of one's own, which has to be total: by
    /// the coordinates of the points, say, so that what is found does not depend on how they are numbered. It is asked
    /// only where distances are equal.
    ///
    /// ```
    /// use taut_oblivious::kdtree::KdTree;
    /// let points = [[2.0f64, 0.0], [1.0, 1.0], [0.0, 0.0]];
    /// let by_place = |a: u32, b: u32| points[a as usize][0].total_cmp(&points[b as usize][0]);
    /// let found = KdTree::new(&points)?.nearest_k_by([1.0, 0.0], 2, by_place);
    /// assert_eq!([found[0].row, found[1].row], [2, 1]);         // all are equally far
    /// # Ok::<(), taut_oblivious::Error>(())
    /// ```
    pub fn nearest_k_by(
        &self,
        place: [f64; D],
        k: usize,
        ties: impl Fn(u32, u32) -> Ordering,
    ) -> Vec<Nearest> {
        self.several(place, k, &ties, &mut NoProbe)
    }

    fn several<F: Fn(u32, u32) -> Ordering + Copy, P: Probe>(
        &self,
        place: [f64; D],
        k: usize,
        ties: F,
        probe: &mut P,
    ) -> Vec<Nearest> {
        if k == 0 {
            return Vec::new();
        }
        if !(self.plain && is_plain(place)) {
            return self.nearest_wide(place, k, ties, probe);
        }
        if k <= ORDERED_LIST_MAX {
            let mut few = NearestList { found: Vec::with_capacity(k), k, ties };
            self.search(Level::best(), place, &mut few, probe);
            let nearest =
                |(bits, row): (u64, u32)| Nearest { row, distance2: f64::from_bits(bits) };
            return few.found.into_iter().map(nearest).collect();
        }
        let heap = BinaryHeap::with_capacity(k.min(self.len));
        let mut found = NearestHeap { heap, k, ties };
        self.search(Level::best(), place, &mut found, probe);
        let sorted = found.heap.into_sorted_vec().into_iter();
        let nearest =
            |c: Candidate<u64, F>| Nearest { row: c.row, distance2: f64::from_bits(c.square) };
        sorted.map(nearest).collect()
    }

    /// [`KdTree::nearest`] of many places, on the current rayon pool. The places are searched for along a Hilbert curve,
    /// so that each search finds what it needs where the one before it was.
    pub fn nearest_all(&self, places: &[[f64; D]]) -> Vec<Option<Nearest>> {
        let order = hilbert_order(places.len(), |i| places[i]);
        let parts: Vec<Vec<Option<Nearest>>> = order
            .par_chunks(TASK)
            .map(|part| part.iter().map(|&i| self.nearest(places[i as usize])).collect())
            .collect();
        let mut found = vec![None; places.len()];
        for (&i, &nearest) in order.iter().zip(parts.iter().flatten()) {
            found[i as usize] = nearest;
        }
        found
    }

    /// Tells a probe of the arrays; once, ahead of the first instrumented call.
    pub fn place<P: Probe>(&self, probe: &mut P) {
        probe.place(self.nodes.words());
        probe.place(self.coordinates.words());
        probe.place(self.rows.words());
    }

    /// Runs a search with the instructions of a level.
    #[allow(unsafe_code, reason = "dispatch of a vector kernel")]
    #[inline]
    fn search<F: NearestSet, P: Probe>(
        &self,
        level: Level,
        place: [f64; D],
        found: &mut F,
        probe: &mut P,
    ) {
        match level {
            #[cfg(target_arch = "x86_64")]
            Level::Avx512(_) => {
                // SAFETY: the value proves that the processor has AVX-512F.
                unsafe { self.search_avx512(place, found, probe) }
            }
            #[cfg(target_arch = "x86_64")]
            Level::Avx2(_) => {
                // SAFETY: the value proves that the processor has AVX2.
                unsafe { self.search_avx2(place, found, probe) }
            }
            _ => self.search_by(place, found, probe),
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx512f")]
    fn search_avx512<F: NearestSet, P: Probe>(
        &self,
        place: [f64; D],
        found: &mut F,
        probe: &mut P,
    ) {
        self.search_by(place, found, probe);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn search_avx2<F: NearestSet, P: Probe>(&self, place: [f64; D], found: &mut F, probe: &mut P) {
        self.search_by(place, found, probe);
    }

    #[inline(always)]
    fn search_by<F: NearestSet, P: Probe>(&self, place: [f64; D], found: &mut F, probe: &mut P) {
        if self.len == 0 {
            return;
        }
        let nodes = self.nodes.words();
        let (coordinates, rows) = (self.coordinates.words(), self.rows.words());
        let start = Side { child: self.root, distance2: 0.0, offsets: [0.0; D] };
        let mut waiting = [start; DEPTH_MAX];
        let (mut count, mut side) = (0, start);
        // Buckets on their way from memory, and their squared distances.
        let mut asked = [(0, 0.0); BUCKETS_AHEAD];
        let mut ahead = 0;
        loop {
            while side.child & IS_BUCKET == 0 {
                let at = side.child as usize;
                probe.read(&nodes[at..=at]);
                let node = Node::of_words(nodes[at]);
                let axis = node.axis();
                let ahead = place[axis] - node.split;
                let before = ahead < 0.0;
                let far = select_unpredictable(before, node.right, node.left());
                // Chosen, not written to one place of: that would have to reach memory before all are read.
                let offsets = from_fn(|i| select_unpredictable(i == axis, ahead, side.offsets[i]));
                let distance2 = length2(offsets);
                if distance2 <= found.reach() {
                    waiting[count] = Side { child: far, distance2, offsets };
                    count += 1;
                    if far & IS_BUCKET != 0 {
                        // It is likely to be next, and far away in memory.
                        self.fetch(far);
                    }
                }
                side.child = select_unpredictable(before, node.left(), node.right);
            }
            // The rows are read at last, and only if a point is nearer.
            let bucket = (side.child & !IS_BUCKET) as usize;
            prefetch(rows, bucket * BUCKET_SIZE);
            prefetch(rows, bucket * BUCKET_SIZE + BUCKET_SIZE / 2);
            self.fetch(side.child);
            asked[ahead] = (bucket, side.distance2);
            ahead += 1;
            let mut next = None;
            while next.is_none() && count > 0 {
                count -= 1;
                next = Some(waiting[count]).filter(|side| side.distance2 <= found.reach());
            }
            if let Some(next) = next
                && ahead < BUCKETS_AHEAD
                && found.reach() < f64::INFINITY
            {
                side = next;
                continue;
            }
            for &(bucket, distance2) in &asked[..ahead] {
                if distance2 <= found.reach() {
                    let points = &coordinates[bucket * BUCKET_SIZE * D..][..BUCKET_SIZE * D];
                    probe.read(points);
                    let (rows, _) =
                        rows[bucket * BUCKET_SIZE..][..BUCKET_SIZE].as_chunks::<BUCKET_SIZE>();
                    probe.read(&rows[0]);
                    found.offer(&distances(place, points), &rows[0]);
                }
            }
            ahead = 0;
            // The side that was taken may be too far by now.
            let Some(next) = next else { return };
            waiting[count] = next;
            count += 1;
            side = loop {
                if count == 0 {
                    return;
                }
                count -= 1;
                if waiting[count].distance2 <= found.reach() {
                    break waiting[count];
                }
            };
        }
    }

    /// Asks for the points of a bucket.
    #[inline(always)]
    fn fetch(&self, bucket: u32) {
        let first = (bucket & !IS_BUCKET) as usize * BUCKET_SIZE * D;
        for line in (0..BUCKET_SIZE * D).step_by(LANES) {
            prefetch(self.coordinates.words(), first + line);
        }
    }
}

/// The sum of squares from the first axis on, as [`distances`] adds.
#[inline(always)]
fn length2<const D: usize>(offsets: [f64; D]) -> f64 {
    let mut sum = offsets[0] * offsets[0];
    for &x in &offsets[1..] {
        sum += x * x;
    }
    sum
}

/// The squared distances of the points of a bucket from a place.
#[inline(always)]
fn distances<const D: usize>(
    place: [f64; D],
    points: &[f64],
) -> [[f64; LANES]; BUCKET_SIZE / LANES] {
    let (lanes, _) = points.as_chunks::<LANES>();
    let mut distances = [[0.0; LANES]; BUCKET_SIZE / LANES];
    for (j, distance) in distances.iter_mut().enumerate() {
        for i in 0..LANES {
            let x = lanes[j][i] - place[0];
            distance[i] = x * x;
        }
        for axis in 1..D {
            for i in 0..LANES {
                let x = lanes[axis * (BUCKET_SIZE / LANES) + j][i] - place[axis];
                distance[i] += x * x;
            }
        }
    }
    distances
}

/// Searches with all instructions that the machine has, for tests.
#[cfg(test)]
pub(super) fn nearest_by_all<const D: usize>(tree: &KdTree<D>, place: [f64; D]) -> Vec<Nearest> {
    let search = |level| {
        let mut found = NearestOne(Nearest { row: u32::MAX, distance2: f64::INFINITY });
        tree.search(level, place, &mut found, &mut NoProbe);
        found.0
    };
    Level::all().into_iter().map(search).collect()
}
