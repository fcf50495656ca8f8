//! The simplices around one site after the other.

use crate::simplex::{Slots, decode};

/// Room of the table of a star of no unusual size: four times the simplices around a site of a volume.
const TABLE_MIN: usize = 128;

/// In the table: nothing is here. No simplex and no site has this number.
const VACANT: u32 = u32::MAX;

/// A set of numbers below `u32::MAX`, which keep the order in which they came.
///
/// *Idea.* A table of open addresses that is used again and again: making a hash set of the standard library for each site costs
/// several times what is done with it.
pub(super) struct NumberSet {
    numbers: Vec<u32>,
    /// A power of two of places, at most half of them taken.
    table: Vec<u32>,
}

impl NumberSet {
    pub(super) fn new() -> Self {
        Self { numbers: Vec::new(), table: vec![VACANT; TABLE_MIN] }
    }

    pub(super) fn clear(&mut self) {
        self.numbers.clear();
        self.table.truncate(TABLE_MIN);
        self.table.fill(VACANT);
    }

    /// Adds a number; false if it is there.
    #[inline]
    pub(super) fn insert(&mut self, number: u32) -> bool {
        let place = self.place(number);
        if self.table[place] == number {
            return false;
        }
        self.table[place] = number;
        self.numbers.push(number);
        if 2 * self.numbers.len() > self.table.len() {
            self.grow();
        }
        true
    }

    #[cold]
    fn grow(&mut self) {
        self.table = vec![VACANT; 2 * self.table.len()];
        for k in 0..self.numbers.len() {
            let place = self.place(self.numbers[k]);
            self.table[place] = self.numbers[k];
        }
    }

    /// Where a number is in the table, or would be.
    #[inline]
    fn place(&self, number: u32) -> usize {
        /// 2⁶⁴ over the golden ratio: numbers close together are sent far apart.
        const SPREAD: u64 = 0x9E37_79B9_7F4A_7C15;
        let mask = self.table.len() - 1;
        let mut place = (u64::from(number).wrapping_mul(SPREAD) >> 32) as usize & mask;
        while self.table[place] != VACANT && self.table[place] != number {
            place = (place + 1) & mask;
        }
        place
    }
}

/// Collects the simplices around sites.
pub(super) struct Star(NumberSet);

impl Star {
    pub(super) fn new() -> Self {
        Self(NumberSet::new())
    }

    /// The simplices at `site`, ghosts too, of which `first` is one.
    pub(super) fn of<const V: usize>(&mut self, slots: &Slots<V>, first: u32, site: u32) -> &[u32] {
        let Star(star) = self;
        star.clear();
        star.insert(first);
        let mut next = 0;
        while next < star.numbers.len() {
            let simplex = &slots[star.numbers[next] as usize];
            for i in 0..V {
                if simplex.vertices[i] != site {
                    star.insert(decode(simplex.neighbors[i]).0);
                }
            }
            next += 1;
        }
        &star.numbers
    }
}

#[cfg(test)]
mod tests {
    use taut_points::Points;

    use super::*;
    use crate::query::locator::star_of;
    use crate::{DelaunayOptions, Space};

    /// Stars of a few simplices, of thousands, and of a few again.
    #[test]
    fn stars_are_those_of_the_hash_set() {
        let mut values = vec![0.0, 0.0, 0.0];
        let on_sphere = crate::test_length::long_or(3000, 650);
        values.extend((0..on_sphere).flat_map(|i| {
            let angle = 0.1 + f64::from(i) * 2.399963;
            let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(on_sphere);
            let r = (1.0 - z * z).sqrt();
            [r * angle.cos(), r * angle.sin(), z]
        }));
        let points = Points::new(&values, 3).expect("whole rows");
        let space = Space::build(&points, &DelaunayOptions::default()).expect("finite");
        let (slots, mut star, mut expected) = (space.slots(), Star::new(), Vec::new());
        let mut largest = 0;
        for t in space.simplices() {
            for site in space.vertices(t) {
                star_of(slots, t, site, &mut expected);
                assert_eq!(star.of(slots, t, site), expected);
                largest = largest.max(expected.len());
            }
        }
        assert!(largest > on_sphere as usize, "{largest}");
    }
}
