//! The yardstick of a pass: one plain read of the same memory by the same threads.

use std::hint::black_box;
use std::time::Instant;

use rayon::prelude::*;

/// Bytes per task: a few hundred microseconds of reading, so that no thread waits long for another.
const CHUNK: usize = 1 << 20;
/// Words per step: enough independent sums that the additions never wait for each other.
const LANES: usize = 64;

/// Seconds of one vectorized sum over all `bytes`, a multiple of four, on the threads of `pool`.
pub(crate) fn plain_read(bytes: &[u8], pool: &rayon::ThreadPool) -> f64 {
    let words: &[u32] = bytemuck::cast_slice(bytes);
    let (sum, seconds) = pool.install(|| {
        let start = Instant::now();
        let sums = words.par_chunks(CHUNK / 4).map(sum);
        (sums.reduce(|| 0, u32::wrapping_add), start.elapsed().as_secs_f64())
    });
    black_box(sum);
    seconds
}

fn sum(words: &[u32]) -> u32 {
    let mut lanes = [0u32; LANES];
    let blocks = words.chunks_exact(LANES);
    let rest = blocks.remainder();
    for block in blocks {
        for (lane, &word) in lanes.iter_mut().zip(block) {
            *lane = lane.wrapping_add(word);
        }
    }
    rest.iter().chain(&lanes).fold(0, |sum, &word| sum.wrapping_add(word))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_word_is_read_once() {
        let words: Vec<u32> = (0..1003).collect();
        assert_eq!(sum(&words), 1002 * 1003 / 2);
    }
}
