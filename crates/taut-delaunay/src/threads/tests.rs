//! Small sets by several threads that are held up at every vertex, beside one thread.

use std::sync::atomic::Ordering::Relaxed;
use std::time::{Duration, Instant};

use taut_points::{Distribution, Monitor, Points, generate};

use super::round::in_turn;
use crate::affine::Span;
use crate::geometry::{Geometry, InPlane, InSpace};
use crate::kernel::Kernel;
use crate::rounds::insert_all_in_parallel;
use crate::sites::Sites;
use crate::{DelaunayOptions, delaunay};

/// Seeded numbers (SplitMix64; Steele, Lea and Flood, OOPSLA 2014).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.0;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ (x >> 31)
    }

    fn below(&mut self, end: u64) -> u64 {
        self.next() % end
    }

    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Up to `most` points: anywhere, on a grid with many ties, on a sphere, on a few lines, or around one.
fn points(numbers: &mut Numbers, dim: usize, most: u64) -> Vec<f64> {
    let (kind, count) = (numbers.below(5), 4 + numbers.below(most - 3));
    let side = 2 + numbers.below(9);
    let mut values = Vec::new();
    for i in 0..count {
        let mut p: Vec<f64> = (0..dim).map(|_| numbers.unit() - 0.5).collect();
        match kind {
            0 => {}
            1 => p.iter_mut().for_each(|x| *x = (*x * side as f64).floor()),
            2 => {
                let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
                p.iter_mut().for_each(|x| *x /= length);
            }
            3 => p[1..].iter_mut().enumerate().for_each(|(k, x)| *x = (i % side) as f64 + k as f64),
            _ if i == 0 => p[0] = 100.0,
            _ => p[0] = 0.0,
        }
        values.extend(p);
    }
    values
}

/// Sets until `is_enough`; returns how many.
fn compare(seed: u64, most: u64, mut is_enough: impl FnMut(u32) -> bool) -> u32 {
    let mut numbers = Numbers(seed);
    let mut done = 0;
    while !is_enough(done) {
        let dim = 2 + numbers.below(2) as usize;
        let values = points(&mut numbers, dim, most);
        let view = Points::new(&values, dim).expect("whole rows");
        let alone = DelaunayOptions { threads: Some(1), ..DelaunayOptions::default() };
        let expected = delaunay(&view, &alone).expect("finite points");
        let together = DelaunayOptions {
            threads: Some(2 + numbers.below(7) as usize),
            sites_per_thread: Some(1),
            vectors: numbers.below(2) == 0,
            ..alone
        };
        let found = delaunay(&view, &together).expect("finite points");
        assert!(found == expected, "set {done} of seed {seed}: {together:?}, {view:?}");
        done += 1;
    }
    done
}

#[test]
fn small_sets_have_the_same_simplices() {
    let sets = crate::test_length::long_or(10_000, 60);
    assert_eq!(compare(1, 200, |done| done >= sets), sets);
}

/// `TAUT_SOAK_SECONDS=600 cargo test --release -p taut-delaunay --lib threads::tests::soak -- --ignored --nocapture`
#[test]
#[ignore = "runs for as many seconds as TAUT_SOAK_SECONDS says"]
fn soak() {
    let seconds = std::env::var("TAUT_SOAK_SECONDS").ok().and_then(|s| s.parse().ok());
    let end = Instant::now() + Duration::from_secs(seconds.unwrap_or(60));
    let seed = std::env::var("TAUT_SOAK_SEED").ok().and_then(|s| s.parse().ok());
    let done = compare(seed.unwrap_or(2), 3000, |_| Instant::now() > end);
    println!("{done} sets, each the same");
}

/// The time of a build on this many threads, if each had a processor of its own, beside that on one: of each round the part that took
/// longest, and all that one thread does. Parts are done in turn, so that no thread gets into another's way.
fn path<const D: usize, const V: usize, G: Geometry<D, V>>(n: usize, threads: usize) -> [f64; 2] {
    let values: Vec<f64> =
        generate(Distribution::Uniform, n, D, 5).expect("parameters are in range");
    let points = Points::new(&values, D).expect("whole rows");
    let monitor = Monitor::silent();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("one thread");
    let build = |threads: usize| {
        pool.install(|| {
            let begin = Instant::now();
            let sites = Sites::<D>::new(&points, true, &monitor).expect("finite");
            let Span::Full(start) = G::span(&sites.coordinates) else { panic!("points span all") };
            let ordered = begin.elapsed();
            let begin = Instant::now();
            let mut mesh = G::Mesh::new(sites.coordinates, sites.settings);
            mesh.start(start);
            let options = DelaunayOptions::default();
            insert_all_in_parallel(&mut mesh, &start, &options, threads).expect("few simplices");
            assert!(!mesh.simplices().is_empty());
            [ordered.as_secs_f64(), begin.elapsed().as_secs_f64()]
        })
    };
    in_turn::ON.store(true, Relaxed);
    let [_, one] = build(1);
    in_turn::ROUNDS.lock().expect("nobody panics").clear();
    let [_, all] = build(threads);
    let rounds = std::mem::take(&mut *in_turn::ROUNDS.lock().expect("nobody panics"));
    in_turn::ON.store(false, Relaxed);
    let sum: f64 = rounds.iter().flatten().map(Duration::as_secs_f64).sum();
    let longest: f64 =
        rounds.iter().map(|parts| parts.iter().max().map_or(0.0, Duration::as_secs_f64)).sum();
    [one, all - sum + longest]
}

/// `cargo test --release -p taut-delaunay --lib threads::tests::critical_path -- --ignored --nocapture`
#[test]
#[ignore = "takes a minute, and prints times"]
fn critical_path() {
    println!("| points | threads | insertion on one thread over the longest path |\n|---|---|---|");
    for threads in [2, 8, 16, 64] {
        let [one, longest] = path::<2, 3, InPlane>(1_000_000, threads);
        println!("| plane 10⁶ | {threads} | {:.1} |", one / longest);
        let [one, longest] = path::<3, 4, InSpace>(1_000_000, threads);
        println!("| space 10⁶ | {threads} | {:.1} |", one / longest);
    }
}
