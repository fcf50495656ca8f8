//! Degenerate and extreme point sets by name, each judged, and a random stress over hard families.
//!
//! `TAUT_SOAK=<rounds>` lengthens the stress, raises its dimensions to 200 and prints the worst of what it saw.

use common::families::{Random, instance};
use common::{exact, exact_with, judge};
use taut_certify::Stop;
use taut_enclose::{BallOptions, Error, ball};
use taut_points::Points;

use crate::common;

/// The gap every exact answer must prove.
const GAP: f64 = 1e-13;

/// Judges a set whose radius is known.
fn known(name: &str, values: &[f64], dim: usize, radius: f64) {
    let found = exact(name, values, dim, GAP);
    let error = (found.answer.radius - radius).abs() / radius;
    assert!(error <= 1e-13, "{name}: radius {} against {radius}", found.answer.radius);
    effort(name, &found.trace, dim);
}

/// Counters that no healthy run exceeds.
fn effort(name: &str, trace: &taut_certify::Trace, dim: usize) {
    let stalls = trace.counters.get("stalls").copied().unwrap_or(0);
    assert!(
        trace.passes <= 60
            && trace.iterations <= 400 + 100 * dim as u64
            && stalls <= 50 + trace.iterations / 2,
        "{name}: {} passes, {} pivots, {stalls} stalls in {dim} dimensions",
        trace.passes,
        trace.iterations
    );
}

fn judged(name: &str, values: &[f64], dim: usize) {
    let found = exact(name, values, dim, GAP);
    effort(name, &found.trace, dim);
}

/// All points of a grid with `side` values in each of `dim` coordinates.
fn grid(side: usize, dim: usize) -> Vec<f64> {
    let n = side.pow(dim as u32);
    (0..n).flat_map(|i| (0..dim).map(move |j| (i / side.pow(j as u32) % side) as f64)).collect()
}

#[test]
fn one_point_or_one_place() {
    for dim in [1, 2, 7, 100] {
        let point = Random(dim as u64).normals(dim);
        for copies in [1, 2, 3, 5, 7, 100, 300, 3000] {
            for offset in [0.0, 0.1, 1e8, 1e300] {
                let one: Vec<f64> = point.iter().map(|x| x + offset).collect();
                let found = exact("one place", &one.repeat(copies), dim, 0.0);
                assert_eq!(found.answer.radius, 0.0, "{copies} copies in {dim} dimensions");
                assert_eq!(found.answer.center, one);
                let points = one.repeat(copies);
                let found = ball(&Points::new(&points, dim).unwrap(), &Default::default()).unwrap();
                assert_eq!(
                    found.trace.stop,
                    Stop::Converged,
                    "{copies} copies in {dim} dimensions"
                );
            }
        }
    }
}

#[test]
fn two_points() {
    for (a, b) in [(0.0, 1.0), (-1.0, 3.0), (0.1, 0.3), (1e8, 1e8 + 2.0), (-0.0, 0.0)] {
        let found = exact("two numbers", &[a, b], 1, 1e-15);
        let radius = (b - a) / 2.0;
        assert!((found.answer.radius - radius).abs() <= 1e-15 * radius, "{a}, {b}");
    }
    let mut random = Random(5);
    for dim in [2, 3, 50, 5000] {
        let values = random.normals(2 * dim);
        let distance2: f64 = (0..dim).map(|j| (values[j] - values[dim + j]).powi(2)).sum();
        known("two points", &values, dim, distance2.sqrt() / 2.0);
    }
}

#[test]
fn few_points_of_many_coordinates() {
    let mut random = Random(11);
    judged("3 in 100000", &random.normals(3 * 100_000), 100_000);
    judged("50 in 2000", &random.normals(50 * 2000), 2000);
    let shifted: Vec<f64> = random.normals(3 * 20_000).into_iter().map(|v| v + 100.0).collect();
    judged("3 in 20000, off the origin", &shifted, 20_000);
}

#[test]
fn numbers_on_a_line() {
    judged("random numbers", &Random(1).normals(1000), 1);
    known("0 to 9999", &(0..10_000).map(f64::from).collect::<Vec<_>>(), 1, 4999.5);
    let line: Vec<f64> = (0..500).flat_map(|i| [f64::from(i), 2.0 * f64::from(i), 0.0]).collect();
    known("collinear", &line, 3, 499.0 * 5f64.sqrt() / 2.0);
    let direction = Random(8).direction(30);
    let slanted: Vec<f64> =
        (0..2000).flat_map(|i| direction.iter().map(move |x| x * f64::from(i))).collect();
    known("collinear, slanted", &slanted, 30, 1999.0 / 2.0);
}

#[test]
fn cubes_and_grids() {
    known("cube 2^12", &grid(2, 12), 12, 12f64.sqrt() / 2.0);
    known("grid 3^8", &grid(3, 8), 8, 8f64.sqrt());
    known("grid 40^2", &grid(40, 2), 2, 39.0 / 2f64.sqrt());
    known("grid 9^3", &grid(9, 3), 3, 4.0 * 3f64.sqrt());
    let mut random = Random(3);
    let vertices: Vec<f64> = (0..2000 * 60).map(|_| (random.bits() & 1) as f64).collect();
    judged("2000 vertices of the cube in 60", &vertices, 60);
    // The cube of ten of thirty coordinates; the others stand still.
    let values: Vec<f64> = grid(2, 10)
        .chunks_exact(10)
        .flat_map(|row| row.iter().copied().chain([7.0; 20]).collect::<Vec<_>>())
        .collect();
    known("cube in a subspace", &values, 30, 10f64.sqrt() / 2.0);
    // The same cube, turned out of the axes.
    let turn: Vec<Vec<f64>> = orthonormal(&mut random, 10, 30);
    let turned: Vec<f64> = grid(2, 10)
        .chunks_exact(10)
        .flat_map(|row| {
            (0..30).map(|j| (0..10).map(|k| row[k] * turn[k][j]).sum()).collect::<Vec<f64>>()
        })
        .collect();
    known("turned cube in a subspace", &turned, 30, 10f64.sqrt() / 2.0);
}

/// `count` orthonormal vectors, by Gram and Schmidt, twice.
fn orthonormal(random: &mut Random, count: usize, dim: usize) -> Vec<Vec<f64>> {
    let mut basis: Vec<Vec<f64>> = vec![];
    while basis.len() < count {
        let mut v = random.direction(dim);
        for _ in 0..2 {
            for b in &basis {
                let along: f64 = v.iter().zip(b).map(|(v, b)| v * b).sum();
                v.iter_mut().zip(b).for_each(|(v, b)| *v -= along * b);
            }
            let norm = v.iter().map(|x| x * x).sum::<f64>().sqrt();
            v.iter_mut().for_each(|x| *x /= norm);
        }
        basis.push(v);
    }
    basis
}

#[test]
fn circles_and_spheres() {
    let polygon = |n: usize| -> Vec<f64> {
        (0..n)
            .flat_map(|i| {
                let (sin, cos) = (std::f64::consts::TAU * i as f64 / n as f64).sin_cos();
                [cos, sin]
            })
            .collect()
    };
    known("triangle", &polygon(3), 2, 1.0);
    known("pentagon", &polygon(5), 2, 1.0);
    judged("100000-gon", &polygon(100_000), 2);
    let far: Vec<f64> = polygon(1000).into_iter().map(|v| v + 1e8).collect();
    judged("1000-gon at 1e8", &far, 2);
    let mut globe = vec![];
    for i in 0..=90 {
        for k in 0..180 {
            let (theta, phi) = (f64::from(i) * 2f64.to_radians(), f64::from(k) * 2f64.to_radians());
            globe.extend([theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()]);
        }
    }
    known("longitudes and latitudes", &globe, 3, 1.0);
    let mut random = Random(21);
    for (dim, n) in [(2, 5000), (3, 5000), (5, 3000), (10, 3000), (30, 2000), (100, 1000)] {
        judged("sphere", &random.sphere(n, dim), dim);
    }
    judged("sphere, fewer points than coordinates", &random.sphere(200, 300), 300);
}

#[test]
fn simplices_and_cross_polytopes() {
    for dim in [2, 3, 10, 200] {
        let mut cross = vec![0.0; 2 * dim * dim];
        for j in 0..dim {
            cross[2 * j * dim + j] = 1.0;
            cross[(2 * j + 1) * dim + j] = -1.0;
        }
        known("cross-polytope", &cross, dim, 1.0);
        let mut simplex = vec![0.0; dim * dim];
        (0..dim).for_each(|j| simplex[j * dim + j] = 1.0);
        known("unit vectors", &simplex, dim, (1.0 - 1.0 / dim as f64).sqrt());
    }
}

#[test]
fn cospherical_but_for_noise() {
    let mut random = Random(77);
    for noise in [1e-4, 1e-8, 1e-12, 1e-15] {
        for round in 0..50 {
            let dim = 2 + round % 3;
            for n in [dim + 1, dim + 2, 2 * dim + 3] {
                let values: Vec<f64> =
                    random.sphere(n, dim).into_iter().map(|v| v + noise * random.unit()).collect();
                judged("few points, nearly cospherical", &values, dim);
            }
        }
        let values: Vec<f64> =
            random.sphere(1500, 40).into_iter().map(|v| v + noise * random.normal()).collect();
        exact("noisy sphere in 40", &values, 40, GAP);
    }
    // A square and a point that stands a hair outside its circle.
    for step in [1e-8, 1e-13, f64::EPSILON, -f64::EPSILON] {
        judged("square", &[1.0, 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, -1.0 - step], 2);
    }
    // An obtuse triangle on the way to a right one, and needles.
    for step in [1e-3, 1e-8, 1e-15, 1e-17, 0.0] {
        judged("nearly right triangle", &[-1.0, 0.0, 1.0, 0.0, 0.0, 1.0 + step], 2);
        judged("needle", &[-1.0, 0.0, 1.0, 0.0, 0.5, step], 2);
    }
}

#[test]
fn copies_and_near_copies() {
    let mut random = Random(9);
    let originals = random.normals(100 * 40);
    for noise in [0.0, 1e-9, 1e-15] {
        let mut values = Vec::with_capacity(100 * 200 * 40);
        for _ in 0..200 {
            values.extend(originals.iter().map(|v| v + noise * random.normal()));
        }
        judged(&format!("100 points, 200 copies {noise:e} apart"), &values, 40);
    }
    for noise in [1e-7, 1e-12, 1e-16] {
        let values: Vec<f64> = (0..3000)
            .flat_map(|i| {
                let at = if i % 2 == 0 { 0.0 } else { 1.0 };
                (0..10).map(|_| at + noise * random.normal()).collect::<Vec<_>>()
            })
            .collect();
        judged(&format!("two clusters {noise:e} wide"), &values, 10);
    }
}

#[test]
fn outliers_scales_and_lattices() {
    let mut random = Random(31);
    for far in [1e3, 1e8, 1e12, 1e16, 1e100] {
        let mut values = random.normals(2000 * 5);
        values[777 * 5 + 2] = far;
        judged(&format!("an outlier at {far:e}"), &values, 5);
    }
    let mut scales = random.normals(1000 * 16);
    for row in scales.chunks_exact_mut(16) {
        row.iter_mut().enumerate().for_each(|(j, v)| *v *= 10f64.powi(-(j as i32)));
    }
    judged("axes of 1 to 1e-15", &scales, 16);
    let lattice: Vec<f64> = (0..4000 * 6).map(|_| random.below(5) as f64 - 2.0).collect();
    judged("lattice", &lattice, 6);
    let flat: Vec<f64> = (0..1000)
        .flat_map(|_| {
            let (a, b) = (random.normal(), random.normal());
            (0..40).map(|j| a * f64::from(j) + b * f64::from(j * j % 7)).collect::<Vec<_>>()
        })
        .collect();
    judged("a plane in 40 dimensions", &flat, 40);
}

#[test]
fn far_from_the_origin() {
    let mut random = Random(41);
    for offset in [10.0, 1e3, 1e6, 1e8, 1e12] {
        for dim in [1, 2, 3, 10, 100] {
            let values: Vec<f64> =
                random.normals(500 * dim).into_iter().map(|v| v + offset).collect();
            let found = exact(&format!("offset {offset:e} in {dim}"), &values, dim, GAP);
            assert_eq!(found.answer.center_tail.is_empty(), offset <= 10.0);
        }
    }
    // Neighbors among the numbers of double precision.
    let one = 1e8f64;
    let values = [one, one.next_up(), one.next_up().next_up(), one.next_down()];
    known("neighboring numbers", &values, 1, 1.5 * (one.next_up() - one));
    judged("neighboring points", &values, 2);
}

#[test]
fn minus_zero_and_the_ends_of_the_range() {
    let found = exact("zeros of both signs", &[0.0, -0.0, -0.0, 0.0, 0.0, 0.0], 2, 0.0);
    assert_eq!(found.answer.radius, 0.0);
    judged("signed zeros in a triangle", &[-0.0, 1.0, 0.0, -1.0, 1.0, -0.0], 2);
    let mut random = Random(51);
    let values = random.normals(300 * 4);
    let plain = exact("unit scale", &values, 4, GAP).answer;
    for k in [-1000, -600, -530, -500, -300, -200, -190, 190, 200, 300, 500, 510, 520, 1000, 1020] {
        let factor = 2f64.powi(k);
        let scaled: Vec<f64> = values.iter().map(|v| v * factor).collect();
        let found = exact(&format!("scaled by 2^{k}"), &scaled, 4, GAP);
        assert_eq!(found.answer.radius, plain.radius * factor, "2^{k}");
    }
}

#[test]
fn the_largest_numbers() {
    let m = f64::MAX;
    let options = BallOptions { epsilon: 0.0, ..Default::default() };
    let far = [m, m, -m, -m];
    let found = ball(&Points::new(&far, 2).unwrap(), &options);
    assert!(matches!(found, Err(Error::Overflow)), "{found:?}");
    let found = ball(&Points::new(&[m, -m], 1).unwrap(), &options).unwrap();
    judge(&[m, -m], 1, &found).unwrap();
    assert_eq!((found.answer.radius, found.answer.center[0]), (m, 0.0));
    for copies in [1, 2, 3, 7, 300] {
        let found = exact("copies of the largest number", &vec![m; copies], 1, 0.0);
        assert_eq!((found.answer.radius, found.answer.center[0]), (0.0, m));
    }
    judged("large corner", &[m, m, m / 2.0, m, m, m / 2.0], 2);
    judged("large and small", &[m / 4.0, 0.0, 0.0, 1.0, -1.0, 5e-324], 2);
    // Early balls may be larger than the last: what the history says must be numbers, too.
    let mut random = Random(61);
    for _ in 0..20 {
        let values: Vec<f64> = random.sphere(400, 3).iter().map(|v| v * 0.9999 * m).collect();
        match ball(&Points::new(&values, 3).unwrap(), &options) {
            Ok(found) => drop(judge(&values, 3, &found).unwrap()),
            Err(error) => assert!(matches!(error, Error::Overflow), "{error}"),
        }
    }
}

#[test]
fn the_smallest_numbers() {
    // With spacing 5e-324 a center is far from exact, but the ball must enclose, and say how tight it is.
    let tiny = 5e-324;
    for values in [
        vec![0.0, tiny],
        vec![0.0, 3.0 * tiny, tiny],
        vec![0.0, 2.0 * tiny, 4.0 * tiny],
        (0..30).map(|i| f64::from(i) * tiny).collect(),
    ] {
        let found = ball(&Points::new(&values, 1).unwrap(), &Default::default()).unwrap();
        judge(&values, 1, &found).unwrap_or_else(|error| panic!("{values:?}: {error}; {found:?}"));
    }
    let mut random = Random(71);
    for exponent in [-318, -315, -312, -308] {
        let values: Vec<f64> =
            random.normals(30 * 3).iter().map(|v| v * 10f64.powi(exponent)).collect();
        let found = ball(&Points::new(&values, 3).unwrap(), &Default::default()).unwrap();
        judge(&values, 3, &found).unwrap_or_else(|error| panic!("1e{exponent}: {error}"));
    }
}

#[test]
fn stress() {
    let soak: Option<u64> = std::env::var("TAUT_SOAK")
        .ok()
        .map(|rounds| rounds.parse().expect("TAUT_SOAK counts rounds"));
    let start: u64 = std::env::var("TAUT_SOAK_START").map_or(0, |s| s.parse().expect("a number"));
    let (rounds, dim_max) = soak.map_or((150, 40), |rounds| (rounds, 200));
    let mut worst = (0.0f64, 0, 0, 0u64);
    let mut failures = vec![];
    let mut told = 0;
    for seed in start..start + rounds {
        let instance = instance(seed, dim_max);
        let options = BallOptions { epsilon: 0.0, batch: instance.batch, ..Default::default() };
        let name = format!(
            "seed {seed}: {:?}, n {}, d {}, offset {:e}, batch {:?}",
            instance.family, instance.n, instance.dim, instance.offset, instance.batch
        );
        let points = Points::new(&instance.values, instance.dim).unwrap();
        let found = match ball(&points, &options) {
            Ok(found) => found,
            Err(error) => {
                failures.push(format!("{name}: {error}"));
                continue;
            }
        };
        let stalls = found.trace.counters.get("stalls").copied().unwrap_or(0);
        let pivots = found.trace.iterations;
        match judge(&instance.values, instance.dim, &found) {
            Ok(proof) if proof.gap > 2e-13 => {
                failures.push(format!("{name}: gap {:e}, {:?}", proof.gap, found.trace.stop));
            }
            Ok(proof) => worst.0 = worst.0.max(proof.gap),
            Err(error) => failures.push(format!("{name}: {error}")),
        }
        if found.trace.stop != Stop::Converged {
            failures.push(format!("{name}: stopped by {:?}", found.trace.stop));
        }
        // One far point at a time needs about as many passes as there are pivots.
        let passes_max = match instance.batch {
            None | Some(64) => 60,
            Some(m) => 60 + 10 * instance.dim as u64 / m as u64 + 3 * pivots,
        };
        if found.trace.passes > passes_max
            || stalls > 50 + pivots / 2
            || pivots > 400 + 100 * instance.dim as u64
        {
            failures.push(format!(
                "{name}: {} passes, {pivots} pivots, {stalls} stalls",
                found.trace.passes
            ));
        }
        worst =
            (worst.0, worst.1.max(found.trace.passes), worst.2.max(stalls), worst.3.max(pivots));
        if soak.is_some() {
            failures.iter().skip(told).for_each(|failure| println!("{failure}"));
            told = failures.len();
        }
        if soak.is_some() && seed % 500 == 499 {
            println!(
                "{} rounds: gap {:e}, passes {}, stalls {}, pivots {}; {} failures",
                seed + 1 - start,
                worst.0,
                worst.1,
                worst.2,
                worst.3,
                failures.len()
            );
        }
    }
    assert!(failures.is_empty(), "{} failures:\n{}", failures.len(), failures.join("\n"));
}

#[test]
fn every_batch_gives_the_same_ball() {
    let mut random = Random(81);
    let values = random.normals(2000 * 12);
    let wanted = exact("default", &values, 12, GAP);
    for batch in [1, 2, 3, 7, 1000, 5000, usize::MAX] {
        let options = BallOptions { epsilon: 0.0, batch: Some(batch), ..Default::default() };
        let found = exact_with(&format!("batch {batch}"), &values, 12, GAP, &options);
        assert!((found.answer.radius / wanted.answer.radius - 1.0).abs() <= 1e-13);
        assert_eq!(found.certificate.support, wanted.certificate.support);
    }
}

#[test]
fn columns_of_very_different_sizes() {
    let normal: Vec<f64> =
        taut_points::generate(taut_points::Distribution::Normal, 60, 3, 8).unwrap();
    // One column constant or almost, the others far smaller than what it could tell apart.
    let with_first = |first: f64, scale: f64| -> Vec<f64> {
        normal.chunks_exact(3).flat_map(|p| [first, p[1] * scale, p[2] * scale]).collect()
    };
    let cases: [(&str, usize, Vec<f64>); 8] = [
        ("a large constant beside the smallest", 2, vec![1e9, 1e-305, 1e9, 2e-305]),
        ("a tenth beside 1e-25", 3, with_first(0.3, 1e-25)),
        ("1e300 beside 1e-200", 3, with_first(1e300, 1e-200)),
        ("1e300 beside 1e-300", 3, with_first(1e300, 1e-300)),
        ("-1e9 beside 1e-160", 3, with_first(-1e9, 1e-160)),
        ("far apart and a little aside", 2, vec![1e70, 0.0, -1e70, 1e-300]),
        ("a corner", 2, vec![1e200, 0.0, -1e200, 1e-160, 0.0, 1e200]),
        ("the ends of the range", 2, vec![1e300, 0.0, -1e300, 1e-100]),
    ];
    for (name, dim, values) in cases {
        exact(name, &values, dim, 1e-13);
    }
}
