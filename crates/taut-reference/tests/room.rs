//! Tests what is allocated while queues that spill run.

mod counting;

use bytemuck::Pod;
use counting::peak;
use taut_reference::SpillingQueue;

/// Numbers without pattern.
fn random(i: u64) -> u64 {
    let x = i.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    (x ^ x >> 31).wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 8
}

/// Pushes n entries and pops them, counting what is allocated.
fn fill_and_empty<V: Pod>(memory: usize, pattern: &str, key: impl Fn(u64) -> u64) {
    let folder = tempfile::tempdir().expect("a folder");
    let entry = 8 + size_of::<V>();
    let n = (3 * memory / entry) as u64;
    let ((most, used), bytes) = peak(|| {
        let mut queue = SpillingQueue::<u64, V>::new(folder.path(), memory).expect("a file");
        let (mut most, mut used) = (0, 0);
        for i in 0..n {
            queue.push(key(i), V::zeroed()).expect("written");
            used = used.max(queue.len() - queue.spilled());
            if pattern == "groups" && i % 17 == 16 {
                queue.pop().expect("read");
            }
        }
        let mut before = 0;
        while let Some((key, _)) = queue.pop().expect("read") {
            assert!(before <= key);
            before = key;
            most = most.max(queue.spilled());
        }
        (most, used)
    });
    let limit = memory / entry / 10 * 3;
    assert!(used as usize > limit - limit / 64 && used as usize <= limit);
    let beside = (16 << 10) + 24 * (most as usize / (limit / 256));
    assert!(
        bytes <= memory + beside,
        "{pattern}, {entry} bytes: {bytes} of {memory} and {beside} beside"
    );
}

#[test]
fn queues_stay_within_their_memory() {
    let memory = 4 << 20;
    fill_and_empty::<[u64; 16]>(memory, "rising", |i| i);
    fill_and_empty::<[u64; 16]>(memory, "falling", |i| u64::MAX - i);
    fill_and_empty::<[u64; 16]>(memory, "groups", |i| u64::MAX / 2 - i);
    fill_and_empty::<[u64; 16]>(memory, "random", random);
    fill_and_empty::<[u64; 16]>(memory, "equal", |i| i / 20_000);
    fill_and_empty::<u64>(memory, "rising", |i| i);
    fill_and_empty::<u64>(memory, "random", random);
    fill_and_empty::<()>(memory, "groups", |i| u64::MAX / 2 - i);
    fill_and_empty::<[u64; 96]>(2 * memory, "rising", |i| i);
    fill_and_empty::<[u64; 96]>(2 * memory, "random", random);
}
