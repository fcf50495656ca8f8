//! Bounds that cut a set into parts of about the same size, from a random sample.
//!
//! *Idea.* Draw β·s elements, sort them, take every β-th: s − 1 bounds for s parts.
//! *Guarantee.* A part has α n/s elements or more with probability at most n·exp(−(1 − 1/α)² αβ/2); with β = ⅓ ln n,
//! below 1/n² for α = 20. One element is drawn from each of β·s stretches of equal length: the number of those drawn
//! from any set is a sum of independent trials with the same mean as with replacement, so the bound holds; and drawing is
//! a scan, not a miss per element.
//! *Trap.* Equal elements: a value that is chosen twice or more gets a part of its own, whose elements are all equal and
//! need no sorting; without it an array of equal elements would be cut into itself endlessly.
//! *Reference.* Blelloch et al., *A comparison of sorting algorithms for the Connection Machine CM-2*, SPAA 1991; the
//! thesis, 5.6.1, which counts the bounds one too high.

use super::{Random, get, set};
use crate::Probe;

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

/// At most `parts` − 1 bounds in ascending order, from a sample that is sorted and has `parts` elements at least.
///
/// A part has the elements below its bound that are not in a part before. No value comes up more than twice; where it does,
/// the second is the bound of its own part, of the elements that equal it.
pub(super) fn bounds<T: Copy + Ord, P: Probe>(sample: &[T], parts: usize, probe: &mut P) -> Vec<T> {
    let mut found: Vec<T> = Vec::with_capacity(parts);
    for part in 1..parts {
        let value = get(sample, part * sample.len() / parts, probe);
        if !matches!(found[..], [.., x, y] if x == value && y == value) {
            found.push(value);
        }
    }
    found
}
