//! The circumspheres of the cells of a Delaunay triangulation, for their sizes and places, not for signs.
//!
//! *Problem.* Cells of samples of a surface are as flat as chance makes them; the circumsphere of a cell without volume is anything.
//! *Idea.* Coordinates relative to the first vertex, vertices in the order of their numbers, so that a sphere is the same bits
//! however the cell was built. A cell without volume, as calculated, has the sphere around the circle of its best facet for its own.
//! *Guarantee.* A function of the points alone; O(1) for each cell.

use super::two_sum::TwoSum;

pub(super) type Point = [f64; 3];

/// Rounding could have made the volume of a cell whose square is this much less than the product of those of the edges from its first
/// vertex, at any size of cell that samples have.
pub(super) const NEARLY_FLAT: f64 = 1e-18;

/// A sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sphere {
    pub(super) center: Point,
    pub(super) radius: f64,
}

/// The circumsphere of a cell, of its best facet if it has no volume. Vertices come in the order of their numbers.
pub(super) fn circumsphere(p: [Point; 4]) -> Sphere {
    let (u, v, w) = (minus(p[1], p[0]), minus(p[2], p[0]), minus(p[3], p[0]));
    let (uu, vv, ww) = (dot(u, u), dot(v, v), dot(w, w));
    let (vw, wu, uv) = (cross(v, w), cross(w, u), cross(u, v));
    let volume = dot(u, vw);
    if volume * volume / (uu * vv * ww) <= NEARLY_FLAT {
        return nearly_flat(p);
    }
    let half = 0.5 / volume;
    let center = [0, 1, 2].map(|k| half * (uu * vw[k] + vv * wu[k] + ww * uv[k]));
    Sphere { center: plus(p[0], center), radius: dot(center, center).sqrt() }
}

/// The circumsphere of a cell whose volume rounding could have made: with twice the precision, as grids that were turned, say, have
/// such cells everywhere, and spheres made of roundings join what is apart. (A tolerance below which a cell has the circle of its best
/// facet does no better: of 200 000 points of triangles it leaves 60 vertices to repair in place of 2.)
fn nearly_flat(p: [Point; 4]) -> Sphere {
    let edge = |k: usize| [0, 1, 2].map(|i| TwoSum::difference(p[k][i], p[0][i]));
    let [u, v, w] = [1, 2, 3].map(edge);
    let dot = |a: [TwoSum; 3], b: [TwoSum; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let cross = |a: [TwoSum; 3], b: [TwoSum; 3]| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let (uu, vv, ww) = (dot(u, u), dot(v, v), dot(w, w));
    let (vw, wu, uv) = (cross(v, w), cross(w, u), cross(u, v));
    let volume = dot(u, vw).high;
    let center = [0, 1, 2].map(|k| (uu * vw[k] + vv * wu[k] + ww * uv[k]).high / (2.0 * volume));
    let sphere = Sphere { center: plus(p[0], center), radius: length(center) };
    if volume == 0.0 || !sphere.radius.is_finite() { best_circle(p) } else { sphere }
}

/// The circle of the facet with the largest area beside its longest edge.
fn best_circle(p: [Point; 4]) -> Sphere {
    const FACETS: [[usize; 3]; 4] = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]];
    let mut best = (-1.0, Sphere { center: p[0], radius: 0.0 });
    for facet in FACETS {
        let [a, b, c] = facet.map(|k| p[k]);
        let (u, v) = (minus(b, a), minus(c, a));
        let n = cross(u, v);
        let longest = dot(u, u).max(dot(v, v)).max(dot(minus(c, b), minus(c, b)));
        let shape = dot(n, n) / (longest * longest);
        if shape > best.0 {
            best = (shape, circumcircle(a, b, c));
        }
    }
    best.1
}

/// The smallest sphere through the corners of a triangle; one of no size around a corner if they lie on a line to rounding.
pub(super) fn circumcircle(a: Point, b: Point, c: Point) -> Sphere {
    let (u, v) = (minus(b, a), minus(c, a));
    let n = cross(u, v);
    let (uu, vv, nn) = (dot(u, u), dot(v, v), dot(n, n));
    if nn <= 0.0 {
        return Sphere { center: a, radius: 0.0 };
    }
    // C − a = ((n × u)·|v|² + (v × n)·|u|²) / (2·|n|²).
    let (nu, vn) = (cross(n, u), cross(v, n));
    let offset = [0, 1, 2].map(|k| (nu[k] * vv + vn[k] * uu) / (2.0 * nn));
    Sphere { center: plus(a, offset), radius: dot(offset, offset).sqrt() }
}

fn length(a: Point) -> f64 {
    dot(a, a).sqrt()
}

pub(super) fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn plus(a: Point, b: Point) -> Point {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(super) fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_are_on_their_sphere() {
        let p = [[1.0, 2.0, 3.0], [2.0, 2.5, 3.0], [1.5, 3.0, 4.0], [0.0, 2.0, 5.0]];
        let sphere = circumsphere(p);
        for corner in p {
            let off = minus(corner, sphere.center);
            assert!((dot(off, off).sqrt() - sphere.radius).abs() < 1e-12);
        }
    }

    #[test]
    fn a_flat_cell_has_the_circle_of_its_best_facet() {
        let square = [[0.0, 0.0, 7.0], [2.0, 0.0, 7.0], [2.0, 2.0, 7.0], [0.0, 2.0, 7.0]];
        let sphere = circumsphere(square);
        assert_eq!(sphere.center, [1.0, 1.0, 7.0]);
        assert!((sphere.radius - 2f64.sqrt()).abs() < 1e-15);
        let line = [[0.0; 3], [1.0, 1.0, 1.0], [2.0, 2.0, 2.0], [3.0, 3.0, 3.0]];
        assert_eq!(circumsphere(line).radius, 0.0);
    }
}
