//! Numbers that are the same in every run: SplitMix64, and twelve patterns of keys.

/// SplitMix64.
pub(super) struct Draw(pub(super) u64);

impl Draw {
    /// The next 64 bits.
    pub(super) fn word(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// A number from 0 to 1, without 1.
    pub(super) fn unit(&mut self) -> f64 {
        (self.word() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Words.
    pub(super) fn words(&mut self, n: usize) -> Vec<u64> {
        (0..n).map(|_| self.word()).collect()
    }

    /// Points of the unit cube.
    pub(super) fn points(&mut self, n: usize) -> Vec<[f64; 3]> {
        (0..n).map(|_| std::array::from_fn(|_| self.unit())).collect()
    }
}

/// What keys look like.
#[derive(Clone, Copy)]
pub(super) struct Pattern {
    /// Its name in the tables.
    pub(super) name: &'static str,
    /// So many keys of it.
    pub(super) keys: fn(usize) -> Vec<u64>,
}

/// The twelve patterns.
pub(super) const PATTERNS: [Pattern; 12] = [
    Pattern { name: "uniform", keys: |n| Draw(1).words(n) },
    Pattern { name: "sorted", keys: |n| (0..n as u64).collect() },
    Pattern { name: "reverse", keys: |n| (0..n as u64).rev().collect() },
    Pattern { name: "equal", keys: |n| vec![42; n] },
    Pattern {
        name: "√n values",
        keys: |n| {
            let values = n.isqrt().max(1) as u64;
            Draw(1).words(n).iter().map(|word| word % values).collect()
        },
    },
    Pattern {
        name: "zipf",
        keys: |n| {
            let mut draw = Draw(1);
            (0..n).map(|_| (n as f64).powf(draw.unit()) as u64).collect()
        },
    },
    Pattern { name: "almost", keys: almost },
    Pattern { name: "sawtooth", keys: |n| (0..n as u64).map(|i| i % 1000).collect() },
    Pattern { name: "organ pipe", keys: |n| (0..n as u64).map(|i| i.min(n as u64 - i)).collect() },
    Pattern { name: "doubles", keys: doubles },
    Pattern { name: "stagger", keys: stagger },
    Pattern { name: "killer", keys: killer },
];

/// Sorted, but for a swap per hundred.
fn almost(n: usize) -> Vec<u64> {
    let mut draw = Draw(1);
    let mut keys: Vec<u64> = (0..n as u64).collect();
    for _ in 0..n / 100 {
        keys.swap(draw.word() as usize % n, draw.word() as usize % n);
    }
    keys
}

/// Images in the total order of doubles with all that is special about them.
fn doubles(n: usize) -> Vec<u64> {
    let image = |word: u64| {
        let number = match word % 16 {
            0 => f64::NAN,
            1 => 0.0,
            2 => -0.0,
            3 => f64::INFINITY,
            4 => f64::NEG_INFINITY,
            5 => f64::from_bits(word >> 13),
            _ => (word >> 11) as f64 - 4e15,
        };
        let bits = number.to_bits();
        bits ^ (((bits as i64 >> 63) as u64) | 1 << 63)
    };
    Draw(1).words(n).into_iter().map(image).collect()
}

/// Steps of 7919 modulo 1000, with a plateau or falling by turns, after Bentley and McIlroy.
fn stagger(n: usize) -> Vec<u64> {
    let key = |i: u64| {
        let step = i * 7919 % 1000;
        if (i / 1000).is_multiple_of(2) { step.min(500) } else { 1000 - step }
    };
    (0..n as u64).map(key).collect()
}

/// Quadratic for a quicksort by the median of the first, the middle and the last key, after Musser.
fn killer(n: usize) -> Vec<u64> {
    let half = n / 2;
    let key = |i: usize| match i {
        i if i >= half => 2 * (i - half) + 1,
        i if i % 2 == 0 => i,
        i => half + i,
    };
    (0..n).map(|i| key(i) as u64).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_have_as_many_keys_as_asked_for() {
        for (at, pattern) in PATTERNS.iter().enumerate() {
            assert!(PATTERNS[..at].iter().all(|other| other.name != pattern.name));
            assert_eq!((pattern.keys)(1000).len(), 1000, "{}", pattern.name);
        }
    }
}
