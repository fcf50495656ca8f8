//! Loose ends followed through the points between them.
//!
//! *Problem.* No window is flat where a curve bends within a few widths of its band, nor where it runs close between two other strands:
//! there are no seeds, and chains end that the points go on from.
//! *Idea.* From an end, windows of half the length that seeds need go on along the curve, each in the frame that the one before predicts, so
//! they need not find out which way the band runs. They see the points that no chain has within its band, and those next to
//! loose ends. Where they arrive at another loose end, against its direction, both are joined by what was found on the way; an end that
//! arrives nowhere stays as it was.
//! *Guarantee.* No chain is cut: at an end that is joined at most [`TRACK_SEEDS_DROPPED`] seeds are left out, and the result turns and scales
//! with the points. At most [`STEPS_MAX`] windows for each end and each number of seeds left out.
//! *Reference.* A principal curve tracked from a start, as by Kégl and Krzyżak 2002 in their thinning of strokes, here between two ends.

use taut_oblivious::hilbert_order;
use taut_points::{Monitor, OrderBy};

use super::link::Chain;
use super::local::{least_squares, reach};
use super::parameters::{
    ALONG_COS_MIN, BAND_DEVIATIONS, STEP_DEVIATIONS, STEP_TURN_COS_MIN, STEPS_MAX,
    TRACK_POINTS_AHEAD_MIN, TRACK_POINTS_MIN, TRACK_SEEDS_DROPPED, TRACK_WINDOW_DEVIATIONS,
};
use super::seeds::Seed;
use super::spline::Spline;
use crate::Error;
use crate::curve::index::Index;

type Point = [f64; 2];

/// A loose end: that of a chain, where it ends when its last seeds are left out.
#[derive(Clone, Copy, Debug)]
struct End {
    chain: usize,
    /// Whether it is where the chain ends, and not where it begins.
    is_last: bool,
    /// How many seeds are left out.
    dropped: usize,
    /// The seed there, its tangent away from the chain.
    seed: Seed,
}

impl End {
    fn of(chains: &[Chain], chain: usize, is_last: bool, dropped: usize) -> Option<Self> {
        let seeds = &chains[chain].seeds;
        // One seed stays at least on either side, whatever the other end leaves out.
        if 2 * dropped + 2 > seeds.len() {
            return None;
        }
        let seed = match is_last {
            true => seeds[seeds.len() - 1 - dropped],
            false => seeds[dropped].reversed(),
        };
        Some(Self { chain, is_last, dropped, seed })
    }

    /// A number for the end of the chain.
    fn number(&self) -> usize {
        2 * self.chain + usize::from(self.is_last)
    }
}

/// A way from one end to another.
struct Join {
    from: End,
    to: End,
    way: Vec<Seed>,
}

/// The chains with the ends joined between which the points go on; none if there are no such ends. The splines are those through the
/// chains, with their points.
pub(super) fn joined(
    chains: &[Chain],
    splines: &[Spline],
    points: &[Point],
    index: &Index<'_>,
    monitor: &Monitor<'_>,
) -> Result<Option<Vec<Chain>>, Error> {
    let loose: Vec<usize> = (0..chains.len()).filter(|&c| !chains[c].closed).collect();
    if loose.is_empty() {
        return Ok(None);
    }
    let is_taken = taken(splines, points.len());
    let ends = |dropped: usize| {
        let loose = &loose;
        loose.iter().flat_map(move |&c| {
            [false, true].into_iter().filter_map(move |last| End::of(chains, c, last, dropped))
        })
    };
    let targets: Vec<End> = (0..=TRACK_SEEDS_DROPPED).flat_map(ends).collect();
    let order = hilbert_order(targets.len(), |i| targets[i].seed.at);
    let places: Vec<Point> = order.iter().map(|&i| targets[i as usize].seed.at).collect();
    let places = Index::new(&places);
    let track =
        Track { points, index, is_taken: &is_taken, targets: &targets, order: &order, places };
    let mut joins: Vec<Join> = Vec::new();
    for &chain in &loose {
        monitor.check()?;
        for is_last in [false, true] {
            let found = (0..=TRACK_SEEDS_DROPPED)
                .filter_map(|dropped| End::of(chains, chain, is_last, dropped))
                .find_map(|from| track.follow(from));
            joins.extend(found);
        }
    }
    joins.order_by_key(|join| join.way.len());
    let mut is_used = vec![false; 2 * chains.len()];
    joins.retain(|join| {
        let ends = [join.from.number(), join.to.number()];
        let is_free = ends.iter().all(|&end| !is_used[end]);
        if is_free {
            ends.iter().for_each(|&end| is_used[end] = true);
        }
        is_free
    });
    Ok((!joins.is_empty()).then(|| connected(chains, &joins)))
}

/// Tells of each point whether it is within the band of a chain and not next to a loose end.
fn taken(splines: &[Spline], count: usize) -> Vec<bool> {
    let mut is_taken = vec![false; count];
    for spline in splines {
        let (first, last) = (&spline.nodes[0], &spline.nodes[spline.nodes.len() - 1]);
        let (from, to) = match spline.closed {
            true => (0.0, f64::INFINITY),
            false => (2.0 * first.reach, spline.length() - 2.0 * last.reach),
        };
        for member in &spline.members {
            is_taken[member.site as usize] =
                member.share <= BAND_DEVIATIONS && member.arc >= from && member.arc <= to;
        }
    }
    is_taken
}

struct Track<'a> {
    points: &'a [Point],
    index: &'a Index<'a>,
    is_taken: &'a [bool],
    /// Where ways may arrive, and these by their places, in this order.
    targets: &'a [End],
    order: &'a [u32],
    places: Index<'a>,
}

impl Track<'_> {
    /// The way from an end to the first other one that it arrives at.
    fn follow(&self, from: End) -> Option<Join> {
        let mut at = from.seed;
        let mut way = Vec::new();
        for _ in 0..STEPS_MAX {
            let step = STEP_DEVIATIONS * at.deviation;
            if let Some(to) = self.arrival(from, &at, 2.0 * step) {
                return Some(Join { from, to, way });
            }
            at = self.next(&at, step)?;
            way.push(at);
        }
        None
    }

    /// The end that lies ahead of a place on the way, within some length: of several, one that leaves out the fewest seeds.
    fn arrival(&self, from: End, at: &Seed, length: f64) -> Option<End> {
        let mut best: Option<u32> = None;
        self.places.within(at.at, 4.0 * length * length, &mut |place| {
            let number = self.order[place as usize];
            let to = &self.targets[number as usize];
            let is_first = best.is_none_or(|best| number < best);
            if is_first && to.number() != from.number() && is_ahead(at, &to.seed, length) {
                best = Some(number);
            }
        });
        best.map(|number| self.targets[number as usize])
    }

    /// The place that follows one, some length on.
    fn next(&self, seed: &Seed, step: f64) -> Option<Seed> {
        let predicted = seed.ahead(step);
        let half = TRACK_WINDOW_DEVIATIONS * seed.deviation;
        let mut local: Vec<Point> = Vec::new();
        self.index.within(predicted.at, half * half, &mut |i| {
            if !self.is_taken[i as usize] {
                let [u, v] = predicted.local(self.points[i as usize]);
                let off = v - predicted.bend * u * u;
                if off.abs() <= BAND_DEVIATIONS * seed.deviation {
                    local.push([u, v]);
                }
            }
        });
        let ahead = local.iter().filter(|p| p[0] > 0.0).count();
        if local.len() < TRACK_POINTS_MIN || ahead < TRACK_POINTS_AHEAD_MIN {
            return None;
        }
        local.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        let ([a, b, c], _) = least_squares(local.iter().copied(), reach(&local))?;
        let norm = b.hypot(1.0);
        let turned = predicted.turned(a, [1.0 / norm, b / norm]);
        let along =
            turned.tangent[0] * predicted.tangent[0] + turned.tangent[1] * predicted.tangent[1];
        let bend = (c / norm.powi(3)).clamp(-1.0 / half, 1.0 / half);
        let density = local.len() as f64 / half;
        (along >= STEP_TURN_COS_MIN).then_some(Seed { bend, reach: half, density, ..turned })
    }
}

/// Tells whether an end lies ahead of a place, within a length, and comes the other way on the same strand.
fn is_ahead(seed: &Seed, end: &Seed, length: f64) -> bool {
    let [u, v] = seed.local(end.at);
    let off = v - seed.bend * u * u;
    let [x, y] = seed.direction_beside(end.at);
    let against = x * end.tangent[0] + y * end.tangent[1];
    u > 0.0 && u <= length && off.abs() <= seed.deviation && against <= -ALONG_COS_MIN
}

/// The chains with joins made.
fn connected(chains: &[Chain], joins: &[Join]) -> Vec<Chain> {
    // For each end the join, and whether it is where that begins.
    let mut join_at: Vec<Option<(usize, bool)>> = vec![None; 2 * chains.len()];
    for (k, join) in joins.iter().enumerate() {
        join_at[join.from.number()] = Some((k, true));
        join_at[join.to.number()] = Some((k, false));
    }
    let dropped = |end: usize| match join_at[end] {
        Some((k, true)) => joins[k].from.dropped,
        Some((k, false)) => joins[k].to.dropped,
        None => 0,
    };
    let mut is_done = vec![false; chains.len()];
    let mut all = Vec::new();
    for start in 0..chains.len() {
        if is_done[start] {
            continue;
        }
        if chains[start].closed {
            is_done[start] = true;
            all.push(chains[start].clone());
            continue;
        }
        // The other end of what is joined at an end.
        let across = |end: usize| {
            join_at[end].map(|(k, is_from)| match is_from {
                true => joins[k].to.number(),
                false => joins[k].from.number(),
            })
        };
        // Back to a loose end, or once around.
        let (mut entry, mut closed) = (2 * start, false);
        while let Some(end) = across(entry) {
            entry = end ^ 1;
            if entry == 2 * start {
                closed = true;
                break;
            }
        }
        let first = entry;
        let mut seeds: Vec<Seed> = Vec::new();
        loop {
            let chain = &chains[entry / 2].seeds;
            is_done[entry / 2] = true;
            let forward = entry % 2 == 0;
            let kept = &chain[dropped(entry & !1)..chain.len() - dropped(entry | 1)];
            match forward {
                true => seeds.extend(kept),
                false => seeds.extend(kept.iter().rev().map(Seed::reversed)),
            }
            let exit = entry ^ 1;
            let Some((k, is_from)) = join_at[exit] else { break };
            match is_from {
                true => seeds.extend(&joins[k].way),
                false => seeds.extend(joins[k].way.iter().rev().map(Seed::reversed)),
            }
            let Some(next) = across(exit) else { break };
            if next == first {
                break;
            }
            entry = next;
        }
        all.push(Chain { seeds, closed }.counterclockwise());
    }
    all
}
