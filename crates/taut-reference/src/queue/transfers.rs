//! Blocks that a queue moves between a memory of M entries and what lies beyond, beside the bound.

use std::cell::Cell;
use std::convert::Infallible;

use super::core::Core;
use super::spill::Spill;

/// Blocks beyond memory, each of whose moves is counted; a key that is looked at moves its block, too.
struct Counted {
    limit: usize,
    block: usize,
    kept: Vec<(Vec<u64>, Vec<u32>)>,
    moved: Cell<u64>,
}

impl Spill<u32> for Counted {
    type Error = Infallible;
    const ROOM_KEPT: usize = 4;

    fn limit(&self) -> usize {
        self.limit
    }

    fn block(&self) -> usize {
        self.block
    }

    fn keep(&mut self, keys: &[u64], values: &[u32]) -> Result<u32, Infallible> {
        self.moved.set(self.moved.get() + 1);
        self.kept.push((keys.to_vec(), values.to_vec()));
        Ok(self.kept.len() as u32 - 1)
    }

    fn give_back(
        &mut self,
        block: u32,
        keys: &mut Vec<u64>,
        values: &mut Vec<u32>,
    ) -> Result<(), Infallible> {
        self.moved.set(self.moved.get() + 1);
        let (mut of_block, mut with_them) = std::mem::take(&mut self.kept[block as usize]);
        keys.append(&mut of_block);
        values.append(&mut with_them);
        Ok(())
    }

    fn key(&self, block: u32, place: usize) -> Result<u64, Infallible> {
        self.moved.set(self.moved.get() + 1);
        Ok(self.kept[block as usize].0[place])
    }
}

fn random(state: &mut u64) -> u64 {
    *state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
    *state >> 20
}

fn push(queue: &mut Core<u32, Counted>, key: u64) {
    let Ok(()) = queue.push(key, 0);
}

fn pop(queue: &mut Core<u32, Counted>) -> u64 {
    let Ok(found) = queue.pop();
    found.expect("as many were pushed").0
}

/// Blocks moved over (n/B)·(1 + log₂(n/M)), n entries pushed and popped in all.
fn ratio(pattern: &str, n: usize, limit: usize) -> f64 {
    let block = limit / 256;
    let spill = Counted { limit, block, kept: Vec::new(), moved: Cell::new(0) };
    let mut queue = Core::new(spill);
    let (mut state, mut least) = (1, 0);
    match pattern {
        // A heap of half the entries whose smallest comes back later, as in a simulation of events.
        "events" => {
            (0..n / 2).for_each(|_| push(&mut queue, random(&mut state)));
            for _ in 0..n / 2 {
                let key = pop(&mut queue);
                assert!(key >= least);
                least = key;
                push(&mut queue, key + random(&mut state));
            }
        }
        _ => {
            let group = (n / 64) as u64;
            for i in 0..n as u64 {
                let key = match pattern {
                    "random" => random(&mut state),
                    "rising" => i,
                    "falling" => n as u64 - i,
                    // Each group is below all earlier ones.
                    _ => ((64 - i / group) << 48) + random(&mut state),
                };
                push(&mut queue, key);
            }
        }
    }
    while queue.len() > 0 {
        let key = pop(&mut queue);
        assert!(key >= least, "{pattern}: keys leave in order");
        least = key;
    }
    let (n, limit, block) = (n as f64, limit as f64, block as f64);
    queue.spill().moved.get() as f64 / (n / block * (1.0 + (n / limit).log2()))
}

/// The bound is O((1/B)·log₂(n/M)) blocks for each entry, which its push, its splits and its pop share.
#[test]
fn blocks_moved_keep_the_bound() {
    for pattern in ["random", "rising", "falling", "groups", "events"] {
        let mut largest = 0.0f64;
        for limit in [2048, 8192] {
            for n in [1 << 14, 1 << 16, 1 << 18] {
                largest = largest.max(ratio(pattern, n, limit));
            }
        }
        println!("queue, {pattern}: {largest:.3} of (n/B)(1 + log₂(n/M)), allowed 2");
        assert!(largest <= 2.0, "{pattern}: {largest}");
    }
}
