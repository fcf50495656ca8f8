//! Orders of points: those of the solver are confirmed, and no other.

use proptest::collection::vec;
use proptest::prelude::*;
use taut_certify::{
    AnySolution, CheckError, Order, OrderCertificate, OrderCurve, OrderViolation, Solution, Trace,
    Violation,
};
use taut_oblivious::{hilbert_order, morton_order};
use taut_points::{Monitor, Points, hash_points};

fn ordered<const D: usize>(values: &[f64], curve: OrderCurve) -> Solution<Order> {
    let points = Points::new(values, D).unwrap();
    let at = |i: usize| std::array::from_fn::<f64, D, _>(|axis| values[i * D + axis]);
    let rows = match curve {
        OrderCurve::Hilbert => hilbert_order(points.len(), at),
        OrderCurve::Morton => morton_order(points.len(), at),
    };
    let rows = rows.into_iter().map(u64::from).collect();
    let points_hash = hash_points(&points, &Monitor::silent()).unwrap();
    let certificate = OrderCertificate { points_hash };
    Solution { answer: Order { curve, rows }, certificate, trace: Trace::default() }
}

const CURVES: [OrderCurve; 2] = [OrderCurve::Hilbert, OrderCurve::Morton];

fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        -1.0..1.0f64,
        (-3..3i32).prop_map(f64::from),
        (-1020..1023i32).prop_map(|e| 2f64.powi(e)),
        Just(f64::MAX),
        Just(f64::MIN),
        Just(5e-324),
        Just(-0.0),
    ]
}

proptest! {
    #[test]
    fn the_solver_is_confirmed(values in vec(coordinate(), 0..300)) {
        for curve in CURVES {
            let plane = &values[..values.len() / 2 * 2];
            let found = ordered::<2>(plane, curve);
            prop_assert!(found.check(&Points::new(plane, 2).unwrap()).is_ok());
            let space = &values[..values.len() / 3 * 3];
            let found = ordered::<3>(space, curve);
            prop_assert!(found.check(&Points::new(space, 3).unwrap()).is_ok());
        }
    }

    /// Small integers bring ties and equal points: two rows that change places are seen wherever they are.
    #[test]
    fn exchanged_rows_are_seen(flat in vec(-4..4i32, 4..60), i in any::<usize>(), j in any::<usize>()) {
        let values: Vec<f64> = flat[..flat.len() / 2 * 2].iter().copied().map(f64::from).collect();
        let points = Points::new(&values, 2).unwrap();
        for curve in CURVES {
            let mut found = ordered::<2>(&values, curve);
            let (i, j) = (i % points.len(), j % points.len());
            found.answer.rows.swap(i, j);
            prop_assert_eq!(found.check(&points).is_ok(), i == j);
        }
    }
}

#[test]
fn clusters_within_clusters() {
    let values: Vec<f64> = (0..4000)
        .flat_map(|i| {
            let far = 10f64.powi(i % 13);
            [f64::from(i * 7919 % 101) / far, f64::from(i * 104_729 % 97) / far]
        })
        .collect();
    let points = Points::new(&values, 2).unwrap();
    for curve in CURVES {
        let found = ordered::<2>(&values, curve);
        assert!(found.check(&points).unwrap().grids > 10);
    }
    let mut other = ordered::<2>(&values, OrderCurve::Hilbert);
    other.answer.curve = OrderCurve::Morton;
    assert!(matches!(refused(&other, &points), OrderViolation::Descent { .. }));
}

fn refused(found: &Solution<Order>, points: &Points<'_, f64>) -> OrderViolation {
    match found.check(points) {
        Err(CheckError::Rejected(Violation::Order(violation))) => violation,
        other => panic!("{other:?}"),
    }
}

#[test]
fn every_field_counts() {
    let values: Vec<f64> = (0..60).map(|i| f64::from(i * 37 % 61)).collect();
    let points = Points::new(&values, 2).unwrap();
    let found = ordered::<2>(&values, OrderCurve::Hilbert);
    let Ok(AnySolution::Order(found)) = AnySolution::from_json(&found.to_json()) else { panic!() };
    assert_eq!(found.check(&points).unwrap().points, 30);
    let changed = |change: &dyn Fn(&mut Vec<u64>)| {
        let mut other = found.clone();
        change(&mut other.answer.rows);
        refused(&other, &points)
    };
    for change in [
        &(|rows: &mut Vec<u64>| rows[3] = rows[4]) as &dyn Fn(&mut Vec<u64>),
        &|rows| rows[3] = 30,
        &|rows| rows[3] = u64::MAX,
        &|rows| rows.truncate(29),
        &|rows| rows.push(0),
        &Vec::clear,
    ] {
        assert!(matches!(changed(change), OrderViolation::Row { .. }));
    }
    assert!(matches!(changed(&|rows| rows.reverse()), OrderViolation::Descent { place: 1, .. }));
    let mut other = found.clone();
    other.certificate.points_hash.0 ^= 1;
    assert!(matches!(other.check(&points), Err(CheckError::Rejected(Violation::Hash { .. }))));
    let line = Points::new(&values, 1).unwrap();
    assert_eq!(refused(&found, &line), OrderViolation::Dimension { dim: 1 });
}
