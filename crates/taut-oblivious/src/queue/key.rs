//! Keys as integers of the same order.

/// A key of a queue: a number whose order is that of an integer of 64 bits.
///
/// Floating-point keys are in total order: −NaN, −∞, …, −0, 0, …, ∞, NaN.
pub trait QueueKey: Copy {
    /// An integer of the same order.
    fn to_bits(self) -> u64;

    /// The key that [`Self::to_bits`] made this of.
    fn from_bits(bits: u64) -> Self;
}

impl QueueKey for u64 {
    fn to_bits(self) -> u64 {
        self
    }

    fn from_bits(bits: u64) -> Self {
        bits
    }
}

impl QueueKey for u32 {
    fn to_bits(self) -> u64 {
        self.into()
    }

    fn from_bits(bits: u64) -> Self {
        bits as u32
    }
}

impl QueueKey for i64 {
    fn to_bits(self) -> u64 {
        self as u64 ^ 1 << 63
    }

    fn from_bits(bits: u64) -> Self {
        (bits ^ 1 << 63) as i64
    }
}

impl QueueKey for f64 {
    fn to_bits(self) -> u64 {
        // Negative numbers in reverse, below the others.
        let bits = f64::to_bits(self);
        if bits >> 63 == 1 { !bits } else { bits | 1 << 63 }
    }

    fn from_bits(bits: u64) -> Self {
        f64::from_bits(if bits >> 63 == 1 { bits & !(1 << 63) } else { !bits })
    }
}

impl QueueKey for f32 {
    fn to_bits(self) -> u64 {
        let bits = f32::to_bits(self);
        (if bits >> 31 == 1 { !bits } else { bits | 1 << 31 }).into()
    }

    fn from_bits(bits: u64) -> Self {
        let bits = bits as u32;
        f32::from_bits(if bits >> 31 == 1 { bits & !(1 << 31) } else { !bits })
    }
}
