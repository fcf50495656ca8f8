//! Tests what pictures of surfaces must hold: what is near hides what is far, backs have a tint of their own, no triangle is missing, and
//! any numbers give the same finite picture again.

use roxmltree::Document;
use taut_draw::{
    DrawOptions, Error, Figure, Layer3, Page, Projection, Scene3, Section, Shape3, Style, Surface3,
    SurfaceView, Theme, UnusedPoints, Views, surface_scene, to_html, to_svg,
};
use taut_points::Points;

/// The corners of a cube: bit k of the row is coordinate k.
fn cube() -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let corners = (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2 & 1].map(f64::from)).collect();
    let triangles = vec![
        // Left, right, front, rear, bottom, top.
        [0, 4, 6],
        [0, 6, 2],
        [1, 3, 7],
        [1, 7, 5],
        [0, 1, 5],
        [0, 5, 4],
        [2, 6, 7],
        [2, 7, 3],
        [0, 2, 3],
        [0, 3, 1],
        [4, 5, 7],
        [4, 7, 6],
    ];
    (corners, triangles)
}

/// A sphere of 2·n² − 2·n triangles.
fn sphere(n: u32) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let turn = |i: u32, of: f64| (f64::from(i) / f64::from(n) * of).sin_cos();
    let mut corners = vec![[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
    for i in 1..n {
        let (s, c) = turn(i, std::f64::consts::PI);
        for j in 0..n {
            let (sin, cos) = turn(j, std::f64::consts::TAU);
            corners.push([s * cos, s * sin, c]);
        }
    }
    let at = |i: u32, j: u32| 2 + (i - 1) * n + j % n;
    let mut triangles = Vec::new();
    for j in 0..n {
        triangles.push([0, at(1, j), at(1, j + 1)]);
        triangles.push([1, at(n - 1, j + 1), at(n - 1, j)]);
        for i in 1..n - 1 {
            triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    (corners, triangles)
}

fn flipped(triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    triangles.iter().map(|&[a, b, c]| [a, c, b]).collect()
}

fn figures(corners: &[[f64; 3]], triangles: &[[u32; 3]]) -> Vec<Figure> {
    let points = Points::new(corners.as_flattened(), 3).unwrap();
    let view = SurfaceView { points: &points, moved: &[], triangles, unused: &[], remarks: "" };
    surface_scene(&view, &DrawOptions::default()).unwrap()
}

/// The scene seen along the second axis.
fn from_the_front(figures: &[Figure]) -> Figure {
    let Figure::Space(scene) = &figures[0] else { panic!("a scene of space") };
    let mut scene = scene.clone();
    (scene.azimuth, scene.elevation) = (-90.0, 0.0);
    scene.projection = Projection::Orthographic;
    Figure::Space(scene)
}

/// Fills and corners of the polygons of the surface, from back to front.
fn polygons(svg: &str) -> Vec<([u8; 3], Vec<[f64; 2]>)> {
    let document = Document::parse(svg).unwrap();
    let surface = document.descendants().filter(|n| n.attribute("class") == Some("surface"));
    let paths = surface.flat_map(|group| group.children()).filter(|n| n.has_tag_name("path"));
    paths
        .map(|path| {
            let fill = path.attribute("fill").unwrap();
            let channel = |k: usize| u8::from_str_radix(&fill[1 + 2 * k..3 + 2 * k], 16).unwrap();
            let places = path.attribute("d").unwrap().trim_matches(['M', 'Z']).split('L');
            let place = |text: &str| {
                let (x, y) = text.split_once(' ').unwrap();
                [x.parse().unwrap(), y.parse().unwrap()]
            };
            ([0, 1, 2].map(channel), places.map(place).collect())
        })
        .collect()
}

fn blue([r, _, b]: [u8; 3]) -> bool {
    b > r
}

fn bounds(polygons: &[([u8; 3], Vec<[f64; 2]>)]) -> [f64; 4] {
    polygons.iter().flat_map(|(_, places)| places).fold(
        [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY],
        |[a, b, c, d], &[x, y]| [a.min(x), b.min(y), c.max(x), d.max(y)],
    )
}

#[test]
fn of_a_cube_from_the_front_the_front_is_seen_and_nothing_else() {
    let (corners, triangles) = cube();
    let drawn = figures(&corners, &triangles);
    assert_eq!(drawn[0].caption(), "12 triangles with 8 vertices; no boundary.");
    let front = polygons(&to_svg(&from_the_front(&drawn), &Style::default()));
    assert_eq!(front.len(), 2);
    let [left, top, right, bottom] = bounds(&front);
    assert!((right - left - (bottom - top)).abs() < 0.05 && right - left > 100.0);
    assert!(front.iter().all(|(fill, _)| blue(*fill)));
    // On the sheet: two triangles each from front, side and top, six from between.
    assert_eq!(polygons(&to_svg(&drawn[1], &Style::default())).len(), 12);
}

#[test]
fn backs_have_another_tint() {
    let (corners, triangles) = cube();
    let turned = figures(&corners, &flipped(&triangles));
    let front = polygons(&to_svg(&from_the_front(&turned), &Style::default()));
    assert!(front.len() == 2 && front.iter().all(|(fill, _)| !blue(*fill)));
    // Without its front the cube shows the inside of its rear, and a boundary.
    let open: Vec<_> =
        triangles.iter().copied().filter(|t| !matches!(t, [0, 1, 5] | [0, 5, 4])).collect();
    let drawn = figures(&corners, &open);
    assert_eq!(drawn[0].caption(), "10 triangles with 8 vertices; 1 boundary loop of 4 edges.");
    let inside = polygons(&to_svg(&from_the_front(&drawn), &Style::default()));
    assert!(inside.len() == 2 && inside.iter().all(|(fill, _)| !blue(*fill)));
}

#[test]
fn the_nearer_of_two_triangles_is_painted_last() {
    let corners: Vec<[f64; 3]> = [0.0, 1.0]
        .iter()
        .flat_map(|&y| [[-1.0, y, -1.0], [1.0, y, -1.0], [0.0, y, 1.0]])
        .chain([[3.0, 0.0, 0.0]])
        .collect();
    for (order, nearer) in [([[0, 1, 2], [3, 5, 4]], true), ([[3, 5, 4], [0, 1, 2]], true)] {
        let svg = to_svg(&from_the_front(&figures(&corners, &order)), &Style::default());
        // The rear one has the same outline, so it is not seen at all.
        let seen = polygons(&svg);
        assert_eq!(seen.len(), 1);
        assert_eq!(blue(seen[0].0), nearer);
    }
    // Shifted, the rear one, which shows its back, is seen beside the other and painted first.
    let mut shifted = corners;
    shifted[3..6].iter_mut().for_each(|at| at[0] += 0.5);
    for order in [[[0, 1, 2], [3, 5, 4]], [[3, 5, 4], [0, 1, 2]]] {
        let svg = to_svg(&from_the_front(&figures(&shifted, &order)), &Style::default());
        let tints: Vec<bool> = polygons(&svg).iter().map(|(fill, _)| blue(*fill)).collect();
        assert_eq!(tints, [false, true]);
    }
}

#[test]
fn triangles_without_an_order_become_an_image() {
    // Two that pierce each other in the middle.
    let corners = [
        [-1.0, -1.0, -1.0],
        [1.0, 1.0, -1.0],
        [0.0, 0.0, 1.0],
        [-1.0, 1.0, -0.9],
        [1.0, -1.0, -0.9],
        [0.0, 0.0, 1.1],
    ];
    let svg =
        to_svg(&from_the_front(&figures(&corners, &[[0, 1, 2], [3, 4, 5]])), &Style::default());
    assert!(polygons(&svg).is_empty() && svg.contains("href=\"data:image/png;base64,"));
    Document::parse(&svg).unwrap();
}

#[test]
fn boundary_and_unused_points_are_pale_where_they_are_hidden() {
    let (corners, triangles) = cube();
    let open: Vec<_> =
        triangles.iter().copied().filter(|t| !matches!(t, [2, 6, 7] | [2, 7, 3])).collect();
    let mut points = corners;
    points.extend([[0.5, 0.5, 0.5], [0.5, -2.0, 0.5]]);
    let source = Points::new(points.as_flattened(), 3).unwrap();
    let unused = [UnusedPoints { name: "outliers", rows: &[8, 9] }];
    let view = SurfaceView {
        points: &source,
        moved: &[],
        triangles: &open,
        unused: &unused,
        remarks: "Genus 0.",
    };
    let drawn = surface_scene(&view, &DrawOptions::default()).unwrap();
    assert_eq!(
        drawn[0].caption(),
        "10 triangles with 8 vertices; 1 boundary loop of 4 edges. On no triangle: 2 outliers. Genus 0."
    );
    // From the right and above: of the open rear the upper and the right edge are on the rim.
    let svg = to_svg(&drawn[0], &Style::default());
    let document = Document::parse(&svg).unwrap();
    let marks = |hidden: bool| {
        let group = |n: &roxmltree::Node<'_, '_>| {
            n.attribute("opacity").is_some_and(|o| (o == "0.2") == hidden)
        };
        let nodes = || document.descendants().filter(group).flat_map(|n| n.descendants());
        let discs = nodes().filter(|n| n.has_tag_name("circle")).count();
        let lines = nodes().filter(|n| n.attribute("class") == Some("s-support")).count();
        [discs, lines]
    };
    assert_eq!(marks(true)[0], 1);
    assert_eq!(marks(false)[0], 1);
    assert!(marks(true)[1] >= 2 && marks(false)[1] >= 2);
}

#[test]
fn many_triangles_are_one_image_and_none_is_left_out() {
    let (corners, triangles) = sphere(60);
    assert!(triangles.len() > 4000);
    let options = DrawOptions { max_points: 10, ..Default::default() };
    let points = Points::new(corners.as_flattened(), 3).unwrap();
    let view = SurfaceView {
        points: &points,
        moved: &[],
        triangles: &triangles,
        unused: &[],
        remarks: "",
    };
    let drawn = surface_scene(&view, &options).unwrap();
    assert!(drawn[0].caption().starts_with("7080 triangles with 3542 vertices; no boundary."));
    let svg = to_svg(&drawn[1], &Style::default());
    assert_eq!(svg.matches("<image").count(), 4);
    assert_eq!(svg, to_svg(&drawn[1], &Style::default()));
    let html = to_html(&Page {
        sections: vec![Section { figures: drawn, ..Default::default() }],
        ..Default::default()
    });
    // One to turn and four fixed views of the same data.
    assert_eq!(html.matches("<canvas").count(), 5);
    // Where no script runs there is one small image.
    let (_, rest) = html.split_once("<noscript>").unwrap();
    let (still, _) = rest.split_once("</noscript>").unwrap();
    assert!(still.contains("<image") && still.len() < 150_000, "{}", still.len());
    assert_eq!(html.matches("<image").count(), 1);
    assert_eq!(
        html.replace("http://www.w3.org/2000/svg", "").matches("http").count(),
        1,
        "http-equiv"
    );
    // Three whole numbers of four bytes a triangle, in base64.
    let (_, rest) = html.split_once("\"triangles\":\"").unwrap();
    let (numbers, _) = rest.split_once('"').unwrap();
    assert_eq!(numbers.len(), (12 * triangles.len()).div_ceil(3) * 4);
}

#[test]
fn little_is_drawn_too() {
    for (corners, triangles, caption) in [
        (vec![], vec![], "There are no triangles."),
        (vec![[1.0; 3]], vec![], "There are no triangles."),
        (
            vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
            vec![[0, 1, 2]],
            "1 triangle with 3 vertices; 1 boundary loop of 3 edges.",
        ),
        // Corners on a line, at one place, of one row.
        (
            vec![[0.0; 3], [1.0; 3], [2.0; 3]],
            vec![[0, 1, 2]],
            "1 triangle with 3 vertices; 1 boundary loop of 3 edges.",
        ),
        (
            vec![[5.0; 3]; 3],
            vec![[0, 1, 2]],
            "1 triangle with 3 vertices; 1 boundary loop of 3 edges.",
        ),
        (vec![[5.0; 3]], vec![[0, 0, 0]], "1 triangle with 1 vertex; no boundary."),
    ] {
        for figure in figures(&corners, &triangles) {
            assert_eq!(figure.caption(), caption);
            let svg = to_svg(&figure, &Style { theme: Theme::Dark });
            Document::parse(&svg).unwrap();
            assert!(!svg.contains("NaN") && !svg.contains("inf\""));
        }
    }
}

#[test]
fn scale_changes_nothing_and_numbers_of_all_sizes_are_drawn() {
    let (corners, triangles) = cube();
    let plain = to_svg(&figures(&corners, &triangles)[1], &Style::default());
    for power in [-500, 500] {
        let scale = 2.0_f64.powi(power);
        let scaled: Vec<_> = corners.iter().map(|p| p.map(|x| x * scale)).collect();
        assert_eq!(to_svg(&figures(&scaled, &triangles)[1], &Style::default()), plain);
    }
    let wild = [
        [1e150, 0.0, 0.0],
        [0.0, -1e150, 1e-150],
        [1e-150, 1e-150, 0.0],
        [f64::MAX, -f64::MAX, f64::MIN_POSITIVE],
    ];
    for figure in figures(&wild, &[[0, 1, 2], [1, 3, 2], [0, 3, 1]]) {
        Document::parse(&to_svg(&figure, &Style::default())).unwrap();
        let page = Page {
            sections: vec![Section { figures: vec![figure], ..Default::default() }],
            ..Default::default()
        };
        assert!(!to_html(&page).contains("NaN"));
    }
}

#[test]
fn what_cannot_be_drawn_is_refused() {
    let (corners, triangles) = cube();
    let plain = DrawOptions::default();
    let draw = |corners: &[[f64; 3]], moved: &[[f64; 3]], triangles: &[[u32; 3]], rows: &[u32]| {
        let points = Points::new(corners.as_flattened(), 3).unwrap();
        let unused = [UnusedPoints { name: "outliers", rows }];
        surface_scene(
            &SurfaceView { points: &points, moved, triangles, unused: &unused, remarks: "" },
            &plain,
        )
    };
    for value in [f64::NAN, f64::INFINITY] {
        let mut wrong = corners.clone();
        wrong[3][1] = value;
        let refused = draw(&wrong, &[], &triangles, &[]);
        assert!(
            matches!(refused, Err(Error::NonFinite { what, .. }) if what == "coordinate 1 of point 3")
        );
        let refused = draw(&corners, &wrong, &triangles, &[]);
        assert!(
            matches!(refused, Err(Error::NonFinite { what, .. }) if what == "coordinate 1 of the place of point 3")
        );
    }
    assert!(matches!(
        draw(&corners, &[], &[[0, 1, 8]], &[]),
        Err(Error::Mismatch { expected: 9, found: 8, .. })
    ));
    assert!(matches!(
        draw(&corners, &[], &triangles, &[8]),
        Err(Error::Mismatch { expected: 9, found: 8, .. })
    ));
    assert!(matches!(
        draw(&corners, &corners[..7], &triangles, &[]),
        Err(Error::Mismatch { expected: 7, found: 8, .. })
    ));
    let flat = Points::new(&[0.0; 4], 2).unwrap();
    let view = SurfaceView { points: &flat, moved: &[], triangles: &[], unused: &[], remarks: "" };
    assert!(matches!(
        surface_scene(&view, &plain),
        Err(Error::Mismatch { expected: 3, found: 2, .. })
    ));
    let none = DrawOptions { max_points: 0, ..plain.clone() };
    assert!(matches!(surface_scene(&view, &none), Err(Error::Option { .. })));
}

#[test]
fn unused_points_are_sampled_and_counted() {
    let points: Vec<[f64; 3]> = (0..100).map(|i| [f64::from(i), 0.0, 0.0]).collect();
    let source = Points::new(points.as_flattened(), 3).unwrap();
    let rows: Vec<u32> = (0..100).collect();
    let unused = [
        UnusedPoints { name: "outliers", rows: &rows[..40] },
        UnusedPoints { name: "points inside", rows: &[] },
        UnusedPoints { name: "unreferenced points", rows: &rows[40..] },
    ];
    let view =
        SurfaceView { points: &source, moved: &[], triangles: &[], unused: &unused, remarks: "" };
    let drawn =
        surface_scene(&view, &DrawOptions { max_points: 30, ..Default::default() }).unwrap();
    assert_eq!(
        drawn[0].caption(),
        "There are no triangles. On no triangle: 40 outliers, 60 unreferenced points. 30 of these 100 points are drawn, an even sample."
    );
    let Figure::Space(scene) = &drawn[0] else { panic!("a scene of space") };
    let marks = scene.layers.iter().map(|layer| match &layer.shape {
        Shape3::Points(points) => points.len(),
        _ => panic!("points alone"),
    });
    assert_eq!((scene.layers.len(), marks.sum::<usize>()), (2, 30));
}

#[test]
fn a_figure_made_by_hand_with_wrong_triangles_is_drawn_without_them() {
    let surface = Surface3 {
        vertices: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [f64::NAN, 0.0, 0.0]],
        triangles: vec![[0, 1, 2], [0, 1, 3], [0, 1, 9]],
        back: taut_draw::Tone::Second,
        shading: taut_draw::Shading::Flat,
    };
    let layer = Layer3 {
        name: "surface".into(),
        tone: taut_draw::Tone::Answer,
        line_style: taut_draw::LineStyle::Solid,
        shape: Shape3::Surface(surface),
    };
    let scene = Scene3 {
        title: String::new(),
        caption: String::new(),
        axes: ["x", "y", "z"].map(taut_draw::Axis::named),
        layers: vec![layer],
        projection: Projection::Perspective,
        azimuth: f64::NAN,
        elevation: 30.0,
        width: 300.0,
        height: 300.0,
    };
    let views = Figure::Views(Views { scene: scene.clone(), views: Vec::new() });
    for figure in [Figure::Space(scene), views] {
        let svg = to_svg(&figure, &Style::default());
        assert!(polygons(&svg).len() <= 1 && !svg.contains("NaN"));
    }
}

#[cfg(feature = "png")]
mod pixels {
    use super::*;

    fn png(figure: &Figure, scale: f32) -> tiny_skia::Pixmap {
        let bytes = taut_draw::to_png(figure, &Style::default(), scale).unwrap();
        assert_eq!(bytes, taut_draw::to_png(figure, &Style::default(), scale).unwrap());
        tiny_skia::Pixmap::decode_png(&bytes).unwrap()
    }

    /// Returns how many pixels are rather blue, and how many rather amber.
    fn tints(pixels: &tiny_skia::Pixmap) -> [usize; 2] {
        let difference =
            |p: &tiny_skia::PremultipliedColorU8| i32::from(p.blue()) - i32::from(p.red());
        let count = |test: &dyn Fn(i32) -> bool| {
            pixels.pixels().iter().filter(|p| test(difference(p))).count()
        };
        [count(&|d| d > 40), count(&|d| d < -40)]
    }

    #[test]
    fn an_image_lies_where_polygons_do() {
        let (corners, triangles) = sphere(20);
        let drawn = from_the_front(&figures(&corners, &triangles));
        let Figure::Space(mut scene) = drawn.clone() else { panic!() };
        for layer in &mut scene.layers {
            if let Shape3::Surface(surface) = &mut layer.shape {
                surface.shading = taut_draw::Shading::Smooth;
            }
        }
        let smooth = Figure::Space(scene);
        assert!(!to_svg(&drawn, &Style::default()).contains("<image"));
        assert!(to_svg(&smooth, &Style::default()).contains("<image"));
        for &scale in crate::test_length::long_or(&[0.3, 0.6][..], &[0.3]) {
            let [polygons, image] = [&drawn, &smooth].map(|figure| tints(&png(figure, scale)));
            assert!(polygons[1] < polygons[0] / 50 && image[1] < image[0] / 50);
            let ratio = polygons[0] as f64 / image[0] as f64;
            assert!((0.93..1.07).contains(&ratio), "{scale}: {polygons:?} {image:?}");
        }
    }

    #[test]
    fn a_sphere_turned_over_has_the_tint_of_backs() {
        let (corners, triangles) = sphere(50);
        let tinted = tints(&png(&from_the_front(&figures(&corners, &flipped(&triangles))), 0.5));
        assert!(tinted[1] > 5000 && tinted[0] < tinted[1] / 20, "{tinted:?}");
    }
}
