//! Tests what pictures of triangulations must hold: every edge once, honest counts, finite numbers, the same bytes again.

use taut_certify::{Solution, Triangulation};
use taut_delaunay::{DelaunayOptions, delaunay};
use taut_draw::{
    DrawOptions, Error, Figure, Page, Scene2, Scene3, Section, Shape2, Shape3, Style,
    delaunay_figures, to_html, to_svg,
};
use taut_points::{Distribution, Points, generate};

fn solved(values: &[f64], dim: usize) -> Solution<Triangulation> {
    delaunay(&Points::new(values, dim).unwrap(), &DelaunayOptions::default()).unwrap()
}

fn figures(values: &[f64], dim: usize, options: &DrawOptions) -> Vec<Figure> {
    let points = Points::new(values, dim).unwrap();
    delaunay_figures(&solved(values, dim), &points, options).unwrap()
}

fn plane(figure: &Figure) -> &Scene2 {
    let Figure::Plane(scene) = figure else { panic!("a scene of the plane") };
    scene
}

fn space(figure: &Figure) -> &Scene3 {
    let Figure::Space(scene) = figure else { panic!("a scene of space") };
    scene
}

fn chains<'a>(scene: &'a Scene2, name: &str) -> &'a [Vec<[f64; 2]>] {
    match scene.layers.iter().find(|layer| layer.name == name).map(|layer| &layer.shape) {
        Some(Shape2::Polylines(chains)) => chains,
        _ => &[],
    }
}

/// A square with its center: four triangles, eight edges.
const SQUARE: [f64; 10] = [0.0, 0.0, 2.0, 0.0, 2.0, 2.0, 0.0, 2.0, 1.0, 1.0];

#[test]
fn a_square_shows_its_edges_hull_and_cells() {
    let drawn = figures(&SQUARE, 2, &DrawOptions::default());
    assert_eq!(drawn.len(), 2);
    let scene = plane(&drawn[0]);
    assert_eq!(scene.title, "Delaunay triangulation of 5 points in the plane");
    assert_eq!(scene.caption, "4 triangles, 4 edges on the hull.");
    assert_eq!(chains(scene, "edges").len(), 8);
    assert_eq!(chains(scene, "convex hull").len(), 4);
    let scene = plane(&drawn[1]);
    // The cell of the center is a square on its corner; a ray leaves each corner of it.
    let cells = chains(scene, "Voronoi diagram");
    assert_eq!(cells.len(), 8);
    for [a, b] in cells.iter().map(|ends| [ends[0], ends[1]]) {
        let inner = |p: [f64; 2]| ((p[0] - 1.0).abs() + (p[1] - 1.0).abs() - 1.0).abs() < 1e-12;
        let ray = a[0] == b[0] || a[1] == b[1];
        assert!(inner(a) && (ray || inner(b)), "{a:?} {b:?}");
    }
}

#[test]
fn voronoi_edges_lie_between_their_two_points() {
    let values: Vec<f64> = generate(Distribution::Normal, 200, 2, 3).unwrap();
    let drawn = figures(&values, 2, &DrawOptions::default());
    let cells = chains(plane(&drawn[1]), "Voronoi diagram");
    assert!(cells.len() > 300);
    for ends in cells {
        let middle = [0, 1].map(|k| (ends[0][k] + ends[1][k]) / 2.0);
        let mut far: Vec<f64> =
            values.chunks(2).map(|p| (p[0] - middle[0]).hypot(p[1] - middle[1])).collect();
        far.sort_by(f64::total_cmp);
        // Two nearest points, equally far.
        assert!((far[1] - far[0]).abs() <= 1e-9 * far[0].max(1.0), "{ends:?}");
    }
}

#[test]
fn many_points_are_drawn_in_a_window_and_counted() {
    let values: Vec<f64> = generate(Distribution::Normal, 5000, 2, 4).unwrap();
    let drawn = figures(&values, 2, &DrawOptions { max_points: 1000, ..Default::default() });
    assert_eq!(drawn.len(), 3);
    let whole = plane(&drawn[0]);
    assert!(
        whole.caption.contains("too many edges") && whole.caption.contains("1000 points are drawn")
    );
    assert!(chains(whole, "edges").is_empty() && chains(whole, "convex hull").len() > 3);
    let window = plane(&drawn[1]);
    assert!(window.caption.contains("601 points"), "{}", window.caption);
    let edges = chains(window, "edges").len();
    assert!((1500..2500).contains(&edges), "{edges}");
    for figure in &drawn {
        assert!(to_svg(figure, &Style::default()).len() < 200_000);
    }
    let all = figures(&values, 2, &DrawOptions::default());
    assert!(chains(plane(&all[0]), "edges").len() > 14_900);
    // Edges share paths: without that, each would take as much room again.
    assert!(to_svg(&all[0], &Style::default()).len() < 1_000_000);
}

/// Copies of the middle lie in every window, points of one square around it in all or in none.
#[test]
fn no_picture_has_more_points_than_asked_for() {
    let most = 500;
    let options = DrawOptions { max_points: most, ..Default::default() };
    let copies = [0.0, 0.0].repeat(4000);
    let others: Vec<f64> = generate(Distribution::Normal, 1500, 2, 4).unwrap();
    let mut ring = copies.clone();
    ring.extend((0..1200).flat_map(|i| [1.0, f64::from(i) / 1200.0]));
    for (values, pictures) in
        [([&copies, &others[..]].concat(), 3), (ring, 1), (copies, 1), (others, 3)]
    {
        let drawn = figures(&values, 2, &options);
        assert_eq!(drawn.len(), pictures);
        for figure in &drawn {
            for layer in &plane(figure).layers {
                if let Shape2::Points(points) = &layer.shape {
                    assert!((1..=most).contains(&points.len()), "{}", points.len());
                }
            }
        }
    }
}

#[test]
fn space_shows_the_hull_and_few_edges() {
    let values: Vec<f64> = generate(Distribution::Normal, 50, 3, 5).unwrap();
    let drawn = figures(&values, 3, &DrawOptions::default());
    let scene = space(&drawn[0]);
    let found = solved(&values, 3);
    let Shape3::Mesh(hull) = &scene.layers[0].shape else { panic!("a surface") };
    assert_eq!(hull.triangles.len() * 3, found.answer.hull.len());
    let Shape3::Polylines(edges) = &scene.layers[1].shape else { panic!("edges") };
    // Euler: n − E + F − T = 1, with 4T + H = 2F.
    let (t, h) = (found.answer.len(), hull.triangles.len());
    assert_eq!(edges.len(), 50 + (4 * t + h) / 2 - t - 1);
    let page = to_html(&Page {
        sections: vec![Section { figures: drawn.clone(), ..Default::default() }],
        ..Default::default()
    });
    assert!(page.contains("\"look\":\"thin\"") && page.contains("\"kind\":\"mesh\""));
    let values: Vec<f64> = generate(Distribution::Sphere, 3000, 3, 5).unwrap();
    let drawn = figures(&values, 3, &DrawOptions { max_points: 1000, ..Default::default() });
    let scene = space(&drawn[0]);
    assert!(
        scene.caption.contains("too many to draw") && scene.caption.contains("too many to see")
    );
    assert_eq!(scene.layers.len(), 1);
}

#[test]
fn flat_points_are_drawn_as_what_they_are() {
    for (values, dim, said) in [
        (&[1.0, 1.0, 1.0, 1.0][..], 2, "All points are equal. One point equals an earlier one."),
        (&[0.0, 0.0, 1.0, 1.0, 3.0, 3.0], 2, "All points are on a line, 2 edges from end to end."),
        (&[0.0, 0.0, 0.0, 1.0, 1.0, 1.0], 3, "All points are on a line, 1 edge from end to end."),
        (
            &[0.0, 0.0, 1.0, 1.0, 0.0, 1.0, 0.0, 1.0, 1.0],
            3,
            "All points are on a plane: 1 triangle, 3 edges on the hull.",
        ),
        (&[1e300, -1e300, 0.0, 1e300, -1e300, -1e300], 2, "1 triangle, 3 edges on the hull."),
        (&[1e-310, 0.0, 0.0, 1e-310, 0.0, 0.0], 2, "1 triangle, 3 edges on the hull."),
    ] {
        for figure in figures(values, dim, &DrawOptions::default()) {
            if !figure.title().starts_with("Voronoi") {
                assert_eq!(figure.caption(), said);
            }
            let svg = to_svg(&figure, &Style::default());
            assert!(!svg.contains("NaN") && !svg.contains("inf"), "{said}");
        }
    }
}

#[test]
fn other_points_than_those_of_the_answer_are_refused() {
    let found = solved(&SQUARE, 2);
    let draw = |values: &[f64], dim| {
        delaunay_figures(&found, &Points::new(values, dim).unwrap(), &DrawOptions::default())
    };
    assert!(matches!(draw(&SQUARE[..8], 2), Err(Error::Mismatch { what: "number of points", .. })));
    assert!(matches!(draw(&[0.0; 15], 3), Err(Error::Mismatch { .. })));
    let mut bad = SQUARE;
    bad[3] = f64::NAN;
    let refused = draw(&bad, 2).unwrap_err().to_string();
    assert_eq!(refused, "coordinate 1 of point 1 is NaN: only finite numbers can be drawn");
}
