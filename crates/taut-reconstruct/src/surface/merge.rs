//! Points that are nearer to each other than they are to where they belong.
//!
//! *Problem.* Points that were moved onto their sheet are still off by some error. Where they are much nearer to each other than that,
//! triangles between them stand on edge, and the surface through all of them folds.
//! *Idea.* In an order that has nothing to do with place each point takes those that are nearer than its radius, unless they were taken
//! or took others themselves. What was taken is in the place of its taker from then on.
//! *Guarantee.* A function of the points. No two of the places left are nearer than the smaller radius of both, among the
//! [`NEIGHBORS`] nearest of each. O(n log n).

use super::neighbors::of_neighbors_by;
use super::spheres::Point;
use crate::Error;

/// Nearest points, itself among them, that a point can take.
const NEIGHBORS: usize = 32;

/// By point the one whose place it is in: itself, unless it was taken.
pub(super) fn takers(points: &[Point], radii: &[f64]) -> Result<Vec<u32>, Error> {
    let count = |row: usize| if radii[row] > 0.0 { NEIGHBORS } else { 0 };
    let near: Vec<Vec<u32>> = of_neighbors_by(points, count, |row, near| {
        let within = near.iter().take_while(|near| near.distance2.sqrt() < radii[row]);
        within.map(|near| near.row).collect()
    })?;
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    let key = |&row: &u32| {
        let place = points[row as usize].map(|x| (x + 0.0).to_bits());
        (scrambled(place), place)
    };
    order.sort_by_cached_key(key);
    let mut taker: Vec<Option<u32>> = vec![None; points.len()];
    for row in order {
        if taker[row as usize].is_some() {
            continue;
        }
        taker[row as usize] = Some(row);
        for &other in &near[row as usize] {
            taker[other as usize].get_or_insert(row);
        }
    }
    Ok((0..).zip(taker).map(|(row, taker)| taker.unwrap_or(row)).collect())
}

/// A number that places near each other do not share.
fn scrambled(place: [u64; 3]) -> u64 {
    // The finalizer of SplitMix64.
    place.iter().fold(0, |state: u64, &bits| {
        let mut z = (state ^ bits).wrapping_add(0x9e37_79b9_7f4a_7c15);
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn takers_are_apart_and_near_what_they_took() {
        let mut state = 7u64;
        let mut number = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 40) as f64 / f64::from(1 << 24)
        };
        let points: Vec<Point> = (0..500).map(|_| [number(), number(), 0.0]).collect();
        // Fewer than 32 of 500 are within such a circle of a unit square.
        let radius = 0.08;
        let found = takers(&points, &[radius; 500]).expect("finite");
        let apart = |a: u32, b: u32| {
            let [p, q] = [a, b].map(|row| points[row as usize]);
            (p[0] - q[0]).hypot(p[1] - q[1])
        };
        let kept: Vec<u32> = (0..500).filter(|&row| found[row as usize] == row).collect();
        assert!(kept.len() > 50 && kept.len() < 200, "{}", kept.len());
        for (k, &a) in kept.iter().enumerate() {
            assert!(kept[..k].iter().all(|&b| apart(a, b) >= radius));
        }
        for (row, &taker) in (0..).zip(&found) {
            assert!(apart(row, taker) < radius && found[taker as usize] == taker);
        }
        let apart = takers(&points, &[0.0; 500]).expect("finite");
        assert!((0..500).eq(apart));
    }
}
