//! The rows of the input, read once, and the sites among them in the order in which the simplices name them.
//!
//! *Idea.* Rows come in any order, simplices in an order that follows space. Numbering the sites by first appearance
//! makes a copy of the coordinates that is read nearly in order by everything that follows. Rows that are in memory are
//! not copied otherwise.

use std::collections::HashSet;

use rayon::prelude::*;
use taut_points::{
    BlockHash, Blocks, Monitor, PointSource, PointsHash, ReadError, Rows, Scalar, Scratch,
    hash_block,
};

use super::super::{MeshViolation, SiteHash};
use super::signs::{Signs, lexicographic};
use crate::arithmetic::parts;
use crate::{CheckError, Violation};

/// Stands for rows that are no vertex.
pub(super) const NO_SITE: u32 = u32::MAX;

/// Ids looked up at a time: as many as a core can await from memory, and more.
const TOUCHED: usize = 128;

/// All rows.
pub(super) struct Input<'a, const D: usize> {
    rows: Rows<'a>,
    pub(super) hash: PointsHash,
    /// Power of two by which coordinates are multiplied.
    scale: f64,
    signs: Signs,
}

/// What one block of rows has to say.
struct Block {
    hash: BlockHash,
    /// No bit of a coordinate lies below 2^least, none above 2^most.
    least: i32,
    most: i32,
}

impl Block {
    fn of(first: u64, rows: &Rows<'_>) -> Result<Self, Violation> {
        let (least, largest) = match rows {
            Rows::F32(points) => extent(points.values()),
            Rows::F64(points) => extent(points.values()),
        };
        if !f64::from_bits(largest).is_finite()
            && let Some((row, column, value)) = rows.first_non_finite()
        {
            return Err(Violation::NonFinite { row: first + row as u64, column, value });
        }
        let mut most = i32::MIN;
        if largest > 0 {
            let (mantissa, exponent) = parts(f64::from_bits(largest));
            most = exponent + (u64::BITS - mantissa.leading_zeros()) as i32;
        }
        Ok(Block { hash: hash_block(rows), least, most })
    }
}

/// The place of the lowest bit of all values, and the bits of the largest size: more than all others have if any value
/// is not finite.
fn extent<T: Scalar>(values: &[T]) -> (i32, u64) {
    values.iter().fold((i32::MAX, 0), |(least, largest), &value| {
        let x: f64 = value.into();
        (least.min(lowest_bit(x)), largest.max(x.abs().to_bits()))
    })
}

/// The place of the lowest bit of `x`, without a branch.
#[inline(always)]
fn lowest_bit(x: f64) -> i32 {
    let bits = x.to_bits();
    let field = (bits >> 52 & 0x7ff) as i32;
    let mantissa = bits & ((1 << 52) - 1) | u64::from(field != 0) << 52;
    let place = field.max(1) - 1075 + mantissa.trailing_zeros() as i32;
    if mantissa == 0 { i32::MAX } else { place }
}

impl<'a, const D: usize> Input<'a, D> {
    /// One pass. Rows that are not in memory are read to `scratch`.
    pub(super) fn read(
        source: &'a dyn PointSource,
        scratch: &'a mut Scratch,
        monitor: &Monitor<'_>,
    ) -> Result<Self, CheckError> {
        let n = source.len();
        // The largest number is free to mean none.
        if n >= u64::from(u32::MAX) {
            return Err(MeshViolation::TooMany { rows: n }.into());
        }
        monitor.pass(1, n);
        let blocks = Blocks::of(source);
        let rows = source.read(0..n, scratch)?;
        let read = |block: u64| {
            monitor.check().map_err(ReadError::from)?;
            let range = blocks.range(block);
            let some = range.start as usize..range.end as usize;
            let part = match &rows {
                Rows::F32(points) => Rows::F32(points.slice(some)),
                Rows::F64(points) => Rows::F64(points.slice(some)),
            };
            let block = Block::of(range.start, &part)?;
            monitor.points(part.len() as u64);
            Ok::<_, CheckError>(block)
        };
        let blocks: Vec<_> = (0..blocks.count()).into_par_iter().map(read).collect();
        // The first violation by position, whichever thread met it.
        let blocks = blocks.into_iter().collect::<Result<Vec<Block>, CheckError>>()?;
        let hash = PointsHash::of_blocks(n, source.dim(), blocks.iter().map(|b| b.hash));
        let least = blocks.iter().map(|b| b.least).min().unwrap_or(i32::MAX);
        let most = blocks.iter().map(|b| b.most).max().unwrap_or(i32::MIN);
        let (scale, signs) = scaling(least, most);
        Ok(Input { rows, hash, scale, signs })
    }

    /// Number of rows.
    pub(super) fn len(&self) -> usize {
        self.rows.len()
    }

    /// A row. Adding 0 turns −0 into 0 and leaves every other value as it is.
    #[inline(always)]
    fn row(&self, row: u32) -> [f64; D] {
        let at = row as usize * D;
        match &self.rows {
            Rows::F32(points) => {
                let values = &points.values()[at..at + D];
                std::array::from_fn(|k| f64::from(values[k]) + 0.0)
            }
            Rows::F64(points) => {
                let values = &points.values()[at..at + D];
                std::array::from_fn(|k| values[k] + 0.0)
            }
        }
    }

    /// The signs of determinants of rows that went through [`Input::scaled`].
    pub(super) fn signs(&self) -> Signs {
        self.signs
    }

    /// A row, multiplied by the power of two.
    #[inline(always)]
    fn scaled(&self, row: &[f64; D]) -> [f64; D] {
        row.map(|x| x * self.scale)
    }

    /// Dimension of the affine hull. O(n).
    pub(super) fn hull_dimension(&self) -> Option<u8> {
        if self.rows.is_empty() {
            return None;
        }
        let mut rows = 0..self.len() as u32;
        let Some(second) = rows.find(|&row| self.row(row) != self.row(0)) else {
            return Some(0);
        };
        let at = |row: u32| self.scaled(&self.row(row));
        let (a, b) = (at(0), at(second));
        let Some(third) = rows.find(|&row| self.axes(&a, &b, &at(row)).is_some()) else {
            return Some(1);
        };
        let c = at(third);
        let is_beside = |row: u32| {
            let mut tetrahedron = [[0.0; 3]; 4];
            for (to, from) in tetrahedron.iter_mut().zip([a, b, c, at(row)]) {
                to[..D].copy_from_slice(&from);
            }
            self.signs.orientation::<super::geometry::Tetrahedra, 3, 4>(&tetrahedron).is_ne()
        };
        Some(if D == 3 && rows.any(is_beside) { 3 } else { 2 })
    }

    /// The first two coordinates, in the order xy, xz, yz, in which three points are not on a line.
    pub(super) fn axes(&self, a: &[f64; D], b: &[f64; D], c: &[f64; D]) -> Option<[usize; 2]> {
        let pairs = [[0, 1], [0, 2], [1, 2]];
        let pairs = if D == 2 { &pairs[..1] } else { &pairs[..] };
        pairs.iter().copied().find(|&axes| turn(&self.signs, a, b, c, axes).is_ne())
    }
}

/// The orientation of three points in two coordinates.
pub(super) fn turn<const D: usize>(
    signs: &Signs,
    a: &[f64; D],
    b: &[f64; D],
    c: &[f64; D],
    [i, j]: [usize; 2],
) -> std::cmp::Ordering {
    let flat = [a, b, c].map(|p| [p[i], p[j]]);
    signs.orientation::<super::geometry::Triangles, 2, 3>(&flat)
}

/// The factor for coordinates whose bits lie between 2^least and 2^most.
fn scaling(least: i32, most: i32) -> (f64, Signs) {
    if least > most {
        // All coordinates are 0.
        return (1.0, Signs { is_filtered: true, quantum: 1.0 });
    }
    // Powers of two that are themselves f64, and 2^−1024, which is subnormal: multiplying is exact all the same.
    let shift = (-most).clamp(-1024, 1000);
    if least + shift < -1074 {
        return (1.0, Signs { is_filtered: false, quantum: 0.0 });
    }
    let quantum = if least + shift >= -200 { power(least + shift) } else { 0.0 };
    (power(shift), Signs { is_filtered: true, quantum })
}

/// 2ᵏ for −1074 ≤ k ≤ 1023.
fn power(k: i32) -> f64 {
    match k {
        ..-1022 => f64::from_bits(1 << (k + 1074)),
        _ => f64::from_bits(((k + 1023) as u64) << 52),
    }
}

/// The vertices of the simplices.
pub(super) struct Sites<const D: usize> {
    /// Scaled coordinates by site.
    pub(super) points: Vec<[f64; D]>,
    /// Hashes by site.
    pub(super) hashes: Vec<SiteHash>,
    /// Row by site.
    pub(super) rows: Vec<u32>,
    /// Site by row.
    pub(super) sites: Vec<u32>,
}

impl<const D: usize> Sites<D> {
    /// Numbers the rows that `simplices` name, `width` in each, and returns the simplices in these numbers.
    pub(super) fn of(
        input: &Input<'_, D>,
        simplices: &[u32],
        width: usize,
    ) -> Result<(Self, Vec<u32>), MeshViolation> {
        let n = input.len();
        let mut sites = vec![NO_SITE; n];
        // One more, to write to when all are numbered.
        let mut rows = vec![0; n + 1];
        let mut count = 0u32;
        let mut named = simplices.to_vec();
        for (block, ids) in named.chunks_mut(TOUCHED).enumerate() {
            // Touched in a loop of nothing else, many are on their way from memory at the same time.
            let touch = |all: u32, &id: &u32| all ^ sites.get(id as usize).copied().unwrap_or(0);
            std::hint::black_box(ids.iter().fold(0, touch));
            for (place, id) in ids.iter_mut().enumerate() {
                let Some(site) = sites.get_mut(*id as usize) else {
                    let position = (block * TOUCHED + place) / width;
                    return Err(MeshViolation::Id { list: "simplices", position, id: *id });
                };
                // Nobody can foretell whether a site is new, so no branch depends on it.
                let is_new = u32::from(*site == NO_SITE);
                let number = *site ^ ((*site ^ count) & 0u32.wrapping_sub(is_new));
                rows[count as usize] = *id;
                count += is_new;
                *site = number;
                *id = number;
            }
        }
        rows.truncate(count as usize);
        // One visit to each row, in no order that a processor foresees, with nothing else to do meanwhile.
        let mut points: Vec<[f64; D]> = rows.par_iter().map(|&row| input.row(row)).collect();
        let hash = |point: &mut [f64; D]| {
            let hash = SiteHash::of(point);
            *point = input.scaled(point);
            hash
        };
        let hashes = points.par_iter_mut().map(hash).collect();
        Ok((Sites { points, hashes, rows, sites }, named))
    }

    /// The site of a row, if it is a vertex.
    pub(super) fn site(&self, id: u32) -> Option<u32> {
        self.sites.get(id as usize).copied().filter(|&site| site != NO_SITE)
    }

    /// Every row is a vertex, or listed once as equal to a vertex that stands before it.
    ///
    /// That this vertex is the first of the equal rows follows: the others are no vertices, as no two simplices of a
    /// tiling name one place by two ids, so they are listed, and each after the vertex.
    pub(super) fn covers(
        &self,
        input: &Input<'_, D>,
        duplicates: &[[u32; 2]],
    ) -> Result<(), MeshViolation> {
        let n = input.len() as u32;
        let mut before = None;
        for (position, &[row, first]) in duplicates.iter().enumerate() {
            let problem = match () {
                () if row >= n || first >= n => "there are not so many points",
                () if before.is_some_and(|before| before >= row) => "the list is not ascending",
                () if first >= row => "the second must be the earlier one",
                () if input.row(row) != input.row(first) => "they differ",
                () if self.site(row).is_some() => "the first is a vertex",
                () if self.site(first).is_none() => "the second is no vertex",
                () => {
                    before = Some(row);
                    continue;
                }
            };
            return Err(MeshViolation::Duplicate { position, row, first, problem });
        }
        if self.rows.len() + duplicates.len() == input.len() {
            return Ok(());
        }
        let mut listed = duplicates.iter().map(|d| d[0]).peekable();
        let is_missing = |&row: &u32| self.site(row).is_none() && listed.next_if_eq(&row).is_none();
        match (0..n).find(is_missing) {
            Some(row) => Err(MeshViolation::Missing { row }),
            None => Ok(()),
        }
    }

    /// Every row is a vertex or equals one.
    pub(super) fn covers_all_places(&self, input: &Input<'_, D>) -> Result<(), MeshViolation> {
        if self.rows.len() == input.len() {
            return Ok(());
        }
        // −0 was turned into 0, so equal coordinates have equal bits.
        let place = |row: u32| input.row(row).map(f64::to_bits);
        let places: HashSet<[u64; D]> = self.rows.iter().map(|&row| place(row)).collect();
        let is_missing = |&row: &u32| self.site(row).is_none() && !places.contains(&place(row));
        match (0..input.len() as u32).find(is_missing) {
            Some(row) => Err(MeshViolation::Missing { row }),
            None => Ok(()),
        }
    }

    /// The lexicographically smallest site.
    pub(super) fn smallest(&self) -> u32 {
        let smaller = |a: u32, b: u32| {
            let [p, q] = [a, b].map(|site| &self.points[site as usize]);
            if lexicographic(q, p).is_lt() { b } else { a }
        };
        (0..self.points.len() as u32).reduce(smaller).unwrap_or(NO_SITE)
    }

    /// Another vertex with the coordinates of `site`.
    pub(super) fn twin_of(&self, site: u32) -> Option<u32> {
        let place = self.points[site as usize];
        (0..self.points.len() as u32)
            .find(|&other| other != site && self.points[other as usize] == place)
    }

    /// The coordinates of some sites.
    #[inline(always)]
    pub(super) fn gather<const V: usize>(&self, sites: &[u32; V]) -> [[f64; D]; V] {
        std::array::from_fn(|i| self.points[sites[i] as usize])
    }
}
