//! Points spread evenly over the inside of a mesh.
//!
//! *Idea.* Vertical lines through the cells of a square grid, one at a random place of each cell, cross the mesh an even number of
//! times; between crossings with odd and even number they are inside. On each line points follow at the distance of the lines.

use super::tree::Tree;
use crate::random::Random;

/// Lines along each side for the first count, from which the distance is found.
const FIRST_LINES: f64 = 40.0;

/// About as many points inside as wanted; fewer where the grid has not so many, none where the mesh has no inside.
pub(super) fn points(tree: &Tree, wanted: usize, random: &mut Random) -> Vec<[i32; 3]> {
    let extent = |c: usize| f64::from(tree.extent(2 * c)) + f64::from(tree.extent(2 * c + 1));
    let side = extent(0).max(extent(1)).max(extent(2));
    let first = (side / FIRST_LINES).max(1.0);
    let found = spread(tree, first, &mut random.clone()).len().max(1);
    let distance = first * (found as f64 / wanted as f64).cbrt();
    spread(tree, distance.max(1.0), random)
}

fn spread(tree: &Tree, distance: f64, random: &mut Random) -> Vec<[i32; 3]> {
    let low = [0, 1].map(|c| -f64::from(tree.extent(2 * c + 1)));
    let high = [0, 1].map(|c| f64::from(tree.extent(2 * c)));
    let mut points = vec![];
    let lines = |c: usize| ((high[c] - low[c]) / distance).ceil() as usize;
    for i in 0..lines(0) {
        for j in 0..lines(1) {
            let x = (low[0] + distance * (i as f64 + random.unit())) as i32;
            let y = (low[1] + distance * (j as f64 + random.unit())) as i32;
            let start = random.unit();
            for &[from, to] in tree.crossings(x, y).as_chunks::<2>().0 {
                let steps = (from / distance - start).ceil();
                let mut z = (start + steps) * distance;
                while z < to {
                    points.push([x, y, z as i32]);
                    z += distance;
                }
            }
        }
    }
    points
}
