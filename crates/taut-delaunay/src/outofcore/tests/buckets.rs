//! A driver in memory: buckets as lists, tiles and fronts as bytes.

use std::collections::BTreeMap;
use std::io::Write;
use std::sync::Mutex;

use taut_points::Monitor;

use super::super::driver::{Course, NodeRecord, Storage, Totals, Walk, WriteNode, run};
use super::super::{
    CellBox, Dim, Dimension, FINE_LEVELS, Front, Magnitudes, NodePoints, Router, Tile, Tree, Whole,
};
use crate::Error;

/// Bytes of a tile and of a front.
type NodeBytes = (Vec<u8>, Vec<u8>);

/// Lists by node.
struct Lists<const D: usize> {
    buckets: Mutex<BTreeMap<u32, NodePoints<D>>>,
    nodes: Mutex<BTreeMap<u32, NodeBytes>>,
}

impl<const D: usize> Storage<D> for Lists<D> {
    fn points(&self, leaf: u32) -> Result<NodePoints<D>, Error> {
        Ok(self.buckets.lock().unwrap().get(&leaf).cloned().unwrap_or_default())
    }

    fn front(&self, node: u32) -> Result<Front<D>, Error> {
        Front::from_bytes(&self.nodes.lock().unwrap()[&node].1)
    }

    fn store(&self, node: u32, write: &mut WriteNode<'_, D>) -> Result<NodeRecord, Error> {
        let mut tile = Vec::new();
        let (counts, front) = write("memory", &mut tile as &mut dyn Write)?;
        let record = NodeRecord {
            counts,
            front_sites: front.len() as u64,
            front_facets: front.facets.len() as u64,
        };
        let earlier = self.nodes.lock().unwrap().insert(node, (tile, front.to_bytes()));
        assert!(earlier.is_none(), "node {node} is stored once");
        Ok(record)
    }

    fn stored(&self, _: u32) -> Result<Option<NodeRecord>, Error> {
        Ok(None)
    }

    fn release(&self, leaf: u32) {
        self.buckets.lock().unwrap().remove(&leaf);
    }
}

/// How a test cuts and merges.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cut {
    /// 2^levels buckets.
    pub(super) levels: u32,
    pub(super) merge_above: u64,
    pub(super) threads: usize,
    /// Every so many points are the sample.
    pub(super) stride: usize,
}

/// The tiles of points, by node, and the bytes of all nodes.
pub(super) fn tiles<const D: usize>(
    points: &[[f64; D]],
    cut: Cut,
) -> (Vec<Tile<D>>, Totals, Vec<u8>)
where
    Dim<D>: Dimension<D>,
{
    let sample = points.iter().step_by(cut.stride).copied().collect();
    let router = Router::new(sample, cut.levels + FINE_LEVELS);
    let mut cells = vec![CellBox::EMPTY; router.cells()];
    let mut magnitudes = Magnitudes::EMPTY;
    let mut buckets = vec![NodePoints::default(); 1 << cut.levels];
    for (row, p) in (0u64..).zip(points) {
        let p = p.map(|x| x + 0.0);
        let cell = router.cell(p);
        cells[cell].add(p);
        p.iter().for_each(|&x| magnitudes.add(x));
        buckets[cell >> FINE_LEVELS].push(p, row);
    }
    let tree = Tree::new(&cells);
    let mut leaves = vec![0u32];
    for _ in 0..cut.levels {
        leaves = leaves.iter().flat_map(|&node| tree.children(node).unwrap()).collect();
    }
    let whole = Whole::new(&tree, magnitudes, true);
    let walk = Walk::new(|node| tree.children(node), |node| leaves.contains(&node));
    let lists = Lists {
        buckets: Mutex::new(leaves.iter().copied().zip(buckets).collect()),
        nodes: Mutex::default(),
    };
    let course = Course {
        merge_above: cut.merge_above,
        row_bytes: if cut.stride == 1 { 4 } else { 8 },
        threads: cut.threads,
        budget: u64::MAX,
        site_bytes: 100,
    };
    let sites = |leaf: u32| tree.cell(leaf).count;
    let totals = run(&whole, &walk, &course, &sites, &lists, &Monitor::silent()).unwrap();
    let nodes = lists.nodes.into_inner().unwrap();
    let bytes =
        nodes.values().flat_map(|(tile, front)| tile.iter().chain(front)).copied().collect();
    let tiles = nodes.values().map(|(tile, _)| Tile::from_bytes(tile).unwrap()).collect();
    (tiles, totals, bytes)
}
