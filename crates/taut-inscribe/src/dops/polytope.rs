//! The facets of a body as polygons, in plain arithmetic.

use super::directions::{Directions, Offsets};

/// The facets as polygons in units from the origin of the grid; facets that the others make redundant have none.
///
/// `inside` is a point in the interior. Corners are off by some 2⁻²⁵ units.
pub(super) fn facets(directions: &Directions, h: &Offsets, inside: [i32; 3]) -> Vec<Vec<[f64; 3]>> {
    (0..directions.len()).map(|i| facet(directions, h, inside, i)).collect()
}

/// The volume in cubes of the unit.
pub(super) fn volume(directions: &Directions, h: &Offsets, inside: [i32; 3]) -> f64 {
    let from = |p: [f64; 3]| [0, 1, 2].map(|c| p[c] - f64::from(inside[c]));
    let of_facet = |polygon: Vec<[f64; 3]>| -> f64 {
        let Some(&apex) = polygon.first() else { return 0.0 };
        let fan = polygon.windows(2).map(|edge| {
            let [a, b, c] = [from(apex), from(edge[0]), from(edge[1])];
            a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
                + a[2] * (b[0] * c[1] - b[1] * c[0])
        });
        fan.sum::<f64>().abs() / 6.0
    };
    facets(directions, h, inside).into_iter().map(of_facet).sum()
}

fn facet(directions: &Directions, h: &Offsets, inside: [i32; 3], i: usize) -> Vec<[f64; 3]> {
    let normal = |j: usize| directions.normals[j].map(|n| n as f64);
    // Seen from the interior point, so that a small body far from the origin loses no digits.
    let offset = |j: usize| (i64::from(h[j]) - directions.along(j, inside)) as f64;
    let dot = |p: [f64; 3], q: [f64; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    let cross = |p: [f64; 3], q: [f64; 3]| {
        [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]
    };
    // The first six directions bound a box; the square in the plane of the facet is larger than it.
    let reach = 4.0 * (0..6).map(offset).fold(0.0, f64::max);
    let u = normal(i);
    let axis = if u[0] == 0.0 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, -u[1].signum()] };
    let along = cross(u, axis);
    let along = along.map(|x| x * reach / dot(along, along).sqrt());
    let across = cross(u, along).map(|x| x / dot(u, u).sqrt());
    let foot = u.map(|x| x * offset(i) / dot(u, u));
    let corner = |s: f64, t: f64| [0, 1, 2].map(|c| foot[c] + s * along[c] + t * across[c]);
    let mut polygon =
        vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    for j in (0..directions.len()).filter(|&j| j != i) {
        let beyond = |p: &[f64; 3]| dot(normal(j), *p) - offset(j);
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
    }
    polygon.iter().map(|p| [0, 1, 2].map(|c| p[c] + f64::from(inside[c]))).collect()
}
