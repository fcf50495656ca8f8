//! Cuts buckets again that came out larger than a leaf may be.
//!
//! *Problem.* A sample cuts unevenly, and heaps of points that it missed end in one bucket.
//! *Idea.* The cells below a bucket were counted while points were distributed; the largest of them that fit are its leaves.
//! A cell without cells below that is too large gets a router of its own, from a sample of its points and the corners of its
//! box, so that it is cut as long as two of its points differ.
//! *Guarantee.* Leaves have at most so many points, but for equal ones, which nothing can part. The cut is a function of the
//! points and of the plan.
//! *Trap.* A crash in the meantime must not lose points: the first buckets stay until the tree with the new leaves is written.

use taut_points::OrderBy;

use super::buckets::{Bucket, Buffers, read_records};
use super::folder::{Folder, remove};
use super::plan::DiskPlan;
use crate::Error;
use crate::outofcore::tree::{CellBox, FINE_LEVELS, Router, Tree};

/// Points of the sample of a cell.
const SAMPLE_POINTS: u64 = 1 << 14;

/// The leaves of the tree, in order, and the buckets that are of no use any more.
pub(super) struct Leaves {
    pub(super) leaves: Vec<u32>,
    pub(super) replaced: Vec<u32>,
}

/// Cuts all buckets that are too large; `buckets` are their nodes, in the order of the router's cells.
pub(super) fn split<const D: usize>(
    tree: &mut Tree<D>,
    router: &Router<D>,
    buckets: &[u32],
    plan: &DiskPlan,
    folder: &Folder,
) -> Result<Leaves, Error> {
    let mut splitting = Splitting { plan, folder, leaves: vec![], replaced: vec![] };
    for (k, &bucket) in buckets.iter().enumerate() {
        if tree.cell(bucket).count <= plan.leaf_points {
            splitting.leaves.push(bucket);
            continue;
        }
        let mut cells = vec![bucket];
        for _ in 0..FINE_LEVELS {
            cells = cells.iter().flat_map(|&c| tree.children(c).unwrap_or([c; 2])).collect();
        }
        let first = k << FINE_LEVELS;
        let cell = |p: [f64; D]| router.cell(p).saturating_sub(first).min(cells.len() - 1);
        splitting.cut(tree, bucket, &cells, &cell)?;
        splitting.replaced.push(bucket);
    }
    Ok(Leaves { leaves: splitting.leaves, replaced: splitting.replaced })
}

struct Splitting<'a> {
    plan: &'a DiskPlan,
    folder: &'a Folder,
    leaves: Vec<u32>,
    replaced: Vec<u32>,
}

impl Splitting<'_> {
    /// Cuts a node that has cells below; `cells` are the last of these, and `cell` finds that of a point.
    fn cut<const D: usize>(
        &mut self,
        tree: &mut Tree<D>,
        node: u32,
        cells: &[u32],
        cell: &dyn Fn([f64; D]) -> usize,
    ) -> Result<(), Error> {
        let mut parts = Vec::new();
        let mut open = vec![node];
        while let Some(next) = open.pop() {
            match tree.children(next).filter(|_| tree.cell(next).count > self.plan.leaf_points) {
                Some([left, right]) => open.extend([right, left]),
                None => parts.push(next),
            }
        }
        let part_of_cell = part_of_cells(tree, cells, &parts);
        let row_bytes = self.plan.row_bytes;
        let files = parts
            .iter()
            .map(|&part| Bucket::open(&self.folder.bucket(part), 0))
            .collect::<Result<Vec<_>, _>>()?;
        let buffer = self.plan.buffer_bytes as usize;
        let mut buffers = Buffers::new(files.len(), buffer, D, row_bytes);
        read_records(&self.folder.bucket(node), row_bytes, |p, row| {
            buffers.push(&files, part_of_cell[cell(p)], p, row)
        })?;
        buffers.flush(&files)?;
        files.iter().try_for_each(|file| file.sync().map(drop))?;
        drop((files, buffers));
        for part in parts {
            let CellBox { bounds, count } = *tree.cell(part);
            if count <= self.plan.leaf_points || bounds.low == bounds.high {
                self.leaves.push(part);
                continue;
            }
            let (router, below) = self.grow(tree, part)?;
            self.cut(tree, part, &below, &|p| router.cell(p))?;
            remove(&self.folder.bucket(part))?;
        }
        Ok(())
    }

    /// Gives a node without children a router of its own and the cells of that.
    fn grow<const D: usize>(
        &self,
        tree: &mut Tree<D>,
        node: u32,
    ) -> Result<(Router<D>, Vec<u32>), Error> {
        let (path, row_bytes) = (self.folder.bucket(node), self.plan.row_bytes);
        let CellBox { bounds, count } = *tree.cell(node);
        let stride = count.div_ceil(SAMPLE_POINTS).max(1);
        // The rows decide who is in the sample, as the order of records is no function of the points.
        let mut sample = vec![bounds.low, bounds.high];
        read_records(&path, row_bytes, |p: [f64; D], row| {
            if row.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 32 < (1 << 32) / stride {
                sample.push(p);
            }
            Ok(())
        })?;
        sample.order_by(&|a, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
        let wanted = (count * 5).div_ceil(self.plan.leaf_points * 4).next_power_of_two().ilog2();
        let router = Router::new(sample, (wanted + FINE_LEVELS).min(SPLIT_LEVELS_MAX));
        let mut cells = vec![CellBox::EMPTY; router.cells()];
        read_records(&path, row_bytes, |p, _| {
            cells[router.cell(p)].add(p);
            Ok(())
        })?;
        let below = tree.grow(node, &cells);
        Ok((router, below))
    }
}

/// Most levels below a cell that is cut again.
const SPLIT_LEVELS_MAX: u32 = 14;

/// For each cell the place of the part that it lies in.
fn part_of_cells<const D: usize>(tree: &Tree<D>, cells: &[u32], parts: &[u32]) -> Vec<usize> {
    let mut part_of_node = vec![usize::MAX; tree.len()];
    for (place, &part) in parts.iter().enumerate() {
        let mut open = vec![part];
        while let Some(node) = open.pop() {
            part_of_node[node as usize] = place;
            open.extend(tree.children(node).into_iter().flatten());
        }
    }
    cells.iter().map(|&cell| part_of_node[cell as usize].min(parts.len() - 1)).collect()
}
