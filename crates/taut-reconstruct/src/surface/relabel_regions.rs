//! Relabels small regions that the facets around them do not set apart.
//!
//! *Problem.* A few flat cells can end up on the wrong side together, as a bubble beside the surface or within it.
//! *Idea.* The border of a true body says "opposite" with nearly all its facets; a bubble's facets say it with no more than a quarter of
//! their strength. Such a region of at most [`REGION_CELLS_MAX`] cells is turned over; its points are then found unused, and repaired as such.
//! *Guarantee.* O(border). The regions depend on the labels and the points alone.

use std::collections::BTreeSet;

use taut_delaunay::decode;

use super::border::{Face, parts};
use super::cells::Cells;

/// The largest region has this many cells, and at most twice as many facets.
pub(super) const REGION_CELLS_MAX: usize = 24;

/// Relabels small regions, and returns their number.
pub(super) fn sink(
    faces: &[Face],
    cells: &Cells,
    inside: &mut [bool],
    sites: usize,
    weight: &dyn Fn(u32, usize) -> i64,
) -> u64 {
    let part = parts(faces, sites);
    let mut count = vec![0u32; sites];
    faces.iter().for_each(|face| count[part[face.sites[0] as usize] as usize] += 1);
    let is_small = |face: &&Face| {
        count[part[face.sites[0] as usize] as usize] as usize <= 2 * REGION_CELLS_MAX
    };
    let mut relabeled = 0;
    let mut seen = BTreeSet::new();
    for face in faces.iter().filter(is_small) {
        let (cell, i) = decode(face.facet);
        for start in [cell, cells.across(cell, i).0] {
            if seen.contains(&start) {
                continue;
            }
            let Some(region) = region(cells, inside, start) else { continue };
            seen.extend(region.iter().copied());
            let (mut apart, mut facets) = (0, 0);
            for &cell in &region {
                for i in (0..4)
                    .filter(|&i| inside[cells.across(cell, i).0 as usize] != inside[start as usize])
                {
                    apart -= weight(cell, i);
                    facets += 1;
                }
            }
            if 4 * apart < facets * super::dual_edges::CERTAIN_STEPS {
                region.iter().for_each(|&cell| inside[cell as usize] = !inside[cell as usize]);
                relabeled += 1;
                break;
            }
        }
    }
    relabeled
}

/// The cells of one label that hang together with one, if they are few and none is a ghost.
fn region(cells: &Cells, inside: &[bool], start: u32) -> Option<Vec<u32>> {
    let mut region = vec![start];
    let mut next = 0;
    while let Some(&cell) = region.get(next) {
        if cells.is_ghost(cell) || region.len() > REGION_CELLS_MAX {
            return None;
        }
        next += 1;
        for i in 0..4 {
            let (other, _) = cells.across(cell, i);
            if inside[other as usize] == inside[start as usize] && !region.contains(&other) {
                region.push(other);
            }
        }
    }
    Some(region)
}
