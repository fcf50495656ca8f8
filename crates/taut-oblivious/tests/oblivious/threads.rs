//! Every function that runs on the threads of a pool gives the same bytes with one, two and eight of them.
//!
//! Sizes are above those from which on threads share the work; what they are is said beside each.

use std::path::Path;

use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
use taut_oblivious::external::{FileSortOptions, KeyKind, RecordLayout, sort_file};
use taut_oblivious::kdtree::KdTree;
use taut_oblivious::*;
use taut_points::Monitor;

use crate::test_length::long_or;

/// Words without pattern.
fn words(n: usize, seed: u64) -> Vec<u64> {
    let word = |i: u64| {
        let z = (seed ^ i).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        (z ^ z >> 29).wrapping_mul(0xBF58_476D_1CE4_E5B9)
    };
    (0..n as u64).map(|i| word(i) ^ word(i) >> 32).collect()
}

/// Numbers in [−1, 1) with few digits, so that there are equal ones.
fn numbers(n: usize, seed: u64) -> Vec<f64> {
    words(n, seed).iter().map(|word| (word >> 44) as f64 / 524_288.0 - 1.0).collect()
}

fn points<const D: usize>(n: usize, seed: u64) -> Vec<[f64; D]> {
    numbers(n * D, seed).as_chunks::<D>().0.to_vec()
}

fn bytes<T: bytemuck::NoUninit>(values: &[T]) -> Vec<u8> {
    bytemuck::cast_slice(values).to_vec()
}

fn sorted<T: Key + bytemuck::NoUninit>(mut keys: Vec<T>) -> Vec<u8> {
    sort(&mut keys);
    bytes(&keys)
}

/// Through a file of 16-byte records.
fn sorted_file(seed: u64, n: usize, memory: usize) -> Vec<u8> {
    through_files(&bytes(&words(2 * n, seed)), |from, to| {
        let layout = RecordLayout { width: 16, key: 1..9, kind: KeyKind::U64 };
        let options = FileSortOptions { memory, ..Default::default() };
        sort_file(from, to, &layout, &options, &Monitor::silent()).expect("sorted");
    })
}

fn through_files(input: &[u8], run: impl FnOnce(&Path, &Path)) -> Vec<u8> {
    let folder = tempfile::tempdir().expect("a folder");
    let [from, to] = ["from", "to"].map(|name| folder.path().join(name));
    std::fs::write(&from, input).expect("written");
    run(&from, &to);
    std::fs::read(&to).expect("an output")
}

type Job = (&'static str, fn(u64) -> Vec<u8>);

const JOBS: &[Job] = &[
    // From 2¹⁶ keys.
    ("sort of words", |seed| sorted(words(100_000, seed))),
    ("sort of halves", |seed| {
        sorted(words(100_000, seed).iter().map(|w| *w as u32).collect::<Vec<_>>())
    }),
    ("sort of few numbers", |seed| {
        sorted(words(100_000, seed).iter().map(|w| (w % 100) as f64).collect::<Vec<_>>())
    }),
    // From a mebibyte.
    ("sort_records", |seed| {
        let mut records: Vec<[u64; 2]> = (0..).map(|i| [0, i]).take(100_000).collect();
        records.iter_mut().zip(words(100_000, seed)).for_each(|(record, w)| record[0] = w % 5000);
        sort_records(&mut records, |record| record[0]);
        assert!(records.is_sorted());
        bytes(&records)
    }),
    ("sort_records of crowded keys", |seed| {
        let mut records: Vec<[u64; 2]> = (0..).map(|i| [0, i]).take(100_000).collect();
        let crowded = |w: u64| if w.is_multiple_of(64) { w } else { w % 7 };
        records.iter_mut().zip(words(100_000, seed)).for_each(|(r, w)| r[0] = crowded(w));
        sort_records(&mut records, |record| record[0]);
        assert!(records.is_sorted());
        bytes(&records)
    }),
    // 25 runs; two past the system's cache; in memory by words and in place.
    ("sort_file of many runs", |seed| sorted_file(seed, 60_000, 64 << 10)),
    ("sort_file past the cache", |seed| sorted_file(seed, 100_000, 2 << 20)),
    ("sort_file of what fits", |seed| sorted_file(seed, 60_000, 4 << 20)),
    ("sort_file in place", |seed| sorted_file(seed, 100_000, 16 << 20)),
    // From 2¹⁸ elements.
    ("transpose", |seed| {
        let (from, mut to) = (words(601 * 523, seed), vec![0; 601 * 523]);
        transpose(&from, 601, 523, &mut to).expect("transposed");
        bytes(&to)
    }),
    ("transpose_in_place", |seed| {
        let mut matrix = words(601 * 523, seed);
        transpose_in_place(&mut matrix, 601, 523).expect("transposed");
        bytes(&matrix)
    }),
    // One tile as large as that, and tiles.
    ("transpose_file", |seed| {
        let from = bytes(&words(601 * 523, seed));
        let matrix = FileMatrix { rows: 601, columns: 523, width: 8, offset: 0 };
        let run = |memory| {
            through_files(&from, |from, to| {
                let (options, monitor) = (TransposeFileOptions { memory }, Monitor::silent());
                transpose_file(from, matrix, to, b"header", &options, &monitor).expect("a file");
            })
        };
        [run(8 << 20), run(1 << 20)].concat()
    }),
    // From 2¹⁵ samples or items.
    ("sample", |seed| bytes(&sample(seed, 1 << 50, 80_000).expect("a sample"))),
    ("bernoulli", |seed| bytes(&bernoulli(seed, 1 << 30, 8e4 / 2f64.powi(30)).expect("some"))),
    ("shuffle", |seed| {
        let mut items: Vec<u32> = (0..150_000).collect();
        shuffle(&mut items, seed);
        bytes(&items)
    }),
    // From 2¹⁴ points, and from 2¹² places.
    ("hilbert_order", |seed| {
        let (plane, space) = (points::<2>(50_000, seed), points::<3>(50_000, seed));
        [hilbert_order(50_000, |i| plane[i]), hilbert_order(50_000, |i| space[i])]
            .map(|order| bytes(&order))
            .concat()
    }),
    ("morton_order", |seed| {
        let (plane, space) = (points::<2>(50_000, seed), points::<3>(50_000, seed));
        [morton_order(50_000, |i| plane[i]), morton_order(50_000, |i| space[i])]
            .map(|order| bytes(&order))
            .concat()
    }),
    ("kd-tree", |seed| {
        let tree = KdTree::new(&points::<3>(70_000, seed)).expect("a tree");
        let places = points::<3>(10_000, !seed);
        let rows = |found: &[kdtree::Nearest]| -> Vec<u8> {
            found.iter().flat_map(|found| found.row.to_le_bytes()).collect()
        };
        let all: Vec<_> = tree.nearest_all(&places).into_iter().flatten().collect();
        let few = places.iter().step_by(50).flat_map(|&place| tree.nearest_k(place, 5));
        [rows(&all), rows(&few.collect::<Vec<_>>())].concat()
    }),
];

proptest! {
    #![proptest_config(Config {
        cases: long_or(2, 1),
        rng_seed: RngSeed::Fixed(8),
        failure_persistence: None,
        ..Config::default()
    })]

    #[test]
    fn one_two_and_eight_give_the_same_bytes(seed: u64) {
        let pools = [1, 2, 8].map(|threads| {
            rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool")
        });
        for (name, job) in JOBS {
            let [one, two, eight] = pools.each_ref().map(|pool| pool.install(|| job(seed)));
            prop_assert!(!one.is_empty(), "{}", name);
            prop_assert!(one == two, "{} with two threads", name);
            prop_assert!(one == eight, "{} with eight threads", name);
        }
    }
}
