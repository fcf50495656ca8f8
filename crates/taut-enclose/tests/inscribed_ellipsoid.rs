//! The inscribed ellipsoid: closed forms, laws, polytopes without one, doctored answers.

use taut_certify::{InscribedEllipsoid, Solution, Stop};
use taut_enclose::{Error, InscribedOptions, inscribed_ellipsoid};
use taut_points::{Distribution, Points, generate};

fn solved(rows: &[f64], dim: usize) -> Solution<InscribedEllipsoid> {
    let rows = Points::new(rows, dim + 1).unwrap();
    let found = inscribed_ellipsoid(&rows, &InscribedOptions::default()).unwrap();
    let verdict = found
        .check(&rows)
        .unwrap_or_else(|e| panic!("{e}: {:?} {:e}", found.trace, found.certificate.gap));
    assert!(verdict.gap <= 1e-9, "{:e} {:?}", verdict.gap, found.trace);
    found
}

fn log_ball(dim: usize) -> f64 {
    let (start, first) = if dim.is_multiple_of(2) { (0.0, 2) } else { (2f64.ln(), 3) };
    start + (first..=dim).step_by(2).map(|d| f64::ln(std::f64::consts::TAU / d as f64)).sum::<f64>()
}

/// The box of these half widths around a centre.
fn sides_of_box(center: &[f64], widths: &[f64]) -> Vec<f64> {
    let dim = widths.len();
    let mut rows = vec![];
    for j in 0..dim {
        for sign in [1.0, -1.0] {
            rows.extend((0..dim).map(|k| if k == j { sign } else { 0.0 }));
            rows.push(sign * center[j] + widths[j]);
        }
    }
    rows
}

/// Random tangent planes of the unit ball, each moved out a little.
fn random_sides(n: usize, dim: usize, seed: u64) -> Vec<f64> {
    let normals: Vec<f64> = generate(Distribution::Sphere, n, dim, seed).unwrap();
    let rows = normals.chunks(dim).enumerate();
    rows.flat_map(|(i, a)| {
        a.iter().copied().chain([1.0 + (i % 5) as f64 * 0.1]).collect::<Vec<_>>()
    })
    .collect()
}

#[test]
fn a_box_holds_the_ellipsoid_of_its_half_widths() {
    for widths in [vec![3.0], vec![1.0, 5.0], vec![1e-3, 1.0, 1e4], vec![1.0; 8]] {
        let dim = widths.len();
        let found = solved(&sides_of_box(&vec![10.0; dim], &widths), dim);
        let wanted = log_ball(dim) + widths.iter().map(|w| w.ln()).sum::<f64>();
        assert!((found.answer.log_volume - wanted).abs() < 1e-9, "{widths:?}");
    }
}

/// The simplex {x ≥ 0, Σx ≤ 1}: the image of a regular one, whose inscribed ball has radius 1/√(d(d + 1)) at edges √2.
#[test]
fn a_simplex_holds_the_image_of_the_ball_in_the_regular_one() {
    for dim in [2, 3, 5, 9] {
        let mut rows = vec![];
        for j in 0..dim {
            rows.extend((0..dim).map(|k| if k == j { -1.0 } else { 0.0 }));
            rows.push(0.0);
        }
        rows.extend(vec![1.0; dim + 1]);
        let found = solved(&rows, dim);
        let d = dim as f64;
        // Volumes: that of the ball times 1/d! over √(d + 1)/d!.
        let wanted = log_ball(dim) - 0.5 * d * (d * (d + 1.0)).ln() - 0.5 * (d + 1.0).ln();
        assert!((found.answer.log_volume - wanted).abs() < 1e-9, "d = {dim}");
        assert!(found.answer.center.iter().all(|c| (c - 1.0 / (d + 1.0)).abs() < 1e-5));
    }
}

#[test]
fn random_polytopes_are_solved_and_their_affine_images_alike() {
    for (seed, (n, dim)) in [(12, 2), (30, 3), (100, 5), (200, 8)].into_iter().enumerate() {
        let rows = random_sides(n, dim, seed as u64);
        let plain = solved(&rows, dim);
        // x ↦ Dx + e: normals are divided by D.
        let scale = |j: usize| 10f64.powi(3 * (j % 3) as i32 - 2);
        let moved: Vec<f64> = rows
            .chunks(dim + 1)
            .flat_map(|row| {
                let a: Vec<f64> = (0..dim).map(|j| row[j] / scale(j)).collect();
                let b = row[dim] + a.iter().sum::<f64>() * 7.0;
                a.into_iter().chain([b]).collect::<Vec<_>>()
            })
            .collect();
        let found = solved(&moved, dim);
        let logs: f64 = (0..dim).map(|j| scale(j).ln()).sum();
        let off = found.answer.log_volume - plain.answer.log_volume - logs;
        assert!(off.abs() < 3e-9, "{off:e}");
    }
}

#[test]
fn polytopes_without_an_ellipsoid_are_named_with_the_reason() {
    let solve = |rows: &[f64], columns: usize| {
        inscribed_ellipsoid(&Points::new(rows, columns).unwrap(), &InscribedOptions::default())
            .unwrap_err()
    };
    // A strip, and a quadrant.
    match solve(&[1.0, 0.0, 1.0, -1.0, 0.0, 1.0], 3) {
        Error::Unbounded { direction } => assert!(direction[0].abs() < 1e-9),
        other => panic!("{other}"),
    }
    match solve(&[-1.0, 0.0, 0.0, 0.0, -1.0, 0.0], 3) {
        Error::Unbounded { direction } => assert!(direction.iter().all(|&v| v > -1e-6)),
        other => panic!("{other}"),
    }
    // x ≤ 0 and x ≥ 1; then x ≤ 0 and x ≥ 0, each with a box around.
    for gap in [1.0, 0.0] {
        let mut rows = sides_of_box(&[0.0, 0.0], &[5.0, 5.0]);
        rows.extend([1.0, 0.0, 0.0, -1.0, 0.0, -gap]);
        match solve(&rows, 3) {
            Error::NoInterior { rows, multipliers, is_empty } => {
                assert_eq!(is_empty, gap > 0.0);
                assert!(rows.contains(&4) && rows.contains(&5), "{rows:?}");
                assert!(multipliers.iter().all(|&l| l > 0.0));
            }
            other => panic!("{other}"),
        }
    }
    assert!(matches!(solve(&[0.0, 0.0, 1.0], 3), Error::NoNormal { row: 0 }));
    assert!(matches!(solve(&[1.0, f64::NAN, 1.0], 3), Error::NonFinite { row: 0, column: 1, .. }));
    assert!(matches!(solve(&[1.0], 1), Error::NoNormal { row: 0 }));
    assert!(matches!(solve(&[], 3), Error::Empty));
}

#[test]
fn doctored_answers_are_refused() {
    let values = random_sides(40, 3, 9);
    let rows = Points::new(&values, 4).unwrap();
    let found = inscribed_ellipsoid(&rows, &InscribedOptions::default()).unwrap();
    found.check(&rows).unwrap();
    let refused = |what: &str, doctor: &dyn Fn(&mut Solution<InscribedEllipsoid>)| {
        let mut other = found.clone();
        doctor(&mut other);
        assert!(other != found, "{what} changes nothing");
        assert!(other.check(&rows).is_err(), "{what} is accepted");
    };
    refused("a larger ellipsoid", &|s| {
        s.answer.axes.iter_mut().flatten().for_each(|g| *g *= 1.0 + 1e-11)
    });
    refused("a smaller ellipsoid", &|s| {
        s.answer.axes.iter_mut().flatten().for_each(|g| *g *= 1.0 - 1e-6)
    });
    refused("another volume", &|s| s.answer.log_volume += 1e-9);
    refused("a gap of 0", &|s| s.certificate.gap = 0.0);
    refused("another hash", &|s| s.certificate.points_hash.0 ^= 1);
    refused("fewer rows", &|s| s.answer.axes.truncate(2));
    refused("fewer multipliers", &|s| s.certificate.multipliers.truncate(1));
    for j in 0..3 {
        refused("a moved centre", &|s| s.answer.center[j] += 1e-6);
        refused("a moved centre", &|s| s.answer.center[j] -= 1e-6);
        for k in 0..3 {
            refused("a bent axis", &|s| s.answer.axes[j][k] += 1e-6);
            refused("a NaN", &|s| s.answer.axes[j][k] = f64::NAN);
        }
    }
    let largest = found.certificate.multipliers.iter().copied().fold(0.0, f64::max);
    for k in 0..found.certificate.support.len() {
        if found.certificate.multipliers[k] > 1e-3 * largest {
            refused("a larger multiplier", &|s| s.certificate.multipliers[k] *= 1.01);
            refused("a smaller multiplier", &|s| s.certificate.multipliers[k] *= 0.5);
        }
        refused("a negative multiplier", &|s| s.certificate.multipliers[k] *= -1.0);
        refused("a row that is not", &|s| s.certificate.support[k] += 1000);
    }
}

#[test]
fn only_half_spaces_that_touch_have_multipliers() {
    for (n, dim) in [(40, 3), (60, 5)] {
        let rows = random_sides(n, dim, 9);
        let found = solved(&rows, dim);
        let most = dim * (dim + 3) / 2;
        assert!(found.certificate.support.len() <= most, "{:?}", found.certificate.support);
        // And so the others can be left out.
        let few: Vec<f64> = found
            .certificate
            .support
            .iter()
            .flat_map(|&i| rows[i as usize * (dim + 1)..][..dim + 1].to_vec())
            .collect();
        let again = solved(&few, dim);
        assert!((again.answer.log_volume - found.answer.log_volume).abs() < 1e-9);
    }
}

#[test]
fn what_cannot_be_reached_is_not_called_reached() {
    // The fifth half-space touches the ellipse of the others, but has no part in it.
    let mut sides = sides_of_box(&[2.0, 1.0], &[2.0, 1.0]);
    sides.extend([1.0, 1.0, 3.0 + 5f64.sqrt()]);
    let sides = Points::new(&sides, 3).unwrap();
    for epsilon in [1e-13, 1e-16, 1e-300] {
        let options = InscribedOptions { epsilon, ..Default::default() };
        let found = inscribed_ellipsoid(&sides, &options).unwrap();
        let gap = found.check(&sides).unwrap().gap;
        assert!(gap < 1e-12, "{epsilon}: {gap:e}");
        assert!(found.trace.stop != Stop::Converged || found.certificate.gap <= epsilon);
    }
}

/// Boxes of 1 by 1 by some length, turned: their axes are nearly parallel, and no digit of the volume may get lost.
#[test]
fn long_boxes_that_stand_askew() {
    let u = [[2.0, 1.0, 2.0], [-2.0, 2.0, 1.0], [1.0, 2.0, -2.0]].map(|u| u.map(|v| v / 3.0));
    for length in [1e2, 1e3, 1e4] {
        let mut rows = vec![];
        for (normal, width) in u.iter().zip([1.0, 1.0, length]) {
            for sign in [1.0, -1.0] {
                rows.extend(normal.iter().map(|v| sign * v).chain([width]));
            }
        }
        let found = solved(&rows, 3);
        let wanted = log_ball(3) + f64::ln(length);
        assert!((found.answer.log_volume - wanted).abs() < 1e-9, "{length}");
    }
}
