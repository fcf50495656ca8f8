//! Sets whose smallest ellipsoid is known: the checker must confirm it to the last digits.

use common::ellipsoids::{
    certify, cross_polytope, cube, embedded, log_unit_ball, orthonormal, polygon, simplex, uniform,
};
use common::{normalized, numbers};

use crate::common;

/// log-volume to 1e-13, with a gap proved that is no more than rounding.
fn is_tight(case: &common::ellipsoids::Case, log_volume: f64) {
    let verdict = case.verdict();
    let dim = case.solution.answer.rank() as f64;
    assert!(verdict.gap <= 2e-15 * dim * dim, "{}: {verdict:?}", case.name);
    assert!(
        (verdict.upper - log_volume).abs() <= 1e-13 * (1.0 + log_volume.abs()),
        "{}: {verdict:?}",
        case.name
    );
    assert!(verdict.lower <= verdict.upper && verdict.excess <= 1e-14, "{}", case.name);
    assert!(verdict.matrix_excess <= 1e-13 * dim, "{}: {verdict:?}", case.name);
}

#[test]
fn cubes_have_the_ball_through_their_corners() {
    for dim in 1..9 {
        let case = uniform(&format!("cube {dim}"), &cube(dim), dim);
        is_tight(&case, log_unit_ball(dim) + 0.5 * dim as f64 * (dim as f64).ln());
    }
}

#[test]
fn cross_polytopes_have_the_unit_ball() {
    for dim in 1..12 {
        is_tight(&uniform(&format!("cross {dim}"), &cross_polytope(dim), dim), log_unit_ball(dim));
    }
}

/// Volume of the simplex of the origin and the unit vectors is 1/d!, that of the regular one with the unit sphere around
/// it d^(-d/2)·(d + 1)^((d + 1)/2)/d!.
#[test]
fn simplices_have_the_ellipsoid_of_equal_multipliers() {
    for dim in 1..12 {
        let d = dim as f64;
        let ratio = 0.5 * d * d.ln() - 0.5 * (d + 1.0) * (d + 1.0).ln();
        is_tight(
            &uniform(&format!("simplex {dim}"), &simplex(dim), dim),
            log_unit_ball(dim) + ratio,
        );
    }
}

#[test]
fn regular_polygons_have_their_circle() {
    for k in [3, 4, 5, 7, 12, 1000] {
        is_tight(&uniform(&format!("{k}-gon"), &polygon(k), 2), std::f64::consts::PI.ln());
    }
}

/// The classical designs for polynomials: on the curve (t, …, tᵈ) the support is the zeros of (1 − t²)P′(t), P being
/// the Legendre polynomial of degree d; here for d = 2 and 3, where Σ is computed by hand.
#[test]
fn moment_curves_have_the_designs_of_polynomials() {
    let curve = |dim: usize, extra: &[f64]| -> (Vec<f64>, Vec<u64>) {
        let ends: Vec<f64> = if dim == 2 {
            vec![-1.0, 0.0, 1.0]
        } else {
            vec![-1.0, -(0.2f64.sqrt()), 0.2f64.sqrt(), 1.0]
        };
        let all: Vec<f64> = ends.iter().chain(extra).copied().collect();
        let support = (0..ends.len() as u64).collect();
        (all.iter().flat_map(|&t| (1..=dim as i32).map(move |k| t.powi(k))).collect(), support)
    };
    let between: Vec<f64> = (0..50).map(|i| -1.0 + i as f64 / 25.0).collect();
    // d = 2: Σ = diag(2/3, 2/9).
    let (values, support) = curve(2, &between);
    let case = certify("parabola", &values, 2, &support, &[1.0 / 3.0; 3]);
    is_tight(&case, log_unit_ball(2) + 2f64.ln() + 0.5 * (4.0f64 / 27.0).ln());
    // d = 3: moments 0.6, 0.52, 0.504 of t², t⁴, t⁶.
    let (values, support) = curve(3, &between);
    let case = certify("cubic", &values, 3, &support, &[0.25; 4]);
    let determinant: f64 = (0.52 - 0.36) * (0.6 * 0.504 - 0.52 * 0.52);
    is_tight(&case, log_unit_ball(3) + 1.5 * 3f64.ln() + 0.5 * determinant.ln());
}

#[test]
fn scales_and_offsets_cost_no_digits() {
    for scale in [1e-150, 1e-60, 1.0, 1e60, 1e150] {
        let values: Vec<f64> = cross_polytope(4).iter().map(|v| v * scale).collect();
        is_tight(
            &uniform(&format!("scale {scale:e}"), &values, 4),
            log_unit_ball(4) + 4.0 * scale.ln(),
        );
    }
    for offset in [1e3, 1e8, 1e12, 1e15] {
        let values: Vec<f64> = cube(3).iter().map(|v| v + offset).collect();
        is_tight(
            &uniform(&format!("offset {offset:e}"), &values, 3),
            log_unit_ball(3) + 1.5 * 3f64.ln(),
        );
    }
    let stretch = [1e-6, 1.0, 1e6];
    let values: Vec<f64> = cube(3).iter().enumerate().map(|(i, v)| v * stretch[i % 3]).collect();
    is_tight(&uniform("axes", &values, 3), log_unit_ball(3) + 1.5 * 3f64.ln());
}

#[test]
fn flat_sets_are_judged_in_their_hull() {
    for (rank, dim) in [(1, 2), (1, 5), (2, 3), (3, 7), (4, 5)] {
        let flat = uniform(&format!("cube {rank}"), &cube(rank), rank);
        let basis = orthonormal(&numbers(rank * dim, rank as u64), rank, dim);
        let case = embedded(&flat, &basis);
        let verdict = case.verdict();
        let expected = log_unit_ball(rank) + 0.5 * rank as f64 * (rank as f64).ln();
        assert!(verdict.gap <= 1e-13 * rank as f64, "{}: {verdict:?}", case.name);
        assert!((verdict.upper - expected).abs() <= 1e-12, "{}: {verdict:?}", case.name);
        assert_eq!(verdict.rank, rank);
    }
}

#[test]
fn one_point_is_an_ellipsoid_of_dimension_zero() {
    use taut_certify::{Ellipsoid, Hull};
    let mut case = uniform("square", &cube(2), 2);
    case.values = [3.0, 1e9].repeat(4);
    case.solution.answer = Ellipsoid {
        center: vec![3.0, 1e9],
        center_tail: vec![],
        matrix: vec![vec![0.0; 2]; 2],
        factor: vec![],
        hull: Some(Hull { basis: vec![], distance: 0.0 }),
        log_volume: 0.0,
    };
    case.solution.certificate.points_hash = common::ellipsoids::hash(&case.values, 2);
    let verdict = case.verdict();
    assert_eq!((verdict.lower, verdict.upper, verdict.gap, verdict.rank), (0.0, 0.0, 0.0, 0));
    case.values[3] += 1e-3;
    case.solution.certificate.points_hash = common::ellipsoids::hash(&case.values, 2);
    assert!(matches!(case.violation(), taut_certify::Violation::OffHull { row: 1, .. }));
}

/// Multipliers far from the best ones prove a bound of their own, and it is the one the formula says.
#[test]
fn any_multipliers_prove_what_the_formula_says() {
    // The square with weights (1, 1, 2, 4)/8: Σ by hand.
    let values = cube(2);
    let u = normalized(&[1.0, 1.0, 2.0, 4.0]);
    let case = certify("square", &values, 2, &[0, 1, 2, 3], &u);
    // Means: x has −1 at rows 0 and 2; y has −1 at rows 0 and 1.
    let (mx, my): (f64, f64) = ((1.0 - 1.0 + 4.0 - 2.0) / 8.0, (6.0 - 2.0) / 8.0);
    let exy: f64 = (1.0 - 1.0 - 2.0 + 4.0) / 8.0;
    let determinant: f64 = (1.0 - mx * mx) * (1.0 - my * my) - (exy - mx * my).powi(2);
    let lower = log_unit_ball(2) + 2f64.ln() + 0.5 * determinant.ln();
    let verdict = case.verdict();
    assert!((verdict.lower - lower).abs() <= 1e-14, "{verdict:?} {lower}");
}

/// Axes in a ratio of 2⁵⁰⁰ to 2⁹⁰⁰, the second tied to the first: squares of the entries of F do not share a range.
#[test]
fn axes_of_any_ratio_have_their_matrix() {
    use taut_certify::{Ellipsoid, EllipsoidCertificate, Items, Solution, Trace};
    use taut_points::{Monitor, Points, hash_points};

    for power in [250, 300, 400, 450] {
        let (long, short) = (2f64.powi(power), 2f64.powi(-power));
        let mut values = vec![];
        for (y, z) in [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)] {
            values.extend([long * y, short * (z - 0.5 * y)]);
        }
        let points = Points::new(&values, 2).unwrap();
        let root = 0.5f64.sqrt();
        let factor = vec![vec![root * short, 0.0], vec![0.5 * root * short, root * long]];
        let square = root * root;
        let mut by_hand = Solution {
            answer: Ellipsoid {
                center: vec![0.0, 0.0],
                center_tail: vec![],
                matrix: vec![
                    vec![1.25 * square * short * short, 0.5 * square],
                    vec![0.5 * square, square * long * long],
                ],
                factor,
                hull: None,
                log_volume: std::f64::consts::TAU.ln(),
            },
            certificate: EllipsoidCertificate {
                items: Items::Points,
                support: vec![0, 1, 2, 3],
                multipliers: vec![0.25; 4],
                directions: vec![],
                left_out: vec![],
                gap: 1e-12,
                points_hash: hash_points(&points, &Monitor::silent()).unwrap(),
            },
            trace: Trace::default(),
        };
        let verdict = by_hand.check(&points).unwrap();
        assert!(verdict.gap < 1e-13 && verdict.matrix_excess < 1e-13, "{power}: {verdict:?}");
        for (row, column) in [(0, 0), (1, 1)] {
            let right = by_hand.answer.matrix[row][column];
            by_hand.answer.matrix[row][column] *= 1.0 + 1e-13;
            assert!(by_hand.check(&points).is_err(), "{power}: entry {row}, {column}");
            by_hand.answer.matrix[row][column] = right;
        }
    }
}
