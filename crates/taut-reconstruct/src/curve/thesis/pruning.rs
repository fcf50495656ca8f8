//! Pruning: centres that are far enough from each other.
//!
//! *Problem.* Of centres s* with widths W(s), scanned by decreasing width, each one that is still there is selected and deletes all
//! centres within W(s)^(1/3) of it.
//! *Idea.* The tree of boxes over the centres tells which those are; centres near in the plane are near in memory.
//! *Guarantee.* Those selected are farther apart than the smaller of their radii, and each centre is within the radius of a selected one.

use super::disks::Disks;

/// The numbers of the centres selected, in that order; `width` and `reach` are those of each centre.
pub(super) fn select(
    centers: &[[f64; 2]],
    width: impl Fn(usize) -> f64,
    reach: impl Fn(usize) -> f64,
) -> Vec<usize> {
    let disks = Disks::over(centers);
    let mut order: Vec<usize> = (0..centers.len()).collect();
    order.sort_by(|&a, &b| width(b).total_cmp(&width(a)));
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
