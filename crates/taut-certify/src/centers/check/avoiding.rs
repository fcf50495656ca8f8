//! Points of the plane that every ball with some others holds, too.
//!
//! *Problem.* Members m of a cluster and points x left out: is there no center c with |c − m| ≤ ρ for all m and |c − x| ≥ ρ for all x?
//! *Idea.* The set of such centers is closed and bounded. If it is not empty, it has a border, and this is made of the circles of radius ρ
//! about the points. On such a circle each other point allows one arc: seen from the point of the circle at distance D in
//! direction φ, the angles within arccos(D/2ρ) of φ for a member, all others for a point left out. Some arcs have a common angle
//! just when an end of one of them lies in all, or when there are none.
//! *Use.* k balls of radii less than ρ that hold all but z points may be enlarged until all have one radius ρ′ < ρ, as near to ρ as wanted:
//! they leave out no more. What they leave out is then at least ρ′ from all centers.
//! *Rounding.* A difference of coordinates is off by a rounding of itself, so a direction by less than 1e-15. An arccos is off
//! by most near 1, by less than 1e-7 for what D and ρ′ are off by. Arcs are longer by [`MARGIN`] at each end.

use std::f64::consts::PI;

use taut_points::Cancelled;

use super::core::Core;
use super::distance::difference;
use super::meter::Meter;

/// In radians, by how much arcs are longer: ten times what rounding can take.
const MARGIN: f64 = 1e-6;
/// In radians, how far beside an arc an end of another may lie and be in it; covers the rounding of angles.
const END_TOLERANCE: f64 = 1e-9;

/// The angles that one point allows on the circle of another.
struct Arc {
    direction: f64,
    half: f64,
    /// True for a member: angles within `half` of the direction; else those beyond.
    is_member: bool,
}

impl Arc {
    fn ends(&self) -> [f64; 2] {
        [self.direction - self.half, self.direction + self.half]
    }

    fn allows(&self, angle: f64) -> bool {
        let apart = (angle - self.direction).rem_euclid(2.0 * PI);
        let apart = apart.min(2.0 * PI - apart);
        match self.is_member {
            true => apart <= self.half + END_TOLERANCE,
            false => apart >= self.half - END_TOLERANCE,
        }
    }
}

/// Returns true if it is proved that each ball of a radius just below ρ that holds the members holds one of the items left out.
pub(super) fn is_held_out(
    core: &Core,
    members: &[usize],
    left_out: &[usize],
    meter: &mut Meter<'_>,
) -> Result<bool, Cancelled> {
    if !core.is_plain_plane() || members.is_empty() {
        return Ok(false);
    }
    let points = || members.iter().chain(left_out);
    meter.spend(2 * members.len() * left_out.len())?;
    if left_out
        .iter()
        .any(|&out| members.iter().any(|&member| core.place(member) == core.place(out)))
    {
        return Ok(true);
    }
    'circles: for &about in points() {
        let mut arcs = vec![];
        for (number, &item) in points().enumerate() {
            let is_member = number < members.len();
            let [dx, dy] = [0, 1].map(|axis| {
                difference(core.place(item)[axis], core.place(about)[axis], core.scale)
            });
            let distance = dx.hypot(dy);
            let cosine = distance / (2.0 * core.reach(about));
            if is_member && cosine > 1.0 + END_TOLERANCE {
                // No center on this circle is near to the member.
                continue 'circles;
            }
            if distance > 0.0 {
                let half = cosine.min(1.0).acos();
                let half = if is_member { half + MARGIN } else { half - MARGIN };
                arcs.push(Arc { direction: dy.atan2(dx), half, is_member });
            }
        }
        meter.spend(1 + 20 * arcs.len() + 4 * arcs.len() * arcs.len())?;
        let is_allowed = |angle: f64| arcs.iter().all(|arc| arc.allows(angle));
        if arcs.is_empty() || arcs.iter().flat_map(Arc::ends).any(is_allowed) {
            return Ok(false);
        }
    }
    Ok(!left_out.is_empty())
}

#[cfg(test)]
mod tests {
    use taut_points::Monitor;

    use super::super::item::Kind;
    use super::*;

    fn held_out(places: &[[f64; 2]], members: usize, bound: f64) -> bool {
        let core = Core::of(places.as_flattened(), 2, Kind::Points, bound);
        let all: Vec<usize> = (0..places.len()).collect();
        let (members, left_out) = all.split_at(members);
        is_held_out(&core, members, left_out, &mut Meter::of(&Monitor::silent())).unwrap()
    }

    /// Differences of coordinates are beyond the range, the balls are not.
    #[test]
    fn a_lens_at_the_end_of_the_range_is_as_wide_as_any() {
        let lens = |y: f64| held_out(&[[-1.2e308, 0.0], [1.2e308, 0.0], [0.0, y]], 2, 1.5e308);
        assert!(lens(0.5e308) && !lens(0.7e308));
    }

    #[test]
    fn a_point_within_the_lens_of_two_is_held_and_one_beside_it_is_not() {
        // All balls of radius 1.25 with the two ends have in common what is less than 0.5 from the middle, across.
        let lens = |y: f64| held_out(&[[0.0, 0.0], [2.0, 0.0], [1.0, y]], 2, 1.25);
        assert!(lens(0.0) && lens(0.4999) && lens(-0.4999));
        assert!(!lens(0.5) && !lens(0.5001) && !lens(3.0));
        // Each can be avoided, both cannot.
        assert!(held_out(&[[0.0, 0.0], [2.0, 0.0], [1.0, 0.6], [1.0, -0.6]], 2, 1.25));
        assert!(!held_out(&[[0.0, 0.0], [2.0, 0.0]], 2, 1.25));
        assert!(!held_out(&[[0.0, 0.0], [1e-3, 0.0]], 1, 1.0));
        // One that is too far from an end to matter, and one that is held.
        assert!(held_out(&[[0.0, 0.0], [2.0, 0.0], [-0.6, 0.0], [1.0, 0.0]], 2, 1.25));
        // Copies are held together.
        assert!(held_out(&[[0.0, 0.0], [0.0, 0.0]], 1, 1.0));
    }

    #[test]
    fn places_and_sizes_do_not_matter() {
        for (scale, shift) in [(1e-200, 0.0), (1e150, 0.0), (1.0, 1e6)] {
            let place = |x: f64, y: f64| [x * scale + shift, y * scale + shift];
            let lens = |y: f64| {
                held_out(&[place(0.0, 0.0), place(2.0, 0.0), place(1.0, y)], 2, 1.25 * scale)
            };
            assert!(lens(0.499) && !lens(0.501), "{scale} {shift}");
        }
    }

    /// Whatever a fine grid of centers shows to be avoidable is not refuted.
    #[test]
    fn no_center_of_a_grid_is_denied() {
        let mut state = 11u64;
        let mut draw = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695);
            (state >> 33) as f64 / 2f64.powi(31)
        };
        let mut counts = [0, 0];
        for _ in 0..300 {
            let places: Vec<[f64; 2]> = (0..6).map(|_| [1.1 * draw(), 1.1 * draw()]).collect();
            let is_center = |c: [f64; 2]| {
                let distance = |p: [f64; 2]| (p[0] - c[0]).hypot(p[1] - c[1]);
                places[..3].iter().all(|&p| distance(p) <= 1.0)
                    && places[3..].iter().all(|&p| distance(p) >= 1.0)
            };
            let steps = || (-40..90).map(|step| f64::from(step) / 40.0);
            let is_avoided = steps().any(|x| steps().any(|y| is_center([x, y])));
            let is_refuted = held_out(&places, 3, 1.0);
            assert!(!(is_refuted && is_avoided), "{places:?}");
            counts[usize::from(is_refuted)] += 1;
        }
        assert!(counts.iter().all(|&count| count > 30), "{counts:?}");
    }
}
