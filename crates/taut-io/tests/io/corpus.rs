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
