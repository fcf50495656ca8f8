//! The simplices around one site after the other.

use crate::simplex::{Slots, decode};

/// Room of the table of a star of no unusual size: four times the simplices around a site of a volume.
const TABLE_MIN: usize = 128;

/// In the table: nothing is here. No simplex has this number.
const VACANT: u32 = u32::MAX;

/// Collects the simplices around sites.
///
/// *Idea.* Which simplices were seen is in a table of open addresses that lives as long as this: a hash set of the standard library for
/// each site costs several times the walk around it.
pub(super) struct Star {
    simplices: Vec<u32>,
    /// A power of two of places, at most half of them taken.
    table: Vec<u32>,
}

impl Star {
    pub(super) fn new() -> Self {
        Self { simplices: Vec::new(), table: vec![VACANT; TABLE_MIN] }
    }

    /// The simplices at `site`, ghosts too, of which `first` is one.
    pub(super) fn of<const V: usize>(
        &mut self,
        slots: &Slots<V>,
        first: u32,
        site: u32,
    ) -> &[u32] {
        self.simplices.clear();
        self.table.truncate(TABLE_MIN);
        self.table.fill(VACANT);
        self.add(first);
        let mut next = 0;
        while next < self.simplices.len() {
            let simplex = &slots[self.simplices[next] as usize];
            for i in 0..V {
                if simplex.vertices[i] != site {
                    self.add(decode(simplex.neighbors[i]).0);
                }
            }
            next += 1;
        }
        &self.simplices
    }

    /// Adds a simplex that is not there.
    #[inline]
    fn add(&mut self, simplex: u32) {
        let place = self.place(simplex);
        if self.table[place] == simplex {
            return;
        }
        self.table[place] = simplex;
        self.simplices.push(simplex);
        if 2 * self.simplices.len() > self.table.len() {
            self.table = vec![VACANT; 2 * self.table.len()];
            for k in 0..self.simplices.len() {
                let place = self.place(self.simplices[k]);
                self.table[place] = self.simplices[k];
            }
        }
    }

    /// Where a simplex is in the table, or would be.
    #[inline]
    fn place(&self, simplex: u32) -> usize {
        /// 2⁶⁴ over the golden ratio: numbers close together are sent far apart.
        const SPREAD: u64 = 0x9E37_79B9_7F4A_7C15;
        let mask = self.table.len() - 1;
        let mut place = (u64::from(simplex).wrapping_mul(SPREAD) >> 32) as usize & mask;
        while self.table[place] != VACANT && self.table[place] != simplex {
            place = (place + 1) & mask;
        }
        place
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
        values.extend((0..3000).flat_map(|i| {
            let angle = 0.1 + f64::from(i) * 2.399963;
            let z = 1.0 - (f64::from(i) + 0.5) / 1500.0;
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
        assert!(largest > 5000, "{largest}");
    }
}
