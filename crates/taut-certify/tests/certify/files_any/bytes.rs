//! Any bytes as an answer about files and the files it is about: no check panics, or asks for more memory than there are bytes.

use std::io::Cursor;

use taut_certify::{AnyFileSolution, FileCheckError, Files};
use taut_points::Monitor;

/// A document up to the first byte 0, then two files cut at the next.
pub(crate) fn check_any(bytes: &[u8]) {
    let mut parts = bytes.splitn(3, |&byte| byte == 0);
    let [text, input, output] = [(); 3].map(|()| parts.next().unwrap_or_default());
    let Ok(found) = AnyFileSolution::from_json(&String::from_utf8_lossy(text)) else { return };
    // What is read is written as it was read.
    assert_eq!(AnyFileSolution::from_json(&found.to_json()).expect("read"), found);
    for from in [None, Some(input)] {
        let (mut from_data, mut to) = (Cursor::new(from.unwrap_or_default()), Cursor::new(output));
        let input = from.map(|_| &mut from_data as &mut dyn taut_certify::Data);
        let judged = found.check(Files { input, output: &mut to }, &Monitor::silent());
        assert!(!matches!(judged, Err(FileCheckError::Read { .. })), "bytes in memory can be read");
    }
}
