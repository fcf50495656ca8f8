//! Curves with corners: the shortest set of loops that a local search finds among Delaunay edges.
//!
//! *Problem.* At a sharp corner no sampling is dense enough for the crusts: the samples on both sides of it are nearer to each other
//! than to it, and it is cut off.
//! *Idea.* Where samples are dense beside what lies across, the curve is the shortest way to give each of them two edges; a corner
//! changes nothing in that. Short Delaunay edges first, as far as degrees allow; then, as Lin and Kernighan do with tours, exchanges
//! of two or three edges that shorten the whole. Loops may be many, so each exchange is allowed that keeps the degrees. A missing edge
//! costs as much as a gap of a few spacings, so that curves may end.
//! *Guarantee.* No two edges cross, as all are Delaunay edges. None on being the curve that was sampled: measured on outlines of
//! letters and on coastlines.
//! *Trap.* Both neighbours of t₃ are tried as t₄: in a tour one of them would cut it in two, here loops may part.
//! *Reference.* The aim is that of Dey and Wenger, Computational Geometry 19, 2001; shortest tours as curves: Giesen 1999; the exchanges: Lin and Kernighan 1973.

use taut_points::Monitor;

use super::graph::Edge;
use super::near::NONE;
use crate::Error;
use crate::curve::options::Ends;

/// What a missing edge costs, in units of the distance of the second nearest Delaunay neighbour.
const MISSING: f64 = 4.0;

/// The search: edges as links of sites, a missing one as a link to [`NONE`].
struct Search {
    /// Where the neighbours of each site begin in `neighbors`.
    starts: Vec<u32>,
    /// Delaunay neighbours with their distances, near ones first.
    neighbors: Vec<(f64, u32)>,
    links: Vec<[u32; 2]>,
    missing: Vec<f64>,
    /// Sites to start from.
    queue: std::collections::VecDeque<u32>,
    queued: Vec<bool>,
}

/// A change: edges to drop and to add; ends may be [`NONE`].
#[derive(Clone, Copy)]
struct Exchange {
    gain: f64,
    drop: [[u32; 2]; 3],
    add: [[u32; 2]; 3],
    edges: usize,
}

pub(super) fn edges(
    sites: &[[f64; 2]],
    graph: &[Edge],
    ends: Ends,
    monitor: &Monitor<'_>,
) -> Result<Vec<[u32; 2]>, Error> {
    let mut search = Search::new(sites, graph, ends);
    search.greedy();
    monitor.check()?;
    search.improve(monitor)?;
    let linked = (0u32..).zip(&search.links);
    Ok(linked
        .flat_map(|(site, links)| links.map(|to| [site, to]))
        .filter(|&[a, b]| b != NONE && a < b)
        .collect())
}

impl Search {
    fn new(sites: &[[f64; 2]], graph: &[Edge], _ends: Ends) -> Self {
        let mut starts = vec![0u32; sites.len() + 1];
        graph.iter().flat_map(|edge| edge.ends).for_each(|site| starts[site as usize + 1] += 1);
        for site in 0..sites.len() {
            starts[site + 1] += starts[site];
        }
        let mut next = starts.clone();
        let mut neighbors = vec![(0.0, 0); 2 * graph.len()];
        for edge in graph {
            let [[x, y], [u, v]] = edge.ends.map(|site| sites[site as usize]);
            let length = (u - x).hypot(v - y);
            for (from, to) in [(0, 1), (1, 0)] {
                let place = &mut next[edge.ends[from] as usize];
                neighbors[*place as usize] = (length, edge.ends[to]);
                *place += 1;
            }
        }
        let mut search = Self {
            starts,
            neighbors,
            links: vec![[NONE; 2]; sites.len()],
            missing: Vec::new(),
            queue: (0..sites.len() as u32).collect(),
            queued: vec![true; sites.len()],
        };
        for site in 0..sites.len() {
            let range = search.starts[site] as usize..search.starts[site + 1] as usize;
            let around = &mut search.neighbors[range];
            around.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            search.missing.push(match around {
                [] => 0.0,
                [only] => MISSING * only.0,
                [_, second, ..] => MISSING * second.0,
            });
        }
        search
    }

    fn around(&self, site: u32) -> &[(f64, u32)] {
        let [first, end] = [site, site + 1].map(|i| self.starts[i as usize] as usize);
        &self.neighbors[first..end]
    }

    /// Of a Delaunay edge or of a missing edge; nothing for other pairs.
    fn cost(&self, a: u32, b: u32) -> Option<f64> {
        match (a, b) {
            (NONE, NONE) => Some(0.0),
            (NONE, site) | (site, NONE) => Some(self.missing[site as usize]),
            _ => self.around(a).iter().find(|near| near.1 == b).map(|near| near.0),
        }
    }

    fn linked(&self, a: u32, b: u32) -> bool {
        a != NONE && b != NONE && self.links[a as usize].contains(&b)
    }

    /// Short edges first, as far as degrees allow.
    fn greedy(&mut self) {
        let mut order: Vec<(f64, u32, u32)> = (0..self.links.len() as u32)
            .flat_map(|a| {
                self.around(a)
                    .iter()
                    .filter(move |near| a < near.1)
                    .map(move |near| (near.0, a, near.1))
            })
            .collect();
        order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        for (_, a, b) in order {
            if self.links[a as usize].contains(&NONE) && self.links[b as usize].contains(&NONE) {
                self.replace(a, NONE, b);
                self.replace(b, NONE, a);
            }
        }
    }

    /// Replaces one link of a site.
    fn replace(&mut self, site: u32, old: u32, new: u32) {
        if site != NONE {
            let links = &mut self.links[site as usize];
            let place = usize::from(links[0] != old);
            debug_assert!(links[place] == old, "what is dropped was there");
            links[place] = new;
        }
    }

    /// Exchanges edges until none of the kinds tried makes the whole shorter.
    fn improve(&mut self, monitor: &Monitor<'_>) -> Result<(), Error> {
        let mut steps = 0u32;
        while let Some(site) = self.queue.pop_front() {
            self.queued[site as usize] = false;
            steps = steps.wrapping_add(1);
            if steps.is_multiple_of(1 << 16) {
                monitor.check()?;
            }
            while let Some(exchange) = self.best_from(site) {
                self.apply(&exchange);
            }
        }
        Ok(())
    }

    /// The best exchange that begins by dropping an edge of a site.
    fn best_from(&self, t2: u32) -> Option<Exchange> {
        let mut best: Option<Exchange> = None;
        for t1 in self.links[t2 as usize] {
            let Some(dropped) = self.cost(t1, t2) else { continue };
            for &(added, t3) in self.around(t2) {
                let gain = dropped - added;
                if gain <= 0.0 {
                    break;
                }
                if t3 == t1 || self.linked(t2, t3) {
                    continue;
                }
                for t4 in self.links[t3 as usize] {
                    // An edge to nowhere that is dropped from both sides at once.
                    let Some(second) = self.cost(t3, t4) else { continue };
                    let gain = gain + second;
                    let first = [[t1, t2], [t3, t4]];
                    if t4 != t2 && (t4 != t1 || t1 == NONE) && !self.linked(t4, t1) {
                        if let Some(close) = self.cost(t4, t1) {
                            Self::keep(
                                &mut best,
                                Exchange {
                                    gain: gain - close,
                                    drop: [first[0], first[1], [NONE; 2]],
                                    add: [[t2, t3], [t4, t1], [NONE; 2]],
                                    edges: 2,
                                },
                            );
                        }
                    }
                    if t4 != NONE && t4 != t2 {
                        self.third(&mut best, gain, [t1, t2, t3, t4]);
                    }
                }
            }
        }
        best
    }

    /// Exchanges of three edges that go on from t₄.
    fn third(&self, best: &mut Option<Exchange>, gain: f64, [t1, t2, t3, t4]: [u32; 4]) {
        for &(added, t5) in self.around(t4) {
            let gain = gain - added;
            if gain <= 0.0 {
                break;
            }
            if t5 == t3 || t5 == t2 || t5 == t1 || self.linked(t4, t5) {
                continue;
            }
            for t6 in self.links[t5 as usize] {
                // Edges dropped before are not there any more.
                let again = |a: u32, b: u32| (t5 == a && t6 == b) || (t5 == b && t6 == a);
                if again(t1, t2) || again(t3, t4) || t6 == t1 && t1 != NONE || self.linked(t6, t1) {
                    continue;
                }
                let same = |a: u32, b: u32| (t6 == a && t1 == b) || (t6 == b && t1 == a);
                if same(t2, t3) || same(t4, t5) {
                    continue;
                }
                if let (Some(third), Some(close)) = (self.cost(t5, t6), self.cost(t6, t1)) {
                    Self::keep(
                        best,
                        Exchange {
                            gain: gain + third - close,
                            drop: [[t1, t2], [t3, t4], [t5, t6]],
                            add: [[t2, t3], [t4, t5], [t6, t1]],
                            edges: 3,
                        },
                    );
                }
            }
        }
    }

    fn keep(best: &mut Option<Exchange>, exchange: Exchange) {
        // Less than this is rounding, and might be undone for the same gain.
        let scale = 1e-12;
        let most = best.as_ref().map_or(0.0, |b| b.gain);
        if exchange.gain > most * (1.0 + scale) && exchange.gain > 0.0 {
            *best = Some(exchange);
        }
    }

    fn apply(&mut self, exchange: &Exchange) {
        let count = exchange.edges;
        // Of each site the edges dropped make room for those added.
        for &[a, b] in &exchange.drop[..count] {
            self.replace(a, b, NONE);
            self.replace(b, a, NONE);
        }
        for &[a, b] in &exchange.add[..count] {
            if a != NONE && b != NONE {
                self.replace(a, NONE, b);
                self.replace(b, NONE, a);
            }
        }
        for &site in exchange.drop[..count].iter().flatten() {
            if site != NONE && !self.queued[site as usize] {
                self.queued[site as usize] = true;
                self.queue.push_back(site);
            }
        }
    }
}
