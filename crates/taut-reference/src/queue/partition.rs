//! A bucket split at a pivot.

use super::room;

/// Moves the entries with keys below `pivot` from one pair of arrays to the end of another; the order is kept.
pub(super) fn split<V: Copy>(
    pivot: u64,
    (keys, values): (&mut Vec<u64>, &mut Vec<V>),
    (low_keys, low_values): (&mut Vec<u64>, &mut Vec<V>),
) {
    // Counted first: room for every entry would double the memory of a bucket that is split near its end.
    let below = keys.iter().filter(|&&key| key < pivot).count();
    let Some(&value) = values.first() else { return };
    let start = low_keys.len();
    room::grow(low_keys, below + 1);
    room::grow(low_values, below + 1);
    // One entry more, where those that stay are written and written over.
    low_keys.resize(start + below + 1, 0);
    low_values.resize(start + below + 1, value);
    let (mut low, mut high) = (start, 0);
    for i in 0..keys.len() {
        let (key, value) = (keys[i], values[i]);
        low_keys[low] = key;
        low_values[low] = value;
        keys[high] = key;
        values[high] = value;
        low += usize::from(key < pivot);
        high += usize::from(key >= pivot);
    }
    low_keys.truncate(low);
    low_values.truncate(low);
    keys.truncate(high);
    values.truncate(high);
}
