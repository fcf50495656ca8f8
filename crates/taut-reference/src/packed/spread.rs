//! Computes how many entries each leaf of a window gets when the window is spread.
//!
//! Evenly, as the thesis has it; or, where insertions hammer one place, with the room where they will come. Of the two
//! halves of a window the one without the place is then filled as far as its bound allows, and the other one is split
//! again. Insertions that all go to one place so cost O(log n) moves each instead of O(log² n).
//! Reference: M. A. Bender and H. Hu, An adaptive packed-memory array, ACM Trans. Database Syst. 32(4), 2007; here the
//! place is that of a run of insertions into one leaf, and no history is kept.

use super::density::{LEAF_MIN, LEAF_SLOTS, Windows};

/// Sets how many of `len` entries each of `counts`, one leaf or more, gets: as even as can be.
pub(super) fn even(counts: &mut [u32], len: usize) {
    let leaves = counts.len();
    let (each, more) = (len / leaves, len % leaves);
    for (leaf, count) in counts.iter_mut().enumerate() {
        *count = (each + usize::from(leaf < more)) as u32;
    }
}

/// Sets the counts of a window of a level so that there is room where the next entry comes after `before` others.
///
/// No leaf is full, or has fewer entries than it may; `len` allows that.
pub(super) fn around(counts: &mut [u32], len: usize, before: usize, windows: Windows, level: u32) {
    let leaves = counts.len();
    let half = 1 << level.saturating_sub(1);
    if leaves == 1 || level == 0 {
        even(counts, len);
        return;
    }
    if half >= leaves {
        around(counts, len, before, windows, level - 1);
        return;
    }
    let (left, right) = counts.split_at_mut(half);
    let bounds = |leaves: usize| {
        let most = windows.most(leaves, level - 1).min(leaves * (LEAF_SLOTS - 1));
        (leaves * LEAF_MIN, most)
    };
    let ((left_min, left_max), (right_min, right_max)) = (bounds(left.len()), bounds(right.len()));
    // The most that the left half can have.
    let (low, high) = (left_min.max(len.saturating_sub(right_max)), left_max.min(len - right_min));
    if low > high {
        even(counts, len);
        return;
    }
    // The place in the left half, which then has as few as can be; or in the right half, and the left has many.
    let few = low.max(before);
    let many = high.min(before);
    let in_left = few <= high;
    let in_right = many >= low;
    let emptier_left = few * right.len() <= (len - many) * left.len();
    if in_left && (emptier_left || !in_right) {
        around(left, few, before, windows, level - 1);
        even(right, len - few);
    } else if in_right {
        even(left, many);
        around(right, len - many, before - many, windows, level - 1);
    } else {
        even(counts, len);
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(if cfg!(miri) { 4 } else { 256 }))]
        /// All entries are placed, no leaf is full or too empty, and the leaf of the place is among the emptiest.
        #[test]
        fn leaves_keep_their_bounds(
            leaves in 2usize..70,
            fill in 0.0..1.0,
            place in 0.0..=1.0,
        ) {
            let windows = Windows::new(leaves);
            let (low, high) = (leaves * LEAF_MIN, windows.most_of_all() - 1);
            let len = low + ((high - low) as f64 * fill) as usize;
            let before = (len as f64 * place) as usize;
            let mut counts = vec![0; leaves];
            around(&mut counts, len, before, windows, windows.height());
            prop_assert_eq!(counts.iter().map(|&c| c as usize).sum::<usize>(), len);
            prop_assert!(counts.iter().all(|&c| (LEAF_MIN..LEAF_SLOTS).contains(&(c as usize))), "{:?}", counts);
            even(&mut counts, len);
            prop_assert_eq!(counts.iter().map(|&c| c as usize).sum::<usize>(), len);
            let spread = counts.iter().max().unwrap() - counts.iter().min().unwrap();
            prop_assert!(spread <= 1);
        }
    }
}
