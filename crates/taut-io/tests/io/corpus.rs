//! The seeds of the fuzzers and what the fuzzers found, run as plain tests.

use std::path::Path;

use super::parsers;

#[test]
fn every_kept_input_is_read_or_refused() {
    let seeds = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds");
    if !seeds.exists() {
        println!(
            "skipped every_kept_input_is_read_or_refused: this package comes without its seeds"
        );
        return;
    }
    for (name, parse) in parsers::ALL {
        let mut count = 0;
        for entry in std::fs::read_dir(seeds.join(name)).unwrap() {
            parse(&std::fs::read(entry.unwrap().path()).unwrap());
            count += 1;
        }
        assert!(count > 0, "{name} has no seed");
    }
}

/// Lists of lists of booleans, and a list of doubles at the end of the file, take no bytes: the decoder by itself goes through
/// 2³¹ · 2³¹ of them.
#[test]
fn page_headers_that_never_end_are_refused() {
    let seeds = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds/mesh_parquet");
    for name in ["booleans-of-no-bytes", "doubles-of-no-bytes"] {
        let Ok(bytes) = std::fs::read(seeds.join(name)) else {
            return println!("skipped page_headers_that_never_end_are_refused: no seeds");
        };
        let refused =
            taut_io::open_mesh_bytes(bytes, "found.parquet", taut_io::Content::Triangulation, None)
                .unwrap_err()
                .to_string();
        assert!(refused.contains("no reader can pass over"), "{name}: {refused}");
    }
}
