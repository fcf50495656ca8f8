//! Detection error trade-offs: one error rate over the other, on normal-deviate axes.

use crate::{Axis, DrawOptions, Figure, Plot, Scale, Series, SeriesStyle, Tone};

/// Tones of the curves; more curves than tones come round again, dashed.
const TONES: [Tone; 6] =
    [Tone::Answer, Tone::Support, Tone::Bound, Tone::Second, Tone::Third, Tone::Point];

/// The error rates of one method.
#[derive(Clone, Debug, PartialEq)]
pub struct DetCurve {
    /// The entry in the legend.
    pub name: String,
    /// Rates of false acceptance and of false rejection, from 0 to 1, along the thresholds.
    pub points: Vec<[f64; 2]>,
}

/// The trade-offs of several methods in one picture.
///
/// Where one rate is 0 a curve has no place on the axes and is not drawn; the caption names the methods of which nothing is left.
pub fn det_figure(
    title: &str,
    caption: &str,
    curves: Vec<DetCurve>,
    options: &DrawOptions,
) -> Figure {
    let is_drawn = |point: &[f64; 2]| point.iter().all(|&rate| crate::deviate::has_place(rate));
    let mut perfect = vec![];
    let mut series = vec![];
    for (place, curve) in curves.into_iter().enumerate() {
        let points: Vec<[f64; 2]> = curve.points.into_iter().filter(is_drawn).collect();
        if points.is_empty() {
            perfect.push(curve.name.clone());
        }
        let style = if place < TONES.len() { SeriesStyle::Line } else { SeriesStyle::Dashed };
        series.push(Series { name: curve.name, tone: TONES[place % TONES.len()], style, points });
    }
    let mut caption = caption.to_owned();
    if !perfect.is_empty() {
        caption += &format!(" One rate is 0 at every threshold: {}.", perfect.join(", "));
    }
    let axes = [Axis::named("false acceptance rate"), Axis::named("false rejection rate")];
    Figure::Plot(Plot {
        series,
        x_scale: Scale::NormalDeviate,
        y_scale: Scale::NormalDeviate,
        // Both axes have one scale, so the picture is about as high as wide.
        height: options.height,
        ..Plot::empty(title.to_owned(), caption, axes, options)
    })
}
