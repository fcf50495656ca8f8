//! Whether what a fit leaves of points is noise: residuals that do not follow each other.
//!
//! *Idea.* Along the curve in runs of [`RUN_POINTS`] points, the mean square of successive differences over twice the variance is 1 on average
//! where offsets are independent (von Neumann 1941), whatever the noise. Rugged borders leave 0.4 to 1, noise 0.85 to 1.3. Where half
//! neighbors are mutual, as they are of vertices, more is asked: noise so narrow that they are leaves long runs of points, and noise as wide as
//! the residuals say would not leave them mutual.
//! *Guarantee.* A function of the points along the curves; O(n log n).

use super::parameters::{
    MUTUAL_NEUMANN_MIN, MUTUAL_NEUMANN_SPREAD, MUTUAL_RUNS_SHARE_MIN, MUTUAL_SHARE_LOSS,
    MUTUAL_SHARE_MAX, MUTUAL_SHARE_MIN, NOISE_NEUMANN_MIN, NOISE_NEUMANN_SPREAD, RUN_POINTS,
};
use super::spline::Spline;

/// Whether the residuals of so many points are those of noise. The median of few runs is off by more, and is forgiven more.
pub(super) fn are_noise(
    splines: &[Spline],
    points: usize,
    noisiness: f64,
    mutual_share: f64,
) -> bool {
    let (runs, ratio) = neumann_ratio(splines);
    let is_above = |least: f64, spread: f64| ratio > least - spread / (runs as f64).sqrt();
    let is_noise = runs > 0 && is_above(NOISE_NEUMANN_MIN, NOISE_NEUMANN_SPREAD);
    if mutual_share < MUTUAL_SHARE_MIN {
        return is_noise;
    }
    is_noise
        && is_above(MUTUAL_NEUMANN_MIN, MUTUAL_NEUMANN_SPREAD)
        && (runs * RUN_POINTS) as f64 >= MUTUAL_RUNS_SHARE_MIN * points as f64
        && mutual_share <= MUTUAL_SHARE_MAX - MUTUAL_SHARE_LOSS * noisiness
}

/// How many runs there are of points along the curves, and the median of their ratios.
fn neumann_ratio(splines: &[Spline]) -> (usize, f64) {
    let mut ratios = vec![];
    for spline in splines {
        for run in spline.members.chunks_exact(RUN_POINTS) {
            let offsets: Vec<f64> = run
                .iter()
                .map(|member| {
                    let (at, along) = spline.place(member.arc.clamp(0.0, spline.length()));
                    let (x, y) = (member.at[0] - at[0], member.at[1] - at[1]);
                    (along[0] * y - along[1] * x) / along[0].hypot(along[1])
                })
                .collect();
            ratios.extend(ratio(&offsets));
        }
    }
    let (runs, middle) = (ratios.len(), ratios.len() / 2);
    match runs {
        0 => (0, 0.0),
        _ => (runs, *ratios.select_nth_unstable_by(middle, f64::total_cmp).1),
    }
}

/// That of one run; none where all offsets are equal.
fn ratio(offsets: &[f64]) -> Option<f64> {
    let count = offsets.len() as f64;
    let mean = offsets.iter().sum::<f64>() / count;
    let squares: f64 = offsets.iter().map(|x| (x - mean).powi(2)).sum();
    let steps: f64 = offsets.windows(2).map(|pair| (pair[1] - pair[0]).powi(2)).sum();
    let ratio = steps / (count - 1.0) / (2.0 * squares / (count - 1.0));
    ratio.is_finite().then_some(ratio)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waves_follow_each_other_and_signs_do_not() {
        let wave: Vec<f64> = (0..24).map(|k| (f64::from(k) * 0.5).sin()).collect();
        assert!(ratio(&wave).expect("they differ") < 0.2);
        let signs: Vec<f64> = (0..24).map(|k| f64::from(1 - 2 * (k % 2))).collect();
        assert!((ratio(&signs).expect("they differ") - 23.0 * 4.0 / 48.0).abs() < 1e-12);
        assert_eq!(ratio(&[1.0; 24]), None);
    }
}
