//! Files sorted, transposed and drawn, as bytes in memory.

use serde_json::Value;
use taut::Monitor;
use taut::certify::Trace;
use taut::certify::{DrawnSample, FileSolution, Files, SampleCertificate};
use taut::files::{StoredMatrix, sorted, transposed};
use taut::oblivious::external::{FileSortOptions, KeyKind, RecordLayout, sort_file};
use taut::oblivious::{TransposeFileOptions, sample, transpose_file};

use crate::random::Random;

/// A file that was written, beside the one it was made from.
pub struct FileCase {
    /// Which it is, for people to read.
    pub name: String,
    /// The file that was read; none for samples.
    pub input: Option<Vec<u8>>,
    /// The file that was written.
    pub output: Vec<u8>,
    /// The honest document.
    pub document: Value,
}

fn case(name: String, input: Option<Vec<u8>>, output: Vec<u8>, json: &str) -> FileCase {
    let document = serde_json::from_str(json).expect("a document is JSON");
    FileCase { name, input, output, document }
}

/// Returns sorted files of records, of each kind of key.
pub fn sorts() -> Vec<FileCase> {
    let folder = tempfile::tempdir().expect("a folder for files");
    let (from, to) = (folder.path().join("from"), folder.path().join("to"));
    let mut random = Random::new("sorts", 0);
    let mut found = vec![];
    for (kind, width, key) in [
        (KeyKind::U64, 8, 0..8),
        (KeyKind::I64, 16, 4..12),
        (KeyKind::F64, 9, 1..9),
        (KeyKind::Bytes, 5, 1..4),
        (KeyKind::Bytes, 1, 0..1),
    ] {
        for records in [0, 1, 12] {
            let mut input: Vec<u8> =
                (0..records * width).map(|_| random.next() as u8 % 4).collect();
            if records > 2 {
                input.copy_within(0..width, width);
            }
            std::fs::write(&from, &input).expect("files can be written");
            let layout = RecordLayout { width, key: key.clone(), kind };
            let options = FileSortOptions { memory: 1 << 20, ..Default::default() };
            let sort = sort_file(&from, &to, &layout, &options, &Monitor::silent());
            let solution = sorted(&layout, &sort.expect("records can be sorted"));
            let output = std::fs::read(&to).expect("the output is there");
            let name = format!("{records} records of {width} bytes by {kind:?}");
            found.push(case(name, Some(input), output, &solution.to_json()));
        }
    }
    found
}

/// Returns transposed files, in either order and with bytes before the elements.
pub fn transposes() -> Vec<FileCase> {
    let folder = tempfile::tempdir().expect("a folder for files");
    let (from, to) = (folder.path().join("from"), folder.path().join("to"));
    let mut random = Random::new("transposes", 0);
    let monitor = Monitor::silent();
    let mut found = vec![];
    for (rows, columns, width) in [(3, 4, 1), (2, 5, 3), (1, 6, 2), (4, 1, 8), (0, 3, 2), (4, 4, 2)]
    {
        for by_columns in [false, true] {
            let offset = rows + 2;
            let length = offset + rows * columns * width as u64;
            let input: Vec<u8> = (0..length).map(|_| random.next() as u8 % 3).collect();
            std::fs::write(&from, &input).expect("files can be written");
            let stored = StoredMatrix { rows, columns, width, offset, by_columns, dtype: None };
            let options = TransposeFileOptions::default();
            let turned = transpose_file(&from, stored.matrix(), &to, b"head", &options, &monitor);
            let turned = turned.expect("a matrix can be transposed");
            let output = std::fs::read(&to).expect("the output is there");
            let answer = stored.transpose(4);
            let (mut read, mut written) =
                (std::io::Cursor::new(&input), std::io::Cursor::new(&output));
            let files = Files { input: Some(&mut read), output: &mut written };
            let certificate = answer.certify(files, &monitor).expect("the transpose is right");
            let solution = transposed(answer, certificate, &turned);
            let name = format!("{rows} by {columns} elements of {width} bytes");
            found.push(case(name, Some(input), output, &solution.to_json()));
        }
    }
    found
}

/// Returns samples.
pub fn samples() -> Vec<FileCase> {
    let mut found = vec![];
    for (of, drawn) in [(0, 0), (1, 1), (10, 4), (10, 9), (20, 20), (u64::MAX, 5), (1 << 40, 8)] {
        for seed in [0, 7, u64::MAX] {
            let numbers = sample(seed, of, drawn).expect("numbers can be drawn");
            let text: String = numbers.iter().map(|number| format!("{number}\n")).collect();
            let solution = FileSolution {
                answer: DrawnSample { of, drawn },
                certificate: SampleCertificate { seed },
                trace: Trace::default(),
            };
            let name = format!("{drawn} of {of} by seed {seed}");
            found.push(case(name, None, text.into_bytes(), &solution.to_json()));
        }
    }
    found
}
