//! What is largest among many values, and whether all are finite, without a branch for each.

/// The largest value, by eight running maxima, at least 0; values that are not numbers are passed over.
pub(crate) fn largest(values: &[f64]) -> f64 {
    let mut lanes = [0.0f64; 8];
    let (chunks, rest) = values.as_chunks::<8>();
    for chunk in chunks {
        for (lane, &value) in lanes.iter_mut().zip(chunk) {
            *lane = if value > *lane { value } else { *lane };
        }
    }
    lanes.iter().chain(rest).fold(0.0, |m, &v| if v > m { v } else { m })
}

/// Whether all values are finite.
pub(crate) fn all_finite(values: &[f64]) -> bool {
    // Times 0 a value is 0, or NaN if it is infinite or NaN; zeros of either sign have no bits but the sign.
    let bits = values.iter().fold(0, |bits, v| bits | (v * 0.0).to_bits());
    bits << 1 == 0
}
