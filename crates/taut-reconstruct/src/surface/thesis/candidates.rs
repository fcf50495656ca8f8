//! The facets that the front chooses from, with their edges and sites.
//!
//! *Idea.* Candidates are numbered by their sites, edges by theirs: so every tie that numbers break is broken by the point set. The
//! candidates at an edge and at a site are runs of two arrays; a front that asks for them thousands of times needs no hashing.
//! *Trap.* The order of candidates around an edge is not theirs to tell, but the triangulation's ([`super::ring`]).

use taut_points::parallel::ParallelSlice;

use super::options::Priority;
use crate::surface::alpha::passing;
use crate::surface::filter::{Filter, is_gabriel};
use crate::surface::sides::{Side, Sides};
use crate::surface::vector::{Vector, circumcenter, dot, minus, sphere_center};

/// Stands for no candidate.
pub(super) const NONE: u32 = u32::MAX;

/// Candidates T_c, in the order of their sites.
pub(super) struct Candidates {
    pub(super) sides: Vec<Side>,
    /// The sites of each, in order.
    pub(super) sites: Vec<[u32; 3]>,
    /// The edges opposite these.
    pub(super) edges: Vec<[u32; 3]>,
    /// The sites of each edge, in order; edges are in the order of these.
    pub(super) ends: Vec<[u32; 2]>,
    /// For each side its candidate, or [`NONE`].
    of_side: Vec<u32>,
    at_edge: Runs,
    at_site: Runs,
    /// The circumcenter of each, as `f64` has it.
    centers: Vec<Vector>,
    /// The square of what the front prefers to be small, if that is a property of the candidate alone.
    sizes: Vec<f64>,
}

impl Candidates {
    /// All facets that pass the filter.
    pub(super) fn of(sides: &Sides, filter: &Filter, priority: Priority) -> Self {
        let (sites, own) = passing(sides, filter);
        let mut of_side = vec![NONE; 4 * sides.cell_count()];
        for (candidate, &side) in (0..).zip(&own) {
            of_side[side as usize] = candidate;
            of_side[sides.mirror(side) as usize] = candidate;
        }
        let (edges, ends) = edges(&sites);
        let at_edge = Runs::of(ends.len(), &edges);
        let at_site = Runs::of(sides.points.len(), &sites);
        let centers = sites.par_iter().map(|&t| center(sides, t)).collect();
        let size = |(&side, &t): (&Side, &[u32; 3])| match priority {
            Priority::CircumcenterDistance => 0.0,
            Priority::Circumradius => square(sides, t),
            Priority::EmptyBall => empty_ball(sides, side, t),
        };
        let sizes = own.par_iter().zip(sites.par_iter()).map(size).map(finite_or_infinite);
        let sizes =
            if priority == Priority::CircumcenterDistance { vec![] } else { sizes.collect() };
        Self { sides: own, sites, edges, ends, of_side, at_edge, at_site, centers, sizes }
    }

    pub(super) fn len(&self) -> usize {
        self.sides.len()
    }

    /// The candidate that a side belongs to, or [`NONE`].
    pub(super) fn of_side(&self, side: Side) -> u32 {
        self.of_side[side as usize]
    }

    /// The edge of a candidate between two of its sites.
    pub(super) fn edge(&self, candidate: u32, u: u32, v: u32) -> u32 {
        let sites = self.sites[candidate as usize];
        let opposite = sites.iter().position(|&site| site != u && site != v).unwrap_or(0);
        self.edges[candidate as usize][opposite]
    }

    pub(super) fn at_edge(&self, edge: u32) -> &[u32] {
        self.at_edge.run(edge)
    }

    pub(super) fn at_site(&self, site: u32) -> &[u32] {
        self.at_site.run(site)
    }

    /// Returns what makes the one candidate attractive from the other: the less, the more. Infinite where `f64` cannot tell.
    pub(super) fn measure(&self, from: u32, to: u32) -> f64 {
        if let Some(&size) = self.sizes.get(to as usize) {
            return size;
        }
        let way = minus(self.centers[to as usize], self.centers[from as usize]);
        finite_or_infinite(dot(way, way))
    }
}

/// Numbers by key, as runs of one array.
struct Runs {
    starts: Vec<u32>,
    members: Vec<u32>,
}

impl Runs {
    /// For each key the rows that it stands in, ascending.
    fn of(keys: usize, rows: &[[u32; 3]]) -> Self {
        let mut starts = vec![0u32; keys + 1];
        rows.as_flattened().iter().for_each(|&key| starts[key as usize + 1] += 1);
        (0..keys).for_each(|key| starts[key + 1] += starts[key]);
        let mut next = starts.clone();
        let mut members = vec![0; 3 * rows.len()];
        for (row, keys) in (0..).zip(rows) {
            for &key in keys {
                members[next[key as usize] as usize] = row;
                next[key as usize] += 1;
            }
        }
        Self { starts, members }
    }

    fn run(&self, key: u32) -> &[u32] {
        &self.members[self.starts[key as usize] as usize..self.starts[key as usize + 1] as usize]
    }
}

/// Numbers the edges of triangles with sorted sites.
fn edges(triangles: &[[u32; 3]]) -> (Vec<[u32; 3]>, Vec<[u32; 2]>) {
    let mut all: Vec<([u32; 2], u32)> = Vec::with_capacity(3 * triangles.len());
    for (t, &[a, b, c]) in (0u32..).zip(triangles) {
        all.extend([([b, c], 3 * t), ([a, c], 3 * t + 1), ([a, b], 3 * t + 2)]);
    }
    all.par_sort_unstable();
    let (mut edges, mut ends) = (vec![[0; 3]; triangles.len()], Vec::new());
    for (pair, place) in all {
        if ends.last() != Some(&pair) {
            ends.push(pair);
        }
        edges[place as usize / 3][place as usize % 3] = ends.len() as u32 - 1;
    }
    (edges, ends)
}

fn corners(sides: &Sides, triangle: [u32; 3]) -> (Vector, Vector, Vector) {
    let [a, b, c] = triangle.map(|site| sides.points[site as usize]);
    (a, minus(b, a), minus(c, a))
}

fn center(sides: &Sides, triangle: [u32; 3]) -> Vector {
    let (a, u, v) = corners(sides, triangle);
    let c = circumcenter(u, v);
    [0, 1, 2].map(|i| a[i] + c[i])
}

fn square(sides: &Sides, triangle: [u32; 3]) -> f64 {
    let (_, u, v) = corners(sides, triangle);
    let c = circumcenter(u, v);
    dot(c, c)
}

/// The square of the radius of the smallest empty ball: that of the facet, or of the cell whose vertex lies within that of the facet.
fn empty_ball(sides: &Sides, side: Side, triangle: [u32; 3]) -> f64 {
    if is_gabriel(sides, side) {
        return square(sides, triangle);
    }
    let sphere = |side: Side| {
        if sides.is_ghost(side >> 2) {
            return f64::INFINITY;
        }
        let mut sites = sides.cell(side >> 2);
        sites.sort_unstable();
        let [a, b, c, d] = sites.map(|site| sides.points[site as usize]);
        let center = sphere_center(minus(b, a), minus(c, a), minus(d, a));
        finite_or_infinite(dot(center, center))
    };
    sphere(side).min(sphere(sides.mirror(side)))
}

fn finite_or_infinite(x: f64) -> f64 {
    if x.is_nan() { f64::INFINITY } else { x }
}
