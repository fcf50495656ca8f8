//! The candidates around an edge of the front, and which of them it likes best.
//!
//! *Problem.* Triangle t has an edge that no other triangle of the surface has. Which candidate continues it?
//! *Idea.* Turn about the edge from t towards its normal, cell by cell. Candidates that make a dihedral angle of at least π/4 with t are
//! kept, in the order in which they come. From the one whose circumcenter is nearest to that of t, go back towards t for as long as the
//! next one is less than π/12 away: that is the topmost of a system of slivers.
//! *Guarantee.* The order is exact, as it is that of the cells. Angles and distances are `f64`, ties go to the smaller site.
//! *Trap.* Candidates of equal rank are many where points lie on circles; an order by an angle that was computed would be arbitrary
//! there.
//! *Reference.* Conditions 1 and 2 of the thesis, section 4.2.

use taut_delaunay::GHOST;
use taut_points::OrderBy;
use taut_predicates::space::orient;

use super::angles::{Bound, half_plane};
use super::candidates::{Candidates, NONE};
use crate::surface::sides::{Side, Sides};
use crate::surface::vector::{Vector, minus};

/// A candidate at an edge.
#[derive(Clone, Copy, Debug)]
struct RingCandidate {
    /// The side that continues the orientation of the triangle at the edge.
    side: Side,
    /// The third site.
    third: u32,
    /// The normal of its half-plane.
    normal: Vector,
    /// The measure that makes it attractive.
    measure: f64,
}

/// A continuation: what the queue sorts by, and the side to add.
#[derive(Clone, Copy, Debug)]
pub(super) struct Choice {
    /// States whether slivers are on it, then the measure of the candidate next to the triangle.
    pub(super) key: (bool, f64),
    pub(super) side: Side,
}

/// The bounds for angles, and room to work in.
pub(super) struct Ring {
    forbidden: Bound,
    sliver: Bound,
    kept: Vec<RingCandidate>,
    by_measure: Vec<u32>,
}

impl Ring {
    pub(super) fn new(forbidden_angle: f64, sliver_angle: f64) -> Self {
        Self {
            forbidden: Bound::of(forbidden_angle),
            sliver: Bound::of(sliver_angle),
            kept: Vec::new(),
            by_measure: Vec::new(),
        }
    }

    /// The best continuation of a triangle over its edge from u to v, w being its third corner, that may be added.
    pub(super) fn choose(
        &mut self,
        sides: &Sides,
        candidates: &Candidates,
        (triangle, [u, v, w]): (Side, [u32; 3]),
        alive: impl Fn(u32) -> bool,
        may_add: impl Fn(Side) -> bool,
    ) -> Option<Choice> {
        self.turn(sides, candidates, (triangle, [u, v, w]), alive);
        let Self { kept, by_measure, sliver, .. } = self;
        by_measure.clear();
        by_measure.extend(0..kept.len() as u32);
        by_measure.order_by(&|&i, &j| {
            let [one, other] = [i, j].map(|i| &kept[i as usize]);
            one.measure.total_cmp(&other.measure).then(one.third.cmp(&other.third))
        });
        let [from, to] = [u, v].map(|site| sides.points[site as usize]);
        let close = |earlier: usize| {
            let [one, other] = [&kept[earlier], &kept[earlier + 1]];
            let [p, q] = [one, other].map(|kept| sides.points[kept.third as usize]);
            sliver.exceeds(one.normal, other.normal) && orient(from, to, p, q).is_positive()
        };
        by_measure.iter().find_map(|&i| {
            let nearest = i as usize;
            let mut topmost = nearest;
            while topmost > 0 && close(topmost - 1) {
                topmost -= 1;
            }
            let slivers = topmost < nearest || (nearest + 1 < kept.len() && close(nearest));
            let choice = Choice { key: (slivers, kept[nearest].measure), side: kept[topmost].side };
            may_add(choice.side).then_some(choice)
        })
    }

    /// Notes the candidates that are kept, turning towards the normal.
    fn turn(
        &mut self,
        sides: &Sides,
        candidates: &Candidates,
        (triangle, [u, v, w]): (Side, [u32; 3]),
        alive: impl Fn(u32) -> bool,
    ) {
        self.kept.clear();
        let at = |site: u32| sides.points[site as usize];
        let (from, d) = (at(u), minus(at(v), at(u)));
        let own = half_plane(from, d, at(w));
        let own_number = candidates.of_side(triangle);
        let (mut side, mut last) = (triangle, w);
        loop {
            let third = sides.apex(side);
            let next = sides.turned(side, last);
            let candidate = candidates.of_side(next);
            if candidate == own_number {
                break;
            }
            if third != GHOST && candidate != NONE && alive(candidate) {
                let normal = half_plane(from, d, at(third));
                if !self.forbidden.exceeds(own, normal) {
                    let measure = candidates.measure(own_number, candidate);
                    self.kept.push(RingCandidate { side: next, third, normal, measure });
                }
            }
            (side, last) = (sides.mirror(next), third);
        }
    }
}
