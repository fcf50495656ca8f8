//! Who holds which vertex.

use std::sync::atomic::Ordering::{Acquire, Relaxed, Release};

use crate::records::zeros;
use crate::simplex::GHOST;
use crate::threads::atomics::{AtomicBool, AtomicU8, fence, spin_loop};
use crate::threads::{Mark, Record, Slot};

/// The vertices that a thread holds while it changes the mesh around them.
pub(crate) trait Hold {
    /// States whether there are other threads.
    const SHARED: bool;

    /// A simplex as this thread reads and writes it.
    type Slot<const V: usize>: Slot<V>;

    /// A mark as this thread reads and writes it.
    type Mark: Mark;

    /// Holds the finite ones of these vertices as well. Returns false if another thread holds one of them.
    fn hold<const V: usize>(&mut self, vertices: [u32; V]) -> bool;

    /// Holds a vertex that is in no simplex yet, nor ever was: who reads of it in one that is written from now on finds it held.
    fn hold_new(&mut self, vertex: u32);

    /// An insertion is done: gives all vertices back if there are many, or if another thread waits for one of them.
    fn done(&mut self);

    /// Gives all vertices back, and waits for the one that another thread holds, but not for long.
    fn back_off(&mut self);
}

/// Who holds what.
pub(crate) struct Owners {
    /// For each site the thread that holds it, counted from 1; or 0.
    sites: Vec<AtomicU8>,
    /// For each thread whether another waits for one of its vertices.
    wanted: Vec<Flag>,
}

/// In a cache line of its own.
#[repr(align(128))]
#[derive(Default)]
struct Flag(AtomicBool);

impl Owners {
    /// Most threads at once.
    pub(crate) const THREADS_MAX: usize = u8::MAX as usize;

    /// Nobody holds any of these sites.
    pub(crate) fn new(sites: usize) -> Self {
        let wanted = (0..=Self::THREADS_MAX).map(|_| Flag::default()).collect();
        Owners { sites: zeros(sites), wanted }
    }

    /// Returns how many sites there are.
    pub(crate) fn len(&self) -> usize {
        self.sites.len()
    }

    /// Tests whether nobody holds any.
    #[cfg(test)]
    pub(crate) fn are_free(&self) -> bool {
        self.sites.iter().all(|owner| owner.load(Relaxed) == 0)
    }

    /// Thread number `thread`, counted from 0.
    pub(crate) fn holder(&self, thread: usize) -> Holder<'_> {
        debug_assert!(thread < Self::THREADS_MAX);
        let me = thread as u8 + 1;
        Holder {
            owners: &self.sites,
            wanted: &self.wanted,
            is_wanted: &self.wanted[usize::from(me)].0,
            me,
            held: Vec::new(),
            missing: None,
        }
    }
}

/// One of several threads.
///
/// It keeps its vertices beyond an insertion, as the next one is likely to need them too: an exchange costs as much as a
/// conflict test, and of those that are held for 100 insertions along the curve most serve many.
pub(crate) struct Holder<'a> {
    owners: &'a [AtomicU8],
    wanted: &'a [Flag],
    is_wanted: &'a AtomicBool,
    me: u8,
    held: Vec<u32>,
    /// The vertex that another thread held.
    missing: Option<u32>,
}

/// Vertices that a thread keeps, at most, before it gives all of them back.
const HELD_MAX: usize = if cfg!(any(loom, test)) { 3 } else { 512 };
/// How often a thread looks whether a vertex is free again: about as long as an insertion takes.
const LOOKS_MAX: u32 = if cfg!(loom) { 1 } else { 200 };

impl Holder<'_> {
    /// Gives all vertices back.
    pub(crate) fn release(&mut self) {
        for &vertex in &self.held {
            self.owners[vertex as usize].store(0, Release);
        }
        self.held.clear();
        self.is_wanted.store(false, Relaxed);
    }
}

impl Hold for Holder<'_> {
    const SHARED: bool = true;

    type Slot<const V: usize> = Record<V>;
    type Mark = AtomicU8;

    #[inline(always)]
    fn hold<const V: usize>(&mut self, vertices: [u32; V]) -> bool {
        for vertex in vertices {
            if vertex == GHOST {
                continue;
            }
            #[cfg(all(test, not(loom)))]
            delays::some();
            let owner = &self.owners[vertex as usize];
            if owner.load(Relaxed) == self.me {
                continue;
            }
            // Who has read of a vertex in a record finds it held, or as it was given back: this fence pairs with those that come
            // before the record is written, here and in `hold_new`.
            fence(Acquire);
            if owner.compare_exchange(0, self.me, Acquire, Relaxed).is_err() {
                self.missing = Some(vertex);
                return false;
            }
            fence(Release);
            self.held.push(vertex);
        }
        true
    }

    /// No exchange is needed, as nobody knows of the vertex: that saves 7 ns of 160 on each insertion in the plane.
    #[inline(always)]
    fn hold_new(&mut self, vertex: u32) {
        let owner = &self.owners[vertex as usize];
        debug_assert_eq!(owner.load(Relaxed), 0, "nobody knows of it");
        owner.store(self.me, Relaxed);
        self.held.push(vertex);
        fence(Release);
        #[cfg(all(test, not(loom)))]
        delays::some();
    }

    #[inline(always)]
    fn done(&mut self) {
        #[cfg(all(test, not(loom)))]
        delays::some();
        if self.held.len() > HELD_MAX || self.is_wanted.load(Relaxed) {
            self.release();
        }
    }

    #[cold]
    fn back_off(&mut self) {
        self.release();
        let Some(vertex) = self.missing.take() else { return };
        let owner = &self.owners[vertex as usize];
        for _ in 0..LOOKS_MAX {
            match owner.load(Relaxed) {
                0 => return,
                other => self.wanted[usize::from(other)].0.store(true, Relaxed),
            }
            spin_loop();
        }
    }
}

/// In tests threads are held up at every vertex, so that they meet in all ways.
#[cfg(all(test, not(loom)))]
mod delays {
    use std::cell::Cell;
    use std::sync::atomic::Ordering::Relaxed;
    use std::time::Duration;

    thread_local! {
        static STATE: Cell<u64> = const { Cell::new(0) };
    }

    pub(super) fn some() {
        if crate::threads::round::in_turn::ON.load(Relaxed) {
            return;
        }
        let mut state = STATE.get();
        if state == 0 {
            // Each thread has a stack of its own.
            state = (&raw const state).addr() as u64;
        }
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        STATE.set(state);
        match state >> 54 {
            0 => std::thread::sleep(Duration::from_micros(20)),
            1..32 => std::thread::yield_now(),
            _ => {}
        }
    }
}
