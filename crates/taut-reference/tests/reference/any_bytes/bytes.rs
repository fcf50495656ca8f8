//! One function per structure: what the fuzzers call with any bytes, and the tests with seeds.
//!
//! Each compares with the structure of the standard library to the same end: `BTreeMap`, `BinaryHeap`.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use taut_reference::packed::PackedMap;
use taut_reference::{PriorityQueue, SpillingQueue};

/// A packed map beside a `BTreeMap`: four bytes an operation.
pub(crate) fn packed_any(bytes: &[u8]) {
    let (mut map, mut model) = (PackedMap::<u64, u16>::new(), BTreeMap::new());
    for (time, operation) in (0u16..).zip(bytes.as_chunks::<4>().0) {
        let [what, high, low, more] = *operation;
        // Keys all over the range, or near each other, or the ends of it.
        let near = u64::from(u16::from_be_bytes([high, low]));
        let key = |near: u64| match what >> 4 {
            0 => u64::MAX - near,
            1..4 => near << 48,
            _ => near,
        };
        match what % 8 {
            0..3 => assert_eq!(map.insert(key(near), time), model.insert(key(near), time)),
            3 => assert_eq!(map.remove(key(near)), model.remove(&key(near))),
            4 => assert_eq!(map.get(key(near)), model.get(&key(near))),
            5 => {
                // Falling, then rising.
                let entries = (0..u64::from(more)).map(|i| (key(near ^ ((i * 37) & 0xff)), time));
                let entries: Vec<(u64, u16)> = entries.collect();
                let before = model.len();
                model.extend(entries.iter().copied());
                assert_eq!(map.insert_batch(&entries), model.len() - before);
            }
            6 => {
                let (start, end) = (key(near), key(near).saturating_add(u64::from(more) << 8));
                let expected = model.range(start..end).map(|(&key, &value)| (key, value));
                assert!(map.range(start..end).eq(expected));
            }
            _ => {
                let last = model.last_key_value().map(|(&key, &value)| (key, value));
                assert_eq!(map.last(), last);
                let first = model.first_key_value().map(|(&key, &value)| (key, value));
                assert_eq!(map.first(), first);
            }
        }
        assert_eq!(map.len(), model.len());
    }
    map.check().expect("densities within their bounds");
    assert!(map.iter().eq(model));
}

/// Both queues beside a `BinaryHeap`: two bytes an operation, some many times over.
pub(crate) fn queue_any(bytes: &[u8]) {
    let mut queue = PriorityQueue::<i64, u32>::new();
    // Wide values, so that some thousands of entries are more than memory holds.
    let mut spilling =
        SpillingQueue::<i64, [u32; 64]>::new(&std::env::temp_dir(), 4 << 20).expect("a file");
    let mut model = BinaryHeap::new();
    let (mut now, mut held) = (0i64, vec![0u32; 2]);
    for (time, &[what, more]) in (0u32..).zip(bytes.as_chunks::<2>().0) {
        let times = if what & 64 == 0 { 1 } else { 1 + i64::from(more) * 8 };
        for i in 0..times {
            let key = match what % 8 {
                0 => Some(i64::from(more) << 55),
                1 => Some(now - 1 - i),
                2 => Some(now + i),
                3 => Some((i * 7919) % 1000 - i64::from(more)),
                _ => None,
            };
            let Some(key) = key else {
                let smallest = model.pop().map(|Reverse(key)| key);
                let (one, other) = (queue.pop(), narrow(spilling.pop().expect("read")));
                assert_eq!(one.map(|entry| entry.0), smallest);
                assert_eq!(other.map(|entry| entry.0), smallest);
                now = smallest.unwrap_or(0);
                for (held, entry) in held.iter_mut().zip([one, other]) {
                    *held = held.wrapping_sub(entry.map_or(0, |entry| entry.1));
                }
                continue;
            };
            model.push(Reverse(key));
            queue.push(key, time);
            spilling.push(key, [time; 64]).expect("written");
            held.iter_mut().for_each(|held| *held = held.wrapping_add(time));
        }
        assert_eq!((queue.len(), spilling.len()), (model.len() as u64, model.len() as u64));
        if model.len() > 1 << 16 {
            break;
        }
    }
    // Every key, and every payload: their sums come out even.
    while let Some(Reverse(key)) = model.pop() {
        assert_eq!(queue.peek().map(|entry| entry.0), Some(key));
        let (one, other) = (queue.pop(), narrow(spilling.pop().expect("read")));
        assert_eq!([one, other].map(|entry| entry.map(|entry| entry.0)), [Some(key); 2]);
        for (held, entry) in held.iter_mut().zip([one, other]) {
            *held = held.wrapping_sub(entry.map_or(0, |entry| entry.1));
        }
    }
    assert_eq!(
        (queue.pop(), narrow(spilling.pop().expect("read")), held),
        (None, None, vec![0, 0])
    );
}

/// The entry without what its value is repeated for.
fn narrow(entry: Option<(i64, [u32; 64])>) -> Option<(i64, u32)> {
    entry.map(|(key, value)| {
        assert!(value == [value[0]; 64]);
        (key, value[0])
    })
}
