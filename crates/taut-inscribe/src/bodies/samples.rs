//! Points spread evenly over the inside of a mesh.
//!
//! *Idea.* Vertical lines through the cells of a square grid, one at a random place of each cell, cross the mesh and each solid in it an
//! even number of times, and have parts that are in the mesh and in no solid. On each line points follow at the distance of the lines.

use super::scene::free_parts;
use super::tree::Tree;
use crate::random::Random;

/// Lines along each side for the first count, from which the distance is found.
const FIRST_LINES: f64 = 40.0;

/// About as many points inside as wanted; fewer where the grid has not so many, none where the mesh has no inside.
pub(super) fn points(tree: &Tree, wanted: usize, random: &mut Random) -> Vec<[i32; 3]> {
    let [_, half] = tree.mesh_bounds();
    let side = 2.0 * half.into_iter().fold(0.0, f64::max);
    let first = (side / FIRST_LINES).max(1.0);
    let found = spread(tree, first, &mut random.clone()).len().max(1);
    let distance = first * (found as f64 / wanted as f64).cbrt();
    spread(tree, distance.max(1.0), random)
}

fn spread(tree: &Tree, distance: f64, random: &mut Random) -> Vec<[i32; 3]> {
    let [low, high] = tree.corners_of_mesh_bounds().map(|corner| corner.map(f64::from));
    let mut points = vec![];
    let lines = |c: usize| ((high[c] - low[c]) / distance).ceil() as usize;
    for i in 0..lines(0) {
        for j in 0..lines(1) {
            let x = (low[0] + distance * (i as f64 + random.unit())) as i32;
            let y = (low[1] + distance * (j as f64 + random.unit())) as i32;
            let start = random.unit();
            for [from, to] in free_parts(&tree.crossings(x, y)).0 {
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
