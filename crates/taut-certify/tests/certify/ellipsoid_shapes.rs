//! Balls and ellipsoids as items: reach by brute force, bounds by points of the items, closed forms.

use common::ellipsoids::{Case, dot, hash, log_unit_ball, solve, transposed_product};
use common::{normalized, numbers};
use proptest::prelude::*;
use taut_certify::{Ellipsoid, EllipsoidCertificate, Items, Solution, Trace, Violation};

use crate::common;

/// An axis-parallel ellipsoid about the origin as the answer for the items given.
fn aligned(
    items: Items,
    values: &[f64],
    axes: &[f64],
    support: &[u64],
    multipliers: &[f64],
    directions: &[Vec<f64>],
    gap: f64,
) -> Case {
    let dim = axes.len();
    let factor: Vec<Vec<f64>> = (0..dim)
        .map(|j| (0..dim).map(|k| if j == k { 1.0 / axes[j] } else { 0.0 }).collect())
        .collect();
    let columns = items.columns(dim);
    let solution = Solution {
        answer: Ellipsoid {
            center: vec![0.0; dim],
            center_tail: vec![],
            matrix: transposed_product(&factor, dim),
            factor,
            hull: None,
            log_volume: log_unit_ball(dim) + axes.iter().map(|a| a.ln()).sum::<f64>(),
        },
        certificate: EllipsoidCertificate {
            items,
            support: support.to_vec(),
            multipliers: multipliers.to_vec(),
            directions: directions.to_vec(),
            left_out: vec![],
            gap,
            points_hash: hash(values, columns),
        },
        trace: Trace::default(),
    };
    Case { name: format!("{items:?}"), values: values.to_vec(), columns, solution }
}

/// ±eⱼ.
fn signed_units(dim: usize) -> Vec<Vec<f64>> {
    let unit = |i: usize| {
        (0..dim).map(|j| if i / 2 == j { 1.0 - 2.0 * (i % 2) as f64 } else { 0.0 }).collect()
    };
    (0..2 * dim).map(unit).collect()
}

/// A center and the lower triangle of diag(axes²).
fn row(center: &[f64], axes: &[f64]) -> Vec<f64> {
    let mut row = center.to_vec();
    for j in 0..axes.len() {
        row.extend((0..=j).map(|k| if j == k { axes[j] * axes[j] } else { 0.0 }));
    }
    row
}

#[test]
fn one_ellipsoid_is_its_own_hull() {
    for axes in [vec![2.0], vec![1.0, 4.0], vec![0.5, 8.0, 1024.0]] {
        let dim = axes.len();
        let values = row(&vec![0.0; dim], &axes);
        let u = vec![0.5 / dim as f64; 2 * dim];
        let support = vec![0; 2 * dim];
        let case =
            aligned(Items::Ellipsoids, &values, &axes, &support, &u, &signed_units(dim), 0.0);
        let verdict = case.verdict();
        assert!(verdict.gap <= 1e-15 * dim as f64 && verdict.excess <= 1e-15, "{verdict:?}");
    }
}

#[test]
fn balls_and_round_ellipsoids_are_the_same() {
    let dim = 3;
    let units = signed_units(dim);
    let radius = 0.25;
    let balls: Vec<f64> = units.iter().flat_map(|e| e.iter().copied().chain([radius])).collect();
    let round: Vec<f64> = units.iter().flat_map(|e| row(e, &vec![radius; dim])).collect();
    let support: Vec<u64> = (0..2 * dim as u64).collect();
    let u = vec![0.5 / dim as f64; 2 * dim];
    for (items, values) in [(Items::Balls, balls), (Items::Ellipsoids, round)] {
        let case = aligned(items, &values, &[1.25; 3], &support, &u, &units, 1e-14);
        let verdict = case.verdict();
        assert!(verdict.gap <= 4e-15 && verdict.excess <= 1e-15, "{verdict:?}");
        let wrong = aligned(items, &values, &[1.25, 1.25, 1.2499], &support, &u, &units, 1e-3);
        assert!(matches!(wrong.violation(), Violation::OutsideEllipsoid { row: 4, .. }));
        // Directions that point inwards touch at the far sides, and prove less.
        let inward: Vec<Vec<f64>> = units.iter().map(|e| e.iter().map(|v| -v).collect()).collect();
        let wrong = aligned(items, &values, &[1.25; 3], &support, &u, &inward, 1e-14);
        let expected = 3.0 * (1.25f64 / 0.75).ln();
        match wrong.violation() {
            Violation::LogGap { proved, .. } => assert!((proved - expected).abs() < 1e-13),
            other => panic!("{other}"),
        }
    }
}

#[test]
fn shapes_that_are_none_are_refused() {
    let good = row(&[0.0, 0.0], &[1.0, 1.0]);
    let mut bad = good.clone();
    bad[3] = 1.5;
    let units = signed_units(2);
    let values = [good, bad].concat();
    let case = aligned(Items::Ellipsoids, &values, &[1.0, 1.0], &[0; 4], &[0.25; 4], &units, 1e-12);
    assert!(matches!(case.violation(), Violation::NegativeShape { row: 1 }));
    let balls = [0.0, 0.0, 1.0, 0.5, 0.0, -0.5];
    let case = aligned(Items::Balls, &balls, &[1.0, 1.0], &[0; 4], &[0.25; 4], &units, 1e-12);
    assert!(matches!(case.violation(), Violation::NegativeRadius { row: 1, value: -0.5 }));
    let mut case = case;
    case.solution.certificate.items = Items::Ellipsoids;
    assert!(matches!(case.violation(), Violation::NoShape { columns: 3 }));
}

/// |F(x − c)| over many points of the border of an ellipsoid, climbing from each: x ← the point farthest in the direction
/// in which |F(x − c)| grows fastest. Then from the opposite point, as one maximum may be less than the greatest, and lies on its own side.
fn reach_by_climbing(answer: &Ellipsoid, center: &[f64], root: &[Vec<f64>], seed: u64) -> f64 {
    let dim = center.len();
    let mut best: f64 = 0.0;
    for start in numbers(12 * dim, seed).chunks(dim) {
        let mut w = start.to_vec();
        for step in 0..4000 {
            if step == 2000 {
                w.iter_mut().for_each(|v| *v = -*v);
            }
            let length = dot(&w, &w).sqrt();
            w.iter_mut().for_each(|v| *v /= length);
            let point: Vec<f64> = (0..dim).map(|j| center[j] + dot(&root[j], &w)).collect();
            best = best.max(answer.norm(&point));
            let offset: Vec<f64> = point.iter().zip(&answer.center).map(|(x, c)| x - c).collect();
            let slope: Vec<f64> = answer.matrix.iter().map(|q| dot(q, &offset)).collect();
            w = (0..dim).map(|k| (0..dim).map(|j| root[j][k] * slope[j]).sum()).collect();
        }
    }
    best
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: crate::test_length::long_or(60, 25), ..ProptestConfig::default() })]

    /// A random ellipsoid within the unit ball, scaled so that it just touches: accepted, and refused when 1e-6 larger.
    #[test]
    fn the_reach_is_that_of_brute_force(dim in 1usize..6, seed in any::<u64>(), flat in any::<bool>(), centered in any::<bool>()) {
        let random = numbers(dim * dim + dim, seed);
        let mut root: Vec<Vec<f64>> = random[..dim * dim].chunks(dim).map(<[f64]>::to_vec).collect();
        if flat {
            root.iter_mut().for_each(|row| row[dim - 1] = 0.0);
        }
        let center: Vec<f64> =
            random[dim * dim..].iter().map(|v| if centered { 0.0 } else { *v }).collect();
        let unit = aligned(Items::Points, &vec![0.0; dim], &vec![1.0; dim], &[0], &[1.0], &[], 0.0).solution.answer;
        let reach = reach_by_climbing(&unit, &center, &root, seed ^ 5);
        prop_assume!(reach > 1e-3);
        for (factor, inside) in [(1.0 - 1e-9, true), (1.0 + 1e-6, false)] {
            let scale = factor / reach;
            let mut values: Vec<f64> = center.iter().map(|c| c * scale).collect();
            for j in 0..dim {
                values.extend((0..=j).map(|k| dot(&root[j], &root[k]) * scale * scale));
            }
            let u = vec![0.5 / dim as f64; 2 * dim];
            let case = aligned(Items::Ellipsoids, &values, &vec![1.0; dim], &vec![0; 2 * dim], &u, &signed_units(dim), 1e3);
            let refused = match case.check() {
                Err(taut_certify::CheckError::Rejected(Violation::OutsideEllipsoid { excess, .. })) => {
                    prop_assert!((excess - 1e-6).abs() <= 1e-8, "{excess}");
                    true
                }
                _ => false,
            };
            prop_assert_eq!(refused, !inside);
        }
    }

    /// The points where ellipsoids touch, as a set of points of its own, prove the same bound.
    #[test]
    fn a_bound_by_touching_points_is_that_of_the_points(dim in 1usize..4, seed in any::<u64>()) {
        let n = 2 * dim + 2;
        let random = numbers(n * (dim + dim + dim), seed);
        let mut values = Vec::new();
        let mut points = Vec::new();
        let mut directions = Vec::new();
        for item in random.chunks(3 * dim) {
            let (center, rest) = item.split_at(dim);
            let (axes, direction) = rest.split_at(dim);
            values.extend(row(center, axes));
            let q: f64 = axes.iter().zip(direction).map(|(a, n)| (a * n).powi(2)).sum();
            points.extend((0..dim).map(|j| center[j] + axes[j] * axes[j] * direction[j] / q.sqrt()));
            directions.push(direction.iter().map(|v| v * 1e3).collect::<Vec<f64>>());
        }
        let (support, u) = solve(&points, dim);
        let chosen: Vec<Vec<f64>> = support.iter().map(|&i| directions[i as usize].clone()).collect();
        let big = vec![8.0; dim];
        let items = aligned(Items::Ellipsoids, &values, &big, &support, &u, &chosen, 1e3).verdict();
        let alone = aligned(Items::Points, &points, &big, &support, &u, &[], 1e3).verdict();
        prop_assert!((items.gap - alone.gap).abs() <= 1e-12 * (1.0 + alone.gap), "{items:?} {alone:?}");
    }
}

/// Two discs of different size: the smallest ellipse is symmetric about the line of their centers, and any certificate
/// is at least as large as what its own touching points say.
#[test]
fn weights_that_favor_one_side_prove_less() {
    let units = signed_units(2);
    let values: Vec<f64> = units.iter().flat_map(|e| row(e, &[0.5, 0.5])).collect();
    let support = [0, 1, 2, 3];
    let best = aligned(Items::Ellipsoids, &values, &[1.5, 1.5], &support, &[0.25; 4], &units, 1e3);
    let skew = normalized(&[1.0, 2.0, 3.0, 4.0]);
    let worse = aligned(Items::Ellipsoids, &values, &[1.5, 1.5], &support, &skew, &units, 1e3);
    assert!(best.verdict().gap < 1e-14 && worse.verdict().gap > 0.05);
}
