//! The violations of a folder of tiles, and why a check could not be done.

use std::path::PathBuf;

use taut_points::{Cancelled, ReadError};

use super::super::super::{Fingerprint, MeshViolation};

/// Where a folder of tiles is wrong. Tiles have the number in the name of their file; the simplices and sites of a tile are
/// numbered from 0, as listed; facet i of a simplex is the one opposite its vertex i; points are rows of the input, from 0.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TilesViolation {
    /// The manifest is damaged or says that the work is not complete.
    #[error("manifest.txt {problem}")]
    Manifest {
        /// The reason for the refusal.
        problem: String,
    },
    /// The file of a tile is missing, cut, damaged, or not one of those the manifest lists.
    #[error("tile {tile} {problem}")]
    Tile {
        /// The tile.
        tile: u32,
        /// The reason for the refusal.
        problem: String,
    },
    /// A coordinate of the input is NaN or infinite.
    #[error("coordinate {column} of point {row} is {value:?}: all coordinates must be finite")]
    NonFinite {
        /// The point.
        row: u64,
        /// The coordinate, from 0.
        column: usize,
        /// Its value.
        value: f64,
    },
    /// The points are not those the manifest speaks of.
    #[error("the points have hash {found}, the manifest says {claimed}: the data changed")]
    Hash {
        /// The hash in the manifest.
        claimed: String,
        /// The hash of the points.
        found: String,
    },
    /// A count or dimension of the manifest or of a tile is wrong.
    #[error("{place} counts {claimed} {what}, there are {found}")]
    Count {
        /// The file that counts.
        place: String,
        /// The objects that are counted.
        what: &'static str,
        /// The value that the file claims.
        claimed: u64,
        /// The value found.
        found: u64,
    },
    /// The simplices have another number of vertices than those of these points.
    #[error("simplices have {claimed} vertices, those of these points have {found}")]
    Vertices {
        /// The value that the manifest claims.
        claimed: u32,
        /// 1 more than the dimension of the affine hull of the points.
        found: u32,
    },
    /// A coordinate of a site differs from the input.
    #[error(
        "coordinate {column} of point {row} is {found:?} in a tile, but {expected:?} in the points"
    )]
    Coordinate {
        /// The point.
        row: u64,
        /// The coordinate, from 0.
        column: usize,
        /// The value in the tile.
        found: f64,
        /// The value in the input.
        expected: f64,
    },
    /// A point is owned by no tile or by two, or is a vertex of nothing.
    #[error("point {row} {problem}")]
    Site {
        /// The point.
        row: u64,
        /// The reason for the refusal.
        problem: &'static str,
    },
    /// An entry of the duplicates is wrong.
    #[error("point {row} is listed as equal to point {first}: {problem}")]
    Duplicate {
        /// The point.
        row: u64,
        /// The point that it is said to equal.
        first: u64,
        /// The reason for the refusal.
        problem: &'static str,
    },
    /// A simplex is flat or turned the wrong way round.
    #[error("simplex {simplex} of tile {tile} is not positively oriented")]
    Orientation {
        /// The tile.
        tile: u32,
        /// The simplex.
        simplex: u64,
    },
    /// The simplex named across a facet is not the one there, or does not name it back.
    #[error("facet {facet} of simplex {simplex} of tile {tile}: {problem}")]
    Neighbor {
        /// The tile.
        tile: u32,
        /// The simplex.
        simplex: u64,
        /// Its facet.
        facet: usize,
        /// The reason for the refusal.
        problem: &'static str,
    },
    /// A point lies in the open circumsphere of a simplex, or on it where the perturbation puts it inside.
    #[error(
        "point {row} lies {} the circumsphere of simplex {simplex} of tile {tile}{}",
        if *.tie { "on" } else { "inside" },
        if *.tie { ", and the perturbation puts it inside" } else { "" }
    )]
    Conflict {
        /// The tile.
        tile: u32,
        /// The simplex.
        simplex: u64,
        /// The point.
        row: u64,
        /// True if the point lies on the sphere.
        tie: bool,
    },
    /// The facets of the hull do not close up.
    #[error("the hull does not close up at point {row}")]
    HullOpen {
        /// A point where it does not.
        row: u64,
    },
    /// Two facets of the hull meet in a dent, or are folded onto each other.
    #[error("the hull is not convex at point {row}: point {beyond} lies outside")]
    HullDent {
        /// A point of the ridge.
        row: u64,
        /// The vertex beyond the ridge.
        beyond: u64,
    },
    /// A point lies outside a facet of the hull, or the hull winds more than once around the points.
    #[error("the hull winds around the points more than once, or not at all: seen at point {row}")]
    HullWinding {
        /// Where this was seen.
        row: u64,
    },
    /// The simplices have another fingerprint than a file says.
    #[error("the simplices have fingerprint {found}, {place} says {claimed}")]
    Fingerprint {
        /// The file that says so.
        place: String,
        /// The value that it claims.
        claimed: Fingerprint,
        /// The value of the simplices.
        found: Fingerprint,
    },
}

impl TilesViolation {
    /// Returns the violation of a chunk of simplices of a tile, which begins with simplex `first`, in terms of the tile.
    pub(super) fn of_chunk(
        violation: &MeshViolation,
        tile: u32,
        first: u64,
        rows: &[u64],
    ) -> TilesViolation {
        let number = |simplex: usize| first + simplex as u64;
        match *violation {
            MeshViolation::Orientation { simplex } => {
                TilesViolation::Orientation { tile, simplex: number(simplex) }
            }
            MeshViolation::Neighbor { simplex, facet, problem, .. } => {
                TilesViolation::Neighbor { tile, simplex: number(simplex), facet, problem }
            }
            MeshViolation::Conflict { simplex, row, tie, .. } => {
                let row = rows.get(row as usize).copied().unwrap_or(u64::MAX);
                TilesViolation::Conflict { tile, simplex: number(simplex), row, tie }
            }
            ref other => TilesViolation::Tile { tile, problem: format!("is wrong: {other}") },
        }
    }
}

/// Why a folder of tiles was not verified.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TilesError {
    /// The folder is wrong.
    #[error(transparent)]
    Rejected(#[from] TilesViolation),
    /// The points cannot be read, or the monitor stopped the work.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// A file of the folder cannot be read, or a temporary one not written.
    #[error("{}: {source}", path.display())]
    File {
        /// The file or folder.
        path: PathBuf,
        /// The error of the system.
        source: std::io::Error,
    },
    /// The folder has no manifest.
    #[error("{}: a folder without manifest.txt, so no folder of tiles", folder.display())]
    NoManifest {
        /// The folder.
        folder: PathBuf,
    },
    /// The limit on memory is too low.
    #[error(
        "{what} needs {needed} bytes of memory, more than the {allowed} bytes it may take: allow more memory"
    )]
    Memory {
        /// The part of the work.
        what: String,
        /// Bytes that it needs.
        needed: u64,
        /// Bytes that it may take of those allowed.
        allowed: u64,
    },
}

impl From<Cancelled> for TilesError {
    fn from(cancelled: Cancelled) -> Self {
        TilesError::Read(cancelled.into())
    }
}
