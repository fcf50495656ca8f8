//! The functions that a driver calls, on files or on a cluster: one node at a time, points or fronts in, a tile and a front
//! out.
//!
//! | step | call | runs |
//! |---|---|---|
//! | cut | [`Router::new`] over a sample | once |
//! | distribute | [`Router::cell`], [`CellBox::add`], [`Magnitudes::add`] of each point | anywhere; boxes and magnitudes are merged |
//! | agree | [`Whole::new`] over all boxes and magnitudes | once |
//! | leaves | [`summarize`] of the points of a leaf | anywhere |
//! | nodes above | [`merge`] of the fronts of all nodes below | anywhere, once the nodes below are done |
//! | root | [`finish`] of the fronts that are left | once |
//!
//! Each returns the bytes of nothing but its arguments, so that a task that is run twice gives the same twice.

use std::io::Write;

use taut_certify::{Solution, Triangulation};
use taut_points::{Monitor, Points};

use super::front::Front;
use super::points::NodePoints;
use super::solve::{Outcome, Whole, solve};
use super::stream::{TakeSimplex, emit_lower, emit_solved};
use super::tile::{LowerTile, TileCounts, TileOrder, write_lower, write_solved};
use crate::geometry::{Geometry, InPlane, InSpace};
use crate::kernel::Kernel;
use crate::{DelaunayOptions, Error, delaunay};

const SITES_LEFT: Error = Error::DamagedFront { what: "sites are left at the root" };
const FLAT_WITH_FACETS: Error =
    Error::DamagedFront { what: "there are frozen facets, but the sites do not span them" };

/// The node that a tile is written for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NodeJob<'a> {
    /// Its number in the tree, which is that of its tile.
    pub node: u32,
    /// Bytes of a row in the tile: 4, or 8 where there are 2³² rows or more.
    pub row_bytes: u32,
    /// The name of the output, for errors.
    pub output: &'a str,
}

/// The dimensions there are: `Dim<2>` and `Dim<3>`.
#[derive(Clone, Copy, Debug)]
pub struct Dim<const D: usize>;

/// Implemented by [`Dim`] for 2 and 3.
pub trait Dimension<const D: usize>: sealed::Sealed {
    /// Triangulates a node; [`summarize`], [`merge`] and [`finish`] call it.
    ///
    /// # Errors
    /// As these.
    #[doc(hidden)]
    fn run(
        whole: &Whole<D>,
        job: NodeJob<'_>,
        points: NodePoints<D>,
        front: Front<D>,
        out: &mut dyn Write,
        monitor: &Monitor<'_>,
    ) -> Result<(TileCounts, Front<D>), Error>;

    /// Triangulates a chunk of a stream: `front` has what is unfinished, and points that are new behind its sites.
    ///
    /// # Errors
    /// As [`merge`], and those of `take`.
    #[doc(hidden)]
    fn emit(
        whole: &Whole<D>,
        chunk: u32,
        front: Front<D>,
        take: &mut TakeSimplex<'_>,
        monitor: &Monitor<'_>,
    ) -> Result<(TileCounts, Front<D>), Error>;
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for super::Dim<2> {}
    impl Sealed for super::Dim<3> {}
}

impl Dimension<2> for Dim<2> {
    fn run(
        whole: &Whole<2>,
        job: NodeJob<'_>,
        points: NodePoints<2>,
        front: Front<2>,
        out: &mut dyn Write,
        monitor: &Monitor<'_>,
    ) -> Result<(TileCounts, Front<2>), Error> {
        run::<2, 3, InPlane>(whole, job, points, front, out, monitor)
    }

    fn emit(
        whole: &Whole<2>,
        chunk: u32,
        front: Front<2>,
        take: &mut TakeSimplex<'_>,
        monitor: &Monitor<'_>,
    ) -> Result<(TileCounts, Front<2>), Error> {
        emit::<2, 3, InPlane>(whole, chunk, front, take, monitor)
    }
}

impl Dimension<3> for Dim<3> {
    fn run(
        whole: &Whole<3>,
        job: NodeJob<'_>,
        points: NodePoints<3>,
        front: Front<3>,
        out: &mut dyn Write,
        monitor: &Monitor<'_>,
    ) -> Result<(TileCounts, Front<3>), Error> {
        run::<3, 4, InSpace>(whole, job, points, front, out, monitor)
    }

    fn emit(
        whole: &Whole<3>,
        chunk: u32,
        front: Front<3>,
        take: &mut TakeSimplex<'_>,
        monitor: &Monitor<'_>,
    ) -> Result<(TileCounts, Front<3>), Error> {
        emit::<3, 4, InSpace>(whole, chunk, front, take, monitor)
    }
}

/// Triangulates the points of a leaf: writes its tile, returns what goes up.
///
/// O(n log n) on uniform points; about 100 bytes a point in the plane, 330 in space.
///
/// # Errors
/// [`Error::File`] where `out` does not take the tile, [`Error::TooManySimplices`], [`Error::Input`] for points that are not
/// finite and when the monitor says so.
pub fn summarize<const D: usize>(
    whole: &Whole<D>,
    job: NodeJob<'_>,
    points: NodePoints<D>,
    out: &mut dyn Write,
    monitor: &Monitor<'_>,
) -> Result<(TileCounts, Front<D>), Error>
where
    Dim<D>: Dimension<D>,
{
    points.check()?;
    Dim::<D>::run(whole, job, points, Front::empty(), out, monitor)
}

/// Triangulates what is unfinished in the nodes below one: writes its tile, returns what goes up.
///
/// # Errors
/// As [`summarize`]; [`Error::DamagedFront`] where the fronts are not those of disjoint nodes below this one.
pub fn merge<const D: usize>(
    whole: &Whole<D>,
    job: NodeJob<'_>,
    mut front: Front<D>,
    out: &mut dyn Write,
    monitor: &Monitor<'_>,
) -> Result<(TileCounts, Front<D>), Error>
where
    Dim<D>: Dimension<D>,
{
    let points = NodePoints {
        coordinates: std::mem::take(&mut front.coordinates),
        rows: std::mem::take(&mut front.rows),
    };
    Dim::<D>::run(whole, job, points, front, out, monitor)
}

/// Triangulates what is unfinished at the root and writes the last tile. Points that do not span all dimensions are
/// triangulated here, in memory.
///
/// # Errors
/// As [`merge`].
pub fn finish<const D: usize>(
    whole: &Whole<D>,
    job: NodeJob<'_>,
    front: Front<D>,
    out: &mut dyn Write,
    monitor: &Monitor<'_>,
) -> Result<TileCounts, Error>
where
    Dim<D>: Dimension<D>,
{
    let (counts, front) = merge(whole, NodeJob { node: 0, ..job }, front, out, monitor)?;
    if front.is_empty() { Ok(counts) } else { Err(SITES_LEFT) }
}

fn run<const D: usize, const V: usize, G: Geometry<D, V>>(
    whole: &Whole<D>,
    job: NodeJob<'_>,
    points: NodePoints<D>,
    front: Front<D>,
    mut out: &mut dyn Write,
    monitor: &Monitor<'_>,
) -> Result<(TileCounts, Front<D>), Error> {
    let failed = |source| Error::File { path: job.output.to_owned(), source };
    let name = (job.node, job.row_bytes);
    match solve::<D, V, G>(whole, job.node, points, front.facets, monitor)? {
        Outcome::Full(solved) => {
            let unscale = whole.scale.inverse();
            let up = solved.sites_up();
            let order = TileOrder::of(&solved, &up);
            let counts = write_solved(&solved, &order, name, unscale, &mut out).map_err(failed)?;
            let side = |slot, facet| order.side(solved.mesh.simplices(), slot, facet);
            Ok((counts, solved.front(job.node, &up, side, unscale)))
        }
        Outcome::Lower { front, .. } if !front.facets.is_empty() => Err(FLAT_WITH_FACETS),
        Outcome::Lower { front, duplicates } if job.node != 0 => {
            let nothing = LowerTile { vertices_per_simplex: 0, simplices: &[], neighbors: &[] };
            let written = write_lower(&Front::<D>::empty(), &nothing, &duplicates, name, &mut out);
            Ok((written.map_err(failed)?, front))
        }
        Outcome::Lower { front, duplicates } => {
            let found = in_memory(&front, monitor)?;
            let written = write_lower(&front, &listed(&found), &duplicates, name, &mut out);
            Ok((written.map_err(failed)?, Front::empty()))
        }
    }
}

fn emit<const D: usize, const V: usize, G: Geometry<D, V>>(
    whole: &Whole<D>,
    chunk: u32,
    mut front: Front<D>,
    take: &mut TakeSimplex<'_>,
    monitor: &Monitor<'_>,
) -> Result<(TileCounts, Front<D>), Error> {
    let failed = |source| Error::File { path: "the output of simplices".to_owned(), source };
    let points = NodePoints {
        coordinates: std::mem::take(&mut front.coordinates),
        rows: std::mem::take(&mut front.rows),
    };
    match solve::<D, V, G>(whole, chunk, points, front.facets, monitor)? {
        Outcome::Full(solved) => {
            let unscale = whole.scale.inverse();
            let up = solved.sites_up();
            let counts = emit_solved(&solved, &up, unscale, take).map_err(failed)?;
            // A stream has no tiles: of a link only matters that it leads to a simplex.
            Ok((counts, solved.front(chunk, &up, |_, _| 0, unscale)))
        }
        Outcome::Lower { front, .. } if !front.facets.is_empty() => Err(FLAT_WITH_FACETS),
        Outcome::Lower { front, duplicates } if chunk != 0 => {
            let duplicates = duplicates.len() as u64;
            Ok((TileCounts { duplicates, ..TileCounts::default() }, front))
        }
        Outcome::Lower { front, duplicates } => {
            let found = in_memory(&front, monitor)?;
            let duplicates = duplicates.len() as u64;
            let counts = emit_lower(&front, &listed(&found), duplicates, take).map_err(failed)?;
            Ok((counts, Front::empty()))
        }
    }
}

/// The triangulation of sites that do not span all dimensions.
fn in_memory<const D: usize>(
    sites: &Front<D>,
    monitor: &Monitor<'_>,
) -> Result<Solution<Triangulation>, Error> {
    let points = Points::new(sites.coordinates.as_flattened(), D).map_err(|_| SITES_LEFT)?;
    delaunay(&points, &DelaunayOptions { monitor: *monitor, ..DelaunayOptions::default() })
}

fn listed(found: &Solution<Triangulation>) -> LowerTile<'_> {
    LowerTile {
        vertices_per_simplex: found.answer.vertices_per_simplex(),
        simplices: &found.answer.simplices,
        neighbors: &found.certificate.neighbors,
    }
}
