//! Documents survive the way through JSON to the last bit, and nothing that is read makes the reader panic.

use proptest::collection::vec;
use proptest::prelude::*;
use taut_certify::{
    AnySolution, Ball, BallCertificate, Items, JsonError, PassBounds, Solution, Stop, Trace,
};
use taut_points::PointsHash;

/// Every finite f64 alike: subnormal, huge, −0.
fn any_finite() -> impl Strategy<Value = f64> {
    any::<u64>().prop_map(f64::from_bits).prop_filter("finite", |v| v.is_finite())
}

fn any_solution() -> impl Strategy<Value = Solution<Ball>> {
    let numbers = || vec(any_finite(), 0..6);
    let trace =
        (any::<u64>(), vec((any_finite(), any_finite(), any::<u64>()), 0..4), ".*", any::<bool>());
    (
        numbers(),
        numbers(),
        any_finite(),
        numbers(),
        vec(any::<u64>(), 0..6),
        any_finite(),
        any::<u64>(),
        trace,
    )
        .prop_map(|(center, center_tail, radius, multipliers, support, gap, hash, trace)| {
            let (count, history, name, balls) = trace;
            Solution {
                answer: Ball { center, center_tail, radius },
                certificate: BallCertificate {
                    items: if balls { Items::Balls } else { Items::Points },
                    support,
                    multipliers,
                    directions: vec![],
                    gap,
                    points_hash: PointsHash(hash),
                },
                trace: Trace {
                    method: name.clone(),
                    stop: if balls { Stop::Rounding } else { Stop::PassBudget },
                    passes: count,
                    iterations: count / 2,
                    core_set: count / 3,
                    history: history
                        .into_iter()
                        .map(|(lower, upper, working_set)| PassBounds { lower, upper, working_set })
                        .collect(),
                    counters: [(name, count)].into(),
                },
            }
        })
}

fn bits(solution: &Solution<Ball>) -> Vec<u64> {
    let Ball { center, center_tail, radius } = &solution.answer;
    let certificate = &solution.certificate;
    let history = solution.trace.history.iter().flat_map(|bounds| [bounds.lower, bounds.upper]);
    let all = center.iter().chain(center_tail).chain(&certificate.multipliers).copied();
    all.chain([*radius, certificate.gap]).chain(history).map(f64::to_bits).collect()
}

fn example() -> String {
    Solution {
        answer: Ball { center: vec![0.1, -2.5e-310], center_tail: vec![1e-18, 0.0], radius: 1e300 },
        certificate: BallCertificate {
            items: Items::Balls,
            support: vec![3, 8],
            multipliers: vec![0.25, 0.75],
            directions: vec![],
            gap: 1e-16,
            points_hash: PointsHash(0xfeed),
        },
        trace: Trace::default(),
    }
    .to_json()
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_way_through_json_changes_no_bit(solution in any_solution()) {
        let AnySolution::Ball(again) = AnySolution::from_json(&solution.to_json()).unwrap() else {
            panic!("a ball is read back as one")
        };
        prop_assert_eq!(bits(&again), bits(&solution));
        prop_assert_eq!(&again, &solution);
        prop_assert_eq!(again.to_json(), solution.to_json());
    }

    #[test]
    fn garbage_is_refused(text in ".*") {
        prop_assert!(AnySolution::from_json(&text).is_err());
    }

    /// A document with a piece cut out or put in is refused, or read as what it then says; it never panics, and nor
    /// does the checker.
    #[test]
    fn damaged_documents_never_panic(at in 0usize..400, length in 0usize..12, piece in "[-0-9eE.,:\\[\\]{}\"a-z]{0,4}") {
        let mut text = example();
        let start = at.min(text.len());
        text.replace_range(start..(start + length).min(text.len()), &piece);
        if let Ok(solution) = AnySolution::from_json(&text) {
            let points = taut_points::Points::new(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0], 3).unwrap();
            let verdict = solution.check(&points, &taut_points::Monitor::silent());
            prop_assert!(verdict.is_err());
        }
    }

    /// The checker takes any numbers whatever.
    #[test]
    fn any_solution_is_judged_without_panic(solution in any_solution(), values in vec(any::<u64>(), 6)) {
        let values: Vec<f64> = values.into_iter().map(f64::from_bits).collect();
        for columns in [1, 2, 3, 6] {
            prop_assert!(solution.check(&taut_points::Points::new(&values, columns).unwrap()).is_err());
        }
    }
}

#[test]
fn other_schemas_and_kinds_are_refused_by_name() {
    let text = example();
    let newer = text.replacen("\"schema\": 1", "\"schema\": 2", 1);
    assert!(matches!(AnySolution::from_json(&newer), Err(JsonError::Schema { found: 2 })));
    let other = text.replacen("\"kind\": \"ball\"", "\"kind\": \"torus\"", 1);
    match AnySolution::from_json(&other) {
        Err(JsonError::Kind { found }) => assert_eq!(found, "torus"),
        wrong => panic!("{wrong:?}"),
    }
    // A newer schema is named even where the rest is not what this reader knows.
    let foreign = r#"{ "schema": 7, "kind": "ball", "answer": [] }"#;
    assert!(matches!(AnySolution::from_json(foreign), Err(JsonError::Schema { found: 7 })));
}

#[test]
fn a_document_has_one_form() {
    let text = example();
    assert!(AnySolution::from_json(&format!("\u{feff}{text}")).is_ok());
    for (known, unknown) in [
        ("\"kind\"", "\"note\": 1, \"kind\""),
        ("\"radius\"", "\"r\": 1, \"radius\""),
        ("\"items\"", "\"note\": 1, \"items\""),
        ("\"passes\"", "\"note\": 1, \"passes\""),
    ] {
        let more = text.replacen(known, unknown, 1);
        assert!(matches!(AnySolution::from_json(&more), Err(JsonError::Shape(_))), "{more}");
    }
    for hash in ["feed", "000000000000FEED", "+00000000000feed", "0000000000000feed"] {
        let other = text.replacen("000000000000feed", hash, 1);
        assert!(matches!(AnySolution::from_json(&other), Err(JsonError::Shape(_))), "{hash}");
    }
    for (other, line, column) in
        [("", 1, 1), ("0,0\n", 1, 1), ("[1]", 1, 1), ("{\n\"schema\": 1", 2, 11)]
    {
        match AnySolution::from_json(other) {
            Err(JsonError::Syntax { line: l, column: c }) => {
                assert_eq!((l, c), (line, column), "{other}")
            }
            wrong => panic!("{other}: {wrong:?}"),
        }
    }
}

#[test]
fn the_document_is_this_one() {
    let text = r#"{
  "schema": 1,
  "kind": "ball",
  "answer": {
    "center": [
      0.1,
      -2.5e-310
    ],
    "center_tail": [
      1e-18,
      0.0
    ],
    "radius": 1e300
  },
  "certificate": {
    "items": "balls",
    "support": [
      3,
      8
    ],
    "multipliers": [
      0.25,
      0.75
    ],
    "gap": 1e-16,
    "points_hash": "000000000000feed"
  },
  "trace": {
    "method": "",
    "stop": "converged",
    "passes": 0,
    "iterations": 0,
    "core_set": 0,
    "history": []
  }
}"#;
    assert_eq!(example().replace("1e+300", "1e300"), text);
}
