//! `taut ball` and `taut ellipsoid` around balls and ellipsoids, and inscribed ellipsoids verified like all others.

use taut::{InscribedOptions, Points, inscribed_ellipsoid};

use crate::test_folder::TestFolder;

/// Two unit discs as centers and lower triangles of shape matrices; the centers are 2 apart.
const DISCS: &str = "x,y,s11,s21,s22\n-1,0,1,0,1\n1,0,1,0,1\n";
const BALLS: &str = "x,y,r\n-1,0,1\n1,0,1\n";

#[test]
fn the_smallest_ball_around_ellipsoids() {
    let folder = TestFolder::new();
    folder.put("discs.csv", DISCS);
    folder.taut("ball discs.csv --ellipsoids -o ball.json").ends(0).stdout_has(&[
        "Smallest ball around 2 ellipsoids in 2 dimensions\n",
        "\n  center    (0, 0)\n",
        "verified  yes; every ellipsoid is inside",
    ]);
    let found: serde_json::Value = serde_json::from_str(&folder.text("ball.json")).unwrap();
    assert!((found["answer"]["radius"].as_f64().unwrap() - 2.0).abs() < 1e-8);
    assert_eq!(found["certificate"]["items"], "ellipsoids");
    folder
        .taut("verify ball.json discs.csv --epsilon 1e-8")
        .ends(0)
        .stdout_has(&["Verified within a gap of ", ": ball of radius 2"]);
    folder
        .taut("draw ball.json discs.csv -o ball.svg")
        .ends(2)
        .stderr_has(&["ball.json", "no pictures of balls around ellipsoids"]);
    assert_eq!(folder.files(), ["ball.json", "discs.csv"]);
}

/// By symmetry x²/a² + y²/b² ≤ 1 around two unit discs at (±1, 0); the least a·b by search over b, where the disc touches
/// at its farthest point: max over θ of (1 + cos θ)²/a² + sin²θ/b² = 1.
fn least_log_volume() -> f64 {
    let reach = |b: f64| {
        // For given b the least a is the largest (1 + cos θ)/√(1 − sin²θ/b²).
        (0..=20_000)
            .map(|i| f64::from(i) * std::f64::consts::PI / 20_000.0)
            .map(|t| (1.0 + t.cos()) / (1.0 - (t.sin() / b).powi(2)).sqrt())
            .fold(0.0, f64::max)
    };
    let (mut low, mut high) = (1.0 + 1e-6, 3.0);
    for _ in 0..60 {
        let (left, right) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if left * reach(left) < right * reach(right) { high = right } else { low = left }
    }
    (std::f64::consts::PI * low * reach(low)).ln()
}

#[test]
fn the_ellipsoid_of_least_volume_around_balls_and_ellipsoids() {
    let folder = TestFolder::new();
    folder.put("discs.csv", DISCS);
    folder.put("balls.csv", BALLS);
    let least = least_log_volume();
    for (file, option, noun) in
        [("discs.csv", "--ellipsoids", "ellipsoid"), ("balls.csv", "--balls", "ball")]
    {
        folder
            .taut(&format!("ellipsoid {file} {option} -o found.json --draw found.svg"))
            .ends(0)
            .stdout_has(&[
                &format!("Smallest ellipsoid around 2 {noun}s in 2 dimensions\n"),
                "\n  center     (0, 0)\n",
                &format!("verified   yes; every {noun} is inside"),
            ]);
        let found: serde_json::Value = serde_json::from_str(&folder.text("found.json")).unwrap();
        let volume = found["answer"]["log_volume"].as_f64().unwrap();
        assert!((volume - least).abs() < 1e-6, "{option}: {volume}, not {least}");
        assert_eq!(found["certificate"]["items"], format!("{noun}s"));
        assert!(folder.text("found.svg").contains(&format!("2 {noun}s, d = 2")));
        folder.taut(&format!("verify found.json {file} --epsilon 1e-8")).ends(0);
        folder.taut(&format!("draw found.json {file} -o again.svg")).ends(0);
    }
    folder.put("changed.csv", DISCS.replace("-1,0,1,0,1", "-1,0,1,0,1.5"));
    folder.taut("verify found.json changed.csv").ends(1).stdout_has(&["changed.csv"]);
}

#[test]
fn rows_that_are_no_shapes_are_named() {
    let folder = TestFolder::new();
    folder.put("four.csv", "0,0,1,1\n");
    folder.put("negative.csv", DISCS.replace("1,0,1,0,1\n1", "1,0,1,0,1\n1,0,1,2,1\n1"));
    folder.put("nan.csv", DISCS.replace("1,0,1,0,1\n1", "1,0,1,0,NaN\n1"));
    folder.put("hole.csv", BALLS.replace("1,0,1\n1", "1,0,-3\n1"));
    for command in ["ball", "ellipsoid"] {
        let refused = |line: &str, parts: &[&str]| {
            let run = folder.taut(&format!("{command} {line} -o found.json")).ends(2);
            assert!(parts.iter().all(|part| run.err.contains(part)), "{parts:?} in {run:?}");
            assert_eq!(run.out, "");
        };
        refused("four.csv --ellipsoids", &["four.csv", "there are 4", "2, 5, 9", "--columns"]);
        refused(
            "negative.csv --ellipsoids",
            &["negative.csv", "row 2", "ellipsoid 1", "not positive semidefinite"],
        );
        refused("nan.csv --ellipsoids", &["nan.csv", "row 1", "column 4", "`s22`", "NaN"]);
        refused("hole.csv --balls", &["hole.csv", "row 1", "`r`", "-3", "at least 0"]);
        refused("four.csv --ellipsoids --balls", &["--ellipsoids", "--balls"]);
        folder.put("discs.csv", DISCS);
        let method = if command == "ball" { "thesis-pure" } else { "away-steps" };
        refused(&format!("discs.csv --ellipsoids --method {method}"), &["--method", method]);
    }
    let run = folder.taut("ball discs.csv --ellipsoids --draw ball.svg").ends(2);
    assert!(run.err.contains("--draw"), "{run:?}");
    assert_eq!(folder.files().iter().filter(|name| name.contains("found")).count(), 0);
}

#[test]
fn an_inscribed_ellipsoid_is_proved_or_rejected() {
    let folder = TestFolder::new();
    // The rectangle [0, 4] × [0, 2].
    let sides = [1.0, 0.0, 4.0, -1.0, 0.0, 0.0, 0.0, 1.0, 2.0, 0.0, -1.0, 0.0];
    let sides = Points::new(&sides, 3).unwrap();
    let mut found = inscribed_ellipsoid(&sides, &InscribedOptions::default()).unwrap();
    folder.put("sides.csv", "a,b,most\n1,0,4\n-1,0,0\n0,1,2\n0,-1,0\n");
    folder.put("inside.json", found.to_json());
    folder.taut("verify inside.json sides.csv --epsilon 1e-8").ends(0).stdout_has(&[
        "Verified within a gap of ",
        ": inscribed ellipsoid of log-volume 1.837877",
        " ≤ largest log-volume ≤ 1.837877",
    ]);
    folder
        .taut("verify inside.json sides.csv --epsilon 1e-18")
        .ends(1)
        .stdout_has(&["larger than --epsilon"]);
    found.answer.center[1] += 0.001;
    folder.put("moved.json", found.to_json());
    folder
        .taut("verify moved.json sides.csv")
        .ends(1)
        .stdout_has(&["Rejected: sides.csv, row 3: the ellipsoid reaches beyond half-space 2"]);
}
