//! Points in blocks of neighbors, so that most of them are counted by blocks.

use super::polytope::Sides;
use super::vectors::dot;

/// Points of a block, at most.
const BLOCK_POINTS_MAX: usize = 16;

/// Points, block by block.
#[derive(Default)]
pub(super) struct Cloud {
    points: Vec<[f64; 3]>,
    blocks: Vec<Block>,
}

/// A block: its last point, and the center and the half sides of its box.
struct Block {
    end: usize,
    center: [f64; 3],
    half: [f64; 3],
}

impl Cloud {
    pub(super) fn of(points: &[[i32; 3]]) -> Self {
        let mut points: Vec<[f64; 3]> = points.iter().map(|p| p.map(f64::from)).collect();
        let mut blocks = vec![];
        if !points.is_empty() {
            split(&mut points, 0, &mut blocks);
        }
        Cloud { points, blocks }
    }

    /// The points in the interior of a body.
    pub(super) fn inside(&self, sides: &Sides) -> Vec<[f64; 3]> {
        let (mut found, mut crossing) = (vec![], vec![]);
        let mut first = 0;
        for block in &self.blocks {
            let points = &self.points[first..block.end];
            first = block.end;
            crossing.clear();
            let is_out =
                sides.normals.iter().zip(&sides.offsets).enumerate().any(|(j, (u, &offset))| {
                    let half = block.half;
                    let reach = u[0].abs() * half[0] + u[1].abs() * half[1] + u[2].abs() * half[2];
                    let at = dot(*u, block.center);
                    if at + reach >= offset {
                        crossing.push(j);
                    }
                    at - reach >= offset
                });
            if !is_out {
                let is_in = |p: &&[f64; 3]| {
                    crossing.iter().all(|&j| dot(sides.normals[j], **p) < sides.offsets[j])
                };
                found.extend(points.iter().filter(is_in));
            }
        }
        found
    }
}

/// Brings points into an order in which blocks are boxes, by medians along the longest side, and appends the blocks.
fn split(points: &mut [[f64; 3]], first: usize, blocks: &mut Vec<Block>) {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for p in points.iter() {
        for c in 0..3 {
            (low[c], high[c]) = (low[c].min(p[c]), high[c].max(p[c]));
        }
    }
    if points.len() <= BLOCK_POINTS_MAX {
        let center = [0, 1, 2].map(|c| f64::midpoint(low[c], high[c]));
        let half = [0, 1, 2].map(|c| (high[c] - low[c]) / 2.0);
        blocks.push(Block { end: first + points.len(), center, half });
        return;
    }
    let longest = |a: &usize, b: &usize| (high[*a] - low[*a]).total_cmp(&(high[*b] - low[*b]));
    let axis = (0..3).max_by(longest).unwrap_or(0);
    let middle = points.len() / 2;
    let order = |p: &[f64; 3]| [p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]];
    points.select_nth_unstable_by(middle, |p, q| {
        order(p).partial_cmp(&order(q)).unwrap_or(std::cmp::Ordering::Equal)
    });
    let (lower, upper) = points.split_at_mut(middle);
    split(lower, first, blocks);
    split(upper, first + middle, blocks);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_count_the_points_that_each_one_counts() {
        let points: Vec<[i32; 3]> =
            (0..3000).map(|k: i32| [k * 37 % 101, k * 53 % 97, k * 71 % 89]).collect();
        let cloud = Cloud::of(&points);
        let normals = vec![[1.0, 0.0, 0.0], [-1.0, 2.0, 0.0], [3.0, 1.0, -2.0], [0.0, -1.0, -1.0]];
        for offsets in [[60.0, 90.0, 70.0, -40.0], [500.0; 4], [-1.0; 4], [50.0, 90.0, 101.0, 0.0]]
        {
            let sides = Sides { normals: normals.clone(), offsets: offsets.to_vec() };
            let mut found = cloud.inside(&sides);
            let mut expected: Vec<[f64; 3]> =
                points.iter().map(|p| p.map(f64::from)).filter(|&p| sides.contains(p)).collect();
            found.sort_by(|p, q| p.partial_cmp(q).unwrap());
            expected.sort_by(|p, q| p.partial_cmp(q).unwrap());
            assert_eq!(found, expected);
        }
        assert!(Cloud::of(&[]).inside(&Sides::default()).is_empty());
    }
}
