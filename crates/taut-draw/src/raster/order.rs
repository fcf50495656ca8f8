//! An order in which things can be painted one over the other.
//!
//! *Idea.* What lies behind another thing somewhere comes before it; among those that could come next, the farthest does.
//! *Trap.* Things can lie behind each other in a ring: then there is no order.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The places of `depths`, from back to front, such that of each pair in `behind` the first comes first; `None` if that cannot be.
/// Depths are above 0 and rise towards the eye. `behind` is sorted.
pub(crate) fn order(depths: &[f64], behind: &[[u32; 2]]) -> Option<Vec<usize>> {
    let mut waits_for = vec![0_usize; depths.len()];
    for &[_, front] in behind {
        waits_for[front as usize] += 1;
    }
    // Depths above 0 order as their bits do.
    let entry = |i: usize| Reverse((depths[i].to_bits(), i));
    let free = (0..depths.len()).filter(|&i| waits_for[i] == 0);
    let mut ready: BinaryHeap<_> = free.map(entry).collect();
    let mut order = Vec::with_capacity(depths.len());
    while let Some(Reverse((_, next))) = ready.pop() {
        order.push(next);
        let first = behind.partition_point(|pair| (pair[0] as usize) < next);
        for &[_, front] in behind[first..].iter().take_while(|pair| pair[0] as usize == next) {
            waits_for[front as usize] -= 1;
            if waits_for[front as usize] == 0 {
                ready.push(entry(front as usize));
            }
        }
    }
    (order.len() == depths.len()).then_some(order)
}

#[cfg(test)]
mod tests {
    use super::order;

    #[test]
    fn depth_decides_unless_something_is_behind() {
        assert_eq!(order(&[3.0, 1.0, 2.0], &[]), Some(vec![1, 2, 0]));
        assert_eq!(order(&[3.0, 1.0, 2.0], &[[0, 1], [2, 1]]), Some(vec![2, 0, 1]));
        assert_eq!(order(&[1.0, 1.0], &[]), Some(vec![0, 1]));
        assert_eq!(order(&[], &[]), Some(vec![]));
    }

    #[test]
    fn a_ring_has_no_order() {
        assert_eq!(order(&[1.0, 2.0, 3.0], &[[0, 1], [1, 2], [2, 0]]), None);
    }
}
