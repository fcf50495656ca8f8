//! Honest curves and tours are true, doctored ones are not.

use taut::certify::Curve;
use taut::certify::{CurveDoubt, CurveVerdict, Place};
use taut::reconstruct::Ends;
use taut::{CurveMethod, CurveOptions, Points, Solution, curve};

use super::super::Truth;
use super::super::numbers::numbers;
use super::CurveOracle;
use crate::test_length::long_or;

type Judged = (Solution<Curve>, CurveVerdict);

/// Circles and ellipses, even and uneven, with corners, outliers, copies and gaps; noise; grids, lines and few points; all at
/// some place and scale.
fn inputs() -> Vec<Vec<f64>> {
    let ring = |n: usize, [a, b]: [f64; 2], uneven: f64| {
        let mut random = numbers(n as u64);
        (0..n).map(move |k| {
            let t = std::f64::consts::TAU * (k as f64 + uneven * random()) / n as f64;
            [a * t.cos(), b * t.sin()]
        })
    };
    let flat = |points: Vec<[f64; 2]>| points.into_iter().flatten().collect::<Vec<f64>>();
    let mut inputs: Vec<Vec<f64>> = vec![vec![], vec![3.0; 6], vec![0.0, 0.0, 1.0, 2.0]];
    for (n, axes) in [(24, [1.0, 1.0]), (40, [1.0, 1.0]), (40, [2.0, 1.0]), (60, [5.0, 1.0])] {
        for uneven in [0.0, 0.3, 0.9] {
            inputs.push(flat(ring(n, axes, uneven).collect()));
        }
    }
    let with = |mut points: Vec<[f64; 2]>, more: &[[f64; 2]]| {
        points.extend(more);
        flat(points)
    };
    let circle: Vec<[f64; 2]> = ring(40, [1.0, 1.0], 0.1).collect();
    inputs.push(with(circle.clone(), &[[5.0, 5.0], [-4.0, 3.0], [0.1, 0.2]]));
    inputs.push(with(circle.clone(), &circle[..7]));
    inputs.push(flat(circle[..33].to_vec()));
    let other = ring(26, [0.5, 0.5], 0.1).map(|[x, y]| [x + 1.0, y + 3.0]);
    inputs.push(with(circle[..].to_vec(), &other.collect::<Vec<_>>()));
    let mut random = numbers(5);
    let noisy = ring(60, [1.0, 1.0], 0.9).map(|p| p.map(|x| x * (1.0 + 0.1 * random())));
    inputs.push(flat(noisy.collect()));
    for n in [3, 4, 5, 7, 9, 11, 20, 45] {
        let mut random = numbers(n);
        inputs.push((0..2 * n).map(|_| random()).collect());
        inputs.push((0..2 * n).map(|_| (random() * 4.0).floor()).collect());
    }
    let square = |k: usize| match (k / 10, (k % 10) as f64) {
        (0, t) => [t, 0.0],
        (1, t) => [10.0, t],
        (2, t) => [10.0 - t, 10.0],
        (_, t) => [0.0, 10.0 - t],
    };
    inputs.push(flat((0..40).map(square).collect()));
    inputs.push(flat((0..9).map(|k| [f64::from(k * k), 2.0 * f64::from(k * k)]).collect()));
    let scaled = |values: &[f64], by: f64| values.iter().map(|x| x * by).collect::<Vec<f64>>();
    for scale in [1e-150, 1e150, 1e-310, 1e305] {
        inputs.push(scaled(&flat(circle.clone()), scale));
        inputs.push(scaled(&[0.0, 0.0, 3.0, 4.0, 6.0, 0.0, 3.0, 1.0], scale));
    }
    inputs.push(flat(circle.iter().map(|&[x, y]| [x + 1e6, y - 1e3]).collect()));
    inputs
}

/// The answers of all methods that find one.
fn solved(values: &[f64]) -> Vec<Judged> {
    let points = Points::new(values, 2).expect("rows");
    let mut found = vec![];
    for method in CurveMethod::ALL {
        for ends in [Ends::Auto, Ends::Open] {
            let options = CurveOptions { method, ends, places: true, ..Default::default() };
            if let Ok(solution) = curve(&points, &options) {
                let verdict = solution.check(&points).expect("accepted");
                found.push((solution, verdict));
            }
        }
    }
    found
}

#[test]
fn honest_curves_are_true() {
    let (mut all, mut undecided, mut certified, mut tours) = (0, 0, 0, 0);
    for values in inputs().into_iter().step_by(long_or(1, 2)) {
        let oracle = CurveOracle::new(&values, 2);
        for (solution, verdict) in solved(&values) {
            let truth = oracle.judge(&solution, &verdict);
            let method = &solution.trace.method;
            assert!(
                !matches!(truth, Truth::False(_)),
                "{method}: {truth:?} {verdict:?} {values:?}"
            );
            all += 1;
            undecided += usize::from(truth != Truth::True);
            certified += usize::from(verdict.certified);
            tours += usize::from(verdict.tour_gap.is_some());
        }
    }
    eprintln!("{all} curves, {certified} certified, {tours} tours, {undecided} undecided");
    assert!(50 * undecided <= all && certified >= long_or(50, 25) && tours >= long_or(50, 25));
}

/// Each change alone is a lie wherever it is a change.
#[test]
fn doctored_curves_are_false() {
    type Change = fn(&mut Solution<Curve>, &mut CurveVerdict);
    let changes: [(&str, Change); 17] = [
        ("two vertices exchanged", |found, _| {
            if let Some(one) = found.answer.curves.first_mut()
                && one.vertices.len() > 1
            {
                one.vertices.swap(0, 1);
            }
        }),
        ("edges that cross", |found, verdict| {
            if let Some(one) = found.answer.curves.first_mut()
                && one.vertices.len() >= 24
                && one.closed
                && verdict.is_simple
            {
                one.vertices.swap(0, 12);
                if !one.rows.is_empty() {
                    one.rows.swap(0, 12);
                }
                found.answer.places.clear();
            }
        }),
        ("a curve less", |found, _| {
            if !found.answer.curves.is_empty() {
                found.answer.curves.pop();
                found.answer.places.clear();
            }
        }),
        ("a band that is narrower", |found, verdict| {
            let vertices = found.answer.curves.iter().flat_map(|one| one.vertices.as_flattened());
            let size = vertices.fold(0.0f64, |most, x| most.max(x.abs()));
            // The band is rounded up by some roundings of the coordinates.
            if verdict.band > 1e-6 * size {
                let narrow = verdict.band * (1.0 - 1e-9);
                (found.certificate.band, verdict.band) = (narrow, narrow);
            }
        }),
        ("an outlier that is a vertex", |found, _| {
            if let Some(&row) = found.answer.curves.first().and_then(|one| one.rows.first()) {
                found.answer.outliers = vec![row];
            }
        }),
        ("an outlier less", |found, _| {
            if found.answer.curves.iter().any(|one| !one.rows.is_empty()) {
                found.answer.outliers.pop();
            }
        }),
        ("an outlier twice", |found, _| {
            if let Some(&row) = found.answer.outliers.last() {
                found.answer.outliers.push(row);
            }
        }),
        ("a place moved", |found, _| {
            let is_long = |one: &&taut::certify::CurveComponent| one.vertices.len() > 8;
            let one = found.answer.curves.first().filter(is_long);
            if let (Some(one), Some(place)) = (one, found.answer.places.first_mut()) {
                let half = (one.vertices.len() / 2) as f64;
                *place = Place(0, if place.1 < half { place.1 + half } else { place.1 - half });
            }
        }),
        ("open for closed", |found, _| {
            if let Some(one) = found.answer.curves.first_mut()
                && one.closed
                && found.certificate.tour.is_none()
            {
                one.closed = false;
                found.answer.places.clear();
            }
        }),
        ("simple or not", |_, verdict| verdict.is_simple ^= true),
        ("certified or not", |_, verdict| verdict.certified ^= true),
        ("certified without evidence", |found, verdict| {
            if !verdict.certified {
                (found.certificate.certified, verdict.certified, verdict.doubt) =
                    (true, true, None);
            }
        }),
        ("denser samples", |found, verdict| {
            if verdict.sampling_ratio.is_finite() {
                verdict.sampling_ratio *= 0.5;
                found.certificate.sampling_ratio = verdict.sampling_ratio;
            }
        }),
        ("another doubt", |_, verdict| {
            if verdict.doubt.is_some() {
                verdict.doubt = Some(CurveDoubt::Corner { curve: 0, vertex: 0, degrees: 61.0 });
            }
        }),
        ("a smaller gap of a tour", |_, verdict| {
            if let Some(gap) = verdict.tour_gap.as_mut().filter(|gap| **gap > 1e-3) {
                *gap = *gap * (1.0 - 1e-9) - 1e-9;
            }
        }),
        ("a bound above the tour", |found, _| {
            let length = |one: &taut::certify::CurveComponent| {
                taut::certify::tour_length(&one.vertices, !one.closed)
            };
            let length = found.answer.curves.first().map_or(0.0, length);
            if let Some(bound) = found.certificate.tour.as_mut()
                && length > 0.0
                && length < 1e300
                && length > 1e-300
            {
                bound.lower = length * (1.0 + 1e-7);
            }
        }),
        ("another hash", |found, _| {
            let other = Points::new(&[1.5], 1).expect("one row");
            let hash = taut::points::hash_points(&other, &taut::Monitor::silent());
            found.certificate.points_hash = hash.expect("in memory");
        }),
    ];
    let mut judged = [0; 17];
    for values in inputs().into_iter().skip(long_or(0, 1)).step_by(long_or(1, 2)) {
        let oracle = CurveOracle::new(&values, 2);
        for honest in solved(&values) {
            for (count, (name, change)) in judged.iter_mut().zip(&changes) {
                let (mut found, mut verdict) = honest.clone();
                change(&mut found, &mut verdict);
                if (&found, verdict) == (&honest.0, honest.1) {
                    continue;
                }
                let truth = oracle.judge(&found, &verdict);
                let method = &found.trace.method;
                assert!(matches!(truth, Truth::False(_)), "{name}, {method}: {truth:?} {values:?}");
                *count += 1;
            }
        }
    }
    assert!(judged.iter().all(|&count| count >= long_or(5, 2)), "{judged:?}");
}

/// Four points whose shortest tour is the square: another order is longer by √2/2 − 1/2, and the gap has to say so.
#[test]
fn the_gap_of_a_tour_is_that_to_the_shortest() {
    let values = [0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0];
    let options = CurveOptions { method: CurveMethod::Tour, ..Default::default() };
    let points = Points::new(&values, 2).expect("rows");
    let mut found = curve(&points, &options).expect("solved");
    let mut verdict = found.check(&points).expect("accepted");
    let oracle = CurveOracle::new(&values, 2);
    let tour = &mut found.answer.curves[0];
    tour.rows = vec![0, 2, 1, 3];
    tour.vertices = vec![[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
    found.answer.places.clear();
    verdict.is_simple = false;
    verdict.doubt = Some(CurveDoubt::Crossing { curve: 0, edge: 0 });
    let truth = (2.0 + 8f64.sqrt()) / 4.0 - 1.0;
    for (gap, is_true) in [(truth * (1.0 - 1e-14), false), (truth * (1.0 + 1e-14), true)] {
        verdict.tour_gap = Some(gap);
        let bound = found.certificate.tour.as_mut().expect("a bound");
        bound.potentials.fill(0.0);
        bound.lower = 4.0;
        let said = oracle.judge(&found, &verdict);
        // The bound from no potentials is that of the least 1-tree, which is the square.
        assert_eq!(said == Truth::True, is_true, "{gap:e}: {said:?}");
    }
}
