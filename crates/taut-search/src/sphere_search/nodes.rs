//! The arrays of the tree: blocks of rows, and above them boxes and balls, eight to a group.
//!
//! *Idea.* Level 0 are the blocks in tree order, node j of level ℓ + 1 is over the nodes 8j to 8j + 7 of level ℓ: no link is
//! stored. The bounds of such eight stand side by side, axis by axis, so that one vector register holds a bound of all of them.
//! *Guarantee.* Every row lies in the box and in the ball of each node above it, and no row above a node is lower than its
//! `lowest_row`. Lanes beyond the last node or row repeat the last one; searches skip these nodes by number, and such rows have the
//! number [`NO_ROW`].

use std::ops::Deref;

use super::build::pack;
use super::cuts::Cuts;
use super::dim::Dim;
use super::measure::Measure;

/// Rows of a block: two vectors of eight coordinates for each axis.
pub(super) const BLOCK_SIZE: usize = 16;
/// Children of a node: one vector of eight bounds.
pub(super) const FANOUT: usize = 8;
/// The row number of a lane without a row.
pub(super) const NO_ROW: u32 = u32::MAX;

/// One number for each lane, on cache lines of their own.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub(super) struct Lanes<const L: usize>(pub(super) [f64; L]);

impl<const L: usize> Deref for Lanes<L> {
    type Target = [f64; L];

    #[inline(always)]
    fn deref(&self) -> &[f64; L] {
        &self.0
    }
}

/// How far a range is from those of eight nodes.
#[inline(always)]
fn outside(bounds: &[f64; 2 * FANOUT], low: f64, high: f64, scale: f64) -> [f64; FANOUT] {
    let mut differences = [0.0; FANOUT];
    for lane in 0..FANOUT {
        let above = bounds[lane] * scale - high;
        let below = low - bounds[FANOUT + lane] * scale;
        let outside = if above > below { above } else { below };
        differences[lane] = if outside > 0.0 { outside } else { 0.0 };
    }
    differences
}

/// The bounds of the nodes of one level.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Level {
    /// Nodes.
    pub(super) count: usize,
    /// For each group the cuts between its nodes.
    pub(super) cuts: Vec<Cuts>,
    /// For each group and axis the eight low ends, then the eight high ends.
    pub(super) boxes: Vec<Lanes<{ 2 * FANOUT }>>,
    /// For each group and axis the eight coordinates of centers of balls.
    pub(super) centers: Vec<Lanes<FANOUT>>,
    /// For each group the eight radii of these balls around the points (or centers of balls) of a node.
    pub(super) radii: Vec<f64>,
    /// For each group the largest radius of a row of each node; empty where rows are points.
    pub(super) row_radii: Vec<f64>,
    /// For each group the lowest row of each node.
    pub(super) lowest_rows: Vec<u32>,
}

/// All of the tree.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Nodes {
    pub(super) dim: usize,
    /// For each block and axis the coordinates of its rows.
    pub(super) coordinates: Vec<Lanes<BLOCK_SIZE>>,
    /// The radii of the rows of blocks; empty where rows are points.
    pub(super) row_radii: Vec<f64>,
    /// The largest of them, 0 of points.
    pub(super) row_radius_max: f64,
    /// The row numbers of blocks, ascending in each.
    pub(super) rows: Vec<u32>,
    /// From the blocks up; the last has one group.
    pub(super) levels: Vec<Level>,
}

impl Nodes {
    pub(super) fn of(values: &[f64], dim: usize, row_radii: &[f64]) -> Nodes {
        pack(values, dim, row_radii)
    }

    pub(super) fn blocks(&self) -> usize {
        self.levels[0].count
    }

    /// The level of the node above all: its children are the first group of the highest level.
    pub(super) fn root_level(&self) -> u32 {
        self.levels.len() as u32
    }

    #[inline(always)]
    pub(super) fn block<D: Dim>(&self, dim: D, block: usize) -> &[Lanes<BLOCK_SIZE>] {
        &self.coordinates[block * dim.get()..][..dim.get()]
    }

    #[inline(always)]
    pub(super) fn rows_of(&self, block: usize) -> &[u32; BLOCK_SIZE] {
        &self.rows.as_chunks().0[block]
    }

    #[inline(always)]
    pub(super) fn radii_of(&self, block: usize) -> &[f64; BLOCK_SIZE] {
        &self.row_radii.as_chunks().0[block]
    }

    /// Keys of the rows of a block from a place: the near sides of balls, or with `IS_FAR` the far sides.
    #[inline(always)]
    pub(super) fn block_keys<D: Dim, M: Measure, const IS_FAR: bool>(
        &self,
        dim: D,
        block: usize,
        place: &[f64],
    ) -> [M::Key; BLOCK_SIZE] {
        let coordinates = self.block(dim, block);
        let keys = M::keys(dim.get(), |axis, scale| {
            let (column, x) = (&coordinates[axis], place[axis] * scale);
            let mut differences = [0.0; BLOCK_SIZE];
            for lane in 0..BLOCK_SIZE {
                differences[lane] = x - column[lane] * scale;
            }
            differences
        });
        let sign = if IS_FAR { 1.0 } else { -1.0 };
        M::lengthen(keys, |lane| sign * self.radii_of(block)[lane])
    }
}

impl Level {
    /// The boxes of a group.
    #[inline(always)]
    pub(super) fn boxes_of<D: Dim>(&self, dim: D, group: usize) -> &[Lanes<{ 2 * FANOUT }>] {
        &self.boxes[group * dim.get()..][..dim.get()]
    }

    /// The coordinates of the centers of a group's balls.
    #[inline(always)]
    pub(super) fn centers_of<D: Dim>(&self, dim: D, group: usize) -> &[Lanes<FANOUT>] {
        &self.centers[group * dim.get()..][..dim.get()]
    }

    /// The largest radius of a row of a node, 0 of points.
    #[inline(always)]
    pub(super) fn row_radius(&self, node: usize) -> f64 {
        self.row_radii.get(node).copied().unwrap_or(0.0)
    }

    /// Lower bounds of the keys of the rows of a group's nodes from a box, which may be a place, with balls in it of radii up to
    /// `own_radius`. The sum of two radii comes first, as it does for two rows: other roundings could put a bound above a key.
    #[inline(always)]
    pub(super) fn lower<D: Dim, M: Measure>(
        &self,
        dim: D,
        group: usize,
        (low, high): (&[f64], &[f64]),
        own_radius: f64,
    ) -> [M::Key; FANOUT] {
        let boxes = self.boxes_of(dim, group);
        let keys = M::keys(dim.get(), |axis, scale| {
            outside(&boxes[axis], low[axis] * scale, high[axis] * scale, scale)
        });
        M::lengthen(keys, |lane| -(own_radius + self.row_radius(group * FANOUT + lane)))
    }

    /// The lanes of a group's nodes that may have rows within a limit of a box with balls in it of radii up to `own_radius`.
    #[inline(always)]
    pub(super) fn lanes_near<D: Dim, M: Measure>(
        &self,
        dim: D,
        group: usize,
        (low, high): (&[f64], &[f64]),
        own_radius: f64,
        limit: f64,
    ) -> u32 {
        let boxes = self.boxes_of(dim, group);
        let differences = |axis: usize, scale: f64| {
            outside(&boxes[axis], low[axis] * scale, high[axis] * scale, scale)
        };
        let lengths = |lane: usize| own_radius + self.row_radius(group * FANOUT + lane);
        let near = M::lanes_near::<FANOUT>(dim.get(), differences, lengths, limit);
        near & ((1 << self.width(group)) - 1)
    }

    /// Upper bounds of the keys of the rows of a group's nodes from a box, which may be a place, with balls in it of radii up to
    /// `own_radius`, whose centers the ball around `center` with `radius` holds.
    #[inline(always)]
    pub(super) fn upper<D: Dim, M: Measure>(
        &self,
        dim: D,
        group: usize,
        (low, high): (&[f64], &[f64]),
        (center, radius): (&[f64], f64),
        own_radius: f64,
    ) -> [M::Key; FANOUT] {
        let boxes = self.boxes_of(dim, group);
        let by_box = M::keys(dim.get(), |axis, scale| {
            let (bounds, low, high) = (&boxes[axis], low[axis] * scale, high[axis] * scale);
            let mut differences = [0.0; FANOUT];
            for lane in 0..FANOUT {
                let up = bounds[FANOUT + lane] * scale - low;
                let down = high - bounds[lane] * scale;
                differences[lane] = if up > down { up } else { down };
            }
            differences
        });
        let centers = self.centers_of(dim, group);
        let between = M::keys(dim.get(), |axis, scale| {
            let (column, x) = (&centers[axis], center[axis] * scale);
            let mut differences = [0.0; FANOUT];
            for lane in 0..FANOUT {
                differences[lane] = x - column[lane] * scale;
            }
            differences
        });
        let radii = &self.radii.as_chunks::<FANOUT>().0[group];
        let mut keys = by_box;
        for lane in 0..FANOUT {
            let by_ball = M::key_above(M::distance(between[lane]) + (radius + radii[lane]));
            keys[lane] = if by_ball < keys[lane] { by_ball } else { keys[lane] };
        }
        M::lengthen(keys, |lane| own_radius + self.row_radius(group * FANOUT + lane))
    }

    /// The lowest rows of a group's nodes.
    #[inline(always)]
    pub(super) fn lowest_rows_of(&self, group: usize) -> &[u32; FANOUT] {
        &self.lowest_rows.as_chunks().0[group]
    }

    /// How many nodes of a group there are.
    #[inline(always)]
    pub(super) fn width(&self, group: usize) -> usize {
        (self.count - group * FANOUT).min(FANOUT)
    }

    /// The low and high ends of one node's box, by axis.
    pub(super) fn ends_of(
        &self,
        dim: usize,
        node: usize,
    ) -> impl ExactSizeIterator<Item = (f64, f64)> {
        let (group, lane) = (node / FANOUT, node % FANOUT);
        let boxes = &self.boxes[group * dim..][..dim];
        boxes.iter().map(move |ends| (ends[lane], ends[FANOUT + lane]))
    }

    /// The center of the ball of one node.
    pub(super) fn center_of(&self, dim: usize, node: usize) -> Vec<f64> {
        let (group, lane) = (node / FANOUT, node % FANOUT);
        (0..dim).map(|axis| self.centers[group * dim + axis][lane]).collect()
    }
}
