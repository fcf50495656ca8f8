//! Shape matrices that rounding has made indefinite: no direction may name a point far outside of the item.

use common::ellipsoids::{Case, hash, log_unit_ball, transposed_product};
use common::exact;
use num_rational::BigRational;
use num_traits::ToPrimitive;
use taut_certify::{
    Ball, BallCertificate, CheckError, Ellipsoid, EllipsoidCertificate, Items, Solution, Trace,
    Violation,
};
use taut_points::Points;

use crate::common;

/// ss′ for s of length 1.608, each entry rounded: the determinant is -3.9e-17.
const SHAPE: [f64; 3] = [0.9565739104051543, 1.2487000506648323, 1.6300379924327413];

/// Sa, and a′Sa, both rounded once.
fn touch(a: [f64; 2]) -> ([f64; 2], f64) {
    let [s, t, r] = SHAPE.map(exact);
    let [x, y] = a.map(exact);
    let v = [&s * &x + &t * &y, &t * &x + &r * &y];
    let q: BigRational = &v[0] * &x + &v[1] * &y;
    (v.map(|v| v.to_f64().unwrap()), q.to_f64().unwrap())
}

/// A direction across the item in which a′Sa > 0 is what cancellation leaves, so that Sa/√(a′Sa) is twenty times as long as
/// the half axis.
fn treacherous() -> ([f64; 2], [f64; 2]) {
    let a = [1.0, -0.7660557991343674];
    let (v, q) = touch(a);
    let p = v.map(|v| v / q.sqrt());
    assert!(q > 0.0 && p[0].hypot(p[1]) > 30.0);
    (a, p)
}

#[test]
fn no_direction_makes_a_ball_look_necessary() {
    let (a, p) = treacherous();
    let values = [0.0, 0.0, SHAPE[0], SHAPE[1], SHAPE[2]];
    let solution = Solution {
        answer: Ball { center: vec![0.0; 2], center_tail: vec![], radius: p[0].hypot(p[1]) },
        certificate: BallCertificate {
            items: Items::Ellipsoids,
            support: vec![0, 0],
            multipliers: vec![0.5; 2],
            directions: vec![a.to_vec(), a.map(|v| -v).to_vec()],
            gap: 1e-9,
            points_hash: hash(&values, 5),
        },
        trace: Trace::default(),
    };
    match solution.check(&Points::new(&values, 5).unwrap()) {
        Err(CheckError::Rejected(Violation::Gap { proved, .. })) => assert!(proved > 6.0),
        other => panic!("{other:?}"),
    }
}

#[test]
fn no_direction_makes_an_ellipse_look_necessary() {
    let (a, p) = treacherous();
    let length = p[0].hypot(p[1]);
    let along = p.map(|v| v / length);
    let across = [-along[1], along[0]];
    // A segment of half length 1 across the item, and the ellipse with these two as its half axes.
    let segment = [across[0] * across[0], across[0] * across[1], across[1] * across[1]];
    let values = [[0.0; 2].as_slice(), &SHAPE, &[0.0; 2], &segment].concat();
    let stretch = 1.0 + 1e-13;
    let factor =
        vec![along.map(|v| v / (length * stretch)).to_vec(), across.map(|v| v / stretch).to_vec()];
    let solution = Solution {
        answer: Ellipsoid {
            center: vec![0.0; 2],
            center_tail: vec![],
            matrix: transposed_product(&factor, 2),
            factor,
            hull: None,
            log_volume: log_unit_ball(2) + (length * stretch * stretch).ln(),
        },
        certificate: EllipsoidCertificate {
            items: Items::Ellipsoids,
            support: vec![0, 0, 1, 1],
            multipliers: vec![0.25; 4],
            directions: [a, a.map(|v| -v), across, across.map(|v| -v)].map(|a| a.to_vec()).to_vec(),
            left_out: vec![],
            gap: 1e-9,
            points_hash: hash(&values, 5),
        },
        trace: Trace::default(),
    };
    let case = Case { name: "indefinite".into(), values, columns: 5, solution };
    match case.violation() {
        Violation::LogGap { proved, .. } => assert!(proved > 2.0, "{proved}"),
        other => panic!("{other}"),
    }
}

/// The reach of an item is found, or refused, however far from the item the center is said to be.
#[test]
fn a_center_at_the_end_of_the_range_is_refused_in_time() {
    for far in [1e155, 1e200, 1e308] {
        let values = [0.0, 0.0, 1.0, 2.0, 1.0, 0.5];
        let factor = vec![vec![0.4, 0.0], vec![0.1, 0.3]];
        let solution = Solution {
            answer: Ellipsoid {
                center: vec![far, 0.27],
                center_tail: vec![],
                matrix: transposed_product(&factor, 2),
                factor,
                hull: None,
                log_volume: log_unit_ball(2) - 0.12f64.ln(),
            },
            certificate: EllipsoidCertificate {
                items: Items::Balls,
                support: vec![0, 1],
                multipliers: vec![0.5; 2],
                directions: vec![vec![1.0, 0.0]; 2],
                left_out: vec![],
                gap: 1e-9,
                points_hash: hash(&values, 3),
            },
            trace: Trace::default(),
        };
        let case = Case { name: "far".into(), values: values.to_vec(), columns: 3, solution };
        assert!(matches!(case.violation(), Violation::OutsideEllipsoid { row: 0, .. }));
    }
}
