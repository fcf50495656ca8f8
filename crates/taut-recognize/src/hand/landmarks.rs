//! Tips and valleys of the fingers by the angle function of the thesis (7.4), and on which side the thumb is.
//!
//! *Idea.* For each point q of the outline, A(q) is the interior angle at q between the points at the arc length L
//! before and after it. Tips are minima and valleys maxima. Of all minima, five are chosen so that the maxima between
//! neighbors are largest; corners of the wrist drop out, as no valley separates them from a finger.
//! *Trap.* The place of an extremum jumps with noise and rotation. A landmark is the weighted mean of the places whose
//! angle is within 0.3 of the extremum.
//! *Departure.* The thesis takes the five highest peaks in the order of a counterclockwise traversal; `L` there is half
//! a finger's length, and here a multiple of the square root of the area, so that no unit is needed.

use std::f64::consts::TAU;

use taut_points::OrderBy;

use super::Side;
use super::failure::Failure;
use super::outline::{Outline, distance, gaussian_weights};

/// The window L of the angle function in square roots of the hand's area: half a finger of most hands.
pub(super) const WINDOW: f64 = 0.216;

/// The Gaussian that smooths the angle function, in windows: 4 pixels at 90 dots per inch.
const SMOOTHING: f64 = 0.04;

/// The largest angle of a tip.
const TIP_ANGLE_MAX: f64 = 1.6;

/// The least angle of a valley: a thumb at 90° still has 4.7.
const VALLEY_ANGLE_MIN: f64 = 4.0;

/// Angles within this of an extremum count for the place of its landmark.
const LANDMARK_ANGLE: f64 = 0.3;

/// The arc length between neighboring tips in windows: two lengths of a short finger, and of two long ones.
const TIP_DISTANCE: [f64; 2] = [1.2, 9.0];

/// Minima of the angle function that are considered, sharpest first: five tips, two corners of the wrist, and noise.
const CANDIDATES_MAX: usize = 20;

/// The least ratio of the thumb's distances to those of the little finger: of the first two valleys to the last two,
/// times that of the tips. Among 278 hands the valleys alone have at least 1.57, but a little finger that is spread far
/// comes near to 1: of 2756 free scans two have less than 1.25, and none less than 1.17. Those of a hand that is taken for the
/// other one are no proportions of hands.
const THUMB_RATIO_MIN: f64 = 1.12;

/// The outline of a hand with its landmarks, in the order from the thumb to the little finger.
#[derive(Clone, Debug, PartialEq)]
pub struct Landmarks {
    /// The outline, in the direction from the thumb over the fingers.
    pub outline: Outline,
    /// The places of the five tips on the outline, increasing.
    pub tips: [f64; 5],
    /// The places of the four valleys between them.
    pub valleys: [f64; 4],
    /// The angles at the tips.
    pub tip_angles: [f64; 5],
    /// The angles at the valleys.
    pub valley_angles: [f64; 4],
    /// The hand if the palm faces the sensor, as on a scanner.
    pub side: Side,
}

impl Landmarks {
    /// Returns the points of the tips, in pixels.
    #[must_use]
    pub fn tip_points(&self) -> [[f64; 2]; 5] {
        self.tips.map(|place| self.outline.at(place))
    }

    /// Returns the points of the valleys, in pixels.
    #[must_use]
    pub fn valley_points(&self) -> [[f64; 2]; 4] {
        self.valleys.map(|place| self.outline.at(place))
    }
}

/// Finds the tips and valleys of an outline around `area` pixels.
///
/// # Errors
/// [`Failure::TooFewTips`] if there are no five tips with four valleys between them, [`Failure::ThumbUnclear`] if both
/// ends of the row of tips could be the thumb.
pub fn find_landmarks(outline: &Outline, area: f64) -> Result<Landmarks, Failure> {
    let count = outline.points().len();
    let window = (WINDOW * area.sqrt() / outline.step()).round() as usize;
    if window < 4 || count < 8 * window {
        return Err(Failure::TooFewTips { found: 0 });
    }
    let angles = angle_function(outline, window);
    let candidates = find_minima(&angles, window / 2);
    let Some(chain) = best_chain(&angles, &candidates, window) else {
        return Err(Failure::TooFewTips { found: candidates.len().min(4) });
    };
    let sign = |is_tip: bool| if is_tip { 1.0 } else { -1.0 };
    let places: [f64; 9] =
        std::array::from_fn(|k| refine(&angles, chain[k], sign(k % 2 == 0), window));
    let extrema: [f64; 9] = std::array::from_fn(|k| angles[chain[k] % count]);
    let points = places.map(|place| outline.at(place));
    let ratio = distance(points[1], points[3]) / distance(points[5], points[7])
        * (distance(points[0], points[2]) / distance(points[6], points[8]));
    let (outline, places, extrema, side) = if ratio >= THUMB_RATIO_MIN {
        (outline.clone(), places, extrema, Side::Left)
    } else if ratio <= 1.0 / THUMB_RATIO_MIN {
        let mirrored = std::array::from_fn(|k| 2.0 * count as f64 - places[8 - k]);
        (outline.reversed(), mirrored, std::array::from_fn(|k| extrema[8 - k]), Side::Right)
    } else {
        return Err(Failure::ThumbUnclear { ratio });
    };
    Ok(Landmarks {
        outline,
        tips: std::array::from_fn(|k| places[2 * k]),
        valleys: std::array::from_fn(|k| places[2 * k + 1]),
        tip_angles: std::array::from_fn(|k| extrema[2 * k]),
        valley_angles: std::array::from_fn(|k| extrema[2 * k + 1]),
        side,
    })
}

/// Returns the interior angle at each sample between the samples `window` before and after it, smoothed.
#[must_use]
pub fn angle_function(outline: &Outline, window: usize) -> Vec<f64> {
    let points = outline.points();
    let count = points.len();
    let raw: Vec<f64> = (0..count)
        .map(|index| {
            let q = points[index];
            let p = points[(index + count - window % count) % count];
            let r = points[(index + window) % count];
            let (p, r) = ([p[0] - q[0], p[1] - q[1]], [r[0] - q[0], r[1] - q[1]]);
            // One arc tangent of the cross and scalar product instead of a difference of two.
            let angle = (r[0] * p[1] - r[1] * p[0]).atan2(r[0] * p[0] + r[1] * p[1]);
            if angle < 0.0 { angle + TAU } else { angle }
        })
        .collect();
    let weights = gaussian_weights(SMOOTHING * window as f64);
    let radius = weights.len() - 1;
    // The ends are repeated, so that the inner loop needs no modulo.
    let padded: Vec<f64> = (0..count + 2 * radius)
        .map(|index| raw[(index + count - radius % count) % count])
        .collect();
    padded
        .windows(2 * radius + 1)
        .map(|around| {
            let pairs =
                (1..=radius).map(|k| weights[k] * (around[radius - k] + around[radius + k]));
            weights[0] * around[radius] + pairs.sum::<f64>()
        })
        .collect()
}

/// Returns the samples whose angle is that of a tip and the least within `radius`, by place.
fn find_minima(angles: &[f64], radius: usize) -> Vec<usize> {
    let count = angles.len();
    let mut found: Vec<usize> = (0..count)
        .filter(|&index| {
            angles[index] < TIP_ANGLE_MAX
                && (1..=radius).all(|k| {
                    angles[index] <= angles[(index + k) % count]
                        && angles[index] < angles[(index + count - k) % count]
                })
        })
        .collect();
    found.order_by(&|&a, &b| angles[a].total_cmp(&angles[b]).then(a.cmp(&b)));
    found.truncate(CANDIDATES_MAX);
    found.sort_unstable();
    found
}

/// Chooses five candidates in cyclic order and the maxima between neighbors: the sum of the valleys' angles minus half
/// the sum of the tips' is largest. Returns tips and valleys alternately, as samples that increase beyond the count.
fn best_chain(angles: &[f64], candidates: &[usize], window: usize) -> Option<[usize; 9]> {
    let count = angles.len();
    let k = candidates.len();
    // Twice round, so that places count on beyond the end.
    let twice = [angles, angles].concat();
    // The valley after candidate a and before b: its sample, counted on from that of a.
    let valley = |a: usize, b: usize| -> Option<(f64, usize)> {
        let gap = (candidates[b] + count - candidates[a]) % count;
        let range = TIP_DISTANCE.map(|windows| windows * window as f64);
        if (gap as f64) < range[0] || gap as f64 > range[1] {
            return None;
        }
        let between = &twice[candidates[a] + 1..candidates[a] + gap];
        let (before, &angle) =
            between.iter().enumerate().max_by(|(_, x), (_, y)| x.total_cmp(y))?;
        (angle > VALLEY_ANGLE_MIN).then_some((angle, before + 1))
    };
    let valleys: Vec<Vec<_>> = (0..k)
        .map(|a| (0..k).map(|b| if a == b { None } else { valley(a, b) }).collect())
        .collect();
    let mut best: Option<(f64, [usize; 5])> = None;
    for start in 0..k {
        let cost = |c: usize| -0.5 * angles[candidates[c]];
        // table[n][j]: the best chain of n + 1 tips that ends at candidate start + j, and the tip before.
        let mut table = vec![vec![None; k]; 5];
        table[0][0] = Some((cost(start), 0));
        for n in 1..5 {
            for j in 1..k {
                let end = (start + j) % k;
                let mut found: Option<(f64, usize)> = None;
                for i in 0..j {
                    let Some((before, _)) = table[n - 1][i] else { continue };
                    let Some((angle, _)) = valleys[(start + i) % k][end] else { continue };
                    let score = before + angle + cost(end);
                    if found.is_none_or(|(other, _)| score > other) {
                        found = Some((score, i));
                    }
                }
                table[n][j] = found;
            }
        }
        for j in 1..k {
            let Some((score, _)) = table[4][j] else { continue };
            if best.is_some_and(|(other, _)| score <= other) {
                continue;
            }
            let mut chain = [0; 5];
            let mut at = j;
            for n in (0..5).rev() {
                chain[n] = (start + at) % k;
                at = table[n][at].map_or(0, |(_, before)| before);
            }
            best = Some((score, chain));
        }
    }
    let (_, chain) = best?;
    let mut places = [0; 9];
    places[0] = candidates[chain[0]];
    for n in 0..4 {
        let (a, b) = (chain[n], chain[n + 1]);
        places[2 * n + 1] = places[2 * n] + valleys[a][b]?.1;
        places[2 * n + 2] = places[2 * n] + (candidates[b] + count - candidates[a]) % count;
    }
    Some(places)
}

/// Returns the mean of the places around an extremum, weighted by how far the angle is from the limit.
fn refine(angles: &[f64], extremum: usize, sign: f64, window: usize) -> f64 {
    let count = angles.len();
    let limit = sign * angles[extremum % count] + LANDMARK_ANGLE;
    let weight = |place: usize| limit - sign * angles[place % count];
    let reach = |step: &dyn Fn(usize) -> usize| {
        (1..=window / 2).take_while(|&k| weight(step(k)) > 0.0).last().unwrap_or(0)
    };
    let before = reach(&|k| extremum + count - k);
    let after = reach(&|k| extremum + k);
    let (mut sum, mut moment) = (LANDMARK_ANGLE, 0.0);
    for k in 1..=before.max(after) {
        let left = if k <= before { weight(extremum + count - k) } else { 0.0 };
        let right = if k <= after { weight(extremum + k) } else { 0.0 };
        sum += left + right;
        moment += k as f64 * (right - left);
    }
    extremum as f64 + moment / sum
}
