//! Whether k of many sets cover all items but z.
//!
//! *Idea.* The item that fewest sets hold is tried in each of them, but for sets that hold nothing that another does not
//! hold too. Weights on the items refute early: when no set weighs more than 1, all items together can weigh k at most,
//! and with z left out as much more as the heaviest z weigh. What failed once, fails again.
//! *Guarantee.* `None` only when the nodes are used up.
//! *Cost.* Exponential in k.

use std::collections::HashSet;

use super::super::meter::{Meter, Stop};

const WORDS: usize = 4;

/// Most items of a core-set that is looked at twice.
pub(super) const ITEMS: usize = 200;

/// A cover is looked for in at most this many nodes.
pub(super) const NODES_MAX: u64 = 1 << 15;

/// This many rounds of weights are made: the more, the nearer to the best there are; most of the way is gone after six.
const WEIGHT_ROUNDS: usize = 6;

/// A set of at most 256 items.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Set([u64; WORDS]);

impl Set {
    pub(super) fn of_words(words: &[u64]) -> Self {
        Set(std::array::from_fn(|word| words.get(word).copied().unwrap_or(0)))
    }

    pub(super) fn insert(&mut self, item: usize) {
        self.0[item / 64] |= 1 << (item % 64);
    }

    fn has(&self, item: usize) -> bool {
        self.0[item / 64] >> (item % 64) & 1 == 1
    }

    fn and(&self, other: &Set) -> Set {
        Set(std::array::from_fn(|word| self.0[word] & other.0[word]))
    }

    fn without(&self, other: &Set) -> Set {
        Set(std::array::from_fn(|word| self.0[word] & !other.0[word]))
    }

    fn is_within(&self, other: &Set) -> bool {
        self.without(other) == Set::default()
    }

    fn len(&self) -> usize {
        self.0.iter().map(|word| word.count_ones() as usize).sum()
    }

    pub(super) fn items(&self) -> impl Iterator<Item = usize> + use<'_> {
        super::super::core::items(&self.0)
    }
}

/// Sets of which none is within another.
fn maximal(mut sets: Vec<Set>, meter: &mut Meter<'_>) -> Result<Vec<Set>, Stop> {
    meter.spend(WORDS * sets.len() * ((sets.len() + 1).ilog2() as usize + 1))?;
    sets.sort_unstable_by(|a, b| b.len().cmp(&a.len()).then(b.cmp(a)));
    sets.dedup();
    let mut kept: Vec<Set> = vec![];
    for set in sets {
        let larger = kept.iter().position(|larger| set.is_within(larger));
        meter.spend(WORDS / 2 * larger.unwrap_or(kept.len()))?;
        if larger.is_none() {
            kept.push(set);
        }
    }
    Ok(kept)
}

/// A search for a cover.
pub(super) struct Covering {
    sets: Vec<Set>,
    items: usize,
    pub(super) nodes: u64,
    failed: HashSet<(Set, usize, usize)>,
    chosen: Vec<Set>,
}

impl Covering {
    pub(super) fn of(sets: Vec<Set>, items: usize, meter: &mut Meter<'_>) -> Result<Self, Stop> {
        let sets = maximal(sets, meter)?;
        Ok(Covering { sets, items, nodes: 0, failed: HashSet::new(), chosen: vec![] })
    }

    /// A cover by k sets of all items but z, or none; `None` when the nodes are used up.
    pub(super) fn search(
        &mut self,
        k: usize,
        z: usize,
        meter: &mut Meter<'_>,
    ) -> Result<Option<Option<Vec<Set>>>, Stop> {
        let mut all = Set::default();
        (0..self.items).for_each(|item| all.insert(item));
        let sets = self.sets.clone();
        Ok(match self.node(all, &sets, k, z, meter)? {
            Some(true) => Some(Some(self.chosen.clone())),
            Some(false) => Some(None),
            None => None,
        })
    }

    /// Whether `open` can be covered; `sets` are those that may help.
    fn node(
        &mut self,
        open: Set,
        sets: &[Set],
        k: usize,
        z: usize,
        meter: &mut Meter<'_>,
    ) -> Result<Option<bool>, Stop> {
        self.nodes += 1;
        if open.len() <= z {
            return Ok(Some(true));
        }
        if k == 0 {
            return Ok(Some(false));
        }
        if self.nodes > NODES_MAX {
            return Ok(None);
        }
        if self.failed.contains(&(open, k, z)) {
            return Ok(Some(false));
        }
        let sets = maximal(sets.iter().map(|set| set.and(&open)).collect(), meter)?;
        meter.spend(WEIGHT_ROUNDS * (self.items * sets.len() + 16 * self.items))?;
        let counts = counts(&sets, self.items);
        if weighs_too_much(&open, &sets, &counts, k, z) {
            self.failed.insert((open, k, z));
            return Ok(Some(false));
        }
        let Some(item) = open.items().min_by_key(|&item| counts[item]) else {
            return Ok(Some(true));
        };
        for set in sets.iter().filter(|set| set.has(item)) {
            self.chosen.push(*set);
            match self.node(open.without(set), &sets, k - 1, z, meter)? {
                Some(false) => drop(self.chosen.pop()),
                other => return Ok(other),
            }
        }
        if z > 0 {
            let mut left_out = Set::default();
            left_out.insert(item);
            match self.node(open.without(&left_out), &sets, k, z - 1, meter)? {
                Some(false) => {}
                other => return Ok(other),
            }
        }
        self.failed.insert((open, k, z));
        Ok(Some(false))
    }
}

/// For each item, how many sets hold it.
fn counts(sets: &[Set], items: usize) -> Vec<usize> {
    let mut counts = vec![0; items];
    for set in sets {
        set.items().for_each(|item| counts[item] += 1);
    }
    counts
}

/// Whether weights on the items show that k sets and z items left out are too few.
fn weighs_too_much(open: &Set, sets: &[Set], counts: &[usize], k: usize, z: usize) -> bool {
    let mut weights = vec![0.0; counts.len()];
    for item in open.items() {
        weights[item] = if counts[item] == 0 { 1.0 } else { 1.0 / counts[item] as f64 };
    }
    for _ in 0..WEIGHT_ROUNDS {
        let mut heaviest = vec![0.0f64; counts.len()];
        for set in sets {
            let weight: f64 = set.items().map(|item| weights[item]).sum();
            set.items().for_each(|item| heaviest[item] = heaviest[item].max(weight));
        }
        for item in open.items().filter(|&item| heaviest[item] > 0.0) {
            weights[item] /= heaviest[item];
        }
        let mut all: Vec<f64> = open.items().map(|item| weights[item]).collect();
        all.sort_unstable_by(|a, b| b.total_cmp(a));
        // Sums of at most 256 numbers of at most 1 are off by far less.
        if all.iter().skip(z).sum::<f64>() > k as f64 + 1e-6 {
            return true;
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use taut_points::Monitor;

    use super::*;

    fn covered(sets: &[&[usize]], items: usize, k: usize, z: usize) -> bool {
        let set = |items: &&[usize]| {
            let mut set = Set::default();
            items.iter().for_each(|&item| set.insert(item));
            set
        };
        let mut meter = Meter::endless(&Monitor::silent());
        let mut covering = Covering::of(sets.iter().map(set).collect(), items, &mut meter).unwrap();
        let found = covering.search(k, z, &mut meter).unwrap().unwrap();
        if let Some(cover) = &found {
            let held = (0..items).filter(|&item| cover.iter().any(|set| set.has(item))).count();
            assert!(cover.len() <= k && held + z >= items);
        }
        found.is_some()
    }

    #[test]
    fn edges_of_a_cycle_cover_it_by_halves() {
        let cycle: Vec<[usize; 2]> = (0..7).map(|i| [i, (i + 1) % 7]).collect();
        let edges: Vec<&[usize]> = cycle.iter().map(|edge| &edge[..]).collect();
        for z in 0..3usize {
            let least = (7 - z).div_ceil(2);
            assert!(!covered(&edges, 7, least - 1, z) && covered(&edges, 7, least, z), "{z}");
        }
    }

    #[test]
    fn all_choices_of_small_random_families_agree() {
        let mut state = 1u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695);
            state >> 40
        };
        for _ in 0..300 {
            let items = 3 + next() as usize % 7;
            let masks: Vec<u64> = (0..6).map(|_| next() & next() & ((1 << items) - 1)).collect();
            for k in 1..4 {
                for z in 0..3 {
                    let covers =
                        (0u32..64).filter(|chosen| chosen.count_ones() as usize <= k).any(|c| {
                            let all =
                                (0..6).filter(|i| c >> i & 1 == 1).fold(0, |all, i| all | masks[i]);
                            all.count_ones() as usize + z >= items
                        });
                    let lists: Vec<Vec<usize>> = masks
                        .iter()
                        .map(|mask| (0..items).filter(|i| mask >> i & 1 == 1).collect())
                        .collect();
                    let lists: Vec<&[usize]> = lists.iter().map(Vec::as_slice).collect();
                    assert_eq!(covered(&lists, items, k, z), covers, "{masks:?} {k} {z}");
                }
            }
        }
    }
}
