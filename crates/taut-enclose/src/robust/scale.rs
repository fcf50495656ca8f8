//! Robust location and scale of one coordinate: the median and Qn.
//!
//! *Idea.* Qn is the k-th smallest of all |xᵢ − xⱼ|, i < j, with k = C(⌊n/2⌋ + 1, 2). In sorted order the pairs within t
//! are counted in O(n), and the smallest t with k of them is found by halving the bit patterns of positive numbers,
//! which are ordered as the numbers are: it is exact after 64 halvings at most.
//! *Reference.* Rousseeuw, Croux, JASA 88, 1993.

/// Makes Qn the standard deviation of normal numbers: 1/(√2·Φ⁻¹(5/8)).
const NORMAL_FACTOR: f64 = 2.219_144_465_985_075_5;

/// The median; of an even number, the mean of the middle two. `values` is put in ascending order.
pub(super) fn median(values: &mut [f64]) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    let (low, high) = (values[(values.len() - 1) / 2], values[values.len() / 2]);
    low + 0.5 * (high - low)
}

/// Qn of ascending values, of which there is at least one; 0 when about half of them are equal.
pub(super) fn qn(sorted: &[f64]) -> f64 {
    let half = sorted.len() / 2 + 1;
    let wanted = (half * (half - 1) / 2) as u64;
    let within = |t: f64| {
        let (mut first, mut count) = (0, 0u64);
        for (i, x) in sorted.iter().enumerate() {
            while x - sorted[first] > t {
                first += 1;
            }
            count += (i - first) as u64;
        }
        count
    };
    let (mut low, mut high) = (0u64, (sorted[sorted.len() - 1] - sorted[0]).to_bits());
    while low < high {
        let middle = low + (high - low) / 2;
        if within(f64::from_bits(middle)) >= wanted { high = middle } else { low = middle + 1 }
    }
    NORMAL_FACTOR * f64::from_bits(low)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn qn_is_the_order_statistic_of_all_pairs() {
        let mut values: Vec<f64> = (0..41).map(|i| f64::from(i * i % 37) * 0.3 - 1.0).collect();
        for n in 2..values.len() {
            let part = &mut values[..n];
            part.sort_unstable_by(f64::total_cmp);
            let mut pairs: Vec<f64> = (0..n)
                .flat_map(|i| (0..i).map(move |j| (i, j)))
                .map(|(i, j)| part[i] - part[j])
                .collect();
            pairs.sort_unstable_by(f64::total_cmp);
            let half = n / 2 + 1;
            assert_eq!(qn(part), NORMAL_FACTOR * pairs[half * (half - 1) / 2 - 1], "{n}");
        }
        assert_eq!(qn(&[5.0]), 0.0);
        assert_eq!(median(&mut [3.0, 1.0, 2.0, 10.0]), 2.5);
    }
}
