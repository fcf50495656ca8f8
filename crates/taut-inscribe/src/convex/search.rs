//! Local search for a large convex polygon: carve, turn each side, ruin and recreate.
//!
//! *Idea.* From each start the nearest edges carve a first body ([`carve`](super::carve)). Then each side in turn gives way to the
//! best one in its place ([`pivot`](super::pivot)), until none gains. In rounds, one to three neighbors of the best body's sides are
//! taken out, the room that opens is carved again from a random point of the body, and what is larger is kept.
//! *Guarantee.* No edge reaches deeper into a body than [`DEPTH`]; the rest is evidence, as the bound is proved apart.

use taut_points::{Cancelled, Monitor};

use crate::ellipse::local_optima;
use crate::groups::{Extent, Groups};
use crate::polygon::Segment;
use crate::random::Random;
use crate::units::Units;

use super::carve::{Metric, carve};
use super::pivot::best_side;
use super::region::{Moments, Region, Side};

/// How far edges may reach into a body, in units of the bounding box.
const DEPTH: f64 = 1e-12;

/// Bound of the rounding errors of distances to sides, coordinates being below 4 in size.
const EXCESS_ERROR: f64 = 64.0 * f64::EPSILON;

/// Least gain in area for a change to count, relatively.
const GAIN_MIN: f64 = 1e-9;

/// Sides of the bounding box, which come first and stay.
const BOX_SIDES: usize = 4;

/// Times that all sides are turned, at most.
const SWEEPS_MAX: usize = 60;

/// How much all later sweeps are supposed to gain, in gains of the last one: where that does not make a body the best, it is given up.
/// Measured on outlines of countries and on random polygons: no area is smaller than without.
const LATER_GAIN_MAX: f64 = 2.0;

/// Times that a first body is carved again in the metric of the one before.
const CARVINGS: usize = 3;

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

struct Search {
    edges: Groups,
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
        edges: Groups::of(&units.edges),
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
    bodies.sort_by(|one, other| other.area.total_cmp(&one.area));
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
    bodies.sort_by(|one, other| other.area.total_cmp(&one.area));
    Ok(bodies.into_iter().next())
}

impl Search {
    /// The body around a center, carved again in its own metric and turned.
    fn first(&self, mut center: [f64; 2], mut metric: Metric) -> Option<Body> {
        let mut best: Option<Body> = None;
        for _ in 0..CARVINGS {
            let carved = self.carved(self.box_sides.to_vec(), center, metric);
            let Some(body) = carved.map(|body| self.turned(body, 0.0)) else { break };
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
        let near = self.near(&sides, &room);
        let (region, sides) = carve(&room, sides, center, metric, near.into_iter(), DEPTH)?;
        let area = region.area();
        (area > 0.0).then_some(Body { region, sides, area })
    }

    /// Puts the best side in the place of each, until none gains, or the area wanted is out of reach.
    fn turned(&self, mut body: Body, wanted: f64) -> Body {
        // Sides that follow each other and stay: when all do, another sweep would find the same.
        let mut unchanged = 0;
        for _ in 0..SWEEPS_MAX {
            let before = body.area;
            let mut at = BOX_SIDES;
            while at < body.sides.len() {
                if unchanged == body.sides.len() - BOX_SIDES {
                    return body;
                }
                let Some(Moments { centroid, .. }) = body.region.moments() else { return body };
                let turned = body.sides.remove(at);
                let room = self.whole.within(&body.sides[BOX_SIDES..]);
                let reaching = self.reaching(&body.sides, &room);
                if reaching.is_empty() {
                    // The others alone keep all edges out.
                    body.area = room.area();
                    body.region = room;
                    unchanged = 0;
                    continue;
                }
                let side = match best_side(&room, &reaching, centroid) {
                    Some((area, side)) if area > body.area * (1.0 + GAIN_MIN) => {
                        unchanged = 0;
                        side
                    }
                    _ => {
                        unchanged += 1;
                        turned
                    }
                };
                body.sides.insert(at, side);
                body.region = room.clipped(&side);
                body.area = body.region.area();
                at += 1;
            }
            let gain = body.area - before;
            if gain <= GAIN_MIN * before || body.area + LATER_GAIN_MAX * gain < wanted {
                break;
            }
        }
        body
    }

    /// The ends of the parts of edges that reach into a room.
    fn reaching(&self, sides: &[Side], room: &Region) -> Vec<[f64; 2]> {
        let mut found: Vec<[f64; 2]> = vec![];
        for edge in self.near(sides, room) {
            if let Some([from, to]) = Region::inner_part(sides.iter().copied(), edge, DEPTH) {
                // Edges of a ring follow each other.
                if found.last() != Some(&from) {
                    found.push(from);
                }
                found.push(to);
            }
        }
        found
    }

    /// The edges that may reach into a room: those of groups whose boxes meet its bounding box and are behind none of its sides.
    fn near(&self, sides: &[Side], room: &Region) -> Vec<Segment> {
        let [low, high] = room.bounds();
        let is_behind = |side: &Side, &Extent { center, half }: &Extent| {
            let reach = side.normal[0].abs() * half[0] + side.normal[1].abs() * half[1];
            side.excess(center) - reach + DEPTH >= EXCESS_ERROR
        };
        let may_reach = |extent: &Extent| {
            let Extent { center, half } = *extent;
            let is_apart = |k: usize| {
                center[k] + half[k] < low[k] - EXCESS_ERROR
                    || center[k] - half[k] > high[k] + EXCESS_ERROR
            };
            !is_apart(0) && !is_apart(1) && !sides.iter().any(|side| is_behind(side, extent))
        };
        let mut found = self.edges.among(may_reach);
        found.retain(|edge| is_near(edge, low, high));
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
        sides[BOX_SIDES..].sort_by(|one, other| angle(one).total_cmp(&angle(other)));
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
        let next = self.turned(self.carved(sides, center, Metric::of_moments(second))?, body.area);
        (next.area > body.area * (1.0 + GAIN_MIN)).then_some(next)
    }
}

/// Whether the bounding box of an edge meets a rectangle.
fn is_near(edge: &Segment, low: [f64; 2], high: [f64; 2]) -> bool {
    (0..2).all(|k| edge[0][k].max(edge[1][k]) >= low[k] && edge[0][k].min(edge[1][k]) <= high[k])
}
