//! Finds the largest of many values, and whether all are finite, without a branch for each.

use super::vector::dispatched;

dispatched! {
    /// The largest value, by sixteen running maxima, at least 0; values that are not numbers are passed over.
    largest(values: &[f64]) -> f64, largest_body
}

#[inline(always)]
fn largest_body<const FUSED: bool>(values: &[f64]) -> f64 {
    let mut lanes = [0.0f64; 16];
    let (chunks, rest) = values.as_chunks::<16>();
    for chunk in chunks {
        for (lane, &value) in lanes.iter_mut().zip(chunk) {
            *lane = if value > *lane { value } else { *lane };
        }
    }
    lanes.iter().chain(rest).fold(0.0, |m, &v| if v > m { v } else { m })
}

dispatched! {
    /// Returns true if all values are finite.
    all_finite(values: &[f64]) -> bool, all_finite_body
}

#[inline(always)]
fn all_finite_body<const FUSED: bool>(values: &[f64]) -> bool {
    // Times 0 a value is 0, or NaN if it is infinite or NaN; zeros of either sign have no bits but the sign.
    let bits = values.iter().fold(0, |bits, v| bits | (v * 0.0).to_bits());
    bits << 1 == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_is_found_wherever_it_stands() {
        for n in 0..70usize {
            for at in 0..n {
                let mut values = vec![1.0; n];
                values[at] = 7.0;
                values[(at + 3) % n] = if n > 3 { f64::NAN } else { 7.0 };
                assert_eq!(largest(&values), 7.0);
                assert_eq!(all_finite(&values), n <= 3);
                values[(at + 3) % n] = 2.0;
                assert!(all_finite(&values));
            }
        }
        assert_eq!(
            (largest(&[]), largest(&[-1.0]), all_finite(&[f64::INFINITY])),
            (0.0, 0.0, false)
        );
    }
}
