//! Balls of the plane that hold some points and none of others.
//!
//! *Problem.* Is there a center whose distance to each member is at most ρ, and to each point left out at least ρ?
//! *Idea.* Where balls of one radius are given, a point that is left out lies in none of them: if it lay in one, it would be held. So a
//! cluster is refuted when each ball that holds it holds a point left out, too. If there are centers, some lie on one of the
//! circles of radius ρ about the points. Most often one is where two circles meet. Where none is, each circle is cut into arcs: by a member at
//! distance D, all is lost that is more than arccos(D/2ρ) from its direction, and by a point left out all that is less.
//! *Guarantee.* Arcs are widened by [`MARGIN`], which is more than rounding and than what a checker widens them by.

use std::f64::consts::PI;

use super::items::{ItemSet, Position, Shape};

/// In radians; arcs that are nearer than this count as meeting. A checker takes a tenth, and rounding takes less than 1e-7.
const MARGIN: f64 = 1e-5;

type Place = [f64; 2];

/// Points of one cluster, and those left out that may be in its ball.
#[derive(Clone, Debug, Default)]
pub(super) struct AvoidingBall {
    /// Members first.
    points: Vec<Place>,
    members: usize,
}

impl AvoidingBall {
    /// Returns true if points like these can be asked for.
    pub(super) fn applies<P: Position>(items: &ItemSet<P>) -> bool {
        items.shape() == Shape::Points && items.dim() == 2
    }

    /// Takes the members of a cluster, and the points left out that are near to all of them.
    pub(super) fn set<P: Position>(
        &mut self,
        items: &ItemSet<P>,
        members: impl Iterator<Item = u32>,
        left_out: &[u32],
        radius: f64,
    ) {
        let place = |item: u32| [items.at(item as usize)[0], items.at(item as usize)[1]];
        self.points.clear();
        self.points.extend(members.map(place));
        self.members = self.points.len();
        for &item in left_out {
            let place = place(item);
            let is_near = |&member: &Place| square(place, member) < 4.0 * radius * radius;
            if self.points[..self.members].iter().all(is_near) {
                self.points.push(place);
            }
        }
    }

    /// Returns false if each ball of this radius that holds the members holds a point left out; true where that is not sure.
    pub(super) fn may_exist(&self, radius: f64) -> bool {
        let is_copied = |out: &Place| self.points[..self.members].contains(out);
        if self.points[self.members..].iter().any(is_copied) {
            return false;
        }
        self.points.len() == self.members
            || self.is_where_two_meet(radius)
            || self.is_on_arc(radius)
    }

    /// Looks at the two places at which each two circles meet.
    fn is_where_two_meet(&self, radius: f64) -> bool {
        let square_of_radius = radius * radius;
        let is_center = |place: Place| {
            let (members, left_out) = self.points.split_at(self.members);
            // The two circles meet there but for rounding.
            members.iter().all(|&member| square(place, member) <= square_of_radius * (1.0 + 1e-12))
                && left_out
                    .iter()
                    .all(|&out| square(place, out) >= square_of_radius * (1.0 - 1e-12))
        };
        self.points.iter().enumerate().any(|(at, &a)| {
            self.points[..at].iter().any(|&b| {
                let apart = square(a, b);
                let across = square_of_radius / apart - 0.25;
                if !(across >= 0.0 && across.is_finite()) {
                    return false;
                }
                let across = across.sqrt();
                let (x, y) = (0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]));
                let (u, v) = (across * (b[1] - a[1]), across * (a[0] - b[0]));
                is_center([x + u, y + v]) || is_center([x - u, y - v])
            })
        })
    }

    /// Looks for a piece of a circle that is left by all other points.
    fn is_on_arc(&self, radius: f64) -> bool {
        (0..self.points.len()).any(|at| {
            // Pieces from an angle to a larger one, which may go beyond π.
            let mut pieces = vec![[-PI, PI]];
            for (other, &place) in self.points.iter().enumerate() {
                let apart = square(place, self.points[at]).sqrt();
                if other == at || apart == 0.0 {
                    continue;
                }
                let [dx, dy] = [place[0] - self.points[at][0], place[1] - self.points[at][1]];
                let (direction, half) = (dy.atan2(dx), (apart / (2.0 * radius)).min(1.0).acos());
                let kept = match other < self.members {
                    true => [direction - half - MARGIN, direction + half + MARGIN],
                    false => [direction + half - MARGIN, direction + 2.0 * PI - half + MARGIN],
                };
                pieces = cut(&pieces, kept);
            }
            !pieces.is_empty()
        })
    }
}

/// The parts of pieces that lie in an arc, on any turn.
fn cut(pieces: &[[f64; 2]], [from, to]: [f64; 2]) -> Vec<[f64; 2]> {
    let turns = [-2.0 * PI, 0.0, 2.0 * PI];
    let parts = pieces
        .iter()
        .flat_map(|&[first, last]| turns.map(|turn| [first.max(from + turn), last.min(to + turn)]));
    parts.filter(|[first, last]| first <= last).collect()
}

fn square(a: Place, b: Place) -> f64 {
    (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn may_exist(members: &[Place], left_out: &[Place], radius: f64) -> bool {
        let mut items = ItemSet::<[f64; 2]>::new(Shape::Points, 2);
        members.iter().chain(left_out).for_each(|place| items.push(place, 0.0));
        let out: Vec<u32> = (members.len() as u32..items.len() as u32).collect();
        let mut ball = AvoidingBall::default();
        ball.set(&items, 0..members.len() as u32, &out, radius);
        ball.may_exist(radius)
    }

    #[test]
    fn a_point_between_others_is_held_with_them() {
        let ends = [[0.0, 0.0], [2.0, 0.0]];
        assert!(!may_exist(&ends, &[[1.0, 0.0]], 1.2));
        // The lens of all balls of radius 1.25 with both ends is 0.5 thick on each side of the middle.
        assert!(!may_exist(&ends, &[[1.0, 0.49]], 1.25));
        assert!(may_exist(&ends, &[[1.0, 0.51]], 1.25));
        // Two of them, on both sides, are not avoided at once by balls that are not much larger.
        assert!(!may_exist(&ends, &[[1.0, 0.51], [1.0, -0.51]], 1.25));
        assert!(may_exist(&ends[..1], &[[1e-3, 0.0]], 1.0));
        assert!(!may_exist(&ends[..1], &[[0.0, 0.0]], 1.0));
    }

    /// Where a fine grid of centers has one that keeps clear of all circles, it exists.
    #[test]
    fn no_center_of_a_grid_is_missed() {
        let mut state = 3u64;
        let mut draw = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695);
            (state >> 33) as f64 / 2f64.powi(31)
        };
        let (mut yes, mut no) = (0, 0);
        for _ in 0..400 {
            let mut places = |count: usize, size: f64| -> Vec<Place> {
                (0..count).map(|_| [size * draw(), size * draw()]).collect()
            };
            let (members, left_out) = (places(3, 1.2), places(3, 1.0));
            let is_center = |place: Place| {
                members.iter().all(|&m| square(place, m) <= 0.999)
                    && left_out.iter().all(|&out| square(place, out) >= 1.001)
            };
            let steps = || (-60..120).map(|step| f64::from(step) / 60.0);
            let is_found = steps().any(|x| steps().any(|y| is_center([x, y])));
            let may = may_exist(&members, &left_out, 1.0);
            assert!(may || !is_found, "{members:?} {left_out:?}");
            (yes, no) = (yes + u32::from(may), no + u32::from(!may));
        }
        assert!(yes > 50 && no > 50, "{yes} {no}");
    }
}
