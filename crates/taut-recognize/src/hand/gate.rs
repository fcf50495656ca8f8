//! The plausibility gate: what may have changed the features without a failure before.
//!
//! *Problem.* A ring cuts a finger, a bandage widens it, fingers that touch move a valley: five tips and four valleys
//! are found all the same, and features are wrong by up to two thirds.
//! *Idea.* Each trap leaves a mark that a free hand does not have: a second piece, a hole, a flat tip, a step in the
//! width, a valley that is not round, a proportion that hands do not have.
//! *Limits.* The gate says "may be wrong", not "is wrong": it refuses some free hands too.

use super::components::{Component, LargestComponent};
use super::failure::{Edge, FingerName, Pixel, Sign};
use super::features::Measured;
use super::landmarks::Landmarks;
use super::outline::{Outline, distance};
use super::profile::Axis;
use super::trace::{EdgeColors, b_at};
use super::{Failure, RgbImage};

mod model;
mod shade;
mod shape;

use shade::Shading;
pub use shape::{PROPORTION_NAMES, PROPORTIONS};

/// The image and what was found in it.
pub(super) struct Sheet<'a> {
    pub(super) image: &'a RgbImage,
    pub(super) colors: Option<EdgeColors>,
    pub(super) mm_per_pixel: f64,
    pub(super) component: &'a LargestComponent,
}

/// The least area of a second object in mm²: dust has 3 at most, the tip of a little finger beyond a ring 60.
const PIECE_MIN_MM2: f64 = 8.0;

/// The largest area of a piece of a finger in mm²; a second hand is larger.
const PIECE_MAX_MM2: f64 = 2500.0;

/// The least area of a hole that is a concern in mm²; dust within a hand makes smaller ones.
const HOLE_MIN_MM2: f64 = 4.0;

/// How close the outline comes to an edge that cuts it, in pixels: the centers of the border pixels are at 0.5, and
/// smoothing and noise move it away from there by up to 0.6. Of 266 pages cut so that a hand reaches the last pixel and no
/// farther none has more than 1.11; of 3000 free hands some three are nearer, by half a pixel or less.
const EDGE_PIXELS: f64 = 1.15;

/// The width 2 mm below a tip over that at 70 % of the length: 0.55 to 0.72 for round tips, 0.95 for flat ones.
const FLAT_TIP: f64 = 0.80;

/// The change of b* across the edge of a tip over that of the whole edge: where a finger leaves the glass, its color
/// fades over a centimeter. Of 2978 free scans none has less than 0.83, and of 29 lifted fingers whose tips are not flat
/// none above 0.57.
const TIP_CONTRAST_MIN: f64 = 0.75;

/// The largest change of the width along 3 mm beyond that of its surroundings, in mm: of 3573 free scans 0.1 % have more,
/// and bandages that change a feature by 5 % have at least 0.7. The thumb is short and its joint thick: one person in
/// 140 has 0.8 to 0.97 in all scans.
const WIDTH_STEP_MM: [f64; 5] = [1.05, 0.45, 0.42, 0.45, 0.60];

/// The distance between the two sides of a valley 2.5 mm along the outline from its bottom, at least, in mm: of 1252
/// free scans the least are 3, 0.6, 0.5 and 1.9, and a valley of fingers that touch has 0.2 to 1.1.
const VALLEY_GAP_MM: [f64; 4] = [0.72, 0.45, 0.45, 1.2];

/// The opening of a valley and by how much it is wider than the valley's bottom, together at least, in mm: fingers that
/// touch lie side by side for longer. Of 2981 free scans none has less than 2.6, and of 472 with a finger that touches the
/// next one none above 2.0 whose proportions are those of hands.
const VALLEY_OPENING_MM: f64 = 2.3;

/// The least rise of the brightness at the sides of a finger: in 2978 free scans 0.89 or more, and on 210 flat covers
/// that only this or a step of the width shows at most 0.13.
const SIDE_RISE_MIN: f64 = 0.5;

/// The largest brightness below a valley: in 2978 free scans at most 0.56, and below 36 flat patches that nothing else
/// shows at least 0.94.
const VALLEY_BRIGHTNESS_MAX: f64 = 0.73;

/// The tip may be so far from the axis, in widths of the finger.
const TIP_OFFSET: f64 = 0.25;

/// What the gate measured at the valleys and tips, for the proportions.
struct Ends {
    gaps: [f64; 4],
    turns: [f64; 4],
    tip_ratio: [f64; 5],
}

/// What the gate measured on a hand.
#[derive(Clone, Debug, PartialEq)]
pub struct Evidence {
    /// The width 2 mm below each tip over that at 70 % of the length: 0.55 to 0.72 for round tips, 0.95 for flat ones.
    pub tip_ratio: [f64; 5],
    /// The change of b* within 2 mm across the edge of each tip, over that of the whole edge: 0.8 or more for tips on
    /// the glass.
    pub tip_contrast: [f64; 5],
    /// The distance of each tip from the axis of its finger, over the width at 70 % of the length.
    pub tip_offset: [f64; 5],
    /// The largest change of each finger's width along 3 mm beyond that of its surroundings, in mm.
    pub width_step: [f64; 5],
    /// Where that change is, in pixels.
    pub width_step_at: [[f64; 2]; 5],
    /// The distance between the sides of each valley, 2.5 mm along the outline from its bottom, in mm.
    pub valley_gap: [f64; 4],
    /// The mean distance between the sides of each valley, 12 to 20 mm along the outline from its bottom, in mm.
    pub valley_opening: [f64; 4],
    /// The largest change of direction along 1.5 mm of the outline near each valley, in radians.
    pub valley_turn: [f64; 4],
    /// The least brightness 0.75 to 1.5 mm below each valley: 0 as near the edges of this hand, 1 as within.
    pub valley_brightness: [f64; 4],
    /// The least rise of the brightness across the outer 2 mm of each finger, over 5 mm of its length: 1 as on most of
    /// this hand, 0 on a flat cover.
    pub side_rise: [f64; 5],
    /// Proportions of the hand, in the order of [`PROPORTION_NAMES`].
    pub proportions: [f64; PROPORTIONS],
}

impl Evidence {
    pub(super) fn new(
        landmarks: &Landmarks,
        axes: &[Axis; 5],
        measured: &Measured,
        sheet: &Sheet<'_>,
    ) -> Self {
        let mm_per_pixel = sheet.mm_per_pixel;
        let gaps = std::array::from_fn(|k| chord(landmarks, k, VALLEY_ARC_MM, mm_per_pixel));
        let turns = std::array::from_fn(|k| valley_turn(landmarks, k, mm_per_pixel));
        let tips = [0, 1, 2, 3, 4].map(|k| tip_measures(&axes[k], mm_per_pixel));
        let steps: [(f64, [f64; 2]); 5] = std::array::from_fn(|k| {
            let (step, along) = width_step(&axes[k], FingerName::ALL[k], mm_per_pixel);
            (step, axes[k].point(along))
        });
        let tip_ratio = tips.map(|[ratio, _]| ratio);
        let shading = Shading::new(landmarks, axes, sheet);
        Self {
            tip_ratio,
            tip_contrast: std::array::from_fn(|k| {
                tip_contrast(landmarks, &axes[k], landmarks.tips[k], sheet).unwrap_or(1.0)
            }),
            tip_offset: tips.map(|[_, offset]| offset),
            width_step: steps.map(|(step, _)| step),
            width_step_at: steps.map(|(_, place)| place),
            valley_gap: gaps,
            valley_opening: std::array::from_fn(|k| {
                let chords = OPENING_ARCS_MM.map(|arc| chord(landmarks, k, arc, mm_per_pixel));
                chords.iter().sum::<f64>() / chords.len() as f64
            }),
            valley_turn: turns,
            valley_brightness: shading.valley_brightness,
            side_rise: shading.side_rise,
            proportions: shape::proportions(
                landmarks,
                axes,
                measured,
                &Ends { gaps, turns, tip_ratio },
            ),
        }
    }
}

/// Returns everything about a measured hand that no free hand shows.
pub(super) fn concerns(
    landmarks: &Landmarks,
    evidence: &Evidence,
    measured: &Measured,
    sheet: &Sheet<'_>,
) -> Vec<Failure> {
    let mut found = vec![];
    found.extend(cut_off(landmarks, measured, sheet));
    let frame = Frame::new(landmarks, measured);
    found.extend(second_piece(landmarks, &frame, sheet));
    found.extend(hole(sheet, Some(&frame)));
    for k in 0..4 {
        let (first, second) = (FingerName::ALL[k], FingerName::ALL[k + 1]);
        let is_narrow = evidence.valley_gap[k] < VALLEY_GAP_MM[k]
            || 2.0 * evidence.valley_opening[k] - evidence.valley_gap[k] < VALLEY_OPENING_MM;
        if is_narrow || evidence.valley_brightness[k] > VALLEY_BRIGHTNESS_MAX {
            let at = Pixel::of(landmarks.outline.at(landmarks.valleys[k]));
            found.push(Failure::FingersTouching { first, second, at });
        }
    }
    for (k, finger) in FingerName::ALL.into_iter().enumerate() {
        let tip = landmarks.outline.at(landmarks.tips[k]);
        let sign = if evidence.tip_ratio[k] > FLAT_TIP {
            Some((Sign::FlatTip, tip))
        } else if evidence.tip_contrast[k] < TIP_CONTRAST_MIN {
            Some((Sign::FadingTip, tip))
        } else if evidence.tip_offset[k] > TIP_OFFSET {
            Some((Sign::SkewTip, tip))
        } else if evidence.width_step[k] > WIDTH_STEP_MM[k] {
            Some((Sign::WidthStep, evidence.width_step_at[k]))
        } else if evidence.side_rise[k] < SIDE_RISE_MIN {
            Some((Sign::FlatSides, tip))
        } else {
            None
        };
        found.extend(sign.map(|(sign, place)| Failure::RingOrBandage {
            finger,
            sign,
            at: Pixel::of(place),
        }));
    }
    found.extend(shape::concerns(evidence, measured));
    found
}

/// Returns the reason for which no landmarks were found, if it is another than that there are too few.
pub(super) fn explain(failure: Failure, sheet: &Sheet<'_>) -> Failure {
    if !matches!(failure, Failure::TooFewTips { .. } | Failure::ThumbUnclear { .. }) {
        return failure;
    }
    // The wrist is at the edge with the longest contact; a hand at another one is cut off.
    let lengths = Edge::ALL.map(|edge| (contact(sheet, edge).count(), edge));
    let wrist = lengths.iter().max_by_key(|(length, _)| *length).map(|(_, edge)| *edge);
    let cut = lengths.iter().filter(|(length, edge)| *length > 0 && Some(*edge) != wrist);
    if let Some((_, edge)) = cut.max_by_key(|(length, _)| *length) {
        let at = contact(sheet, *edge).next().unwrap_or(Pixel { x: 0, y: 0 });
        return Failure::CutOff { edge: *edge, at };
    }
    hole(sheet, None).unwrap_or(failure)
}

/// Returns the pixels of the component at an edge of the image.
fn contact<'a>(sheet: &'a Sheet<'_>, edge: Edge) -> impl Iterator<Item = Pixel> + 'a {
    let (width, height) = (sheet.image.width() as i64, sheet.image.height() as i64);
    let length = if matches!(edge, Edge::Left | Edge::Right) { height } else { width };
    let pixel = move |k: i64| match edge {
        Edge::Left => Pixel { x: 0, y: k },
        Edge::Right => Pixel { x: width - 1, y: k },
        Edge::Top => Pixel { x: k, y: 0 },
        Edge::Bottom => Pixel { x: k, y: height - 1 },
    };
    (0..length).map(pixel).filter(|&Pixel { x, y }| sheet.component.mask.contains(x, y))
}

/// Where the fingers of a hand are.
struct Frame {
    palm: [f64; 2],
    /// The direction from the palm to the fingers.
    up: [f64; 2],
    radius: f64,
}

impl Frame {
    fn new(landmarks: &Landmarks, measured: &Measured) -> Self {
        let palm = measured.circles[9];
        let valleys = landmarks.valley_points();
        let knuckles = [0, 1].map(|c| 0.5 * (valleys[1][c] + valleys[2][c]));
        let up = [0, 1].map(|c| knuckles[c] - palm.center[c]);
        let length = (up[0] * up[0] + up[1] * up[1]).sqrt().max(f64::MIN_POSITIVE);
        Self { palm: palm.center, up: up.map(|v| v / length), radius: palm.radius }
    }

    /// Tests whether a point is above the lower end of the palm's circle.
    fn is_above_wrist(&self, [x, y]: [f64; 2]) -> bool {
        (x - self.palm[0]) * self.up[0] + (y - self.palm[1]) * self.up[1] >= -self.radius
    }
}

/// Tests whether the outline meets an edge of the image above the wrist.
fn cut_off(landmarks: &Landmarks, measured: &Measured, sheet: &Sheet<'_>) -> Option<Failure> {
    let frame = Frame::new(landmarks, measured);
    let (width, height) = (sheet.image.width() as f64, sheet.image.height() as f64);
    let (edge, at) = landmarks.outline.points().iter().find_map(|&[x, y]| {
        if !frame.is_above_wrist([x, y]) {
            return None;
        }
        let gaps =
            [(x, Edge::Left), (width - x, Edge::Right), (y, Edge::Top), (height - y, Edge::Bottom)];
        let near = gaps.into_iter().find(|(gap, _)| *gap < EDGE_PIXELS);
        near.map(|(_, edge)| {
            (edge, Pixel::of([x.clamp(0.0, width - 1.0), y.clamp(0.0, height - 1.0)]))
        })
    })?;
    Some(Failure::CutOff { edge, at })
}

/// Finds a second object above the wrist: the piece of a finger beyond a ring, or something else. Below the wrist is
/// the arm, which a sleeve or a watch may cut.
fn second_piece(landmarks: &Landmarks, frame: &Frame, sheet: &Sheet<'_>) -> Option<Failure> {
    let square = sheet.mm_per_pixel * sheet.mm_per_pixel;
    let area = |object: &Component| object.area as f64 * square;
    let object = sheet
        .component
        .others
        .iter()
        .find(|object| area(object) >= PIECE_MIN_MM2 && frame.is_above_wrist(object.center))?;
    let tips = landmarks.tip_points();
    let nearest = (0..5).min_by(|&a, &b| {
        distance(tips[a], object.center).total_cmp(&distance(tips[b], object.center))
    })?;
    // A piece is at most a finger's length beyond the stump's tip.
    const PIECE_DISTANCE_MM: f64 = 70.0;
    let gap = distance(tips[nearest], object.center) * sheet.mm_per_pixel;
    let at = Pixel::of(object.center);
    Some(if area(object) <= PIECE_MAX_MM2 && gap <= PIECE_DISTANCE_MM {
        Failure::RingOrBandage { finger: FingerName::ALL[nearest], sign: Sign::SecondPiece, at }
    } else {
        Failure::SecondObject { area_mm2: area(object), at }
    })
}

/// Finds a hole, within a frame above its wrist.
fn hole(sheet: &Sheet<'_>, frame: Option<&Frame>) -> Option<Failure> {
    let is_in_hand =
        |hole: &&Component| frame.is_none_or(|frame| frame.is_above_wrist(hole.center));
    let hole = sheet.component.holes.iter().find(is_in_hand)?;
    let area_mm2 = hole.area as f64 * sheet.mm_per_pixel * sheet.mm_per_pixel;
    (area_mm2 >= HOLE_MIN_MM2).then_some(Failure::Hole { area_mm2, at: Pixel::of(hole.center) })
}

/// The arc from the bottom of a valley to both of its sides, in mm, for its width.
const VALLEY_ARC_MM: f64 = 2.5;

/// The same for its opening.
const OPENING_ARCS_MM: [f64; 5] = [12.0, 14.0, 16.0, 18.0, 20.0];

/// Returns the distance in mm between the sides of a valley at an arc length from its bottom.
fn chord(landmarks: &Landmarks, valley: usize, arc_mm: f64, mm_per_pixel: f64) -> f64 {
    let outline: &Outline = &landmarks.outline;
    let arc = arc_mm / mm_per_pixel / outline.step();
    let place = landmarks.valleys[valley];
    distance(outline.at(place - arc), outline.at(place + arc)) * mm_per_pixel
}

/// Returns the largest change of direction along 1.5 mm of the outline within 6 mm of a valley, in radians; to the
/// outside, as the bottom of a valley has it.
fn valley_turn(landmarks: &Landmarks, valley: usize, mm_per_pixel: f64) -> f64 {
    const REACH_MM: f64 = 6.0;
    const ARC_MM: f64 = 1.5;
    const CHORD_MM: f64 = 0.8;
    let outline = &landmarks.outline;
    let places = |mm: f64| mm / mm_per_pixel / outline.step();
    let (arc, chord, reach) = (places(ARC_MM), places(CHORD_MM), places(REACH_MM));
    let tangent = |place: f64| {
        let (a, b) = (outline.at(place - 0.5 * chord), outline.at(place + 0.5 * chord));
        [b[0] - a[0], b[1] - a[1]]
    };
    // Landmarks of a right hand go against the outline's own direction.
    let sign = if landmarks.side == super::Side::Left { -1.0 } else { 1.0 };
    let middle = landmarks.valleys[valley];
    (-(reach as i64)..=reach as i64)
        .map(|k| {
            let place = middle + k as f64;
            let (a, b) = (tangent(place - 0.5 * arc), tangent(place + 0.5 * arc));
            sign * (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1])
        })
        .fold(0.0, f64::max)
}

/// Returns the width 2 mm below the tip over that at 70 %, and the tip's distance from the axis over that width;
/// infinite if the finger has no such width.
fn tip_measures(axis: &Axis, mm_per_pixel: f64) -> [f64; 2] {
    const DEPTH_MM: f64 = 2.0;
    let top = axis.top() - DEPTH_MM / mm_per_pixel;
    match axis.widths(&[top, 0.7 * axis.length])[..] {
        [Some(near_tip), Some(below)] if below > 0.0 => {
            [near_tip / below, axis.tip_offset().abs() / below]
        }
        _ => [f64::INFINITY; 2],
    }
}

/// Returns the median change of b* across the edge near a tip over that of the whole edge; `None` without colors.
fn tip_contrast(landmarks: &Landmarks, axis: &Axis, tip: f64, sheet: &Sheet<'_>) -> Option<f64> {
    /// Along the outline to both sides of the tip.
    const ARC_MM: f64 = 2.0;
    /// Along the axis to both sides of the outline.
    const DEPTH_MM: f64 = 1.0;
    let colors = sheet.colors?;
    let outline = &landmarks.outline;
    let [u, v] = axis.direction();
    // The blur of an edge is some pixels at every resolution.
    let depth = (DEPTH_MM / sheet.mm_per_pixel).max(3.0);
    let b = |p: [f64; 2], depth: f64| {
        b_at(sheet.image, [p[0] + depth * u, p[1] + depth * v].map(|c| c.floor() as i64))
    };
    let reach = (ARC_MM / sheet.mm_per_pixel / outline.step()) as i64;
    let mut changes: Vec<f64> = (-reach..=reach)
        .filter_map(|k| {
            let p = outline.at(tip + k as f64);
            Some(b(p, -depth)? - b(p, depth)?)
        })
        .collect();
    changes.sort_by(f64::total_cmp);
    let median = changes.get(changes.len() / 2)?;
    let whole = colors.skin - colors.lid;
    (whole > 0.0).then(|| median / whole)
}

/// Returns the largest change of the width along 3 mm, beyond a third of that along the 9 mm around it, in mm, and its place
/// along the axis in pixels.
///
/// Both sides change: twice the smaller change counts, and none if one side goes out and the other one in, as where a
/// finger bends. So a speck of dust at one side is no step.
fn width_step(axis: &Axis, finger: FingerName, mm_per_pixel: f64) -> (f64, f64) {
    /// Distance between stations in mm.
    const STATION_MM: f64 = 0.5;
    /// Stations from the middle to the ends of 3 and of 9 mm.
    const SPANS: [usize; 2] = [3, 9];
    /// Above this the finger's end is round, in mm from the tip.
    const TIP_MM: f64 = 7.0;
    /// The sides of a finger are straight from here on, in mm above the higher one of its valleys.
    const SHOULDER_MM: f64 = 2.0;
    // Below this the webs begin, and the ball of the thumb.
    let base = match finger {
        FingerName::Thumb => 0.30,
        FingerName::Index => 0.15,
        _ => 0.08,
    };
    let low = (base * axis.length).max(axis.shoulder + SHOULDER_MM / mm_per_pixel);
    let high = axis.length - TIP_MM / mm_per_pixel;
    let step = STATION_MM / mm_per_pixel;
    let count = ((high - low) / step).max(0.0) as usize;
    let stations: Vec<f64> = (0..count).map(|k| high - k as f64 * step).collect();
    // The two sides, outward from the axis.
    let sides: Vec<Option<[f64; 2]>> = axis
        .sections(&stations)
        .into_iter()
        .map(|section| {
            section.map(|[left, right]| [-left, right].map(|v| v * (right - left).signum()))
        })
        .collect();
    let change = |middle: usize, reach: usize| {
        let (below, above) = (sides[middle + reach]?, sides[middle - reach]?);
        Some([below[0] - above[0], below[1] - above[1]])
    };
    let ratio = SPANS[0] as f64 / SPANS[1] as f64;
    let step_at = |middle: usize| {
        let (near, around) = (change(middle, SPANS[0])?, change(middle, SPANS[1])?);
        let [left, right] = [0, 1].map(|side| near[side] - ratio * around[side]);
        Some(if left * right > 0.0 { 2.0 * left.abs().min(right.abs()) } else { 0.0 })
    };
    let middles = SPANS[1]..count.saturating_sub(SPANS[1]);
    let mut best = (0.0, high);
    for (middle, &along) in stations.iter().enumerate().filter(|(k, _)| middles.contains(k)) {
        let found = step_at(middle).unwrap_or(0.0) * mm_per_pixel;
        if found > best.0 {
            best = (found, along);
        }
    }
    best
}
