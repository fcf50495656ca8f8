//! The surface that a front leaves behind.

use super::candidates::Candidates;
use super::front::Front;
use super::options::Pinches;
use super::pinches::{peel, split};
use crate::surface::sides::{Side, Sides};

/// A surface on the sites of a triangulation.
///
/// Every triangle is a Delaunay facet. If it was grown by a front, no edge has more than two triangles, both run along it in opposite
/// directions, and no vertex with a closed fan has another triangle.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ThesisSurface {
    /// The site of each vertex, ascending: those of triangles only. A site is given several times where [`Pinches::Split`] asks
    /// for it.
    pub vertices: Vec<u32>,
    /// Corners as vertices, counter-clockwise as seen from the side of the normal, in the order in which the front added
    /// triangles. Candidates of [`Extent::Candidates`](super::Extent::Candidates) are in the order of their sites and not oriented.
    pub triangles: Vec<[u32; 3]>,
    /// For each triangle a witness: the site opposite in one of the Delaunay cells it is a facet of, the smaller one if there are
    /// two.
    pub apexes: Vec<u32>,
    /// The sites that were pinches before they were split or peeled; ascending. Not looked for among candidates.
    pub pinches: Vec<u32>,
    /// The sites of no triangle, ascending.
    pub unused: Vec<u32>,
    /// Edges of one triangle.
    pub boundary_edges: usize,
    /// Connected sets of such edges.
    pub boundary_loops: usize,
    /// The way in which it came about.
    pub counters: ThesisCounters,
}

/// Events of the construction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ThesisCounters {
    /// Finite facets of the triangulation.
    pub facets: u64,
    /// Of these, the ones that pass the filter.
    pub candidates: u64,
    /// Triangles that a front began with.
    pub seeds: u64,
    /// Edges taken from the queue.
    pub pops: u64,
    /// Times that the candidates around an edge were looked at.
    pub examined_edges: u64,
}

impl ThesisSurface {
    /// The triangles as sites.
    pub fn on_sites(&self) -> Vec<[u32; 3]> {
        let site = |vertex: u32| self.vertices[vertex as usize];
        self.triangles.iter().map(|triangle| triangle.map(site)).collect()
    }
}

pub(super) fn of_candidates(sides: &Sides, candidates: &Candidates) -> ThesisSurface {
    finish(sides, candidates.sites.clone(), &candidates.sides, vec![], Pinches::Keep)
}

pub(super) fn of_front(sides: &Sides, front: &Front<'_>, wanted: Pinches) -> ThesisSurface {
    let mut grown = front.grown.clone();
    let mut triangles: Vec<_> = grown.iter().map(|&side| sides.triangle(side)).collect();
    let pinches = front.pinches();
    if wanted == Pinches::Peel && !pinches.is_empty() {
        let stays = peel(&triangles);
        let mut keep = stays.iter();
        triangles.retain(|_| *keep.next().unwrap_or(&true));
        let mut keep = stays.iter();
        grown.retain(|_| *keep.next().unwrap_or(&true));
    }
    let mut surface = finish(sides, triangles, &grown, pinches, wanted);
    surface.counters.seeds = front.events.seeds;
    surface.counters.pops = front.events.pops;
    surface.counters.examined_edges = front.events.examined_edges;
    surface
}

fn finish(
    sides: &Sides,
    triangles: Vec<[u32; 3]>,
    own: &[Side],
    pinches: Vec<u32>,
    wanted: Pinches,
) -> ThesisSurface {
    let mut used = vec![false; sides.points.len()];
    triangles.as_flattened().iter().for_each(|&site| used[site as usize] = true);
    let all = |state: bool| (0..).zip(&used).filter(move |&(_, &is)| is == state).map(|(s, _)| s);
    let unused = all(false).collect();
    let (vertices, triangles) = if wanted == Pinches::Split {
        split(&triangles)
    } else {
        let vertices: Vec<u32> = all(true).collect();
        let mut number = vec![0; used.len()];
        (0..).zip(&vertices).for_each(|(vertex, &site)| number[site as usize] = vertex);
        let numbered = |t: [u32; 3]| t.map(|site| number[site as usize]);
        (vertices, triangles.into_iter().map(numbered).collect())
    };
    let apex = |&side: &Side| sides.apexes(side).min().unwrap_or(u32::MAX);
    let (boundary_edges, boundary_loops) = boundary(&triangles, vertices.len());
    ThesisSurface {
        apexes: own.iter().map(apex).collect(),
        vertices,
        triangles,
        pinches,
        unused,
        boundary_edges,
        boundary_loops,
        counters: ThesisCounters::default(),
    }
}

/// Returns how many edges have one triangle, and how many connected sets they make.
fn boundary(triangles: &[[u32; 3]], vertex_count: usize) -> (usize, usize) {
    let mut edges: Vec<[u32; 2]> = triangles
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
        .map(|[u, v]| [u.min(v), u.max(v)])
        .collect();
    edges.sort_unstable();
    let mut parent: Vec<u32> = (0..vertex_count as u32).collect();
    let root = |parent: &mut Vec<u32>, mut vertex: u32| {
        while parent[vertex as usize] != vertex {
            parent[vertex as usize] = parent[parent[vertex as usize] as usize];
            vertex = parent[vertex as usize];
        }
        vertex
    };
    let (mut count, mut vertices, mut joined) = (0, 0, 0);
    let mut seen = vec![false; vertex_count];
    for edge in edges.chunk_by(|a, b| a == b).filter(|edge| edge.len() == 1) {
        count += 1;
        for end in edge[0] {
            vertices += usize::from(!std::mem::replace(&mut seen[end as usize], true));
        }
        let ends = edge[0].map(|end| root(&mut parent, end));
        joined += usize::from(ends[0] != ends[1]);
        parent[ends[0].max(ends[1]) as usize] = ends[0].min(ends[1]);
    }
    (count, vertices - joined)
}
