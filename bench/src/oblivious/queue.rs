//! A queue of keys with values: all in, then all out in order.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use anyhow::{Result, ensure};
use serde_json::{Value, json};
use taut_reference::PriorityQueue;

use super::draw::Draw;
use super::guests::Guests;
use super::lanes::{Lanes, have_memory};
use crate::context::Context;
use crate::goals::Goals;
use crate::stats::times;

/// With values, and of keys alone, which its other queue is made for.
const QUICKHEAP: [&str; 2] = ["quickheap", "quickheap-keys"];

/// Beside std's heap and quickheap. All must hand out the keys as a sort does, each with the value that came with it.
pub(super) fn run(context: &Context) -> Result<Value> {
    let n = if context.quick { 100_000 } else { 10_000_000 };
    let keys = Draw(1).words(n);
    let mut sorted = keys.clone();
    sorted.sort_unstable();
    let expected: Vec<(u64, u64)> = sorted.into_iter().map(|key| (key, !key)).collect();
    let both: Vec<u64> = expected.iter().flat_map(|&(key, value)| [key, value]).collect();
    let mut lanes = Lanes::default();
    let mut guests = Guests::invite(context, &keys, 1, &QUICKHEAP)?;
    for _ in 0..context.runs {
        have_memory(64 * n)?;
        let out: Vec<(u64, u64)> = lanes.time("taut", || {
            let mut queue = PriorityQueue::new();
            keys.iter().for_each(|&key| queue.push(key, !key));
            std::iter::from_fn(|| queue.pop()).collect()
        });
        ensure!(out == expected, "taut: not in order");
        drop(out);
        have_memory(64 * n)?;
        let out: Vec<(u64, u64)> = lanes.time("BinaryHeap", || {
            let mut heap = BinaryHeap::new();
            keys.iter().for_each(|&key| heap.push(Reverse((key, !key))));
            std::iter::from_fn(|| heap.pop()).map(|Reverse(entry)| entry).collect()
        });
        ensure!(out == expected, "BinaryHeap: not in order");
        drop(out);
        have_memory(64 * n)?;
        guests.turn(context, &mut lanes, |name, out| {
            let same = match name == QUICKHEAP[0] {
                true => out == both,
                false => out.iter().eq(both.iter().step_by(2)),
            };
            ensure!(same, "{name}: not in order");
            Ok(())
        })?;
    }
    println!("{n} entries of 16 bytes, in and out\n\n{}", lanes.table(n));
    let mut goals = Goals::default();
    let ratio = lanes.faster("taut", "BinaryHeap");
    goals.aim("BinaryHeap over taut at least 5".into(), times(ratio), ratio >= 5.0);
    let ratio = lanes.faster("taut", QUICKHEAP[1]);
    let met = (!ratio.is_nan()).then_some(ratio >= 0.9);
    goals.aim("quickheap of keys alone over taut at least 0.9".into(), times(ratio), met);
    Ok(json!({ "n": n, "lanes": lanes.json(n), "goals": goals.json() }))
}
