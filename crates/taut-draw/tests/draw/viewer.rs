//! The script of the page, run by node where there is one: what it draws of a surface is what the still pictures show.

use std::collections::BTreeMap;
use std::process::{Command, Stdio};

use taut_draw::{
    DrawOptions, Figure, Page, Projection, Section, SurfaceView, surface_scene, to_html,
};
use taut_points::Points;

/// A square of side 2 in the plane of the first and third axes and, behind it, one of half the size; both face the first one's front.
const CORNERS: [f64; 24] = [
    -1.0, 0.0, -1.0, 1.0, 0.0, -1.0, 1.0, 0.0, 1.0, -1.0, 0.0, 1.0, //
    -0.5, 0.5, -0.5, 0.5, 0.5, -0.5, 0.5, 0.5, 0.5, -0.5, 0.5, 0.5,
];

/// Returns what the script says it drew of two squares seen from the front; `None` where there is no node.
fn drawn(triangles: &[[u32; 3]]) -> Option<BTreeMap<String, f64>> {
    let points = Points::new(&CORNERS, 3).unwrap();
    let view = SurfaceView { points: &points, moved: &[], triangles, unused: &[], remarks: "" };
    let mut figures = surface_scene(&view, &DrawOptions::default()).unwrap();
    let Figure::Space(scene) = &mut figures[0] else { panic!("a scene of space") };
    (scene.azimuth, scene.elevation) = (-90.0, 0.0);
    scene.projection = Projection::Orthographic;
    let sections = vec![Section { figures, ..Default::default() }];
    let html = to_html(&Page { sections, ..Default::default() });
    let name = format!("taut-viewer-{}-{}.html", std::process::id(), triangles.len());
    let path = std::env::temp_dir().join(name);
    std::fs::write(&path, html).unwrap();
    let dom = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/draw/page/dom.js");
    let output = Command::new("node").arg(dom).arg(&path).stderr(Stdio::inherit()).output();
    std::fs::remove_file(&path).unwrap();
    let Ok(output) = output else {
        println!("node is not there: not tested");
        return None;
    };
    assert!(output.status.success());
    let line = |line: &str| {
        let (name, value) = line.split_once(' ').unwrap();
        (name.to_owned(), value.parse().unwrap())
    };
    Some(String::from_utf8(output.stdout).unwrap().lines().map(line).collect())
}

#[test]
fn the_page_draws_fronts_and_backs_and_what_is_hidden() {
    let front = [[0, 1, 2], [0, 2, 3]];
    let Some(one) = drawn(&front) else { return };
    // A square of half diagonal 0.94·280/740 of the width, on a sheet of 740 by 560: the squares of lengths make a part.
    let part = 2.0 * (0.47_f64 * 560.0).powi(2) / (740.0 * 560.0);
    assert!((one["rest-part"] - part).abs() < 0.02, "{one:?}, {part}");
    assert_eq!([one["rest-blue"], one["rest-pale"]], [1.0, 0.0]);
    // Its entry in the legend hides it.
    assert_eq!(one["hidden-images"], 0.0);
    // Coarse while it moves.
    assert_eq!([one["rest-width"], one["moving-width"]], [800.0, 400.0]);
    assert!((0.9..1.01).contains(&(one["moving-part"] / one["rest-part"])));

    let back = front.map(|[a, b, c]| [a, c, b]);
    assert_eq!(drawn(&[back[0], back[1], back[0]]).unwrap()["rest-blue"], 0.0);

    // The rear square faces away: nothing of it is seen, and its boundary is pale.
    let both = [front[0], front[1], [4, 6, 5], [4, 7, 6]];
    let both = drawn(&both).unwrap();
    assert_eq!(both["rest-blue"], 1.0);
    assert!(both["rest-pale"] >= 4.0, "{both:?}");
}
