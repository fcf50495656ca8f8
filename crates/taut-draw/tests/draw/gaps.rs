//! One gap in all words and plots of an answer, the one that a checker proved; and ticks at each whole number of passes.

use roxmltree::Document;
use taut_certify::PassBounds;
use taut_draw::{DrawOptions, Figure, Plot, Style, ball_figures, ellipsoid_figures, to_svg};
use taut_points::Points;

const CORNERS: [f64; 8] = [0.0, 0.0, 2.0, 0.0, 0.0, 2.0, 2.0, 2.0];

/// So many passes, of which the last leaves a gap of about an eighth.
fn history(passes: u32) -> Vec<PassBounds> {
    let bounds = |pass: u32| PassBounds {
        lower: 2.0 - f64::from(1 + passes - pass) / 4.0,
        upper: 2.0,
        working_set: 3,
    };
    (1..=passes).map(bounds).collect()
}

fn plots(figures: Vec<Figure>) -> Vec<Plot> {
    let plot = |figure| match figure {
        Figure::Plot(plot) => Some(plot),
        _ => None,
    };
    figures.into_iter().filter_map(plot).collect()
}

/// The labels and the marks without one below the axis of passes.
fn passes_told(plot: Plot) -> (Vec<String>, usize) {
    let svg = to_svg(&Figure::Plot(plot), &Style::default());
    let document = Document::parse(&svg).unwrap();
    let nodes = |class: &'static str| {
        document.descendants().filter(move |node| node.attribute("class") == Some(class))
    };
    let lowest = |name| -> f64 {
        nodes("t-axis")
            .flat_map(|axes| axes.children().filter_map(|line| line.attribute(name)))
            .map(|y| y.parse::<f64>().unwrap())
            .fold(0.0, f64::max)
    };
    let (axis, end) = (lowest("y1"), lowest("y2"));
    let labels = nodes("t-tick")
        .filter(|text| text.attribute("y").unwrap().parse::<f64>().unwrap() > axis + 10.0)
        .map(|text| text.text().unwrap().to_owned())
        .collect();
    let marks = nodes("t-axis")
        .flat_map(|axes| axes.children().filter_map(|line| line.attribute("y2")))
        .filter(|y| y.parse::<f64>().unwrap() == end && end > axis)
        .count();
    (labels, marks)
}

#[test]
fn captions_and_plots_have_the_gap_that_is_proved() {
    let points = Points::new(&CORNERS, 2).unwrap();
    let mut ball = taut_enclose::ball(&points, &Default::default()).unwrap();
    ball.trace.history = history(4);
    let proved = DrawOptions { proved_gap: Some(0.0625), ..Default::default() };
    let told = ball_figures(&ball, &points, &DrawOptions::default()).unwrap();
    assert!(told[0].caption().contains("as the solver says"), "{}", told[0].caption());
    let told = plots(told);
    assert_eq!(told[0].series[1].points[3], [4.0, 1.75]);
    let drawn = ball_figures(&ball, &points, &proved).unwrap();
    let words = "relative gap 6.2e-2, proved by the checker";
    assert!(drawn[0].caption().contains(words), "{}", drawn[0].caption());
    let [bounds, gap] = &plots(drawn)[..] else { panic!("two plots") };
    assert_eq!(bounds.series[1].points[3], [4.0, 2.0 / 1.0625]);
    assert_eq!(gap.series[0].points[3], [4.0, 0.0625]);
    assert_eq!(gap.series[0].points[2][1], 2.0 / 1.5 - 1.0, "earlier passes stay");
    assert!(gap.caption.contains("The last is the gap that the checker proved."));

    let mut ellipsoid = taut_enclose::ellipsoid(&points, &Default::default()).unwrap();
    ellipsoid.trace.history = history(4);
    let [bounds, gap] = &plots(ellipsoid_figures(&ellipsoid, &points, &proved).unwrap())[..] else {
        panic!("two plots")
    };
    assert_eq!(bounds.series[1].points[3], [4.0, 1.9375]);
    assert_eq!(gap.series[0].points[3], [4.0, 0.0625]);

    // No difference of bounds has these.
    for tiny in [2.3e-16, 1.2e-15, 1e-9] {
        let proved = DrawOptions { proved_gap: Some(tiny), ..Default::default() };
        for figures in [
            ball_figures(&ball, &points, &proved).unwrap(),
            ellipsoid_figures(&ellipsoid, &points, &proved).unwrap(),
        ] {
            let [_, gap] = &plots(figures)[..] else { panic!("two plots") };
            assert_eq!(gap.series[0].points[3], [4.0, tiny]);
            assert!(!gap.caption.contains("a gap of 0"), "{}", gap.caption);
        }
    }
}

#[test]
fn each_pass_has_a_tick() {
    let points = Points::new(&CORNERS, 2).unwrap();
    let mut ball = taut_enclose::ball(&points, &Default::default()).unwrap();
    for passes in [2, 3, 6, 7, 9, 11, 12] {
        ball.trace.history = history(passes);
        for plot in plots(ball_figures(&ball, &points, &DrawOptions::default()).unwrap()) {
            let (labels, marks) = passes_told(plot);
            let all: Vec<String> = (1..=passes).map(|pass| pass.to_string()).collect();
            assert_eq!((labels, marks), (all, passes as usize));
        }
    }
    // More have labels where there is room, but still a mark each.
    ball.trace.history = history(40);
    for plot in plots(ball_figures(&ball, &points, &DrawOptions::default()).unwrap()) {
        let (labels, marks) = passes_told(plot);
        assert!(labels.len() < 12 && labels.contains(&"20".to_owned()), "{labels:?}");
        assert_eq!(marks, 40);
    }
}
