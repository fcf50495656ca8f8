//! The filter of space; idea, proof and references are those of the plane's filter.
//!
//! - `orient`: 3 differences, minor 2, a product, two sums: k = 8.
//! - `in_sphere`: 5 differences, minor 2, determinant 3, lift 3, their product, two sums: k = 16.
//!
//! *Underflow.* What is off by 2⁻¹⁰⁷⁵ is a product of two differences or more. The later factors make it at most
//! 2⁻¹⁰⁷⁵·2⁶·(2⁴¹)³ < 2⁻⁹⁴⁰, and fewer than 2⁷ such errors, and those of the permanent, stay below [`UNDERFLOW_ERROR`].

use crate::mul_add::MulAdd;
use crate::space::Point;

const U: f64 = f64::EPSILON / 2.0;

/// Relative to the permanent, the largest error of the determinant of [`orient_filter`].
pub const ORIENT_ERROR: f64 = 8.0 * U;
/// Relative to the permanent, the largest error of the determinant of [`in_sphere_filter`].
pub const IN_SPHERE_ERROR: f64 = 16.0 * U;
/// The error that is allowed for underflow, 2⁻⁹⁰⁰: more than it can cost for coordinates up to 2⁴⁰.
pub const UNDERFLOW_ERROR: f64 = f64::from_bits((1023 - 900) << 52);

/// A number whose sign is that of `orient(a, b, c, d)`, or 0 if rounding may hide it. For coordinates up to 2⁴⁰.
#[inline(always)]
#[must_use]
pub fn orient_filter<M: MulAdd>(a: Point, b: Point, c: Point, d: Point) -> f64 {
    let [(ux, uy, uz), (vx, vy, vz), (wx, wy, wz)] =
        [b, c, d].map(|p| (p[0] - a[0], p[1] - a[1], p[2] - a[2]));
    let (uy_vx, uy_wx, vy_wx) = (uy * vx, uy * wx, vy * wx);
    let uv = M::mul_add(ux, vy, -uy_vx);
    let uw = M::mul_add(ux, wy, -uy_wx);
    let vw = M::mul_add(vx, wy, -vy_wx);
    let det = M::mul_add(uz, vw, M::mul_add(-vz, uw, wz * uv));
    let uv = M::mul_add(ux.abs(), vy.abs(), uy_vx.abs());
    let uw = M::mul_add(ux.abs(), wy.abs(), uy_wx.abs());
    let vw = M::mul_add(vx.abs(), wy.abs(), vy_wx.abs());
    let permanent = M::mul_add(uz.abs(), vw, M::mul_add(vz.abs(), uw, wz.abs() * uv));
    certain::<M>(det, permanent, ORIENT_ERROR)
}

/// A number whose sign is that of `in_sphere(a, b, c, d, q)`, or 0 if rounding may hide it. For coordinates up to
/// 2⁴⁰.
#[inline(always)]
#[must_use]
pub fn in_sphere_filter<M: MulAdd>(a: Point, b: Point, c: Point, d: Point, q: Point) -> f64 {
    let [(ax, ay, az), (bx, by, bz), (cx, cy, cz), (dx, dy, dz)] =
        [a, b, c, d].map(|p| (p[0] - q[0], p[1] - q[1], p[2] - q[2]));
    let (ay_bx, by_cx, cy_dx) = (ay * bx, by * cx, cy * dx);
    let (ay_cx, by_dx, ay_dx) = (ay * cx, by * dx, ay * dx);
    let ab = M::mul_add(ax, by, -ay_bx);
    let bc = M::mul_add(bx, cy, -by_cx);
    let cd = M::mul_add(cx, dy, -cy_dx);
    let ac = M::mul_add(ax, cy, -ay_cx);
    let bd = M::mul_add(bx, dy, -by_dx);
    let ad = M::mul_add(ax, dy, -ay_dx);
    let a2 = M::mul_add(ax, ax, M::mul_add(ay, ay, az * az));
    let b2 = M::mul_add(bx, bx, M::mul_add(by, by, bz * bz));
    let c2 = M::mul_add(cx, cx, M::mul_add(cy, cy, cz * cz));
    let d2 = M::mul_add(dx, dx, M::mul_add(dy, dy, dz * dz));
    let bcd = M::mul_add(bz, cd, M::mul_add(-cz, bd, dz * bc));
    let cda = M::mul_add(az, cd, M::mul_add(dz, ac, -(cz * ad)));
    let dab = M::mul_add(az, bd, M::mul_add(dz, ab, -(bz * ad)));
    let abc = M::mul_add(az, bc, M::mul_add(-bz, ac, cz * ab));
    let det = M::mul_add(a2, bcd, -(b2 * cda)) + M::mul_add(c2, dab, -(d2 * abc));
    let (az, bz, cz, dz) = (az.abs(), bz.abs(), cz.abs(), dz.abs());
    let ab = M::mul_add(ax.abs(), by.abs(), ay_bx.abs());
    let bc = M::mul_add(bx.abs(), cy.abs(), by_cx.abs());
    let cd = M::mul_add(cx.abs(), dy.abs(), cy_dx.abs());
    let ac = M::mul_add(ax.abs(), cy.abs(), ay_cx.abs());
    let bd = M::mul_add(bx.abs(), dy.abs(), by_dx.abs());
    let ad = M::mul_add(ax.abs(), dy.abs(), ay_dx.abs());
    let bcd = M::mul_add(cz, bd, M::mul_add(bz, cd, dz * bc));
    let cda = M::mul_add(az, cd, M::mul_add(dz, ac, cz * ad));
    let dab = M::mul_add(bz, ad, M::mul_add(dz, ab, az * bd));
    let abc = M::mul_add(az, bc, M::mul_add(bz, ac, cz * ab));
    let permanent = M::mul_add(a2, bcd, b2 * cda) + M::mul_add(c2, dab, d2 * abc);
    certain::<M>(det, permanent, IN_SPHERE_ERROR)
}

#[inline(always)]
fn certain<M: MulAdd>(det: f64, permanent: f64, error: f64) -> f64 {
    // A comparison with NaN is false, as it must be.
    if det.abs() > M::mul_add(error, permanent, UNDERFLOW_ERROR) { det } else { 0.0 }
}
