//! Which pairs of items fit in no ball, in bits, and greedy cliques of them.
//!
//! *Idea.* A clique that takes items in order is what is left of the rows of its members, one of which after the other is intersected:
//! n²/2 pairs are compared once, where cliques from n items in turn compare each with up to k others.

/// A bit for each pair of items.
pub(super) struct ApartPairs {
    /// Of the bits of a row.
    words: usize,
    rows: Vec<u64>,
}

impl ApartPairs {
    /// The pairs of `count` items of which `are_apart` is true.
    pub(super) fn of(count: usize, are_apart: impl Fn(u32, u32) -> bool) -> Self {
        let words = count.div_ceil(64);
        let mut rows = vec![0u64; count * words];
        for a in 0..count {
            for b in 0..a {
                if are_apart(a as u32, b as u32) {
                    rows[a * words + b / 64] |= 1 << (b % 64);
                    rows[b * words + a / 64] |= 1 << (a % 64);
                }
            }
        }
        ApartPairs { words, rows }
    }

    /// The largest of greedy cliques from all items in turn, the first of several; the search ends with one of more than `enough`.
    pub(super) fn large_clique(&self, enough: usize) -> Vec<u32> {
        let (mut clique, mut trial, mut left) = (vec![], vec![], vec![0; self.words]);
        let count = self.rows.len() / self.words.max(1);
        for start in 0..count as u32 {
            self.greedy_clique(start, enough, &mut left, &mut trial);
            if trial.len() > clique.len() {
                std::mem::swap(&mut clique, &mut trial);
            }
            if clique.len() > enough {
                break;
            }
        }
        clique
    }

    /// Items no two of which fit in a ball, taken in order after `start`; ends with more than `enough`.
    fn greedy_clique(&self, start: u32, enough: usize, left: &mut [u64], clique: &mut Vec<u32>) {
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
            // Its own bit is not in its row.
            left.iter_mut().zip(self.row(next)).skip(word).for_each(|(bits, more)| *bits &= more);
        }
    }

    fn row(&self, item: u32) -> &[u64] {
        let from = item as usize * self.words;
        &self.rows[from..from + self.words]
    }
}

#[cfg(test)]
mod tests {
    use super::ApartPairs;

    /// The same by a look at each pair.
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
            [(0, 50), (1, 50), (2, 100), (63, 70), (64, 30), (65, 50), (200, 80)]
        {
            let are_apart = |a: u32, b: u32| {
                let (a, b) = (u64::from(a.max(b)), u64::from(a.min(b)));
                let mixed = (a * 1009 + b).wrapping_mul(0x9e37_79b9_7f4a_7c15);
                a != b && (mixed >> 40) % 100 < percent
            };
            let pairs = ApartPairs::of(count as usize, are_apart);
            for enough in [0, 3, 1000] {
                let clique = pairs.large_clique(enough);
                assert_eq!(clique, slow_clique(count, enough, are_apart), "{count}, {enough}");
                sizes.insert(clique.len());
            }
        }
        assert!(sizes.len() > 5, "{sizes:?}");
    }
}
