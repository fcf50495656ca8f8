//! LAS and LAZ files, written by the crate that reads them.

use std::collections::HashSet;
use std::io::Cursor;

use las::point::{Classification, Format as PointFormat};
use las::{Builder, Color, Point, Transform, Vector, Writer};
use taut_io::{Bounds, Format, ReadOptions, Thinning, open_bytes, spill_bytes};

use super::{message, values};

/// Whole numbers that the file has for the coordinates of point `i`.
fn raw(i: i32) -> [i32; 3] {
    let i = i64::from(i);
    [i * 7919 % 1_000_003, i * 104_729 % 999_983 - 500_000, i % 1000].map(|x| x as i32)
}

const SCALES: [f64; 3] = [0.001, 0.01, 1e-5];
const OFFSETS: [f64; 3] = [500_000.123, -4_000_000.5, 0.0];

fn coordinates(i: i32) -> [f64; 3] {
    let raw = raw(i);
    std::array::from_fn(|k| SCALES[k] * f64::from(raw[k]) + OFFSETS[k])
}

/// A file of points of this point format, of the classes 2, 9 and 6 in turn.
fn file(points: i32, format: u8, is_compressed: bool) -> Vec<u8> {
    let mut builder = Builder::from((1, 4));
    builder.point_format = PointFormat::new(format).unwrap();
    builder.point_format.is_compressed = is_compressed;
    let [x, y, z] = [0, 1, 2].map(|k| Transform { scale: SCALES[k], offset: OFFSETS[k] });
    builder.transforms = Vector { x, y, z };
    let mut writer = Writer::new(Cursor::new(vec![]), builder.into_header().unwrap()).unwrap();
    for i in 0..points {
        let [x, y, z] = coordinates(i);
        let classification = Classification::new([2, 9, 6][i as usize % 3]).unwrap();
        let mut point = Point { x, y, z, classification, ..Point::default() };
        let format = *writer.header().point_format();
        point.gps_time = format.has_gps_time.then_some(7.0);
        point.color = format.has_color.then(|| Color::new(1, 2, 3));
        writer.write_point(point).unwrap();
    }
    writer.close().unwrap();
    writer.into_inner().unwrap().into_inner()
}

fn expected(points: i32, keep: impl Fn(i32) -> bool) -> Vec<f64> {
    (0..points).filter(|&i| keep(i)).flat_map(coordinates).collect()
}

#[test]
fn coordinates_are_those_of_scale_and_offset_bit_by_bit() {
    for &format in crate::test_length::long_or(&[0, 1, 2, 3, 6, 7][..], &[0, 7]) {
        for is_compressed in [false, true] {
            let bytes = file(40_000, format, is_compressed);
            let name = if is_compressed { "scan.laz" } else { "scan.las" };
            let input = open_bytes(bytes, name, &ReadOptions::default()).unwrap();
            assert_eq!((input.format, input.source.dim()), (Format::Las, 3));
            assert_eq!(input.columns, ["x", "y", "z"]);
            assert!(values(&input) == expected(40_000, |_| true), "{format} {is_compressed}");
        }
    }
}

#[test]
fn columns_and_classes_are_chosen() {
    let bytes = file(1000, 1, true);
    let options = ReadOptions { columns: Some("y,x".parse().unwrap()), ..Default::default() };
    let input = open_bytes(bytes.clone(), "scan.laz", &options).unwrap();
    assert_eq!(input.columns, ["y", "x"]);
    assert_eq!(values(&input)[..2], [coordinates(0)[1], coordinates(0)[0]]);
    let of = |classes: &[u8]| ReadOptions { classes: Some(classes.to_vec()), ..Default::default() };
    for (classes, keep) in [(&[2][..], [true, false, false]), (&[6, 9], [false, true, true])] {
        let input = open_bytes(bytes.clone(), "scan.laz", &of(classes)).unwrap();
        assert!(values(&input) == expected(1000, |i| keep[i as usize % 3]), "{classes:?}");
    }
    let said = message(open_bytes(bytes, "scan.laz", &of(&[77, 78])));
    assert_eq!(said, "scan.laz: no point is of class 77,78: the classes of its points are 2,6,9");
    let refused = open_bytes(b"1,2\n".to_vec(), "points.csv", &of(&[2]));
    assert!(message(refused).contains("leave out --classes"));
}

/// A file of a folder without points of the classes is left out; a folder without any says which there are.
#[test]
fn files_of_a_folder_may_have_other_classes() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.las"), file(1, 1, false)).unwrap();
    std::fs::write(folder.path().join("b.las"), file(30, 1, false)).unwrap();
    let of = |classes: &[u8]| ReadOptions { classes: Some(classes.to_vec()), ..Default::default() };
    let input = taut_io::open(folder.path(), &of(&[9])).unwrap();
    assert!(values(&input) == expected(30, |i| i % 3 == 1));
    let said = message(taut_io::open(folder.path(), &of(&[77])));
    assert!(
        said.contains("no point is of class 77: the classes of its points are 2,6,9"),
        "{said}"
    );
}

/// Points that outgrow the memory go to a temporary file; standard input has no name.
#[test]
fn files_are_told_by_their_first_bytes_and_may_outgrow_memory() {
    let options =
        ReadOptions { format: Some(Format::Las), memory: Some(1 << 16), ..Default::default() };
    let input = open_bytes(file(30_000, 3, true), "scan", &options).unwrap();
    assert!(input.source.in_memory().is_none());
    assert!(values(&input) == expected(30_000, |_| true));
    let input = open_bytes(file(10, 0, false), "scan", &ReadOptions::default()).unwrap();
    assert_eq!(input.format, Format::Las);
}

/// A box, a grid of which the height is no axis, and both with classes.
#[test]
fn points_are_kept_within_bounds_and_one_in_each_cell() {
    let bytes = file(30_000, 1, true);
    let bounds: Bounds = "500100,-4004000,500600,-3999000".parse().unwrap();
    let is_within = |p: [f64; 3]| {
        (500_100.0..=500_600.0).contains(&p[0]) && (-4_004_000.0..=-3_999_000.0).contains(&p[1])
    };
    let (cell, mut seen) = (25.0, HashSet::new());
    let is_first = |p: [f64; 3], seen: &mut HashSet<[i64; 2]>| {
        seen.insert([p[0], p[1]].map(|x| (x / cell).floor() as i64))
    };
    let thinning = Some(Thinning { cell, except: Some("z".to_owned()) });
    let options = ReadOptions { bounds: Some(bounds), ..Default::default() };
    let found = values(&open_bytes(bytes.clone(), "scan.laz", &options).unwrap());
    let wanted = expected(30_000, |i| is_within(coordinates(i)));
    assert!(wanted.len() > 3000 && found == wanted);
    let options = ReadOptions { thinning: thinning.clone(), ..Default::default() };
    let found = values(&open_bytes(bytes.clone(), "scan.laz", &options).unwrap());
    let mut kept = vec![];
    for i in 0..30_000 {
        if is_first(coordinates(i), &mut seen) {
            kept.extend(coordinates(i));
        }
    }
    assert!(kept.len() > 3000 && kept.len() < 80_000 && found == kept);
    let classes = Some(vec![9]);
    let options = ReadOptions { classes, thinning, ..Default::default() };
    let found = values(&open_bytes(bytes.clone(), "scan.laz", &options).unwrap());
    seen.clear();
    let kept: Vec<f64> = (0..30_000)
        .filter(|i| i % 3 == 1 && is_first(coordinates(*i), &mut seen))
        .flat_map(coordinates)
        .collect();
    assert!(found == kept);
    let options = ReadOptions { bounds: "0,0,1,1".parse().ok(), ..Default::default() };
    let refused = open_bytes(bytes, "scan.laz", &options);
    assert!(message(refused).contains("no point is within the bounds"));
}

#[test]
fn the_bytes_of_points_that_wait_on_the_disk_are_known_before() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let of = |memory: u64| ReadOptions { memory: Some(memory), ..Default::default() };
    for is_compressed in [false, true] {
        let file = path("scan.laz");
        std::fs::write(&file, file_of(40_000, is_compressed)).unwrap();
        assert_eq!(spill_bytes(&file, &of(1 << 10)), 960_000);
        assert_eq!(spill_bytes(&file, &of(960_000)), 0);
        assert_eq!(spill_bytes(&file, &ReadOptions::default()), 0);
        let columns = ReadOptions { columns: Some("x,y".parse().unwrap()), ..of(1 << 10) };
        assert_eq!(spill_bytes(&file, &columns), 640_000);
    }
    // Each file of a folder has its share of the memory.
    std::fs::write(path("more.las"), file_of(1000, false)).unwrap();
    std::fs::write(path("other.csv"), "1,2,3\n").unwrap();
    assert_eq!(spill_bytes(folder.path(), &of(60_000)), 984_000);
    assert_eq!(spill_bytes(folder.path(), &of(90_000)), 960_000);
    assert_eq!(spill_bytes(&path("other.csv"), &of(1)), 0);
    assert_eq!(spill_bytes(&path("none.las"), &of(1)), 0);
    let cut = file_of(1000, false)[..400].to_vec();
    std::fs::write(path("cut.las"), cut).unwrap();
    assert_eq!(spill_bytes(&path("cut.las"), &of(1)), 0);
}

/// A file of point format 1.
fn file_of(points: i32, is_compressed: bool) -> Vec<u8> {
    file(points, 1, is_compressed)
}

#[test]
fn damaged_files_are_refused_with_the_place() {
    for is_compressed in [false, true] {
        let bytes = file(crate::test_length::long_or(40_000, 1000), 1, is_compressed);
        let name = if is_compressed { "scan.laz" } else { "scan.las" };
        for part in [2, 3, 7] {
            let cut = bytes[..bytes.len() / part].to_vec();
            let said = message(open_bytes(cut, name, &ReadOptions::default()));
            assert!(said.starts_with(name) && said.contains("point"), "{said}");
        }
        for length in [0, 4, 100, 227, 374, 376] {
            message(open_bytes(bytes[..length].to_vec(), name, &ReadOptions::default()));
        }
        // Any byte of the header, and some of the points: an error or other points, but no panic.
        for at in (0..700).chain((700..bytes.len()).step_by(997)) {
            let mut other = bytes.clone();
            other[at] ^= 0xff;
            let _ = open_bytes(other, name, &ReadOptions::default());
        }
    }
}

/// The decoder makes room for all chunks that a file claims before it reads one.
#[test]
fn more_chunks_than_a_file_has_room_for_are_refused() {
    let bytes = file(2000, 1, true);
    let number = |at: usize, size: usize| {
        bytes[at..][..size].iter().rev().fold(0, |n, &b| n << 8 | b as usize)
    };
    let points = number(96, 4);
    let table = number(points, 8);
    assert_eq!(number(table + 4, 4), 1, "one chunk");
    // With the place of the table before the points, and at the end of the file.
    let mut at_end = bytes.clone();
    at_end[points..][..8].fill(0xff);
    at_end.extend((table as u64).to_le_bytes());
    for bytes in [&bytes, &at_end] {
        let read = |bytes| open_bytes(bytes, "scan.laz", &ReadOptions::default());
        assert_eq!(read(bytes.clone()).unwrap().source.len(), 2000);
        for byte in [2, 3] {
            let mut other = bytes.clone();
            other[table + 4 + byte] = 0xff;
            let said = message(read(other));
            assert!(said.starts_with("scan.laz") && said.contains("chunks"), "{said}");
        }
    }
}
