//! Sets that grow together.
//!
//! *Problem.* Things 0…n−1, each a set of its own at first; join two sets, and ask for the set of a thing.
//! *Idea.* Each set is a tree whose root is its least thing; every walk to the root halves the way.
//! *Guarantee.* O(log n) for each step, taken over all steps; the root does not depend on the order of the joins.
//! *Reference.* Tarjan, van Leeuwen, J. ACM 31(2), 1984: linking by index with halving.

/// Disjoint sets of the numbers below n; for each number whether it differs from its root, where somebody cares.
pub(crate) struct UnionFind {
    /// The thing above, shifted by one, and in the lowest bit whether the two differ.
    above: Vec<u64>,
}

impl UnionFind {
    pub(crate) fn new(n: usize) -> Self {
        Self { above: (0..n as u64).map(|thing| thing << 1).collect() }
    }

    /// The least thing of the set, and whether `thing` differs from it.
    pub(crate) fn find(&mut self, thing: u32) -> (u32, bool) {
        let (mut at, mut differs) = (u64::from(thing), 0);
        loop {
            let up = self.above[at as usize];
            if up >> 1 == at {
                return (at as u32, differs == 1);
            }
            // Two steps become one.
            let far = self.above[(up >> 1) as usize] ^ (up & 1);
            self.above[at as usize] = far;
            (at, differs) = (far >> 1, differs ^ (far & 1));
        }
    }

    /// The least thing of the set.
    pub(crate) fn root(&mut self, thing: u32) -> u32 {
        self.find(thing).0
    }

    /// Joins two sets such that the two things differ or not. False if they are of one set already and it is the other way.
    pub(crate) fn join(&mut self, one: u32, other: u32, differ: bool) -> bool {
        let ((one, a), (other, b)) = (self.find(one), self.find(other));
        let differ = differ ^ a ^ b;
        if one == other {
            return !differ;
        }
        let (low, high) = (one.min(other), one.max(other));
        self.above[high as usize] = u64::from(low) << 1 | u64::from(differ);
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_add_up() {
        let mut sets = UnionFind::new(6);
        assert!(sets.join(5, 3, true) && sets.join(3, 4, true) && sets.join(4, 1, false));
        assert_eq!((sets.find(5), sets.find(3)), ((1, false), (1, true)));
        assert_eq!((sets.find(4), sets.find(1)), ((1, false), (1, false)));
        assert!(sets.join(5, 1, false) && !sets.join(5, 1, true));
        assert_eq!((sets.root(0), sets.root(2)), (0, 2));
    }
}
