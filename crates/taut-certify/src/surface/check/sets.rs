//! Disjoint sets that are joined, each member turned or not against the least one.
//!
//! *Reference.* Tarjan, J. ACM 22(2), 1975; the parity along the path is that of Harary's balanced graphs, 1953.

/// Sets of 0..n.
pub(super) struct Sets {
    /// The parent, times two, plus whether the member is turned against it.
    parents: Vec<u64>,
}

impl Sets {
    pub(super) fn new(n: usize) -> Self {
        Sets { parents: (0..n as u64).map(|member| 2 * member).collect() }
    }

    /// The least member of a set, and whether this one is turned against it.
    pub(super) fn root(&mut self, member: u32) -> (u32, bool) {
        let (mut at, mut turned) = (member, false);
        loop {
            let link = self.parents[at as usize];
            let parent = (link / 2) as u32;
            if parent == at {
                return (at, turned);
            }
            // Half the path: each member is hung below its grandparent.
            let above = self.parents[parent as usize];
            let shorter = (above & !1) | ((link ^ above) & 1);
            self.parents[at as usize] = shorter;
            turned ^= shorter & 1 == 1;
            at = (shorter / 2) as u32;
        }
    }

    /// Joins two sets such that the members are turned against each other or not. False if they are in one set and it is the other
    /// way there.
    pub(super) fn join(&mut self, one: u32, other: u32, turned: bool) -> bool {
        let ((a, a_turned), (b, b_turned)) = (self.root(one), self.root(other));
        let link = a_turned ^ b_turned ^ turned;
        if a != b {
            let (least, most) = (a.min(b), a.max(b));
            self.parents[most as usize] = 2 * u64::from(least) + u64::from(link);
        }
        a != b || !link
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_add_up_along_a_cycle() {
        for (last, fits) in [(true, false), (false, true)] {
            let mut sets = Sets::new(5);
            assert!(sets.join(4, 3, true) && sets.join(3, 1, true) && sets.join(2, 1, false));
            assert_eq!(sets.join(2, 4, last), fits);
            assert_eq!(
                (sets.root(4), sets.root(3), sets.root(0)),
                ((1, false), (1, true), (0, false))
            );
        }
    }
}
