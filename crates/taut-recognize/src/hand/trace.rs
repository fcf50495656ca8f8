//! The outline of the segmented hand: through its boundary pixels, or where b* crosses the middle of the edge.
//!
//! *Problem.* Skin is paler at the edge of a hand than within (thesis, 7.4). The threshold between skin and lid is above
//! the middle between the edge's color and the lid's, and the outline there is too small by some 0.4 pixels.
//! *Idea.* The threshold finds the hand; its outline is where b* crosses the mean of two medians: a few pixels inside the
//! boundary and as many outside.

use super::color::{Histogram, approximate_lab_b};
use super::outline::{Crack, Outline, follow_cracks};
use super::thesis::thesis_boundary;
use super::{Failure, HandOptions, RgbImage, Segment, Threshold, Tracing};

/// The Gaussian that smooths the outline in square roots of the hand's area: 2 pixels at 90 dots per inch.
const SMOOTHING: f64 = 0.0042;

/// The least Gaussian in pixels: less leaves the steps of the pixels.
const SMOOTHING_PIXELS_MIN: f64 = 1.0;

/// How far from the two pixels of a crack the colors beside the edge are taken, in pixels: beyond its blur, but not so
/// deep in the hand that the skin has its full color again. The threshold is already a part of a pixel inside.
const INSIDE_PIXELS: i64 = 1;
const OUTSIDE_PIXELS: i64 = 2;

/// The b* beside the edge of a hand: medians over its boundary.
#[derive(Clone, Copy)]
pub(super) struct EdgeColors {
    /// In the hand.
    pub(super) skin: f64,
    /// On the lid.
    pub(super) lid: f64,
}

/// Traces the outline of the hand; the colors are `None` if no part of it has hand and background beside it.
pub(super) fn outline(
    image: &RgbImage,
    found: &Segment,
    options: &HandOptions,
) -> Result<(Outline, Option<EdgeColors>), Failure> {
    let sigma = (SMOOTHING * (found.component.area as f64).sqrt()).max(SMOOTHING_PIXELS_MIN);
    // Cracks are more than the arc length by the factor 4/π in the mean over all directions, and boundary pixels are
    // about as many as cracks along a diagonal.
    let sigma = sigma * 4.0 / std::f64::consts::PI;
    let cracks = follow_cracks(&found.component.mask);
    let colors = edge_colors(image, &cracks, found.threshold);
    match options.tracing {
        Tracing::SubPixel => {
            let level = match options.threshold {
                Threshold::Fixed(value) => value,
                Threshold::Adaptive => {
                    colors.map_or(found.threshold, |colors| 0.5 * (colors.skin + colors.lid))
                }
            };
            let outline = Outline::new(&cracks, sigma, |pixel| Some(b_at(image, pixel)? - level));
            Ok((outline.ok_or(Failure::NoHand { area_mm2: 0.0 })?, colors))
        }
        Tracing::Thesis => {
            let mut boundary =
                thesis_boundary(&found.component.mask).ok_or(Failure::BrokenBoundary)?;
            // Landmarks expect the direction of the cracks, which is clockwise on the screen.
            boundary.reverse();
            let centers: Vec<[f64; 2]> =
                boundary.iter().map(|pixel| pixel.map(|c| c as f64 + 0.5)).collect();
            Ok((Outline::smoothed(&centers, sigma), colors))
        }
    }
}

/// Returns the b* of a pixel; `None` beyond the image.
pub(super) fn b_at(image: &RgbImage, [x, y]: [i64; 2]) -> Option<f64> {
    image.get(usize::try_from(x).ok()?, usize::try_from(y).ok()?).map(approximate_lab_b)
}

/// Returns the b* on both sides of the edge; `None` if no crack has hand and background beside it.
fn edge_colors(image: &RgbImage, cracks: &[Crack], threshold: f64) -> Option<EdgeColors> {
    let (mut inside, mut outside) = (Histogram::default(), Histogram::default());
    for crack in cracks {
        let away = |from: [i64; 2], to: [i64; 2], pixels: i64| {
            [0, 1].map(|c| to[c] + pixels * (to[c] - from[c]))
        };
        let skin = b_at(image, away(crack.outside, crack.inside, INSIDE_PIXELS));
        let lid = b_at(image, away(crack.inside, crack.outside, OUTSIDE_PIXELS));
        if let (Some(skin), Some(lid)) = (skin, lid)
            && skin > threshold
            && lid <= threshold
        {
            inside.add(skin);
            outside.add(lid);
        }
    }
    Some(EdgeColors { skin: inside.median()?, lid: outside.median()? })
}
