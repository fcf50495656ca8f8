//! The data that show that triangles are Delaunay facets: an empty ball for each.
//!
//! *Idea.* The smallest ball around the triangle is empty of all sites if the vertices opposite in its two cells are not inside. Where
//! one is, the ball of either cell will do: the smaller one, as a checker has to look into it.
//! *Guarantee.* The sign is exact.
//! *Trap.* The cells inside a sphere all have nearly that sphere for theirs: a checker who was given those would look at all points for
//! each triangle.

use taut_certify::Apex;
use taut_delaunay::{GHOST, decode};
use taut_points::parallel::ParallelSlice;
use taut_predicates::space::EquatorialSphere;

use super::cells::Cells;
use super::spheres::{Point, circumsphere};

/// Triangles of one task.
const TASK: usize = 1 << 9;

/// For each facet, given as cell and place, a ball; `row` is that of a site.
pub(super) fn witnesses(
    cells: &Cells,
    points: &[Point],
    facets: &[u32],
    row: impl Fn(u32) -> u32 + Sync,
) -> Vec<Apex> {
    let at = |site: u32| points[site as usize];
    let all = facets.par_iter().with_min_len(TASK);
    all.map(|&facet| {
        let (cell, i) = decode(facet);
        let (across, k) = cells.across(cell, i);
        let apexes = [cells.sites(cell)[i], cells.sites(across)[k]];
        let [a, b, c] = cells.facet(cell, i).map(at);
        let smallest = EquatorialSphere::new(a, b, c);
        let is_inside = |d: u32| smallest.side(at(d)).is_positive();
        if !apexes.iter().any(|&d| d != GHOST && is_inside(d)) {
            return Apex::Gabriel;
        }
        // In an order that does not depend on the cell, as roundings do on the order.
        let mut sites = cells.facet(cell, i);
        sites.sort_unstable();
        let [a, b, c] = sites.map(at);
        let radius = |d: u32| circumsphere([a, b, c, at(d)]).radius;
        let finite = apexes.into_iter().filter(|&d| d != GHOST);
        let best = finite.min_by(|&d, &e| radius(d).total_cmp(&radius(e)).then(d.cmp(&e)));
        best.map_or(Apex::Hull, |d| Apex::Row(row(d)))
    })
    .collect()
}

/// The facets that triangles are, each as cell and place. Triangles that are no facets are passed over.
pub(super) fn located(cells: &Cells, triangles: &[[u32; 3]], sites: usize) -> Vec<u32> {
    let mut is_used = vec![false; sites];
    triangles.as_flattened().iter().for_each(|&site| is_used[site as usize] = true);
    let sorted = |mut sites: [u32; 3]| {
        sites.sort_unstable();
        sites
    };
    let mut named: Vec<([u32; 3], u32)> =
        (0u32..).zip(triangles).map(|(number, &triangle)| (sorted(triangle), number)).collect();
    named.sort_unstable();
    let mut facets = vec![u32::MAX; triangles.len()];
    for cell in cells.finite() {
        for i in 0..4 {
            let name = sorted(cells.facet(cell, i));
            if !name.iter().all(|&site| is_used[site as usize]) {
                continue;
            }
            let first = named.partition_point(|(other, _)| *other < name);
            let same = named[first..].iter().take_while(|(other, _)| *other == name);
            // Either of the two cells will do.
            same.for_each(|&(_, number)| facets[number as usize] = cell << 2 | i as u32);
        }
    }
    facets.retain(|&facet| facet != u32::MAX);
    facets
}
