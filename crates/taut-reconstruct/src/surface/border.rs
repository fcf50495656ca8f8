//! The surface between inside and outside: its triangles, and the vertices at which it is no surface.
//!
//! *Idea.* A facet from an inside cell to an outside one is a triangle, seen from outside. The sides opposite a vertex in its triangles
//! are the vertex' link; a vertex of a surface has one cycle for a link, which visits no vertex twice.
//! *Guarantee.* The triangles are facets of the Delaunay triangulation, so they meet nowhere but in common edges and vertices, and as
//! the border of a set of cells they are closed and turned alike. They are in the order of their sites, so they are a function of the
//! labels, not of the numbers of cells.

use taut_points::OrderBy;
use taut_points::parallel::IntoParallel;

use super::cells::Cells;
use super::parity::ParityUnionFind;

/// Cells or vertices of one task.
const TASK: usize = 1 << 13;

/// A triangle of the border.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Face {
    /// Sites, counter-clockwise from outside, the smallest first.
    pub(super) sites: [u32; 3],
    /// `cell << 2 | facet`, with the inside cell, or the finite one if that is a ghost.
    pub(super) facet: u32,
}

impl Face {
    /// The facet of a cell that is inside, or else of one of the hull.
    fn of(cells: &Cells, facet: u32, is_inside: bool) -> Self {
        let [a, b, c] = cells.facet(facet >> 2, facet as usize & 3);
        Self { sites: from_least(if is_inside { [a, b, c] } else { [a, c, b] }), facet }
    }
}

/// The triangles between inside and outside, but for those with the vertex at infinity.
pub(super) fn faces(cells: &Cells, inside: &[bool], sites: usize) -> Vec<Face> {
    let task = |facets: &mut Vec<u32>, begin: usize| {
        let some = begin as u32..cells.len().min(begin + TASK) as u32;
        facets.resize(4 * some.len(), 0);
        let (mut count, mut outside) = (0, Vec::new());
        for cell in some {
            let is_inside = inside[cell as usize];
            if cells.is_ghost(cell) {
                // A facet of the hull is found from its only finite cell, which is outside here.
                let back = cells.mirror(cell << 2 | 3);
                if is_inside && !inside[(back >> 2) as usize] {
                    outside.push(Face::of(cells, back, false));
                }
                continue;
            }
            for facet in (0..4).map(|i| cell << 2 | i) {
                // All are written and most of them written over, as which of them stay cannot be guessed.
                facets[count] = facet;
                let other = cells.mirror(facet) >> 2;
                count += usize::from(is_inside & !inside[other as usize]);
            }
        }
        let found = facets[..count].iter().map(|&facet| Face::of(cells, facet, true));
        found.chain(outside).collect::<Vec<Face>>()
    };
    let begins: Vec<usize> = (0..cells.len()).step_by(TASK).collect();
    let parts: Vec<Vec<Face>> = begins.into_par_iter().map_init(Vec::new, task).collect();
    in_order(&parts, sites)
}

/// The same from the triangles of other labels, in which few cells have another one.
pub(super) fn faces_after(
    found: &[Face],
    before: &[bool],
    cells: &Cells,
    inside: &[bool],
) -> Vec<Face> {
    let has_changed = |cell: u32| before[cell as usize] != inside[cell as usize];
    let mut fresh = Vec::new();
    for cell in (0..cells.len() as u32).filter(|&cell| has_changed(cell)) {
        for facet in (0..4).map(|i| cell << 2 | i) {
            let back = cells.mirror(facet);
            let other = back >> 2;
            // Of two cells that have changed the first has the facet.
            let is_between = inside[other as usize] != inside[cell as usize];
            if is_between && !(has_changed(other) && other < cell) {
                let is_own = match (cells.is_ghost(cell), cells.is_ghost(other)) {
                    (false, false) => inside[cell as usize],
                    (false, true) => true,
                    (true, false) => false,
                    (true, true) => continue,
                };
                let facet = if is_own { facet } else { back };
                fresh.push(Face::of(cells, facet, inside[(facet >> 2) as usize]));
            }
        }
    }
    fresh.sort_unstable();
    let stays =
        |face: &&Face| !has_changed(face.facet >> 2) && !has_changed(cells.mirror(face.facet) >> 2);
    let mut fresh = fresh.into_iter().peekable();
    let mut all = Vec::with_capacity(found.len() + fresh.len());
    for face in found.iter().filter(stays) {
        while let Some(earlier) = fresh.next_if(|fresh| fresh < face) {
            all.push(earlier);
        }
        all.push(*face);
    }
    all.extend(fresh);
    all
}

pub(super) fn from_least([a, b, c]: [u32; 3]) -> [u32; 3] {
    if a < b && a < c {
        [a, b, c]
    } else if b < c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}

/// Faces by their sites: counted by the first, of which few are alike, then compared.
fn in_order(parts: &[Vec<Face>], sites: usize) -> Vec<Face> {
    let mut begins = vec![0u32; sites + 2];
    let all = || parts.iter().flatten();
    all().for_each(|face| begins[face.sites[0] as usize + 2] += 1);
    for site in 2..begins.len() {
        begins[site] += begins[site - 1];
    }
    let mut sorted = vec![Face { sites: [0; 3], facet: 0 }; begins[sites + 1] as usize];
    for &face in all() {
        let place = &mut begins[face.sites[0] as usize + 1];
        sorted[*place as usize] = face;
        *place += 1;
    }
    for site in 0..sites {
        sorted[begins[site] as usize..begins[site + 1] as usize].sort_unstable();
    }
    sorted
}

/// The links of vertices: for each, the sides opposite it.
pub(super) struct Links {
    begins: Vec<u32>,
    sides: Vec<[u32; 2]>,
}

impl Links {
    pub(super) fn of(faces: &[Face], sites: usize) -> Self {
        let mut begins = vec![0u32; sites + 2];
        for face in faces {
            face.sites.iter().for_each(|&site| begins[site as usize + 2] += 1);
        }
        for site in 2..begins.len() {
            begins[site] += begins[site - 1];
        }
        let mut sides = vec![[0; 2]; 3 * faces.len()];
        for face in faces {
            let [a, b, c] = face.sites;
            for (site, side) in [(a, [b, c]), (b, [c, a]), (c, [a, b])] {
                let place = &mut begins[site as usize + 1];
                sides[*place as usize] = side;
                *place += 1;
            }
        }
        Self { begins, sides }
    }

    pub(super) fn at(&self, site: u32) -> &[[u32; 2]] {
        &self.sides[self.begins[site as usize] as usize..self.begins[site as usize + 1] as usize]
    }

    /// The sites that fail a test of their link, ascending.
    pub(super) fn failing(&self, passes: fn(&[[u32; 2]]) -> bool) -> Vec<u32> {
        let sites = self.begins.len() as u32 - 2;
        let fails = |&site: &u32| !passes(self.at(site));
        (0..sites).into_par_iter().with_min_len(TASK).filter(fails).collect()
    }
}

/// Tests whether a link is one cycle, all of whose sides run the same way round, as of a vertex within a surface.
pub(super) fn is_cycle(link: &[[u32; 2]]) -> bool {
    /// Up to this many sides, looking through all of them is as fast as sorting.
    const LINEAR_SEARCH_MAX: usize = 24;
    if link.len() <= LINEAR_SEARCH_MAX {
        return is_round(link, |site| link.iter().position(|side| side[0] == site));
    }
    let mut sorted: Vec<usize> = (0..link.len()).collect();
    sorted.order_by_key(|&k| link[k][0]);
    let place = |site| sorted.binary_search_by_key(&site, |&k| link[k][0]).ok();
    is_round(link, |site| place(site).map(|k| sorted[k]))
}

/// Tests whether the walk along the sides of a link comes back by all of them, and by no vertex twice.
fn is_round(link: &[[u32; 2]], leaves: impl Fn(u32) -> Option<usize>) -> bool {
    let Some(&[first, mut at]) = link.first() else { return false };
    let mut length = 1;
    while at != first && length <= link.len() {
        let Some(next) = leaves(at) else { return false };
        at = link[next][1];
        length += 1;
    }
    // Where a vertex is passed by twice, the walk takes the same way out again and misses the other.
    length == link.len()
}

/// Tests whether a link is one path or one cycle, whichever way its sides run, as of a vertex within a surface or on its boundary.
pub(super) fn is_fan(link: &[[u32; 2]]) -> bool {
    let mut ends: Vec<(u32, u32)> = Vec::with_capacity(2 * link.len());
    for (side, [a, b]) in (0..).zip(link) {
        ends.extend([(*a, side), (*b, side)]);
    }
    ends.order();
    let mut parity = ParityUnionFind::new(link.len());
    let mut parts = link.len();
    for at_site in ends.chunk_by(|a, b| a.0 == b.0) {
        match at_site {
            [_] => {}
            [one, other] => parts -= usize::from(parity.join(one.1, other.1, false)),
            _ => return false,
        }
    }
    parts == 1
}

/// The parts of a surface: for each site one that stands for all that hang together with it.
pub(super) fn parts(faces: &[Face], sites: usize) -> Vec<u32> {
    parts_of(faces.iter().map(|face| face.sites), sites)
}

/// The same for triangles.
pub(super) fn parts_of(triangles: impl Iterator<Item = [u32; 3]>, sites: usize) -> Vec<u32> {
    let mut link: Vec<u32> = (0..sites as u32).collect();
    let root = |link: &mut [u32], mut site: u32| {
        while link[site as usize] != site {
            link[site as usize] = link[link[site as usize] as usize];
            site = link[site as usize];
        }
        site
    };
    for triangle in triangles {
        let [a, b, c] = triangle.map(|site| root(&mut link, site));
        let least = a.min(b).min(c);
        [a, b, c].iter().for_each(|&site| link[site as usize] = least);
    }
    (0..sites).for_each(|site| link[site] = link[link[site] as usize]);
    link
}

#[cfg(test)]
mod tests {
    use taut_delaunay::{DelaunayOptions, Space};
    use taut_points::{Distribution, Points, generate};

    use super::*;

    #[test]
    fn links_of_surfaces_are_single_cycles() {
        assert!(is_cycle(&[[1, 2], [3, 1], [2, 3]]));
        assert!(!is_cycle(&[]));
        assert!(!is_cycle(&[[1, 2], [2, 3]]), "a path");
        assert!(!is_cycle(&[[1, 2], [2, 3], [3, 1], [4, 5], [5, 6], [6, 4]]), "two");
        assert!(!is_cycle(&[[1, 2], [2, 3], [3, 1], [1, 5], [5, 6], [6, 1]]), "a vertex twice");
        assert!(!is_cycle(&[[9, 1], [1, 2], [2, 1], [2, 9]]), "a pinch");
        let long: Vec<[u32; 2]> = (0..100).map(|k| [k * 7 % 100, (k + 1) * 7 % 100]).collect();
        assert!(is_cycle(&long));
        assert!(!is_cycle(&long[1..]));
        assert!(is_fan(&long[1..]) && is_fan(&long) && !is_fan(&[]));
        assert!(is_fan(&[[2, 3], [1, 2]]) && is_fan(&[[2, 3], [2, 1]]));
        assert!(!is_fan(&[[1, 2], [3, 4]]), "two paths");
        assert!(!is_fan(&[[1, 2], [2, 3], [3, 1], [4, 5]]), "a cycle and a path");
        assert!(!is_fan(&[[9, 1], [1, 2], [2, 1]]), "a path into a cycle");
    }

    #[test]
    fn faces_after_changes_are_those_of_the_labels() {
        let values: Vec<f64> = generate(Distribution::Uniform, 300, 3, 5).expect("valid");
        let points = Points::new(&values, 3).expect("whole rows");
        let space = Space::build(&points, &DelaunayOptions::default());
        let cells = Cells::of(space.expect("finite").into_slots(), 300);
        // Ghosts change as well, as they do where surfaces are open.
        let labels = |seed: u32, rare: u32| -> Vec<bool> {
            let mix = |cell: u32| (cell + seed).wrapping_mul(0x9E37_79B1) >> 20;
            (0..cells.len() as u32).map(|cell| mix(cell).is_multiple_of(rare)).collect()
        };
        for rare in [1, 2, 7, 50, 5000] {
            let before = labels(0, 3);
            let now: Vec<bool> = before.iter().zip(labels(9, rare)).map(|(a, b)| a ^ b).collect();
            let found = faces(&cells, &before, 300);
            assert_eq!(faces_after(&found, &before, &cells, &now), faces(&cells, &now, 300));
        }
    }

    #[test]
    fn the_smallest_site_comes_first() {
        for sites in [[4, 7, 9], [7, 9, 4], [9, 4, 7]] {
            assert_eq!(from_least(sites), [4, 7, 9]);
        }
    }
}
