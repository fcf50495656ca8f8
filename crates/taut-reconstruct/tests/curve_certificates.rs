//! Every certificate is accepted by the checker, and none is certified whose curve is not the one that was sampled.

use taut_certify::{Curve, CurveVerdict, Solution};
use taut_mesh::{Polyline, compare};
use taut_points::Points;
use taut_points::generate::curves::{CurveNoise, TestCurve, TruthCurves, sample_curve};
use taut_reconstruct::{CurveMethod, CurveOptions, curve};

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

    fn below(&mut self, n: usize) -> usize {
        ((self.next() * n as f64) as usize).min(n - 1)
    }
}

const NAMES: [&str; 6] = ["circle", "ellipse3", "flower5", "bumpy", "gear20", "multi4"];

/// The methods whose curves may be certified.
const METHODS: [CurveMethod; 8] = [
    CurveMethod::Auto,
    CurveMethod::Fit,
    CurveMethod::Corners,
    CurveMethod::NnCrust,
    CurveMethod::Crust,
    CurveMethod::OneStepCrust,
    CurveMethod::HnnCrust,
    CurveMethod::ConservativeCrust,
];

/// A curve with random samples: far too few or plenty, noise up to a third of the least feature size, outliers, arcs missing.
fn sampled(random: &mut Random) -> (TruthCurves, Vec<f64>) {
    let truth = match random.below(3) {
        0 => TestCurve::named(NAMES[random.below(6)]).unwrap().build_with(1500),
        _ => TestCurve::random((random.next() * 1e6) as u64).build_with(1000),
    };
    let density = 300f64.powf(random.next());
    let n = ((density * truth.length_over_feature) as usize).clamp(3, 12_000);
    let noise = CurveNoise {
        delta: [0.0, random.next().powi(2) / 3.0][random.below(2)],
        gaussian: random.below(4) == 0,
        uniform_arc: random.below(3) == 0,
        outliers: [0.0, 0.2 * random.next()][random.below(2)],
    };
    let mut rows = sample_curve(&truth, n, &noise, (random.next() * 1e9) as u64).points;
    if random.below(4) == 0 {
        let hole = &truth.loops[random.below(truth.loops.len())];
        let (center, radius) = (hole[random.below(hole.len())], 2.0 * random.next());
        let far = |p: &&[f64]| (p[0] - center[0]).hypot(p[1] - center[1]) > radius;
        rows = rows.chunks_exact(2).filter(far).flatten().copied().collect();
    }
    (truth, rows)
}

fn is_right(truth: &TruthCurves, found: &Solution<Curve>) -> bool {
    let line = |vertices, closed| Polyline { vertices, closed };
    let wanted: Vec<Polyline<'_>> =
        truth.loops.iter().zip(&truth.closed).map(|(one, &closed)| line(one, closed)).collect();
    let curves = found.answer.curves.iter();
    let curves: Vec<Polyline<'_>> = curves.map(|one| line(&one.vertices, one.closed)).collect();
    compare(&wanted, &curves).topology_right()
}

fn checked(rows: &[f64], method: CurveMethod) -> (Solution<Curve>, CurveVerdict) {
    let points = Points::new(rows, 2).unwrap();
    let options = CurveOptions { method, places: rows.len() % 4 == 0, ..Default::default() };
    let found = curve(&points, &options).unwrap();
    let verdict = found.check(&points).unwrap_or_else(|e| panic!("{method:?}: {e}"));
    (found, verdict)
}

#[test]
fn none_is_false() {
    let (mut certified, mut right) = (0, 0);
    for trial in 0..trials(60) {
        let mut random = Random(trial * 6151 + 11);
        let (truth, rows) = sampled(&mut random);
        let method = METHODS[random.below(METHODS.len())];
        let (found, verdict) = checked(&rows, method);
        let is_right = is_right(&truth, &found);
        let n = rows.len() / 2;
        assert!(is_right || !verdict.certified, "trial {trial}, {method:?}, {n} rows: {verdict:?}");
        // The solver keeps some room to each threshold.
        assert!(verdict.certified || !found.certificate.certified);
        certified += u32::from(found.certificate.certified);
        right += u32::from(is_right);
    }
    println!("{certified} certified, {right} right");
}

/// Samples of curves as dense as the certificate asks for.
#[test]
fn dense_samples_without_noise_are_certified() {
    for name in NAMES {
        let truth = TestCurve::named(name).unwrap().build_with(3000);
        let n = (60.0 * truth.length_over_feature) as usize;
        let rows = sample_curve(&truth, n, &CurveNoise::default(), 3).points;
        for method in [CurveMethod::NnCrust, CurveMethod::HnnCrust] {
            let (found, verdict) = checked(&rows, method);
            assert!(is_right(&truth, &found), "{name}, {method:?}");
            assert!(found.certificate.certified, "{name}, {method:?}: {:?}", verdict.doubt);
            let (claimed, seen) = (found.certificate.sampling_ratio, verdict.sampling_ratio);
            assert!((claimed / seen - 1.0).abs() < 0.04, "{name}: {claimed} for {seen}");
        }
    }
}
