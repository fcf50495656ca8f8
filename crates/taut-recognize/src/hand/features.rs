//! The thirty features of the thesis (7.4, figure 54), in millimeters.
//!
//! *Definitions.* A finger is the piece of the outline between its two valleys, closed by the chord. Its length is the
//! distance from the tip to the middle of the chord, its width that of the valleys, its perimeter the arc, its area
//! that of the polygon. Circles are the largest in the finger of the thumb, in the lower and upper half of the other
//! fingers, cut across at half their length, and in the whole hand.
//! *Gap.* Thumb and little finger have one valley: the other end is the first point on the outer side that is as far
//! from the tip as the valley.

use super::HandOptions;
use super::circle::{Circle, inscribed_circle};
use super::landmarks::Landmarks;
use super::outline::{Outline, between, distance, twice_signed_area};

/// The number of features of the thesis.
pub const FEATURES: usize = 30;

/// The names of the thirty features, in the thesis' order; lengths, widths, radii and perimeters are in millimeters and
/// areas in square millimeters.
pub const FEATURE_NAMES: [&str; FEATURES] = [
    "thumb length",
    "index length",
    "middle length",
    "ring length",
    "little length",
    "thumb width",
    "index width",
    "middle width",
    "ring width",
    "little width",
    "thumb circle",
    "index lower circle",
    "index upper circle",
    "middle lower circle",
    "middle upper circle",
    "ring lower circle",
    "ring upper circle",
    "little lower circle",
    "little upper circle",
    "thumb perimeter",
    "index perimeter",
    "middle perimeter",
    "ring perimeter",
    "little perimeter",
    "thumb area",
    "index area",
    "middle area",
    "ring area",
    "little area",
    "palm circle",
];

/// How the lower end of the index finger on the side of the thumb is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum IndexBase {
    /// The valley between thumb and index finger, as the thesis has it: it moves with the thumb.
    #[default]
    Valley,
    /// The point as far from the tip as the valley to the middle finger.
    Symmetric,
}

/// One finger on the outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Finger {
    /// The place of its tip on the outline.
    pub tip: f64,
    /// The places of its two lower ends, before and after the tip.
    pub base: [f64; 2],
}

/// Returns the five fingers, thumb first.
#[must_use]
pub fn fingers(landmarks: &Landmarks, index_base: IndexBase) -> [Finger; 5] {
    let (tips, valleys) = (&landmarks.tips, &landmarks.valleys);
    std::array::from_fn(|k| {
        let tip = tips[k];
        let before = (k > 0).then(|| valleys[k - 1]);
        let after = (k < 4).then(|| valleys[k]);
        let before = before.filter(|_| k != 1 || index_base == IndexBase::Valley);
        let base = match (before, after) {
            (Some(before), Some(after)) => [before, after],
            (None, Some(after)) => [opposite(&landmarks.outline, tip, after), after],
            (Some(before), None) => [before, opposite(&landmarks.outline, tip, before)],
            (None, None) => [tip, tip],
        };
        Finger { tip, base }
    })
}

/// Returns the first place on the other side of the tip that is as far from it as `valley`.
pub(super) fn opposite(outline: &Outline, tip: f64, valley: f64) -> f64 {
    let peak = outline.at(tip);
    let wanted = distance(peak, outline.at(valley));
    let sign = if valley > tip { -1.0 } else { 1.0 };
    let mut before = 0.0;
    for k in 1..outline.points().len() / 2 {
        let reached = distance(peak, outline.at(tip + sign * k as f64));
        if reached >= wanted {
            return tip + sign * (k as f64 - (reached - wanted) / (reached - before).max(1e-9));
        }
        before = reached;
    }
    tip + sign * wanted
}

/// The thirty features and the circles that some of them are the radii of.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// The features, in the order of [`FEATURE_NAMES`].
    pub features: [f64; FEATURES],
    /// The ten circles, in pixels: thumb, then lower and upper half of each finger, then the whole hand.
    pub circles: [Circle; 10],
}

/// Measures the thirty features; `None` if a piece of a finger is too thin for a circle.
#[must_use]
pub fn measure(
    landmarks: &Landmarks,
    options: &HandOptions,
    mm_per_pixel: f64,
) -> Option<Measured> {
    let outline = &landmarks.outline;
    let fingers = fingers(landmarks, options.index_base);
    let tolerance = options.circle_tolerance / mm_per_pixel;
    let mut features = [0.0; FEATURES];
    let mut circles = [Circle { center: [0.0; 2], radius: 0.0 }; 10];
    for (k, finger) in fingers.iter().enumerate() {
        let [from, to] = finger.base;
        let tip = outline.at(finger.tip);
        let ends = [outline.at(from), outline.at(to)];
        let middle = between(ends[0], ends[1], 0.5);
        let piece = outline.piece(from, to);
        features[k] = distance(tip, middle) * mm_per_pixel;
        features[5 + k] = distance(ends[0], ends[1]) * mm_per_pixel;
        features[19 + k] = (to - from) * outline.step() * mm_per_pixel;
        features[24 + k] = 0.5 * twice_signed_area(&piece).abs() * mm_per_pixel * mm_per_pixel;
        if k == 0 {
            circles[0] = inscribed_circle(&piece, tolerance)?;
        } else {
            let cut = between(tip, middle, 0.5);
            let axis = [tip[0] - middle[0], tip[1] - middle[1]];
            let lower = clip(&piece, cut, [-axis[0], -axis[1]]);
            circles[2 * k - 1] = inscribed_circle(&lower, tolerance)?;
            circles[2 * k] = inscribed_circle(&clip(&piece, cut, axis), tolerance)?;
        }
    }
    circles[9] = inscribed_circle(outline.points(), tolerance)?;
    for (k, circle) in circles.iter().enumerate() {
        let place = if k == 9 { 29 } else { 10 + k };
        features[place] = circle.radius * mm_per_pixel;
    }
    features.iter().all(|value| value.is_finite()).then_some(Measured { features, circles })
}

/// Clips a polygon by a half-plane (Sutherland–Hodgman); pieces stay joined along the line, where their edges cancel.
fn clip(polygon: &[[f64; 2]], origin: [f64; 2], normal: [f64; 2]) -> Vec<[f64; 2]> {
    let side = |p: [f64; 2]| (p[0] - origin[0]) * normal[0] + (p[1] - origin[1]) * normal[1];
    let mut kept = Vec::with_capacity(polygon.len());
    for index in 0..polygon.len() {
        let (a, b) = (polygon[index], polygon[(index + 1) % polygon.len()]);
        let (from, to) = (side(a), side(b));
        if from >= 0.0 {
            kept.push(a);
        }
        if (from >= 0.0) != (to >= 0.0) {
            kept.push(between(a, b, from / (from - to)));
        }
    }
    kept
}
