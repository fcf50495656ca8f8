//! Tests what is refused by name, closed forms, the assignment, and documents.

use std::sync::atomic::{AtomicBool, Ordering};

use common::centers::{Best, Case, Task, best, by_hand, everything, log};
use common::numbers;
use proptest::prelude::*;
use taut_certify::{
    Answer, AnySolution, AnyVerdict, Centers, CentersCertificate, CentersViolation, CheckError,
    Items, LowerBound, Placement, Solution, Trace, Violation,
};
use taut_points::{Monitor, Points, PointsHash, ReadError, hash_points};

use crate::common;

fn refusal(found: &Solution<Centers>, points: &Points<'_, f64>) -> CentersViolation {
    match found.check(points) {
        Err(CheckError::Rejected(Violation::Centers(violation))) => violation,
        other => panic!("{other:?}"),
    }
}

#[test]
fn integer_corners_have_no_gap_at_all() {
    // Three balls for the corners of a square: two corners share one, and any two are 2 apart or more.
    let square = [0.0, 0.0, 2.0, 0.0, 0.0, 2.0, 2.0, 2.0];
    let points = Points::new(&square, 2).unwrap();
    let centers: [&[f64]; 3] = [&[1.0, 0.0], &[0.0, 2.0], &[2.0, 2.0]];
    let found = by_hand(&points, &centers, (1.0, 1.0), &[0, 1, 2, 3], LowerBound::Separated);
    let verdict = found.check(&points).unwrap();
    assert_eq!((verdict.lower, verdict.upper, verdict.gap, verdict.branches), (1.0, 1.0, 0.0, 0));
    let branches = LowerBound::Branches { items: vec![0, 1, 2, 3] };
    let replayed = by_hand(&points, &centers, (1.0, 1.0), &[0, 1, 2, 3], branches);
    let verdict = replayed.check(&points).unwrap();
    assert_eq!((verdict.gap, verdict.branches), (0.0, 4));
    // An ulp more is not so.
    let mut more = found.clone();
    (more.answer.lower_bound, more.answer.radius) = (1f64.next_up(), 1f64.next_up());
    let close = CentersViolation::NotApart { first: 0, second: 1 };
    assert_eq!(refusal(&more, &points), close);
}

#[test]
fn one_center_is_the_smallest_ball() {
    // 3-4-5: the hypotenuse of 10 is a diameter.
    let values = [0.0, 0.0, 6.0, 0.0, 6.0, 8.0, 3.0, 4.0];
    let points = Points::new(&values, 2).unwrap();
    let center: [&[f64]; 1] = [&[3.0, 4.0]];
    let found = by_hand(&points, &center, (5.0, 5.0), &[0, 2], LowerBound::Separated);
    assert_eq!(found.check(&points).unwrap().gap, 0.0);
    // An equilateral triangle, of radius 1/√3.
    let values = [0.0, 0.0, 1.0, 0.0, 0.5, 3f64.sqrt() / 2.0];
    let points = Points::new(&values, 2).unwrap();
    let radius = 1.0 / 3f64.sqrt();
    let center: [&[f64]; 1] = [&[0.5, radius / 2.0]];
    let bounds = (radius * (1.0 + 1e-15), radius * (1.0 - 1e-13));
    let branches = LowerBound::Branches { items: vec![0, 1, 2] };
    let found = by_hand(&points, &center, bounds, &[0, 1, 2], branches);
    assert!(found.check(&points).unwrap().gap < 2e-13);
    let found = by_hand(&points, &center, bounds, &[0, 1], LowerBound::Separated);
    assert_eq!(refusal(&found, &points), CentersViolation::NotApart { first: 0, second: 1 });
}

#[test]
fn nothing_is_to_be_proved_of_zero() {
    let values = [1.0, 2.0, 1.0, 2.0, 3.0, 4.0];
    let points = Points::new(&values, 2).unwrap();
    let centers: [&[f64]; 2] = [&[1.0, 2.0], &[3.0, 4.0]];
    let mut found = by_hand(&points, &centers, (0.0, 0.0), &[], LowerBound::Separated);
    found.certificate.gap = 0.0;
    assert_eq!(found.check(&points).unwrap().gap, 0.0);
    // Where the bound alone is 0, the gap is as large as a number can be.
    let mut found = by_hand(&points, &centers, (1.0, 0.0), &[], LowerBound::Separated);
    assert_eq!(found.check(&points).unwrap().gap, f64::INFINITY);
    found.certificate.gap = 1e300;
    assert!(matches!(refusal(&found, &points), CentersViolation::Gap { .. }));
}

#[test]
fn a_bound_of_minus_zero_is_no_number() {
    let values = [0.0, 0.0, 1.0, 0.0];
    let points = Points::new(&values, 2).unwrap();
    for lower in [-0.0, -1.0] {
        let mut found = by_hand(&points, &[&[0.0, 0.0]], (1e6, lower), &[], LowerBound::Separated);
        found.certificate.gap = 0.0;
        match found.check(&points) {
            Err(CheckError::Rejected(Violation::Number { what, .. })) => {
                assert_eq!(what, "the lower bound")
            }
            other => panic!("{other:?}"),
        }
    }
}

/// The least radius is 1. Beside squares of 1e155 and more, the differences of depths are no numbers.
#[test]
fn weights_far_apart_prove_nothing() {
    for weight in [1e100, 1e150, 1e155, 1e200, 1e300] {
        for rows in [[0.0, 0.0, 1.0, 0.0, 1.0, weight], [0.0, 1.0, weight, 0.0, 0.0, 1.0]] {
            let points = Points::new(&rows, 3).unwrap();
            let proof = LowerBound::Branches { items: vec![0, 1] };
            let centers: [&[f64]; 1] = [&[0.0, 1.0]];
            let mut found = by_hand(&points, &centers, (1e6, 1e6), &[0, 1], proof);
            found.certificate.weights = true;
            let refused = found.check(&points);
            assert!(matches!(refused, Err(CheckError::Rejected(_))), "{weight}: {refused:?}");
            (found.answer.radius, found.answer.lower_bound) = (1.0, 0.999);
            found.certificate.gap = 0.01;
            if weight <= 1e100 {
                assert!(found.check(&points).is_ok(), "{weight}: {:?}", found.check(&points));
            }
        }
    }
}

/// The heavy point fixes one center; the others are 2 apart.
#[test]
fn weights_far_apart_do_not_hide_what_is_apart() {
    let rows = [0.0, 1e150, 1.0, 1e-150, 3.0, 1e-150];
    let points = Points::new(&rows, 2).unwrap();
    let centers: [&[f64]; 2] = [&[0.0], &[2.0]];
    for (lower, is_bound) in [(0.999e-150, true), (1.001e-150, false)] {
        let radius = 1e-150 * (1.0 + 1e-2);
        let mut found =
            by_hand(&points, &centers, (radius, lower), &[0, 1, 2], LowerBound::Separated);
        found.certificate.weights = true;
        assert_eq!(found.check(&points).is_ok(), is_bound, "{lower}: {:?}", found.check(&points));
    }
}

#[test]
fn rows_that_are_no_items_are_named() {
    let check = |values: &[f64], change: &dyn Fn(&mut Solution<Centers>)| {
        let points = Points::new(values, 2).unwrap();
        let mut found = by_hand(&points, &[&[0.0]], (9.0, 0.0), &[], LowerBound::Separated);
        change(&mut found);
        match found.check(&points) {
            Err(CheckError::Rejected(violation)) => violation,
            other => panic!("{other:?}"),
        }
    };
    let weights = |found: &mut Solution<Centers>| found.certificate.weights = true;
    for value in [0.0, -1.0] {
        let violation = check(&[1.0, 1.0, 2.0, value], &weights);
        assert_eq!(violation, CentersViolation::Weight { row: 1, value }.into());
    }
    let balls = |found: &mut Solution<Centers>| found.certificate.items = Items::Balls;
    let violation = check(&[1.0, 1.0, 2.0, -0.5], &balls);
    assert_eq!(violation, Violation::NegativeRadius { row: 1, value: -0.5 });
    let points = |found: &mut Solution<Centers>| found.answer.centers[0].push(0.0);
    let violation = check(&[1.0, f64::INFINITY], &points);
    assert_eq!(violation, Violation::NonFinite { row: 0, column: 1, value: f64::INFINITY });
}

#[test]
fn equally_near_centers_are_all_right_and_others_are_not() {
    let values = [0.0, 0.0, 4.0, 0.0, 2.0, 0.0, 2.0, 1.0];
    let points = Points::new(&values, 2).unwrap();
    let centers: [&[f64]; 2] = [&[0.0, 0.0], &[4.0, 0.0]];
    let mut found = by_hand(&points, &centers, (3.0, 1.0), &[0, 1, 2], LowerBound::Separated);
    for middle in [[0, 0], [0, 1], [1, 0], [1, 1]] {
        found.answer.assignment = vec![0, 1, middle[0], middle[1]];
        found.check(&points).unwrap();
    }
    found.answer.assignment = vec![1, 1, 0, 0];
    let wrong = CentersViolation::Assignment { row: 0, center: 1, nearer: 0 };
    assert_eq!(refusal(&found, &points), wrong);
}

#[test]
fn what_is_too_large_is_named() {
    let values = numbers(2 * 20_000, 1);
    let points = Points::new(&values, 2).unwrap();
    let core: Vec<u64> = (0..16_385).collect();
    let proof = LowerBound::Branches { items: vec![0] };
    let found = by_hand(&points, &[&[0.0, 0.0]], (2.0, 0.1), &core, proof);
    let violation = refusal(&found, &points);
    let is_named = matches!(violation, CentersViolation::CoreSetSize { most: 16_384, .. });
    assert!(is_named, "{violation:?}");
}

/// However small it is, the proof of the bound asks whether to go on after the pass over the rows.
#[test]
fn a_proof_that_is_stopped_ends() {
    let values = [0.0, 0.0, 1.0, 0.0, 0.5, 3f64.sqrt() / 2.0];
    let points = Points::new(&values, 2).unwrap();
    let radius = 1.0 / 3f64.sqrt();
    let branches = LowerBound::Branches { items: vec![0, 1] };
    for (placement, radius) in [(Placement::Free, radius * (1.0 + 1e-15)), (Placement::Rows, 1.0)] {
        for proof in [LowerBound::Separated, branches.clone()] {
            let center: &[f64] = match placement {
                Placement::Free => &[0.5, radius / 2.0],
                Placement::Rows => &[0.0, 0.0],
            };
            let mut found = by_hand(&points, &[center], (radius, 0.45), &[0, 1, 2], proof);
            if placement == Placement::Rows {
                (found.certificate.placement, found.answer.rows) = (placement, vec![0]);
            }
            assert!(found.check(&points).is_ok(), "{:?}", found.check(&points));
            let cancel = AtomicBool::new(false);
            let stop = |_| cancel.store(true, Ordering::Relaxed);
            let monitor =
                Monitor { on_points: Some(&stop), cancel: Some(&cancel), ..Monitor::silent() };
            match found.answer.check(&found.certificate, &points, &monitor) {
                Err(CheckError::Read(ReadError::Cancelled(_))) => {}
                other => panic!("{other:?}"),
            }
        }
    }
}

/// Each item gets a ball of its own, one below the other: the replay is as deep as the core-set is large.
#[test]
fn a_deep_log_takes_no_stack() {
    let values: Vec<f64> = (0..1024).flat_map(|i| [f64::from(i % 32), f64::from(i / 32)]).collect();
    let points = Points::new(&values, 2).unwrap();
    let core: Vec<u64> = (0..1024).collect();
    let proof = LowerBound::Branches { items: (0..1024).collect() };
    let mut found = by_hand(&points, &[&[16.0, 16.0]], (30.0, 0.4), &core, proof);
    found.certificate.k = 1024;
    let judged = || refusal(&found, &points);
    let small = std::thread::Builder::new().stack_size(256 << 10);
    let violation =
        std::thread::scope(|scope| small.spawn_scoped(scope, judged).unwrap().join().unwrap());
    assert_eq!(violation, CentersViolation::LogEnds { branches: 1024 });
}

/// 5000 rows and 200 centers, of which each row finds one by way of lists.
#[test]
fn many_centers_hold_many_rows() {
    let values = numbers(3 * 5000, 9);
    let points = Points::new(&values, 3).unwrap();
    let centers: Vec<&[f64]> = values.chunks(3).take(200).collect();
    let reach = |row: &[f64]| {
        let square = |c: &[f64]| row.iter().zip(c).map(|(x, c)| (x - c).powi(2)).sum::<f64>();
        let all = centers.iter().map(|c| square(c).sqrt()).enumerate();
        all.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap()
    };
    let nearest: Vec<(usize, f64)> = values.chunks(3).map(reach).collect();
    let (row, radius) =
        nearest.iter().map(|n| n.1).enumerate().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
    let make = |radius: f64| {
        let mut found = by_hand(&points, &centers, (radius, 0.0), &[], LowerBound::Separated);
        found.answer.assignment = nearest.iter().map(|n| n.0 as u32).collect();
        found
    };
    make(radius * (1.0 + 1e-15)).check(&points).unwrap();
    let mut found = make(radius * (1.0 - 1e-15));
    for _ in 0..2 {
        let violation = refusal(&found, &points);
        let CentersViolation::Outside { row: named, center, .. } = violation else {
            panic!("{violation:?}")
        };
        assert_eq!((named, center), (row as u64, nearest[row].0));
        found.answer.assignment.clear();
    }
}

fn any_finite() -> impl Strategy<Value = f64> {
    any::<u64>().prop_map(f64::from_bits).prop_filter("finite", |v| v.is_finite())
}

fn any_solution() -> impl Strategy<Value = Solution<Centers>> {
    let places = prop::collection::vec(prop::collection::vec(any_finite(), 0..4), 0..4);
    let numbers = (any_finite(), any_finite(), any_finite());
    let lists = (
        prop::collection::vec(any::<u64>(), 0..4),
        prop::collection::vec(any::<u64>(), 0..4),
        prop::collection::vec(any::<u32>(), 0..6),
        prop::collection::vec(0u64..4, 0..4),
    );
    let kinds = (0..2usize, 0..2usize, any::<bool>(), 0u64..4, 0u64..3, any::<u64>());
    (places, numbers, lists, kinds).prop_map(|(centers, numbers, lists, kinds)| {
        let (radius, lower_bound, gap) = numbers;
        let (rows, outliers, items_of_log, core_set) = lists;
        let (balls, proof, placed, k, z, hash) = kinds;
        Solution {
            answer: Centers {
                centers,
                rows,
                radius,
                lower_bound,
                outliers,
                assignment: items_of_log.clone(),
            },
            certificate: CentersCertificate {
                items: if balls == 1 { Items::Balls } else { Items::Points },
                weights: placed && balls == 0,
                group: None,
                placement: if placed { Placement::Rows } else { Placement::Free },
                k,
                outliers: z,
                gap,
                core_set,
                directions: vec![],
                proof: match proof {
                    0 => LowerBound::Separated,
                    _ => LowerBound::Branches { items: items_of_log },
                },
                points_hash: PointsHash(hash),
            },
            trace: Trace::default(),
        }
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_way_through_json_changes_nothing(solution in any_solution()) {
        let text = solution.to_json();
        prop_assert!(text.contains("\"kind\": \"centers\""));
        let again = AnySolution::from_json(&text).unwrap();
        prop_assert_eq!(&again, &AnySolution::Centers(solution));
        prop_assert_eq!(again.to_json(), text);
    }

    /// Any numbers are judged; with the right hash, too.
    #[test]
    fn any_solution_is_judged_without_panic(solution in any_solution(), values in prop::collection::vec(any_finite(), 6)) {
        for columns in [1, 2, 3, 6] {
            let points = Points::new(&values, columns).unwrap();
            let mut solution = solution.clone();
            let _ = solution.check(&points);
            let dim = columns - usize::from(solution.certificate.weights || solution.certificate.items == Items::Balls);
            solution.answer.centers.iter_mut().for_each(|center| center.resize(dim, 1.0));
            solution.answer.assignment.clear();
            solution.answer.outliers.clear();
            solution.answer.rows.clear();
            solution.certificate.placement = Placement::Free;
            solution.certificate.gap = f64::MAX;
            solution.certificate.core_set = (0..points.len() as u64).collect();
            (solution.answer.radius, solution.answer.lower_bound) = (f64::MAX, solution.answer.lower_bound.abs());
            solution.certificate.points_hash = hash_points(&points, &Monitor::silent()).unwrap();
            let _ = solution.check(&points);
        }
    }
}

#[test]
fn a_document_is_judged_as_what_it_is() {
    let task = Task::points(&numbers(16, 5), 2);
    let radii = task.radii();
    let found: Best = best(&radii, 255, 2, 1);
    let lower = found.radius * (1.0 - 1e-12);
    let items = log(&radii, &everything(&task), 2, 1, lower).unwrap();
    let proof = (everything(&task), LowerBound::Branches { items });
    let case = Case::of("document", &task, &found, (2, 1), (1.0, lower), proof);
    let text = case.solution.to_json();
    let again = AnySolution::from_json(&text).unwrap();
    let points = Points::new(&task.values, 2).unwrap();
    match again.check(&points, &Monitor::silent()) {
        Ok(AnyVerdict::Centers(verdict)) => assert_eq!(verdict, case.check().unwrap()),
        other => panic!("{other:?}"),
    }
    for (from, to) in [
        ("\"by\": \"branches\"", "\"by\": \"guess\""),
        ("\"by\": \"branches\"", "\"by\": \"apart\""),
        ("\"placement\": \"free\"", "\"placement\": \"anywhere\""),
        ("\"radius\"", "\"radii\""),
        ("\"k\": 2", "\"k\": -2"),
    ] {
        assert!(text.contains(from), "{text}");
        assert!(AnySolution::from_json(&text.replacen(from, to, 1)).is_err(), "{to}");
    }
}

#[test]
fn fields_that_no_proof_has_are_named() {
    let values = [0.0, 0.0, 4.0, 0.0];
    let points = Points::new(&values, 2).unwrap();
    for (proof, by) in
        [(LowerBound::Separated, "apart"), (LowerBound::Branches { items: vec![0] }, "branches")]
    {
        let found = by_hand(&points, &[&[2.0, 0.0]], (2.0, 2.0), &[0, 1], proof);
        let text = found.to_json();
        let field = format!("\"by\": \"{by}\"");
        assert!(text.contains(&field) && AnySolution::from_json(&text).is_ok(), "{text}");
        let more = text.replacen(&field, &format!("\"more\": 1, {field}"), 1);
        let error = AnySolution::from_json(&more).unwrap_err().to_string();
        assert!(error.contains("unknown field `more`"), "{error}");
    }
}

/// Earlier versions wrote proofs that the checker had to find by itself.
#[test]
fn a_proof_that_is_left_to_the_checker_is_refused_by_name() {
    let values = [0.0, 0.0, 4.0, 0.0];
    let points = Points::new(&values, 2).unwrap();
    let found = by_hand(&points, &[&[2.0, 0.0]], (2.0, 2.0), &[0, 1], LowerBound::Separated);
    let text = found.to_json().replacen("\"by\": \"apart\"", "\"by\": \"search\"", 1);
    let error = AnySolution::from_json(&text).unwrap_err().to_string();
    assert!(error.contains("solve again to get a proof that lists its branches"), "{error}");
}
