//! Nogoods as they are recorded, and the log that a checker can follow.

use taut_certify::Nogood;

use super::item_set::ItemSet;

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

/// All nogoods found so far.
#[derive(Clone, Debug, Default)]
pub(super) struct Record {
    items: Vec<ItemSet>,
    reasons: Vec<Reason>,
    /// Of those with a branch, the numbers for each count of discs and each item that is branched on.
    of_level: Vec<Vec<Vec<u32>>>,
}

impl Record {
    pub(super) fn add(&mut self, level: usize, items: ItemSet, reason: Reason) -> u32 {
        let number = self.items.len() as u32;
        // Items apart are found again faster than they are looked up.
        if let &Reason::Branch { item, .. } = &reason {
            if self.of_level.len() <= level {
                self.of_level.resize(level + 1, vec![]);
            }
            let of_level = &mut self.of_level[level];
            if of_level.len() <= item as usize {
                of_level.resize(item as usize + 1, vec![]);
            }
            of_level[item as usize].push(number);
        }
        self.items.push(items);
        self.reasons.push(reason);
        number
    }

    pub(super) fn items(&self, number: u32) -> &ItemSet {
        &self.items[number as usize]
    }

    /// The nogoods of a level whose items are all among these.
    pub(super) fn within(&self, level: usize, items: &ItemSet) -> impl Iterator<Item = u32> {
        let of_level = self.of_level.get(level).map_or(&[][..], |of_level| &of_level[..]);
        // Most are told apart by the item that is branched on, without a look at the set.
        let possible = of_level.iter().enumerate().filter(|&(item, _)| items.contains(item as u32));
        possible
            .flat_map(|(_, numbers)| numbers.iter().copied())
            .filter(|&number| self.items(number).is_subset(items))
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
