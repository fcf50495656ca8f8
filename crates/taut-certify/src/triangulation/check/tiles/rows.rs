//! Coverage: each row of the input is a vertex or a duplicate, and each site has the coordinates of its row.
//!
//! *Idea.* Tiles have sites in the order of space, the input has rows in any. Sites are distributed to buckets by row, on the
//! disk; a bucket is compared with its part of the input, while that fits in the cache.
//! *Proof.* A row that no duplicate names must be owned by just one tile, and be a vertex in some. A row that a duplicate
//! names is owned by none, is named once, and has the coordinates of an earlier row that is owned. That this is the first of
//! the equal rows follows: the others are not owned, so they are named, and each after it.
//! *Trap.* The input is read once more here, and may have changed in the meantime: each block is hashed again.

mod buckets;
mod pages;

use std::ops::Range;
use std::path::Path;
use std::sync::atomic::{AtomicU8, Ordering};

use taut_points::parallel::{IntoParallel, ParallelSlice};
use taut_points::{BlockHash, Blocks, Monitor, PointSource, PointsHash, Rows, Scratch, hash_block};

use self::buckets::{Buckets, ReadBuckets};
use super::overview::{Overview, point};
use super::sort::{Sorted, Sorter};
use super::{TilesError, TilesViolation};

/// Bytes of coordinates of a bucket where there is memory for it: what is compared stays in the cache.
const BUCKET_BYTES: u64 = 4 << 20;

/// Fewest bytes of a bucket that are written at once.
const BLOCK_BYTES_MIN: u64 = 1 << 12;

/// Most bytes of a bucket that are written at once.
const BLOCK_BYTES_MAX: u64 = 1 << 18;

/// In a record: its tile owns the site.
const IS_OWNED: u32 = 1 << 31;
/// In a record: a simplex of its tile has the site.
const IS_VERTEX: u32 = 1 << 30;

/// Of a row: a tile owns it.
const OWNED: u8 = 1;
/// Of a row: more than one tile owns it.
const OWNED_TWICE: u8 = 2;
/// Of a row: it is a vertex of a simplex.
const VERTEX: u8 = 4;
/// Of a row: a tile has it, perhaps as a copy.
const SITE: u8 = 8;
/// Of a row: it is listed as a duplicate.
const DUPLICATE: u8 = 16;

/// A site of a tile.
pub(super) struct Site<const D: usize> {
    pub(super) row: u64,
    pub(super) coordinates: [f64; D],
    pub(super) is_owned: bool,
    pub(super) is_vertex: bool,
}

/// The sites and duplicates of all tiles.
pub(super) struct Coverage<const D: usize> {
    /// Rows of a bucket: whole blocks of the input.
    bucket_rows: u64,
    sites: Buckets,
    by_row: Sorter<2>,
    by_first: Sorter<2>,
    duplicates: u64,
    owned: u64,
}

impl<const D: usize> Coverage<D> {
    /// Takes `memory` bytes at most beside one bucket of the input.
    pub(super) fn new(n: u64, folder: &Path, memory: u64) -> Result<Self, TilesError> {
        let row_bytes = 8 * D as u64 + 1;
        let block_rows = Blocks::new(n, D).range(0).end.max(1);
        let buckets_max = (memory / 2 / BLOCK_BYTES_MIN).max(1);
        let wanted = BUCKET_BYTES.min(memory / 4) / row_bytes;
        let bucket_rows = wanted.max(n.div_ceil(buckets_max)).max(1).next_multiple_of(block_rows);
        let needed = bucket_rows.saturating_mul(row_bytes);
        let is_too_large = needed > memory && bucket_rows > block_rows || bucket_rows >= 1 << 30;
        if is_too_large {
            let what = "the comparison of the sites with the points".to_owned();
            return Err(TilesError::Memory { what, needed, allowed: memory });
        }
        let buckets = n.div_ceil(bucket_rows);
        let block = (memory / 2 / buckets.max(1)).clamp(BLOCK_BYTES_MIN, BLOCK_BYTES_MAX);
        Ok(Coverage {
            bucket_rows,
            sites: Buckets::new(folder, buckets as usize, block as usize, 4 + 8 * D)?,
            by_row: Sorter::new(folder, memory / 8),
            by_first: Sorter::new(folder, memory / 8),
            duplicates: 0,
            owned: 0,
        })
    }

    /// Adds a site, whose row is one of the input.
    #[inline(always)]
    pub(super) fn add(&mut self, site: &Site<D>) -> Result<(), TilesError> {
        let (bucket, place) = (site.row / self.bucket_rows, site.row % self.bucket_rows);
        let flags = [(site.is_owned, IS_OWNED), (site.is_vertex, IS_VERTEX)];
        let flags = flags.into_iter().filter(|flag| flag.0).fold(0, |all, flag| all | flag.1);
        self.owned += u64::from(site.is_owned);
        let to = self.sites.place(bucket as usize)?;
        to.extend_from_slice(&(place as u32 | flags).to_le_bytes());
        for x in site.coordinates {
            to.extend_from_slice(&x.to_bits().to_le_bytes());
        }
        Ok(())
    }

    /// Adds a row that is said to equal another; both are rows of the input.
    pub(super) fn add_duplicate(&mut self, row: u64, first: u64) -> Result<(), TilesError> {
        self.duplicates += 1;
        self.by_row.push([row, first])?;
        self.by_first.push([first, row])
    }

    /// The sites that are owned, and the duplicates.
    pub(super) fn counts(&self) -> [u64; 2] {
        [self.owned, self.duplicates]
    }

    /// Compares all that was added with the input.
    pub(super) fn check(
        self,
        source: &dyn PointSource,
        overview: &Overview<D>,
        folder: &Path,
        memory: u64,
        monitor: &Monitor<'_>,
    ) -> Result<(), TilesError> {
        let n = source.len();
        monitor.pass(4, n);
        let Coverage { bucket_rows, sites, by_row, by_first, .. } = self;
        let comparison = Comparison::<D> {
            source,
            blocks: Blocks::of(source),
            monitor,
            by_row: by_row.sorted()?,
            by_first: by_first.sorted()?,
            equal: Equal::new(folder, memory / 8),
            hashes: vec![],
        };
        let (found, equal) =
            sites.read(memory / 2, |sites| comparison.run(bucket_rows as usize, sites))?;
        if found != overview.hash {
            return Err(changed(overview.hash, found));
        }
        equal.check(source, overview, monitor)
    }
}

/// The comparison of sites and duplicates with the input, bucket by bucket.
struct Comparison<'a, const D: usize> {
    source: &'a dyn PointSource,
    blocks: Blocks,
    monitor: &'a Monitor<'a>,
    /// Row and earlier row, by the one and by the other.
    by_row: Sorted<2>,
    by_first: Sorted<2>,
    equal: Equal<D>,
    /// Those of the blocks of the input that were read.
    hashes: Vec<BlockHash>,
}

impl<const D: usize> Comparison<'_, D> {
    /// The hash of the input as it is now, and what is left to compare.
    fn run(
        mut self,
        bucket_rows: usize,
        sites: &mut ReadBuckets<'_>,
    ) -> Result<(PointsHash, Equal<D>), TilesError> {
        let n = self.source.len();
        let mut scratch = Scratch::new();
        for (bucket, start) in (0..n).step_by(bucket_rows).enumerate() {
            let range = start..n.min(start + bucket_rows as u64);
            let rows = self.source.read(range.clone(), &mut scratch)?;
            self.hash(&rows, &range);
            let states: Vec<AtomicU8> = range.clone().map(|_| AtomicU8::new(0)).collect();
            sites.for_each_piece(bucket, |runs| {
                self.monitor.check()?;
                compare::<D>(runs, &rows, start, &states)
            })?;
            self.duplicates(&rows, &range, &states)?;
            for (row, state) in range.clone().zip(&states) {
                if let Some(problem) = problem_of(state.load(Ordering::Relaxed)) {
                    return Err(TilesViolation::Site { row, problem }.into());
                }
            }
            self.monitor.points(range.end - start);
        }
        Ok((PointsHash::of_blocks(n, D, self.hashes), self.equal))
    }

    /// Hashes the blocks of a bucket, which are whole.
    fn hash(&mut self, rows: &Rows<'_>, range: &Range<u64>) {
        let block_rows = self.blocks.range(0).end;
        let hash = |block: u64| {
            let of_block = self.blocks.range(block);
            let place = |row: u64| (row - range.start) as usize;
            hash_block(&part(rows, place(of_block.start), place(of_block.end)))
        };
        let all = range.start / block_rows..range.end.div_ceil(block_rows);
        let of_bucket: Vec<BlockHash> = all.into_par_iter().map(hash).collect();
        self.hashes.extend(of_bucket);
    }

    /// Judges the duplicates among the rows of a bucket, and notes the coordinates of those that others equal.
    fn duplicates(
        &mut self,
        rows: &Rows<'_>,
        range: &Range<u64>,
        states: &[AtomicU8],
    ) -> Result<(), TilesError> {
        while let Some([row, first]) = self.by_row.next_if(|entry| entry[0] < range.end)? {
            let state = &states[(row - range.start) as usize];
            let problem = match state.fetch_or(DUPLICATE, Ordering::Relaxed) {
                _ if first >= row => "the second must be the earlier one",
                before if before & DUPLICATE != 0 => "the first is listed twice",
                before if before & SITE != 0 => "the first is a site of a tile",
                _ => continue,
            };
            return Err(TilesViolation::Duplicate { row, first, problem }.into());
        }
        while let Some([first, row]) = self.by_first.next_if(|entry| entry[0] < range.end)? {
            let place = (first - range.start) as usize;
            if states[place].load(Ordering::Relaxed) & OWNED == 0 {
                let problem = "the second is no site of a tile";
                return Err(TilesViolation::Duplicate { row, first, problem }.into());
            }
            self.equal.add(row, first, point(rows, place))?;
        }
        Ok(())
    }
}

fn changed(claimed: PointsHash, found: PointsHash) -> TilesError {
    let (claimed, found) = (claimed.to_string(), found.to_string());
    TilesViolation::Hash { claimed, found }.into()
}

/// Some of the rows.
fn part<'a>(rows: &Rows<'a>, start: usize, end: usize) -> Rows<'a> {
    match rows {
        Rows::F32(points) => Rows::F32(points.slice(start..end)),
        Rows::F64(points) => Rows::F64(points.slice(start..end)),
    }
}

/// Why a row with this state is not covered.
fn problem_of(state: u8) -> Option<&'static str> {
    let has = |bit: u8| state & bit != 0;
    match () {
        () if has(DUPLICATE) => None,
        () if has(OWNED_TWICE) => Some("is owned by more than one tile"),
        () if !has(SITE) => Some("is a site of no tile, nor listed as a duplicate"),
        () if !has(OWNED) => Some("is owned by no tile"),
        () if !has(VERTEX) => Some("is a vertex of no simplex"),
        () => None,
    }
}

/// Compares the coordinates of sites with their rows, and notes what is known of these.
fn compare<const D: usize>(
    runs: &[&[u8]],
    rows: &Rows<'_>,
    start: u64,
    states: &[AtomicU8],
) -> Result<(), TilesError> {
    /// Records that a thread takes at once.
    const SHARE: usize = 1 << 12;
    let width = 4 + 8 * D;
    let shares: Vec<&[u8]> = runs.iter().flat_map(|run| run.chunks(SHARE * width)).collect();
    let compared = shares.par_iter().try_for_each(|records| {
        let wrong = records.chunks_exact(width).find_map(|record| {
            let (head, coordinates) = record.split_first_chunk::<4>()?;
            let head = u32::from_le_bytes(*head);
            let place = (head & (IS_VERTEX - 1)) as usize;
            let expected = point::<D>(rows, place);
            for (column, (bytes, expected)) in
                coordinates.as_chunks::<8>().0.iter().zip(expected).enumerate()
            {
                let found = f64::from_le_bytes(*bytes);
                if found.to_bits() != expected.to_bits() {
                    let row = start + place as u64;
                    return Some(TilesViolation::Coordinate { row, column, found, expected });
                }
            }
            let mut state = SITE;
            if head & IS_OWNED != 0 {
                state |= OWNED;
            }
            if head & IS_VERTEX != 0 {
                state |= VERTEX;
            }
            let before = states[place].fetch_or(state, Ordering::Relaxed);
            if before & state & OWNED != 0 {
                states[place].fetch_or(OWNED_TWICE, Ordering::Relaxed);
            }
            None
        });
        wrong.map_or(Ok(()), Err)
    });
    compared.map_err(TilesError::from)
}

/// Rows that are said to equal an earlier one, with the coordinates of that.
struct Equal<const D: usize> {
    /// Row, earlier row, and coordinates, of which those beyond the dimension are 0.
    entries: Sorter<5>,
    is_empty: bool,
}

impl<const D: usize> Equal<D> {
    fn new(folder: &Path, memory: u64) -> Self {
        Equal { entries: Sorter::new(folder, memory), is_empty: true }
    }

    fn add(&mut self, row: u64, first: u64, coordinates: [f64; D]) -> Result<(), TilesError> {
        let mut entry = [row, first, 0, 0, 0];
        for (word, x) in entry[2..].iter_mut().zip(coordinates) {
            *word = x.to_bits();
        }
        self.is_empty = false;
        self.entries.push(entry)
    }

    /// Reads the blocks with such rows.
    fn check(
        self,
        source: &dyn PointSource,
        overview: &Overview<D>,
        monitor: &Monitor<'_>,
    ) -> Result<(), TilesError> {
        if self.is_empty {
            return Ok(());
        }
        let blocks = Blocks::of(source);
        let (mut scratch, mut entries) = (Scratch::new(), self.entries.sorted()?);
        for (block, &expected) in (0..blocks.count()).zip(&overview.blocks) {
            let range = blocks.range(block);
            let mut next = entries.next_if(|entry| entry[0] < range.end)?;
            if next.is_none() {
                continue;
            }
            monitor.check()?;
            let rows = source.read(range.clone(), &mut scratch)?;
            if hash_block(&rows) != expected {
                let found = format!("another in block {block}");
                let claimed = overview.hash.to_string();
                return Err(TilesViolation::Hash { claimed, found }.into());
            }
            while let Some(entry) = next {
                let [row, first, ..] = entry;
                let p = point::<D>(&rows, (row - range.start) as usize);
                if p.iter().zip(&entry[2..]).any(|(x, &bits)| x.to_bits() != bits) {
                    let problem = "they differ";
                    return Err(TilesViolation::Duplicate { row, first, problem }.into());
                }
                next = entries.next_if(|entry| entry[0] < range.end)?;
            }
        }
        Ok(())
    }
}
