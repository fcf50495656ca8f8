//! Tiles are read by two threads, every other one by each, and handed on in order.
//!
//! *Idea.* Reading, its sum and the distribution of the sites by row take longer than the judging of the simplices, which all
//! threads share. So two threads read where the tiles that wait for each other fit into the memory. The sites of a tile are
//! distributed when those of the tile before have been, and after the tile has been handed on, so that one tile is judged
//! while the one before is distributed.
//! *Guarantee.* What is handed on, the order of the sites and the violation that is told are those of one thread: of all that is
//! wrong the first tile counts, and in a tile what is judged before what is read. For a tile is judged only after all tiles
//! before have been handed on whole, and what is left of these, the distribution, is not broken off.

use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;

use super::inside::Job;
use super::rows::{Coverage, Site};
use super::tile::{Counts, Expected, TileFile, TileSites, WithNeighbors};
use super::{TilesError, TilesViolation};

/// Threads that read where memory and the threads of the check allow.
const READERS_MAX: usize = 2;

/// What a thread that reads hands on, in the order of the file.
pub(super) enum Part<const D: usize> {
    Tile(Arc<TileSites<D>>),
    /// Simplices one after the other, and their neighbors: not as arrays, so that readers are compiled once for all kinds of simplices.
    Simplices(Vec<u32>, Vec<u32>),
    End(Counts),
}

/// An error, and the place of its tile among all.
type Misplaced = (usize, TilesError);

/// Reads so many simplices, of which the first has that number.
type ReadSimplices<const D: usize> =
    fn(&mut TileFile<D>, usize, u64) -> Result<WithNeighbors, TilesError>;

/// What judges the parts of a tile.
type Judge<'a, const D: usize> =
    dyn FnMut(&mut dyn Iterator<Item = Part<D>>) -> Result<(), TilesError> + 'a;

/// The threads that read.
pub(super) struct Readers<'a, 'j, const D: usize> {
    job: &'a Job<'j, D>,
    /// Reads simplices of the kind there is.
    simplices: ReadSimplices<D>,
    expected: Expected,
    count: usize,
    turn: Mutex<Turn<D>>,
    is_next: Condvar,
}

/// The distribution of sites, and the place of the tile that it waits for.
struct Turn<const D: usize> {
    coverage: Coverage<D>,
    place: usize,
    /// A thread has ended before its last tile.
    is_over: bool,
}

impl<'a, 'j, const D: usize> Readers<'a, 'j, D> {
    /// Sites and duplicates go to `coverage`.
    pub(super) fn new(
        job: &'a Job<'j, D>,
        coverage: Coverage<D>,
        simplices: ReadSimplices<D>,
    ) -> Self {
        let expected = Expected {
            points: job.manifest.points,
            row_bytes: job.manifest.row_bytes,
            vertices: job.vertices,
            memory: job.shares.sites,
        };
        // Two threads hold the sites of three tiles, where one and the judge hold two. A tile that cannot be opened is told in its turn.
        let fits = |&tile: &(u32, u64)| {
            TileFile::<D>::open(job.folder, tile, &expected)
                .is_ok_and(|file| file.counts.memory::<D>() <= job.shares.sites / 3 * 2)
        };
        let is_shared = rayon::current_num_threads() > 1 && job.manifest.tiles.iter().all(fits);
        let count = if is_shared { READERS_MAX } else { 1 };
        let turn = Mutex::new(Turn { coverage, place: 0, is_over: false });
        Readers { job, simplices, expected, count, turn, is_next: Condvar::new() }
    }

    /// Reads all tiles; `judge` is given the parts of each in turn.
    pub(super) fn read(self, judge: &mut Judge<'_, D>) -> Result<Coverage<D>, TilesError> {
        let failed = thread::scope(|scope| {
            let mut receivers = vec![];
            let mut readers = vec![];
            for first in 0..self.count {
                let (send, receive) = sync_channel(1);
                receivers.push(receive);
                let this = &self;
                readers.push(scope.spawn(move || this.read_from(first, &send)));
            }
            let judged = self.judge_in_order(&receivers, judge);
            // A thread that still reads has nobody to hand on to, and ends.
            drop(receivers);
            let read = readers.into_iter().map(|reader| {
                reader.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
            });
            [judged].into_iter().chain(read).filter_map(Result::err).collect::<Vec<Misplaced>>()
        });
        // The first of equals is returned: what was judged comes first.
        match failed.into_iter().min_by_key(|failed| failed.0) {
            Some((_, error)) => Err(error),
            None => Ok(self.turn.into_inner().unwrap_or_else(PoisonError::into_inner).coverage),
        }
    }

    fn judge_in_order(
        &self,
        receivers: &[Receiver<Part<D>>],
        judge: &mut Judge<'_, D>,
    ) -> Result<(), Misplaced> {
        for place in 0..self.job.manifest.tiles.len() {
            let receiver = &receivers[place % receivers.len()];
            let mut is_whole = false;
            let mut parts = std::iter::from_fn(|| {
                let part = if is_whole { None } else { receiver.recv().ok() };
                is_whole |= matches!(part, Some(Part::End(_)));
                part
            });
            judge(&mut parts).map_err(|error| (place, error))?;
            if !is_whole {
                // The thread that reads it tells why.
                return Ok(());
            }
        }
        Ok(())
    }

    /// Reads one tile in `count` from the first on.
    fn read_from(&self, first: usize, send: &SyncSender<Part<D>>) -> Result<(), Misplaced> {
        for place in (first..self.job.manifest.tiles.len()).step_by(self.count) {
            let read = self.read_tile(place, send);
            if !matches!(read, Ok(Some(()))) {
                self.lock().is_over = true;
                self.is_next.notify_all();
                return read.map(|_| ()).map_err(|error| (place, error));
            }
        }
        Ok(())
    }

    /// Reads a tile and hands it on; `None` if nobody wants it any more.
    fn read_tile(
        &self,
        place: usize,
        send: &SyncSender<Part<D>>,
    ) -> Result<Option<()>, TilesError> {
        let job = self.job;
        let mut file = TileFile::<D>::open(job.folder, job.manifest.tiles[place], &self.expected)?;
        let sites = file.sites(&self.expected)?;
        if send.send(Part::Tile(Arc::clone(&sites))).is_err() {
            return Ok(None);
        }
        if file.counts.duplicates > 0 {
            let Some(mut turn) = self.turn_of(place) else { return Ok(None) };
            file.duplicates(|[row, first]| self.duplicate(&mut turn.coverage, row, first))?;
        }
        // Five chunks are held where two threads read, three where one does.
        // A triangulation of no points has no vertices of simplices.
        let vertices = u64::from(job.vertices.max(1));
        let chunk = (job.shares.chunk / (8 * vertices * self.count as u64)).max(1);
        let mut is_vertex = vec![false; sites.rows.len()];
        let mut done = 0;
        while done < file.counts.simplices {
            let count = chunk.min(file.counts.simplices - done);
            let (simplices, neighbors) = (self.simplices)(&mut file, count as usize, done)?;
            for &v in &simplices {
                is_vertex[v as usize] = true;
            }
            done += count;
            if send.send(Part::Simplices(simplices, neighbors)).is_err() {
                return Ok(None);
            }
        }
        let counts = file.counts;
        let copies = file.finish()?;
        if send.send(Part::End(counts)).is_err() {
            return Ok(None);
        }
        let Some(mut turn) = self.turn_of(place) else { return Ok(None) };
        self.distribute(&mut turn.coverage, &sites, &is_vertex, &copies)?;
        turn.place += 1;
        self.is_next.notify_all();
        Ok(Some(()))
    }

    fn distribute(
        &self,
        coverage: &mut Coverage<D>,
        sites: &TileSites<D>,
        is_vertex: &[bool],
        copies: &[u32],
    ) -> Result<(), TilesError> {
        let smallest = self.job.overview.smallest;
        let mut copies = copies.iter().peekable();
        for (number, (&row, &coordinates)) in sites.rows.iter().zip(&sites.coordinates).enumerate()
        {
            if smallest.is_some_and(|(v, p)| p == coordinates && row != v) {
                let problem = "is a site, but equals an earlier point";
                return Err(TilesViolation::Site { row, problem }.into());
            }
            let is_owned = copies.next_if_eq(&&(number as u32)).is_none();
            coverage.add(&Site { row, coordinates, is_owned, is_vertex: is_vertex[number] })?;
        }
        Ok(())
    }

    fn duplicate(
        &self,
        coverage: &mut Coverage<D>,
        row: u64,
        first: u64,
    ) -> Result<(), TilesError> {
        if row.max(first) >= self.job.manifest.points {
            let problem = "there are not so many points";
            return Err(TilesViolation::Duplicate { row, first, problem }.into());
        }
        coverage.add_duplicate(row, first)
    }

    /// Waits until all tiles before have been distributed; `None` if that will not be.
    fn turn_of(&self, place: usize) -> Option<MutexGuard<'_, Turn<D>>> {
        let waits = |turn: &mut Turn<D>| turn.place != place && !turn.is_over;
        let turn = self.is_next.wait_while(self.lock(), waits);
        Some(turn.unwrap_or_else(PoisonError::into_inner)).filter(|turn| turn.place == place)
    }

    fn lock(&self) -> MutexGuard<'_, Turn<D>> {
        self.turn.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
