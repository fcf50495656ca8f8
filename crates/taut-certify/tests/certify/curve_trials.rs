//! Curves of the wrong topology through the samples of known ones: none may be called certified, and the right ones mostly are.

use std::f64::consts::TAU;

use taut_certify::{
    CheckError, Curve, CurveCertificate, CurveComponent, CurveDoubt, CurveVerdict, Solution, Trace,
};
use taut_mesh::{Polyline, compare};
use taut_points::{
    Monitor, Points,
    generate::curves::{CurveNoise, TestCurve, TruthCurves, sample_curve},
    hash_points,
};

use crate::test_length::long_or;

/// Trials of each kind. The environment variable asks for more.
fn trials(usual: u64) -> u64 {
    std::env::var("TAUT_TRIALS").ok().and_then(|text| text.parse().ok()).unwrap_or(usual)
}

/// Random numbers in [0, 1).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let mixed = (self.0 >> 22 ^ self.0) >> (22 + (self.0 >> 61));
        f64::from(mixed as u32) / 2f64.powi(32)
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    fn below(&mut self, n: usize) -> usize {
        ((self.next() * n as f64) as usize).min(n - 1)
    }
}

type Loop = Vec<[f64; 2]>;

/// Returns what the checker says of closed polylines, rows farther off than `reach` being outliers.
fn judged(loops: &[Loop], rows: &[f64], reach: f64) -> Result<CurveVerdict, CheckError> {
    let points = Points::new(rows, 2).unwrap();
    let far = |p: &[f64]| loops.iter().all(|vertices| distance(vertices, [p[0], p[1]]) > reach);
    let outliers =
        points.rows().enumerate().filter(|(_, p)| far(p)).map(|(row, _)| row as u64).collect();
    let curves = loops.iter().map(|vertices| CurveComponent {
        vertices: vertices.clone(),
        closed: true,
        rows: vec![],
    });
    Solution {
        answer: Curve { curves: curves.collect(), noise: 0.0, outliers, places: vec![] },
        certificate: CurveCertificate {
            band: if reach.is_finite() { reach * 1.001 } else { 1e9 },
            sampling_ratio: f64::MAX,
            noise_ratio: f64::MAX,
            certified: false,
            tour: None,
            points_hash: hash_points(&points, &Monitor::silent()).unwrap(),
        },
        trace: Trace::default(),
    }
    .check(&points)
}

fn distance(vertices: &Loop, p: [f64; 2]) -> f64 {
    let n = vertices.len();
    let squared = (0..n).map(|k| {
        let (a, b) = (vertices[k], vertices[(k + 1) % n]);
        let (e, w) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
        let t = ((e[0] * w[0] + e[1] * w[1]) / (e[0] * e[0] + e[1] * e[1])).clamp(0.0, 1.0);
        (w[0] - t * e[0]).powi(2) + (w[1] - t * e[1]).powi(2)
    });
    squared.fold(f64::INFINITY, f64::min).sqrt()
}

/// Vertices of the true curves about `step` apart, each off by up to `jitter`.
fn resampled(truth: &TruthCurves, step: f64, jitter: f64, random: &mut Random) -> Vec<Loop> {
    let one = |all: &Loop| {
        let length: f64 = (0..all.len())
            .map(|k| {
                let (a, b) = (all[k], all[(k + 1) % all.len()]);
                (a[0] - b[0]).hypot(a[1] - b[1])
            })
            .sum();
        let count = ((length / step) as usize).clamp(8, all.len());
        (0..count)
            .map(|k| all[k * all.len() / count].map(|x| x + random.between(-jitter, jitter)))
            .collect()
    };
    truth.loops.iter().map(one).collect()
}

const NAMES: [&str; 6] = ["circle", "ellipse3", "flower5", "bumpy", "gear20", "multi4"];

fn truth(random: &mut Random) -> TruthCurves {
    match random.below(3) {
        0 => TestCurve::named(NAMES[random.below(6)]).unwrap().build_with(1500),
        _ => TestCurve::random((random.next() * 1e6) as u64).build_with(1000),
    }
}

/// Samples with random density and noise up to a third of the least feature size, some outliers, and perhaps an arc missing.
fn sampled(truth: &TruthCurves, random: &mut Random) -> (Vec<f64>, f64) {
    let density = 2.0 * 200f64.powf(random.next());
    let n = ((density * truth.length_over_feature) as usize).clamp(30, 15_000);
    let delta = random.next().powi(2) / 3.0;
    let noise = CurveNoise {
        delta,
        gaussian: false,
        uniform_arc: random.below(3) == 0,
        outliers: if random.below(2) == 0 { random.between(0.0, 0.2) } else { 0.0 },
    };
    let mut rows = sample_curve(truth, n, &noise, (random.next() * 1e9) as u64).points;
    if random.below(4) == 0 {
        let hole = &truth.loops[random.below(truth.loops.len())];
        let (center, radius) = (hole[random.below(hole.len())], random.between(0.1, 2.0));
        let kept =
            rows.chunks_exact(2).filter(|p| (p[0] - center[0]).hypot(p[1] - center[1]) > radius);
        rows = kept.flatten().copied().collect();
    }
    (rows, delta)
}

/// The vertices of two loops, or of two parts of one, that are nearest to each other.
fn nearest(a: &Loop, b: &Loop, least_steps: usize) -> (usize, usize) {
    let mut best = (f64::INFINITY, 0, 0);
    let is_same = std::ptr::eq(a, b);
    for (i, p) in a.iter().enumerate() {
        for (j, q) in b.iter().enumerate() {
            let steps = j.abs_diff(i).min(a.len() - j.abs_diff(i).min(a.len()));
            let far = (p[0] - q[0]).hypot(p[1] - q[1]);
            if far < best.0 && !(is_same && (j <= i || steps < least_steps)) {
                best = (far, i, j);
            }
        }
    }
    (best.1, best.2)
}

/// The loops with a wrong topology, and what was done.
fn damaged(loops: &[Loop], delta: f64, random: &mut Random) -> (&'static str, Vec<Loop>) {
    let mut loops = loops.to_vec();
    let some = random.below(loops.len());
    match random.below(5) {
        0 if loops[some].len() >= 24 => {
            let one = loops.swap_remove(some);
            let (i, j) = nearest(&one, &one, one.len() / 6 + random.below(one.len() / 4));
            loops.push(one[i + 1..j].to_vec());
            loops.push(one[j + 1..].iter().chain(&one[..i]).copied().collect());
            ("shortcut across a neck", loops)
        }
        1 if loops.len() > 1 => {
            let other = (some + 1) % loops.len();
            let (i, j) = nearest(&loops[some], &loops[other], 0);
            let (one, mut two) = (loops[some].clone(), loops[other].clone());
            if random.below(2) == 0 {
                two.reverse();
            }
            let j = if two == loops[other] { j } else { two.len() - 1 - j };
            let mut joined: Loop = one[i..].iter().chain(&one[..i]).copied().collect();
            joined.extend(two[j..].iter().chain(&two[..j]));
            loops = (0..loops.len())
                .filter(|&k| k != some && k != other)
                .map(|k| loops[k].clone())
                .collect();
            loops.push(joined);
            ("two loops joined", loops)
        }
        2 if loops.len() > 1 => {
            loops.swap_remove(some);
            ("a loop missing", loops)
        }
        3 => {
            let p = loops[some][random.below(loops[some].len())];
            let radius = random.between(0.02, 1.0);
            let center = [p[0] + random.between(-1.5, 1.5), p[1] + random.between(-1.5, 1.5)];
            let at = |k: usize| {
                let (sin, cos) = (TAU * k as f64 / 40.0).sin_cos();
                [center[0] + radius * cos, center[1] + radius * sin]
            };
            loops.push((0..40).map(at).collect());
            ("a loop too many", loops)
        }
        _ => {
            let all = &loops[some];
            let n = all.len();
            let aside = random.between(0.1, 1.5) * (delta + 0.02);
            let shifted = |side: f64| -> Loop {
                let at = |k: usize| {
                    let (a, b) = (all[(k + n - 1) % n], all[(k + 1) % n]);
                    let (x, y) = (b[0] - a[0], b[1] - a[1]);
                    let size = side * aside / x.hypot(y);
                    [all[k][0] - size * y, all[k][1] + size * x]
                };
                (0..n).map(at).collect()
            };
            let two = [shifted(0.5), shifted(-0.5)];
            loops.swap_remove(some);
            loops.extend(two);
            ("a loop twice within its band", loops)
        }
    }
}

#[test]
fn no_damaged_curve_is_certified() {
    for trial in 0..trials(long_or(100, 40)) {
        let mut random = Random(trial * 7919 + 1);
        let truth = truth(&mut random);
        let (rows, delta) = sampled(&truth, &mut random);
        let step = random.between(0.04, 0.3);
        let jitter = random.between(0.0, 0.1) * step;
        let right = resampled(&truth, step, jitter, &mut random);
        let (kind, wrong) = damaged(&right, delta, &mut random);
        let reach = [1.2 * delta + 0.01, 3.0 * delta + 0.05, f64::INFINITY][random.below(3)];
        if let Ok(verdict) = judged(&wrong, &rows, reach) {
            assert!(!verdict.certified, "trial {trial}: {kind}, {reach}, {delta} {verdict:?}");
        }
    }
}

/// Two circles so near to each other that one between them has a band that is narrow beside its own features.
#[test]
fn one_circle_in_place_of_two_is_not_certified() {
    for trial in 0..trials(60) {
        let mut random = Random(trial * 104_729 + 3);
        let apart = random.between(0.02, 0.5);
        // The least feature size is half the distance.
        let delta = apart / 6.0 * random.next();
        let n = (200.0 * 100f64.powf(random.next())) as usize;
        let share = random.between(0.3, 0.7);
        let mut rows = vec![];
        for _ in 0..n {
            let inner = random.next() < share;
            let radius = if inner { 1.0 - apart / 2.0 } else { 1.0 + apart / 2.0 };
            let radius = radius + random.between(-delta, delta);
            let (sin, cos) = (TAU * random.next()).sin_cos();
            rows.extend([radius * cos, radius * sin]);
        }
        let count = 30 + random.below(200);
        let at = |k: usize| {
            let (sin, cos) = (TAU * k as f64 / count as f64).sin_cos();
            [cos, sin]
        };
        let verdict = judged(&[(0..count).map(at).collect()], &rows, f64::INFINITY).unwrap();
        assert!(!verdict.certified, "trial {trial}: {apart} apart, {verdict:?}");
    }
}

#[test]
fn right_curves_through_dense_samples_are_certified() {
    let (mut certified, mut all) = (0, 0);
    for name in NAMES {
        let truth = TestCurve::named(name).unwrap().build_with(3000);
        for seed in 0..long_or(4, 2) {
            let mut random = Random(seed + 17);
            let n = (200.0 * truth.length_over_feature) as usize;
            let noise = CurveNoise { delta: 0.05, ..CurveNoise::default() };
            let rows = sample_curve(&truth, n, &noise, seed).points;
            let found = resampled(&truth, 0.1, 0.008, &mut random);
            let line = |vertices| Polyline { vertices, closed: true };
            let [right, wanted] = [&found, &truth.loops]
                .map(|loops| loops.iter().map(|one| line(one.as_slice())).collect::<Vec<_>>());
            assert!(compare(&wanted, &right).topology_right());
            let verdict = judged(&found, &rows, 0.2).unwrap();
            all += 1;
            certified += u32::from(verdict.certified);
            assert!(
                verdict.sampling_ratio < 0.1 && verdict.noise_ratio < 0.1,
                "{name}: {verdict:?}"
            );
        }
    }
    assert!(certified * 10 >= all * 9, "{certified} of {all}");
}

/// The samples of a missing curve are as near to each other as those of the curve that was found.
#[test]
fn a_missing_loop_among_the_outliers_is_noticed() {
    let truth = TestCurve::named("multi4").unwrap().build_with(2000);
    let noise = CurveNoise { delta: 0.05, ..CurveNoise::default() };
    let rows = sample_curve(&truth, 20_000, &noise, 5).points;
    let found = resampled(&truth, 0.1, 0.0, &mut Random(1));
    let verdict = judged(&found[..3], &rows, 0.2).unwrap();
    assert!(matches!(verdict.doubt, Some(CurveDoubt::Cluster { .. })), "{verdict:?}");
}
