//! A random order of 0 … N − 1 that is never stored: the place of each number is computed when it is asked for.
//!
//! *Idea.* A Feistel network is a bijection of the numbers of 2w bits whatever its round function is; with a good one
//! four rounds suffice. What falls beyond N − 1 is sent through again until it does not, which keeps it a bijection of
//! 0 … N − 1 and takes fewer than four tries on average, as 4^w < 4N.
//! *Reference.* Luby and Rackoff, SIAM J. Comput. 17(2), 1988; Black and Rogaway, CT-RSA 2002, cycle walking.

use rand::RngExt;

use super::draw::stream;

/// The place of `number` mod N in the random order that belongs to `seed`, where N = last + 1.
pub(super) fn shuffled(seed: u64, number: u64, last: u64) -> u64 {
    // From the last stream, which no point has before 2⁶⁴ − 1.
    let keys: [u64; 4] = stream(seed, u64::MAX).random();
    let half = (64 - last.leading_zeros()).div_ceil(2).max(1);
    let mask = (1u64 << half) - 1;
    let mut value = last.checked_add(1).map_or(number, |n| number % n);
    loop {
        let (mut left, mut right) = (value >> half, value & mask);
        for key in keys {
            (left, right) = (right, left ^ (mix(right ^ key) & mask));
        }
        value = left << half | right;
        if value <= last {
            return value;
        }
    }
}

/// The finalizer of SplitMix64 (Steele, Lea and Flood, OOPSLA 2014): each bit depends on all.
fn mix(mut x: u64) -> u64 {
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_number_has_a_place_of_its_own_and_the_order_is_not_that_of_the_numbers() {
        for n in [1, 2, 3, 15, 16, 17, 1000, 4096, 4097] {
            let mut places: Vec<u64> = (0..n).map(|i| shuffled(5, i, n - 1)).collect();
            let (again, other) = (places.clone(), (0..n).map(|i| shuffled(6, i, n - 1)));
            if n >= 15 {
                assert!(!places.is_sorted() && !other.eq(again.iter().copied()), "{n}");
                // Neighbors are n / 3 apart on average.
                let apart: f64 = again.windows(2).map(|p| p[0].abs_diff(p[1]) as f64).sum();
                let apart = apart / ((n - 1) * n) as f64;
                assert!((0.2..0.5).contains(&apart) || n < 1000, "{n}: {apart}");
            }
            places.sort_unstable();
            assert!(places.into_iter().eq(0..n), "{n}");
            assert_eq!(shuffled(5, n + 1, n - 1), shuffled(5, 1 % n, n - 1));
        }
        assert_ne!(shuffled(5, 0, u64::MAX), shuffled(5, 1, u64::MAX));
    }
}
