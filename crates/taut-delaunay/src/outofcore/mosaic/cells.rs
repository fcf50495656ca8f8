//! Voronoi cells tile by tile.
//!
//! *Idea.* The cell of a site needs all simplices at it, its star. A site that went up in the tree has parts of its star in
//! several tiles; the one with the smallest number has its cell.
//! *Guarantee.* Each site has one cell, the one of [`Locator::voronoi_cell`](crate::Locator::voronoi_cell), bit by bit where
//! coordinates need no other scale.
//! *Cost.* O(k²) for k neighbors; a simplex of another tile is read again for each of its vertices.

use std::collections::HashSet;

use taut_points::parallel::ParallelSlice;
use taut_points::{Monitor, OrderBy};

use super::{Mosaic, Place, Tile, View};
use crate::query::{Body, clipped};
use crate::{Error, Polygon, Polyhedron};

/// Sites of one task.
const TASK: usize = 1 << 10;

/// Tasks whose cells wait for their turn.
const TASKS_AT_ONCE: usize = 64;

/// Not a simplex.
const UNUSED: u32 = u32::MAX;

impl<const D: usize> Mosaic<D> {
    /// The cells of the sites of a tile, each with its row, to `put`. `W` is the number of vertices of a simplex.
    fn cells<const W: usize, B: Body<D> + Send>(
        &self,
        tile: &Tile<D>,
        frame: [[f64; D]; 2],
        monitor: &Monitor<'_>,
        put: &mut dyn FnMut(u64, &B) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let view = View::new(self, tile);
        let mut at_site = vec![UNUSED; tile.rows.len()];
        for (simplex, sites) in (0..).zip(tile.simplex_rows()) {
            sites.iter().for_each(|&v| at_site[v as usize] = simplex);
        }
        for (round, sites) in at_site.chunks(TASK * TASKS_AT_ONCE).enumerate() {
            monitor.check()?;
            let first = round * TASK * TASKS_AT_ONCE;
            let cells: Vec<Vec<(u64, B)>> = sites
                .par_chunks(TASK)
                .enumerate()
                .map(|(task, sites)| {
                    let numbers = (first + task * TASK..).zip(sites);
                    let used = numbers.filter(|&(_, &simplex)| simplex != UNUSED);
                    let cells = used.map(|(site, &simplex)| {
                        let (row, here) = (tile.rows[site], tile.coordinates[site]);
                        let others = star::<D, W>(&view, simplex, row)?;
                        Ok(others.map(|mut others| (row, clipped(here, &mut others, frame))))
                    });
                    cells.filter_map(Result::transpose).collect()
                })
                .collect::<Result<_, Error>>()?;
            cells.iter().flatten().try_for_each(|(row, cell)| put(*row, cell))?;
        }
        monitor.points(tile.counts.simplices);
        Ok(())
    }
}

/// The sites that are joined with the site of a row, one of whose simplices is given; `None` if a tile with a smaller number
/// has a part of its star.
fn star<const D: usize, const W: usize>(
    view: &View<'_, D>,
    simplex: u32,
    row: u64,
) -> Result<Option<Vec<[f64; D]>>, Error> {
    let first = view.place(simplex);
    let mut open: Vec<Place> = vec![first];
    let mut seen = HashSet::from([first]);
    let mut others: Vec<(u64, [f64; D])> = vec![];
    while let Some(place) = open.pop() {
        let corners = view.corners::<W>(place)?;
        for i in 0..W {
            if corners.rows[i] == row {
                continue;
            }
            others.push((corners.rows[i], corners.at[i]));
            let Some(across) = view.across(place, &corners, i) else { continue };
            if across.tile < first.tile {
                return Ok(None);
            }
            if seen.insert(across) {
                open.push(across);
            }
        }
    }
    others.order_by_key(|other| other.0);
    others.dedup_by_key(|other| other.0);
    Ok(Some(others.into_iter().map(|(_, at)| at).collect()))
}

/// The same in the plane and in space.
macro_rules! voronoi_cells {
    ($d:literal, $cell:ident, $($w:literal)*) => {
        impl Mosaic<$d> {
            /// The Voronoi cells of all sites, clipped to the box between two corners, each with the smallest row of its site, tile
            /// by tile. Sites that do not span all dimensions have cells, too; a single site has all of the box.
            ///
            /// # Errors
            /// Those of `put`, of reading, and of the monitor.
            pub fn voronoi_cells(
                &self,
                frame: [[f64; $d]; 2],
                monitor: &Monitor<'_>,
                put: &mut dyn FnMut(u64, &$cell) -> Result<(), Error>,
            ) -> Result<(), Error> {
                monitor.pass(1, self.simplices);
                let mut cells = |&tile| self.voronoi_cells_of(tile, frame, monitor, put);
                self.numbers.iter().try_for_each(&mut cells)
            }

            /// The Voronoi cells that belong to one tile, as those of all.
            ///
            /// # Errors
            /// Those of `put`, of reading, and of the monitor.
            ///
            /// # Panics
            /// If there is no such tile.
            pub fn voronoi_cells_of(
                &self,
                tile: u32,
                frame: [[f64; $d]; 2],
                monitor: &Monitor<'_>,
                put: &mut dyn FnMut(u64, &$cell) -> Result<(), Error>,
            ) -> Result<(), Error> {
                let tile = self.tile(tile)?;
                match tile.counts.vertices_per_simplex {
                    $($w => self.cells::<$w, _>(&tile, frame, monitor, put),)*
                    _ => Ok(()),
                }
            }
        }
    };
}
voronoi_cells!(2, Polygon, 1 2 3);
voronoi_cells!(3, Polyhedron, 1 2 3 4);
