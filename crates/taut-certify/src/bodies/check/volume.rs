//! The volume of a convex body with whole half-spaces.
//!
//! *Idea.* The line in which the planes of two facets meet is cut by all other half-spaces, in fractions; its ends are vertices. For
//! most pairs nothing is left after a few cuts. An edge joins the two vertices that two facets have in common. A tetrahedron spans an interior point, a vertex of a facet and an edge of that facet; these
//! tetrahedra fill the body, so that the volume is a sum of positive terms.
//! *Guarantee.* Vertices are exact; each is rounded once, and the rounding of all terms and of the sum is bounded.

use std::collections::{BTreeMap, BTreeSet};

use super::ConvexBody;

/// The unit roundoff of `f64`.
const U: f64 = 1.0 / (1u64 << 53) as f64;

/// A bound on the error of a determinant of three rounded vectors, in roundoffs of the sum of its six products without signs:
/// 3·3 for the entries, 2 for products, 5 for sums, doubled.
const DETERMINANT_ROUNDOFFS: f64 = 32.0;

/// The facets that hold a vertex, one bit for each of at most 256.
type Facets = [u64; 4];

fn holds(facets: &Facets, facet: usize) -> bool {
    facets[facet / 64] >> (facet % 64) & 1 == 1
}

/// Bounds of the volume in cubes of the unit, for a bounded body with this point in its interior.
pub(crate) fn bounds(body: &ConvexBody, inside: [i64; 3]) -> [f64; 2] {
    let vertices = around(body, inside);
    let (mut lower, mut upper, mut terms) = (0.0, 0.0, 0.0);
    for facet in 0..body.normals.len() {
        let (corners, edges) = border(&vertices, facet, body.normals.len());
        let Some(&apex) = corners.first() else { continue };
        for [one, two] in edges {
            let [size, error] = determinant(apex, corners[one], corners[two]);
            lower += (size - error).max(0.0);
            upper += size + error;
            terms += 1.0;
        }
    }
    let slack = (terms + 8.0) * 2.0 * U;
    [lower / 6.0 * (1.0 - slack), upper / 6.0 * (1.0 + slack)]
}

/// The vertices of a facet, and its edges as pairs of them.
fn border(
    vertices: &BTreeMap<Facets, [f64; 3]>,
    facet: usize,
    facets: usize,
) -> (Vec<[f64; 3]>, BTreeSet<[usize; 2]>) {
    let corners: Vec<_> = vertices.iter().filter(|(on, _)| holds(on, facet)).collect();
    let mut edges = BTreeSet::new();
    for other in (0..facets).filter(|&other| other != facet) {
        let mut ends = (0..corners.len()).filter(|&k| holds(corners[k].0, other));
        if let (Some(one), Some(two)) = (ends.next(), ends.next()) {
            edges.insert([one, two]);
        }
    }
    (corners.into_iter().map(|(_, &corner)| corner).collect(), edges)
}

/// The facets as polygons in units from the origin of the grid, rounded, each facet counter-clockwise from outside; empty where a
/// facet is redundant. No facets where numbers are out of range.
pub(crate) fn polygons(body: &ConvexBody) -> Vec<Vec<[f64; 3]>> {
    if super::facets(0, body).is_err() {
        return vec![];
    }
    let vertices = around(body, [0; 3]);
    let polygon = |facet: usize| {
        let (corners, edges) = border(&vertices, facet, body.normals.len());
        let mut left: Vec<[usize; 2]> = edges.into_iter().collect();
        let mut chain: Vec<usize> = vec![];
        while let Some(at) =
            left.iter().position(|edge| chain.last().is_none_or(|k| edge.contains(k)))
        {
            let [one, two] = left.swap_remove(at);
            chain.push(if chain.last() == Some(&one) { two } else { one });
        }
        let mut polygon: Vec<[f64; 3]> = chain.into_iter().map(|k| corners[k]).collect();
        if polygon.len() < 3 {
            return vec![];
        }
        let minus = |p: [f64; 3], q: [f64; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
        let (u, v) = (minus(polygon[1], polygon[0]), minus(polygon[2], polygon[0]));
        let normal = body.normals[facet].map(|n| n as f64);
        let turn = normal[0] * (u[1] * v[2] - u[2] * v[1])
            + normal[1] * (u[2] * v[0] - u[0] * v[2])
            + normal[2] * (u[0] * v[1] - u[1] * v[0]);
        if turn < 0.0 {
            polygon.reverse();
        }
        polygon
    };
    (0..body.normals.len()).map(polygon).collect()
}

/// The vertices in units from the origin of the grid, rounded; none where numbers are out of range.
pub(crate) fn vertices(body: &ConvexBody) -> Vec<[f64; 3]> {
    match super::facets(0, body) {
        Ok(()) => around(body, [0; 3]).into_values().collect(),
        Err(_) => vec![],
    }
}

/// The vertices seen from a point of the grid, each rounded, by the facets that hold it.
fn around(body: &ConvexBody, from: [i64; 3]) -> BTreeMap<Facets, [f64; 3]> {
    let normals: Vec<[i128; 3]> = body.normals.iter().map(|u| u.map(i128::from)).collect();
    let from = from.map(i128::from);
    let offset = |(u, &h): (&[i128; 3], &i64)| i128::from(h) - dot(*u, from);
    let offsets: Vec<i128> = normals.iter().zip(&body.offsets).map(offset).collect();
    let planes = Planes { normals, offsets };
    let facets = planes.normals.len();
    let mut vertices = BTreeMap::new();
    // Neighbors among the lines are mostly cut off by the same facets, so these come first.
    let mut order: Vec<usize> = (0..facets).collect();
    for i in 0..facets {
        for j in i + 1..facets {
            for point in planes.ends([i, j], &mut order).into_iter().flatten() {
                if let Some(on) = planes.holding(&point) {
                    let [x, y, z, divisor] = point.map(|x| x as f64);
                    vertices.insert(on, [x / divisor, y / divisor, z / divisor]);
                }
            }
        }
    }
    vertices
}

/// A point (x, y, z)/divisor with a positive divisor.
type Fraction = [i128; 4];

/// Half-spaces normal·x ≤ offset.
struct Planes {
    normals: Vec<[i128; 3]>,
    offsets: Vec<i128>,
}

impl Planes {
    /// How far a point is beyond a plane, times its divisor and the length of the normal.
    fn beyond(&self, facet: usize, &[x, y, z, divisor]: &Fraction) -> i128 {
        dot(self.normals[facet], [x, y, z]) - self.offsets[facet] * divisor
    }

    /// The ends of the part that all other half-spaces leave of the line in which two planes meet; none if nothing is left or
    /// the planes are parallel. Planes parallel to the line are left out. The facets are tried in an order in which the one that left
    /// nothing then comes first.
    fn ends(&self, [i, j]: [usize; 2], order: &mut [usize]) -> [Option<Fraction>; 2] {
        let line = cross(self.normals[i], self.normals[j]);
        if line == [0; 3] {
            return [None; 2];
        }
        let mut ends = [None; 2];
        for place in 0..order.len() {
            let k = order[place];
            if k == i || k == j {
                continue;
            }
            let slope = dot(line, self.normals[k]);
            let (own, other) = match slope.signum() {
                0 => continue,
                1 => (1, 0),
                _ => (0, 1),
            };
            if ends[other].is_some_and(|end| self.beyond(k, &end) > 0) {
                order[..=place].rotate_right(1);
                return [None; 2];
            }
            if ends[own].is_none_or(|end| self.beyond(k, &end) > 0) {
                ends[own] = Some(self.meeting([i, j, k], line, slope));
            }
        }
        ends
    }

    /// The point in which three planes meet, by Cramer's rule.
    fn meeting(&self, [i, j, k]: [usize; 3], line: [i128; 3], slope: i128) -> Fraction {
        let (jk, ki) =
            (cross(self.normals[j], self.normals[k]), cross(self.normals[k], self.normals[i]));
        let [a, b, c] = [i, j, k].map(|facet| self.offsets[facet] * slope.signum());
        let [x, y, z] = [0, 1, 2].map(|at| a * jk[at] + b * ki[at] + c * line[at]);
        [x, y, z, slope.abs()]
    }

    /// The facets that hold a point; `None` for a point that is not in all half-spaces.
    fn holding(&self, point: &Fraction) -> Option<Facets> {
        let mut on = [0u64; 4];
        for facet in 0..self.normals.len() {
            let beyond = self.beyond(facet, point);
            if beyond > 0 {
                return None;
            }
            on[facet / 64] |= u64::from(beyond == 0) << (facet % 64);
        }
        Some(on)
    }
}

fn dot(a: [i128; 3], b: [i128; 3]) -> i128 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [i128; 3], b: [i128; 3]) -> [i128; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The determinant of three vectors without its sign, and a bound on its error; each entry has three roundings.
fn determinant(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> [f64; 2] {
    let (mut value, mut size) = (0.0, 0.0);
    for k in 0..3 {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        value += a[k] * (b[i] * c[j] - b[j] * c[i]);
        size += (a[k] * (b[i] * c[j])).abs() + (a[k] * (b[j] * c[i])).abs();
    }
    [value.abs(), size * DETERMINANT_ROUNDOFFS * U]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn volume(normals: &[[i64; 3]], offsets: &[i64]) -> f64 {
        let body = ConvexBody { normals: normals.to_vec(), offsets: offsets.to_vec(), volume: 0.0 };
        let [lower, upper] = bounds(&body, [1, 1, 1]);
        assert!(lower <= upper && upper - lower <= 1e-13 * upper, "{lower} {upper}");
        f64::midpoint(lower, upper)
    }

    /// The vertices by all triples of planes.
    fn by_triples(body: &ConvexBody) -> BTreeSet<Facets> {
        let normals: Vec<[i128; 3]> = body.normals.iter().map(|u| u.map(i128::from)).collect();
        let offsets = body.offsets.iter().map(|&h| i128::from(h)).collect();
        let planes = Planes { normals, offsets };
        let mut found = BTreeSet::new();
        for i in 0..planes.normals.len() {
            for j in i + 1..planes.normals.len() {
                let line = cross(planes.normals[i], planes.normals[j]);
                for k in j + 1..planes.normals.len() {
                    let slope = dot(line, planes.normals[k]);
                    if slope != 0 {
                        found.extend(planes.holding(&planes.meeting([i, j, k], line, slope)));
                    }
                }
            }
        }
        found
    }

    #[test]
    fn vertices_are_those_of_all_triples_of_planes() {
        let mut state = 1u64;
        let mut next = |end: u64| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            ((state >> 33) % end) as i64
        };
        let mut all = 0;
        for round in 0..60 {
            let mut normals: Vec<[i64; 3]> = vec![];
            while normals.len() < 4 + round % 17 {
                // Small entries make many planes meet in one point, and many lines parallel to planes.
                let end = if round % 3 == 0 { 3 } else { 9 };
                let u = [0; 3].map(|_: i32| next(end) - end as i64 / 2);
                if u != [0; 3] && !normals.contains(&u) {
                    normals.push(u);
                }
            }
            let offsets = normals
                .iter()
                .map(|u| 1 + u.iter().map(|n| n.abs()).sum::<i64>() * (1 + next(2)))
                .collect();
            let body = ConvexBody { normals, offsets, volume: 0.0 };
            let found: BTreeSet<Facets> = around(&body, [0; 3]).into_keys().collect();
            assert_eq!(found, by_triples(&body), "{body:?}");
            all += found.len();
        }
        assert!(all > 300, "{all}");
    }

    #[test]
    fn boxes_tetrahedra_and_touching_planes() {
        let axes = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]];
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-12 * b;
        assert!(near(volume(&axes, &[3, 0, 4, 0, 5, 0]), 60.0));
        // A plane through a corner, one through an edge and one far away change nothing.
        let more: Vec<_> = axes.into_iter().chain([[1, 1, 1], [1, 1, 0], [1, 2, 3]]).collect();
        assert!(near(volume(&more, &[3, 0, 4, 0, 5, 0, 12, 7, 99]), 60.0));
        // A plane cuts a corner off.
        assert!(near(volume(&more, &[3, 0, 4, 0, 5, 0, 11, 7, 99]), 60.0 - 1.0 / 6.0));
        let tetrahedron = [[-1, 0, 0], [0, -1, 0], [0, 0, -1], [1, 1, 1]];
        assert!(near(volume(&tetrahedron, &[0, 0, 0, 6]), 36.0));
    }
}
