//! Laws of the ellipsoid over random sets: what maps, orders, copies and inner points do to it.

use std::collections::HashSet;

use ellipsoids::{exact, log_determinant, map, mapped, normal, shell};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};

use crate::ellipsoids;

const GAP: f64 = 1e-12;

/// Small integers bring ties, copies and flat sets.
fn flat_rows() -> impl Strategy<Value = (usize, Vec<f64>)> {
    (1usize..5).prop_flat_map(|dim| {
        let rows = prop::collection::vec(-4i32..5, dim..40 * dim);
        rows.prop_map(move |mut values| {
            values.truncate(values.len() / dim * dim);
            (dim, values.into_iter().map(f64::from).collect())
        })
    })
}

proptest! {
    #![proptest_config(Config {
        cases: 200, rng_seed: RngSeed::Fixed(4), failure_persistence: None, ..Config::default()
    })]

    /// Whatever the rank, the checker confirms the gap, and every point is inside for a user.
    #[test]
    fn small_integers_are_solved_exactly((dim, values) in flat_rows()) {
        let found = exact("small integers", &values, dim, GAP);
        for row in values.chunks(dim) {
            prop_assert!(found.answer.norm(row) <= 1.0 + 1e-12);
        }
        // No more points touch than determine an ellipsoid; copies of one may share its weight.
        let rows = found.certificate.support.iter().map(|&row| &values[row as usize * dim..][..dim]);
        let places: HashSet<Vec<u64>> = rows.map(|row| row.iter().map(|x| x.to_bits()).collect()).collect();
        let r = found.answer.rank();
        prop_assert!(places.len() <= (r * (r + 3) / 2).max(1));
    }

    #[test]
    fn affine_maps_map_the_ellipsoid(dim in 1usize..8, n in 1usize..300, seed in 0u64..1000) {
        let n = n + dim + 1;
        let values = normal(n, dim, seed);
        let (matrix, shift) = (map(dim, seed + 1), normal(1, dim, seed + 2));
        let (before, after) = (
            exact("before", &values, dim, GAP),
            exact("after", &mapped(&values, &matrix, &shift), dim, GAP),
        );
        let grown = after.answer.log_volume - before.answer.log_volume;
        prop_assert!((grown - log_determinant(&matrix, dim)).abs() < 1e-9);
        prop_assert_eq!(&before.certificate.support, &after.certificate.support);
        let center = mapped(&before.answer.center, &matrix, &shift);
        for (mapped, found) in center.iter().zip(&after.answer.center) {
            prop_assert!((mapped - found).abs() < 1e-5);
        }
    }

    #[test]
    fn order_copies_and_inner_points_change_nothing(
        dim in 1usize..7, n in 1usize..200, seed in 0u64..1000, copies in 1usize..5,
    ) {
        let n = n + dim + 1;
        let values = normal(n, dim, seed);
        let plain = exact("plain", &values, dim, GAP);
        let volume = plain.answer.log_volume;
        let rows: Vec<&[f64]> = values.chunks(dim).collect();
        let reversed: Vec<f64> = rows.iter().rev().copied().flatten().copied().collect();
        let reversed = exact("reversed", &reversed, dim, GAP);
        prop_assert!((reversed.answer.log_volume - volume).abs() < 2.0 * GAP);
        let mut support: Vec<u64> =
            reversed.certificate.support.iter().map(|i| n as u64 - 1 - i).collect();
        support.reverse();
        prop_assert_eq!(&support, &plain.certificate.support);
        let repeated: Vec<f64> = (0..copies).flat_map(|_| values.clone()).collect();
        let repeated = exact("repeated", &repeated, dim, GAP);
        prop_assert!((repeated.answer.log_volume - volume).abs() < 2.0 * GAP);
        // Halfway to the center every point is inside.
        let center = &plain.answer.center;
        let halves = values.iter().enumerate().map(|(k, x)| 0.5 * (x + center[k % dim]));
        let filled: Vec<f64> = values.iter().copied().chain(halves).collect();
        let filled = exact("filled", &filled, dim, GAP);
        prop_assert!((filled.answer.log_volume - volume).abs() < 2.0 * GAP);
        prop_assert_eq!(&filled.certificate.support, &plain.certificate.support);
    }

    #[test]
    fn only_the_support_matters(dim in 1usize..7, n in 1usize..200, seed in 0u64..1000) {
        let n = n + dim + 1;
        let values = normal(n, dim, seed);
        let plain = exact("plain", &values, dim, GAP);
        let support = &plain.certificate.support;
        let rows: Vec<&[f64]> = values.chunks(dim).collect();
        let alone: Vec<f64> =
            support.iter().flat_map(|&i| rows[i as usize].iter().copied()).collect();
        let alone = exact("the support alone", &alone, dim, GAP);
        prop_assert!((alone.answer.log_volume - plain.answer.log_volume).abs() < 2.0 * GAP);
        // Without its heaviest point the ellipsoid is smaller.
        let heaviest = (0..support.len())
            .max_by(|&a, &b| {
                plain.certificate.multipliers[a].total_cmp(&plain.certificate.multipliers[b])
            })
            .unwrap();
        let left: Vec<f64> = (0..n as u64)
            .filter(|i| *i != support[heaviest])
            .flat_map(|i| rows[i as usize].iter().copied())
            .collect();
        // What is left may be a thin simplex, of which leverages are known less well.
        let left = exact("without the heaviest", &left, dim, 10.0 * GAP);
        if left.answer.rank() == dim {
            prop_assert!(left.answer.log_volume < plain.answer.log_volume - 1e-9);
        }
    }

    #[test]
    fn shells_of_any_thickness_are_solved(
        dim in 2usize..9, n in 50usize..1500, exponent in 0i32..13, seed in 0u64..100,
    ) {
        let values = shell(n, dim, 10f64.powi(-exponent), seed);
        exact("a shell", &values, dim, GAP);
    }
}

/// The multipliers are those of the optimum: κᵢ = d + 1 where uᵢ > 0, and Σuᵢκᵢ = d + 1 always.
#[test]
fn points_with_multipliers_touch() {
    for (n, dim) in [(500, 3), (3000, 8), (2000, 15)] {
        let values = normal(n, dim, 1);
        let found = exact("touching", &values, dim, GAP);
        assert!((found.certificate.multipliers.iter().sum::<f64>() - 1.0).abs() < 1e-14);
        for &i in &found.certificate.support {
            let norm = found.answer.norm(&values[i as usize * dim..(i as usize + 1) * dim]);
            assert!((norm - 1.0).abs() < 1e-6, "{n} × {dim}, point {i}: {norm}");
        }
    }
}

/// The ellipsoid shrunk to 1/d lies in the hull of the points (John): in any direction some point reaches farther.
#[test]
fn a_shrunk_copy_lies_in_the_hull() {
    let (n, dim) = (400, 4);
    let values = normal(n, dim, 21);
    let found = exact("John", &values, dim, GAP);
    // F is lower triangular: h(b) = b′c + |F⁻ᵀb|.
    for b in normal(200, dim, 22).chunks(dim) {
        let mut z = b.to_vec();
        for a in (0..dim).rev() {
            z[a] /= found.answer.factor[a][a];
            for k in 0..a {
                z[k] -= found.answer.factor[a][k] * z[a];
            }
        }
        let width = z.iter().map(|z| z * z).sum::<f64>().sqrt();
        let product = |x: &[f64]| b.iter().zip(x).map(|(b, x)| b * x).sum::<f64>();
        let reach = values.chunks(dim).map(product).fold(f64::NEG_INFINITY, f64::max);
        let center = product(&found.answer.center);
        assert!(reach >= center + width / dim as f64 - 1e-9 && reach <= center + width + 1e-9);
    }
}
