//! The part of a triangle that other facets leave, and its lowest point.

use super::directions::{Directions, Offsets, opposite};

/// Depth in units of the grid up to which a triangle only touches a body. Far above the rounding of a clipped corner, 2⁻²⁵, and far
/// below the unit; the proof in whole numbers takes a unit back where it matters.
pub(super) const TOUCH: f64 = 1e-6;

/// Corners of a clipped triangle, at most: each of 25 planes adds one, and rounding hardly more.
const CORNERS_MAX: usize = 40;

/// Room for the polygons of a clipped triangle, so that it is not cleared for each of them.
pub(super) struct Scratch {
    polygon: [[f64; 3]; CORNERS_MAX],
    clipped: [[f64; 3]; CORNERS_MAX],
    beyond: [f64; CORNERS_MAX],
}

impl Default for Scratch {
    fn default() -> Self {
        let none = [[0.0; 3]; CORNERS_MAX];
        Scratch { polygon: none, clipped: none, beyond: [0.0; CORNERS_MAX] }
    }
}

/// The least uᵢ·x over the triangle in the open body {uⱼ·x < hⱼ for all j ≠ i}; `None` where the triangle does not enter it.
///
/// `heights` has the least uⱼ·x of the triangle, rounded down, for all j. A plane that all of the triangle is below cuts nothing.
pub(super) fn lowest(
    corners: &[[f64; 3]; 3],
    heights: &[i32],
    i: usize,
    h: &Offsets,
    directions: &Directions,
    scratch: &mut Scratch,
) -> Option<f64> {
    let Scratch { polygon, clipped, beyond } = scratch;
    let (mut polygon, mut clipped) = (polygon, clipped);
    let mut size = 3;
    polygon[..3].copy_from_slice(corners);
    let is_cutting = |&j: &usize| j != i && -heights[opposite(j)] >= h[j];
    for j in (0..directions.len()).filter(is_cutting) {
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for (beyond, p) in beyond.iter_mut().zip(&polygon[..size]) {
            *beyond = height(directions, j, p) - f64::from(h[j]);
            least = if *beyond < least { *beyond } else { least };
            most = if *beyond > most { *beyond } else { most };
        }
        if least >= -TOUCH {
            return None;
        }
        if most <= 0.0 {
            continue;
        }
        let mut kept = 0;
        let (mut from, mut before) = (polygon[size - 1], beyond[size - 1]);
        for (to, &after) in polygon[..size].iter().zip(&*beyond) {
            if kept + 2 > CORNERS_MAX {
                // The whole triangle is not higher than its part.
                return Some(f64::from(heights[i]));
            }
            if (before > 0.0) != (after > 0.0) {
                let share = before / (before - after);
                clipped[kept] = [0, 1, 2].map(|c| from[c] + share * (to[c] - from[c]));
                kept += 1;
            }
            if after <= 0.0 {
                clipped[kept] = *to;
                kept += 1;
            }
            (from, before) = (*to, after);
        }
        std::mem::swap(&mut polygon, &mut clipped);
        size = kept;
    }
    // Clipping by later facets may have left a part that lies in the plane of an earlier one.
    let enters = (0..directions.len()).filter(is_cutting).all(|j| {
        let most = f64::from(h[j]) - TOUCH;
        polygon[..size].iter().any(|p| height(directions, j, p) < most)
    });
    let heights = polygon[..size].iter().map(|p| height(directions, i, p));
    enters.then(|| heights.fold(f64::INFINITY, f64::min))
}

fn height(directions: &Directions, j: usize, p: &[f64; 3]) -> f64 {
    let u = directions.floats[j];
    u[0] * p[0] + u[1] * p[1] + u[2] * p[2]
}
