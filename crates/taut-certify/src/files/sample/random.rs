//! Random words of a node, and how many of a draw fall below the middle of a range.
//!
//! *References.* Vigna and Blackman's xoshiro256++; Steele, Lea and Flood's SplitMix64; Lemire's numbers in an interval.

/// The state of xoshiro256++.
pub(super) struct Random {
    a: u64,
    b: u64,
    c: u64,
    d: u64,
}

impl Random {
    /// The stream of a node of the tree of ranges.
    pub(super) fn of_node(seed: u64, node: u64) -> Self {
        const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;
        let mix = |counter: u64| {
            let x = (counter ^ counter >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
            x ^ x >> 31
        };
        let start = mix(seed.wrapping_add(GOLDEN)) ^ node.wrapping_mul(0xd6e8_feb8_6659_fd93);
        let [a, b, c, d] =
            [1, 2, 3, 4].map(|i: u64| mix(start.wrapping_add(GOLDEN.wrapping_mul(i))));
        Self { a, b, c, d }
    }

    fn word(&mut self) -> u64 {
        let Self { a, b, c, d } = *self;
        let word = a.wrapping_add(d).rotate_left(23).wrapping_add(a);
        let (c, d) = (c ^ a, d ^ b);
        *self = Self { a: a ^ d, b: b ^ c, c: c ^ b << 17, d: d.rotate_left(45) };
        word
    }

    /// A number below `n`, at least 1: the upper half of a product, drawn again where the lower half is too small.
    pub(super) fn below(&mut self, n: u64) -> u64 {
        let too_small = n.wrapping_neg() % n;
        loop {
            let product = u128::from(self.word()) * u128::from(n);
            if product as u64 >= too_small {
                return (product >> 64) as u64;
            }
        }
    }

    /// A multiple of 2⁻⁵³ above 0, at most 1.
    fn unit(&mut self) -> f64 {
        ((self.word() >> 11) + 1) as f64 / 2f64.powi(53)
    }
}

/// Of `k` of `n` numbers, how many are among the first `half`: the hypergeometric number that a random number chooses.
///
/// Weights go out from 1 at the mode, upwards first, until one is no more than 10⁻²². The lot is a random share of their
/// sum, from which they are taken off in the same order until nothing is left.
pub(super) fn fall_below(random: &mut Random, n: u64, half: u64, k: u64) -> u64 {
    let least = k.saturating_sub(n - half);
    let most = k.min(half);
    let mode = (u128::from(k) + 1) * (u128::from(half) + 1) / (u128::from(n) + 2);
    let mode = (mode as u64).clamp(least, most);
    // The weight of x + 1 over that of x.
    let ratio = |x: u64| {
        let rest = i128::from(n - half) - i128::from(k) + i128::from(x) + 1;
        let (up, down) = ((k - x) as f64 * (half - x) as f64, (x + 1) as f64 * rest as f64);
        up / down
    };
    // The weights are walked through twice: kept, those of a file that only promises numbers could fill any memory.
    let mut sum = 0.0;
    walk(mode, [least, most], ratio, |weight| {
        sum += weight;
        false
    });
    let mut lot = random.unit() * sum;
    walk(mode, [least, most], ratio, |weight| {
        lot -= weight;
        lot <= 0.0
    })
}

/// Goes through the numbers and their weights until `stop` says so; the number it ends at.
fn walk(
    mode: u64,
    [least, most]: [u64; 2],
    ratio: impl Fn(u64) -> f64,
    mut stop: impl FnMut(f64) -> bool,
) -> u64 {
    let (mut x, mut weight) = (mode, 1.0);
    if stop(weight) {
        return x;
    }
    while x < most && weight > 1e-22 {
        weight *= ratio(x);
        x += 1;
        if stop(weight) {
            return x;
        }
    }
    (x, weight) = (mode, 1.0);
    while x > least && weight > 1e-22 {
        x -= 1;
        weight /= ratio(x);
        if stop(weight) {
            return x;
        }
    }
    x
}
