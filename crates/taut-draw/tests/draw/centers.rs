//! Tests what pictures of centers must hold: a circle each, what is left out, the core-set, and both bounds by k.

use taut_certify::{Centers, CentersCertificate, Items, LowerBound, Placement, Solution, Trace};
use taut_draw::{
    DrawOptions, ElbowStep, Error, Figure, Plot, Scene2, Shape2, Shape3, Style, Tone,
    centers_figures, elbow_figure, to_svg,
};
use taut_points::{Distribution, Monitor, Points, generate, hash_points};

/// Two clouds of radius 1 around ±4 on the first axis, `most` points in all, and one far away.
fn case(dim: usize, most: usize) -> (Vec<f64>, Solution<Centers>) {
    let mut values: Vec<f64> = generate(Distribution::Normal, most - 1, dim, 6).unwrap();
    for (i, point) in values.chunks_exact_mut(dim).enumerate() {
        let length = point.iter().map(|v| v * v).sum::<f64>().sqrt();
        point.iter_mut().for_each(|v| *v /= length.max(1.0));
        point[0] += if i % 2 == 0 { 4.0 } else { -4.0 };
    }
    values.extend(vec![50.0; dim]);
    let center = |x: f64| (0..dim).map(|j| if j == 0 { x } else { 0.0 }).collect::<Vec<f64>>();
    let points_hash = hash_points(&Points::new(&values, dim).unwrap(), &Monitor::silent()).unwrap();
    let answer = Centers {
        centers: vec![center(4.0), center(-4.0)],
        rows: vec![],
        radius: 1.0,
        lower_bound: 0.8,
        outliers: vec![most as u64 - 1],
        assignment: vec![],
    };
    let certificate = CentersCertificate {
        items: Items::Points,
        weights: false,
        group: None,
        placement: Placement::Free,
        k: 2,
        outliers: 1,
        gap: 0.25,
        core_set: vec![3, 0, 1, most as u64 - 1],
        directions: vec![],
        proof: LowerBound::Separated,
        points_hash,
    };
    (values, Solution { answer, certificate, trace: Trace::default() })
}

fn drawn(values: &[f64], columns: usize, found: &Solution<Centers>) -> Vec<Figure> {
    let points = Points::new(values, columns).unwrap();
    let figures = centers_figures(found, &points, &DrawOptions::default()).unwrap();
    for figure in &figures {
        let text = to_svg(figure, &Style::default());
        assert!(!text.contains("NaN") && !text.contains("inf"), "{columns} columns");
    }
    figures
}

/// An ellipse of half axes 3 and 1 that the ball around its middle holds, and one that reaches to a center of its own from aside.
#[test]
fn ellipses_are_drawn_and_reach_as_far_as_their_ends() {
    let (_, mut found) = case(2, 3);
    let values = [4.0, 0.0, 1.0, 0.0, 9.0, -4.0, 2.0, 1.0, 0.0, 1.0];
    found.answer.outliers.clear();
    found.answer.radius = 3.0;
    found.certificate.items = Items::Ellipsoids;
    found.certificate.core_set = vec![0, 0, 1];
    found.certificate.directions = vec![vec![0.0, 1.0], vec![0.0, -1.0], vec![0.0, 1.0]];
    let figures = drawn(&values, 5, &found);
    let text = to_svg(&figures[0], &Style::default());
    assert!(text.contains("2 ellipsoids") && !text.contains("reach outside"), "{text}");
    assert!(text.contains("The 2 ellipsoids of the core-set"), "{text}");
    // A little less, and both reach beyond.
    found.answer.radius = 2.9;
    let figures = drawn(&values, 5, &found);
    assert!(
        to_svg(&figures[0], &Style::default()).contains("2 ellipsoids reach outside the balls")
    );
}

fn plane(figures: &[Figure]) -> &Scene2 {
    match &figures[0] {
        Figure::Plane(scene) => scene,
        other => panic!("{other:?}"),
    }
}

fn ids(scene: &Scene2, tone: Tone) -> Vec<u64> {
    let layers = scene.layers.iter().filter(|layer| layer.tone == tone);
    let ids = layers.flat_map(|layer| match &layer.shape {
        Shape2::Points(points) => points.iter().filter_map(|point| point.id).collect::<Vec<_>>(),
        Shape2::Circles(circles) => circles.iter().filter_map(|circle| circle.id).collect(),
        _ => vec![],
    });
    ids.collect()
}

fn circles(scene: &Scene2, tone: Tone) -> Vec<([f64; 2], f64)> {
    let layer = scene.layers.iter().find(|layer| layer.tone == tone);
    match layer.map(|layer| &layer.shape) {
        Some(Shape2::Circles(circles)) => circles.iter().map(|c| (c.center, c.radius)).collect(),
        _ => vec![],
    }
}

#[test]
fn each_center_has_its_circle_and_each_point_its_part() {
    let (values, found) = case(2, 41);
    let figures = drawn(&values, 2, &found);
    let scene = plane(&figures);
    assert_eq!(circles(scene, Tone::Answer), [([4.0, 0.0], 1.0), ([-4.0, 0.0], 1.0)]);
    assert_eq!(circles(scene, Tone::Bound), [([4.0, 0.0], 0.8), ([-4.0, 0.0], 0.8)]);
    assert_eq!(ids(scene, Tone::Support), [0, 1, 3]);
    assert_eq!(ids(scene, Tone::Third), [40], "left out, though of the core-set too");
    // Even points are around the first center, and have a tone of their own.
    let [first, second] = [Tone::Point, Tone::Second].map(|tone| ids(scene, tone));
    assert_eq!(first.len() + second.len(), 37);
    assert!(first.iter().all(|id| id % 2 == 0) && second.iter().all(|id| id % 2 == 1));
    let crosses = scene.layers.iter().find(|layer| layer.tone == Tone::Ink).unwrap();
    assert_eq!(crosses.shape, Shape2::Crosses(vec![[4.0, 0.0], [-4.0, 0.0]]));
    assert_eq!(scene.title, "Centers of 41 points, k = 2, d = 2");
    for part in ["relative gap 2.5e-1, as", "One point is left out", "All 41 points are drawn"] {
        assert!(scene.caption.contains(part), "{part} in {}", scene.caption);
    }
    assert!(!scene.caption.contains("does not fit"), "{}", scene.caption);
    assert_eq!(figures.len(), 1, "no history, no plots");
}

#[test]
fn many_points_are_thinned_but_for_those_that_matter() {
    let (values, found) = case(2, 5001);
    let points = Points::new(&values, 2).unwrap();
    let options = DrawOptions { max_points: 200, ..Default::default() };
    let figures = centers_figures(&found, &points, &options).unwrap();
    let scene = plane(&figures);
    assert_eq!(ids(scene, Tone::Support), [0, 1, 3]);
    assert_eq!(ids(scene, Tone::Third), [5000]);
    let others = [Tone::Point, Tone::Second].map(|tone| ids(scene, tone).len());
    assert_eq!(others.iter().sum::<usize>(), 196);
    assert!(scene.caption.contains("200 of 5001 points are drawn"), "{}", scene.caption);
}

#[test]
fn a_point_outside_all_balls_is_told() {
    let (values, mut found) = case(2, 41);
    found.answer.outliers.clear();
    let figures = drawn(&values, 2, &found);
    assert!(plane(&figures).caption.contains("1 point reaches outside the balls"));
}

#[test]
fn a_line_has_intervals_space_spheres_and_more_dimensions_shadows() {
    let (values, found) = case(1, 41);
    let figures = drawn(&values, 1, &found);
    let answer = plane(&figures).layers.iter().find(|layer| layer.tone == Tone::Answer).unwrap();
    let Shape2::Polygons(bands) = &answer.shape else { panic!("{answer:?}") };
    assert_eq!([bands[0][0][0], bands[0][1][0], bands[1][0][0]], [3.0, 5.0, -5.0]);

    let (values, found) = case(3, 41);
    let figures = drawn(&values, 3, &found);
    let Figure::Space(scene) = &figures[0] else { panic!("no space") };
    let Shape3::Spheres(spheres) = &scene.layers[0].shape else { panic!("no spheres") };
    assert_eq!(spheres.len(), 2);
    assert_eq!((spheres[1].center, spheres[1].radius), ([-4.0, 0.0, 0.0], 1.0));

    let (values, found) = case(5, 41);
    let figures = drawn(&values, 5, &found);
    // The centers spread along the first axis, and the items turn the view from it a little: they are nearly 8 apart.
    let shadows = circles(plane(&figures), Tone::Answer);
    assert!(((shadows[0].0[0] - shadows[1].0[0]).abs() - 8.0).abs() < 1e-6, "{shadows:?}");
    let Figure::Plot(Plot { bars, .. }) = &figures[1] else { panic!("no plot") };
    assert_eq!(bars.iter().map(|bar| bar.height).sum::<f64>(), 40.0);
}

#[test]
fn weights_have_no_circles_and_balls_are_drawn_as_such() {
    let (plain, mut found) = case(2, 41);
    let with = |last: f64| -> Vec<f64> {
        plain.chunks_exact(2).flat_map(|row| [row[0], row[1], last]).collect()
    };
    found.certificate.weights = true;
    let figures = drawn(&with(1.0), 3, &found);
    assert!(circles(plane(&figures), Tone::Answer).is_empty());
    let others = [Tone::Point, Tone::Second].map(|tone| ids(plane(&figures), tone).len());
    assert_eq!(others.iter().sum::<usize>(), 37);
    assert!(plane(&figures).caption.contains("times the weight"));
    found.certificate.weights = false;
    found.certificate.items = Items::Balls;
    found.answer.radius = 1.25;
    let figures = drawn(&with(0.25), 3, &found);
    assert!(circles(plane(&figures), Tone::Point).iter().all(|&(_, radius)| radius == 0.25));
    assert!(!plane(&figures).caption.contains("does not fit"));
    assert_eq!(plane(&figures).title, "Centers of 41 balls, k = 2, d = 2");
}

#[test]
fn the_elbow_shows_both_bounds_in_the_order_of_k() {
    let step = |k, radius, lower_bound| ElbowStep { k, radius, lower_bound };
    let steps = [step(3, 1.0, 0.9), step(1, 4.0, 4.0), step(2, 2.0, 1.5)];
    let figure = elbow_figure(&steps, &DrawOptions::default()).unwrap();
    let Figure::Plot(plot) = &figure else { panic!("no plot") };
    assert_eq!(plot.series[0].points, [[1.0, 4.0], [2.0, 2.0], [3.0, 1.0]]);
    assert_eq!(plot.series[1].points, [[1.0, 4.0], [2.0, 1.5], [3.0, 0.9]]);
    assert!(plot.title.ends_with("k = 1 to 3"));
    assert!(!to_svg(&figure, &Style::default()).contains("NaN"));
    let wrong = elbow_figure(&[step(1, f64::NAN, 0.0)], &DrawOptions::default()).unwrap_err();
    assert!(wrong.to_string().contains("a radius is NaN"), "{wrong}");
}

#[test]
fn what_does_not_fit_is_refused_by_name() {
    let (values, found) = case(2, 41);
    let refused = |change: fn(&mut Solution<Centers>)| {
        let mut found = found.clone();
        change(&mut found);
        let points = Points::new(&values, 2).unwrap();
        centers_figures(&found, &points, &DrawOptions::default()).unwrap_err()
    };
    assert!(matches!(refused(|f| f.answer.centers.clear()), Error::Mismatch { .. }));
    assert!(matches!(refused(|f| f.answer.centers[1].push(0.0)), Error::Mismatch { .. }));
    assert!(matches!(refused(|f| f.certificate.core_set.push(41)), Error::Mismatch { .. }));
    assert!(matches!(refused(|f| f.answer.outliers.push(u64::MAX)), Error::Mismatch { .. }));
    assert!(matches!(refused(|f| f.answer.centers[0][0] = f64::NAN), Error::NonFinite { .. }));
    assert!(matches!(refused(|f| f.answer.radius = f64::INFINITY), Error::NonFinite { .. }));
    assert!(matches!(refused(|f| f.answer.radius = -1.0), Error::NegativeRadius { .. }));
    assert!(matches!(refused(|f| f.certificate.items = Items::Balls), Error::Mismatch { .. }));
}
