//! Goes through the tree of cells from the leaves to the root, a node at a time on each thread.
//!
//! *Idea.* A leaf is triangulated from its points. A node above has the fronts of its children side by side; it passes
//! them on as they are until they hold more sites than `merge_above`, so that small fronts are not triangulated at every
//! level. Threads take the first node that is ready in the order of a depth-first walk, so that few fronts wait.
//! *Guarantee.* Which nodes are triangulated, and what they write, depends on the points and on the tree alone, not on the
//! number of threads or on which of them was first. Nodes run at the same time only while the bytes they need stay within
//! the budget together; a node that needs more by itself is refused before it runs.
//! *Resume.* A thread asks the storage for a node without the lock, before the node may take memory: a storage may read all of
//! a file to compare its sum, and does so on all threads.
//! *Trap.* Each thread has a pool of its own: on a common one, a thread that waits for a part of its node would begin
//! another node in the meantime, and hold the memory of both.

use std::io::Write;
use std::ops::AddAssign;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

use taut_points::{InputError, Monitor, thread_pool};

use super::front::Front;
use super::node::{Dim, Dimension, NodeJob, finish, merge, summarize};
use super::points::NodePoints;
use super::solve::Whole;
use super::tile::TileCounts;
use crate::Error;

/// Where points, tiles and fronts are kept.
pub(super) trait Storage<const D: usize>: Sync {
    /// The points of a leaf.
    fn points(&self, leaf: u32) -> Result<NodePoints<D>, Error>;

    /// The front of a node that was stored.
    fn front(&self, node: u32) -> Result<Front<D>, Error>;

    /// Has `write` write the tile of a node, and keeps it with its front: both or, after a crash, none.
    fn store(&self, node: u32, write: &mut WriteNode<'_, D>) -> Result<NodeRecord, Error>;

    /// What is known of a node that was stored before, in another run perhaps; an error if its tile is known to have been changed.
    fn stored(&self, node: u32) -> Result<Option<NodeRecord>, Error>;

    /// The points of a leaf that is stored are of no use any more.
    fn release(&self, leaf: u32);
}

/// Writes a tile and returns its counts and the front.
pub(super) type WriteNode<'a, const D: usize> =
    dyn FnMut(&str, &mut dyn Write) -> Result<(TileCounts, Front<D>), Error> + 'a;

/// What is remembered of a node that is stored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NodeRecord {
    /// The counts of its tile.
    pub counts: TileCounts,
    /// Sites that go up.
    pub front_sites: u64,
    /// Facets that go up.
    pub front_facets: u64,
}

/// How the nodes are gone through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Course {
    /// Fronts side by side with more sites than this are triangulated.
    pub(super) merge_above: u64,
    /// Bytes of a row in the tiles.
    pub(super) row_bytes: u32,
    /// Threads, at least 1.
    pub(super) threads: usize,
    /// Bytes of memory that all nodes may take that run at the same time.
    pub(super) budget: u64,
    /// Bytes of memory that a node takes for each of its sites.
    pub(super) site_bytes: u64,
}

/// What came of all nodes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Totals {
    /// Distinct points.
    pub sites: u64,
    /// Rows that equal a smaller row.
    pub duplicates: u64,
    /// Simplices.
    pub simplices: u64,
    /// Facets of the convex hull.
    pub hull: u64,
    /// The fingerprint of the simplices.
    pub fingerprint: taut_certify::Fingerprint,
    /// Vertices of a simplex.
    pub vertices_per_simplex: u32,
    /// Tiles.
    pub tiles: u64,
    /// Sites that the leaves passed up, all together.
    pub front_sites: u64,
    /// Sites that were triangulated again above the leaves, all together.
    pub merged_sites: u64,
    /// The sites at the root.
    pub root_sites: u64,
}

impl AddAssign<&TileCounts> for Totals {
    fn add_assign(&mut self, tile: &TileCounts) {
        self.sites += tile.owned();
        self.duplicates += tile.duplicates;
        self.simplices += tile.simplices;
        self.hull += tile.hull;
        self.fingerprint.merge(tile.fingerprint);
        self.vertices_per_simplex = self.vertices_per_simplex.max(tile.vertices_per_simplex);
        self.tiles += 1;
    }
}

/// The nodes that are gone through: `children[k]` are two earlier places of this list, or none for a leaf; the root is
/// the last.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Walk {
    nodes: Vec<u32>,
    children: Vec<Option<[usize; 2]>>,
}

impl Walk {
    /// The nodes below and including the root, down to those that `is_leaf` holds of, children first.
    pub(super) fn new(
        children: impl Fn(u32) -> Option<[u32; 2]>,
        is_leaf: impl Fn(u32) -> bool,
    ) -> Self {
        let mut walk = Self { nodes: vec![], children: vec![] };
        // A node is listed when its children are.
        let mut open: Vec<(u32, bool)> = vec![(0, false)];
        let mut listed: Vec<usize> = Vec::new();
        while let Some((node, is_open)) = open.pop() {
            let below = if is_leaf(node) { None } else { children(node) };
            match below {
                Some([left, right]) if !is_open => {
                    open.extend([(node, true), (right, false), (left, false)]);
                }
                Some(_) => {
                    let second = listed.pop().unwrap_or(0);
                    let first = listed.pop().unwrap_or(0);
                    walk.push(node, Some([first, second]), &mut listed);
                }
                None => walk.push(node, None, &mut listed),
            }
        }
        walk
    }

    /// The nodes in the order of the walk.
    pub(super) fn nodes(&self) -> &[u32] {
        &self.nodes
    }

    fn push(&mut self, node: u32, children: Option<[usize; 2]>, listed: &mut Vec<usize>) {
        listed.push(self.nodes.len());
        self.nodes.push(node);
        self.children.push(children);
    }
}

/// The state of one node of the walk.
enum Progress {
    Waiting,
    /// It is not stored, and waits for memory.
    Missing(Task),
    Running,
    /// Stored nodes whose fronts side by side are what goes up, and the sites in them.
    Done {
        fronts: Vec<u32>,
        sites: u64,
    },
}

struct Board {
    progress: Vec<Progress>,
    /// Nodes before this place are done.
    first_open: usize,
    in_use: u64,
    running: usize,
    totals: Totals,
    failed: Option<Error>,
}

/// What one thread does next.
#[derive(Clone)]
struct Task {
    place: usize,
    bytes: u64,
    /// The stored nodes whose fronts are the input; none for a leaf.
    fronts: Option<Vec<u32>>,
    sites: u64,
}

/// Goes through all nodes; `leaf_sites` tells how many points a leaf has.
pub(super) fn run<const D: usize>(
    whole: &Whole<D>,
    walk: &Walk,
    course: &Course,
    leaf_sites: &(dyn Fn(u32) -> u64 + Sync),
    storage: &dyn Storage<D>,
    monitor: &Monitor<'_>,
) -> Result<Totals, Error>
where
    Dim<D>: Dimension<D>,
{
    let board = Board {
        progress: walk.nodes.iter().map(|_| Progress::Waiting).collect(),
        first_open: 0,
        in_use: 0,
        running: 0,
        totals: Totals::default(),
        failed: None,
    };
    let drive = Drive {
        whole,
        walk,
        course,
        leaf_sites,
        storage,
        monitor,
        board: Mutex::new(board),
        changed: Condvar::new(),
    };
    let refused = |refused: taut_points::ThreadsError| InputError::Option {
        name: "threads",
        value: course.threads.to_string(),
        expected: refused.expected,
    };
    taut_points::check_threads(course.threads).map_err(refused)?;
    let pools = (0..course.threads).map(|_| thread_pool(1)).collect::<Result<Vec<_>, _>>();
    let pools = pools.map_err(refused)?;
    std::thread::scope(|scope| {
        for pool in &pools {
            scope.spawn(|| pool.install(|| drive.work()));
        }
    });
    let board = drive.board.into_inner().unwrap_or_else(PoisonError::into_inner);
    board.failed.map_or(Ok(board.totals), Err)
}

struct Drive<'a, const D: usize> {
    whole: &'a Whole<D>,
    walk: &'a Walk,
    course: &'a Course,
    leaf_sites: &'a (dyn Fn(u32) -> u64 + Sync),
    storage: &'a dyn Storage<D>,
    monitor: &'a Monitor<'a>,
    board: Mutex<Board>,
    changed: Condvar,
}

/// What the board says to a thread that asks for work.
enum Offer {
    /// Ask whether a node is stored.
    Look(Task),
    /// Triangulate a node.
    Solve(Task),
    Wait,
    End,
}

impl<const D: usize> Drive<'_, D>
where
    Dim<D>: Dimension<D>,
{
    fn lock(&self) -> MutexGuard<'_, Board> {
        self.board.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes nodes until none is left.
    fn work(&self) {
        let mut board = self.lock();
        loop {
            match self.offer(&mut board) {
                Offer::End => break,
                Offer::Wait => {
                    board = self.changed.wait(board).unwrap_or_else(PoisonError::into_inner);
                }
                Offer::Look(task) => {
                    let place = task.place;
                    let found;
                    (board, found) = self.unlocked(board, place, 0, || self.look(&task));
                    match found {
                        Some(Some(record)) => self.note(&mut board, &task, &record),
                        Some(None) => board.progress[place] = Progress::Missing(task),
                        None => {}
                    }
                    self.changed.notify_all();
                }
                Offer::Solve(task) => {
                    let Task { place, bytes, .. } = task;
                    let record;
                    (board, record) = self.unlocked(board, place, bytes, || self.perform(&task));
                    if let Some(record) = record {
                        self.note(&mut board, &task, &record);
                    }
                    self.changed.notify_all();
                }
            }
        }
        self.changed.notify_all();
    }

    /// Acts on a node with so many bytes of memory, without the lock. Notes an error, and returns what there is otherwise.
    fn unlocked<'b, R>(
        &'b self,
        mut board: MutexGuard<'b, Board>,
        place: usize,
        bytes: u64,
        act: impl FnOnce() -> Result<R, Error>,
    ) -> (MutexGuard<'b, Board>, Option<R>) {
        board.in_use += bytes;
        board.running += 1;
        board.progress[place] = Progress::Running;
        drop(board);
        let result = act();
        let mut board = self.lock();
        board.in_use -= bytes;
        board.running -= 1;
        match result {
            Ok(result) => (board, Some(result)),
            Err(error) => {
                board.failed.get_or_insert(error);
                (board, None)
            }
        }
    }

    /// The first node that is ready, and fits into the budget if it is known to be missing. Nodes that need no work are done on
    /// the way.
    fn offer(&self, board: &mut Board) -> Offer {
        if board.failed.is_some() {
            return Offer::End;
        }
        let places = self.walk.nodes.len();
        while board.first_open < places
            && matches!(board.progress[board.first_open], Progress::Done { .. })
        {
            board.first_open += 1;
        }
        if board.first_open == places {
            return Offer::End;
        }
        for place in board.first_open..places {
            match &board.progress[place] {
                Progress::Waiting => {}
                Progress::Missing(task) => {
                    let task = task.clone();
                    return self.offer_missing(board, task);
                }
                Progress::Running | Progress::Done { .. } => continue,
            }
            let Some((sites, fronts)) = self.input(board, place) else { continue };
            let is_root = place + 1 == places;
            if let Some(fronts) = fronts.as_ref().filter(|_| !is_root)
                && sites <= self.course.merge_above
            {
                board.progress[place] = Progress::Done { fronts: fronts.clone(), sites };
                continue;
            }
            let bytes = sites.saturating_mul(self.course.site_bytes);
            return Offer::Look(Task { place, bytes, fronts, sites });
        }
        if board.running > 0 { Offer::Wait } else { self.offer(board) }
    }

    /// Offers a node that is not stored, if it fits into the budget.
    fn offer_missing(&self, board: &mut Board, task: Task) -> Offer {
        let (sites, needed, budget) = (task.sites, task.bytes, self.course.budget);
        if needed > budget {
            board.failed = Some(Error::Memory { sites, needed, budget });
            return Offer::End;
        }
        let is_full = board.running > 0 && board.in_use + needed > budget;
        if is_full { Offer::Wait } else { Offer::Solve(task) }
    }

    /// How many sites a node has to triangulate and whose fronts they are; `None` if it is not ready.
    fn input(&self, board: &Board, place: usize) -> Option<(u64, Option<Vec<u32>>)> {
        let Some([left, right]) = self.walk.children[place] else {
            return Some(((self.leaf_sites)(self.walk.nodes[place]), None));
        };
        match (&board.progress[left], &board.progress[right]) {
            (Progress::Done { fronts: a, sites: m }, Progress::Done { fronts: b, sites: n }) => {
                Some((m + n, Some([a.as_slice(), b].concat())))
            }
            _ => None,
        }
    }

    fn note(&self, board: &mut Board, task: &Task, record: &NodeRecord) {
        board.totals += &record.counts;
        if task.fronts.is_none() {
            board.totals.front_sites += record.front_sites;
        } else {
            board.totals.merged_sites += task.sites;
        }
        if task.place + 1 == self.walk.nodes.len() {
            board.totals.root_sites = task.sites;
        }
        let fronts =
            if record.front_sites > 0 { vec![self.walk.nodes[task.place]] } else { vec![] };
        board.progress[task.place] = Progress::Done { fronts, sites: record.front_sites };
    }

    /// What an earlier run has stored of a node.
    fn look(&self, task: &Task) -> Result<Option<NodeRecord>, Error> {
        self.monitor.check()?;
        let found = self.storage.stored(self.walk.nodes[task.place])?;
        if found.is_some() {
            self.release(task);
        }
        Ok(found)
    }

    fn perform(&self, task: &Task) -> Result<NodeRecord, Error> {
        self.monitor.check()?;
        let node = self.walk.nodes[task.place];
        let Course { row_bytes, .. } = *self.course;
        let Self { whole, storage, monitor, .. } = self;
        let is_root = task.place + 1 == self.walk.nodes.len();
        let record = match &task.fronts {
            None => {
                let mut points = Some(storage.points(node)?);
                storage.store(node, &mut |output, out| {
                    let job = NodeJob { node, row_bytes, output };
                    summarize(whole, job, points.take().unwrap_or_default(), out, monitor)
                })?
            }
            Some(fronts) => {
                let mut all = Front::empty();
                for &below in fronts {
                    all.append(storage.front(below)?);
                }
                let mut all = Some(all);
                storage.store(node, &mut |output, out| {
                    let job = NodeJob { node, row_bytes, output };
                    let front = all.take().unwrap_or_default();
                    if is_root {
                        Ok((finish(whole, job, front, out, monitor)?, Front::empty()))
                    } else {
                        merge(whole, job, front, out, monitor)
                    }
                })?
            }
        };
        self.release(task);
        Ok(record)
    }

    fn release(&self, task: &Task) {
        if task.fronts.is_none() {
            self.storage.release(self.walk.nodes[task.place]);
        }
    }
}
