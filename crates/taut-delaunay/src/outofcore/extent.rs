//! The facts about points elsewhere that a node has to know, as bytes: the boxes of all cells, and the magnitudes.
//!
//! *Idea.* Whoever has points adds them to an extent of his own; extents are merged in any order. All nodes take the same one.

use taut_points::{ByteReader, ByteWriter, PartsError};

use super::solve::Whole;
use super::tree::{CellBox, Tree};
use crate::sites::Magnitudes;

/// The boxes of the cells of a [`Router`](super::Router) around some points, and the magnitudes of their coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Extent<const D: usize> {
    cells: Vec<CellBox<D>>,
    magnitudes: Magnitudes,
}

/// The word that bytes of an extent begin with.
const EXTENT: &str = "extent";

impl<const D: usize> Extent<D> {
    /// That of no points, over so many cells, a power of two.
    pub fn new(cells: usize) -> Self {
        Extent { cells: vec![CellBox::EMPTY; cells], magnitudes: Magnitudes::EMPTY }
    }

    /// Adds a point that comes to a cell.
    ///
    /// # Panics
    /// If there is no such cell.
    pub fn add(&mut self, cell: usize, p: [f64; D]) {
        self.cells[cell].add(p);
        p.iter().for_each(|&x| self.magnitudes.add(x));
    }

    /// The extent of these points and of others, which came to the same cells.
    ///
    /// # Errors
    /// [`PartsError::Question`] if there are other cells.
    pub fn merge(mut self, other: &Self) -> Result<Self, PartsError> {
        if self.cells.len() != other.cells.len() {
            return Err(PartsError::Question);
        }
        self.cells.iter_mut().zip(&other.cells).for_each(|(cell, other)| cell.merge(other));
        self.magnitudes.merge(other.magnitudes);
        Ok(self)
    }

    /// Points in all cells.
    pub fn len(&self) -> u64 {
        self.cells.iter().map(|cell| cell.count).sum()
    }

    /// Points in the cells of a node: 0 is the root, and 2i + 1 and 2i + 2 lie below i.
    pub fn points_of(&self, node: u32) -> u64 {
        let number = u64::from(node) + 1;
        let level = number.ilog2();
        let (first, count) =
            ((number - (1 << level)) as usize, self.cells.len().checked_shr(level).unwrap_or(0));
        self.cells[first * count..][..count].iter().map(|cell| cell.count).sum()
    }

    /// Returns true if there is no point.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the facts that all nodes have in common, once this is of all points.
    pub fn whole(&self) -> Whole<D> {
        Whole::new(&Tree::new(&self.cells), self.magnitudes, true)
    }

    /// The extent as bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = ByteWriter::new(EXTENT);
        bytes.count(D);
        bytes.float(self.magnitudes.largest);
        bytes.whole(i64::from(self.magnitudes.lowest).cast_unsigned());
        bytes.count(self.cells.len());
        for cell in &self.cells {
            bytes.whole(cell.count);
            cell.corners().as_flattened().iter().for_each(|&x| bytes.float(x));
        }
        bytes.into_bytes()
    }

    /// Reads what [`to_bytes`](Self::to_bytes) wrote.
    ///
    /// # Errors
    /// [`PartsError::Bytes`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, PartsError> {
        let mut bytes = ByteReader::new(EXTENT, bytes)?;
        if bytes.size()? != D {
            return Err(bytes.wrong());
        }
        let (largest, lowest) = (bytes.float()?, bytes.whole()?.cast_signed());
        let lowest = i32::try_from(lowest).map_err(|_| bytes.wrong())?;
        let count = bytes.count(8 * (1 + 2 * D))?;
        if !count.is_power_of_two() || !largest.is_finite() {
            return Err(bytes.wrong());
        }
        let mut cells = Vec::with_capacity(count);
        for _ in 0..count {
            let points = bytes.whole()?;
            let mut corners = [[0.0; D]; 2];
            for x in corners.as_flattened_mut() {
                *x = bytes.float()?;
            }
            cells.push(CellBox::of(corners, points));
        }
        bytes.end(Extent { cells, magnitudes: Magnitudes { largest, lowest } })
    }
}

#[cfg(test)]
mod tests {
    use taut_points::Monitor;

    use super::super::tests::plane_sets;
    use super::super::{
        FINE_LEVELS, Front, NodeJob, NodePoints, Router, TileCounts, finish, merge, summarize,
    };
    use super::*;
    use crate::{DelaunayOptions, delaunay};

    const LEVELS: u32 = 3;

    /// A node of which all is bytes before and after.
    fn run(
        extent: &[u8],
        node: u32,
        work: Result<NodePoints<2>, Vec<Vec<u8>>>,
    ) -> (TileCounts, Vec<u8>) {
        let whole = Extent::<2>::from_bytes(extent).unwrap().whole();
        let job = NodeJob { node, row_bytes: 4, output: "memory" };
        let (monitor, mut out) = (Monitor::silent(), Vec::new());
        let (counts, front) = match work {
            Ok(points) => summarize(&whole, job, points, &mut out, &monitor).unwrap(),
            Err(fronts) => {
                let mut all = Front::empty();
                fronts.iter().for_each(|front| all.append(Front::from_bytes(front).unwrap()));
                match node {
                    0 => (finish(&whole, job, all, &mut out, &monitor).unwrap(), Front::empty()),
                    _ => merge(&whole, job, all, &mut out, &monitor).unwrap(),
                }
            }
        };
        (counts, front.to_bytes())
    }

    /// Points dealt from three places to eight leaves, whose fronts go up two levels at once, and then one.
    #[test]
    fn points_in_parts_have_the_fingerprint_of_those_in_memory() {
        for (name, points) in plane_sets() {
            let router =
                Router::new(points.iter().step_by(7).copied().collect(), LEVELS + FINE_LEVELS);
            let mut leaves = vec![NodePoints::<2>::default(); 1 << LEVELS];
            let mut extent = Extent::<2>::new(router.cells());
            for part in 0..3 {
                let mut seen = Extent::<2>::new(router.cells());
                for (row, &p) in (0u64..).zip(&points).skip(part).step_by(3) {
                    let p = p.map(|x| x + 0.0);
                    seen.add(router.cell(p), p);
                    leaves[router.cell(p) >> FINE_LEVELS].push(p, row);
                }
                extent = extent.merge(&Extent::from_bytes(&seen.to_bytes()).unwrap()).unwrap();
            }
            assert_eq!(extent.len(), points.len() as u64);
            assert_eq!(extent.points_of(0), extent.len());
            assert_eq!(extent.points_of(4000), 0, "below all cells");
            let (whole, extent) = (extent.clone(), extent.to_bytes());
            let mut counts = vec![];
            let mut fronts = [vec![], vec![]];
            for (leaf, points) in leaves.into_iter().enumerate() {
                let node = 7 + leaf as u32;
                assert_eq!(whole.points_of(node), points.rows.len() as u64, "{name}");
                let (tile, front) = run(&extent, node, Ok(points));
                counts.push(tile);
                fronts[leaf / 4].push(front);
            }
            let mut top = vec![];
            for (node, fronts) in (1..).zip(fronts) {
                let (tile, front) = run(&extent, node, Err(fronts));
                counts.push(tile);
                top.push(front);
            }
            counts.push(run(&extent, 0, Err(top)).0);
            let mut fingerprint = taut_certify::Fingerprint::default();
            counts.iter().for_each(|tile| fingerprint.merge(tile.fingerprint));
            let flat = points.as_flattened();
            let in_memory =
                delaunay(&taut_points::Points::new(flat, 2).unwrap(), &DelaunayOptions::default())
                    .unwrap();
            assert_eq!(fingerprint, in_memory.certificate.fingerprint, "{name}");
            let simplices: u64 = counts.iter().map(|tile| tile.simplices).sum();
            let width = in_memory.answer.vertices_per_simplex() as u64;
            assert_eq!(simplices * width, in_memory.answer.simplices.len() as u64, "{name}");
        }
    }
}
