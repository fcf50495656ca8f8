//! The cells at a vertex, and how they divide into inside and outside.
//!
//! *Idea.* The cells at a vertex are the triangles of a sphere around it. Labels cut that sphere along the vertex' link, and the vertex
//! is on a surface if and only if there is one connected part of each label.

use std::collections::HashMap;
use std::rc::Rc;

use super::cells::Cells;

/// No cell.
const NONE: u32 = u32::MAX;

/// Finds stars, and keeps those it found: cells do not change while labels do.
pub(super) struct Stars<'a> {
    cells: &'a Cells,
    /// A cell at each site.
    at: Vec<u32>,
    found: HashMap<u32, Rc<Star>>,
}

/// The cells around a site.
#[derive(Clone, Debug, Default)]
pub(super) struct Star {
    /// In the order of their sites.
    pub(super) cells: Vec<u32>,
    /// For each the places in the star of those across its three facets at the site.
    pub(super) beside: Vec<[u32; 3]>,
}

impl<'a> Stars<'a> {
    pub(super) fn of(cells: &'a Cells, sites: usize) -> Self {
        let mut at = vec![NONE; sites];
        for cell in cells.finite() {
            cells.sites(cell).iter().for_each(|&site| at[site as usize] = cell);
        }
        Self { cells, at, found: HashMap::new() }
    }

    /// The cells around a site.
    pub(super) fn star(&mut self, site: u32) -> Rc<Star> {
        let Self { cells, at, found } = self;
        found.entry(site).or_insert_with(|| Rc::new(gather(cells, site, at[site as usize]))).clone()
    }
}

fn gather(cells: &Cells, site: u32, first: u32) -> Star {
    if first == NONE {
        return Star::default();
    }
    let beside = |cell: u32| {
        let sites = cells.sites(cell);
        (0..4).filter(move |&i| sites[i] != site).map(move |i| cells.across(cell, i).0)
    };
    let mut place = HashMap::from([(first, 0u32)]);
    let mut all = vec![first];
    let mut next = 0;
    while let Some(&cell) = all.get(next) {
        next += 1;
        for other in beside(cell) {
            place.entry(other).or_insert_with(|| {
                all.push(other);
                0
            });
        }
    }
    all.sort_by_cached_key(|&cell| {
        let mut sites = cells.sites(cell);
        sites.sort_unstable();
        sites
    });
    (0u32..).zip(&all).for_each(|(k, cell)| _ = place.insert(*cell, k));
    let places = |&cell: &u32| {
        let mut places = [0; 3];
        places.iter_mut().zip(beside(cell)).for_each(|(k, other)| *k = place[&other]);
        places
    };
    let beside = all.iter().map(places).collect();
    Star { cells: all, beside }
}

impl Star {
    /// For each cell the number of its connected part of one label, and how many parts there are inside and outside.
    pub(super) fn groups(&self, label: impl Fn(u32) -> bool) -> (Vec<u32>, Groups) {
        let labels: Vec<bool> = self.cells.iter().map(|&cell| label(cell)).collect();
        let mut group = vec![NONE; labels.len()];
        let mut found = Groups::default();
        let mut open = Vec::new();
        for start in 0..labels.len() {
            if group[start] != NONE {
                continue;
            }
            let number = found.inside + found.outside;
            *(if labels[start] { &mut found.inside } else { &mut found.outside }) += 1;
            group[start] = number;
            open.push(start);
            while let Some(at) = open.pop() {
                for &next in &self.beside[at] {
                    let next = next as usize;
                    if labels[next] == labels[start] && group[next] == NONE {
                        group[next] = number;
                        open.push(next);
                    }
                }
            }
        }
        (group, found)
    }
}

/// How many connected parts there are around a vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Groups {
    pub(super) inside: u32,
    pub(super) outside: u32,
}

impl Groups {
    /// 0 for a vertex of a surface; 2 for one that is not on it; else how many parts there are too many.
    pub(super) fn defect(self) -> u32 {
        match (self.inside, self.outside) {
            (0, _) | (_, 0) => 2,
            (inside, outside) => inside + outside - 2,
        }
    }
}
