//! A triangulation tile by tile, for what is computed from it: of a folder, or of memory as one tile.
//!
//! *Problem.* Contour lines, interpolation, Voronoi cells and alpha complexes ask for simplices side by side. In a folder
//! some of these are in different tiles.
//! *Idea.* One tile at a time is in memory. The links of all tiles are, too, both ways: a few bytes for each facet between
//! tiles. A step across such a facet reads one simplex of another file, and few steps lead there.
//! *Guarantee.* The same corners in the same order, whichever tiles hold them: what is computed from corners in an order that
//! coordinates decide has the same bits for every tiling, and in memory.
//! *Cost.* 32 bytes a link. A step across costs 2 + 2·(D + 1) reads of a few bytes.

mod alpha;
mod cells;
mod files;
mod of_memory;

use std::path::Path;
use std::sync::Arc;

use super::front::Link;
use super::tile::{NO_NEIGHBOR, OTHER_TILE, Tile};
use crate::Error;
use files::TileFiles;

pub use alpha::AlphaPart;

/// A triangulation of points of dimension `D`, tile by tile.
pub struct Mosaic<const D: usize> {
    tiles: Tiles<D>,
    numbers: Vec<u32>,
    simplices: u64,
    vertices: usize,
    /// Both sides of each facet between two tiles, one way and the other, ascending.
    sides: Vec<[Side; 2]>,
}

enum Tiles<const D: usize> {
    Memory(Arc<Tile<D>>),
    Folder(TileFiles<D>),
}

/// A side of a facet: the number of a tile, simplex << 2 | facet.
type Side = (u32, u32);

/// A simplex of a mosaic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Place {
    pub(crate) tile: u32,
    pub(crate) simplex: u32,
}

/// The corners of a simplex in positive order.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corners<const D: usize, const W: usize> {
    pub(crate) rows: [u64; W],
    pub(crate) at: [[f64; D]; W],
    neighbors: [u32; W],
}

/// Bytes of memory for a link.
const LINK_BYTES: u64 = 2 * size_of::<[Side; 2]>() as u64;

impl<const D: usize> Mosaic<D> {
    /// Opens a folder of tiles that is complete.
    ///
    /// # Errors
    /// [`Error::UnfinishedFolder`] if it is not, [`Error::Input`] for points of another dimension, [`Error::DamagedFolder`],
    /// [`Error::File`], and [`Error::LinkMemory`] if the links of all tiles take more than `memory` bytes.
    pub fn open(folder: &Path, memory: u64) -> Result<Self, Error> {
        let files = TileFiles::open(folder)?;
        let links = files.counts().map(|counts| counts.links).sum::<u64>();
        let needed = links.saturating_mul(LINK_BYTES);
        if needed > memory {
            return Err(Error::LinkMemory { links, needed, budget: memory });
        }
        let mut sides = Vec::new();
        for number in files.numbers() {
            for link in files.links(number)? {
                // What turned out to lie on the hull has one side.
                if link.code != Link::OUTSIDE && !link.link.is_outside() {
                    let (here, there) = ((number, link.code), (link.link.tile, link.link.code));
                    sides.extend([[here, there], [there, here]]);
                }
            }
        }
        sides.sort_unstable();
        let numbers = files.numbers().collect();
        let simplices = files.counts().map(|counts| counts.simplices).sum();
        let vertices = files.counts().map(|counts| counts.vertices_per_simplex).max().unwrap_or(0);
        let (tiles, vertices) = (Tiles::Folder(files), vertices as usize);
        Ok(Self { tiles, numbers, simplices, vertices, sides })
    }

    /// The numbers of the tiles, ascending.
    pub fn tiles(&self) -> &[u32] {
        &self.numbers
    }

    /// The number of all simplices.
    pub fn simplices(&self) -> u64 {
        self.simplices
    }

    /// Vertices of a simplex: one more than the dimension of the affine hull of the points; 0 if there are no simplices.
    pub fn vertices_per_simplex(&self) -> usize {
        self.vertices
    }

    /// A tile; its sum was compared.
    ///
    /// # Errors
    /// [`Error::DamagedFolder`] and [`Error::File`].
    ///
    /// # Panics
    /// If there is no such tile.
    pub fn tile(&self, number: u32) -> Result<Arc<Tile<D>>, Error> {
        match &self.tiles {
            Tiles::Memory(tile) => Ok(tile.clone()),
            Tiles::Folder(files) => files.tile(number).map(Arc::new),
        }
    }

    /// The least and the largest coordinates of all sites; `None` if there are none. Reads the coordinates of all tiles.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn extent(&self) -> Result<Option<[[f64; D]; 2]>, Error> {
        let mut extent = [[f64::INFINITY; D], [f64::NEG_INFINITY; D]];
        let mut add = |p: &[f64; D]| {
            for (k, &x) in p.iter().enumerate() {
                extent[0][k] = extent[0][k].min(x);
                extent[1][k] = extent[1][k].max(x);
            }
        };
        match &self.tiles {
            Tiles::Memory(tile) => tile.coordinates.iter().for_each(add),
            Tiles::Folder(files) => {
                for &number in &self.numbers {
                    files.each_site(number, &mut add)?;
                }
            }
        }
        Ok((extent[0][0] <= extent[1][0]).then_some(extent))
    }

    fn other_side(&self, side: Side) -> Option<Side> {
        let at = self.sides.partition_point(|sides| sides[0] < side);
        self.sides.get(at).filter(|sides| sides[0] == side).map(|sides| sides[1])
    }
}

/// A mosaic as seen from one of its tiles, which is in memory.
#[derive(Clone, Copy)]
pub(crate) struct View<'a, const D: usize> {
    mosaic: &'a Mosaic<D>,
    pub(crate) tile: &'a Tile<D>,
}

impl<'a, const D: usize> View<'a, D> {
    pub(crate) fn new(mosaic: &'a Mosaic<D>, tile: &'a Tile<D>) -> Self {
        Self { mosaic, tile }
    }

    pub(crate) fn place(&self, simplex: u32) -> Place {
        Place { tile: self.tile.counts.tile, simplex }
    }

    /// The corners of a simplex of `W` vertices, of this tile or of another.
    pub(crate) fn corners<const W: usize>(&self, at: Place) -> Result<Corners<D, W>, Error> {
        match &self.mosaic.tiles {
            Tiles::Folder(files) if at.tile != self.tile.counts.tile => {
                files.corners(at.tile, at.simplex)
            }
            _ => Ok(self.tile.corners(at.simplex)),
        }
    }

    /// The simplex across a facet and the place of that facet in it, if this is told; `None` on the hull.
    pub(crate) fn across<const W: usize>(
        &self,
        at: Place,
        corners: &Corners<D, W>,
        facet: usize,
    ) -> Option<Place> {
        match corners.neighbors[facet] {
            NO_NEIGHBOR => None,
            OTHER_TILE => {
                let side = (at.tile, crate::simplex::code(at.simplex, facet as u32));
                let (tile, code) = self.mosaic.other_side(side)?;
                Some(Place { tile, simplex: crate::simplex::decode(code).0 })
            }
            simplex => Some(Place { simplex, ..at }),
        }
    }
}

impl<const D: usize> Tile<D> {
    fn corners<const W: usize>(&self, simplex: u32) -> Corners<D, W> {
        let first = simplex as usize * W;
        let sites: [u32; W] = std::array::from_fn(|i| self.simplices[first + i]);
        Corners {
            rows: sites.map(|v| self.rows[v as usize]),
            at: sites.map(|v| self.coordinates[v as usize]),
            neighbors: std::array::from_fn(|i| self.neighbors[first + i]),
        }
    }
}
