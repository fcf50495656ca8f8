//! Which of many item sets lie within one.
//!
//! *Idea.* 64 sets stand side by side: for each item that any of them has, a word says which. An item that is not among those asked for rules
//! out all sets with it at once.
//! *Again.* Sets that lie within some items are asked for again, of fewer items: only their groups are looked at then.
//! *Cost.* Linear in the number of sets and their items, 64 sets at a time.
//! *Evidence.* Nogoods of 15,112 cities and 20 centers, gap 2 %: a question finds 420 sets in some 70 groups. Beside a look at each set on its own
//! the whole search took 0.7 times as long.

use super::item_set::ItemSet;

/// Sets that stand side by side: a bit of a word each.
const SIDE_BY_SIDE: usize = u64::BITS as usize;
/// Items after which it is seen whether the rest of them matters.
const ITEMS_AT_ONCE: usize = 16;

/// Item sets, each with a number.
#[derive(Clone, Debug, Default)]
pub(super) struct SubsetIndex {
    groups: Vec<Group>,
}

/// As many sets as stand side by side, or fewer in the last group.
#[derive(Clone, Debug)]
struct Group {
    numbers: Vec<u32>,
    /// Items in their order.
    items: Vec<u16>,
    /// For each of them the sets that have it.
    with_item: Vec<u64>,
}

impl SubsetIndex {
    /// Takes a set, its items by growing key. The items of smaller keys are looked at first.
    pub(super) fn add(&mut self, number: u32, items: &[u32], key: impl Fn(u32) -> f64) {
        match self.groups.last_mut() {
            Some(group) if group.numbers.len() < SIDE_BY_SIDE => group.add(number, items, key),
            _ => self.groups.push(Group::of_one(number, items)),
        }
    }

    /// The sets within the items of a question, for each group of which there are some.
    pub(super) fn within<'i>(
        &'i self,
        question: &'i Question,
    ) -> impl Iterator<Item = SetsOfGroup> {
        self.groups.iter().zip(0..).filter_map(|(group, number)| {
            let sets = group.within(group.all(), question);
            (sets != 0).then_some(SetsOfGroup { group: number, sets })
        })
    }

    /// Of some sets the numbers of those within the items of a question, in the order in which they were added.
    pub(super) fn numbers_within(
        &self,
        some: SetsOfGroup,
        question: &Question,
    ) -> impl Iterator<Item = u32> {
        let group = &self.groups[some.group as usize];
        let mut left = group.within(some.sets, question);
        std::iter::from_fn(move || {
            let bit = left.trailing_zeros() as usize;
            (left != 0).then(|| {
                left &= left - 1;
                group.numbers[bit]
            })
        })
    }
}

/// Some of the sets of one group.
#[derive(Clone, Copy, Debug)]
pub(super) struct SetsOfGroup {
    group: u32,
    sets: u64,
}

/// The items that a set may have.
pub(super) struct Question {
    /// For each item all bits if a set may have it, and none if not: so a group is asked without a branch for each of its items.
    is_left: Vec<u64>,
    /// For each item, whether a set may have it and all those that come after it.
    is_settled: Vec<bool>,
}

impl Question {
    /// About some of the items that are given in their order.
    pub(super) fn new<const WORDS: usize>(items: &ItemSet<WORDS>, order: &[u32]) -> Self {
        let (mut is_left, mut is_settled) = (vec![0; order.len()], vec![false; order.len()]);
        items.items().for_each(|item| is_left[item as usize] = u64::MAX);
        let last = order.iter().rev().take_while(|&&item| items.contains(item));
        last.for_each(|&item| is_settled[item as usize] = true);
        Question { is_left, is_settled }
    }
}

impl Group {
    fn of_one(number: u32, items: &[u32]) -> Self {
        Group {
            numbers: vec![number],
            items: items.iter().map(|&item| item as u16).collect(),
            with_item: vec![1; items.len()],
        }
    }

    fn add(&mut self, number: u32, items: &[u32], key: impl Fn(u32) -> f64) {
        let bit = 1 << self.numbers.len();
        self.numbers.push(number);
        let comes_before = |a: u16, b: u16| {
            let [a, b] = [a, b].map(u32::from);
            (key(a), a) < (key(b), b)
        };
        let (mut merged, mut with_item) = (vec![], vec![]);
        let mut push = |item: u16, sets: u64| {
            merged.push(item);
            with_item.push(sets);
        };
        let old = self.items.iter().copied().zip(self.with_item.iter().copied());
        let mut old = old.peekable();
        for item in items.iter().map(|&item| item as u16) {
            while let Some((before, sets)) = old.next_if(|&(other, _)| comes_before(other, item)) {
                push(before, sets);
            }
            let sets = old.next_if(|&(other, _)| other == item).map_or(0, |(_, sets)| sets);
            push(item, sets | bit);
        }
        old.for_each(|(item, sets)| push(item, sets));
        (self.items, self.with_item) = (merged, with_item);
    }

    fn all(&self) -> u64 {
        u64::MAX >> (SIDE_BY_SIDE - self.numbers.len())
    }

    /// Of some sets those within the items of a question.
    fn within(&self, some: u64, question: &Question) -> u64 {
        let mut left = some;
        let sets = self.with_item.chunks(ITEMS_AT_ONCE);
        for (items, sets) in self.items.chunks(ITEMS_AT_ONCE).zip(sets) {
            if left == 0 || question.is_settled[usize::from(items[0])] {
                break;
            }
            for (&item, &sets) in items.iter().zip(sets) {
                left &= !sets | question.is_left[usize::from(item)];
            }
        }
        left
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_within_are_those_that_a_look_at_each_finds() {
        let mut state = 3u64;
        let mut draw = |below: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695);
            (state >> 33) % below
        };
        let key = |item: u32| f64::from(item % 7);
        let mut order: Vec<u32> = (0..100).collect();
        order.sort_by(|&a, &b| (key(a), a).partial_cmp(&(key(b), b)).unwrap());
        let (mut index, mut all) = (SubsetIndex::default(), vec![]);
        let mut found = 0;
        for number in 0..300 {
            let set: ItemSet<2> = (0..1 + draw(4)).map(|_| draw(90) as u32).collect();
            let in_order: Vec<u32> =
                order.iter().copied().filter(|&item| set.contains(item)).collect();
            index.add(number, &in_order, key);
            all.push((number, set));
            let gone: ItemSet<2> = (0..draw(60)).map(|_| draw(100) as u32).collect();
            let items = ItemSet::first(100).without(&gone);
            let is_within = |&&(_, set): &&(u32, ItemSet<2>)| set.without(&items).is_empty();
            let expected: Vec<u32> = all.iter().filter(is_within).map(|&(at, _)| at).collect();
            let question = Question::new(&items, &order);
            let sets: Vec<SetsOfGroup> = index.within(&question).collect();
            let among = |question: &Question| -> Vec<u32> {
                sets.iter().flat_map(|&sets| index.numbers_within(sets, question)).collect()
            };
            assert_eq!(among(&question), expected);
            found += expected.len();
            // Asked again of fewer items.
            let fewer = items.without(&(0..draw(9)).map(|_| draw(100) as u32).collect());
            let expected: Vec<u32> = all
                .iter()
                .filter(|(_, set)| set.without(&fewer).is_empty())
                .map(|&(at, _)| at)
                .collect();
            assert_eq!(among(&Question::new(&fewer, &order)), expected);
        }
        assert!((10_000..40_000).contains(&found), "{found}");
    }
}
