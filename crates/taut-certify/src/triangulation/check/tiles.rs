//! The proof that a folder of tiles is *the* Delaunay triangulation of points, for more of either than memory holds.
//!
//! *Problem.* Given points from a source and a folder as docs/delaunay.md defines it: are the simplices of all tiles together
//! the Delaunay triangulation of the points, each once, and does each file say the truth about its neighbors and counts?
//! *Proof.* It is that of [the check in memory](super), whose five facts are proved in this order.
//! 1. *Vertices.* Each row of the input is owned by one tile and a vertex in some, or it is listed once as a duplicate of an
//!    earlier row that is owned and has the same coordinates. Each site of each tile, owned or copied, has the coordinates of
//!    its row, bit by bit (−0 counts as 0). So a row stands for one place, in all tiles alike. [`rows`]
//! 2. *Orientation.* Each simplex is positively oriented.
//! 3. *Facets.* Inside a chunk of a tile the neighbors are checked as in memory. All other sides of facets are sorted by their
//!    rows, which pairs them up: two sides, opposite ways, each as the other says; or one, which is on the hull. [`between`]
//! 4. *Hull.* The facets with one side form one closed surface without dents, which winds once around the points. [`hull`]
//! 5. *Emptiness.* Across each inner facet the far vertex is outside the circumsphere, or on it where the perturbation puts
//!    it outside: in chunks as in memory, else where the two sides of the facet come together.
//!
//! These are facts about rows and their places, and do not mention tiles; so what follows from them in memory follows here:
//! the simplices tile the convex hull, and are the perturbed Delaunay triangulation. Counts, links, fingerprints and sums of
//! each tile and of the manifest are compared with what is found.
//! *Not proved.* The order of sites, simplices and links in a tile, which tile owns a site, copies that no simplex needs,
//! which of the two tiles at a facet has the link, bytes that only fill up, and the lines of the manifest about the run:
//! levels, leaf_points, merge_above, front_sites, merged_sites and root_sites.
//! *Less than full dimension.* The dimension of the points is decided from all of them. In a plane of space the same proof
//! runs on two coordinates; on a line, edges must ascend and pair up at their ends to one chain.
//! *Cost.* Two passes over the points, and a third over the blocks with duplicates; one over the tiles. On the disk each site
//! with its row, 4 + 8d bytes, and each facet between chunks twice, 112 bytes in the plane and 176 in space. The memory
//! of a tile is what its sites take; simplices pass in chunks.
//! Threads beyond those whose buffers fit into an eighth of the memory stay idle: the shares of all else are seven eighths.
//! *Trap.* Numbers that a tile gives are not those of the input before the last step has compared them. Until then they only
//! have to be finite: an arithmetic that relies on more may err, and the folder is refused in the end.
//! *Reference.* M. Isenburg, Y. Liu, J. Shewchuk, J. Snoeyink: Streaming computation of Delaunay triangulations, 2006, write
//! triangles in a coherent order; nothing is proved there.

mod between;
mod hull;
mod inside;
mod manifest;
mod overview;
mod reading;
mod rows;
mod sort;
mod sum;
mod tile;
mod violation;

use std::fs;
use std::path::{Path, PathBuf};

use serde::Serialize;
use taut_points::{Monitor, PointSource, PointsHash, keep_freed_memory, thread_pool};

use self::hull::{Ends, Polygon, Surface};
use self::inside::{Chain, Full, Job};
use self::manifest::Manifest;
use self::overview::Overview;
use super::super::{Fingerprint, TriangulationCounts};
use super::geometry::{Tetrahedra, Triangles};
use crate::json::hash_to_hex;

pub use violation::{TilesError, TilesViolation};

/// Least memory for a check.
const MEMORY_MIN: u64 = 16 << 20;

/// Bytes of the buffers of one thread, or more: a block of points, and lists for a batch of simplices. (Measured, 2·10⁶ uniform
/// points of the plane on 1 and 8 threads: 0.45 MiB.)
const THREAD_BYTES: u64 = 1 << 20;

/// How a folder of tiles is verified; [`Default`] is what most people want.
#[derive(Clone, Debug, PartialEq)]
pub struct TilesOptions<'a> {
    /// Bytes of memory that the check may take, at least 16 MiB. Default 512 MiB. No verdict depends on it. With less than 8 MiB
    /// for each thread of the current rayon pool, some of them stay idle.
    pub memory: u64,
    /// Folder for temporary files, which have no name and go with the process. Default: that of the system.
    pub temporary: Option<&'a Path>,
    /// Watches the work and can stop it. Pass 1 reads the points, pass 2 the tiles, pass 3 the facets between chunks, and
    /// pass 4 the points again. Default [`Monitor::silent`].
    pub monitor: Monitor<'a>,
}

impl Default for TilesOptions<'_> {
    fn default() -> Self {
        Self { memory: 512 << 20, temporary: None, monitor: Monitor::silent() }
    }
}

/// The proved facts about a folder of tiles: it holds the Delaunay triangulation of these points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct TilesVerdict {
    /// Dimension of the points: 2 or 3.
    pub dimension: u8,
    /// Dimension of the affine hull of the points; `None` when there are none.
    pub hull_dimension: Option<u8>,
    /// Rows of the input.
    pub points: u64,
    /// The hash of the points.
    #[serde(serialize_with = "hash_to_hex")]
    pub points_hash: PointsHash,
    /// Tiles.
    pub tiles: u64,
    /// The counts of the triangulation.
    pub counts: TriangulationCounts,
    /// Rows that equal an earlier one.
    pub duplicates: u64,
    /// The fingerprint of the simplices.
    pub fingerprint: Fingerprint,
    /// Facets whose two simplices lie on one sphere, so that the perturbation decided between them.
    pub ties: u64,
}

/// Proves that a folder of tiles is the Delaunay triangulation of the points of `source`.
///
/// Takes the time of a few passes over the files, and temporary files of 4 + 8d bytes for each point and, for each facet between
/// tiles or between the chunks in which a tile is read, 224 bytes in the plane and 352 in space.
///
/// # Errors
/// [`TilesError::Rejected`] with the first violation, [`TilesError::Read`] when the points cannot be read or the monitor stops
/// the work, [`TilesError::File`], and [`TilesError::Memory`] when the sites of a tile do not fit.
pub fn check_tiles(
    folder: &Path,
    source: &dyn PointSource,
    options: &TilesOptions<'_>,
) -> Result<TilesVerdict, TilesError> {
    if options.memory < MEMORY_MIN {
        let (what, needed, allowed) = ("the check".to_owned(), MEMORY_MIN, options.memory);
        return Err(TilesError::Memory { what, needed, allowed });
    }
    let manifest = Manifest::read(folder)?;
    count("dimensions", u64::from(manifest.dimension), source.dim() as u64)?;
    count("points", manifest.points, source.len())?;
    let check = || match source.dim() {
        2 => plane(folder, &manifest, source, options),
        3 => space(folder, &manifest, source, options),
        dim => {
            let problem = format!("speaks of points of dimension {dim}: expected 2 or 3");
            Err(TilesViolation::Manifest { problem }.into())
        }
    };
    let threads = threads_within(options.memory);
    keep_freed_memory(options.memory, threads.min(rayon::current_num_threads()));
    if threads >= rayon::current_num_threads() {
        return check();
    }
    match thread_pool(threads) {
        Ok(pool) => pool.install(check),
        // The threads that are there take a little more memory; without any there would be no verdict.
        Err(_) => check(),
    }
}

/// Most threads whose buffers fit into the memory that [`Shares`] leave, at least 1.
fn threads_within(memory: u64) -> usize {
    usize::try_from(memory / 8 / THREAD_BYTES).unwrap_or(usize::MAX).max(1)
}

/// Bytes of temporary files that [`check_tiles`] takes, for a triangulation of uniform points of the plane or of space in `tiles`
/// tiles of about the same size. Points on lines, curves or surfaces have more facets between tiles and take more.
pub fn check_tiles_disk(points: u64, dimension: usize, tiles: u64, memory: u64) -> u64 {
    let chunk = Shares::of(memory).chunk / (8 * (dimension as u64 + 1));
    let simplices = points.saturating_mul(if dimension == 2 { 200 } else { 677 }) / 100;
    let in_tile = simplices.div_ceil(tiles.max(1));
    let chunks = tiles.saturating_mul(in_tile.div_ceil(chunk.max(1)));
    let size = simplices as f64 / chunks.max(1) as f64;
    // Sides of facets between chunks, measured in 1 to 32 tiles of 10⁵ to 3·10⁵ simplices: of chunks of m triangles 4.8 to 6.2·√m,
    // of tetrahedra 5.8 to 7.2·m^⅔, without the share on the outside of all, which is the larger the fewer chunks there are.
    let (border, outside) = match dimension {
        2 => (6.4 * size.sqrt(), (chunks.max(1) as f64).powf(-1.0 / 2.0)),
        _ => (7.2 * size.cbrt().powi(2), (chunks.max(1) as f64).powf(-1.0 / 3.0)),
    };
    let sides = (border * (1.0 - outside) * chunks as f64) as u64;
    let sorted = sides.saturating_mul(if dimension == 2 { 8 * 14 } else { 8 * 22 });
    // Fewer sides than memory has room for never leave it.
    let sorted = if sorted > Shares::of(memory).between / 3 * 2 { sorted } else { 0 };
    // A tenth more for sites that two tiles have.
    let rows = points.saturating_mul(4 + 8 * dimension as u64) / 10 * 11;
    rows.saturating_add(sorted)
}

fn plane(
    folder: &Path,
    manifest: &Manifest,
    source: &dyn PointSource,
    options: &TilesOptions<'_>,
) -> Result<TilesVerdict, TilesError> {
    let job = begin::<2>(folder, manifest, source, options)?;
    let (signs, room) = (job.overview.signs, job.shares.hull);
    match job.vertices {
        0 | 1 => job.run::<_, _, 1, 0, 6>(Chain, Ends::new(source.len().min(1))),
        2 => job.run::<_, _, 2, 1, 10>(Chain, Ends::new(2)),
        _ => {
            let hull = Polygon::<2, 7>::new(signs, &job.temporary, room);
            job.run::<_, _, 3, 2, 14>(Full::<Triangles>::new(), hull)
        }
    }
}

fn space(
    folder: &Path,
    manifest: &Manifest,
    source: &dyn PointSource,
    options: &TilesOptions<'_>,
) -> Result<TilesVerdict, TilesError> {
    let job = begin::<3>(folder, manifest, source, options)?;
    let (signs, room) = (job.overview.signs, job.shares.hull);
    match (job.vertices, job.overview.smallest) {
        (3, _) => {
            let hull = Polygon::<3, 9>::new(signs, &job.temporary, room);
            job.run::<_, _, 3, 2, 17>(Full::<Triangles>::new(), hull)
        }
        (4, Some((row, smallest))) => {
            let smallest = (row, job.overview.scaled(&smallest));
            let hull = Surface::new(signs, smallest, &job.temporary, room);
            job.run::<_, _, 4, 3, 22>(Full::<Tetrahedra>::new(), hull)
        }
        (2, _) => job.run::<_, _, 2, 1, 12>(Chain, Ends::new(2)),
        _ => job.run::<_, _, 1, 0, 7>(Chain, Ends::new(source.len().min(1))),
    }
}

/// All that comes before the first tile.
fn begin<'a, const D: usize>(
    folder: &'a Path,
    manifest: &'a Manifest,
    source: &'a dyn PointSource,
    options: &'a TilesOptions<'a>,
) -> Result<Job<'a, D>, TilesError> {
    list(folder, manifest)?;
    let overview = Overview::<D>::read(source, &options.monitor)?;
    if overview.hash != manifest.points_hash {
        let (claimed, found) = (manifest.points_hash.to_string(), overview.hash.to_string());
        return Err(TilesViolation::Hash { claimed, found }.into());
    }
    let hull = overview.hull_dimension(source, &options.monitor)?;
    let vertices = hull.vertices() as u32;
    if manifest.vertices != vertices {
        let (claimed, found) = (manifest.vertices, vertices);
        return Err(TilesViolation::Vertices { claimed, found }.into());
    }
    Ok(Job {
        folder,
        manifest,
        source,
        overview,
        axes: hull.axes(),
        vertices,
        temporary: options.temporary.map_or_else(std::env::temp_dir, PathBuf::from),
        shares: Shares::of(options.memory),
        monitor: options.monitor,
    })
}

/// The parts of the memory for what is held at the same time.
#[derive(Clone, Copy, Debug)]
struct Shares {
    /// The sites of a tile; two are held, or three of two thirds.
    sites: u64,
    /// A chunk of simplices; three are held, or five of half.
    chunk: u64,
    /// Sides of facets.
    between: u64,
    /// Facets of the hull.
    hull: u64,
    /// Sites on their way to the disk, later a part of the input.
    rows: u64,
}

impl Shares {
    fn of(memory: u64) -> Self {
        Shares {
            sites: memory / 4,
            chunk: memory / 32,
            between: memory / 8,
            hull: memory / 32,
            rows: memory / 8,
        }
    }
}

/// The folder has the tiles that the manifest lists, and no others.
fn list(folder: &Path, manifest: &Manifest) -> Result<(), TilesError> {
    let failed = |source| TilesError::File { path: folder.to_owned(), source };
    for entry in fs::read_dir(folder).map_err(failed)? {
        let name = entry.map_err(failed)?.file_name();
        let Some(name) = name.to_str() else { continue };
        let Some(number) = name.strip_prefix("tile-").and_then(|name| name.strip_suffix(".ttd"))
        else {
            continue;
        };
        let is_listed = number.parse::<u32>().is_ok_and(|number| {
            let known = manifest.tiles.binary_search_by_key(&number, |tile| tile.0).is_ok();
            known && tile::file_name(number) == name
        });
        if !is_listed {
            let problem = format!("does not list {name}, which is in the folder");
            return Err(TilesViolation::Manifest { problem }.into());
        }
    }
    Ok(())
}

/// Compares a count of the manifest with what was found.
fn count(what: &'static str, claimed: u64, found: u64) -> Result<(), TilesViolation> {
    match claimed == found {
        true => Ok(()),
        false => {
            Err(TilesViolation::Count { place: "manifest.txt".to_owned(), what, claimed, found })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_and_threads_stay_within_the_memory() {
        for memory in [MEMORY_MIN, 17 << 20, 64 << 20, 1 << 30, 1 << 36] {
            let Shares { sites, chunk, between, hull, rows } = Shares::of(memory);
            let threads = threads_within(memory) as u64;
            let all = 2 * sites + 3 * chunk + between + hull + rows + threads * THREAD_BYTES;
            assert!(threads >= 2 && all <= memory, "{all} of {memory}");
        }
    }
}
