//! Which rows are inside of the ball that a triangle is said to have.

use num_bigint::{BigInt, Sign};
use num_traits::Zero;
use taut::Solution;
use taut::certify::Apex;
use taut::certify::Surface;

use super::super::lattice::{determinant, difference, dot};
use super::convex::{Place, cross};
use super::scene::{Scene, kept, sorted};
use super::{Judged, ensure};

/// The ball of a triangle: lower rows first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Ball {
    pub(super) triangle: [u32; 3],
    pub(super) apex: Apex,
}

/// Rows strictly inside of a ball; of a facet of the hull, beyond its plane or in its circle, to either side.
#[derive(Clone, Debug, Default)]
pub(super) struct Inside {
    /// Why there is no such ball.
    problem: Option<&'static str>,
    sides: Vec<(Sign, Vec<u32>)>,
}

/// Each triangle has the empty ball that it is said to have.
pub(super) fn judge(solution: &Solution<Surface>, scene: &Scene, is_site: &[bool]) -> Judged {
    let (triangles, apexes) = (&solution.answer.triangles, &solution.certificate.apexes);
    if apexes.is_empty() {
        return Ok(());
    }
    ensure(apexes.len() == triangles.len(), || "not an apex for each triangle".into())?;
    for (&triangle, &apex) in triangles.iter().zip(apexes) {
        if let Apex::Row(row) = apex {
            let is_there = is_site.get(row as usize).is_some_and(|&is_site| is_site);
            ensure(is_there, || format!("apex {row} is no point"))?;
        }
        let ball = Ball { triangle: sorted(triangle), apex };
        let Inside { problem, sides } = kept(&scene.balls, ball, || ball.inside(scene));
        ensure(problem.is_none(), || format!("{ball:?} is none: {problem:?}"))?;
        let is_empty = |rows: &[u32]| !rows.iter().any(|&row| is_site[row as usize]);
        ensure(sides.iter().any(|(_, rows)| is_empty(rows)), || {
            format!("{ball:?} holds rows {sides:?}")
        })?;
    }
    Ok(())
}

impl Ball {
    /// Returns true if it depends on the place of a row, other than that the row may be inside.
    pub(super) fn names(&self, row: u32) -> bool {
        self.triangle.contains(&row) || self.apex == Apex::Row(row)
    }

    fn inside(&self, scene: &Scene) -> Inside {
        if scene.is_flat(self.triangle) {
            return Inside { problem: Some("it is flat"), sides: vec![] };
        }
        let corners = scene.corners(self.triangle);
        let sides = match self.apex {
            Apex::Gabriel => vec![Sign::NoSign],
            Apex::Hull => vec![Sign::Plus, Sign::Minus],
            Apex::Row(row) => vec![orientation(corners, scene.at(row))],
        };
        if matches!(self.apex, Apex::Row(_)) && sides == [Sign::NoSign] {
            return Inside { problem: Some("its apex is in its plane"), sides: vec![] };
        }
        let mut inside =
            Inside { problem: None, sides: sides.into_iter().map(|side| (side, vec![])).collect() };
        (0..scene.places.len() as u32).for_each(|row| self.enter(&mut inside, row, scene));
        inside
    }

    /// Enters a row where it is inside.
    fn enter(&self, inside: &mut Inside, row: u32, scene: &Scene) {
        for (side, rows) in &mut inside.sides {
            if !self.triangle.contains(&row) && self.holds(*side, scene.at(row), scene) {
                rows.push(row);
            }
        }
    }

    /// Returns what is inside where some rows, none of them named, have other places than before.
    pub(super) fn renewed(&self, before: &Inside, changed: &[u32], scene: &Scene) -> Inside {
        let mut inside = before.clone();
        for (_, rows) in &mut inside.sides {
            rows.retain(|row| !changed.contains(row));
        }
        changed.iter().for_each(|&row| self.enter(&mut inside, row, scene));
        inside
    }

    /// Returns true if a place that is no corner is strictly inside: of the half-space on `side` of the triangle, if it is one.
    fn holds(&self, side: Sign, q: &Place, scene: &Scene) -> bool {
        let corners = scene.corners(self.triangle);
        match self.apex {
            Apex::Gabriel => is_in_smallest(corners, q),
            Apex::Hull => match orientation(corners, q) {
                Sign::NoSign => is_in_smallest(corners, q),
                other => other == side,
            },
            Apex::Row(row) => {
                // (p − q, |p − q|²) of the four vertices: negative inside of a positive tetrahedron.
                let lifted = |p: &Place| {
                    let mut edge = difference(p, q);
                    edge.push(dot(&edge, &edge));
                    edge
                };
                let [a, b, c] = corners;
                let value = determinant(&[a, b, c, scene.at(row)].map(lifted));
                !value.is_zero() && value.sign() != side
            }
        }
    }
}

/// The side of the plane of a triangle that q is on.
pub(super) fn orientation([a, b, c]: [&Place; 3], q: &Place) -> Sign {
    determinant(&[difference(b, a), difference(c, a), difference(q, a)]).sign()
}

/// Tests whether q is strictly inside of the smallest ball with the corners on its sphere, whose center is a + N/2|n|².
fn is_in_smallest([a, b, c]: [&Place; 3], q: &Place) -> bool {
    let (u, v, r) = (difference(b, a), difference(c, a), difference(q, a));
    let n = cross(&u, &v);
    let (across_u, across_v) = (cross(&n, &u), cross(&v, &n));
    let (uu, vv) = (dot(&u, &u), dot(&v, &v));
    let toward: BigInt = dot(&across_u, &r) * vv + dot(&across_v, &r) * uu;
    dot(&r, &r) * dot(&n, &n) < toward
}
