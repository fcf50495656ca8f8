//! The items that parallel loops begin with: numbers, slices, and lists that are handed over.

use std::cmp::Ordering;
use std::ops::Range;
use std::sync::Mutex;

use super::{Indexed, Parallel, Source, lock};

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
