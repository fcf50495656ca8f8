//! A tour that meets itself nowhere.
//!
//! *Problem.* A tour through distinct sites, not all on a line, that is shorter or equal and a simple polygon or path.
//! *Idea.* Edges that meet are found by boxes over runs of the tour and exact signs. Two that cross are replaced by the sides of
//! their quadrilateral. A site inside an edge at which the tour turns, or ends, is taken out and put into that edge. A site inside
//! an edge at which it goes straight on is crossed there; or the two run along each other, and where the shorter
//! straight run ends, its last site is put into the other.
//! *Guarantee.* Each change makes the tour strictly shorter as a real number, so none comes back and it ends; no rounded length is
//! compared.
//! *Trap.* Candidates do not have all edges that a crossing asks for, so moves alone leave some.
//! *Reference.* Quintas and Supnick, On some properties of shortest Hamiltonian circuits, 1965.

use taut_points::Monitor;
use taut_predicates::plane::{lexicographic, orient};

use super::cycle::Cycle;
use crate::Error;

/// A leaf of the boxes has at most this many edges.
const LEAF_SIZE: usize = 8;

/// Removes all that meets; returns how many changes that took. A node that is no site stands between the ends of a path.
pub(super) fn untangle(
    sites: &[[f64; 2]],
    cycle: &mut Cycle,
    monitor: &Monitor<'_>,
) -> Result<u64, Error> {
    let mut changes = 0;
    loop {
        let meeting = Edges::of(sites, cycle.order()).meeting(monitor)?;
        if meeting.is_empty() {
            return Ok(changes);
        }
        for [[a, b], [c, d]] in meeting {
            monitor.check()?;
            let joined = |a: u32, b: u32| cycle.next(a) == b || cycle.prev(a) == b;
            if joined(a, b) && joined(c, d) && part(sites, cycle, [a, b], [c, d]) {
                changes += 1;
            }
        }
    }
}

type Edge = [u32; 2];

/// Tests whether a point other than its ends is on an edge.
fn is_inside(p: [f64; 2], [a, b]: [[f64; 2]; 2]) -> bool {
    let (low, high) = if lexicographic(a, b).is_lt() { (a, b) } else { (b, a) };
    lexicographic(low, p).is_lt() && lexicographic(p, high).is_lt() && orient(a, b, p).is_zero()
}

/// Tests whether two edges have a point in common that is not an end of both.
fn meet(sites: &[[f64; 2]], [a, b]: Edge, [c, d]: Edge) -> bool {
    let [p, q, r, s] = [a, b, c, d].map(|v| sites[v as usize]);
    for k in 0..2 {
        if p[k].max(q[k]) < r[k].min(s[k]) || r[k].max(s[k]) < p[k].min(q[k]) {
            return false;
        }
    }
    let [of_r, of_s, of_p, of_q] =
        [orient(p, q, r), orient(p, q, s), orient(r, s, p), orient(r, s, q)];
    let apart = |x: taut_predicates::Sign, y: taut_predicates::Sign| {
        (x.is_positive() && y.is_negative()) || (x.is_negative() && y.is_positive())
    };
    apart(of_r, of_s) && apart(of_p, of_q)
        || is_inside(r, [p, q])
        || is_inside(s, [p, q])
        || is_inside(p, [r, s])
        || is_inside(q, [r, s])
}

/// Makes two edges that meet shorter; false if they do not meet.
fn part(sites: &[[f64; 2]], cycle: &mut Cycle, first: Edge, second: Edge) -> bool {
    if !meet(sites, first, second) {
        return false;
    }
    let at = |v: u32| sites[v as usize];
    let on = |v: u32, edge: Edge| is_inside(at(v), edge.map(at));
    let incidences = [(first, second), (second, first)];
    let found = incidences
        .iter()
        .find_map(|&(edge, other)| other.into_iter().find(|&v| on(v, edge)).map(|v| (v, edge)));
    let Some((site, edge)) = found else {
        let [[a, b], [c, d]] =
            [first, second].map(|[a, b]| if cycle.next(a) == b { [a, b] } else { [b, a] });
        cycle.swap_edges(a, b, c, d);
        return true;
    };
    if !goes_straight(sites, cycle, site) {
        cycle.insert_between(site, edge[0], edge[1]);
        return true;
    }
    let (before, after) = (cycle.prev(site), cycle.next(site));
    if !orient(at(edge[0]), at(edge[1]), at(after)).is_zero() {
        let [a, b] = if cycle.next(edge[0]) == edge[1] { edge } else { [edge[1], edge[0]] };
        cycle.swap_edges(a, b, site, after);
        return true;
    }
    let runs = [run(sites, cycle, edge), run(sites, cycle, [before, site])];
    // An end that both have is no end of what they share.
    let mut ends = runs.iter().zip([1, 0]).flat_map(|(run, other)| {
        let (runs, ends) = (&runs, [run.first(), run.last()]);
        ends.into_iter().flatten().filter_map(move |&v| {
            let edge = runs[other].windows(2).find(|w| on(v, [w[0], w[1]]))?;
            Some((v, [edge[0], edge[1]]))
        })
    });
    if let Some((end, edge)) = ends.next() {
        cycle.insert_between(end, edge[0], edge[1]);
        return true;
    }
    false
}

/// Tests whether the tour passes a site without a turn.
fn goes_straight(sites: &[[f64; 2]], cycle: &Cycle, site: u32) -> bool {
    let at = |v: u32| sites.get(v as usize).copied();
    match (at(cycle.prev(site)), at(site), at(cycle.next(site))) {
        (Some(a), Some(p), Some(b)) => is_inside(p, [a, b]),
        _ => false,
    }
}

/// The longest straight run that an edge is part of.
fn run(sites: &[[f64; 2]], cycle: &Cycle, edge: Edge) -> Vec<u32> {
    let forward = cycle.next(edge[0]) == edge[1];
    let mut run = vec![edge[1]];
    while let Some(&last) = run.last()
        && goes_straight(sites, cycle, last)
    {
        run.push(cycle.ahead(last, forward));
    }
    run.reverse();
    run.push(edge[0]);
    while let Some(&last) = run.last()
        && goes_straight(sites, cycle, last)
    {
        run.push(cycle.ahead(last, !forward));
    }
    run
}

/// The edges of a tour by boxes over its runs.
struct Edges<'a> {
    sites: &'a [[f64; 2]],
    edges: Vec<Edge>,
    /// A heap: the halves of node k are 2k + 1 and 2k + 2; low and high corner.
    boxes: Vec<[[f64; 2]; 2]>,
}

impl<'a> Edges<'a> {
    fn of(sites: &'a [[f64; 2]], order: &[u32]) -> Self {
        let steps = order.iter().zip(order.iter().cycle().skip(1)).map(|(&a, &b)| [a, b]);
        let edges: Vec<Edge> =
            steps.filter(|edge| edge.iter().all(|&v| (v as usize) < sites.len())).collect();
        let mut leaves = 1;
        while edges.len().div_ceil(leaves) > LEAF_SIZE {
            leaves *= 2;
        }
        let mut found = Self { sites, edges, boxes: vec![[[0.0; 2]; 2]; 2 * leaves - 1] };
        found.bound(0, 0, found.edges.len());
        found
    }

    fn is_leaf(&self, node: usize) -> bool {
        2 * node + 1 >= self.boxes.len()
    }

    fn bound(&mut self, node: usize, from: usize, to: usize) {
        let mut own = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        let mut widen = |p: [f64; 2]| {
            for k in 0..2 {
                own[0][k] = own[0][k].min(p[k]);
                own[1][k] = own[1][k].max(p[k]);
            }
        };
        if self.is_leaf(node) {
            let ends = self.edges[from..to].as_flattened();
            ends.iter().for_each(|&v| widen(self.sites[v as usize]));
        } else {
            let middle = from.midpoint(to);
            for (half, from, to) in [(2 * node + 1, from, middle), (2 * node + 2, middle, to)] {
                self.bound(half, from, to);
                self.boxes[half].into_iter().for_each(&mut widen);
            }
        }
        self.boxes[node] = own;
    }

    /// Pairs of edges that meet, in the order of the tour.
    fn meeting(&self, monitor: &Monitor<'_>) -> Result<Vec<[Edge; 2]>, Error> {
        let mut found = Vec::new();
        for i in 0..self.edges.len() {
            if i % 1024 == 0 {
                monitor.check()?;
            }
            let [p, q] = self.edges[i].map(|v| self.sites[v as usize]);
            let own = [[p[0].min(q[0]), p[1].min(q[1])], [p[0].max(q[0]), p[1].max(q[1])]];
            self.meeting_after(i, own, 0, 0, self.edges.len(), &mut found);
        }
        Ok(found)
    }

    /// Those of edge `i` with later edges of a node.
    fn meeting_after(
        &self,
        i: usize,
        own: [[f64; 2]; 2],
        node: usize,
        from: usize,
        to: usize,
        found: &mut Vec<[Edge; 2]>,
    ) {
        let [low, high] = self.boxes[node];
        if to <= i + 1 || (0..2).any(|k| low[k] > own[1][k] || high[k] < own[0][k]) {
            return;
        }
        if self.is_leaf(node) {
            let later = &self.edges[from.max(i + 1)..to];
            let pairs = later.iter().map(|&other| [self.edges[i], other]);
            found.extend(pairs.filter(|&[a, b]| meet(self.sites, a, b)));
        } else {
            let middle = from.midpoint(to);
            self.meeting_after(i, own, 2 * node + 1, from, middle, found);
            self.meeting_after(i, own, 2 * node + 2, middle, to, found);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn length(sites: &[[f64; 2]], cycle: &Cycle) -> f64 {
        Edges::of(sites, cycle.order())
            .edges
            .iter()
            .map(|e| e.map(|v| sites[v as usize]))
            .map(|[p, q]| (p[0] - q[0]).hypot(p[1] - q[1]))
            .sum()
    }

    /// All orders of few sites of a small grid, where most touch themselves or run along themselves, closed and open.
    #[test]
    fn every_order_of_few_sites_becomes_simple_and_no_longer() {
        let sets: [&[[f64; 2]]; 4] = [
            &[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0], [1.0, 1.0], [4.0, 0.0]],
            &[[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [0.0, 2.0], [2.0, 0.0], [1.0, 0.0]],
            &[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.0, 1.0], [1.0, 1.0], [2.0, 1.0]],
            &[
                [0.0, 0.0],
                [1.0, 0.0],
                [2.0, 0.0],
                [3.0, 0.0],
                [4.0, 0.0],
                [5.0, 0.0],
                [6.0, 1e-300],
            ],
        ];
        for sites in sets {
            for open in [false, true] {
                let nodes = sites.len() as u32 + u32::from(open);
                let mut order: Vec<u32> = (0..nodes).collect();
                permutations(&mut order, 1, &mut |order| {
                    let mut cycle = Cycle::new(order.to_vec());
                    let before = length(sites, &cycle);
                    untangle(sites, &mut cycle, &Monitor::silent()).expect("not stopped");
                    assert!(length(sites, &cycle) <= before * (1.0 + 1e-12), "{order:?}");
                    let edges = Edges::of(sites, cycle.order()).edges;
                    for (i, &a) in edges.iter().enumerate() {
                        assert!(edges[..i].iter().all(|&b| !meet(sites, a, b)), "{order:?}");
                    }
                });
            }
        }
    }

    fn permutations(order: &mut [u32], from: usize, see: &mut impl FnMut(&[u32])) {
        if from == order.len() {
            return see(order);
        }
        for k in from..order.len() {
            order.swap(from, k);
            permutations(order, from + 1, see);
            order.swap(from, k);
        }
    }
}
