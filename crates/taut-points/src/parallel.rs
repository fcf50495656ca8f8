//! The same work for many items on all threads of the current pool, with the results in their order.
//!
//! *Problem.* The adapters of rayon are compiled for each closure: a parallel `map` takes six kilobytes beside its closure, and there are a
//! hundred of them in the module of Python.
//! *Idea.* One loop over numbered tasks is compiled once, for any closure behind a reference. A task is a range of items; only the loop
//! over its items is compiled for each closure. The methods have the names of rayon's. Other than there, `map_init` makes its value for
//! each task, and a failing loop still finishes the items before the failure.
//! *Guarantee.* Results are in the order of the items, and an error is that of the first item that fails, whatever the number of threads.
//! *Not for* collecting many millions of items, which are copied once more and need twice their memory meanwhile; nor for many tiny items
//! that are handed over, each of which takes a lock: rayon itself is for these.

use std::cmp::Ordering;
use std::ops::Range;
use std::sync::atomic::AtomicUsize;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Most tasks of a loop that names no least number of items: eight for each of 128 threads.
const TASKS_MAX: usize = 1 << 10;

/// Calls `task` with each number below `count`, on all threads.
fn run_tasks(count: usize, task: &(dyn Fn(usize) + Sync)) {
    match count {
        0 => {}
        1 => task(0),
        _ => {
            use rayon::iter::{IntoParallelIterator, ParallelIterator};
            IntoParallelIterator::into_par_iter(0..count).for_each(task);
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

/// Collections of items.
pub trait Collect<Item>: Sized {
    /// All items of a source.
    fn of<S: Source<Item = Item>>(items: Parallel<S>) -> Self;
}

impl<T: Send> Collect<T> for Vec<T> {
    fn of<S: Source<Item = T>>(items: Parallel<S>) -> Self {
        let tasks = items.tasks();
        let of = |task| items.source.items(tasks.of(task)).collect();
        if tasks.len() <= 1 {
            return of(0);
        }
        let parts: Vec<Mutex<Self>> = (0..tasks.len()).map(|_| Mutex::default()).collect();
        run_tasks(parts.len(), &|task| *lock(&parts[task]) = of(task));
        let parts = parts.into_iter();
        let parts: Vec<Self> =
            parts.map(|part| part.into_inner().unwrap_or_else(PoisonError::into_inner)).collect();
        joined(parts)
    }
}

impl<T: Send, E: Send> Collect<Result<T, E>> for Result<Vec<T>, E> {
    fn of<S: Source<Item = Result<T, E>>>(items: Parallel<S>) -> Self {
        let tasks = items.tasks();
        let of = |task| items.source.items(tasks.of(task)).collect();
        if tasks.len() <= 1 {
            return of(0);
        }
        let parts: Vec<Mutex<Self>> = (0..tasks.len()).map(|_| Mutex::new(Ok(vec![]))).collect();
        try_run_tasks(parts.len(), &|task| {
            let part: Self = of(task);
            let is_done = part.is_ok();
            *lock(&parts[task]) = part;
            is_done
        });
        let parts = parts.into_iter();
        let parts: Result<Vec<Vec<T>>, E> =
            parts.map(|part| part.into_inner().unwrap_or_else(PoisonError::into_inner)).collect();
        parts.map(joined)
    }
}

/// The items of all parts; the memory of each is given back when its items have moved.
fn joined<T>(parts: Vec<Vec<T>>) -> Vec<T> {
    let mut all = Vec::with_capacity(parts.iter().map(Vec::len).sum());
    for mut part in parts {
        all.append(&mut part);
    }
    all
}

/// Items with their numbers.
pub struct Enumerated<S>(S);

impl<S: Source> Source for Enumerated<S> {
    type Item = (usize, S::Item);

    fn count(&self) -> usize {
        self.0.count()
    }

    fn items(&self, range: Range<usize>) -> impl Iterator<Item = Self::Item> {
        range.clone().zip(self.0.items(range))
    }
}

impl<S: Indexed> Indexed for Enumerated<S> {}

/// Pairs of items.
pub struct Zipped<A, B>(A, B);

impl<A: Source, B: Source> Source for Zipped<A, B> {
    type Item = (A::Item, B::Item);

    fn count(&self) -> usize {
        self.0.count().min(self.1.count())
    }

    fn items(&self, range: Range<usize>) -> impl Iterator<Item = Self::Item> {
        self.0.items(range.clone()).zip(self.1.items(range))
    }
}

impl<A: Indexed, B: Indexed> Indexed for Zipped<A, B> {}

/// Results of a function of each item.
pub struct Mapped<S, F>(S, F);

impl<S: Source, T, F: Fn(S::Item) -> T + Sync> Source for Mapped<S, F> {
    type Item = T;

    fn count(&self) -> usize {
        self.0.count()
    }

    fn items(&self, range: Range<usize>) -> impl Iterator<Item = T> {
        self.0.items(range).map(&self.1)
    }
}

impl<S: Indexed, T, F: Fn(S::Item) -> T + Sync> Indexed for Mapped<S, F> {}

/// Results of a function of an item and a value that each task has for itself.
pub struct MappedWith<S, I, F>(S, I, F);

impl<S: Source, M, T, I: Fn() -> M + Sync, F: Fn(&mut M, S::Item) -> T + Sync> Source
    for MappedWith<S, I, F>
{
    type Item = T;

    fn count(&self) -> usize {
        self.0.count()
    }

    fn items(&self, range: Range<usize>) -> impl Iterator<Item = T> {
        let mut own = self.1();
        self.0.items(range).map(move |item| self.2(&mut own, item))
    }
}

impl<S: Indexed, M, T, I: Fn() -> M + Sync, F: Fn(&mut M, S::Item) -> T + Sync> Indexed
    for MappedWith<S, I, F>
{
}

/// Some of the items.
pub struct Filtered<S, F>(S, F);

impl<S: Source, F: Fn(&S::Item) -> bool + Sync> Source for Filtered<S, F> {
    type Item = S::Item;

    fn count(&self) -> usize {
        self.0.count()
    }

    fn items(&self, range: Range<usize>) -> impl Iterator<Item = S::Item> {
        self.0.items(range).filter(&self.1)
    }
}

/// Items of a list for each item.
pub struct Flattened<S, F>(S, F);

impl<S: Source, T: IntoIterator, F: Fn(S::Item) -> T + Sync> Source for Flattened<S, F> {
    type Item = T::Item;

    fn count(&self) -> usize {
        self.0.count()
    }

    fn items(&self, range: Range<usize>) -> impl Iterator<Item = T::Item> {
        self.0.items(range).flat_map(&self.1)
    }
}

/// Numbers.
pub struct Numbers<T>(Range<T>);

macro_rules! number_the_items_of {
    ($($number:ty)*) => {$(
        impl Source for Numbers<$number> {
            type Item = $number;

            fn count(&self) -> usize {
                usize::try_from(self.0.end.saturating_sub(self.0.start)).expect("a loop over numbers that memory could hold")
            }

            fn items(&self, range: Range<usize>) -> impl Iterator<Item = $number> {
                self.0.start + range.start as $number..self.0.start + range.end as $number
            }
        }

        impl Indexed for Numbers<$number> {}

        impl IntoParallel for Range<$number> {
            type Source = Numbers<$number>;

            fn into_par_iter(self) -> Parallel<Numbers<$number>> {
                Parallel::new(Numbers(self))
            }
        }
    )*};
}

number_the_items_of! { u32 u64 usize }

/// References to the items of a slice.
pub struct Borrowed<'a, T>(&'a [T]);

impl<'a, T: Sync> Source for Borrowed<'a, T> {
    type Item = &'a T;

    fn count(&self) -> usize {
        self.0.len()
    }

    fn items(&self, range: Range<usize>) -> impl Iterator<Item = &'a T> {
        self.0[range].iter()
    }
}

impl<T: Sync> Indexed for Borrowed<'_, T> {}

/// Parts of a slice.
pub struct Chunks<'a, T> {
    items: &'a [T],
    size: usize,
}

impl<'a, T: Sync> Source for Chunks<'a, T> {
    type Item = &'a [T];

    fn count(&self) -> usize {
        self.items.len().div_ceil(self.size)
    }

    fn items(&self, range: Range<usize>) -> impl Iterator<Item = &'a [T]> {
        let end = self.items.len().min(range.end * self.size);
        self.items[end.min(range.start * self.size)..end].chunks(self.size)
    }
}

impl<T: Sync> Indexed for Chunks<'_, T> {}

/// Items that are handed over.
pub struct Owned<T>(Vec<Mutex<Option<T>>>);

impl<T: Send> Owned<T> {
    fn new(items: impl Iterator<Item = T>) -> Self {
        Owned(items.map(|item| Mutex::new(Some(item))).collect())
    }
}

impl<T: Send> Source for Owned<T> {
    type Item = T;

    fn count(&self) -> usize {
        self.0.len()
    }

    fn items(&self, range: Range<usize>) -> impl Iterator<Item = T> {
        self.0[range].iter().map(|item| lock(item).take().expect("an item is asked for once"))
    }
}

impl<T: Send> Indexed for Owned<T> {}

/// Collections whose items are handed over to all threads.
pub trait IntoParallel {
    /// Its items.
    type Source: Source;

    /// The items, in order.
    fn into_par_iter(self) -> Parallel<Self::Source>;
}

impl<T: Send> IntoParallel for Vec<T> {
    type Source = Owned<T>;

    fn into_par_iter(self) -> Parallel<Owned<T>> {
        Parallel::new(Owned::new(self.into_iter()))
    }
}

/// Slices whose items or parts all threads work on.
pub trait ParallelSlice<T> {
    /// References to the items.
    fn par_iter(&self) -> Parallel<Borrowed<'_, T>>
    where
        T: Sync;

    /// References to the items, to change them. Each item takes a lock and 24 bytes while the loop runs.
    fn par_iter_mut(&mut self) -> Parallel<Owned<&mut T>>
    where
        T: Send;

    /// Parts of `size` items; the last one may have fewer.
    ///
    /// # Panics
    /// If `size` is 0.
    fn par_chunks(&self, size: usize) -> Parallel<Chunks<'_, T>>
    where
        T: Sync;

    /// Parts of `size` items, to change them; the last one may have fewer. Each part takes a lock and 24 bytes while the loop runs.
    ///
    /// # Panics
    /// If `size` is 0.
    fn par_chunks_mut(&mut self, size: usize) -> Parallel<Owned<&mut [T]>>
    where
        T: Send;

    /// Sorts by the order of the items; equal ones are the same.
    fn par_sort_unstable(&mut self)
    where
        T: Ord + Send;

    /// Sorts by a key; the order of items with equal keys is not defined.
    fn par_sort_unstable_by_key<K: Ord>(&mut self, key: impl Fn(&T) -> K + Sync)
    where
        T: Send;

    /// Sorts; the order of equal items is not defined.
    fn par_sort_unstable_by(&mut self, compare: impl Fn(&T, &T) -> Ordering + Sync)
    where
        T: Send;
}

impl<T> ParallelSlice<T> for [T] {
    fn par_iter(&self) -> Parallel<Borrowed<'_, T>>
    where
        T: Sync,
    {
        Parallel::new(Borrowed(self))
    }

    fn par_iter_mut(&mut self) -> Parallel<Owned<&mut T>>
    where
        T: Send,
    {
        Parallel::new(Owned::new(self.iter_mut()))
    }

    fn par_chunks(&self, size: usize) -> Parallel<Chunks<'_, T>>
    where
        T: Sync,
    {
        assert!(size > 0, "a part has items");
        Parallel::new(Chunks { items: self, size })
    }

    fn par_chunks_mut(&mut self, size: usize) -> Parallel<Owned<&mut [T]>>
    where
        T: Send,
    {
        Parallel::new(Owned::new(self.chunks_mut(size)))
    }

    fn par_sort_unstable(&mut self)
    where
        T: Ord + Send,
    {
        rayon::slice::ParallelSliceMut::par_sort_unstable(self);
    }

    fn par_sort_unstable_by_key<K: Ord>(&mut self, key: impl Fn(&T) -> K + Sync)
    where
        T: Send,
    {
        rayon::slice::ParallelSliceMut::par_sort_unstable_by_key(self, key);
    }

    fn par_sort_unstable_by(&mut self, compare: impl Fn(&T, &T) -> Ordering + Sync)
    where
        T: Send,
    {
        rayon::slice::ParallelSliceMut::par_sort_unstable_by(self, compare);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::thread_pool;

    fn on_pools(test: impl Fn() + Sync) {
        for threads in [1, 2, 7] {
            thread_pool(threads).unwrap().install(&test);
        }
    }

    #[test]
    fn results_are_in_the_order_of_the_items() {
        on_pools(|| {
            for count in [0, 1, 2, 63, 64, 65, 1024, 1025, 5000] {
                for least in [1, 7, 64, 10_000] {
                    let wanted: Vec<usize> = (0..count).map(|i| 3 * i + 1).collect();
                    let found: Vec<usize> =
                        (0..count).into_par_iter().with_min_len(least).map(|i| 3 * i + 1).collect();
                    assert_eq!(found, wanted);
                    let found: Vec<usize> =
                        wanted.par_iter().with_min_len(least).map(|i| *i).collect();
                    assert_eq!(found, wanted);
                    let found: Vec<usize> = wanted.clone().into_par_iter().map(|i| i).collect();
                    assert_eq!(found, wanted);
                    let parts: Vec<(usize, Vec<usize>)> =
                        wanted.par_chunks(least).map(<[usize]>::to_vec).enumerate().collect();
                    assert_eq!(
                        parts,
                        wanted.chunks(least).map(<[usize]>::to_vec).enumerate().collect::<Vec<_>>()
                    );
                    let mut written = vec![0; count];
                    let others = wanted.par_chunks(least);
                    written.par_chunks_mut(least).zip(others).enumerate().for_each(
                        |(part, (to, from))| {
                            assert_eq!(from[0], 3 * part * least + 1);
                            to.copy_from_slice(from);
                        },
                    );
                    assert_eq!(written, wanted);
                    written.par_iter_mut().with_min_len(least).for_each(|number| *number += 1);
                    assert!(written.iter().zip(&wanted).all(|(a, b)| *a == b + 1));
                }
            }
        });
    }

    #[test]
    fn the_first_error_is_returned_whoever_fails_first() {
        let fails = |i: usize| match i % 100 == 40 {
            true => Err(i),
            false => Ok(i),
        };
        on_pools(|| {
            for _ in 0..50 {
                for least in [1, 3, 100, 2000] {
                    let items = || (0..1000usize).into_par_iter().with_min_len(least);
                    assert_eq!(items().map(fails).collect::<Result<Vec<_>, _>>(), Err(40));
                    assert_eq!(items().try_for_each(|i| fails(i).map(drop)), Err(40));
                    assert_eq!(items().try_for_each(|_| Ok::<_, ()>(())), Ok(()));
                    let all = items().map(Ok::<usize, ()>).collect::<Result<Vec<_>, _>>();
                    assert!(all.is_ok_and(|all| all.iter().copied().eq(0..1000)));
                }
            }
        });
    }

    #[test]
    fn items_are_left_out_made_more_and_put_together() {
        on_pools(|| {
            for count in [0, 1, 100, 3000u32] {
                let items = || (0..count).into_par_iter();
                let odd: Vec<u32> = items().filter(|i| i % 2 == 1).collect();
                assert_eq!(odd, (0..count).filter(|i| i % 2 == 1).collect::<Vec<_>>());
                let thirds: Vec<u32> =
                    items().filter_map(|i| (i % 3 == 0).then_some(i / 3)).collect();
                assert_eq!(thirds, (0..count.div_ceil(3)).collect::<Vec<_>>());
                let twice: Vec<u32> = items().flat_map_iter(|i| [i, i]).collect();
                assert_eq!(twice, (0..count).flat_map(|i| [i, i]).collect::<Vec<_>>());
                let kept: Vec<u32> =
                    items().map_init(|| 7, |kept, i| std::mem::replace(kept, 7) * i).collect();
                assert_eq!(kept, (0..count).map(|i| 7 * i).collect::<Vec<_>>());
                assert_eq!(items().reduce(|| 0, |a, b| a + b), (0..count).sum::<u32>());
                assert!(items().all(|i| i < count));
                assert_eq!(items().all(|i| i < 99), count <= 99);
            }
            let ends: Vec<u32> = (u32::MAX - 3..u32::MAX).into_par_iter().collect();
            assert_eq!(ends, [u32::MAX - 3, u32::MAX - 2, u32::MAX - 1]);
            #[allow(clippy::reversed_empty_ranges)]
            let none: Vec<u64> = (5..2u64).into_par_iter().collect();
            assert!(none.is_empty());
            let pairs: Vec<(&u8, usize)> =
                [1, 2, 3].par_iter().zip((0..2usize).into_par_iter()).collect();
            assert_eq!(pairs, [(&1, 0), (&2, 1)]);
        });
    }

    #[test]
    fn a_panic_of_a_task_is_one_of_the_loop() {
        on_pools(|| {
            let outcome = std::panic::catch_unwind(|| {
                (0..100usize).into_par_iter().for_each(|i| assert!(i != 50, "fifty"));
            });
            assert!(outcome.is_err());
        });
    }

    #[test]
    fn two_works_return_what_each_returns() {
        on_pools(|| assert_eq!(join(|| 1, || "two"), (1, "two")));
    }
}
