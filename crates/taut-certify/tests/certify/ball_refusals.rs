//! Input and answers that are refused for what they are, and in which order.

use std::sync::atomic::AtomicBool;

use common::{Case, certify};
use taut_certify::{Answer, CheckError, Items, Violation};
use taut_points::{Monitor, Points, ReadError};

use crate::common;

fn square() -> Case {
    let values = [0.0, 0.0, 1.0, 1.0, 1.0, 0.0, 0.0, 1.0];
    certify("square", &values, 2, Items::Points, &[0, 1], &[0.5, 0.5], true)
}

#[test]
fn bad_rows_are_named_before_the_hash_and_before_rows_outside() {
    let mut case = square();
    case.values[2] = 7.0;
    assert!(matches!(case.violation(), Violation::Hash { .. }));
    case.values[5] = f64::NEG_INFINITY;
    let infinite = Violation::NonFinite { row: 2, column: 1, value: f64::NEG_INFINITY };
    assert_eq!(case.violation(), infinite);
    case.values[7] = f64::NAN;
    assert_eq!(case.violation(), infinite);
}

#[test]
fn negative_radii_are_named() {
    let balls = [0.0, 0.0, 1.0, 3.0, 4.0, 2.0, 1.0, 1.0, 0.25];
    let mut case = certify("balls", &balls, 3, Items::Balls, &[0, 1], &[0.4, 0.6], false);
    case.values[8] = -0.25;
    assert_eq!(case.violation(), Violation::NegativeRadius { row: 2, value: -0.25 });
    case.values[8] = f64::NAN;
    assert!(matches!(case.violation(), Violation::NonFinite { row: 2, column: 2, .. }));
    // A negative zero is a zero.
    let balls = [0.0, 0.0, -0.0, 3.0, 4.0, 0.0];
    certify("balls", &balls, 3, Items::Balls, &[0, 1], &[0.5, 0.5], false).check().unwrap();
}

#[test]
fn balls_need_a_column_for_the_center() {
    let mut case = square();
    case.solution.certificate.items = Items::Balls;
    case.solution.answer.center.clear();
    case.solution.answer.center_tail.clear();
    case.columns = 1;
    assert_eq!(case.violation(), Violation::NoRadius { columns: 1 });
}

#[test]
fn a_tail_is_what_rounding_left_over() {
    let mut case = square();
    assert_eq!(case.solution.answer.center_tail, [0.0, 0.0]);
    case.check().unwrap();
    // The same center, split in another way.
    case.solution.answer.center[0] = 0.25;
    case.solution.answer.center_tail[0] = 0.25;
    assert!(
        matches!(case.violation(), Violation::Number { what, .. } if what.contains("0 of the tail"))
    );
}

#[test]
fn no_rows_have_no_ball() {
    let mut case = square();
    case.values.clear();
    assert!(matches!(case.violation(), Violation::Support { position: 0, point: 0, .. }));
    case.solution.certificate.support.clear();
    assert_eq!(case.violation(), Violation::EmptySupport);
}

#[test]
fn a_check_can_be_stopped() {
    let case = square();
    let stop = AtomicBool::new(true);
    let monitor = Monitor { cancel: Some(&stop), ..Monitor::silent() };
    let points = Points::new(&case.values, 2).unwrap();
    let said = case.solution.answer.check(&case.solution.certificate, &points, &monitor);
    assert!(matches!(said, Err(CheckError::Read(ReadError::Cancelled(_)))));
}

#[test]
fn a_hundred_thousand_dimensions() {
    let d = 100_000;
    let mut case = square();
    case.values =
        (0..2 * d).map(|i| if i < d { (i % 7) as f64 } else { -((i % d % 7) as f64) }).collect();
    case.columns = d;
    let points = Points::new(&case.values, d).unwrap();
    case.solution.certificate.points_hash =
        taut_points::hash_points(&points, &Monitor::silent()).unwrap();
    // The squares are integers, and so is their sum, which is no square: the root lies between two f64.
    let square: f64 = case.values[..d].iter().map(|v| v * v).sum();
    let root = square.sqrt();
    let above = if root.mul_add(root, -square) > 0.0 { root } else { root.next_up() };
    let ball = &mut case.solution.answer;
    (ball.center, ball.center_tail, ball.radius) = (vec![0.0; d], vec![], above);
    let verdict = case.check().unwrap();
    assert!(verdict.gap > 0.0 && verdict.gap <= 3e-16, "{:e}", verdict.gap);
    case.solution.answer.radius = above.next_down();
    assert!(matches!(case.violation(), Violation::Outside { row: 0, .. }));
}
