//! The places of tips and valleys from the axes of the fingers.
//!
//! *Idea.* The angle function finds a landmark, but its place depends on the outline half a finger away. A tip is where
//! the medial line of the finger's last part meets the outline. A valley is the middle of the lowest part of the
//! outline along the bisector of the two axes.
//! *Trap.* The bottom of a valley is flat, so that its lowest point jumps: the mean of all places within a small height
//! of it, weighted by how far they are below that height, does not.

use super::landmarks::{Landmarks, WINDOW};
use super::outline::Outline;
use super::profile::{Axis, axes};

/// The height above the lowest point of a valley whose places count, in windows of the angle function: 0.9 mm.
const VALLEY_HEIGHT: f64 = 0.03;

/// How far a landmark may move, in windows.
const MOVE_MAX: f64 = 0.5;

/// Returns the landmarks with tips and valleys placed by the axes of the fingers; `area` is that of the hand in pixels.
#[must_use]
pub fn refined(landmarks: &Landmarks, area: f64) -> Landmarks {
    let axes = axes(landmarks);
    let outline = &landmarks.outline;
    let window = WINDOW * area.sqrt() / outline.step();
    let tips = std::array::from_fn(|k| {
        let place = landmarks.tips[k];
        refined_tip(outline, &axes[k], place, window).unwrap_or(place)
    });
    let valleys = std::array::from_fn(|k| {
        let place = landmarks.valleys[k];
        refined_valley(outline, [&axes[k], &axes[k + 1]], place, window).unwrap_or(place)
    });
    Landmarks { tips, valleys, ..landmarks.clone() }
}

/// Returns where the medial line of the last part of a finger meets the outline, nearest to the tip so far.
fn refined_tip(outline: &Outline, axis: &Axis, place: f64, window: f64) -> Option<f64> {
    let [offset, slope] = axis.distal_line()?;
    // The signed distance from the line, up to a factor.
    let side = |place: f64| {
        let [t, v] = axis.local(outline.at(place));
        v - offset - slope * t
    };
    let steps = (MOVE_MAX * window) as i64;
    let own = side(place);
    (0..steps).flat_map(|k| [k, -k - 1]).find_map(|k| {
        let (from, to) = (place + k as f64, place + k as f64 + 1.0);
        let (a, b) = (if k == 0 { own } else { side(from) }, side(to));
        ((a < 0.0) != (b < 0.0)).then(|| from + a / (a - b))
    })
}

/// Returns the middle of the lowest part of a valley along the bisector of the axes beside it.
fn refined_valley(outline: &Outline, axes: [&Axis; 2], place: f64, window: f64) -> Option<f64> {
    let [a, b] = axes.map(Axis::direction);
    let sum = [a[0] + b[0], a[1] + b[1]];
    let size = (sum[0] * sum[0] + sum[1] * sum[1]).sqrt();
    if size < 0.1 {
        return None;
    }
    let height = |place: f64| {
        let p = outline.at(place);
        (p[0] * sum[0] + p[1] * sum[1]) / size
    };
    let steps = (MOVE_MAX * window) as i64;
    let heights: Vec<f64> = (-steps..=steps).map(|k| height(place + k as f64)).collect();
    let (lowest, &least) = heights.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1))?;
    let limit = least + VALLEY_HEIGHT * window * outline.step();
    let mut range = [lowest, lowest];
    while range[0] > 0 && heights[range[0] - 1] < limit {
        range[0] -= 1;
    }
    while range[1] + 1 < heights.len() && heights[range[1] + 1] < limit {
        range[1] += 1;
    }
    let (mut weights, mut moment) = (0.0, 0.0);
    for k in range[0]..=range[1] {
        weights += limit - heights[k];
        moment += (limit - heights[k]) * (k as f64 - lowest as f64);
    }
    Some(place + lowest as f64 - steps as f64 + moment / weights)
}
