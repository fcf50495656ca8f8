//! The Voronoi diagram as lists.
//!
//! Idea: its vertices are the centers of groups of simplices with one sphere; its ridges are the cycles of simplices around the
//! edges of the triangulation, each group once; the region of a site is its star.
//! Guarantee: combinatorially exact. An edge whose cells share less than a ridge, as a diagonal of a square does, has none.

use taut_points::parallel::ParallelSlice;
use taut_predicates::{Sign, space};

use super::TriangulationIndex;
use super::star::{NumberSet, Star};
use crate::geometry::{InPlane, InSpace};
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

/// The part of the diagram that belongs to some sites.
#[derive(Default)]
struct Part {
    region_lengths: Vec<u32>,
    region_vertices: Vec<u32>,
    ridge_rows: Vec<[u32; 2]>,
    ridge_lengths: Vec<u32>,
    ridge_vertices: Vec<u32>,
}

impl Part {
    fn add_region(&mut self, vertices: &[u32]) {
        self.region_lengths.push(vertices.len() as u32);
        self.region_vertices.extend_from_slice(vertices);
    }

    fn add_ridge(&mut self, rows: [u32; 2], vertices: &[u32]) {
        self.ridge_rows.push(rows);
        self.ridge_lengths.push(vertices.len() as u32);
        self.ridge_vertices.extend_from_slice(vertices);
    }
}

/// Continues `starts` by runs of these lengths.
fn extend_starts(starts: &mut Vec<u64>, lengths: &[u32]) {
    let mut end = starts.last().copied().unwrap_or(0);
    starts.extend(lengths.iter().map(|&length| {
        end += u64::from(length);
        end
    }));
}

/// Takes repetitions side by side out of a cycle, and turns it so that infinity or the lowest number is first.
fn make_canonical(cycle: &mut Vec<u32>) {
    cycle.dedup();
    if cycle.len() > 1 && cycle.first() == cycle.last() {
        cycle.pop();
    }
    let first = (0..cycle.len()).min_by_key(|&i| cycle[i].wrapping_add(1)).unwrap_or(0);
    cycle.rotate_left(first);
}

impl<const D: usize, const V: usize> TriangulationIndex<D, V> {
    /// The vertex of a slot.
    #[inline(always)]
    fn vertex_of(&self, slot: u32, of_simplices: &[u32]) -> u32 {
        // Ghosts come after the simplices.
        of_simplices.get(slot as usize).copied().unwrap_or(AT_INFINITY)
    }

    /// The diagram, with the parts of runs of sites as `part` makes them.
    fn diagram_by(
        &self,
        centers: Vec<([f64; D], f64)>,
        groups: Vec<u32>,
        part: impl Fn(&[u32], &[u32]) -> Part + Sync,
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
        let parts: Vec<Part> = sites.par_chunks(TASK).map(|run| part(run, &of_simplices)).collect();
        let mut diagram = VoronoiDiagram {
            vertices,
            of_simplices,
            ridge_starts: vec![0],
            region_rows: sites.iter().map(|&site| self.triangulation.row(site)).collect(),
            region_starts: vec![0],
            ..VoronoiDiagram::default()
        };
        for part in parts {
            extend_starts(&mut diagram.region_starts, &part.region_lengths);
            diagram.region_vertices.extend(part.region_vertices);
            extend_starts(&mut diagram.ridge_starts, &part.ridge_lengths);
            diagram.ridge_rows.extend(part.ridge_rows);
            diagram.ridge_vertices.extend(part.ridge_vertices);
        }
        diagram
    }
}

impl TriangulationIndex<2, 3> {
    /// The Voronoi diagram; nothing if the sites do not span the plane. O(simplices).
    pub fn voronoi(&self) -> VoronoiDiagram<2> {
        if self.count == 0 {
            return VoronoiDiagram::default();
        }
        let (centers, groups) = (self.centers_by::<InPlane>(), self.groups_by::<InPlane>());
        self.diagram_by(centers, groups, |sites, of_simplices| {
            let (mut part, mut region, mut ridges) = (Part::default(), Vec::new(), Vec::new());
            for &site in sites {
                region.clear();
                ridges.clear();
                self.turn_around(site, of_simplices, &mut region, &mut ridges);
                make_canonical(&mut region);
                part.add_region(&region);
                ridges.sort_unstable();
                let row = self.triangulation.row(site);
                ridges.iter().for_each(|&(other, ends)| part.add_ridge([row, other], &ends));
            }
            part
        })
    }

    /// Turns counter-clockwise around a site. Ridges are those to sites of higher rows: this row, and its two ends, infinity or the
    /// lower one first.
    fn turn_around(
        &self,
        site: u32,
        of_simplices: &[u32],
        region: &mut Vec<u32>,
        ridges: &mut Vec<(u32, [u32; 2])>,
    ) {
        let slots = self.triangulation.slots();
        let row = self.triangulation.row(site);
        let first = self.directory.at_site[site as usize];
        let mut here = first;
        loop {
            let triangle = &slots[here as usize];
            let i = triangle.vertices.iter().position(|&v| v == site).unwrap_or(0);
            let (next, _) = decode(triangle.neighbors[(i + 1) % 3]);
            let other = triangle.vertices[(i + 2) % 3];
            let [a, b] = [here, next].map(|slot| self.vertex_of(slot, of_simplices));
            region.push(a);
            if other != GHOST && a != b {
                let other = self.triangulation.row(other);
                if row < other {
                    let is_first = a.wrapping_add(1) < b.wrapping_add(1);
                    ridges.push((other, if is_first { [a, b] } else { [b, a] }));
                }
            }
            here = next;
            if here == first {
                break;
            }
        }
    }
}

impl TriangulationIndex<3, 4> {
    /// The Voronoi diagram; nothing if the sites do not span space. O(simplices).
    pub fn voronoi(&self) -> VoronoiDiagram<3> {
        if self.count == 0 {
            return VoronoiDiagram::default();
        }
        let (centers, groups) = (self.centers_by::<InSpace>(), self.groups_by::<InSpace>());
        self.diagram_by(centers, groups, |sites, of_simplices| self.part(sites, of_simplices))
    }

    /// Goes through the stars of sites, and around each edge to a site of a higher row.
    fn part(&self, sites: &[u32], of_simplices: &[u32]) -> Part {
        let slots = self.triangulation.slots();
        let (mut part, mut around, mut joined) = (Part::default(), Star::new(), NumberSet::new());
        let mut edges: Vec<(u32, u32, u32)> = Vec::new();
        let (mut region, mut cycle) = (Vec::new(), Vec::new());
        for &site in sites {
            let row = self.triangulation.row(site);
            let star = around.of(slots, self.directory.at_site[site as usize], site);
            edges.clear();
            region.clear();
            joined.clear();
            for &t in star {
                region.push(self.vertex_of(t, of_simplices));
                for v in slots[t as usize].vertices {
                    if v != GHOST && v != site && joined.insert(v) {
                        let other = self.triangulation.row(v);
                        if other > row {
                            edges.push((other, v, t));
                        }
                    }
                }
            }
            region.sort_unstable_by_key(|v| v.wrapping_add(1));
            region.dedup();
            part.add_region(&region);
            edges.sort_unstable();
            for &(other, v, t) in &edges {
                if self.is_ridge(site, v, t, of_simplices, &mut cycle) {
                    part.add_ridge([row, other], &cycle);
                }
            }
        }
        part
    }

    /// Puts the vertices around the edge from `a` to `b`, of which `first` is a simplex, into `cycle`; false if the regions share
    /// less than a ridge.
    fn is_ridge(
        &self,
        a: u32,
        b: u32,
        first: u32,
        of_simplices: &[u32],
        cycle: &mut Vec<u32>,
    ) -> bool {
        let slots = self.triangulation.slots();
        let vertices = slots[first as usize].vertices;
        let mut others = (0..4).filter(|&i| vertices[i] != a && vertices[i] != b);
        // The way leads through the facet opposite one of the other two vertices; the next simplex has the one kept, and a new one.
        let mut leave = others.next().unwrap_or(0);
        let mut kept = vertices[others.next().unwrap_or(0)];
        let mut here = first;
        // An edge of the hull is one of two facets there: their third vertices.
        let (mut beyond, mut hull_facets) = ([0; 2], 0);
        cycle.clear();
        loop {
            let simplex = &slots[here as usize];
            cycle.push(self.vertex_of(here, of_simplices));
            if here >= self.count && hull_facets < 2 {
                let third = if kept == GHOST { simplex.vertices[leave] } else { kept };
                beyond[hull_facets] = third;
                hull_facets += 1;
            }
            let (next, entered) = decode(simplex.neighbors[leave]);
            let vertices = slots[next as usize].vertices;
            leave = vertices.iter().position(|&v| v == kept).unwrap_or(0);
            kept = vertices[entered];
            here = next;
            if here == first {
                break;
            }
        }
        make_canonical(cycle);
        match cycle[..] {
            [_] => return false,
            // Between two finite vertices there is an edge of the diagram, no ridge.
            [first, _] if first != AT_INFINITY => return false,
            // One vertex and a flat of the hull: a ray.
            [_, _] if hull_facets == 2 => {
                let [c, d] = beyond;
                let [a, b, c, d] =
                    [a, b, c, d].map(|v| self.triangulation.sites.coordinates[v as usize]);
                if space::orient(a, b, c, d) == Sign::Zero {
                    return false;
                }
            }
            _ => {}
        }
        if cycle.len() > 2 && cycle[1].wrapping_add(1) > cycle[cycle.len() - 1].wrapping_add(1) {
            cycle[1..].reverse();
        }
        true
    }
}
