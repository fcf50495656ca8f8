//! Nogood recording: why some items of the plane need more discs than there are, found once and used again.
//!
//! *Problem.* Do k discs of one radius hold a core-set X of points of the plane? As [`super::tree`], but for many discs.
//! *Idea.* A nogood is a set of items that no e discs hold. To find one among some items, take the first of them along an
//! axis, p, and the largest sets that one disc with p can hold ([`discs`]). If e − 1 discs hold the rest of any of these, the items are held;
//! else the rest has a nogood N for e − 1 discs. All discs with p that hold nothing of N fail for the same reason. When all have failed, p and
//! all these N together are a nogood for e discs.
//! A nogood is recorded, and is used wherever all its items are left: discs elsewhere do not matter. As items are held along an axis, what is
//! left differs near a front alone, so that parts of the plane are not searched again for each choice in other parts, as a tree does.
//! *Growth of X.* Discs that hold X are looked at from all items, as in [`super::subsearch`], and the search starts again with the farthest
//! item. What was recorded stays true, and leads back at once.
//! *Guarantee.* The radius is a little larger than what is claimed ([`MARGIN`]), so that a checker refutes the same discs whatever rounding does.
//! Nothing depends on threads.
//! *Trap.* For few discs there is little to use again, and a tree is faster. A bound much nearer to the radius than 1e-5 is not proved.
//! *Evidence.* 15,112 cities: for 15 centers at 1 % some 8000 nogoods are enough, where the tree takes 1.7·10⁵ nodes. 20 centers take 4·10⁴ steps in all
//! at 5 %, 1.6·10⁵ at 3 % and 6·10⁵ at 1 %; with other starts of the same search 4.4·10⁵ to 6·10⁵, fewer where good centers are found soon. At 3 % a step finds
//! some 210 nogoods within what is left.
//! What a nogood is made of matters, as those with items far from the front apply more often ([`NogoodSearch::known_missed`],
//! [`NogoodSearch::apart`]). Which disc is tried first does not: for the same radius, the disc that holds the most takes as many steps as the ones
//! that hold most beside p, or most far from it, by several weights. Nor does the choice of
//! p: the first along other axes, or that with the fewest discs of the first eight, takes 0.9 to 1.1 times as many steps.
//! Weights on items of which no disc holds more than 1, from linear
//! programs of all items and of parts, refute what is left more often than items apart do, and save a sixth to a third of the steps at 5 %: not worth the programs.
//! *Reference.* Recording is that of constraint satisfaction: Dechter, Artificial Intelligence 41, 1990. A sweep over the plane with k discs takes
//! n^O(√k) states: Hwang, Lee and Chang, Algorithmica 9, 1993.

mod disc_table;
mod discs;
mod item_set;
mod record;
mod subset_index;
#[cfg(test)]
mod tests;
mod transpose;

use taut_certify::Nogood;
use taut_points::ReadError;

use self::disc_table::{DiscSet, DiscTable};
use self::discs::{Disc, Discs, Place};
use self::item_set::ItemSet;
use self::record::{Known, Record, Source};
use self::subset_index::Question;
use super::items::{Position, Shape};
use super::lloyd::improve;
use super::start::Incumbent;
use super::subsearch::Task;
use crate::Error;

/// The smallest gap to be proved in this way; the margin is to be small beside it.
const GAP_MIN: f64 = 1e-5;
/// Fewest discs. Measured: to record nogoods takes 12 of 15,112 cities 1.1 times as long as a tree, and 15 of them 0.7 times.
const DISCS_MIN: usize = 13;
/// Most discs: one call within another for each.
const DISCS_MAX: usize = 64;
/// A core-set is expected to grow by at most this factor. Measured: 1.5 for 15 and 20 of 15,112 cities at gaps of 5 to 1 %.
pub(super) const CORE_SET_GROWTH: f64 = 1.6;
/// In parts of the radius, by how much larger discs are than what is claimed. A checker adds a tenth of it.
const MARGIN: f64 = 1e-6;
/// A step counts as so many nodes of a tree, as it takes about as much time.
pub(super) const NODES_PER_STEP: u64 = 10;
/// Discs whose radius is this near to the best are worth Lloyd's steps.
const WORTH_IMPROVING: f64 = 1.02;
/// Most nogoods by which a checker shows another one.
const MISSES_MAX: usize = 127;
/// Most items that a checker takes.
const ITEMS_MAX: usize = 2048;
/// Most items times nogoods of a log that a checker takes.
const LOG_BITS_MAX: usize = 1 << 30;
/// Directions in whose order items apart are sought, from both ends: by how far they go along the axis of the search, and across it.
const ORDERS: [Place; 4] = [[1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, -1.0]];

/// A finished search: no k balls of a radius of `best.radius / (1 + gap)` hold the core-set.
pub(super) struct Refutation {
    /// The items that are needed, by their number in the cloud.
    pub(super) core_set: Vec<u32>,
    pub(super) log: Vec<Nogood>,
}

impl Refutation {
    /// Tests whether a checker takes so long a log.
    fn is_checkable(&self) -> bool {
        self.core_set.len().saturating_mul(self.log.len()) <= LOG_BITS_MAX
    }
}

/// How a search ended.
pub(super) enum End {
    Refuted(Refutation),
    /// It took too many nodes.
    Budget,
    /// It takes more items than the sets of this width have.
    ManyItems,
    /// It took more nogoods for one, or a longer log, than a checker takes.
    Full,
}

/// A search and what it has found so far.
pub(super) struct NogoodSearch<'c, const WORDS: usize> {
    task: &'c Task<'c, Place>,
    gap: f64,
    /// Items by their number in the cloud.
    pub(super) core_set: Vec<u32>,
    pub(super) best: Incumbent<Place>,
    pub(super) nodes: u64,
    pub(super) scans: u64,
    max_nodes: u64,
    discs: Discs<WORDS>,
    /// The axis along which items are held.
    axis: usize,
    orders: [Vec<u32>; ORDERS.len()],
    /// For each item, where it is in the first of the orders.
    ranks: Vec<u32>,
    record: Record<WORDS>,
}

/// An item set that so many discs cannot hold.
struct Missed<const WORDS: usize> {
    items: ItemSet<WORDS>,
    source: Source,
}

enum Outcome<const WORDS: usize> {
    /// Discs about these centers hold the items.
    Held(Vec<Place>),
    Not(Missed<WORDS>),
    Budget,
    /// A nogood takes more others than a checker goes through.
    Full,
}

/// Returns true if nogoods can be recorded for this question.
pub(super) fn applies<P: Position>(task: &Task<'_, P>, items: usize, gap: f64) -> bool {
    let cloud = task.cloud;
    cloud.items.shape() == Shape::Points
        && cloud.items.dim() == 2
        && !cloud.is_grouped
        && cloud.place_error == 0.0
        && task.z == 0
        && (DISCS_MIN..=DISCS_MAX).contains(&task.k)
        && items < ITEMS_MAX
        && gap >= GAP_MIN
}

impl<'c, const WORDS: usize> NogoodSearch<'c, WORDS> {
    pub(super) fn new(
        task: &'c Task<'c, Place>,
        core_set: &[u32],
        best: &Incumbent<Place>,
        gap: f64,
        max_nodes: u64,
    ) -> Self {
        let mut search = NogoodSearch {
            task,
            gap,
            core_set: core_set.to_vec(),
            best: best.clone(),
            nodes: 0,
            scans: 0,
            max_nodes,
            discs: Discs::new(0.0, std::iter::empty()),
            axis: 0,
            orders: Default::default(),
            ranks: vec![],
            record: Record::default(),
        };
        search.make_discs();
        let spread = |axis: usize| {
            let values = || core_set.iter().map(|&item| search.place_of(item)[axis]);
            values().fold(f64::MIN, f64::max) - values().fold(f64::MAX, f64::min)
        };
        search.axis = usize::from(spread(1) > spread(0));
        (0..core_set.len() as u32).for_each(|item| search.put_in_order(item));
        search
    }

    /// Goes on until the core-set is refuted, or something is used up.
    pub(super) fn go_on(&mut self) -> Result<End, Error> {
        loop {
            let all = ItemSet::first(self.core_set.len());
            let centers = match self.search(&all, self.task.k)? {
                Outcome::Budget => return Ok(End::Budget),
                Outcome::Full => return Ok(End::Full),
                Outcome::Not(missed) => {
                    let refutation = self.refutation(missed);
                    return Ok(if refutation.is_checkable() {
                        End::Refuted(refutation)
                    } else {
                        End::Full
                    });
                }
                Outcome::Held(centers) => centers,
            };
            let before = self.best.radius;
            let far = self.read_all_items(centers)?;
            if self.best.radius < before {
                self.make_discs();
            }
            if self.core_set.contains(&far) {
                // Only rounding can leave the centers as they were.
                if self.best.radius == before {
                    return Ok(End::Full);
                }
                continue;
            }
            if self.core_set.len() == ItemSet::<WORDS>::ITEMS_MAX {
                return Ok(End::ManyItems);
            }
            self.discs.add(self.place_of(far));
            self.core_set.push(far);
            self.put_in_order(self.core_set.len() as u32 - 1);
        }
    }

    fn place_of(&self, item: u32) -> Place {
        let place = self.task.cloud.items.at(item as usize);
        [place[0], place[1]]
    }

    /// Makes all discs again, for the radius that is now to be refuted.
    fn make_discs(&mut self) {
        let radius = self.best.radius / (1.0 + self.gap) * (1.0 + MARGIN);
        self.discs = Discs::new(radius, self.core_set.iter().map(|&item| self.place_of(item)));
    }

    /// Puts the last item where it is in each order.
    fn put_in_order(&mut self, item: u32) {
        let axis = self.axis;
        for (order, [along, across]) in self.orders.iter_mut().zip(ORDERS) {
            let key = |item: u32| {
                let place = self.discs.place(item);
                along * place[axis] + across * place[1 - axis]
            };
            let at = order.partition_point(|&other| key(other) <= key(item));
            order.insert(at, item);
        }
        self.ranks.push(0);
        for (&item, rank) in self.orders[0].iter().zip(0..) {
            self.ranks[item as usize] = rank;
        }
    }

    /// Reads all items from these centers; returns the farthest.
    fn read_all_items(&mut self, centers: Vec<Place>) -> Result<u32, Error> {
        let Task { cloud, monitor, k, z } = *self.task;
        let far = cloud.farthest(&centers, 1)[0];
        self.scans += 1;
        let mut seen = Incumbent { centers, radius: far.reach };
        if seen.radius <= self.best.radius * WORTH_IMPROVING {
            seen = improve(cloud, seen, k, z, monitor)?;
        }
        if seen.radius < self.best.radius {
            self.best = seen;
        }
        Ok(far.item)
    }

    /// Discs that hold these items, at most so many, or a nogood among the items.
    fn search(&mut self, items: &ItemSet<WORDS>, level: usize) -> Result<Outcome<WORDS>, Error> {
        if items.is_empty() {
            return Ok(Outcome::Held(vec![]));
        }
        if let Some(apart) = self.apart(items, level) {
            let number = self.record.add_separated(apart);
            return Ok(Outcome::Not(Missed { items: apart, source: Source::Recorded(number) }));
        }
        self.nodes += NODES_PER_STEP;
        if self.nodes > self.max_nodes {
            return Ok(Outcome::Budget);
        }
        self.task.monitor.check().map_err(ReadError::from)?;
        let first = self.orders[0].iter().copied().find(|&item| items.contains(item));
        let first = first.expect("there are items");
        self.discs.update_table(first);
        let table = self.discs.table(first);
        let (mut open, counts) = (table.all().clone(), table.counts(items));
        // Of those for `level` discs there is none within the items, or this would not have been asked.
        let known = self.record.within(level - 1, items, &self.orders[0]);
        let mut nogood = ItemSet::of_one(first);
        let mut misses = vec![];
        while let Some(disc) = self.discs.table(first).fullest(&open, &counts) {
            let Disc { held, center } = *self.discs.disc(disc);
            let rest = items.without(&held);
            let missed = match level {
                1 => match self.item_missed(&rest, first, &open, &nogood) {
                    Some(item) => {
                        Missed { items: ItemSet::of_one(item), source: Source::Item(item) }
                    }
                    None => return Ok(Outcome::Held(vec![center])),
                },
                _ => match self.known_missed(&known, &rest, &nogood) {
                    Some(missed) => missed,
                    None => match self.search(&rest, level - 1)? {
                        Outcome::Not(missed) => missed,
                        end @ (Outcome::Budget | Outcome::Full) => return Ok(end),
                        Outcome::Held(mut centers) => {
                            centers.push(center);
                            return Ok(Outcome::Held(centers));
                        }
                    },
                },
            };
            let refuted = self.discs.table(first).without(&missed.items);
            misses.push((missed.source, open.intersection(&refuted)));
            open.remove_all(&refuted);
            nogood.add_all(&missed.items);
        }
        let misses = self.needed(self.discs.table(first), &misses);
        if misses.len() > MISSES_MAX {
            return Ok(Outcome::Full);
        }
        let mut nogood = ItemSet::of_one(first);
        misses.iter().for_each(|&miss| nogood.add_all(&self.items_of(miss)));
        let order = self.orders[0].iter().copied();
        let in_order: Vec<u32> = order.filter(|&item| nogood.contains(item)).collect();
        let along_axis = |item| self.discs.place(item)[self.axis];
        let number = self.record.add_branch(level, first, misses, &in_order, along_axis);
        Ok(Outcome::Not(Missed { items: nogood, source: Source::Recorded(number) }))
    }

    /// Of nogoods, each with the discs of the table that it was the first to refute, those without which some disc is refuted by none.
    /// Measured: without the others a search takes 0.8 times as many steps.
    fn needed(&self, table: &DiscTable<WORDS>, misses: &[(Source, DiscSet)]) -> Vec<Source> {
        let (mut needed, mut left) = (vec![], table.all().clone());
        for (source, discs) in misses.iter().rev() {
            if !discs.intersection(&left).is_empty() {
                left.remove_all(&table.without(&self.items_of(*source)));
                needed.push(*source);
            }
        }
        needed.reverse();
        needed
    }

    fn items_of(&self, source: Source) -> ItemSet<WORDS> {
        match source {
            Source::Item(item) => ItemSet::of_one(item),
            Source::Recorded(number) => *self.record.items(number),
        }
    }

    /// Of the known nogoods within what a disc leaves, that whose first item that is not in the nogood yet is the farthest along the
    /// axis; of these the one that adds the fewest. What is far from the front is usually left when the nogood is asked for again. Measured: with
    /// the one that adds the fewest items, however near, a search takes 1.2 times as many steps.
    fn known_missed(
        &self,
        known: &Known,
        rest: &ItemSet<WORDS>,
        nogood: &ItemSet<WORDS>,
    ) -> Option<Missed<WORDS>> {
        let mut best = None;
        let mut best_rank = 0;
        let mut fewest = u32::MAX;
        let mut before = ItemSet::default();
        let question = Question::new(rest, &self.orders[0]);
        for number in self.record.known_within(known, &question) {
            let added = self.record.items(number).without(nogood);
            if !added.is_disjoint(&before) {
                continue;
            }
            let ranks = added.items().map(|item| self.ranks[item as usize]);
            let rank = ranks.min().unwrap_or(u32::MAX);
            let count = added.len();
            if rank > best_rank || count < fewest {
                before.extend(
                    self.orders[0][best_rank as usize..]
                        .iter()
                        .take((rank - best_rank) as usize)
                        .copied(),
                );
                (best, best_rank, fewest) = (Some(number), rank, count);
            }
        }
        let number = best?;
        Some(Missed { items: *self.record.items(number), source: Source::Recorded(number) })
    }

    /// Of the items that one of the open discs does not hold, one that is in the nogood already, if there is such a one, and of these
    /// that which is outside of most others.
    fn item_missed(
        &self,
        rest: &ItemSet<WORDS>,
        first: u32,
        open: &DiscSet,
        nogood: &ItemSet<WORDS>,
    ) -> Option<u32> {
        let table = self.discs.table(first);
        let outside = |item: u32| open.intersection(&table.without(&ItemSet::of_one(item))).len();
        rest.items().max_by_key(|&item| (nogood.contains(item), outside(item), item))
    }

    /// One more of the items than there may be discs, no two of which are in one disc; sought greedily in each order from both ends. The far
    /// end comes first, as items there are usually left when this is asked again. Measured: so a search takes 0.7 times as many steps as
    /// with three orders from their near ends alone.
    fn apart(&self, items: &ItemSet<WORDS>, level: usize) -> Option<ItemSet<WORDS>> {
        let from_far =
            self.orders.iter().find_map(|order| self.apart_in(order.iter().rev(), items, level));
        from_far.or_else(|| {
            self.orders.iter().find_map(|order| self.apart_in(order.iter(), items, level))
        })
    }

    fn apart_in<'o>(
        &self,
        order: impl Iterator<Item = &'o u32>,
        items: &ItemSet<WORDS>,
        level: usize,
    ) -> Option<ItemSet<WORDS>> {
        let (mut left, mut apart, mut count) = (*items, ItemSet::default(), 0);
        for &item in order {
            if left.contains(item) {
                apart.insert(item);
                count += 1;
                if count > level {
                    return Some(apart);
                }
                left = left.intersection(self.discs.apart(item));
            }
        }
        None
    }

    fn refutation(&self, missed: Missed<WORDS>) -> Refutation {
        let number = match missed.source {
            Source::Recorded(number) => number,
            Source::Item(_) => unreachable!("there is at least one disc"),
        };
        let (core, log) = self.record.log(number);
        let core_set = core.into_iter().map(|item| self.core_set[item as usize]).collect();
        Refutation { core_set, log }
    }
}
