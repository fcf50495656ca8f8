//! Tests what pictures of balls must hold: every mark, finite numbers, honest counts, escaped words, the same bytes again.

use proptest::prelude::*;
use roxmltree::{Document, Node};
use taut_certify::{Ball, BallCertificate, Items, PassBounds, Solution, Trace};
use taut_draw::{
    DrawOptions, Error, Field, Figure, Page, Section, Shape2, Style, Theme, ball_figures, to_html,
    to_svg,
};
use taut_points::{Distribution, Monitor, Points, generate, hash_points};

/// A solution written by hand, so that these tests depend on no solver.
fn solution(
    points: &Points<'_, f64>,
    ball: Ball,
    support: &[(u64, f64)],
    items: Items,
) -> Solution<Ball> {
    Solution {
        answer: ball,
        certificate: BallCertificate {
            items,
            support: support.iter().map(|s| s.0).collect(),
            multipliers: support.iter().map(|s| s.1).collect(),
            directions: vec![],
            gap: 1e-3,
            points_hash: hash_points(points, &Monitor::silent()).unwrap(),
        },
        trace: Trace {
            history: vec![
                PassBounds { lower: 0.0, upper: 2.0, working_set: 1 },
                PassBounds { lower: 0.9, upper: 1.1, working_set: 2 },
                PassBounds { lower: 1.0, upper: 1.0, working_set: 3 },
            ],
            ..Trace::default()
        },
    }
}

fn ball(center: &[f64], radius: f64) -> Ball {
    Ball { center: center.to_vec(), center_tail: vec![], radius }
}

/// `n` points in the unit ball, the first two of them opposite on its boundary.
fn inside(n: usize, dim: usize) -> Vec<f64> {
    let mut values: Vec<f64> = generate(Distribution::Normal, n, dim, 7).unwrap();
    for row in values.chunks_exact_mut(dim) {
        let norm = row.iter().map(|v| v * v).sum::<f64>().sqrt();
        let scale = 0.95 / norm.max(1.0);
        row.iter_mut().for_each(|v| *v *= scale);
    }
    values[..2 * dim].fill(0.0);
    values[0] = 1.0;
    values[dim] = -1.0;
    values
}

fn unit_ball(n: usize, dim: usize) -> (Vec<f64>, Solution<Ball>) {
    let values = inside(n, dim);
    let points = Points::new(&values, dim).unwrap();
    let found = solution(&points, ball(&vec![0.0; dim], 1.0), &[(0, 0.5), (1, 0.5)], Items::Points);
    (values, found)
}

/// Parses the document and checks that no number in it is NaN, infinite or absurd, and that the view box is sound.
fn check(svg: &str) -> Document<'_> {
    let document = Document::parse(svg).unwrap();
    let numbers = |text: &str| -> Vec<f64> {
        text.split(|c: char| !(c.is_ascii_digit() || c == '.' || c == '-'))
            .filter(|t| !t.is_empty() && *t != "-")
            .map(|t| t.parse().unwrap())
            .collect()
    };
    for node in document.descendants() {
        for attribute in node.attributes() {
            if [
                "cx",
                "cy",
                "r",
                "rx",
                "ry",
                "x",
                "y",
                "x1",
                "x2",
                "y1",
                "y2",
                "d",
                "width",
                "height",
                "viewBox",
                "transform",
            ]
            .contains(&attribute.name())
            {
                let value = attribute.value();
                assert!(
                    !value.contains("NaN") && !value.contains("inf") && !value.contains('e')
                        || attribute.name() == "transform",
                    "{value}"
                );
                assert!(numbers(value).iter().all(|v| v.abs() <= 20_000.0), "{value}");
            }
        }
    }
    let view = numbers(document.root_element().attribute("viewBox").unwrap());
    assert!(view[2] >= 160.0 && view[3] >= 100.0, "{view:?}");
    document
}

fn circles(document: &Document<'_>, class: &str) -> usize {
    let of_class = |node: &Node<'_, '_>| {
        node.attribute("class").is_some_and(|c| c.split(' ').any(|c| c == class))
            && node.attribute("data-layer") == Some("points")
    };
    let groups = document.descendants().filter(of_class);
    groups.map(|g| g.children().filter(|c| c.has_tag_name("circle")).count()).sum()
}

fn figures(
    values: &[f64],
    columns: usize,
    found: &Solution<Ball>,
    options: &DrawOptions,
) -> Vec<Figure> {
    ball_figures(found, &Points::new(values, columns).unwrap(), options).unwrap()
}

#[test]
fn the_plane_shows_every_point_once_and_the_support_marked() {
    let (values, found) = unit_ball(50, 2);
    let figures = figures(&values, 2, &found, &DrawOptions::default());
    assert!(matches!(figures[..], [Figure::Plane(_), Figure::Plot(_), Figure::Plot(_)]));
    let svg = to_svg(&figures[0], &Style::default());
    let document = check(&svg);
    assert_eq!(circles(&document, "f-point"), 48);
    assert_eq!(circles(&document, "f-support"), 2);
    let titles: Vec<_> = document
        .descendants()
        .filter(|n| n.has_tag_name("title"))
        .filter_map(|n| n.text())
        .collect();
    assert!(titles.contains(&"point 0: x = 1, y = 0; support, multiplier 0.5"), "{titles:?}");
    assert!(figures[0].caption().contains("All 50 points are drawn."));
    // The ball itself: one circle, round.
    let answer =
        document.descendants().find(|n| n.attribute("data-layer") == Some("circles")).unwrap();
    assert_eq!(answer.children().filter(|c| c.has_tag_name("circle")).count(), 1);
}

#[test]
fn each_dimension_has_its_figures() {
    for (dim, wanted) in [(1, "P.."), (2, "P.."), (3, "S.."), (4, "P..."), (40, "P...")] {
        let (values, found) = unit_ball(30, dim);
        let figures = figures(&values, dim, &found, &DrawOptions::default());
        let kinds: String = figures
            .iter()
            .map(|f| match f {
                Figure::Plane(_) => 'P',
                Figure::Space(_) => 'S',
                Figure::Plot(_) | Figure::Views(_) => '.',
            })
            .collect();
        assert_eq!(kinds, wanted, "d = {dim}");
        for figure in &figures {
            check(&to_svg(figure, &Style { theme: Theme::Dark }));
        }
    }
}

#[test]
fn every_distance_is_in_the_histogram_and_the_gap_of_zero_is_shown() {
    let (values, found) = unit_ball(500, 6);
    let figures = figures(&values, 6, &found, &DrawOptions::default());
    let Figure::Plot(distances) = &figures[1] else { panic!() };
    assert_eq!(distances.bars.iter().map(|b| b.height).sum::<f64>(), 500.0);
    assert_eq!(distances.series[0].points.len(), 2);
    assert!(distances.caption.starts_with("2 of 500 points"), "{}", distances.caption);
    let Figure::Plot(gap) = &figures[3] else { panic!() };
    // The first pass has no lower bound; the last has a gap of 0, an open mark at the edge.
    assert_eq!(gap.series[0].points.len(), 2);
    assert!(gap.caption.contains("The first pass had no lower bound yet."));
    let svg = to_svg(&figures[3], &Style::default());
    let document = check(&svg);
    let zeros =
        document.descendants().find(|n| n.attribute("data-layer") == Some("zeros")).unwrap();
    assert_eq!(zeros.children().filter(|c| c.has_tag_name("circle")).count(), 1);
}

#[test]
fn thinning_keeps_the_support_and_says_how_many() {
    for dim in [2, 3, 7] {
        let (values, found) = unit_ball(5000, dim);
        let options = DrawOptions { max_points: 300, ..Default::default() };
        let figures = figures(&values, dim, &found, &options);
        assert!(
            figures[0].caption().contains("300 of 5000 points are drawn"),
            "{}",
            figures[0].caption()
        );
        let drawn = match &figures[0] {
            Figure::Plane(_) => {
                let svg = to_svg(&figures[0], &Style::default());
                let document = check(&svg);
                [circles(&document, "f-point"), circles(&document, "f-support")]
            }
            Figure::Space(scene) => {
                let marks = |tone| {
                    let of = |l: &&taut_draw::Layer3| l.tone == tone && !l.name.is_empty();
                    let layer = scene.layers.iter().find(of).unwrap();
                    let taut_draw::Shape3::Points(points) = &layer.shape else { panic!() };
                    points.len()
                };
                [marks(taut_draw::Tone::Point), marks(taut_draw::Tone::Support)]
            }
            Figure::Plot(_) | Figure::Views(_) => panic!(),
        };
        assert_eq!(drawn, [298, 2], "d = {dim}");
    }
    // The same choice again, and the same bytes.
    let (values, found) = unit_ball(5000, 4);
    let options = DrawOptions { max_points: 300, ..Default::default() };
    let [first, second] = [0, 1].map(|_| figures(&values, 4, &found, &options));
    assert_eq!(first, second);
    assert_eq!(
        to_svg(&first[0], &Style::default()).as_bytes(),
        to_svg(&second[0], &Style::default()).as_bytes()
    );
    // More support than room: all of it is drawn, and nothing else.
    let (values, found) = unit_ball(100, 2);
    let figures = figures(&values, 2, &found, &DrawOptions { max_points: 1, ..Default::default() });
    assert!(figures[0].caption().contains(" of 100 points are drawn"));
    let svg = to_svg(&figures[0], &Style::default());
    assert_eq!(circles(&check(&svg), "f-support"), 2);
}

#[test]
fn balls_of_the_input_are_drawn_with_their_radii() {
    for dim in [1, 2, 3, 5] {
        let mut values = Vec::new();
        for (x, r) in [(-3.0, 1.0), (2.0, 2.0), (0.0, 0.5)] {
            let mut row = vec![0.0; dim + 1];
            (row[0], row[dim]) = (x, r);
            values.extend(row);
        }
        let points = Points::new(&values, dim + 1).unwrap();
        let found =
            solution(&points, ball(&vec![0.0; dim], 4.0), &[(0, 0.5), (1, 0.5)], Items::Balls);
        let figures = figures(&values, dim + 1, &found, &DrawOptions::default());
        for figure in &figures {
            check(&to_svg(figure, &Style::default()));
        }
        assert!(figures[0].title().contains("3 balls"), "{}", figures[0].title());
        if let Figure::Space(scene) = &figures[0] {
            let radii: Vec<f64> = (scene.layers.iter())
                .filter_map(|l| match &l.shape {
                    taut_draw::Shape3::Spheres(s) => Some(s.iter().map(|s| s.radius)),
                    _ => None,
                })
                .flatten()
                .collect();
            assert_eq!(radii, [4.0, 0.5, 1.0, 2.0]);
        }
    }
}

#[test]
fn words_from_outside_stay_words() {
    let evil = "</script><img src=x onerror=alert(1)>\"'&\u{0}";
    for dim in [2, 3] {
        let (values, found) = unit_ball(5, dim);
        let options = DrawOptions { columns: vec![evil.into(); dim], ..Default::default() };
        let figures = figures(&values, dim, &found, &options);
        check(&to_svg(&figures[0], &Style::default()));
        let page = Page {
            title: evil.into(),
            intro: evil.into(),
            footer: evil.into(),
            sections: vec![Section {
                heading: evil.into(),
                text: evil.into(),
                command: evil.into(),
                fields: vec![Field::new(evil, evil)],
                figures,
            }],
        };
        let html = to_html(&page);
        assert!(!html.contains("<img"), "markup came through");
        assert_eq!(html.matches("<script").count(), html.matches("</script>").count());
        assert!(
            !html.contains("http:")
                || !html.replace("http://www.w3.org/2000/svg", "").contains("http:")
        );
    }
}

#[test]
fn one_section_for_each_and_figures_in_their_place() {
    let (values, found) = unit_ball(20, 3);
    let figures = figures(&values, 3, &found, &DrawOptions::default());
    let page = Page {
        title: "Balls".into(),
        sections: vec![Section { heading: "One".into(), figures, ..Default::default() }],
        ..Default::default()
    };
    let html = to_html(&page);
    assert_eq!(html.matches("<section>").count(), 1);
    assert_eq!(html.matches("<figure class=\"space\">").count(), 1);
    assert_eq!(html.matches("<figure class=\"flat\">").count(), 2);
    assert_eq!(html.matches("<canvas").count(), 1);
    assert!(html.contains("prefers-color-scheme: dark") && html.contains("@media print"));
    assert_eq!(html, to_html(&page));
}

#[test]
fn what_does_not_fit_is_refused() {
    let (values, found) = unit_ball(5, 2);
    let points = Points::new(&values, 2).unwrap();
    let draw =
        |found: &Solution<Ball>, options: &DrawOptions| ball_figures(found, &points, options);
    let plain = DrawOptions::default();
    let mut wrong = found.clone();
    wrong.answer.center.push(0.0);
    assert!(matches!(draw(&wrong, &plain), Err(Error::Mismatch { expected: 3, found: 2, .. })));
    let mut wrong = found.clone();
    wrong.certificate.support[1] = 5;
    assert!(matches!(draw(&wrong, &plain), Err(Error::Mismatch { expected: 6, found: 5, .. })));
    let mut wrong = found.clone();
    wrong.certificate.multipliers.pop();
    assert!(matches!(draw(&wrong, &plain), Err(Error::Mismatch { .. })));
    for radius in [f64::NAN, f64::INFINITY, -1.0] {
        let mut wrong = found.clone();
        wrong.answer.radius = radius;
        assert!(draw(&wrong, &plain).is_err(), "{radius}");
    }
    for options in [
        DrawOptions { max_points: 0, ..plain.clone() },
        DrawOptions { width: f64::NAN, ..plain.clone() },
        DrawOptions { height: 1e9, ..plain.clone() },
    ] {
        assert!(matches!(draw(&found, &options), Err(Error::Option { .. })));
    }
    let holed = [1.0, 0.0, -1.0, f64::NAN];
    let answer = ball_figures(&found, &Points::new(&holed, 2).unwrap(), &plain);
    assert!(
        matches!(answer, Err(Error::NonFinite { what, .. }) if what == "coordinate 1 of point 1")
    );
    let negative = [0.0, 1.0, 2.0, -1.0];
    let mut of_balls = found.clone();
    of_balls.answer.center.pop();
    of_balls.certificate.items = Items::Balls;
    let answer = ball_figures(&of_balls, &Points::new(&negative, 2).unwrap(), &plain);
    assert!(
        matches!(answer, Err(Error::NegativeRadius { what, .. }) if what == "radius of ball 1")
    );
    let beyond = [1e308, 0.0, -1e308, 0.0];
    let mut dot = found.clone();
    (dot.answer.center, dot.answer.radius) = (vec![1e-300, 0.0], 1e-300);
    let answer = ball_figures(&dot, &Points::new(&beyond, 2).unwrap(), &plain);
    assert!(matches!(answer, Err(Error::NonFinite { .. })));
    // A ball that is too small is drawn, and the caption says so.
    let mut small = found;
    small.answer.radius = 0.99;
    assert!(draw(&small, &plain).unwrap()[0].caption().contains("2 points reach outside the ball"));
}

#[cfg(feature = "png")]
#[test]
fn png_has_its_size_its_letters_and_the_same_bytes_again() {
    let (values, found) = unit_ball(30, 3);
    for figure in figures(&values, 3, &found, &DrawOptions::default()) {
        let png = taut_draw::to_png(&figure, &Style::default(), 0.5).unwrap();
        let pixels = tiny_skia::Pixmap::decode_png(&png).unwrap();
        let svg = to_svg(&figure, &Style::default());
        let document = Document::parse(&svg).unwrap();
        let size =
            |name| -> f64 { document.root_element().attribute(name).unwrap().parse().unwrap() };
        assert_eq!(f64::from(pixels.width()), (size("width") / 2.0).ceil());
        assert_eq!(f64::from(pixels.height()), (size("height") / 2.0).ceil());
        // The title is the only thing in the top strip: dark pixels there mean that its letters were found.
        let dark = (0..18u32)
            .flat_map(|y| (0..pixels.width()).map(move |x| (x, y)))
            .filter(|&(x, y)| pixels.pixel(x, y).is_some_and(|p| p.red() < 120))
            .count();
        assert!(dark > 50, "{dark} dark pixels");
        assert_eq!(png, taut_draw::to_png(&figure, &Style::default(), 0.5).unwrap());
    }
    let figure = &figures(&values, 3, &found, &DrawOptions::default())[0];
    assert!(taut_draw::to_png(figure, &Style::default(), f32::NAN).is_err());
    let wide = DrawOptions { width: 10_000.0, height: 10_000.0, ..Default::default() };
    let figure = &figures(&values, 3, &found, &wide)[0];
    assert!(matches!(taut_draw::to_png(figure, &Style::default(), 10.0), Err(Error::Png { .. })));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    /// Scales from the smallest to the largest, offsets that swallow the spread, duplicates: always a sound document.
    #[test]
    fn any_scale_gives_a_finite_picture(
        dim in 1usize..6,
        exponent in -320i32..306,
        offset in prop_oneof![Just(0.0), -1e3..1e3, Just(1e15)],
        flat in proptest::collection::vec(-3i32..4, 6..60),
    ) {
        let scale = 10.0_f64.powi(exponent.max(-300)) * 10.0_f64.powi(exponent.min(-300) + 300);
        let offset = if exponent > 280 { 0.0 } else { offset };
        let mut values: Vec<f64> = flat.iter().map(|&v| (f64::from(v) + offset) * scale).collect();
        values.truncate(values.len() / dim * dim);
        let points = Points::new(&values, dim).unwrap();
        let center = points.row(0).to_vec();
        let spread = values.chunks(dim).flat_map(|r| r.iter().zip(&center).map(|(a, b)| (a - b).abs()));
        let radius = spread.fold(0.0_f64, f64::max) * (dim as f64).sqrt();
        let found = solution(&points, ball(&center, radius), &[(0, 1.0)], Items::Points);
        for figure in ball_figures(&found, &points, &DrawOptions::default()).unwrap() {
            check(&to_svg(&figure, &Style::default()));
            let page = Page { sections: vec![Section { figures: vec![figure], ..Default::default() }], ..Default::default() };
            prop_assert!(!to_html(&page).contains("NaN"));
        }
    }
}

/// Ellipsoids that are round, with radius ½: their shadows on any two directions are circles of that radius.
#[test]
fn a_ball_is_drawn_with_the_extent_of_its_ellipsoids() {
    for dim in [2, 4, 7] {
        let mut values = Vec::new();
        for x in [0.5, -0.5, 0.1] {
            values.extend((0..dim).map(|j| if j == 0 { x } else { 0.0 }));
            values.extend(
                (0..dim).flat_map(|j| (0..=j).map(move |k| if j == k { 0.25 } else { 0.0 })),
            );
        }
        let rows = Points::new(&values, dim + dim * (dim + 1) / 2).unwrap();
        let support = [(0, 0.5), (1, 0.5)];
        let found = solution(&rows, ball(&vec![0.0; dim], 1.0), &support, Items::Ellipsoids);
        let figures = ball_figures(&found, &rows, &DrawOptions::default()).unwrap();
        let Figure::Plane(scene) = &figures[0] else { panic!("d = {dim}") };
        let mut chains = 0;
        for layer in &scene.layers {
            let Shape2::Polygons(ellipses) = &layer.shape else { continue };
            for ellipse in ellipses {
                chains += 1;
                let count = ellipse.len() as f64;
                let middle = [0, 1].map(|k| ellipse.iter().map(|p| p[k]).sum::<f64>() / count);
                // A few roundings of numbers of order 1.
                let is_near =
                    |p: &[f64; 2]| ((p[0] - middle[0]).hypot(p[1] - middle[1]) - 0.5).abs() < 1e-12;
                assert!(ellipse.iter().all(is_near), "d = {dim}, {}", layer.name);
            }
        }
        assert_eq!(chains, 3, "d = {dim}: two of the support, and another");
    }
}
