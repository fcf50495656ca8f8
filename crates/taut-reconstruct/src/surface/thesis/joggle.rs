//! Points moved a little, as the thesis' program moved them for Qhull.
//!
//! *Idea.* Points are moved to their mean and scaled into a unit cube, coordinates rounded to the 24 bits of single precision, and the
//! eight bits below are drawn at random: at 2⁻²⁴ to 2⁻³² of each coordinate, what is on one circle is on it no more.
//! *Guarantee.* What is drawn depends on the seed and the point alone, so that the order of points does not matter and equal points stay
//! equal.
//! *Reference.* Section 4.5 of the thesis.

/// The points in the unit cube about their mean, joggled.
pub(super) fn joggle(points: &[[f64; 3]], seed: u64) -> Vec<[f64; 3]> {
    let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for p in points {
        for i in 0..3 {
            bounds[0][i] = bounds[0][i].min(p[i]);
            bounds[1][i] = bounds[1][i].max(p[i]);
        }
    }
    // Halves, as the whole may be beyond all numbers.
    let half = |i: usize| 0.5 * bounds[1][i] - 0.5 * bounds[0][i];
    let size = 2.0 * half(0).max(half(1)).max(half(2)).min(0.25 * f64::MAX);
    let mean = [0, 1, 2].map(|i| mean(points, i));
    points
        .iter()
        .map(|p| {
            let mut state = seed;
            let name = p.map(|x| mixed(&mut state, x.to_bits()));
            [0, 1, 2].map(|i| {
                let x = if size > 0.0 { (p[i] - mean[i]) / size } else { 0.0 };
                with_bits(x as f32, (name[2] >> (8 * i)) as u8)
            })
        })
        .collect()
}

/// Summed up from the least to the largest, so that the order of points does not matter.
fn mean(points: &[[f64; 3]], axis: usize) -> f64 {
    let mut all: Vec<f64> = points.iter().map(|p| p[axis]).collect();
    all.sort_unstable_by(f64::total_cmp);
    let n = all.len().max(1) as f64;
    all.into_iter().map(|x| x / n).sum()
}

/// A single-precision number with these eight bits below its last; for 0, whose last bit has no place, below 2⁻³².
fn with_bits(x: f32, bits: u8) -> f64 {
    if x == 0.0 {
        return f64::from(bits) * 2f64.powi(-40);
    }
    let two_sum = f64::from(x).to_bits();
    f64::from_bits(two_sum | u64::from(bits) << (52 - 23 - 8))
}

/// The next number of a state into which a word was mixed: splitmix64.
fn mixed(state: &mut u64, word: u64) -> u64 {
    *state = (*state ^ word).wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    *state = z ^ (z >> 31);
    *state
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_move_a_little_and_alike() {
        let mut points = vec![[1.0, 2.0, 3.0], [5.0, 2.0, 3.5], [2.0, 2.5, 3.0], [1.0, 2.0, 3.0]];
        let moved = joggle(&points, 7);
        assert_eq!(moved[0], moved[3]);
        assert_ne!(moved, joggle(&points, 8));
        for (p, q) in points.iter().zip(&moved) {
            for i in 0..3 {
                let mean = [2.25, 2.125, 3.125][i];
                assert!((4.0 * q[i] - (p[i] - mean)).abs() < 2f64.powi(-22), "{p:?} {q:?}");
            }
        }
        points.swap(0, 1);
        let again = joggle(&points, 7);
        assert_eq!([again[1], again[0]], [moved[0], moved[1]]);
        assert!(joggle(&[[3.0; 3]; 2], 7).iter().flatten().all(|x| x.is_finite()));
    }
}
