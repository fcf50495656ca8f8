//! The ball of ellipsoids: closed forms, laws, degenerate items, refusals.

use shapes::{Item, border, random_items, rows_of};
use taut_certify::{Ball, Items, Solution};
use taut_enclose::{BallMethod, BallOptions, Error, ball};
use taut_points::{InputError, Points};

use crate::shapes;

fn solved(items: &[Item], epsilon: f64) -> Solution<Ball> {
    let (values, columns) = rows_of(items);
    let rows = Points::new(&values, columns).unwrap();
    let options = BallOptions { epsilon, ..Default::default() };
    let found = ball(&rows, &BallOptions { inputs: Items::Ellipsoids, ..options.clone() }).unwrap();
    let verdict = found.check(&rows).unwrap();
    assert!(verdict.gap <= epsilon.max(1e-11), "{} of {epsilon}: {:?}", verdict.gap, found.trace);
    found
}

fn round(center: &[f64], radius: f64) -> Item {
    let dim = center.len();
    let entry = |at: usize| if at / dim == at % dim { radius * radius } else { 0.0 };
    Item { center: center.to_vec(), shape: (0..dim * dim).map(entry).collect() }
}

#[test]
fn balls_as_ellipsoids_give_what_balls_give() {
    let balls = [0.0, 0.0, 0.3, 1.0, 5.0, 1.0, -1.0, 0.5, 2.0, 4.0, 1.0, 0.0, 3.0, -1.0, 0.0, 1.5];
    let items: Vec<Item> = balls.chunks(4).map(|b| round(&b[..3], b[3])).collect();
    let found = solved(&items, 1e-11);
    let rows = Points::new(&balls, 4).unwrap();
    let wanted =
        ball(&rows, &BallOptions { inputs: Items::Balls, ..Default::default() }).unwrap().answer;
    assert!((found.answer.radius / wanted.radius - 1.0).abs() < 1e-10);
    for (a, b) in found.answer.center.iter().zip(&wanted.center) {
        assert!((a - b).abs() < 1e-5);
    }
}

#[test]
fn points_as_ellipsoids_give_what_points_give() {
    let points = [0.0, 0.0, 4.0, 0.1, 3.0, 2.0, 0.5, 2.5, 1.0, 1.0, -1.0, 1.5];
    let items: Vec<Item> = points.chunks(2).map(|p| round(p, 0.0)).collect();
    let found = solved(&items, 1e-12);
    let wanted = ball(&Points::new(&points, 2).unwrap(), &BallOptions::default()).unwrap();
    assert!((found.answer.radius / wanted.answer.radius - 1.0).abs() < 1e-12);
}

#[test]
fn one_ellipsoid_has_the_ball_of_its_longest_axis() {
    for dim in [1, 2, 5] {
        let mut shape = vec![0.0; dim * dim];
        (0..dim).for_each(|j| shape[j * dim + j] = ((j + 1) * (j + 1)) as f64);
        let found = solved(&[Item { center: vec![7.0; dim], shape }], 1e-12);
        assert!((found.answer.radius - dim as f64).abs() < 1e-11);
        assert!(found.answer.center.iter().all(|c| (c - 7.0).abs() < 1e-6));
    }
}

#[test]
fn all_one_point_is_a_ball_of_radius_0() {
    let item = round(&[1.0, -2.0, 1e9], 0.0);
    let found = solved(&[item.clone(), item], 0.0);
    assert_eq!(found.answer.radius, 0.0);
}

#[test]
fn a_moved_and_scaled_copy_has_the_moved_and_scaled_ball() {
    let items = random_items(40, 4, 11, 0.7);
    let plain = solved(&items, 1e-11);
    for scale in [1e-150, 1e-3, 1e140] {
        let map: Vec<f64> = (0..16).map(|at| if at / 4 == at % 4 { scale } else { 0.0 }).collect();
        let moved: Vec<Item> =
            items.iter().map(|item| item.mapped(&map, &[5e3 * scale; 4])).collect();
        let found = solved(&moved, 1e-9);
        assert!((found.answer.radius / scale / plain.answer.radius - 1.0).abs() < 2e-9, "{scale}");
    }
}

#[test]
fn random_items_of_many_kinds_are_proved() {
    let kinds = [
        (1, 3, 1.0),
        (2, 2, 1.0),
        (5, 4, 3.0),
        (30, 3, 0.01),
        (300, 10, 0.5),
        (40, 25, 1.0),
        (1000, 2, 1e-7),
    ];
    for (seed, (n, dim, size)) in kinds.into_iter().enumerate() {
        for epsilon in [1e-3, 1e-9] {
            solved(&random_items(n, dim, seed as u64, size), epsilon);
        }
    }
}

#[test]
fn the_bytes_do_not_depend_on_threads() {
    let (values, columns) = rows_of(&random_items(500, 4, 3, 0.5));
    let rows = Points::new(&values, columns).unwrap();
    let with = |threads| {
        let options = BallOptions { threads: Some(threads), ..Default::default() };
        ball(&rows, &BallOptions { inputs: Items::Ellipsoids, ..options.clone() }).unwrap()
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn bad_rows_are_named() {
    let error = |values: &[f64], columns: usize, options: &BallOptions<'_>| {
        ball(
            &Points::new(values, columns).unwrap(),
            &BallOptions { inputs: Items::Ellipsoids, ..options.clone() },
        )
        .unwrap_err()
    };
    let plain = BallOptions::default();
    let indefinite = [0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 1.0, 2.0, 1.0];
    assert!(matches!(error(&indefinite, 5, &plain), Error::NegativeShape { row: 1 }));
    assert!(matches!(
        error(&[0.0, 0.0, f64::NAN, 0.0, 1.0], 5, &plain),
        Error::Input(InputError::NonFinite { row: 0, column: 2, .. })
    ));
    assert!(matches!(error(&[1.0; 4], 4, &plain), Error::NoShape { columns: 4 }));
    let thesis = BallOptions { method: BallMethod::ThesisFast, ..Default::default() };
    assert!(matches!(
        error(&[0.0, 0.0, 1.0, 0.0, 1.0], 5, &thesis),
        Error::Input(InputError::Option { name: "method", .. })
    ));
    assert!(matches!(error(&[0.0, -1.0], 2, &plain), Error::NegativeShape { row: 0 }));
}

/// Of n points at equal angles on each border the radius is too small by (π/n)² or so, relatively.
#[test]
fn twenty_ellipses_have_the_ball_of_points_on_their_borders() {
    for seed in 0..3 {
        let items = random_items(20, 2, seed, 1.0);
        let points: Vec<f64> = items.iter().flat_map(|item| border(item, 5000)).collect();
        let wanted = ball(&Points::new(&points, 2).unwrap(), &BallOptions::default()).unwrap();
        let off = solved(&items, 1e-9).answer.radius / wanted.answer.radius - 1.0;
        assert!((-2e-9..1e-6).contains(&off), "{off:e}");
    }
}

/// Whatever is done to an answer or its certificate, either it is refused or it still says the truth.
#[test]
fn doctored_answers_are_refused() {
    let (values, columns) = rows_of(&random_items(60, 4, 21, 0.6));
    let rows = Points::new(&values, columns).unwrap();
    let found =
        ball(&rows, &BallOptions { inputs: Items::Ellipsoids, ..Default::default() }).unwrap();
    found.check(&rows).unwrap();
    let refused = |what: &str, doctor: &dyn Fn(&mut Solution<Ball>)| {
        let mut other = found.clone();
        doctor(&mut other);
        assert!(other != found, "{what} changes nothing");
        assert!(other.check(&rows).is_err(), "{what} is accepted");
    };
    refused("a smaller radius", &|s| s.answer.radius *= 1.0 - 1e-12);
    refused("a larger radius", &|s| s.answer.radius *= 1.0 + 1e-8);
    refused("a radius of 0", &|s| s.answer.radius = 0.0);
    refused("a NaN", &|s| s.answer.radius = f64::NAN);
    refused("a smaller gap", &|s| s.certificate.gap = 0.0);
    refused("another hash", &|s| s.certificate.points_hash.0 ^= 1);
    refused("no directions", &|s| s.certificate.directions.clear());
    refused("other items", &|s| s.certificate.items = taut_certify::Items::Points);
    refused("too many multipliers", &|s| s.certificate.multipliers.push(0.1));
    for j in 0..4 {
        refused("a moved center", &|s| s.answer.center[j] += 1e-7);
        refused("a moved center", &|s| s.answer.center[j] -= 1e-7);
    }
    for k in 0..found.certificate.support.len() {
        refused("another multiplier", &|s| s.certificate.multipliers[k] *= 1.01);
        refused("a turned direction", &|s| {
            s.certificate.directions[k].iter_mut().for_each(|v| *v = -*v)
        });
        refused("an infinite direction", &|s| s.certificate.directions[k][1] = f64::INFINITY);
        refused("no direction", &|s| s.certificate.directions[k].fill(0.0));
        refused("another row", &|s| s.certificate.support[k] += 1000);
        refused("moved weight", &|s| {
            let last = (k + 1) % s.certificate.multipliers.len();
            let half = s.certificate.multipliers[k] / 2.0;
            s.certificate.multipliers[k] -= half;
            s.certificate.multipliers[last] += half;
        });
    }
    let mut moved = values.clone();
    for at in (0..values.len()).step_by(17) {
        moved[at] += 1e-3;
        assert!(found.check(&Points::new(&moved, columns).unwrap()).is_err());
        moved[at] = values[at];
    }
}
