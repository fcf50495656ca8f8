//! The ellipsoid of balls and of ellipsoids: closed forms, laws, degenerate items, refusals.

use shapes::{Item, border, random_items, rows_of};
use taut_certify::{Ellipsoid, Items, Solution};
use taut_enclose::{EllipsoidMethod, EllipsoidOptions, Error, ellipsoid};
use taut_points::{InputError, Points};

use crate::shapes;

/// Solves items and has the answer checked.
fn solved(items: &[Item], epsilon: f64) -> Solution<Ellipsoid> {
    let (values, columns) = rows_of(items);
    let rows = Points::new(&values, columns).unwrap();
    let options = EllipsoidOptions { epsilon, ..Default::default() };
    let found =
        ellipsoid(&rows, &EllipsoidOptions { inputs: Items::Ellipsoids, ..options.clone() })
            .unwrap();
    let verdict = found.check(&rows).unwrap();
    assert!(verdict.gap <= epsilon, "{} of {epsilon}: {:?}", verdict.gap, found.trace);
    found
}

fn log_ball(dim: usize) -> f64 {
    let start = if dim.is_multiple_of(2) { 0.0 } else { 2f64.ln() };
    let first = if dim.is_multiple_of(2) { 2 } else { 3 };
    start + (first..=dim).step_by(2).map(|d| f64::ln(std::f64::consts::TAU / d as f64)).sum::<f64>()
}

#[test]
fn one_ellipsoid_gives_itself() {
    for dim in [1, 2, 3, 7, 12] {
        let items = random_items(1, dim, dim as u64, 1.0);
        let found = solved(&items, 1e-9);
        let shape = &items[0].shape;
        // Q is the inverse of S.
        for i in 0..dim {
            for j in 0..dim {
                let product: f64 =
                    (0..dim).map(|k| found.answer.matrix[i][k] * shape[k * dim + j]).sum();
                let wanted = f64::from(u8::from(i == j));
                assert!((product - wanted).abs() < 1e-7, "d = {dim}: {product}");
            }
        }
    }
}

#[test]
fn points_as_ellipsoids_give_what_points_give() {
    let points = [0.0, 0.0, 4.0, 0.1, 3.0, 2.0, 0.5, 2.5, 1.0, 1.0, -1.0, 1.5];
    let items: Vec<Item> =
        points.chunks(2).map(|p| Item { center: p.to_vec(), shape: vec![0.0; 4] }).collect();
    let found = solved(&items, 1e-11);
    let rows = Points::new(&points, 2).unwrap();
    let of_points =
        ellipsoid(&rows, &EllipsoidOptions { epsilon: 1e-11, ..Default::default() }).unwrap();
    assert!((found.answer.log_volume - of_points.answer.log_volume).abs() < 2e-11);
    let all = EllipsoidOptions::default();
    let dispatched = ellipsoid(&rows, &all).unwrap();
    assert_eq!(dispatched, ellipsoid(&rows, &all).unwrap());
}

/// Two unit balls with centers ±h on an axis: half axes a along it and b across, of least a·b^(d − 1) such that
/// (h + cos t)²/a² + sin² t/b² ≤ 1 for all t.
#[test]
fn two_balls_have_the_ellipsoid_of_revolution_around_them() {
    for dim in [2, 3, 6] {
        for &h in crate::test_length::long_or(&[0.3, 1.0, 2.5][..], &[0.3, 2.5]) {
            let balls: Vec<Item> = [h, -h]
                .iter()
                .map(|&h| {
                    let mut center = vec![0.0; dim];
                    center[dim - 1] = h;
                    let mut shape = vec![0.0; dim * dim];
                    (0..dim).for_each(|i| shape[i * dim + i] = 1.0);
                    Item { center, shape }
                })
                .collect();
            let found = solved(&balls, 1e-8);
            let log_volume = |a: f64| {
                // The least b for this a, by a fine search over t.
                let needed = |t: f64| {
                    let along = (h + t.cos()) / a;
                    if along >= 1.0 {
                        f64::INFINITY
                    } else {
                        t.sin().powi(2) / (1.0 - along * along)
                    }
                };
                let steps = crate::test_length::long_or(20_000, 10_000);
                let b2 = (1..steps)
                    .map(|k| needed(std::f64::consts::PI * f64::from(k) / f64::from(steps)))
                    .fold(0.0, f64::max);
                a.ln() + 0.5 * (dim as f64 - 1.0) * b2.ln()
            };
            let (mut low, mut high) = (h + 1.0 + 1e-9, 3.0 * (h + 1.0));
            for _ in 0..100 {
                let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
                if log_volume(a) < log_volume(b) { high = b } else { low = a }
            }
            let wanted = log_volume(low) + log_ball(dim);
            let off = found.answer.log_volume - wanted;
            assert!(off.abs() < 1e-6, "d = {dim}, h = {h}: {off:e}");
        }
    }
}

/// {m + v} with m at the corners of a cube and S = D for a diagonal D: symmetric, so the answer is axis-aligned.
#[test]
fn corners_of_a_box_with_equal_ellipsoids_give_an_aligned_ellipsoid_around_the_origin() {
    let widths = [3.0f64, 1.0, 0.2];
    let items: Vec<Item> = (0..8u32)
        .map(|corner| {
            let center = (0..3).map(|j| if corner >> j & 1 == 1 { widths[j] } else { -widths[j] });
            let mut shape = vec![0.0; 9];
            (0..3).for_each(|j| shape[4 * j] = (0.5 * widths[j]).powi(2));
            Item { center: center.collect(), shape }
        })
        .collect();
    let found = solved(&items, 1e-10);
    // In units of the widths: eight balls of radius ½ at the corners of a cube, and the ball around them.
    let radius = 3f64.sqrt() + 0.5;
    let wanted = log_ball(3) + 3.0 * radius.ln() + widths.iter().map(|w| w.ln()).sum::<f64>();
    assert!((found.answer.log_volume - wanted).abs() < 1e-9);
    assert!(found.answer.center.iter().all(|c| c.abs() < 1e-5));
}

#[test]
fn an_affine_image_has_the_image_of_the_ellipsoid() {
    let dim = 4;
    let items = random_items(30, dim, 5, 0.4);
    let plain = solved(&items, 1e-10);
    // Lower triangular, axes from 1 to 1e5, far from the origin.
    let map: Vec<f64> = (0..dim * dim)
        .map(|at| {
            let (i, j) = (at / dim, at % dim);
            let size = 10f64.powf(5.0 * i as f64 / 3.0);
            if i == j {
                size
            } else if j < i {
                0.3 * size
            } else {
                0.0
            }
        })
        .collect();
    let moved: Vec<Item> = items.iter().map(|item| item.mapped(&map, &vec![1e4; dim])).collect();
    let found = solved(&moved, 1e-9);
    let logs: f64 = (0..dim).map(|i| map[i * dim + i].ln()).sum();
    let off = found.answer.log_volume - plain.answer.log_volume - logs;
    assert!(off.abs() < 2e-9, "{off:e}");
}

#[test]
fn flat_items_are_solved_in_their_plane() {
    let dim = 3;
    // Discs and points in the plane z = x + y, and one segment.
    let basis = [[1.0, 0.0, 1.0], [0.0, 1.0, 1.0]];
    let item = |x: f64, y: f64, a: f64, b: f64| {
        let center = (0..3).map(|j| x * basis[0][j] + y * basis[1][j]).collect();
        let shape = (0..9)
            .map(|at| {
                a * basis[0][at / 3] * basis[0][at % 3] + b * basis[1][at / 3] * basis[1][at % 3]
            })
            .collect();
        Item { center, shape }
    };
    let items = [
        item(0.0, 0.0, 1.0, 1.0),
        item(3.0, 0.5, 0.0, 0.0),
        item(1.0, 2.0, 0.5, 0.0),
        item(-2.0, 1.0, 0.25, 0.5),
    ];
    let found = solved(&items, 1e-9);
    assert_eq!((found.answer.rank(), found.answer.dim()), (2, dim));
    // The same in the plane itself, in which areas are √3 times as small.
    let plane =
        |x: f64, y: f64, a: f64, b: f64| Item { center: vec![x, y], shape: vec![a, 0.0, 0.0, b] };
    let flat = [
        plane(0.0, 0.0, 1.0, 1.0),
        plane(3.0, 0.5, 0.0, 0.0),
        plane(1.0, 2.0, 0.5, 0.0),
        plane(-2.0, 1.0, 0.25, 0.5),
    ];
    let in_plane = solved(&flat, 1e-9);
    let off = found.answer.log_volume - in_plane.answer.log_volume - 0.5 * 3f64.ln();
    assert!(off.abs() < 2e-9, "{off:e}");
}

#[test]
fn one_point_and_one_segment_are_ellipsoids() {
    let point = Item { center: vec![1.0, 2.0, 3.0], shape: vec![0.0; 9] };
    let found = solved(&[point.clone(), point.clone()], 1e-9);
    assert_eq!((found.answer.rank(), found.answer.log_volume), (0, 0.0));
    let mut shape = vec![0.0; 9];
    shape[8] = 4.0;
    let found = solved(&[Item { center: vec![1.0, 2.0, 3.0], shape }, point], 1e-9);
    assert_eq!(found.answer.rank(), 1);
    assert!((found.answer.log_volume - 4f64.ln()).abs() < 1e-9);
}

#[test]
fn balls_and_the_same_balls_as_ellipsoids_agree() {
    let balls = [0.0, 0.0, 1.0, 5.0, 1.0, 0.5, 2.0, 4.0, 0.0, 3.0, -1.0, 1.5];
    let rows = Points::new(&balls, 3).unwrap();
    let options = EllipsoidOptions { epsilon: 1e-10, ..Default::default() };
    let of_balls =
        ellipsoid(&rows, &EllipsoidOptions { inputs: Items::Balls, ..options.clone() }).unwrap();
    assert!(of_balls.check(&rows).unwrap().gap <= 1e-10);
    let items: Vec<Item> = balls
        .chunks(3)
        .map(|b| Item { center: b[..2].to_vec(), shape: vec![b[2] * b[2], 0.0, 0.0, b[2] * b[2]] })
        .collect();
    let found = solved(&items, 1e-10);
    assert!((found.answer.log_volume - of_balls.answer.log_volume).abs() < 2e-10);
}

#[test]
fn random_items_of_many_kinds_are_proved() {
    for (seed, (n, dim, size)) in [
        (1, 2, 1.0),
        (2, 3, 1.0),
        (3, 5, 2.0),
        (10, 2, 0.1),
        (40, 3, 1.0),
        (100, 6, 0.5),
        (300, 10, 0.3),
        (20, 15, 3.0),
        (500, 4, 1e-6),
    ]
    .into_iter()
    .enumerate()
    {
        solved(&random_items(n, dim, seed as u64, size), 1e-8);
    }
}

#[test]
fn the_bytes_do_not_depend_on_threads() {
    let (values, columns) = rows_of(&random_items(400, 5, 3, 0.5));
    let rows = Points::new(&values, columns).unwrap();
    let with = |threads| {
        let options = EllipsoidOptions { threads: Some(threads), ..Default::default() };
        ellipsoid(&rows, &EllipsoidOptions { inputs: Items::Ellipsoids, ..options.clone() })
            .unwrap()
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn bad_rows_are_named() {
    let options = EllipsoidOptions::default();
    let error = |values: &[f64], columns: usize| {
        ellipsoid(
            &Points::new(values, columns).unwrap(),
            &EllipsoidOptions { inputs: Items::Ellipsoids, ..options.clone() },
        )
        .unwrap_err()
    };
    let good = [0.0, 0.0, 1.0, 0.0, 1.0];
    let after_good = |row: [f64; 5]| [good, row].concat();
    assert!(matches!(
        error(&after_good([0.0, 0.0, 1.0, 2.0, 1.0]), 5),
        Error::NegativeShape { row: 1 }
    ));
    assert!(matches!(
        error(&after_good([0.0, 0.0, -1.0, 0.0, 1.0]), 5),
        Error::NegativeShape { row: 1 }
    ));
    assert!(matches!(
        error(&after_good([0.0, 0.0, 0.0, 0.1, 1.0]), 5),
        Error::NegativeShape { row: 1 }
    ));
    let nan = error(&after_good([0.0, 0.0, 1.0, f64::NAN, 1.0]), 5);
    assert!(matches!(nan, Error::Input(InputError::NonFinite { row: 1, column: 3, .. })));
    assert!(matches!(error(&[1.0; 4], 4), Error::NoShape { columns: 4 }));
    assert!(matches!(error(&[], 5), Error::Empty));
    let rows = Points::new(&good, 5).unwrap();
    let slow = EllipsoidOptions { method: EllipsoidMethod::AwaySteps, ..Default::default() };
    assert!(matches!(
        ellipsoid(&rows, &EllipsoidOptions { inputs: Items::Ellipsoids, ..slow.clone() }),
        Err(Error::Input(InputError::Option { name: "method", .. }))
    ));
    let balls = Points::new(&[0.0, 1.0, 0.0, -1.0], 2).unwrap();
    let negative = ellipsoid(&balls, &EllipsoidOptions { inputs: Items::Balls, ..options.clone() })
        .unwrap_err();
    assert!(matches!(negative, Error::NegativeRadius { row: 1, .. }));
}

/// Of n points at equal angles on each border the ellipse is too small by (π/n)² or so, in log-area.
#[test]
fn twenty_ellipses_have_the_ellipse_of_points_on_their_borders() {
    for seed in 0..3 {
        let items = random_items(20, 2, seed, 1.0);
        let points: Vec<f64> = items.iter().flat_map(|item| border(item, 5000)).collect();
        let wanted = ellipsoid(&Points::new(&points, 2).unwrap(), &EllipsoidOptions::default());
        let off = solved(&items, 1e-9).answer.log_volume - wanted.unwrap().answer.log_volume;
        assert!((-2e-9..1e-6).contains(&off), "{off:e}");
    }
}
