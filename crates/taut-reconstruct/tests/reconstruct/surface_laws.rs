//! Tests what a surface does not depend on, and what is refused.

use std::sync::atomic::AtomicBool;

use judge::{JudgedSurface, assert_exact, closed, found};
use points::{Point, chances, circle, cube, sphere, tube};
use taut_certify::Apex;
use taut_points::{InputError, Monitor, Points};
use taut_reconstruct::{
    Denoise, Error, Positions, Span, SurfaceMethod, SurfaceMode, SurfaceOptions, surface,
};

use crate::surface_any::judge;
use crate::surface_any::points;

/// A torus on a grid, which is full of ties, a random sphere, and points within it.
fn sample() -> Vec<Point> {
    let mut points = tube(circle(false), 0.25, 48, 12);
    points.extend(sphere(600, [5.0, 0.0, 0.0], 1.0, 1));
    points.extend(cube(5).into_iter().map(|p| p.map(|x| x - 9.0)));
    points.extend(sphere(3, [5.0, 0.0, 0.0], 0.1, 2));
    points
}

/// The triangles and the points that show that they are Delaunay triangles, as coordinates.
fn as_places(points: &[Point], found: &JudgedSurface) -> Vec<[Option<[u64; 3]>; 4]> {
    let place = |row: u32| Some(points[row as usize].map(f64::to_bits));
    let all = found.triangles.iter().zip(&found.solution.certificate.apexes);
    let shown = |apex: &Apex| match apex {
        Apex::Row(row) => place(*row),
        _ => None,
    };
    all.map(|(&[a, b, c], apex)| [place(a), place(b), place(c), shown(apex)]).collect()
}

#[test]
fn threads_do_not_matter() {
    let points = sample();
    for mode in [SurfaceMode::Closed, SurfaceMode::Open] {
        let by = |threads| {
            found(
                &points,
                &SurfaceOptions {
                    method: SurfaceMethod::Tree(mode),
                    threads: Some(threads),
                    ..Default::default()
                },
            )
        };
        let one = by(1);
        assert_eq!(one, by(2));
        assert_eq!(one, by(8));
    }
}

#[test]
fn the_order_of_the_input_does_not_matter() {
    let points = sample();
    for mode in [SurfaceMode::Closed, SurfaceMode::Open] {
        let options = SurfaceOptions { method: SurfaceMethod::Tree(mode), ..Default::default() };
        let first = found(&points, &options);
        let mut chance = chances(9);
        for _ in 0..3 {
            let mut shuffled = points.clone();
            for k in (1..shuffled.len()).rev() {
                shuffled.swap(k, (chance() * (k + 1) as f64) as usize);
            }
            let again = found(&shuffled, &options);
            assert_eq!(as_places(&points, &first), as_places(&shuffled, &again));
            assert_eq!(first.solution.trace, again.solution.trace);
            let unused = |found: &JudgedSurface| found.solution.answer.unused.interior.len();
            assert_eq!(unused(&first), unused(&again));
        }
    }
}

#[test]
fn the_unit_does_not_matter() {
    let points = sample();
    let first = closed(&points);
    for power in [-40, 3, 300, -300] {
        let scaled: Vec<Point> = points.iter().map(|p| p.map(|x| x * 2f64.powi(power))).collect();
        let view = Points::new(scaled.as_flattened(), 3).expect("whole rows");
        let again = surface(&view, &SurfaceOptions::default()).expect("points that span space");
        assert_eq!(first.triangles, again.answer.triangles, "2^{power}");
        assert_eq!(first.solution.certificate.apexes, again.certificate.apexes);
    }
}

#[test]
fn single_precision_is_the_same_points() {
    let narrow: Vec<f32> = sample().as_flattened().iter().map(|&x| x as f32).collect();
    let wide: Vec<f64> = narrow.iter().map(|&x| f64::from(x)).collect();
    let options = SurfaceOptions::default();
    let one = surface(&Points::new(&narrow, 3).expect("whole rows"), &options).expect("a surface");
    let other = surface(&Points::new(&wide, 3).expect("whole rows"), &options).expect("a surface");
    assert_eq!((one.answer, one.certificate.apexes), (other.answer, other.certificate.apexes));
}

#[test]
fn copies_are_named() {
    let mut points = sphere(200, [0.0; 3], 1.0, 4);
    points.push(points[17]);
    points.push(points[17]);
    let found = closed(&points);
    assert!(found.is_closed() && found.is_through_all());
    assert_eq!(found.solution.answer.unused.duplicates, [[200, 17], [201, 17]]);
}

#[test]
fn points_without_volume_are_refused() {
    let refused = |points: &[Point]| {
        let view = Points::new(points.as_flattened(), 3).expect("whole rows");
        match surface(&view, &SurfaceOptions::default()) {
            Err(Error::Flat { points, span }) => (points, span),
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(refused(&[]), (0, Span::Nothing));
    assert_eq!(refused(&[[1.0; 3]]), (1, Span::Point));
    assert_eq!(refused(&[[1.0; 3]; 9]), (9, Span::Point));
    assert_eq!(refused(&[[1.0; 3], [2.0; 3], [3.0; 3], [7.0; 3]]), (4, Span::Line));
    assert_eq!(refused(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]), (3, Span::Plane));
    let plane: Vec<Point> = (0..50).map(|k| [f64::from(k % 7), f64::from(k / 7), 3.0]).collect();
    assert_eq!(refused(&plane), (50, Span::Plane));
}

#[test]
fn wrong_input_is_named() {
    let mut points = sphere(20, [0.0; 3], 1.0, 5);
    points[13][2] = f64::NAN;
    let view = Points::new(points.as_flattened(), 3).expect("whole rows");
    let refused = surface(&view, &SurfaceOptions::default());
    assert!(
        matches!(refused, Err(Error::Input(InputError::NonFinite { row: 13, column: 2, value })) if value.is_nan())
    );
    let flat = [0.0, 1.0, 2.0, 3.0];
    let plane = Points::new(&flat, 2).expect("whole rows");
    let refused = surface(&plane, &SurfaceOptions::default());
    assert!(matches!(refused, Err(Error::Input(InputError::Dimension { dim: 2, .. }))));
    let view = Points::new(&points.as_flattened()[..30], 3).expect("whole rows");
    let refused = surface(&view, &SurfaceOptions { threads: Some(0), ..Default::default() });
    assert!(matches!(refused, Err(Error::Input(InputError::Option { name: "threads", .. }))));
}

#[test]
fn a_monitor_stops_it() {
    let points = sphere(2_000, [0.0; 3], 1.0, 6);
    let view = Points::new(points.as_flattened(), 3).expect("whole rows");
    let stop = AtomicBool::new(true);
    let monitor = Monitor { cancel: Some(&stop), ..Monitor::silent() };
    let stopped = surface(&view, &SurfaceOptions { monitor, ..Default::default() });
    assert!(matches!(stopped, Err(Error::Input(InputError::Cancelled(_)))));
}

#[test]
fn extreme_coordinates_are_solved() {
    let cubes = [1e-300, 1e-150, 1e150, 1e300];
    for size in cubes {
        let points: Vec<Point> = cube(4).into_iter().map(|p| p.map(|x| x * size)).collect();
        let view = Points::new(points.as_flattened(), 3).expect("whole rows");
        let found = surface(&view, &SurfaceOptions::default()).expect("points that span space");
        assert!(found.check(&view).expect("a sound certificate").certified, "{size:e}");
        assert_eq!(found.answer.topology.vertices, points.len() as u64, "{size:e}");
    }
    let far: Vec<Point> = sphere(500, [1e6, -1e6, 1e6], 1.0, 8);
    assert_exact(&closed(&far), 1, 0);
}

/// A unit sphere with noise of 2 %, and three points far from it.
fn noisy() -> Vec<Point> {
    let mut chance = chances(21);
    let mut points = sphere(4_000, [0.0; 3], 1.0, 20);
    for point in &mut points {
        let away = 1.0 + 0.02 * (chance() + chance() + chance() + chance() - 2.0);
        *point = point.map(|x| x * away);
    }
    points.extend([[0.1, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, -2.0, 2.0]]);
    points
}

#[test]
fn noise_is_taken_out() {
    let points = noisy();
    let with = |positions| {
        let denoise = Some(Denoise { positions, ..Default::default() });
        let options = SurfaceOptions { denoise, ..Default::default() };
        judge::found(&points, &options)
    };
    let found = with(Positions::Projected);
    assert!(found.is_closed() && found.topology.genus == Some(0));
    assert_eq!(found.solution.answer.unused.outliers, [4_000, 4_001, 4_002]);
    let off = |points: &[Point]| -> f64 {
        points[..4_000]
            .iter()
            .map(|p| (p.iter().map(|x| x * x).sum::<f64>().sqrt() - 1.0).abs())
            .sum()
    };
    assert!(
        off(&found.solution.answer.vertices) < 0.5 * off(&points),
        "{} {}",
        off(&found.solution.answer.vertices),
        off(&points)
    );
    let in_place = with(Positions::Original);
    assert!(in_place.solution.answer.vertices.is_empty());
    assert_eq!(in_place.triangles, found.triangles);
}

#[test]
fn noise_is_taken_out_alike_in_any_order_and_unit() {
    let points = noisy();
    let options = SurfaceOptions { denoise: Some(Denoise::default()), ..Default::default() };
    let by = |points: &[Point]| found(points, &options);
    let first = by(&points);
    let turned: Vec<Point> = points.iter().rev().copied().collect();
    let again = by(&turned);
    assert_eq!(
        as_places(&first.solution.answer.vertices, &first),
        as_places(&again.solution.answer.vertices, &again)
    );
    for power in [-400, 300] {
        let unit = 2f64.powi(power);
        let scaled: Vec<Point> = points.iter().map(|p| p.map(|x| x * unit)).collect();
        let again = by(&scaled);
        assert_eq!(first.triangles, again.triangles);
        let back: Vec<Point> =
            again.solution.answer.vertices.iter().map(|p| p.map(|x| x / unit)).collect();
        assert_eq!(first.solution.answer.vertices, back);
    }
}

#[test]
fn wrong_ways_to_take_out_noise_are_named() {
    let points = noisy();
    let view = Points::new(points.as_flattened(), 3).expect("whole rows");
    let refused = |denoise| {
        let options = SurfaceOptions { denoise: Some(denoise), ..Default::default() };
        match surface(&view, &options) {
            Err(Error::Input(InputError::Option { name, .. })) => name,
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(refused(Denoise { neighbors: Some(3), ..Default::default() }), "neighbors");
    assert_eq!(refused(Denoise { iterations: 101, ..Default::default() }), "iterations");
}
