//! The calling thread and others, at the same work.
//!
//! *Problem.* Loops share out work that takes a millisecond. A sleeping thread takes a twentieth of that to wake, and as long again passes
//! until a thread that waits for it is told; and a thread that is woken on a busy processor begins when that is free, though another is idle.
//! *Idea.* The calling thread takes part. Within a pool of rayon the others are threads of that. Outside of any they are helpers: one fewer
//! than the global pool has threads, so that there are no more threads than processors. Work is offered to them; what none of them has begun
//! when the calling thread is ready is withdrawn. At the end it looks for a moment whether the others are done before it sleeps.
//! *Guarantee.* No thread waits for work that has not begun: so loops within loops neither lock up nor wait for long tasks of others.
//! *Measured* on two processors with 10⁵ × 10 normal points (example `ellipsoids` of taut-enclose): with the global pool beside the calling
//! thread, the second thread began 1 to 2 ms late, often when all was done, in a third of the passes of 1 ms; with one helper within
//! 0.13 ms in all of them.
#![allow(unsafe_code)]

use std::any::Any;
use std::collections::VecDeque;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::AtomicUsize;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use rayon::Scope;

/// What another thread needs to end a block, and less than twice what it takes to sleep and be woken.
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
    let offer = Arc::new(Offer {
        worker: worker_of_offer,
        state: Mutex::new(State { is_open: true, panic: None }),
        running: AtomicUsize::new(0),
        all_ended: Condvar::new(),
    });
    HELPERS.offer(&offer, others);
    let own = catch_unwind(AssertUnwindSafe(worker));
    HELPERS.withdraw(&offer);
    let theirs = offer.close();
    if let Some(panic) = own.err().or(theirs) {
        resume_unwind(panic);
    }
}

/// Work that helpers may take up while it is open.
struct Offer {
    /// Lives until [`close`](Offer::close) has returned, which [`share_with_helpers`] calls before it ends, be it by a panic. It is used by
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
        if let Err(panic) = result {
            state.panic.get_or_insert(panic);
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
    /// Each as often as helpers are wanted for it.
    offers: VecDeque<Arc<Offer>>,
    /// Helpers that have been started.
    started: usize,
    /// Those of them that sleep.
    asleep: usize,
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
        queue.offers.extend(std::iter::repeat_n(Arc::clone(offer), others));
        self.wake(&queue);
    }

    /// Wakes up to two that sleep: each wakes two more, so that no thread has to wake many.
    fn wake(&self, queue: &Queue) {
        for _ in 0..queue.asleep.min(queue.offers.len()).min(2) {
            self.offered.notify_one();
        }
    }

    fn withdraw(&self, offer: &Arc<Offer>) {
        lock(&self.queue).offers.retain(|other| !Arc::ptr_eq(offer, other));
    }

    /// What a helper does.
    fn help(&self) {
        let mut queue = lock(&self.queue);
        loop {
            while let Some(offer) = queue.offers.pop_front() {
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

/// A panic in a worker is caught, so that no lock is left with a state half changed.
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

    /// Numbers are given out to `most` workers, each of which gives out numbers in turn; returns how many were given out.
    fn counted(most: usize) -> usize {
        let (next, inner) = (AtomicUsize::new(0), AtomicUsize::new(0));
        share(most, &|| {
            while next.fetch_add(1, Relaxed) < 100 {
                let next = AtomicUsize::new(0);
                share(most, &|| {
                    while next.fetch_add(1, Relaxed) < 10 {
                        inner.fetch_add(1, Relaxed);
                    }
                });
            }
        });
        inner.into_inner()
    }

    #[test]
    fn work_within_work_is_done_when_it_returns() {
        for most in [0, 1, 2, 3, 100] {
            assert_eq!(counted(most), 1000, "outside of a pool, {most}");
            for threads in [1, 2, 4] {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                assert_eq!(pool.install(|| counted(most)), 1000, "{threads} threads, {most}");
            }
        }
    }

    /// Two threads of the pool, and from outside the calling thread and a helper, if there is a second thread at all.
    #[test]
    fn workers_run_at_the_same_time() {
        let meet = || {
            let here = AtomicUsize::new(0);
            share(2, &|| {
                here.fetch_add(1, Relaxed);
                let start = Instant::now();
                while here.load(Relaxed) < 2 && start.elapsed() < Duration::from_secs(60) {
                    std::thread::yield_now();
                }
            });
            here.into_inner()
        };
        if rayon::current_num_threads() > 1 {
            assert_eq!(meet(), 2);
        }
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
        assert_eq!(pool.install(meet), 2);
    }

    /// Inner loops would else wait until the helper has ended a long task of the outer.
    #[test]
    fn nobody_waits_for_work_that_has_not_begun() {
        let (caller, is_released) = (std::thread::current().id(), AtomicUsize::new(0));
        let inner = AtomicUsize::new(0);
        let start = Instant::now();
        share(2, &|| {
            if std::thread::current().id() == caller {
                for _ in 0..100 {
                    share(2, &|| {
                        inner.fetch_add(1, Relaxed);
                    });
                }
                is_released.store(1, Relaxed);
            } else {
                while is_released.load(Relaxed) == 0 && start.elapsed() < Duration::from_secs(60) {
                    std::thread::yield_now();
                }
            }
        });
        assert!(inner.into_inner() >= 100);
        assert!(start.elapsed() < Duration::from_secs(60));
    }

    #[test]
    fn a_panic_is_passed_on_after_the_other_workers_have_ended() {
        let ended = AtomicUsize::new(0);
        let calls = AtomicUsize::new(0);
        let shared = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
            share(2, &|| {
                if calls.fetch_add(1, Relaxed) == 0 {
                    panic!("the first call fails");
                }
                ended.fetch_add(1, Relaxed);
            });
        }));
        assert!(shared.is_err());
        assert!(ended.into_inner() <= 1);
        // The helpers are still there.
        assert_eq!(counted(2), 1000);
    }
}
