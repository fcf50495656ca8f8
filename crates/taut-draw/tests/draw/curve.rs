//! Tests what pictures of curves must hold: every curve once, the band on both sides, honest counts, finite numbers, the same bytes again.

use taut_certify::{Curve, CurveCertificate, CurveComponent, Solution, Trace};
use taut_draw::{
    DrawOptions, Error, Figure, Page, Scene2, Section, Shape2, Style, curve_figures, to_html,
    to_svg,
};
use taut_points::{Points, PointsHash};

/// An answer as a solver could give it; pictures do not ask whether it is right.
fn answer(curves: Vec<CurveComponent>, noise: f64, outliers: Vec<u64>) -> Solution<Curve> {
    let certificate = CurveCertificate {
        band: noise,
        sampling_ratio: f64::MAX,
        noise_ratio: f64::MAX,
        certified: false,
        tour: None,
        points_hash: PointsHash(0),
    };
    let answer = Curve { curves, noise, outliers, places: Vec::new() };
    Solution { answer, certificate, trace: Trace::default() }
}

fn component(vertices: Vec<[f64; 2]>, closed: bool) -> CurveComponent {
    CurveComponent { vertices, closed, rows: Vec::new() }
}

fn ring(n: usize, radius: f64) -> Vec<[f64; 2]> {
    (0..n)
        .map(|i| (std::f64::consts::TAU * i as f64 / n as f64).sin_cos())
        .map(|(sin, cos)| [radius * cos, radius * sin])
        .collect()
}

fn plane(figure: &Figure) -> &Scene2 {
    let Figure::Plane(scene) = figure else { panic!("a scene of the plane") };
    scene
}

fn shape<'a>(scene: &'a Scene2, name: &str) -> Option<&'a Shape2> {
    scene.layers.iter().find(|layer| layer.name == name).map(|layer| &layer.shape)
}

fn figures(
    found: &Solution<Curve>,
    points: &[[f64; 2]],
    options: &DrawOptions,
) -> Result<Vec<Figure>, Error> {
    curve_figures(found, &Points::new(points.as_flattened(), 2).unwrap(), options)
}

#[test]
fn a_ring_and_a_line_show_curves_band_ends_and_outliers() {
    let points = [ring(200, 1.05), ring(200, 0.95), vec![[3.0, 3.0]]].concat();
    let line = vec![[2.0, -1.0], [2.5, 0.0], [2.0, 1.0]];
    let found = answer(
        vec![component(ring(64, 1.0), true), component(line.clone(), false)],
        0.05,
        vec![400],
    );
    let drawn = figures(&found, &points, &DrawOptions::default()).unwrap();
    let scene = plane(&drawn[0]);
    assert_eq!(scene.title, "2 curves through 401 points");
    assert_eq!(
        scene.caption,
        "1 closed and 1 open curves with 67 vertices. Noise of half-width 0.05, as estimated. One point is an outlier. \
         All 401 points are drawn."
    );
    let count = |name: &str| match shape(scene, name) {
        Some(Shape2::Points(list)) => list.len(),
        Some(Shape2::Polygons(list) | Shape2::Polylines(list)) => list.len(),
        _ => 0,
    };
    assert_eq!([count("points"), count("outliers"), count("ends")], [400, 1, 2]);
    assert_eq!([count("closed curves"), count("open curves")], [1, 1]);
    let Some(Shape2::Polygons(borders)) = shape(scene, "band of noise") else { panic!("a band") };
    assert_eq!(borders.len(), 2);
    for (border, radius) in borders.iter().zip([0.95, 1.05]) {
        assert!(border.iter().all(|at| (at[0].hypot(at[1]) - radius).abs() < 1e-3), "{radius}");
    }
    let Some(Shape2::Polylines(drawn_line)) = shape(scene, "open curves") else { panic!("a line") };
    assert_eq!(*drawn_line, [line]);
}

/// A band of a thousandth of the picture cannot be seen, so a window shows it.
#[test]
fn narrow_bands_have_a_window() {
    let points = ring(5000, 1.0);
    let found = answer(vec![component(ring(500, 1.0), true)], 1e-3, Vec::new());
    let drawn = figures(&found, &points, &DrawOptions::default()).unwrap();
    assert_eq!(drawn.len(), 2);
    let scene = plane(&drawn[1]);
    assert!(scene.title.ends_with(": a window") && scene.caption.contains("half-width 0.001"));
    let Some(Shape2::Points(inside)) = shape(scene, "points") else { panic!("points") };
    assert!((10..200).contains(&inside.len()), "{}", inside.len());
    assert!(shape(scene, "ends").is_none());
    let wide = answer(vec![component(ring(500, 1.0), true)], 0.1, Vec::new());
    assert_eq!(figures(&wide, &points, &DrawOptions::default()).unwrap().len(), 1);
}

#[test]
fn of_many_points_an_even_sample_is_drawn_and_counted() {
    let points = ring(5000, 1.0);
    let found = answer(vec![component(ring(5000, 1.0), true)], 0.0, (0..40).collect());
    let options = DrawOptions { max_points: 100, ..DrawOptions::default() };
    let drawn = figures(&found, &points, &options).unwrap();
    let scene = plane(&drawn[0]);
    let Some(Shape2::Points(others)) = shape(scene, "points") else { panic!("points") };
    assert_eq!(others.len(), 100);
    assert!(
        scene.caption.contains("40 points are outliers, 25 of them drawn."),
        "{}",
        scene.caption
    );
    assert!(scene.caption.contains("of 5000 points are drawn"), "{}", scene.caption);
    let Some(Shape2::Polygons(rings)) = shape(scene, "closed curves") else { panic!("a ring") };
    assert!((500..5000).contains(&rings[0].len()), "{}", rings[0].len());
}

#[test]
fn degenerate_answers_are_drawn_and_wrong_ones_refused() {
    let points = [[1.0, 2.0], [1.0, 2.0]];
    let options = DrawOptions::default();
    for curves in [
        vec![],
        vec![component(vec![[1.0, 2.0]], false)],
        vec![component(vec![[1.0, 2.0]; 3], true)],
        vec![component(vec![], false)],
    ] {
        for noise in [0.0, 1e-300, 1e300] {
            let found = answer(curves.clone(), noise, vec![1]);
            for figure in figures(&found, &points, &options).unwrap() {
                let svg = to_svg(&figure, &Style::default());
                roxmltree::Document::parse(&svg).unwrap();
                assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
                let section = Section { figures: vec![figure], ..Section::default() };
                to_html(&Page { sections: vec![section], ..Page::default() });
            }
        }
    }
    let beyond = answer(vec![], 0.0, vec![2]);
    assert!(matches!(figures(&beyond, &points, &options), Err(Error::Mismatch { .. })));
    let nan = answer(vec![component(vec![[0.0, f64::NAN]], false)], 0.0, vec![]);
    assert!(matches!(figures(&nan, &points, &options), Err(Error::NonFinite { .. })));
    let space = Points::new(&[0.0, 0.0, 0.0], 3).unwrap();
    let found = answer(vec![], 0.0, vec![]);
    assert!(matches!(curve_figures(&found, &space, &options), Err(Error::Mismatch { .. })));
}
