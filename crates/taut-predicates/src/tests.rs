//! Every predicate and every stage of it against integers without end, on a million hard cases.
//!
//! The oracle shares no formula with the predicates: it expands determinants of absolute coordinates, solves for
//! circumcenters by Cramer's rule, and perturbs the lifts by numbers that are really there.

mod test_length;

mod balls;
mod cases;
mod errors;
mod oracle;
mod plane;
mod radii;
mod space;

/// Splitmix64: Steele, Lea & Flood, Fast splittable pseudorandom number generators, OOPSLA 2014.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In [0, end).
    pub(crate) fn below(&mut self, end: u64) -> u64 {
        ((u128::from(self.bits()) * u128::from(end)) >> 64) as u64
    }

    /// In [from, to].
    pub(crate) fn between(&mut self, from: i64, to: i64) -> i64 {
        from + self.below((to - from + 1) as u64) as i64
    }

    /// In [−1, 1].
    pub(crate) fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub(crate) fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.below(from.len() as u64) as usize]
    }

    /// An even or odd permutation, and whether it is odd.
    pub(crate) fn shuffle<T>(&mut self, items: &mut [T]) -> bool {
        let mut odd = false;
        for i in (1..items.len()).rev() {
            let j = self.below(i as u64 + 1) as usize;
            items.swap(i, j);
            odd ^= i != j;
        }
        odd
    }
}

/// Counts of what a run met, so that a run that meets too little fails.
#[derive(Debug, Default)]
pub(crate) struct Met {
    pub(crate) positive: u64,
    pub(crate) zero: u64,
    pub(crate) negative: u64,
}

impl Met {
    pub(crate) fn count(&mut self, sign: crate::Sign) {
        match sign {
            crate::Sign::Positive => self.positive += 1,
            crate::Sign::Zero => self.zero += 1,
            crate::Sign::Negative => self.negative += 1,
        }
    }

    /// Returns true if no answer is rarer than one in so many.
    pub(crate) fn is_balanced(&self, one_in: u64) -> bool {
        let least = (self.positive + self.zero + self.negative) / one_in;
        self.positive > least && self.zero > least && self.negative > least
    }
}
