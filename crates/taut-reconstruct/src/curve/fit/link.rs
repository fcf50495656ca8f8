//! Seeds joined to chains, each seed to the next one on either side of it.
//!
//! *Idea.* A seed knows its tangent, so it knows what is ahead and what is behind. It asks for the nearest seed on each side that
//! lies along its own tangent and whose tangent lies along the way there; where both ask for each other they are joined. Sides left
//! over are joined by ascending distance where they face each other.
//! *Guarantee.* No seed gets more than one neighbor on a side, so the result is chains and loops; it turns and scales with the seeds.

use taut_oblivious::hilbert_order;
use taut_points::OrderBy;

use super::parameters::{
    ACROSS_FACTOR, ALONG_COS_MIN, APART_FACTOR, APART_FACTOR_MAX, CHAIN_SEEDS_MIN,
    END_DISTANCE_MAX, SEED_DISTANCE_MAX,
};
use super::seeds::Seed;
use crate::curve::Ends;
use crate::curve::index::Index;

type Point = [f64; 2];

/// Seeds in the order of a curve, tangents along it.
#[derive(Clone, Debug)]
pub(super) struct Chain {
    /// The seeds.
    pub(super) seeds: Vec<Seed>,
    /// Whether the first follows the last.
    pub(super) closed: bool,
}

impl Chain {
    /// The chain, a closed one counterclockwise.
    pub(super) fn counterclockwise(mut self) -> Self {
        if self.closed && area(&self.seeds) < 0.0 {
            self.reverse();
        }
        self
    }

    /// The other way around; a closed one from the same seed on.
    fn reverse(&mut self) {
        self.seeds.reverse();
        if self.closed {
            self.seeds.rotate_right(1);
        }
        self.seeds.iter_mut().for_each(|seed| *seed = seed.reversed());
    }
}

/// Twice the area that seeds go around, counted from the first; below 0 where they go around clockwise.
fn area(seeds: &[Seed]) -> f64 {
    let from = |seed: &Seed| [seed.at[0] - seeds[0].at[0], seed.at[1] - seeds[0].at[1]];
    let cross = |pair: &[Seed]| {
        let (p, q) = (from(&pair[0]), from(&pair[1]));
        p[0] * q[1] - p[1] * q[0]
    };
    seeds.windows(2).map(cross).sum()
}

/// A side of a seed: 2·seed, plus 1 for the side its tangent points to.
type Side = usize;

struct Sides<'a> {
    seeds: &'a [Seed],
    /// For each side the side it is joined to.
    partner: Vec<Option<Side>>,
}

impl Sides<'_> {
    /// How well a seed lies on this side of another: the cosine of the angle between the tangent and the way there.
    fn along(&self, side: Side, to: usize) -> f64 {
        let seed = &self.seeds[side / 2];
        let (dx, dy) = (self.seeds[to].at[0] - seed.at[0], self.seeds[to].at[1] - seed.at[1]);
        let sign = if side % 2 == 1 { 1.0 } else { -1.0 };
        sign * (dx * seed.tangent[0] + dy * seed.tangent[1]) / dx.hypot(dy)
    }

    /// How far it is from one seed to another, the way across the tangents counted more often.
    ///
    /// On one arc of a circle both tangents are off the way between by the same angle to opposite sides (Parent and Zucker 1989). What is
    /// left of both ways across when they are added is how far the strands of the seeds are apart, which counts by how long windows are
    /// beside the noise.
    fn way(&self, i: usize, j: usize) -> f64 {
        let (a, b) = (&self.seeds[i], &self.seeds[j]);
        let (dx, dy) = (b.at[0] - a.at[0], b.at[1] - a.at[1]);
        let across = |t: Point| dx * t[1] - dy * t[0];
        let along = |t: Point| dx * t[0] + dy * t[1];
        let sign = if along(a.tangent) * along(b.tangent) < 0.0 { -1.0 } else { 1.0 };
        let (from, to) = (across(a.tangent), sign * across(b.tangent));
        let (apart, bent) = (0.5 * (from + to), 0.5 * (from - to));
        let flatness = |s: &Seed| s.reach / s.deviation.max(f64::MIN_POSITIVE);
        let factor =
            (APART_FACTOR * flatness(a).min(flatness(b))).clamp(ACROSS_FACTOR, APART_FACTOR_MAX);
        let square = |factor: f64, length: f64| (factor * factor - 1.0) * length * length;
        (dx * dx + dy * dy + square(factor, apart) + square(ACROSS_FACTOR, bent)).sqrt()
    }

    /// The side of `to` that faces a seed.
    fn facing(&self, from: usize, to: usize) -> Side {
        2 * to + usize::from(self.along(2 * to + 1, from) > 0.0)
    }

    fn join(&mut self, a: Side, b: Side) {
        (self.partner[a], self.partner[b]) = (Some(b), Some(a));
    }
}

/// The chains of seeds, the one with the earliest seed first.
pub(super) fn chains(found: &[Seed], ends: Ends) -> Vec<Chain> {
    let order = hilbert_order(found.len(), |i| found[i].at);
    let seeds: Vec<Seed> = order.iter().map(|&i| found[i as usize]).collect();
    let places: Vec<Point> = seeds.iter().map(|seed| seed.at).collect();
    let index = Index::new(&places);
    let mut sides = Sides { seeds: &seeds, partner: vec![None; 2 * seeds.len()] };
    let wanted: Vec<Option<Side>> =
        (0..2 * seeds.len()).map(|side| next(&sides, &index, side)).collect();
    for side in 0..wanted.len() {
        if let Some(other) = wanted[side].filter(|&other| wanted[other] == Some(side)) {
            sides.join(side, other);
        }
    }
    if ends == Ends::Auto {
        join_ends(&mut sides, &index);
    }
    // Where a chain begins is told by the order in which seeds were found, which turns with the points; places do not.
    let mut rank = vec![0; seeds.len()];
    for (place, &i) in order.iter().enumerate() {
        rank[place] = i;
    }
    trace(&sides, &rank)
}

/// The side of the nearest seed on this side that lies along both tangents.
fn next(sides: &Sides<'_>, index: &Index<'_>, side: Side) -> Option<Side> {
    let i = side / 2;
    let seed = &sides.seeds[i];
    let reach = SEED_DISTANCE_MAX * seed.reach;
    let mut best: Option<(f64, Side)> = None;
    index.within(seed.at, reach * reach, &mut |j| {
        let j = j as usize;
        if j == i || sides.along(side, j) < ALONG_COS_MIN {
            return;
        }
        let other = sides.facing(i, j);
        if sides.along(other, i) < ALONG_COS_MIN {
            return;
        }
        let apart = sides.way(i, j);
        if best.is_none_or(|(least, _)| apart < least) {
            best = Some((apart, other));
        }
    });
    best.map(|(_, other)| other)
}

fn distance(sides: &Sides<'_>, i: usize, j: usize) -> f64 {
    let (a, b) = (sides.seeds[i].at, sides.seeds[j].at);
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Joins free sides that face each other, the nearest first.
fn join_ends(sides: &mut Sides<'_>, index: &Index<'_>) {
    let mut pairs: Vec<(f64, Side, Side)> = Vec::new();
    for side in (0..sides.partner.len()).filter(|&side| sides.partner[side].is_none()) {
        let seed = &sides.seeds[side / 2];
        let reach = END_DISTANCE_MAX * seed.reach;
        index.within(seed.at, reach * reach, &mut |j| {
            for other in [2 * j as usize, 2 * j as usize + 1] {
                let facing = j as usize != side / 2
                    && sides.partner[other].is_none()
                    && sides.along(side, j as usize) > 0.0
                    && sides.along(other, side / 2) > 0.0;
                if facing {
                    pairs.push((
                        distance(sides, side / 2, j as usize),
                        side.min(other),
                        side.max(other),
                    ));
                }
            }
        });
    }
    pairs.order_by(&|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    for (_, a, b) in pairs {
        if sides.partner[a].is_none() && sides.partner[b].is_none() {
            sides.join(a, b);
        }
    }
}

/// Follows partners from side to side. Closed chains run counterclockwise, open ones from the end that was found first: what comes after
/// goes along them, and would not turn with the points otherwise.
fn trace(sides: &Sides<'_>, rank: &[u32]) -> Vec<Chain> {
    let mut starts: Vec<usize> = (0..sides.seeds.len()).collect();
    starts.order_by_key(|&i| rank[i]);
    let mut seen = vec![false; sides.seeds.len()];
    let mut chains = Vec::new();
    for &start in &starts {
        if seen[start] {
            continue;
        }
        // Back to an end, or once around.
        let mut entry = 2 * start;
        let mut closed = false;
        while let Some(partner) = sides.partner[entry] {
            entry = partner ^ 1;
            if entry / 2 == start {
                (closed, entry) = (true, 2 * start);
                break;
            }
        }
        let (first, mut seeds) = (entry / 2, Vec::new());
        loop {
            let seed = sides.seeds[entry / 2];
            seen[entry / 2] = true;
            seeds.push(if entry % 2 == 0 { seed } else { seed.reversed() });
            match sides.partner[entry ^ 1] {
                Some(next) if next / 2 != start || !closed => entry = next,
                _ => break,
            }
        }
        if seeds.len() >= CHAIN_SEEDS_MIN {
            let mut chain = Chain { seeds, closed };
            let last = entry / 2;
            let is_backward = match closed {
                true => area(&chain.seeds) < 0.0,
                false => rank[last] < rank[first],
            };
            if is_backward {
                chain.reverse();
            }
            chains.push(chain);
        }
    }
    chains
}
