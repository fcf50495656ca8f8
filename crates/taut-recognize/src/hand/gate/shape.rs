//! Proportions of a hand, and how far they are from those of people.

use super::super::Failure;
use super::super::features::Measured;
use super::super::landmarks::Landmarks;
use super::super::outline::distance;
use super::super::profile::Axis;
use super::Evidence;

/// The number of proportions.
pub const PROPORTIONS: usize = 22;

/// The names of the proportions; all but the two offsets are natural logarithms of ratios.
pub const PROPORTION_NAMES: [&str; PROPORTIONS] = [
    "thumb length to middle length",
    "index length to middle length",
    "ring length to middle length",
    "little length to middle length",
    "thumb width to middle width",
    "index width to middle width",
    "ring width to middle width",
    "little width to middle width",
    "middle width to middle length",
    "palm circle to middle length",
    "thumb–index valley to palm circle",
    "index–middle valley to palm circle",
    "middle–ring valley to palm circle",
    "ring–little valley to palm circle",
    "valley offset at middle to middle length",
    "valley offset at ring to middle length",
    "middle valleys to middle width",
    "ring valleys to ring width",
    "index base to index width",
    "middle base to middle width",
    "ring base to ring width",
    "little base to little width",
];

/// Returns the proportions of a hand.
pub(super) fn proportions(
    landmarks: &Landmarks,
    axes: &[Axis; 5],
    measured: &Measured,
) -> [f64; PROPORTIONS] {
    let width = |k: usize, share: f64| {
        axes[k].widths(&[share * axes[k].length])[0].unwrap_or(f64::NAN)
    };
    let widths: [f64; 5] = std::array::from_fn(|k| width(k, 0.5));
    let bases: [f64; 5] = std::array::from_fn(|k| width(k, 0.12));
    let length = |k: usize| axes[k].length;
    let palm = measured.circles[9];
    let valleys = landmarks.valley_points();
    let to_palm = |k: usize| distance(valleys[k], palm.center) / palm.radius;
    let offset = |k: usize| {
        (axes[k].along(valleys[k - 1]) - axes[k].along(valleys[k])) / length(2)
    };
    let gap = |k: usize| distance(valleys[k - 1], valleys[k]);
    [
        (length(0) / length(2)).ln(),
        (length(1) / length(2)).ln(),
        (length(3) / length(2)).ln(),
        (length(4) / length(2)).ln(),
        (widths[0] / widths[2]).ln(),
        (widths[1] / widths[2]).ln(),
        (widths[3] / widths[2]).ln(),
        (widths[4] / widths[2]).ln(),
        (widths[2] / length(2)).ln(),
        (palm.radius / length(2)).ln(),
        to_palm(0).ln(),
        to_palm(1).ln(),
        to_palm(2).ln(),
        to_palm(3).ln(),
        offset(2),
        offset(3),
        (gap(2) / widths[2]).ln(),
        (gap(3) / widths[3]).ln(),
        (bases[1] / widths[1]).ln(),
        (bases[2] / widths[2]).ln(),
        (bases[3] / widths[3]).ln(),
        (bases[4] / widths[4]).ln(),
    ]
}

/// Returns proportions that no free hand has.
pub(super) fn concerns(evidence: &Evidence, measured: &Measured) -> Option<Failure> {
    let _ = (evidence, measured);
    None
}
