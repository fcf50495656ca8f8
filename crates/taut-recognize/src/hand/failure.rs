//! Reasons why a picture gives no features that can be relied on.

use std::fmt;

/// The five fingers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum FingerName {
    /// The thumb.
    Thumb,
    /// The index finger.
    Index,
    /// The middle finger.
    Middle,
    /// The ring finger.
    Ring,
    /// The little finger.
    Little,
}

impl FingerName {
    /// The five fingers in the order of the features.
    pub const ALL: [Self; 5] = [Self::Thumb, Self::Index, Self::Middle, Self::Ring, Self::Little];
}

impl fmt::Display for FingerName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Thumb => "thumb",
            Self::Index => "index finger",
            Self::Middle => "middle finger",
            Self::Ring => "ring finger",
            Self::Little => "little finger",
        })
    }
}

/// The four edges of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Edge {
    /// Column 0.
    Left,
    /// The last column.
    Right,
    /// Row 0.
    Top,
    /// The last row.
    Bottom,
}

impl Edge {
    /// The four edges.
    pub const ALL: [Self; 4] = [Self::Left, Self::Right, Self::Top, Self::Bottom];
}

impl fmt::Display for Edge {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Left => "left",
            Self::Right => "right",
            Self::Top => "top",
            Self::Bottom => "bottom",
        })
    }
}

/// A place of the image, counted from its top left pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Pixel {
    /// The column, from 0 on.
    pub x: i64,
    /// The row, from 0 on.
    pub y: i64,
}

impl Pixel {
    /// Returns the pixel that holds a point.
    pub(super) fn of([x, y]: [f64; 2]) -> Self {
        Self { x: x.floor() as i64, y: y.floor() as i64 }
    }
}

impl fmt::Display for Pixel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "({}, {})", self.x, self.y)
    }
}

/// Why a picture gives no features, or none that can be relied on. Each text says what was found, where, and what helps.
#[derive(Clone, Debug, PartialEq, thiserror::Error, serde::Serialize, serde::Deserialize)]
#[non_exhaustive]
pub enum Failure {
    /// Nothing of the size of a hand has its color.
    #[error(
        "no hand: the largest object of the color of skin has {area_mm2:.0} mm², and a hand has at least {limit:.0}; lay one bare hand on the glass, or set the right resolution",
        limit = super::HAND_AREA_MIN_MM2
    )]
    NoHand {
        /// The area of the largest object.
        area_mm2: f64,
    },
    /// Hand and background differ too little in b*.
    #[error(
        "low contrast: the b* of hand and background differ by {contrast:.1}, {separation:.1} times their spread, and at least {least:.1} and {times:.1} times are needed; use a white or bluish background, or a fixed threshold",
        least = super::CONTRAST_MIN,
        times = super::SEPARATION_MIN
    )]
    LowContrast {
        /// The difference of the medians of b*.
        contrast: f64,
        /// The same over the sum of the median deviations.
        separation: f64,
    },
    /// The outline does not have five tips with four valleys between them.
    #[error("{found} of five fingertips found; spread all five fingers and lay them flat")]
    TooFewTips {
        /// Tips found.
        found: usize,
    },
    /// The outline has tips and valleys, but a finger between them has no width or no circle.
    #[error(
        "tips and valleys are found, but a finger between them has no width; spread the fingers and scan again"
    )]
    Unmeasurable,
    /// The boundary pixels are not one closed curve; only with the tracing of the thesis.
    #[error(
        "the boundary pixels are not one closed curve, as the tracing of the thesis needs; use the sub-pixel tracing"
    )]
    BrokenBoundary,
    /// Two fingers touch, or are too close for their valley to be found, or something joins them.
    #[error(
        "{first} and {second} touch, or nearly so, or are joined, at pixel {at}; spread them, and remove what joins them"
    )]
    FingersTouching {
        /// The finger nearer to the thumb.
        first: FingerName,
        /// The other one.
        second: FingerName,
        /// The bottom of the valley between them.
        at: Pixel,
    },
    /// A part of the hand that is measured is beyond the edge of the image.
    #[error(
        "the hand is cut off at the {edge} edge of the image, at pixel {at}; move the whole hand onto the page"
    )]
    CutOff {
        /// The edge.
        edge: Edge,
        /// A pixel of the hand at the edge.
        at: Pixel,
    },
    /// A ring, a bandage or the like covers a part of a finger, or a finger is lifted.
    #[error(
        "the {finger} is covered or lifted at pixel {at}: {sign}; remove rings and bandages, and lay the finger flat"
    )]
    RingOrBandage {
        /// The finger.
        finger: FingerName,
        /// What it shows by.
        sign: Sign,
        /// Where it shows.
        at: Pixel,
    },
    /// There is a hole in the hand: a cover, or fingers that touch at their tips.
    #[error(
        "the hand has a hole of {area_mm2:.1} mm² at pixel {at}; remove what covers it, and spread fingers that touch"
    )]
    Hole {
        /// The area of the largest hole.
        area_mm2: f64,
        /// Its middle.
        at: Pixel,
    },
    /// Something else of the color of a hand lies beside it.
    #[error(
        "a second object of the color of skin, {area_mm2:.0} mm², is at pixel {at}; leave one hand alone on the glass"
    )]
    SecondObject {
        /// Its area.
        area_mm2: f64,
        /// Its middle.
        at: Pixel,
    },
    /// The thumb could be at either end of the row of fingers.
    #[error(
        "the thumb cannot be told from the little finger: the distances at the ends of the row of fingers have the ratio {ratio:.2}; spread the thumb, and the little finger less"
    )]
    ThumbUnclear {
        /// The distances of the first two valleys and tips over those of the last two.
        ratio: f64,
    },
    /// The hand is the other one than was asked for.
    #[error("the image shows the other hand; scan the one that was asked for, or ask for either")]
    OtherHand,
    /// The proportions are not those of hands: a part is covered or joined to another one.
    #[error(
        "the proportions of the hand differ by {distance:.1} from those of hands, and the limit is {limit:.1}; spread the fingers, lay them flat, and remove what covers them"
    )]
    Proportions {
        /// The Mahalanobis distance from the mean of hands.
        distance: f64,
        /// The largest distance that is accepted.
        limit: f64,
    },
    /// A measure is outside the range of human hands: the outline is not that of a free hand, or the resolution wrong.
    #[error(
        "{measure} is {value:.2}, outside the range of human hands, {low:.2} to {high:.2}; set the right resolution, and spread the fingers"
    )]
    Implausible {
        /// The measure.
        measure: String,
        /// Its value.
        value: f64,
        /// The least plausible value.
        low: f64,
        /// The largest plausible value.
        high: f64,
    },
}

/// A sign that something covers a finger.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Sign {
    /// Another object lies beyond or beside the finger.
    SecondPiece,
    /// The tip is flat.
    FlatTip,
    /// The color of the tip fades into that of the background.
    FadingTip,
    /// The width has a step.
    WidthStep,
    /// The sides are as bright at their edges as within, as those of a flat cover.
    FlatSides,
    /// The tip is not where the axis of the finger leads.
    SkewTip,
}

impl fmt::Display for Sign {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::SecondPiece => "a piece of it is apart",
            Self::FlatTip => "its tip is flat",
            Self::FadingTip => "its tip fades out, as one that is not on the glass",
            Self::WidthStep => "its width has a step",
            Self::FlatSides => "its edges are not shaded as skin is",
            Self::SkewTip => "its tip is off its axis",
        })
    }
}
