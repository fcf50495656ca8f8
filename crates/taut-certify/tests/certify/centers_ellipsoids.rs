//! Centers of ellipsoids: closed forms to thirteen digits, and what is refused by name.

use taut_certify::{
    Centers, CentersViolation, CheckError, Items, LowerBound, Placement, Solution, Violation,
};
use taut_points::Points;

use crate::common::centers::by_hand as of_points;

/// Around ellipsoids of the plane, or of a line: centers of this radius, and points of them by row and direction that prove the bound.
fn by_hand(
    values: &[f64],
    columns: usize,
    centers: &[&[f64]],
    (radius, lower_bound): (f64, f64),
    points: &[(u64, &[f64])],
    proof: LowerBound,
) -> Solution<Centers> {
    let source = Points::new(values, columns).unwrap();
    let core_set: Vec<u64> = points.iter().map(|point| point.0).collect();
    let mut found = of_points(&source, centers, (radius, lower_bound), &core_set, proof);
    found.certificate.items = Items::Ellipsoids;
    found.certificate.directions = points.iter().map(|point| point.1.to_vec()).collect();
    found
}

/// Half axes 3 and 1 at the origin, 1 and 2 at (10, 0), and a point at (10, 40).
const THREE: [f64; 15] =
    [0.0, 0.0, 9.0, 0.0, 1.0, 10.0, 0.0, 1.0, 0.0, 4.0, 10.0, 40.0, 0.0, 0.0, 0.0];

fn violation(found: &Solution<Centers>, values: &[f64], columns: usize) -> Violation {
    match found.check(&Points::new(values, columns).unwrap()) {
        Err(CheckError::Rejected(violation)) => violation,
        other => panic!("{other:?}"),
    }
}

/// −3 to 11 along the first axis; the point has a ball of its own.
fn two_balls(radius: f64, lower: f64) -> Solution<Centers> {
    let points: [(u64, &[f64]); 3] = [(0, &[-1.0, 0.0]), (1, &[1e300, 0.0]), (2, &[0.0, 0.0])];
    let centers: [&[f64]; 2] = [&[4.0, 0.0], &[10.0, 40.0]];
    by_hand(&THREE, 5, &centers, (radius, lower), &points, LowerBound::Separated)
}

#[test]
fn closed_forms_are_met_to_thirteen_digits() {
    let points = Points::new(&THREE, 5).unwrap();
    let up = 7.0 * (1.0 + 1e-15);
    let verdict = two_balls(up, 7.0 * (1.0 - 1e-13)).check(&points).unwrap();
    assert!(verdict.gap < 2e-13 && verdict.branches == 0, "{verdict:?}");
    // Neither a smaller radius nor a larger bound.
    let refused = violation(&two_balls(7.0 * (1.0 - 1e-13), 6.0), &THREE, 5);
    assert!(matches!(refused, Violation::Centers(CentersViolation::Outside { center: 0, .. })));
    let refused = violation(&two_balls(7.1, 7.0 * (1.0 + 1e-13)), &THREE, 5);
    assert!(matches!(refused, Violation::Centers(CentersViolation::NotApart { .. })));
    // The same by branches, two points of each ellipse and no matter which comes first.
    let points: [(u64, &[f64]); 5] =
        [(1, &[0.0, 1.0]), (0, &[-1.0, 0.0]), (2, &[5.0, 5.0]), (1, &[1.0, 0.0]), (0, &[1.0, 0.0])];
    let centers: [&[f64]; 2] = [&[4.0, 0.0], &[10.0, 40.0]];
    // The first ellipse, then the second: with it, or apart, where the point goes to neither.
    let items = vec![1, 0, 3, 2];
    let proof = LowerBound::Branches { items };
    let lower = 7.0 * (1.0 - 1e-13);
    let found = by_hand(&THREE, 5, &centers, (up, lower), &points, proof);
    let verdict = found.check(&Points::new(&THREE, 5).unwrap()).unwrap();
    assert_eq!(verdict.branches, 4);
}

#[test]
fn assignments_are_those_from_which_ellipsoids_reach_least_far() {
    // The middle of the first is nearer to the first center; its far end is nearer to the second.
    let values = [0.0, 0.0, 16.0, 0.0, 0.0, 9.0, 0.0, 0.0, 0.0, 0.0];
    let points = Points::new(&values, 5).unwrap();
    let centers: [&[f64]; 2] = [&[1.0, 0.0], &[0.0, 1.5]];
    let with = |assignment: Vec<u32>| {
        let mut found = by_hand(&values, 5, &centers, (10.0, 0.0), &[], LowerBound::Separated);
        found.answer.assignment = assignment;
        found
    };
    with(vec![1, 0]).check(&points).unwrap();
    let refused = violation(&with(vec![0, 0]), &values, 5);
    let expected = CentersViolation::Assignment { row: 0, center: 0, nearer: 1 };
    assert_eq!(refused, Violation::Centers(expected));
    let refused = violation(&with(vec![2, 0]), &values, 5);
    assert_eq!(refused, CentersViolation::NoSuchCenter { row: 0, center: 2 }.into());
}

#[test]
fn what_ellipsoids_cannot_have_is_refused_by_name() {
    let refused = |change: &dyn Fn(&mut Solution<Centers>)| {
        let mut found = two_balls(7.5, 6.5);
        change(&mut found);
        violation(&found, &THREE, 5)
    };
    let is_named = |violation: Violation| {
        matches!(violation, Violation::Centers(CentersViolation::Ellipsoids { .. }))
    };
    assert!(is_named(refused(&|found| found.certificate.weights = true)));
    assert!(is_named(refused(&|found| found.certificate.group = Some(1))));
    assert!(is_named(refused(&|found| found.certificate.placement = Placement::Rows)));
    let is_length = |violation: Violation| matches!(violation, Violation::Length { .. });
    assert!(is_length(refused(&|found| drop(found.certificate.directions.pop()))));
    assert!(is_length(refused(&|found| found.certificate.directions[0].push(0.0))));
    let no_number = refused(&|found| found.certificate.directions[2][1] = f64::NAN);
    assert!(matches!(no_number, Violation::Number { .. }));
    let row = refused(&|found| found.certificate.core_set[1] = 3);
    assert!(matches!(row, Violation::Centers(CentersViolation::CoreSet { position: 1, .. })));
    // Points have no directions.
    let of_points = refused(&|found| {
        found.certificate.items = Items::Points;
        found.answer.centers = vec![vec![0.0; 5]];
    });
    assert!(is_length(of_points));
    // No dimension has rows of three numbers.
    let values = [0.0, 1.0, 2.0];
    let found = by_hand(&values, 3, &[&[0.0]], (1.0, 0.0), &[], LowerBound::Separated);
    assert_eq!(violation(&found, &values, 3), Violation::NoShape { columns: 3 });
    let values = [0.0, 0.0, 1.0, 2.0, 1.0];
    let found = by_hand(&values, 5, &[&[0.0, 0.0]], (9.0, 0.0), &[], LowerBound::Separated);
    assert_eq!(violation(&found, &values, 5), Violation::NegativeShape { row: 0 });
    // Differences of these are no numbers.
    let values = [-1.7e308, 1.0, 1.7e308, 1.0];
    let centers: [&[f64]; 2] = [&[-1.7e308], &[1.7e308]];
    let points: [(u64, &[f64]); 2] = [(0, &[1.0]), (1, &[1.0])];
    let found = by_hand(&values, 2, &centers, (1.5, 0.5), &points, LowerBound::Separated);
    assert_eq!(violation(&found, &values, 2), CentersViolation::TooFar { row: 1 }.into());
}

/// Any directions name points of their ellipsoids: nothing proves more than is so, and nothing ends in a panic.
#[test]
fn directions_of_any_size_prove_no_more_than_is_so() {
    let points = Points::new(&THREE, 5).unwrap();
    let sizes = [0.0, -0.0, 5e-324, 1e-310, 1e-160, 1.0, 1e160, f64::MAX];
    for x in sizes {
        for y in sizes {
            for lower in [7.0 * (1.0 + 1e-12), 7.5, 1e9] {
                let mut found = two_balls(lower * 1.1, lower);
                for direction in &mut found.certificate.directions {
                    *direction = vec![-x, y];
                }
                assert!(found.check(&points).is_err(), "{x:e}, {y:e}, {lower}");
            }
        }
    }
}
