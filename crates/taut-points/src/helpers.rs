//! The calling thread and others, at the same work.
//!
//! *Problem.* Loops share out work that takes a millisecond. A sleeping thread takes a twentieth of that to wake, and as long again passes
//! until a thread that waits for it is told; and a thread that is woken on a busy processor begins when that is free, though another is idle.
//! *Idea.* The calling thread takes part. Within a pool of rayon the others are threads of that. Outside of any they are helpers: one fewer
//! than the global pool has threads, so that one caller keeps no more threads busy than there are in that pool. Work is offered to them;
//! what none of them has begun when the calling thread is ready is withdrawn. At the end it looks for a moment whether the others are done
//! before it sleeps.
//! *Guarantee.* Outside of a pool no thread waits for work that has not begun: so loops within loops neither lock up nor wait for long
//! tasks of others. Within a pool a waiting thread may take up another task of the pool, as everywhere in rayon.
//! *Cost.* The threads of the global pool, which sleep, and as many helpers but one. Helpers have the stack and the processors that a thread
//! of the standard library gets from the one that starts it; a program that has set up a pool of its own calls from within that pool.
//! *Measured* on two processors with 10⁵ × 10 normal points (example `ellipsoids` of taut-enclose), passes of 1 ms: with the global pool
//! beside the calling thread, the second thread often began 1 to 2 ms late, when all was done; with a pool of one thread beside it within
//! 0.13 ms in each of the 36 passes looked at.
#![allow(unsafe_code)]

use std::any::Any;
use std::collections::VecDeque;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::AtomicUsize;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use rayon::Scope;

/// What another thread needs to end a block, and what it takes to sleep and to be woken.
const WATCH: Duration = Duration::from_micros(100);

/// Calls `worker` on the calling thread and, at the same time, on as many others as are free, at most `most` calls in all.
///
/// A call may begin when others have ended. A panic in one is passed on when no other runs any more.
pub(crate) fn share(most: usize, worker: &(dyn Fn() + Sync)) {
    let others = most.min(rayon::current_num_threads()).saturating_sub(1);
    if others == 0 {
        worker();
    } else if rayon::current_thread_index().is_some() {
        share_in_pool(others, worker);
    } else {
        share_with_helpers(others, worker);
    }
}

/// Shares with so many threads of the pool of the calling thread, which makes itself the calls that no other has begun.
fn share_in_pool(others: usize, worker: &(dyn Fn() + Sync)) {
    let (begun, ended) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let other = || {
        begun.fetch_add(1, Relaxed);
        worker();
        ended.fetch_add(1, Relaxed);
    };
    fn offer<'s>(scope: &Scope<'s>, others: usize, other: &'s (dyn Fn() + Sync)) {
        (0..others).for_each(|_| scope.spawn(|_| other()));
    }
    rayon::in_place_scope(|scope| {
        offer(scope, others, &other);
        worker();
        watch(|| ended.load(Relaxed) == begun.load(Relaxed));
    });
}

/// Shares with so many helpers.
fn share_with_helpers(others: usize, worker: &(dyn Fn() + Sync)) {
    // SAFETY: the lifetime is forgotten. See `Offer` for how long the pointer is used.
    let worker_of_offer: *const (dyn Fn() + Sync + 'static) = unsafe {
        std::mem::transmute::<*const (dyn Fn() + Sync + '_), *const (dyn Fn() + Sync + 'static)>(
            worker,
        )
    };
    let open = OpenOffer(Arc::new(Offer {
        worker: worker_of_offer,
        state: Mutex::new(State { is_open: true, panic: None }),
        running: AtomicUsize::new(0),
        all_ended: Condvar::new(),
    }));
    HELPERS.offer(&open.0, others);
    worker();
    if let Some(panic) = open.close() {
        resume_unwind(panic);
    }
}

/// An offer that is closed when this is dropped, also by a panic of the caller's own call.
struct OpenOffer(Arc<Offer>);

impl OpenOffer {
    /// Withdraws the offer, waits until no call runs, and returns the panic of one.
    fn close(&self) -> Option<Box<dyn Any + Send>> {
        HELPERS.withdraw(&self.0);
        self.0.close()
    }
}

impl Drop for OpenOffer {
    fn drop(&mut self) {
        // Nothing is left to do where it was closed before. The panic of a helper is lost where the caller's own is on its way.
        std::mem::forget(self.close());
    }
}

/// Work that helpers may take up while it is open.
struct Offer {
    /// Lives until [`close`](Offer::close) has returned, which [`OpenOffer`] calls before [`share_with_helpers`] ends, be it by a panic. It is used by
    /// [`take_up`](Offer::take_up) alone, by calls that are counted in `running`: none begins after the offer is closed, and `close`
    /// waits for those that have begun.
    worker: *const (dyn Fn() + Sync),
    state: Mutex<State>,
    /// Calls that have begun and not ended. Changed with the state locked.
    running: AtomicUsize,
    all_ended: Condvar,
}

// SAFETY: what the pointer leads to is `Sync`, so that helpers may call it, and lives as long as they do so.
unsafe impl Send for Offer {}
// SAFETY: as above.
unsafe impl Sync for Offer {}

struct State {
    is_open: bool,
    /// What the first call that panicked said.
    panic: Option<Box<dyn Any + Send>>,
}

impl Offer {
    /// Calls the worker, if the offer is still open.
    fn take_up(&self) {
        let state = lock(&self.state);
        if !state.is_open {
            return;
        }
        self.running.fetch_add(1, Relaxed);
        drop(state);
        // SAFETY: this call is counted in `running`.
        let worker = unsafe { &*self.worker };
        let result = catch_unwind(AssertUnwindSafe(worker));
        let mut state = lock(&self.state);
        match result {
            Err(panic) if state.panic.is_none() => state.panic = Some(panic),
            // To drop what a second call said could panic, too.
            Err(panic) => std::mem::forget(panic),
            Ok(()) => {}
        }
        if self.running.fetch_sub(1, Relaxed) == 1 {
            self.all_ended.notify_one();
        }
    }

    /// Lets nobody begin any more, waits until no call runs, and returns the panic of one.
    fn close(&self) -> Option<Box<dyn Any + Send>> {
        lock(&self.state).is_open = false;
        watch(|| self.running.load(Relaxed) == 0);
        let mut state = lock(&self.state);
        while self.running.load(Relaxed) > 0 {
            state = self.all_ended.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        state.panic.take()
    }
}

/// Threads that take up offers, for as long as the process lives.
struct Helpers {
    queue: Mutex<Queue>,
    offered: Condvar,
}

struct Queue {
    /// Open offers, each with the number of helpers that are still wanted for it.
    offers: VecDeque<(Arc<Offer>, usize)>,
    /// Helpers that have been started.
    started: usize,
    /// Those of them that sleep.
    asleep: usize,
}

impl Queue {
    /// The oldest offer for which a helper is wanted, taken by one.
    fn next(&mut self) -> Option<Arc<Offer>> {
        let (offer, wanted) = self.offers.front_mut()?;
        let offer = Arc::clone(offer);
        *wanted -= 1;
        if *wanted == 0 {
            self.offers.pop_front();
        }
        Some(offer)
    }
}

static HELPERS: Helpers = Helpers {
    queue: Mutex::new(Queue { offers: VecDeque::new(), started: 0, asleep: 0 }),
    offered: Condvar::new(),
};

impl Helpers {
    /// Offers work to so many helpers. Where the system grants fewer threads there are fewer.
    fn offer(&'static self, offer: &Arc<Offer>, others: usize) {
        let mut queue = lock(&self.queue);
        while queue.started < others {
            let helper = std::thread::Builder::new().name(format!("taut {}", queue.started));
            if helper.spawn(|| self.help()).is_err() {
                break;
            }
            queue.started += 1;
        }
        queue.offers.push_back((Arc::clone(offer), others));
        self.wake(&queue);
    }

    /// Wakes up to two that sleep: each wakes two more, so that no thread has to wake many.
    fn wake(&self, queue: &Queue) {
        let wanted = queue.offers.iter().map(|(_, wanted)| wanted).sum::<usize>();
        for _ in 0..queue.asleep.min(wanted).min(2) {
            self.offered.notify_one();
        }
    }

    fn withdraw(&self, offer: &Arc<Offer>) {
        lock(&self.queue).offers.retain(|(other, _)| !Arc::ptr_eq(offer, other));
    }

    /// What a helper does.
    fn help(&self) {
        let mut queue = lock(&self.queue);
        loop {
            while let Some(offer) = queue.next() {
                self.wake(&queue);
                drop(queue);
                offer.take_up();
                queue = lock(&self.queue);
            }
            queue.asleep += 1;
            queue = self.offered.wait(queue).unwrap_or_else(PoisonError::into_inner);
            queue.asleep -= 1;
        }
    }
}

/// Locks, whether or not a thread panicked with the lock: workers run without it, so no state is left half changed.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Returns when it is done, or a moment later.
fn watch(is_done: impl Fn() -> bool) {
    /// Between two looks at the clock, and at whether another thread could use the processor.
    const LOOKS: usize = 64;
    let start = Instant::now();
    while !is_done() && start.elapsed() < WATCH {
        for _ in 0..LOOKS {
            if is_done() {
                return;
            }
            std::hint::spin_loop();
        }
        // The thread that is awaited may be queued behind this one.
        std::thread::yield_now();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Waits until a condition holds, a minute at most; returns whether it does.
    fn holds(condition: impl Fn() -> bool) -> bool {
        let start = Instant::now();
        while !condition() && start.elapsed() < Duration::from_secs(60) {
            std::thread::yield_now();
        }
        condition()
    }

    /// Shares among the caller and so many others, outside of a pool whatever the number of processors, and in a pool.
    fn in_both_ways(others: usize, test: impl Fn(&(dyn Fn(&(dyn Fn() + Sync)) + Sync)) + Sync) {
        test(&|worker| share_with_helpers(others, worker));
        let pool = rayon::ThreadPoolBuilder::new().num_threads(others + 1).build().unwrap();
        pool.install(|| test(&|worker| share_in_pool(others, worker)));
    }

    #[test]
    fn work_within_work_is_done_when_it_returns() {
        for others in [1, 2, 3, 9] {
            in_both_ways(others, |share| {
                let (next, inner) = (AtomicUsize::new(0), AtomicUsize::new(0));
                share(&|| {
                    while next.fetch_add(1, Relaxed) < 100 {
                        let next = AtomicUsize::new(0);
                        share(&|| {
                            while next.fetch_add(1, Relaxed) < 10 {
                                inner.fetch_add(1, Relaxed);
                            }
                        });
                    }
                });
                assert_eq!(inner.into_inner(), 1000, "{others}");
            });
        }
    }

    /// Each call waits until all have begun.
    #[test]
    fn calls_run_at_the_same_time() {
        in_both_ways(2, |share| {
            let here = AtomicUsize::new(0);
            share(&|| {
                here.fetch_add(1, Relaxed);
                assert!(holds(|| here.load(Relaxed) == 3));
            });
        });
    }

    /// Inner loops would otherwise wait until the helper has ended a long task of the outer.
    #[test]
    fn nobody_waits_for_work_that_has_not_begun() {
        let caller = std::thread::current().id();
        let (is_entered, is_released) = (AtomicUsize::new(0), AtomicUsize::new(0));
        share_with_helpers(1, &|| {
            if std::thread::current().id() == caller {
                assert!(holds(|| is_entered.load(Relaxed) == 1));
                // Other helpers may take these up, but not this one.
                (0..100).for_each(|_| share_with_helpers(1, &|| {}));
                is_released.store(1, Relaxed);
            } else {
                is_entered.store(1, Relaxed);
                assert!(holds(|| is_released.load(Relaxed) == 1));
            }
        });
    }

    /// The caller, the other or both panic, once both have begun; the one that does not, or that panics later, ends late.
    #[test]
    fn a_panic_is_passed_on_when_no_call_runs_any_more() {
        for panics in [[true, false], [false, true], [true, true]] {
            in_both_ways(1, |share| {
                let caller = std::thread::current().id();
                let (begun, ended) = (AtomicUsize::new(0), AtomicUsize::new(0));
                let shared = catch_unwind(AssertUnwindSafe(|| {
                    share(&|| {
                        begun.fetch_add(1, Relaxed);
                        assert!(holds(|| begun.load(Relaxed) == 2));
                        let is_caller = std::thread::current().id() == caller;
                        let does_panic = panics[usize::from(!is_caller)];
                        if is_caller != does_panic {
                            std::thread::sleep(Duration::from_millis(20));
                        }
                        ended.fetch_add(1, Relaxed);
                        assert!(!does_panic, "as it is told");
                    });
                }));
                let said = shared.unwrap_err();
                assert_eq!(said.downcast_ref::<&str>(), Some(&"as it is told"), "{panics:?}");
                assert_eq!(ended.into_inner(), 2, "{panics:?}");
            });
        }
        // The helpers are still there.
        let here = AtomicUsize::new(0);
        share_with_helpers(1, &|| {
            here.fetch_add(1, Relaxed);
            assert!(holds(|| here.load(Relaxed) == 2));
        });
    }
}
