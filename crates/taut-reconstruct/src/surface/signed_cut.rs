//! Labels that all facets together object to least: a signed cut, improved by minimum cuts around what is in doubt.
//!
//! *Problem.* The label of a cell hangs on a single path of the tree. In a wall one or two spacings thick one wrong facet on that path turns
//! over all that hangs on it, against most of the facets around. The labels sought have the least E = Σ |s| over the facets that disagree with
//! them, which is the maximum cut of a signed graph, and hard; but near the labels of the tree it is easy.
//! *Idea.* Facets that short cycles settle (`cycles`) hardly have anything to gain. For each other one that disagrees, let one of its cells be the one
//! that may turn over and the other one stay. So E has a linear bound that is exact for the labels there are, and its least value is a
//! minimum cut: weight flows from the cells that may turn to those that stay, through facets that agree. Where flow finds no way out, the
//! cells that it reached turn over together. Which cell of a facet may turn is chosen in five ways by turns: that of the smaller sphere, of
//! the larger one, inside, outside, and either one.
//! *Guarantee.* Each step lowers E, and sums are exact: the labels are a function of the points. Searches end after [`REGION_CELLS_MAX`] cells, all
//! of them after [`VISITS_PER_CELL`] times as many cells as there are, so O(n).
//! *Trap.* The least E is not always the truth: where a hole is as narrow as the walls around it, closing it can cost less. Cuts from the
//! labels of the tree, which begin where these are most in doubt, do better than the optimum. Two ways in place of five keep nine in fifteen
//! of the gains.
//! *Other code.* Libraries for maximum flow (petgraph, pathfinding) take a graph that is stored edge by edge, and find one cut of all of it. Here the
//! graph is the triangulation, and nearly all of it is never looked at.
//! *Reference.* Boykov, Veksler and Zabih, *Fast approximate energy minimization via graph cuts*, IEEE PAMI 23(11), 2001, for moves that are
//! cuts; Rother, Kumar, Kolmogorov and Blake, CVPR 2005, for linear bounds that touch.

use std::collections::{BTreeSet, HashSet};

use taut_points::{Cancelled, Monitor, OrderBy};

use super::cells::Cells;
use super::cycles::{Found, Network, Objection};
use super::dual_edges::{CERTAIN_STEPS, DualEdges};
use super::spheres::{Point, circumsphere};

/// A search is given up after this many cells.
const REGION_CELLS_MAX: usize = 2000;
/// All searches together come by this many times as many cells as there are. Samples that are dense enough take a few times as many, thin
/// walls up to a hundred; noise would take more without an end.
const VISITS_PER_CELL: u64 = 100;
/// A facet is left alone if cycles carry all but this much of its weight: an eighth of what a certain facet says.
const LEFT_MIN: u32 = (CERTAIN_STEPS / 8) as u32;
/// Which cell of a facet may turn is chosen in this many ways.
const WAYS: u32 = 5;

/// What was done.
#[derive(Clone, Debug, Default)]
pub(super) struct Improved {
    /// Of each facet that disagrees with the labels in the end one cell, in the order of cells.
    pub(super) doubtful: Vec<u32>,
    /// Regions that were turned over.
    pub(super) regions: u64,
    /// Rounds.
    pub(super) rounds: u64,
    /// Facets whose weight cycles do not carry, in the end.
    pub(super) unsettled: u64,
}

/// What labels are of.
#[derive(Clone, Copy)]
pub(super) struct Doubted<'a> {
    pub(super) cells: &'a Cells,
    pub(super) points: &'a [Point],
    pub(super) dual_edges: &'a DualEdges,
    /// True if ghosts are one and stay outside.
    pub(super) ghosts_stay: bool,
}

/// The end of a round.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Round {
    /// Nothing is left to be tried in this way.
    Nothing,
    /// No cut is better than the labels.
    Idle,
    /// Cells were turned over.
    Turned,
}

struct Improver<'a> {
    network: Network<'a>,
    points: &'a [Point],
    /// In the order of facets.
    objections: Vec<Objection>,
    /// By cell, what still may flow into it.
    demand: Vec<i64>,
    improved: Improved,
}

/// Improves labels. Of each facet that disagrees with them one cell at least is among `doubtful`.
pub(super) fn improve(
    Doubted { cells, points, dual_edges, ghosts_stay }: Doubted<'_>,
    inside: &mut [bool],
    doubtful: &[u32],
    monitor: &Monitor<'_>,
) -> Result<Improved, Cancelled> {
    let network = Network::new(cells, dual_edges, inside, ghosts_stay);
    let demand = vec![0; cells.len()];
    let improved = Improved::default();
    let mut improver = Improver { network, points, objections: Vec::new(), demand, improved };
    improver.object(doubtful);
    let (mut idle, visits_max) = (0, VISITS_PER_CELL * cells.len() as u64);
    for way in (0..WAYS).cycle() {
        if idle == WAYS || improver.network.visited > visits_max {
            break;
        }
        monitor.check()?;
        let found = improver.round(way);
        idle = if found == Round::Turned { 0 } else { idle + 1 };
        improver.improved.rounds += u64::from(found != Round::Nothing);
    }
    let Improver { objections, improved, .. } = improver;
    let unsettled = objections.iter().filter(|objection| objection.left > 0).count() as u64;
    let doubtful = objections.iter().map(|objection| objection.facet >> 2).collect();
    Ok(Improved { doubtful, unsettled, ..improved })
}

impl Improver<'_> {
    /// Lists the facets of some cells that disagree, beside those listed, and settles what can be settled.
    fn object(&mut self, some: &[u32]) {
        let network = &mut self.network;
        let facets = some.iter().flat_map(|&cell| (0..4).map(move |i| cell << 2 | i));
        let facets = facets
            .filter(|&facet| network.dual_edges.at(facet).weight() > 0 && network.disagrees(facet));
        let mut facets: Vec<u32> =
            facets.map(|facet| facet.min(network.cells.mirror(facet))).collect();
        facets.sort_unstable();
        facets.dedup();
        let known = &self.objections;
        facets.retain(|facet| known.binary_search_by_key(facet, |known| known.facet).is_err());
        let new = facets.into_iter().map(|facet| {
            let ends = [facet, network.cells.mirror(facet)].map(|facet| facet >> 2);
            let [one, two] = ends.map(|cell| radius(network.cells, self.points, cell));
            Objection::new(facet, one > two, network)
        });
        self.objections.extend(new);
        self.objections.order_by_key(|objection| objection.facet);
        let unsettled = self.objections.iter_mut().filter(|objection| objection.tried == 0);
        unsettled.for_each(|objection| objection.settle(network));
    }

    /// Turns over what a minimum cut says.
    fn round(&mut self, way: u32) -> Round {
        let is_tried =
            |objection: &Objection| objection.left < LEFT_MIN || objection.tried >> way & 1 == 1;
        if self.objections.iter().all(is_tried) {
            return Round::Nothing;
        }
        self.orient(way);
        // By cell what has to flow out of it.
        let (mut excess, mut ends) = (Vec::new(), Vec::new());
        for objection in self.objections.iter_mut().filter(|objection| !is_tried(objection)) {
            let [from, to] = objection.ends(&self.network);
            excess.push((from, i64::from(objection.left)));
            self.demand[to as usize] += i64::from(objection.left);
            objection.tried |= 1 << way;
            ends.push(to);
        }
        excess.sort_unstable();
        let mut flows: Vec<(Vec<u32>, u32)> = Vec::new();
        let mut region = Vec::new();
        for same in excess.chunk_by(|one, other| one.0 == other.0) {
            let (from, mut left) = (same[0].0, same.iter().map(|(_, amount)| amount).sum::<i64>());
            // What may flow in at once need not look for a way.
            let own = left.min(self.demand[from as usize]);
            left -= own;
            self.demand[from as usize] -= own;
            while left > 0 && !self.network.is_closed(from) {
                let demand = &self.demand;
                let is_goal = |network: &Network<'_>, cell: u32| {
                    demand[cell as usize] > 0 || network.is_fixed(cell)
                };
                match self.network.search(from, REGION_CELLS_MAX, is_goal) {
                    Found::Goal(place) => {
                        let (way, to) = (self.network.way(place), self.network.reached(place));
                        let is_fixed = self.network.is_fixed(to);
                        let most = if is_fixed { left } else { left.min(self.demand[to as usize]) };
                        let amount =
                            self.network.flow(&way, most.min(i64::from(u32::MAX >> 2)) as u32);
                        left -= i64::from(amount);
                        if !is_fixed {
                            self.demand[to as usize] -= i64::from(amount);
                        }
                        flows.push((way, amount));
                    }
                    Found::Closed => region.extend(self.network.close()),
                    Found::Open => break,
                }
            }
        }
        // Cycles alone stay for the next round.
        for (way, amount) in flows {
            way.iter().for_each(|&facet| self.network.push(facet, (amount as i32).wrapping_neg()));
        }
        ends.iter().for_each(|&cell| self.demand[cell as usize] = 0);
        let turned = self.turn(&region);
        self.network.reopen(&region);
        if turned.is_empty() {
            return Round::Idle;
        }
        let cells = self.network.cells;
        let near: HashSet<u32> = turned.iter().flat_map(|&cell| cells.sites(cell)).collect();
        for objection in &mut self.objections {
            objection.reconsider(&mut self.network);
            let ends = [objection.facet, cells.mirror(objection.facet)].map(|facet| facet >> 2);
            if ends.iter().any(|&end| cells.sites(end).iter().any(|site| near.contains(site))) {
                objection.tried = 0;
            }
        }
        let network = &self.network;
        self.objections.retain(|objection| network.disagrees(objection.facet));
        self.object(&turned);
        Round::Turned
    }

    /// Has flow come from the cells that may turn over.
    fn orient(&mut self, way: u32) {
        let network = &mut self.network;
        for objection in &mut self.objections {
            let ends = [objection.facet >> 2, network.cells.mirror(objection.facet) >> 2];
            let is_turned = match ends.map(|cell| network.is_fixed(cell)) {
                [true, _] => true,
                [_, true] => false,
                _ => match way {
                    0 | 1 => objection.is_first_larger == (way == 0),
                    2 => !network.inside[ends[0] as usize],
                    3 => network.inside[ends[0] as usize],
                    _ => objection.facet.wrapping_mul(0x9e37_79b1) >> 31 == 1,
                },
            };
            if is_turned != objection.is_turned {
                objection.turn(network);
            }
        }
    }

    /// Turns over the parts of a region that this makes agree better, and returns their cells.
    fn turn(&mut self, region: &[u32]) -> Vec<u32> {
        let Network { cells, dual_edges, .. } = self.network;
        let mut turned = Vec::new();
        let mut left: BTreeSet<u32> = region.iter().copied().collect();
        while let Some(first) = left.pop_first() {
            let mut part = vec![first];
            let (mut next, mut gain) = (0, 0);
            while let Some(&cell) = part.get(next) {
                next += 1;
                for (i, dual_edge) in (0..).zip(dual_edges.of_cell(cell)) {
                    let (other, _) = cells.across(cell, i);
                    if !self.network.is_closed(other) {
                        let weight = i64::from(dual_edge.weight());
                        let disagrees = self.network.disagrees(cell << 2 | i as u32);
                        gain += if disagrees { weight } else { -weight };
                    } else if left.remove(&other) {
                        part.push(other);
                    }
                }
            }
            if gain > 0 {
                part.iter().for_each(|&cell| {
                    self.network.inside[cell as usize] = !self.network.inside[cell as usize];
                });
                self.improved.regions += 1;
                turned.extend(part);
            }
        }
        turned
    }
}

/// The radius of the circumsphere of a cell; that of a ghost is without end.
fn radius(cells: &Cells, points: &[Point], cell: u32) -> f64 {
    if cells.is_ghost(cell) {
        return f64::INFINITY;
    }
    circumsphere(cells.ascending(cell).map(|site| points[site as usize])).radius
}

#[cfg(test)]
mod tests {
    use taut_delaunay::{DelaunayOptions, Space};
    use taut_points::{Distribution, Points, generate};

    use super::*;

    /// The sum of the weights of facets that disagree with labels, each once.
    fn energy(cells: &Cells, dual_edges: &DualEdges, inside: &[bool]) -> u64 {
        let all = (0..4 * cells.len() as u32).filter(|&facet| facet < cells.mirror(facet));
        all.filter(|&facet| {
            let ends = [facet >> 2, cells.mirror(facet) >> 2].map(|cell| inside[cell as usize]);
            dual_edges.at(facet).is_opposite() != (ends[0] != ends[1])
        })
        .map(|facet| u64::from(dual_edges.at(facet).weight()))
        .sum()
    }

    /// All labels of a few cells are tried: nothing gets worse, and most of what is settled is the least of all.
    #[test]
    fn cuts_lower_the_energy_mostly_to_the_least() {
        let (mut settled, mut best, mut lowered) = (0, 0, 0);
        for seed in 0..60u64 {
            let count = 6 + seed as usize % 3;
            let values: Vec<f64> = generate(Distribution::Uniform, count, 3, seed).expect("valid");
            let points = Points::new(&values, 3).expect("whole rows");
            let space = Space::build(&points, &DelaunayOptions::default()).expect("finite");
            let sites: Vec<Point> =
                (0..space.site_count() as u32).map(|site| space.site(site)).collect();
            let cells = Cells::of(space.into_slots(), count);
            let dual_edges = DualEdges::of(&cells, &sites, true);
            let finite: Vec<u32> = cells.finite().collect();
            let labeled = |bits: usize| {
                let mut inside = vec![false; cells.len()];
                let own = finite.iter().enumerate();
                own.for_each(|(k, &cell)| inside[cell as usize] = bits >> k & 1 == 1);
                inside
            };
            let least = (0..1 << finite.len())
                .map(|bits| energy(&cells, &dual_edges, &labeled(bits)))
                .min()
                .expect("at least one cell");
            let all: Vec<u32> = (0..cells.len() as u32).collect();
            let mut inside = labeled(0x5a5a_1234 ^ seed as usize);
            let before = energy(&cells, &dual_edges, &inside);
            let doubted = Doubted {
                cells: &cells,
                points: &sites,
                dual_edges: &dual_edges,
                ghosts_stay: true,
            };
            let improved =
                improve(doubted, &mut inside, &all, &Monitor::silent()).expect("never cancelled");
            let after = energy(&cells, &dual_edges, &inside);
            assert!(least <= after && after <= before);
            assert!(improved.regions == 0 || after < before);
            assert!(cells.finite().count() == finite.len());
            assert!(
                (0..cells.len() as u32).all(|cell| !cells.is_ghost(cell) || !inside[cell as usize])
            );
            lowered += usize::from(after < before);
            if improved.unsettled == 0 {
                settled += 1;
                best += usize::from(after == least);
            }
        }
        assert!(lowered >= 20 && 2 * best >= settled && best >= 5, "{lowered} {best} {settled}");
    }
}
