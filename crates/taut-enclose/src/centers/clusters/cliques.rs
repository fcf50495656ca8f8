//! Items no two of which fit in one ball, and the last empty cluster, which may be too small for all that fit in no other.

use super::Clusters;
use super::apart_pairs::ApartPairs;
use crate::centers::items::Position;
use crate::centers::small_ball::Ball;

/// Cliques are sought from every item that fits nowhere if there are at most so many, else from the first so many.
const CLIQUE_STARTS: usize = 24;
/// Comparisons of pairs that a search for a large clique may make, about 0.1 s: beyond, it starts from fewer items.
const CLIQUE_PAIRS: usize = 20_000_000;

impl<P: Position> Clusters<P> {
    /// A clique of items that fit in no cluster, the largest of some greedy ones; the search ends with one of more than `capacity` items.
    pub(super) fn find_clique(&mut self, capacity: usize) {
        let mut clique = std::mem::take(&mut self.clique);
        clique.clear();
        let mut trial = vec![];
        for &start in self.unplaced.iter().take(CLIQUE_STARTS) {
            self.greedy_clique(start, &self.unplaced, capacity, &mut trial);
            if trial.len() > clique.len() {
                std::mem::swap(&mut clique, &mut trial);
            }
            if clique.len() > capacity {
                break;
            }
        }
        self.clique = clique;
    }

    /// The largest of greedy cliques from all items in turn; the search ends with one of more than `enough`.
    pub(in crate::centers) fn large_clique(&self, enough: usize) -> Vec<u32> {
        let count = self.items.len();
        if count.saturating_mul(count) / 2 <= CLIQUE_PAIRS {
            return ApartPairs::new(count, |a, b| self.are_apart(a, b)).large_clique(enough);
        }
        let candidates: Vec<u32> = (0..count as u32).collect();
        let pairs = count.saturating_mul(enough.min(count));
        let starts = (CLIQUE_PAIRS / pairs.max(1)).max(1);
        let (mut clique, mut trial) = (vec![], vec![]);
        for &start in candidates.iter().take(starts) {
            self.greedy_clique(start, &candidates, enough, &mut trial);
            if trial.len() > clique.len() {
                std::mem::swap(&mut clique, &mut trial);
            }
            if clique.len() > enough {
                break;
            }
        }
        clique
    }

    /// Items no two of which fit in one ball below the threshold, taken in order after `start`; ends with more than `enough`. Of a
    /// group there is one.
    fn greedy_clique(&self, start: u32, candidates: &[u32], enough: usize, clique: &mut Vec<u32>) {
        clique.clear();
        clique.push(start);
        for &candidate in candidates {
            if clique.len() > enough {
                return;
            }
            let is_apart = |&member: &u32| self.are_apart(member, candidate);
            if candidate != start && clique.iter().all(is_apart) {
                clique.push(candidate);
            }
        }
    }

    /// Returns true if some items of two groups fit in no ball below the threshold; of two items, where each stands for itself.
    fn are_apart(&self, a: u32, b: u32) -> bool {
        let far = |a: u32, b: u32| self.items.pair_radius(a as usize, b as usize) >= self.threshold;
        let Some(links) = &self.links else { return far(a, b) };
        links.group(a) != links.group(b)
            && links.linked(a).iter().any(|&a| links.linked(b).iter().any(|&b| far(a, b)))
    }

    /// Where no ball below the threshold holds all items that fit in no cluster, adds some of which that is true to the conflict.
    pub(super) fn refute_last_cluster(&mut self) {
        let together: Vec<u32> = match &self.links {
            None => self.unplaced.clone(),
            Some(links) => {
                self.unplaced.iter().flat_map(|&item| links.linked(item)).copied().collect()
            }
        };
        let mut ball = Ball::of_one(&self.items, together[0]);
        for at in 1..together.len() {
            let (known, more) = (&together[..at], together[at]);
            if !ball.holds(&self.items, more) {
                ball.grow(&self.items, known, more, self.threshold, &mut self.work);
            }
            if ball.radius >= self.threshold {
                self.conflicting.extend_from_slice(&ball.support);
                return;
            }
        }
    }
}
