//! The cells at a vertex, and how they divide into inside and outside.
//!
//! *Idea.* The cells at a vertex are the triangles of a sphere around it. Labels cut that sphere along the vertex' link, and the vertex
//! is on a surface if and only if there is one connected part of each label.

use std::collections::{HashMap, HashSet};
use std::rc::Rc;

use super::cells::Cells;

/// No cell.
const NONE: u32 = u32::MAX;

/// Finds stars, and keeps those it found: cells do not change while labels do.
pub(super) struct Stars<'a> {
    cells: &'a Cells,
    /// A cell at each of some sites.
    at: HashMap<u32, u32>,
    found: HashMap<u32, Rc<Star>>,
}

/// The cells around a site.
#[derive(Clone, Debug, Default)]
pub(super) struct Star {
    /// In the order of their numbers.
    pub(super) cells: Vec<u32>,
    /// For each the places in the star of those across its three facets at the site.
    beside: Vec<[u32; 3]>,
}

impl<'a> Stars<'a> {
    /// Ready for the stars of some sites.
    pub(super) fn of(cells: &'a Cells, sites: &[u32]) -> Self {
        let mut is_wanted = vec![false; sites.iter().max().map_or(0, |&last| last as usize + 1)];
        sites.iter().for_each(|&site| is_wanted[site as usize] = true);
        let mut at = HashMap::with_capacity(sites.len());
        for cell in cells.finite() {
            for site in cells.sites(cell) {
                if let Some(is_wanted) = is_wanted.get_mut(site as usize)
                    && std::mem::take(is_wanted)
                {
                    at.insert(site, cell);
                }
            }
            if at.len() == sites.len() {
                break;
            }
        }
        Self { cells, at, found: HashMap::new() }
    }

    /// The cells around a site that one of the first stars has a cell with, or `near` is a cell of.
    pub(super) fn star(&mut self, site: u32, near: Option<u32>) -> Rc<Star> {
        let Self { cells, at, found } = self;
        let first = || near.or_else(|| at.get(&site).copied()).unwrap_or(NONE);
        found.entry(site).or_insert_with(|| Rc::new(gather(cells, site, first()))).clone()
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
    let mut seen = HashSet::from([first]);
    let mut all = vec![first];
    let mut next = 0;
    while let Some(&cell) = all.get(next) {
        next += 1;
        all.extend(beside(cell).filter(|&other| seen.insert(other)));
    }
    all.sort_unstable();
    let places = |&cell: &u32| {
        let mut places = [0; 3];
        let place = |other: u32| all.binary_search(&other).unwrap_or(0) as u32;
        places.iter_mut().zip(beside(cell)).for_each(|(k, other)| *k = place(other));
        places
    };
    let beside = all.iter().map(places).collect();
    Star { cells: all, beside }
}

impl Star {
    /// For each cell the number of its connected part of one label, and how many parts there are inside and outside.
    pub(super) fn groups(&self, labels: &[bool]) -> (Vec<u32>, Groups) {
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

impl Star {
    /// Returns how many vertices of surfaces the site is, with these labels of the cells.
    pub(super) fn sheets(&self, labels: &[bool]) -> i64 {
        match self.groups(labels).1 {
            Groups { inside: 0, .. } | Groups { outside: 0, .. } => 0,
            Groups { inside, outside } => i64::from(inside + outside) - 1,
        }
    }

    /// Returns how many parts too many there are at the site, with these labels of the cells. Small stars, as most are, fit into the bits
    /// of a number.
    pub(super) fn defect(&self, labels: &[bool]) -> u32 {
        let count = self.cells.len();
        if count > 128 {
            return self.groups(labels).1.defect();
        }
        let all = if count == 128 { u128::MAX } else { (1 << count) - 1 };
        let bits = labels.iter().rev().fold(0u128, |bits, &is| bits << 1 | u128::from(is));
        Groups { inside: self.parts(bits), outside: self.parts(all & !bits) }.defect()
    }

    /// Returns how many connected parts some cells are in, one bit each.
    fn parts(&self, mut left: u128) -> u32 {
        let mut parts = 0;
        while left != 0 {
            parts += 1;
            let mut open = left & left.wrapping_neg();
            left ^= open;
            while open != 0 {
                let cell = open.trailing_zeros() as usize;
                open &= open - 1;
                let beside = self.beside[cell].iter().fold(0u128, |bits, &k| bits | 1 << k);
                open |= beside & left;
                left &= !beside;
            }
        }
        parts
    }
}

/// The number of connected parts around a vertex.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A ring of cells, each beside the one before, the one after, and itself in place of a third.
    fn ring(count: u32) -> Star {
        let beside = |k| [(k + count - 1) % count, (k + 1) % count, k];
        Star { cells: (0..count).collect(), beside: (0..count).map(beside).collect() }
    }

    #[test]
    fn bits_and_lists_count_the_same_parts() {
        for count in [3, 8, 64, 127, 128, 129, 200] {
            let star = ring(count);
            for period in [1, 2, 5, 40, 300] {
                let labels: Vec<bool> = (0..count).map(|k| k / period % 2 == 0).collect();
                let groups = star.groups(&labels).1;
                assert_eq!(star.defect(&labels), groups.defect(), "{count} {period}");
                let changes = (0..count)
                    .filter(|&k| labels[k as usize] != labels[(k as usize + 1) % count as usize]);
                let parts = changes.count().max(1) as u32;
                assert_eq!(groups.inside + groups.outside, parts);
            }
        }
    }
}
