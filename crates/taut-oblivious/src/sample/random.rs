//! Random numbers for one node of a recursion.
//!
//! *Idea.* xoshiro256++, whose state is filled from the seed and the number of the node by a bijective mixer. Nodes have
//! streams of their own, so that it does not matter which of them is drawn first, or where.
//! *Trap.* `x mod n` favors small numbers; a product of 128 bits and a rare second draw do not.
//! *References.* D. Blackman, S. Vigna, *Scrambled linear pseudorandom number generators*, TOMS 47(4), 2021;
//! D. Lemire, *Fast random integer generation in an interval*, TOMACS 29(1), 2019.

use crate::random::split_mix;

/// A stream of random words.
#[derive(Clone, Debug)]
pub(super) struct Random([u64; 4]);

impl Random {
    pub(super) fn new(seed: u64, node: u64) -> Self {
        let mut state = seed;
        let mut state = split_mix(&mut state) ^ node.wrapping_mul(0xD6E8_FEB8_6659_FD93);
        Self(std::array::from_fn(|_| split_mix(&mut state)))
    }

    /// 64 random bits.
    #[inline(always)]
    pub(super) fn next(&mut self) -> u64 {
        let s = &mut self.0;
        let word = s[0].wrapping_add(s[3]).rotate_left(23).wrapping_add(s[0]);
        let t = s[1] << 17;
        s[2] ^= s[0];
        s[3] ^= s[1];
        s[1] ^= s[2];
        s[0] ^= s[3];
        s[2] ^= t;
        s[3] = s[3].rotate_left(45);
        word
    }

    /// A number below `n`, all with the same probability; 0 if `n` is 0.
    #[inline(always)]
    pub(super) fn below(&mut self, n: u64) -> u64 {
        let mut product = u128::from(self.next()) * u128::from(n);
        if (product as u64) < n {
            let least = n.wrapping_neg() % n;
            while (product as u64) < least {
                product = u128::from(self.next()) * u128::from(n);
            }
        }
        (product >> 64) as u64
    }

    /// A real number above 0 and up to 1, a multiple of 2⁻⁵³.
    #[inline]
    pub(super) fn unit(&mut self) -> f64 {
        ((self.next() >> 11) + 1) as f64 / (1u64 << 53) as f64
    }
}
