//! How many points bodies cover.

use taut_certify::ConvexBody;

/// The number of points that lie in at least one of the bodies.
pub(super) fn covered(points: &[[i32; 3]], bodies: &[ConvexBody]) -> u64 {
    let is_in = |p: &[i32; 3], body: &ConvexBody| {
        body.normals.iter().zip(&body.offsets).all(|(u, &h)| {
            let along: i64 = (0..3).map(|c| u[c] * i64::from(p[c])).sum();
            along <= h
        })
    };
    points.iter().filter(|p| bodies.iter().any(|body| is_in(p, body))).count() as u64
}
