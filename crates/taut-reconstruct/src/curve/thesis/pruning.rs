//! Pruning: centers that are far enough from each other.
//!
//! *Problem.* Of centers s* with widths W(s), scanned by decreasing width, each one that is still there is selected and deletes all
//! centers within W(s)^(1/3) of it.
//! *Idea.* The tree of boxes over the centers tells which those are; centers near in the plane are near in memory.
//! *Guarantee.* Those selected are farther apart than the larger of their radii, and each center is within the radius of a selected
//! one.
//! *Trap.* Of two samples that are each the K-th nearest of the other the widths are equal, and by rounding either may be the
//! larger; their rectangles may be the same ones, too. Widths, heights and ways from sample to center are compared one after the other, in single
//! precision, as they turn with the input.

use std::cmp::Ordering;

use taut_points::OrderBy;

use super::disks::Disks;

/// The numbers of the centers selected, in that order; `size` is the width and height of each and its way from the sample, and
/// `reach` its radius.
pub(super) fn select(
    centers: &[[f64; 2]],
    size: impl Fn(usize) -> [f64; 3],
    reach: impl Fn(usize) -> f64,
) -> Vec<usize> {
    let disks = Disks::over(centers);
    let mut order: Vec<usize> = (0..centers.len()).collect();
    order.order_by(&|&a, &b| {
        let [a, b] = [a, b].map(|center| size(center).map(|x| x as f32));
        let pairs = b.iter().zip(&a);
        pairs.fold(Ordering::Equal, |order, (b, a)| order.then(b.total_cmp(a)))
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
