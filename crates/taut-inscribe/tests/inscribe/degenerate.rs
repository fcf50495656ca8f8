//! Inputs at the edge of what is a polygon, and beyond.

use super::common::{Ring, proved, regular, solve, solve_with, verify};
use taut_certify::Stop;
use taut_inscribe::{CircleOptions, Error, inscribed_circle};
use taut_points::{InputError, Points};

use crate::test_length::long_or;

fn refusal(ring: &[[f64; 2]]) -> String {
    solve(ring).unwrap_err().to_string()
}

#[test]
fn too_few_vertices_are_refused() {
    for (ring, distinct) in [
        (vec![], 0),
        (vec![[1.0, 2.0]], 1),
        (vec![[1.0, 2.0]; 5], 1),
        (vec![[0.0, 0.0], [1.0, 0.0]], 2),
        (vec![[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 0.0]], 2),
    ] {
        let error = solve(&ring).unwrap_err();
        let found = matches!(error, Error::TooFewVertices { ring: 0, distinct: found } if found == distinct);
        assert!(found, "{ring:?}: {error}");
    }
}

#[test]
fn rings_that_meet_themselves_are_refused_by_row() {
    let bow = [[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]];
    assert_eq!(
        refusal(&bow),
        "the edge from point 0 to point 1 meets the edge from point 2 to point 3: rings may neither cross nor touch themselves or each other"
    );
    // Repeated rows: an edge is named by the rows between which it leads.
    let doubled: Ring = bow.iter().flat_map(|&p| [p, p]).collect();
    assert!(refusal(&doubled).contains("from point 1 to point 2 meets the edge from point 5 to"));
    // No area: three points on a line.
    assert!(refusal(&[[0.0, 0.0], [1.0, 1.0], [3.0, 3.0]]).contains("meets the edge"));
    // A vertex on an edge, and a vertex that comes twice.
    let touching = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 0.0], [0.0, 4.0]];
    assert!(refusal(&touching).contains("from point 0 to point 1 meets"));
    let pinched = [[0.0, 0.0], [2.0, 2.0], [4.0, 0.0], [4.0, 4.0], [2.0, 2.0], [0.0, 4.0]];
    assert!(refusal(&pinched).contains("meets the edge"));
    // The crossing of one pair among many edges.
    let mut ring = regular(50_000);
    ring.swap(777, 778);
    assert!(refusal(&ring).contains("point 77"), "{}", refusal(&ring));
}

#[test]
fn bad_points_and_options_are_refused() {
    let points = [0.0, 0.0, 1.0, 0.0, f64::NAN, 1.0];
    let error = inscribed_circle(&Points::new(&points, 2).unwrap(), &CircleOptions::default());
    let row = matches!(error, Err(Error::Input(InputError::NonFinite { row: 2, column: 0, .. })));
    assert!(row, "{error:?}");
    for dim in [1, 6] {
        let error =
            inscribed_circle(&Points::new(&points, dim).unwrap(), &CircleOptions::default());
        let is_named = matches!(error, Err(Error::Input(InputError::Dimension { dim: found, .. })) if found == dim);
        assert!(is_named, "{error:?}");
    }
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    for epsilon in [0.0, 1.0, -1e-9, f64::NAN, f64::INFINITY] {
        let options = CircleOptions { epsilon, ..Default::default() };
        let error = solve_with(&square, &options).unwrap_err().to_string();
        assert!(error.contains("option `epsilon` is"), "{error}");
    }
    let options = CircleOptions { max_cells: 0, ..Default::default() };
    assert!(solve_with(&square, &options).unwrap_err().to_string().contains("`max_cells` is 0"));
}

#[test]
fn single_precision_points_have_the_circle_of_their_copies() {
    let ring: Vec<f32> = regular(9).iter().flatten().map(|&x| x as f32).collect();
    let copies: Vec<f64> = ring.iter().map(|&x| f64::from(x)).collect();
    let options = CircleOptions::default();
    let one = inscribed_circle(&Points::new(&ring, 2).unwrap(), &options).unwrap();
    let other = inscribed_circle(&Points::new(&copies, 2).unwrap(), &options).unwrap();
    assert_eq!(one, other);
}

/// Fails unless a ring is refused as thinner than a checker can see.
fn assert_too_thin(ring: &[[f64; 2]]) {
    let refused = solve(ring);
    assert!(matches!(refused, Err(Error::TooThin)), "{refused:?}");
}

#[test]
fn needles_are_solved_to_the_gap() {
    for &height in long_or(&[1e-3, 1e-6, 1e-9, 1e-12, 1e-15][..], &[1e-15]) {
        let (found, _) = proved(&[[0.0, 0.0], [1.0, 0.0], [0.5, height]]);
        // Area over half the perimeter.
        let expected = height / (1.0 + 2.0 * 0.5f64.hypot(height));
        assert!((found.answer.radius / expected - 1.0).abs() <= 1.1e-9, "{height:e}");
    }
    // Below 2⁻⁹³ of the length the checker cannot tell the height from 0.
    let needle = [[0.0, 0.0], [1.0, 0.0], [0.5, 1e-30]];
    assert_too_thin(&needle);
}

#[test]
fn far_from_the_origin_rounding_ends_the_search() {
    // At 2^40 coordinates are multiples of 2⁻¹², and the center of this triangle is none.
    let far = 2f64.powi(40);
    let ring = [[far, far], [far + 1.0, far], [far + 0.25, far + 0.75]];
    let found = solve(&ring).unwrap();
    let verdict = verify(&found, &ring);
    assert_eq!(found.trace.stop, Stop::Rounding);
    assert!(verdict.gap > 1e-9 && verdict.gap < 2e-3, "{verdict:?}");
    let near = [[0.0, 0.0], [1.0, 0.0], [0.25, 0.75]];
    let radius = proved(&near).0.answer.radius;
    assert!(found.answer.radius <= radius && radius <= verdict.upper, "{radius}, {verdict:?}");
}

#[test]
fn a_polygon_without_a_point_inside_is_refused() {
    let (one, next) = (1.0, 1.0 + f64::EPSILON);
    let ring = [[one, one], [next, one], [one, next]];
    assert!(matches!(solve(&ring).unwrap_err(), Error::TooThin), "{}", refusal(&ring));
}

/// Strips as thin as the last digits of coordinates, or thinner than a checker can see, end with a reason or a gap, and soon.
#[test]
fn strips_thinner_than_the_digits_of_coordinates_end() {
    let strip = [[0.0, 0.0], [1.0, 0.0], [1.0, 1e-300], [0.0, 1e-300]];
    assert_too_thin(&strip);
    // A corner of two such strips is wide in every direction: only a search can tell that there is no circle.
    let corner = [[0.0, 0.0], [1.0, 0.0], [1.0, 1e-40], [1e-40, 1e-40], [1e-40, 1.0], [0.0, 1.0]];
    let options = CircleOptions { max_cells: long_or(1_000_000, 1000), ..Default::default() };
    let refused = solve_with(&corner, &options);
    assert!(matches!(refused, Err(Error::TooThin)), "{refused:?}");
    let (next, width) = (1.0 + f64::EPSILON, 2e-16);
    let slanted = [[0.0, 0.0], [1.0, 1.0], [1.0, next], [0.0, width]];
    let options = CircleOptions { max_cells: long_or(210_000, 1000), ..Default::default() };
    let found = solve_with(&slanted, &options).unwrap();
    let verdict = verify(&found, &slanted);
    assert_eq!(found.trace.stop, Stop::NodeBudget);
    assert!(
        verdict.upper >= found.answer.radius && found.answer.radius > 0.1 * width,
        "{verdict:?}"
    );
    assert!(found.trace.iterations < 1_000_000, "{} cells", found.trace.iterations);
}

#[test]
fn edges_far_from_a_thin_circle_are_not_called_touched() {
    // Of coordinates of about 10³⁶ plain distances have no digit left beside the radius.
    let width = 7.205759403792794e16;
    let corner = [2.5379418373156492e-116, 4.445517498970155e-162];
    let apex = [4.641336831775293e-215, 1.329227995784916e36];
    let ring = [[0.0, width], corner, [width, 0.0], apex];
    let rings = [ring, ring.map(|[x, y]| [y, x])];
    for ring in rings.into_iter().take(crate::test_length::long_or(2, 1)) {
        let options = CircleOptions { max_cells: 200, ..Default::default() };
        let found = solve_with(&ring, &options).unwrap();
        let verdict = verify(&found, &ring);
        assert!(verdict.upper >= found.answer.radius && found.answer.radius > 0.0, "{verdict:?}");
    }
}

#[test]
fn the_largest_and_smallest_coordinates_are_solved() {
    let max = f64::MAX;
    let (found, verdict) = proved(&[[-max, -max], [max, -max], [max, max], [-max, max]]);
    assert!(found.answer.radius > max * (1.0 - 1e-9) && verdict.upper.is_finite());
    let min = f64::MIN_POSITIVE;
    let (found, _) = proved(&[[0.0, 0.0], [min, 0.0], [min, min], [0.0, min]]);
    assert!(found.answer.radius > 0.5 * min * (1.0 - 1e-9));
}

#[test]
fn circles_whose_radii_have_few_digits_are_refused() {
    for size in [4e-310, 1e-315, 5e-322] {
        let ring = [[0.0, 0.0], [size, 0.0], [size, 0.75 * size], [0.0, 0.75 * size]];
        let error = solve(&ring).unwrap_err();
        assert!(matches!(error, Error::Area | Error::TooThin), "{size:e}: {error}");
    }
}
