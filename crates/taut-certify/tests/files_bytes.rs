//! Any bytes as an answer about files, and the seeds of the fuzz target.

#[path = "files_any/bytes.rs"]
mod bytes;

use std::path::Path;

use proptest::prelude::*;

fn seeds() -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds/files");
    let seeds = std::fs::read_dir(folder).unwrap();
    seeds.map(|seed| std::fs::read(seed.unwrap().path()).unwrap()).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// A seed with bytes changed, cut or put in.
    #[test]
    fn edited_seeds(which in any::<usize>(), edits in prop::collection::vec((any::<usize>(), any::<u8>()), 0..6)) {
        let seeds = seeds();
        let mut seed = seeds[which % seeds.len()].clone();
        for (place, byte) in edits {
            let place = place % seed.len();
            match byte % 3 {
                0 => seed[place] = byte,
                1 => seed.insert(place, byte),
                _ => {
                    seed.drain(place..(place + 3).min(seed.len()));
                }
            }
            if seed.is_empty() {
                break;
            }
        }
        bytes::check_any(&seed);
    }
}

#[test]
fn the_seeds_pass() {
    let seeds = seeds();
    assert!(seeds.len() >= 4);
    seeds.iter().for_each(|seed| bytes::check_any(seed));
}
