//! A few items, and for each of them the rows at which a center has it within less than a radius.

use taut_points::{Monitor, ReadError};

use super::sites::Sites;
use crate::Error;

/// The words of a set of rows that are not empty, with their numbers.
pub(super) type Words = Vec<(u32, u64)>;

/// Number of rows in a set.
pub(super) fn size(words: &[(u32, u64)]) -> u32 {
    words.iter().map(|(_, word)| word.count_ones()).sum()
}

/// The items X, at one radius.
#[derive(Clone)]
pub(super) struct CoreSet<'s> {
    pub(super) sites: &'s Sites,
    /// Balls hold what lies within less than this.
    pub(super) radius: f64,
    /// The site of each item.
    pub(super) members: Vec<usize>,
    /// For each item, the rows that have it within the radius: all words, and those that are not empty.
    near: Vec<Vec<u64>>,
    words: Vec<Words>,
    sizes: Vec<u32>,
    /// For each item, a bit for each item that fits in one ball with it.
    fits: Vec<Vec<u64>>,
}

impl<'s> CoreSet<'s> {
    pub(super) fn new(
        sites: &'s Sites,
        radius: f64,
        members: &[usize],
        monitor: &Monitor<'_>,
    ) -> Result<Self, Error> {
        let mut core = CoreSet {
            sites,
            radius,
            members: vec![],
            near: vec![],
            words: vec![],
            sizes: vec![],
            fits: vec![],
        };
        for &site in members {
            monitor.check().map_err(ReadError::from)?;
            core.add(site);
        }
        Ok(core)
    }

    pub(super) fn len(&self) -> usize {
        self.members.len()
    }

    /// X ← X ∪ {item}.
    pub(super) fn add(&mut self, site: usize) {
        let near = self.sites.near(site, self.radius);
        let words: Words = (0..).zip(near.iter().copied()).filter(|(_, word)| *word != 0).collect();
        let new = self.members.len();
        self.members.push(site);
        self.sizes.push(size(&words));
        self.near.push(near);
        self.words.push(words);
        let mut fits = vec![0; new / 64 + 1];
        for other in 0..=new {
            if self.meets(&self.words[new], other) {
                fits[other / 64] |= 1 << (other % 64);
                let row = if other == new { &mut fits } else { &mut self.fits[other] };
                row.resize(new / 64 + 1, 0);
                row[new / 64] |= 1 << (new % 64);
            }
        }
        self.fits.push(fits);
    }

    /// The rows at which a center has this item.
    pub(super) fn words(&self, item: usize) -> &Words {
        &self.words[item]
    }

    pub(super) fn size(&self, item: usize) -> u32 {
        self.sizes[item]
    }

    fn meets(&self, words: &[(u32, u64)], item: usize) -> bool {
        let near = &self.near[item];
        words.iter().any(|&(at, word)| word & near[at as usize] != 0)
    }

    /// Returns how many of these rows have this item, too.
    pub(super) fn count(&self, words: &[(u32, u64)], item: usize) -> u32 {
        let near = &self.near[item];
        words.iter().map(|&(at, word)| (word & near[at as usize]).count_ones()).sum()
    }

    /// Those of these rows that have this item, too.
    pub(super) fn common(&self, words: &[(u32, u64)], item: usize) -> Words {
        let near = &self.near[item];
        let both = words.iter().map(|&(at, word)| (at, word & near[at as usize]));
        both.filter(|(_, word)| *word != 0).collect()
    }

    /// Returns true if some row has both items.
    pub(super) fn fit(&self, a: usize, b: usize) -> bool {
        self.fits[a].get(b / 64).is_some_and(|word| word >> (b % 64) & 1 == 1)
    }

    /// Items of which no two fit in one ball: those of `among`, the most particular first, that fit with none before,
    /// from several of them in turn; the largest such set found, or the first larger than `enough`.
    pub(super) fn separated(&self, among: &[usize], starts: usize, enough: usize) -> Vec<usize> {
        let degree = |&a: &usize| among.iter().filter(|&&b| self.fit(a, b)).count();
        let mut order: Vec<(usize, usize)> = among.iter().map(|a| (degree(a), *a)).collect();
        order.sort_unstable();
        let mut best: Vec<usize> = vec![];
        for &(_, start) in order.iter().take(starts) {
            let mut chosen = vec![start];
            for &(_, item) in &order {
                if item != start && chosen.iter().all(|&other| !self.fit(item, other)) {
                    chosen.push(item);
                }
            }
            if chosen.len() > best.len() {
                best = chosen;
            }
            if best.len() > enough {
                break;
            }
        }
        best
    }
}
