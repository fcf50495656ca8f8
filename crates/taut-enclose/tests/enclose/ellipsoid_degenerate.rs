//! Ellipsoids of what is not in general position, of any size, and of what has no ellipsoid.

use ellipsoids::{by, exact, log_unit_ball, mapped, normal, rotation, shell, uniform};
use taut_enclose::{EllipsoidMethod, EllipsoidOptions, Error, ellipsoid};
use taut_points::{InputError, Points};

use crate::ellipsoids;
use crate::test_length::long_or;

const GAP: f64 = 1e-12;

#[test]
fn a_single_point_is_its_own_ellipsoid() {
    for copies in [1, 2, 1000] {
        for point in [[0.0, 0.0, 0.0], [1.5, -2.0, 1e8], [1e-150, 1e150, 3.0]] {
            let values: Vec<f64> = (0..copies).flat_map(|_| point).collect();
            let found = exact("one point", &values, 3, GAP);
            assert_eq!(found.answer.center, point);
            assert_eq!((found.answer.rank(), found.answer.log_volume), (0, 0.0));
            assert_eq!(found.answer.hull.unwrap().distance, 0.0);
        }
    }
}

#[test]
fn on_a_line_the_ends_matter() {
    for (dim, offset) in [(1, 0.0), (1, 1e8), (2, 0.0), (5, 0.0), (3, 1e8)] {
        let direction: Vec<f64> = (0..dim).map(|j| 1.0 + j as f64).collect();
        let length = direction.iter().map(|v| v * v).sum::<f64>().sqrt();
        let values: Vec<f64> = (0..50)
            .flat_map(|k| {
                let t = f64::from((k * 7) % 50) - 10.0;
                direction.iter().map(move |v| v * t + offset).collect::<Vec<_>>()
            })
            .collect();
        let found = exact("a line", &values, dim, GAP);
        assert_eq!(found.answer.rank(), 1, "dimension {dim}, offset {offset}");
        let difference = found.answer.log_volume - (49.0 * length).ln();
        assert!(difference.abs() < 1e-10, "dimension {dim}, offset {offset}: {difference:e}");
        assert_eq!(found.answer.hull.is_some(), dim > 1);
        if let Some(hull) = found.answer.hull {
            assert!(hull.distance <= 1e-14 * (1e3 + offset), "{:e}", hull.distance);
        }
    }
}

#[test]
fn fewer_points_than_dimensions_span_a_simplex() {
    for dim in [2, 3, 6, 12] {
        for n in 2..=dim {
            let values = normal(n, dim, 5);
            let found = exact(&format!("{n} points in {dim} dimensions"), &values, dim, GAP);
            assert_eq!(found.answer.rank(), n - 1);
            assert!(
                found.certificate.multipliers.iter().all(|u| (u * n as f64 - 1.0).abs() < 1e-12)
            );
        }
    }
}

/// Rounding makes rows of F lean out of the hull, and where axes are of very different lengths, points far along it see that.
#[test]
fn what_leaning_out_of_a_hull_costs_is_claimed() {
    let tetrahedron = [
        [-2.384185791015625e-7, 0.0, -1.9073486328125e-6, 1.0],
        [0.125, 0.0, -7.450580596923828e-9, -201326592.0],
        [0.0, 9.313225746154785e-10, 0.0, 0.0],
        [2.384185791015625e-7, 1.1920928955078125e-7, 0.0, -0.046875],
    ];
    let mut sets = vec![(tetrahedron.as_flattened().to_vec(), 4)];
    for (seed, dim) in (0..long_or(2000, 200)).map(|seed| (seed, 3 + seed as usize % 3)) {
        // Three points: a triangle in its plane, with sides from 2⁻³⁰ to 2³⁰.
        let sizes = uniform(3 * dim, seed);
        let digits = uniform(3 * dim, seed + 10_000);
        let coordinate = |(size, digit): (&f64, &f64)| {
            (digit * 7.0 - 3.5).round() * ((size * 60.0).round() - 30.0).exp2()
        };
        sets.push((sizes.iter().zip(&digits).map(coordinate).collect(), dim));
    }
    for (k, (values, dim)) in sets.iter().enumerate() {
        let points = Points::new(values, *dim).unwrap();
        for method in [EllipsoidMethod::Newton, EllipsoidMethod::ThesisCoreSet] {
            let found = ellipsoid(&points, &by(method, 0.1)).unwrap();
            found.check(&points).unwrap_or_else(|error| panic!("{k}, {method:?}: {error}"));
        }
    }
}

#[test]
fn flat_sets_are_solved_in_their_hull() {
    for (dim, rank) in [(3, 2), (5, 2), (8, 7), (6, 3)] {
        for offset in [0.0, 3.0, 1e6] {
            // An isometry of ℝʳ into ℝᵈ keeps the volume.
            let inner = normal(5000, rank, 11);
            let turn: Vec<f64> =
                rotation(dim, 6).chunks(dim).flat_map(|row| row[..rank].to_vec()).collect();
            let values = mapped(&inner, &turn, &vec![offset; dim]);
            let wanted = exact("in its own space", &inner, rank, GAP).answer.log_volume;
            let name = format!("rank {rank} of {dim}, offset {offset}");
            let found = exact(&name, &values, dim, 1e-9);
            assert_eq!(found.answer.rank(), rank, "{name}");
            let difference = found.answer.log_volume - wanted;
            assert!(difference.abs() < 1e-8, "{name}: {difference:e}");
            let distance = found.answer.hull.unwrap().distance;
            assert!(distance < 1e-13 * (100.0 + offset), "{name}: {distance:e}");
        }
    }
}

#[test]
fn coordinates_that_never_change_or_follow_others_lower_the_rank() {
    let inner = normal(300, 2, 3);
    let values: Vec<f64> =
        inner.chunks(2).flat_map(|p| [p[0], 7.0, p[1], p[0] + p[1], 0.0, p[0] * 1e-9]).collect();
    let found = exact("two of six", &values, 6, GAP);
    assert_eq!(found.answer.rank(), 2);
}

/// All but one point in a plane, and more points than a sample: the one decides the rank.
#[test]
fn one_point_beside_a_plane_is_found() {
    let mut values: Vec<f64> =
        normal(20_000, 2, 8).chunks(2).flat_map(|p| [p[0], p[1], p[0] - p[1]]).collect();
    values[3 * 12_345 + 2] += 1e-3;
    // One axis is a thousandth of the others: leverages in `f64` are right to 1e-12.
    let found = exact("a plane and a point", &values, 3, 1e-11);
    assert_eq!(found.answer.hull, None);
    assert!(found.certificate.support.contains(&12_345));
    let mut constant = normal(20_000, 3, 8);
    constant.iter_mut().skip(1).step_by(3).for_each(|v| *v = 0.25);
    constant[3 * 777 + 1] = 0.5;
    let found = exact("one of a constant column", &constant, 3, GAP);
    assert_eq!((found.answer.rank(), found.certificate.support.contains(&777)), (3, true));
}

#[test]
fn offsets_and_scales_do_not_matter() {
    let plain = normal(2000, 4, 2);
    let wanted = exact("plain", &plain, 4, GAP).answer.log_volume;
    for (scale, offset) in [
        (1.0, 1e8),
        (1e150, 0.0),
        (1e-150, 0.0),
        (1e120, 1e125),
        (1e-120, 1e-115),
        (1e-3, 1e6),
        (1.0, -1e3),
    ] {
        let values: Vec<f64> = plain.iter().map(|v| v * scale + offset).collect();
        let found = exact(&format!("scale {scale}, offset {offset}"), &values, 4, GAP);
        let difference = found.answer.log_volume - wanted - 4.0 * f64::ln(scale);
        // Adding an offset rounds the points.
        let rounded = 1e-15 * (1.0 + offset.abs() / scale) + 1e-12;
        assert!(
            difference.abs() < 10.0 * rounded,
            "scale {scale}, offset {offset}: {difference:e}"
        );
    }
    // Each coordinate with units of its own.
    let values: Vec<f64> =
        plain.chunks(4).flat_map(|p| [p[0] * 1e60, p[1] * 1e-60, p[2] * 1e3 + 1e9, p[3]]).collect();
    let found = exact("mixed units", &values, 4, GAP);
    let difference = found.answer.log_volume - wanted - 1e3f64.ln();
    assert!(difference.abs() < 1e-10, "{difference:e}");
}

#[test]
fn few_different_points_and_many_copies() {
    // All copies of two vertices are the farthest 64 points of many.
    for dim in [2, 5, 10] {
        let corners = uniform(20_000, 3);
        let values: Vec<f64> = corners
            .iter()
            .flat_map(|&r| {
                let k = (r * r * f64::from(1u32 << dim)) as usize;
                (0..dim).map(move |j| if k >> j & 1 == 0 { -1.0 } else { 1.0 })
            })
            .collect();
        let d = dim as f64;
        let found = exact(&format!("copies of the {dim}-cube"), &values, dim, GAP);
        let full = (log_unit_ball(dim) + 0.5 * d * d.ln() - found.answer.log_volume).abs();
        assert!(full < 2e-12, "{full:e}");
    }
    for dim in [6, 8, 10, 12] {
        let values: Vec<f64> = uniform(20_000, 8)
            .iter()
            .flat_map(|t| (1..=dim).map(move |k| (2.0 * t - 1.0).powi(k)))
            .collect();
        exact(&format!("moment curve of dimension {dim}"), &values, dim as usize, GAP);
    }
}

#[test]
fn thin_shells_reach_the_gap() {
    for dim in [2, 3, 5, 10] {
        for thickness in [1e-2, 1e-4, 1e-8, 1e-12] {
            exact(&format!("shell {dim}, {thickness}"), &shell(4000, dim, thickness, 7), dim, GAP);
        }
    }
}

#[test]
fn heavy_tails_reach_the_gap() {
    for (n, dim) in [(10_000, 3), (10_000, 10), (3000, 20)] {
        let (a, b) = (normal(n, dim, 1), normal(n, dim, 2));
        let values: Vec<f64> = a.iter().zip(&b).map(|(a, b)| a / b).collect();
        exact(&format!("cauchy {n} × {dim}"), &values, dim, GAP);
        let wild: Vec<f64> = values.iter().map(|v| v * v * v * v * v).collect();
        exact(&format!("fifth powers of it {n} × {dim}"), &wild, dim, 1e-9);
    }
}

#[test]
fn what_is_not_finite_is_named() {
    let mut values = normal(50_000, 3, 4);
    values[3 * 40_000 + 2] = f64::NAN;
    values[3 * 45_000] = f64::INFINITY;
    for method in EllipsoidMethod::ALL {
        let options = EllipsoidOptions { method, ..Default::default() };
        let refused = ellipsoid(&Points::new(&values, 3).unwrap(), &options);
        assert!(
            matches!(refused, Err(Error::Input(InputError::NonFinite { row: 40_000, column: 2, value })) if value.is_nan()),
            "{method:?}: {refused:?}"
        );
    }
    values[4] = f64::NEG_INFINITY;
    let refused = ellipsoid(&Points::new(&values, 3).unwrap(), &EllipsoidOptions::default());
    assert!(matches!(refused, Err(Error::Input(InputError::NonFinite { row: 1, column: 1, .. }))));
    let none: Vec<f64> = vec![];
    let refused = ellipsoid(&Points::new(&none, 3).unwrap(), &EllipsoidOptions::default());
    assert!(matches!(refused, Err(Error::Empty)));
}

#[test]
fn sizes_beyond_double_precision_are_refused() {
    let plain = normal(100, 2, 4);
    for scale in [1e200, 1e-200, 1e307, 1e-307, 5e-324] {
        let values: Vec<f64> = plain.iter().map(|v| v * scale).collect();
        let refused = ellipsoid(&Points::new(&values, 2).unwrap(), &EllipsoidOptions::default());
        assert!(matches!(refused, Err(Error::Overflow)) || scale == 5e-324, "{scale}: {refused:?}");
    }
}

#[test]
fn options_out_of_range_are_named() {
    let points = [0.0, 1.0];
    let points = Points::new(&points, 1).unwrap();
    let refused = |options: EllipsoidOptions<'_>| match ellipsoid(&points, &options) {
        Err(Error::Input(InputError::Option { name, .. })) => name,
        other => panic!("{other:?}"),
    };
    for epsilon in [-1e-9, 1.0, f64::NAN] {
        assert_eq!(refused(EllipsoidOptions { epsilon, ..Default::default() }), "epsilon");
    }
    assert_eq!(refused(EllipsoidOptions { max_passes: 1, ..Default::default() }), "max_passes");
    assert_eq!(refused(EllipsoidOptions { threads: Some(0), ..Default::default() }), "threads");
}

/// Each corner of a cube ten thousand times and more: no list of the farthest points is short.
#[test]
fn many_copies_of_few_points_are_solved() {
    for dim in [2, 3] {
        let corners = 1usize << dim;
        let values: Vec<f64> = (0..100_000 * dim)
            .map(|at| if (at / dim % corners) >> (at % dim) & 1 == 1 { 2.0 } else { -1.0 })
            .collect();
        let points = taut_points::Points::new(&values, dim).unwrap();
        let found = taut_enclose::ellipsoid(&points, &Default::default()).unwrap();
        let verdict = found.check(&points).unwrap();
        assert!(verdict.gap <= 1e-9, "{verdict:?}");
        // A ball of radius 1.5·√d.
        assert!((found.answer.matrix[0][0] - 1.0 / (2.25 * dim as f64)).abs() < 1e-9);
    }
}
