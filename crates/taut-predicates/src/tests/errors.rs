//! The error bounds of the filter and of double-double, measured against the true error.
//!
//! The cases are made to round everywhere, with determinants from large down to far below the bound: a circle or a
//! sphere of lattice points with long coordinates through (R, 0), where the last coordinate of that point is any
//! small number instead of 0; D grows with its square.

use num_bigint::BigInt;
use num_traits::{Signed, ToPrimitive};

use crate::double_double;
use crate::number::{Difference, Measured, Polynomial};
use crate::plane::exact::{InCircle, relative as relative_plane};
use crate::space::exact::{InSphere, relative as relative_space};
use crate::tests::Random;
use crate::tests::oracle::{Exactly, integers_with_unit};

const U: f64 = f64::EPSILON / 2.0;

/// |hi + lo − m·2ᵉ| in parts of the permanent.
fn relative_error(parts: &[f64], truth: &BigInt, exponent: i32, permanent: f64) -> f64 {
    let (numbers, unit) = integers_with_unit(parts);
    let sum: BigInt = numbers.iter().sum();
    let (low, high) = (unit.min(exponent), unit.max(exponent));
    let error =
        if unit > exponent { (sum << (high - low)) - truth } else { sum - (truth << (high - low)) };
    // 64 leading bits are enough of it.
    let drop = error.bits().saturating_sub(64);
    let error = (error.abs() >> drop).to_f64().unwrap() * 2f64.powi(low + drop as i32);
    if error == 0.0 { 0.0 } else { error / permanent }
}

/// The largest error of the plain value in units of u, and of the double-double value in units of u².
fn worst<P: Polynomial<K>, const K: usize>(
    differences: &[Difference; K],
    truth: &BigInt,
    exponent: i32,
    worst: &mut [f64; 2],
) {
    let leaves = differences.map(|[from, less]| from - less);
    let plain = P::evaluate(&leaves.map(|d| Measured { value: d, permanent: d.abs() }));
    let error = relative_error(&[plain.value], truth, exponent, plain.permanent) / U;
    assert!(error < f64::from(P::ROUNDINGS), "{error} u: {differences:?}");
    worst[0] = worst[0].max(error);

    let double = double_double::evaluate::<P, K>(differences).expect("moderate magnitudes");
    let parts = [double.value.hi, double.value.lo];
    let error = relative_error(&parts, truth, exponent, double.permanent) / (U * U);
    assert!(error < f64::from(8 * P::ROUNDINGS), "{error} u²: {differences:?}");
    worst[1] = worst[1].max(error);
}

/// A lattice point of the circle of radius 5¹²·13⁴·17² ≈ 2⁵¹: the product of 24 factors 2 ± i, 8 factors 3 ± 2i and 4
/// factors 4 ± i.
fn long_circle(random: &mut Random) -> [f64; 2] {
    let mut z = (1i64, 0i64);
    for ((x, y), times) in [((2, 1), 24), ((3, 2), 8), ((4, 1), 4)] {
        for _ in 0..times {
            let y = y * random.pick(&[1, -1]);
            z = (z.0 * x - z.1 * y, z.0 * y + z.1 * x);
        }
    }
    [z.0 as f64, z.1 as f64]
}

#[test]
fn errors_stay_below_their_bounds_in_the_plane() {
    let (mut random, mut largest, mut near) = (Random(7), [0.0; 2], 0);
    for number in 0..60_000 {
        let mut points = [(); 4].map(|()| {
            if number % 2 == 0 {
                long_circle(&mut random)
            } else {
                [(); 2].map(|()| random.unit() * 2f64.powi(random.between(-30, 0) as i32))
            }
        });
        if number % 4 == 0 {
            let radius = 5f64.powi(12) * 13f64.powi(4) * 17f64.powi(2);
            points[0] = [radius, radius * 2f64.powi(random.between(-60, -20) as i32)];
        }
        let truth = Exactly::new(&points);
        let [a, b, c, q] = points;
        let differences = relative_plane([a, b, c], q);
        let determinant = truth.in_sphere();
        near += u64::from(double_double::sign::<InCircle, 6>(&differences).is_none());
        worst::<InCircle, 6>(&differences, &determinant, 4 * truth.unit, &mut largest);
    }
    assert!(largest[0] > 1.0 && largest[1] > 1.0, "{largest:?}");
    // A quarter of all are ties.
    assert!((16_000..25_000).contains(&near), "{near} undecided");
}

#[test]
fn errors_stay_below_their_bounds_in_space() {
    let (mut random, mut largest) = (Random(8), [0.0; 2]);
    for number in 0..40_000 {
        let mut points = [(); 5].map(|()| {
            if number % 2 == 0 {
                let ([x, y], z) = (long_circle(&mut random), random.pick(&[0.0, 1e3, 1e15 / 3.0]));
                [x, y, z]
            } else {
                [(); 3].map(|()| random.unit() * 2f64.powi(random.between(-30, 0) as i32))
            }
        });
        if number % 4 == 0 {
            points[0][2] *= 1.0 + f64::EPSILON * random.unit();
            points[1][2] += 2f64.powi(random.between(-120, -20) as i32);
        }
        let truth = Exactly::new(&points);
        let [a, b, c, d, q] = points;
        let differences = relative_space([a, b, c, d], q);
        let determinant = truth.in_sphere();
        worst::<InSphere, 12>(&differences, &determinant, 5 * truth.unit, &mut largest);
    }
    assert!(largest[0] > 1.0 && largest[1] > 1.0, "{largest:?}");
}
