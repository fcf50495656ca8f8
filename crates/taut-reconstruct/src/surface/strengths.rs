//! How strongly each facet says that the cells on both sides are of one medium, or that a surface is between them.
//!
//! *Idea.* s = (r² + q² − d²)/(2rq) for spheres of radii r and q whose centres are d apart is the cosine of the angle between them, but
//! for its sign: near 1 they are nearly one, which cells deep within a body or deep outside are; near −1 they barely meet, which they
//! do through the facets of a surface that is sampled well. On the hull the sphere outside is a half-space, and s = −h/r with the
//! height h of the centre within the hull; between two ghosts it is the cosine between the normals of their facets. It does not change
//! with scale.
//! *Guarantee.* s is a function of the points, to the last bit: spheres and normals are formed with sites in the order of their numbers.

use rayon::prelude::*;
use taut_delaunay::{GHOST, decode};

use super::cells::{Cells, Kind};
use super::spheres::{Point, Sphere, circumcircle, circumsphere, cross, dot, minus};

/// Slots of one task.
const TASK: usize = 1 << 14;
/// Steps of |s| between 0 and 1: so many that roundings of s can be told from nothing.
const STEPS: f64 = (1u32 << 30) as f64;

/// A facet and what it says.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tie {
    /// |s| in steps; the sign in the lowest bit, 1 for opposite.
    pub(super) key: u32,
    /// `cell << 2 | facet`, from a cell that is no ghost if there is one.
    pub(super) facet: u32,
    /// The cell across, or the one ghost that stands for all if they are one.
    pub(super) other: u32,
}

impl Tie {
    fn new(facet: u32, other: u32, s: f64) -> Self {
        // What is not a number says nothing.
        let s = if s.is_nan() { 0.0 } else { s.clamp(-1.0, 1.0) };
        Self { key: ((s.abs() * STEPS + 0.5) as u32) << 1 | u32::from(s < 0.0), facet, other }
    }

    /// The two cells, by the numbers that stand for them.
    pub(super) fn nodes(self) -> [u32; 2] {
        [self.facet >> 2, self.other]
    }

    pub(super) fn is_opposite(self) -> bool {
        self.key & 1 == 1
    }

    /// |s| in steps.
    pub(super) fn strength(self) -> u32 {
        self.key >> 1
    }

    /// s in steps. Sums of it are exact, and so the same in any order.
    pub(super) fn signed(self) -> i64 {
        let strength = i64::from(self.strength());
        if self.is_opposite() { -strength } else { strength }
    }
}

/// As many steps as a facet has that is certain.
pub(super) const CERTAIN: i64 = STEPS as i64;

/// The ties of all facets, each once, in the order of the slots, in as many parts as there were tasks.
pub(super) struct Ties {
    parts: Vec<Vec<Tie>>,
}

impl Ties {
    /// The ties between cells. Where one ghost stands for all, there are none between ghosts.
    pub(super) fn of(cells: &Cells, points: &[Point], ghost: Option<u32>) -> Self {
        let spheres = spheres(cells, points);
        let geometry = Geometry { cells, points, spheres: &spheres, ghost };
        let task = |begin: usize| {
            let end = cells.len().min(begin + TASK);
            // A cell has four facets, and a facet two cells.
            let mut part = Vec::with_capacity(2 * (end - begin) + TASK / 8);
            for cell in begin as u32..end as u32 {
                match cells.kind(cell) {
                    Kind::Finite => geometry.of_finite(cell, &mut part),
                    Kind::Ghost if ghost.is_none() => geometry.of_ghost(cell, &mut part),
                    Kind::Ghost | Kind::Empty => {}
                }
            }
            part
        };
        let begins: Vec<usize> = (0..cells.len()).step_by(TASK).collect();
        Self { parts: begins.into_par_iter().map(task).collect() }
    }

    /// How many facets say "opposite" with at least half of what is certain, between cells of one label.
    pub(super) fn overruled(&self, inside: &[bool]) -> u64 {
        let is_sure = |tie: &Tie| tie.is_opposite() && 2 * i64::from(tie.strength()) >= CERTAIN;
        let is_within = |tie: &Tie| {
            let [a, b] = tie.nodes();
            inside[a as usize] == inside[b as usize]
        };
        self.iter().filter(|tie| is_sure(tie) && is_within(tie)).count() as u64
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = Tie> {
        self.parts.iter().flatten().copied()
    }
}

/// What a single facet says: s in steps, as [`Ties`] have it.
pub(super) fn strength_of(cells: &Cells, points: &[Point], code: u32) -> i64 {
    let (cell, i) = decode(code);
    let (other, _) = cells.across(cell, i);
    let sphere = |cell: u32| sphere_of(cells, points, cell);
    Tie::new(
        code,
        other,
        match (cells.is_ghost(cell), cells.is_ghost(other)) {
            (false, false) => between(sphere(cell), sphere(other), || corners(cells, points, code)),
            (false, true) => on_hull(sphere(cell), cells.facet(cell, i), points),
            (true, false) => {
                let (finite, back) = cells.across(cell, i);
                on_hull(sphere(finite), cells.facet(finite, back), points)
            }
            (true, true) => dot(normal_of(cells, points, cell), normal_of(cells, points, other)),
        },
    )
    .signed()
}

/// The corners of a finite facet in the order of their sites.
fn corners(cells: &Cells, points: &[Point], code: u32) -> [Point; 3] {
    cells.name(code).map(|site| points[site as usize])
}

fn sphere_of(cells: &Cells, points: &[Point], cell: u32) -> Sphere {
    let mut sites = cells.sites(cell);
    sites.sort_unstable();
    circumsphere(sites.map(|site| points[site as usize]))
}

/// The circumspheres by slot; of ghosts and empty slots, none that means anything.
fn spheres(cells: &Cells, points: &[Point]) -> Vec<Sphere> {
    let of = |cell: u32| match cells.kind(cell) {
        Kind::Finite => sphere_of(cells, points, cell),
        Kind::Ghost | Kind::Empty => Sphere { center: [0.0; 3], radius: 0.0 },
    };
    (0..cells.len() as u32).into_par_iter().with_min_len(TASK).map(of).collect()
}

struct Geometry<'a> {
    cells: &'a Cells,
    points: &'a [Point],
    spheres: &'a [Sphere],
    ghost: Option<u32>,
}

impl Geometry<'_> {
    fn of_finite(&self, cell: u32, part: &mut Vec<Tie>) {
        let own = self.spheres[cell as usize];
        for i in 0..4 {
            let (other, _) = self.cells.across(cell, i);
            let facet = cell << 2 | i as u32;
            if self.cells.is_ghost(other) {
                let s = on_hull(own, self.cells.facet(cell, i), self.points);
                part.push(Tie::new(facet, self.ghost.unwrap_or(other), s));
            } else if other > cell {
                let corners = || corners(self.cells, self.points, facet);
                let s = between(own, self.spheres[other as usize], corners);
                part.push(Tie::new(facet, other, s));
            }
        }
    }

    fn of_ghost(&self, cell: u32, part: &mut Vec<Tie>) {
        let own = normal_of(self.cells, self.points, cell);
        for i in 0..4 {
            let (other, _) = self.cells.across(cell, i);
            if self.cells.is_ghost(other) && other > cell {
                let s = dot(own, normal_of(self.cells, self.points, other));
                part.push(Tie::new(cell << 2 | i as u32, other, s));
            }
        }
    }
}

/// s of the spheres of two cells, the same whichever is first; `facet` gives the corners of their common facet in the order of sites.
fn between(one: Sphere, other: Sphere, facet: impl FnOnce() -> [Point; 3]) -> f64 {
    /// Beyond this, differences of squares of distances are lost to rounding.
    const UNLIKE: f64 = 1e3;
    let (r, q) = (one.radius, other.radius);
    if r.max(q) <= UNLIKE * r.min(q) {
        let apart = minus(one.center, other.center);
        return (r * r + q * q - dot(apart, apart)) / (2.0 * r * q);
    }
    // With the radius c of the circle of the facet, and the heights of the centres over it, s = (c² + hk)/(rq).
    let [a, b, c] = facet();
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
    let place = cells.sites(ghost).iter().position(|&site| site == GHOST).unwrap_or(0);
    let (finite, back) = cells.across(ghost, place);
    normal(cells.facet(finite, back), points).0
}

/// The unit normal of a facet, towards where it is seen counter-clockwise from, and its site of the lowest number.
fn normal(facet: [u32; 3], points: &[Point]) -> (Point, Point) {
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
        let none = || [[0.0; 3]; 3];
        assert_eq!(between(ball(0.0, 1.0), ball(3.0, 2.0), none), -1.0);
        assert_eq!(between(ball(0.0, 2.0), ball(0.0, 2.0), none), 1.0);
        assert_eq!(between(ball(0.0, 3.0), ball(5.0, 4.0), none), 0.0);
    }

    #[test]
    fn a_large_sphere_is_a_half_space() {
        // Both through the unit circle around the origin across the axis of x.
        let facet = || [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]];
        let ball = |x: f64| Sphere { center: [x, 0.0, 0.0], radius: x.hypot(1.0) };
        for x in [1e5, 1e12, 1e18] {
            assert!((between(ball(x), ball(1.0), facet) - 0.5f64.sqrt()).abs() < 2.0 / x + 1e-15);
            assert!((between(ball(1.0), ball(-x), facet) + 0.5f64.sqrt()).abs() < 2.0 / x + 1e-15);
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
        assert_eq!(Tie::new(0, 1, f64::NAN).signed(), 0);
        assert_eq!(Tie::new(0, 1, -7.0).signed(), -CERTAIN);
    }
}
