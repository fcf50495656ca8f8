//! The facets of a body as polygons, in plain arithmetic.

use super::directions::{Directions, Offsets};
use super::vectors::{cross, dot};

/// Half the side of the square from which the polygon of a facet is cut, in units: bodies and interior points have coordinates
/// below 2²⁵.
const SQUARE_HALF_SIDE: f64 = (1u64 << 27) as f64;

/// How many times larger than a body the square may be before the polygons are cut once more from a smaller one, so that the
/// corners of small bodies are not off by the rounding of large numbers.
const SQUARE_RATIO_MAX: f64 = 64.0;

/// The half-spaces normal·x ≤ offset, in whole numbers.
#[derive(Clone, Debug, Default)]
pub(super) struct Sides {
    pub(super) normals: Vec<[f64; 3]>,
    pub(super) offsets: Vec<f64>,
}

impl Sides {
    pub(super) fn of_dop(directions: &Directions, h: &Offsets) -> Self {
        let normals: Vec<_> = directions.normals.iter().map(|u| u.map(|n| n as f64)).collect();
        let offsets = h[..normals.len()].iter().map(|&h| f64::from(h)).collect();
        Sides { normals, offsets }
    }

    /// Whether a point is in the interior.
    pub(super) fn contains(&self, p: [f64; 3]) -> bool {
        self.normals.iter().zip(&self.offsets).all(|(u, &offset)| dot(*u, p) < offset)
    }
}

/// The facets as polygons in units from the origin of the grid; facets that the others make redundant have none.
///
/// `inside` is a point in the interior. Corners are off by some 2⁻²⁵ units.
pub(super) fn facets(sides: &Sides, inside: [i32; 3]) -> Vec<Vec<[f64; 3]>> {
    let inside = inside.map(f64::from);
    let placed = |p: [f64; 3]| [0, 1, 2].map(|c| p[c] + inside[c]);
    let polygons = around(sides, inside).into_iter();
    polygons.map(|polygon| polygon.into_iter().map(placed).collect()).collect()
}

/// The volume in cubes of the unit.
pub(super) fn volume(sides: &Sides, inside: [i32; 3]) -> f64 {
    let of_facet = |polygon: Vec<[f64; 3]>| -> f64 {
        let Some(&apex) = polygon.first() else { return 0.0 };
        let fan = polygon.windows(2).map(|edge| dot(apex, cross(edge[0], edge[1])));
        fan.sum::<f64>().abs() / 6.0
    };
    around(sides, inside.map(f64::from)).into_iter().map(of_facet).sum()
}

/// The facets as polygons seen from an interior point, so that a small body far from the origin loses no digits.
fn around(sides: &Sides, inside: [f64; 3]) -> Vec<Vec<[f64; 3]>> {
    let offsets = sides.normals.iter().zip(&sides.offsets).map(|(u, h)| h - dot(*u, inside));
    let offsets: Vec<f64> = offsets.collect();
    let cut = |reach: f64| -> Vec<Vec<[f64; 3]>> {
        (0..offsets.len()).map(|i| facet(&sides.normals, &offsets, reach, i)).collect()
    };
    let found = cut(SQUARE_HALF_SIDE);
    let farthest = found.iter().flatten().map(|p| dot(*p, *p)).fold(0.0, f64::max).sqrt();
    if farthest * SQUARE_RATIO_MAX < SQUARE_HALF_SIDE { cut(4.0 * farthest) } else { found }
}

fn facet(normals: &[[f64; 3]], offsets: &[f64], reach: f64, i: usize) -> Vec<[f64; 3]> {
    let u = normals[i];
    // Not parallel to the normal.
    let axis = if u[0].abs() <= u[1].abs() { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    let along = cross(u, axis);
    let along = along.map(|x| x * reach / dot(along, along).sqrt());
    let across = cross(u, along).map(|x| x / dot(u, u).sqrt());
    let nearest = u.map(|x| x * offsets[i] / dot(u, u));
    let corner = |s: f64, t: f64| [0, 1, 2].map(|c| nearest[c] + s * along[c] + t * across[c]);
    let mut polygon =
        vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    for j in (0..normals.len()).filter(|&j| j != i) {
        let beyond = |p: &[f64; 3]| dot(normals[j], *p) - offsets[j];
        let mut clipped = Vec::with_capacity(polygon.len() + 1);
        for (at, to) in polygon.iter().enumerate() {
            let from = &polygon[(at + polygon.len() - 1) % polygon.len()];
            let (before, after) = (beyond(from), beyond(to));
            if (before > 0.0) != (after > 0.0) {
                let share = before / (before - after);
                clipped.push([0, 1, 2].map(|c| from[c] + share * (to[c] - from[c])));
            }
            if after <= 0.0 {
                clipped.push(*to);
            }
        }
        polygon = clipped;
        if polygon.is_empty() {
            break;
        }
    }
    polygon
}
