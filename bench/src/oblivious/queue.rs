//! A queue of keys with values: all in, then all out in order.

use super::*;

/// With values, and of keys alone, which its other queue is made for.
const QUICKHEAP: [&str; 2] = ["quickheap", "quickheap-keys"];

/// Opponents std's heap and quickheap. All must hand out the keys as a sort does, each with the value that came with it.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let n = context.size(10_000_000, 100_000);
    let keys = Draw(1).words(n);
    let mut sorted = keys.clone();
    sorted.sort_unstable();
    let expected: Vec<(u64, u64)> = sorted.into_iter().map(|key| (key, !key)).collect();
    let both: Vec<u64> = expected.iter().flat_map(|&(key, value)| [key, value]).collect();
    let mut lanes = Lanes::default();
    let mut peers = Peers::start(context, &keys, 1, &QUICKHEAP)?;
    for _ in 0..context.runs {
        have_memory(64 * n)?;
        let popped: Vec<(u64, u64)> = lanes.time("taut", || {
            let mut queue = PriorityQueue::new();
            keys.iter().for_each(|&key| queue.push(key, !key));
            std::iter::from_fn(|| queue.pop()).collect()
        });
        ensure!(popped == expected, "taut: not in order");
        drop(popped);
        have_memory(64 * n)?;
        let popped: Vec<(u64, u64)> = lanes.time("BinaryHeap", || {
            let mut heap = BinaryHeap::new();
            keys.iter().for_each(|&key| heap.push(Reverse((key, !key))));
            std::iter::from_fn(|| heap.pop()).map(|Reverse(entry)| entry).collect()
        });
        ensure!(popped == expected, "BinaryHeap: not in order");
        drop(popped);
        have_memory(64 * n)?;
        peers.turn(context, &mut lanes, |name, popped| {
            let same = match name == QUICKHEAP[0] {
                true => popped == both,
                false => popped.iter().eq(both.iter().step_by(2)),
            };
            ensure!(same, "{name}: not in order");
            Ok(())
        })?;
    }
    out.table(&format!("{n} entries of 16 bytes, in and out"), lanes.table(n));
    let ratio = lanes.faster("taut", "BinaryHeap");
    out.at_least("BinaryHeap over taut", ratio, aim_only(5.0), Unit::Times);
    let ratio = lanes.faster("taut", QUICKHEAP[1]);
    out.at_least("quickheap of keys alone over taut", ratio, aim_only(0.9), Unit::Times);
    Ok(())
}
