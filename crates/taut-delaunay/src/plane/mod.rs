//! The kernel of the plane: one site after another is walked to, and what it is in conflict with is replaced by its star.
//!
//! *Problem.* The Delaunay triangulation of sites in ℝ², closed by ghost triangles, under the lexicographic
//! perturbation.
//! *Idea.* A triangle is in conflict with a new site q if its circumcircle holds q; such triangles form a disc, seen
//! whole from q. Find one of them by a visibility walk from the site before, dig from edge to edge through all
//! of them, counter-clockwise around q, and make every edge of the rim a triangle of the star at once.
//! *Guarantee.* Signs are exact and never tie, so the mesh is a function of the set of inserted sites. A ghost answers
//! for the outside of its hull edge. Per insertion two slots are added, and on one thread none is left dead. No recursion.
//! *Trap.* All tests take place in coordinates relative to q. A vertex that two tests share keeps its difference, its
//! lift and its 2 × 2 minor from one to the next: of the three vertices of a triangle only one is ever loaded.
//! *Cost.* For uniform points in rounds along a Hilbert curve, per site: 1.3 triangles walked through, 9.0 conflict
//! tests, 6 triangles written. A fifth of the time goes to first touches of new pages, a fifth to the walk, the rest
//! to the cavity. Indices without bounds checks and slots made in batches gave nothing.
//! *Threads.* They insert into one mesh ([`threads`](crate::threads)); a star that turns out to be in the way of another thread's is
//! taken back (`undo`).
//! *Reference.* Bowyer 1981 and Watson 1981 for the cavity; Devillers, Pion and Teillaud 2002 for the walk; Amenta,
//! Choi and Rote 2003 for the rounds that the caller inserts in.

pub(crate) mod constrained;
mod dig;
mod dispatch;
mod seen;
mod star;
#[cfg(test)]
mod tests;
mod undo;
mod walk;

use std::sync::atomic::AtomicU32;

use taut_predicates::plane::orient_exact;
use taut_predicates::{Exact, MulAdd, Separate};

use crate::kernel::{Counters, Kernel, Settings, TooMany};
use crate::records::Records;
use crate::simplex::{GHOST, Simplex, code};
use crate::threads::{
    Alone, Hold, Holder, Inserted, OwnSlots, Owners, Plain, Progress, Record, Room, SharedMesh,
    Slot, repair_beginnings,
};
use dig::{Edge, dig};
use seen::{PointOffset, View};
use star::Star;
use undo::{Recorded, Undo};
use walk::{is_triangle, walk};

/// Triangles are numbered with 30 bits, as a code has two more for the facet.
const TRIANGLES_MAX: usize = 1 << 30;

/// A Delaunay triangulation under construction.
pub(crate) struct Mesh {
    sites: Vec<[f64; 2]>,
    records: Records<3>,
    /// The first slot that nobody has taken.
    next: AtomicU32,
    owners: Owners,
    /// The first one inserts alone.
    workers: Vec<Worker>,
    settings: Settings,
}

/// What a thread has for itself, in cache lines of its own.
#[repr(align(128))]
pub(crate) struct Worker {
    /// Where the next walk begins: a triangle of the site inserted last, or one that a walk came to.
    last: u32,
    slots: OwnSlots,
    exact: Exact,
    counters: Counters,
    /// Edges still to be looked through while digging; kept for its memory.
    pending: Vec<Edge>,
    /// Slots that the star may take; kept for its memory.
    free: Vec<u32>,
    undo: Undo,
}

impl Worker {
    fn new(settings: Settings) -> Self {
        Worker {
            last: 0,
            slots: OwnSlots::default(),
            exact: Exact::new(settings.integral),
            counters: Counters::default(),
            pending: Vec::new(),
            free: Vec::new(),
            undo: Undo::default(),
        }
    }
}

/// What threads share, or what one has that is alone: its records are those of its [`Hold`].
pub(crate) struct Shared<'a, R> {
    sites: &'a [[f64; 2]],
    triangles: &'a [R],
    room: Room<'a>,
    settings: Settings,
}

impl Kernel<2, 3> for Mesh {
    fn new(sites: Vec<[f64; 2]>, settings: Settings) -> Mesh {
        // A closed mesh of n sites and the ghost vertex has 2n − 2 triangles.
        let triangles = (2 * sites.len() + 4).min(TRIANGLES_MAX);
        Mesh {
            records: Records::new(triangles),
            sites,
            next: AtomicU32::new(0),
            owners: Owners::new(0),
            workers: vec![Worker::new(settings)],
            settings,
        }
    }

    fn site_count(&self) -> u32 {
        self.sites.len() as u32
    }

    #[inline(always)]
    fn site(&self, site: u32) -> [f64; 2] {
        self.sites[site as usize]
    }

    fn start(&mut self, [a, b, c]: [u32; 3]) {
        let [p, q, r] = [a, b, c].map(|v| self.sites[v as usize]);
        let worker = &mut self.workers[0];
        worker.counters.orientations += 1;
        worker.counters.insertions += 3;
        let (b, c) =
            if orient_exact(p, q, r, &mut worker.exact).is_positive() { (b, c) } else { (c, b) };
        // Ghost i lies across the edge opposite vertex i; its ghost vertex has place 0, as has the hull edge.
        let ghost = |from: u32, to: u32, inside: u32, next: u32, last: u32| Simplex {
            vertices: [GHOST, to, from],
            neighbors: [inside, code(last, 2), code(next, 1)],
        };
        let all = [
            Simplex { vertices: [a, b, c], neighbors: [code(1, 0), code(2, 0), code(3, 0)] },
            ghost(b, c, code(0, 0), 2, 3),
            ghost(c, a, code(0, 1), 3, 1),
            ghost(a, b, code(0, 2), 1, 2),
        ];
        self.records.all().iter().zip(all).for_each(|(record, triangle)| record.set(triangle));
        self.records.set_len(all.len());
        self.next = AtomicU32::new(all.len() as u32);
        worker.last = 0;
    }

    fn insert(&mut self, sites: &[u32]) -> Result<(), TooMany> {
        if self.records.len() + 2 * sites.len() > TRIANGLES_MAX {
            return Err(TooMany);
        }
        let mut left = sites;
        loop {
            let (shared, worker) = self.alone();
            let progress = &mut Progress::default();
            let done = dispatch::insert(&shared, worker, &mut Alone, left, progress);
            self.end_sharing();
            match done {
                Inserted::All => return Ok(()),
                Inserted::Full(at) => left = &left[at..],
            }
            self.grow()?;
        }
    }

    #[inline(always)]
    fn simplices(&self) -> &[Simplex<3>] {
        self.records.as_slice()
    }

    fn last(&self) -> u32 {
        self.workers[0].last
    }

    fn locate(&mut self, q: [f64; 2], hint: u32) -> u32 {
        let (Shared { sites, triangles, settings, .. }, worker) = self.alone();
        let view = View::new(sites, q, settings.filtered);
        let Worker { exact, counters, .. } = worker;
        match walk::<Separate, Alone>(&view, triangles, hint, exact, counters) {
            Ok(found) => found.triangle,
            Err(triangle) => triangle,
        }
    }

    fn finish(self) -> (Vec<Simplex<3>>, Option<Vec<[f64; 2]>>, Counters) {
        let mut all = Counters::default();
        for Worker { mut counters, exact, .. } in self.workers {
            // The filters of the common path count nothing: what no other stage decided was theirs.
            let mut stages = exact.stages;
            let open = stages.calls() - stages.filter;
            stages.filter = (counters.orientations + counters.conflict_tests).saturating_sub(open);
            counters.stages = stages;
            all += counters;
        }
        (self.records.into_simplices(), Some(self.sites), all)
    }
}

impl Mesh {
    /// What the first worker needs to work alone.
    fn alone(&mut self) -> (Shared<'_, Plain<3>>, &mut Worker) {
        let end = self.records.all().len() as u32;
        let shared = Shared {
            sites: &self.sites,
            triangles: self.records.alone(),
            room: Room { next: &self.next, end },
            settings: self.settings,
        };
        (shared, &mut self.workers[0])
    }
}

impl SharedMesh<2, 3> for Mesh {
    type View<'a> = Shared<'a, Record<3>>;
    type Worker = Worker;

    const SITES_MIN: usize = 4000;

    fn share(&mut self, threads: usize) -> (Self::View<'_>, &Owners, &mut [Worker]) {
        if threads > 1 && self.owners.len() < self.sites.len() {
            self.owners = Owners::new(self.sites.len());
        }
        let more = threads.saturating_sub(self.workers.len());
        if more > 0 {
            let (last, settings) = (self.workers[0].last, self.settings);
            let worker = || Worker { last, ..Worker::new(settings) };
            self.workers.extend(std::iter::repeat_with(worker).take(more));
            let room = self.records.room() + more * Room::SLOTS_SPARE;
            self.records.reserve(room.min(TRIANGLES_MAX));
        }
        self.records.extend_to_end();
        let shared = Shared {
            sites: &self.sites,
            triangles: self.records.all(),
            room: Room { next: &self.next, end: self.records.all().len() as u32 },
            settings: self.settings,
        };
        (shared, &self.owners, &mut self.workers[..threads])
    }

    fn end_sharing(&mut self) {
        for worker in &mut self.workers {
            worker.slots.give_back(&self.next, self.records.all());
        }
        self.records.set_len(*self.next.get_mut() as usize);
        let is_live = |t: u32| is_triangle(self.records.all()[t as usize].vertices());
        let beginnings = self.workers.iter_mut().map(|worker| &mut worker.last);
        repair_beginnings(beginnings, self.records.len(), is_live);
    }

    fn grow(&mut self) -> Result<(), TooMany> {
        let len = self.records.all().len();
        if len >= TRIANGLES_MAX {
            return Err(TooMany);
        }
        if !self.records.extend() {
            self.records.reserve((len + len / 8 + Room::SLOTS_SPARE).min(TRIANGLES_MAX));
            self.records.extend_to_end();
        }
        Ok(())
    }

    fn insert_concurrently(
        view: &Self::View<'_>,
        worker: &mut Worker,
        holder: &mut Holder<'_>,
        sites: &[u32],
        progress: &mut Progress,
    ) -> Inserted {
        dispatch::insert(view, worker, holder, sites, progress)
    }
}

/// Attempts to insert a site beside other threads before it is left for the end of the round.
const ATTEMPTS_EACH: usize = 4;

/// Inserts sites in this order.
#[inline(always)]
fn insert_with<M: MulAdd, H: Hold>(
    shared: &Shared<'_, H::Slot<3>>,
    worker: &mut Worker,
    hold: &mut H,
    sites: &[u32],
    progress: &mut Progress,
) -> Inserted {
    let triangles = shared.triangles;
    for (place, &site) in sites.iter().enumerate() {
        // Every insertion adds one vertex to a sphere, hence two triangles.
        if !worker.slots.reserve(2, shared.room, triangles) {
            return Inserted::Full(place);
        }
        let next = *sites.get(place + 1).unwrap_or(&site);
        let view = View::new(shared.sites, shared.sites[site as usize], shared.settings.filtered);
        let towards = view.see::<M>(next);
        if H::SHARED {
            let mut is_inserted = false;
            for attempt in 0..ATTEMPTS_EACH {
                progress.attempts += 1;
                let is_first = attempt == 0;
                is_inserted = insert_beside_others::<M, H>(
                    &view, towards, shared, worker, hold, site, is_first,
                );
                if is_inserted {
                    break;
                }
                hold.back_off();
                progress.failed += 1;
                let is_live = |&t: &u32| is_triangle(triangles[t as usize].vertices());
                worker.last = shared.room.some_of(worker.last, is_live);
            }
            if !is_inserted {
                progress.deferred.push(site);
                continue;
            }
        } else {
            let Worker { last, slots, exact, counters, pending, free, .. } = &mut *worker;
            let found = walk::<M, H>(&view, triangles, *last, exact, counters)
                .expect("a walk ends in a mesh that stands still");
            let (low, high) = (slots.pop(), slots.pop());
            free.extend([high, low]);
            let mut star = Star::new(site, triangles, free, &found, towards);
            dig::<M, _, _>(&view, triangles, hold, found, pending, exact, counters, &mut star);
            *last = star.close();
        }
        worker.counters.insertions += 1;
        // The walk finds the first triangle of each cavity, digging counts the others.
        worker.counters.replaced += 1;
        hold.done();
    }
    Inserted::All
}

/// Beside other threads: walks to q, the site `site`, and replaces its cavity by its star, holding all vertices of both. Returns
/// false, and leaves the mesh as it was, if other threads are in the way; what it holds it does not give back.
#[inline(always)]
fn insert_beside_others<M: MulAdd, H: Hold>(
    view: &View<'_>,
    towards: PointOffset,
    shared: &Shared<'_, H::Slot<3>>,
    worker: &mut Worker,
    hold: &mut H,
    site: u32,
    is_first: bool,
) -> bool {
    let Worker { last, slots, exact, counters, pending, free, undo, .. } = worker;
    let triangles = shared.triangles;
    let found = match walk::<M, H>(view, triangles, *last, exact, counters) {
        Ok(found) => found,
        Err(at) => {
            *last = at;
            return false;
        }
    };
    // Where the walk ended is a good beginning for the next attempt.
    *last = found.triangle;
    if !is_triangle(found.vertices) || !hold.hold(found.vertices) || !found.is_at(triangles) {
        return false;
    }
    if is_first {
        hold.hold_new(site);
    } else if !hold.hold([site]) {
        // Another thread has read of it in a star that was taken back.
        return false;
    }
    let (low, high) = (slots.pop(), slots.pop());
    free.extend([high, low]);
    undo.note(triangles, found.triangle);
    let star = Star::new(site, triangles, free, &found, towards);
    let mut recorded = Recorded { star, triangles, undo };
    let is_held =
        dig::<M, _, _>(view, triangles, hold, found, pending, exact, counters, &mut recorded);
    if is_held {
        *last = recorded.star.close();
        undo.clear();
    } else {
        free.clear();
        undo.take_back(triangles, [low, high]);
        slots.push(low);
        slots.push(high);
    }
    is_held
}
