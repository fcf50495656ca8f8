//! Nogoods: sets of points of the plane that so many balls do not hold, each shown by those before it.
//!
//! *Problem.* No e balls of radii less than ρ hold a set N. It is enough to look at balls of one radius below ρ, as any can be enlarged to it.
//! *Items apart.* If no ball holds two of e + 1 items, e balls do not hold them all.
//! *Branches.* Of e balls that hold N, one holds the item p. If each ball with p holds nothing of some Nⱼ ⊂ N, then the e − 1 others hold that Nⱼ; so
//! it is enough that e − 1 balls hold none of N₁, N₂, ….
//! *Question.* Is there no center within ρ of p and within ρ of some item of each Nⱼ? The balls about p and about one item of each Nⱼ have
//! a common point, if there is such a center; and then a corner of what they have in common, where two of their circles meet,
//! is one, too. So it is enough to go around each circle: another item allows the angles within arccos(D/2ρ) of its direction,
//! and a corner is the first angle of one of these arcs.
//! *Rounding.* A direction is off by less than 1e-15, an arccos by less than 3e-8, and that only near 1. Arcs are longer by [`MARGIN`] at
//! each end: where some have a common angle, the last of their first ends, as rounded, lies in all of them.
//! *Cost.* Arcs are sorted once for each circle. A nogood takes a walk along those circles near p that items of the Nⱼ have.

use std::f64::consts::PI;

use taut_points::Cancelled;

use super::super::{CentersViolation, Nogood, Placement};
use super::core::{Bits, Core, Pairs, items, set};
use super::distance::difference;
use super::meter::Meter;
use crate::CheckError;
use crate::centers::CentersCertificate;

/// In radians, by how much arcs are longer: three times what rounding can take.
const MARGIN: f64 = 1e-7;
/// Relative excess of a distance over 2ρ that may be rounding.
const DISTANCE_TOLERANCE: f64 = 1e-12;
/// Most items: their arcs take at most 128 MiB.
const ITEMS_MAX: usize = 1 << 11;
/// Most bits of all sets: 128 MiB.
const BITS_MAX: usize = 1 << 30;
/// Most nogoods by which one is shown: a bit each, and one for the item.
const MISSES_MAX: usize = 127;
/// The bit of the item that is branched on.
const OF_ITEM: u128 = 1 << MISSES_MAX;

/// Shows each nogood; the last one proves the bound.
pub(super) fn check(
    core: &Core,
    certificate: &CentersCertificate,
    nogoods: &[Nogood],
    meter: &mut Meter<'_>,
) -> Result<(), CheckError> {
    let refused = |problem| Err(CentersViolation::NogoodsApply { problem }.into());
    if !core.is_plain_plane() || certificate.placement != Placement::Free {
        return refused("it is not about points of the plane with free centers");
    }
    if certificate.outliers > 0 {
        return refused("it allows outliers");
    }
    if core.len() > ITEMS_MAX || core.len().saturating_mul(nogoods.len()) > BITS_MAX {
        return refused("it is too large");
    }
    let pairs = Pairs::of(core, meter)?;
    let circles = Circles::of(core, meter)?;
    let mut shown: Vec<ProvedNogood> = vec![];
    for (number, nogood) in nogoods.iter().enumerate() {
        meter.spend(64)?;
        let problem = match show(core, &pairs, &circles, &shown, nogood, meter)? {
            Ok(next) => {
                shown.push(next);
                continue;
            }
            Err(problem) => problem,
        };
        return Err(CentersViolation::Nogood { number, problem }.into());
    }
    match shown.last() {
        Some(last) if last.balls as u64 >= certificate.k => Ok(()),
        _ => refused("the last of them is about fewer balls"),
    }
}

/// A set that so many balls do not hold.
struct ProvedNogood {
    items: Bits,
    balls: usize,
}

/// Shows a nogood by those before it, or says why not.
fn show(
    core: &Core,
    pairs: &Pairs,
    circles: &Circles,
    shown: &[ProvedNogood],
    nogood: &Nogood,
    meter: &mut Meter<'_>,
) -> Result<Result<ProvedNogood, &'static str>, Cancelled> {
    let mut all = vec![0; core.len().div_ceil(64)];
    for &item in &nogood.items {
        if item as usize >= core.len() {
            return Ok(Err("has an item that is not in the core-set"));
        }
        set(&mut all, item as usize);
    }
    if nogood.misses.is_empty() {
        let Some(balls) = nogood.items.len().checked_sub(1) else {
            return Ok(Err("is empty"));
        };
        meter.spend(balls * balls)?;
        let are_apart = |(at, &a): (usize, &u32)| {
            nogood.items[..at].iter().all(|&b| pairs.are_apart(a as usize, b as usize))
        };
        return Ok(match nogood.items.iter().enumerate().all(are_apart) {
            true => Ok(ProvedNogood { items: all, balls }),
            false => Err("has two items that are not apart"),
        });
    }
    let &[item] = &nogood.items[..] else {
        return Ok(Err("branches on more than one item"));
    };
    if nogood.misses.len() > MISSES_MAX {
        return Ok(Err("is shown by too many others"));
    }
    let mut masks = vec![0; core.len()];
    let mut balls = usize::MAX;
    for (bit, &other) in nogood.misses.iter().enumerate() {
        let Some(other) = shown.get(other as usize) else {
            return Ok(Err("is shown by one that does not come before it"));
        };
        balls = balls.min(other.balls);
        items(&other.items).for_each(|item| masks[item] |= 1 << bit);
        all.iter_mut().zip(&other.items).for_each(|(all, more)| *all |= more);
    }
    masks[item as usize] |= OF_ITEM;
    let wanted = OF_ITEM | ((1 << nogood.misses.len()) - 1);
    Ok(match circles.is_some_ball_wanted(item as usize, &masks, wanted, meter)? {
        true => Err("is not shown: some ball holds its item and some of each other one"),
        false => Ok(ProvedNogood { items: all, balls: balls + 1 }),
    })
}

/// For each item the circle of radius ρ about it.
struct Circles(Vec<Circle>);

/// What balls with their center on the circle about an item hold.
struct Circle {
    /// The item, and others at its place.
    here: Vec<u32>,
    /// Other items whose circles meet this one.
    near: Vec<u32>,
    /// Near items that the ball at the angle −π holds, or that one beside it.
    at_start: Vec<u32>,
    /// Ends of arcs by growing angle; of equals, those first at which an arc begins.
    ends: Vec<End>,
}

/// At this angle the ball begins to hold the item, or ends to.
struct End {
    angle: f64,
    begins: bool,
    item: u32,
}

impl Circles {
    fn of(core: &Core, meter: &mut Meter<'_>) -> Result<Self, Cancelled> {
        let circle = |about| {
            meter.spend(20 * core.len())?;
            Ok(Circle::about(core, about))
        };
        Ok(Circles((0..core.len()).map(circle).collect::<Result<_, Cancelled>>()?))
    }

    /// Returns true if some ball holds the item, and with it items whose masks have all wanted bits; or if that cannot be told from rounding.
    fn is_some_ball_wanted(
        &self,
        item: usize,
        masks: &[u128],
        wanted: u128,
        meter: &mut Meter<'_>,
    ) -> Result<bool, Cancelled> {
        let Circle { here, near, .. } = &self.0[item];
        for &about in here.iter().chain(near).filter(|&&about| masks[about as usize] != 0) {
            let circle = &self.0[about as usize];
            meter.spend(2 * circle.near.len() + 16)?;
            if circle.mask_of_all(masks) == wanted && circle.is_some_angle_wanted(masks, wanted) {
                return Ok(true);
            }
        }
        Ok(false)
    }
}

impl Circle {
    fn about(core: &Core, about: usize) -> Self {
        let mut circle = Circle { here: vec![], near: vec![], at_start: vec![], ends: vec![] };
        for item in 0..core.len() {
            let [dx, dy] = [0, 1].map(|axis| {
                difference(core.place(item)[axis], core.place(about)[axis], core.scale)
            });
            let distance = dx.hypot(dy);
            let cosine = distance / (2.0 * core.reach(about));
            if distance == 0.0 {
                circle.here.push(item as u32);
            } else if cosine <= 1.0 + DISTANCE_TOLERANCE {
                let (direction, half) = (dy.atan2(dx), cosine.min(1.0).acos() + MARGIN);
                let [first, last] = [direction - half, direction + half].map(turned);
                let item = item as u32;
                circle.near.push(item);
                if first > last {
                    circle.at_start.push(item);
                }
                circle.ends.push(End { angle: first, begins: true, item });
                circle.ends.push(End { angle: last, begins: false, item });
            }
        }
        circle.ends.sort_by(|a, b| a.angle.total_cmp(&b.angle).then(b.begins.cmp(&a.begins)));
        circle
    }

    fn mask_of_all(&self, masks: &[u128]) -> u128 {
        let all = self.here.iter().chain(&self.near);
        all.fold(0, |all, &item| all | masks[item as usize])
    }

    /// Goes around the circle.
    fn is_some_angle_wanted(&self, masks: &[u128], wanted: u128) -> bool {
        let here = self.here.iter().fold(0, |all, &item| all | masks[item as usize]);
        if here == wanted {
            return true;
        }
        let mut held = Held { counts: [0; MISSES_MAX + 1], mask: here };
        // They are never let go.
        bits(here).for_each(|bit| held.counts[bit] = 1);
        self.at_start.iter().for_each(|&item| held.add(masks[item as usize]));
        self.ends.iter().any(|end| {
            let mask = masks[end.item as usize];
            match end.begins {
                true => held.add(mask),
                false => held.remove(mask),
            }
            end.begins && held.mask == wanted
        })
    }
}

/// The bits of the items that a ball holds.
struct Held {
    counts: [u32; MISSES_MAX + 1],
    /// Those of which there is an item.
    mask: u128,
}

impl Held {
    fn add(&mut self, mask: u128) {
        self.mask |= mask;
        bits(mask).for_each(|bit| self.counts[bit] += 1);
    }

    fn remove(&mut self, mask: u128) {
        for bit in bits(mask) {
            self.counts[bit] -= 1;
            if self.counts[bit] == 0 {
                self.mask &= !(1 << bit);
            }
        }
    }
}

fn bits(mask: u128) -> impl Iterator<Item = usize> {
    let mut rest = mask;
    std::iter::from_fn(move || {
        let bit = rest.trailing_zeros() as usize;
        (rest != 0).then(|| {
            rest &= rest - 1;
            bit
        })
    })
}

/// The same angle from −π to π.
fn turned(angle: f64) -> f64 {
    if angle < -PI {
        angle + 2.0 * PI
    } else if angle > PI {
        angle - 2.0 * PI
    } else {
        angle
    }
}

#[cfg(test)]
mod tests {
    use taut_points::Monitor;

    use super::super::item::Kind;
    use super::*;

    /// The answer for the first place and sets of the others, at a radius of 1.
    fn is_some_ball_wanted(places: &[[f64; 2]], sets: &[&[usize]]) -> bool {
        let core = Core::of(places.as_flattened(), 2, Kind::Points, 1.0);
        let mut meter = Meter::of(&Monitor::silent());
        let mut masks = vec![0; places.len()];
        for (bit, set) in sets.iter().enumerate() {
            set.iter().for_each(|&item| masks[item] |= 1 << bit);
        }
        masks[0] |= OF_ITEM;
        let wanted = OF_ITEM | ((1 << sets.len()) - 1);
        let circles = Circles::of(&core, &mut meter).unwrap();
        circles.is_some_ball_wanted(0, &masks, wanted, &mut meter).unwrap()
    }

    #[test]
    fn balls_that_hold_some_of_each_set_are_found() {
        let places = [[0.0, 0.0], [1.9, 0.0], [-1.9, 0.0], [0.0, 1.9], [0.0, 0.0], [9.0, 0.0]];
        assert!(is_some_ball_wanted(&places, &[&[1]]));
        assert!(!is_some_ball_wanted(&places, &[&[1], &[2]]));
        assert!(!is_some_ball_wanted(&places, &[&[1], &[2, 3]]));
        assert!(is_some_ball_wanted(&places, &[&[1, 2], &[2, 3], &[2, 5]]));
        assert!(!is_some_ball_wanted(&places, &[&[5]]));
        // A copy is held whatever the ball, and so is the item.
        assert!(is_some_ball_wanted(&places, &[&[4]]));
        assert!(is_some_ball_wanted(&places, &[&[0, 5], &[4, 5]]));
        assert!(is_some_ball_wanted(&[[0.0, 0.0], [2.0, 0.0]], &[&[1]]));
        assert!(!is_some_ball_wanted(&[[0.0, 0.0], [2.00001, 0.0]], &[&[1]]));
    }

    /// As many sets as a nogood may be shown by: the ball that holds all places is found, and there is none if one place is far.
    #[test]
    fn each_of_very_many_sets_counts() {
        let near = |at: usize| [0.001 * at as f64, 0.0];
        let places: Vec<[f64; 2]> = (0..=MISSES_MAX).map(near).collect();
        let items: Vec<usize> = (1..=MISSES_MAX).collect();
        let sets: Vec<&[usize]> = items.chunks(1).collect();
        assert!(is_some_ball_wanted(&places, &sets));
        for far in [1, 63, 64, MISSES_MAX] {
            let mut places = places.clone();
            places[far] = [3.0, 0.0];
            assert!(!is_some_ball_wanted(&places, &sets), "{far}");
        }
    }

    /// Differences of coordinates are beyond the range, the balls are not.
    #[test]
    fn balls_at_the_end_of_the_range_are_found() {
        let is_found = |bound: f64, places: &[[f64; 2]]| {
            let core = Core::of(places.as_flattened(), 2, Kind::Points, bound);
            let mut meter = Meter::of(&Monitor::silent());
            let circles = Circles::of(&core, &mut meter).unwrap();
            circles.is_some_ball_wanted(0, &[OF_ITEM, 1], OF_ITEM | 1, &mut meter).unwrap()
        };
        let ends = [[-1.2e308, 0.0], [1.2e308, 0.0]];
        assert!(is_found(1.6e308, &ends) && is_found(1.2e308, &ends) && !is_found(1.19e308, &ends));
        let corners = [[-1e308, -1e308], [1e308, 1e308]];
        assert!(is_found(1.7e308, &corners) && !is_found(1.41e308, &corners));
    }

    /// Whatever a fine grid of centers shows to be held is found, and what is found is held by balls that are a little larger.
    #[test]
    fn no_center_of_a_grid_is_denied() {
        let mut state = 17u64;
        let mut draw = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695);
            (state >> 33) as f64 / 2f64.powi(31)
        };
        let mut counts = [0, 0];
        for _ in 0..300 {
            let places: Vec<[f64; 2]> = (0..9).map(|_| [3.0 * draw(), 3.0 * draw()]).collect();
            let sets: [&[usize]; 3] = [&[1, 2, 3], &[3, 4, 5, 6], &[7, 8]];
            let is_center = |c: [f64; 2], radius: f64| {
                let holds =
                    |item: usize| (places[item][0] - c[0]).hypot(places[item][1] - c[1]) <= radius;
                holds(0) && sets.iter().all(|set| set.iter().any(|&item| holds(item)))
            };
            let is_held = |radius: f64| {
                let steps = || (-20..140).map(|step| f64::from(step) / 40.0);
                steps().any(|x| steps().any(|y| is_center([x, y], radius)))
            };
            let is_found = is_some_ball_wanted(&places, &sets);
            assert!(is_found || !is_held(1.0), "{places:?}");
            assert!(!is_found || is_held(1.0 + 0.02), "{places:?}");
            counts[usize::from(is_found)] += 1;
        }
        assert!(counts.iter().all(|&count| count > 30), "{counts:?}");
    }
}
