//! Features against the dossier's figures and closed forms; laws of the samples.

use std::f64::consts::PI;

use super::*;
use crate::test_length::long_or;

fn truth(name: &str) -> TruthCurves {
    TestCurve::named(name).unwrap().build()
}

#[test]
fn length_over_feature_and_largest_feature_are_the_published_ones() {
    let known = [
        ("circle", 2.0 * PI, 1.0),
        ("ellipse3", 20.2, 3.0),
        ("flower5", 52.5, 4.29),
        ("bumpy", 55.8, 8.89),
        ("gear20", 217.9, 3.02),
        ("multi4", 96.1, 4.0),
    ];
    for (name, length, largest) in known.into_iter().step_by(long_or(1, 3)) {
        let truth = truth(name);
        let smallest = truth.features.iter().flatten().fold(f64::INFINITY, |a, &b| a.min(b));
        assert!((smallest - 1.0).abs() < 1e-12, "{name}: {smallest}");
        let found = truth.length_over_feature;
        assert!((found / length - 1.0).abs() < 5e-3, "{name}: {found}");
        assert!((truth.feature_max / largest - 1.0).abs() < 5e-3, "{name}: {}", truth.feature_max);
    }
}

#[test]
fn features_of_a_circle_and_an_ellipse_are_their_formulas() {
    for f in truth("circle").features[0].iter() {
        assert!((f - 1.0).abs() < 1e-9, "{f}");
    }
    // The axis of an ellipse a > b is the segment between the centers of curvature at its vertices, ±(a − b²/a).
    let truth = truth("ellipse3");
    let (a, b) = (9.0, 3.0);
    let end = a - b * b / a;
    for (p, f) in truth.loops[0].iter().zip(&truth.features[0]) {
        let exact = (p[0].abs() - end).max(0.0).hypot(p[1]);
        assert!((f - exact).abs() < 2e-3 * exact, "{p:?}: {f} and not {exact}");
    }
}

#[test]
fn at_the_ends_of_an_arc_the_disks_beyond_it_count() {
    // A half circle and less: nothing but its center. Three quarters: the disks between the ends, centered on the diagonal.
    let truth = truth("arc");
    assert_eq!(truth.closed, [false]);
    let (first, last) = (truth.loops[0][0], truth.loops[0][9999]);
    let gap = (first[0] - last[0]).hypot(first[1] - last[1]);
    let f = truth.features[0][0];
    assert!((f - gap / 2.0).abs() < 2e-3 * f, "{f} and not {}", gap / 2.0);
    assert!((f - 1.0).abs() < 1e-12);
}

#[test]
fn samples_keep_to_their_band_and_their_density() {
    let circle = truth("circle");
    let noise = CurveNoise { delta: 0.05, ..CurveNoise::default() };
    let sample = sample_curve(&circle, 20_000, &noise, 3);
    let shifts: Vec<f64> = sample.points.chunks(2).map(|p| p[0].hypot(p[1]) - 1.0).collect();
    assert!(shifts.iter().all(|s| s.abs() <= 0.05 + 1e-12));
    let square = shifts.iter().map(|s| s * s).sum::<f64>() / 20_000.0;
    assert!((square.sqrt() - 0.05 / 3f64.sqrt()).abs() < 5e-4, "{}", square.sqrt());
    // Along the ellipse, the share of samples near the vertices is that of ∫ 1/f there.
    let ellipse = truth("ellipse3");
    for uniform_arc in [false, true] {
        let noise = CurveNoise { uniform_arc, ..CurveNoise::default() };
        let sample = sample_curve(&ellipse, 50_000, &noise, 4);
        let near = |p: &[f64]| p[0].abs() > 8.0;
        let found = sample.points.chunks(2).filter(|p| near(p)).count() as f64 / 50_000.0;
        let (mut part, mut all) = (0.0, 0.0);
        for (curve, i, weight) in ellipse.edges(uniform_arc) {
            all += weight;
            part += if near(&ellipse.loops[curve][i]) { weight } else { 0.0 };
        }
        assert!((found - part / all).abs() < 0.01, "{found} and not {}", part / all);
    }
}

#[test]
fn gaussian_shifts_have_their_deviation_and_outliers_their_number() {
    let circle = truth("circle");
    let noise = CurveNoise { delta: 0.03, gaussian: true, outliers: 0.2, ..CurveNoise::default() };
    let sample = sample_curve(&circle, 30_000, &noise, 5);
    assert_eq!(sample.outlier.iter().filter(|&&o| o).count(), 6000);
    let (mut square, mut far) = (0.0, 0);
    for (p, &outlier) in sample.points.chunks(2).zip(&sample.outlier) {
        let shift = p[0].hypot(p[1]) - 1.0;
        if outlier {
            assert!(p.iter().all(|v| v.abs() <= 1.09));
            far += usize::from(shift.abs() > 0.12);
        } else {
            square += shift * shift;
        }
    }
    assert!(((square / 24_000.0).sqrt() - 0.03).abs() < 5e-4);
    assert!(far > 4000, "{far}");
    let again = sample_curve(&circle, 30_000, &noise, 5);
    assert_eq!(sample, again);
    assert_ne!(sample, sample_curve(&circle, 30_000, &noise, 6));
}

#[test]
fn a_row_does_not_depend_on_the_threads() {
    let flower = truth("flower5");
    let noise = CurveNoise { delta: 0.05, outliers: 0.1, ..CurveNoise::default() };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let one = pool.install(|| (truth("flower5"), sample_curve(&flower, 10_000, &noise, 1)));
    assert_eq!(one, (flower.clone(), sample_curve(&flower, 10_000, &noise, 1)));
}

#[test]
fn every_point_of_a_curve_is_served_by_an_epsilon_sample_and_its_edges_are_the_curve() {
    let curves = ["circle", "flower5", "multi4", "arc", "wave"]
        .map(|name| TestCurve::named(name).unwrap())
        .into_iter()
        .chain((0..6).map(TestCurve::random));
    for (seed, curve) in (0..).zip(curves).step_by(long_or(1, 3)) {
        let truth = curve.build_with(4000);
        for epsilon in [0.25, 0.45] {
            let sample = epsilon_sample(&truth, epsilon, seed);
            let points: Vec<[f64; 2]> = sample.points.chunks(2).map(|p| [p[0], p[1]]).collect();
            let ends = 2 * truth.closed.iter().filter(|&&closed| !closed).count();
            assert_eq!(2 * points.len(), 2 * sample.edges.len() + ends);
            let mut degree = vec![0; points.len()];
            sample.edges.iter().flatten().for_each(|&i| degree[i as usize] += 1);
            assert_eq!(degree.iter().filter(|&&d| d == 2).count(), points.len() - ends);
            let mut tight = 0.0f64;
            for (x, f) in truth.loops.iter().flatten().zip(truth.features.iter().flatten()) {
                let near = points
                    .iter()
                    .map(|p| (p[0] - x[0]).hypot(p[1] - x[1]))
                    .fold(f64::INFINITY, f64::min);
                assert!(near <= epsilon * f, "{near} of {epsilon}·{f}");
                tight = tight.max(near / (epsilon * f));
            }
            assert!(tight > 0.9, "{tight}: the allowance is not used");
            // Edges are short: none leads across.
            for [a, b] in sample.edges {
                let (p, q) = (points[a as usize], points[b as usize]);
                assert!((p[0] - q[0]).hypot(p[1] - q[1]) <= 2.0 * epsilon * truth.feature_max);
            }
        }
    }
}

#[test]
fn random_curves_differ_and_stay_within_their_bounds() {
    let curves = long_or(10, 3);
    let mut lengths: Vec<f64> = (0..curves)
        .map(|seed| {
            let truth = TestCurve::random(seed).build_with(2000);
            // Twice around at the least for anything closed: a circle has 2π.
            assert!((2.0 * PI - 1e-3..210.0).contains(&truth.length_over_feature));
            // More points change nothing: no feature was too small to be seen.
            let fine = TestCurve::random(seed).build_with(8000).length_over_feature;
            assert!((truth.length_over_feature / fine - 1.0).abs() < 0.02, "{seed}");
            truth.length_over_feature
        })
        .collect();
    lengths.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    assert_eq!(lengths.len(), curves as usize);
    assert_eq!(TestCurve::random(7), TestCurve::random(7));
}

#[test]
fn a_source_delivers_the_rows_of_the_sample_and_refuses_what_is_no_noise() {
    use crate::{Error, PointSource, Rows, ScalarKind, Scratch};
    let truth = TestCurve::named("wave").unwrap().build_with(500);
    let noise = CurveNoise { delta: 0.05, outliers: 0.1, ..CurveNoise::default() };
    let sample = sample_curve(&truth, 100, &noise, 9);
    let source = CurveSource::new(truth.clone(), 100, noise, 9, ScalarKind::F64).unwrap();
    let mut scratch = Scratch::new();
    let Rows::F64(rows) = source.read(30..70, &mut scratch).unwrap() else { panic!() };
    assert_eq!(rows.values(), &sample.points[60..140]);
    let single = CurveSource::new(truth.clone(), 100, noise, 9, ScalarKind::F32).unwrap();
    let mut scratch = Scratch::new();
    let Rows::F32(rows) = single.read(99..100, &mut scratch).unwrap() else { panic!() };
    assert_eq!(rows.row(0)[1], sample.points[199] as f32);
    assert!(single.read(99..101, &mut Scratch::new()).is_err());
    for (delta, outliers) in [(-1.0, 0.0), (f64::NAN, 0.0), (f64::INFINITY, 0.0), (0.1, 1.5)] {
        let noise = CurveNoise { delta, outliers, ..noise };
        let refused = CurveSource::new(truth.clone(), 3, noise, 9, ScalarKind::F64);
        assert!(matches!(refused, Err(Error::Parameter { .. })), "{delta} {outliers}");
    }
    let far = CurveNoise { delta: 1e300, outliers: 0.0, ..noise };
    let source = CurveSource::new(truth, 3, far, 9, ScalarKind::F32).unwrap();
    assert!(source.read(0..3, &mut Scratch::new()).is_err());
}
