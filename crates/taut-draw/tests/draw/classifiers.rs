//! Pictures of classifiers: error rates over thresholds, and decision maps.

use taut_draw::{
    DecisionPoints, DetCurve, DrawOptions, Figure, Shape2, Style, decision_figure, det_figure,
    to_svg,
};

#[test]
fn curves_are_drawn_where_both_rates_have_a_place() {
    let curve = |name: &str, points: &[[f64; 2]]| DetCurve {
        name: name.to_owned(),
        points: points.to_vec(),
    };
    let curves = vec![
        curve("boxes", &[[1.0, 0.0], [0.2, 0.01], [0.02, 0.1], [0.0, 1.0]]),
        curve("perfect", &[[1.0, 0.0], [0.0, 0.0], [0.0, 1.0]]),
    ];
    let figure = det_figure("Rates", "Two methods.", curves, &DrawOptions::default());
    assert_eq!(figure.caption(), "Two methods. One rate is 0 at every threshold: perfect.");
    let Figure::Plot(plot) = &figure else { panic!("a plot") };
    assert_eq!(plot.series.iter().map(|s| s.points.len()).collect::<Vec<_>>(), [2, 0]);
    let svg = to_svg(&figure, &Style::default());
    // One tick has the label of 10 %.
    assert!(svg.contains("false rejection rate") && svg.contains(">10<"), "{svg}");
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
}

#[test]
fn discs_and_borders_are_where_the_classifier_has_them() {
    let points = [[-1.0, 0.0], [-1.0, 1.0], [1.0, 0.0], [1.0, 1.0]];
    let (labels, classes) = ([0, 0, 1, 1], ["left".to_owned(), "right".to_owned()]);
    let data = DecisionPoints { points: &points, labels: &labels, classes: &classes };
    // Places above 1 are rejected.
    let decide = |[x, y]: [f64; 2]| ((y <= 1.0).then_some(u32::from(x > 0.0)), x.abs());
    let figure = decision_figure(data, &decide, &DrawOptions::default()).unwrap();
    let Figure::Plane(scene) = &figure else { panic!("a plane") };
    for (layer, sign) in [(0, -1.0), (2, 1.0)] {
        let Shape2::Points(discs) = &scene.layers[layer].shape else { panic!("discs") };
        assert!(!discs.is_empty());
        assert!(discs.iter().all(|disc| disc.at[0] * sign > 0.0 && disc.at[1] <= 1.0));
        // The farther from the border, the larger.
        let largest = discs.iter().max_by(|a, b| a.size.total_cmp(&b.size)).unwrap();
        assert!(largest.at[0] * sign > 1.1, "{largest:?}");
    }
    let Shape2::Polylines(border) = &scene.layers[4].shape else { panic!("a border") };
    // 192 cells over the points and a margin of 12 % at each side.
    let cell = 2.0 * 1.24 / 192.0;
    let is_near = |p: &[f64; 2]| p[0].abs() <= cell || (p[1] - 1.0).abs() <= cell;
    assert!(border.len() > 100 && border.iter().flatten().all(is_near));
    assert!(scene.caption.contains("are rejected"), "{}", scene.caption);
    let wrong = DecisionPoints { labels: &labels[..3], ..data };
    assert!(decision_figure(wrong, &decide, &DrawOptions::default()).is_err());
    let one = DecisionPoints { points: &points[..1], labels: &labels[..1], classes: &classes };
    assert!(decision_figure(one, &decide, &DrawOptions::default()).is_ok());
}
