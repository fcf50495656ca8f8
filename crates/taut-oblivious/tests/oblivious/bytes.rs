//! Tests what the fuzzer calls with any bytes, and the tests with seeds.

use taut_oblivious::external::{FileSortOptions, KeyKind, RecordLayout, sort_file};
use taut_points::Monitor;

/// The first byte, and what is left; 0 and nothing of nothing.
fn head(bytes: &[u8]) -> (u8, &[u8]) {
    bytes.split_first().map_or((0, bytes), |(&first, rest)| (first, rest))
}

/// Records of any width, sorted through files in as little memory as there can be.
pub(crate) fn sort_any(bytes: &[u8]) {
    let ((width, rest), kinds) = (head(bytes), [KeyKind::U64, KeyKind::I64, KeyKind::F64]);
    let (choice, rest) = head(rest);
    let width = 1 + usize::from(width) % 48;
    let (kind, key) = match width.checked_sub(8) {
        Some(room) if choice % 4 < 3 => {
            let start = usize::from(choice / 4) % (room + 1);
            (kinds[usize::from(choice % 4)], start..start + 8)
        }
        _ => {
            let start = usize::from(choice / 4) % width;
            (KeyKind::Bytes, start..width)
        }
    };
    // Many records of few bytes, so that runs are merged.
    let copies = if choice & 64 == 0 { 1 } else { 200_000 / rest.len().max(1) };
    let input = rest.repeat(copies);
    let input = &input[..input.len() / width * width];
    let folder = tempfile::tempdir().expect("a folder");
    let (from, to) = (folder.path().join("from"), folder.path().join("to"));
    std::fs::write(&from, input).expect("a file");
    let layout = RecordLayout { width, key: key.clone(), kind };
    let options = FileSortOptions { memory: 64 << 10, ..Default::default() };
    let monitor = Monitor::silent();
    sort_file(&from, &to, &layout, &options, &monitor).expect("sorted");
    let mut expected: Vec<&[u8]> = input.chunks(width).collect();
    let word = |record: &[u8]| u64::from_le_bytes(record[key.clone()].try_into().expect("eight"));
    expected.sort_by(|a, b| match kind {
        KeyKind::U64 => word(a).cmp(&word(b)),
        KeyKind::I64 => word(a).cast_signed().cmp(&word(b).cast_signed()),
        KeyKind::F64 => f64::from_bits(word(a)).total_cmp(&f64::from_bits(word(b))),
        KeyKind::Bytes => a[key.clone()].cmp(&b[key.clone()]),
    });
    assert!(std::fs::read(&to).expect("there") == expected.concat());
}
