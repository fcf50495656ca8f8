//! Proportions of a hand, and how far they are from those of people.

use super::super::Failure;
use super::super::features::Measured;
use super::super::landmarks::Landmarks;
use super::super::outline::distance;
use super::super::profile::Axis;
use super::model::{FACTOR, MEAN};
use super::{Ends, Evidence};

/// The number of proportions.
pub const PROPORTIONS: usize = 30;

/// The names of the proportions: natural logarithms of ratios, the offsets as ratios; depths of 5 mm of the outline in
/// mm, and logarithms of turns in radians and of the widths near the tips. Depths and turns are together, as a round
/// valley turns the more the narrower it is. The thumb's length is left out: it depends on how far the thumb is spread.
pub const PROPORTION_NAMES: [&str; PROPORTIONS] = [
    "index length to middle length",
    "ring length to middle length",
    "little length to middle length",
    "thumb width to middle width",
    "index width to middle width",
    "ring width to middle width",
    "little width to middle width",
    "middle width to middle length",
    "palm circle to middle length",
    "index–middle valley to palm circle",
    "middle–ring valley to palm circle",
    "ring–little valley to palm circle",
    "valley offset at middle to middle length",
    "valley offset at ring to middle length",
    "middle valleys to middle width",
    "ring valleys to ring width",
    "index lower width to index width",
    "middle lower width to middle width",
    "ring lower width to ring width",
    "little lower width to little width",
    "depth of the index–middle valley",
    "depth of the middle–ring valley",
    "depth of the ring–little valley",
    "turn of the index–middle valley",
    "turn of the middle–ring valley",
    "turn of the ring–little valley",
    "roundness of the index finger",
    "roundness of the middle finger",
    "roundness of the ring finger",
    "roundness of the little finger",
];

/// Returns the proportions of a hand.
pub(super) fn proportions(
    landmarks: &Landmarks,
    axes: &[Axis; 5],
    measured: &Measured,
    ends: &Ends,
) -> [f64; PROPORTIONS] {
    let width =
        |k: usize, share: f64| axes[k].widths(&[share * axes[k].length])[0].unwrap_or(f64::NAN);
    let widths: [f64; 5] = std::array::from_fn(|k| width(k, 0.5));
    let lower: [f64; 5] = std::array::from_fn(|k| width(k, 0.25));
    let length = |k: usize| axes[k].length;
    let palm = measured.circles[9];
    let valleys = landmarks.valley_points();
    let to_palm = |k: usize| distance(valleys[k], palm.center) / palm.radius;
    let offset = |k: usize| (axes[k].along(valleys[k - 1]) - axes[k].along(valleys[k])) / length(2);
    let gap = |k: usize| distance(valleys[k - 1], valleys[k]);
    // The sides of a valley are 5 mm of the outline: straight, they have no depth.
    let depth = |k: usize| (25.0 - ends.gaps[k] * ends.gaps[k]).max(0.25).sqrt();
    // A flat valley is no concern: the least turns count as one.
    let turn = |k: usize| (ends.turns[k].max(0.35) + 0.3).ln();
    [
        (length(1) / length(2)).ln(),
        (length(3) / length(2)).ln(),
        (length(4) / length(2)).ln(),
        (widths[0] / widths[2]).ln(),
        (widths[1] / widths[2]).ln(),
        (widths[3] / widths[2]).ln(),
        (widths[4] / widths[2]).ln(),
        (widths[2] / length(2)).ln(),
        (palm.radius / length(2)).ln(),
        to_palm(1).ln(),
        to_palm(2).ln(),
        to_palm(3).ln(),
        offset(2),
        offset(3),
        (gap(2) / widths[2]).ln(),
        (gap(3) / widths[3]).ln(),
        (lower[1] / widths[1]).ln(),
        (lower[2] / widths[2]).ln(),
        (lower[3] / widths[3]).ln(),
        (lower[4] / widths[4]).ln(),
        depth(1),
        depth(2),
        depth(3),
        turn(1),
        turn(2),
        turn(3),
        ends.tip_ratio[1].ln(),
        ends.tip_ratio[2].ln(),
        ends.tip_ratio[3].ln(),
        ends.tip_ratio[4].ln(),
    ]
}

/// The largest Mahalanobis distance that is accepted: of 3573 free scans of the tuning seed 99.8 % are below 7.7, and of
/// 2981 others all but two below 9.5; of 1066 with fused fingers those that no other sign shows are above 10.9.
const DISTANCE_MAX: f64 = 9.5;

/// The lengths of a middle finger in mm, from a child's to the largest: beyond, the resolution is wrong.
const MIDDLE_LENGTH_MM: [f64; 2] = [35.0, 120.0];

/// Returns proportions or sizes that no free hand has.
pub(super) fn concerns(evidence: &Evidence, measured: &Measured) -> Vec<Failure> {
    let mut found = vec![];
    let distance = distance_from_model(&evidence.proportions);
    // A proportion that is not a number is none of a hand.
    if distance.is_nan() || distance > DISTANCE_MAX {
        found.push(Failure::Proportions { distance, limit: DISTANCE_MAX });
    }
    let (value, [low, high]) = (measured.features[2], MIDDLE_LENGTH_MM);
    if !(low..=high).contains(&value) {
        let measure = "the length of the middle finger in mm".to_owned();
        found.push(Failure::Implausible { measure, value, low, high });
    }
    found
}

/// Returns the Mahalanobis distance of proportions from their mean, by forward substitution in the Cholesky factor.
fn distance_from_model(proportions: &[f64; PROPORTIONS]) -> f64 {
    let mut whitened = [0.0; PROPORTIONS];
    let mut row = 0;
    for i in 0..PROPORTIONS {
        let sum: f64 = (0..i).map(|k| FACTOR[row + k] * whitened[k]).sum();
        whitened[i] = (proportions[i] - MEAN[i] - sum) / FACTOR[row + i];
        row += i + 1;
    }
    whitened.iter().map(|value| value * value).sum::<f64>().sqrt()
}
