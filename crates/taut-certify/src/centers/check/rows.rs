//! Balls with their centers at rows of the input: which items each row is near enough to.
//!
//! *Idea.* A row is as good a center as the set of items less than ρ from it. One more pass over the rows finds these
//! sets; rows with the same set are one place. A cluster of items is held by a ball just when some place is near to all of
//! them, which is the intersection of sets of places, one for each item.
//! *Guarantee.* Whether an item is less than ρ from a row is decided exactly.
//! *Cost.* O(n·|X|·d) for n rows and |X| items, and |X| bits for each place, of which there are at most n: [`SET_BYTES_MAX`] bytes
//! are granted.

use std::collections::HashSet;
use std::sync::{Mutex, PoisonError};

use taut_points::{Cancelled, Monitor, PointSource, PointsHash};

use super::super::CentersViolation;
use super::core::{Bits, Core, items, set};
use super::item::Layout;
use super::meter::Meter;
use super::oracle::Oracle;
use crate::CheckError;
use crate::hashed_pass::{WantedRows, hashed_pass};

/// The sets of all places take at most this many bytes.
const SET_BYTES_MAX: u64 = 1 << 30;

/// The number of bits kept for each pair of a place and an item: by place, by item, and in the clusters and what is kept to undo them, as
/// each item begins a cluster or narrows one.
const SETS_PER_PLACE: u64 = 3;

/// A place takes this many bytes beside its bits.
const PLACE_BYTES: u64 = 64;

/// Places at rows, for one core-set.
pub(super) struct Places {
    /// For each item, the places near to it.
    near: Vec<Bits>,
}

impl Places {
    /// Reads all rows once.
    pub(super) fn of(
        core: &Core,
        layout: Layout,
        claimed: PointsHash,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<Self, CheckError> {
        let words = core.len().div_ceil(64);
        let sets: Mutex<HashSet<Bits>> = Mutex::default();
        hashed_pass(source, claimed, WantedRows::none(), monitor, |_, rows| {
            let mut found = HashSet::new();
            let (mut row, mut meter) = (vec![0.0; source.dim()], Meter::of(monitor));
            for number in 0..rows.len() {
                rows.copy_row(number, &mut row);
                let item = layout.of_item(&row);
                let center = layout.kind.item(&item).position;
                let mut near = vec![0; words];
                for item in 0..core.len() {
                    if !core.is_out_of_reach(item, center, &mut meter)? {
                        set(&mut near, item);
                    }
                }
                if near.iter().any(|&word| word != 0) {
                    found.insert(near);
                }
            }
            // The order of the sets means nothing.
            let mut sets = sets.lock().unwrap_or_else(PoisonError::into_inner);
            sets.extend(found);
            match (SETS_PER_PLACE * 8 * words as u64 + PLACE_BYTES) * sets.len() as u64
                > SET_BYTES_MAX
            {
                true => Err(CheckError::from(CentersViolation::Memory { most: SET_BYTES_MAX })),
                false => Ok(()),
            }
        })?;
        let sets = sets.into_inner().unwrap_or_else(PoisonError::into_inner);
        let mut near = vec![vec![0; sets.len().div_ceil(64)]; core.len()];
        for (place, of_place) in sets.iter().enumerate() {
            items(of_place).for_each(|item| set(&mut near[item], place));
        }
        Ok(Places { near })
    }

    /// Tests whether no place is near to both.
    pub(super) fn are_apart(
        &self,
        i: usize,
        j: usize,
        meter: &mut Meter<'_>,
    ) -> Result<bool, Cancelled> {
        meter.spend(self.near[i].len())?;
        Ok(self.near[i].iter().zip(&self.near[j]).all(|(a, b)| a & b == 0))
    }
}

/// The places that are near to all items of a cluster.
impl Oracle for &Places {
    type Cluster = Bits;
    type Undo = Bits;

    fn len(&self) -> usize {
        self.near.len()
    }

    fn open(&mut self, item: usize) -> Option<Bits> {
        self.near[item].iter().any(|&word| word != 0).then(|| self.near[item].clone())
    }

    fn grow(
        &mut self,
        cluster: &mut Bits,
        item: usize,
        meter: &mut Meter<'_>,
    ) -> Result<Option<Bits>, Cancelled> {
        meter.spend(2 * cluster.len())?;
        let both: Bits = cluster.iter().zip(&self.near[item]).map(|(a, b)| a & b).collect();
        let is_held = both.iter().any(|&word| word != 0);
        Ok(is_held.then(|| std::mem::replace(cluster, both)))
    }

    fn undo(&self, cluster: &mut Bits, before: Bits) {
        *cluster = before;
    }

    /// Proofs for centers among the rows do not ask.
    fn is_held_out(&self, _: &Bits, _: &[usize], _: &mut Meter<'_>) -> Result<bool, Cancelled> {
        Ok(false)
    }

    fn undo_bytes(before: &Bits) -> usize {
        size_of_val(&before[..])
    }
}
