//! Transposed files.

use proptest::prelude::*;
use taut_certify::{
    AnyFileSolution, ElementOrder, FileSolution, FileViolation, Files, Hash128,
    TransposeCertificate, TransposedFile,
};
use taut_points::Monitor;

use super::{judge, no_change_is_confirmed, words};

/// The answer about a matrix, certified by the checker.
fn certified(answer: TransposedFile, input: &[u8], output: &[u8]) -> AnyFileSolution {
    let (mut from, mut to) = (std::io::Cursor::new(input), std::io::Cursor::new(output));
    let files = Files { input: Some(&mut from), output: &mut to };
    let certificate = answer.certify(files, &Monitor::silent()).unwrap();
    AnyFileSolution::Transpose(FileSolution { answer, certificate, trace: Default::default() })
}

fn answer(rows: u64, columns: u64, width: u64, offsets: [u64; 2]) -> TransposedFile {
    let [input_offset, output_offset] = offsets;
    let order = ElementOrder::Rows;
    TransposedFile { rows, columns, width, order, input_offset, output_offset, dtype: None }
}

/// A matrix of that many bytes, and its transpose, one element after the other.
fn matrix(rows: usize, columns: usize, width: usize) -> (Vec<u8>, Vec<u8>) {
    let count = rows * columns * width;
    let bytes: Vec<u8> = words(count as u64).into_iter().map(|word| word as u8).collect();
    let places = (0..columns).flat_map(|j| (0..rows).map(move |i| (i * columns + j) * width));
    let turned = places.flat_map(|at| bytes[at..at + width].to_vec()).collect();
    (bytes, turned)
}

#[test]
fn both_files_or_one() {
    let (bytes, turned) = matrix(30, 41, 3);
    let output = [b"header".to_vec(), turned.clone()].concat();
    let found = certified(answer(30, 41, 3, [0, 6]), &bytes, &output);
    assert_eq!(judge(&found, Some(&bytes), &output).unwrap().items, 30 * 41);
    assert!(!judge(&found, None, &output).unwrap().compared);
    for at in (6..output.len()).step_by(53) {
        let mut changed = output.clone();
        changed[at] ^= 4;
        let refused = judge(&found, Some(&bytes), &changed).unwrap_err();
        let place = (at as u64 - 6) / 3;
        assert!(
            matches!(refused, FileViolation::Element { row, column, .. } if (row, column) == (place / 30, place % 30)),
            "{refused}"
        );
        assert!(matches!(judge(&found, None, &changed), Err(FileViolation::Hash { .. })));
    }
    assert!(judge(&found, Some(&bytes[1..]), &output).is_err(), "shorter");
    assert!(judge(&found, Some(&turned), &output).is_err(), "not turned");
}

#[test]
fn every_field_counts() {
    let (bytes, turned) = matrix(5, 8, 2);
    let input = [b"ab".to_vec(), bytes].concat();
    let found = certified(answer(5, 8, 2, [2, 0]), &input, &turned);
    let changes: &[(&str, &[&str])] = &[
        ("rows", &["4", "8", "0", "10", "18446744073709551615"]),
        ("columns", &["5", "7", "16", "0"]),
        ("width", &["1", "4", "0", "18446744073709551615"]),
        ("order", &["\"columns\"", "\"diagonals\""]),
        ("input_offset", &["0", "3", "18446744073709551615"]),
        ("output_offset", &["2", "18446744073709551615"]),
        ("hash", &["\"00000000000000000000000000000001\""]),
    ];
    no_change_is_confirmed(&found, Some(&input), &turned, changes);
    // The same bytes as another matrix: of one row more and a shorter element.
    let other = answer(10, 8, 1, [2, 0]);
    let certificate = TransposeCertificate { hash: Hash128(0) };
    let other = FileSolution { answer: other, certificate, trace: Default::default() };
    assert!(judge(&AnyFileSolution::Transpose(other), Some(&input), &turned).is_err());
}

/// An array as NumPy writes it.
fn npy(dtype: &str, fortran: bool, shape: [u64; 2], values: &[u8]) -> Vec<u8> {
    let order = if fortran { "True" } else { "False" };
    let [n, d] = shape;
    let text = format!("{{'descr': '{dtype}', 'fortran_order': {order}, 'shape': ({n}, {d}), }}");
    let text = format!("{text:117}\n");
    let length = (text.len() as u16).to_le_bytes();
    [b"\x93NUMPY\x01\x00".to_vec(), length.to_vec(), text.into_bytes(), values.to_vec()].concat()
}

#[test]
fn headers_are_read() {
    let (bytes, turned) = matrix(6, 4, 8);
    let output = npy("<f8", false, [4, 6], &turned);
    let array = |order| TransposedFile {
        order,
        dtype: Some("<f8".to_owned()),
        ..answer(6, 4, 8, [128, 128])
    };
    // In Fortran order the input has the bytes of the output.
    for (order, fortran, values) in
        [(ElementOrder::Rows, false, &bytes), (ElementOrder::Columns, true, &turned)]
    {
        let input = npy("<f8", fortran, [6, 4], values);
        let found = certified(array(order), &input, &output);
        assert!(judge(&found, Some(&input), &output).is_ok());
        for wrong in [
            npy(">f8", false, [4, 6], &turned),
            npy("<f8", true, [4, 6], &turned),
            npy("<f8", false, [6, 4], &turned),
            npy("<f8", false, [24, 1], &turned),
            turned.clone(),
        ] {
            assert!(judge(&found, None, &wrong).is_err());
        }
        let mut damaged = output.clone();
        for at in 0..128 {
            damaged[at] ^= 0x15;
            assert!(judge(&found, None, &damaged).is_err(), "byte {at}");
            damaged[at] = output[at];
        }
        let changes: &[(&str, &[&str])] = &[
            ("rows", &["4"]),
            ("columns", &["6"]),
            ("width", &["4"]),
            ("order", &[if fortran { "\"rows\"" } else { "\"columns\"" }]),
            ("input_offset", &["127"]),
            ("output_offset", &["129"]),
            ("dtype", &["\"<i8\"", "\"\""]),
            ("hash", &["\"00000000000000000000000000000001\""]),
        ];
        no_change_is_confirmed(&found, Some(&input), &output, changes);
    }
}

/// A header with any text.
fn with_header(text: &str, values: &[u8]) -> Vec<u8> {
    let text = format!("{text:117}\n");
    let length = (text.len() as u16).to_le_bytes();
    [b"\x93NUMPY\x01\x00".as_slice(), &length, text.as_bytes(), values].concat()
}

#[test]
#[cfg(target_endian = "little")]
fn headers_that_numpy_reads_are_read() {
    let (bytes, turned) = matrix(6, 4, 8);
    let output = npy("<f8", false, [4, 6], &turned);
    let array = TransposedFile { dtype: Some("<f8".to_owned()), ..answer(6, 4, 8, [128, 128]) };
    for text in [
        r#"{"descr": "<f8", "fortran_order": False, "shape": (6, 4)}"#,
        "{'shape':(6,4),'descr':'<f8','fortran_order':False}",
        "{ 'descr' : 'f8' , 'fortran_order' : False , 'shape' : ( 6 , 4 , ) }",
        "{'descr': '=f8', 'fortran_order': False, 'shape': (6L, 4L), }",
        "{'descr': 'float64', 'fortran_order': False, 'shape': (6, 4), }",
    ] {
        let input = with_header(text, &bytes);
        let found = certified(array.clone(), &input, &output);
        assert!(judge(&found, Some(&input), &output).is_ok(), "{text}");
        for (from, to) in
            [("6", "7"), ("False", "True"), ("8'", "4'"), ("8\"", "4\""), ("4'", "2'")]
        {
            let other = with_header(&text.replace(from, to), &bytes);
            assert!(judge(&found, Some(&other), &output).is_err() || other == input, "{text} {to}");
        }
    }
    // What is written is as NumPy writes it, but for the name of the type.
    let input = npy("<f8", false, [6, 4], &bytes);
    let found = certified(array.clone(), &input, &output);
    for text in [
        r#"{"descr": "<f8", "fortran_order": False, "shape": (4, 6), }"#,
        "{'descr': '<f8', 'shape': (4, 6), 'fortran_order': False, }",
    ] {
        assert!(judge(&found, Some(&input), &with_header(text, &turned)).is_err(), "{text}");
    }
    let by_name = TransposedFile { dtype: Some("f8".to_owned()), ..array };
    certified(by_name, &npy("<f8", false, [6, 4], &bytes), &output);
}

#[test]
fn headers_that_lie_are_seen_without_a_type() {
    let (bytes, turned) = matrix(6, 4, 8);
    let array = answer(6, 4, 8, [128, 128]);
    let input = npy("<f8", false, [6, 4], &bytes);
    let output = npy("<f8", false, [4, 6], &turned);
    let found = certified(array.clone(), &input, &output);
    for wrong in [
        npy("<f8", false, [6, 4], &turned),
        npy("<f8", false, [24, 1], &turned),
        npy("<f8", true, [4, 6], &turned),
        npy("<f4", false, [4, 12], &turned),
        npy("<f4", false, [4, 6], &turned),
        npy("|O", false, [4, 6], &turned),
        with_header("{'descr': '<f8', 'shape': (4, 6), }", &turned),
    ] {
        let refused = judge(&found, None, &wrong).unwrap_err();
        assert!(matches!(refused, FileViolation::Header { .. }), "{refused}");
        assert!(judge(&found, Some(&input), &wrong).is_err());
    }
    for wrong in [npy("<f8", true, [6, 4], &bytes), npy("<f8", false, [4, 6], &bytes)] {
        let refused = judge(&found, Some(&wrong), &output).unwrap_err();
        assert!(matches!(refused, FileViolation::Header { .. }), "{refused}");
    }
    // Raw files with something before their elements, whatever it is.
    let raw = [vec![7; 128], bytes.clone()].concat();
    assert!(judge(&found, Some(&raw), &output).is_ok());
    assert!(judge(&found, None, &[vec![7; 128], turned.clone()].concat()).is_ok());
    let without = certified(answer(6, 4, 8, [128, 0]), &npy("|S7", true, [1, 1], &bytes), &turned);
    assert!(judge(&without, None, &turned).is_ok());
}

proptest! {
    /// Shapes of any kind, nothing included; element (i, j) of the input against every place.
    #[test]
    fn any_shape(rows in 0usize..40, columns in 0usize..40, width in 1usize..17) {
        let (bytes, turned) = matrix(rows, columns, width);
        let shape = answer(rows as u64, columns as u64, width as u64, [0, 0]);
        let found = certified(shape, &bytes, &turned);
        prop_assert!(judge(&found, Some(&bytes), &turned).is_ok());
        prop_assert!(judge(&found, None, &turned).is_ok());
        prop_assert_eq!(judge(&found, None, &bytes).is_ok(), bytes == turned);
    }
}

/// More than one tile: 8 MiB hold half of it.
#[test]
fn tiles_meet() {
    let (bytes, turned) = matrix(2100, 2100, 4);
    let found = certified(answer(2100, 2100, 4, [0, 0]), &bytes, &turned);
    let mut changed = turned.clone();
    *changed.last_mut().unwrap() ^= 1;
    assert!(matches!(judge(&found, Some(&bytes), &changed), Err(FileViolation::Element { .. })));
}
