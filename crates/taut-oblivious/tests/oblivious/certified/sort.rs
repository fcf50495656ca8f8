//! Sorted files.

use proptest::collection::vec;
use proptest::prelude::*;
use taut_certify::{
    AnyFileSolution, FileSolution, FileViolation, Hash128, KeyKind, SortCertificate, SortedFile,
    Trace, WhichFile,
};
use taut_oblivious::external::{self, FileSortOptions, RecordLayout, sort_file};
use taut_points::Monitor;

use super::{judge, no_change_is_confirmed, words};

/// Sorts bytes by the solver; the answer and the bytes in order.
fn sorted(
    input: &[u8],
    width: usize,
    key: [usize; 2],
    kind: KeyKind,
) -> (AnyFileSolution, Vec<u8>) {
    sorted_behind(0, input, width, key, kind)
}

/// The same of records behind some bytes.
fn sorted_behind(
    header: u64,
    input: &[u8],
    width: usize,
    key: [usize; 2],
    kind: KeyKind,
) -> (AnyFileSolution, Vec<u8>) {
    let folder = tempfile::tempdir().unwrap();
    let (from, to) = (folder.path().join("from"), folder.path().join("to"));
    std::fs::write(&from, input).unwrap();
    let theirs = match kind {
        KeyKind::U64 => external::KeyKind::U64,
        KeyKind::I64 => external::KeyKind::I64,
        KeyKind::F64 => external::KeyKind::F64,
        KeyKind::Bytes => external::KeyKind::Bytes,
    };
    let layout = RecordLayout { width, key: key[0]..key[1], kind: theirs };
    let options = FileSortOptions { memory: 64 << 10, header, ..Default::default() };
    let found = sort_file(&from, &to, &layout, &options, &Monitor::silent()).unwrap();
    let answer = SortedFile {
        records: found.certificate.records,
        width: width as u64,
        header,
        key: key.map(|byte| byte as u64),
        key_kind: kind,
    };
    let hash = found.certificate.hash.wrapping_add(found.header_hash);
    let certificate = SortCertificate { hash: Hash128(hash) };
    let solution = FileSolution { answer, certificate, trace: Trace::default() };
    (AnyFileSolution::Sort(solution), std::fs::read(&to).unwrap())
}

fn records(count: u64) -> Vec<u8> {
    words(3 * count).iter().flat_map(|word| word.to_le_bytes()).collect()
}

#[test]
fn what_was_sorted_is_confirmed_with_and_without_the_input() {
    for kind in [KeyKind::U64, KeyKind::I64, KeyKind::F64, KeyKind::Bytes] {
        // More than memory holds, so that runs are merged.
        let input = records(4000);
        let (found, output) = sorted(&input, 24, [8, 16], kind);
        assert!(judge(&found, Some(&input), &output).unwrap().compared);
        let verdict = judge(&found, None, &output).unwrap();
        assert_eq!((verdict.items, verdict.compared), (4000, false), "{kind:?}");
        // Another kind of key is another order.
        let unsorted = judge(&found, None, &input).unwrap_err();
        assert!(matches!(unsorted, FileViolation::Unsorted { .. }), "{unsorted}");
    }
    let (nothing, output) = sorted(&[], 24, [8, 16], KeyKind::U64);
    assert_eq!(judge(&nothing, Some(&[]), &output).unwrap().items, 0);
}

#[test]
fn every_field_counts() {
    let input = records(300);
    let (found, output) = sorted(&input, 24, [8, 16], KeyKind::U64);
    no_change_is_confirmed(
        &found,
        None,
        &output,
        &[
            ("records", &["299", "301", "0", "18446744073709551615", "-1"]),
            ("width", &["23", "12", "48", "0", "18446744073709551615"]),
            ("key", &["[0, 8]", "[8, 8]", "[16, 8]", "[9, 17]", "[20, 28]", "[8, 15]", "[8]"]),
            ("key_kind", &["\"i64\"", "\"f64\"", "\"bytes\"", "\"u32\""]),
            ("hash", &["\"00000000000000000000000000000000\"", "\"0\"", "7"]),
        ],
    );
}

#[test]
fn other_bytes_are_seen() {
    let input = records(200);
    let (found, output) = sorted(&input, 24, [8, 16], KeyKind::U64);
    for at in (0..output.len()).step_by(37) {
        let mut changed = output.clone();
        changed[at] ^= 1;
        assert!(judge(&found, Some(&input), &changed).is_err(), "output, byte {at}");
        let mut changed = input.clone();
        changed[at] ^= 0x80;
        let refused = judge(&found, Some(&changed), &output).unwrap_err();
        let input = WhichFile::Input;
        assert!(matches!(refused, FileViolation::Hash { file, .. } if file == input), "{refused}");
    }
    let lost = [&output[24..], &output[output.len() - 24..]].concat();
    assert!(matches!(judge(&found, None, &lost), Err(FileViolation::Hash { .. })), "one twice");
    assert!(matches!(judge(&found, None, &output[24..]), Err(FileViolation::Length { .. })));
}

/// In memory and beyond: what is before the first record stays there, and no byte of it is another one.
#[test]
fn a_header_is_copied_and_judged() {
    for (count, header) in [(300, 128), (4000, 77), (4000, 4096), (0, 5)] {
        let before: Vec<u8> = (0..header).map(|byte| byte as u8).collect();
        let input = [&before[..], &records(count)].concat();
        let (found, output) = sorted_behind(header, &input, 24, [8, 16], KeyKind::U64);
        let plain = sorted(&input[before.len()..], 24, [8, 16], KeyKind::U64).1;
        assert!(output == [&before[..], &plain].concat(), "{count} {header}");
        assert!(judge(&found, Some(&input), &output).unwrap().compared);
        let mut other = output.clone();
        other[3] ^= 1;
        assert!(matches!(judge(&found, None, &other), Err(FileViolation::Hash { .. })));
        assert!(judge(&found, Some(&other), &output).is_err());
        let bare = judge(&found, None, &plain);
        assert!(matches!(bare, Err(FileViolation::Length { .. })), "{bare:?}");
    }
    let input = [&[7; 40][..], &records(30)].concat();
    let (found, output) = sorted_behind(40, &input, 24, [8, 16], KeyKind::U64);
    no_change_is_confirmed(
        &found,
        None,
        &output,
        &[
            ("header", &["0", "39", "64", "18446744073709551615", "-1"]),
            ("records", &["29", "31", "0"]),
            ("width", &["23", "12", "48", "0"]),
            ("key", &["[0, 8]", "[8, 8]", "[16, 8]", "[8, 15]"]),
            ("key_kind", &["\"i64\"", "\"f64\""]),
            ("hash", &["\"00000000000000000000000000000000\""]),
        ],
    );
}

/// Signs of two neighbors, and the pairs of bits that a weak hash mixes alike.
#[test]
fn doubles_that_change_signs_are_other_records() {
    let record = |x: f64, y: u64| [x.to_bits(), y].map(u64::to_le_bytes).concat();
    let input = record(1.5, 2.5f64.to_bits());
    let (found, output) = sorted(&input, 16, [0, 8], KeyKind::U64);
    assert!(judge(&found, Some(&input), &output).is_ok());
    for bits in [1 << 63, 1 << 63 | 1 << 31, 1 << 31] {
        let other = record(-1.5, 2.5f64.to_bits() ^ bits);
        assert!(judge(&found, None, &other).is_err(), "{bits:x}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Keys of few values, of any length; the checker's multiset is that of the solver.
    #[test]
    fn records_of_any_width(bytes in vec(0u8..3, 0..600), width in 1usize..20, cut in 0usize..20) {
        let input = &bytes[..bytes.len() / width * width];
        let start = cut % width;
        let (found, output) = sorted(input, width, [start, width], KeyKind::Bytes);
        prop_assert!(judge(&found, Some(input), &output).is_ok());
        prop_assert_eq!(judge(&found, None, input).is_ok(), input == output);
    }
}
