//! Measures how strongly each facet says that the cells on both sides are on one side of the surface, or that a surface is between them.
//!
//! *Idea.* s = (r² + q² − d²)/(2rq) for spheres of radii r and q whose centers are d apart is the cosine of the angle between them, but
//! for its sign: near 1 they are nearly one, which cells deep within a body or deep outside are; near −1 they barely meet, which they
//! do through the facets of a surface that is sampled well. On the hull the sphere outside is a half-space, and s = −h/r with the
//! height h of the center within the hull; between two ghosts it is the cosine between the normals of their facets. It does not change
//! with scale.
//! *Guarantee.* s is a function of the points, to the last bit: spheres and normals are formed with sites in the order of their numbers.

use std::ops::Range;
use std::sync::atomic::AtomicU32;
use std::sync::atomic::Ordering::Relaxed;

use rayon::prelude::*;
use taut_delaunay::decode;

use super::cells::Cells;
use super::flats::{FLAT_RATIO_MAX, flats};
use super::lanes::write_spheres;
use super::spheres::{Point, Sphere, circumcircle, cross, dot, minus};

/// Cells of one task.
const TASK: usize = 1 << 12;
/// There are so many steps of |s| between 0 and 1 that roundings of s can be told from nothing.
const WEIGHT_STEPS: f64 = (1u32 << 30) as f64;
/// A facet that is certain has as many steps.
pub(super) const CERTAIN_STEPS: i64 = WEIGHT_STEPS as i64;

/// The edge between two ghosts that are one: more than any other.
const ONE: DualEdge = DualEdge { key: ((1 << 30) + 1) << 1 };

/// The sign and weight of a facet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct DualEdge {
    /// |s| in steps; the sign in the lowest bit, 1 for opposite.
    pub(super) key: u32,
}

impl DualEdge {
    fn new(s: f64) -> Self {
        // NaN carries no evidence.
        let s = if s.is_nan() { 0.0 } else { s.clamp(-1.0, 1.0) };
        Self { key: ((s.abs() * WEIGHT_STEPS + 0.5) as u32) << 1 | u32::from(s < 0.0) }
    }

    pub(super) fn is_opposite(self) -> bool {
        self.key & 1 == 1
    }

    /// |s| in steps.
    pub(super) fn weight(self) -> u32 {
        self.key >> 1
    }

    /// s in steps. Sums of it are exact, and so the same in any order.
    pub(super) fn signed(self) -> i64 {
        let weight = i64::from(self.weight());
        if self.is_opposite() { -weight } else { weight }
    }
}

/// The signs and weights of all facets, each twice: at either of its cells.
pub(super) struct DualEdges {
    /// Keys by cell and place. Each is written by whoever has the facet's first cell, so tasks write beside each other.
    all: Vec<[AtomicU32; 4]>,
}

impl DualEdges {
    /// The dual edges between cells. Where ghosts are one, nothing is stronger than what they are joined by.
    pub(super) fn of(cells: &Cells, points: &[Point], ghosts_are_one: bool) -> Self {
        let (mut spheres, flat) = spheres(cells, points);
        let geometry = Geometry { cells, points, spheres: &spheres, ghosts_are_one };
        let every = (0..cells.len() as u32).into_par_iter().with_min_len(TASK);
        let dual_edges = Self { all: every.map(|_| Default::default()).collect() };
        let begins: Vec<usize> = (0..cells.len()).step_by(TASK).collect();
        begins.into_par_iter().for_each_init(Vec::new, |facets, begin| {
            firsts(begin as u32..cells.len().min(begin + TASK) as u32, cells, facets);
            facets
                .iter()
                .for_each(|&facet| dual_edges.set(cells, facet, geometry.dual_edge(facet)));
        });
        let taken = flats(&flat, &dual_edges, (cells, points), &mut spheres);
        let geometry = Geometry { cells, points, spheres: &spheres, ghosts_are_one };
        for facet in taken.iter().flat_map(|cell| (0..4).map(move |i| cell << 2 | i)) {
            dual_edges.set(cells, facet, geometry.dual_edge(facet));
        }
        dual_edges
    }

    /// Writes that of a facet at both its cells.
    #[inline]
    fn set(&self, cells: &Cells, facet: u32, dual_edge: DualEdge) {
        for (cell, i) in [facet, cells.mirror(facet)].map(decode) {
            self.all[cell as usize][i].store(dual_edge.key, Relaxed);
        }
    }

    /// That of a facet, `cell << 2 | place`.
    pub(super) fn at(&self, facet: u32) -> DualEdge {
        let (cell, i) = decode(facet);
        DualEdge { key: self.all[cell as usize][i].load(Relaxed) }
    }

    /// Those of the facets of a cell.
    pub(super) fn of_cell(&self, cell: u32) -> [DualEdge; 4] {
        let [a, b, c, d] = &self.all[cell as usize];
        let dual_edge = |key: &AtomicU32| DualEdge { key: key.load(Relaxed) };
        [dual_edge(a), dual_edge(b), dual_edge(c), dual_edge(d)]
    }

    /// The facets of some cells that say "opposite" with at least half of what is certain, between cells of one label.
    pub(super) fn overruled(&self, some: &[u32], cells: &Cells, inside: &[bool]) -> Vec<u32> {
        let is_sure = |facet: &u32| {
            let dual_edge = self.at(*facet);
            dual_edge.is_opposite() && 2 * i64::from(dual_edge.weight()) >= CERTAIN_STEPS
        };
        let is_within = |facet: &u32| {
            inside[(facet >> 2) as usize] == inside[(cells.mirror(*facet) >> 2) as usize]
        };
        let facets = some.iter().flat_map(|&cell| (0..4).map(move |i| cell << 2 | i));
        let found = facets.filter(is_sure).filter(is_within);
        let mut found: Vec<u32> = found.map(|facet| facet.min(cells.mirror(facet))).collect();
        found.sort_unstable();
        found.dedup();
        found
    }
}

/// Lists the facets of some cells from the first of their two cells.
fn firsts(some: Range<u32>, cells: &Cells, facets: &mut Vec<u32>) {
    facets.resize(4 * some.len(), 0);
    let mut count = 0;
    for cell in some {
        for i in 0..4 {
            // All are written and half of them written over: which is the first cell cannot be guessed.
            facets[count] = cell << 2 | i as u32;
            count += usize::from(cells.across(cell, i).0 > cell);
        }
    }
    facets.truncate(count);
}

/// The circumspheres by cell, of ghosts some of no size, and the flat cells.
fn spheres(cells: &Cells, points: &[Point]) -> (Vec<Sphere>, Vec<u32>) {
    let mut spheres = vec![Sphere { center: [0.0; 3], radius: 0.0 }; cells.len()];
    let tasks = spheres.par_chunks_mut(TASK).enumerate();
    let flats =
        tasks.map(|(k, own)| write_spheres(own, (k * TASK) as u32, cells, points, FLAT_RATIO_MAX));
    let flats: Vec<Vec<u32>> = flats.collect();
    (spheres, flats.concat())
}

/// The spheres and normals that weights are made from.
struct Geometry<'a> {
    cells: &'a Cells,
    points: &'a [Point],
    /// By cell; of ghosts, spheres of no size.
    spheres: &'a [Sphere],
    ghosts_are_one: bool,
}

impl Geometry<'_> {
    /// Returns what a facet says.
    #[inline(always)]
    fn dual_edge(&self, facet: u32) -> DualEdge {
        let (cell, i) = decode(facet);
        let (other, k) = self.cells.across(cell, i);
        let (one, two) = (self.spheres[cell as usize], self.spheres[other as usize]);
        if one.is_like(two) {
            return DualEdge::new(near(one, two));
        }
        self.unlike([cell, other], [i, k])
    }

    /// The same where the spheres are not alike, as that of a ghost is not like any.
    #[cold]
    fn unlike(&self, cells: [u32; 2], places: [usize; 2]) -> DualEdge {
        let [facet, back] = [0, 1].map(|k| self.cells.facet(cells[k], places[k]));
        let [one, two] = cells.map(|cell| self.spheres[cell as usize]);
        let points = self.points;
        DualEdge::new(match cells.map(|cell| self.cells.is_ghost(cell)) {
            [false, false] => far(one, two, corners(facet, points)),
            [false, true] => on_hull(one, facet, points),
            [true, false] => on_hull(two, back, points),
            [true, true] if self.ghosts_are_one => return ONE,
            [true, true] => {
                let [m, n] = cells.map(|cell| normal_of(self.cells, points, cell));
                dot(m, n)
            }
        })
    }
}

/// The corners of a finite facet in the order of their sites.
fn corners(mut facet: [u32; 3], points: &[Point]) -> [Point; 3] {
    facet.sort_unstable();
    facet.map(|site| points[site as usize])
}

impl Sphere {
    /// Returns true if two radii are so much alike that differences of squares are not lost to rounding.
    fn is_like(self, other: Sphere) -> bool {
        const RADII_RATIO_MAX: f64 = 1e3;
        let (r, q) = (self.radius, other.radius);
        0.0 < r && r <= RADII_RATIO_MAX * q && q <= RADII_RATIO_MAX * r
    }
}

/// s of the spheres of two cells which are alike, the same whichever is first.
fn near(one: Sphere, other: Sphere) -> f64 {
    let (r, q) = (one.radius, other.radius);
    let apart = minus(one.center, other.center);
    (r * r + q * q - dot(apart, apart)) / (2.0 * r * q)
}

/// The same where one is much larger than the other, from the corners of their common facet in the order of sites.
#[cold]
fn far(one: Sphere, other: Sphere, [a, b, c]: [Point; 3]) -> f64 {
    // With the radius c of the circle of the facet, and the heights of the centers over it, s = (c² + hk)/(rq).
    let (r, q) = (one.radius, other.radius);
    let normal = cross(minus(b, a), minus(c, a));
    let size = dot(normal, normal).sqrt();
    let [h, k] = [one, other].map(|sphere| dot(minus(sphere.center, a), normal) / size);
    let circle = circumcircle(a, b, c).radius;
    // Sums and quotients in this order leave the range of numbers last.
    (circle / r) * (circle / q) + (h / r) * (k / q)
}

/// s of a sphere and the half-space beyond a facet of the hull.
fn on_hull(sphere: Sphere, facet: [u32; 3], points: &[Point]) -> f64 {
    let (normal, base) = normal(facet, points);
    dot(minus(sphere.center, base), normal) / sphere.radius
}

/// The unit normal of the facet of the hull that a ghost stands for, outward.
fn normal_of(cells: &Cells, points: &[Point], ghost: u32) -> Point {
    let (finite, back) = cells.across(ghost, 3);
    normal(cells.facet(finite, back), points).0
}

/// The unit normal of a facet, towards where it is seen counter-clockwise from, and its site of the lowest number.
pub(super) fn normal(facet: [u32; 3], points: &[Point]) -> (Point, Point) {
    let mut sites = facet;
    sites.sort_unstable();
    // Turned back to what it was if sorting turned it.
    let is_turned = (0..3).filter(|&k| facet[k] > facet[(k + 1) % 3]).count() == 2;
    let [a, b, c] = sites.map(|site| points[site as usize]);
    let normal = cross(minus(b, a), minus(c, a));
    let size = dot(normal, normal).sqrt();
    (normal.map(|x| if is_turned { -x / size } else { x / size }), a)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spheres_that_touch_are_opposite_and_equal_ones_alike() {
        let ball = |x: f64, radius: f64| Sphere { center: [x, 0.0, 0.0], radius };
        assert_eq!(near(ball(0.0, 1.0), ball(3.0, 2.0)), -1.0);
        assert_eq!(near(ball(0.0, 2.0), ball(0.0, 2.0)), 1.0);
        assert_eq!(near(ball(0.0, 3.0), ball(5.0, 4.0)), 0.0);
    }

    #[test]
    fn a_large_sphere_is_a_half_space() {
        // Both through the unit circle around the origin across the axis of x.
        let facet = [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]];
        let ball = |x: f64| Sphere { center: [x, 0.0, 0.0], radius: x.hypot(1.0) };
        for x in [1e5, 1e12, 1e18] {
            assert!((far(ball(x), ball(1.0), facet) - 0.5f64.sqrt()).abs() < 2.0 / x + 1e-15);
            assert!((far(ball(1.0), ball(-x), facet) + 0.5f64.sqrt()).abs() < 2.0 / x + 1e-15);
        }
    }

    #[test]
    fn a_half_space_is_a_sphere_of_no_end() {
        let points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        for facet in [[0, 1, 2], [1, 2, 0], [2, 0, 1]] {
            // The facet is seen from above, so the sphere below it is within the hull.
            let below = Sphere { center: [0.3, 0.3, -1.0], radius: 2.0 };
            assert_eq!(on_hull(below, facet, &points), -0.5);
        }
        let above = Sphere { center: [0.3, 0.3, 1.0], radius: 2.0 };
        assert_eq!(on_hull(above, [0, 1, 2], &points), 0.5);
    }

    #[test]
    fn what_is_not_a_number_says_nothing() {
        assert_eq!(DualEdge::new(f64::NAN).signed(), 0);
        assert_eq!(DualEdge::new(-7.0).signed(), -CERTAIN_STEPS);
    }
}
