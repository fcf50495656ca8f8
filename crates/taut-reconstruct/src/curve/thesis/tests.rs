use std::f64::consts::PI;

use taut_mesh::{Polyline, Quality, compare};
use taut_points::{
    Points,
    generate::curves::{CurveNoise, TestCurve, sample_curve},
};

use super::strip::{least_strip, reduce_to_hull};
use super::*;
use crate::curve;

/// Numbers in [0, 1) from a seed.
struct Draw(u64);

impl Draw {
    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

const METHODS: [fn(CurveThesisOptions) -> CurveMethod; 2] =
    [CurveMethod::Thesis, CurveMethod::ThesisCrude];

fn found(points: &[[f64; 2]], options: &CurveOptions<'_>) -> taut_certify::Curve {
    let view = Points::new(points.as_flattened(), 2).expect("pairs");
    curve(&view, options).expect("finite points").answer
}

fn with(method: CurveMethod) -> CurveOptions<'static> {
    CurveOptions { method, ..CurveOptions::default() }
}

/// The options of the methods, with a local feature size that is known or not.
fn of(feature: Option<f64>) -> CurveThesisOptions {
    CurveThesisOptions { feature, ..CurveThesisOptions::default() }
}

/// Samples with δ = 1/144, and what is found of them.
fn measured(name: &str, n: usize, seed: u64, options: &CurveOptions<'_>) -> Quality {
    let truth = TestCurve::named(name).expect("a name").build();
    let noise = CurveNoise { delta: 1.0 / 144.0, ..CurveNoise::default() };
    let sample = sample_curve(&truth, n, &noise, seed);
    let answer = curve(&Points::new(&sample.points, 2).expect("pairs"), options).expect("finite");
    let lines = |curves: &mut dyn Iterator<Item = (&'_ Vec<[f64; 2]>, bool)>| -> Quality {
        let found: Vec<(Vec<[f64; 2]>, bool)> = curves.map(|(v, c)| (v.clone(), c)).collect();
        let found: Vec<Polyline<'_>> =
            found.iter().map(|(vertices, closed)| Polyline { vertices, closed: *closed }).collect();
        let truth: Vec<Polyline<'_>> = truth
            .loops
            .iter()
            .zip(&truth.closed)
            .map(|(vertices, &closed)| Polyline { vertices, closed })
            .collect();
        compare(&truth, &found)
    };
    lines(&mut answer.answer.curves.iter().map(|c| (&c.vertices, c.closed)))
}

#[test]
fn curves_within_the_theorem_are_found() {
    for (name, n, rms) in
        [("circle", 5027, 2e-3), ("ellipse3", 8000, 3e-3), ("flower5", 15_000, 4e-3)]
    {
        for feature in [Some(1.0), None] {
            let quality = measured(name, n, 1, &with(CurveMethod::Thesis(of(feature))));
            assert!(quality.topology_right(), "{name} {feature:?} {quality:?}");
            assert!(quality.vertex_rms < rms, "{name} {feature:?} {quality:?}");
        }
    }
}

#[test]
fn crude_centers_lie_near_the_curve() {
    let quality = measured("circle", 1000, 1, &with(CurveMethod::ThesisCrude(of(None))));
    // Below the noise, whose root mean square is δ/√3 = 4.0e-3.
    assert!(quality.vertex_rms < 4.0e-3 && quality.loops_found == 1, "{quality:?}");
}

#[test]
fn degenerate_points() {
    let mut sets = vec![
        vec![],
        vec![[1.0, 2.0]; 3],
        vec![[0.0, 0.0], [3.0, 4.0]],
        vec![[0.0, 0.0], [3.0, 4.0], [-1.0, 2.0]],
        vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]],
        (0..50).map(|i| [f64::from(i), 2.0 * f64::from(i)]).collect(),
        (0..100).map(|i| [f64::from(i % 10), f64::from(i / 10)]).collect(),
        vec![[1e300, 1e-300], [-1e300, 1e300], [1e-300, 0.0], [0.0, 1.7e308], [-1.7e308, 3.0]],
    ];
    sets.push(sets[6].iter().map(|p| p.map(|x| x * 5e-324)).collect());
    for points in &sets {
        for method in METHODS {
            for feature in [None, Some(1.0), Some(1e-300), Some(1e300)] {
                let answer = found(points, &with(method(of(feature))));
                let finite = |c: &taut_certify::CurveComponent| {
                    c.vertices.iter().flatten().all(|x| x.is_finite())
                };
                assert!(answer.curves.iter().all(finite) && answer.noise.is_finite());
            }
        }
    }
    let line = found(&sets[5], &with(CurveMethod::Thesis(of(None))));
    assert!(line.curves.len() == 1 && !line.curves[0].closed && line.noise < 1e-12, "{line:?}");
    // Noise alone has no flat disk.
    let mut draw = Draw(3);
    let blob: Vec<[f64; 2]> = (0..300).map(|_| [draw.next(), draw.next()]).collect();
    let answer = found(&blob, &with(CurveMethod::Thesis(of(Some(0.2)))));
    assert!(answer.outliers.len() > 150);
}

#[test]
fn answers_follow_their_input() {
    let truth = TestCurve::named("flower5").expect("a name").build();
    let noise = CurveNoise { delta: 1.0 / 144.0, ..CurveNoise::default() };
    let sample = sample_curve(&truth, 4000, &noise, 5);
    let points: Vec<[f64; 2]> = sample.points.chunks_exact(2).map(|p| [p[0], p[1]]).collect();
    for method in METHODS {
        let plain = found(&points, &with(method(of(None))));
        let same = |points: &[[f64; 2]], threads| {
            found(points, &CurveOptions { threads, ..with(method(of(None))) }) == plain
        };
        let backwards: Vec<[f64; 2]> = points.iter().rev().copied().collect();
        assert!(same(&points, Some(1)) && same(&points, Some(3)));
        let back = found(&backwards, &with(method(of(None))));
        assert_eq!((&back.curves, back.noise), (&plain.curves, plain.noise));
        let twice: Vec<[f64; 2]> = points.iter().chain(&points).copied().collect();
        assert_eq!(found(&twice, &with(method(of(None)))).curves, plain.curves);
        let doubled: Vec<[f64; 2]> = points.iter().map(|p| p.map(|x| x * 1024.0)).collect();
        let big = found(&doubled, &with(method(of(None))));
        assert_eq!(big.noise, plain.noise * 1024.0);
        for (a, b) in big.curves.iter().zip(&plain.curves) {
            assert_eq!(
                a.vertices,
                b.vertices.iter().map(|v| v.map(|x| x * 1024.0)).collect::<Vec<_>>()
            );
        }
    }
    // Turned, shifted by a thousand diameters, and a millionth of the size: the same vertices, up to where a curve begins.
    let (sin, cos) = 0.7f64.sin_cos();
    let moves: [&dyn Fn([f64; 2]) -> [f64; 2]; 3] =
        [&|p| p.map(|x| x * 1e-6), &|[x, y]| [cos * x - sin * y, sin * x + cos * y], &|[x, y]| {
            [x + 3e4, y - 1e4]
        }];
    let plain = found(&points, &with(CurveMethod::Thesis(of(None))));
    for (number, map) in moves.iter().enumerate() {
        let moved: Vec<[f64; 2]> = points.iter().map(|&p| map(p)).collect();
        let answer = found(&moved, &with(CurveMethod::Thesis(of(None))));
        let size = |curves: &[taut_certify::CurveComponent]| -> Vec<(bool, usize)> {
            let mut sizes: Vec<(bool, usize)> =
                curves.iter().map(|c| (c.closed, c.vertices.len())).collect();
            sizes.sort_unstable();
            sizes
        };
        assert_eq!(size(&answer.curves), size(&plain.curves), "{number}");
        let unit = if number == 0 { 1e-6 } else { 1.0 };
        for vertex in plain.curves.iter().flat_map(|c| &c.vertices) {
            let [x, y] = map(*vertex);
            let near = answer.curves.iter().flat_map(|c| &c.vertices);
            let near = near.map(|v| (v[0] - x).hypot(v[1] - y)).fold(f64::INFINITY, f64::min);
            assert!(near <= 1e-5 * unit, "{number} {near}");
        }
    }
}

#[test]
fn strips_are_those_of_brute_force() {
    let mut draw = Draw(9);
    for round in 0..300 {
        let whole = round % 2 == 0;
        let mut points: Vec<[f64; 2]> = (0..3 + round % 30)
            .map(|_| [draw.next(), draw.next()].map(|x| if whole { (5.0 * x).floor() } else { x }))
            .collect();
        // Least over directions along two points each of how far points reach across.
        let mut least = f64::INFINITY;
        for a in &points {
            for b in &points {
                let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
                let across = points.iter().map(|p| (dx * p[1] - dy * p[0]) / dx.hypot(dy));
                let (low, high) = across
                    .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
                if high >= low {
                    least = least.min(high - low);
                }
            }
        }
        reduce_to_hull(&mut points);
        let width = least_strip(&points).width;
        let expected = if least.is_finite() { least } else { 0.0 };
        assert!((width - expected).abs() < 1e-12, "{round}: {width} {expected}");
    }
}

#[test]
fn rectangles_are_those_of_a_dense_scan() {
    let mut draw = Draw(4);
    for _ in 0..50 {
        let samples: Vec<[f64; 2]> = (0..80)
            .map(|_| [2.0 * draw.next() - 1.0, 0.2 * draw.next() - 0.1])
            .chain([[0.0; 2]])
            .collect();
        let near: Vec<disks::Sample> =
            samples.iter().map(|&[x, y]| (x * x + y * y, [x, y])).collect();
        let strip = strip::Strip { width: 0.2, along: [1.0, 0.0] };
        let rectangle = refined(&near, strip, 0.6);
        let height = |angle: f64| {
            let (sin, cos) = angle.sin_cos();
            let inside = samples.iter().filter(|p| (cos * p[0] + sin * p[1]).abs() <= 0.3);
            let across = inside.map(|p| cos * p[1] - sin * p[0]);
            across.clone().fold(0.0, f64::max) - across.fold(0.0, f64::min)
        };
        let angles = (-20_000..=20_000).map(|k| f64::from(k) * PI / 200_000.0);
        let least = angles.map(height).fold(f64::INFINITY, f64::min);
        // The nearest angle tried is within π/200, which lifts an end of the slab by W/2 times as much.
        assert!(rectangle.height <= least + 0.6 * PI / 200.0, "{} {least}", rectangle.height);
        assert!(rectangle.height >= least - 1e-4);
    }
}

#[test]
fn pruned_centers_are_a_maximal_packing() {
    let mut draw = Draw(8);
    let centers: Vec<[f64; 2]> = (0..500).map(|_| [draw.next(), draw.next()]).collect();
    let width: Vec<f64> = (0..500).map(|_| 1e-4 * draw.next()).collect();
    let reach = |i: usize| width[i].cbrt();
    let selected = pruning::select(&centers, |i| [width[i], 0.0, 0.0], reach);
    let apart =
        |a: usize, b: usize| (centers[a][0] - centers[b][0]).hypot(centers[a][1] - centers[b][1]);
    for (place, &a) in selected.iter().enumerate() {
        assert!(
            selected[..place]
                .iter()
                .all(|&b| width[b] as f32 >= width[a] as f32 && apart(a, b) > reach(b))
        );
    }
    assert!((0..500).all(|a| selected.iter().any(|&b| apart(a, b) <= reach(b))));
}
