//! The rows of the input, read once, and the sites among them in the order in which the simplices name them.
//!
//! *Idea.* Rows come in any order, simplices in an order that follows space. Numbering the sites by first appearance
//! makes a second copy of the coordinates that is read nearly in order by everything that follows.

use std::collections::HashSet;

use rayon::prelude::*;
use taut_points::{
    BlockHash, Blocks, Monitor, PointSource, Points, PointsHash, ReadError, Rows, Scalar, Scratch,
    hash_block,
};

use super::super::{MeshViolation, SiteHash};
use super::signs::{Signs, lexicographic};
use crate::arithmetic::parts;
use crate::{CheckError, Violation};

/// Stands for rows that are no vertex.
pub(super) const NO_SITE: u32 = u32::MAX;

/// All rows.
pub(super) struct Input<const D: usize> {
    pub(super) rows: Vec<[f64; D]>,
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
    /// Copies the rows to `out`.
    fn of<const D: usize>(
        first: u64,
        rows: &Rows<'_>,
        out: &mut [[f64; D]],
    ) -> Result<Self, Violation> {
        if let Some((row, column, value)) = rows.first_non_finite() {
            return Err(Violation::NonFinite { row: first + row as u64, column, value });
        }
        let mut block = Block { hash: hash_block(rows), least: i32::MAX, most: i32::MIN };
        match rows {
            Rows::F32(points) => block.copy(points, out),
            Rows::F64(points) => block.copy(points, out),
        }
        Ok(block)
    }

    fn copy<T: Scalar, const D: usize>(&mut self, points: &Points<'_, T>, out: &mut [[f64; D]]) {
        let mut largest = 0u64;
        for (to, from) in out.iter_mut().zip(points.rows()) {
            for (to, &from) in to.iter_mut().zip(from) {
                // Adding 0 turns −0 into 0 and leaves every other value as it is.
                let x: f64 = from.into() + 0.0;
                largest = largest.max(x.abs().to_bits());
                self.least = self.least.min(lowest_bit(x));
                *to = x;
            }
        }
        if largest > 0 {
            let (mantissa, exponent) = parts(f64::from_bits(largest));
            self.most = exponent + (u64::BITS - mantissa.leading_zeros()) as i32;
        }
    }
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

impl<const D: usize> Input<D> {
    /// One pass.
    pub(super) fn read(
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<Self, CheckError> {
        let n = source.len();
        // The largest number is free to mean none.
        if n >= u64::from(u32::MAX) {
            return Err(MeshViolation::TooMany { rows: n }.into());
        }
        monitor.pass(1, n);
        let blocks = Blocks::of(source);
        let mut rows = vec![[0.0; D]; n as usize];
        let per_block = (blocks.range(0).end as usize).max(1);
        let read = |scratch: &mut Scratch, (block, out): (usize, &mut [[f64; D]])| {
            monitor.check().map_err(ReadError::from)?;
            let range = blocks.range(block as u64);
            let first = range.start;
            let block = Block::of(first, &source.read(range, scratch)?, out)?;
            monitor.points(out.len() as u64);
            Ok::<_, CheckError>(block)
        };
        let blocks: Vec<_> =
            rows.par_chunks_mut(per_block).enumerate().map_init(Scratch::new, read).collect();
        // The first violation by position, whichever thread met it.
        let blocks = blocks.into_iter().collect::<Result<Vec<Block>, CheckError>>()?;
        let hash = PointsHash::of_blocks(n, source.dim(), blocks.iter().map(|b| b.hash));
        let least = blocks.iter().map(|b| b.least).min().unwrap_or(i32::MAX);
        let most = blocks.iter().map(|b| b.most).max().unwrap_or(i32::MIN);
        let (scale, signs) = scaling(least, most);
        Ok(Input { rows, hash, scale, signs })
    }

    /// The signs of determinants of rows that went through [`Input::scaled`].
    pub(super) fn signs(&self) -> Signs {
        self.signs
    }

    /// A row, multiplied by the power of two.
    pub(super) fn scaled(&self, row: u32) -> [f64; D] {
        self.rows[row as usize].map(|x| x * self.scale)
    }

    /// Dimension of the affine hull. O(n).
    pub(super) fn hull_dimension(&self) -> Option<u8> {
        let first = self.rows.first()?;
        let mut rows = 0..self.rows.len() as u32;
        let Some(second) = rows.find(|&row| self.rows[row as usize] != *first) else {
            return Some(0);
        };
        let (a, b) = (self.scaled(0), self.scaled(second));
        let Some(third) = rows.find(|&row| self.axes(&a, &b, &self.scaled(row)).is_some()) else {
            return Some(1);
        };
        let c = self.scaled(third);
        let is_beside = |row: u32| {
            let mut tetrahedron = [[0.0; 3]; 4];
            for (to, from) in tetrahedron.iter_mut().zip([a, b, c, self.scaled(row)]) {
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
        input: &Input<D>,
        simplices: &[u32],
        width: usize,
    ) -> Result<(Self, Vec<u32>), MeshViolation> {
        let mut sites = vec![NO_SITE; input.rows.len()];
        let mut rows = Vec::with_capacity(input.rows.len());
        let mut named = Vec::with_capacity(simplices.len());
        for (place, &id) in simplices.iter().enumerate() {
            let Some(site) = sites.get_mut(id as usize) else {
                let position = place / width;
                return Err(MeshViolation::Id { list: "simplices", position, id });
            };
            if *site == NO_SITE {
                *site = rows.len() as u32;
                rows.push(id);
            }
            named.push(*site);
        }
        // One visit to each row, in no order that a processor foresees.
        let visit = |&row: &u32| (input.scaled(row), SiteHash::of(&input.rows[row as usize]));
        let (points, hashes) = rows.par_iter().map(visit).unzip();
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
        input: &Input<D>,
        duplicates: &[[u32; 2]],
    ) -> Result<(), MeshViolation> {
        let n = input.rows.len() as u32;
        let mut before = None;
        for (position, &[row, first]) in duplicates.iter().enumerate() {
            let problem = match () {
                () if row >= n || first >= n => "there are not so many points",
                () if before.is_some_and(|before| before >= row) => "the list is not ascending",
                () if first >= row => "the second must be the earlier one",
                () if input.rows[row as usize] != input.rows[first as usize] => "they differ",
                () if self.site(row).is_some() => "the first is a vertex",
                () if self.site(first).is_none() => "the second is no vertex",
                () => {
                    before = Some(row);
                    continue;
                }
            };
            return Err(MeshViolation::Duplicate { position, row, first, problem });
        }
        if self.rows.len() + duplicates.len() == input.rows.len() {
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
    pub(super) fn covers_all_places(&self, input: &Input<D>) -> Result<(), MeshViolation> {
        if self.rows.len() == input.rows.len() {
            return Ok(());
        }
        // −0 was turned into 0, so equal coordinates have equal bits.
        let place = |row: u32| input.rows[row as usize].map(f64::to_bits);
        let places: HashSet<[u64; D]> = self.rows.iter().map(|&row| place(row)).collect();
        let is_missing = |&row: &u32| self.site(row).is_none() && !places.contains(&place(row));
        match (0..input.rows.len() as u32).find(is_missing) {
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

    /// The coordinates of some sites.
    #[inline(always)]
    pub(super) fn gather<const V: usize>(&self, sites: &[u32; V]) -> [[f64; D]; V] {
        std::array::from_fn(|i| self.points[sites[i] as usize])
    }
}
