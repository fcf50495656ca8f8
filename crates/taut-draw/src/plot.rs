//! Line charts and histograms, with linear or logarithmic axes.

use crate::{Axis, DrawOptions, Tone};

/// A chart: series, bars and levels over two axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// The subject of the chart.
    pub title: String,
    /// A description in sentences, with every count named.
    pub caption: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Scale of the horizontal axis.
    pub x_scale: Scale,
    /// Scale of the vertical axis.
    pub y_scale: Scale,
    /// Curves and scatters.
    pub series: Vec<Series>,
    /// Bars, drawn below the series.
    pub bars: Vec<Bar>,
    /// Straight lines across the chart.
    pub levels: Vec<Level>,
    /// Width of the picture, pixels.
    pub width: f64,
    /// Height of the picture without caption, pixels.
    pub height: f64,
}

/// The height of a plot, as a part of that of a scene.
const PLOT_HEIGHT: f64 = 0.62;

impl Plot {
    /// Axes with nothing between them yet, both linear.
    pub(crate) fn empty(
        title: String,
        caption: String,
        [x, y]: [Axis; 2],
        options: &DrawOptions,
    ) -> Self {
        Plot {
            title,
            caption,
            x,
            y,
            x_scale: Scale::Linear,
            y_scale: Scale::Linear,
            series: Vec::new(),
            bars: Vec::new(),
            levels: Vec::new(),
            width: options.width,
            height: (options.height * PLOT_HEIGHT).max(180.0),
        }
    }
}

/// The way in which numbers become places on an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Scale {
    /// Equal differences are equally long.
    #[default]
    Linear,
    /// Equal ratios are equally long. Values of at most 0 are drawn at the lower edge, as open marks.
    Log,
    /// Rates from 0 to 1 stand where the standard normal distribution has them as its tail, with ticks in percent. Values of at most 0
    /// or at least 1 are drawn at the lower edge, as open marks.
    NormalDeviate,
}

/// A curve or a scatter.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// The entry in the legend; an empty name makes none.
    pub name: String,
    /// The role of the marks.
    pub tone: Tone,
    /// A curve, dots or both.
    pub style: SeriesStyle,
    /// (x, y) in data units.
    pub points: Vec<[f64; 2]>,
}

impl Series {
    pub(crate) fn dots(name: String, tone: Tone, points: Vec<[f64; 2]>) -> Self {
        Series { name, tone, style: SeriesStyle::Dots, points }
    }
}

/// The way in which a series is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum SeriesStyle {
    /// A curve with a dot at each value.
    #[default]
    LineAndDots,
    /// A curve.
    Line,
    /// A broken curve.
    Dashed,
    /// Dots.
    Dots,
}

/// A bar of a histogram, from 0 up.
#[derive(Clone, Debug, PartialEq)]
pub struct Bar {
    /// Left and right end, in data units.
    pub span: [f64; 2],
    /// Height, in data units.
    pub height: f64,
    /// The role of the marks.
    pub tone: Tone,
}

/// A straight line across the chart.
#[derive(Clone, Debug, PartialEq)]
pub enum Level {
    /// At one x, from bottom to top.
    AtX {
        /// Where.
        x: f64,
        /// The role of the marks.
        tone: Tone,
        /// The word beside it.
        label: String,
    },
    /// At one y, from left to right.
    AtY {
        /// Where.
        y: f64,
        /// The role of the marks.
        tone: Tone,
        /// The word above it.
        label: String,
    },
}
