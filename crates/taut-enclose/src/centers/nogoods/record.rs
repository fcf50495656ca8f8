//! Nogoods as they are recorded, and the log that a checker can follow.

use taut_certify::Nogood;

use super::item_set::ItemSet;
use super::subset_index::{Question, SetsOfGroup, SubsetIndex};

/// A set of items that so many discs cannot hold, by what shows it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Source {
    /// No discs hold this one item.
    Item(u32),
    /// The nogood of this number.
    Recorded(u32),
}

/// The reason why e discs do not hold some items.
#[derive(Clone, Debug)]
pub(super) enum Reason {
    /// There are e + 1 of them, and no two are in one disc.
    Separated,
    /// The disc with `item` holds nothing of one of these, which e − 1 others do not hold.
    Branch { item: u32, misses: Box<[Source]> },
}

/// Nogoods of one level that lie within some items, as the record has them.
#[derive(Debug)]
pub(super) struct Known {
    level: usize,
    /// By the item that was branched on.
    sets: Vec<(u32, SetsOfGroup)>,
}

/// All nogoods found so far.
#[derive(Clone, Debug)]
pub(super) struct Record<const WORDS: usize> {
    items: Vec<ItemSet<WORDS>>,
    reasons: Vec<Reason>,
    /// Of those with a branch, the numbers for each count of discs and each item that is branched on.
    of_level: Vec<Vec<SubsetIndex>>,
}

impl<const WORDS: usize> Default for Record<WORDS> {
    fn default() -> Self {
        Record { items: vec![], reasons: vec![], of_level: vec![] }
    }
}

impl<const WORDS: usize> Record<WORDS> {
    /// Records items of which there is one more than there are discs, and no two in one disc. They are found again faster than they
    /// are looked up.
    pub(super) fn add_separated(&mut self, items: ItemSet<WORDS>) -> u32 {
        self.items.push(items);
        self.reasons.push(Reason::Separated);
        self.items.len() as u32 - 1
    }

    /// Records a nogood for so many discs that was found by a branch on an item; its items come by growing `key`.
    pub(super) fn add_branch(
        &mut self,
        level: usize,
        item: u32,
        misses: Vec<Source>,
        items: &[u32],
        key: impl Fn(u32) -> f64,
    ) -> u32 {
        let number = self.items.len() as u32;
        if self.of_level.len() <= level {
            self.of_level.resize(level + 1, vec![]);
        }
        let of_level = &mut self.of_level[level];
        if of_level.len() <= item as usize {
            of_level.resize(item as usize + 1, SubsetIndex::default());
        }
        of_level[item as usize].add(number, items, key);
        self.items.push(items.iter().copied().collect());
        self.reasons.push(Reason::Branch { item, misses: misses.into() });
        number
    }

    pub(super) fn items(&self, number: u32) -> &ItemSet<WORDS> {
        &self.items[number as usize]
    }

    /// The nogoods of a level whose items are all among these, without those that have the first of these in their order: each
    /// disc that is tried holds it.
    pub(super) fn within(&self, level: usize, items: &ItemSet<WORDS>, order: &[u32]) -> Known {
        let mut known = Known { level, sets: vec![] };
        if let Some(of_level) = self.of_level.get(level) {
            let question = Question::new(items, order);
            let first = order.iter().find(|&&item| items.contains(item));
            for item in items.items().filter(|item| Some(item) != first) {
                if let Some(index) = of_level.get(item as usize) {
                    known.sets.extend(index.within(&question).map(|sets| (item, sets)));
                }
            }
        }
        known
    }

    /// The numbers of the known nogoods whose items are all among those of a question.
    pub(super) fn known_within(
        &self,
        known: &Known,
        question: &Question,
    ) -> impl Iterator<Item = u32> {
        known.sets.iter().flat_map(move |&(item, sets)| {
            self.of_level[known.level][item as usize].numbers_within(sets, question)
        })
    }

    /// The items that a nogood needs, and the log that ends with it, in numbers of these.
    pub(super) fn log(&self, last: u32) -> (Vec<u32>, Vec<Nogood>) {
        let core: Vec<u32> = self.items(last).items().collect();
        let number_of = |item: u32| core.binary_search(&item).expect("it is among them") as u32;
        let mut is_needed = vec![false; last as usize + 1];
        let mut is_single = vec![false; core.len()];
        is_needed[last as usize] = true;
        for number in (0..=last as usize).rev() {
            if !is_needed[number] {
                continue;
            }
            if let Reason::Branch { misses, .. } = &self.reasons[number] {
                for miss in misses {
                    match *miss {
                        Source::Item(item) => is_single[number_of(item) as usize] = true,
                        Source::Recorded(other) => is_needed[other as usize] = true,
                    }
                }
            }
        }
        let mut log = vec![];
        let mut single_at = vec![0; core.len()];
        for item in (0..core.len()).filter(|&item| is_single[item]) {
            single_at[item] = log.len() as u32;
            log.push(Nogood { items: vec![item as u32], misses: vec![] });
        }
        let mut at = vec![0; last as usize + 1];
        for number in (0..=last as usize).filter(|&number| is_needed[number]) {
            at[number] = log.len() as u32;
            log.push(match &self.reasons[number] {
                Reason::Separated => Nogood {
                    items: self.items[number].items().map(number_of).collect(),
                    misses: vec![],
                },
                Reason::Branch { item, misses } => Nogood {
                    items: vec![number_of(*item)],
                    misses: misses
                        .iter()
                        .map(|miss| match *miss {
                            Source::Item(item) => single_at[number_of(item) as usize],
                            Source::Recorded(other) => at[other as usize],
                        })
                        .collect(),
                },
            });
        }
        (core, log)
    }
}
