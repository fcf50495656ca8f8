//! What is to be known of all points before the first tile: their hash, the numbers that arithmetic relies on, the
//! lexicographically smallest one, and the dimension of their affine hull.

use std::cmp::Ordering;

use taut_points::{
    BlockHash, Blocks, Monitor, PointSource, PointsHash, Rows, Scratch, hash_block, map_blocks,
};

use super::super::geometry::Tetrahedra;
use super::super::input::{Block, scaling, turn};
use super::super::signs::{Signs, lexicographic};
use super::{TilesError, TilesViolation};
use crate::Violation;

/// All about the points as a whole.
pub(super) struct Overview<const D: usize> {
    pub(super) hash: PointsHash,
    /// The hash of each block.
    pub(super) blocks: Vec<BlockHash>,
    /// Power of two by which coordinates are multiplied.
    pub(super) scale: f64,
    pub(super) signs: Signs,
    /// The lexicographically smallest point, of equal ones the first, with its row.
    pub(super) smallest: Option<(u64, [f64; D])>,
}

/// A row, with −0 turned into 0.
#[inline(always)]
pub(super) fn point<const D: usize>(rows: &Rows<'_>, row: usize) -> [f64; D] {
    let at = row * D;
    match rows {
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

impl<const D: usize> Overview<D> {
    /// One pass over the points.
    pub(super) fn read(
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<Self, TilesError> {
        monitor.pass(1, source.len());
        let found = map_blocks(source, monitor, |first, rows| {
            let block = Block::of(first, &rows).map_err(|violation| match violation {
                Violation::NonFinite { row, column, value } => {
                    TilesViolation::NonFinite { row, column, value }
                }
                other => TilesViolation::Manifest { problem: other.to_string() },
            })?;
            let mut smallest: Option<(u64, [f64; D])> = None;
            for row in 0..rows.len() {
                let p = point(&rows, row);
                if smallest.is_none_or(|(_, least)| lexicographic(&p, &least).is_lt()) {
                    smallest = Some((first + row as u64, p));
                }
            }
            Ok::<_, TilesError>((block, smallest))
        })?;
        let least = found.iter().map(|(block, _)| block.least).min().unwrap_or(i32::MAX);
        let most = found.iter().map(|(block, _)| block.most).max().unwrap_or(i32::MIN);
        let (scale, signs) = scaling(least, most);
        let blocks: Vec<BlockHash> = found.iter().map(|(block, _)| block.hash).collect();
        let hash = PointsHash::of_blocks(source.len(), D, blocks.iter().copied());
        let all = found.into_iter().filter_map(|(_, smallest)| smallest);
        // The first of equal ones, as blocks are in order.
        let smallest = all.reduce(|a, b| if lexicographic(&b.1, &a.1).is_lt() { b } else { a });
        Ok(Overview { hash, blocks, scale, signs, smallest })
    }

    pub(super) fn scaled(&self, p: &[f64; D]) -> [f64; D] {
        p.map(|x| x * self.scale)
    }

    /// Dimension of the affine hull: reads until it is known, in general a block.
    pub(super) fn hull_dimension(
        &self,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<Hull<D>, TilesError> {
        let blocks = Blocks::of(source);
        let (mut scratch, mut hull) = (Scratch::new(), Hull { corners: vec![], axes: None });
        for (block, &expected) in (0..blocks.count()).zip(&self.blocks) {
            monitor.check()?;
            let rows = source.read(blocks.range(block), &mut scratch)?;
            // The input may have changed since the first pass.
            if hash_block(&rows) != expected {
                let found = format!("another in block {block}");
                return Err(TilesViolation::Hash { claimed: self.hash.to_string(), found }.into());
            }
            for row in 0..rows.len() {
                self.add(&mut hull, self.scaled(&point(&rows, row)));
                if hull.corners.len() == D + 1 {
                    return Ok(hull);
                }
            }
        }
        Ok(hull)
    }

    /// Adds a point if it lies beside those that are there.
    fn add(&self, hull: &mut Hull<D>, p: [f64; D]) {
        let is_new = match hull.corners[..] {
            [] => true,
            [a] => a != p,
            [a, b] => {
                let pairs = [[0, 1], [0, 2], [1, 2]];
                let pairs = if D == 2 { &pairs[..1] } else { &pairs[..] };
                hull.axes =
                    pairs.iter().copied().find(|&axes| turn(&self.signs, &a, &b, &p, axes).is_ne());
                hull.axes.is_some()
            }
            [a, b, c] if D == 3 => {
                let mut tetrahedron = [[0.0; 3]; 4];
                for (to, from) in tetrahedron.iter_mut().zip([a, b, c, p]) {
                    to[..D].copy_from_slice(&from);
                }
                self.signs.orientation::<Tetrahedra, 3, 4>(&tetrahedron) != Ordering::Equal
            }
            _ => false,
        };
        if is_new {
            hull.corners.push(p);
        }
    }
}

/// Points that span the affine hull of all.
pub(super) struct Hull<const D: usize> {
    corners: Vec<[f64; D]>,
    /// The first two coordinates, in the order xy, xz, yz, in which three of them are not on a line.
    axes: Option<[usize; 2]>,
}

impl<const D: usize> Hull<D> {
    /// Vertices of a simplex.
    pub(super) fn vertices(&self) -> usize {
        self.corners.len()
    }

    /// The order of the coordinates in which a plane does not stand upright.
    pub(super) fn axes(&self) -> [usize; D] {
        let mut axes = std::array::from_fn(|k| k);
        if D == 3
            && let Some([i, j]) = self.axes
        {
            axes[..3].copy_from_slice(&[i, j, 3 - i - j]);
        }
        axes
    }
}
