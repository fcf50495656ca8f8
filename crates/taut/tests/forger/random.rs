//! Random numbers that depend on a seed alone, SplitMix64, or on bytes as long as there are some.

/// A stream of random numbers.
#[derive(Clone, Debug)]
pub struct Random {
    state: u64,
    /// Two of them make the next number.
    bytes: std::vec::IntoIter<u8>,
}

impl Random {
    /// Returns the stream of a name and a number.
    pub fn new(name: &str, number: u64) -> Self {
        let seed = name.bytes().fold(0xcbf2_9ce4_8422_2325, |h: u64, byte| {
            (h ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
        });
        let state = seed ^ number.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let mut random = Random { state, bytes: vec![].into_iter() };
        random.next();
        random
    }

    /// Returns the stream that bytes choose, two for each number: a byte that changes changes one number.
    pub fn from_bytes(bytes: &[u8]) -> Self {
        Random { state: 0, bytes: Vec::from(bytes).into_iter() }
    }

    /// Returns 64 random bits.
    pub fn next(&mut self) -> u64 {
        let mut z = match self.bytes.next() {
            Some(byte) => {
                let other = self.bytes.next().unwrap_or(0);
                u64::from(u16::from_be_bytes([byte, other])).wrapping_mul(0x9e37_79b9_7f4a_7c15)
            }
            None => {
                self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
                self.state
            }
        };
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    }

    /// Returns a number below `n`, which is at least 1.
    pub fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    /// Returns true in `percent` of 100 cases.
    pub fn chance(&mut self, percent: usize) -> bool {
        self.below(100) < percent
    }

    /// Returns one of several.
    pub fn pick<'a, T>(&mut self, from: &'a [T]) -> &'a T {
        &from[self.below(from.len())]
    }

    /// Returns a number in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 * 2f64.powi(-53)
    }

    /// Returns a number in [−1, 1).
    pub fn signed(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }

    /// Returns an integer between `low` and `high`, both included.
    pub fn between(&mut self, low: i64, high: i64) -> i64 {
        low + (self.next() % (high - low + 1) as u64) as i64
    }
}
