//! `taut generate`: each distribution, each format, and the same bytes whatever the threads.

use crate::test_folder::TestFolder;

fn rows(text: &str) -> Vec<Vec<f64>> {
    text.lines().map(|line| line.split(',').map(|field| field.parse().unwrap()).collect()).collect()
}

#[test]
fn every_distribution_is_drawn() {
    let folder = TestFolder::new();
    let help = folder.taut("generate --help").ends(0).out;
    for (name, _) in taut::points::Distribution::NAMES {
        assert!(help.contains(&format!("- {name}:")), "{name} in {help}");
        let run = folder.taut(&format!("generate {name} -n 12 -d 3")).ends(0);
        let rows = rows(&run.out);
        assert_eq!(rows.len(), 12, "{name}");
        assert!(rows.iter().all(|row| row.len() == 3), "{name}");
    }
}

#[test]
fn parameters_reach_their_distribution() {
    let folder = TestFolder::new();
    let norm = |row: &Vec<f64>| row.iter().map(|v| v * v).sum::<f64>().sqrt();
    let shell = rows(&folder.taut("generate shell -n 50 -d 4 --thickness 0.5").ends(0).out);
    assert!(shell.iter().map(norm).all(|r| (0.5..=1.5).contains(&r)));
    assert!(shell.iter().map(norm).any(|r| (r - 1.0).abs() > 0.2));
    let square = rows(&folder.taut("generate polygon -n 8 -d 2 --vertices 4").ends(0).out);
    assert_eq!(square[..4], square[4..]);
    let points = folder.taut("generate clusters -n 9 -d 2 --count 3 --spread 0").ends(0).out;
    assert_eq!(rows(&points)[..3], rows(&points)[6..]);
    let grid = rows(&folder.taut("generate grid -n 9 -d 2 --side 3").ends(0).out);
    let mut cells: Vec<_> = grid.iter().map(|row| (3.0 * row[0] + row[1]) as usize).collect();
    cells.sort_unstable();
    assert!(cells.into_iter().eq(0..9));
    let turned = rows(&folder.taut("generate grid -n 9 -d 2 --angle 90").ends(0).out);
    assert!(turned.iter().zip(&grid).all(|(turned, row)| (turned[1] - row[0]).abs() < 1e-15));
    let still = folder.taut("generate spiral -n 5 -d 3 --turns 0").ends(0).out;
    assert!(rows(&still).iter().all(|row| row[1..] == [0.0, 0.0]));
    let exact = rows(&folder.taut("generate torus -n 5 -d 3 --noise 0").ends(0).out);
    let off = |row: &Vec<f64>| ((row[0].hypot(row[1]) - 2.0).hypot(row[2]) - 0.7).abs();
    assert!(exact.iter().all(|row| off(row) < 1e-14));
    folder
        .taut("generate normal -n 2 -d 2 --thickness 1")
        .ends(2)
        .stderr_has(&["--thickness", "shell"]);
    folder
        .taut("generate shell -n 2 -d 2 --thickness -1")
        .ends(2)
        .stderr_has(&["--thickness` is -1"]);
    folder.taut("generate normal -n 2 -d 0").ends(2).stderr_has(&["dimension"]);
    folder.taut("generate weibull -n 2 -d 2").ends(2);
}

#[test]
fn curves_are_drawn_with_their_noise() {
    let folder = TestFolder::new();
    let help = folder.taut("generate --help").ends(0).out;
    assert!(help.contains("- curve:") && help.contains("- flower5:"), "{help}");
    let exact = "generate curve --shape circle -n 50 -d 2 --noise 0";
    let exact = rows(&folder.taut(exact).ends(0).out);
    assert!(exact.iter().all(|row| (row[0].hypot(row[1]) - 1.0).abs() < 1e-6));
    let noisy = rows(&folder.taut("generate curve --shape circle -n 200 -d 2").ends(0).out);
    let off: Vec<f64> = noisy.iter().map(|row| (row[0].hypot(row[1]) - 1.0).abs()).collect();
    assert!(off.iter().all(|off| *off <= 0.05 + 1e-12) && off.iter().any(|off| *off > 0.03));
    let spoiled = "generate curve --shape circle -n 200 -d 2 --outliers 0.5";
    let far = rows(&folder.taut(spoiled).ends(0).out);
    assert!(far.iter().filter(|row| (row[0].hypot(row[1]) - 1.0).abs() > 0.05).count() > 60);
    for (wrong, said) in [
        ("curve -n 2 -d 2", "--shape"),
        ("curve --shape circle -n 2 -d 3", "`--dim` is 3"),
        ("curve --shape circle -n 2 -d 2 --noise -1", "`--noise` is -1"),
        ("curve --shape circle -n 2 -d 2 --outliers 2", "`--outlier-share` is 2"),
        ("curve --shape circle -n 2 -d 2 --turns 2", "--turns"),
        ("normal --shape circle -n 2 -d 2", "--shape belongs to curve"),
    ] {
        folder.taut(&format!("generate {wrong}")).ends(2).stderr_has(&[said]);
    }
    folder.taut("generate curve --shape knot -n 2 -d 2").ends(2);
}

#[test]
fn point_i_depends_on_the_seed_and_i_alone() {
    let folder = TestFolder::new();
    let few = folder.taut("generate normal -n 5 -d 3 --seed 9 --threads 1").ends(0).out;
    let many = folder.taut("generate normal -n 50000 -d 3 --seed 9 --threads 8").ends(0).out;
    assert!(many.starts_with(&few));
    assert_ne!(folder.taut("generate normal -n 5 -d 3 --seed 10").ends(0).out, few);
}

#[test]
fn what_is_written_is_read_back_whatever_the_format() {
    let folder = TestFolder::new();
    let mut answers = Vec::new();
    let mut files = "p.csv p.tsv p.txt p.npy p.xyz p.csv.gz".to_owned();
    for (built, more) in [
        (cfg!(feature = "arrow"), " p.parquet p.arrow"),
        (cfg!(feature = "zstd"), " p.npy.zst"),
        (cfg!(feature = "xz"), " p.xyz.xz"),
    ] {
        files += if built { more } else { "" };
    }
    for file in files.split(' ') {
        folder.taut(&format!("generate uniform -n 200 -d 3 --type f32 -o {file}")).ends(0);
        let answer = folder.taut(&format!("ball {file} --json")).ends(0).json();
        answers.push((
            file,
            answer["certificate"]["points_hash"].clone(),
            answer["answer"].clone(),
        ));
    }
    for (file, hash, answer) in &answers {
        assert_eq!((hash, answer), (&answers[0].1, &answers[0].2), "{file}");
    }
    folder.taut("generate uniform -n 2 -d 2 -o p.xls").ends(2).stderr_has(&["p.xls"]);
    folder.taut("generate uniform -n 2 -d 2 -o p.tsp").ends(2).stderr_has(&["p.tsp"]);
}

#[test]
fn radii_make_balls() {
    let folder = TestFolder::new();
    let balls = rows(&folder.taut("generate normal -n 300 -d 2 --radii uniform:1:2").ends(0).out);
    assert!(balls.iter().all(|ball| ball.len() == 3 && (1.0..=2.0).contains(&ball[2])));
    let centers = rows(&folder.taut("generate normal -n 300 -d 2").ends(0).out);
    assert!(balls.iter().zip(&centers).all(|(ball, center)| ball[..2] == center[..]));
    folder.taut("generate normal -n 300 -d 2 --radii exponential:0.1 -o balls.csv").ends(0);
    folder
        .taut("ball balls.csv --balls")
        .ends(0)
        .stdout_has(&["300 balls in 2 dimensions", "verified  yes"]);
    folder.taut("generate normal -n 3 -d 2 --radii big").ends(2);
}

#[test]
fn sizes_that_cannot_be_are_refused() {
    let folder = TestFolder::new();
    folder.taut("generate normal -n 0 -d 2").ends(2).stderr_has(&["at least 1 point"]);
    for d in ["18446744073709551615", "2305843009213693953", "1152921504606846976"] {
        for more in ["", " --radii equal:1", " -o p.npy", " --type f32 -o p.csv"] {
            let run = format!("generate normal -n 1 -d {d}{more}");
            folder.taut(&run).ends(2).stderr_has(&["`--dim` is"]);
        }
    }
    folder
        .taut("generate normal -n 18446744073709551615 -d 3")
        .ends(2)
        .stderr_has(&["is 18446744073709551615"]);
}

#[test]
fn a_value_that_single_precision_cannot_hold_is_named() {
    let folder = TestFolder::new();
    let beyond = "generate clusters -n 3 -d 2 --spread 1e300";
    folder.taut(beyond).ends(0);
    folder
        .taut(&format!("{beyond} --type f32"))
        .ends(2)
        .stderr_has(&["coordinate 0 of point 0", "f32"]);
    folder
        .taut("generate normal -n 3 -d 2 --radii equal:1e300 --type f32")
        .ends(2)
        .stderr_has(&["coordinate 2 of point 0"]);
}
