//! The Voronoi diagram as lists.
//!
//! Idea: its vertices are the centers of groups of simplices with one sphere; its ridges are the cycles of simplices around the
//! edges of the triangulation, each group once; the region of a site is its star.
//! Guarantee: combinatorially exact. An edge whose cells share less than a ridge, as a diagonal of a square does, has none.

use rayon::prelude::*;
use taut_predicates::{Sign, space};

use super::TriangulationIndex;
use crate::geometry::{InPlane, InSpace};
use crate::query::locator::star_of;
use crate::simplex::{GHOST, decode};

/// In place of a vertex: the region or ridge reaches to infinity.
const AT_INFINITY: u32 = u32::MAX;

/// Regions of one task.
const TASK: usize = 1 << 10;

/// A Voronoi diagram. Vertices have numbers, `u32::MAX` stands for infinity.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VoronoiDiagram<const D: usize> {
    /// The vertices.
    pub vertices: Vec<[f64; D]>,
    /// For each simplex its vertex.
    pub of_simplices: Vec<u32>,
    /// The rows whose regions meet in each ridge, the lower one first.
    pub ridge_rows: Vec<[u32; 2]>,
    /// Ridge i has the vertices `ridge_starts[i]..ridge_starts[i + 1]`.
    pub ridge_starts: Vec<u64>,
    /// The vertices of ridges, in order around each, infinity or the lowest first.
    pub ridge_vertices: Vec<u32>,
    /// The row of each region, ascending; rows that equal an earlier one have none.
    pub region_rows: Vec<u32>,
    /// Region i has the vertices `region_starts[i]..region_starts[i + 1]`.
    pub region_starts: Vec<u64>,
    /// The vertices of regions; in the plane counter-clockwise with infinity or the lowest first, in space ascending with
    /// infinity first.
    pub region_vertices: Vec<u32>,
}

/// The part of the diagram that belongs to one site.
#[derive(Default)]
struct Part {
    region: Vec<u32>,
    ridges: Vec<([u32; 2], Vec<u32>)>,
}

/// A cycle without repetitions side by side, turned so that infinity or the lowest number is first.
fn canonical_cycle(mut cycle: Vec<u32>) -> Vec<u32> {
    cycle.dedup();
    if cycle.len() > 1 && cycle.first() == cycle.last() {
        cycle.pop();
    }
    let first = (0..cycle.len()).min_by_key(|&i| cycle[i].wrapping_add(1)).unwrap_or(0);
    cycle.rotate_left(first);
    cycle
}

impl<const D: usize, const V: usize> TriangulationIndex<D, V> {
    /// The vertex of a slot.
    fn vertex_of(&self, slot: u32, of_simplices: &[u32]) -> u32 {
        // A ghost has no place.
        of_simplices.get(self.order.places[slot as usize] as usize).copied().unwrap_or(AT_INFINITY)
    }

    fn diagram_by(
        &self,
        centers: Vec<([f64; D], f64)>,
        groups: Vec<u32>,
        part: impl Fn(u32, &[u32]) -> Part + Sync,
    ) -> VoronoiDiagram<D> {
        let mut of_simplices = vec![0; groups.len()];
        let (mut vertices, mut volumes) = (Vec::new(), Vec::new());
        for (number, &group) in groups.iter().enumerate() {
            let (center, volume) = centers[number];
            if group as usize == number {
                of_simplices[number] = vertices.len() as u32;
                vertices.push(center);
                volumes.push(volume);
                continue;
            }
            // The best determined center of a group is that of its fattest simplex.
            let vertex = of_simplices[group as usize];
            of_simplices[number] = vertex;
            if volume > volumes[vertex as usize] {
                vertices[vertex as usize] = center;
                volumes[vertex as usize] = volume;
            }
        }
        let mut sites: Vec<u32> = (0..self.triangulation.site_count() as u32).collect();
        sites.par_sort_unstable_by_key(|&site| self.triangulation.row(site));
        let parts: Vec<Part> =
            sites.par_iter().with_min_len(TASK).map(|&site| part(site, &of_simplices)).collect();
        let mut diagram = VoronoiDiagram {
            vertices,
            of_simplices,
            ridge_starts: vec![0],
            region_starts: vec![0],
            ..VoronoiDiagram::default()
        };
        for (&site, part) in sites.iter().zip(parts) {
            diagram.region_rows.push(self.triangulation.row(site));
            diagram.region_vertices.extend(part.region);
            diagram.region_starts.push(diagram.region_vertices.len() as u64);
            for (rows, vertices) in part.ridges {
                diagram.ridge_rows.push(rows);
                diagram.ridge_vertices.extend(vertices);
                diagram.ridge_starts.push(diagram.ridge_vertices.len() as u64);
            }
        }
        diagram
    }
}

impl TriangulationIndex<2, 3> {
    /// The Voronoi diagram; nothing if the sites do not span the plane. O(simplices).
    pub fn voronoi(&self) -> VoronoiDiagram<2> {
        if self.order.finite.is_empty() {
            return VoronoiDiagram::default();
        }
        let (centers, groups) = (self.centers_by::<InPlane>(), self.groups_by::<InPlane>());
        self.diagram_by(centers, groups, |site, of_simplices| self.part(site, of_simplices))
    }

    /// Turns counter-clockwise around a site.
    fn part(&self, site: u32, of_simplices: &[u32]) -> Part {
        let slots = self.triangulation.slots();
        let row = self.triangulation.row(site);
        let first = self.directory.at_site[site as usize];
        let (mut here, mut part) = (first, Part::default());
        loop {
            let triangle = &slots[here as usize];
            let i = triangle.vertices.iter().position(|&v| v == site).unwrap_or(0);
            let (next, _) = decode(triangle.neighbors[(i + 1) % 3]);
            let other = triangle.vertices[(i + 2) % 3];
            let ends = [here, next].map(|slot| self.vertex_of(slot, of_simplices));
            part.region.push(ends[0]);
            if other != GHOST && ends[0] != ends[1] {
                let other = self.triangulation.row(other);
                if row < other {
                    part.ridges.push(([row, other], canonical_cycle(ends.to_vec())));
                }
            }
            here = next;
            if here == first {
                break;
            }
        }
        part.region = canonical_cycle(part.region);
        part.ridges.sort_unstable();
        part
    }
}

impl TriangulationIndex<3, 4> {
    /// The Voronoi diagram; nothing if the sites do not span space. O(simplices).
    pub fn voronoi(&self) -> VoronoiDiagram<3> {
        if self.order.finite.is_empty() {
            return VoronoiDiagram::default();
        }
        let (centers, groups) = (self.centers_by::<InSpace>(), self.groups_by::<InSpace>());
        self.diagram_by(centers, groups, |site, of_simplices| self.part(site, of_simplices))
    }

    /// Goes through the star of a site, and around each of its edges to sites of higher rows.
    fn part(&self, site: u32, of_simplices: &[u32]) -> Part {
        let slots = self.triangulation.slots();
        let row = self.triangulation.row(site);
        let mut star = Vec::new();
        star_of(slots, self.directory.at_site[site as usize], site, &mut star);
        let mut edges: Vec<(u32, u32, u32)> = Vec::new();
        for &t in &star {
            for v in slots[t as usize].vertices {
                if v != GHOST && v != site && self.triangulation.row(v) > row {
                    edges.push((self.triangulation.row(v), v, t));
                }
            }
        }
        edges.sort_unstable();
        edges.dedup_by_key(|edge| edge.0);
        let ridges = edges.into_iter().filter_map(|(other, v, t)| {
            Some(([row, other], self.ridge(site, v, t, of_simplices)?))
        });
        let ridges = ridges.collect();
        let mut region: Vec<u32> = star.iter().map(|&t| self.vertex_of(t, of_simplices)).collect();
        region.sort_unstable_by_key(|v| v.wrapping_add(1));
        region.dedup();
        Part { region, ridges }
    }

    /// The vertices around the edge from `a` to `b`, of which `first` is a simplex; none if the regions share less than a
    /// ridge.
    fn ridge(&self, a: u32, b: u32, first: u32, of_simplices: &[u32]) -> Option<Vec<u32>> {
        let slots = self.triangulation.slots();
        let others = |t: u32| {
            let vertices = slots[t as usize].vertices;
            let mut places = (0..4).filter(|&i| vertices[i] != a && vertices[i] != b);
            [places.next().unwrap_or(0), places.next().unwrap_or(0)]
        };
        let (mut here, mut leave) = (first, others(first)[0]);
        let (mut cycle, mut beyond) = (Vec::new(), Vec::new());
        loop {
            let simplex = &slots[here as usize];
            cycle.push(self.vertex_of(here, of_simplices));
            if simplex.is_ghost() {
                let others = others(here).map(|i| simplex.vertices[i]);
                beyond.extend(others.into_iter().filter(|&v| v != GHOST));
            }
            let [p, q] = others(here);
            let kept = simplex.vertices[if leave == p { q } else { p }];
            let (next, _) = decode(simplex.neighbors[leave]);
            let vertices = slots[next as usize].vertices;
            leave = vertices.iter().position(|&v| v == kept).unwrap_or(0);
            here = next;
            if here == first {
                break;
            }
        }
        let mut cycle = canonical_cycle(cycle);
        match (cycle.as_slice(), beyond.as_slice()) {
            ([_], _) => return None,
            // Between two finite vertices there is an edge of the diagram, no ridge.
            ([first, _], _) if *first != AT_INFINITY => return None,
            // One vertex and a flat of the hull: a ray.
            ([_, _], &[c, d]) => {
                let [a, b, c, d] =
                    [a, b, c, d].map(|v| self.triangulation.sites.coordinates[v as usize]);
                if space::orient(a, b, c, d) == Sign::Zero {
                    return None;
                }
            }
            _ => {}
        }
        if cycle.len() > 2 && cycle[1].wrapping_add(1) > cycle[cycle.len() - 1].wrapping_add(1) {
            cycle[1..].reverse();
        }
        Some(cycle)
    }
}
