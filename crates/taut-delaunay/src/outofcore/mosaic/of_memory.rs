//! A triangulation in memory as one tile.

use std::sync::Arc;

use taut_points::parallel::ParallelSlice;

use super::{Mosaic, Tiles};
use crate::Triangulation;
use crate::canonical::arrangement;
use crate::outofcore::tile::{NO_NEIGHBOR, Tile, TileCounts};
use crate::simplex::decode;

impl<const D: usize> Mosaic<D> {
    /// A triangulation in memory as one tile. Sites that do not span all dimensions have no simplices here.
    ///
    /// Takes 24 bytes a site and 8 a vertex of a simplex beside the triangulation, and half as much again for a while.
    pub fn of<const V: usize>(found: &Triangulation<D, V>) -> Self {
        let slots = found.slots();
        // Slots depend on the threads, the order of vertices does not.
        let mut order: Vec<([u32; V], u32)> = found
            .simplices()
            .map(|t| {
                let mut vertices = slots[t as usize].vertices;
                vertices.sort_unstable();
                (vertices, t)
            })
            .collect();
        order.par_sort_unstable();
        let mut numbers = vec![NO_NEIGHBOR; slots.len()];
        (0u32..).zip(&order).for_each(|(number, &(_, t))| numbers[t as usize] = number);
        let simplices = order.len() as u32;
        let mut tile = Tile {
            counts: TileCounts {
                vertices_per_simplex: if simplices > 0 { V as u32 } else { 0 },
                row_bytes: 4,
                sites: found.site_count() as u64,
                duplicates: found.duplicates().len() as u64,
                simplices: simplices.into(),
                ..TileCounts::default()
            },
            coordinates: (0..found.site_count() as u32).map(|v| found.site(v)).collect(),
            rows: (0..found.site_count() as u32).map(|v| found.row(v).into()).collect(),
            duplicates: found.duplicates().iter().map(|pair| pair.map(u64::from)).collect(),
            simplices: Vec::with_capacity(simplices as usize * V),
            neighbors: Vec::with_capacity(simplices as usize * V),
            copies: vec![],
            links: vec![],
        };
        for (_, t) in order {
            let simplex = &slots[t as usize];
            for i in arrangement(&simplex.vertices) {
                let i = usize::from(i);
                tile.simplices.push(simplex.vertices[i]);
                // A ghost has no number.
                tile.neighbors.push(numbers[decode(simplex.neighbors[i]).0 as usize]);
            }
        }
        tile.counts.hull = tile.neighbors.iter().filter(|&&n| n == NO_NEIGHBOR).count() as u64;
        Self {
            tiles: Tiles::Memory(Arc::new(tile)),
            numbers: vec![0],
            simplices: simplices.into(),
            vertices: if simplices > 0 { V } else { 0 },
            sides: vec![],
        }
    }
}
