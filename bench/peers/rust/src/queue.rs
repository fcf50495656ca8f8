//! quickheap in the protocol of `bench/peers/protocol.hpp`: all keys in, then all out.
//!
//! The input holds words of 64 bits where others have doubles. `quickheap` takes each with its complement as its value and
//! hands out keys and values by turns; `quickheap-keys` has keys alone, which its other queue is made for. Seconds are
//! processor time of the process, which has one thread.

use std::error::Error;
use std::io::stdin;

use quickheap::{KvSimdQuickHeap, SimdQuickHeap};

use crate::meter::Meter;

/// Answers each line of standard input with a line, and `output` with what came out of the queue.
pub fn serve(name: &str, path: &str, output: &str) -> Result<(), Box<dyn Error>> {
    let bytes = std::fs::read(path)?;
    let (words, _) = bytes.as_chunks::<8>();
    let keys: Vec<u64> = words.iter().skip(2).map(|&word| u64::from_le_bytes(word)).collect();
    drop(bytes);
    let run = match name {
        "quickheap" => with_values,
        "quickheap-keys" => keys_alone,
        _ => return Err(format!("no queue is called {name}").into()),
    };
    println!("{{\"ready\":true}}");
    for line in stdin().lines() {
        line?;
        let (seconds, out) = run(&keys);
        std::fs::write(output, out.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>())?;
        println!("{{\"seconds\":{seconds},\"radius\":0,\"support\":0}}");
    }
    Ok(())
}

fn with_values(keys: &[u64]) -> (f64, Vec<u64>) {
    let meter = Meter::start();
    let mut queue = KvSimdQuickHeap::<u64>::default();
    keys.iter().for_each(|&key| queue.push(key, !key));
    let out: Vec<(u64, u64)> = std::iter::from_fn(|| queue.pop()).collect();
    drop(queue);
    let seconds = meter.stop().cpu;
    (seconds, out.into_iter().flat_map(|(key, value)| [key, value]).collect())
}

fn keys_alone(keys: &[u64]) -> (f64, Vec<u64>) {
    let meter = Meter::start();
    let mut queue = SimdQuickHeap::<u64>::default();
    keys.iter().for_each(|&key| queue.push(key));
    let out: Vec<u64> = std::iter::from_fn(|| queue.pop()).collect();
    drop(queue);
    (meter.stop().cpu, out)
}
