//! What can be sorted by its bits.

/// A number whose order is the order of a 64-bit integer.
///
/// Floating-point numbers are in the total order of IEEE 754, as [`f64::total_cmp`] has it: negative NaN, −∞, …, −0, 0,
/// …, ∞, NaN. Sealed: exactly `u32`, `u64`, `i32`, `i64`, `f32` and `f64`.
pub trait SortKey: Copy + Send + Sync + sealed::Key {
    /// An integer for each key: in the same order, and different for different bits.
    fn rank(self) -> u64;
}

pub(super) mod sealed {
    /// What the sort needs of a key, and nobody else.
    pub trait Key: Sized {
        /// The key with this rank; for a number that is no rank, any key.
        fn of_rank(rank: u64) -> Self;

        /// Keys that are words turned into words that are ranks, in place; none for keys that are smaller.
        fn into_ranks(keys: &mut [Self]) -> Option<&mut [u64]>;

        /// Ranks turned back into keys.
        fn out_of_ranks(ranks: &mut [u64]);
    }
}

const SIGN: u64 = 1 << 63;

macro_rules! sort_key {
    ($key:ty, $word:ident, $rank:expr, $of_rank:expr) => {
        impl SortKey for $key {
            #[inline(always)]
            fn rank(self) -> u64 {
                let rank: fn(Self) -> u64 = $rank;
                rank(self)
            }
        }
        impl sealed::Key for $key {
            #[inline(always)]
            fn of_rank(rank: u64) -> Self {
                let of_rank: fn(u64) -> Self = $of_rank;
                of_rank(rank)
            }
            sort_key!(@$word);
        }
    };
    (@word) => {
        fn into_ranks(keys: &mut [Self]) -> Option<&mut [u64]> {
            for key in keys.iter_mut() {
                *key = bytemuck::cast(key.rank());
            }
            Some(bytemuck::cast_slice_mut(keys))
        }

        fn out_of_ranks(ranks: &mut [u64]) {
            for rank in ranks {
                *rank = bytemuck::cast(Self::of_rank(*rank));
            }
        }
    };
    (@half) => {
        fn into_ranks(_: &mut [Self]) -> Option<&mut [u64]> {
            None
        }

        fn out_of_ranks(_: &mut [u64]) {}
    };
}

sort_key!(u64, word, |key| key, |rank| rank);
sort_key!(i64, word, |key| key as u64 ^ SIGN, |rank| (rank ^ SIGN) as i64);
// Negative numbers: all bits turned; others: the sign alone.
sort_key!(
    f64,
    word,
    |key| {
        let bits = key.to_bits();
        bits ^ ((bits as i64 >> 63) as u64 | SIGN)
    },
    |rank| f64::from_bits(rank ^ (!(rank as i64 >> 63) as u64 | SIGN))
);
sort_key!(u32, half, |key| u64::from(key), |rank| rank as u32);
sort_key!(i32, half, |key| u64::from(key as u32 ^ 1 << 31), |rank| (rank as u32 ^ 1 << 31) as i32);
sort_key!(
    f32,
    half,
    |key| {
        let bits = key.to_bits();
        u64::from(bits ^ ((bits as i32 >> 31) as u32 | 1 << 31))
    },
    |rank| {
        let rank = rank as u32;
        f32::from_bits(rank ^ (!(rank as i32 >> 31) as u32 | 1 << 31))
    }
);
