//! Curves to files: what is written holds the same numbers and says what encloses what.

use std::path::Path;

use taut_io::{Content, Error, Format, Polyline, ReadOptions, open, write_polylines};

const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [8.0, 0.0], [8.0, 8.0], [0.0, 8.0]];
const HOLE: [[f64; 2]; 3] = [[1.0, 1.0], [3.0, 1.5], [2.0, 0.1 + 0.2]];
const LINE: [[f64; 2]; 2] = [[-1.0, 1e-300], [-0.0, 1e300]];
const DOT: [[f64; 2]; 1] = [[9.0, 9.0]];

fn curves() -> [Polyline<'static>; 4] {
    [
        Polyline { vertices: &HOLE, closed: true },
        Polyline { vertices: &LINE, closed: false },
        Polyline { vertices: &SQUARE, closed: true },
        Polyline { vertices: &DOT, closed: true },
    ]
}

fn written(curves: &[Polyline<'_>], name: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    write_polylines(curves, &path, None).unwrap();
    std::fs::read_to_string(path).unwrap()
}

#[test]
fn csv_is_read_back_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["curves.csv", "curves.csv.zst"].into_iter().filter(|name| crate::unpacks(name)) {
        let path = folder.path().join(name);
        write_polylines(&curves(), &path, None).unwrap();
        let input = open(&path, &ReadOptions::default()).unwrap();
        assert_eq!(input.columns, ["curve", "closed", "x", "y"]);
        assert_eq!(input.source.len(), 10);
    }
    let text = std::fs::read_to_string(folder.path().join("curves.csv")).unwrap();
    let rows: Vec<&str> = text.lines().collect();
    assert_eq!(rows[3], "0,1,2,0.30000000000000004");
    assert_eq!(rows[4], "1,0,-1,1e-300");
    assert_eq!(rows[5], "1,0,0,1e+300");
    assert_eq!(rows[10], "3,1,9,9");
}

#[test]
fn geojson_turns_rings_and_finds_holes() {
    assert_eq!(
        written(&curves(), "curves.geojson"),
        "{\"type\": \"FeatureCollection\", \"features\": [\n\
         {\"type\": \"Feature\", \"properties\": {\"curves\": [1]}, \"geometry\": {\"type\": \"LineString\", \
         \"coordinates\": [[-1, 1e-300], [0, 1e+300]]}},\n\
         {\"type\": \"Feature\", \"properties\": {\"curves\": [2, 0]}, \"geometry\": {\"type\": \"Polygon\", \
         \"coordinates\": [[[0, 0], [8, 0], [8, 8], [0, 8], [0, 0]], \
         [[1, 1], [3, 1.5], [2, 0.30000000000000004], [1, 1]]]}},\n\
         {\"type\": \"Feature\", \"properties\": {\"curves\": [3]}, \"geometry\": {\"type\": \"Point\", \
         \"coordinates\": [9, 9]}}\n]}\n"
    );
    let back: Vec<[f64; 2]> = SQUARE.iter().rev().copied().collect();
    let text = written(&[Polyline { vertices: &back, closed: true }], "back.geojson");
    assert!(text.contains("[[[0, 8], [0, 0], [8, 0], [8, 8], [0, 8]]]"), "{text}");
    assert_eq!(
        written(&[], "none.geojson"),
        "{\"type\": \"FeatureCollection\", \"features\": [\n]}\n"
    );
}

#[test]
fn svg_is_one_path_in_coordinates_of_the_input() {
    let text = written(&curves()[2..], "curves.svg");
    assert!(text.contains("viewBox=\"-0.18 -9.18 9.36 9.36\""), "{text}");
    assert!(text.contains(" d=\"M0 0L8 0 8 8 0 8Z\nM9 9Z\"/>"), "{text}");
    assert_eq!(text.matches("<path").count(), 1);
    for curves in [&[][..], &curves()[3..], &curves()[1..2]] {
        let text = written(curves, "few.svg");
        assert!(!text.contains("inf") && !text.contains("NaN"), "{text}");
    }
}

#[test]
fn names_tell_formats() {
    for format in Format::of(Content::Curves) {
        let path = format!("a.{format}");
        assert_eq!(Format::of_path(Path::new(&path)).0, Some(format));
    }
    let unknown = write_polylines(&curves(), Path::new("curves.unknown"), None).unwrap_err();
    assert!(matches!(unknown, Error::UnknownOutput { content: Content::Curves, .. }));
    assert!(
        unknown.to_string().contains("give it one of the extensions .csv, .geojson, .svg"),
        "{unknown}"
    );
    let other = write_polylines(&curves(), Path::new("curves.dxf"), None).unwrap_err();
    let said = "curves.dxf: dxf files are not written as curves; write one of csv, geojson, svg";
    assert_eq!(other.to_string(), said);
    let lost = write_polylines(&curves(), Path::new("no/such/curves.csv"), None).unwrap_err();
    assert!(matches!(lost, Error::NotFound { .. }), "{lost}");
}
