//! The same work for many items on all threads of the current pool, with the results in their order.
//!
//! *Problem.* The adapters of rayon are compiled for each closure: a parallel `map` takes six kilobytes beside its closure, and there are a
//! hundred of them in the module of Python.
//! *Idea.* One loop over numbered tasks is compiled once, for any closure behind a reference. A task is a range of items; only the loop
//! over its items is compiled for each closure. The methods have the names of rayon's. Other than there, `map_init` makes its value for
//! each task, and a failing loop still finishes the items before the failure.
//! *Guarantee.* Results are in the order of the items, and an error is that of the first item that fails, whatever the number of threads.
//! A panic in a task is passed on to the caller of the loop when no task runs any more.
//! *Not for* collecting many millions of items, which are copied once more and need twice their memory meanwhile; nor for many tiny items
//! that are handed over, each of which takes a lock: rayon itself is for these.

use std::ops::Range;
use std::sync::atomic::AtomicUsize;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::helpers::share;

mod adapters;
mod collect;
mod items;
#[cfg(test)]
mod tests;

pub use adapters::{Enumerated, Filtered, Flattened, Mapped, MappedWith, Zipped};
pub use collect::Collect;
pub use items::{Borrowed, Chunks, IntoParallel, Numbers, Owned, ParallelSlice};

/// Most tasks of a loop that names no least number of items: eight for each of 128 threads.
const TASKS_MAX: usize = 1 << 10;

/// Calls `task` with each number below `count`, on all threads.
fn run_tasks(count: usize, task: &(dyn Fn(usize) + Sync)) {
    match count {
        0 => {}
        1 => task(0),
        _ => {
            let next = AtomicUsize::new(0);
            let worker = || {
                loop {
                    let number = next.fetch_add(1, Relaxed);
                    if number >= count {
                        return;
                    }
                    task(number);
                }
            };
            share(count, &worker);
        }
    }
}

/// As [`run_tasks`], for tasks that can fail and say whether they did not: what comes after a failure need not be done, what comes before
/// it is.
fn try_run_tasks(count: usize, task: &(dyn Fn(usize) -> bool + Sync)) {
    let failed = AtomicUsize::new(usize::MAX);
    run_tasks(count, &|number| {
        if number < failed.load(Relaxed) && !task(number) {
            failed.fetch_min(number, Relaxed);
        }
    });
}

/// Does both at the same time where a thread is free, and returns what they return.
pub fn join<A: Send, B: Send>(
    a: impl FnOnce() -> A + Send,
    b: impl FnOnce() -> B + Send,
) -> (A, B) {
    let (mut a, mut b) = (Some(a), Some(b));
    let (mut of_a, mut of_b) = (None, None);
    both(&mut || of_a = a.take().map(|a| a()), &mut || of_b = b.take().map(|b| b()));
    of_a.zip(of_b).expect("both are done")
}

/// As [`join`], compiled once.
fn both(a: &mut (dyn FnMut() + Send), b: &mut (dyn FnMut() + Send)) {
    rayon::join(a, b);
}

/// Numbered items, of which threads ask for ranges.
pub trait Source: Sync {
    /// An item.
    type Item;

    /// Returns how many items there are, or at most, where some are left out.
    fn count(&self) -> usize;

    /// Returns the items of a range. Each item is asked for once.
    fn items(&self, range: Range<usize>) -> impl Iterator<Item = Self::Item>;
}

/// Sources that leave no item out, so that a number names one item.
pub trait Indexed: Source {}

/// Items to be worked on by all threads.
#[must_use]
pub struct Parallel<S> {
    source: S,
    /// Least number of items of a task.
    least: usize,
}

impl<S: Source> Parallel<S> {
    fn new(source: S) -> Self {
        Parallel { source, least: 1 }
    }

    fn with<Other>(self, source: impl FnOnce(S) -> Other) -> Parallel<Other> {
        Parallel { source: source(self.source), least: self.least }
    }

    /// A task has at least so many items. Without it there are about a thousand tasks.
    pub fn with_min_len(self, least: usize) -> Self {
        Parallel { least: self.least.max(least), ..self }
    }

    /// The items with their numbers.
    pub fn enumerate(self) -> Parallel<Enumerated<S>>
    where
        S: Indexed,
    {
        self.with(Enumerated)
    }

    /// Pairs of these items and others, as many as there are of both.
    pub fn zip<Other: Indexed>(self, other: Parallel<Other>) -> Parallel<Zipped<S, Other>>
    where
        S: Indexed,
    {
        self.with_min_len(other.least).with(|source| Zipped(source, other.source))
    }

    /// `f` of each item.
    pub fn map<T, F: Fn(S::Item) -> T + Sync>(self, f: F) -> Parallel<Mapped<S, F>> {
        self.with(|source| Mapped(source, f))
    }

    /// `f` of each item, with something that `init` makes for each task.
    pub fn map_init<M, T, I: Fn() -> M + Sync, F: Fn(&mut M, S::Item) -> T + Sync>(
        self,
        init: I,
        f: F,
    ) -> Parallel<MappedWith<S, I, F>> {
        self.with(|source| MappedWith(source, init, f))
    }

    /// Those items for which `f` is true.
    pub fn filter<F: Fn(&S::Item) -> bool + Sync>(self, f: F) -> Parallel<Filtered<S, F>> {
        self.with(|source| Filtered(source, f))
    }

    /// The items of all lists that `f` returns, in order.
    pub fn flat_map_iter<T: IntoIterator, F: Fn(S::Item) -> T + Sync>(
        self,
        f: F,
    ) -> Parallel<Flattened<S, F>> {
        self.with(|source| Flattened(source, f))
    }

    /// What `f` returns for each item for which that is something.
    pub fn filter_map<T, F: Fn(S::Item) -> Option<T> + Sync>(
        self,
        f: F,
    ) -> Parallel<Flattened<S, F>> {
        self.flat_map_iter(f)
    }

    /// The items of each task.
    fn tasks(&self) -> Tasks {
        let count = self.source.count();
        Tasks { count, size: self.least.max(count.div_ceil(TASKS_MAX)) }
    }

    /// Calls `f` with each item.
    pub fn for_each(self, f: impl Fn(S::Item) + Sync) {
        let tasks = self.tasks();
        run_tasks(tasks.len(), &|task| self.source.items(tasks.of(task)).for_each(&f));
    }

    /// Calls `f` with each item, and something that `init` makes for each task.
    pub fn for_each_init<M>(self, init: impl Fn() -> M + Sync, f: impl Fn(&mut M, S::Item) + Sync) {
        self.map_init(init, f).for_each(|()| ());
    }

    /// Calls `f` with each item, until one fails.
    ///
    /// # Errors
    /// That of the first item that has one.
    pub fn try_for_each<E: Send>(
        self,
        f: impl Fn(S::Item) -> Result<(), E> + Sync,
    ) -> Result<(), E> {
        let tasks = self.tasks();
        let failed: Mutex<Option<(usize, E)>> = Mutex::new(None);
        try_run_tasks(tasks.len(), &|task| {
            let Err(error) = self.source.items(tasks.of(task)).try_for_each(&f) else {
                return true;
            };
            let mut failed = lock(&failed);
            if failed.as_ref().is_none_or(|(first, _)| task < *first) {
                *failed = Some((task, error));
            }
            false
        });
        let failed = failed.into_inner().unwrap_or_else(PoisonError::into_inner);
        failed.map_or(Ok(()), |(_, error)| Err(error))
    }

    /// Tests whether `f` is true for all items.
    pub fn all(self, f: impl Fn(S::Item) -> bool + Sync) -> bool {
        self.try_for_each(|item| f(item).then_some(()).ok_or(())).is_ok()
    }

    /// All items in order: `Vec<T>`, or `Result<Vec<T>, E>` with the first error.
    pub fn collect<C: Collect<S::Item>>(self) -> C {
        C::of(self)
    }

    /// All items in order, put together by `f`, which must not depend on how they are put in parentheses.
    pub fn reduce(
        self,
        first: impl Fn() -> S::Item + Sync,
        f: impl Fn(S::Item, S::Item) -> S::Item + Sync,
    ) -> S::Item
    where
        S::Item: Send,
    {
        let tasks = self.tasks();
        let of = |task| self.source.items(tasks.of(task)).fold(first(), &f);
        let of_tasks: Vec<S::Item> = (0..tasks.len()).into_par_iter().map(of).collect();
        of_tasks.into_iter().fold(first(), &f)
    }
}

/// Runs of items.
struct Tasks {
    count: usize,
    size: usize,
}

impl Tasks {
    fn len(&self) -> usize {
        self.count.div_ceil(self.size)
    }

    fn of(&self, task: usize) -> Range<usize> {
        self.count.min(task * self.size)..self.count.min((task + 1) * self.size)
    }
}

fn lock<T>(place: &Mutex<T>) -> MutexGuard<'_, T> {
    place.lock().unwrap_or_else(PoisonError::into_inner)
}
