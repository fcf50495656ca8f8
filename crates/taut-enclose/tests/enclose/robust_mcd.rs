//! The minimum covariance determinant: classical sets, breakdown, exact fits, and what it must not depend on.

use robust::{by, classical, contaminated, judge, mapped, normal, real, solve};
use taut_certify::{RobustMethod, RobustScale};
use taut_enclose::{Error, RobustOptions, robust_ellipsoid};
use taut_points::{InputError, Points};

use crate::robust;

fn mcd() -> RobustOptions<'static> {
    by(RobustMethod::Mcd)
}

/// The best determinants, locations and outliers (rows from 1) that the R package robustbase publishes with its tests.
#[test]
fn classical_sets_have_the_determinants_of_the_literature() {
    type Case = (&'static str, usize, f64, &'static [f64], &'static [u64]);
    let cases: &[Case] = &[
        ("rb_heart.csv", 2, 5.678742, &[38.3, 33.1], &[]),
        ("rb_phosphor.csv", 2, 6.878847, &[13.4, 38.8], &[1, 6]),
        ("rb_starsCYG.csv", 2, -8.031215, &[4.41, 4.95], &[7, 11, 14, 20, 30, 34]),
        ("rb_stackloss.csv", 3, 5.472581, &[59.5, 20.8, 87.3], &[1, 2, 3, 15, 16, 17, 18, 19, 21]),
        ("rb_salinity.csv", 3, 1.326364, &[10.08, 2.78, 22.78], &[5, 16, 23, 24]),
        (
            "rb_hbk.csv",
            3,
            -1.047858,
            &[1.54, 1.78, 1.69],
            &[1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14],
        ),
        (
            "rb_wood.csv",
            5,
            -36.270094,
            &[0.587, 0.122, 0.531, 0.538, 0.892],
            &[4, 6, 7, 8, 11, 16, 19],
        ),
        (
            "rb_coleman.csv",
            5,
            1.286808,
            &[2.76, 48.38, 6.12, 25.00, 6.40],
            &[1, 6, 9, 10, 11, 15, 18],
        ),
        (
            "rb_bushfire.csv",
            5,
            18.135810,
            &[105.0, 147.0, 274.0, 218.0, 279.0],
            &[7, 8, 9, 10, 11, 12, 29, 30, 31, 32, 33, 34, 35, 36, 37, 38],
        ),
        (
            "rb_milk.csv",
            8,
            -28.902301,
            &[1.03, 35.97, 33.13, 26.17, 25.15, 25.08, 123.18, 14.39],
            &[1, 2, 3, 11, 12, 13, 14, 15, 16, 17, 18, 27, 41, 44, 47, 70, 74, 75, 77],
        ),
    ];
    for (name, dim, log_det, center, outliers) in cases {
        let Some(values) = real(name, *dim) else {
            println!("skipped {name}: TAUT_DATA is not set");
            return;
        };
        let found = solve(name, &values, *dim, &mcd());
        let below = log_det - found.certificate.objective;
        assert!(below > -1e-6, "{name}: {}", found.certificate.objective);
        // Of the milk, a better subset is found than is published.
        if below < 1e-6 {
            let rows: Vec<u64> = found.answer.outliers.iter().map(|row| row + 1).collect();
            assert_eq!(rows, *outliers, "{name}");
            for (c, wanted) in found.answer.center.iter().zip(*center) {
                assert!((c - wanted).abs() < 5e-3 * wanted.abs(), "{name}: {c} of {wanted}");
            }
        } else {
            assert_eq!(*name, "rb_milk.csv", "{below}");
        }
    }
}

#[test]
fn forty_percent_of_outliers_do_not_move_it() {
    for (n, dim) in [(50, 2), (200, 5), (crate::test_length::long_or(5000, 1500), 3)] {
        let outliers = 2 * n / 5;
        let clean = normal(n - outliers, dim, 3);
        let (mean, _) = classical(&clean, dim);
        for away in [1e2, 1e6, 1e12] {
            let values = contaminated(n, dim, outliers, away, 3);
            let found = solve("breakdown", &values, dim, &mcd());
            let out: Vec<u64> = ((n - outliers) as u64..n as u64).collect();
            assert!(out.iter().all(|row| found.answer.outliers.contains(row)), "{n} {dim} {away}");
            for (c, m) in found.answer.center.iter().zip(&mean) {
                assert!((c - m).abs() < 0.5, "{n} × {dim} at {away}: {c} of {m}");
            }
            assert!(found.answer.log_det.abs() < 4.0, "{}", found.answer.log_det);
        }
    }
}

/// By the level the covariance of the points not weighed out is multiplied by level/F(q), with q the quantile of χ² with d degrees
/// of freedom and F the distribution with two more, as scikit-learn does: SciPy's chi2.cdf(chi2.ppf(0.975, d), d + 2).
#[test]
fn scales_by_the_level_are_those_of_scikit_learn() {
    for (dim, wanted) in [(2, 1.1044679239), (3, 1.0784787184), (10, 1.0355599028)] {
        let values = contaminated(900, dim, 200, 30.0, 6);
        for method in [RobustMethod::Mcd, RobustMethod::Mve] {
            let share = solve("share", &values, dim, &by(method));
            let options = RobustOptions { scale: RobustScale::Level, ..by(method) };
            let level = solve("level", &values, dim, &options);
            assert_eq!(share.certificate.weighed_out, level.certificate.weighed_out);
            let (found, other) = (level.certificate.scale, share.certificate.scale);
            assert!((found - wanted).abs() < 1e-9, "{dim}: {found}");
            let ratio = level.answer.scatter[0][0] / share.answer.scatter[0][0];
            assert!((ratio * other / found - 1.0).abs() < 1e-12, "{dim}: {ratio}");
            // Fewer are left than the level says, and their share is taken for the part of normal points.
            assert!(found < other, "{dim}: {found} {other}");
        }
    }
}

/// h points that hold a tight cluster and all the way to it can have a smaller determinant than any h of the others: by
/// definition these are the answer then. Far enough away the cluster has no part in it, as for any cluster.
#[test]
fn a_tight_cluster_is_kept_exactly_where_that_has_the_smaller_determinant() {
    let (n, dim, outliers) = (1000, 5, 300);
    let others = n - outliers;
    for (away, is_kept) in [(10.0, true), (1e6, false)] {
        let mut values = normal(n, dim, 19);
        values[others * dim..].iter_mut().for_each(|v| *v = 0.05 * *v + away);
        let found = solve("tight", &values, dim, &mcd());
        let h = found.certificate.kept;
        // The best h of the others alone, of which h is the part α.
        let half = (others + dim).div_ceil(2) as f64;
        let alpha = (h as f64 + 0.5 - 2.0 * half + others as f64) / (2.0 * (others as f64 - half));
        let options = RobustOptions { coverage: Some(alpha), ..mcd() };
        let alone = solve("others", &values[..others * dim], dim, &options);
        assert_eq!(alone.certificate.kept, h);
        let less = alone.certificate.objective - found.certificate.objective;
        let left_out = &found.certificate.left_out;
        let kept = (others as u64..n as u64).filter(|row| !left_out.contains(row)).count();
        if is_kept {
            assert!(less > 1.0 && kept == outliers, "{away}: {less}, {kept}");
        } else {
            assert!(less > -1e-9 && kept == 0, "{away}: {less}, {kept}");
            assert!((others as u64..n as u64).all(|row| found.answer.outliers.contains(&row)));
        }
    }
}

#[test]
fn no_exchange_of_two_points_lowers_the_determinant() {
    let log_det = |rows: &[f64]| {
        let [[a, b], [_, d]] = [0, 1].map(|i| {
            let (_, covariance) = classical(rows, 2);
            [covariance[i][0], covariance[i][1]]
        });
        (a * d - b * b).ln()
    };
    for seed in 0..8 {
        let (n, dim) = (40, 2);
        let values = contaminated(n, dim, 8, 6.0, seed);
        let found = solve("exchanges", &values, dim, &mcd());
        let left_out = &found.certificate.left_out;
        let is_kept = |row: usize| !left_out.contains(&(row as u64));
        let least = found.certificate.objective;
        for out in (0..n).filter(|row| is_kept(*row)) {
            for into in (0..n).filter(|row| !is_kept(*row)) {
                let rows = (0..n).filter(|&row| row == into || (row != out && is_kept(row)));
                let rows: Vec<f64> =
                    rows.flat_map(|row| values[row * dim..][..dim].iter().copied()).collect();
                assert!(log_det(&rows) > least - 1e-11, "seed {seed}: {out} for {into}");
            }
        }
    }
}

#[test]
fn all_points_give_mean_and_covariance() {
    for dim in [1, 2, 6] {
        let matrix: Vec<f64> = normal(dim, dim, 7);
        let values = mapped(&normal(300, dim, 5), &matrix, &vec![1e3; dim]);
        let options = RobustOptions { coverage: Some(1.0), ..mcd() };
        let found = solve("all", &values, dim, &options);
        let (mean, covariance) = classical(&values, dim);
        assert!(found.certificate.left_out.is_empty() && found.certificate.weighed_out.is_empty());
        for a in 0..dim {
            assert!((found.answer.center[a] - mean[a]).abs() < 1e-10);
            for b in 0..dim {
                let size = (covariance[a][a] * covariance[b][b]).sqrt();
                assert!((found.answer.scatter[a][b] - covariance[a][b]).abs() < 1e-11 * size);
            }
        }
    }
}

#[test]
fn h_points_in_a_hyperplane_are_reported() {
    let mut values = normal(100, 3, 11);
    for row in values.chunks_mut(3).take(70) {
        row[2] = 2.0 * row[0] - row[1] + 5.0;
    }
    let found = solve("plane", &values, 3, &mcd());
    let hull = found.answer.hull.as_ref().expect("a plane holds 70 of 100 points");
    assert_eq!(hull.basis.len(), 2);
    assert!((70..100).all(|row| found.answer.outliers.contains(&row)));
    assert!(found.answer.outliers.len() < 40, "{:?}", found.answer.outliers);
    let normal_of_plane = [2.0, -1.0, -1.0];
    for direction in &hull.basis {
        let product: f64 = direction.iter().zip(normal_of_plane).map(|(b, v)| b * v).sum();
        assert!(product.abs() < 1e-12);
    }

    // A line in the plane, one point, fewer points than dimensions.
    for row in values.chunks_mut(3).take(60) {
        row[1] = row[0];
        row[2] = row[0] + 5.0;
    }
    let found = solve("line", &values, 3, &mcd());
    assert_eq!(found.answer.factor.len(), 1);
    values[..60 * 3].fill(0.25);
    let found = solve("point", &values, 3, &mcd());
    assert_eq!((found.answer.factor.len(), &found.answer.center[..]), (0, &[0.25; 3][..]));
    assert_eq!(found.answer.outliers, (60..100).collect::<Vec<u64>>());
    let few = solve("few", &normal(4, 7, 2), 7, &mcd());
    assert_eq!(few.answer.factor.len(), 3);
    let one = solve("one", &[1.0, 2.0], 2, &mcd());
    assert_eq!((one.answer.factor.len(), one.answer.outliers.len()), (0, 0));
}

#[test]
fn shifts_scales_and_turns_go_along() {
    for (n, dim) in [(120, 3), (crate::test_length::long_or(6000, 700), 4)] {
        let values = contaminated(n, dim, n / 4, 20.0, 17);
        let plain = solve("plain", &values, dim, &mcd());
        let mut scales = vec![0.0; dim * dim];
        (0..dim).for_each(|a| scales[a * dim + a] = 10f64.powi(3 * a as i32 - 4));
        for (name, matrix) in [("scaled", scales), ("affine", normal(dim, dim, 23))] {
            let shift: Vec<f64> = (0..dim).map(|a| 100.0 * a as f64).collect();
            let image = mapped(&values, &matrix, &shift);
            let found = solve(name, &image, dim, &mcd());
            assert_eq!(found.answer.outliers, plain.answer.outliers, "{name} {n}");
            let wanted = mapped(&plain.answer.center, &matrix, &shift);
            for (a, (c, w)) in found.answer.center.iter().zip(&wanted).enumerate() {
                let size = found.answer.scatter[a][a].sqrt();
                assert!((c - w).abs() < 1e-9 * size, "{name} {n}: {c} of {w}");
            }
        }
    }
}

#[test]
fn order_threads_and_precision_change_nothing() {
    for n in [150, crate::test_length::long_or(9000, 1000)] {
        let dim = 3;
        let narrow: Vec<f32> =
            contaminated(n, dim, n / 3, 30.0, 31).iter().map(|&v| v as f32).collect();
        let values: Vec<f64> = narrow.iter().map(|&v| v.into()).collect();
        let found = solve("f64", &values, dim, &mcd());
        for &threads in crate::test_length::long_or(&[1, 2, 5][..], &[2]) {
            let options = RobustOptions { threads: Some(threads), ..mcd() };
            let again = robust_ellipsoid(&Points::new(&values, dim).unwrap(), &options).unwrap();
            assert_eq!(again.to_json(), found.to_json());
            let single = robust_ellipsoid(&Points::new(&narrow, dim).unwrap(), &options).unwrap();
            assert_eq!(single.to_json(), found.to_json());
        }
        let turned: Vec<f64> =
            values.chunks(dim).rev().flat_map(|row| row.iter().copied()).collect();
        let back = solve("reversed", &turned, dim, &mcd());
        let rows: Vec<u64> =
            back.answer.outliers.iter().rev().map(|row| n as u64 - 1 - row).collect();
        assert_eq!(rows, found.answer.outliers);
        for (c, w) in back.answer.center.iter().zip(&found.answer.center) {
            assert!((c - w).abs() < 1e-12);
        }
        assert!((back.answer.log_det - found.answer.log_det).abs() < 1e-11);
    }
}

#[test]
fn offsets_and_ranges_are_borne() {
    for (offset, scale) in [(1e8, 1.0), (0.0, 1e-140), (0.0, 1e140), (1e12, 1e3)] {
        let values: Vec<f64> =
            contaminated(400, 4, 100, 50.0, 41).iter().map(|v| offset + scale * v).collect();
        let found = solve("far", &values, 4, &mcd());
        assert!((300..400).all(|row| found.answer.outliers.contains(&row)), "{offset} {scale}");
        assert!(found.answer.hull.is_none());
    }
}

#[test]
fn bad_input_is_named() {
    let nan = [0.0, 1.0, f64::NAN, 3.0];
    let refused = robust_ellipsoid(&Points::new(&nan, 2).unwrap(), &mcd()).unwrap_err();
    assert!(
        matches!(refused, Error::Input(InputError::NonFinite { row: 1, column: 0, .. })),
        "{refused}"
    );
    let empty = robust_ellipsoid(&Points::<f64>::new(&[], 2).unwrap(), &mcd()).unwrap_err();
    assert!(matches!(empty, Error::Empty));
    let huge = [0.0, f64::MAX, -f64::MAX, f64::MAX / 2.0, 1.0];
    assert!(robust_ellipsoid(&Points::new(&huge, 1).unwrap(), &mcd()).is_err());
    let points = Points::new(&[0.0, 1.0], 1).unwrap();
    for options in [
        RobustOptions { coverage: Some(0.4), ..mcd() },
        RobustOptions { coverage: Some(f64::NAN), ..mcd() },
        RobustOptions { coverage: Some(0.0), ..by(RobustMethod::Trim) },
        RobustOptions { level: 1.0, ..mcd() },
        RobustOptions { epsilon: 0.0, ..mcd() },
        RobustOptions { threads: Some(0), ..mcd() },
    ] {
        let refused = robust_ellipsoid(&points, &options).unwrap_err();
        assert!(matches!(refused, Error::Input(InputError::Option { .. })), "{options:?}");
    }
}

#[test]
fn few_values_with_many_ties_are_solved() {
    // Small integers: ties of distances, flat halves, copies.
    for seed in 0..crate::test_length::long_or(60, 20) {
        for dim in 1..4 {
            let values: Vec<f64> = normal(9 + seed as usize % 20, dim, seed)
                .iter()
                .map(|v| (1.5 * v).round())
                .collect();
            let found = solve(&format!("ties {seed}, {dim}"), &values, dim, &mcd());
            judge("again", &values, dim, &found);
        }
    }
}
