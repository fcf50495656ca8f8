//! Documents of ellipsoids: to the last bit, in one form, and never a panic.

use proptest::collection::vec;
use proptest::prelude::*;
use taut_certify::{
    AnySolution, Ellipsoid, EllipsoidCertificate, Hull, Items, JsonError, Solution, Trace,
};
use taut_points::{Monitor, Points, PointsHash};

fn example() -> Solution<Ellipsoid> {
    Solution {
        answer: Ellipsoid {
            center: vec![0.5, 1e9],
            center_tail: vec![0.0, 1e-9],
            matrix: vec![vec![4.0, 0.0], vec![0.0, 0.0]],
            factor: vec![vec![2.0, 0.0]],
            hull: Some(Hull { basis: vec![vec![1.0, 0.0]], distance: 0.0 }),
            log_volume: 0.0,
        },
        certificate: EllipsoidCertificate {
            items: Items::Balls,
            support: vec![0, 1],
            multipliers: vec![0.5, 0.5],
            directions: vec![vec![-1.0, 0.0], vec![1.0, 0.0]],
            left_out: vec![7],
            gap: 1e-12,
            points_hash: PointsHash(0xfeed),
        },
        trace: Trace::default(),
    }
}

#[test]
fn the_document_is_this_one() {
    let text = r#"{
  "schema": 1,
  "kind": "ellipsoid",
  "answer": {
    "center": [
      0.5,
      1000000000.0
    ],
    "center_tail": [
      0.0,
      1e-9
    ],
    "matrix": [
      [4.0, 0.0],
      [0.0, 0.0]
    ],
    "factor": [
      [2.0, 0.0]
    ],
    "hull": {
      "basis": [
        [1.0, 0.0]
      ],
      "distance": 0.0
    },
    "log_volume": 0.0
  },
  "certificate": {
    "items": "balls",
    "support": [
      0,
      1
    ],
    "multipliers": [
      0.5,
      0.5
    ],
    "directions": [
      [-1.0, 0.0],
      [1.0, 0.0]
    ],
    "left_out": [
      7
    ],
    "gap": 1e-12,
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
    assert_eq!(example().to_json(), text);
}

/// What most answers have no use for is not written.
#[test]
fn what_is_empty_is_left_out() {
    let mut plain = example();
    plain.answer.center_tail.clear();
    plain.answer.hull = None;
    plain.certificate.directions.clear();
    plain.certificate.left_out.clear();
    let text = plain.to_json();
    for name in ["center_tail", "hull", "directions", "left_out"] {
        assert!(!text.contains(name), "{name}");
    }
    assert_eq!(AnySolution::from_json(&text).unwrap(), AnySolution::Ellipsoid(plain));
}

#[test]
fn unknown_and_missing_fields_are_refused() {
    let text = example().to_json();
    for name in [
        "center",
        "matrix",
        "factor",
        "log_volume",
        "items",
        "support",
        "multipliers",
        "gap",
        "basis",
        "distance",
    ] {
        let field = format!("\"{name}\"");
        let other = text.replacen(&field, &format!("\"_{name}\""), 1);
        assert!(
            matches!(AnySolution::from_json(&other), Err(JsonError::Shape(_))),
            "{name} renamed"
        );
        let more = text.replacen(&field, &format!("\"note\": 1, {field}"), 1);
        assert!(matches!(AnySolution::from_json(&more), Err(JsonError::Shape(_))), "beside {name}");
    }
    for (good, bad) in [
        ("[4.0, 0.0]", "4.0"),
        ("[4.0, 0.0]", "[null, 0.0]"),
        ("\"balls\"", "\"discs\""),
        ("0.5,", "\"0.5\","),
    ] {
        let other = text.replacen(good, bad, 1);
        assert!(matches!(AnySolution::from_json(&other), Err(JsonError::Shape(_))), "{bad}");
    }
}

fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        any::<u64>().prop_map(f64::from_bits),
        (-2i32..3).prop_map(f64::from),
        Just(f64::MAX),
        Just(f64::MIN_POSITIVE),
    ]
}

fn any_table(rows: usize, columns: usize) -> impl Strategy<Value = Vec<Vec<f64>>> {
    vec(vec(any_number(), columns), rows)
}

/// Any numbers whatever, in lists that mostly have the lengths they should.
fn any_solution() -> impl Strategy<Value = Solution<Ellipsoid>> {
    (1usize..4, 0usize..4).prop_flat_map(|(dim, rank)| {
        let answer = (
            vec(any_number(), dim),
            prop_oneof![Just(vec![]), vec(any_number(), dim)],
            any_table(dim, dim),
            any_table(rank, dim),
            proptest::option::of((any_table(rank, dim), any_number())),
            any_number(),
        );
        let certificate = (
            0usize..3,
            vec(0u64..4, 0..4),
            vec(prop_oneof![Just(0.5), Just(0.25), Just(1.0), any_number()], 0..4),
            any_table(2, dim),
            vec(0u64..4, 0..2),
            any_number(),
        );
        (answer, certificate).prop_map(|(answer, certificate)| {
            let (center, center_tail, matrix, factor, hull, log_volume) = answer;
            let hull = hull.map(|(basis, distance)| Hull { basis, distance });
            let (items, support, multipliers, directions, left_out, gap) = certificate;
            Solution {
                answer: Ellipsoid { center, center_tail, matrix, factor, hull, log_volume },
                certificate: EllipsoidCertificate {
                    items: [Items::Points, Items::Balls, Items::Ellipsoids][items],
                    support,
                    multipliers,
                    directions,
                    left_out,
                    gap,
                    points_hash: PointsHash(0),
                },
                trace: Trace::default(),
            }
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 2000, ..ProptestConfig::default() })]

    #[test]
    fn any_solution_is_judged_without_panic(mut solution in any_solution(), values in vec(any_number(), 36)) {
        let columns = solution.certificate.items.columns(solution.answer.dim());
        let values = &values[..36 / columns * columns];
        let points = Points::new(values, columns).unwrap();
        if let Ok(hash) = taut_points::hash_points(&points, &Monitor::silent()) {
            solution.certificate.points_hash = hash;
        }
        // What a few random numbers say of others can only be true by accident.
        if let Ok(verdict) = solution.check(&points) {
            prop_assert!(verdict.gap <= solution.certificate.gap * (1.0 + 1e-9) + 1e-14);
        }
    }

    #[test]
    fn damaged_documents_never_panic(at in 0usize..900, length in 0usize..12, piece in "[-0-9eE.,:\\[\\]{}\"a-z]{0,4}") {
        let mut text = example().to_json();
        let start = at.min(text.len());
        text.replace_range(start..(start + length).min(text.len()), &piece);
        if let Ok(solution) = AnySolution::from_json(&text) {
            let points = Points::new(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0], 3).unwrap();
            prop_assert!(solution.check(&points, &Monitor::silent()).is_err());
        }
    }
}
