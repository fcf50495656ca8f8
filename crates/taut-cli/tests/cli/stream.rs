//! `taut stream`: points that come once, in a coherent order.

use crate::test_folder::TestFolder;

/// Lines of points of a spiral-like sequence, sorted along x.
fn sorted() -> Vec<[f64; 2]> {
    let place =
        |i: u32| [f64::from(i * 7919 % 1000) / 1000.0, f64::from(i * 104_729 % 997) / 997.0];
    let mut points: Vec<[f64; 2]> = (0..1000).map(place).collect();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    points
}

fn lines(points: &[[f64; 2]]) -> String {
    points.iter().map(|[x, y]| format!("{x},{y}\n")).collect()
}

/// What the summary says of the hash.
fn hash(text: &str) -> String {
    let line = text.lines().find(|line| line.trim().starts_with("fingerprint")).unwrap_or_default();
    line.split_whitespace().nth(1).unwrap_or_default().trim_end_matches(';').to_owned()
}

#[test]
fn a_sorted_stream_gives_the_triangles_of_the_file() {
    let folder = TestFolder::new();
    let text = lines(&sorted());
    folder.put("points.csv", text.as_bytes());
    let expected = folder.taut("delaunay points.csv -o expected.json").ends(0);
    let run = folder.pipe(text.clone(), "stream --within 0,0,1,1 --sorted x").ends(0);
    assert!(run.err.contains("1000 points in the plane, as they came"), "{}", run.err);
    assert_eq!(hash(&run.err), hash(&expected.out));
    let triangles = run.out.lines().count();
    assert!((1900..2000).contains(&triangles), "{triangles}");
    let first: Vec<u64> =
        run.out.lines().next().unwrap().split(',').map(|v| v.parse().unwrap()).collect();
    assert!(first.len() == 3 && first.iter().all(|&row| row < 1000));
    let quiet = folder.taut("stream points.csv --within 0,0,1,1 --sorted x -q").ends(0);
    assert_eq!((quiet.out, quiet.err.as_str()), (run.out, ""));
}

#[test]
fn cells_are_closed_by_rows_of_nan_and_a_number() {
    let folder = TestFolder::new();
    let points = sorted();
    let expected = folder.pipe(lines(&points), "stream --within 0,0,1,1 --sorted x").ends(0);
    let mut text = String::from("x,y\n");
    for cell in 0..4 {
        let is_in = |p: &&[f64; 2]| usize::from(p[0] >= 0.5) + 2 * usize::from(p[1] >= 0.5) == cell;
        text += &lines(&points.iter().filter(is_in).copied().collect::<Vec<_>>());
        text += &format!("nan,{cell}\n");
    }
    let run = folder.pipe(text, "stream --within 0,0,1,1 --cells 1").ends(0);
    assert_eq!(hash(&run.err), hash(&expected.err));
}

#[test]
fn rows_that_break_the_promise_are_named() {
    let folder = TestFolder::new();
    for (text, options, said) in [
        ("0,0\n1,0\n0.5,1\n", "--sorted x", "line 3: point 2 comes after a point with a larger"),
        ("0,0\n1,7\n", "--sorted x", "line 2: point 1 lies outside the box"),
        ("nan,0\n0.1,0.1\n", "--cells 1", "line 2: point 0 lies in a cell that was closed"),
        ("nan,4\n", "--cells 1", "line 1: "),
        ("nan,0.5\n", "--cells 1", "line 1: 0.5 is no number of a cell"),
        ("0,0\n1,four\n", "--sorted y", "line 2: `four` is no number"),
        ("0,0\nnan,1\n", "--sorted y", "coordinate 0 of point 1 is NaN"),
        ("0,0\n", "--sorted z", "axis"),
        ("0,0\n", "--sorted x --memory 1M", "memory"),
    ] {
        let run = folder.pipe(text, &format!("stream --within 0,0,1,1 {options}")).ends(2);
        assert!(run.err.contains(said), "{text} {options}: {}", run.err);
    }
    folder.pipe("0,0\n", "stream --within 0,0,1 --sorted x").ends(2);
    folder.pipe("0,0\n", "stream --within 0,0,1,1").ends(2);
}
