//! Vertices that stick out of a surface.
//!
//! *Problem.* A point far from the sheets that were sampled is a vertex like any other, at the tip of a spike.
//! *Idea.* The triangles at a tip are long beside those at the other ends of its edges, and all in one narrow cone.
//! *Guarantee.* None: this is evidence. The tip of a needle that was sampled at its foot alone looks the same.

use super::border::Face;
use super::spheres::{Point, dot, minus};

/// The least distance of a tip from the next vertex, over the median of those of its neighbors.
const HEIGHT_RATIO: f64 = 3.0;
/// The least cosine of the angle between an edge at the tip and the middle of all: 35°.
const CONE_COSINE: f64 = 0.82;

/// The tips of spikes, ascending. O(n).
pub(super) fn spikes(faces: &[Face], points: &[Point]) -> Vec<u32> {
    let off = |a: u32, b: u32| minus(points[b as usize], points[a as usize]);
    let square = |a: u32, b: u32| dot(off(a, b), off(a, b));
    // Each corner with the two others of its triangle.
    let corners = |face: &Face| {
        let [a, b, c] = face.sites;
        [[a, b, c], [b, c, a], [c, a, b]]
    };
    let mut least = vec![f64::INFINITY; points.len()];
    for [at, b, c] in faces.iter().flat_map(corners) {
        let least = &mut least[at as usize];
        *least = least.min(square(at, b)).min(square(at, c));
    }
    // By vertex, how many of its neighbors have a much nearer one, less how many have none.
    let mut excess = vec![0i32; points.len()];
    for [at, b, c] in faces.iter().flat_map(corners) {
        for other in [b, c] {
            let bound = HEIGHT_RATIO * HEIGHT_RATIO * least[other as usize];
            excess[at as usize] += if least[at as usize] > bound { 1 } else { -1 };
        }
    }
    let mut tips: Vec<u32> =
        (0..points.len() as u32).filter(|&at| excess[at as usize] > 0).collect();
    if tips.is_empty() {
        return tips;
    }
    let direction = |a: u32, b: u32| off(a, b).map(|x| x / square(a, b).sqrt());
    let mut axes = vec![[0.0; 3]; points.len()];
    let at_tips = || faces.iter().flat_map(corners).filter(|[at, ..]| excess[*at as usize] > 0);
    for [at, b, c] in at_tips() {
        for direction in [direction(at, b), direction(at, c)] {
            (0..3).for_each(|k| axes[at as usize][k] += direction[k]);
        }
    }
    let mut is_wide = vec![false; points.len()];
    for [at, b, c] in at_tips() {
        let axis = axes[at as usize];
        let bound = CONE_COSINE * dot(axis, axis).sqrt();
        is_wide[at as usize] |= [b, c].iter().any(|&other| dot(direction(at, other), axis) < bound);
    }
    tips.retain(|&at| !is_wide[at as usize]);
    tips
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A flat grid of squares with a point at this height over its middle, which has the triangles to the square's corners.
    fn grid_with_tip(height: f64) -> (Vec<Face>, Vec<Point>) {
        let side = 9u32;
        let mut points: Vec<Point> =
            (0..side * side).map(|k| [f64::from(k % side), f64::from(k / side), 0.0]).collect();
        points.push([3.5, 3.5, height]);
        let tip = side * side;
        let mut faces = Vec::new();
        for k in (0..side * (side - 1)).filter(|k| k % side + 1 < side) {
            let [a, b, c, d] = [k, k + 1, k + side + 1, k + side];
            let triangles = if k == 3 + 3 * side {
                vec![[a, b, tip], [b, c, tip], [c, d, tip], [d, a, tip]]
            } else {
                vec![[a, b, c], [a, c, d]]
            };
            faces.extend(triangles.into_iter().map(|sites| Face { sites, facet: 0 }));
        }
        (faces, points)
    }

    #[test]
    fn a_high_point_is_a_tip_and_a_low_one_is_none() {
        for (height, expected) in [(0.0, vec![]), (1.0, vec![]), (4.0, vec![81]), (-50.0, vec![81])]
        {
            let (faces, points) = grid_with_tip(height);
            assert_eq!(spikes(&faces, &points), expected, "{height}");
        }
    }
}
