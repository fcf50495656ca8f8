//! That the circle of no triangle is larger than the radius of an alpha shape.
//!
//! *Formula.* For edges u, v, w of a triangle and n = u × v, the square of the radius is |u|²|v|²|w|²/4|n|².
//! *Bound.* |n|² ≤ |u|²|v|², and the terms of a minor sum to at most that in size; each side has fewer than 20 roundings.

use super::super::{Surface, SurfaceViolation};
use super::places::Places;
use crate::arithmetic::{Integer, Ring, U, parts};
use crate::triangulation::{UNDERFLOW, cross};

pub(super) fn check(
    surface: &Surface,
    places: &Places,
    radius: f64,
) -> Result<(), SurfaceViolation> {
    let scaled = radius * places.scale;
    // Scaling is exact unless it over- or underflows.
    let is_exact = scaled.is_finite() && scaled / places.scale == radius;
    for (triangle, &rows) in surface.triangles.iter().enumerate() {
        let corners = places.corners(rows);
        let fits = match is_exact && places.signs.is_filtered {
            true => fits(&corners, scaled),
            false => None,
        };
        if !fits.unwrap_or_else(|| fits_exactly(&corners, radius, places.scale)) {
            return Err(SurfaceViolation::Radius { triangle, radius });
        }
    }
    Ok(())
}

/// |u|²|v|²|w|² and |n|².
fn measures<T: Ring>([a, b, c]: &[[T; 3]; 3]) -> [T; 2] {
    let edge = |from: &[T; 3], to: &[T; 3]| [0, 1, 2].map(|k| to[k].minus(&from[k]));
    let square = |v: &[T; 3]| v[0].times(&v[0]).plus(&v[1].times(&v[1])).plus(&v[2].times(&v[2]));
    let (u, v, w) = (edge(a, b), edge(a, c), edge(b, c));
    [square(&u).times(&square(&v)).times(&square(&w)), square(&cross(&u, &v))]
}

/// Tests whether the radius is at most `radius`, where rounding leaves that certain. Sizes of coordinates are below 1.
fn fits(corners: &[[f64; 3]; 3], radius: f64) -> Option<bool> {
    let [product, area] = measures(corners);
    let most = 4.0 * radius * radius;
    let edges: f64 = (0..3)
        .map(|k| (corners[1][k] - corners[0][k]).abs().max((corners[2][k] - corners[0][k]).abs()))
        .sum();
    // Either minor has two terms of at most this square in size.
    let largest = 12.0 * edges * edges * edges * edges;
    let error = 40.0 * U * (product + most * largest) + UNDERFLOW * (1.0 + most);
    let difference = most * area - product;
    (difference.abs() > error && error.is_finite()).then_some(difference > 0.0)
}

/// The same in whole numbers; false for a triangle without area.
fn fits_exactly(corners: &[[f64; 3]; 3], radius: f64, scale: f64) -> bool {
    // Both sides times the power of two by which coordinates were multiplied.
    let values = || corners.iter().flatten().copied().filter(|&x| x != 0.0);
    let least = values().map(|x| parts(x).1).min().unwrap_or(0);
    let [product, area] = measures(&corners.map(|p| p.map(|x| Integer::scaled(x, least))));
    let (radius_power, scale_power) = (parts(radius).1, parts(scale).1);
    // 4·radius²·scale²·|n|² in units of 2^(2·least) less than the product has.
    let mantissa = Integer::scaled(radius, radius_power);
    let bound = mantissa.times(&mantissa).times(&area);
    let shift = 2 + 2 * (radius_power + scale_power - least);
    let (bound, product) = match shift {
        0.. => (bound.times(&power(shift)), product),
        _ => (bound, product.times(&power(-shift))),
    };
    area.sign().is_gt() && bound.minus(&product).sign().is_ge()
}

/// 2^k for k ≥ 0.
fn power(k: i32) -> Integer {
    Integer::scaled(1.0, -k)
}
