//! A tile: the simplices that one node finished, as a file has them.
//!
//! *Content.* The sites of the simplices with their rows; the simplices as numbers of sites of the tile; across each facet
//! the neighbor. All simplices of all tiles are the triangulation, each once. Each site of the triangulation is *owned* by
//! one tile, that of the node where its star was complete; other tiles may have copies of it, which they list.
//! *Neighbors.* A neighbor is the number of a simplex of this tile, [`NO_NEIGHBOR`] on the hull, or [`OTHER_TILE`]. Of the
//! two tiles at such a facet, the one that was finished later has it in its links: (simplex << 2 | facet here, tile,
//! simplex << 2 | facet there), ascending; 0xFFFF_FFFF stands here where the facet turned out to lie on the hull. The later
//! tile is of a node above the other, so a reader looks at few tiles.
//! *Order.* Sites follow the Hilbert curve of the node. Simplices: vertices begin with
//! the smallest and ascend as far as their orientation allows; simplices ascend by their vertices in ascending order.
//! *Guarantee.* A function of the points and of the tree of cells, byte by byte.
//!
//! *Bytes*, little-endian:
//!
//! | what | type |
//! |---|---|
//! | magic `TAUTTILE` | 8 bytes |
//! | version, D | 2 × u32 |
//! | sites | sites × D × f64 |
//! | rows of the sites | sites × u32 or u64 |
//! | duplicates: a row and the smallest row it equals, ascending | duplicates × 2 × u32 or u64 |
//! | simplices: the vertices and the neighbors opposite them | simplices × (vertices + neighbors) × u32 |
//! | copies: the sites that other tiles own, ascending | copies × u32 |
//! | links | links × 3 × u32 |
//! | the last 104 bytes: magic `TAUTTILE` | 8 bytes |
//! | version, D, vertices of a simplex, bytes of a row (4 or 8), number of the tile, 0 | 6 × u32 |
//! | copies, sites, duplicates, simplices, links, facets on the hull | 6 × u64 |
//! | fingerprint of the simplices | u128 |
//! | sum of all words before | u64 |
//!
//! The counts come last, as a tile is written in one pass.

mod order;
mod read;
mod write;

pub(super) use order::TileOrder;
pub use read::Tile;
pub(super) use write::{LowerTile, fingerprint_lower, write_lower, write_solved};

use taut_certify::Fingerprint;

use super::front::Link;

/// Among neighbors: the facet lies on the hull.
pub const NO_NEIGHBOR: u32 = u32::MAX;
/// Among neighbors: the neighbor is in another tile.
pub const OTHER_TILE: u32 = u32::MAX - 1;

const MAGIC: &[u8; 8] = b"TAUTTILE";
const VERSION: u32 = 1;
/// Bytes before the sites.
pub(super) const HEAD_BYTES: usize = 16;
/// Bytes of the counts, with the sum.
pub(super) const COUNTS_BYTES: usize = 104;

/// A facet between two tiles, as the later tile has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TileLink {
    /// The side in this tile: simplex << 2 | facet, or [`Link::OUTSIDE`] if there is none.
    pub code: u32,
    /// The side in the other tile.
    pub link: Link,
}

/// The counts at the end of a tile.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TileCounts {
    /// Vertices of a simplex: 1 more than the dimension of the affine hull of all points, 0 if there are no simplices.
    pub vertices_per_simplex: u32,
    /// Bytes of a row, 4 or 8.
    pub row_bytes: u32,
    /// The number of the tile: that of its node.
    pub tile: u32,
    /// Sites that other tiles own.
    pub copies: u64,
    /// All sites.
    pub sites: u64,
    /// Rows that equal a smaller row.
    pub duplicates: u64,
    /// Simplices.
    pub simplices: u64,
    /// Facets whose other side was finished before, in another tile; those on the hull included.
    pub links: u64,
    /// Facets that were found to lie on the hull, of this tile or of another.
    pub hull: u64,
    /// The fingerprint of the simplices.
    pub fingerprint: Fingerprint,
}

impl TileCounts {
    /// Sites that no other tile owns.
    pub fn owned(&self) -> u64 {
        self.sites - self.copies
    }

    /// Bytes of the tile, with its sum; `None` if more than can be counted.
    pub fn bytes(&self, dimension: usize) -> Option<u64> {
        let simplex = 8 * u128::from(self.vertices_per_simplex);
        let row = u128::from(self.row_bytes);
        let total = (HEAD_BYTES + COUNTS_BYTES) as u128
            + u128::from(self.sites) * (8 * dimension as u128 + row)
            + u128::from(self.duplicates) * 2 * row
            + u128::from(self.simplices) * simplex
            + u128::from(self.copies) * 4
            + u128::from(self.links) * 12;
        u64::try_from(total).ok()
    }
}
