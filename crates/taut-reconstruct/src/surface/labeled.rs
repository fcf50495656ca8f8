//! From cells to triangles: labels, their repair, and the border between them.

use taut_points::{Cancelled, Monitor};

use super::SurfaceMode;
use super::answer::Facets;
use super::border::{Face, Links, faces, faces_after, is_cycle, is_fan};
use super::cells::Cells;
use super::diagonals::swap;
use super::doubts::doubts;
use super::dual_edges::DualEdges;
use super::merged_labelings::Patch;
use super::one_sided::OVERRULED;
use super::orient::orient;
use super::prune::{without_all_small_fans, without_membranes};
use super::relabel_parts::{Relabeled, flip};
use super::relabel_regions::sink;
use super::repair::{Repaired, repair};
use super::signed_cut::{Doubted, Improved, improve};
use super::spheres::Point;
use super::spikes::spikes;
use super::tree::{Labels, labels};

/// Sinking and repair take turns this often at most.
const ROUNDS_MAX: usize = 8;

/// Labels cells as inside and outside. For closed surfaces all ghosts are outside; else they are cells as others.
pub(super) fn surface_of_labels(
    cells: &Cells,
    points: &[Point],
    mode: SurfaceMode,
    monitor: &Monitor<'_>,
) -> Result<Facets, Cancelled> {
    let is_open = mode == SurfaceMode::Open;
    let root = cells.first_ghost().unwrap_or(0);
    let dual_edges = DualEdges::of(cells, points, !is_open);
    monitor.check()?;
    let Labels { mut inside, tree } = labels(&dual_edges, cells, root);
    monitor.check()?;
    let Relabeled { relabeled, doubtful } = flip(&dual_edges, &tree, cells, &mut inside);
    drop(tree);
    let Improved { doubtful, regions, rounds, unsettled } = if is_open {
        // What labels overrule tells sheets with one side; cuts would hide it.
        Improved { doubtful, regions: 0, rounds: 0, unsettled: 0 }
    } else {
        let doubted = Doubted { cells, points, dual_edges: &dual_edges, ghosts_stay: true };
        improve(doubted, &mut inside, &doubtful, monitor)?
    };
    let overruled = dual_edges.overruled(&doubtful, cells, &inside);
    // Only sheets can have one side.
    let patch = if is_open { Patch::of(&overruled, cells) } else { None };
    monitor.check()?;
    let weight = |cell: u32, i: usize| dual_edges.of_cell(cell)[i].signed();
    let mut found = faces(cells, &inside, points.len());
    let (mut repaired, mut bubbles) = (Repaired::default(), 0);
    let mut before = inside.clone();
    // Bubbles that sink leave points to repair, and what is repaired can leave bubbles.
    for round in 0..ROUNDS_MAX {
        let sunk = sink(&found, cells, &mut inside, points.len(), &weight);
        if sunk > 0 {
            found = faces(cells, &inside, points.len());
        }
        if round > 0 && sunk == 0 {
            break;
        }
        let defects = match is_open {
            // What membranes do to vertices ends with them.
            true => Links::of(&without_membranes(&found, points), points.len()).failing(is_fan),
            false => Links::of(&found, points.len()).failing(is_cycle),
        };
        before.clone_from(&inside);
        let now = repair(cells, &mut inside, defects, &weight, is_open, monitor)?;
        bubbles += sunk;
        if now.sites.is_empty() {
            break;
        }
        repaired.sites.extend(now.sites);
        repaired.rebuilt.extend(now.rebuilt);
        found = faces_after(&found, &before, cells, &inside);
    }
    before.clone_from(&inside);
    let is_empty = !is_open && repaired.sites.is_empty() && found.is_empty();
    if is_empty {
        // Too few points to tell inside from outside, or points within a body: the hull is the one surface around all.
        cells.finite().for_each(|cell| inside[cell as usize] = true);
    }
    let sheets =
        |faces: &[Face]| without_all_small_fans(without_membranes(faces, points), points.len());
    // A sheet with one side is put together from this surface and another one, both with the diagonals that labels give.
    let mended = patch.and_then(|patch| {
        let found = faces_after(&found, &before, cells, &inside);
        patch.mended(&sheets(&found), &dual_edges, cells, points)
    });
    let swaps = if mended.is_some() || is_empty { 0 } else { swap(cells, points, &mut inside) };
    if is_empty || swaps > 0 {
        found = faces_after(&found, &before, cells, &inside);
    }
    monitor.check()?;
    if is_open {
        found = mended.unwrap_or_else(|| sheets(&found));
        orient(&mut found, points);
    }
    // Many of these are where there is noise, or a sheet with one side, as no labels of its two sides exist.
    let doubts = doubts(&repaired, &overruled, spikes(&found, points), cells, points.len());
    let overruled = overruled.len() as u64;
    let counters = [
        ("flips", relabeled),
        ("cuts", regions),
        ("cut_rounds", rounds),
        ("unsettled", unsettled),
        (OVERRULED, overruled),
        ("repairs", repaired.sites.len() as u64),
        ("bubbles", bubbles),
        ("rebuilt", repaired.rebuilt.len() as u64),
        ("swaps", swaps),
    ];
    Ok(Facets {
        facets: Some(found.iter().map(|face| face.facet).collect()),
        triangles: found.iter().map(|face| face.sites).collect(),
        is_outward: !is_open,
        doubts,
        inside: if is_open {
            Vec::new()
        } else {
            labels_of_sites(cells, &inside, points.len(), &found)
        },
        counters: counters.map(|(name, count)| (name.to_owned(), count)).into(),
    })
}

/// By site, the label of a cell at it: that of all, if no triangle has it. Nothing where each site has a triangle.
fn labels_of_sites(cells: &Cells, inside: &[bool], sites: usize, faces: &[Face]) -> Vec<bool> {
    let mut is_used = vec![false; sites];
    faces.iter().flat_map(|face| face.sites).for_each(|site| is_used[site as usize] = true);
    if is_used.iter().all(|&is| is) {
        return Vec::new();
    }
    let mut is_inside = vec![false; sites];
    for cell in cells.finite() {
        for site in cells.sites(cell) {
            is_inside[site as usize] = inside[cell as usize];
        }
    }
    is_inside
}
