//! The support of ellipses, proved by exact arithmetic that shares nothing with the solver.

use taut_certify::{CheckError, Violation, ellipse_support};
use taut_enclose::{EllipsoidOptions, ellipsoid};
use taut_points::{Distribution, Monitor, Points, generate};

/// Normal, uniform, near an ellipse with axes in a ratio of 1000, and three clouds.
fn laws(n: usize, seed: u64) -> [Vec<f64>; 4] {
    let draw = |law| -> Vec<f64> { generate(law, n, 2, seed).unwrap() };
    let mut shell = draw(Distribution::Sphere);
    let depths: Vec<f64> = generate(Distribution::Uniform, n, 1, seed + 1).unwrap();
    for (row, depth) in shell.as_chunks_mut::<2>().0.iter_mut().zip(depths) {
        let [x, y] = row.map(|v| v * (1.0 - 1e-2 * depth));
        *row = [0.6 * x - 800.0 * y + 3.0, 0.8 * x + 600.0 * y];
    }
    let mut clouds = draw(Distribution::Normal);
    for (i, row) in clouds.as_chunks_mut::<2>().0.iter_mut().enumerate() {
        row[0] += [0.0, 9.0, 4.0][i % 3];
        row[1] *= [1.0, 0.1, 3.0][i % 3];
    }
    [draw(Distribution::Normal), draw(Distribution::Uniform), shell, clouds]
}

#[test]
fn supports_are_exact_whatever_the_law() {
    let mut sizes = [0; 6];
    for seed in 0..12 {
        for values in laws(2000, seed) {
            let points = Points::new(&values, 2).unwrap();
            let found = ellipsoid(&points, &EllipsoidOptions::default()).unwrap();
            let support = &found.certificate.support;
            let proved = ellipse_support(&points, support, &Monitor::silent()).unwrap();
            assert_eq!(proved.rows, *support, "nothing to spare");
            assert_eq!(proved.on_border, support.len() as u64);
            sizes[support.len()] += 1;
            // Without one of them the others, or the ellipse, do not stand the test.
            for i in 0..support.len() {
                let mut fewer = support.clone();
                fewer.remove(i);
                assert!(ellipse_support(&points, &fewer, &Monitor::silent()).is_err());
            }
        }
    }
    assert!(sizes[3] > 0 && sizes[4] > 0 && sizes[5] > 0, "{sizes:?}");
}

/// Of all three to five of nine points just one set passes, and the solver's is that.
#[test]
fn one_basis_of_few_points_passes() {
    for seed in 0..crate::test_length::long_or(40, 4) {
        let values: Vec<f64> = generate(Distribution::Uniform, 9, 2, seed).unwrap();
        let points = Points::new(&values, 2).unwrap();
        let found = ellipsoid(&points, &EllipsoidOptions::default()).unwrap();
        let mut passing = vec![];
        for mask in 0..1u32 << 9 {
            if (3..=5).contains(&mask.count_ones()) {
                let rows: Vec<u64> = (0..9).filter(|i| mask >> i & 1 == 1).collect();
                let proved = ellipse_support(&points, &rows, &Monitor::silent());
                passing.extend(proved.ok().filter(|proved| proved.rows == rows));
            }
        }
        let passing: Vec<Vec<u64>> = passing.into_iter().map(|proved| proved.rows).collect();
        assert_eq!(passing, [found.certificate.support]);
    }
}

/// Points on the border to the last bit are told from those one bit outside.
#[test]
fn ties_are_decided_exactly() {
    let check = |values: &[f64], rows: &[u64]| {
        ellipse_support(&Points::new(values, 2).unwrap(), rows, &Monitor::silent())
    };
    // The corners of a square, and (7, 1), on the same circle.
    let mut values = vec![5.0, 5.0, -5.0, 5.0, -5.0, -5.0, 5.0, -5.0, 7.0, 1.0];
    let proved = check(&values, &[0, 1, 2, 3]).unwrap();
    assert_eq!((proved.on_border, proved.near_border >= 1), (5, true));
    values[9] = 1f64.next_down();
    assert_eq!(check(&values, &[0, 1, 2, 3]).unwrap().on_border, 4);
    values[9] = 1f64.next_up();
    let outside = check(&values, &[0, 1, 2, 3]);
    let Err(CheckError::Rejected(Violation::OutsideSupport { row: 4 })) = outside else {
        panic!("{outside:?}")
    };
    // A triangle with (1, 1, 1)/3, and the point opposite a corner on Steiner's ellipse.
    let triangle = [0.0, 0.0, 3.0, 0.0, 0.0, 3.0, 2.0, 2.0];
    assert_eq!(check(&triangle, &[0, 1, 2]).unwrap().on_border, 4);
    // All twelve whole points on a circle: some of them are a basis.
    let mut circle: Vec<f64> = vec![];
    for (x, y) in [(5.0, 0.0), (4.0, 3.0), (3.0, 4.0)] {
        circle.extend([x, y, -y, x, -x, -y, y, -x]);
    }
    let rows: Vec<u64> = (0..10).collect();
    let proved = check(&circle, &rows).unwrap();
    assert_eq!((proved.on_border, (3..=5).contains(&proved.rows.len())), (12, true));
}

#[test]
fn what_is_no_support_is_refused_by_name() {
    let check = |values: &[f64], dim: usize, rows: &[u64]| {
        let points = Points::new(values, dim).unwrap();
        ellipse_support(&points, rows, &Monitor::silent()).unwrap_err().to_string()
    };
    let square = [0.0, 0.0, 2.0, 0.0, 2.0, 2.0, 0.0, 2.0];
    assert!(check(&square, 1, &[0, 1, 2]).contains("dimension 1"));
    assert!(check(&square, 2, &[0, 1]).contains("2 rows"));
    assert!(check(&square, 2, &[0, 1, 1, 2]).contains("point 3 lies outside"));
    assert!(check(&[0.0, 0.0, 1.0, 1.0, 2.0, 2.0], 2, &[0, 1, 2]).contains("3 rows"));
    let mut values = square.to_vec();
    values.extend([f64::NAN, 0.0]);
    assert!(check(&values, 2, &[0, 1, 2, 3]).contains("coordinate 0 of point 4"));
}
