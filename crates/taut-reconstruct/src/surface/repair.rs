//! Vertices at which the border is no surface, or is not at all, put right by turning a few cells over.
//!
//! *Idea.* Around a vertex of a surface the cells inside hang together by facets, and so do those outside. Where they do not, a cell, two
//! neighbors, or a whole part of the star changes sides: the change that leaves the fewest parts too many at all vertices it
//! touches, and of those the one that the strengths of the facets object to least.
//! *Trap.* A change can cut a few cells off from the rest of their label, and leave them as a body of their own: such changes are passed over.
//! *Guarantee.* Each change lowers the number of parts too many, so it ends. A cell changes only to a side that it has a facet with,
//! so no small region arises. Vertices are taken in the order of their numbers, cells in the order of their sites, and sums are exact: the
//! answer is a function of the points.

use std::cmp::Reverse;
use std::collections::{BTreeSet, HashMap};
use std::rc::Rc;

use taut_delaunay::GHOST;
use taut_points::{Cancelled, Monitor, OrderBy};

use super::cells::Cells;
use super::relabel_regions::REGION_CELLS_MAX;
use super::stars::{Star, Stars};

/// The signed weight of a facet: s in steps, more than 0 for the same side.
pub(super) type Weight<'a> = &'a dyn Fn(u32, usize) -> i64;

/// A star is repaired if it has at most this many cells. Samples of surfaces have stars of twenty cells, random ones of
/// a hundred; a vertex with more is far from all surfaces around it, as the center of a ball is, and its star would
/// take the square of its size.
const STAR_CELLS_MAX: usize = 512;

/// Turns cells over until no change makes it better, ghosts only if they may be.
pub(super) fn repair(
    cells: &Cells,
    inside: &mut [bool],
    defects: Vec<u32>,
    weight: Weight<'_>,
    ghosts_may: bool,
    monitor: &Monitor<'_>,
) -> Result<Repaired, Cancelled> {
    let mut repaired = Repaired::default();
    if defects.is_empty() {
        return Ok(repaired);
    }
    let mut bench = Bench { cells, stars: Stars::of(cells, &defects), weight, ghosts_may };
    let mut waiting = BTreeSet::from_iter(defects);
    let mut stuck = BTreeSet::new();
    while let Some(site) = waiting.pop_first() {
        monitor.check()?;
        let around = bench.around(inside, site, None);
        if around.defect == 0 {
            continue;
        }
        if around.labels.len() > STAR_CELLS_MAX {
            stuck.insert(site);
            continue;
        }
        let Some(change) = bench.best_change(inside, site) else {
            stuck.insert(site);
            continue;
        };
        if bench.changes_euler(inside, &change) {
            repaired.rebuilt.push(site);
        }
        change.iter().for_each(|&cell| inside[cell as usize] = !inside[cell as usize]);
        repaired.sites.push(site);
        for (site, cell) in bench.sites_of(&change) {
            // What was stuck may have become possible.
            if stuck.remove(&site) || bench.around(inside, site, Some(cell)).defect > 0 {
                waiting.insert(site);
            }
        }
    }
    Ok(repaired)
}

/// What repair did.
#[derive(Clone, Debug, Default)]
pub(super) struct Repaired {
    /// For each change the site at which it was made.
    pub(super) sites: Vec<u32>,
    /// Those of them at which a change made or closed a handle, a hole or a part.
    pub(super) rebuilt: Vec<u32>,
}

struct Bench<'a> {
    cells: &'a Cells,
    stars: Stars<'a>,
    weight: Weight<'a>,
    ghosts_may: bool,
}

/// A star with the labels of its cells, and how many parts too many it has.
struct StarDefect {
    star: Rc<Star>,
    labels: Vec<bool>,
    defect: u32,
}

impl StarDefect {
    /// By how much the defect would be less, were some cells turned over.
    fn gain(&self, change: &[u32]) -> i64 {
        let labels = flipped(&self.star, &self.labels, change);
        i64::from(self.defect) - i64::from(self.star.defect(&labels))
    }
}

/// The labels of a star once some cells are turned over.
fn flipped(star: &Star, labels: &[bool], change: &[u32]) -> Vec<bool> {
    let mut labels = labels.to_vec();
    for cell in change {
        if let Ok(place) = star.cells.binary_search(cell) {
            labels[place] = !labels[place];
        }
    }
    labels
}

impl Bench<'_> {
    fn around(&mut self, inside: &[bool], site: u32, near: Option<u32>) -> StarDefect {
        let star = self.stars.star(site, near);
        let labels: Vec<bool> = star.cells.iter().map(|&cell| inside[cell as usize]).collect();
        let defect = star.defect(&labels);
        StarDefect { star, labels, defect }
    }

    /// The sites of some cells, each with one of these.
    fn sites_of(&self, change: &[u32]) -> Vec<(u32, u32)> {
        let of_cell = |&cell: &u32| self.cells.sites(cell).map(|site| (site, cell));
        let mut sites: Vec<(u32, u32)> = change.iter().flat_map(of_cell).collect();
        sites.retain(|&(site, _)| site != GHOST);
        sites.sort_unstable();
        sites.dedup_by_key(|&mut (site, _)| site);
        sites
    }

    /// The change at a site that lowers the defects around it most.
    fn best_change(&mut self, inside: &[bool], site: u32) -> Option<Vec<u32>> {
        let own = self.around(inside, site, None);
        let mut known: HashMap<u32, StarDefect> = HashMap::new();
        let mut better: Vec<(i64, i64, Vec<u32>)> = Vec::new();
        for change in self.changes(inside, &own) {
            let mut gain = 0;
            for (site, cell) in self.sites_of(&change) {
                let around =
                    known.entry(site).or_insert_with(|| self.around(inside, site, Some(cell)));
                gain += around.gain(&change);
            }
            if gain > 0 {
                better.push((gain, self.objection(inside, &change), change));
            }
        }
        // Stable: of those alike the first one.
        better.order_by_key(|&(gain, objection, _)| (Reverse(gain), objection));
        let best = better.into_iter().find(|(_, _, change)| !self.leaves_a_bubble(inside, change));
        best.map(|(_, _, change)| change)
    }

    /// Returns true if the change cuts a few cells off from all others of their label.
    fn leaves_a_bubble(&self, inside: &[bool], change: &[u32]) -> bool {
        let cut_off = |start: u32| {
            let mut region = vec![start];
            let mut next = 0;
            while let Some(&cell) = region.get(next) {
                if self.cells.is_ghost(cell) || region.len() > REGION_CELLS_MAX {
                    return false;
                }
                next += 1;
                for i in 0..4 {
                    let (other, _) = self.cells.across(cell, i);
                    if inside[other as usize] == inside[start as usize]
                        && !change.contains(&other)
                        && !region.contains(&other)
                    {
                        region.push(other);
                    }
                }
            }
            true
        };
        change.iter().any(|&cell| {
            (0..4).any(|i| {
                let (other, _) = self.cells.across(cell, i);
                inside[other as usize] == inside[cell as usize]
                    && !change.contains(&other)
                    && cut_off(other)
            })
        })
    }

    /// Returns true if a change would alter the Euler number χ' = Σ c − F/2 of the border with all its sheets apart: a vertex at which
    /// p parts of the star meet is c = p − 1 vertices, and F triangles that close up have 3F/2 edges.
    fn changes_euler(&mut self, inside: &[bool], change: &[u32]) -> bool {
        let mut twice = 0i64;
        for (site, cell) in self.sites_of(change) {
            let StarDefect { star, labels, .. } = self.around(inside, site, Some(cell));
            let after = flipped(&star, &labels, change);
            twice += 2 * (star.sheets(&after) - star.sheets(&labels));
        }
        for &cell in change {
            for i in 0..4 {
                let (other, _) = self.cells.across(cell, i);
                if !change.contains(&other) {
                    let is_border = inside[other as usize] != inside[cell as usize];
                    twice += if is_border { 1 } else { -1 };
                }
            }
        }
        twice != 0
    }

    /// The changes worth a look: cells of the star, pairs of neighbors one of which is in it, and its parts of one label.
    fn changes(
        &self,
        inside: &[bool],
        StarDefect { star, labels, .. }: &StarDefect,
    ) -> Vec<Vec<u32>> {
        let may = |cell: u32| self.ghosts_may || !self.cells.is_ghost(cell);
        let mut changes: Vec<Vec<u32>> = star.cells.iter().map(|&cell| vec![cell]).collect();
        for &cell in &star.cells {
            let mut sites = self.cells.sites(cell);
            sites.sort_unstable();
            for site in sites {
                let i = self.cells.sites(cell).iter().position(|&s| s == site).unwrap_or(0);
                let (other, _) = self.cells.across(cell, i);
                if inside[other as usize] == inside[cell as usize] {
                    changes.push(vec![cell, other]);
                }
            }
        }
        let (group, _) = star.groups(labels);
        let count = group.iter().max().map_or(0, |most| *most as usize + 1);
        let mut groups = vec![Vec::new(); count];
        group.iter().zip(&star.cells).for_each(|(&g, &cell)| groups[g as usize].push(cell));
        groups.retain(|group| group.len() > 2 && group.len() < star.cells.len());
        changes.extend(groups);
        changes.retain(|change| {
            change.iter().all(|&cell| may(cell)) && self.touches_the_other_side(inside, change)
        });
        changes
    }

    /// Returns true if one of the cells has a facet with a cell of the other label.
    fn touches_the_other_side(&self, inside: &[bool], change: &[u32]) -> bool {
        change.iter().any(|&cell| {
            (0..4).any(|i| inside[self.cells.across(cell, i).0 as usize] != inside[cell as usize])
        })
    }

    /// Returns what the facets around a change object to it: by how much less they agree with the labels after it.
    fn objection(&self, inside: &[bool], change: &[u32]) -> i64 {
        let mut sum = 0;
        for &cell in change {
            for i in 0..4 {
                let (other, _) = self.cells.across(cell, i);
                if !change.contains(&other) {
                    let is_alike = inside[other as usize] == inside[cell as usize];
                    let s = (self.weight)(cell, i);
                    sum += if is_alike { s } else { -s };
                }
            }
        }
        sum
    }
}
