//! Sets that lie at the limits of `f64` or of what a scatter is: whatever is answered passes the checker.

use robust::{by, contaminated, normal};
use taut_certify::RobustMethod;
use taut_enclose::{RobustOptions, robust_ellipsoid};
use taut_points::Points;

use crate::robust;

/// Each row made of the row of normal numbers and its number.
fn rows(n: usize, dim: usize, seed: u64, row: impl Fn(usize, &[f64]) -> Vec<f64>) -> Vec<f64> {
    normal(n, dim, seed).chunks(dim).enumerate().flat_map(|(i, x)| row(i, x)).collect()
}

fn sets() -> Vec<(&'static str, usize, Vec<f64>)> {
    let scaled = |by: [f64; 2]| rows(40, 2, 1, move |_, x| vec![x[0] * by[0], x[1] * by[1]]);
    let far = |by: f64| rows(60, 2, 2, move |_, x| vec![by + x[0], by + x[1]]);
    let thin = |by: f64| rows(60, 2, 3, move |_, x| vec![x[0], x[0] + by * x[1]]);
    vec![
        ("one", 2, vec![1.0, 2.0]),
        ("two", 2, vec![1.0, 2.0, 3.0, 4.0]),
        ("copies", 2, [1.0, 2.0].repeat(20)),
        ("copies and others", 2, [[1.0, 2.0].repeat(20), normal(15, 2, 4)].concat()),
        ("a line and others", 2, {
            let line = (0..30).flat_map(|i| [f64::from(i) * 0.1, f64::from(i) * 0.3 + 0.7]);
            line.chain(normal(20, 2, 5).iter().map(|v| 10.0 * v)).collect()
        }),
        ("grid", 2, (0..25).flat_map(|i| [f64::from(i % 5), f64::from(i / 5)]).collect()),
        ("large", 2, scaled([1e140, 1e140])),
        ("small", 2, scaled([1e-140, 1e-140])),
        ("large and small", 2, scaled([1e-70, 1e70])),
        ("at 1e8", 2, far(1e8)),
        ("at 1e12", 2, far(1e12)),
        ("at 1e13", 2, far(1e13)),
        ("thin", 2, thin(1e-6)),
        ("thinner", 2, thin(1e-9)),
        ("as thin as may be", 2, thin(1e-11)),
        ("as thin as rounding", 2, thin(1e-13)),
        ("numbers", 1, normal(50, 1, 6)),
        ("few numbers, many times", 1, rows(50, 1, 7, |i, _| vec![(i % 4) as f64])),
        ("ties", 3, normal(60 * 3, 1, 8).iter().map(|v| v.round()).collect()),
        ("more columns than rows", 10, normal(6, 10, 9)),
        ("heavy tails", 4, {
            let below = normal(200, 4, 11);
            normal(200, 4, 10).iter().zip(below).map(|(a, b)| a / b.abs().max(1e-300)).collect()
        }),
        ("a constant column", 3, rows(40, 2, 12, |_, x| vec![x[0], 7.0, x[1]])),
        ("a plane and others", 3, {
            let plane = rows(40, 2, 13, |_, x| vec![x[0], x[1], x[0] + x[1]]);
            [plane, normal(12, 3, 14)].concat()
        }),
        ("as many as dimensions", 3, normal(4, 3, 15)),
        ("contaminated", 3, contaminated(90, 3, 40, 9.0, 16)),
    ]
}

#[test]
fn whatever_is_answered_is_proved() {
    let mut refused = vec![];
    for (name, dim, values) in sets() {
        let points = Points::new(&values, dim).unwrap();
        for method in RobustMethod::ALL {
            let base = by(method);
            let options = [
                RobustOptions { coverage: Some(0.75), level: 1.0 - 1e-10, ..base.clone() },
                RobustOptions { level: 0.5, epsilon: 0.01, ..base.clone() },
                base.clone(),
                RobustOptions { coverage: Some(1.0), ..base.clone() },
                RobustOptions { coverage: Some(0.6), epsilon: 1e-4, ..base },
            ];
            for options in options.into_iter().take(crate::test_length::long_or(5, 1)) {
                match robust_ellipsoid(&points, &options) {
                    Ok(found) => {
                        if let Err(error) = found.check(&points) {
                            refused.push(format!("{name} by {method}, {options:?}: {error}"));
                        }
                    }
                    Err(other) => panic!("{name}: {other}"),
                }
            }
        }
    }
    assert!(refused.is_empty(), "{refused:#?}");
}

/// Returns what is wrong with an answer to a set that has one, in words; nothing if the checker passes it.
fn refusal(name: &str, values: &[f64], dim: usize, options: &RobustOptions<'_>) -> Option<String> {
    let points = Points::new(values, dim).unwrap();
    let verdict = match robust_ellipsoid(&points, options) {
        Ok(found) => found.check(&points).err()?.to_string(),
        Err(error) => error.to_string(),
    };
    Some(format!("{name} by {}, {:?}: {verdict}", options.method, options.coverage))
}

fn by_all(name: &str, values: &[f64], dim: usize, coverages: &[f64]) -> Vec<String> {
    let cases = RobustMethod::ALL.into_iter().flat_map(|method| {
        coverages.iter().map(move |&part| RobustOptions { coverage: Some(part), ..by(method) })
    });
    cases.filter_map(|options| refusal(name, values, dim, &options)).collect()
}

#[test]
fn copies_that_leave_few_places_are_an_exact_fit() {
    // Rows by the number of copies of each place.
    let copies = |places: &[(&[f64], usize)]| -> Vec<f64> {
        places.iter().flat_map(|(place, count)| place.repeat(*count)).collect()
    };
    let corners = copies(&[
        (&[0.0, 0.0, 0.0], 4),
        (&[0.0, 0.0, 1.0], 10),
        (&[1.0, 0.0, 0.0], 2),
        (&[0.0, 1.0, 0.0], 1),
    ]);
    let tenths = copies(&[
        (&[0.1, 0.0, 0.0], 1),
        (&[0.2, 0.0, 0.2], 1),
        (&[0.1, 0.1, 0.0], 1),
        (&[0.2, 0.0, 0.1], 1),
        (&[0.0, 0.0, 0.0], 1),
        (&[0.0, 0.0, 0.1], 1),
        (&[0.0, 0.0, 0.0], 5),
        (&[0.0, 0.2, 0.2], 1),
        (&[0.0, 0.0, 0.0], 5),
        (&[0.0, 0.0, 0.2], 1),
    ]);
    let line: Vec<f64> = (0..6).flat_map(|i| [f64::from(i), f64::from(3 * i)].repeat(30)).collect();
    // Corners of a cube in six dimensions that lie in a flat, and most of them in one of fewer dimensions.
    let bits: [u32; 8] =
        [0b000110, 0b001000, 0b010100, 0b010110, 0b011110, 0b100001, 0b110001, 0b110011];
    let cube: Vec<f64> =
        bits.iter().flat_map(|row| (0..6).rev().map(move |j| f64::from(row >> j & 1))).collect();
    let some = crate::test_length::long_or(&[0.5, 0.75, 0.9, 1.0][..], &[0.5, 0.9]);
    let mut refused = by_all("corners", &corners, 3, some);
    refused.extend(by_all("tenths", &tenths, 3, some));
    refused.extend(by_all("line", &line, 2, some));
    refused.extend(by_all(
        "cube",
        &cube,
        6,
        crate::test_length::long_or(&[0.5, 0.65, 0.75, 0.9, 1.0][..], &[0.65, 0.9]),
    ));
    assert!(refused.is_empty(), "{refused:#?}");
}

#[test]
fn lattices_are_fitted_or_laid_flat() {
    let mut refused = vec![];
    let mut state = 1u64;
    let mut lot = |below: u64| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) % below
    };
    for which in 0..crate::test_length::long_or(400, 6) {
        let (dim, n) = (1 + lot(7) as usize, 8 + lot(23) as usize);
        let (levels, unit) = (2 + lot(2), [1.0, 0.1, 1.0 / 3.0, 1e8][lot(4) as usize]);
        // Rows that are 0 but for the last columns, so that many are copies.
        let (zeros, part) = (lot(dim as u64 + 1) as usize, lot(4));
        let values: Vec<f64> = (0..n)
            .flat_map(|_| {
                let is_zero = lot(6) < part;
                let mut row: Vec<f64> = (0..dim).map(|_| unit * lot(levels) as f64).collect();
                if is_zero {
                    row[..zeros].fill(0.0);
                }
                row
            })
            .collect();
        let coverage = 0.5 + lot(11) as f64 / 20.0;
        refused.extend(by_all(&format!("lattice {which}"), &values, dim, &[coverage]));
    }
    assert!(refused.is_empty(), "{} {refused:#?}", refused.len());
}

#[test]
fn columns_may_be_of_any_ratio() {
    let mut refused = vec![];
    for power in [80, 100, 120, 140] {
        let by = 10f64.powi(power);
        let values = rows(50, 2, 20, |_, x| vec![x[0] * by, x[1] / by]);
        refused.extend(by_all(&format!("1e{power}"), &values, 2, &[0.5, 0.75, 1.0]));
    }
    assert!(refused.is_empty(), "{refused:#?}");
}
