//! The sum at the end of a tile and of the manifest, from its definition in docs/delaunay.md.
//!
//! *Value.* s = 1; for each word w of 8 bytes, s = s·F + (w xor w >> 32) modulo 2⁶⁴, F = 0x9E3779B97F4A7C15; then the same
//! with the bytes that are left, filled up with 0, even if there are none, and with the number of bytes; at the end
//! s xor s >> 29. It notices damage; the proof does not rest on it.

const FACTOR: u64 = 0x9E37_79B9_7F4A_7C15;

/// The sum of bytes that come in pieces.
pub(super) struct Sum {
    value: u64,
    bytes: u64,
    /// The bytes after the last whole word.
    rest: Vec<u8>,
}

impl Default for Sum {
    fn default() -> Self {
        Sum { value: 1, bytes: 0, rest: Vec::with_capacity(8) }
    }
}

fn after(value: u64, word: u64) -> u64 {
    value.wrapping_mul(FACTOR).wrapping_add(word ^ word >> 32)
}

impl Sum {
    pub(super) fn add(&mut self, mut bytes: &[u8]) {
        self.bytes += bytes.len() as u64;
        while !self.rest.is_empty() && !bytes.is_empty() {
            self.rest.push(bytes[0]);
            bytes = &bytes[1..];
            if let Some(word) = self.rest.first_chunk() {
                self.value = after(self.value, u64::from_le_bytes(*word));
                self.rest.clear();
            }
        }
        let (words, rest) = bytes.as_chunks::<8>();
        // Four at a time, as each step waits for the product of the one before.
        let (fours, words) = words.as_chunks::<4>();
        let powers =
            [FACTOR.wrapping_pow(4), FACTOR.wrapping_pow(3), FACTOR.wrapping_pow(2), FACTOR];
        for four in fours {
            let [a, b, c, d] = four.map(|word| {
                let word = u64::from_le_bytes(word);
                word ^ word >> 32
            });
            let tail = a
                .wrapping_mul(powers[1])
                .wrapping_add(b.wrapping_mul(powers[2]))
                .wrapping_add(c.wrapping_mul(powers[3]).wrapping_add(d));
            self.value = self.value.wrapping_mul(powers[0]).wrapping_add(tail);
        }
        for word in words {
            self.value = after(self.value, u64::from_le_bytes(*word));
        }
        self.rest.extend_from_slice(rest);
    }

    pub(super) fn finish(self) -> u64 {
        let mut last = [0; 8];
        last[..self.rest.len()].copy_from_slice(&self.rest);
        let value = after(after(self.value, u64::from_le_bytes(last)), self.bytes);
        value ^ value >> 29
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_give_the_sum_of_the_whole() {
        let bytes: Vec<u8> = (0..1000u32).map(|i| (i * i % 253) as u8).collect();
        let mut expected = 1u64;
        for word in bytes.as_chunks::<8>().0 {
            expected = after(expected, u64::from_le_bytes(*word));
        }
        expected = after(after(expected, 0), 1000);
        expected ^= expected >> 29;
        for piece in [1, 3, 8, 31, 64, 1000] {
            let mut sum = Sum::default();
            bytes.chunks(piece).for_each(|chunk| sum.add(chunk));
            assert_eq!(sum.finish(), expected, "pieces of {piece}");
        }
    }
}
