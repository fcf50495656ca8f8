//! Hands: from the image of a hand to features in millimeters, and synthetic scans with ground truth.
//!
//! ```no_run
//! use taut_recognize::hand::{Hand, HandOptions};
//!
//! let hand = Hand::from_file("scan.png", &HandOptions::default())?;
//! println!("{:?} hand, middle finger {:.1} mm", hand.side, hand.features[2]);
//! # Ok::<(), taut_recognize::hand::HandError>(())
//! ```
//!
//! The way: image, threshold of b* ([`color`]), set of pixels ([`mask`]), largest component ([`components`]), outline
//! ([`outline`]), tips and valleys ([`landmarks`]), features ([`features`], [`profile`]), and whether they can be
//! relied on ([`failure`]).

pub mod circle;
pub mod color;
pub mod components;
mod default_matcher;
pub mod distance;
pub mod failure;
pub mod features;
pub mod gate;
pub mod landmarks;
pub mod mask;
pub mod outline;
pub mod profile;
pub mod read;
pub mod refine;
pub mod synthetic;
pub mod thesis;
mod trace;
mod write;

use std::io::Read;
use std::path::Path;

pub use failure::{Edge, Failure, FingerName, Pixel, Sign};
pub use features::{FEATURE_NAMES, FEATURES, IndexBase};
pub use gate::{Evidence, PROPORTION_NAMES, PROPORTIONS};
pub use profile::{PROFILE, profile_names};
pub use read::{ImageError, RgbImage};

use circle::Circle;
use color::{AdaptiveThreshold, ThresholdTable, adaptive_threshold};
use components::{LargestComponent, largest_component};
use landmarks::{Landmarks, find_landmarks};
use mask::Mask;

/// Bytes of an image file for each pixel that is allowed, beside a megabyte for what is no pixel: 16 bits in four channels.
const FILE_BYTES_PER_PIXEL: u64 = 8;

/// Millimeters in an inch.
const MM_PER_INCH: f64 = 25.4;

/// The radius of the opening in millimeters: two pixels at 90 dots per inch.
const OPENING_MM: f64 = 0.5;

/// The largest radius of the opening in pixels; beyond 400 dots per inch noise is smaller than half a millimeter.
const OPENING_PIXELS_MAX: usize = 8;

/// The least area of a hand in square millimeters: that of a small child without its arm has some 5000.
const HAND_AREA_MIN_MM2: f64 = 2500.0;

/// The least difference of the medians of b* of hand and background; noise alone has 2.
const CONTRAST_MIN: f64 = 5.0;

/// The least such difference in sums of the median deviations; one class cut in two has 2.
const SEPARATION_MIN: f64 = 2.2;

/// Which of the two hands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Side {
    /// The left hand.
    Left,
    /// The right hand.
    Right,
}

impl Side {
    /// Returns the other hand.
    #[must_use]
    pub fn other(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }
}

/// Which side of the hand faces the sensor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum View {
    /// The palm, as on a scanner.
    #[default]
    Palm,
    /// The back, as below a camera.
    Back,
}

/// How the threshold of b* is chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Threshold {
    /// By Otsu's method from each image.
    #[default]
    Adaptive,
    /// A fixed value, as the thesis has it; [`color::FIXED_THRESHOLD`] is ours for scanners.
    Fixed(f64),
}

/// How the outline of the hand is traced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Tracing {
    /// Where b* crosses the threshold between two pixels.
    #[default]
    SubPixel,
    /// Through the centers of the cleaned boundary pixels, as the thesis has it.
    Thesis,
}

/// What becomes of features that cannot be relied on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Gate {
    /// They are refused: the first concern is the failure.
    #[default]
    Refuse,
    /// They are returned with all concerns.
    Report,
}

/// How to measure a hand.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct HandOptions {
    /// How the threshold of b* is chosen. Default: from each image.
    pub threshold: Threshold,
    /// How the outline is traced. Default: where b* crosses the threshold.
    pub tracing: Tracing,
    /// Dots per inch, in place of the value of the file. Range 20 to 2400, default that of the file.
    pub dots_per_inch: Option<f64>,
    /// Where the index finger ends on the thumb's side. Default: at the valley, as in the thesis.
    pub index_base: IndexBase,
    /// Which side of the hand faces the sensor. Default: the palm.
    pub view: View,
    /// The hand that is expected; the other one is a failure. Default: either.
    pub side: Option<Side>,
    /// What becomes of features that cannot be relied on. Default: they are refused.
    pub gate: Gate,
    /// The tolerance of the radii of inscribed circles in millimeters. Range 1e-6 to 1, default 0.015.
    pub circle_tolerance: f64,
    /// The largest number of pixels of an image that is decoded. Default 100 million.
    pub pixels_max: u64,
}

impl Default for HandOptions {
    fn default() -> Self {
        Self {
            threshold: Threshold::default(),
            tracing: Tracing::default(),
            dots_per_inch: None,
            index_base: IndexBase::default(),
            view: View::default(),
            side: None,
            gate: Gate::default(),
            circle_tolerance: 0.015,
            pixels_max: 100_000_000,
        }
    }
}

/// A measured hand.
#[derive(Clone, Debug, PartialEq)]
pub struct Hand {
    /// Which hand it is.
    pub side: Side,
    /// The resolution, in dots per inch.
    pub dots_per_inch: f64,
    /// The threshold of b* that was used.
    pub threshold: f64,
    /// The thirty features of the thesis, in the order of [`FEATURE_NAMES`], in mm and mm².
    pub features: [f64; FEATURES],
    /// The width profile, in the order of [`profile_names`], in mm.
    pub profile: [f64; PROFILE],
    /// The outline with tips and valleys, in pixels.
    pub landmarks: Landmarks,
    /// The ten circles, in pixels: thumb, then lower and upper half of each finger, then the whole hand.
    pub circles: [Circle; 10],
    /// What the plausibility gate measured.
    pub evidence: Evidence,
    /// Why the features may be wrong; empty unless [`Gate::Report`] was asked for.
    pub concerns: Vec<Failure>,
}

/// Why there is no measured hand.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum HandError {
    /// The image cannot be read.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// The image does not show a hand that can be measured.
    #[error(transparent)]
    Hand(#[from] Failure),
    /// An option is outside its range.
    #[error("option `{name}` is {value}: expected {expected}")]
    Option {
        /// The option.
        name: &'static str,
        /// Its value.
        value: f64,
        /// Its range.
        expected: &'static str,
    },
}

impl Hand {
    /// Measures the hand in an image file in PNG, or with the feature `photographs` in JPEG or TIFF.
    ///
    /// # Errors
    /// [`HandError`]: the file or the options are not as they should be, or the hand cannot be measured.
    pub fn from_file(path: impl AsRef<Path>, options: &HandOptions) -> Result<Self, HandError> {
        let path = path.as_ref();
        let failed = |error: std::io::Error| ImageError::Io {
            path: path.to_owned(),
            error: error.to_string(),
        };
        let file = std::fs::File::open(path).map_err(failed)?;
        if !file.metadata().map_err(failed)?.is_file() {
            return Err(failed(std::io::Error::other("not a regular file")).into());
        }
        // No format takes much more for a pixel than its decoder may.
        let most = options.pixels_max.saturating_mul(FILE_BYTES_PER_PIXEL).saturating_add(1 << 20);
        let mut bytes = vec![];
        file.take(most + 1).read_to_end(&mut bytes).map_err(failed)?;
        if bytes.len() as u64 > most {
            return Err(failed(std::io::Error::other(format!("more than {most} bytes"))).into());
        }
        Self::from_image(&bytes, options)
    }

    /// Measures the hand in the bytes of an image file in PNG, or with the feature `photographs` in JPEG or TIFF.
    ///
    /// # Errors
    /// [`HandError`]: the image or the options are not as they should be, or the hand cannot be measured.
    pub fn from_image(bytes: &[u8], options: &HandOptions) -> Result<Self, HandError> {
        Self::from_rgb(&RgbImage::decode(bytes, options.pixels_max)?, options)
    }

    /// Measures the hand in a decoded image.
    ///
    /// # Errors
    /// [`HandError`]: the options are not as they should be, or the hand cannot be measured.
    pub fn from_rgb(image: &RgbImage, options: &HandOptions) -> Result<Self, HandError> {
        let (mm_per_pixel, dots_per_inch) = resolution(image, options)?;
        let found = segment(image, options, mm_per_pixel)?;
        let (outline, colors) = trace::outline(image, &found, options)?;
        let sheet = gate::Sheet { image, colors, mm_per_pixel, component: &found.component };
        let landmarks = find_landmarks(&outline, found.component.area as f64)
            .map_err(|failure| gate::explain(failure, &sheet))?;
        let landmarks = refine::refined(&landmarks, found.component.area as f64);
        let measured = features::measure(&landmarks, options, mm_per_pixel)
            .ok_or_else(|| gate::explain(Failure::Unmeasurable, &sheet))?;
        let axes = profile::axes(&landmarks);
        let profile = profile::profile(&landmarks, &axes, &measured, mm_per_pixel)
            .ok_or_else(|| gate::explain(Failure::Unmeasurable, &sheet))?;
        let side = match options.view {
            View::Palm => landmarks.side,
            View::Back => landmarks.side.other(),
        };
        let evidence = gate::Evidence::new(&landmarks, &axes, &measured, &sheet);
        let mut concerns = gate::concerns(&landmarks, &evidence, &measured, &sheet);
        if options.side.is_some_and(|wanted| wanted != side) {
            concerns.insert(0, Failure::OtherHand);
        }
        if options.gate == Gate::Refuse && !concerns.is_empty() {
            return Err(concerns.swap_remove(0).into());
        }
        Ok(Self {
            side,
            dots_per_inch,
            threshold: found.threshold,
            features: measured.features,
            profile,
            landmarks,
            circles: measured.circles,
            evidence,
            concerns,
        })
    }
}

/// Checks the options; returns millimeters per pixel and dots per inch.
fn resolution(image: &RgbImage, options: &HandOptions) -> Result<(f64, f64), HandError> {
    let refuse = |name, value, expected| Err(HandError::Option { name, value, expected });
    if !(1e-6..=1.0).contains(&options.circle_tolerance) {
        return refuse("circle_tolerance", options.circle_tolerance, "1e-6 to 1 mm");
    }
    if let Threshold::Fixed(value) = options.threshold
        && !(-100.0..=100.0).contains(&value)
    {
        return refuse("threshold", value, "a b* from −100 to 100");
    }
    match options.dots_per_inch {
        Some(value) if !(20.0..=2400.0).contains(&value) => {
            refuse("dots_per_inch", value, "20 to 2400")
        }
        Some(value) => Ok((MM_PER_INCH / value, value)),
        None => {
            let value = image.dots_per_inch().ok_or(match image.implausible_resolution() {
                Some([horizontal, vertical]) => ImageError::BadResolution { horizontal, vertical },
                None => ImageError::NoResolution,
            })?;
            Ok((MM_PER_INCH / value, value))
        }
    }
}

/// The pixels of the hand.
struct Segment {
    component: LargestComponent,
    threshold: f64,
}

/// Finds the pixels of the hand.
fn segment(image: &RgbImage, options: &HandOptions, mm_per_pixel: f64) -> Result<Segment, Failure> {
    let (width, height) = (image.width(), image.height());
    let own_table;
    let table = match options.threshold {
        Threshold::Fixed(value) if value == color::FIXED_THRESHOLD => ThresholdTable::shared(value),
        Threshold::Fixed(value) => {
            own_table = ThresholdTable::new(value);
            &own_table
        }
        Threshold::Adaptive => {
            let found = adaptive_threshold(image.pixels(), width, height)
                .ok_or(Failure::NoHand { area_mm2: 0.0 })?;
            check_contrast(&found, (width * height) as f64 * mm_per_pixel * mm_per_pixel)?;
            ThresholdTable::shared(found.threshold)
        }
    };
    let radius = ((OPENING_MM / mm_per_pixel).round() as usize).clamp(1, OPENING_PIXELS_MAX);
    let mask = Mask::from_rgb(image.pixels(), width, height, table).opened(radius);
    let component = largest_component(&mask).ok_or(Failure::NoHand { area_mm2: 0.0 })?;
    let area_mm2 = component.area as f64 * mm_per_pixel * mm_per_pixel;
    if area_mm2 < HAND_AREA_MIN_MM2 {
        return Err(Failure::NoHand { area_mm2 });
    }
    Ok(Segment { component, threshold: table.threshold() })
}

/// Refuses an image whose b* does not have two classes.
fn check_contrast(found: &AdaptiveThreshold, image_mm2: f64) -> Result<(), Failure> {
    let (contrast, separation) = (found.contrast, found.separation);
    let area_mm2 = found.share * image_mm2;
    if area_mm2 < HAND_AREA_MIN_MM2 {
        return Err(Failure::NoHand { area_mm2 });
    }
    if contrast < CONTRAST_MIN || separation < SEPARATION_MIN {
        return Err(Failure::LowContrast { contrast, separation });
    }
    Ok(())
}
