//! Search in the layout of van Emde Boas, by index arithmetic: no tree is built.

use taut_oblivious::{Access, Probe};
use taut_reference::algorithms::{VebIndex, VebTree};

use super::{WORD, misses, random, row};

/// Blocks of 2^shift words on a path of a tree of that height whose array begins `before` words behind a border: the mean
/// over all paths and the most, which are the misses of a memory that is cold. Positions grow along a path, so a block
/// that was left does not come back.
fn cold_misses(height: usize, layouts: &[(u32, usize)]) -> Vec<(f64, f64)> {
    let index = VebIndex::new(height).expect("not too high");
    let mut blocks = vec![vec![1u32; height]; layouts.len()];
    let mut found = vec![(0u64, 0u32); layouts.len()];
    let mut positions = vec![0; height];
    for leaf in 1usize << (height - 1)..1 << height {
        // Only the last levels differ from those of the path before.
        let fresh = height - 1 - (leaf.trailing_zeros() as usize).min(height - 1);
        for depth in fresh.max(1)..height {
            let node = leaf >> (height - 1 - depth);
            positions[depth] = index.position(node, depth, &positions);
            let (above, here) = (positions[depth - 1], positions[depth]);
            assert!(above < here);
            for (blocks, &(shift, before)) in blocks.iter_mut().zip(layouts) {
                let crosses = (above + before) >> shift != (here + before) >> shift;
                blocks[depth] = blocks[depth - 1] + u32::from(crosses);
            }
        }
        for ((sum, most), blocks) in found.iter_mut().zip(&blocks) {
            *sum += u64::from(blocks[height - 1]);
            *most = blocks[height - 1].max(*most);
        }
    }
    let paths = 2f64.powi(height as i32 - 1);
    found.into_iter().map(|(sum, most)| (sum as f64 / paths, f64::from(most))).collect()
}

fn bound_holds(last: usize) {
    // At a border of blocks, and with one word before the first border.
    let layouts: Vec<_> =
        (3..=12).flat_map(|shift| [(shift, 0), (shift, (1 << shift) - 1)]).collect();
    let (mut mean_ratio, mut most_ratio) = (0.0f64, 0.0f64);
    for height in 1..=last {
        let nodes = 2f64.powi(height as i32) - 1.0;
        for ((mean, most), (shift, _)) in cold_misses(height, &layouts).into_iter().zip(&layouts) {
            let levels = nodes.log2() / f64::from(*shift);
            mean_ratio = mean_ratio.max(mean / (1.5 * levels + 2.0));
            most_ratio = most_ratio.max(most / (4.0 * levels + 2.0));
        }
    }
    let name = format!("van Emde Boas search, heights 1..{last}");
    row(&format!("{name}, mean"), "1.5 log_B n + 2, B = 8..4096", mean_ratio, 1.0);
    row(&format!("{name}, worst"), "4 log_B n + 2, B = 8..4096", most_ratio, 1.0);
}

#[test]
fn search_keeps_the_bound() {
    bound_holds(18);
}

#[test]
#[ignore = "seconds even when optimized"]
fn search_keeps_the_bound_for_every_height() {
    bound_holds(26);
}

/// Misses per search of 20 000 random paths of height 20 in a memory that stays warm, as another program measured them.
#[test]
fn searches_in_a_warm_memory_miss_as_measured_before() {
    const HEIGHT: usize = 20;
    let grid = [(4096, 8), (4096, 16), (65536, 64), (65536, 512)];
    let index = VebIndex::new(HEIGHT).expect("not too high");
    let search =
        |golden: [f64; 4], layout: &str, position: &dyn Fn(usize, usize, &[usize]) -> usize| {
            let base = 1 << 32;
            let found = misses(&grid, |probe| {
                probe.place_at(base, WORD << HEIGHT);
                let mut state = 3;
                let mut positions = [0; HEIGHT];
                for _ in 0..20_000 {
                    let mut node = 1;
                    for depth in 0..HEIGHT {
                        positions[depth] = position(node, depth, &positions);
                        probe.record(base + positions[depth] * WORD, WORD, Access::Read);
                        node = 2 * node + (random(&mut state) & 1) as usize;
                    }
                }
            });
            for (q, golden) in found.iter().zip(golden) {
                let ratio = q / 20_000.0 / golden;
                assert!((0.99..1.01).contains(&ratio), "{layout}: {q}, {golden}");
            }
            row(
                &format!("{layout} search, warm, M = 4096, B = 8"),
                "1 miss",
                found[0] / 20_000.0,
                golden[0] + 0.01,
            );
        };
    search([5.31, 4.28, 2.03, 1.68], "van Emde Boas", &|node, depth, positions| {
        index.position(node, depth, positions)
    });
    search([6.35, 5.76, 2.90, 2.75], "pre-order", &|node, depth, positions| match depth {
        0 => 0,
        _ => positions[depth - 1] + 1 + (node & 1) * ((1 << (HEIGHT - depth)) - 1),
    });
    search([10.22, 10.22, 5.49, 5.49], "breadth-first", &|node, _, _| node);
}

/// In a memory of one block each change of block is a miss.
#[test]
fn a_tree_with_keys_is_no_worse_than_its_index() {
    let keys: Vec<u64> = (0..4095).map(|i| 2 * i + 1).collect();
    let tree = VebTree::new(&keys).expect("sorted");
    let found = misses(&[(8, 8), (64, 64)], |probe| {
        probe.place(tree.nodes());
        for i in 0..4096 {
            assert_eq!(tree.lower_bound_instrumented(2 * i, probe), i as usize);
        }
    });
    for (q, shift) in found.into_iter().zip([3.0, 6.0]) {
        let formula = format!("1.5 log_B n + 2, B = {}", 1 << shift as u32);
        row(
            "van Emde Boas tree of 4095 keys",
            &formula,
            q / 4096.0 / (1.5 * 12.0 / shift + 2.0),
            1.0,
        );
    }
}
