//! The volume of a convex body with whole half-spaces.
//!
//! *Idea.* The vertices are the points of three facets that all half-spaces hold, in fractions. An edge joins the two vertices
//! that two facets have in common. A tetrahedron spans an interior point, a vertex of a facet and an edge of that facet; these
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
    let facets = normals.len();
    let mut vertices = BTreeMap::new();
    for i in 0..facets {
        for j in i + 1..facets {
            let crossed = cross(normals[i], normals[j]);
            if crossed == [0; 3] {
                continue;
            }
            for k in j + 1..facets {
                let divisor = dot(crossed, normals[k]);
                if divisor == 0 {
                    continue;
                }
                // Cramer's rule, with a positive divisor.
                let (jk, ki) = (cross(normals[j], normals[k]), cross(normals[k], normals[i]));
                let sign = divisor.signum();
                let at = [0, 1, 2].map(|c| {
                    sign * (offsets[i] * jk[c] + offsets[j] * ki[c] + offsets[k] * crossed[c])
                });
                let divisor = divisor.abs();
                let mut on = [0u64; 4];
                let is_vertex = (0..facets).all(|facet| {
                    let beyond = dot(normals[facet], at) - offsets[facet] * divisor;
                    on[facet / 64] |= u64::from(beyond == 0) << (facet % 64);
                    beyond <= 0
                });
                if is_vertex {
                    vertices.insert(on, at.map(|x| x as f64 / divisor as f64));
                }
            }
        }
    }
    vertices
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
