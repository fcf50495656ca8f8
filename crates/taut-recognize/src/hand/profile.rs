//! The width profile: lengths, bends and widths along the medial axis of each finger, and distances in the palm.
//!
//! *Idea.* The axis of a finger is the least-squares line through the middles of its cross-sections, so that it does
//! not depend on where the valleys are found. Widths are measured across it, nine in equal steps, none below the higher valley.
//! *Trap.* The index finger's valley to the thumb moves with the thumb: the profile uses the symmetric end instead.

use super::features::{Finger, IndexBase, Measured, fingers};
use super::landmarks::Landmarks;
use super::outline::{Outline, between, distance};

/// The number of entries of the width profile.
pub const PROFILE: usize = 61;

/// Widths along each finger.
const WIDTHS: usize = 9;

/// How far above the higher valley beside a finger its widths are measured, at least.
const SHOULDER_MM: f64 = 0.5;

/// The entries of one finger: its length, its bend, and the widths.
const FINGER_ENTRIES: usize = 2 + WIDTHS;

/// Returns the names of the entries of the profile; all are in millimeters.
#[must_use]
pub fn profile_names() -> Vec<String> {
    let mut names = vec![];
    for finger in ["thumb", "index", "middle", "ring", "little"] {
        names.push(format!("{finger} axis length"));
        names.push(format!("{finger} bend"));
        names.extend((1..=WIDTHS).map(|k| format!("{finger} width at {k}0 %")));
    }
    for pair in
        ["thumb–index to index–middle", "index–middle to middle–ring", "middle–ring to ring–little"]
    {
        names.push(format!("valley distance {pair}"));
    }
    names.push("valley offset at middle".to_owned());
    names.push("valley offset at ring".to_owned());
    names.push("palm circle".to_owned());
    names
}

/// The medial axis of a finger: a line, and the two sides of the finger in its coordinates.
pub(super) struct Axis {
    origin: [f64; 2],
    direction: [f64; 2],
    /// The distance along the axis from the level of the lower ends to the tip, in pixels.
    pub(super) length: f64,
    /// How far the higher one of the lower ends is above their mean level, in pixels.
    pub(super) shoulder: f64,
    /// The two sides from the tip on, in coordinates along and across the axis.
    sides: [Vec<[f64; 2]>; 2],
}

impl Axis {
    /// Fits the axis of a finger.
    pub(super) fn new(outline: &Outline, finger: &Finger) -> Self {
        /// Times that the line is fitted: the second changes it by less than a tenth of the first.
        const FITS: usize = 3;
        /// The part of the length whose cross-sections are fitted.
        const FITTED: [f64; 2] = [0.25, 0.85];
        let tip = outline.at(finger.tip);
        let ends = finger.base.map(|place| outline.at(place));
        // Sides go on beyond the ends, as cross-sections of a bent finger may cross the outline there.
        let beyond = 0.35 * (finger.base[1] - finger.base[0]);
        let mut before = outline.piece(finger.base[0] - beyond, finger.tip);
        before.reverse();
        let after = outline.piece(finger.tip, finger.base[1] + beyond);
        let mut origin = between(ends[0], ends[1], 0.5);
        let mut direction = unit([tip[0] - origin[0], tip[1] - origin[1]]);
        let mut axis =
            Self { origin, direction, length: 0.0, shoulder: 0.0, sides: [vec![], vec![]] };
        for fit in 0..FITS {
            let along = |p: [f64; 2]| {
                let (x, y) = (p[0] - origin[0], p[1] - origin[1]);
                [x * direction[0] + y * direction[1], y * direction[0] - x * direction[1]]
            };
            let level = 0.5 * (along(ends[0])[0] + along(ends[1])[0]);
            axis.origin = [origin[0] + level * direction[0], origin[1] + level * direction[1]];
            axis.direction = direction;
            axis.length = along(tip)[0] - level;
            axis.shoulder = (along(ends[0])[0] - level).abs();
            let shift = |p: &[f64; 2]| {
                let [t, v] = along(*p);
                [t - level, v]
            };
            axis.sides = [before.iter().map(shift).collect(), after.iter().map(shift).collect()];
            if fit + 1 == FITS {
                break;
            }
            let stations: Vec<f64> = (0..=20)
                .map(|k| axis.length * (FITTED[1] + (FITTED[0] - FITTED[1]) * f64::from(k) / 20.0))
                .collect();
            let sections = axis.sections(&stations);
            let Some((offset, slope)) = fit_line(&stations, &sections) else { break };
            let normal = [-direction[1], direction[0]];
            origin = [0, 1].map(|c| axis.origin[c] + offset * normal[c]);
            direction = unit([0, 1].map(|c| direction[c] + slope * normal[c]));
        }
        axis
    }

    /// Returns the cross-sections at distances along the axis, which must decrease: the coordinates across the axis
    /// of its two ends, where each side comes below the distance first on the way from the tip.
    pub(super) fn sections(&self, stations: &[f64]) -> Vec<Option<[f64; 2]>> {
        let crossings = |side: &[[f64; 2]]| -> Vec<Option<f64>> {
            let mut at = 0;
            stations
                .iter()
                .map(|&station| {
                    while at + 1 < side.len() && side[at + 1][0] > station {
                        at += 1;
                    }
                    let a = side.get(at)?;
                    // A side that ends above the distance goes on along the axis.
                    let Some(b) = side.get(at + 1) else { return Some(a[1]) };
                    if a[0] <= station {
                        return None;
                    }
                    Some(a[1] + (a[0] - station) / (a[0] - b[0]) * (b[1] - a[1]))
                })
                .collect()
        };
        let (left, right) = (crossings(&self.sides[0]), crossings(&self.sides[1]));
        left.into_iter().zip(right).map(|(left, right)| Some([left?, right?])).collect()
    }

    /// Returns the widths at distances along the axis, which must decrease.
    pub(super) fn widths(&self, stations: &[f64]) -> Vec<Option<f64>> {
        let sections = self.sections(stations).into_iter();
        sections.map(|section| section.map(|[left, right]| (right - left).abs())).collect()
    }

    /// Returns the largest coordinate along the axis that the finger reaches.
    pub(super) fn top(&self) -> f64 {
        let points = self.sides.iter().flatten();
        points.map(|point| point[0]).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Returns the coordinate of the tip across the axis.
    pub(super) fn tip_offset(&self) -> f64 {
        self.sides[0].first().map_or(0.0, |tip| tip[1])
    }

    /// Returns the medial line of the last part of the finger: its coordinate across the axis at 0, and its slope.
    pub(super) fn distal_line(&self) -> Option<[f64; 2]> {
        /// The part of the length: beyond the last joint, and below the round end.
        const DISTAL: [f64; 2] = [0.74, 0.89];
        const STATIONS: u32 = 14;
        let stations: Vec<f64> = (0..=STATIONS)
            .map(|k| {
                let share = f64::from(k) / f64::from(STATIONS);
                self.length * (DISTAL[1] + (DISTAL[0] - DISTAL[1]) * share)
            })
            .collect();
        fit_line(&stations, &self.sections(&stations)).map(|(offset, slope)| [offset, slope])
    }

    /// Returns the direction from the base to the tip.
    pub(super) fn direction(&self) -> [f64; 2] {
        self.direction
    }

    /// Returns the point of the axis at a distance along it.
    pub(super) fn point(&self, along: f64) -> [f64; 2] {
        [0, 1].map(|c| self.origin[c] + along * self.direction[c])
    }

    /// Returns the coordinates of a point along and across the axis.
    pub(super) fn local(&self, p: [f64; 2]) -> [f64; 2] {
        let (x, y) = (p[0] - self.origin[0], p[1] - self.origin[1]);
        let [u, v] = self.direction;
        [x * u + y * v, y * u - x * v]
    }

    /// Returns the coordinate of a point along the axis, 0 at the level of the lower ends.
    pub(super) fn along(&self, p: [f64; 2]) -> f64 {
        self.local(p)[0]
    }
}

/// Fits a line to the middles of cross-sections; returns its value at 0 and its slope.
fn fit_line(stations: &[f64], sections: &[Option<[f64; 2]>]) -> Option<(f64, f64)> {
    let points: Vec<[f64; 2]> = stations
        .iter()
        .zip(sections)
        .filter_map(|(&t, section)| section.map(|[left, right]| [t, 0.5 * (left + right)]))
        .collect();
    let count = points.len() as f64;
    let mean = |axis: usize| points.iter().map(|p| p[axis]).sum::<f64>() / count;
    let (t, v) = (mean(0), mean(1));
    let square: f64 = points.iter().map(|p| (p[0] - t).powi(2)).sum();
    let product: f64 = points.iter().map(|p| (p[0] - t) * (p[1] - v)).sum();
    (points.len() >= 3 && square > 0.0).then(|| (v - product / square * t, product / square))
}

fn unit(v: [f64; 2]) -> [f64; 2] {
    let length = (v[0] * v[0] + v[1] * v[1]).sqrt().max(f64::MIN_POSITIVE);
    v.map(|value| value / length)
}

/// Returns the axes of the five fingers, thumb first, with the symmetric lower end of the index finger.
pub(super) fn axes(landmarks: &Landmarks) -> [Axis; 5] {
    fingers(landmarks, IndexBase::Symmetric).map(|finger| Axis::new(&landmarks.outline, &finger))
}

/// Measures the width profile; `None` if a cross-section of a finger misses one of its sides.
pub(super) fn profile(
    landmarks: &Landmarks,
    axes: &[Axis; 5],
    measured: &Measured,
    mm_per_pixel: f64,
) -> Option<[f64; PROFILE]> {
    let mut profile = [0.0; PROFILE];
    for (k, axis) in axes.iter().enumerate() {
        let entries = &mut profile[FINGER_ENTRIES * k..FINGER_ENTRIES * (k + 1)];
        entries[0] = axis.length * mm_per_pixel;
        // Below the higher of two valleys a section would end on the next finger. Beyond the thumb there is none.
        let lowest = match k {
            0 => f64::NEG_INFINITY,
            _ => axis.shoulder + SHOULDER_MM / mm_per_pixel,
        };
        let share = |station: usize| (axis.length * station as f64 / 10.0).max(lowest);
        let stations: Vec<f64> = (1..=WIDTHS).rev().map(share).collect();
        let sections = axis.sections(&stations);
        let mut middles = [0.0; WIDTHS];
        for (place, section) in (0..WIDTHS).rev().zip(sections) {
            let [left, right] = section?;
            entries[2 + place] = (right - left).abs() * mm_per_pixel;
            // Positive is the side of the little finger, on both hands.
            middles[place] = 0.5 * (left + right) * (right - left).signum();
        }
        let chord = 0.5 * (middles[1] + middles[8]);
        let inner = (middles[3] + middles[4] + middles[5] + middles[6]) / 4.0;
        entries[1] = (inner - chord) * mm_per_pixel;
    }
    let valleys = landmarks.valley_points();
    let rest = FINGER_ENTRIES * 5;
    for k in 0..3 {
        profile[rest + k] = distance(valleys[k], valleys[k + 1]) * mm_per_pixel;
    }
    for k in 0..2 {
        let axis = &axes[2 + k];
        let offset = axis.along(valleys[1 + k]) - axis.along(valleys[2 + k]);
        profile[rest + 3 + k] = offset * mm_per_pixel;
    }
    profile[rest + 5] = measured.features[29];
    profile.iter().all(|value| value.is_finite()).then_some(profile)
}
