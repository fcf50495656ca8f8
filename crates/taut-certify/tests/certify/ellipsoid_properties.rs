//! Random sets: the gap that is proved is the true one, by exact fractions; items inside are accepted, items outside are
//! not, however small the margin.

use common::ellipsoids::{
    Case, certify, certify_but, hash, orthonormal, solve, solved, transposed_product,
};
use common::{exact, normalized, numbers};
use num_rational::BigRational;
use num_traits::{ToPrimitive, Zero};
use proptest::prelude::*;
use taut_certify::{Items, Violation};

use crate::common;

/// det W of the head of the checker's lower bound, by fractions, and the largest |F(x − c)|² of all rows.
fn truth(case: &Case) -> (BigRational, BigRational) {
    let answer = &case.solution.answer;
    let certificate = &case.solution.certificate;
    let dim = answer.dim();
    let image = |row: &[f64]| -> Vec<BigRational> {
        let offset: Vec<BigRational> = (0..dim)
            .map(|j| {
                let tail = answer.center_tail.get(j).copied().unwrap_or(0.0);
                exact(row[j]) - exact(answer.center[j]) - exact(tail)
            })
            .collect();
        let dot = |f: &Vec<f64>| f.iter().zip(&offset).map(|(&f, x)| exact(f) * x).sum();
        answer.factor.iter().map(dot).collect()
    };
    let rows: Vec<Vec<BigRational>> = case.values.chunks(dim).map(image).collect();
    let weight: BigRational = certificate.multipliers.iter().map(|&u| exact(u)).sum();
    let rank = answer.rank();
    let mean = |of: &dyn Fn(&[BigRational]) -> BigRational| -> BigRational {
        let terms = certificate.support.iter().zip(&certificate.multipliers);
        terms.map(|(&i, &u)| exact(u) * of(&rows[i as usize])).sum::<BigRational>() / &weight
    };
    let means: Vec<BigRational> = (0..rank).map(|a| mean(&|y| y[a].clone())).collect();
    let mut matrix: Vec<Vec<BigRational>> = (0..rank)
        .map(|a| {
            let entry = |b: usize| mean(&|y| &y[a] * &y[b]) - &means[a] * &means[b];
            (0..rank).map(|b| exact(rank as f64) * entry(b)).collect()
        })
        .collect();
    let mut determinant = exact(1.0);
    for k in 0..rank {
        determinant *= &matrix[k][k];
        if matrix[k][k].is_zero() {
            break;
        }
        for i in k + 1..rank {
            let factor = &matrix[i][k] / &matrix[k][k];
            for j in k..rank {
                let step = &factor * &matrix[k][j];
                matrix[i][j] -= step;
            }
        }
    }
    let most = rows.iter().map(|y| y.iter().map(|y| y * y).sum()).max().unwrap();
    (determinant, most)
}

/// The gap that is true, to about 1e-16 absolutely, for one that is not large.
fn true_gap(case: &Case) -> f64 {
    let (determinant, most) = truth(case);
    let rank = case.solution.answer.rank() as f64;
    let log = |x: BigRational| match (&x - exact(1.0)).to_f64().unwrap() {
        beside_one if beside_one.abs() < 0.5 => beside_one.ln_1p(),
        _ => x.to_f64().unwrap().ln(),
    };
    -0.5 * log(determinant) + 0.5 * rank * log(most).max(0.0)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: crate::test_length::long_or(200, 80), ..ProptestConfig::default() })]

    /// Any multipliers over random points: what is proved is true, and no more than rounding above the truth.
    #[test]
    fn the_gap_is_the_true_one(dim in 1usize..5, extra in 0usize..6, seed in any::<u64>(), offset in prop_oneof![Just(0.0), Just(1e6)]) {
        let n = dim + 1 + extra;
        let values: Vec<f64> = numbers(n * dim, seed).iter().map(|v| v + offset).collect();
        let u = normalized(&numbers(n, seed ^ 1).iter().map(|v| 0.1 + v * v).collect::<Vec<_>>());
        let support: Vec<u64> = (0..n as u64).collect();
        let case = certify("random", &values, dim, &support, &u);
        let verdict = case.verdict();
        let truth = true_gap(&case);
        prop_assert!(verdict.gap >= truth * (1.0 - 4e-16), "{} below {truth}", verdict.gap);
        prop_assert!(verdict.gap <= truth * (1.0 + 2e-14) + 2e-14, "{} above {truth}", verdict.gap);
    }

    /// Good multipliers: the same, where the gap itself is small.
    #[test]
    fn small_gaps_are_true(dim in 1usize..4, extra in 0usize..5, seed in any::<u64>()) {
        let case = solved("solved", &numbers((dim + 1 + extra) * dim, seed), dim);
        let verdict = case.verdict();
        let truth = true_gap(&case);
        prop_assert!(verdict.gap <= 1e-7);
        prop_assert!(verdict.gap >= truth - 1e-30, "{} below {truth}", verdict.gap);
        prop_assert!(verdict.gap <= truth + 4e-15, "{} above {truth}", verdict.gap);
    }

    /// A row is accepted exactly where it reaches at most to the tolerance.
    #[test]
    fn rows_are_told_inside_from_outside(seed in any::<u64>(), margin in prop_oneof![Just(-1e-13), Just(5e-13), Just(2e-12), Just(1e-9), Just(1e-3)]) {
        let mut case = solved("solved", &numbers(24, seed), 3);
        let center = case.solution.answer.center.clone();
        let row = &case.values[3 * case.solution.certificate.support[0] as usize..][..3];
        let norm = case.solution.answer.norm(row);
        let outside: Vec<f64> =
            row.iter().zip(&center).map(|(x, c)| c + (x - c) * (1.0 + margin) / norm).collect();
        case.values.extend(outside);
        case.solution.certificate.points_hash = hash(&case.values, 3);
        case.solution.certificate.gap += 1e-11;
        if margin <= 5e-13 {
            let verdict = case.verdict();
            prop_assert!(verdict.excess >= margin - 1e-15 && verdict.excess <= 6e-13);
        } else {
            let found = matches!(case.violation(), Violation::OutsideEllipsoid { row: 8, .. });
            prop_assert!(found);
        }
    }

    /// Moving, stretching and shearing the space moves the ellipsoid along; the gap stays, and the log-volume shifts.
    #[test]
    fn affine_maps_change_nothing(seed in any::<u64>(), shift in -1e3f64..1e3, stretch in 1e-3f64..1e3, shear in -10f64..10.0) {
        let values = numbers(30, seed);
        let plain = solved("plain", &values, 2);
        let moved: Vec<f64> = values
            .chunks(2)
            .flat_map(|p| [stretch * p[0] + shear * p[1] + shift, p[1] - shift])
            .collect();
        let certificate = &plain.solution.certificate;
        let case = certify("moved", &moved, 2, &certificate.support, &certificate.multipliers);
        let (before, after) = (plain.verdict(), case.verdict());
        prop_assert!((before.gap - after.gap).abs() <= 1e-9, "{before:?} {after:?}");
        prop_assert!((after.lower - before.lower - stretch.ln()).abs() <= 1e-9, "{before:?} {after:?}");
    }

    /// Single precision holds the same numbers.
    #[test]
    fn single_precision_is_read_as_it_is(seed in any::<u64>()) {
        let single: Vec<f32> = numbers(40, seed).iter().map(|&v| v as f32).collect();
        let values: Vec<f64> = single.iter().map(|&v| v.into()).collect();
        let case = solved("single", &values, 4);
        let points = taut_points::Points::new(&single, 4).unwrap();
        prop_assert_eq!(case.solution.check(&points).unwrap(), case.verdict());
    }

    /// Balls of radius 0 and ellipsoids of shape 0 are points.
    #[test]
    fn items_without_extent_are_points(seed in any::<u64>()) {
        let values = numbers(36, seed);
        let plain = solved("points", &values, 3);
        for items in [Items::Balls, Items::Ellipsoids] {
            let mut case = plain.clone();
            case.columns = items.columns(3);
            let pad = case.columns - 3;
            case.values = values.chunks(3).flat_map(|p| p.iter().copied().chain(vec![0.0; pad])).collect();
            let certificate = &mut case.solution.certificate;
            certificate.items = items;
            certificate.directions = vec![vec![1.0, 2.0, 3.0]; certificate.support.len()];
            certificate.points_hash = hash(&case.values, case.columns);
            let (shaped, plain) = (case.verdict(), plain.verdict());
            prop_assert_eq!((shaped.lower, shaped.upper, shaped.gap), (plain.lower, plain.upper, plain.gap));
            prop_assert!((shaped.matrix_excess / plain.matrix_excess - 1.0).abs() <= 1e-14);
        }
    }
}

/// A factor need not be triangular: turned by any rotation it describes the same ellipsoid, also where axes differ by
/// many orders of magnitude.
#[test]
fn any_factor_will_do() {
    for (dim, ratio) in [(2, 1.0), (3, 1e4), (5, 1e2), (8, 10.0)] {
        let stretch = |i: usize| f64::powi(ratio, (i % dim) as i32);
        let values: Vec<f64> =
            numbers(6 * dim * dim, 31).iter().enumerate().map(|(i, v)| v * stretch(i)).collect();
        let plain = solved("plain", &values, dim);
        let rotation = orthonormal(&numbers(dim * dim, 32), dim, dim);
        let mut turned = plain.clone();
        let answer = &mut turned.solution.answer;
        answer.factor = rotation
            .iter()
            .map(|r| {
                let entry =
                    |k: usize| (0..dim).map(|a| r[a] * plain.solution.answer.factor[a][k]).sum();
                (0..dim).map(entry).collect()
            })
            .collect();
        answer.matrix = transposed_product(&answer.factor, dim);
        turned.solution.certificate.gap += 1e-10;
        let (plain, found) = (plain.verdict(), turned.verdict());
        assert!((plain.upper - found.upper).abs() <= 1e-10, "{dim}: {plain:?} {found:?}");
        assert!((plain.gap - found.gap).abs() <= 1e-10, "{dim}: {plain:?} {found:?}");
        turned.solution.answer.log_volume += 1e-9;
        assert!(matches!(turned.violation(), Violation::LogVolume { .. }));
    }
}

/// A certificate that leaves rows out is a part of a robust fit; by itself it would pass for an ellipsoid around all.
#[test]
fn an_ellipsoid_that_leaves_rows_out_is_refused() {
    let inside = numbers(30, 13);
    let (support, u) = solve(&inside, 2);
    let values = [&[9.0, 9.0][..], &inside, &[-7.0, 2.0, 0.0, 30.0]].concat();
    let support: Vec<u64> = support.iter().map(|i| i + 1).collect();
    let case = certify_but("outliers", &values, 2, &support, &u, &[0, 16, 17]);
    assert!(matches!(case.violation(), Violation::LeftOut { position: 0, row: 0, .. }));
    let mut silent = case;
    silent.solution.certificate.left_out.clear();
    assert!(matches!(silent.violation(), Violation::OutsideEllipsoid { row: 0, .. }));
}
