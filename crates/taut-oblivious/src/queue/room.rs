//! Room of vectors that grow by half.
//!
//! Trap: a vector that doubles, and is moved as it does, takes three times its entries for a moment; one that never shrinks
//! keeps what it once held. A limit on memory has to know both.

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

/// Gives up room beyond half as much again as is needed, unless it is for no more than `kept` entries.
pub(super) fn give_up<T>(entries: &mut Vec<T>, kept: usize) {
    let needed = entries.len() + entries.len() / 2;
    if entries.capacity() > needed.max(kept) {
        entries.shrink_to(needed);
    }
}
