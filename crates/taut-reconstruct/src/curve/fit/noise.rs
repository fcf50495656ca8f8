//! What kind of noise it is: whether it has an edge, where that is, and whether there are outliers beside the band.
//!
//! *Idea.* Distances from the curve are measured in standard deviations of the noise around each place, and pooled over all points.
//! Of uniform noise nine tenths lie within 1.8 times the median distance, of normal noise within 2.4 times. What lies beyond three
//! deviations is background, as dense there as within the band, and is subtracted first.
//! *Guarantee.* A function of the distances; O(n log n).

use super::parameters::{EDGE_MEDIANS_MAX, KIND_POINTS_MIN, NOISE_DEVIATIONS_MAX};
use super::spline::Spline;

/// What is known about the noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Noise {
    /// Where noise ends, in standard deviations, if it has an edge.
    pub(super) edge: Option<f64>,
    /// Whether there are outliers beside the band.
    pub(super) outliers: bool,
}

impl Noise {
    /// Nothing is known.
    pub(super) const UNKNOWN: Self = Self { edge: None, outliers: false };

    /// Of the members of splines, whose distances go up to `width` deviations, more than [`NOISE_DEVIATIONS_MAX`].
    pub(super) fn of<'a>(splines: impl Iterator<Item = &'a Spline>, width: f64) -> Self {
        let mut shares: Vec<f64> =
            splines.flat_map(|s| s.members.iter().map(|m| m.share)).collect();
        shares.sort_unstable_by(f64::total_cmp);
        let below = |z: f64| shares.partition_point(|&share| share <= z);
        let near = below(NOISE_DEVIATIONS_MAX);
        if near < KIND_POINTS_MIN {
            return Self::UNKNOWN;
        }
        let background = (shares.len() - near) as f64 / (width - NOISE_DEVIATIONS_MAX);
        let total = near as f64 - NOISE_DEVIATIONS_MAX * background;
        // The place below which lies a share of the noise.
        let quantile = |part: f64| {
            let (mut low, mut high) = (0, near);
            while low < high {
                let middle = (low + high) / 2;
                let inside = (middle + 1) as f64 - shares[middle] * background;
                if inside < part * total { low = middle + 1 } else { high = middle }
            }
            shares[low.min(near - 1)]
        };
        let (median, most) = (quantile(0.5), quantile(0.9));
        let edged = most < EDGE_MEDIANS_MAX * median;
        Self {
            edge: edged.then_some(most / 0.9),
            outliers: edged && background * NOISE_DEVIATIONS_MAX > 1e-3 * total,
        }
    }
}
