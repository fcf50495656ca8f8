//! Tests what pictures of ellipsoids must hold: the right curve, every mark, honest counts, finite numbers.

use roxmltree::Document;
use taut_certify::{Ellipsoid, EllipsoidCertificate, Hull, Items, PassBounds, Solution, Trace};
use taut_draw::{
    DrawOptions, Error, Figure, Layer2, Layer3, Page, Scene2, Section, Shape2, Shape3, Style, Tone,
    ellipsoid_figures, to_html, to_svg,
};
use taut_points::{Distribution, Monitor, Points, generate, hash_points};

/// An answer written by hand, so that these tests depend on no solver: F about a center.
fn solution(
    values: &[f64],
    columns: usize,
    center: &[f64],
    factor: Vec<Vec<f64>>,
) -> Solution<Ellipsoid> {
    let dim = center.len();
    let points = Points::new(values, columns).unwrap();
    let entry = |j: usize, k: usize| factor.iter().map(|row| row[j] * row[k]).sum::<f64>();
    Solution {
        answer: Ellipsoid {
            center: center.to_vec(),
            center_tail: vec![],
            matrix: (0..dim).map(|j| (0..dim).map(|k| entry(j, k)).collect()).collect(),
            factor,
            hull: None,
            log_volume: 1.25,
        },
        certificate: EllipsoidCertificate {
            items: Items::Points,
            support: vec![0, 1],
            multipliers: vec![0.25, 0.75],
            directions: vec![],
            left_out: vec![],
            gap: 1e-9,
            points_hash: hash_points(&points, &Monitor::silent()).unwrap(),
        },
        trace: Trace {
            history: vec![
                PassBounds { lower: -3.0, upper: 2.0, working_set: 1 },
                PassBounds { lower: 1.25, upper: 1.25, working_set: 2 },
            ],
            ..Trace::default()
        },
    }
}

/// Points within the ellipsoid of a lower triangular factor, the first two on its border.
fn inside(n: usize, center: &[f64], factor: &[Vec<f64>]) -> Vec<f64> {
    let dim = center.len();
    let mut images = generate(Distribution::Normal, n, dim, 3).unwrap();
    for (i, y) in images.chunks_exact_mut(dim).enumerate() {
        let length = y.iter().map(|v| v * v).sum::<f64>().sqrt();
        let part = if i < 2 { 1.0 } else { 0.9 / length.max(1.0) * length };
        y.iter_mut().for_each(|v| *v *= part / length);
        for j in 0..dim {
            let known: f64 = (0..j).map(|k| factor[j][k] * y[k]).sum();
            y[j] = (y[j] - known) / factor[j][j];
        }
        y.iter_mut().zip(center).for_each(|(x, c)| *x += c);
    }
    images
}

fn triangular(dim: usize) -> Vec<Vec<f64>> {
    let entry = |j: usize, k: usize| if j == k { 0.5 + 0.25 * j as f64 } else { -0.2 };
    (0..dim).map(|j| (0..dim).map(|k| if k <= j { entry(j, k) } else { 0.0 }).collect()).collect()
}

fn case(n: usize, dim: usize) -> (Vec<f64>, Solution<Ellipsoid>) {
    let center: Vec<f64> = (0..dim).map(|j| j as f64 - 1.0).collect();
    let factor = triangular(dim);
    let values = inside(n, &center, &factor);
    let found = solution(&values, dim, &center, factor);
    (values, found)
}

fn figures(values: &[f64], columns: usize, found: &Solution<Ellipsoid>) -> Vec<Figure> {
    ellipsoid_figures(found, &Points::new(values, columns).unwrap(), &DrawOptions::default())
        .unwrap()
}

/// The document, if it is one and has no number that is none.
fn check(figure: &Figure) -> String {
    let svg = to_svg(figure, &Style::default());
    Document::parse(&svg).unwrap();
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "{}", figure.title());
    svg
}

fn plane(figure: &Figure) -> &Scene2 {
    match figure {
        Figure::Plane(scene) => scene,
        _ => panic!("{} is no scene of the plane", figure.title()),
    }
}

fn layer(scene: &Scene2, tone: Tone) -> &Layer2 {
    scene.layers.iter().find(|layer| layer.tone == tone && !layer.name.is_empty()).unwrap()
}

#[test]
fn each_dimension_has_its_figures() {
    for (dim, wanted) in [(1, "P.."), (2, "P.."), (3, "S.."), (4, "P..."), (12, "P...")] {
        let (values, found) = case(40, dim);
        let figures = figures(&values, dim, &found);
        let kinds: String = figures
            .iter()
            .map(|figure| match figure {
                Figure::Plane(_) => 'P',
                Figure::Space(_) => 'S',
                Figure::Plot(_) | Figure::Views(_) => '.',
            })
            .collect();
        assert_eq!(kinds, wanted, "d = {dim}");
        figures.iter().for_each(|figure| drop(check(figure)));
        let caption = figures[0].caption();
        assert!(
            caption.starts_with("Log-volume 1.25; gap in log-volume 1.0e-9, as the solver says"),
            "{caption}"
        );
        assert!(caption.contains("2 support points decide the ellipsoid"), "{caption}");
        assert!(!caption.contains("outside the ellipsoid"), "{caption}");
    }
}

/// Each corner of the curve lies on the border, and it reaches as far as it should along both axes.
#[test]
fn the_ellipse_is_the_border() {
    let (values, found) = case(40, 2);
    let all = figures(&values, 2, &found);
    let scene = plane(&all[0]);
    let Shape2::Polygons(chains) = &layer(scene, Tone::Answer).shape else { panic!() };
    assert_eq!(chains.len(), 1);
    for corner in &chains[0] {
        assert!((found.answer.norm(corner) - 1.0).abs() < 1e-12, "{corner:?}");
    }
    let right = chains[0].iter().fold(f64::MIN, |m, p| m.max(p[0]));
    assert!((right - (-1.0 + 2.0)).abs() < 1e-3, "{right}");
    let Shape2::Points(points) = &layer(scene, Tone::Point).shape else { panic!() };
    let Shape2::Points(support) = &layer(scene, Tone::Support).shape else { panic!() };
    assert_eq!((points.len(), support.len()), (38, 2));
    assert!(support[1].size > support[0].size);
}

#[test]
fn the_net_lies_on_the_surface() {
    let (values, found) = case(40, 3);
    let all = figures(&values, 3, &found);
    let Figure::Space(scene) = &all[0] else { panic!() };
    let of = |tone| scene.layers.iter().find(|l: &&Layer3| l.tone == tone).unwrap();
    let Shape3::Polylines(chains) = &of(Tone::Answer).shape else { panic!() };
    assert_eq!(chains.len(), 11);
    for corner in chains.iter().flatten() {
        assert!((found.answer.norm(corner) - 1.0).abs() < 1e-12, "{corner:?}");
    }
    // The ends of the longest axis are the two points of the net that lie farthest apart.
    let squared = |p: &[f64; 3]| -> f64 {
        p.iter().zip(&found.answer.center).map(|(x, c)| (x - c).powi(2)).sum()
    };
    let most = chains.iter().flatten().map(squared).fold(0.0, f64::max);
    for y in [[1.0, 0.3, 0.2], [0.2, 1.0, -0.5], [0.6, 0.6, 0.6]] {
        let border: Vec<f64> = inside_of(&y, &found.answer);
        assert!(border.iter().map(|v| v * v).sum::<f64>() <= most * (1.0 + 1e-9));
    }
}

/// The offset of the border point in the direction y.
fn inside_of(y: &[f64; 3], answer: &Ellipsoid) -> Vec<f64> {
    let point: Vec<f64> = y.iter().zip(&answer.center).map(|(y, c)| y + c).collect();
    let norm = answer.norm(&point);
    y.iter().map(|y| y / norm).collect()
}

/// The shadow on two coordinates reaches as far along each as the ellipsoid, and no point falls outside.
#[test]
fn shadows_hold_all_points() {
    for dim in [4, 7, 9] {
        let (values, found) = case(300, dim);
        let all = figures(&values, dim, &found);
        let scene = plane(&all[0]);
        let drawn = if dim <= 7 { dim } else { 6 };
        let panels = drawn * (drawn - 1) / 2;
        let Shape2::Polygons(chains) = &layer(scene, Tone::Answer).shape else { panic!() };
        assert_eq!(chains.len(), panels, "d = {dim}");
        let Shape2::Points(points) = &layer(scene, Tone::Point).shape else { panic!() };
        assert_eq!(points.len(), 298 * panels);
        for chain in chains {
            let middle = [0, 1].map(|k| {
                let (low, high) =
                    chain.iter().fold((f64::MAX, f64::MIN), |(l, h), p| (l.min(p[k]), h.max(p[k])));
                // Each shadow fills its panel.
                assert!((high - low - 0.92 / 1.12).abs() < 1e-3, "{low} to {high}");
                0.5 * (low + high)
            });
            for point in points.iter().filter(|p| (0..2).all(|k| (p.at[k] - middle[k]).abs() < 0.5))
            {
                assert!(is_within(point.at, chain), "{point:?}");
            }
        }
        assert_eq!(all[0].caption().contains("coordinates are drawn, those whose"), dim > 7);
        let Figure::Plot(reach) = &all[1] else { panic!() };
        assert_eq!(reach.bars.iter().map(|bar| bar.height).sum::<f64>(), 300.0);
        assert!(reach.caption.starts_with("2 of 300 points come within"), "{}", reach.caption);
    }
}

/// Tests whether a point lies on the inner side of all edges of a convex chain, counter-clockwise.
fn is_within(p: [f64; 2], chain: &[[f64; 2]]) -> bool {
    (0..chain.len()).all(|i| {
        let (a, b) = (chain[i], chain[(i + 1) % chain.len()]);
        (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) >= -1e-4
    })
}

#[test]
fn rows_left_out_have_their_own_marks() {
    let (mut values, mut found) = case(40, 2);
    values.extend([9.0, 9.0, -8.0, 3.0]);
    found.certificate.left_out = vec![40, 41];
    let all = figures(&values, 2, &found);
    let scene = plane(&all[0]);
    let Shape2::Points(out) = &layer(scene, Tone::Third).shape else { panic!() };
    assert_eq!(out.iter().map(|p| p.id).collect::<Vec<_>>(), [Some(40), Some(41)]);
    assert!(all[0].title().starts_with("Smallest ellipsoid around 40 points of 42"));
    let caption = all[0].caption();
    assert!(
        caption.contains("2 points are left out.") && !caption.contains("outside"),
        "{caption}"
    );
    found.certificate.left_out.clear();
    let honest = figures(&values, 2, &found);
    assert!(honest[0].caption().contains("2 points reach outside the ellipsoid"));
}

#[test]
fn flat_sets_are_drawn_flat() {
    let half = 0.5f64.sqrt();
    let segment = vec![0.0, 0.0, 2.0, 2.0, 1.0, 1.0];
    let mut found = solution(&segment, 2, &[1.0, 1.0], vec![vec![0.5, 0.5]]);
    found.answer.hull = Some(Hull { basis: vec![vec![half, half]], distance: 0.0 });
    let all = figures(&segment, 2, &found);
    let Shape2::Polylines(chains) = &layer(plane(&all[0]), Tone::Answer).shape else { panic!() };
    let ends: Vec<f64> = chains[0].iter().flatten().map(|v| (v * 1e9).round() / 1e9).collect();
    assert!(ends == [0.0, 0.0, 2.0, 2.0] || ends == [2.0, 2.0, 0.0, 0.0], "{ends:?}");
    assert!(all[0].caption().contains("All lie in a flat of dimension 1 of 2"));
    for dim in [1, 2, 3, 5] {
        let point = vec![4.0; 2 * dim];
        let mut found = solution(&point, dim, &vec![4.0; dim], vec![]);
        found.answer.hull = Some(Hull { basis: vec![], distance: 0.0 });
        let all = figures(&point, dim, &found);
        assert!(all[0].caption().contains("All lie in one point."), "{}", all[0].caption());
        all.iter().for_each(|figure| drop(check(figure)));
    }
}

/// Balls and ellipsoids as items: drawn with their extent, the marks where they touch.
#[test]
fn items_have_their_extent() {
    // Two discs of radius ½ at ±1 on the first axis, in an ellipse of half-axes 1.5 and 1.
    let factor = vec![vec![1.0 / 1.5, 0.0], vec![0.0, 1.0]];
    let balls = vec![1.0, 0.0, 0.5, -1.0, 0.0, 0.5];
    let round = vec![1.0, 0.0, 0.25, 0.0, 0.25, -1.0, 0.0, 0.25, 0.0, 0.25];
    for (items, values) in [(Items::Balls, balls), (Items::Ellipsoids, round)] {
        let columns = items.columns(2);
        let mut found = solution(&values, columns, &[0.0, 0.0], factor.clone());
        found.certificate.items = items;
        found.certificate.directions = vec![vec![2.0, 0.0], vec![-1.0, 0.0]];
        let all = figures(&values, columns, &found);
        let scene = plane(&all[0]);
        match &layer(scene, Tone::Point).shape {
            Shape2::Circles(circles) => {
                let drawn: Vec<_> = circles.iter().map(|c| (c.id, c.center, c.radius)).collect();
                assert_eq!(drawn, [(Some(0), [1.0, 0.0], 0.5), (Some(1), [-1.0, 0.0], 0.5)]);
                assert_eq!(items, Items::Balls);
            }
            Shape2::Polygons(chains) => {
                assert_eq!((chains.len(), items), (2, Items::Ellipsoids));
                assert!(chains[0].iter().all(|p| ((p[0] - 1.0).hypot(p[1]) - 0.5).abs() < 1e-12));
            }
            other => panic!("{other:?}"),
        }
        let Shape2::Points(marks) = &layer(scene, Tone::Support).shape else { panic!() };
        assert_eq!([marks[0].at, marks[1].at], [[1.5, 0.0], [-1.5, 0.0]]);
        assert!(!all[0].caption().contains("outside"), "{}", all[0].caption());
        for (dim, center) in [(3, vec![0.0; 3]), (4, vec![0.0; 4])] {
            let row: Vec<f64> = match items {
                Items::Balls => vec![0.0; dim].into_iter().chain([1.0]).collect(),
                _ => vec![0.0; dim]
                    .into_iter()
                    .chain(
                        (0..dim).flat_map(|j| (0..=j).map(move |k| if j == k { 1.0 } else { 0.0 })),
                    )
                    .collect(),
            };
            let unit =
                |j: usize| (0..dim).map(|k| if j == k { 1.0 } else { 0.0 }).collect::<Vec<f64>>();
            let mut found = solution(&row, row.len(), &center, (0..dim).map(unit).collect());
            found.certificate.items = items;
            found.certificate.support = vec![0, 0];
            found.certificate.directions = vec![unit(0), unit(1)];
            let all = figures(&row, row.len(), &found);
            all.iter().for_each(|figure| drop(check(figure)));
            assert!(!all[0].caption().contains("outside"), "{}", all[0].caption());
        }
    }
}

#[test]
fn loose_bounds_are_drawn_dashed() {
    let (values, mut found) = case(40, 2);
    found.certificate.gap = 2.0 * 2f64.ln();
    let all = figures(&values, 2, &found);
    let Shape2::Polygons(chains) = &layer(plane(&all[0]), Tone::Bound).shape else { panic!() };
    assert!(chains[0].iter().all(|p| (found.answer.norm(p) - 0.5).abs() < 1e-12));
}

#[test]
fn extreme_scales_and_strange_answers_are_drawn_or_refused() {
    for scale in [1e-150, 1e150] {
        for dim in [2, 3, 4] {
            let (values, mut found) = case(20, dim);
            let values: Vec<f64> = values.iter().map(|v| v * scale).collect();
            found.answer.center.iter_mut().for_each(|c| *c *= scale);
            found.answer.factor.iter_mut().flatten().for_each(|f| *f /= scale);
            let all = figures(&values, dim, &found);
            all.iter().for_each(|figure| drop(check(figure)));
            assert!(!all[0].caption().contains("outside"), "{}", all[0].caption());
        }
    }
    let (values, found) = case(20, 3);
    let points = Points::new(&values, 3).unwrap();
    let refused = |change: &dyn Fn(&mut Solution<Ellipsoid>)| {
        let mut found = found.clone();
        change(&mut found);
        ellipsoid_figures(&found, &points, &DrawOptions::default()).unwrap_err()
    };
    assert!(matches!(refused(&|s| s.answer.center.truncate(2)), Error::Mismatch { .. }));
    assert!(matches!(refused(&|s| s.answer.factor.truncate(2)), Error::Mismatch { .. }));
    assert!(matches!(refused(&|s| s.answer.factor[0].truncate(2)), Error::Mismatch { .. }));
    assert!(matches!(refused(&|s| s.certificate.support[0] = 99), Error::Mismatch { .. }));
    assert!(matches!(refused(&|s| s.certificate.left_out.push(99)), Error::Mismatch { .. }));
    assert!(matches!(refused(&|s| s.certificate.directions.push(vec![])), Error::Mismatch { .. }));
    assert!(matches!(refused(&|s| s.answer.factor[1][0] = f64::NAN), Error::NonFinite { .. }));
    // A singular factor has no ellipsoid, but no panic either.
    let mut singular = found.clone();
    singular.answer.factor[1] = vec![0.0; 3];
    let all = ellipsoid_figures(&singular, &points, &DrawOptions::default()).unwrap();
    all.iter().for_each(|figure| drop(check(figure)));
}

#[test]
fn a_page_is_the_same_again() {
    let (values, found) = case(60, 5);
    let page = || {
        to_html(&Page {
            title: "Ellipsoids".into(),
            sections: vec![Section { figures: figures(&values, 5, &found), ..Section::default() }],
            ..Page::default()
        })
    };
    assert_eq!(page(), page());
    assert!(page().contains("shadow of the smallest ellipsoid"));
}
