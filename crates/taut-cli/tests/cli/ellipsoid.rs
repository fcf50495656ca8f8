//! Answers about ellipsoids: verified and drawn like all others.

use taut::certify::Hull;
use taut::{Ellipsoid, EllipsoidCertificate, Items, Monitor, Points, Solution, Trace};

use crate::desk::Desk;

const RECTANGLE: [f64; 8] = [-2.0, -1.0, 2.0, -1.0, -2.0, 1.0, 2.0, 1.0];

/// The ellipse through the corners of a rectangle of sides 4 and 2.
fn by_hand() -> Solution<Ellipsoid> {
    let points = Points::new(&RECTANGLE, 2).unwrap();
    Solution {
        answer: Ellipsoid {
            center: vec![0.0, 0.0],
            center_tail: vec![],
            matrix: vec![vec![0.125, 0.0], vec![0.0, 0.5]],
            factor: vec![vec![1.0 / 8f64.sqrt(), 0.0], vec![0.0, 1.0 / 2f64.sqrt()]],
            hull: None,
            log_volume: (4.0 * std::f64::consts::PI).ln(),
        },
        certificate: EllipsoidCertificate {
            items: Items::Points,
            support: vec![0, 1, 2, 3],
            multipliers: vec![0.25; 4],
            directions: vec![],
            left_out: vec![],
            gap: 1e-12,
            points_hash: taut::points::hash_points(&points, &Monitor::silent()).unwrap(),
        },
        trace: Trace { method: "by hand".into(), ..Trace::default() },
    }
}

fn desk(change: impl FnOnce(&mut Solution<Ellipsoid>)) -> Desk {
    let desk = Desk::new();
    desk.put("points.csv", "x,y\n-2,-1\n2,-1\n-2,1\n2,1\n");
    let mut found = by_hand();
    change(&mut found);
    desk.put("ellipsoid.json", found.to_json());
    desk
}

#[test]
fn a_true_ellipsoid_is_proved_with_its_bracket() {
    desk(|_| {}).taut("verify ellipsoid.json points.csv").ends(0).says(&[
        "Verified within a gap of ",
        ": ellipsoid of log-volume 2.53102424",
        "\n  bracket   2.53102424",
        " ≤ least log-volume ≤ 2.53102424",
        "\n  dimension 2",
    ]);
}

#[test]
fn what_is_wrong_is_said_of_the_point_or_of_the_answer() {
    let small = desk(|found| {
        found.answer.factor[0][0] *= 1.0 + 1e-6;
        found.answer.matrix[0][0] = found.answer.factor[0][0].powi(2);
        found.answer.log_volume -= f64::ln_1p(1e-6);
    });
    small
        .taut("verify ellipsoid.json points.csv")
        .ends(1)
        .says(&["Rejected: points.csv: point 0 (row 1) reaches to |F(x − c)| = 1.0000005"]);
    let flat = desk(|found| found.answer.hull = Some(Hull { basis: vec![], distance: 0.0 }));
    flat.taut("verify ellipsoid.json points.csv")
        .ends(1)
        .says(&["Rejected: ellipsoid.json: a hull is given, but"]);
    let loose = desk(|found| found.certificate.multipliers = vec![0.125, 0.375, 0.375, 0.125]);
    loose
        .taut("verify ellipsoid.json points.csv")
        .ends(1)
        .says(&["Rejected: ellipsoid.json: the multipliers prove a gap of 1.438"]);
}

#[test]
fn epsilon_bounds_the_gap_that_is_proved() {
    let loose = desk(|found| {
        found.certificate.multipliers = vec![0.125, 0.375, 0.375, 0.125];
        found.certificate.gap = 0.5;
    });
    loose.taut("verify ellipsoid.json points.csv").ends(0).says(&["Verified within a gap of"]);
    loose
        .taut("verify ellipsoid.json points.csv --epsilon 0.1")
        .ends(1)
        .says(&["Rejected: ellipsoid.json: a gap of 1.438", "larger than --epsilon 1e-1"]);
}

#[test]
fn an_ellipsoid_is_drawn() {
    let desk = desk(|_| {});
    desk.taut("draw ellipsoid.json points.csv -o e.svg").ends(0);
    assert!(desk.text("e.svg").contains("Smallest ellipsoid around 4 points, d = 2"));
    desk.taut("draw ellipsoid.json points.csv -o e.html").ends(0);
    let page = desk.text("e.html");
    assert!(page.contains("Smallest ellipsoid around 4 points in 2 dimensions"));
    assert!(page.contains("log-volume"));
}
