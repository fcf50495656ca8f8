//! The shading at the edges of a hand: what is flat there is no skin.
//!
//! *Problem.* A bandage of the color of skin on a thumb, and a patch that fills the web of two fingers, change widths
//! and valleys by as much as people differ.
//! *Idea.* Skin curves away from the glass, so that it darkens over the last millimeters before an edge (thesis, 7.4:
//! "Edge areas of hands were quite faint"). Brightness is measured in units of this hand's own shading: 0 as near its edges, 1 as within.
//! A cover is as bright at its edge as within.
//! *Limits.* The generator paints covers flat. One that curves as skin does has no such mark, and a scan without
//! shading has no evidence here: both leave the other signs.

use super::super::FingerName;
use super::super::landmarks::Landmarks;
use super::super::profile::Axis;
use super::Sheet;

/// How deep in the hand its edge is dark, in mm, and at least in pixels: beyond the blur of the edge.
const EDGE_DEPTH: [f64; 2] = [0.55, 2.0];

/// How deep the shading has ended, in mm, and at least in pixels.
const INNER_DEPTH: [f64; 2] = [2.2, 6.0];

/// The least shading that is evidence, in levels of 255: synthetic hands have 16 to 33, and noise 1.5 in one pixel.
const SHADING_MIN: f64 = 8.0;

/// Distance between stations along a finger in mm.
const STATION_MM: f64 = 0.5;

/// Stations over which a side is averaged, 5 mm: bandages are longer, and noise and dust shorter.
const WINDOW: usize = 10;

/// Depths below the bottom of a valley in mm at which skin is still dark: from the end of the blur on.
const VALLEY_DEPTHS_MM: [f64; 4] = [0.75, 1.0, 1.25, 1.5];

/// The brightness of two sides of a finger, near the edge and deep, where each is known.
type Sides = Option<[[f64; 2]; 2]>;

/// The shading of the sides of the fingers and of the valleys.
pub(super) struct Shading {
    /// The least rise of the brightness from the edges of each finger inward, over 5 mm of the side that rises more.
    pub(super) side_rise: [f64; 5],
    /// The least brightness at 0.75 to 1.5 mm below each valley.
    pub(super) valley_brightness: [f64; 4],
}

impl Shading {
    /// Measures the shading; without evidence, sides rise by 1 and valleys are dark.
    pub(super) fn new(landmarks: &Landmarks, axes: &[Axis; 5], sheet: &Sheet<'_>) -> Self {
        let fingers: [Vec<Sides>; 5] =
            std::array::from_fn(|k| sides(&axes[k], FingerName::ALL[k], sheet));
        let all = |depth: usize| {
            fingers.iter().flatten().flatten().flatten().map(move |side| side[depth])
        };
        let (Some(edge), Some(skin)) = (median(all(0)), median(all(1))) else {
            return Self { side_rise: [1.0; 5], valley_brightness: [0.0; 4] };
        };
        let whole = skin - edge;
        if whole < SHADING_MIN {
            return Self { side_rise: [1.0; 5], valley_brightness: [0.0; 4] };
        }
        Self {
            side_rise: std::array::from_fn(|k| least_rise(&fingers[k], whole)),
            valley_brightness: std::array::from_fn(|k| {
                let brightness = |level: f64| (level - edge) / whole;
                valley_level(landmarks, [&axes[k], &axes[k + 1]], k, sheet).map_or(0.0, brightness)
            }),
        }
    }
}

/// Returns the brightness of the pixel of a point: the mean of its three levels.
fn level(sheet: &Sheet<'_>, p: [f64; 2]) -> Option<f64> {
    let [x, y] = p.map(|c| c.floor() as i64);
    let rgb = sheet.image.get(usize::try_from(x).ok()?, usize::try_from(y).ok()?)?;
    Some(rgb.iter().map(|&level| f64::from(level)).sum::<f64>() / 3.0)
}

fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.collect();
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// Returns the brightness at both sides of a finger from below its round end to above its webs.
fn sides(axis: &Axis, finger: FingerName, sheet: &Sheet<'_>) -> Vec<Sides> {
    /// Above this the finger's end is round, in mm from the tip.
    const TIP_MM: f64 = 6.0;
    /// Where the sides begin, in mm above the higher valley, and as a share of the length.
    const SHOULDER_MM: f64 = 1.0;
    const BASE: f64 = 0.08;
    /// The same share of the thumb, whose lower end is that of its ball.
    const THUMB_BASE: f64 = 0.2;
    let pixels = |mm: f64| mm / sheet.mm_per_pixel;
    let low = match finger {
        FingerName::Thumb => THUMB_BASE * axis.length,
        _ => (BASE * axis.length).max(axis.shoulder + pixels(SHOULDER_MM)),
    };
    let high = axis.length - pixels(TIP_MM);
    let count = ((high - low) / pixels(STATION_MM)).max(0.0) as usize;
    let stations: Vec<f64> = (0..count).map(|k| high - k as f64 * pixels(STATION_MM)).collect();
    let [u, v] = axis.direction();
    let depths = [EDGE_DEPTH, INNER_DEPTH].map(|[mm, least]| pixels(mm).max(least));
    let side = |along: f64, from: f64, to: f64| {
        let middle = axis.point(along);
        let at = |depth: f64| {
            let across = from + depth * (to - from).signum();
            level(sheet, [middle[0] - across * v, middle[1] + across * u])
        };
        Some([at(depths[0])?, at(depths[1])?])
    };
    let sections = axis.sections(&stations);
    let pairs = stations.iter().zip(sections).map(|(&along, section)| {
        let [left, right] = section?;
        Some([side(along, left, right)?, side(along, right, left)?])
    });
    pairs.collect()
}

/// Returns the least mean rise over a window of stations, of the side that rises more; 1 for a finger that is too short.
fn least_rise(stations: &[Sides], whole: f64) -> f64 {
    let rise = |sides: &Sides| {
        // A cover that darkens inward is flat too, but no edge: the size counts.
        sides.map(|sides| sides.map(|[near, deep]| (deep - near).abs() / whole))
    };
    let mean = |window: &[Sides]| {
        let sum =
            window.iter().map(|sides| rise(sides).map(|[a, b]| a.max(b))).sum::<Option<f64>>();
        sum.map(|sum| sum / WINDOW as f64)
    };
    stations.windows(WINDOW).filter_map(mean).min_by(f64::total_cmp).unwrap_or(1.0)
}

/// Returns the least brightness below the bottom of a valley, each the mean across the bisector of the axes beside it.
fn valley_level(
    landmarks: &Landmarks,
    axes: [&Axis; 2],
    valley: usize,
    sheet: &Sheet<'_>,
) -> Option<f64> {
    /// Samples to each side of the bisector, and the distance between them in mm.
    const SAMPLES: i32 = 2;
    const SAMPLE_MM: f64 = 0.14;
    let [a, b] = axes.map(Axis::direction);
    let sum = [a[0] + b[0], a[1] + b[1]];
    let size = (sum[0] * sum[0] + sum[1] * sum[1]).sqrt();
    let down = sum.map(|c| -c / size.max(f64::MIN_POSITIVE) / sheet.mm_per_pixel);
    let bottom = landmarks.outline.at(landmarks.valleys[valley]);
    let at = |depth: f64, across: f64| {
        level(
            sheet,
            [
                bottom[0] + depth * down[0] + across * down[1],
                bottom[1] + depth * down[1] - across * down[0],
            ],
        )
    };
    let mean = |depth: f64| {
        let levels = (-SAMPLES..=SAMPLES).map(|k| at(depth, f64::from(k) * SAMPLE_MM));
        Some(levels.sum::<Option<f64>>()? / f64::from(2 * SAMPLES + 1))
    };
    VALLEY_DEPTHS_MM
        .into_iter()
        .map(mean)
        .try_fold(f64::INFINITY, |least, level| Some(least.min(level?)))
}
