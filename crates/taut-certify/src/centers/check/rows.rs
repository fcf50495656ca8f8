//! Balls with their centres at rows of the input: which items each row is near enough to.
//!
//! *Idea.* A row is as good a centre as the set of items less than ρ from it. One more pass over the rows finds these
//! sets; rows with the same set are one place. A group of items is held by a ball just when some place is near to all of
//! them, which is the intersection of sets of places, one for each item.
//! *Guarantee.* Whether an item is less than ρ from a row is decided exactly.
//! *Cost.* O(n·|X|·d) for n rows and |X| items, and |X| bits for each place, of which there are at most n: [`MEMORY`] bytes
//! are granted.

use std::collections::HashSet;

use taut_points::{Monitor, PointSource, map_blocks};

use super::super::CentersViolation;
use super::core::{Bits, Core, is_set, set};
use super::item::Kind;
use super::room::Room;
use crate::CheckError;

/// Most bytes for the sets of all places, as they are found and as they are kept.
const MEMORY: u64 = 1 << 30;

/// Places at rows, for one core-set.
pub(super) struct Places {
    /// For each place, the items near to it; no two alike, in a fixed order.
    pub(super) sets: Vec<Bits>,
    /// For each item, the places near to it.
    near: Vec<Bits>,
    /// For each item, the items that no place is near to both of; all items where no place is near to it alone.
    apart: Vec<Bits>,
}

impl Places {
    /// Reads all rows once.
    pub(super) fn of(
        core: &Core,
        kind: Kind,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<Self, CheckError> {
        let words = core.len().div_ceil(64);
        let blocks = map_blocks(source, monitor, |_, rows| {
            let mut found = HashSet::new();
            let mut row = vec![0.0; source.dim()];
            for number in 0..rows.len() {
                rows.copy_row(number, &mut row);
                let center = kind.item(&row).position;
                let mut near = vec![0; words];
                for item in (0..core.len()).filter(|&item| !core.is_out_of_reach(item, center)) {
                    set(&mut near, item);
                }
                if near.iter().any(|&word| word != 0) {
                    found.insert(near);
                }
            }
            Ok::<_, CheckError>(found)
        })?;
        let mut sets: HashSet<Bits> = HashSet::new();
        for block in blocks {
            sets.extend(block);
            // What is found is kept once by row and once by column.
            let needed = 2 * 8 * words as u64 * sets.len() as u64;
            if needed > MEMORY {
                let violation = CentersViolation::Memory { needed, most: MEMORY };
                return Err(violation.into());
            }
        }
        let mut sets: Vec<Bits> = sets.into_iter().collect();
        sets.sort_unstable();
        Ok(Places::of_sets(sets, core.len()))
    }

    fn of_sets(sets: Vec<Bits>, items: usize) -> Self {
        let mut near = vec![vec![0; sets.len().div_ceil(64)]; items];
        for (place, of_place) in sets.iter().enumerate() {
            for item in super::core::items(of_place) {
                set(&mut near[item], place);
            }
        }
        let mut apart = vec![vec![!0; items.div_ceil(64)]; items];
        for i in 0..items {
            for j in 0..items {
                if near[i].iter().zip(&near[j]).any(|(a, b)| a & b != 0) {
                    super::core::clear(&mut apart[i], j);
                }
            }
            mask(&mut apart[i], items);
        }
        Places { sets, near, apart }
    }

    pub(super) fn are_apart(&self, i: usize, j: usize) -> bool {
        is_set(&self.apart[i], j)
    }
}

/// Clears the bits beyond the last item.
fn mask(bits: &mut [u64], items: usize) {
    if let Some(last) = bits.last_mut().filter(|_| !items.is_multiple_of(64)) {
        *last &= (1 << (items % 64)) - 1;
    }
}

/// The places that are near to all items of a group.
impl Room for &Places {
    type Group = Bits;

    fn len(&self) -> usize {
        self.near.len()
    }

    fn apart(&self, item: usize) -> &[u64] {
        &self.apart[item]
    }

    fn open(&mut self, item: usize) -> Option<Bits> {
        self.near[item].iter().any(|&word| word != 0).then(|| self.near[item].clone())
    }

    fn with(&mut self, group: &Bits, item: usize) -> Option<Bits> {
        let both: Bits = group.iter().zip(&self.near[item]).map(|(a, b)| a & b).collect();
        both.iter().any(|&word| word != 0).then_some(both)
    }

    fn strain(&mut self, group: &Bits, item: usize) -> f64 {
        let mut counts = [0, 0];
        for (group, near) in group.iter().zip(&self.near[item]) {
            counts[0] += (group & near).count_ones();
            counts[1] += (group & !near).count_ones();
        }
        if counts[0] == 0 { f64::INFINITY } else { counts[1].into() }
    }

    fn covers(&self, group: &Bits, item: usize) -> bool {
        super::core::items(group).next().is_some_and(|place| is_set(&self.near[item], place))
    }
}
