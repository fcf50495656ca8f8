//! The types that can be keys: numbers, by an unsigned word that has their order.
//!
//! *Idea.* Whatever sorts, searches or queues keys compares words and nothing else, so one kernel serves all kinds of keys.
//! Words are a bijection: unsigned numbers are their own, signed ones have the sign bit flipped, floats are in the total
//! order of IEEE 754 ([`f64::total_cmp`]): −NaN < −∞ < … < −0.0 < 0.0 < … < ∞ < NaN.
//! *Trap.* −0.0 and 0.0 are two keys in that order, and every NaN has its place; nothing panics, and nothing is equal to
//! a key but the same bits.

use std::fmt::Debug;

use bytemuck::Pod;

mod sealed {
    pub trait Sealed {}
}

/// The unsigned word that a [`Key`] is compared by: `u32` or `u64`.
pub trait Word: Key<Word = Self> + Ord + Default + Into<u64> {
    /// The largest word.
    const MAX: Self;
    /// Words in a line of memory of 64 bytes.
    const LANES: usize;

    /// The next larger word; none after the largest.
    fn next(self) -> Option<Self>;

    /// The low bits of a number.
    fn low_bits(number: u64) -> Self;
}

macro_rules! word {
    ($word:ty, $lanes:literal) => {
        impl Word for $word {
            const MAX: Self = <$word>::MAX;
            const LANES: usize = $lanes;

            #[inline(always)]
            fn next(self) -> Option<Self> {
                self.checked_add(1)
            }

            #[inline(always)]
            fn low_bits(number: u64) -> Self {
                number as Self
            }
        }
    };
}
word!(u32, 16);
word!(u64, 8);

/// A number that can be sorted, searched for or queued: exactly `u32`, `u64`, `i32`, `i64`, `f32` and `f64`.
///
/// The order of keys is that of integers, and of floats the total order of IEEE 754, as [`f64::total_cmp`] has it: negative
/// NaN, −∞, …, −0, 0, …, ∞, NaN. Sealed.
pub trait Key: Copy + Pod + Debug + Send + Sync + sealed::Sealed {
    /// The word that has the key's place.
    type Word: Word;

    /// The word of a key: smaller for a smaller key, equal only for the same bits.
    fn word(self) -> Self::Word;

    /// The key of a word.
    fn of_word(word: Self::Word) -> Self;
}

/// The word of a key among those of 64 bits.
#[inline(always)]
pub(crate) fn rank<K: Key>(key: K) -> u64 {
    key.word().into()
}

/// The key with this rank; for a number that is no rank, any key.
#[inline(always)]
pub(crate) fn of_rank<K: Key>(rank: u64) -> K {
    K::of_word(K::Word::low_bits(rank))
}

macro_rules! unsigned {
    ($key:ty) => {
        impl sealed::Sealed for $key {}
        impl Key for $key {
            type Word = $key;

            #[inline(always)]
            fn word(self) -> Self {
                self
            }

            #[inline(always)]
            fn of_word(word: Self) -> Self {
                word
            }
        }
    };
}
unsigned!(u32);
unsigned!(u64);

macro_rules! signed {
    ($key:ty, $word:ty) => {
        impl sealed::Sealed for $key {}
        impl Key for $key {
            type Word = $word;

            #[inline(always)]
            fn word(self) -> $word {
                self.cast_unsigned() ^ (1 << (<$word>::BITS - 1))
            }

            #[inline(always)]
            fn of_word(word: $word) -> Self {
                (word ^ (1 << (<$word>::BITS - 1))).cast_signed()
            }
        }
    };
}
signed!(i32, u32);
signed!(i64, u64);

macro_rules! float {
    ($key:ty, $word:ty) => {
        impl sealed::Sealed for $key {}
        impl Key for $key {
            type Word = $word;

            /// All bits of a negative number are flipped, of others the sign alone.
            #[inline(always)]
            fn word(self) -> $word {
                let bits = self.to_bits();
                let negative = (bits.cast_signed() >> (<$word>::BITS - 1)).cast_unsigned();
                bits ^ (negative | 1 << (<$word>::BITS - 1))
            }

            #[inline(always)]
            fn of_word(word: $word) -> Self {
                let positive = (word.cast_signed() >> (<$word>::BITS - 1)).cast_unsigned();
                Self::from_bits(word ^ (!positive | 1 << (<$word>::BITS - 1)))
            }
        }
    };
}
float!(f32, u32);
float!(f64, u64);

#[cfg(test)]
mod tests {
    use super::*;

    fn keeps_order<K: Key>(sorted: &[K]) {
        assert!(sorted.windows(2).all(|side| side[0].word() < side[1].word()), "{sorted:?}");
        assert!(sorted.windows(2).all(|side| rank(side[0]) < rank(side[1])), "{sorted:?}");
        for &key in sorted {
            // By their bits, as NaN equals nothing.
            let bits = |key: K| bytemuck::bytes_of(&key).to_vec();
            assert_eq!(bits(K::of_word(key.word())), bits(key));
            assert_eq!(bits(of_rank(rank(key))), bits(key));
        }
    }

    #[test]
    fn words_have_the_order_of_their_keys() {
        keeps_order(&[0u64, 1, u64::MAX - 1, u64::MAX]);
        keeps_order(&[0u32, 1, u32::MAX - 1, u32::MAX]);
        keeps_order(&[i64::MIN, -2, -1, 0, 1, i64::MAX]);
        keeps_order(&[i32::MIN, -1, 0, i32::MAX]);
        let floats = [f64::INFINITY, f64::MAX, 1.0, f64::MIN_POSITIVE, 5e-324, 0.0];
        let mut all: Vec<f64> = floats.iter().rev().flat_map(|&x| [x, -x]).collect();
        all.extend([f64::NAN, -f64::NAN]);
        all.sort_by(f64::total_cmp);
        keeps_order(&all);
        keeps_order(&[-f32::NAN, f32::NEG_INFINITY, -1.0, -0.0, 0.0, 1.0, f32::NAN]);
    }
}
