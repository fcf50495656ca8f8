//! Sets of items of a core-set of limited size, a bit each.

/// A set of items by number, below [`Self::ITEMS_MAX`]. Sets of fixed size need no memory of their own and no checks of length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ItemSet<const WORDS: usize>([u64; WORDS]);

impl<const WORDS: usize> Default for ItemSet<WORDS> {
    fn default() -> Self {
        ItemSet([0; WORDS])
    }
}

impl<const WORDS: usize> ItemSet<WORDS> {
    /// Most items.
    pub(super) const ITEMS_MAX: usize = 64 * WORDS;

    pub(super) fn of_one(item: u32) -> Self {
        let mut set = ItemSet::default();
        set.insert(item);
        set
    }

    pub(super) fn first(count: usize) -> Self {
        let mut set = ItemSet::default();
        (0..count as u32).for_each(|item| set.insert(item));
        set
    }

    pub(super) fn insert(&mut self, item: u32) {
        self.0[item as usize / 64] |= 1 << (item % 64);
    }

    pub(super) fn contains(&self, item: u32) -> bool {
        self.0[item as usize / 64] >> (item % 64) & 1 == 1
    }

    /// The items from 64 times this number on, a bit each.
    pub(super) fn word(&self, at: usize) -> u64 {
        self.0[at]
    }

    pub(super) fn is_empty(&self) -> bool {
        self.0.iter().all(|&word| word == 0)
    }

    pub(super) fn len(&self) -> u32 {
        self.0.iter().map(|word| word.count_ones()).sum()
    }

    pub(super) fn is_disjoint(&self, other: &Self) -> bool {
        self.0.iter().zip(&other.0).all(|(a, b)| a & b == 0)
    }

    pub(super) fn without(&self, other: &Self) -> Self {
        let mut set = *self;
        set.0.iter_mut().zip(&other.0).for_each(|(a, b)| *a &= !b);
        set
    }

    pub(super) fn intersection(&self, other: &Self) -> Self {
        let mut set = *self;
        set.0.iter_mut().zip(&other.0).for_each(|(a, b)| *a &= b);
        set
    }

    pub(super) fn add_all(&mut self, other: &Self) {
        self.0.iter_mut().zip(&other.0).for_each(|(a, b)| *a |= b);
    }

    /// The items, ascending.
    pub(super) fn items(&self) -> impl Iterator<Item = u32> {
        self.0.iter().enumerate().flat_map(|(at, &word)| {
            let mut rest = word;
            std::iter::from_fn(move || {
                let bit = rest.trailing_zeros();
                (rest != 0).then(|| {
                    rest &= rest - 1;
                    64 * at as u32 + bit
                })
            })
        })
    }
}

impl<const WORDS: usize> Extend<u32> for ItemSet<WORDS> {
    fn extend<I: IntoIterator<Item = u32>>(&mut self, items: I) {
        items.into_iter().for_each(|item| self.insert(item));
    }
}

impl<const WORDS: usize> FromIterator<u32> for ItemSet<WORDS> {
    fn from_iter<I: IntoIterator<Item = u32>>(items: I) -> Self {
        let mut set = ItemSet::default();
        set.extend(items);
        set
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    type Items = ItemSet<16>;

    #[test]
    fn sets_are_as_those_of_the_standard_library() {
        let of = |step: u32| (0..Items::ITEMS_MAX as u32).filter(move |item| item % step == 1);
        let (a, b): (BTreeSet<u32>, BTreeSet<u32>) = (of(3).collect(), of(5).collect());
        let set = |items: &BTreeSet<u32>| items.iter().copied().collect::<Items>();
        let (x, y) = (set(&a), set(&b));
        let common: BTreeSet<u32> = a.intersection(&b).copied().collect();
        assert_eq!(x.intersection(&y), set(&common));
        assert_eq!(x.without(&y), set(&a.difference(&b).copied().collect()));
        assert!(x.items().eq(a.iter().copied()) && x.len() as usize == a.len());
        assert!(!x.is_disjoint(&y));
        assert!(x.without(&y).is_disjoint(&y) && Items::default().is_empty() && !x.is_empty());
        let mut all = x;
        all.add_all(&y);
        assert_eq!(all, set(&a.union(&b).copied().collect()));
        assert!(Items::first(70).items().eq(0..70) && x.contains(1) && !x.contains(2));
        assert!(Items::of_one(700).items().eq([700]));
    }
}
