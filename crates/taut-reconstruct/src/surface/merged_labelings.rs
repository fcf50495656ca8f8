//! Sheets with one side, put together from two labelings.
//!
//! *Problem.* Labels give every sheet two sides. Where it has one, as a Möbius band, they contradict what some facets surely say, all the
//! way across the sheet: a patch is missing there, and a membrane goes through.
//! *Idea.* Any sheet has two sides for those who do not walk around it. So the cells at the points of the patch, and at those some rings
//! around it, are labeled once more, by the strongest tree of the facets between them alone. Both surfaces are alike
//! all around the patch. At the points of triangles that only one of them has, as far as these hang together with
//! the patch, the second surface is taken, and everywhere else the first.
//! *Guarantee.* All triangles at a point are of one of the two, so it is as good a point of a surface as it is there. The result is taken
//! only if it has one side, and no more points that are none of a surface than what labels give. A function of the points.
//! *Trap.* The first surface is to be repaired before, though repair makes one with two sides of what is around the patch: without that 7
//! of 21 random bands kept holes or defects. The second is not to be: repair would run along the border of what is labeled, where every
//! point looks like a defect. Noise has facets overruled, too: where patches are many and everywhere, no rings get around them.

use std::cmp::Reverse;
use std::collections::BTreeSet;

use taut_delaunay::GHOST;
use taut_points::OrderBy;

use super::border::{Face, Links, faces, is_fan};
use super::cells::Cells;
use super::dual_edges::DualEdges;
use super::orient::has_one_side;
use super::parity::ParityUnionFind;
use super::prune::{without_all_small_fans, without_membranes};
use super::spheres::Point;

/// The smallest patch has this many facets that hang together.
const PATCH_FACETS_MIN: usize = 5;
/// The numbers of rings around the patch that are tried: few may not reach beyond what the patch has spoilt, many may reach around the sheet.
const RING_RANGE: std::ops::RangeInclusive<usize> = 2..=6;

/// Where labels contradict what facets surely say.
pub(super) struct Patch {
    /// The points of the facets, ascending.
    core: BTreeSet<u32>,
    /// Both directions of the edges of these facets.
    edges: Vec<[u32; 2]>,
}

impl Patch {
    /// None where the facets that were overruled are few, or far from each other.
    pub(super) fn of(overruled: &[u32], cells: &Cells) -> Option<Self> {
        let mut facets: Vec<[u32; 3]> = overruled.iter().map(|&facet| cells.name(facet)).collect();
        facets.retain(|name| name[2] != GHOST);
        facets.sort_unstable();
        let mut parity = ParityUnionFind::new(facets.len());
        let mut at: Vec<(u32, u32)> =
            (0..).zip(&facets).flat_map(|(k, name)| name.map(|site| (site, k))).collect();
        at.sort_unstable();
        for pair in at.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
            parity.join(pair[0].1, pair[1].1, false);
        }
        let (part, parts) = parity.numbered();
        let mut size = vec![0; parts];
        part.iter().for_each(|part| size[(part >> 1) as usize] += 1);
        let is_large =
            |(part, _): &(&u32, &[u32; 3])| size[(**part >> 1) as usize] >= PATCH_FACETS_MIN;
        let large: Vec<[u32; 3]> =
            part.iter().zip(&facets).filter(is_large).map(|(_, &name)| name).collect();
        let core = BTreeSet::from_iter(large.as_flattened().iter().copied());
        (!core.is_empty()).then(|| Self { core, edges: edges_of(large.into_iter()) })
    }

    /// The patch, and so many rings of points around it by the edges of a surface and its own.
    fn rings(&self, surface: &[[u32; 2]], count: usize) -> BTreeSet<u32> {
        let mut all = self.core.clone();
        let mut last: Vec<u32> = all.iter().copied().collect();
        for _ in 0..count {
            let mut next = Vec::new();
            for site in last {
                for edges in [surface, &self.edges] {
                    let begin = edges.partition_point(|edge| edge[0] < site);
                    let here = edges[begin..].iter().take_while(|edge| edge[0] == site);
                    next.extend(here.map(|edge| edge[1]).filter(|&other| all.insert(other)));
                }
            }
            last = next;
        }
        all
    }

    /// The surface that labels give, without membranes, with the patch put in, if it has one side then.
    pub(super) fn mended(
        &self,
        first: &[Face],
        dual_edges: &DualEdges,
        cells: &Cells,
        points: &[Point],
    ) -> Option<Vec<Face>> {
        let edges = edges_of(first.iter().map(|face| face.sites));
        let defects = |faces: &[Face]| Links::of(faces, points.len()).failing(is_fan).len();
        let limit = defects(first);
        let all = RING_RANGE.map(|count| {
            let around = Region::of(&self.rings(&edges, count), points.len());
            let second = without_membranes(&around.surface(dual_edges, cells), points);
            without_all_small_fans(self.joined(first, &second, &around), points.len())
        });
        let may = |faces: &Vec<Face>| defects(faces) <= limit && has_one_side(faces);
        // Of equally good ones the one with the fewest holes and handles, and of these the first.
        let key = |faces: &Vec<Face>| (defects(faces), -euler_characteristic(faces));
        all.filter(may).min_by_key(key)
    }

    /// The second surface at the points where it is unlike the first, as far as they hang together with the patch; elsewhere the first.
    fn joined(&self, first: &[Face], second: &[Face], around: &Region) -> Vec<Face> {
        let names = |faces: &[Face]| -> BTreeSet<[u32; 3]> {
            faces.iter().map(|face| sorted(face.sites)).filter(|name| around.meets(name)).collect()
        };
        let (one, other) = (names(first), names(second));
        let mut unlike: Vec<[u32; 3]> = one.symmetric_difference(&other).copied().collect();
        let mut taken = self.core.clone();
        loop {
            let (met, rest): (Vec<_>, Vec<_>) =
                unlike.into_iter().partition(|name| name.iter().any(|site| taken.contains(site)));
            if met.is_empty() {
                break;
            }
            taken.extend(met.as_flattened().iter().filter(|site| around.meets(&[**site])));
            unlike = rest;
        }
        let is_taken = |face: &&Face| face.sites.iter().any(|site| taken.contains(site));
        let mut both: Vec<Face> = first.iter().filter(|face| !is_taken(face)).copied().collect();
        both.extend(second.iter().filter(is_taken));
        both.sort_unstable();
        both
    }
}

/// Vertices − edges + triangles.
fn euler_characteristic(faces: &[Face]) -> i64 {
    let sides = edges_of(faces.iter().map(|face| face.sites));
    // Each edge is there in both directions, and each vertex begins some.
    let vertices = sides.chunk_by(|one, other| one[0] == other[0]).count();
    vertices as i64 - (sides.len() / 2) as i64 + faces.len() as i64
}

struct Region {
    /// By site.
    has: Vec<bool>,
}

impl Region {
    fn of(region: &BTreeSet<u32>, sites: usize) -> Self {
        let mut has = vec![false; sites];
        region.iter().for_each(|&site| has[site as usize] = true);
        Self { has }
    }

    /// Returns true if one of some sites is among them.
    fn meets(&self, sites: &[u32]) -> bool {
        sites.iter().any(|&site| self.has.get(site as usize) == Some(&true))
    }

    /// The surface at these points, as the cells at them have it.
    fn surface(&self, dual_edges: &DualEdges, cells: &Cells) -> Vec<Face> {
        let mut is_at = vec![false; cells.len()];
        let at: Vec<u32> =
            (0..cells.len() as u32).filter(|&cell| self.meets(&cells.sites(cell))).collect();
        at.iter().for_each(|&cell| is_at[cell as usize] = true);
        let facets = at.iter().flat_map(|&cell| (0..4).map(move |i| cell << 2 | i));
        let is_between = |facet: &u32| {
            let across = cells.mirror(*facet);
            *facet < across && is_at[(across >> 2) as usize]
        };
        let mut kept: Vec<u32> = facets.filter(is_between).collect();
        kept.order_by_key(|&facet| (Reverse(dual_edges.at(facet).weight()), facet));
        let mut parity = ParityUnionFind::new(cells.len());
        for facet in kept {
            parity.join(facet >> 2, cells.mirror(facet) >> 2, dual_edges.at(facet).is_opposite());
        }
        let (sides, _) = parity.numbered();
        let inside: Vec<bool> = sides.iter().map(|side| side & 1 == 1).collect();
        let mut found = faces(cells, &inside, self.has.len());
        found.retain(|face| self.meets(&face.sites));
        found
    }
}

/// Both directions of the sides of triangles, in order.
fn edges_of(triangles: impl Iterator<Item = [u32; 3]>) -> Vec<[u32; 2]> {
    let both = |[a, b, c]: [u32; 3]| [[a, b], [b, a], [b, c], [c, b], [c, a], [a, c]];
    let mut edges: Vec<[u32; 2]> = triangles.flat_map(both).collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}

fn sorted(mut sites: [u32; 3]) -> [u32; 3] {
    sites.sort_unstable();
    sites
}
