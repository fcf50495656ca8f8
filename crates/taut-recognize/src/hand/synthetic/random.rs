//! Random numbers that are addressed by number, and functions that are the same on every machine.
//!
//! *Guarantee.* Only additions, multiplications, divisions, square roots and integers take part, so that a scan has the
//! same bytes wherever it is made.

/// A sequence of random numbers (SplitMix64) whose start is a hash of its address.
#[derive(Clone, Debug)]
pub(super) struct Stream {
    state: u64,
}

impl Stream {
    /// Starts the sequence of an address: seed, person, scan and purpose.
    pub(super) fn new(address: [u64; 4]) -> Self {
        let state = address.iter().fold(0x6a09_e667_f3bc_c909, |state, &part| {
            hash(state ^ hash(part.wrapping_add(0x9e37_79b9_7f4a_7c15)))
        });
        Self { state }
    }

    /// Returns 64 random bits.
    pub(super) fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        hash(self.state)
    }

    /// Returns a number from 0 to below 1.
    pub(super) fn share(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Returns a number of a range.
    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }

    /// Returns a number of mean 0 and variance 1: the sum of twelve uniform ones, whose tails end at 6.
    pub(super) fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.share()).sum::<f64>() - 6.0
    }

    /// Returns a whole number below `count`.
    pub(super) fn below(&mut self, count: usize) -> usize {
        ((self.share() * count as f64) as usize).min(count - 1)
    }
}

/// Mixes 64 bits (the finalizer of SplitMix64).
pub(super) fn hash(mut bits: u64) -> u64 {
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}

/// Returns the sine and cosine of an angle in radians of at most some turns.
pub(super) fn sine_cosine(angle: f64) -> [f64; 2] {
    use std::f64::consts::PI;
    // Taylor's series up to x²⁵: below 1e-12 for |x| ≤ π.
    let x = angle - (angle / (2.0 * PI)).round() * 2.0 * PI;
    let (mut sine, mut cosine, mut term) = (0.0, 0.0, 1.0);
    for k in 0..26 {
        match k % 4 {
            0 => cosine += term,
            1 => sine += term,
            2 => cosine -= term,
            _ => sine -= term,
        }
        term *= x / f64::from(k + 1);
    }
    [sine, cosine]
}

/// Returns the sine and cosine of an angle in degrees.
pub(super) fn turn(degrees: f64) -> [f64; 2] {
    sine_cosine(degrees * std::f64::consts::PI / 180.0)
}

/// Returns the square root of the sum of two squares.
pub(super) fn length(x: f64, y: f64) -> f64 {
    (x * x + y * y).sqrt()
}
