//! The part of space where points may still come.
//!
//! *Idea.* A box behind which a sorted stream cannot go back; or the open cells of a grid, under a tree of boxes that the node
//! function asks as it asks the boxes of other leaves.
//! *Guarantee.* Each point that the region lets in lies in one of its boxes: cells are told apart by comparing with the
//! borders of the boxes themselves.

use std::borrow::Cow;

use super::super::tree::{CellBox, Tree};
use super::{Coherence, option};
use crate::Error;

/// Most bits of a cell's number, so that the boxes of all cells take less than 200 MB.
const CELL_BITS_MAX: u32 = 20;
/// Bytes of a node of the tree with its scaled copy, and of a cell's list of points.
const CELL_BYTES: u64 = 2 * 2 * 64 + 64;

/// Where points may still come.
pub(super) struct Region<const D: usize> {
    within: [[f64; D]; 2],
    kind: Kind<D>,
}

enum Kind<const D: usize> {
    /// From `from` on along `axis`, while points come.
    Sorted {
        axis: usize,
        from: f64,
        is_open: bool,
    },
    Cells(Grid<D>),
}

struct Grid<const D: usize> {
    levels: u32,
    /// The borders of the cells along each axis, 2^levels + 1 of them.
    borders: [Vec<f64>; D],
    /// The boxes of the open cells; of those that are closed nothing is left.
    tree: Tree<D>,
    /// By number.
    is_open: Vec<bool>,
}

impl<const D: usize> Region<D> {
    pub(super) fn new(within: [[f64; D]; 2], coherence: Coherence) -> Result<Self, Error> {
        let [low, high] = within;
        if !(0..D).all(|i| low[i] <= high[i] && low[i].is_finite() && high[i].is_finite()) {
            let expected = "finite numbers, the smallest coordinates first, then the largest";
            return Err(option("within", format!("{low:?} to {high:?}"), expected));
        }
        let kind = match coherence {
            Coherence::Sorted { axis } if axis >= D => {
                return Err(option("axis", axis, "an axis of the points"));
            }
            Coherence::Sorted { axis } => Kind::Sorted { axis, from: low[axis], is_open: true },
            Coherence::Cells { levels } if levels == 0 || levels > CELL_BITS_MAX / D as u32 => {
                return Err(option("levels", levels, "1 to 10 in the plane, 1 to 6 in space"));
            }
            Coherence::Cells { levels } => Kind::Cells(Grid::new(within, levels)),
        };
        Ok(Self { within, kind })
    }

    /// Lists that points wait in.
    pub(super) fn lists(&self) -> usize {
        match &self.kind {
            Kind::Sorted { .. } => 1,
            Kind::Cells(grid) => grid.is_open.len(),
        }
    }

    pub(super) fn levels(&self) -> u32 {
        match &self.kind {
            Kind::Sorted { .. } => 0,
            Kind::Cells(grid) => grid.levels,
        }
    }

    /// Bytes of memory.
    pub(super) fn bytes(&self) -> u64 {
        self.lists() as u64 * CELL_BYTES
    }

    /// The list of a point; an error where it may not be.
    #[inline]
    pub(super) fn place(&self, p: [f64; D], row: u64) -> Result<usize, Error> {
        let [low, high] = &self.within;
        let outside = |what: &'static str| Error::OutsideStream { row, what };
        if !(0..D).all(|i| low[i] <= p[i] && p[i] <= high[i]) {
            return Err(outside("lies outside the box that was given for all points"));
        }
        match &self.kind {
            Kind::Sorted { axis, from, .. } if p[*axis] < *from => {
                Err(outside("comes after a point with a larger coordinate along the axis"))
            }
            Kind::Sorted { .. } => Ok(0),
            Kind::Cells(grid) => {
                let cell = grid.cell(p);
                let is_open = grid.is_open[cell];
                is_open.then_some(cell).ok_or(outside("lies in a cell that was closed"))
            }
        }
    }

    /// Goes on to a point; returns true if those that wait are in closed places now.
    #[inline]
    pub(super) fn advance(&mut self, p: [f64; D]) -> bool {
        match &mut self.kind {
            Kind::Sorted { axis, from, .. } => {
                let advanced = p[*axis] > *from;
                *from = p[*axis];
                advanced
            }
            Kind::Cells(_) => false,
        }
    }

    /// Closes a cell and returns its list.
    pub(super) fn close(&mut self, cell: u64) -> Result<usize, Error> {
        let Kind::Cells(grid) = &mut self.kind else {
            return Err(option("cell", cell, "no cells in a sorted stream"));
        };
        let number = usize::try_from(cell).ok().filter(|&cell| cell < grid.is_open.len());
        let number = number.ok_or_else(|| option("cell", cell, "a cell of the grid"))?;
        if !std::mem::replace(&mut grid.is_open[number], false) {
            return Err(option("cell", cell, "a cell that was not closed before"));
        }
        grid.tree.clear(grid.leaf(number));
        Ok(number)
    }

    pub(super) fn close_all(&mut self) {
        match &mut self.kind {
            Kind::Sorted { is_open, .. } => *is_open = false,
            Kind::Cells(grid) => {
                grid.is_open.fill(false);
                grid.tree = Tree::new(&[CellBox::EMPTY]);
            }
        }
    }

    /// The boxes where points may still come.
    pub(super) fn tree(&self) -> Cow<'_, Tree<D>> {
        match &self.kind {
            Kind::Cells(grid) => Cow::Borrowed(&grid.tree),
            Kind::Sorted { is_open: false, .. } => Cow::Owned(Tree::new(&[CellBox::EMPTY])),
            Kind::Sorted { axis, from, .. } => {
                let [mut low, high] = self.within;
                low[*axis] = *from;
                Cow::Owned(Tree::new(&[CellBox::of([low, high], 1)]))
            }
        }
    }

    /// A point of each connected part of the open cells. A sorted stream has none within the hull of its points.
    pub(super) fn seeds(&self) -> Vec<[f64; D]> {
        match &self.kind {
            Kind::Sorted { .. } => vec![],
            Kind::Cells(grid) => grid.seeds(),
        }
    }
}

impl<const D: usize> Grid<D> {
    fn new([low, high]: [[f64; D]; 2], levels: u32) -> Self {
        let side = 1usize << levels;
        let borders = std::array::from_fn(|i| {
            // Halves before they are subtracted, so that no difference overflows. The last border is exact.
            let half = high[i] * 0.5 - low[i] * 0.5;
            let at = |k: usize| low[i] + half * (k as f64 / side as f64) * 2.0;
            let mut borders: Vec<f64> = (0..side).map(|k| at(k).clamp(low[i], high[i])).collect();
            borders.push(high[i]);
            borders
        });
        let count = side.pow(D as u32);
        let mut grid = Self {
            levels,
            borders,
            tree: Tree::new(&[CellBox::EMPTY]),
            is_open: vec![true; count],
        };
        let mut cells = vec![CellBox::EMPTY; count];
        for number in 0..count {
            let place = grid.along_axes(number);
            let corner = |above: usize| std::array::from_fn(|i| grid.borders[i][place[i] + above]);
            cells[grid.leaf(number) as usize - (count - 1)] = CellBox::of([0, 1].map(corner), 1);
        }
        grid.tree = Tree::new(&cells);
        grid
    }

    /// The cell of a point in the box: along each axis the last with a lower border not above it.
    #[inline]
    fn cell(&self, p: [f64; D]) -> usize {
        let side = 1usize << self.levels;
        (0..D).rev().fold(0, |cell, i| {
            let borders = &self.borders[i];
            let width = borders[side] - borders[0];
            let guess = ((p[i] - borders[0]) / width * side as f64) as usize;
            let mut k = guess.min(side - 1);
            while k > 0 && p[i] < borders[k] {
                k -= 1;
            }
            while k + 1 < side && p[i] >= borders[k + 1] {
                k += 1;
            }
            cell << self.levels | k
        })
    }

    /// The places of a cell along the axes.
    fn along_axes(&self, number: usize) -> [usize; D] {
        let mask = (1 << self.levels) - 1;
        std::array::from_fn(|i| number >> (i as u32 * self.levels) & mask)
    }

    /// The leaf of a cell in the tree, which cuts along all axes in turn.
    fn leaf(&self, number: usize) -> u32 {
        let place = self.along_axes(number);
        let mut leaf = 0;
        for bit in (0..self.levels).rev() {
            for along in place {
                leaf = leaf << 1 | along >> bit & 1;
            }
        }
        (leaf + self.is_open.len() - 1) as u32
    }

    fn seeds(&self) -> Vec<[f64; D]> {
        let mut seen = vec![false; self.is_open.len()];
        let (mut seeds, mut open) = (Vec::new(), Vec::new());
        for first in 0..seen.len() {
            if !self.is_open[first] || seen[first] {
                continue;
            }
            let place = self.along_axes(first);
            seeds.push(std::array::from_fn(|i| self.borders[i][place[i]]));
            seen[first] = true;
            open.push(first);
            while let Some(cell) = open.pop() {
                let place = self.along_axes(cell);
                for (i, &along) in place.iter().enumerate() {
                    let step = 1 << (i as u32 * self.levels);
                    let below = (along > 0).then(|| cell - step);
                    let above = (along + 1 < 1 << self.levels).then_some(cell + step);
                    for next in below.into_iter().chain(above) {
                        if self.is_open[next] && !seen[next] {
                            seen[next] = true;
                            open.push(next);
                        }
                    }
                }
            }
        }
        seeds
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_lies_in_the_box_of_its_cell() {
        let within = [[-0.3, 1e-3], [0.7, 17.0]];
        let grid = Grid::new(within, 5);
        let borders =
            |i: usize| grid.borders[i].iter().flat_map(|&x| [x.next_down(), x, x.next_up()]);
        for x in borders(0).filter(|x| (-0.3..=0.7).contains(x)) {
            for y in borders(1).filter(|y| (1e-3..=17.0).contains(y)) {
                let cell = grid.cell([x, y]);
                let bounds = grid.tree.cell(grid.leaf(cell)).bounds;
                assert!(bounds.holds([x, y]), "{x} {y}");
                let place = grid.along_axes(cell);
                assert!(x >= grid.borders[0][place[0]] && y >= grid.borders[1][place[1]]);
            }
        }
    }

    #[test]
    fn boxes_of_any_size_have_borders_in_order() {
        for within in
            [[[-1.7e308], [1.7e308]], [[5e-324], [5e-324]], [[0.0], [5e-324]], [[3.0], [3.0]]]
        {
            let grid = Grid::<1>::new(within, 4);
            assert!(grid.borders[0].is_sorted() && grid.borders[0].iter().all(|x| x.is_finite()));
            for x in [within[0][0], within[1][0]] {
                assert!(grid.tree.cell(grid.leaf(grid.cell([x]))).bounds.holds([x]));
            }
        }
    }

    #[test]
    fn each_connected_part_of_the_open_cells_has_a_seed() {
        let mut region = Region::new([[0.0; 2], [4.0; 2]], Coherence::Cells { levels: 2 }).unwrap();
        assert_eq!(region.seeds(), [[0.0, 0.0]]);
        // A cross of closed cells leaves four corners, one of them of 2 × 2 cells.
        for cell in [1, 5, 9, 13, 4, 6, 7] {
            region.close(cell).unwrap();
        }
        assert_eq!(region.seeds(), [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0], [2.0, 2.0]]);
        assert!(region.close(5).is_err() && region.close(16).is_err());
        assert_eq!(region.tree().cell(0).count, 9);
        region.close_all();
        assert!(region.seeds().is_empty() && region.tree().cell(0).count == 0);
    }
}
