//! Proportions of a hand, and how far they are from those of people.

use super::super::Failure;
use super::super::features::Measured;
use super::super::landmarks::Landmarks;
use super::super::outline::distance;
use super::super::profile::Axis;
use super::Evidence;
use super::model::{FACTOR, MEAN};

/// The number of proportions.
pub const PROPORTIONS: usize = 28;

/// The names of the proportions: natural logarithms of ratios, the offsets as ratios, logarithms of gaps in mm, and turns
/// in radians. The last six are together, as a round valley turns the more the narrower it is.
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
    "index lower width to index width",
    "middle lower width to middle width",
    "ring lower width to ring width",
    "little lower width to little width",
    "gap of the index–middle valley",
    "gap of the middle–ring valley",
    "gap of the ring–little valley",
    "turn of the index–middle valley",
    "turn of the middle–ring valley",
    "turn of the ring–little valley",
];

/// Returns the proportions of a hand.
pub(super) fn proportions(
    landmarks: &Landmarks,
    axes: &[Axis; 5],
    measured: &Measured,
    gaps: &[f64; 4],
    turns: &[f64; 4],
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
        (lower[1] / widths[1]).ln(),
        (lower[2] / widths[2]).ln(),
        (lower[3] / widths[3]).ln(),
        (lower[4] / widths[4]).ln(),
        gaps[1].ln(),
        gaps[2].ln(),
        gaps[3].ln(),
        turns[1],
        turns[2],
        turns[3],
    ]
}

/// The largest Mahalanobis distance that is accepted: of 346 free hands of the tuning seed 99 % are below 7.1, and one
/// with two fingers 0.6 mm apart is above.
const DISTANCE_MAX: f64 = 7.8;

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
