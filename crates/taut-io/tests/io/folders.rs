//! The files of a folder as one set of points.

use std::fs;

use taut_io::{Error, ReadOptions, open};
use taut_points::Scratch;

use super::{hash, message, open_default, text, values};

#[test]
fn files_are_one_behind_the_other_in_the_order_of_their_names() {
    let folder = tempfile::tempdir().unwrap();
    let put = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    put("b.csv", "x,y\n5,6\n7,8\n");
    put("a.txt", "1 2\n3 4\n");
    put("c.tsv", "9\t10\n");
    put(".hidden", "no points");
    let input = open_default(folder.path()).unwrap();
    let expected: Vec<f64> = (1..=10).map(f64::from).collect();
    assert_eq!(values(&input), expected);
    let one = text("all.txt", "1 2\n3 4\n5 6\n7 8\n9 10\n").unwrap();
    assert_eq!(hash(&input), hash(&one));
    let mut scratch = Scratch::new();
    for start in 0..5 {
        for end in start..=5 {
            let rows = input.source.read(start..end, &mut scratch).unwrap();
            let mut row = [0.0; 2];
            for i in 0..rows.len() {
                rows.copy_row(i, &mut row);
                let first = 2 * (start as usize + i);
                assert_eq!(row, expected[first..first + 2]);
            }
            assert_eq!(rows.len() as u64, end - start);
        }
    }
    assert!(input.source.read(3..6, &mut scratch).is_err());
    let place = input.describe_cell(3, 1);
    assert!(place.path.ends_with("b.csv") && place.row == 2, "{place:?}");
    let place = input.describe_cell(4, 0);
    assert!(place.path.ends_with("c.tsv") && place.row == 1, "{place:?}");
    let little = ReadOptions { memory: Some(8), ..Default::default() };
    assert_eq!(values(&open(folder.path(), &little).unwrap()), expected);
}

#[test]
fn folders_that_hold_other_things_are_refused_with_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let put = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    put("a.csv", "1,2\n");
    put("b.csv", "1,2,3\n");
    let refused = open_default(folder.path());
    assert!(matches!(refused, Err(Error::OtherDimension { found: 3, expected: 2, .. })));
    assert!(message(refused).contains("b.csv has points of 3 coordinates"));
    put("b.csv", "1,x\n");
    assert!(message(open_default(folder.path())).contains("b.csv"));
    fs::remove_file(folder.path().join("b.csv")).unwrap();
    put("b.what", "1,2\n");
    assert!(message(open_default(folder.path())).contains("b.what"));
    fs::remove_file(folder.path().join("b.what")).unwrap();
    fs::create_dir(folder.path().join("below")).unwrap();
    assert!(message(open_default(folder.path())).contains("below is a folder"));
}
