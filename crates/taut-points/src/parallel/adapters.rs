//! What parallel loops make of items on their way.

use std::ops::Range;

use super::{Indexed, Source};

/// Items with their numbers.
pub struct Enumerated<S>(pub(super) S);

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
pub struct Zipped<A, B>(pub(super) A, pub(super) B);

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
pub struct Mapped<S, F>(pub(super) S, pub(super) F);

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
pub struct MappedWith<S, I, F>(pub(super) S, pub(super) I, pub(super) F);

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
pub struct Filtered<S, F>(pub(super) S, pub(super) F);

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
pub struct Flattened<S, F>(pub(super) S, pub(super) F);

impl<S: Source, T: IntoIterator, F: Fn(S::Item) -> T + Sync> Source for Flattened<S, F> {
    type Item = T::Item;

    fn count(&self) -> usize {
        self.0.count()
    }

    fn items(&self, range: Range<usize>) -> impl Iterator<Item = T::Item> {
        self.0.items(range).flat_map(&self.1)
    }
}
