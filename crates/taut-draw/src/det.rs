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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Style, to_svg};

    #[test]
    fn curves_are_drawn_where_both_rates_have_a_place() {
        let curve = |name: &str, points: &[[f64; 2]]| DetCurve {
            name: name.to_owned(),
            points: points.to_vec(),
        };
        let curves = vec![
            curve("boxes", &[[1.0, 0.0], [0.2, 0.01], [0.02, 0.1], [0.0, 1.0]]),
            curve("perfect", &[[1.0, 0.0], [0.0, 0.0], [0.0, 1.0]]),
        ];
        let figure = det_figure("Rates", "Two methods.", curves, &DrawOptions::default());
        assert_eq!(figure.caption(), "Two methods. One rate is 0 at every threshold: perfect.");
        let Figure::Plot(plot) = &figure else { panic!("a plot") };
        assert_eq!(plot.series.iter().map(|s| s.points.len()).collect::<Vec<_>>(), [2, 0]);
        let svg = to_svg(&figure, &Style::default());
        // One tick has the label of 10 %.
        assert!(svg.contains("false rejection rate") && svg.contains(">10<"), "{svg}");
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
    }
}
