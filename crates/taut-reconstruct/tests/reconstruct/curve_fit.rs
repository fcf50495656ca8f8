//! Curves of noisy points: laws, accuracy, connectivity, degenerate inputs.

use taut_certify::{Curve, Solution};
use taut_mesh::{Polyline, Quality, compare};
use taut_points::{
    Distribution, Points, generate,
    generate::curves::{CurveNoise, TestCurve, TruthCurves, sample_curve},
};
use taut_reconstruct::{CurveMethod, CurveOptions, curve};

use crate::test_length::long_or;

fn fitted(points: &[f64]) -> Solution<Curve> {
    let points = Points::new(points, 2).expect("pairs");
    let options = CurveOptions { method: CurveMethod::Fit, ..Default::default() };
    let found = curve(&points, &options).expect("finite points of the plane");
    found.check(&points).expect("the checker agrees");
    found
}

fn quality(truth: &TruthCurves, found: &Curve) -> Quality {
    let line = |(vertices, &closed)| Polyline { vertices, closed };
    let truth: Vec<Polyline<'_>> =
        truth.loops.iter().map(|l| &l[..]).zip(&truth.closed).map(line).collect();
    let found: Vec<Polyline<'_>> =
        found.curves.iter().map(|c| line((&c.vertices[..], &c.closed))).collect();
    compare(&truth, &found)
}

fn sampled(
    name: &str,
    n: usize,
    outliers: f64,
    gaussian: bool,
    seed: u64,
) -> (TruthCurves, Vec<f64>) {
    let truth = TestCurve::named(name).expect("a test curve").build();
    let noise = CurveNoise { delta: 0.05, outliers, gaussian, ..Default::default() };
    let points = sample_curve(&truth, n, &noise, seed).points;
    (truth, points)
}

/// The rms that FitConnect reaches on 2000 points at noise 0.05, as measured for the bench.
#[test]
fn two_thousand_points_of_each_test_curve() {
    let known = [
        ("circle", 0.0133),
        ("ellipse3", 0.0214),
        ("flower5", 0.0226),
        ("bumpy", 0.0224),
        ("gear20", 0.0217),
        ("multi4", 0.0217),
    ];
    for (name, most) in known.into_iter().step_by(long_or(1, 2)) {
        let (truth, points) = sampled(name, 2000, 0.0, false, 7);
        let found = quality(&truth, &fitted(&points).answer);
        assert!(found.topology_right(), "{name}: {found:?}");
        assert!(found.vertex_rms < 0.8 * most, "{name}: {found:?}");
    }
}

/// Samples in which some windows are flat by chance, within the band or across it: no vertex is to be at one.
#[test]
fn what_is_flat_by_chance_is_no_part_of_the_curve() {
    let sets = [
        ("circle", 6283, 0.0, 10),
        ("circle", 6283, 0.1, 11),
        ("ellipse3", 20_194, 0.0, 7),
        ("ellipse3", 20_194, 0.1, 8),
        ("ellipse3", 20_194, 0.1, 28),
    ];
    for (name, n, outliers, seed) in sets.into_iter().step_by(long_or(1, 4)) {
        let (truth, points) = sampled(name, n, outliers, false, seed);
        let found = quality(&truth, &fitted(&points).answer);
        assert!(found.topology_right() && found.hausdorff < 0.012, "{name} {seed}: {found:?}");
    }
}

/// Uniform noise has an edge, and the error falls faster than that of any average: at least as n^(−0.6) here.
#[test]
fn the_error_falls_with_the_number_of_points() {
    let rms = |n: usize| -> f64 {
        let sum: f64 = (1..=3)
            .map(|seed| {
                let (truth, points) = sampled("circle", n, 0.0, false, seed);
                quality(&truth, &fitted(&points).answer).vertex_rms.ln()
            })
            .sum();
        sum / 3.0
    };
    let slope = (rms(16_000) - rms(1000)) / 16f64.ln();
    assert!(slope < -0.6, "{slope}");
}

#[test]
fn outliers_and_normal_noise_leave_the_curve_where_it_is() {
    let (truth, points) = sampled("ellipse3", 8000, 0.1, false, 3);
    let found = fitted(&points);
    assert!((600..1000).contains(&found.answer.outliers.len()), "{}", found.answer.outliers.len());
    let found = quality(&truth, &found.answer);
    assert!(found.topology_right() && found.vertex_rms < 0.005, "{found:?}");

    let (truth, points) = sampled("ellipse3", 8000, 0.0, true, 3);
    let found = fitted(&points);
    assert!((found.answer.noise - 0.15).abs() < 0.015, "three deviations: {}", found.answer.noise);
    let found = quality(&truth, &found.answer);
    assert!(found.topology_right() && found.vertex_rms < 0.012, "{found:?}");
}

#[test]
fn the_noise_is_told() {
    let (_, points) = sampled("ellipse3", 8000, 0.0, false, 5);
    let noise = fitted(&points).answer.noise;
    assert!((noise - 0.05).abs() < 0.003, "{noise}");
}

/// Scaled by 10^±6, turned, shifted by a thousand diameters, shuffled: the same curves, to 1e-6 of their size.
#[test]
fn curves_turn_scale_and_shift_with_the_points() {
    let kinds = [
        ("circle", 3000, 0.0, 1),
        ("flower5", 4000, 0.1, 2),
        ("multi4", 6000, 0.0, 3),
        ("gear20", 2500, 0.0, 4),
    ];
    for (name, n, outliers, seed) in
        kinds.into_iter().skip(long_or(0, 1)).take(long_or(usize::MAX, 1))
    {
        let (_, points) = sampled(name, n, outliers, false, seed);
        let size = points.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let original = fitted(&points).answer;
        let (sin, cos) = 0.7_f64.sin_cos();
        for (scale, turned, shift) in [
            (1e6, false, 0.0),
            (1e-6, false, 0.0),
            (1.0, true, 0.0),
            (1.0, false, 2e3 * size),
            (1e3, true, 7.0),
        ] {
            let there = |[x, y]: [f64; 2]| {
                let [x, y] = if turned { [cos * x - sin * y, sin * x + cos * y] } else { [x, y] };
                [scale * (x + shift), scale * (y - shift)]
            };
            // Backwards, too: the order of rows means nothing.
            let moved: Vec<f64> =
                points.chunks(2).rev().flat_map(|p| there([p[0], p[1]])).collect();
            let found = fitted(&moved).answer;
            assert_eq!(found.curves.len(), original.curves.len(), "{name}");
            assert_eq!(found.outliers.len(), original.outliers.len(), "{name}");
            let tolerance = 1e-6 * scale * size;
            for wanted in &original.curves {
                let near = |c: &taut_certify::CurveComponent| {
                    is_the_same_cycle(&c.vertices, &wanted.vertices, there, tolerance)
                };
                assert!(found.curves.iter().any(near), "{name} {scale} {turned} {shift}");
            }
        }
    }
}

/// Each vertex is where the turn takes it, and the first is the first: nothing goes by the order of rows or by how the plane lies.
#[test]
fn curves_turn_with_the_points_vertex_by_vertex() {
    let noise = CurveNoise { delta: 0.2, outliers: 0.02, ..Default::default() };
    let blob = |seed: u64| {
        let truth = TestCurve::random(seed).build_with(3000);
        sample_curve(&truth, 1500 + 500 * (seed % 6) as usize, &noise, seed).points
    };
    let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
    let mut sets: Vec<Vec<f64>> = (0..16).map(blob).collect();
    sets.extend((0..6).map(|seed| around_polygon(&square, 1500, 0.05, seed)));
    sets.extend((0..4).map(|seed| sampled("wave", 2000, 0.0, false, seed).1));
    for (set, points) in sets.iter().enumerate().step_by(long_or(1, 8)) {
        let original = fitted(points).answer;
        let size = points.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        for (cos, sin) in [(0.0, 1.0), (-1.0, 0.0), (1.1_f64.cos(), 1.1_f64.sin())] {
            let turned = |[x, y]: [f64; 2]| [cos * x - sin * y, sin * x + cos * y];
            let moved: Vec<f64> = points.chunks(2).flat_map(|p| turned([p[0], p[1]])).collect();
            let found = fitted(&moved).answer;
            assert_eq!(found.outliers, original.outliers, "{set} {sin}");
            assert_eq!(found.curves.len(), original.curves.len(), "{set} {sin}");
            for (found, wanted) in found.curves.iter().zip(&original.curves) {
                assert_eq!(found.vertices.len(), wanted.vertices.len(), "{set} {sin}");
                for (&a, &b) in found.vertices.iter().zip(&wanted.vertices) {
                    let b = turned(b);
                    let off = (a[0] - b[0]).hypot(a[1] - b[1]);
                    assert!(off <= 1e-6 * size, "{set} {sin}: {a:?} {b:?}");
                }
            }
        }
    }
}

/// Tests whether `found` is `wanted` moved, from any start and either way round.
fn is_the_same_cycle(
    found: &[[f64; 2]],
    wanted: &[[f64; 2]],
    there: impl Fn([f64; 2]) -> [f64; 2],
    tolerance: f64,
) -> bool {
    let count = wanted.len();
    let near = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]) <= tolerance;
    found.len() == count
        && (0..count).any(|start| {
            near(found[start], there(wanted[0]))
                && [1, count - 1].into_iter().any(|step| {
                    (0..count).all(|k| near(found[(start + k * step) % count], there(wanted[k])))
                })
        })
}

#[test]
fn threads_and_order_change_no_bit() {
    let (_, points) = sampled("multi4", 5000, 0.05, false, 9);
    let json = |points: &[f64], threads: usize| {
        let points = Points::new(points, 2).expect("pairs");
        let options =
            CurveOptions { method: CurveMethod::Fit, threads: Some(threads), ..Default::default() };
        let found = curve(&points, &options).expect("finite");
        (found.to_json(), found.answer.curves)
    };
    let (one, curves) = json(&points, 1);
    for threads in [2, 3, 8] {
        assert_eq!(json(&points, threads).0, one);
    }
    let backwards: Vec<f64> = points.chunks(2).rev().flatten().copied().collect();
    assert_eq!(json(&backwards, 2).1, curves);
}

/// A polygon's outline with uniform noise across it.
fn around_polygon(corners: &[[f64; 2]], n: usize, noise: f64, seed: u64) -> Vec<f64> {
    let places: Vec<f64> = generate(Distribution::Uniform, n, 2, seed).expect("numbers");
    let sides: Vec<([f64; 2], [f64; 2])> =
        corners.iter().copied().zip(corners.iter().copied().cycle().skip(1)).collect();
    let length = |(a, b): &([f64; 2], [f64; 2])| (b[0] - a[0]).hypot(b[1] - a[1]);
    let whole: f64 = sides.iter().map(length).sum();
    let place = |lots: &[f64]| {
        let mut along = lots[0] * whole;
        let on = |side: &&([f64; 2], [f64; 2])| {
            let fits = along < length(side);
            along -= if fits { 0.0 } else { length(side) };
            fits
        };
        let &(a, b) = sides.iter().find(on).unwrap_or(&sides[0]);
        let (t, off) = (along / length(&(a, b)), noise * (2.0 * lots[1] - 1.0) / length(&(a, b)));
        [
            a[0] + t * (b[0] - a[0]) - off * (b[1] - a[1]),
            a[1] + t * (b[1] - a[1]) + off * (b[0] - a[0]),
        ]
    };
    places.chunks_exact(2).flat_map(place).collect()
}

/// The angle by which a closed polyline turns at a vertex, in degrees.
fn turn(vertices: &[[f64; 2]], i: usize) -> f64 {
    let count = vertices.len();
    let [a, b, c] = [i + count - 1, i, i + 1].map(|k| vertices[k % count]);
    let (p, q) = ([b[0] - a[0], b[1] - a[1]], [c[0] - b[0], c[1] - b[1]]);
    (p[0] * q[1] - p[1] * q[0]).atan2(p[0] * q[0] + p[1] * q[1]).abs().to_degrees()
}

/// Corners of up to a right angle lie within the noise from where they are, and nowhere else does the curve turn so much. Two thousand
/// points show right angles; those of a hexagon are within the noise of a bend.
#[test]
fn corners_are_kept() {
    let hexagon: Vec<[f64; 2]> = (0..6)
        .map(|k| (f64::from(k) * 60f64.to_radians()).sin_cos())
        .map(|(s, c)| [c, s])
        .collect();
    let square = vec![[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
    let angle = vec![[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    for (polygon, n, noise, seed) in [
        (&hexagon, 10_000, 0.03, 2),
        (&hexagon, 10_000, 0.05, 3),
        (&square, 2000, 0.03, 1),
        (&square, 10_000, 0.05, 3),
        (&angle, 2000, 0.03, 1),
        (&angle, 10_000, 0.03, 2),
    ] {
        let found = fitted(&around_polygon(polygon, n, noise, seed)).answer;
        let [curve] = &found.curves[..] else { panic!("{n}: {}", found.curves.len()) };
        let sharp = (0..curve.vertices.len()).filter(|&i| turn(&curve.vertices, i) > 45.0);
        let sharp: Vec<[f64; 2]> = sharp.map(|i| curve.vertices[i]).collect();
        assert!(curve.closed && sharp.len() == polygon.len(), "{n} {noise}: {sharp:?}");
        for corner in polygon {
            let off = |p: &[f64; 2]| (p[0] - corner[0]).hypot(p[1] - corner[1]);
            assert!(sharp.iter().map(off).any(|off| off <= noise), "{n} {noise}: {sharp:?}");
        }
    }
}

/// A bend of any radius that the noise lets be seen is no corner, and no vertex turns as one would.
#[test]
fn bends_are_no_corners() {
    for (name, delta) in [("ellipse3", 0.05), ("ellipse3", 0.3), ("flower5", 0.3), ("bumpy", 0.2)] {
        let truth = TestCurve::named(name).expect("a test curve").build();
        let noise = CurveNoise { delta, ..Default::default() };
        let found = fitted(&sample_curve(&truth, 20_000, &noise, 5).points);
        assert!(found.trace.counters.get("corners") == Some(&0), "{name}");
        let quality = quality(&truth, &found.answer);
        assert!(
            quality.topology_right() && quality.hausdorff < 0.01 + 0.15 * delta,
            "{name}: {quality:?}"
        );
        for curve in &found.answer.curves {
            let sharpest =
                (0..curve.vertices.len()).map(|i| turn(&curve.vertices, i)).fold(0.0, f64::max);
            assert!(sharpest < 25.0, "{name}: {sharpest}");
        }
    }
}

/// An arc stays open, up to its last points.
#[test]
fn ends_stay_ends() {
    let (truth, points) = sampled("arc", 3000, 0.0, false, 2);
    let found = fitted(&points).answer;
    assert_eq!(found.curves.len(), 1);
    assert!(!found.curves[0].closed);
    let found = quality(&truth, &found);
    assert!(found.topology_right() && found.hausdorff < 0.1, "{found:?}");
}

/// Six hundred points of a wave, as dense everywhere: its crests hold eight for each unit of their radius.
#[test]
fn sparse_crests_are_followed_and_the_noise_is_told() {
    let n = 600;
    for name in ["arc", "wave"] {
        let truth = TestCurve::named(name).expect("a test curve").build();
        let noise = CurveNoise { delta: 0.05, uniform_arc: true, ..Default::default() };
        let mut wrong_noise = 0;
        for seed in 0..8 {
            let points = sample_curve(&truth, n, &noise, seed).points;
            let found = fitted(&points).answer;
            assert!(found.outliers.len() <= n / 50, "{name} {seed}: {:?}", found.outliers);
            wrong_noise += usize::from((found.noise - 0.05).abs() > 0.015);
            let found = quality(&truth, &found);
            assert!(found.topology_right() && found.vertex_rms < 0.05, "{name} {seed}: {found:?}");
        }
        assert!(wrong_noise <= 2, "{name}: {wrong_noise}");
    }
}

/// Two circles, the noise of each as wide as two fifths of the room between them: windows on one reach into the other.
#[test]
fn circles_side_by_side_are_closed_and_two() {
    for (n, seed) in [(5000, 1), (20_000, 2), (50_000, 3)] {
        let lots: Vec<f64> = generate(Distribution::Uniform, n, 2, seed).expect("numbers");
        let place = |(k, lots): (usize, &[f64])| {
            let radius = [1.0, 0.6][k % 2] + 0.08 * (2.0 * lots[0] - 1.0);
            let (sin, cos) = (std::f64::consts::TAU * lots[1]).sin_cos();
            [radius * cos, radius * sin]
        };
        let points: Vec<f64> = lots.chunks_exact(2).enumerate().flat_map(place).collect();
        let found = fitted(&points).answer;
        assert!(found.curves.len() == 2 && found.curves.iter().all(|c| c.closed), "{n}");
        for curve in &found.curves {
            let off =
                |p: &[f64; 2]| (p[0].hypot(p[1]) - 1.0).abs().min((p[0].hypot(p[1]) - 0.6).abs());
            assert!(curve.vertices.iter().map(off).fold(0.0, f64::max) < 0.03, "{n}");
        }
    }
}

/// A few exact points beside many noisy ones change neither the method nor what the noise is said to be.
#[test]
fn exact_points_beside_noisy_ones_are_fitted_too() {
    let circle = |radius: f64, middle: f64, off: f64, n: usize, seed: u64| -> Vec<f64> {
        let lots: Vec<f64> = generate(Distribution::Uniform, n, 2, seed).expect("numbers");
        let place = |lots: &[f64]| {
            let radius = radius + off * (2.0 * lots[0] - 1.0);
            let (sin, cos) = (std::f64::consts::TAU * lots[1]).sin_cos();
            [middle + radius * cos, radius * sin]
        };
        lots.chunks_exact(2).flat_map(place).collect()
    };
    for exact in [300, 1000] {
        let points = [circle(1.0, 0.0, 0.05, 3000, 1), circle(1.0, 3.0, 0.0, exact, 2)].concat();
        let points = Points::new(&points, 2).expect("pairs");
        let found = curve(&points, &CurveOptions::default()).expect("finite points").answer;
        assert!(
            found.curves.len() == 2 && found.curves.iter().all(|c| c.closed),
            "{exact}: {}",
            found.curves.len()
        );
        assert!((found.noise - 0.05).abs() < 0.005, "{exact}: {}", found.noise);
        assert!(found.outliers.len() <= exact / 50, "{exact}: {}", found.outliers.len());
        let vertices: usize = found.curves.iter().map(|c| c.vertices.len()).sum();
        assert!(vertices < 3 * exact, "{vertices}");
    }
}

/// Outliers about as far off as the checker stops to count them as the curve's own: whoever is right, it is no contradiction.
#[test]
fn claims_hold_where_roundings_decide() {
    for seed in 0..long_or(60, 20) {
        let lots: Vec<f64> = generate(Distribution::Uniform, 2000, 2, seed).expect("numbers");
        let place = |(k, lots): (usize, &[f64])| {
            let off = 2.0 * lots[0] - 1.0;
            let off = if k % 100 == 0 { 2.0 + 0.01 * off } else { off };
            let (sin, cos) = (std::f64::consts::TAU * lots[1]).sin_cos();
            [(1.0 + 0.03 * off) * cos, (1.0 + 0.03 * off) * sin]
        };
        let points: Vec<f64> = lots.chunks_exact(2).enumerate().flat_map(place).collect();
        assert_eq!(fitted(&points).answer.curves.len(), 1, "{seed}");
    }
}

/// Fifty rows in one place, as of a sensor that is stuck, beside a circle.
#[test]
fn a_clump_hides_no_curve() {
    let lots: Vec<f64> = generate(Distribution::Uniform, 2050, 2, 4).expect("numbers");
    let place = |(k, lots): (usize, &[f64])| {
        let off = [2.0 * lots[0] - 1.0, 2.0 * lots[1] - 1.0];
        let (sin, cos) = (std::f64::consts::TAU * lots[1]).sin_cos();
        match k < 50 {
            true => [0.3 + 1e-3 * off[0], 0.2 + 1e-3 * off[1]],
            false => [(1.0 + 0.03 * off[0]) * cos, (1.0 + 0.03 * off[0]) * sin],
        }
    };
    let points: Vec<f64> = lots.chunks_exact(2).enumerate().flat_map(place).collect();
    let found = fitted(&points).answer;
    assert!(found.curves.len() == 1 && found.curves[0].closed, "{:?}", found.curves.len());
    assert_eq!(found.outliers, (0..50).collect::<Vec<u64>>());
}

/// A flower, a circle, an ellipse and a wave of three crests, whose least radius is three deviations of the noise; and eight points
/// anywhere.
#[test]
fn three_loops_and_a_wave() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../taut-cli/samples/loops.csv");
    let Ok(text) = std::fs::read_to_string(file) else {
        return println!("skipped three_loops_and_a_wave: no sample of the command");
    };
    let points: Vec<f64> = text
        .lines()
        .filter_map(|line| line.split_once(','))
        .filter_map(|(x, y)| Some([x.trim().parse::<f64>().ok()?, y.trim().parse::<f64>().ok()?]))
        .flatten()
        .collect();
    let found = fitted(&points).answer;
    let mut closed: Vec<bool> = found.curves.iter().map(|c| c.closed).collect();
    closed.sort_unstable();
    assert_eq!(closed, [false, true, true, true]);
    assert!((4..=16).contains(&found.outliers.len()), "{:?}", found.outliers);
    assert!((found.noise - 0.09).abs() < 0.025, "{}", found.noise);
}

#[test]
fn few_equal_collinear_and_huge_points() {
    let cloud: Vec<f64> = (0..400u32)
        .map(|i| f64::from(i.wrapping_mul(2_654_435_761) >> 8) / f64::from(1 << 24))
        .collect();
    let line: Vec<f64> = (0..200).flat_map(|i| [f64::from(i), 3.0 * f64::from(i)]).collect();
    let grid: Vec<f64> = (0..400).flat_map(|i| [f64::from(i % 20), f64::from(i / 20)]).collect();
    let mut inputs = vec![vec![], [1.0, 2.0].repeat(50), cloud, line, grid];
    for n in 1..5 {
        inputs.push((0..2 * n).map(|i| f64::from(i * i % 7)).collect());
    }
    for points in inputs {
        for scale in [1.0, 1e300, 1e-300] {
            let scaled: Vec<f64> = points.iter().map(|x| x * scale).collect();
            for method in [CurveMethod::Fit, CurveMethod::Auto] {
                let points = Points::new(&scaled, 2).expect("pairs");
                let options = CurveOptions { method, ..Default::default() };
                let found = curve(&points, &options).expect("finite points");
                found.check(&points).expect("the checker agrees");
            }
        }
    }
}

/// Without noise the vertices are the points.
#[test]
fn auto_interpolates_clean_points_and_fits_noisy_ones() {
    let circle: Vec<f64> = (0..200)
        .flat_map(|i| {
            let (sin, cos) = (f64::from(i) * std::f64::consts::TAU / 200.0).sin_cos();
            [cos, sin]
        })
        .collect();
    let of = |points: &[f64]| {
        curve(&Points::new(points, 2).expect("pairs"), &CurveOptions::default()).expect("finite")
    };
    let found = of(&circle);
    assert_eq!(found.answer.curves.len(), 1);
    assert_eq!(found.answer.curves[0].rows.len(), 200);
    assert_eq!(found.answer.noise, 0.0);
    let (_, points) = sampled("ellipse3", 3000, 0.0, false, 1);
    assert_eq!(of(&points).trace.method, "fit");
}

/// Clean points at random places, whose gaps differ by any factor, are one certified curve: NN-Crust asks for density alone. The corners of
/// a square, which no sample is dense enough for, take one that leaves no ends.
#[test]
fn auto_takes_uneven_samples_and_corners_as_they_come() {
    let lots: Vec<f64> = generate(Distribution::Uniform, 20_000, 1, 5).expect("numbers");
    let place = |t: &f64| <[f64; 2]>::from((t * std::f64::consts::TAU).sin_cos());
    let circle: Vec<f64> = lots.iter().flat_map(place).collect();
    let of = |points: &[f64]| {
        curve(&Points::new(points, 2).expect("pairs"), &CurveOptions::default()).expect("finite")
    };
    let found = of(&circle);
    assert_eq!((found.answer.curves.len(), found.certificate.certified), (1, true));
    assert_eq!(found.trace.method, "nn-crust");
    let square: Vec<f64> = (0..400)
        .flat_map(|i| {
            let (side, t) = (i / 100, f64::from(i % 100) / 100.0);
            [[t, 0.0], [1.0, t], [1.0 - t, 1.0], [0.0, 1.0 - t]][side as usize]
        })
        .collect();
    let found = of(&square);
    assert_eq!((found.answer.curves.len(), found.certificate.certified), (1, false));
    assert_eq!((found.answer.curves[0].rows.len(), &found.trace.method[..]), (400, "hnn-crust"));
}
