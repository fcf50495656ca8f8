//! `taut draw`, `taut ball --draw` and `taut tour`.

use crate::test_folder::TestFolder;
use crate::test_length::long_or;

fn solved() -> TestFolder {
    let folder = TestFolder::new();
    folder.put("points.csv", "a,b\n0,0\n2,0\n1,0.5\n");
    folder.taut("ball points.csv --epsilon 0 -o ball.json").ends(0);
    folder
}

#[test]
fn each_kind_of_picture_is_drawn() {
    let folder = solved();
    folder.taut("draw ball.json points.csv -o ball.svg").ends(0);
    assert!(folder.text("ball.svg").starts_with("<svg"));
    if cfg!(feature = "png") {
        folder.taut("draw ball.json points.csv -o ball.png").ends(0);
        assert!(folder.bytes("ball.png").starts_with(b"\x89PNG\r\n\x1a\n"));
    }
    folder.taut("draw ball.json points.csv -o ball.html").ends(0);
    let page = folder.text("ball.html");
    for part in [
        "<!doctype html>",
        "Smallest ball around 3 points in 2 dimensions",
        "taut draw ball.json",
        "verified",
    ] {
        assert!(page.to_lowercase().contains(&part.to_lowercase()), "no {part}");
    }
}

#[test]
fn ball_draws_what_draw_draws() {
    let folder = solved();
    folder.taut("ball points.csv --epsilon 0 --draw at-once.svg").ends(0);
    folder.taut("draw ball.json points.csv -o later.svg").ends(0);
    assert_eq!(folder.text("at-once.svg"), folder.text("later.svg"));
}

#[test]
fn further_figures_and_the_dark_are_a_choice() {
    let folder = solved();
    folder.taut("draw ball.json points.csv -o 1.svg").ends(0);
    folder.taut("draw ball.json points.csv -o 2.svg --figure 2").ends(0);
    folder.taut("draw ball.json points.csv -o dark.svg --theme dark").ends(0);
    assert_ne!(folder.text("1.svg"), folder.text("2.svg"));
    assert_ne!(folder.text("1.svg"), folder.text("dark.svg"));
    folder
        .taut("draw ball.json points.csv -o 99.svg --figure 99")
        .ends(2)
        .stderr_has(&["--figure", "99"]);
    folder
        .taut("draw ball.json points.csv -o thin.svg --image-width 1")
        .ends(2)
        .stderr_has(&["--image-width"]);
}

#[test]
fn what_does_not_fit_its_points_is_not_drawn() {
    let folder = solved();
    folder.put("changed.csv", "0,0\n2,0\n1,0.25\n");
    folder.put("ball.svg", "earlier picture");
    folder
        .taut("draw ball.json changed.csv -o ball.svg")
        .ends(1)
        .stderr_has(&["changed.csv", "hash"]);
    assert_eq!(folder.text("ball.svg"), "earlier picture");
    folder.taut("draw ball.json changed.csv -o ball.svg --no-verify").ends(0);
    folder.taut("draw ball.json points.csv -o ball.gif").ends(2).stderr_has(&["ball.gif", ".svg"]);
}

#[test]
fn the_tour_shows_and_verifies_every_tool() {
    let folder = TestFolder::new();
    let run =
        folder.taut("tour --samples samples").ends(0).stdout_has(&["verified yes", "tour.html"]);
    let stations = run.out.lines().filter(|line| line.contains(" verified yes ")).count();
    assert_eq!(stations, 19, "{}", run.out);
    assert_eq!(folder.files(), ["samples", "tour.html"]);
    let page = folder.text("tour.html");
    for part in [
        "Points in the plane",
        "Points in space",
        "Many dimensions",
        "Balls around balls",
        "A hard case: the cube",
        "taut ball discs.csv --balls",
        "a millionth smaller",
        "rejected",
        "3.5355339",
        "Around them, closer",
        "a millionth flatter",
        "taut ellipsoid iris.csv",
        "An ellipsoid in space",
        "Most of the points: outliers",
        "an outlier less",
        "lacks point 149",
        "Near to all: k centers",
        "taut centers europe.csv -k 8",
        "From within: a polytope",
        "a millionth longer",
        "is crossed by",
        "an ellipse in a lake",
        "a thousandth longer",
        "bodies in a mesh",
        "a body grown",
        "Through the points",
        "Voronoi diagram of 432 points",
        "an edge turned",
        "a triangle turned over",
        "A hand, measured",
        "all thirty features within",
        "Memory hierarchy",
        "times the formula, allowed 5.5",
        "Misses of multiply",
    ] {
        assert!(page.contains(part), "no {part}");
    }
    assert_eq!(page.matches("verified</th><td>yes</td>").count(), 16);
    let mut told = [0; 4];
    for section in page.split("<section>") {
        let field = |name: &str| {
            let (_, rest) = section.split_once(&format!("\"row\">{name}</th><td>"))?;
            Some(rest.split_once("</td>").unwrap().0)
        };
        // One gap, and each number written in one way.
        for (count, (name, words)) in told.iter_mut().zip([
            ("gap", [("gap ", ", proved by"), ("gap in log-volume ", ", proved by")]),
            ("radius", [("<figcaption>Radius ", ";"); 2]),
            ("log-volume", [("<figcaption>Log-volume ", ";"); 2]),
            ("area", [("<figcaption>Area ", ";"); 2]),
        ]) {
            let Some(number) = field(name).filter(|_| !section.contains("Robust")) else {
                continue;
            };
            *count += 1;
            let is_told = |(before, after)| section.contains(&format!("{before}{number}{after}"));
            assert!(words.into_iter().any(is_told), "{name} {number}");
        }
        assert!(!section.contains("as the solver says"));
    }
    assert_eq!(told, [10, 6, 3, 1]);
    // Each command of the page does what it says.
    for tool in [
        "ball",
        "ellipsoid",
        "centers",
        "inscribe ellipsoid",
        "inscribe ellipse",
        "inscribe dops",
        "delaunay",
        "surface",
    ] {
        for line in page.lines().filter_map(|line| line.split(&format!("taut {tool} ")).nth(1)) {
            let words = line.split('<').next().unwrap().trim();
            folder.taut(&format!("{tool} samples/{words} --quiet")).ends(0);
        }
    }
    // To standard output, and on one thread.
    for options in long_or(&["--threads 1", ""][..], &["--threads 1"]) {
        let run = folder.taut(&format!("tour -o - {options}")).ends(0);
        assert_eq!((run.out.as_str(), run.err.as_str()), (page.as_str(), ""));
    }
}

/// The largest page of 10⁴ points.
const PAGE_BYTES_MAX: usize = 1_000_000;

#[test]
fn a_page_of_ten_thousand_points_is_below_a_megabyte() {
    let folder = TestFolder::new();
    let sets = [
        ("plane", "clusters -d 2"),
        ("sphere", "sphere -d 3"),
        ("many", "normal -d 7"),
        ("torus", "torus -d 3"),
        ("curve", "curve -d 2 --shape bumpy"),
    ];
    for (name, points) in sets.into_iter().take(long_or(usize::MAX, 3)) {
        folder.taut(&format!("generate {points} -n 10000 --seed 1 -o {name}.npy -q")).ends(0);
    }
    let ring: String = (0..10_000)
        .map(|i| {
            let (sin, cos) = (f64::from(i) * std::f64::consts::TAU / 1e4).sin_cos();
            let radius =
                1.0 + 0.1 * (f64::from(i) * 0.7).sin() + 0.2 * (f64::from(i) * 0.005).cos();
            format!("{},{}\n", radius * cos, radius * sin)
        })
        .collect();
    folder.put("ring.csv", format!("x,y\n{ring}"));
    let mut commands = vec![
        "ball plane.npy",
        "ball sphere.npy",
        "ball many.npy",
        "ellipsoid plane.npy",
        "ellipsoid sphere.npy",
        "ellipsoid many.npy",
        "centers plane.npy -k 5 --epsilon 0.2",
        "centers sphere.npy -k 5 --epsilon 0.5",
        "dop sphere.npy -k 18",
        "delaunay plane.npy",
        "delaunay sphere.npy",
        "inscribe circle ring.csv --epsilon 0.1",
    ];
    if long_or(true, false) {
        commands.extend([
            "curve curve.npy",
            "surface torus.npy -o torus.ply",
            "inscribe bodies torus.ply --max-events 1000",
            "ellipsoid plane.npy --robust mcd",
            "ellipsoid sphere.npy --robust mcd",
            "ball plane.npy --kernel gaussian --gamma 0.1 --nu 0.5 --epsilon 0.5",
            "ball many.npy --kernel gaussian --gamma 0.1 --nu 0.5 --epsilon 0.5",
        ]);
    }
    let mut large = Vec::new();
    for command in commands {
        folder.taut(&format!("{command} --draw page.html --quiet")).ends(0);
        let bytes = folder.bytes("page.html").len();
        println!("{bytes:>8} bytes: {command}");
        if bytes > PAGE_BYTES_MAX {
            large.push(format!("{command}: {bytes} bytes"));
        }
    }
    assert!(large.is_empty(), "{large:#?}");
}
