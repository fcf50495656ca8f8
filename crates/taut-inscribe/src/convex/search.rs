//! Local search for a large convex polygon: carve, turn each side, ruin and recreate.
//!
//! *Idea.* From each start the nearest edges carve a first body ([`carve`](super::carve)). Then each side in turn gives way to the
//! best one in its place ([`pivot`](super::pivot)), until none gains. In rounds, one to three neighbors of the best body's sides are
//! taken out, the room that opens is carved again from a random point of the body, and what is larger is kept.
//! *Guarantee.* No edge reaches deeper into a body than [`DEPTH`]; the rest is evidence, as the bound is proved apart.

use taut_points::{Cancelled, Monitor, OrderBy};

use crate::ellipse::local_optima;
use crate::polygon::Segment;
use crate::random::Random;
use crate::runs::{Bounds, Runs, bounds, overlap};
use crate::units::Units;

use super::carve::{Metric, carve};
use super::pivot::{best_side, hull};
use super::region::{Moments, Region, Side};

/// How far edges may reach into a body, in units of the bounding box.
const DEPTH: f64 = 1e-12;

/// Least gain in area for a change to count, relatively.
const GAIN_MIN: f64 = 1e-9;

/// Sides of the bounding box, which come first and stay.
const BOX_SIDES: usize = 4;

/// Times that all sides are turned, at most.
const SWEEPS_MAX: usize = 60;

/// Times that a first body is carved again in the metric of the one before.
const CARVINGS: usize = 3;

/// How far beyond a side that was taken out edges are looked for first, in units of the bounding box, and the factor of the next.
const FIRST_BEYOND: f64 = 1.0 / 64.0;
const BEYOND_GROWTH: f64 = 4.0;

/// A distance that no two points of the bounding box have, in its units.
const BEYOND_MAX: f64 = 4.0;

/// Times that points are added for one side before all are taken.
const ADDITIONS_MAX: usize = 16;

/// Bodies that rounds of ruin and recreation start from.
const KEPT_MAX: usize = 3;

/// Sides that are taken out at once, at most.
const RUINED_MAX: usize = 3;

/// A body and the sides that make it, those of the bounding box first.
#[derive(Clone)]
pub(super) struct Body {
    pub(super) region: Region,
    sides: Vec<Side>,
    pub(super) area: f64,
}

struct Search<'a> {
    edges: &'a [Segment],
    runs: Runs,
    whole: Region,
    box_sides: [Side; BOX_SIDES],
}

/// The largest body found, if any.
pub(super) fn search(
    units: &Units,
    starts: usize,
    rounds: u64,
    seed: u64,
    monitor: &Monitor<'_>,
) -> Result<Option<Body>, Cancelled> {
    let [width, height] = units.extent;
    let side = |normal, offset| Side { normal, offset };
    let search = Search {
        edges: &units.edges,
        runs: Runs::of(&units.edges),
        whole: Region::rectangle([0.0; 2], units.extent),
        box_sides: [
            side([1.0, 0.0], width),
            side([0.0, 1.0], height),
            side([-1.0, 0.0], 0.0),
            side([0.0, -1.0], 0.0),
        ],
    };
    let mut bodies: Vec<Body> = vec![];
    for (center, form) in local_optima(units, starts) {
        monitor.check()?;
        bodies.extend(search.first(center, Metric(form)));
    }
    bodies.order_by(&|one, other| other.area.total_cmp(&one.area));
    bodies.dedup_by(|next, kept| (kept.area - next.area).abs() <= GAIN_MIN * kept.area);
    bodies.truncate(KEPT_MAX);
    let mut random = Random::new(seed);
    for body in &mut bodies {
        for _ in 0..rounds {
            monitor.check()?;
            if let Some(next) = search.recreated(body, &mut random) {
                *body = next;
            }
        }
    }
    bodies.order_by(&|one, other| other.area.total_cmp(&one.area));
    Ok(bodies.into_iter().next())
}

impl Search<'_> {
    /// The body around a center, carved again in its own metric and turned.
    fn first(&self, mut center: [f64; 2], mut metric: Metric) -> Option<Body> {
        let mut best: Option<Body> = None;
        for _ in 0..CARVINGS {
            let carved = self.carved(self.box_sides.to_vec(), center, metric);
            let Some(body) = carved.map(|body| self.turned(body)) else { break };
            let Some(moments) = body.region.moments() else { break };
            (center, metric) = (moments.centroid, Metric::of_moments(moments.second));
            match &best {
                Some(before) if body.area <= before.area * (1.0 + GAIN_MIN) => break,
                _ => best = Some(body),
            }
        }
        best
    }

    fn carved(&self, sides: Vec<Side>, center: [f64; 2], metric: Metric) -> Option<Body> {
        let room = self.whole.within(&sides[BOX_SIDES..]);
        let near = self.near(&sides, &room).into_iter();
        let (region, sides) = carve(&room, sides, center, metric, near, DEPTH)?;
        let area = region.area();
        (area > 0.0).then_some(Body { region, sides, area })
    }

    /// Puts the best side in the place of each, until none gains.
    fn turned(&self, mut body: Body) -> Body {
        for _ in 0..SWEEPS_MAX {
            let before = body.area;
            let mut at = BOX_SIDES;
            while at < body.sides.len() {
                let Some(Moments { centroid, .. }) = body.region.moments() else { return body };
                let turned = body.sides.remove(at);
                let room = self.whole.within(&body.sides[BOX_SIDES..]);
                let points = self.first_points(&body.sides, &turned, &room);
                if points.is_empty() {
                    // The others alone keep all edges out.
                    body.area = room.area();
                    body.region = room;
                    continue;
                }
                let least = body.area * (1.0 + GAIN_MIN);
                let better = self.better_side(&body.sides, &room, points, centroid, least);
                let side = better.unwrap_or(turned);
                body.sides.insert(at, side);
                body.region = room.clipped(&side);
                body.area = body.region.area();
                at += 1;
            }
            if body.area <= before * (1.0 + GAIN_MIN) {
                break;
            }
        }
        body
    }

    /// The ends of the parts of edges that reach into a room and are nearest beyond a side that was taken out; none if no edge does.
    fn first_points(&self, sides: &[Side], taken: &Side, room: &Region) -> Vec<[f64; 2]> {
        let mut beyond = FIRST_BEYOND;
        while beyond < BEYOND_MAX {
            let mut sides = sides.to_vec();
            sides.push(Side { normal: taken.normal, offset: taken.offset + beyond });
            let points = self.reaching(&sides, &room.clipped(&sides[sides.len() - 1]));
            if !points.is_empty() {
                return points;
            }
            beyond *= BEYOND_GROWTH;
        }
        self.reaching(sides, room)
    }

    /// The side that leaves most of a room without an edge in it, if that is more than `least`.
    ///
    /// The best side for some points leaves at least as much as that for all; points that it lets in are added.
    fn better_side(
        &self,
        sides: &[Side],
        room: &Region,
        mut points: Vec<[f64; 2]>,
        inside: [f64; 2],
        least: f64,
    ) -> Option<Side> {
        for _ in 0..ADDITIONS_MAX {
            let (area, side) = best_side(room, &mut points, inside)?;
            if area <= least {
                return None;
            }
            let mut all = sides.to_vec();
            all.push(side);
            let entering = self.reaching(&all, &room.clipped(&side));
            if entering.is_empty() {
                return Some(side);
            }
            points = hull(&mut points);
            points.extend(entering);
        }
        let (area, side) = best_side(room, &mut self.reaching(sides, room), inside)?;
        (area > least).then_some(side)
    }

    /// The ends of the parts of edges that reach into a room.
    fn reaching(&self, sides: &[Side], room: &Region) -> Vec<[f64; 2]> {
        let near = self.near(sides, room).into_iter();
        near.filter_map(|edge| Region::inner_part(sides.iter().copied(), edge, DEPTH))
            .flatten()
            .collect()
    }

    /// The edges whose boxes meet that of a room, without runs that one of its sides keeps out.
    fn near(&self, sides: &[Side], room: &Region) -> Vec<Segment> {
        let around = room.bounds();
        let is_kept_out = |side: &Side, bounds: &Bounds| side.least_excess(bounds) + DEPTH >= 0.0;
        let is_wanted = |bounds: &Bounds| {
            overlap(bounds, &around) && !sides.iter().any(|side| is_kept_out(side, bounds))
        };
        let mut found = vec![];
        self.runs.visit(&is_wanted, &mut |edges| {
            let near = self.edges[edges].iter().filter(|&&edge| overlap(&bounds(edge), &around));
            found.extend(near);
            true
        });
        found
    }

    /// A larger body, if taking out some neighboring sides and carving the room again leads to one.
    fn recreated(&self, body: &Body, random: &mut Random) -> Option<Body> {
        let own = body.sides.len() - BOX_SIDES;
        if own == 0 {
            return None;
        }
        let moments = body.region.moments()?;
        let mut sides = body.sides.clone();
        let angle = |side: &Side| side.normal[1].atan2(side.normal[0]);
        sides[BOX_SIDES..].order_by(&|one, other| angle(one).total_cmp(&angle(other)));
        sides[BOX_SIDES..].rotate_left(random.below(own));
        sides.truncate(BOX_SIDES + own - (1 + random.below(RUINED_MAX)).min(own));
        let corner = body.region.corners[random.below(body.region.corners.len())];
        let share = random.unit();
        let center =
            [0, 1].map(|k| moments.centroid[k] + share * (corner[k] - moments.centroid[k]));
        let room = self.whole.within(&sides[BOX_SIDES..]);
        let second = match random.below(2) {
            0 => moments.second,
            _ => room.moments()?.second,
        };
        let next = self.turned(self.carved(sides, center, Metric::of_moments(second))?);
        (next.area > body.area * (1.0 + GAIN_MIN)).then_some(next)
    }
}
