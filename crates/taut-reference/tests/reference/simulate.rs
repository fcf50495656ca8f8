//! The simulator against brute force: each policy on ten thousand random traces, and what the policies promise.

use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use taut_oblivious::{Access, Probe};
use taut_reference::simulate::{CacheShape, Counts, Simulator, StackDistances, Trace};

/// The simulated array begins here.
const BASE: usize = 1 << 20;
/// Bytes of a block in these tests.
const BLOCK: usize = 16;

/// Block and whether it is written.
type Blocks = Vec<(u64, bool)>;

fn traces() -> impl Strategy<Value = Blocks> {
    (1u64..14).prop_flat_map(|blocks| prop::collection::vec((0..blocks, any::<bool>()), 0..70))
}

fn replay(probe: &mut impl Probe, blocks: &Blocks) {
    probe.place_at(BASE, 64 * BLOCK);
    for &(block, write) in blocks {
        let access = if write { Access::Write } else { Access::Read };
        probe.record(BASE + block as usize * BLOCK + 3, 2, access);
    }
}

/// Sets as lists, the next to go first.
fn by_hand(blocks: &Blocks, sets: usize, ways: usize, lru: bool) -> Counts {
    let mut lists: Vec<Blocks> = vec![Vec::new(); sets];
    let mut counts = Counts { accesses: blocks.len() as u64, ..Counts::default() };
    for &(block, write) in blocks {
        let list = &mut lists[block as usize % sets];
        if let Some(place) = list.iter().position(|entry| entry.0 == block) {
            list[place].1 |= write;
            if lru {
                let entry = list.remove(place);
                list.push(entry);
            }
            continue;
        }
        counts.misses += 1;
        if list.len() == ways {
            counts.write_backs += u64::from(list.remove(0).1);
        }
        list.push((block, write));
    }
    counts.dirty = lists.iter().flatten().filter(|entry| entry.1).count() as u64;
    counts
}

/// SplitMix64, and a number below `n` by its upper bits.
fn drawn(state: &mut u64, n: usize) -> usize {
    *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let x = (*state ^ *state >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let x = (x ^ x >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((u128::from(x ^ x >> 31) * n as u128) >> 64) as usize
}

/// Sets as arrays that are filled from the front; in a full one a drawn place is taken.
fn by_chance(blocks: &Blocks, sets: usize, ways: usize, mut seed: u64) -> Counts {
    let mut arrays: Vec<Blocks> = vec![Vec::new(); sets];
    let mut counts = Counts { accesses: blocks.len() as u64, ..Counts::default() };
    for &(block, write) in blocks {
        let array = &mut arrays[block as usize % sets];
        if let Some(entry) = array.iter_mut().find(|entry| entry.0 == block) {
            entry.1 |= write;
            continue;
        }
        counts.misses += 1;
        if array.len() < ways {
            array.push((block, write));
        } else {
            let gone = std::mem::replace(&mut array[drawn(&mut seed, ways)], (block, write));
            counts.write_backs += u64::from(gone.1);
        }
    }
    counts.dirty = arrays.iter().flatten().filter(|entry| entry.1).count() as u64;
    counts
}

/// Belady by looking ahead at every miss; of those that never come back the highest number goes.
fn farthest_first(blocks: &Blocks, held: usize) -> Counts {
    let mut there = Blocks::new();
    let mut counts = Counts { accesses: blocks.len() as u64, ..Counts::default() };
    for (now, &(block, write)) in blocks.iter().enumerate() {
        if let Some(entry) = there.iter_mut().find(|entry| entry.0 == block) {
            entry.1 |= write;
            continue;
        }
        counts.misses += 1;
        if there.len() == held {
            let comes = |b: u64| blocks[now..].iter().position(|t| t.0 == b).unwrap_or(usize::MAX);
            let victim = (0..held).max_by_key(|&i| (comes(there[i].0), there[i].0));
            counts.write_backs += u64::from(there.remove(victim.expect("a block is there")).1);
        }
        there.push((block, write));
    }
    counts.dirty = there.iter().filter(|entry| entry.1).count() as u64;
    counts
}

/// The fewest misses of all choices.
fn fewest(blocks: &[(u64, bool)], there: &mut Vec<u64>, held: usize) -> u64 {
    let Some((&(block, _), rest)) = blocks.split_first() else { return 0 };
    if there.contains(&block) {
        return fewest(rest, there, held);
    }
    if there.len() < held {
        there.push(block);
        let misses = 1 + fewest(rest, there, held);
        there.pop();
        return misses;
    }
    let all = (0..held).map(|victim| {
        let gone = std::mem::replace(&mut there[victim], block);
        let misses = 1 + fewest(rest, there, held);
        there[victim] = gone;
        misses
    });
    all.min().expect("a block is there")
}

fn run(cases: u32, test: impl Fn(Blocks, usize, usize) -> Result<(), TestCaseError>) {
    let config = Config { cases, failure_persistence: None, ..Config::default() };
    let result = TestRunner::new_with_rng(
        config,
        proptest::test_runner::TestRng::deterministic_rng(
            proptest::test_runner::RngAlgorithm::ChaCha,
        ),
    )
    .run(&(traces(), 1usize..5, 1usize..7), |(blocks, sets, ways)| test(blocks, sets, ways));
    if let Err(error) = result {
        panic!("{error}");
    }
}

fn counts(shape: CacheShape, blocks: &Blocks) -> Counts {
    let mut simulator = Simulator::new(&[shape]).expect("a cache");
    replay(&mut simulator, blocks);
    assert_eq!(simulator.unannounced(), 0);
    simulator.counts(0)
}

#[test]
fn lru_equals_brute_force_on_ten_thousand_traces() {
    run(10_000, |blocks, _, held| {
        let shape = CacheShape::lru(held * BLOCK, BLOCK);
        prop_assert_eq!(counts(shape, &blocks), by_hand(&blocks, 1, held, true));
        Ok(())
    });
}

#[test]
fn fifo_equals_brute_force_on_ten_thousand_traces() {
    run(10_000, |blocks, _, held| {
        let shape = CacheShape::fifo(held * BLOCK, BLOCK);
        prop_assert_eq!(counts(shape, &blocks), by_hand(&blocks, 1, held, false));
        Ok(())
    });
}

#[test]
fn sets_equal_brute_force_on_ten_thousand_traces() {
    run(10_000, |blocks, sets, ways| {
        for (lru, shape) in [(true, CacheShape::lru as fn(_, _) -> _), (false, CacheShape::fifo)] {
            let shape = shape(sets * ways * BLOCK, BLOCK).with_ways(ways);
            prop_assert_eq!(counts(shape, &blocks), by_hand(&blocks, sets, ways, lru));
        }
        Ok(())
    });
}

#[test]
fn random_equals_brute_force_on_ten_thousand_traces() {
    run(10_000, |blocks, sets, ways| {
        let seed = 7 * blocks.len() as u64;
        let shape = CacheShape::random(sets * ways * BLOCK, BLOCK, seed).with_ways(ways);
        prop_assert_eq!(counts(shape, &blocks), by_chance(&blocks, sets, ways, seed));
        Ok(())
    });
}

/// Going round m + 1 blocks, one is always away. The block that a miss throws out is any of the m others, and the next miss is
/// when its turn comes, (m + 1)/2 accesses later in the mean; LRU and FIFO miss each time.
#[test]
fn random_misses_as_often_as_chance_says_where_lru_always_does() {
    let (held, accesses) = (63u64, 400_000u64);
    let shapes = [
        CacheShape::random(held as usize * BLOCK, BLOCK, 1),
        CacheShape::random(held as usize * BLOCK, BLOCK, 2),
        CacheShape::lru(held as usize * BLOCK, BLOCK),
        CacheShape::fifo(held as usize * BLOCK, BLOCK),
    ];
    let mut simulator = Simulator::new(&shapes).expect("caches");
    replay(&mut simulator, &(0..accesses).map(|i| (i % (held + 1), false)).collect());
    let misses = [0, 1, 2, 3].map(|cache| simulator.counts(cache).misses);
    assert_eq!(misses[2..], [accesses, accesses]);
    assert_ne!(misses[0], misses[1], "seeds matter");
    for misses in &misses[..2] {
        // 12 500 gaps with a standard deviation of 18: their mean of 32 is right to 0.17, or to 4 % at seven of these.
        let expected = 2.0 * accesses as f64 / (held + 1) as f64;
        assert!((*misses as f64 / expected - 1.0).abs() < 0.04, "{misses}, {expected}");
    }
}

#[test]
fn optimal_equals_brute_force_on_ten_thousand_traces() {
    run(10_000, |blocks, _, held| {
        let mut trace = Trace::new(BLOCK).expect("a power of two");
        replay(&mut trace, &blocks);
        let found = trace.optimal(held * BLOCK, BLOCK).expect("a cache");
        prop_assert_eq!(found, farthest_first(&blocks, held));
        Ok(())
    });
}

#[test]
fn no_choice_beats_the_farthest_first() {
    run(1000, |blocks, _, held| {
        let held = held.min(3);
        let few: Blocks = blocks.into_iter().map(|(b, w)| (b % 6, w)).take(14).collect();
        prop_assert_eq!(farthest_first(&few, held).misses, fewest(&few, &mut Vec::new(), held));
        Ok(())
    });
}

#[test]
fn stack_distances_equal_lru_of_every_size_on_ten_thousand_traces() {
    run(10_000, |blocks, _, _| {
        let mut distances = StackDistances::new(BLOCK).expect("a power of two");
        replay(&mut distances, &blocks);
        let curve = distances.curve();
        prop_assert_eq!(curve[0], blocks.len() as u64);
        prop_assert_eq!(curve.last().copied(), Some(distances.cold()));
        for held in 1..16 {
            let misses = by_hand(&blocks, 1, held, true).misses;
            prop_assert_eq!(distances.misses(held * BLOCK), misses);
            prop_assert_eq!(curve[held.min(curve.len() - 1)], misses);
        }
        Ok(())
    });
}

/// The tree is renumbered many times, with few blocks and with many.
#[test]
fn stack_distances_survive_long_traces() {
    for spread in [3u64, 700, 5000] {
        let mut state = 1u64;
        let blocks: Blocks = (0..40_000)
            .map(|_| {
                state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                ((state >> 33) % spread, false)
            })
            .collect();
        let mut distances = StackDistances::new(BLOCK).expect("a power of two");
        let shapes = [1, 2, 64, 512, 4096].map(|held| CacheShape::lru(held * BLOCK, BLOCK));
        let mut simulator = Simulator::new(&shapes).expect("caches");
        for probe in [&mut distances as &mut dyn DynProbe, &mut simulator] {
            probe.replay(&blocks, spread as usize * BLOCK);
        }
        for (i, shape) in shapes.iter().enumerate() {
            assert_eq!(distances.misses(shape.memory), simulator.counts(i).misses);
        }
    }
}

/// Probes have constants, so they make no trait objects; this does.
trait DynProbe {
    fn replay(&mut self, blocks: &Blocks, bytes: usize);
}

impl<P: Probe> DynProbe for P {
    fn replay(&mut self, blocks: &Blocks, bytes: usize) {
        self.place_at(BASE, bytes);
        for &(block, _) in blocks {
            self.record(BASE + block as usize * BLOCK, 1, Access::Read);
        }
    }
}

#[test]
fn larger_memories_miss_less_and_the_best_is_within_twice_of_half() {
    run(2000, |blocks, _, held| {
        let mut trace = Trace::new(BLOCK).expect("a power of two");
        replay(&mut trace, &blocks);
        let lru =
            |held: usize| trace.simulate(CacheShape::lru(held * BLOCK, BLOCK)).map(|c| c.misses);
        let best = |held: usize| trace.optimal(held * BLOCK, BLOCK).map(|c| c.misses);
        prop_assert!(lru(held + 1).unwrap() <= lru(held).unwrap());
        prop_assert!(best(held).unwrap() <= lru(held).unwrap());
        prop_assert!(lru(2 * held).unwrap() <= 2 * best(held).unwrap());
        Ok(())
    });
}

/// The second cache of a chain records the misses and write-backs of the first, in that order.
#[test]
fn a_chain_hands_down_misses_and_write_backs() {
    run(2000, |blocks, _, held| {
        let shapes = [CacheShape::lru(held * BLOCK, BLOCK), CacheShape::lru(4 * BLOCK, 2 * BLOCK)];
        let mut chain = Simulator::chained(&shapes).expect("caches");
        replay(&mut chain, &blocks);
        let first = by_hand(&blocks, 1, held, true);
        prop_assert_eq!(chain.counts(0), first);
        let second = chain.counts(1);
        prop_assert_eq!(second.accesses, first.misses + first.write_backs);
        prop_assert!(second.misses <= second.accesses);
        prop_assert!(second.write_backs + second.dirty <= first.write_backs);
        Ok(())
    });
}

#[test]
fn an_access_of_many_blocks_is_one_of_each() {
    let bytes = vec![0u8; 1000];
    let mut simulator =
        Simulator::new(&[CacheShape::lru(256, 64), CacheShape::fifo(256, 256)]).expect("caches");
    simulator.place(&bytes);
    simulator.read(&bytes);
    simulator.write(&bytes[60..70]);
    simulator.read(&bytes[..0]);
    let expected = Counts { accesses: 18, misses: 18, write_backs: 0, dirty: 2 };
    assert_eq!(simulator.counts(0), expected);
    assert_eq!(simulator.counts(0).transfers(), 20);
    assert_eq!(simulator.counts(1).misses, 5);
    assert_eq!(simulator.unannounced(), 0);
    let elsewhere = vec![0u8; 10];
    simulator.read(&elsewhere);
    assert_eq!(simulator.unannounced(), 1);
}

/// The same announcements and accesses at other addresses give the same counts.
#[test]
fn counts_do_not_depend_on_addresses() {
    let shapes = [CacheShape::L1, CacheShape::L2, CacheShape::DTLB, CacheShape::lru(4096, 64)];
    let replay = |places: [usize; 3]| {
        let mut simulator = Simulator::new(&shapes).expect("caches");
        for place in places {
            simulator.place_at(place, 100_000);
        }
        for i in 0..30_000 {
            simulator.record(places[i % 3] + i * i % 99_991, 8, Access::Write);
        }
        [0, 1, 2, 3].map(|cache| simulator.counts(cache))
    };
    assert_eq!(
        replay([1 << 20, 1 << 22, 1 << 24]),
        replay([(1 << 24) + 8, (1 << 22) + 24, 1 << 20])
    );
}

#[test]
fn curves_are_rows() {
    let mut trace = Trace::new(64).expect("a power of two");
    replay(&mut trace, &(0..64).chain(0..64).map(|b| (b, false)).collect());
    let rows = trace.misses_by_memory(64, &[64, 512, 1024]).expect("a power of two");
    assert_eq!(rows.iter().map(|r| r.misses).collect::<Vec<_>>(), [32, 32, 16]);
    assert_eq!(rows[2].to_string(), "1024,64,16");
    let rows = trace.misses_by_block(512, &[16, 32, 64]).expect("powers of two");
    assert_eq!(rows.iter().map(|r| r.misses).collect::<Vec<_>>(), [128, 64, 32]);
    assert!(trace.misses_by_block(512, &[1024]).is_err());
    assert_eq!(trace.accesses().len(), 128);
}

#[test]
fn what_is_no_cache_is_refused_by_name() {
    let message = |shape| match Simulator::new(&[shape]) {
        Ok(_) => String::new(),
        Err(error) => error.to_string(),
    };
    for (shape, part) in [
        (CacheShape::lru(4096, 0), "option `block` is 0"),
        (CacheShape::lru(4096, 48), "option `block` is 48"),
        (CacheShape::lru(0, 64), "option `ways`"),
        (CacheShape::lru(100, 64), "option `memory` is 100"),
        (CacheShape::lru(4096, 64).with_ways(0), "option `ways` is 0"),
        (CacheShape::lru(4096, 64).with_ways(65), "option `ways` is 65"),
        (CacheShape::lru(4096, 64).with_ways(3), "option `memory` is 4096"),
        (CacheShape::lru(1 << 40, 1), "option `memory`"),
    ] {
        assert!(message(shape).contains(part), "{shape:?}: {}", message(shape));
    }
    assert!(Simulator::chained(&[CacheShape::L1, CacheShape::lru(1, 3)]).is_err());
    assert!(StackDistances::new(3).is_err());
    assert!(Trace::new(0).is_err());
    let mut nothing = Simulator::new(&[]).expect("no cache is not wrong");
    replay(&mut nothing, &vec![(1, true)]);
}

/// Accesses per second, the best of some runs: `cargo test --release -p taut-oblivious --test simulate -- --ignored
/// --nocapture` shows them.
#[test]
#[ignore = "a measurement: run it alone and optimized"]
fn accesses_per_second() {
    use std::time::Instant;
    use taut_reference::algorithms::{MatrixSizes, mergesort_instrumented, multiply_instrumented};

    fn product(probe: &mut impl Probe) {
        let n = 100;
        let (a, b, mut c) = (vec![1.0; n * n], vec![1.0; n * n], vec![0.0; n * n]);
        multiply_instrumented(&a, &b, &mut c, MatrixSizes::square(n), 1, probe).expect("square");
    }
    fn sort(probe: &mut impl Probe) {
        let mut keys: Vec<u64> = (0..50_000).map(|i: u64| i.wrapping_mul(0x9E37_79B9)).collect();
        mergesort_instrumented(&mut keys, probe);
    }
    /// Every access a miss, or nearly.
    fn scattered(probe: &mut impl Probe) {
        let (array, mut state) = (vec![0u64; 1 << 22], 1u64);
        probe.place(&array);
        for _ in 0..2_000_000 {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            let i = (state >> 42) as usize;
            probe.read(&array[i..=i]);
        }
    }
    fn fastest<P>(fresh: impl Fn() -> P, run: fn(&mut P), accesses: impl Fn(&P) -> u64) -> f64 {
        let rate = |_| {
            let mut probe = fresh();
            let start = Instant::now();
            run(&mut probe);
            accesses(&probe) as f64 / start.elapsed().as_secs_f64() / 1e6
        };
        (0..9).map(rate).fold(0.0, f64::max)
    }
    let show = |name: &str, rates: [f64; 3]| {
        println!(
            "{name:<24} product {:6.1}, sort {:6.1}, scattered {:6.1} M/s",
            rates[0], rates[1], rates[2]
        );
    };
    for (name, shapes) in [
        ("LRU, 32 KiB", vec![CacheShape::lru(1 << 15, 64)]),
        ("LRU, 1 MiB", vec![CacheShape::lru(1 << 20, 64)]),
        ("FIFO, 1 MiB", vec![CacheShape::fifo(1 << 20, 64)]),
        ("L1", vec![CacheShape::L1]),
        ("L1, L2 and DTLB at once", vec![CacheShape::L1, CacheShape::L2, CacheShape::DTLB]),
    ] {
        let fresh = || Simulator::new(&shapes).expect("caches");
        let accesses = |simulator: &Simulator| simulator.counts(0).accesses;
        let rates = [product, sort, scattered].map(|run| fastest(fresh, run, accesses));
        show(name, rates);
        assert!(shapes.len() > 1 || rates.iter().all(|&rate| rate >= 20.0), "{rates:?}");
    }
    let fresh = || StackDistances::new(64).expect("a power of two");
    let rates = [product, sort, scattered].map(|run| fastest(fresh, run, StackDistances::accesses));
    show("stack distances", rates);
    assert!(rates.iter().all(|&rate| rate >= 5.0), "{rates:?}");
}
