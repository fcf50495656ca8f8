//! Tests what pictures of robust ellipsoids must hold: outliers apart, both ellipsoids, a close-up, a distance for each point.

use taut_certify::{
    Ellipsoid, EllipsoidCertificate, Enclosure, Items, RobustCertificate, RobustEllipsoid,
    RobustMethod, RobustScale, Solution, Trace,
};
use taut_draw::{
    DrawOptions, Error, Figure, Scene2, Shape2, Shape3, Style, Tone, robust_figures, to_svg,
};
use taut_points::{Distribution, Monitor, Points, generate, hash_points};

fn identity(dim: usize, scale: f64) -> Vec<Vec<f64>> {
    (0..dim).map(|j| (0..dim).map(|k| if j == k { scale } else { 0.0 }).collect()).collect()
}

/// Forty points in the unit ball, and three outliers along the diagonal at `far` half axes of the ball of radius 2.
fn case(dim: usize, method: RobustMethod, far: f64) -> (Vec<f64>, Solution<RobustEllipsoid>) {
    let mut values: Vec<f64> = generate(Distribution::Normal, 40, dim, 6).unwrap();
    for point in values.chunks_exact_mut(dim) {
        let length = point.iter().map(|v| v * v).sum::<f64>().sqrt();
        point.iter_mut().for_each(|v| *v /= length.max(1.0));
    }
    for i in 0..3 {
        values.extend(vec![2.0 * far + f64::from(i); dim]);
    }
    let hash = hash_points(&Points::new(&values, dim).unwrap(), &Monitor::silent()).unwrap();
    let ball = |radius: f64| Ellipsoid {
        center: vec![0.0; dim],
        center_tail: vec![],
        matrix: identity(dim, 1.0 / (radius * radius)),
        factor: identity(dim, 1.0 / radius),
        hull: None,
        log_volume: 0.5,
    };
    let outliers = vec![40, 41, 42];
    let certificate = EllipsoidCertificate {
        items: Items::Points,
        support: vec![0, 1],
        multipliers: vec![0.5; 2],
        directions: vec![],
        left_out: outliers.clone(),
        gap: 1e-9,
        points_hash: hash,
    };
    let enclosure = Enclosure { ellipsoid: ball(1.0), certificate };
    let Ellipsoid { center, center_tail, matrix, factor, hull, log_volume } = ball(2.0);
    let found = Solution {
        answer: RobustEllipsoid {
            center,
            center_tail,
            matrix,
            factor,
            hull,
            log_volume,
            scatter: identity(dim, 1.0),
            log_det: 0.0,
            outliers: outliers.clone(),
        },
        certificate: RobustCertificate {
            method,
            kept: 40,
            left_out: outliers.clone(),
            objective: 0.0,
            level: 0.975,
            cutoff: 4.0,
            raw_scale: 1.0,
            scale: 1.0,
            scaled_by: RobustScale::Share,
            weighed_out: outliers,
            unweighted: None,
            enclosure: (method != RobustMethod::Mcd).then_some(enclosure),
            points_hash: hash,
        },
        trace: Trace::default(),
    };
    (values, found)
}

fn drawn(values: &[f64], dim: usize, found: &Solution<RobustEllipsoid>) -> Vec<Figure> {
    let points = Points::new(values, dim).unwrap();
    let figures = robust_figures(found, &points, &DrawOptions::default()).unwrap();
    for figure in &figures {
        let text = to_svg(figure, &Style::default());
        assert!(!text.contains("NaN") && !text.contains("inf"), "d = {dim}");
    }
    figures
}

fn places(scene: &Scene2, tone: Tone) -> Vec<[f64; 2]> {
    let layers = scene.layers.iter().filter(|layer| layer.tone == tone);
    let points = layers.filter_map(|layer| match &layer.shape {
        Shape2::Points(points) => Some(points.iter().map(|point| point.at)),
        _ => None,
    });
    points.flatten().collect()
}

fn sizes(scene: &Scene2, tone: Tone) -> f64 {
    let layer = scene.layers.iter().find(|layer| layer.tone == tone).unwrap();
    match &layer.shape {
        Shape2::Points(points) => points[0].size,
        other => panic!("{other:?}"),
    }
}

#[test]
fn outliers_are_marks_of_their_own_and_near_ones_need_no_close_up() {
    let (values, found) = case(2, RobustMethod::Mcd, 1.0);
    let figures = drawn(&values, 2, &found);
    let Figure::Plane(scene) = &figures[0] else { panic!("no plane") };
    assert_eq!(places(scene, Tone::Third), [[2.0, 2.0], [3.0, 3.0], [4.0, 4.0]]);
    assert_eq!(places(scene, Tone::Point).len(), 40);
    assert!(sizes(scene, Tone::Third) > sizes(scene, Tone::Point));
    // Nothing supports the ellipsoid of mcd, and it is not compared with another.
    assert!(scene.layers.iter().all(|layer| !matches!(layer.tone, Tone::Support | Tone::Second)));
    assert_eq!(figures.len(), 2, "a close-up of what is close");
    let Figure::Plot(plot) = &figures[1] else { panic!("no plot") };
    let distances: Vec<f64> = plot.series[1].points.iter().map(|point| point[1]).collect();
    let wanted = [2.0, 3.0, 4.0].map(|x: f64| x * 2f64.sqrt() / 2.0);
    assert!(distances.iter().zip(wanted).all(|(d, w)| (d - w).abs() < 1e-12), "{distances:?}");
    // Rows are counted from 1, as in files.
    assert_eq!(plot.series[1].points[0][0], 41.0);
    assert_eq!(plot.series[0].points.len(), 40);
}

#[test]
fn a_close_up_leaves_the_far_outliers_out_and_says_so() {
    let (values, found) = case(2, RobustMethod::Mve, 100.0);
    let figures = drawn(&values, 2, &found);
    assert_eq!(figures.len(), 3);
    let Figure::Plane(near) = &figures[1] else { panic!("no plane") };
    assert!(near.title.contains("from near by"), "{}", near.title);
    assert!(near.caption.contains("3 outliers lie beyond the picture"), "{}", near.caption);
    assert!(places(near, Tone::Third).is_empty() && places(near, Tone::Point).len() == 40);
    // By mve the ellipsoid around the points kept stands beside the answer, half as wide.
    let reach = |tone: Tone| {
        let layer = near.layers.iter().find(|layer| layer.tone == tone).unwrap();
        let Shape2::Polygons(chains) = &layer.shape else { panic!("{layer:?}") };
        chains[0].iter().fold(0.0f64, |most, at| most.max(at[0]))
    };
    assert!((reach(Tone::Answer) - 2.0).abs() < 1e-9 && (reach(Tone::Second) - 1.0).abs() < 1e-9);
}

#[test]
fn by_trim_the_support_is_marked() {
    let (values, found) = case(2, RobustMethod::Trim, 1.0);
    let Figure::Plane(scene) = &drawn(&values, 2, &found)[0] else { panic!("no plane") };
    assert_eq!(places(scene, Tone::Support).len(), 2);
    assert!(scene.layers.iter().all(|layer| layer.tone != Tone::Second));
}

#[test]
fn every_dimension_has_its_picture() {
    for dim in [1, 3, 5, 9] {
        for method in RobustMethod::ALL {
            let (values, found) = case(dim, method, 2.0);
            let figures = drawn(&values, dim, &found);
            match &figures[0] {
                Figure::Plane(scene) if dim == 1 => assert_eq!(places(scene, Tone::Third).len(), 3),
                Figure::Plane(scene) => {
                    let panels = if dim == 5 { 10 } else { 15 };
                    // What reaches beyond three half-widths stands on the border of its panel.
                    assert_eq!(places(scene, Tone::Third).len(), 3 * panels, "d = {dim}");
                    assert!(scene.caption.contains("outside"), "{}", scene.caption);
                }
                Figure::Space(scene) => {
                    let layer = scene.layers.iter().find(|layer| layer.tone == Tone::Third);
                    let Shape3::Points(points) = &layer.unwrap().shape else { panic!("no points") };
                    assert_eq!(points.len(), 3);
                }
                Figure::Plot(_) | Figure::Views(_) => panic!("a plot first"),
            }
            assert!(matches!(figures.last(), Some(Figure::Plot(_))));
        }
    }
}

#[test]
fn what_does_not_belong_is_refused() {
    let (values, found) = case(3, RobustMethod::Mve, 1.0);
    let points = |dim: usize| Points::new(&values[..dim * 36], dim).unwrap();
    let options = DrawOptions::default();
    let refused = |found: &Solution<RobustEllipsoid>, dim: usize| {
        robust_figures(found, &points(dim), &options).unwrap_err()
    };
    assert!(matches!(refused(&found, 2), Error::Mismatch { .. }));
    assert!(matches!(refused(&found, 3), Error::Mismatch { what: "number of points", .. }));
    let (values, mut found) = case(3, RobustMethod::Mve, 1.0);
    let points = Points::new(&values, 3).unwrap();
    found.certificate.enclosure.as_mut().unwrap().ellipsoid.factor.pop();
    assert!(matches!(robust_figures(&found, &points, &options), Err(Error::Mismatch { .. })));
    found.certificate.enclosure = None;
    found.answer.center[0] = f64::NAN;
    assert!(matches!(robust_figures(&found, &points, &options), Err(Error::NonFinite { .. })));
}
