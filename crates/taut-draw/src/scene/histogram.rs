//! Measures how far the items of an answer reach, which a projection of many dimensions cannot show.

use super::Input;
use crate::item_pass::BORDER_TOLERANCE;
use crate::number::{count, counted, digits};
use crate::{Axis, Bar, Figure, Level, Plot, Scale, Series, Tone};

/// About how many bars there are.
const BAR_COUNT: usize = 48;
/// The axis is logarithmic if the tallest bar reaches this count.
const LINEAR_HEIGHT_MAX: u64 = 200;

/// The text of the histogram of an answer.
pub(crate) struct Histogram {
    pub(crate) title: String,
    pub(crate) axis: &'static str,
    /// The name of the border, in the caption and beside its line; its number is in the caption of the scene.
    pub(crate) border: &'static str,
    /// Where the border is on the axis.
    pub(crate) reach: f64,
    /// The number of items that are not measured.
    pub(crate) left_out: usize,
    /// The support by name, and how far each item of it reaches.
    pub(crate) support: Option<(String, Vec<f64>)>,
}

/// A bar for each range of distances.
pub(crate) fn histogram(input: &Input<'_>, words: Histogram) -> Figure {
    let Histogram { title, axis, border, reach, left_out, support } = words;
    let bins = input.item_pass.bins(BAR_COUNT);
    let tallest = bins.iter().map(|bin| bin.2).max().unwrap_or(0);
    let y_scale = if tallest >= LINEAR_HEIGHT_MAX { Scale::Log } else { Scale::Linear };
    let bar = |(from, to, items): (f64, f64, u64)| Bar {
        span: [from * reach, to * reach],
        height: items as f64,
        tone: Tone::Point,
    };
    let lowest = if y_scale == Scale::Log { 1.0 } else { 0.0 };
    let dots = |(name, reaches): (String, Vec<f64>)| {
        Series::dots(name, Tone::Support, reaches.into_iter().map(|x| [x, lowest]).collect())
    };
    let thing = input.thing();
    let measured = input.source.len().saturating_sub(left_out as u64);
    let caption = format!(
        "{} of {} come within {} % of the {border}. Each bar counts the {thing}s of one range of distances{}{}.",
        count(input.item_pass.close),
        counted(measured, thing),
        digits(100.0 * BORDER_TOLERANCE, 2),
        match y_scale {
            Scale::Log => "; the count is logarithmic, so that few are seen beside many",
            Scale::Linear | Scale::NormalDeviate => "",
        },
        match left_out {
            0 => String::new(),
            _ => format!("; the {thing}s left out are not counted"),
        },
    );
    let y = Axis::named(format!("{thing}s"));
    Figure::Plot(Plot {
        y_scale,
        series: support.into_iter().map(dots).collect(),
        bars: bins.into_iter().map(bar).collect(),
        levels: vec![Level::AtX { x: reach, tone: Tone::Answer, label: border.into() }],
        ..Plot::empty(title, caption, [Axis::named(axis), y], input.options)
    })
}
