//! Which way closed parts face.
//!
//! *Problem.* Parts of a surface made of facets, each with one side turned to the front throughout. Turn the closed ones so that they
//! face outwards, and those within an odd number of others inwards.
//! *Idea.* Walk through the cells from outside the hull. A facet of a closed part changes the number of closed parts around a cell from even
//! to odd or back, nothing else does; a triangle is to face the even side.
//! *Guarantee.* Combinatorial, so exact. O(m log m) for m triangles, and one look at each facet of the triangulation.

use taut_delaunay::GHOST;
use taut_mesh::Topology;

use super::border::parts_of;
use super::cells::Cells;

/// The number of closed parts that are around a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Depth {
    Unknown,
    Even,
    Odd,
}

/// Turns the closed parts of a surface of facets.
pub(super) fn turn(cells: &Cells, triangles: &mut [[u32; 3]], found: &Topology) {
    let sites = 1 + triangles.as_flattened().iter().max().map_or(0, |&site| site as usize);
    let part = parts_of(triangles.iter().copied(), sites);
    let part_of = |triangle: [u32; 3]| part[triangle[0] as usize] as usize;
    let mut is_closed = vec![false; sites];
    for one in found.components.iter().filter(|one| one.closed) {
        is_closed[part_of(triangles[one.first_triangle as usize])] = true;
    }
    let mut closed: Vec<([u32; 3], u32)> = (0u32..)
        .zip(&*triangles)
        .filter(|(_, triangle)| is_closed[part_of(**triangle)])
        .map(|(number, &triangle)| (sorted(triangle), number))
        .collect();
    if closed.is_empty() {
        return;
    }
    closed.sort_unstable();
    let on_closed = |site: u32| (site as usize) < sites && is_closed[part[site as usize] as usize];
    let triangle_at = |facet: [u32; 3]| {
        let name = sorted(facet);
        let can_be = name[2] != GHOST && name.iter().all(|&site| on_closed(site));
        can_be.then(|| closed.binary_search_by_key(&name, |&(name, _)| name).ok()).flatten()
    };

    let mut depth = vec![Depth::Unknown; cells.len()];
    let mut is_wrong = vec![false; sites];
    let Some(first) = cells.first_ghost() else { return };
    depth[first as usize] = Depth::Even;
    let mut open = vec![first];
    while let Some(cell) = open.pop() {
        let own = depth[cell as usize];
        for i in 0..4 {
            let (next, _) = cells.across(cell, i);
            let facet = cells.facet(cell, i);
            let met = triangle_at(facet);
            if let Some(place) = met.filter(|_| own == Depth::Odd) {
                // Seen from beyond, where the number is even, the facet runs counter-clockwise.
                let triangle = triangles[closed[place].1 as usize];
                is_wrong[part_of(triangle)] = !same_turn(triangle, facet);
            }
            if depth[next as usize] == Depth::Unknown {
                depth[next as usize] = match (met, own) {
                    (None, own) => own,
                    (Some(_), Depth::Even) => Depth::Odd,
                    (Some(_), _) => Depth::Even,
                };
                open.push(next);
            }
        }
    }
    for triangle in triangles {
        if is_wrong[part[triangle[0] as usize] as usize] {
            triangle.swap(1, 2);
        }
    }
}

fn sorted(mut sites: [u32; 3]) -> [u32; 3] {
    sites.sort_unstable();
    sites
}

/// Tests whether two orders of the same three sites turn the same way.
fn same_turn(a: [u32; 3], b: [u32; 3]) -> bool {
    (0..3).any(|k| a == [b[k], b[(k + 1) % 3], b[(k + 2) % 3]])
}
