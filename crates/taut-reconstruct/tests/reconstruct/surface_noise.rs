//! Tests what the pre-pass makes of outliers and of noise, against the truth of drawn samples.

use taut_certify::{Solution, TopologyDoubt, TopologyReason};
use taut_reconstruct::{Denoise, SurfaceOptions};

use crate::surface_any::judge::{JudgedSurface, closed, found};
use crate::surface_any::points::{Point, chances, sphere};

fn denoised(points: &[Point]) -> JudgedSurface {
    let options = SurfaceOptions { denoise: Some(Denoise::default()), ..Default::default() };
    found(points, &options)
}

fn size(p: Point) -> f64 {
    p.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// A random unit sphere that is ten times as dense at the left end as at the right one.
fn uneven_sphere(count: usize, seed: u64) -> Vec<Point> {
    let mut chance = chances(seed + 1);
    let mut points = sphere(3 * count, [0.0; 3], 1.0, seed);
    points.retain(|p| chance() < 10f64.powf(-0.5 * (p[0] + 1.0)));
    points.truncate(count);
    points
}

/// Normal, nearly.
fn normal(chance: &mut impl FnMut() -> f64) -> f64 {
    (0..12).map(|_| chance()).sum::<f64>() - 6.0
}

#[test]
fn outliers_of_an_uneven_sample_are_found() {
    let sheet = uneven_sphere(6000, 5);
    let mut points = sheet.clone();
    let mut chance = chances(6);
    let mut within = |reach: f64| [0; 3].map(|_| reach * (2.0 * chance() - 1.0));
    points.extend((0..60).map(|_| within(1.5)));
    for _ in 0..3 {
        let middle = within(1.5);
        points.extend((0..8).map(|_| {
            let off = within(0.05);
            [0, 1, 2].map(|k| middle[k] + off[k])
        }));
    }
    let found = denoised(&points);
    assert!(found.is_closed() && found.topology.genus == Some(0));
    let named = &found.solution.answer.unused.outliers;
    let wrong = named.iter().filter(|&&row| (row as usize) < sheet.len()).count();
    // Spacings are 0.03 to 0.1.
    let is_far = |row: &u32| (size(points[*row as usize]) - 1.0).abs() > 0.2;
    let far: Vec<u32> = (sheet.len() as u32..points.len() as u32).filter(is_far).collect();
    let hits = far.iter().filter(|row| named.contains(row)).count();
    println!("{hits} of {} far outliers, {wrong} points of the sphere", far.len());
    assert!(20 * hits >= 19 * far.len() && wrong <= 2);
}

#[test]
fn an_uneven_sample_without_outliers_keeps_all_points() {
    let found = denoised(&uneven_sphere(6000, 15));
    assert!(found.solution.answer.unused.outliers.len() <= 2);
}

#[test]
fn noise_of_a_whole_spacing_leaves_the_topology() {
    // Radii 1 and 0.4, area 15.8, so a spacing of 0.036.
    let mut chance = chances(7);
    let mut torus = Vec::new();
    while torus.len() < 12_000 {
        let [around, across] = [0; 2].map(|_| std::f64::consts::TAU * chance());
        let ring = 1.0 + 0.4 * across.cos();
        if 1.4 * chance() < ring {
            torus.push([ring * around.cos(), ring * around.sin(), 0.4 * across.sin()]);
        }
    }
    let noisy: Vec<Point> =
        torus.iter().map(|p| p.map(|x| x + 0.036 * normal(&mut chance))).collect();
    let found = denoised(&noisy);
    assert!(found.is_closed() && found.topology.genus == Some(1));
    let off = |p: &Point| ((p[0].hypot(p[1]) - 1.0).hypot(p[2]) - 0.4).abs();
    let mean = |points: &[Point]| points.iter().map(off).sum::<f64>() / points.len() as f64;
    let (before, after) = (mean(&noisy), mean(&found.solution.answer.vertices));
    println!("mean distance {after} after, {before} before");
    assert!(after < 0.4 * before);
}

#[test]
fn a_far_point_is_named_where_nothing_was_taken_out() {
    // A spacing is 0.08.
    let ball = sphere(2000, [0.0; 3], 1.0, 8);
    assert_eq!(closed(&ball).solution.certificate.doubts, []);
    for &away in crate::test_length::long_or(&[0.4, 0.6, 1.5, 2.0, 9.0][..], &[0.4, 2.0]) {
        let mut points = ball.clone();
        points.push([0.0, away, 0.0]);
        let Solution { answer, certificate, .. } = closed(&points).solution;
        let is_tip = |doubt: &TopologyDoubt| {
            doubt.reason == TopologyReason::Spikes && doubt.rows.contains(&2000)
        };
        let is_left = [&answer.unused.interior, &answer.unused.unreferenced];
        let is_named = certificate.doubts.iter().any(is_tip)
            || is_left.iter().any(|rows| rows.contains(&2000));
        assert!(is_named, "{away}: {:?}", certificate.doubts);
        let found = denoised(&points).solution;
        assert_eq!(found.answer.unused.outliers, [2000], "{away}");
        assert_eq!(found.certificate.doubts, [], "{away}");
    }
}
