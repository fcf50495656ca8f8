//! Room of vectors that grow by half.
//!
//! Trap: a vector that doubles, and is moved as it does, takes three times its entries for a moment; one that never shrinks
//! keeps what it once held. A limit on memory has to know both, and that a vector may be moved as it shrinks, too: one of e
//! entries with room for e / 2 more takes 2.5·e as it grows and 3·e as it gives up little of its room.

/// Makes room for so many more.
#[inline(always)]
pub(super) fn grow<T>(entries: &mut Vec<T>, more: usize) {
    if entries.capacity() - entries.len() < more {
        grow_to(entries, more);
    }
}

#[cold]
fn grow_to<T>(entries: &mut Vec<T>, more: usize) {
    entries.reserve_exact(more.max(entries.len() / 2));
}

/// Takes the last entry, and gives up room once more than half of it is empty.
pub(super) fn pop<T>(entries: &mut Vec<T>) -> Option<T> {
    let last = entries.pop();
    if entries.len() < entries.capacity() / 2 {
        give_up(entries, 4);
    }
    last
}

/// Gives up room beyond half as much again as is needed, unless it is for no more than `kept` entries.
pub(super) fn give_up<T>(entries: &mut Vec<T>, kept: usize) {
    let needed = entries.len() + entries.len() / 2;
    if entries.capacity() > needed.max(kept) {
        entries.shrink_to(needed);
    }
}
