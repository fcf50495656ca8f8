//! The kernel of space: tetrahedra under insertion.
//!
//! *Problem.* Add sites one by one to a Delaunay triangulation of space, in about a microsecond each.
//! *Idea.* Walk from the last simplex made to the one that holds the new site; take out its cavity, all simplices whose
//! circumsphere holds it; put its star there. Sites come in the order of a space-filling curve, so all of this happens in
//! memory that was just in use, and what is left to do is arithmetic: 43 in-sphere tests per site on uniform points, which
//! run eight or four at a time where the machine has vectors.
//! *Guarantee.* The mesh is the Delaunay triangulation under the lexicographic perturbation: a function of the set of
//! inserted sites, whatever their order and whichever path took the signs. No recursion, no panic on any distinct sites;
//! more than 2³⁰ simplices are an error (two skew lines with n sites have n²/4).
//! *Trap.* The hull. A ghost is in conflict with what lies strictly beyond its facet; with what lies in the plane of that
//! facet it answers as the finite simplex behind it. That needs no in-circle test in a plane: the vertex off the plane has
//! coefficient zero in the perturbed sign.
//! *Reference.* Bowyer, Comput. J. 24(2), 1981; Watson, ibid.; Amenta, Choi and Rote, SoCG 2003, for the order.
//!
//! `walk` finds the simplex, `cavity` what must go, `star` what comes; `signs` says what they ask of arithmetic and
//! `lanes` answers it with vectors.

mod cavity;
mod lanes;
#[cfg(target_arch = "x86_64")]
mod pairs;
mod signs;
mod star;
#[cfg(test)]
mod tests;
mod walk;
#[cfg(target_arch = "x86_64")]
mod whole;

use std::cell::Cell;
use std::marker::PhantomData;
use std::sync::atomic::{AtomicU8, AtomicU32};

use taut_predicates::Separate;

use crate::kernel::{Counters, Kernel, Settings, TooMany};
use crate::records::{Records, extend_zeros, zeros};
use crate::simplex::{DEAD_MARK, GHOST, Simplex, code};
use crate::threads::{
    Alone, Hold, Holder, Inserted, Mark, OwnSlots, Owners, Plain, Progress, Record, Room,
    SharedMesh, Slot, plain_marks, repair_beginnings,
};
use cavity::{Cavity, FACETS};
use lanes::Level;
use signs::{Judge, Scalar, Signs, Unfiltered};
use star::Star;

/// The coordinates of a site, padded so that one aligned load fetches them.
#[repr(C, align(32))]
#[derive(Clone, Copy, Debug)]
struct Site([f64; 4]);

impl Site {
    /// The vertex at infinity: makes every comparison with it false.
    const GHOST: Site = Site([f64::NAN; 4]);

    fn new([x, y, z]: [f64; 3]) -> Self {
        Site([x, y, z, 0.0])
    }

    /// The coordinates.
    #[inline(always)]
    fn point(&self) -> [f64; 3] {
        [self.0[0], self.0[1], self.0[2]]
    }
}

/// The row of a site: the vertex at infinity comes first, so that its number wraps to 0.
#[inline(always)]
fn row(vertex: u32) -> usize {
    vertex.wrapping_add(1) as usize
}

/// Most simplices, dead slots included: what 30 bits can number.
const SIMPLICES_MAX: usize = 1 << 30;

/// The mesh of space under construction.
pub(crate) struct Mesh {
    sites: Vec<Site>,
    records: Records<4>,
    /// For `cavity`; zero between insertions.
    marks: Vec<AtomicU8>,
    /// The first slot that nobody has taken.
    next: AtomicU32,
    owners: Owners,
    /// The first one inserts alone.
    workers: Vec<Worker>,
    settings: Settings,
    level: Level,
    /// Most simplices; [`SIMPLICES_MAX`] outside tests.
    limit: usize,
}

/// What a thread has for itself, in cache lines of its own.
#[repr(align(128))]
pub(crate) struct Worker {
    /// Where the next walk begins.
    last: u32,
    slots: OwnSlots,
    cavity: Cavity,
    star: Star,
    judge: Judge,
    counters: Counters,
}

impl Worker {
    fn new(sites: usize, settings: Settings) -> Self {
        Worker {
            last: 0,
            slots: OwnSlots::default(),
            cavity: Cavity::default(),
            star: Star::new(sites),
            judge: Judge::new(settings),
            counters: Counters::default(),
        }
    }
}

/// What threads share, or what one has that is alone: its records and marks are those of its [`Hold`].
pub(crate) struct View<'a, R, M> {
    sites: &'a [Site],
    simplices: &'a [R],
    marks: &'a [M],
    room: Room<'a>,
    level: Level,
}

impl Kernel<3, 4> for Mesh {
    fn new(sites: Vec<[f64; 3]>, settings: Settings) -> Self {
        // Uniform points of a torus with noise take 7.6 simplices each, dead slots included, the most of all sets of the bench. To grow
        // moves the records, which took 3 % of the time of that build.
        let slots = sites.len().saturating_mul(78) / 10;
        Self::with_room(sites.len(), |i| sites[i], settings, slots)
    }

    fn gather(count: usize, site: impl Fn(usize) -> [f64; 3], settings: Settings) -> Self {
        // Uniform points take 6.77 simplices each, ghosts included; cavities leave a few dead slots. Whoever gathers points has
        // a limit on memory.
        Self::with_room(count, site, settings, count * 69 / 10)
    }

    fn site_count(&self) -> u32 {
        self.sites.len() as u32 - 1
    }

    #[inline(always)]
    fn site(&self, site: u32) -> [f64; 3] {
        self.sites[row(site)].point()
    }

    fn start(&mut self, mut first: [u32; 4]) {
        debug_assert!(self.records.len() == 0, "a mesh starts once");
        let worker = &mut self.workers[0];
        let sign = worker.judge.orient(first.map(|v| &self.sites[row(v)]));
        debug_assert!(!sign.is_zero(), "the first four sites span space");
        if sign.is_negative() {
            first.swap(2, 3);
        }
        // Ghost i + 1 lies across facet i: seen from outside, two vertices of that facet change places.
        let ghosts = FACETS.map(|[a, b, c]| [GHOST, first[b], first[a], first[c]]);
        let all: Vec<[u32; 4]> = std::iter::once(first).chain(ghosts).collect();
        let without = |vertices: [u32; 4], i: usize| {
            let mut facet = vertices;
            facet[i] = DEAD_MARK;
            facet.sort_unstable();
            facet
        };
        for (t, &vertices) in all.iter().enumerate() {
            let neighbors = [0, 1, 2, 3].map(|i| {
                let facet = without(vertices, i);
                let others = (0..5).filter(|&other| other != t);
                let mut sides = others.flat_map(|other| (0..4).map(move |j| (other, j)));
                let (other, j) = sides
                    .find(|&(other, j)| without(all[other], j) == facet)
                    .expect("a tetrahedron and its four ghosts close up");
                code(other as u32, j as u32)
            });
            self.records.all()[t].set(Simplex { vertices, neighbors });
        }
        self.records.set_len(all.len());
        self.next = AtomicU32::new(all.len() as u32);
        worker.counters.insertions += 4;
        worker.counters.orientations += 1;
    }

    fn insert(&mut self, sites: &[u32]) -> Result<(), TooMany> {
        let mut left = sites;
        loop {
            let (view, worker) = self.alone();
            let done = lanes::insert(&view, worker, &mut Alone, left, &mut Progress::default());
            self.end_sharing();
            match done {
                Inserted::All => return Ok(()),
                Inserted::Full(at) => left = &left[at..],
            }
            self.grow()?;
        }
    }

    #[inline(always)]
    fn simplices(&self) -> &[Simplex<4>] {
        self.records.as_slice()
    }

    fn last(&self) -> u32 {
        self.workers[0].last
    }

    fn locate(&mut self, q: [f64; 3], hint: u32) -> u32 {
        let q = &Site::new(q);
        let (View { sites, simplices, level, .. }, worker) = self.alone();
        let Worker { judge, counters, .. } = worker;
        let found = if matches!(level, Level::Unfiltered) {
            walk::walk::<_, Alone>(Unfiltered, sites, simplices, judge, counters, q, hint)
        } else {
            let signs = Scalar::<Separate>(PhantomData);
            walk::walk::<_, Alone>(signs, sites, simplices, judge, counters, q, hint)
        };
        match found {
            Ok((t, _)) | Err(t) => t,
        }
    }

    fn finish(self) -> (Vec<Simplex<4>>, Option<Vec<[f64; 3]>>, Counters) {
        let mut all = Counters::default();
        for Worker { mut counters, judge, .. } in self.workers {
            let (stages, behind) = judge.into_parts();
            counters.conflict_tests += behind;
            counters.stages += stages;
            counters.stages.filter +=
                counters.orientations + counters.conflict_tests - stages.calls();
            all += counters;
        }
        (self.records.into_simplices(), None, all)
    }
}

impl Mesh {
    /// Makes a mesh without simplices, with room for some. Where the system gives pages when they are touched, as on Linux, room that is
    /// not used costs nothing.
    fn with_room(
        count: usize,
        site: impl Fn(usize) -> [f64; 3],
        settings: Settings,
        slots: usize,
    ) -> Self {
        let slots = (slots + 1024).min(SIMPLICES_MAX);
        let mut rows = Vec::with_capacity(count + 1);
        rows.push(Site::GHOST);
        rows.extend((0..count).map(|i| Site::new(site(i))));
        Mesh {
            sites: rows,
            records: Records::new(slots),
            marks: zeros(slots),
            next: AtomicU32::new(0),
            owners: Owners::new(0),
            workers: vec![Worker::new(count, settings)],
            settings,
            level: Level::best(settings),
            limit: SIMPLICES_MAX,
        }
    }

    /// What the first worker needs to work alone.
    fn alone(&mut self) -> (View<'_, Plain<4>, Cell<u8>>, &mut Worker) {
        let end = self.records.all().len().min(self.limit) as u32;
        let view = View {
            sites: &self.sites,
            simplices: self.records.alone(),
            marks: plain_marks(&mut self.marks),
            room: Room { next: &self.next, end },
            level: self.level,
        };
        (view, &mut self.workers[0])
    }

    /// Makes room for so many slots, as far as the limit allows.
    fn enlarge(&mut self, room: usize) {
        let room = room.min(self.limit).max(self.records.room());
        self.records.reserve(room);
        extend_zeros(&mut self.marks, room);
    }
}

impl SharedMesh<3, 4> for Mesh {
    type View<'a> = View<'a, Record<4>, AtomicU8>;
    type Worker = Worker;

    const SITES_MIN: usize = 1500;

    fn share(&mut self, threads: usize) -> (Self::View<'_>, &Owners, &mut [Worker]) {
        let count = self.sites.len() - 1;
        if threads > 1 && self.owners.len() < count {
            self.owners = Owners::new(count);
        }
        let more = threads.saturating_sub(self.workers.len());
        if more > 0 {
            let (last, settings) = (self.workers[0].last, self.settings);
            let worker = || Worker { last, ..Worker::new(count, settings) };
            self.workers.extend(std::iter::repeat_with(worker).take(more));
            self.enlarge(self.records.room() + more * Room::SLOTS_SPARE);
        }
        self.records.extend_to_end();
        let end = self.records.all().len().min(self.limit) as u32;
        let view = View {
            sites: &self.sites,
            simplices: self.records.all(),
            marks: &self.marks,
            room: Room { next: &self.next, end },
            level: self.level,
        };
        (view, &self.owners, &mut self.workers[..threads])
    }

    fn end_sharing(&mut self) {
        for worker in &mut self.workers {
            worker.slots.give_back(&self.next, self.records.all());
        }
        self.records.set_len(*self.next.get_mut() as usize);
        let is_live = |t: u32| walk::is_simplex(self.records.all()[t as usize].vertices());
        let beginnings = self.workers.iter_mut().map(|worker| &mut worker.last);
        repair_beginnings(beginnings, self.records.len(), is_live);
    }

    fn grow(&mut self) -> Result<(), TooMany> {
        let len = self.records.all().len();
        if len >= self.limit {
            return Err(TooMany);
        }
        if !self.records.extend() {
            // An eighth at a time: doubling would be the peak of the whole build.
            self.enlarge(len + len / 8 + Room::SLOTS_SPARE);
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
        lanes::insert(view, worker, holder, sites, progress)
    }
}

/// Attempts to insert a site beside other threads before it is left for the end of the round.
const ATTEMPTS_EACH: usize = 4;

/// Inserts sites in this order; the path of the signs is the caller's choice.
#[inline(always)]
fn insert_with<S: Signs, H: Hold>(
    signs: S,
    view: &View<'_, H::Slot<4>, H::Mark>,
    worker: &mut Worker,
    hold: &mut H,
    sites: &[u32],
    progress: &mut Progress,
) -> Inserted {
    for (i, &site) in sites.iter().enumerate() {
        // Four sites ahead: about the time that memory takes.
        if let Some(&soon) = sites.get(i + 4) {
            signs.fetch(view.sites.as_ptr().wrapping_add(row(soon)));
        }
        // One copy of `find`, in a function that is compiled for the processor. It fails only beside other threads.
        let attempts = if H::SHARED { ATTEMPTS_EACH } else { 1 };
        let mut is_found = false;
        for attempt in 0..attempts {
            if attempt > 0 {
                begin_elsewhere(view, worker);
            }
            progress.attempts += 1;
            is_found = find(signs, view, worker, hold, site);
            if is_found {
                break;
            }
            progress.failed += 1;
        }
        if !is_found {
            debug_assert!(H::SHARED, "nobody is in the way of one thread");
            progress.deferred.push(site);
            continue;
        }
        let is_placed = replace(view, worker, site);
        hold.done();
        if !is_placed {
            return Inserted::Full(i);
        }
    }
    Inserted::All
}

/// Leaves the cavity of q in `worker` and holds it; the mesh does not change. Returns false, and holds nothing, if another
/// thread is in the way.
#[inline(always)]
fn find<S: Signs, H: Hold>(
    signs: S,
    view: &View<'_, H::Slot<4>, H::Mark>,
    worker: &mut Worker,
    hold: &mut H,
    site: u32,
) -> bool {
    let q = &view.sites[row(site)];
    let Worker { last, cavity, judge, counters, .. } = worker;
    let View { sites, simplices, marks, .. } = *view;
    let found = walk::walk::<S, H>(signs, sites, simplices, judge, counters, q, *last);
    let (start, vertices) = match found {
        Ok(found) => found,
        Err(at) => {
            *last = at;
            hold.back_off();
            return false;
        }
    };
    if H::SHARED {
        // Where the walk ended is a good beginning for the next attempt.
        *last = start;
        if !hold.hold(vertices)
            || simplices[start as usize].vertices() != vertices
            || !is_in_conflict(signs, view, judge, counters, start, vertices, q)
        {
            hold.back_off();
            return false;
        }
    }
    let (tests, all_held) = cavity.carve(signs, sites, simplices, marks, judge, hold, q, start);
    counters.conflict_tests += tests;
    if all_held {
        hold.hold_new(site);
    } else {
        hold.back_off();
    }
    all_held
}

/// Tests whether a simplex that a walk beside other threads came to is in conflict with q. A finite one is, as its facets were
/// asked for these very vertices; a ghost was only reached across the facet of another simplex.
#[inline(always)]
fn is_in_conflict<S: Signs>(
    signs: S,
    view: &View<'_, impl Slot<4>, impl Mark>,
    judge: &mut Judge,
    counters: &mut Counters,
    t: u32,
    vertices: [u32; 4],
    q: &Site,
) -> bool {
    if cavity::ghost_place(vertices).is_none() {
        return true;
    }
    counters.conflict_tests += 1;
    judge.conflicts(signs, view.sites, view.simplices, &[t; 8][..S::WIDTH], 1, q) != 0
}

/// Lets the next walk begin at another simplex, if there is none any more where the last one ended.
#[cold]
#[inline(never)]
fn begin_elsewhere(view: &View<'_, impl Slot<4>, impl Mark>, worker: &mut Worker) {
    let is_live = |&t: &u32| walk::is_simplex(view.simplices[t as usize].vertices());
    worker.last = view.room.some_of(worker.last, is_live);
}

/// Puts the star of `site` in the place of the cavity that `worker` has found. Returns false, and changes nothing, if there is
/// no room.
#[inline(always)]
fn replace(view: &View<'_, impl Slot<4>, impl Mark>, worker: &mut Worker, site: u32) -> bool {
    let Worker { last, slots: own, cavity, star, counters, .. } = worker;
    let simplices = view.simplices;
    let (facets, slots) = cavity.facets_and_slots();
    // Slots of the cavity first: they are in the cache.
    let more = facets.len().saturating_sub(slots.len());
    if !own.reserve(more, view.room, simplices) {
        return false;
    }
    counters.insertions += 1;
    counters.replaced += slots.len() as u64;
    while slots.len() > facets.len() {
        let slot = slots.pop().expect("the loop has just seen it");
        simplices[slot as usize].kill();
        own.push(slot);
    }
    for _ in 0..more {
        slots.push(own.pop());
    }
    star.fill(simplices, facets, slots, site);
    *last = slots[slots.len() - 1];
    true
}
