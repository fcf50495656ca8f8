//! Volumes of closed components, and how many of them are around a point.

use num_bigint::{BigInt, Sign};
use num_traits::Zero;

use super::super::lattice::{determinant, difference};
use super::balls::orientation;
use super::convex::{Place, is_on, meet};
use super::scene::Scene;
use super::shape::Shape;

/// The sign of the volume that a component bounds: positive if it faces outwards.
pub(super) fn volume(
    triangles: &[[u32; 3]],
    shape: &Shape,
    scene: &Scene,
    component: usize,
) -> Sign {
    let own = triangles.iter().zip(&shape.component).filter(|(_, own)| **own == component);
    let six_times: BigInt =
        own.map(|(&triangle, _)| determinant(&scene.corners(triangle).map(Clone::clone))).sum();
    six_times.sign()
}

/// Returns how many closed components, one left out or none, are around a point; `None` if it is on one.
///
/// Rays run in the directions (1, k, k²). A plane through the point has at most two of them, so one misses all edges.
pub(super) fn depth(
    p: &Place,
    triangles: &[[u32; 3]],
    shape: &Shape,
    scene: &Scene,
    but: Option<usize>,
) -> Option<usize> {
    let around: Vec<(usize, [&Place; 3], bool)> = triangles
        .iter()
        .zip(&shape.component)
        .filter(|(_, own)| shape.is_closed[**own] && but != Some(**own))
        .map(|(&triangle, &own)| (own, scene.corners(triangle), scene.is_flat(triangle)))
        .collect();
    let is_at = |&(_, [a, b, c], is_flat): &(usize, [&Place; 3], bool)| match is_flat {
        true => is_on(p, a, b) || is_on(p, b, c) || is_on(p, c, a),
        false => orientation([a, b, c], p) == Sign::NoSign && meet([a, b, c], &[p]),
    };
    if around.iter().any(is_at) {
        return None;
    }
    (1i64..).find_map(|k| {
        let direction = [1, k, k * k].map(BigInt::from).to_vec();
        let mut is_odd = vec![false; shape.is_closed.len()];
        for &(own, corners, is_flat) in &around {
            // A ray that misses the edges misses a flat triangle.
            if !is_flat && crosses(p, &direction, corners)? {
                is_odd[own] = !is_odd[own];
            }
        }
        Some(is_odd.into_iter().filter(|&is_odd| is_odd).count())
    })
}

/// Tests whether a ray crosses a triangle that the point is not on; `None` if it meets an edge's line or runs within the plane.
fn crosses(p: &Place, direction: &Place, corners: [&Place; 3]) -> Option<bool> {
    let [a, b, c] = corners.map(|corner| difference(corner, p));
    let level = determinant(&[a.clone(), b.clone(), c.clone()]);
    let turn = |s: &Place, t: &Place| determinant(&[direction.clone(), s.clone(), t.clone()]);
    let turns = [turn(&a, &b), turn(&b, &c), turn(&c, &a)];
    if level.is_zero() {
        // The sum is the direction times the normal: the plane is left at once, or never.
        return (!turns.iter().sum::<BigInt>().is_zero()).then_some(false);
    }
    if turns.iter().any(Zero::is_zero) {
        return None;
    }
    Some(turns.iter().all(|turn| turn.sign() == level.sign()))
}
