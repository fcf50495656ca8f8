//! Replacement that knows the future.
//!
//! Idea: from the end, note for each access when its block is accessed next; then keep the blocks in a heap by that time,
//! the farthest on top.
//! Trap: a block in the heap gets a new time at each access, and heaps do not like that. Entries stay instead: one whose
//! time has come is below every entry that is still to come, so it never reaches the top while a block is there.
//! Reference: Belady, *A study of replacement algorithms for a virtual-storage computer*, IBM Systems Journal 5(2), 1966.

use std::collections::{BinaryHeap, HashMap};

use super::cache::Counts;
use crate::Access;

/// Counts for accesses of blocks in a memory of `held` blocks.
pub(super) fn optimal(accesses: &[(u64, Access)], held: usize) -> Counts {
    let next = next_accesses(accesses);
    let mut counts = Counts { accesses: accesses.len() as u64, ..Counts::default() };
    // True if a block that is there was written to.
    let mut there: HashMap<u64, bool> = HashMap::new();
    let mut farthest: BinaryHeap<(usize, u64)> = BinaryHeap::new();
    for (now, &(block, access)) in accesses.iter().enumerate() {
        let write = access == Access::Write;
        if let Some(dirty) = there.get_mut(&block) {
            *dirty |= write;
        } else {
            counts.misses += 1;
            if there.len() == held
                && let Some((_, victim)) = farthest.pop()
            {
                counts.write_backs += u64::from(there.remove(&victim) == Some(true));
            }
            there.insert(block, write);
        }
        farthest.push((next[now], block));
        if farthest.len() > 4 * held + 1024 {
            farthest.retain(|&(time, _)| time > now);
        }
    }
    counts.dirty = there.values().filter(|&&dirty| dirty).count() as u64;
    counts
}

/// For each access the number of the next one of its block; `usize::MAX` where there is none.
fn next_accesses(accesses: &[(u64, Access)]) -> Vec<usize> {
    let mut coming = HashMap::new();
    let mut next = vec![usize::MAX; accesses.len()];
    for (now, (block, _)) in accesses.iter().enumerate().rev() {
        if let Some(time) = coming.insert(*block, now) {
            next[now] = time;
        }
    }
    next
}
