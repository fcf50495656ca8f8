//! A search of the checker's own: no k balls of a radius less than ρ hold all items but so many.
//!
//! *Idea.* A node gives items to groups, each of which some ball may hold. At each node:
//! 1. An item that no group has and no ball covers has as many choices as there are groups it fits in, and one more each
//!    where a ball is left for it and where an item may still be left out. No choice: refuted.
//! 2. Of the items that fit in no group, a clique of items that are apart two by two needs a ball, or to be left out, for
//!    each: more than there are refutes. With one ball left and none to be left out, all of them must fit in it.
//! 3. Otherwise the item with the fewest choices is tried in each; among several, the one that narrows its groups most.
//!
//! Groups stay as they are when an item is put elsewhere, so what did not fit never fits again below: a column of strains
//! for each group is computed only when that group grows.
//! *Guarantee.* [`Outcome::Refuted`] only when all cases were gone through.
//! *Cost.* Exponential in k: at most [`NODES_MAX`] nodes, each of at most |X| tests for the group that grew, and as much work as
//! its meter allows.
//! *Reference.* The choice of the most constrained item is that of Brélaz, Comm. ACM 22(4), 1979, for colourings.

use super::core::{Bits, clear, is_set, items, set};
use super::meter::{Meter, Stop};
use super::room::Room;

/// A search has at most this many nodes. What needs more is to be proved by its branches.
pub(super) const NODES_MAX: u64 = 1 << 16;

/// A search takes at most this many steps: some five seconds. Proofs that are left to a search took 5·10⁷ and less, in
/// up to 500 dimensions.
pub(super) const STEPS_MAX: u64 = 3 << 30;

/// Most items of a core-set that is searched.
pub(super) const ITEMS: usize = 1024;

/// How a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Outcome {
    /// No balls hold the items.
    Refuted,
    /// Balls hold them, as far as rounding tells.
    Held,
    /// All nodes were used up.
    Undecided,
}

/// Searches; the number of nodes beside.
pub(super) fn search<R: Room>(
    room: &mut R,
    k: usize,
    outliers: u64,
    meter: &mut Meter<'_>,
) -> Result<(Outcome, u64), Stop> {
    let n = room.len();
    let mut apart = vec![vec![0; n.div_ceil(64)]; n];
    for i in 0..n {
        for j in 0..i {
            if room.are_apart(i, j, meter)? {
                set(&mut apart[i], j);
                set(&mut apart[j], i);
            }
        }
    }
    let mut search = Search {
        apart,
        opens: (0..n).map(|item| room.open(item).is_some()).collect(),
        room,
        k,
        nodes: 0,
        groups: vec![],
        strains: vec![],
        given: vec![0; n.div_ceil(64)],
        left: outliers,
    };
    let outcome = search.node(meter)?;
    Ok((outcome, search.nodes))
}

struct Search<'a, R: Room> {
    room: &'a mut R,
    /// For each item, the items that are apart from it.
    apart: Vec<Bits>,
    /// Whether a ball of its own holds the item.
    opens: Vec<bool>,
    k: usize,
    nodes: u64,
    groups: Vec<R::Group>,
    /// For each group the strain of each item, infinite where it does not fit.
    strains: Vec<Vec<f64>>,
    /// Items of groups and those left out.
    given: Bits,
    /// How many may still be left out.
    left: u64,
}

impl<R: Room> Search<'_, R> {
    fn node(&mut self, meter: &mut Meter<'_>) -> Result<Outcome, Stop> {
        if self.nodes == NODES_MAX {
            return Ok(Outcome::Undecided);
        }
        self.nodes += 1;
        let mut open = vec![];
        for item in 0..self.room.len() {
            if !is_set(&self.given, item) && !self.is_covered(item, meter)? {
                open.push(item);
            }
        }
        if open.is_empty() {
            return Ok(Outcome::Held);
        }
        if self.is_refuted(&open, meter)? {
            return Ok(Outcome::Refuted);
        }
        let item = self.choice(&open);
        set(&mut self.given, item);
        let outcome = self.branch(item, meter);
        clear(&mut self.given, item);
        outcome
    }

    /// Whether the ball of some group holds the item.
    fn is_covered(&self, item: usize, meter: &mut Meter<'_>) -> Result<bool, Stop> {
        for group in &self.groups {
            if self.room.covers(group, item, meter)? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Whether items that fit in no group need more than is left.
    fn is_refuted(&mut self, open: &[usize], meter: &mut Meter<'_>) -> Result<bool, Stop> {
        meter.spend(2 * open.len() * (self.groups.len() + 1))?;
        let fits = |item: usize| self.strains.iter().any(|strain| strain[item] < f64::INFINITY);
        let homeless: Vec<usize> = open.iter().copied().filter(|&item| !fits(item)).collect();
        let balls = self.k - self.groups.len();
        let places = (balls as u64).saturating_add(self.left);
        let no_place = |&item: &usize| self.left == 0 && (balls == 0 || !self.opens[item]);
        if homeless.iter().any(no_place) || self.has_clique(&homeless, places, meter)? {
            return Ok(true);
        }
        Ok(balls == 1 && self.left == 0 && !self.room.fit(homeless, meter)?)
    }

    /// Whether more than so many of these items are found apart, two by two.
    fn has_clique(
        &self,
        items: &[usize],
        places: u64,
        meter: &mut Meter<'_>,
    ) -> Result<bool, Stop> {
        if items.len() as u64 <= places {
            return Ok(false);
        }
        let mut all = vec![0; self.given.len()];
        items.iter().for_each(|&item| set(&mut all, item));
        let mut rest = vec![0; all.len()];
        for &start in items {
            let (mut last, mut size) = (start, 1);
            rest.copy_from_slice(&all);
            loop {
                meter.spend(2 * rest.len())?;
                clear(&mut rest, last);
                rest.iter_mut().zip(&self.apart[last]).for_each(|(rest, apart)| *rest &= apart);
                let Some(next) = self::items(&rest).next() else { break };
                (last, size) = (next, size + 1);
            }
            if size > places {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// The item with the fewest choices.
    fn choice(&self, open: &[usize]) -> usize {
        let mut best = (usize::MAX, f64::INFINITY, 0);
        for &item in open {
            let strains = self.strains.iter().map(|strain| strain[item]);
            let (choices, strain) = strains
                .filter(|strain| *strain < f64::INFINITY)
                .fold((0, 0.0), |(choices, sum), strain| (choices + 1, sum + strain));
            // Without a group, the item that is apart from most.
            let relief = match choices {
                0 => self.apart[item].iter().map(|word| word.count_ones()).sum::<u32>().into(),
                _ => strain,
            };
            if choices < best.0 || (choices == best.0 && -relief < best.1) {
                best = (choices, -relief, item);
            }
        }
        best.2
    }

    /// Tries the item in all groups, in a new one, and left out.
    fn branch(&mut self, item: usize, meter: &mut Meter<'_>) -> Result<Outcome, Stop> {
        let mut order: Vec<usize> = (0..self.groups.len())
            .filter(|&group| self.strains[group][item] < f64::INFINITY)
            .collect();
        order.sort_by(|&a, &b| self.strains[a][item].total_cmp(&self.strains[b][item]));
        for number in order {
            let Some(undo) = self.room.grow(&mut self.groups[number], item, meter)? else {
                continue;
            };
            let strains = self.strained(number, true, meter)?;
            let before = std::mem::replace(&mut self.strains[number], strains);
            let outcome = self.node(meter)?;
            self.room.shrink(&mut self.groups[number], undo);
            self.strains[number] = before;
            if outcome != Outcome::Refuted {
                return Ok(outcome);
            }
        }
        if self.groups.len() < self.k
            && let Some(group) = self.room.open(item)
        {
            self.groups.push(group);
            let strains = self.strained(self.groups.len() - 1, false, meter)?;
            self.strains.push(strains);
            let outcome = self.node(meter)?;
            self.groups.pop();
            self.strains.pop();
            if outcome != Outcome::Refuted {
                return Ok(outcome);
            }
        }
        if self.left > 0 {
            self.left -= 1;
            let outcome = self.node(meter)?;
            self.left += 1;
            return Ok(outcome);
        }
        Ok(Outcome::Refuted)
    }

    /// The strains for a group of all items that nothing has yet; where it grew, what did not fit before does not now.
    fn strained(
        &mut self,
        number: usize,
        grew: bool,
        meter: &mut Meter<'_>,
    ) -> Result<Vec<f64>, Stop> {
        let mut strains = vec![f64::INFINITY; self.room.len()];
        for (item, strain) in strains.iter_mut().enumerate() {
            let fitted = !grew || self.strains[number][item] < f64::INFINITY;
            if fitted && !is_set(&self.given, item) {
                *strain = self.room.strain(&self.groups[number], item, meter)?;
            }
        }
        Ok(strains)
    }
}

#[cfg(test)]
mod tests {
    use taut_points::Monitor;

    use super::super::core::{Core, Pairs};
    use super::super::free::Free;
    use super::super::item::Kind;
    use super::*;

    /// Three pentagons far from each other need three balls each, while no more than two of their corners are apart.
    #[test]
    fn a_search_ends_with_its_work() {
        let corner = |i: usize| {
            let angle = std::f64::consts::TAU * (i % 5) as f64 / 5.0;
            [10.0 * (i / 5) as f64 + angle.cos(), angle.sin()]
        };
        let values: Vec<f64> = (0..15).flat_map(corner).collect();
        let core = Core::of(&values, 2, Kind::Points, 0.6);
        let monitor = Monitor::silent();
        let pairs = Pairs::of(&core, &mut Meter::endless(&monitor)).unwrap();
        let searched = |most| {
            let mut meter = Meter::of(&monitor, most);
            search(&mut Free::of(&core, &pairs), 8, 0, &mut meter)
        };
        assert_eq!(searched(1000), Err(Stop::Spent(1000)));
        assert!(matches!(searched(STEPS_MAX), Ok((Outcome::Refuted, 11..))));
    }
}
