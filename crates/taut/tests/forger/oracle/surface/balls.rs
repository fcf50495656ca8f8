//! Which rows are inside of the ball that a triangle is said to have.

use num_bigint::{BigInt, Sign};
use num_traits::Zero;
use taut::certify::Apex;
use taut::{Solution, Surface};

use super::super::lattice::{determinant, difference, dot};
use super::convex::{Place, cross};
use super::scene::{Scene, kept, sorted};
use super::{Judged, ensure};

/// Rows strictly inside of the ball, or, of a facet of the hull, of the half-space and circle to each side.
#[derive(Clone, Debug)]
pub(super) enum Inside {
    /// There is no such ball.
    NoBall(&'static str),
    Of(Vec<Vec<u32>>),
}

/// Each triangle has the empty ball that it is said to have.
pub(super) fn judge(solution: &Solution<Surface>, scene: &Scene, is_site: &[bool]) -> Judged {
    let (triangles, apexes) = (&solution.answer.triangles, &solution.certificate.apexes);
    if apexes.is_empty() {
        return Ok(());
    }
    ensure(apexes.len() == triangles.len(), || "not an apex for each triangle".into())?;
    for (&triangle, &apex) in triangles.iter().zip(apexes) {
        let code = match apex {
            Apex::Row(row) => i64::from(row),
            Apex::Hull => -1,
            Apex::Gabriel => -2,
        };
        if let Apex::Row(row) = apex {
            let is_there = is_site.get(row as usize).is_some_and(|&is_site| is_site);
            ensure(is_there, || format!("apex {row} is no point"))?;
        }
        let triangle = sorted(triangle);
        match kept(&scene.balls, (triangle, code), || inside(scene, triangle, apex)) {
            Inside::NoBall(why) => {
                return Err(format!("triangle {triangle:?} has no ball {apex:?}: {why}"));
            }
            Inside::Of(rows) => {
                let is_empty = |rows: &Vec<u32>| !rows.iter().any(|&row| is_site[row as usize]);
                ensure(rows.iter().any(is_empty), || {
                    format!("the ball {apex:?} of triangle {triangle:?} holds {rows:?}")
                })?;
            }
        }
    }
    Ok(())
}

fn inside(scene: &Scene, triangle: [u32; 3], apex: Apex) -> Inside {
    if scene.is_flat(triangle) {
        return Inside::NoBall("it is flat");
    }
    let corners = scene.corners(triangle);
    let rows = |is_inside: &dyn Fn(&Place) -> bool| -> Vec<u32> {
        let others = (0..scene.places.len() as u32).filter(|row| !triangle.contains(row));
        others.filter(|&row| is_inside(scene.at(row))).collect()
    };
    match apex {
        Apex::Gabriel => Inside::Of(vec![rows(&|q| is_in_smallest(corners, q))]),
        Apex::Hull => {
            let beyond = |side: Sign| {
                rows(&|q| match orientation(corners, q) {
                    Sign::NoSign => is_in_smallest(corners, q),
                    other => other == side,
                })
            };
            Inside::Of(vec![beyond(Sign::Plus), beyond(Sign::Minus)])
        }
        Apex::Row(row) => match orientation(corners, scene.at(row)) {
            Sign::NoSign => Inside::NoBall("its apex is in its plane"),
            side => Inside::Of(vec![rows(&|q| {
                // (a − q, |a − q|²) of the four corners: negative inside of a positive tetrahedron.
                let [a, b, c] = corners;
                let row = |p: &Place| {
                    let mut edge = difference(p, q);
                    edge.push(dot(&edge, &edge));
                    edge
                };
                let lifted = determinant(&[row(a), row(b), row(c), row(scene.at(row_of(apex)))]);
                !lifted.is_zero() && lifted.sign() != side
            })]),
        },
    }
}

fn row_of(apex: Apex) -> u32 {
    match apex {
        Apex::Row(row) => row,
        Apex::Hull | Apex::Gabriel => 0,
    }
}

/// The side of the plane of a triangle that q is on.
pub(super) fn orientation([a, b, c]: [&Place; 3], q: &Place) -> Sign {
    determinant(&[difference(b, a), difference(c, a), difference(q, a)]).sign()
}

/// Whether q is strictly inside of the smallest ball with the corners on its sphere, whose center is a + N/2|n|².
fn is_in_smallest([a, b, c]: [&Place; 3], q: &Place) -> bool {
    let (u, v, r) = (difference(b, a), difference(c, a), difference(q, a));
    let n = cross(&u, &v);
    let (across_u, across_v) = (cross(&n, &u), cross(&v, &n));
    let (uu, vv) = (dot(&u, &u), dot(&v, &v));
    let toward: BigInt = dot(&across_u, &r) * vv + dot(&across_v, &r) * uu;
    dot(&r, &r) * dot(&n, &n) < toward
}
