//! The inscribed ellipsoid: closed forms, laws, polytopes without one, doctored answers.

use taut_certify::{CheckError, InscribedEllipsoid, Solution, Stop, Violation};
use taut_enclose::{Error, InscribedOptions, inscribed_ellipsoid};
use taut_points::{Distribution, InputError, Points, generate};

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

/// The box of these half widths around a center.
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
            Error::NoInterior { rows, multipliers, radius } => {
                assert!(
                    (0.0..1e-7).contains(&radius) && (gap == 0.0 || radius == 0.0),
                    "{radius:e}"
                );
                assert!(rows.contains(&4) && rows.contains(&5), "{rows:?}");
                assert!(multipliers.iter().all(|&l| l > 0.0));
            }
            other => panic!("{other}"),
        }
    }
    assert!(matches!(solve(&[0.0, 0.0, 1.0], 3), Error::NoNormal { row: 0 }));
    assert!(matches!(
        solve(&[1.0, f64::NAN, 1.0], 3),
        Error::Input(InputError::NonFinite { row: 0, column: 1, .. })
    ));
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
        refused("a moved center", &|s| s.answer.center[j] += 1e-6);
        refused("a moved center", &|s| s.answer.center[j] -= 1e-6);
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

/// The box of these half widths around a center, turned by 30 degrees in the plane of the first two axes.
fn sides_of_turned_box(center: &[f64], widths: &[f64]) -> Vec<f64> {
    let dim = widths.len();
    let (cos, sin) = (0.75f64.sqrt(), 0.5);
    let mut rows = sides_of_box(&vec![0.0; dim], widths);
    for row in rows.chunks_mut(dim + 1) {
        (row[0], row[1]) = (cos * row[0] - sin * row[1], sin * row[0] + cos * row[1]);
        row[dim] += row[..dim].iter().zip(center).map(|(a, c)| a * c).sum::<f64>();
    }
    rows
}

/// Where pivots cancel, the determinant is known to the last digits all the same.
#[test]
fn thin_boxes_that_are_turned_have_their_volume() {
    for thin in [1e-4, 1e-5, 1e-6, 1e-7, 1e-8] {
        for widths in [vec![1.0, thin], vec![1.0, thin, 0.5], vec![thin, 1.0, thin * 3.0, 2.0]] {
            let dim = widths.len();
            let found = solved(&sides_of_turned_box(&vec![0.0; dim], &widths), dim);
            let wanted = log_ball(dim) + widths.iter().map(|w| w.ln()).sum::<f64>();
            assert!((found.answer.log_volume - wanted).abs() < 1e-8, "{widths:?}");
        }
    }
}

/// A half-space is the same whatever its row is multiplied by, as long as squares are not taken of it.
#[test]
fn rows_of_any_length_are_the_same_half_spaces() {
    let plain = random_sides(20, 3, 5);
    let wanted = solved(&plain, 3);
    for (least, most) in [(-560, 560), (-1000, -900), (900, 1000)] {
        let scaled: Vec<f64> = plain
            .chunks(4)
            .enumerate()
            .flat_map(|(i, row)| {
                let power = 2f64.powi(least + (i as i32 * 97) % (most - least + 1));
                row.iter().map(|v| v * power).collect::<Vec<_>>()
            })
            .collect();
        let found = solved(&scaled, 3);
        assert_eq!(found.answer, wanted.answer);
        assert_eq!(found.certificate.multipliers, wanted.certificate.multipliers);
    }
    // A box that is small beyond all squares.
    let found = solved(&sides_of_box(&[0.0, 0.0], &[1e-170, 2e-170]), 2);
    assert!(
        (found.answer.log_volume - log_ball(2) - 2.0 * 1e-170f64.ln() - 2f64.ln()).abs() < 1e-9
    );
}

/// A row so short that its square is 0 cuts as any other does.
#[test]
fn a_tiny_row_cuts_the_disc() {
    let mut values = sides_of_box(&[0.0, 0.0], &[1.0, 1.0]);
    let square = solved(&values, 2);
    values.extend([1e-170, 0.0, 0.5e-170]);
    let found = solved(&values, 2);
    assert!((found.answer.log_volume - log_ball(2) - 0.75f64.ln()).abs() < 1e-9);
    let mut forged = square;
    forged.certificate.points_hash = found.certificate.points_hash;
    let refusal = forged.check(&Points::new(&values, 3).unwrap());
    assert!(
        matches!(refusal, Err(CheckError::Rejected(Violation::OutsideHalfSpace { row: 4, .. }))),
        "{refusal:?}"
    );
}

/// Forgeries that are consistent in themselves, on turned and on tiny rows.
#[test]
fn forged_ellipsoids_are_refused() {
    let tiny = |values: Vec<f64>| -> Vec<f64> { values.iter().map(|v| v * 1e-165).collect() };
    let turned = sides_of_turned_box(&[0.3, -0.2], &[1.0, 1e-3]);
    for values in
        [turned.clone(), tiny(turned), random_sides(12, 2, 3), tiny(random_sides(12, 2, 4))]
    {
        let rows = Points::new(&values, 3).unwrap();
        let found = solved(&values, 2);
        let refused = |what: &str, forge: &dyn Fn(&mut Solution<InscribedEllipsoid>)| {
            let mut forged = found.clone();
            forge(&mut forged);
            let refusal = forged.check(&rows);
            assert!(matches!(refusal, Err(CheckError::Rejected(_))), "{what}: {refusal:?}");
        };
        for times in [1.0 + 1e-9, 1.5, 1e100] {
            refused("grown", &|s| {
                s.answer.axes.iter_mut().flatten().for_each(|g| *g *= times);
                s.answer.log_volume += 2.0 * f64::ln(times);
            });
        }
        // Shrunk, with a gap that would do for the larger one.
        refused("shrunk", &|s| {
            s.answer.axes.iter_mut().flatten().for_each(|g| *g *= 0.5);
            s.answer.log_volume += 2.0 * 0.5f64.ln();
        });
        // Flat: no volume at all, whatever is claimed.
        for log_volume in [0.0, -1e300, 700.0, found.answer.log_volume] {
            for flat in [[[1e-9, 1e-9], [1e-9, 1e-9]], [[0.0; 2]; 2], [[0.1, 0.3], [0.3, 0.9]]] {
                refused("flat", &|s| {
                    s.answer.axes = flat.iter().map(|row| row.to_vec()).collect();
                    s.answer.log_volume = log_volume;
                });
            }
        }
        // Multipliers of other rows, and all of one row.
        refused("turned multipliers", &|s| s.certificate.multipliers.rotate_left(1));
        refused("one row", &|s| {
            s.certificate.support.truncate(1);
            s.certificate.multipliers.truncate(1);
        });
    }
}

/// What is not reached is not called so.
#[test]
fn a_gap_below_rounding_is_not_said_to_be_reached() {
    for epsilon in [1e-12, 1e-13, 1e-14, 1e-15] {
        let turned = sides_of_turned_box(&[0.0; 4], &[1.0, 0.3, 2.0, 0.1]);
        for (values, dim) in [(random_sides(40, 3, 9), 3), (turned, 4)] {
            let rows = Points::new(&values, dim + 1).unwrap();
            let options = InscribedOptions { epsilon, ..Default::default() };
            let found = inscribed_ellipsoid(&rows, &options).unwrap();
            found.check(&rows).unwrap();
            let is_reached = found.certificate.gap <= epsilon;
            assert_eq!(
                found.trace.stop == Stop::Converged,
                is_reached,
                "{epsilon:e} {:?}",
                found.trace
            );
        }
    }
}

/// Half-spaces as thin as rounding, at any angle: a ball, a proof that none is large, or nothing is claimed.
#[test]
fn what_is_said_of_thin_and_open_polytopes_is_proved() {
    for angle in [0.0, 0.3, 1.1, 2.5] {
        let (sin, cos) = f64::sin_cos(angle);
        for width in [1e-6, 1e-8, 1e-10, 1e-13, 0.0, -1e-13, -1e-9, -1e-3] {
            let mut rows = sides_of_box(&[0.0, 0.0], &[5.0, 5.0]);
            rows.extend([cos, sin, 0.25, -cos, -sin, width - 0.25]);
            let points = Points::new(&rows, 3).unwrap();
            match inscribed_ellipsoid(&points, &InscribedOptions::default()) {
                Ok(found) => {
                    assert!(width > 0.0);
                    found.check(&points).unwrap_or_else(|e| panic!("{angle} {width:e}: {e}"));
                }
                // Offsets are divided by the largest, 5.
                Err(Error::NoInterior { radius, .. }) => {
                    assert!(
                        radius >= width / 10.0 && radius < 1e-6,
                        "{angle} {width:e}: {radius:e}"
                    );
                }
                Err(Error::Undecided) => assert!(width.abs() < 1e-5, "{angle} {width:e}"),
                Err(other) => panic!("{angle} {width:e}: {other}"),
            }
        }
        // A strip, closed on one side: the only ray runs along both.
        let half = [cos, sin, 1.0, -cos, -sin, 1.0, sin, -cos, 2.0];
        match inscribed_ellipsoid(&Points::new(&half, 3).unwrap(), &InscribedOptions::default()) {
            Err(Error::Unbounded { direction }) => {
                assert!((direction[0] + sin).abs() + (direction[1] - cos).abs() < 1e-14);
            }
            other => panic!("{angle}: {other:?}"),
        }
    }
}

/// Subnormal multipliers times slacks underflow: they must not prove that an ellipsoid half as wide is the largest.
#[test]
fn multipliers_that_underflow_prove_nothing() {
    let dim = 10;
    let rows = sides_of_box(&vec![0.0; dim], &vec![1.0; dim]);
    let honest = solved(&rows, dim);
    let points = Points::new(&rows, dim + 1).unwrap();
    let mut forged = honest.clone();
    let axis = |j: usize, width: f64| (0..dim).map(|k| if k == j { width } else { 0.0 }).collect();
    forged.answer.axes = (0..dim).map(|j| axis(j, 0.51)).collect();
    forged.answer.center = vec![0.0; dim];
    forged.answer.log_volume = log_ball(dim) + dim as f64 * 0.51f64.ln();
    forged.certificate.support = (0..2 * dim as u64).collect();
    forged.certificate.gap = 0.0;
    for lambda in [5e-324, 1e-310, 1e-300, 1.0, 1e300] {
        forged.certificate.multipliers = vec![lambda; 2 * dim];
        match forged.check(&points) {
            Err(CheckError::Rejected(Violation::LogGap { proved, .. })) => {
                assert!((proved + dim as f64 * 0.51f64.ln()).abs() < 1e-9, "{lambda:e}: {proved}");
            }
            other => panic!("{lambda:e}: {other:?}"),
        }
    }
    // The ball of radius 1 is the largest, in whatever unit its multipliers are written down.
    let radius = 1.0 - 1e-12;
    forged.answer.axes = (0..dim).map(|j| axis(j, radius)).collect();
    forged.answer.log_volume = log_ball(dim) + dim as f64 * radius.ln();
    forged.certificate.gap = 1e-10;
    for lambda in [5e-324, 1e-310, 1e-300, 1.0, 1e300] {
        forged.certificate.multipliers = vec![lambda; 2 * dim];
        let gap = forged.check(&points).unwrap().gap;
        assert!(gap < 2e-11, "{lambda:e}: {gap:e}");
    }
}

/// The stated log-volume may be off by rounding; the bracket is not.
#[test]
fn the_lower_end_of_the_bracket_is_not_above_the_optimum() {
    for dim in 2..=8 {
        let rows = sides_of_box(&vec![0.0; dim], &vec![1.0; dim]);
        let points = Points::new(&rows, dim + 1).unwrap();
        let mut found = solved(&rows, dim);
        let optimum = log_ball(dim);
        let mut accepted = 0;
        for ulps in 0..400 {
            found.answer.log_volume = found.answer.log_volume.next_up();
            let Ok(verdict) = found.check(&points) else { continue };
            accepted += 1;
            // The optimum is known to some units in the last place here.
            assert!(verdict.lower <= optimum + 2e-15, "d = {dim}, {ulps}: {verdict:?}");
            assert!(verdict.upper >= optimum - 2e-15);
        }
        assert!(accepted > 0, "d = {dim}");
    }
}
