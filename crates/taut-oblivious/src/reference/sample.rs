//! Boundaries that cut a set into parts of about the same size, from a random sample.
//!
//! *Idea.* Draw β·s elements, sort them, take every β-th: s − 1 boundaries for s parts.
//! *Guarantee.* A part has α n/s elements or more with probability at most n·exp(−(1 − 1/α)² αβ/2); with β = ⅓ ln n,
//! below 1/n² for α = 20. One element is drawn from each of β·s stretches of equal length: the number of those drawn
//! from any set is a sum of independent trials with the same mean as with replacement, so the bound holds; and drawing is
//! a scan, not a miss per element.
//! *Trap.* Equal elements: a value that is chosen twice or more gets a part of its own, whose elements are all equal and
//! need no sorting; without it an array of equal elements would be cut into itself for ever.
//! *Reference.* Blelloch et al., *A comparison of sorting algorithms for the Connection Machine CM-2*, SPAA 1991; the
//! thesis, 5.6.1, which counts the boundaries one too high.

use super::{Random, get, set};
use crate::Probe;

/// Where one part ends and the next begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Boundary<T> {
    /// Smaller elements belong to the parts before.
    Below(T),
    /// Smaller and equal elements do.
    UpTo(T),
    /// All elements do: there is nothing behind.
    All,
}

impl<T: Copy + Ord> Boundary<T> {
    /// Whether an element belongs before this boundary.
    #[inline]
    pub(super) fn is_after(self, x: T) -> bool {
        match self {
            Self::Below(value) => x < value,
            Self::UpTo(value) => x <= value,
            Self::All => true,
        }
    }

    /// Whether the part between two neighbouring boundaries holds equal elements only.
    pub(super) fn one_value(before: Self, after: Self) -> bool {
        matches!((before, after), (Self::Below(x), Self::UpTo(y)) if x == y)
    }
}

/// β for n elements.
pub(super) fn oversampling(n: usize) -> usize {
    ((n.max(2) as f64).ln() / 3.0).ceil() as usize
}

/// Writes into `sample` an element from each of as many stretches of `array`, which is not shorter than it.
pub(super) fn draw<T: Copy, P: Probe>(
    array: &[T],
    sample: &mut [T],
    random: &mut Random,
    probe: &mut P,
) {
    let (n, count) = (array.len(), sample.len());
    for i in 0..count {
        let (start, end) = (i * n / count, (i + 1) * n / count);
        let x = get(array, start + random.below(end - start), probe);
        set(sample, i, x, probe);
    }
}

/// At most `parts` − 1 boundaries in ascending order, from a sample that is sorted and has `parts` elements at least.
pub(super) fn boundaries<T: Copy + Ord, P: Probe>(
    sample: &[T],
    parts: usize,
    probe: &mut P,
) -> Vec<Boundary<T>> {
    let mut found: Vec<Boundary<T>> = Vec::with_capacity(parts);
    for part in 1..parts {
        let value = get(sample, part * sample.len() / parts, probe);
        match found.last() {
            Some(Boundary::Below(last)) if *last == value => found.push(Boundary::UpTo(value)),
            Some(Boundary::UpTo(last)) if *last == value => {}
            _ => found.push(Boundary::Below(value)),
        }
    }
    found
}
