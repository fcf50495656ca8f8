//! Polygons at the ends of the range of numbers, and as thin as their last digits: each is answered with what a checker proves, or refused
//! with the reason.

use super::common::Ring;
use taut_certify::{Answer, Solution};
use taut_inscribe::{
    EllipseOptions, Error, OrientedRectangleOptions, RectangleOptions, TriangleOptions,
    inscribed_ellipse, inscribed_oriented_rectangle, inscribed_rectangle, inscribed_triangle,
};
use taut_points::Points;

/// Cells of a search, at most.
const CELLS_MAX: u64 = 60;

/// Returns the error of a search, if any; an answer has to pass the checker.
fn refusal<A: Answer>(
    ring: &[[f64; 2]],
    solve: impl Fn(&Points<'_, f64>) -> Result<Solution<A>, Error>,
) -> Option<Error> {
    let points = Points::new(ring.as_flattened(), 2).unwrap();
    match solve(&points) {
        Ok(found) => {
            let verdict = found.check(&points);
            assert!(
                verdict.is_ok(),
                "{:?}: {ring:?}",
                verdict.err().map(|error| error.to_string())
            );
            None
        }
        Err(error) => Some(error),
    }
}

fn triangle_refusal(ring: &[[f64; 2]], epsilon: f64) -> Option<Error> {
    let options = TriangleOptions { epsilon, max_cells: CELLS_MAX, ..Default::default() };
    refusal(ring, |points| inscribed_triangle(points, &options))
}

fn ellipse_refusal(ring: &[[f64; 2]], epsilon: f64) -> Option<Error> {
    let options = EllipseOptions { epsilon, max_cells: CELLS_MAX, ..Default::default() };
    refusal(ring, |points| inscribed_ellipse(points, &options))
}

fn rectangle_refusal(ring: &[[f64; 2]]) -> Option<Error> {
    let options = RectangleOptions { epsilon: 0.1, max_cells: CELLS_MAX, ..Default::default() };
    refusal(ring, |points| inscribed_rectangle(points, &options))
}

fn oriented_rectangle_refusal(ring: &[[f64; 2]]) -> Option<Error> {
    let options =
        OrientedRectangleOptions { epsilon: 1e-9, max_cells: CELLS_MAX, ..Default::default() };
    refusal(ring, |points| inscribed_oriented_rectangle(points, &options))
}

/// The area is a number, but with the gap that is left the bound is none.
#[test]
fn bounds_that_overflow_are_refused() {
    let triangle = [
        [1.1517219314030588e164, 1.1517219314030583e164],
        [7.672009237256583e148, 0.0],
        [5.758609657015293e163, 5.758609657015295e163],
    ];
    assert!(matches!(triangle_refusal(&triangle, 1e-9), Some(Error::Area)));
    let ellipse =
        [[0.0, 7.137681160693359e285], [0.0, 0.0], [17179869184.0, 1.6742321998979804e299]];
    assert!(matches!(ellipse_refusal(&ellipse, 0.1), Some(Error::Area)));
    let rectangle =
        [[0.0, 0.0], [2.6815615859885194e154, 0.0], [5.363123171977039e154, 1.248699420126397e145]];
    assert!(matches!(oriented_rectangle_refusal(&rectangle), Some(Error::Area)));
}

/// An area of the least normal number is a subnormal one with a checker's roundings.
#[test]
fn rectangles_with_the_least_area_are_refused() {
    let side = 2f64.powi(-510);
    let ring = [[0.0, 0.0], [side, 0.0], [0.0, side]];
    assert!(matches!(rectangle_refusal(&ring), Some(Error::Area)));
}

/// Along the first axis numbers are subnormal, while the area is far from the ends of the range.
#[test]
fn areas_have_all_digits_where_a_side_has_few() {
    let ring = [
        [4.450147717014424e-308, 5.231975621026698e297],
        [4.450147717014403e-308, 5.231975621026711e297],
        [4.450147717014404e-308, 5.231975621026705e297],
    ];
    assert!(triangle_refusal(&ring, 0.1).is_none());
}

/// Half axes are rounded to multiples of the least number.
#[test]
fn ellipses_with_half_axes_of_few_digits_are_refused() {
    for ring in [
        [[0.0, 1.5e-323], [0.0, 5e-324], [7.814079413531079e238, 1e-323]],
        [[0.0, 5e-324], [5.56047450272705e191, 0.0], [2.2812203088110977e191, 2e-323]],
    ] {
        for epsilon in [0.1, 1e-9] {
            assert!(matches!(ellipse_refusal(&ring, epsilon), Some(Error::Area)), "{ring:?}");
        }
    }
}

/// Along the first axis there are a few numbers from one end of the polygon to the other, so that corners and centers are moved far.
#[test]
fn polygons_of_a_few_last_digits_are_answered_or_too_thin() {
    let ring = [[1.000000000000001, 0.0], [1.0000000000000004, 1.0], [1.0, 2.0]];
    let is_expected = |error: Option<Error>| matches!(error, None | Some(Error::TooThin));
    assert!(is_expected(triangle_refusal(&ring, 0.1)));
    let ring = [[1.0, 0.0], [1.000000000000003, 2.0], [1.0000000000000044, 3.0]];
    assert!(is_expected(ellipse_refusal(&ring, 1e-9)));
}

/// The area of the images of the corners in double precision is 0.
#[test]
fn triangles_as_thin_as_the_last_digits_touch_edges() {
    let ring: Ring =
        vec![[9.0, 3.0], [4.440892098500626e-16, 1.1102230246251565e-15], [6.0, 2.000000000000001]];
    assert!(triangle_refusal(&ring, 0.1).is_none());
}

/// The search cannot tell that a box of a corner is outside, but the checker can, whose errors are smaller.
#[test]
fn boxes_that_only_the_checker_knows_to_be_outside_hold_no_corner() {
    let ring = [
        [16384.0, 2.43632850285e288],
        [8192.0, 3.923981715770022e297],
        [16384.0, 1.1975041857208319e293],
    ];
    assert!(triangle_refusal(&ring, 1e-9).is_none());
}
