//! Which items of a core-set have to be together, and where the first of them is.
//!
//! *Idea.* The items of a core-set that are rows of one group are decided on one by one. The first decision settles the group:
//! all others of it go where that one is, and have no other choice. So a group can be in the core-set with a few of its rows, and get
//! more of them when these turn out to matter.

use std::collections::HashMap;

use super::depth_first::Place;

/// Where the first decided item of a group is, and at which level that was decided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Home {
    /// The cluster; none if the group is left out.
    pub(super) cluster: Option<usize>,
    pub(super) level: u32,
}

/// The groups of the items of a core-set.
#[derive(Clone, Debug, Default)]
pub(super) struct Links {
    /// From the number of a group among all to its number here.
    numbers: HashMap<u32, u32>,
    /// The group of each item.
    groups: Vec<u32>,
    /// The items of each group, ascending.
    members: Vec<Vec<u32>>,
    homes: Vec<Option<Home>>,
    /// For each decision, in order, the group that it settled, if any.
    settled: Vec<Option<u32>>,
}

impl Links {
    /// The next item is of this group.
    pub(super) fn add(&mut self, group: u32) {
        let next = self.members.len() as u32;
        let number = *self.numbers.entry(group).or_insert(next);
        if number == next {
            self.members.push(vec![]);
            self.homes.push(None);
        }
        self.members[number as usize].push(self.groups.len() as u32);
        self.groups.push(number);
    }

    /// Number of groups.
    pub(super) fn len(&self) -> usize {
        self.members.len()
    }

    /// The group of an item.
    pub(super) fn group(&self, item: u32) -> usize {
        self.groups[item as usize] as usize
    }

    /// The items of the group that is numbered so among all.
    pub(super) fn known(&self, group: u32) -> &[u32] {
        self.numbers.get(&group).map_or(&[], |&number| &self.members[number as usize])
    }

    /// The items of a group.
    pub(super) fn members(&self, group: usize) -> &[u32] {
        &self.members[group]
    }

    /// The items of the group of an item.
    pub(super) fn linked(&self, item: u32) -> &[u32] {
        &self.members[self.group(item)]
    }

    /// Where the group of an item is, if that is decided.
    pub(super) fn home(&self, item: u32) -> Option<Home> {
        self.homes[self.group(item)]
    }

    /// An item was put into this cluster, or left out.
    pub(super) fn decide(&mut self, item: u32, cluster: Option<usize>, level: u32) {
        let group = self.group(item);
        let is_first = self.homes[group].is_none();
        if is_first {
            self.homes[group] = Some(Home { cluster, level });
        }
        self.settled.push(is_first.then_some(group as u32));
    }

    /// Takes the last decision back.
    pub(super) fn undo(&mut self) {
        if let Some(group) = self.settled.pop().flatten() {
            self.homes[group as usize] = None;
        }
    }
}

/// The cluster of a place, where so many have items.
pub(super) fn cluster_of(place: Place, used: usize) -> Option<usize> {
    match place {
        Place::Into(cluster) => Some(cluster),
        Place::Open => Some(used),
        Place::LeaveOut => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_decision_settles_a_group_and_goes_last() {
        let mut links = Links::default();
        [7, 3, 7, 9].into_iter().for_each(|group| links.add(group));
        assert_eq!((links.len(), links.known(7), links.known(8)), (3, &[0, 2][..], &[][..]));
        links.decide(2, Some(4), 1);
        links.decide(1, None, 2);
        links.decide(0, Some(4), 3);
        assert_eq!(links.home(0), Some(Home { cluster: Some(4), level: 1 }));
        assert_eq!(links.home(1), Some(Home { cluster: None, level: 2 }));
        links.undo();
        assert_eq!(links.home(2), Some(Home { cluster: Some(4), level: 1 }));
        links.undo();
        links.undo();
        assert!((0..4).all(|item| links.home(item).is_none()));
        assert_eq!(links.linked(2), [0, 2]);
    }
}
