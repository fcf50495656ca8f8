//! The centres next to each centre, so that few are asked for each row.

use rayon::prelude::*;

use super::enclosure::distance;

/// So few centres are asked as quickly without lists.
const LEAST: usize = 12;

/// So many are listed for each, in 16 bytes each; farther ones are asked in no order.
const LISTED: usize = 128;

/// For each centre, the centres next to it with their distances, ascending.
pub(super) struct Neighbours {
    lists: Vec<Vec<(f64, usize)>>,
}

impl Neighbours {
    /// `None` for few centres.
    pub(super) fn of(centers: &[Vec<f64>]) -> Option<Self> {
        if centers.len() < LEAST {
            return None;
        }
        let list = |from: &Vec<f64>| {
            let mut list: Vec<(f64, usize)> =
                centers.iter().map(|to| distance(from, to)).zip(0..).collect();
            let order =
                |a: &(f64, usize), b: &(f64, usize)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
            if list.len() > LISTED {
                list.select_nth_unstable_by(LISTED - 1, order);
                list.truncate(LISTED);
            }
            list.sort_unstable_by(order);
            list.shrink_to_fit();
            list
        };
        Some(Neighbours { lists: centers.par_iter().map(list).collect() })
    }

    /// All centres at most so far from this one, the nearest first, and perhaps others.
    pub(super) fn within(&self, from: usize, reach: f64) -> impl Iterator<Item = usize> {
        let list = &self.lists[from];
        let ends_early = list.len() < self.lists.len() && list.last().is_none_or(|l| l.0 <= reach);
        let rest = if ends_early { 0..self.lists.len() } else { 0..0 };
        let near = list.iter().take_while(move |(distance, _)| *distance <= reach);
        near.map(|&(_, to)| to).chain(rest)
    }
}
