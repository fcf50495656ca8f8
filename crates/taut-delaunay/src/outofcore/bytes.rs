//! Little-endian words from bytes that may be anything, and a sum that tells whether they changed.

/// A well spread odd number: the fractional part of the golden ratio.
const SUM_FACTOR: u64 = 0x9E37_79B9_7F4A_7C15;

/// Reads words, none beyond the end.
pub(crate) struct Reader<'a> {
    rest: &'a [u8],
}

impl<'a> Reader<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes }
    }

    pub(crate) fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.rest.split_at_checked(count)?;
        self.rest = rest;
        Some(taken)
    }

    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        self.take(N)?.try_into().ok()
    }

    pub(crate) fn u32(&mut self) -> Option<u32> {
        self.array().map(u32::from_le_bytes)
    }

    pub(crate) fn u64(&mut self) -> Option<u64> {
        self.array().map(u64::from_le_bytes)
    }

    pub(crate) fn f64(&mut self) -> Option<f64> {
        self.array().map(f64::from_le_bytes)
    }

    /// The coordinates of one point.
    pub(crate) fn points<const D: usize>(&mut self) -> Option<[f64; D]> {
        let mut p = [0.0; D];
        for x in &mut p {
            *x = self.f64()?;
        }
        Some(p)
    }
}

/// Words that are added at once. One by one, each waits for the product of the sum before it, which takes as long as four
/// others: 10 ns a point of the plane where a tile was written, 2 ns with blocks.
const BLOCK_WORDS: usize = 8;

/// The powers of [`SUM_FACTOR`] that the words of a block are multiplied with, and the sum before.
const BLOCK_FACTORS: [u64; BLOCK_WORDS + 1] = {
    let mut powers = [1u64; BLOCK_WORDS + 1];
    let mut i = BLOCK_WORDS;
    while i > 0 {
        powers[i - 1] = powers[i].wrapping_mul(SUM_FACTOR);
        i -= 1;
    }
    powers
};

/// A sum over words in order, for bytes that come in pieces; the pieces do not matter.
#[derive(Clone, Debug)]
pub(crate) struct WordSum {
    sum: u64,
    length: u64,
    /// The beginning of a word that is not whole yet.
    begun: [u8; 8],
}

impl Default for WordSum {
    fn default() -> Self {
        Self { sum: 1, length: 0, begun: [0; 8] }
    }
}

impl WordSum {
    #[inline(always)]
    fn step(&mut self, word: u64) {
        self.sum = self.sum.wrapping_mul(SUM_FACTOR).wrapping_add(word ^ word >> 32);
    }

    /// Makes a step with each word of a block.
    #[inline(always)]
    fn step_all(&mut self, block: &[u8; 8 * BLOCK_WORDS]) {
        let [before, factors @ ..] = &BLOCK_FACTORS;
        self.sum = self.sum.wrapping_mul(*before);
        for (bytes, factor) in block.as_chunks::<8>().0.iter().zip(factors) {
            let word = u64::from_le_bytes(*bytes);
            self.sum = self.sum.wrapping_add((word ^ word >> 32).wrapping_mul(*factor));
        }
    }

    /// Adds bytes.
    pub(crate) fn add(&mut self, mut bytes: &[u8]) {
        let filled = (self.length % 8) as usize;
        self.length += bytes.len() as u64;
        if filled > 0 {
            let taken = bytes.len().min(8 - filled);
            self.begun[filled..filled + taken].copy_from_slice(&bytes[..taken]);
            bytes = &bytes[taken..];
            if filled + taken < 8 {
                return;
            }
            self.step(u64::from_le_bytes(self.begun));
        }
        let (blocks, bytes) = bytes.as_chunks::<{ 8 * BLOCK_WORDS }>();
        blocks.iter().for_each(|block| self.step_all(block));
        let (words, rest) = bytes.as_chunks::<8>();
        words.iter().for_each(|word| self.step(u64::from_le_bytes(*word)));
        self.begun[..rest.len()].copy_from_slice(rest);
    }

    /// The sum of all bytes.
    pub(crate) fn finish(mut self) -> u64 {
        let filled = (self.length % 8) as usize;
        self.begun[filled..].fill(0);
        self.step(u64::from_le_bytes(self.begun));
        self.step(self.length);
        self.sum ^ self.sum >> 29
    }
}

/// The [`WordSum`] of bytes: each change of a single word changes it.
pub(crate) fn word_sum(bytes: &[u8]) -> u64 {
    let mut sum = WordSum::default();
    sum.add(bytes);
    sum.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Files have these sums: another way of adding may not change them.
    #[test]
    fn blocks_have_the_sum_of_their_words() {
        let bytes: Vec<u8> = (0..1000u32).map(|i| (i * i * 31 % 253) as u8).collect();
        for length in [0, 7, 8, 63, 64, 65, 127, 128, 200, 1000] {
            let bytes = &bytes[..length];
            let mut one_by_one = WordSum::default();
            bytes.chunks(8).for_each(|word| one_by_one.add(word));
            assert_eq!(one_by_one.finish(), word_sum(bytes), "{length} bytes");
        }
    }

    #[test]
    fn pieces_do_not_matter_but_bytes_do() {
        let bytes: Vec<u8> = (0..100).map(|i| (i * 37 % 251) as u8).collect();
        for piece in 1..20 {
            let mut sum = WordSum::default();
            bytes.chunks(piece).for_each(|chunk| sum.add(chunk));
            assert_eq!(sum.finish(), word_sum(&bytes), "pieces of {piece}");
        }
        for at in 0..bytes.len() {
            let mut other = bytes.clone();
            other[at] ^= 0x80;
            assert_ne!(word_sum(&other), word_sum(&bytes), "byte {at}");
        }
        assert_ne!(word_sum(&[0; 7]), word_sum(&[0; 8]));
    }
}
