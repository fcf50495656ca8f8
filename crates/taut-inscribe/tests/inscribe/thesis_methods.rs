//! The methods of the thesis for triangles and ellipses: their answers are inside and below the bounds that are proved.

use super::common::{Random, Ring, regular, star_shaped, tour};
use super::rings::{rows, square};
use crate::test_length::long_or;
use taut_certify::{InscribedEllipse, InscribedTriangle, Solution, Stop};
use taut_inscribe::{
    EllipseMethod, EllipseOptions, EllipseThesisOptions, Error, TriangleMethod, TriangleOptions,
    TriangleThesisOptions, inscribed_ellipse, inscribed_triangle,
};
use taut_points::Points;

fn triangle(
    rings: &[Ring],
    thesis: TriangleThesisOptions,
) -> Result<Solution<InscribedTriangle>, Error> {
    let method = TriangleMethod::Thesis(thesis);
    let options = TriangleOptions { method, epsilon: 1e-2, ..Default::default() };
    inscribed_triangle(&Points::new(&rows(rings), 3).unwrap(), &options)
}

fn ellipse(rings: &[Ring], method: EllipseMethod) -> Result<Solution<InscribedEllipse>, Error> {
    let options = EllipseOptions { method, epsilon: 1e-2, ..Default::default() };
    inscribed_ellipse(&Points::new(&rows(rings), 3).unwrap(), &options)
}

/// The area, and the upper bound of all areas that the checker proves.
fn proved_triangle(rings: &[Ring], thesis: TriangleThesisOptions) -> [f64; 2] {
    let found = triangle(rings, thesis).unwrap();
    let verdict = found.check(&Points::new(&rows(rings), 3).unwrap()).unwrap();
    assert_eq!((found.trace.method.as_str(), found.trace.stop), ("thesis", Stop::Converged));
    [found.answer.area, verdict.upper]
}

fn proved_ellipse(rings: &[Ring], method: EllipseMethod) -> [f64; 2] {
    let found = ellipse(rings, method).unwrap();
    let verdict = found.check(&Points::new(&rows(rings), 3).unwrap()).unwrap();
    assert_eq!((found.trace.method.as_str(), found.trace.stop), (method.name(), Stop::Converged));
    [found.answer.area, verdict.upper]
}

/// Both methods for ellipses.
fn both(thesis: EllipseThesisOptions) -> [EllipseMethod; 2] {
    [EllipseMethod::Thesis(thesis), EllipseMethod::FivePoint(thesis)]
}

/// The image under a matrix, shifted.
fn mapped(ring: &[[f64; 2]], [[a, b], [c, d]]: [[f64; 2]; 2]) -> Ring {
    ring.iter().map(|p| [a * p[0] + b * p[1] - 3.0, c * p[0] + d * p[1] + 5.0]).collect()
}

const MAPS: [[[f64; 2]; 2]; 3] =
    [[[1.0, 0.0], [0.0, 1.0]], [[3.0, 1.0], [0.5, 0.75]], [[0.25, -2.0], [1.0, 0.5]]];

#[test]
fn sampled_triangles_come_near_closed_forms_and_stay_below_the_bound() {
    for map in MAPS {
        let determinant = map[0][0] * map[1][1] - map[0][1] * map[1][0];
        for (ring, area) in [
            (square(0.0, 0.0, 1.0), 0.5),
            (vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], 0.5),
            (regular(6), 0.75 * 3f64.sqrt()),
        ] {
            let expected = area * determinant.abs();
            let rings = [mapped(&ring, map)];
            let [found, upper] = proved_triangle(&rings, TriangleThesisOptions::DEFAULT);
            assert!(found <= expected * (1.0 + 1e-12) && expected <= upper, "{found}, {expected}");
            // Of 300 points some are near all corners: within √(1/300) of a side or so.
            assert!(found >= 0.75 * expected, "{found} of {expected}");
        }
    }
}

#[test]
fn more_samples_of_the_same_seed_give_no_smaller_triangle() {
    for seed in 1..4 {
        let rings = [tour(seed, 14)];
        let of =
            |sample_count| proved_triangle(&rings, TriangleThesisOptions { sample_count, seed });
        let [few, some, many] = [20, 60, 180].map(of);
        // Shrinking by rounding only.
        assert!(few[0] <= some[0] * (1.0 + 1e-12) && some[0] <= many[0] * (1.0 + 1e-12));
        assert!(many[0] <= many[1] && many[0] > 0.4 * many[1], "{many:?}");
    }
}

#[test]
fn no_sampled_triangle_holds_a_hole() {
    // Small holes, which hardly any side meets: without the test of holes nearly all triangles have one inside.
    let mut random = Random(8);
    for _ in 0..5 {
        let mut rings = vec![square(0.0, 0.0, 1.0)];
        for i in 0..9 {
            let [x, y] = [i % 3, i / 3].map(|k| 0.2 + 0.3 * f64::from(k) + 0.05 * random.unit());
            rings.push(square(x, y, 1e-5));
        }
        let [found, upper] = proved_triangle(&rings, TriangleThesisOptions::DEFAULT);
        assert!(found <= upper && found > 0.5 * upper, "{found} and {upper}");
    }
}

#[test]
fn ellipses_among_samples_come_near_closed_forms_and_stay_below_the_bound() {
    let pi = std::f64::consts::PI;
    for map in MAPS.into_iter().skip(long_or(0, 1)).take(long_or(MAPS.len(), 1)) {
        let determinant = map[0][0] * map[1][1] - map[0][1] * map[1][0];
        let pentagon = (0.2 * pi).cos().powi(2) * pi;
        for (ring, area) in [
            (square(0.0, 0.0, 1.0), 0.25 * pi),
            (vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], 0.5 * pi / 27f64.sqrt()),
            (regular(5), pentagon),
            (regular(80), (pi / 80.0).cos().powi(2) * pi),
        ] {
            let expected = area * determinant.abs();
            let rings = [mapped(&ring, map)];
            for method in both(EllipseThesisOptions { sample_count: 120, ..Default::default() }) {
                let [found, upper] = proved_ellipse(&rings, method);
                assert!(found <= expected * (1.0 + 1e-12) && expected <= upper);
                // The thinnest ellipse here has a least semi-axis of 4 spacings or more: (1 − 1/8)² of the area are left.
                assert!(found >= 0.76 * expected, "{method}: {found} of {expected}");
            }
        }
    }
}

#[test]
fn ellipses_of_the_thesis_stay_below_the_bound_with_holes_and_bays() {
    for seed in 0..long_or(6, 2) {
        let mut rings = vec![mapped(&star_shaped(seed, 18), MAPS[seed as usize % 3])];
        if seed % 2 == 0 {
            rings = vec![square(0.0, 0.0, 4.0), square(1.0 + 0.1 * seed as f64, 1.2, 1.0)];
        }
        let options = EllipseThesisOptions { sample_count: 160, angle: 60.0, ..Default::default() };
        for method in both(options) {
            let [found, upper] = proved_ellipse(&rings, method);
            println!("{seed}: {method} {:.3} of the bound", found / upper);
            assert!(found <= upper && found >= 0.3 * upper, "{seed}: {method}: {found}, {upper}");
        }
    }
}

#[test]
fn what_no_sample_allows_is_refused() {
    let rings = [square(0.0, 0.0, 1.0)];
    // No ellipse is as thick as a thousand spacings.
    for method in
        both(EllipseThesisOptions { fatness: 1e3, sample_count: 24, ..Default::default() })
    {
        let error = ellipse(&rings, method).unwrap_err();
        assert!(matches!(error, Error::NoneAmongSamples { samples: 24, .. }), "{error}");
        assert!(error.to_string().contains(method.name()), "{error}");
    }
    // Three points in a spiral hardly ever see each other.
    let mut spiral: Ring = vec![];
    let arm = |angle: f64, width: f64| {
        let radius = 1.0 + 0.2 * angle / std::f64::consts::TAU + width;
        [radius * angle.cos(), radius * angle.sin()]
    };
    spiral.extend((0..200).map(|i| arm(0.2 * f64::from(i), 0.0)));
    spiral.extend((0..200).rev().map(|i| arm(0.2 * f64::from(i), 1e-3)));
    let thesis = TriangleThesisOptions { sample_count: 5, seed: 2 };
    let error = triangle(&[spiral], thesis).unwrap_err();
    assert!(matches!(error, Error::NoneAmongSamples { method: "thesis", samples: 5 }), "{error}");
}

#[test]
fn options_of_the_thesis_out_of_range_are_refused() {
    let rings = [square(0.0, 0.0, 1.0)];
    for sample_count in [0, 2, 4097] {
        let refused = triangle(&rings, TriangleThesisOptions { sample_count, seed: 1 });
        assert!(refused.unwrap_err().to_string().contains("`sample_count` is"));
    }
    let wrong = EllipseThesisOptions::DEFAULT;
    for (thesis, name) in [
        (EllipseThesisOptions { sample_count: 11, ..wrong }, "sample_count"),
        (EllipseThesisOptions { sample_count: 1001, ..wrong }, "sample_count"),
        (EllipseThesisOptions { fatness: 0.49, ..wrong }, "fatness"),
        (EllipseThesisOptions { fatness: f64::NAN, ..wrong }, "fatness"),
        (EllipseThesisOptions { angle: 90.0, ..wrong }, "angle"),
        (EllipseThesisOptions { angle: 0.0, ..wrong }, "angle"),
    ] {
        for method in both(thesis) {
            let error = ellipse(&rings, method).unwrap_err().to_string();
            assert!(error.contains(&format!("`{name}` is")), "{error}");
        }
    }
}
