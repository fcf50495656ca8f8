//! Points within a box, and one in each cell of a grid, of any format.

use taut_io::{Bounds, Error, FilterError, ReadOptions, Thinning, open, open_bytes};
use tempfile::tempdir;

use super::{message, values};

fn bounds(text: &str) -> ReadOptions {
    ReadOptions { bounds: Some(text.parse::<Bounds>().unwrap()), ..Default::default() }
}

fn thin(cell: f64, except: Option<&str>) -> ReadOptions {
    let thinning = Some(Thinning { cell, except: except.map(str::to_owned) });
    ReadOptions { thinning, ..Default::default() }
}

const POINTS: &[u8] = b"x,y,z\n0,0,5\n0.9,0.2,6\n1,1,7\n-0.5,0,8\n2,2,-9\n0.5,0.5,5.5\n";

#[test]
fn the_border_of_a_box_belongs_to_it() {
    let of = |text: &str| values(&open_bytes(POINTS.to_vec(), "p.csv", &bounds(text)).unwrap());
    assert_eq!(of("0,0,1,1"), [0.0, 0.0, 5.0, 0.9, 0.2, 6.0, 1.0, 1.0, 7.0, 0.5, 0.5, 5.5]);
    assert_eq!(
        of("-1,2"),
        values(&open_bytes(POINTS.to_vec(), "p.csv", &ReadOptions::default()).unwrap())
    );
    assert_eq!(of("-9,-9,-9,9,9,5"), [0.0, 0.0, 5.0, 2.0, 2.0, -9.0]);
    for text in ["0,0,1", "", "1,0", "0,nan", "a,b", "0,0,1,-1"] {
        assert!(text.parse::<Bounds>().is_err(), "{text}");
    }
    let refused = open_bytes(POINTS.to_vec(), "p.csv", &bounds("0,0,0,0,1,1,1,1"));
    assert!(message(refused).contains("at most 6 numbers"));
    let refused = open_bytes(POINTS.to_vec(), "p.csv", &bounds("100,101"));
    assert!(matches!(refused, Err(Error::Filter(FilterError::NothingKept { .. }))));
}

#[test]
fn the_first_point_of_a_cell_is_kept() {
    let of = |options: &ReadOptions| {
        let found = values(&open_bytes(POINTS.to_vec(), "p.csv", options).unwrap());
        found.chunks(3).map(|p| p[2]).collect::<Vec<_>>()
    };
    assert_eq!(of(&thin(1.0, Some("z"))), [5.0, 7.0, 8.0, -9.0]);
    assert_eq!(of(&thin(1.0, Some("2"))), [5.0, 7.0, 8.0, -9.0]);
    assert_eq!(of(&thin(1.0, None)), [5.0, 6.0, 7.0, 8.0, -9.0]);
    assert_eq!(of(&thin(100.0, None)), [5.0, 8.0, -9.0]);
    let refused = open_bytes(POINTS.to_vec(), "p.csv", &thin(1e-300, None));
    assert!(message(refused).contains("2^50"));
}

/// Arrays that are read in place, both precisions, values that are no numbers, and labels.
#[test]
fn arrays_and_labels_are_filtered_too() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("p.npy");
    let values_of: Vec<f32> = (0..2000).map(|i| (i % 100) as f32).collect();
    let points = taut_points::Points::new(&values_of, 2).unwrap();
    taut_io::write_points(&points, &[], &path, None, &taut_points::Monitor::silent()).unwrap();
    let found = open(&path, &bounds("10,11,12,13")).unwrap();
    assert_eq!(found.source.scalar(), taut_points::ScalarKind::F32);
    assert_eq!(values(&found), [10.0, 11.0, 12.0, 13.0].repeat(20));
    let found = open(&path, &thin(50.0, None)).unwrap();
    assert_eq!(values(&found), [0.0, 1.0, 50.0, 51.0]);
    let text = b"0,0,a\n5,5,b\n1,1,c\n".to_vec();
    let options = ReadOptions { label: Some("2".to_owned()), ..bounds("0,0,2,2") };
    let found = open_bytes(text, "p.csv", &options).unwrap();
    assert_eq!(found.labels, ["a", "c"]);
    let raw: Vec<f64> = vec![0.0, 1.0, f64::NAN, 2.0];
    let points = taut_points::Points::new(&raw, 2).unwrap();
    taut_io::write_points(&points, &[], &path, None, &taut_points::Monitor::silent()).unwrap();
    let said = message(open(&path, &bounds("0,0,1,1")));
    assert!(said.contains("row 2") && said.contains("NaN"), "{said}");
}

/// Files of a folder share the grid; those that lie outside the box are passed over.
#[test]
fn folders_are_one_set() {
    let folder = tempdir().unwrap();
    std::fs::write(folder.path().join("a.csv"), "0,0\n5,5\n").unwrap();
    std::fs::write(folder.path().join("b.csv"), "0.5,0.5\n9,9\n").unwrap();
    let found = open(folder.path(), &thin(1.0, None)).unwrap();
    assert_eq!(values(&found), [0.0, 0.0, 5.0, 5.0, 9.0, 9.0]);
    let found = open(folder.path(), &bounds("8,8,10,10")).unwrap();
    assert_eq!(values(&found), [9.0, 9.0]);
    assert!(matches!(
        open(folder.path(), &bounds("20,30")),
        Err(Error::Filter(FilterError::NothingKept { .. }))
    ));
}

#[test]
fn a_grid_beyond_the_memory_is_refused() {
    let text: String = (0..40_000).map(|i| format!("{},{}\n", i * 100, i * 70)).collect();
    let options = ReadOptions { memory: Some(1 << 10), ..thin(1.0, None) };
    let refused = open_bytes(text.clone().into_bytes(), "p.csv", &options);
    assert!(matches!(refused, Err(Error::Filter(FilterError::Memory { .. }))));
    let found = open_bytes(text.into_bytes(), "p.csv", &thin(1.0, None)).unwrap();
    assert_eq!(found.source.len(), 40_000);
}
