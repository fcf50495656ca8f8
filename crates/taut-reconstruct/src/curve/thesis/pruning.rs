//! Pruning: centres that are far enough from each other.
//!
//! *Problem.* Of centres s* with widths W(s), scanned by decreasing width, each one that is still there is selected and deletes all
//! centres within W(s)^(1/3) of it.
//! *Idea.* The tree of boxes over the centres tells which those are; centres near in the plane are near in memory.
//! *Guarantee.* Those selected are farther apart than the larger of their radii, and each centre is within the radius of a selected
//! one.
//! *Trap.* Of two samples that are each the K-th nearest of the other the widths are equal, and by rounding either may be the
//! larger: widths are compared in single precision, and then heights, which turn with the input.

use super::disks::Disks;

/// The numbers of the centres selected, in that order; `size` is the width and height of each, and `reach` its radius.
pub(super) fn select(
    centers: &[[f64; 2]],
    size: impl Fn(usize) -> [f64; 2],
    reach: impl Fn(usize) -> f64,
) -> Vec<usize> {
    let disks = Disks::over(centers);
    let mut order: Vec<usize> = (0..centers.len()).collect();
    order.sort_by(|&a, &b| {
        let ([wa, ha], [wb, hb]) = (size(a), size(b));
        (wb as f32).total_cmp(&(wa as f32)).then(hb.total_cmp(&ha))
    });
    let mut deleted = vec![false; centers.len()];
    let mut selected = Vec::new();
    for center in order {
        if !deleted[center] {
            selected.push(center);
            disks.within(centers[center], reach(center), |other| deleted[other] = true);
        }
    }
    selected
}
