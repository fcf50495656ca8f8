//! Every certificate is accepted by the checker, and none is certified whose curve is not the one that was sampled.
//!
//! `TAUT_TRIALS=10000` in the release profile is the claim; the usual few see to it that nothing breaks.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

use rayon::prelude::*;
use taut_certify::{Curve, CurveVerdict, Solution};
use taut_mesh::{Polyline, compare};
use taut_points::{
    Points,
    generate::curves::{CurveNoise, TestCurve, TruthCurves, sample_curve},
};
use taut_reconstruct::{CurveMethod, CurveOptions, curve};

/// Trials of each kind. The environment variable asks for more.
fn trials(usual: u64) -> u64 {
    std::env::var("TAUT_TRIALS").ok().and_then(|text| text.parse().ok()).unwrap_or(usual)
}

/// Random numbers in [0, 1).
struct Random(u64);

impl Random {
    fn of(seed: u64) -> Self {
        let mut random = Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15).wrapping_add(11));
        for _ in 0..4 {
            random.next();
        }
        random
    }

    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let mixed = (self.0 >> 22 ^ self.0) >> (22 + (self.0 >> 61));
        f64::from(mixed as u32) / 2f64.powi(32)
    }

    fn below(&mut self, n: usize) -> usize {
        ((self.next() * n as f64) as usize).min(n - 1)
    }

    /// 0 in one of two draws, else below a limit.
    fn or_none(&mut self, most: f64) -> f64 {
        if self.below(2) == 0 { 0.0 } else { most * self.next() }
    }

    /// In [−1, 1] or normal.
    fn shift(&mut self, gaussian: bool) -> f64 {
        let uniform = 2.0 * self.next() - 1.0;
        match gaussian {
            true => (-2.0 * (1.0 - self.next()).ln()).sqrt() * (PI * uniform).cos(),
            false => uniform,
        }
    }
}

const NAMES: [&str; 6] = ["circle", "ellipse3", "flower5", "bumpy", "gear20", "multi4"];

/// The methods whose curves may be certified; every other trial takes the first.
const METHODS: [CurveMethod; 8] = [
    CurveMethod::Fit,
    CurveMethod::NnCrust,
    CurveMethod::HnnCrust,
    CurveMethod::OneStepCrust,
    CurveMethod::Corners,
    CurveMethod::Crust,
    CurveMethod::ConservativeCrust,
    CurveMethod::Auto,
];

/// Rows, and the curves that they are from.
struct Sample {
    kind: &'static str,
    loops: Vec<Vec<[f64; 2]>>,
    closed: Vec<bool>,
    rows: Vec<f64>,
}

/// A curve with random samples: far too few or plenty, noise up to a third of the least feature size, outliers, arcs missing.
fn sampled(random: &mut Random) -> Sample {
    match random.below(4) {
        0 => circles(random),
        _ => smooth(random),
    }
}

fn smooth(random: &mut Random) -> Sample {
    let (kind, truth) = match random.below(8) {
        0 | 1 => {
            let name = NAMES[random.below(6)];
            (name, TestCurve::named(name).unwrap().build_with(800))
        }
        2 => {
            let name = ["arc", "wave"][random.below(2)];
            (name, TestCurve::named(name).unwrap().build_with(800))
        }
        _ => ("random", TestCurve::random((random.next() * 1e6) as u64).build_with(600)),
    };
    let density = 500f64.powf(random.next());
    let n = ((density * truth.length_over_feature) as usize).clamp(3, 5_000);
    let noise = CurveNoise {
        delta: [0.0, random.next().powi(2) / 3.0][random.below(2)],
        gaussian: random.below(4) == 0,
        uniform_arc: random.below(3) == 0,
        outliers: [0.0, 0.2 * random.next()][random.below(2)],
    };
    let mut rows = sample_curve(&truth, n, &noise, (random.next() * 1e9) as u64).points;
    if random.below(4) == 0 {
        let hole = &truth.loops[random.below(truth.loops.len())];
        let (center, radius) = (hole[random.below(hole.len())], 2.0 * random.next().powi(2));
        let far = |p: &&[f64]| (p[0] - center[0]).hypot(p[1] - center[1]) > radius;
        rows = rows.chunks_exact(2).filter(far).flatten().copied().collect();
    }
    let TruthCurves { loops, closed, .. } = truth;
    Sample { kind, loops, closed, rows }
}

/// Two circles, nested or side by side, with little room between, and noise up to what the certificate supposes, a third of their
/// feature size; or one with an arc missing, longer than gaps that chance makes.
fn circles(random: &mut Random) -> Sample {
    let room = 0.6 * random.next().powi(2);
    let gaussian = random.below(4) == 0;
    // The feature size is half the room between; normal noise is three times as wide as its deviation.
    let noise = random.or_none(room / if gaussian { 18.0 } else { 6.0 });
    let (kind, mut disks) = match random.below(3) {
        0 => ("nested", vec![([0.0; 2], 1.0), ([0.0; 2], 1.0 - room)]),
        1 => ("side by side", vec![([0.0; 2], 1.0), ([1.5 + room, 0.0], 0.5)]),
        _ => ("nearly nested", vec![([0.0; 2], 1.0), ([0.3, 0.0], 0.7 - room)]),
    };
    let n = (20.0 * 200f64.powf(random.next())) as usize;
    let chance = 1.5 * (10.0 + 1.5 * (n as f64).ln()) * TAU / n as f64;
    let gap = match random.below(3) {
        0 => (TAU * random.next().powi(3)).max(chance).min(0.9 * TAU),
        _ => 0.0,
    };
    if gap > 0.0 {
        disks.truncate(1);
    }
    let kind = if gap > 0.0 { "open circle" } else { kind };
    let places = |k: usize, ([x, y], r): ([f64; 2], f64)| -> Vec<[f64; 2]> {
        let count = k + usize::from(gap > 0.0);
        let turn = |i: usize| (TAU - gap) * i as f64 / k as f64;
        (0..count).map(|i| [x + r * turn(i).cos(), y + r * turn(i).sin()]).collect()
    };
    let loops: Vec<_> = disks.iter().map(|&disk| places(800, disk)).collect();
    let closed = vec![gap == 0.0; loops.len()];
    let outliers = random.or_none(0.2);
    let mut rows = Vec::new();
    for _ in 0..n {
        if random.next() < outliers {
            rows.extend([4.0 * random.next() - 1.5, 3.0 * random.next() - 1.5]);
            continue;
        }
        let ([x, y], r) = disks[random.below(disks.len())];
        let (turn, r) = ((TAU - gap) * random.next(), r + noise * random.shift(gaussian));
        rows.extend([x + r * turn.cos(), y + r * turn.sin()]);
    }
    Sample { kind, loops, closed, rows }
}

fn is_right(sample: &Sample, found: &Solution<Curve>) -> bool {
    let line = |vertices, closed| Polyline { vertices, closed };
    let wanted: Vec<Polyline<'_>> =
        sample.loops.iter().zip(&sample.closed).map(|(one, &closed)| line(one, closed)).collect();
    let curves = found.answer.curves.iter();
    let curves: Vec<Polyline<'_>> = curves.map(|one| line(&one.vertices, one.closed)).collect();
    compare(&wanted, &curves).topology_right()
}

fn checked(rows: &[f64], method: CurveMethod) -> (Solution<Curve>, CurveVerdict) {
    let points = Points::new(rows, 2).unwrap();
    let options =
        CurveOptions { method, places: rows.len().is_multiple_of(4), ..Default::default() };
    let found = curve(&points, &options).unwrap();
    let verdict = found.check(&points).unwrap_or_else(|e| panic!("{method:?}: {e}"));
    // The solver asks the checker's own function, so it claims what the checker finds, to the last bit.
    let claimed = &found.certificate;
    assert_eq!(claimed.certified, verdict.certified, "{method:?}: {:?}", verdict.doubt);
    if claimed.certified {
        let figures = [claimed.sampling_ratio, claimed.noise_ratio];
        assert_eq!(figures, [verdict.sampling_ratio, verdict.noise_ratio], "{method:?}");
    }
    let is_close = claimed.band >= verdict.band && claimed.band <= verdict.band * (1.0 + 2e-12);
    assert!(is_close, "{method:?}: {} for {}", claimed.band, verdict.band);
    (found, verdict)
}

/// The results of the trials of a method.
#[derive(Default)]
struct Count {
    trials: u32,
    right: u32,
    certified: u32,
    /// Certified but wrong.
    wrong: u32,
}

#[test]
fn none_is_false() {
    let of_trial = |trial: u64| {
        let mut random = Random::of(trial);
        let sample = sampled(&mut random);
        let method = match trial % 2 {
            0 => METHODS[0],
            _ => METHODS[random.below(METHODS.len())],
        };
        let (found, verdict) = checked(&sample.rows, method);
        let is_right = is_right(&sample, &found);
        let (kind, rows) = (sample.kind, sample.rows.len() / 2);
        let told = format!("trial {trial}, {method:?}, {kind}, {rows} rows: {verdict:?}");
        (method.name(), is_right, verdict, told)
    };
    let found: Vec<_> =
        (0..trials(crate::test_length::long_or(60, 25))).into_par_iter().map(of_trial).collect();
    let mut counts: BTreeMap<&str, Count> = BTreeMap::new();
    let mut wrong = Vec::new();
    for (method, is_right, verdict, told) in found {
        let count = counts.entry(method).or_default();
        count.trials += 1;
        count.right += u32::from(is_right);
        count.certified += u32::from(verdict.certified);
        if verdict.certified && !is_right {
            count.wrong += 1;
            wrong.push(told);
        }
    }
    for (method, Count { trials, right, certified, wrong }) in counts {
        println!("{method}: {trials} trials, {right} right, {certified} certified, {wrong} wrong");
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Samples of curves as dense as the certificate asks for.
#[test]
fn dense_samples_without_noise_are_certified() {
    for name in NAMES.into_iter().step_by(crate::test_length::long_or(1, 2)) {
        let truth = TestCurve::named(name).unwrap().build_with(3000);
        let n = (60.0 * truth.length_over_feature) as usize;
        let rows = sample_curve(&truth, n, &CurveNoise::default(), 3).points;
        let sample = Sample { kind: name, loops: truth.loops, closed: truth.closed, rows };
        for method in [CurveMethod::NnCrust, CurveMethod::HnnCrust] {
            let (found, verdict) = checked(&sample.rows, method);
            assert!(is_right(&sample, &found), "{name}, {method:?}");
            assert!(found.certificate.certified, "{name}, {method:?}: {:?}", verdict.doubt);
        }
    }
}

/// 1000 noisy samples on the length of a feature.
#[test]
fn dense_noisy_samples_are_certified() {
    let (mut certified, mut all) = (0, 0);
    let outliers = std::env::var("TAUT_OUTLIERS").ok().and_then(|text| text.parse().ok());
    // The larger sets only where more trials are asked for.
    let names = if std::env::var("TAUT_TRIALS").is_ok() { &NAMES[..] } else { &NAMES[..2] };
    for &name in names {
        let truth = TestCurve::named(name).unwrap().build_with(3000);
        let n = (1000.0 * truth.length_over_feature) as usize;
        for seed in 0..trials(2) {
            let noise =
                CurveNoise { delta: 0.05, outliers: outliers.unwrap_or(0.0), ..Default::default() };
            let rows = sample_curve(&truth, n, &noise, seed).points;
            let (loops, closed) = (truth.loops.clone(), truth.closed.clone());
            let sample = Sample { kind: name, loops, closed, rows };
            let (found, verdict) = checked(&sample.rows, CurveMethod::Fit);
            let is_right = is_right(&sample, &found);
            println!(
                "{name} {seed}, {n} rows, right {is_right}, claimed {}, verdict {verdict:?}",
                found.certificate.certified
            );
            certified += u32::from(found.certificate.certified && is_right);
            all += 1;
        }
    }
    assert!(10 * certified >= 7 * all, "{certified} of {all}");
}
