//! The dimension of the affine hull of sites, exactly, and the simplex a build starts from.
//!
//! Idea: take the first site; the first that is another one; the first off their line; the first off their plane.
//! Guarantee: exact. Which simplex comes out does not matter to the triangulation.

use taut_predicates::{Sign, plane, space};

/// The affine hull that a set of distinct sites spans.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Span<const V: usize> {
    Nothing,
    Point,
    Line,
    /// A plane in space, with three sites that are not collinear.
    Plane([u32; 3]),
    /// All dimensions, with affinely independent sites.
    Full([u32; V]),
}

pub(crate) fn span_of_plane(sites: &[[f64; 2]]) -> Span<3> {
    match sites.len() {
        0 => Span::Nothing,
        1 => Span::Point,
        _ => match (2..sites.len())
            .find(|&i| plane::orient(sites[0], sites[1], sites[i]) != Sign::Zero)
        {
            Some(third) => Span::Full([0, 1, third as u32]),
            None => Span::Line,
        },
    }
}

/// Tests whether three points of space lie on a line: they do in all three projections.
pub(crate) fn collinear(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> bool {
    [[0, 1], [1, 2], [2, 0]].iter().all(|&[i, j]| {
        let project = |p: [f64; 3]| [p[i], p[j]];
        plane::orient(project(a), project(b), project(c)) == Sign::Zero
    })
}

pub(crate) fn span_of_space(sites: &[[f64; 3]]) -> Span<4> {
    match sites.len() {
        0 => return Span::Nothing,
        1 => return Span::Point,
        _ => {}
    }
    let Some(third) = (2..sites.len()).find(|&i| !collinear(sites[0], sites[1], sites[i])) else {
        return Span::Line;
    };
    let off = |i: &usize| space::orient(sites[0], sites[1], sites[third], sites[*i]) != Sign::Zero;
    match (third + 1..sites.len()).find(off) {
        Some(fourth) => Span::Full([0, 1, third as u32, fourth as u32]),
        None => Span::Plane([0, 1, third as u32]),
    }
}

/// A point off the plane of `sites`, three of which, `on`, are not collinear; integral if they are, and no larger than
/// their largest coordinate or extent, up to the next integer.
pub(crate) fn apex(sites: &[[f64; 3]], on: [u32; 3]) -> [f64; 3] {
    let [a, b, c] = on.map(|i| sites[i as usize]);
    let axis = (0..3)
        .find(|&k| {
            let project = |p: [f64; 3]| [p[(k + 1) % 3], p[(k + 2) % 3]];
            plane::orient(project(a), project(b), project(c)) != Sign::Zero
        })
        .expect("three points that are not collinear have a projection that is not");
    let extent = sites
        .iter()
        .fold(0.0, |extent: f64, p| (0..3).fold(extent, |e, k| e.max((p[k] - a[k]).abs())));
    let mut apex = a;
    // Any height off the plane does, as the circles of the plane are where it cuts spheres through the apex. A height
    // that only adds the extent could be lost to rounding far from 0.
    apex[axis] =
        if a[axis].abs() >= extent { -a[axis] } else { a[axis] - extent.ceil().copysign(a[axis]) };
    apex
}
