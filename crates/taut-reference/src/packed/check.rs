//! The checker of a packed map: order, counts, separators and densities, told from the arrays alone.

use super::density::{LEAF_MIN, LEAF_SLOTS};
use super::map::PackedMap;
use crate::{Key, Word};

/// The density of the windows of one level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Density {
    /// Leaves of a whole window.
    pub leaves: usize,
    /// The smallest share of full slots of a window of this level.
    pub min: f64,
    /// The largest.
    pub max: f64,
    /// The share from which on a window of this level is too empty to be spread by itself.
    pub bound_min: f64,
    /// The share up to which it can be spread by itself.
    pub bound_max: f64,
}

/// An inconsistency of a packed map: always a mistake of this crate, as no use can bring it about.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("leaf {leaf} {reason}")]
pub struct Violation {
    /// The leaf where it shows.
    pub leaf: usize,
    /// The reason.
    pub reason: &'static str,
}

impl<K: Key, V: Copy + Default> PackedMap<K, V> {
    /// Checks all that is promised and returns how full the windows are, by level from the leaves to the whole array.
    ///
    /// Checked are the ascending order of all keys; that they are in the leaf where they are looked for; that all leaves
    /// but the last hold 8 to 64 entries; and that the array is at most 3/4 full, and without its last leaf at least 3/8.
    /// Windows between a leaf and the whole may be outside their bounds until a leaf next overflows. O(n).
    ///
    /// # Errors
    /// The first leaf where any of it is not so.
    pub fn check(&self) -> Result<Vec<Density>, Violation> {
        let windows = self.windows();
        let leaves = self.counts.len();
        let wrong = |leaf, reason| Err(Violation { leaf, reason });
        let mut before: Option<K::Word> = None;
        for (leaf, &count) in self.counts.iter().enumerate() {
            let count = count as usize;
            if count > LEAF_SLOTS || (leaf + 1 < leaves && count < LEAF_MIN) {
                return wrong(leaf, "has too many or too few entries");
            }
            if leaf + 1 == leaves && leaf > 0 && count == 0 {
                return wrong(leaf, "is in use and empty");
            }
            let separator = self.separators.get(leaf);
            if separator.is_some_and(|separator| before.is_some_and(|word| word >= separator)) {
                return wrong(leaf, "has a separator that is not above the leaf before it");
            }
            for (place, key) in self.keys.words()[leaf * LEAF_SLOTS..][..count].iter().enumerate() {
                let word = key.word();
                if before.is_some_and(|before| before >= word) {
                    return wrong(leaf, "has keys that do not ascend");
                }
                if separator.is_some_and(|separator| word < separator) {
                    return wrong(leaf, "has a key below its separator");
                }
                if self.find(word, &mut crate::NoProbe) != (leaf, place) {
                    return wrong(leaf, "has a key that is looked for elsewhere");
                }
                before = Some(word);
            }
        }
        for leaf in leaves..self.separators.room() {
            if self.separators.get(leaf) != Some(K::Word::MAX) {
                return wrong(leaf, "is not in use and has a separator");
            }
        }
        let len = self.entries(&(0..leaves));
        if len != self.len {
            return wrong(0, "and all others have not as many entries as counted");
        }
        if len > windows.most_of_all() || len < windows.fewest_of_all() {
            return wrong(0, "and all others are too full or too empty");
        }
        let share = |entries: usize, leaves: usize| entries as f64 / (leaves * LEAF_SLOTS) as f64;
        let level = |level: u32| {
            let all = (0..leaves).step_by(1 << level).map(|leaf| windows.around(leaf, level));
            let shares = all.map(|window| share(self.entries(&window), window.len()));
            let (min, max) = shares
                .fold((f64::INFINITY, 0.0), |(min, max): (f64, f64), s| (min.min(s), max.max(s)));
            let whole = 1 << level;
            Density {
                leaves: whole,
                min,
                max,
                bound_min: share(windows.fewest(whole, level), whole),
                bound_max: share(windows.most(whole, level), whole),
            }
        };
        Ok((0..=windows.height()).map(level).collect())
    }
}
