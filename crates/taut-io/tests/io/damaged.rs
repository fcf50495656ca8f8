//! Files that were cut short or changed on the way: an error, never fewer points in silence, never a panic.

use std::path::Path;

use proptest::prelude::*;
use taut_io::{Content, Feature, Format, RawLayout, ReadOptions, open, open_bytes, write_points};
use taut_points::{Distribution, Monitor, Points, ScalarKind, generate};

use super::unpacks;
use crate::test_length::long_or;

/// 40 points of dimension 3 as a file of the given name.
fn sample(folder: &Path, name: &str) -> Vec<u8> {
    let values: Vec<f64> = generate(Distribution::Normal, 40, 3, 11).unwrap();
    let path = folder.join(name);
    let points = Points::new(&values, 3).unwrap();
    write_points(&points, &[], &path, None, &Monitor::silent()).unwrap();
    std::fs::read(path).unwrap()
}

fn names() -> Vec<&'static str> {
    let all = ["p.npy", "p.parquet", "p.arrow", "p.csv.gz", "p.csv.xz", "p.csv.zst", "p.npy.gz"];
    let read = |name: &&str| Format::of_path(Path::new(name)).0.unwrap().reads(Content::Points);
    all.into_iter().filter(read).filter(|name| unpacks(name)).collect()
}

#[test]
fn no_cut_gives_points() {
    let folder = tempfile::tempdir().unwrap();
    for name in names() {
        let whole = sample(folder.path(), name);
        assert_eq!(
            open_bytes(whole.clone(), name, &ReadOptions::default()).unwrap().source.len(),
            40
        );
        for cut in 0..whole.len() {
            let read = open_bytes(whole[..cut].to_vec(), name, &ReadOptions::default());
            let Err(refused) = read else { panic!("{name} cut at {cut} of {}", whole.len()) };
            assert!(refused.to_string().starts_with(name), "{cut}: {refused}");
        }
        // The way over a file is another one for npy (read in place) and parquet.
        let path = folder.path().join(name);
        for cut in (0..whole.len()).step_by(37) {
            std::fs::write(&path, &whole[..cut]).unwrap();
            assert!(open(&path, &ReadOptions::default()).is_err(), "{name} cut at {cut}");
        }
    }
}

#[cfg(feature = "arrow")]
#[test]
fn no_cut_of_an_arrow_stream_gives_points() {
    let folder = tempfile::tempdir().unwrap();
    let file = sample(folder.path(), "p.arrow");
    // The stream inside of the file ends where the footer begins.
    let footer = u32::from_le_bytes(file[file.len() - 10..file.len() - 6].try_into().unwrap());
    let stream = &file[64..file.len() - 10 - footer as usize];
    assert_eq!(
        open_bytes(stream.to_vec(), "s.arrow", &ReadOptions::default()).unwrap().source.len(),
        40
    );
    for cut in (0..stream.len()).step_by(3) {
        assert!(
            open_bytes(stream[..cut].to_vec(), "s.arrow", &ReadOptions::default()).is_err(),
            "{cut}"
        );
    }
}

/// Files of other programs, cut anywhere and with any byte changed.
#[test]
fn no_cut_and_no_change_of_files_of_other_programs_ends_in_a_panic() {
    let seeds = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds");
    if !seeds.exists() {
        return println!("skipped: this package comes without its seeds");
    }
    for name in [
        "pcd/binary.pcd",
        "pcd/compressed.pcd",
        "npz/stored.npz",
        "npz/packed.npz",
        "shapefile/heights.shp",
        "shapefile/line.shp",
        "shapefile/multi.shp",
        "shapefile/polygons.shp",
        "parquet/points.geo.parquet",
        "parquet/polygon.geo.parquet",
    ] {
        if !Format::of_path(Path::new(name)).0.unwrap().reads(Content::Points) {
            continue;
        }
        let whole = std::fs::read(seeds.join(name)).unwrap();
        // The archive of two arrays is the one where a choice is needed.
        let feature = name.contains("stored").then(|| Feature::Name("cloud".to_owned()));
        let options = ReadOptions { feature, ..Default::default() };
        let read = |bytes: Vec<u8>| open_bytes(bytes, name, &options);
        let expected = super::values(&read(whole.clone()).unwrap());
        for cut in (0..whole.len()).step_by(long_or(1, 3)) {
            let Err(refused) = read(whole[..cut].to_vec()) else {
                panic!("{name} cut at {cut} of {}", whole.len())
            };
            assert!(refused.to_string().starts_with(name), "{cut}: {refused}");
        }
        for at in (0..whole.len()).step_by(long_or(1, 3)) {
            for bits in [1, 0x80, 0xff] {
                let mut changed = whole.clone();
                changed[at] ^= bits;
                let Ok(found) = read(changed) else { continue };
                let values = super::values(&found);
                assert!(values.iter().all(|value| value.is_finite()), "{name}, byte {at}");
                // Only archives have checksums.
                assert!(!name.contains("npz") || values == expected, "{name}, byte {at}");
            }
        }
    }
}

#[test]
fn a_message_about_a_cut_stream_says_so() {
    let folder = tempfile::tempdir().unwrap();
    for (name, wanted) in [
        ("p.csv.gz", "the gzip stream is damaged or ends early"),
        ("p.csv.xz", "the xz stream is damaged or ends early"),
        ("p.csv.zst", "the zstd stream is damaged or ends early"),
        ("p.npy", "p.npy is cut short or damaged: its npy header promises 960 bytes of values"),
    ]
    .into_iter()
    .filter(|(name, _)| unpacks(name))
    {
        let whole = sample(folder.path(), name);
        let cut = whole[..whole.len() - 20].to_vec();
        let said = open_bytes(cut, name, &ReadOptions::default()).unwrap_err().to_string();
        assert!(said.contains(wanted), "{said}");
    }
}

#[test]
fn a_file_that_is_too_long_is_not_called_cut_short() {
    let folder = tempfile::tempdir().unwrap();
    let mut long = sample(folder.path(), "p.npy");
    long.extend([0; 8]);
    let said = open_bytes(long, "p.npy", &ReadOptions::default()).unwrap_err().to_string();
    let wanted = "p.npy is longer than it says or damaged: its npy header promises 960 bytes of values, but there are 968";
    assert_eq!(said, wanted);
}

#[cfg(feature = "zstd")]
#[test]
fn zstd_streams_carry_a_checksum() {
    let folder = tempfile::tempdir().unwrap();
    let packed = sample(folder.path(), "p.npy.zst");
    // The flag of a checksum in the frame header descriptor, RFC 8878, 3.1.1.1.1.
    assert_eq!(packed[4] & 0b100, 0b100);
    let mut changed = packed;
    *changed.last_mut().unwrap() ^= 1;
    assert!(open_bytes(changed, "p.npy.zst", &ReadOptions::default()).is_err());
}

#[test]
fn no_shape_of_a_header_ends_in_a_panic() {
    for shape in [
        "(1, 18446744073709551615)",
        "(1, 2305843009213693953)",
        "(18446744073709551615, 3)",
        "(2305843009213693953, 8)",
    ] {
        for order in ["True", "False"] {
            let mut text =
                format!("{{'descr': '<f8', 'fortran_order': {order}, 'shape': {shape}, }}");
            while text.len() % 64 != 53 {
                text.push(' ');
            }
            text.push('\n');
            let bytes = [
                b"\x93NUMPY\x01\x00",
                &(text.len() as u16).to_le_bytes()[..],
                text.as_bytes(),
                &[0; 64],
            ]
            .concat();
            let path = tempfile::tempdir().unwrap();
            let path = path.path().join("p.npy");
            std::fs::write(&path, &bytes).unwrap();
            assert!(open(&path, &ReadOptions::default()).is_err(), "{shape}");
            assert!(open_bytes(bytes, "p.npy", &ReadOptions::default()).is_err(), "{shape}");
        }
    }
    for dim in [usize::MAX, 2_305_843_009_213_693_953] {
        let raw = Some(RawLayout { dim, scalar: ScalarKind::F64, offset: 0 });
        let options = ReadOptions { raw, ..Default::default() };
        assert!(open_bytes(vec![0; 64], "p.raw", &options).is_err());
    }
}

#[test]
fn a_name_that_promises_another_format_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let files: Vec<Vec<u8>> = names().iter().map(|name| sample(folder.path(), name)).collect();
    for format in [Format::Npy, Format::Parquet, Format::Arrow, Format::Tsplib, Format::Xyz] {
        for (bytes, name) in files.iter().zip(names()) {
            if Format::of_path(Path::new(name)).0 != Some(format) {
                let options = ReadOptions { format: Some(format), ..Default::default() };
                assert!(open_bytes(bytes.clone(), name, &options).is_err(), "{name} as {format}");
            }
        }
    }
    for name in ["p.csv.gz", "p.csv.xz", "p.csv.zst"].into_iter().filter(|name| unpacks(name)) {
        assert!(open_bytes(b"1,2\n3,4\n".to_vec(), name, &ReadOptions::default()).is_err());
    }
}

proptest! {
    /// A few changed bytes: whatever is read, it is never a panic, and never a point that is not finite.
    #[test]
    fn changed_bytes_are_points_or_an_error(
        which in 0_usize..7,
        changes in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..4),
    ) {
        thread_local! {
            static FILES: Vec<(&'static str, Vec<u8>)> = {
                let folder = tempfile::tempdir().unwrap();
                names().into_iter().map(|name| (name, sample(folder.path(), name))).collect()
            };
        }
        let (name, mut bytes) = FILES.with(|files| files[which % files.len()].clone());
        for (at, byte) in changes {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        if let Ok(input) = open_bytes(bytes, name, &ReadOptions::default()) {
            prop_assert!(super::values(&input).iter().all(|value| value.is_finite()));
        }
    }

    #[test]
    fn any_bytes_are_points_or_an_error(
        which in 0_usize..9,
        bytes in proptest::collection::vec(any::<u8>(), 0..300),
        start in 0_usize..4,
        dim in 1_usize..5,
    ) {
        let starts: [&[u8]; 4] = [b"", b"\x93NUMPY\x01\x00\x76\x00{'descr': '<f8', ", b"PAR1", b"ARROW1\0\0\xff\xff\xff\xff"];
        let bytes = [starts[start], &bytes].concat();
        let options = ReadOptions {
            format: Format::of(Content::Points).nth(which),
            raw: Some(RawLayout { dim, scalar: ScalarKind::F32, offset: 0 }),
            ..Default::default()
        };
        if let Ok(input) = open_bytes(bytes, "any", &options) {
            prop_assert!(super::values(&input).iter().all(|value| value.is_finite()));
        }
    }

    /// Text made of what tables are made of goes deeper than any bytes do.
    #[test]
    fn any_table_is_points_or_an_error(
        which in 0_usize..5,
        content in "([0-9.,;\t\" eEnax#\r\n+-]|NODE_COORD_SECTION\n|DIMENSION:2\n|EOF\n){0,80}",
    ) {
        let format = [Format::Csv, Format::Tsv, Format::Whitespace, Format::Tsplib, Format::Xyz][which];
        let options = ReadOptions { format: Some(format), ..Default::default() };
        if let Ok(input) = super::text_with("any", &content, &options) {
            prop_assert!(super::values(&input).iter().all(|value| value.is_finite()));
        }
    }
}
