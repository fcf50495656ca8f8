//! Methods of the thesis: inside, proved by the same certificate, and never above the bound.

use super::common::{Ring, comb, regular, star_shaped, tour};
use super::ellipses;
use super::rings::{rows, square};
use super::triangles::{proved, verified};
use taut_certify::{InscribedEllipse, InscribedTriangle, Solution, Stop};
use taut_inscribe::{
    EllipseFivePointOptions, EllipseMethod, EllipseOptions, Error, TriangleMethod, TriangleOptions,
    TriangleThesisOptions, inscribed_ellipse, inscribed_triangle,
};
use taut_points::Points;

fn sampled(
    rings: &[Ring],
    thesis: TriangleThesisOptions,
) -> Result<Solution<InscribedTriangle>, Error> {
    let method = TriangleMethod::Thesis(thesis);
    let options = TriangleOptions { method, ..Default::default() };
    inscribed_triangle(&Points::new(&rows(rings), 3).unwrap(), &options)
}

#[test]
fn sampled_triangles_are_inside_and_below_the_largest() {
    // An affine image of a hexagon, whose largest triangle has half of its area.
    let hexagon: Ring = regular(6).iter().map(|p| [3.0 * p[0] + p[1], 0.5 * p[1] - p[0]]).collect();
    let mut shapes = vec![
        vec![hexagon],
        vec![regular(40)],
        vec![comb(3, 2.0)],
        vec![square(0.0, 0.0, 8.0), square(3.0, 3.0, 1.0), square(5.0, 2.0, 2.0)],
    ];
    shapes.extend((1..4).map(|seed| vec![star_shaped(seed, 30)]));
    shapes.extend((1..3).map(|seed| vec![tour(seed, 20)]));
    for rings in shapes {
        let largest = proved(&rings).answer.area;
        let found = sampled(&rings, TriangleThesisOptions::DEFAULT).unwrap();
        let verdict = verified(&found, &rings);
        let area = found.answer.area;
        assert_eq!((&found.trace.method[..], found.trace.stop), ("thesis", Stop::Converged));
        // The largest one is known up to 1e-4, and the bound is within 1e-3 of the best one known.
        assert!(area <= largest * (1.0 + 1.1e-4), "{area} above {largest}: {rings:?}");
        assert!(verdict.upper >= largest && verdict.upper <= largest * (1.0 + 1.3e-3));
        assert!(verdict.lower <= area && area <= verdict.upper);
        println!("{:.3} of the largest triangle, gap {:.3}", area / largest, verdict.gap);
        // The thesis' constant is a quarter, for four points in the largest triangle; 300 points have many more there.
        assert!(area >= 0.5 * largest, "{area} for {largest}: {rings:?}");
    }
}

#[test]
fn a_triangle_between_points_holds_no_hole() {
    // A frame: corners of triangles around the hole see each other.
    let rings = [square(0.0, 0.0, 16.0), vec![[7.0, 7.0], [9.0, 7.0], [8.0, 8.0]]];
    for seed in 1..6 {
        let found = sampled(&rings, TriangleThesisOptions { samples: 60, seed }).unwrap();
        verified(&found, &rings);
    }
}

#[test]
fn samples_and_seed_alone_decide() {
    let rings = [star_shaped(9, 25)];
    let of = |samples, seed| {
        let found = sampled(&rings, TriangleThesisOptions { samples, seed }).unwrap();
        found.to_json()
    };
    assert_eq!(of(80, 1), of(80, 1));
    assert_ne!(of(80, 1), of(80, 2));
    // The first 80 of 160 points are the same, so that the largest triangle is no smaller.
    let area =
        |samples| sampled(&rings, TriangleThesisOptions { samples, seed: 1 }).unwrap().answer.area;
    assert!(area(160) >= area(80) && area(80) >= area(20));
}

#[test]
fn samples_without_a_triangle_are_refused() {
    let message = |samples| {
        let thesis = TriangleThesisOptions { samples, seed: 1 };
        sampled(&[comb(12, 30.0)], thesis).unwrap_err().to_string()
    };
    assert!(message(2).contains("`samples` is 2: expected from 3 to 4096"));
    assert!(message(4097).contains("`samples` is 4097"));
    assert!(message(3).contains("no three of these points see each other"));
}

fn through_five(
    rings: &[Ring],
    five: EllipseFivePointOptions,
) -> Result<Solution<InscribedEllipse>, Error> {
    let method = EllipseMethod::FivePoint(five);
    let options = EllipseOptions { method, ..Default::default() };
    inscribed_ellipse(&Points::new(&rows(rings), 3).unwrap(), &options)
}

/// A smooth closed curve r(φ) = 1 + a·cos(kφ) + b·cos φ, mapped.
fn smooth(k: f64, a: f64, b: f64, [[m, n], [o, p]]: [[f64; 2]; 2]) -> Ring {
    let vertex = |i: usize| {
        let angle = std::f64::consts::TAU * i as f64 / 200.0;
        let radius = 1.0 + a * (k * angle).cos() + b * angle.cos();
        let (x, y) = (radius * angle.cos(), radius * angle.sin());
        [m * x + n * y, o * x + p * y]
    };
    (0..200).map(vertex).collect()
}

#[test]
fn ellipses_through_five_samples_are_inside_and_below_the_largest() {
    let unit = [[1.0, 0.0], [0.0, 1.0]];
    for (ring, share) in [
        // Ellipses with vertices on them: only the distance of samples keeps it from the largest.
        (smooth(2.0, 0.0, 0.0, [[2.0, 0.3], [-0.5, 0.8]]), 0.95),
        (smooth(3.0, 0.15, 0.0, unit), 0.8),
        (smooth(2.0, 0.4, 0.1, unit), 0.8),
        (smooth(5.0, 0.1, 0.3, [[1.5, 0.4], [0.0, 0.7]]), 0.7),
        (smooth(4.0, 0.2, 0.0, [[1.0, 1.0], [-0.2, 0.9]]), 0.7),
    ] {
        let rings = [ring];
        let largest = ellipses::solve(&rings, 1e-4).unwrap().answer.area;
        let found = through_five(&rings, EllipseFivePointOptions::DEFAULT).unwrap();
        let verdict = ellipses::verified(&found, &rings);
        let area = found.answer.area;
        println!("{:.3} of the largest ellipse, gap {:.3}", area / largest, verdict.gap);
        assert_eq!((&found.trace.method[..], found.trace.stop), ("five-point", Stop::Converged));
        assert!(area <= largest * (1.0 + 1.1e-4), "{area} above {largest}");
        assert!(verdict.upper >= largest && verdict.upper <= largest * (1.0 + 1.3e-3));
        assert!(area >= share * largest, "{area} for {largest}");
    }
}

#[test]
fn samples_without_an_ellipse_are_refused() {
    let message = |five| through_five(&[comb(2, 6.0)], five).unwrap_err().to_string();
    let default = EllipseFivePointOptions::DEFAULT;
    let of = |samples| message(EllipseFivePointOptions { samples, ..default });
    assert!(of(5).contains("`samples` is 5: expected from 6 to 400") && of(401).contains("401"));
    assert!(message(EllipseFivePointOptions { fatness: 1e3, ..default }).contains("passes"));
    assert!(message(EllipseFivePointOptions { fatness: -1.0, ..default }).contains("`fatness`"));
    for normal in [1.0, -1.0, f64::NAN] {
        assert!(message(EllipseFivePointOptions { normal, ..default }).contains("`normal`"));
    }
}
