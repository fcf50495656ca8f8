//! Triangulates points that come once, in a coherent order: finished simplices leave while points still come.
//!
//! *Problem.* Points come from a pipe. They cannot be read twice, are too many for memory, and whoever reads the simplices
//! wants the first of them long before the last point.
//! *Idea.* The stream says where no more points will come ([`Coherence`]): behind the current coordinate of a sorted stream,
//! or in the cells of a grid that were closed, as in Isenburg's streaming meshes. Points wait until their place is closed.
//! Whenever enough are ready, the node function triangulates them together with what is unfinished, and all simplices whose
//! spheres meet no place that is still open are final and leave. So this is the tree merge along a tree that leans to the
//! left, and a front that holds what the open part of space may still change.
//! *Guarantee.* The simplices are those of [`delaunay()`](crate::delaunay), ties included, each once, positively oriented and
//! with the smallest vertex first. Their order is a function of the stream and of the limit on memory, for any number of
//! threads. A stream that keeps too much open is refused with the row where the memory would be exceeded.
//! *Trap.* Open cells may lie within the hull of the points so far, as those do that a Hilbert curve encloses. Then not all
//! simplices in conflict with a coming point are connected with a ghost, and the search for them also begins at a point of
//! each connected part of what is open.
//! *Trap.* Of a stream nobody knows the magnitudes before its end. Each chunk takes the scale of those so far: fronts have
//! coordinates as they were given, and no sign depends on the scale.
//! *Reference.* Isenburg, Liu, Shewchuk, Snoeyink, *Streaming computation of Delaunay triangulations*, SIGGRAPH 2006, for
//! finalization of space.

mod emit;
mod region;
#[cfg(test)]
mod tests;

use std::io;

use taut_points::{InputError, Monitor};

pub(super) use emit::{emit_lower, emit_solved};
use region::Region;

use super::driver::Totals;
use super::front::Front;
use super::node::{Dim, Dimension};
use super::points::NodePoints;
use super::solve::Whole;
use crate::Error;
use crate::sites::Magnitudes;

/// Least memory of a stream.
const MEMORY_MIN: u64 = 32 << 20;
/// Memory for the program, its stacks and buffers.
const BASE_BYTES: u64 = 12 << 20;
/// Points of the first chunk; it is small so that simplices leave early.
const FIRST_CHUNK: usize = 1 << 14;
/// Each chunk has so many times the points of the one before, as far as memory allows.
const CHUNK_GROWTH: usize = 2;
/// Most points of a chunk, except where the front is large: its arrays stay in the cache.
const CHUNK_MAX: usize = 1 << 18;
/// A chunk has at least so many times the sites of the front, as far as memory allows: these are triangulated again.
const CHUNK_OVER_FRONT: usize = 8;
/// A chunk has at least this share of the sites that are triangulated with it: with less the work repeats itself.
const CHUNK_SHARE_MIN: f64 = 1.0 / 16.0;
/// Fewest points that there must be room for beside the front.
const CHUNK_MIN: usize = 1 << 10;

/// Peak bytes of memory for each site of a chunk (measured on uniform points, example `stream`).
const fn site_bytes(d: usize) -> u64 {
    if d == 2 { 120 } else { 330 }
}

/// How a stream says where no more points will come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coherence {
    /// The coordinates along this axis, from 0, never fall.
    Sorted {
        /// The axis.
        axis: usize,
    },
    /// The box of all points is cut into 2^`levels` cells along each axis, which [`Stream::close`] closes one by one.
    Cells {
        /// At least 1; all axes together at most 20.
        levels: u32,
    },
}

/// Options to triangulate a stream of points of dimension `D`.
#[derive(Clone, Debug, PartialEq)]
pub struct StreamOptions<'a, const D: usize> {
    /// The smallest and largest coordinates of a box that all points lie in.
    pub within: [[f64; D]; 2],
    /// How the stream says where no more points will come.
    pub coherence: Coherence,
    /// Bytes of memory that the work may take, at least 32 MiB.
    pub memory: u64,
    /// True if vector instructions are used where the machine has them. No simplex depends on it.
    pub vectors: bool,
    /// Watches the work and can stop it.
    pub monitor: Monitor<'a>,
}

/// Takes the simplices, each as the rows of its vertices, positively oriented, the smallest first.
pub type TakeSimplex<'a> = dyn FnMut(&[u64]) -> io::Result<()> + 'a;

/// A triangulation of points that are still coming.
///
/// ```
/// use taut_delaunay::outofcore::{Coherence, Stream, StreamOptions};
/// use taut_points::Monitor;
///
/// let options = StreamOptions {
///     within: [[0.0, 0.0], [100.0, 1.0]],
///     coherence: Coherence::Sorted { axis: 0 },
///     memory: 64 << 20,
///     vectors: true,
///     monitor: Monitor::silent(),
/// };
/// let mut triangles = 0;
/// let mut take = |_: &[u64]| { triangles += 1; Ok(()) };
/// let mut stream = Stream::new(options)?;
/// for i in 0..101 {
///     stream.push([f64::from(i), f64::from(i % 2)], &mut take)?;
/// }
/// let totals = stream.end(&mut take)?;
/// assert_eq!((totals.sites, totals.simplices, triangles), (101, 99, 99));
/// # Ok::<(), taut_delaunay::Error>(())
/// ```
pub struct Stream<'a, const D: usize> {
    options: StreamOptions<'a, D>,
    region: Region<D>,
    /// Points in open places, by cell; a sorted stream has one list.
    waiting: Vec<NodePoints<D>>,
    waiting_points: u64,
    /// Points in closed places that are not triangulated yet.
    ready: NodePoints<D>,
    front: Front<D>,
    magnitudes: Magnitudes,
    totals: Totals,
    rows: u64,
    chunk: usize,
    front_most: u64,
    first_after: Option<u64>,
}

impl<'a, const D: usize> Stream<'a, D>
where
    Dim<D>: Dimension<D>,
{
    /// A stream without points.
    ///
    /// # Errors
    /// [`Error::Input`] for a box that is empty or not finite, an axis or a number of cells that there is not, and too
    /// little memory.
    pub fn new(options: StreamOptions<'a, D>) -> Result<Self, Error> {
        let memory = options.memory;
        if memory < MEMORY_MIN {
            return Err(option("memory", memory, "at least 33554432, which is 32 MiB"));
        }
        let region = Region::new(options.within, options.coherence)?;
        if region.bytes() > memory / 4 {
            return Err(option("levels", region.levels(), "fewer cells, or more memory for them"));
        }
        let largest = options.within.iter().flatten().fold(0.0f64, |most, x| most.max(x.abs()));
        Ok(Self {
            waiting: vec![NodePoints::default(); region.lists()],
            waiting_points: 0,
            ready: NodePoints::default(),
            front: Front::empty(),
            magnitudes: Magnitudes { largest, ..Magnitudes::EMPTY },
            totals: Totals::default(),
            rows: 0,
            chunk: FIRST_CHUNK,
            front_most: 0,
            first_after: None,
            region,
            options,
        })
    }

    /// Points so far.
    pub fn rows(&self) -> u64 {
        self.rows
    }

    /// The points that had come when the first simplex left.
    pub fn first_after(&self) -> Option<u64> {
        self.first_after
    }

    /// The most sites that were unfinished at a time.
    pub fn front_most(&self) -> u64 {
        self.front_most
    }

    /// Takes the next point, whose row is the number of points before it.
    ///
    /// # Errors
    /// [`Error::Input`] for a point that is not finite; [`Error::OutsideStream`] for one outside the box, in a closed cell, or
    /// behind the one before; [`Error::Incoherent`] where too much is open for the memory; errors of `take`.
    #[inline]
    pub fn push(&mut self, p: [f64; D], take: &mut TakeSimplex<'_>) -> Result<(), Error> {
        let (row, p) = (self.rows, p.map(|x| x + 0.0));
        if let Some(column) = p.iter().position(|x| !x.is_finite()) {
            return Err(InputError::NonFinite { row, column, value: p[column] }.into());
        }
        let list = self.region.place(p, row)?;
        if self.region.advance(p) {
            self.make_ready(0);
        }
        p.iter().for_each(|&x| self.magnitudes.add(x));
        self.rows += 1;
        self.waiting[list].push(p, row);
        self.waiting_points += 1;
        if row % CHECK_ROWS == 0 { self.look(take) } else { Ok(()) }
    }

    /// Closes a cell, by its number along the axes, the first axis first: no more points will come there.
    ///
    /// # Errors
    /// [`Error::Input`] for a cell that there is not, or that is closed; as [`push`](Self::push).
    pub fn close(&mut self, cell: u64, take: &mut TakeSimplex<'_>) -> Result<(), Error> {
        let list = self.region.close(cell)?;
        self.make_ready(list);
        self.look(take)
    }

    /// Says that no more points will come anywhere; the last simplices leave.
    ///
    /// # Errors
    /// As [`push`](Self::push).
    pub fn end(mut self, take: &mut TakeSimplex<'_>) -> Result<Totals, Error> {
        self.region.close_all();
        (0..self.waiting.len()).for_each(|list| self.make_ready(list));
        self.totals.root_sites = (self.front.len() + self.ready.rows.len()) as u64;
        self.triangulate(0, take)?;
        if self.front.is_empty() {
            Ok(self.totals)
        } else {
            Err(Error::DamagedFront { what: "sites are left at the end" })
        }
    }

    fn make_ready(&mut self, list: usize) {
        let points = std::mem::take(&mut self.waiting[list]);
        self.waiting_points -= points.rows.len() as u64;
        self.ready.coordinates.extend(points.coordinates);
        self.ready.rows.extend(points.rows);
    }

    /// Bytes of memory for a chunk and its front, beside the points that wait.
    fn budget(&self) -> u64 {
        let memory = self.options.memory;
        // Lists have up to twice the room that their points take.
        let waiting = self.waiting_points * (8 * D as u64 + 8) * 2;
        let left = memory - memory / 8 - BASE_BYTES - self.region.bytes();
        left.saturating_sub(waiting)
    }

    fn refuse_beyond(&self, sites: u64) -> Result<(), Error> {
        let (needed, budget) = (sites.saturating_mul(site_bytes(D)), self.budget());
        if needed <= budget {
            return Ok(());
        }
        let (row, waiting) = (self.rows.saturating_sub(1), self.waiting_points);
        let unfinished = self.front.len() as u64;
        Err(Error::Incoherent { row, waiting, unfinished, needed, budget })
    }

    /// Triangulates if enough points are ready; refuses a stream that leaves no room for enough of them.
    fn look(&mut self, take: &mut TakeSimplex<'_>) -> Result<(), Error> {
        let (ready, front) = (self.ready.rows.len(), self.front.len());
        let room = (self.budget() / site_bytes(D)) as usize;
        let least = ((room as f64 * CHUNK_SHARE_MIN) as usize).max(CHUNK_MIN);
        self.refuse_beyond((front + least) as u64)?;
        let wanted = self.chunk.max(CHUNK_OVER_FRONT * front).min(room - front);
        if ready < wanted {
            return Ok(());
        }
        self.chunk = (CHUNK_GROWTH * self.chunk).min(CHUNK_MAX);
        let tile = self.totals.tiles as u32 + 1;
        self.triangulate(tile, take)
    }

    /// Triangulates the points that are ready with the front; what is final leaves, the rest is the new front.
    fn triangulate(&mut self, tile: u32, take: &mut TakeSimplex<'_>) -> Result<(), Error> {
        self.options.monitor.check()?;
        // All of what is ready, as no simplex may leave while a point outside the open places is not there.
        self.refuse_beyond((self.front.len() + self.ready.rows.len()) as u64)?;
        let mut all = std::mem::take(&mut self.front);
        let ready = std::mem::take(&mut self.ready);
        self.totals.merged_sites += all.len() as u64;
        self.options.monitor.points(ready.rows.len() as u64);
        // Of equal points the first in this order stays, so that facets of the front keep their vertices.
        all.coordinates.extend(ready.coordinates);
        all.rows.extend(ready.rows);
        let tree = self.region.tree();
        let whole = Whole::open(&tree, self.region.seeds(), self.magnitudes, self.options.vectors);
        let monitor = Monitor { on_points: None, ..self.options.monitor };
        let (counts, front) = Dim::<D>::emit(&whole, tile, all, take, &monitor)?;
        self.front = front;
        self.totals += &counts;
        self.front_most = self.front_most.max(self.front.len() as u64);
        self.totals.front_sites = self.front_most;
        if counts.simplices > 0 {
            self.first_after.get_or_insert(self.rows);
        }
        Ok(())
    }
}

/// Rows between two looks at the memory.
const CHECK_ROWS: u64 = 1 << 10;

fn option(name: &'static str, value: impl ToString, expected: &'static str) -> Error {
    Error::Input(InputError::Option { name, value: value.to_string(), expected })
}
