//! Curves with corners: the shortest set of loops that a local search finds among Delaunay edges.
//!
//! *Problem.* At a sharp corner no sampling is dense enough for the crusts: the samples on both sides of it are nearer to each other
//! than to it, and it is cut off.
//! *Idea.* Where samples are dense beside what lies across, the curve is the shortest way to give each of them two edges, turns
//! counted. How probable each Delaunay edge is then, over all such ways, comes from messages between neighbors ([`belief`]); sought
//! are the loops of least doubt, an edge of probability p counting 1 − p. Likely edges first, as far as degrees allow; then, as Lin
//! and Kernighan do with tours, exchanges of two or three edges that lower the sum. Loops may be many, so each exchange is allowed
//! that keeps the degrees. A missing edge costs nearly as much as a wrong one at each end, so that curves may end.
//! *Guarantee.* No two edges cross, as all are Delaunay edges. None on being the curve that was sampled: measured on outlines of
//! letters and on coastlines.
//! *Trap.* By length alone a corner of less than 38° is cut off: its last three samples become a triangle of their own.
//! *Trap.* Both neighbors of t₃ are tried as t₄: in a tour one of them would cut it in two, here loops may part.
//! *Trap.* Coastlines are often finer than their samples: of every hundred of their edges between one and two are no Delaunay edges,
//! and no choice among these finds more.
//! *Reference.* The aim is that of Dey and Wenger, Computational Geometry 19, 2001; shortest tours as curves: Giesen 1999; the
//! exchanges: Lin and Kernighan 1973.

use taut_points::{Monitor, OrderBy};

use super::belief;
use super::graph::Edge;
use super::near::NONE;
use crate::Error;

/// What a missing edge costs, where an edge of probability p costs 1 − p.
const MISSING_EDGE_COST: f64 = 0.9;

/// Odds of an edge that another method found too, over those of the same edge without. No unit. Measured on 30 drawn maps, full and
/// thinned: with 2, 8 or 16 fewer are as near to the best method.
const FAVORED_ODDS_RATIO: f64 = 4.0;

/// Edges longer than this many spacings at their ends are left out from the start: of densely sampled curves they are
/// most of the triangulation, and were three quarters of the memory. A million places by chance have gaps of up to
/// fourteen times the mean, which is more times the spacing where points around happen to be near each other.
const LENGTH_RATIO_MAX: f64 = 100.0;

/// The Delaunay neighbors of all sites.
pub(super) struct Graph {
    /// Where the neighbors of each site begin.
    starts: Vec<u32>,
    /// Neighbors with the lengths of the edges, near ones first.
    neighbors: Vec<(f64, u32)>,
}

impl Graph {
    fn new(sites: &[[f64; 2]], edges: Vec<Edge>) -> Self {
        let mut starts = vec![0u32; sites.len() + 1];
        edges.iter().flat_map(|edge| edge.ends).for_each(|site| starts[site as usize + 1] += 1);
        for site in 0..sites.len() {
            starts[site + 1] += starts[site];
        }
        let mut next = starts.clone();
        let mut neighbors = vec![(0.0, 0); 2 * edges.len()];
        for edge in &edges {
            let [[x, y], [u, v]] = edge.ends.map(|site| sites[site as usize]);
            let length = (u - x).hypot(v - y);
            for (from, to) in [(0, 1), (1, 0)] {
                let place = &mut next[edge.ends[from] as usize];
                neighbors[*place as usize] = (length, edge.ends[to]);
                *place += 1;
            }
        }
        drop(edges);
        let mut graph = Self { starts, neighbors };
        graph.sort();
        graph
    }

    /// Without the edges that `stays` (length and ends) does not want, and without the memory for them.
    fn retain(&mut self, stays: impl Fn(f64, u32, u32) -> bool) {
        let (mut kept, mut begin) = (0, 0);
        for site in 0..self.starts.len() - 1 {
            let end = self.starts[site + 1] as usize;
            for place in begin..end {
                let (length, to) = self.neighbors[place];
                if stays(length, site as u32, to) {
                    self.neighbors[kept] = (length, to);
                    kept += 1;
                }
            }
            (begin, self.starts[site + 1]) = (end, kept as u32);
        }
        self.neighbors.truncate(kept);
        self.neighbors.shrink_to_fit();
    }

    fn sort(&mut self) {
        for range in self.starts.windows(2) {
            let around = &mut self.neighbors[range[0] as usize..range[1] as usize];
            around.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        }
    }

    pub(super) fn sites(&self) -> std::ops::Range<u32> {
        0..self.starts.len() as u32 - 1
    }

    /// Where the neighbors of a site begin in the list of all.
    pub(super) fn first(&self, site: u32) -> usize {
        self.starts[site as usize] as usize
    }

    pub(super) fn around(&self, site: u32) -> &[(f64, u32)] {
        &self.neighbors[self.first(site)..self.first(site + 1)]
    }

    /// The same, with 1 − p for lengths; likely ones first. `favored` edges have [`FAVORED_ODDS_RATIO`] times the odds.
    fn doubts(
        mut self,
        sites: &[[f64; 2]],
        favored: &[[u32; 2]],
        monitor: &Monitor<'_>,
    ) -> Result<Self, Error> {
        let spacings = belief::spacings(&self);
        self.retain(|length, a, b| {
            length <= LENGTH_RATIO_MAX * (spacings[a as usize] * spacings[b as usize]).sqrt()
        });
        let probabilities = belief::probabilities(sites, &self, &spacings, monitor)?;
        drop(spacings);
        for (near, probability) in self.neighbors.iter_mut().zip(probabilities) {
            near.0 = 1.0 - probability;
        }
        for site in self.sites() {
            for place in self.first(site)..self.first(site + 1) {
                let (doubt, to) = self.neighbors[place];
                if favored.binary_search(&[site.min(to), site.max(to)]).is_ok() {
                    self.neighbors[place].0 = doubt / (doubt + FAVORED_ODDS_RATIO * (1.0 - doubt));
                }
            }
        }
        self.sort();
        Ok(self)
    }
}

/// The search: edges as links of sites, a missing one as a link to [`NONE`].
struct Search {
    /// Neighbors by doubt.
    graph: Graph,
    links: Vec<[u32; 2]>,
    /// What each site costs as it is.
    costs: Vec<f64>,
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

/// The edges of the loops; `favored`, ascending pairs of ascending ends, are more probable than others.
pub(super) fn edges(
    sites: &[[f64; 2]],
    graph: Vec<Edge>,
    favored: &[[u32; 2]],
    monitor: &Monitor<'_>,
) -> Result<Vec<[u32; 2]>, Error> {
    let mut search = Search::new(Graph::new(sites, graph).doubts(sites, favored, monitor)?);
    monitor.check()?;
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
    fn new(graph: Graph) -> Self {
        let count = graph.sites().len();
        Self {
            links: vec![[NONE; 2]; count],
            costs: Vec::new(),
            queue: graph.sites().collect(),
            queued: vec![true; count],
            graph,
        }
    }

    fn around(&self, site: u32) -> &[(f64, u32)] {
        self.graph.around(site)
    }

    /// Whether an edge may be there: a Delaunay edge, or a missing one.
    fn allowed(&self, a: u32, b: u32) -> bool {
        a == NONE || b == NONE || self.around(a).iter().any(|near| near.1 == b)
    }

    /// What a site costs with these two links: half of what they do, as the other half is their other ends'.
    fn cost(&self, site: u32, links: [u32; 2]) -> f64 {
        let doubt = |to: u32| {
            let near = self.around(site).iter().find(|near| near.1 == to);
            near.map_or(MISSING_EDGE_COST, |near| near.0 / 2.0)
        };
        doubt(links[0]) + doubt(links[1])
    }

    /// By how much an exchange lowers the costs of the sites in it.
    fn gain(&self, drop: &[[u32; 2]], add: &[[u32; 2]]) -> f64 {
        let touched = drop.as_flattened();
        let (mut gain, mut before) = (0.0, 0.0);
        for (i, &site) in touched.iter().enumerate() {
            if site == NONE || touched[..i].contains(&site) {
                continue;
            }
            let old = self.links[site as usize];
            let mut new = old;
            let mut replace = |from: u32, to: u32| {
                if let Some(link) = new.iter_mut().find(|link| **link == from) {
                    *link = to;
                }
            };
            for (edges, adds) in [(drop, false), (add, true)] {
                for &[a, b] in edges.iter().filter(|edge| edge.contains(&site)) {
                    let other = if a == site { b } else { a };
                    if adds { replace(NONE, other) } else { replace(other, NONE) }
                }
            }
            let cost = self.costs[site as usize];
            before += cost;
            gain += cost - self.cost(site, new);
        }
        // Less than this is rounding, and might be undone for the same gain.
        if gain > 1e-9 * before { gain } else { 0.0 }
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
        order.order_by(&|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
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
        self.costs =
            (0u32..).zip(&self.links).map(|(site, &links)| self.cost(site, links)).collect();
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

    /// The best exchange that begins by dropping an edge of a site: of two edges if one of those gains, else of three.
    fn best_from(&self, t2: u32) -> Option<Exchange> {
        let mut best = None;
        for edges in [2, 3] {
            for t1 in self.links[t2 as usize] {
                self.leave_edge(&mut best, edges, t1, t2);
            }
            if best.is_some() {
                break;
            }
        }
        best
    }

    /// What dropping all edges of a site could gain.
    fn slack(&self, site: u32) -> f64 {
        if site == NONE { 0.0 } else { self.costs[site as usize] }
    }

    fn leave_edge(&self, best: &mut Option<Exchange>, edges: usize, t1: u32, t2: u32) {
        // More than this is not to be had by dropping edges here: a bound of the search, not of what is possible.
        let budget = self.slack(t1).max(self.slack(t2));
        for &(added, t3) in self.around(t2) {
            if added >= budget {
                break;
            }
            if t3 == t1 || self.linked(t2, t3) {
                continue;
            }
            for t4 in self.links[t3 as usize] {
                if t4 == t2 || t4 == t1 && t1 != NONE {
                    continue;
                }
                if edges == 2 {
                    if !self.linked(t4, t1) && self.allowed(t4, t1) {
                        self.keep(best, &[[t1, t2], [t3, t4]], &[[t2, t3], [t4, t1]]);
                    }
                } else if t4 != NONE {
                    self.third(best, [t1, t2, t3, t4]);
                }
            }
        }
    }

    /// Exchanges of three edges that go on from t₄.
    fn third(&self, best: &mut Option<Exchange>, [t1, t2, t3, t4]: [u32; 4]) {
        let budget = self.slack(t4);
        for &(added, t5) in self.around(t4) {
            if added >= budget {
                break;
            }
            if t5 == t3 || t5 == t2 || t5 == t1 || self.linked(t4, t5) {
                continue;
            }
            for t6 in self.links[t5 as usize] {
                // An edge that is dropped already, or just added.
                let among = |a: u32, b: u32, c: u32, d: u32| (a, b) == (c, d) || (a, b) == (d, c);
                let again = among(t5, t6, t1, t2) || among(t5, t6, t3, t4);
                let doubled = among(t6, t1, t2, t3) || among(t6, t1, t4, t5);
                if again || doubled || t6 == t1 && t1 != NONE || self.linked(t6, t1) {
                    continue;
                }
                if self.allowed(t6, t1) {
                    let drop = [[t1, t2], [t3, t4], [t5, t6]];
                    self.keep(best, &drop, &[[t2, t3], [t4, t5], [t6, t1]]);
                }
            }
        }
    }

    fn keep(&self, best: &mut Option<Exchange>, drop: &[[u32; 2]], add: &[[u32; 2]]) {
        let gain = self.gain(drop, add);
        if gain > best.as_ref().map_or(0.0, |best| best.gain) {
            let mut exchange =
                Exchange { gain, drop: [[NONE; 2]; 3], add: [[NONE; 2]; 3], edges: drop.len() };
            exchange.drop[..drop.len()].copy_from_slice(drop);
            exchange.add[..add.len()].copy_from_slice(add);
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
            if site != NONE {
                self.costs[site as usize] = self.cost(site, self.links[site as usize]);
            }
            if site != NONE && !self.queued[site as usize] {
                self.queued[site as usize] = true;
                self.queue.push_back(site);
            }
        }
    }
}
