//! Counts that are known beforehand.

use taut_delaunay::{DelaunayOptions, Plane, Space, delaunay};
use taut_points::{Distribution, Points, generate};

/// The perturbation that looks at coordinates alone cuts each cube of a grid into the same six tetrahedra.
#[test]
fn a_grid_of_k_cubed_points_has_six_tetrahedra_a_cube() {
    for k in [2usize, 3, 5, 16] {
        let values: Vec<f64> =
            (0..k.pow(3)).flat_map(|i| [i % k, i / k % k, i / k / k]).map(|x| x as f64).collect();
        let points = Points::new(&values, 3).expect("whole rows");
        for threads in [1, 5] {
            let options = DelaunayOptions {
                threads: Some(threads),
                sites_per_thread: Some(1),
                ..DelaunayOptions::default()
            };
            let found = delaunay(&points, &options).expect("finite");
            assert_eq!(found.answer.len(), 6 * (k - 1).pow(3), "{k}, {threads} threads");
            assert_eq!(found.certificate.counts.hull as usize, 12 * (k - 1).pow(2));
        }
    }
}

/// Euler's relation: T = 2n − 2 − h with h vertices on the hull, those between its corners included.
#[test]
fn a_grid_of_the_plane_has_two_triangles_a_square() {
    let (rows, columns) = (40, 60);
    let values: Vec<f64> =
        (0..rows * columns).flat_map(|i| [i % columns, i / columns]).map(f64::from).collect();
    let points = Points::new(&values, 2).expect("whole rows");
    let found = delaunay(&points, &DelaunayOptions::default()).expect("finite");
    assert_eq!(found.answer.len() as i32, 2 * (rows - 1) * (columns - 1));
    assert_eq!(found.certificate.counts.hull as i32, 2 * (rows - 1) + 2 * (columns - 1));
}

/// All integer points on the circle of radius 5·13·17·29, and those alone: any triangulation of a polygon.
#[test]
fn integer_points_on_a_circle() {
    let radius = 5 * 13 * 17 * 29i64;
    let on_circle = (-radius..=radius).flat_map(|x| {
        let y = ((radius * radius - x * x) as f64).sqrt().round() as i64;
        let both = if y == 0 { vec![0] } else { vec![y, -y] };
        both.into_iter()
            .filter(move |y| x * x + y * y == radius * radius)
            .map(move |y| [x as f64, y as f64])
    });
    let values: Vec<f64> = on_circle.flatten().collect();
    let n = values.len() / 2;
    assert_eq!(n, 4 * 3usize.pow(4), "each prime 1 mod 4 of the radius triples the points");
    let points = Points::new(&values, 2).expect("whole rows");
    let found = delaunay(&points, &DelaunayOptions::default()).expect("finite");
    assert_eq!(found.answer.len(), n - 2);
    assert_eq!(
        found.check(&points).expect("it is the one").ties as usize,
        n - 3,
        "each inner edge is a tie"
    );
}

/// Exact arithmetic is for the rare case.
#[test]
fn uniform_points_hardly_need_exact_arithmetic() {
    for dim in [2, 3] {
        let values = generate::<f64>(Distribution::Uniform, 100_000, dim, 1).expect("a set");
        let points = Points::new(&values, dim).expect("whole rows");
        let options = DelaunayOptions::default();
        let counters = match dim {
            2 => *Plane::build(&points, &options).expect("finite").counters(),
            _ => *Space::build(&points, &options).expect("finite").counters(),
        };
        let exact = counters.stages.calls() - counters.stages.filter;
        let tests = counters.orientations + counters.conflict_tests;
        assert!(tests > 1_000_000 && exact as f64 <= 1e-4 * tests as f64, "{dim}: {counters:?}");
    }
}
