//! Pages as a browser shows them: every figure is there and whole and no two texts overlap, on a laptop, on phones and on paper, in both
//! color schemes.
//!
//! One headless Chromium looks at all pages; where there is none, the tests say that they are skipped.

mod browser;

use std::path::Path;

use serde_json::Value;

use self::browser::{Browser, Screen};
use crate::test_folder::TestFolder;

const LAPTOP: Screen = Screen { width: 1280, dark: false, print: false };
const LAPTOP_DARK: Screen = Screen { dark: true, ..LAPTOP };
const TABLET: Screen = Screen { width: 500, ..LAPTOP };
const PHONE: Screen = Screen { width: 390, dark: true, print: false };
/// A sheet of A4 without its margins; paper is white whatever the screen is.
const PAPER: Screen = Screen { width: 718, dark: true, print: true };

/// Screenshots have this many pixels to each of the page.
const SCREENSHOT_SCALE: f64 = 0.25;

/// A figure has something on at least this part of its area: axes alone have less than half of it.
const INK_MIN: f64 = 0.01;

/// The widest that a figure is which stands alone below the first one.
const LONE_WIDTH_MAX: f64 = 640.0;

/// Returns all that is wrong with a page.
fn faults(browser: &mut Browser, page: &Path) -> Vec<String> {
    browser.open(page);
    let mut faults = Vec::new();
    for screen in [LAPTOP, LAPTOP_DARK, TABLET, PHONE, PAPER] {
        browser.show_on(screen);
        let found = faults_on(browser, screen);
        faults.extend(found.into_iter().map(|fault| format!("{screen:?}: {fault}")));
    }
    faults.extend(browser.exceptions().iter().map(|exception| format!("thrown: {exception}")));
    faults
}

/// Returns all that is wrong with the open page on a screen.
fn faults_on(browser: &mut Browser, screen: Screen) -> Vec<String> {
    let seen = browser.evaluate(include_str!("screens/look.js"));
    let mut faults = Vec::new();
    for (name, words) in [
        ("texts overlap", &seen["covered"]),
        ("texts are cut off", &seen["cut"]),
        ("texts are too faint", &seen["faint"]),
    ] {
        let words = words.as_array().unwrap();
        faults.extend(words.iter().map(|words| format!("{name}: {words}")));
    }
    let [width, height] = [0, 1].map(|k| seen["size"][k].as_f64().unwrap());
    if seen["wide"].as_f64().unwrap() > width {
        faults.push(format!("the page is wider than the screen: {}", seen["wide"]));
    }
    let is_dark = seen["ground"][0].as_u64().unwrap() < 64;
    if is_dark != (screen.dark && !screen.print) {
        faults.push(format!("the ground is {}", seen["ground"]));
    }
    let figures = seen["figures"].as_array().unwrap();
    if figures.is_empty() {
        faults.push("there is no figure".to_owned());
    }
    for figure in figures {
        let title = &figure["title"];
        if figure["whole"] != true {
            faults.push(format!("not whole: {title}"));
        }
        if figure["alone"] == true && figure["place"][2].as_f64().unwrap() > LONE_WIDTH_MAX {
            faults.push(format!("stretched: {title}"));
        }
    }
    // Of the others the drawings are the same, but for their size or their colors.
    if [LAPTOP, PHONE, PAPER].contains(&screen) {
        faults.extend(blank_figures(browser, &seen, [width, height]));
    }
    faults
}

/// Names the figures of which a screenshot shows nothing.
fn blank_figures(browser: &mut Browser, seen: &Value, size: [f64; 2]) -> Vec<String> {
    let figures = seen["figures"].as_array().unwrap();
    let places: Vec<&Value> = figures.iter().map(|figure| &figure["place"]).collect();
    let png = browser.screenshot(size, SCREENSHOT_SCALE);
    let ask = include_str!("screens/ink.js").trim();
    let words = serde_json::json!([png, SCREENSHOT_SCALE, seen["ground"], places]);
    let found = browser.evaluate(&format!("({})(...{words})", ask.split_once('\n').unwrap().1));
    let shares = found["shares"].as_array().unwrap().iter().map(|share| share.as_f64().unwrap());
    let mut faults: Vec<String> = figures
        .iter()
        .zip(shares)
        .filter(|(_, share)| *share < INK_MIN)
        .map(|(figure, share)| format!("blank, {share} of it is drawn: {}", figure["title"]))
        .collect();
    let ground = |found: &Value| {
        found.as_array().unwrap().iter().map(|c| c.as_i64().unwrap()).collect::<Vec<_>>()
    };
    // Colors of a smaller picture are rounded.
    if ground(&found["corner"]).iter().zip(ground(&seen["ground"])).any(|(a, b)| (a - b).abs() > 3)
    {
        faults.push(format!("the screenshot ends in {}", found["corner"]));
    }
    faults
}

fn skipped(test: &str) {
    println!("{test} is skipped: there is no Chromium; the variable CHROMIUM names one");
}

/// A page for each kind of answer that the tour does not show, and for each dimension that is drawn in a way of its own.
const PAGES: [(&str, &str); 16] = [
    ("ball on a line", "ball line.npy"),
    ("ball of a kernel", "ball plane.npy --kernel gaussian --gamma 2"),
    ("soft ball of a kernel", "ball space.npy --kernel gaussian --gamma 2 --nu 0.1"),
    ("ellipsoid", "ellipsoid plane.npy"),
    ("ellipsoid in seven dimensions", "ellipsoid many.npy"),
    ("robust ellipsoid", "ellipsoid plane.npy --robust mcd"),
    ("centers", "centers many.npy -k 3 --epsilon 0.5"),
    ("elbow", "centers plane.npy --elbow 1..6 --epsilon 0.5"),
    ("dop", "dop space.npy -k 18"),
    ("circle", "inscribe circle ring.csv"),
    ("triangle", "inscribe triangle ring.csv --epsilon 0.1"),
    ("rectangle", "inscribe rectangle ring.csv --epsilon 0.1"),
    ("oriented rectangle", "inscribe rectangle ring.csv --oriented --epsilon 0.1"),
    ("convex polygon", "inscribe polygon ring.csv"),
    (
        "decision map",
        "classify train classes.csv --label kind --method mahalanobis --model model.json",
    ),
    ("error rates", "classify evaluate classes.csv --label kind --model model.json --positive oak"),
];

/// An L with a cut corner: `x,y` and a label for classes.
fn inputs() -> TestFolder {
    let folder = TestFolder::new();
    folder.put("ring.csv", "x,y\n0,0\n6,0\n7,1\n7,4\n4,4\n4,7\n0,7\n");
    let mut classes = String::from("length,width,kind\n");
    for i in 0..60 {
        let (angle, radius) = (f64::from(i) * 2.4, f64::from(i % 7) / 4.0);
        let (x, y) = (radius * angle.cos(), radius * angle.sin());
        let (middle, kind) = if i % 2 == 0 { (0.0, "oak") } else { (2.0, "elm") };
        classes += &format!("{},{y},{kind}\n", x + middle);
    }
    folder.put("classes.csv", classes);
    for (name, dim) in [("line", 1), ("plane", 2), ("space", 3), ("many", 7)] {
        folder.taut(&format!("generate normal -n 80 -d {dim} --seed 3 -o {name}.npy -q")).ends(0);
    }
    folder
}

#[test]
fn every_page_can_be_read_on_every_screen() {
    let Some(mut browser) = Browser::start() else {
        return skipped("every_page_can_be_read_on_every_screen");
    };
    let folder = inputs();
    folder.taut("tour --quiet").ends(0);
    let mut wrong = faults(&mut browser, &folder.path("tour.html"));
    for (name, command) in PAGES {
        folder.taut(&format!("{command} --draw page.html --quiet")).ends(0);
        let found = faults(&mut browser, &folder.path("page.html"));
        wrong.extend(found.into_iter().map(|fault| format!("{name}: {fault}")));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The judge itself: each fault that it looks for is found on a page that has it.
#[test]
fn faults_of_a_page_are_found() {
    let Some(mut browser) = Browser::start() else {
        return skipped("faults_of_a_page_are_found");
    };
    let folder = TestFolder::new();
    let text = |x: u32, words: &str, color: &str| {
        format!("<text x='{x}' y='30' font-size='12' fill='{color}'>{words}</text>")
    };
    let figure = |title: &str, inside: &str| {
        format!(
            "<figure><h3>{title}</h3><div class='sheet'><svg width='600' height='300'>{inside}</svg></div></figure>"
        )
    };
    let rect = "<rect y='80' width='600' height='40' fill='#0072b2'/>";
    let marks = format!(
        "{rect}{}{}{}{}",
        text(20, "one word", "#000"),
        text(60, "another", "#000"),
        text(580, "at the edge", "#000"),
        text(300, "pale", "#eee")
    );
    let page = format!(
        "<!DOCTYPE html><style>html {{ background: #fff }} .sheet {{ overflow-x: auto }} .rest svg {{ width: 1100px }}</style>\
         {}{}<div class='rest'>{}</div><div style='width: 1500px'>wide</div><script>throw 7</script>",
        figure("crowded", &marks),
        figure("empty", ""),
        figure("lone", rect)
    );
    folder.put("page.html", page);
    let found = faults(&mut browser, &folder.path("page.html")).join("\n");
    for fault in [
        "texts overlap: \"one word | another\"",
        "texts are cut off: \"at the edge\"",
        "texts are too faint: \"pale\"",
        "the page is wider than the screen",
        "the ground is [255,255,255]",
        "not whole: \"crowded\"",
        "is drawn: \"empty\"",
        "stretched: \"lone\"",
        "thrown",
    ] {
        assert!(found.contains(fault), "no `{fault}` in\n{found}");
    }
    assert!(!found.contains("is drawn: \"crowded\""), "{found}");
}
