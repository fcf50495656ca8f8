//! One function per parser: what the fuzzers call with any bytes, and the tests with the kept ones.
//!
//! Each panics when a promise is broken: points that are not finite, names that do not fit, two ways to read the
//! same bytes that differ.

use taut_io::{
    Content, Decimal, Feature, Format, Header, Input, Missing, RawLayout, ReadOptions, open_bytes,
    open_mesh_bytes,
};
use taut_points::{Monitor, ScalarKind, Scratch, hash_points};

type Parser = (&'static str, fn(&[u8]));

/// Every parser by the name of its fuzz target.
pub(crate) const ALL: [Parser; 24] = [
    ("csv", csv),
    ("npy", npy),
    ("parquet", parquet),
    ("arrow", arrow),
    ("tsplib", tsplib),
    ("xyz", xyz),
    ("raw", raw),
    ("json", json),
    ("geojson", geojson),
    ("wkt", wkt),
    ("svg", svg),
    ("pcd", pcd),
    ("npz", npz),
    ("shapefile", shapefile),
    ("ply", ply),
    ("obj", obj),
    ("off", off),
    ("vtu", vtu),
    ("mesh_parquet", mesh_parquet),
    ("shape_ply", shape_ply),
    ("shape_obj", shape_obj),
    ("shape_off", shape_off),
    ("shape_stl", shape_stl),
    ("shape_xyz", shape_xyz),
];

/// Comma, tab and space; with all columns and with some.
pub(crate) fn csv(bytes: &[u8]) {
    for format in [Format::Csv, Format::Tsv, Format::Whitespace] {
        let all = read(bytes, format, ReadOptions::default());
        for header in [Header::Present, Header::Absent] {
            read(bytes, format, ReadOptions { header, ..Default::default() });
        }
        for (numeric, missing, decimal) in [
            (true, Missing::Refuse, Decimal::Point),
            (false, Missing::Drop, Decimal::Point),
            (false, Missing::Refuse, Decimal::Comma),
            (true, Missing::Drop, Decimal::Comma),
        ] {
            read(bytes, format, ReadOptions { numeric, missing, decimal, ..Default::default() });
        }
        // A selection of everything takes the slow way through each row, which must give the same points.
        let columns = Some("0-".parse().expect("a range"));
        let selected = read(bytes, format, ReadOptions { columns, ..Default::default() });
        if let (Some(all), Some(selected)) = (all, selected) {
            let hash =
                |input: &Input| hash_points(&*input.source, &Monitor::silent()).expect("in memory");
            assert_eq!(hash(&all), hash(&selected));
        }
    }
}

pub(crate) fn npy(bytes: &[u8]) {
    read(bytes, Format::Npy, ReadOptions::default());
    let columns = Some("0".parse().expect("a number"));
    read(bytes, Format::Npy, ReadOptions { columns, ..Default::default() });
}

pub(crate) fn parquet(bytes: &[u8]) {
    read(bytes, Format::Parquet, ReadOptions::default());
}

pub(crate) fn arrow(bytes: &[u8]) {
    read(bytes, Format::Arrow, ReadOptions::default());
}

pub(crate) fn tsplib(bytes: &[u8]) {
    read(bytes, Format::Tsplib, ReadOptions::default());
}

pub(crate) fn xyz(bytes: &[u8]) {
    read(bytes, Format::Xyz, ReadOptions::default());
    let columns = Some("0-".parse().expect("a range"));
    read(bytes, Format::Xyz, ReadOptions { columns, ..Default::default() });
}

/// The first bytes are the layout.
pub(crate) fn raw(bytes: &[u8]) {
    let [dim, offset, narrow, values @ ..] = bytes else { return };
    let scalar = if narrow % 2 == 0 { ScalarKind::F64 } else { ScalarKind::F32 };
    let layout = RawLayout { dim: (*dim).into(), scalar, offset: (*offset).into() };
    read(values, Format::Raw, ReadOptions { raw: Some(layout), ..Default::default() });
}

/// An answer that is read is written and read again, to the same.
pub(crate) fn json(bytes: &[u8]) {
    use taut_certify::AnySolution;
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let Ok(found) = AnySolution::from_json(text) else { return };
    let again = found.to_json();
    assert_eq!(AnySolution::from_json(&again).expect("written by us"), found);
}

pub(crate) fn geojson(bytes: &[u8]) {
    features(bytes, Format::GeoJson);
}

pub(crate) fn wkt(bytes: &[u8]) {
    features(bytes, Format::Wkt);
}

pub(crate) fn svg(bytes: &[u8]) {
    features(bytes, Format::Svg);
}

pub(crate) fn pcd(bytes: &[u8]) {
    read(bytes, Format::Pcd, ReadOptions::default());
    let columns = Some("0-".parse().expect("a range"));
    read(bytes, Format::Pcd, ReadOptions { columns, ..Default::default() });
}

/// The only array, and the first two of several.
pub(crate) fn npz(bytes: &[u8]) {
    read(bytes, Format::Npz, ReadOptions::default());
    for number in [0, 1] {
        let feature = Some(Feature::Number(number));
        read(bytes, Format::Npz, ReadOptions { feature, ..Default::default() });
    }
}

pub(crate) fn shapefile(bytes: &[u8]) {
    features(bytes, Format::Shapefile);
}

/// With all columns and with some, where little memory is allowed, and feature by feature.
fn features(bytes: &[u8], format: Format) {
    let all = read(bytes, format, ReadOptions::default()).map(|input| input.source.len());
    let columns = Some("1,0".parse().expect("numbers"));
    let turned = read(bytes, format, ReadOptions { columns, ..Default::default() });
    assert_eq!(all, turned.map(|input| input.source.len()));
    read(bytes, format, ReadOptions { memory: Some(1 << 20), ..Default::default() });
    for feature in [Feature::Number(0), Feature::Number(1), Feature::Name("a".to_owned())] {
        let one = read(bytes, format, ReadOptions { feature: Some(feature), ..Default::default() });
        // What is read as a whole is one feature, or the points of several.
        if let (Some(all), Some(one)) = (all, one) {
            assert!(one.source.len() <= all);
        }
    }
}

pub(crate) fn ply(bytes: &[u8]) {
    mesh(bytes, "fuzz.ply");
}

pub(crate) fn obj(bytes: &[u8]) {
    mesh(bytes, "fuzz.obj");
}

pub(crate) fn off(bytes: &[u8]) {
    mesh(bytes, "fuzz.off");
}

pub(crate) fn vtu(bytes: &[u8]) {
    mesh(bytes, "fuzz.vtu");
}

/// Parquet with rows of ids.
pub(crate) fn mesh_parquet(bytes: &[u8]) {
    mesh(bytes, "fuzz.parquet");
}

fn mesh(bytes: &[u8], name: &str) {
    match open_mesh_bytes(bytes.to_vec(), name, Content::Triangulation, None) {
        Ok(mesh) => {
            assert!((1..=4).contains(&mesh.width) && !mesh.simplices.is_empty());
            assert!(mesh.simplices.len().is_multiple_of(mesh.width));
            // Parquet holds ids alone.
            let n = mesh.vertices.len();
            assert!(n == 0 || mesh.simplices.iter().all(|&id| (id as usize) < n));
            assert_eq!(n == 0, name == "fuzz.parquet");
            assert!(mesh.vertices.iter().flatten().all(|x| x.is_finite()));
        }
        Err(refused) => assert!(!refused.to_string().is_empty()),
    }
}

pub(crate) fn shape_ply(bytes: &[u8]) {
    shape(bytes, "fuzz.ply");
}

pub(crate) fn shape_obj(bytes: &[u8]) {
    shape(bytes, "fuzz.obj");
}

pub(crate) fn shape_off(bytes: &[u8]) {
    shape(bytes, "fuzz.off");
}

pub(crate) fn shape_stl(bytes: &[u8]) {
    shape(bytes, "fuzz.stl");
}

pub(crate) fn shape_xyz(bytes: &[u8]) {
    shape(bytes, "fuzz.xyz");
}

fn shape(bytes: &[u8], name: &str) {
    match open_mesh_bytes(bytes.to_vec(), name, Content::Surface, None) {
        Ok(mesh) => {
            let n = mesh.vertices.len();
            assert!(n > 0 && mesh.view().is_ok());
            assert!(mesh.colors.is_none_or(|colors| colors.len() == n));
            if let Some(normals) = mesh.normals {
                assert!(normals.len() == n && normals.iter().flatten().all(|x| x.is_finite()));
            }
        }
        Err(refused) => assert!(!refused.to_string().is_empty()),
    }
}

fn read(bytes: &[u8], format: Format, options: ReadOptions) -> Option<Input> {
    let options = ReadOptions { format: Some(format), ..options };
    let input = match open_bytes(bytes.to_vec(), "fuzz", &options) {
        Ok(input) => input,
        Err(refused) => {
            assert!(!refused.to_string().is_empty());
            return None;
        }
    };
    assert!(!input.source.is_empty());
    assert!(input.columns.is_empty() || input.columns.len() == input.source.dim());
    let mut scratch = Scratch::new();
    let rows = input.source.read(0..input.source.len(), &mut scratch).expect("in memory");
    assert_eq!(rows.first_non_finite(), None);
    Some(input)
}
