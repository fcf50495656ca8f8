//! Groups of numbers that are joined two by two (union–find): each number leads to a lower one of its group, the lowest to itself.

/// The lowest number of the group of `at`; ways to it are halved.
pub(crate) fn root(groups: &mut [u32], mut at: u32) -> u32 {
    while groups[at as usize] != at {
        groups[at as usize] = groups[groups[at as usize] as usize];
        at = groups[at as usize];
    }
    at
}

/// Makes one group of the groups of two numbers.
pub(crate) fn join(groups: &mut [u32], a: u32, b: u32) {
    let (a, b) = (root(groups, a), root(groups, b));
    groups[a.max(b) as usize] = a.min(b);
}
