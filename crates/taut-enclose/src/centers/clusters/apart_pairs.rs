//! Greedy cliques of items no two of which fit in one ball, over rows of bits.
//!
//! *Idea.* A greedy clique takes the first item that is apart from all of its members: the first bit of the intersection of their rows. A
//! row is determined when it is first used, from those of others as far as they are known, so that cliques from n items in turn compare
//! n²/2 pairs, where each would compare every item with up to k others; and a first clique that suffices compares few.

/// Rows of bits: whether an item is apart from each other one.
pub(super) struct ApartPairs<F> {
    are_apart: F,
    count: usize,
    /// Number of words of a row.
    words: usize,
    rows: Vec<u64>,
    is_known: Vec<bool>,
}

impl<F: Fn(u32, u32) -> bool> ApartPairs<F> {
    /// Rows of `count` items, none of which is known; `are_apart` is symmetric.
    pub(super) fn new(count: usize, are_apart: F) -> Self {
        let words = count.div_ceil(64);
        let (rows, is_known) = (vec![0; count * words], vec![false; count]);
        ApartPairs { are_apart, count, words, rows, is_known }
    }

    /// The largest of greedy cliques from all items in turn, the first of several; the search ends with one of more than `enough`.
    pub(super) fn large_clique(&mut self, enough: usize) -> Vec<u32> {
        let (mut clique, mut trial, mut left) = (vec![], vec![], vec![0; self.words]);
        for start in 0..self.count as u32 {
            self.greedy_clique(start, enough, &mut left, &mut trial);
            if trial.len() > clique.len() {
                std::mem::swap(&mut clique, &mut trial);
            }
            if clique.len() > enough || clique.len() == self.count {
                break;
            }
        }
        clique
    }

    /// Items no two of which fit in a ball, taken in order after `start`; ends with more than `enough`.
    fn greedy_clique(
        &mut self,
        start: u32,
        enough: usize,
        left: &mut [u64],
        clique: &mut Vec<u32>,
    ) {
        clique.clear();
        clique.push(start);
        left.copy_from_slice(self.row(start));
        let mut word = 0;
        while clique.len() <= enough
            && let Some(step) = left[word..].iter().position(|&bits| bits != 0)
        {
            word += step;
            let next = word as u32 * 64 + left[word].trailing_zeros();
            clique.push(next);
            // An item is not apart from itself, so this takes it out of what is left.
            left.iter_mut().zip(self.row(next)).skip(word).for_each(|(bits, more)| *bits &= more);
        }
    }

    fn row(&mut self, item: u32) -> &[u64] {
        let at = item as usize;
        if !std::mem::replace(&mut self.is_known[at], true) {
            for other in (0..self.count).filter(|&other| other != at) {
                let is_apart = match self.is_known[other] {
                    true => self.rows[other * self.words + at / 64] >> (at % 64) & 1 == 1,
                    false => (self.are_apart)(item, other as u32),
                };
                self.rows[at * self.words + other / 64] |= u64::from(is_apart) << (other % 64);
            }
        }
        &self.rows[at * self.words..(at + 1) * self.words]
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::ApartPairs;

    /// Greedy cliques by a look at each pair.
    fn slow_clique(count: u32, enough: usize, are_apart: impl Fn(u32, u32) -> bool) -> Vec<u32> {
        let mut best = vec![];
        for start in 0..count {
            let mut clique = vec![start];
            for next in (0..count).filter(|&next| next != start) {
                let fits = clique.iter().all(|&member| are_apart(member, next));
                if fits && clique.len() <= enough {
                    clique.push(next);
                }
            }
            if clique.len() > best.len() {
                best = clique;
            }
            if best.len() > enough {
                break;
            }
        }
        best
    }

    #[test]
    fn cliques_are_those_of_a_look_at_each_pair() {
        let mut sizes = std::collections::BTreeSet::new();
        for (count, percent) in
            [(0u32, 50), (1, 50), (2, 100), (63, 70), (64, 30), (65, 50), (200, 80)]
        {
            let are_apart = |a: u32, b: u32| {
                let (a, b) = (u64::from(a.max(b)), u64::from(a.min(b)));
                let mixed = (a * 1009 + b).wrapping_mul(0x9e37_79b9_7f4a_7c15);
                a != b && (mixed >> 40) % 100 < percent
            };
            for enough in [0, 3, 1000] {
                let asked = Cell::new(0);
                let counted = |a, b| {
                    asked.set(asked.get() + 1);
                    are_apart(a, b)
                };
                let clique = ApartPairs::new(count as usize, counted).large_clique(enough);
                if enough == 0 {
                    assert!(asked.get() <= count, "{count}");
                }
                assert!(asked.get() <= count * count.saturating_sub(1) / 2, "{count}");
                assert_eq!(clique, slow_clique(count, enough, are_apart), "{count}, {enough}");
                sizes.insert(clique.len());
            }
        }
        assert!(sizes.len() > 5, "{sizes:?}");
    }
}
