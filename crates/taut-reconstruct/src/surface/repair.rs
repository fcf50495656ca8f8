//! Vertices at which the border is no surface, or is not at all, put right by turning a few cells over.
//!
//! *Idea.* Around a vertex of a surface the cells inside hang together by facets, and so do those outside. Where they do not, a cell, two
//! neighbors, or a whole part of the star changes sides: the change that leaves the fewest parts too many at all vertices it
//! touches, and of those the one that the strengths of the facets object to least.
//! *Guarantee.* Each change lowers the number of parts too many, so it ends. A cell changes only to a side that it has a facet with,
//! so no small region arises. Vertices are taken in the order of their numbers, cells in the order of their sites, and sums are exact: the
//! answer is a function of the points.

use std::collections::{BTreeSet, HashMap};
use std::rc::Rc;

use taut_delaunay::GHOST;
use taut_points::{Cancelled, Monitor};

use super::cells::Cells;
use super::stars::{Star, Stars};

/// The signed weight of a facet: s in steps, more than 0 for the same side.
pub(super) type Weight<'a> = &'a dyn Fn(u32, usize) -> i64;

/// A star is repaired if it has at most this many cells. Samples of surfaces have stars of twenty cells, random ones of
/// a hundred; a vertex with more is far from all surfaces around it, as the center of a ball is, and its star would
/// take the square of its size.
const STAR_CELLS_MAX: usize = 512;

/// Turns cells over until no change makes it better, ghosts only if they may be, and says how many times.
pub(super) fn repair(
    cells: &Cells,
    inside: &mut [bool],
    defects: Vec<u32>,
    weight: Weight<'_>,
    ghosts_may: bool,
    monitor: &Monitor<'_>,
) -> Result<u64, Cancelled> {
    if defects.is_empty() {
        return Ok(0);
    }
    let mut changes = 0;
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
        change.iter().for_each(|&cell| inside[cell as usize] = !inside[cell as usize]);
        changes += 1;
        for (site, cell) in bench.sites_of(&change) {
            // What was stuck may have become possible.
            if stuck.remove(&site) || bench.around(inside, site, Some(cell)).defect > 0 {
                waiting.insert(site);
            }
        }
    }
    Ok(changes)
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
        let mut labels = self.labels.clone();
        for cell in change {
            if let Ok(place) = self.star.cells.binary_search(cell) {
                labels[place] = !labels[place];
            }
        }
        i64::from(self.defect) - i64::from(self.star.defect(&labels))
    }
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
        let mut best: Option<(i64, i64, Vec<u32>)> = None;
        for change in self.changes(inside, &own) {
            let mut gain = 0;
            for (site, cell) in self.sites_of(&change) {
                let around =
                    known.entry(site).or_insert_with(|| self.around(inside, site, Some(cell)));
                gain += around.gain(&change);
            }
            if gain <= 0 || best.as_ref().is_some_and(|(most, ..)| gain < *most) {
                continue;
            }
            let objection = self.objection(inside, &change);
            let is_better =
                |&(most, least, _): &(i64, i64, Vec<u32>)| gain > most || objection < least;
            if best.as_ref().is_none_or(is_better) {
                best = Some((gain, objection, change));
            }
        }
        best.map(|(_, _, change)| change)
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
