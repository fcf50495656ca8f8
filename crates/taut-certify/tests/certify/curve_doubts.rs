//! Curves that are right beside their rows, but not certified, each for its reason; and beside each the one that is.

use std::f64::consts::TAU;

use crate::test_length::long_or;
use taut_certify::{
    CheckError, Curve, CurveCertificate, CurveComponent, CurveDoubt, CurveVerdict, Solution, Trace,
};
use taut_points::{Monitor, Points, hash_points};

type Loop = Vec<[f64; 2]>;

/// The k-th of some numbers in [0, 1) that fill it evenly, in an order of their own for each `seed`.
fn random(seed: u64, k: u64) -> f64 {
    let mut x = (seed << 40 ^ k).wrapping_add(0x9E37_79B9_7F4A_7C15);
    for factor in [0xBF58_476D_1CE4_E5B9, 0x94D0_49BB_1331_11EB] {
        x = (x ^ x >> 30).wrapping_mul(factor);
        x ^= x >> 27;
    }
    (x >> 11) as f64 / 2f64.powi(53)
}

fn at(radius: f64, turn: f64) -> [f64; 2] {
    [radius * (TAU * turn).cos(), radius * (TAU * turn).sin()]
}

/// Rows at random around a circle, off it by up to `noise`.
fn ring(radius: f64, noise: f64, rows: u64, seed: u64) -> Loop {
    let off = |k| radius + noise * (2.0 * random(seed, 2 * k) - 1.0);
    (0..rows).map(|k| at(off(k), random(seed, 2 * k + 1))).collect()
}

fn circle(radius: f64, vertices: usize) -> Loop {
    (0..vertices).map(|k| at(radius, k as f64 / vertices as f64)).collect()
}

/// A closed curve; rows farther off than `band` are outliers, and those after the first `kept`.
fn judged(
    curve: Loop,
    rows: &[[f64; 2]],
    band: f64,
    kept: usize,
) -> Result<CurveVerdict, CheckError> {
    let points = Points::new(rows.as_flattened(), 2).unwrap();
    let is_exact = curve.len() == kept;
    let outliers = (0u64..).zip(rows).filter(|(k, p)| {
        let off = (p[0].hypot(p[1]) - 1.0).abs();
        *k >= kept as u64 || off > band + 1e-3
    });
    let answer = Curve {
        outliers: outliers.map(|(row, _)| row).collect(),
        curves: vec![CurveComponent {
            rows: if is_exact { (0..kept as u64).collect() } else { vec![] },
            vertices: curve,
            closed: true,
        }],
        noise: if is_exact { 0.0 } else { band },
        places: vec![],
    };
    let certificate = CurveCertificate {
        band: if is_exact { 0.0 } else { band + 2e-3 },
        sampling_ratio: f64::MAX,
        noise_ratio: f64::MAX,
        certified: false,
        tour: None,
        points_hash: hash_points(&points, &Monitor::silent()).unwrap(),
    };
    Solution { answer, certificate, trace: Trace::default() }.check(&points)
}

/// Many rings with gaps between them, the middle one found: thin gaps need long windows.
#[test]
fn rings_beside_each_other_are_no_band() {
    for (rings, share) in [(2, 0.6), (2, 0.8), (3, 0.6), (6, 0.6), (6, 0.3)] {
        let apart = 0.16 / f64::from(rings - 1);
        let radius = |ring: i32| 1.0 + apart * (f64::from(ring) - 0.5 * f64::from(rings - 1));
        let noise = 0.5 * share * apart;
        let all = |ring_of: i32| ring(radius(ring_of), noise, 3000, ring_of as u64 + 1);
        let rows: Loop = (0..rings).flat_map(all).collect();
        let verdict = judged(circle(1.0, 300), &rows, 0.08 + noise, rows.len()).unwrap();
        let doubt = verdict.doubt;
        assert!(matches!(doubt, Some(CurveDoubt::Split { .. })), "{rings} {share}: {doubt:?}");
    }
    let one = ring(1.0, 0.1, 18_000, 9);
    assert_eq!(judged(circle(1.0, 300), &one, 0.1, one.len()).unwrap().doubt, None);
}

/// A few hundred rows of two rings a third as far apart as those are wide, or of normal noise with centers five deviations apart.
#[test]
fn few_rows_of_two_rings_are_no_band() {
    let normal = |radius: f64, seed: u64| -> Loop {
        let off = |k: u64| (0..12).map(|i| random(seed, 100 * k + i)).sum::<f64>() - 6.0;
        (0..150).map(|k| at(radius + 0.012 * off(k), random(seed, 100 * k + 50))).collect()
    };
    for seed in 1..20 {
        let rows = [ring(0.97, 0.023, 150, seed), ring(1.03, 0.023, 150, seed + 50)].concat();
        let verdict = judged(circle(1.0, 200), &rows, 0.054, rows.len()).unwrap();
        assert!(matches!(verdict.doubt, Some(CurveDoubt::Split { .. })), "{:?}", verdict.doubt);
        let rows = [normal(0.97, seed), normal(1.03, seed + 50)].concat();
        let verdict = judged(circle(1.0, 200), &rows, 0.1, rows.len()).unwrap();
        assert!(matches!(verdict.doubt, Some(CurveDoubt::Split { .. })), "{:?}", verdict.doubt);
        let rows = [normal(1.0, seed), normal(1.0, seed + 50)].concat();
        let verdict = judged(circle(1.0, 200), &rows, 0.1, rows.len()).unwrap();
        assert!(!matches!(verdict.doubt, Some(CurveDoubt::Split { .. })), "{:?}", verdict.doubt);
    }
}

/// A thin ring beside a wide band: said to be outliers, or taken in as one row in thirty of the band.
#[test]
fn a_ring_close_to_a_band_is_noticed() {
    let base = ring(1.0, 0.05, 10_000, 1);
    let rows = [base.clone(), ring(1.095, 0.001, 500, 2)].concat();
    let doubt = judged(circle(1.0, 300), &rows, 0.05, 10_000).unwrap().doubt;
    assert!(matches!(doubt, Some(CurveDoubt::Beside { outliers: 500 })), "{doubt:?}");
    let rows = [base, ring(1.075, 0.001, 300, 2)].concat();
    let doubt = judged(circle(1.0, 300), &rows, 0.077, rows.len()).unwrap().doubt;
    assert!(matches!(doubt, Some(CurveDoubt::Split { .. })), "{doubt:?}");
}

/// A small ring of rows among outliers that are twice as many, but not so near to each other.
#[test]
fn a_small_curve_among_outliers_is_noticed() {
    let base = ring(1.0, 0.004, 1700, 1);
    let some = |k: u64| [0, 1].map(|c| 2.4 * (random(7, 2 * k + c) - 0.5));
    let far = |p: &[f64; 2]| (p[0].hypot(p[1]) - 1.0).abs() > 0.02;
    let clutter: Loop = (0..90).map(some).filter(far).collect();
    for (rows, radius) in [(40, 0.24), (30, 0.2), (20, 0.1)] {
        let moved = |p: &[f64; 2]| [p[0] + 0.3, p[1] - 0.2];
        let missed: Loop = ring(radius, 0.004, rows, 3).iter().map(moved).collect();
        let rows = [base.clone(), clutter.clone(), missed].concat();
        let doubt = judged(circle(1.0, 300), &rows, 0.004, 1700).unwrap().doubt;
        assert!(matches!(doubt, Some(CurveDoubt::Gathered { .. })), "{radius}: {doubt:?}");
    }
    let rows = [base, clutter].concat();
    assert_eq!(judged(circle(1.0, 300), &rows, 0.004, 1700).unwrap().doubt, None);
}

/// Rows of a curve that is missed are no outliers, however sparse or far; rows at random are.
#[test]
fn a_curve_among_the_outliers_is_noticed() {
    let base = || ring(1.0, 0.02, 20_000, 1);
    let missed = [ring(5.0, 0.05, 1000, 2), ring(1.1, 0.01, 400, 3), ring(0.4, 0.01, 60, 4)];
    for (k, missed) in missed.into_iter().enumerate() {
        let rows: Loop = base().into_iter().chain(missed).collect();
        let verdict = judged(circle(1.0, 300), &rows, 0.02, 20_000).unwrap();
        let is_right = |doubt: CurveDoubt| {
            matches!(doubt, CurveDoubt::Gathered { .. } | CurveDoubt::Cluster { .. })
        };
        assert!(verdict.doubt.is_some_and(is_right), "{k}: {:?}", verdict.doubt);
    }
    for (clutter, size) in [(3, 3.0), (20, 3.0), (300, 3.0), (2000, 8.0)] {
        let some = |k: u64| [0, 1].map(|c| size * (random(7, 2 * k + c) - 0.5));
        let far = |p: &[f64; 2]| (p[0].hypot(p[1]) - 1.0).abs() > 0.05;
        let rows: Loop = base().into_iter().chain((0..clutter).map(some).filter(far)).collect();
        let doubt = judged(circle(1.0, 300), &rows, 0.02, 20_000).unwrap().doubt;
        // So many could be a small curve, and are too few to show that they are none.
        let is_handful = matches!(doubt, Some(CurveDoubt::Handful { .. }));
        assert!(if clutter == 20 { is_handful } else { doubt.is_none() }, "{clutter}: {doubt:?}");
    }
}

/// Outliers anywhere, and up to three more far off, for which the box around all is so large that others would be near each other in it; four
/// are as far as a curve that was missed can be.
#[test]
fn few_outliers_far_away_change_nothing() {
    let mut rows = ring(1.0, 0.01, 2000, 3);
    let anywhere = (0..380).map(|k| [0, 1].map(|i| 3.0 * random(8, 2 * k + i) - 1.5));
    rows.extend(anywhere.filter(|p| (p[0].hypot(p[1]) - 1.0).abs() > 0.024));
    for &far in long_or(&[0.0, 10.0, 1e3, 1e20, 1e100][..], &[0.0, 10.0, 1e100]) {
        let doubt = |count: usize| {
            let mut rows = rows.clone();
            rows.extend((0..count).map(|k| at(far, 0.1 + 0.2 * k as f64)));
            judged(circle(1.0, 300), &rows, 0.01, 2000).unwrap().doubt
        };
        (1..=3).for_each(|count| assert_eq!(doubt(count), None, "{far} {count}"));
        let four = doubt(4);
        assert_eq!(matches!(four, Some(CurveDoubt::Gathered { .. })), far > 1.0, "{far}: {four:?}");
    }
}

/// Rows beside the curve that fill a part of its length as evenly as others fill the whole: too sparse for a circle around one of them to
/// show, or for a few in a row, but not for a stretch as long as that part.
#[test]
fn outliers_along_a_stretch_of_the_curve_are_noticed() {
    let beside = |radius: f64, turn: f64, k: u64| {
        let side = (random(7, 2 * k) - 0.5).signum();
        at(radius + side * (0.025 + 0.025 * random(7, 2 * k + 1)), turn)
    };
    for (count, part) in [(40, 0.25), (36, 0.18), (60, 0.4)] {
        let doubt = |radius: f64, part: f64| {
            let mut rows = ring(1.0, 0.01, 2000, 3);
            let anywhere = (0..380).map(|k| [0, 1].map(|i| 3.0 * random(8, 2 * k + i) - 1.5));
            rows.extend(anywhere.filter(|p| (p[0].hypot(p[1]) - 1.0).abs() > 0.024));
            let turn = |k: u64| 0.3 + part * k as f64 / count as f64;
            rows.extend((0..count).map(|k| beside(radius, turn(k), k)));
            judged(circle(1.0, 300), &rows, 0.01, 2000).unwrap().doubt
        };
        let along = doubt(1.0, part);
        assert!(matches!(along, Some(CurveDoubt::Gathered { .. })), "{count} {part}: {along:?}");
        let away = doubt(1.25, part);
        assert!(!matches!(away, Some(CurveDoubt::Gathered { .. })), "{count} {part}: {away:?}");
        assert_eq!(doubt(1.0, 1.0), None, "{count}, all around");
    }
}

#[test]
fn rows_within_the_band_are_no_outliers() {
    let rows = ring(1.0, 0.02, 10_000, 1);
    let verdict = judged(circle(1.0, 300), &rows, 0.02, 9000).unwrap();
    assert_eq!(verdict.doubt, Some(CurveDoubt::Inside { outliers: 1000 }));
}

/// Evenly spaced rows with some left out, the gap closed by an edge.
#[test]
fn a_gap_in_even_samples_is_noticed() {
    for (left_out, is_open) in [(0, false), (1, false), (4, true), (10, true)] {
        let rows: Loop = circle(1.0, 1000).into_iter().skip(left_out).collect();
        let verdict = judged(rows.clone(), &rows, 0.0, rows.len()).unwrap();
        let is_noticed = matches!(verdict.doubt, Some(CurveDoubt::Lacuna { .. }));
        assert_eq!(is_noticed, is_open, "{left_out}: {:?}", verdict.doubt);
        assert_eq!(verdict.certified, !is_open);
    }
}

/// A wave about the circle that was found.
#[test]
fn rows_that_wind_about_the_curve_are_noticed() {
    let wave = |k: u64| {
        let turn = random(5, 2 * k);
        at(1.0 + 0.05 * (40.0 * TAU * turn).sin() + 0.005 * random(5, 2 * k + 1), turn)
    };
    let rows: Loop = (0..4000).map(wave).collect();
    let doubt = judged(circle(1.0, 300), &rows, 0.056, rows.len()).unwrap().doubt;
    assert!(matches!(doubt, Some(CurveDoubt::Winding { .. })), "{doubt:?}");
}

/// A curve that runs forth, back and forth again within its band, answered straight through; three passes 2.5 half-widths apart.
#[test]
fn a_fold_within_the_band_is_noticed() {
    for seed in 1..8 {
        let pass = |k: u64| {
            let place = random(seed, 2 * k) * 1.2;
            let off = 0.02 * (2.0 * random(seed, 2 * k + 1) - 1.0);
            match place {
                x if x < 0.9 => at(1.0 + off, 0.1 + x),
                x => at(
                    1.0 + off + 0.05 * (((x - 0.9) / 0.1).floor() - 1.0),
                    (x * 10.0).fract() / 10.0,
                ),
            }
        };
        let rows: Loop = (0..2000).map(pass).collect();
        let doubt = judged(circle(1.0, 300), &rows, 0.075, rows.len()).unwrap().doubt;
        let is_noticed = |doubt| {
            matches!(
                doubt,
                CurveDoubt::Swollen { .. } | CurveDoubt::Wide { .. } | CurveDoubt::Split { .. }
            )
        };
        assert!(doubt.is_some_and(is_noticed), "{seed}: {doubt:?}");
    }
}

#[test]
fn vertices_that_are_rows_have_no_noise_and_are_no_outliers() {
    let rows = circle(1.0, 100);
    let points = Points::new(rows.as_flattened(), 2).unwrap();
    let check = |noise: f64, outliers: Vec<u64>| {
        let one = CurveComponent { vertices: rows.clone(), closed: true, rows: (0..100).collect() };
        let certificate = CurveCertificate {
            band: 0.0,
            sampling_ratio: f64::MAX,
            noise_ratio: f64::MAX,
            certified: false,
            tour: None,
            points_hash: hash_points(&points, &Monitor::silent()).unwrap(),
        };
        let answer = Curve { curves: vec![one], noise, outliers, places: vec![] };
        Solution { answer, certificate, trace: Trace::default() }.check(&points)
    };
    assert!(check(0.0, vec![]).is_ok());
    assert!(matches!(check(0.1, vec![]), Err(CheckError::Rejected(_))));
    assert!(matches!(check(0.0, vec![3]), Err(CheckError::Rejected(_))));
}
