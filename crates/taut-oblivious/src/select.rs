//! Order statistics and reversal: what a scan or two can do.
//!
//! *Idea.* The k-th smallest value by the standard library's selection, which falls back on medians of medians; reversal
//! from both ends at once.
//! *Guarantee.* O(n) comparisons and O(1 + n/B) misses for each; values that are no numbers have their place in the total
//! order.
//! *Reference.* Thesis, table of section 5.8; Blum et al., *Time bounds for selection*, 1973.

use crate::{NoProbe, Probe};

/// The `k`-th smallest value (from 0) in the total order of floating-point numbers; none if there are not so many.
///
/// Afterwards the values before place k are not larger, those after it not smaller. O(n).
pub fn select(values: &mut [f64], k: usize) -> Option<f64> {
    (k < values.len()).then(|| *values.select_nth_unstable_by(k, f64::total_cmp).1)
}

/// The median: the middle value, or the mean of the two middle ones; none of nothing.
///
/// Reorders the values. O(n).
///
/// ```
/// assert_eq!(taut_oblivious::median(&mut [3.0, 1.0, 2.0, 10.0]), Some(2.5));
/// ```
pub fn median(values: &mut [f64]) -> Option<f64> {
    let n = values.len();
    let upper = select(values, n / 2)?;
    if n % 2 == 1 {
        return Some(upper);
    }
    let lower = values[..n / 2].iter().copied().max_by(f64::total_cmp)?;
    // Halves first where the sum is too large; otherwise the sum first, which is exact down to the smallest numbers.
    let sum = lower + upper;
    Some(if sum.is_finite() { sum / 2.0 } else { lower / 2.0 + upper / 2.0 })
}

/// Reverses the order of elements. O(n), each line of memory read and written once.
pub fn reverse<T>(values: &mut [T]) {
    reverse_probed(values, &mut NoProbe);
}

/// This many elements of each end are exchanged at a time.
const EXCHANGED_ELEMENTS: usize = 64;

/// As [`reverse`], and tells `probe` of the parts of both ends.
pub fn reverse_probed<T, P: Probe>(values: &mut [T], probe: &mut P) {
    if !P::LISTENS {
        return values.reverse();
    }
    probe.place(values);
    let half = values.len() / 2;
    let (front, back) = values.split_at_mut(values.len() - half);
    for (a, b) in
        front[..half].chunks_mut(EXCHANGED_ELEMENTS).zip(back.rchunks_mut(EXCHANGED_ELEMENTS))
    {
        probe.read(a);
        probe.read(b);
        a.swap_with_slice(b);
        a.reverse();
        b.reverse();
        probe.write(a);
        probe.write(b);
    }
    probe.lift(values);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Access;
    use proptest::prelude::*;

    struct Listener(usize);

    impl Probe for Listener {
        const LISTENS: bool = true;
        fn place_at(&mut self, _: usize, _: usize) {}
        fn lift_from(&mut self, _: usize) {}
        fn touch(&mut self, _: usize, bytes: usize, _: Access) {
            self.0 += bytes;
        }
    }

    /// There are fewer numbers than this, as many as an interpreter has time for.
    const NUMBERS_MAX: usize = if cfg!(miri) { 120 } else { 400 };

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(if cfg!(miri) { 3 } else { 256 }))]
        #[test]
        fn selects_and_reverses(mut values in proptest::collection::vec(any::<f64>(), 0..NUMBERS_MAX), k in 0..NUMBERS_MAX) {
            let mut sorted = values.clone();
            sorted.sort_by(f64::total_cmp);
            let found = select(&mut values, k).map(f64::to_bits);
            prop_assert_eq!(found, sorted.get(k).map(|x| x.to_bits()));
            let (mut a, mut b) = (values.clone(), values.clone());
            let mut heard = Listener(0);
            reverse(&mut a);
            reverse_probed(&mut b, &mut heard);
            for (i, x) in values.iter().enumerate() {
                let mirror = values.len() - 1 - i;
                prop_assert_eq!((a[mirror].to_bits(), b[mirror].to_bits()), (x.to_bits(), x.to_bits()));
            }
            prop_assert_eq!(heard.0, values.len() / 2 * 4 * 8);
        }
    }

    #[test]
    fn medians_of_few_and_of_extremes() {
        assert_eq!(median(&mut []), None);
        assert_eq!(median(&mut [7.0]), Some(7.0));
        assert_eq!(median(&mut [f64::MAX, f64::MAX]), Some(f64::MAX));
        assert_eq!(median(&mut [5e-324, 5e-324]), Some(5e-324));
        assert_eq!(median(&mut [f64::NAN, 1.0, 2.0]), Some(2.0));
        assert_eq!(median(&mut [4.0; 6]), Some(4.0));
    }
}
