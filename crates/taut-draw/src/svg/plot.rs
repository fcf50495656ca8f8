//! A chart as SVG.

use super::canvas::{Anchor, Canvas, stroke};
use super::frame::{self, Chrome, Entry, Key};
use super::plane::ticks_along;
use super::{DISCS_MAX, Hover};
use crate::axes::{AxisMap, Span, Ticks, linear, logarithmic, padded, unit};
use crate::deviate::{self, has_place, quantile};
use crate::number::digits;
use crate::text::width;
use crate::{Level, LineStyle, Plot, Scale, SeriesStyle};

pub(super) fn draw(plot: &Plot, chrome: Chrome, canvas: &mut Canvas) {
    let entries: Vec<_> = plot
        .series
        .iter()
        .map(|series| Entry {
            name: &series.name,
            tone: series.tone,
            key: match series.style {
                SeriesStyle::LineAndDots => Key::LineAndDot,
                SeriesStyle::Line => Key::Line(LineStyle::Solid),
                SeriesStyle::Dashed => Key::Line(LineStyle::Dashed),
                SeriesStyle::Dots => Key::Disc(4.0),
            },
        })
        .collect();
    let size = [plot.width, plot.height];
    let mut room = frame::begin(canvas, chrome, &plot.title, &plot.caption, size, &entries);
    room.bottom -= frame::height_below(&plot.x);
    // Words at vertical levels stand above the room.
    if plot.levels.iter().any(|level| matches!(level, Level::AtX { .. })) {
        room.top += 12.0;
    }
    let y_values = plot
        .series
        .iter()
        .flat_map(|s| s.points.iter().map(|p| p[1]))
        .chain(plot.bars.iter().flat_map(|b| [b.height, 0.0]))
        .chain(plot.levels.iter().filter_map(|l| match l {
            Level::AtY { y, .. } => Some(*y),
            Level::AtX { .. } => None,
        }));
    let x_values = plot
        .series
        .iter()
        .flat_map(|s| s.points.iter().map(|p| p[0]))
        .chain(plot.bars.iter().flat_map(|b| b.span))
        .chain(plot.levels.iter().filter_map(|l| match l {
            Level::AtX { x, .. } => Some(*x),
            Level::AtY { .. } => None,
        }));
    let mut y = AxisScale::new(plot.y_scale, y_values, [room.bottom, room.top]);
    // Bars stand on the axis.
    if !plot.bars.is_empty() && plot.y_scale == Scale::Linear {
        y.span.low = y.span.low.max(0.0);
    }
    let y_ticks = y.ticks(ticks_along(room.bottom - room.top, 50.0));
    room.left += frame::width_left(&plot.y, &y_ticks);
    let x = AxisScale::new(plot.x_scale, x_values, [room.left, room.right]);
    let mut x_ticks = x.ticks(ticks_along(room.right - room.left, 85.0));
    x_ticks.between = x.whole_places();
    canvas.map = x.map().zip(y.map()).map(|(x, y)| [x, y]);
    frame::axes(canvas, room, [&plot.x, &plot.y], [&x.span, &y.span], [&x_ticks, &y_ticks]);

    for bar in &plot.bars {
        let [Some(left), Some(right), Some(top)] =
            [x.at(bar.span[0]), x.at(bar.span[1]), y.at(bar.height)]
        else {
            continue;
        };
        if bar.height > 0.0 {
            canvas.open(
                &format!("f-{}", bar.tone.name()),
                "data-layer=\"bars\" fill-opacity=\"0.55\"",
            );
            // Half a pixel at each side keeps neighbors apart.
            let inset = ((right - left).abs() / 4.0).min(0.5);
            canvas.rect([left.min(right) + inset, top], [left.max(right) - inset, room.bottom]);
            canvas.close();
        }
    }
    let mut labels = Vec::new();
    for level in &plot.levels {
        let (tone, label, from, to, at, anchor) = match level {
            Level::AtX { x: value, tone, label } => {
                let Some(at) = x.at(*value) else { continue };
                let half = width(label, 12.0) / 2.0 + 2.0;
                let middle =
                    at.clamp(room.left + half.min(100.0), (room.right - half).max(room.left));
                (
                    tone,
                    label,
                    [at, room.top - 4.0],
                    [at, room.bottom],
                    [middle, room.top - 10.0],
                    Anchor::Middle,
                )
            }
            Level::AtY { y: value, tone, label } => {
                let Some(at) = y.at(*value) else { continue };
                let right = room.right;
                (tone, label, [room.left, at], [right, at], [right - 4.0, at - 6.0], Anchor::End)
            }
        };
        let (classes, attributes) = stroke(*tone, LineStyle::Dashed);
        canvas.open(&classes, &format!("data-layer=\"level\" {attributes}"));
        canvas.line(from, to);
        canvas.close();
        labels.push((tone, at, anchor, label));
    }
    for (number, series) in plot.series.iter().enumerate() {
        canvas.open_layer(number, chrome);
        let name = series.tone.name();
        let places: Vec<_> =
            series.points.iter().filter_map(|p| Some((p, [x.at(p[0])?, y.at(p[1])?]))).collect();
        let style =
            if series.style == SeriesStyle::Dashed { LineStyle::Dashed } else { LineStyle::Solid };
        if series.style != SeriesStyle::Dots {
            let (classes, attributes) = stroke(series.tone, style);
            canvas.open(&classes, &format!("data-layer=\"curve\" {attributes}"));
            canvas.chain(&places.iter().map(|(_, at)| *at).collect::<Vec<_>>(), false);
            canvas.close();
        }
        let dots = matches!(series.style, SeriesStyle::Dots | SeriesStyle::LineAndDots);
        if dots {
            let radius: f64 = match series.style {
                SeriesStyle::Dots => 4.0,
                _ if places.len() > 80 => 1.6,
                _ => 2.8,
            };
            let seen: Vec<_> =
                places.iter().filter(|(v, _)| !x.below(v[0]) && !y.below(v[1])).collect();
            canvas.hovers.extend(seen.iter().map(|(value, at)| hover(value, *at)));
            if chrome == Chrome::Bare && seen.len() > DISCS_MAX {
                let places: Vec<_> = seen.iter().map(|(_, at)| *at).collect();
                canvas.dots(name, radius.min(MANY_DOTS_RADIUS), "0.6", &places);
            } else {
                canvas.open(&format!("f-{name} t-halo"), "data-layer=\"dots\"");
                seen.iter().for_each(|(_, at)| canvas.disc(*at, radius, ""));
                canvas.close();
            }
        }
        // Values that a logarithm cannot show: open marks at the edge, with or without dots.
        canvas.open(&format!("e-{name} t-ground"), "data-layer=\"zeros\" stroke-width=\"1.8\"");
        for (value, at) in places.iter().filter(|(v, _)| x.below(v[0]) || y.below(v[1])) {
            canvas.disc(*at, 4.0, "");
            canvas.hovers.push(hover(value, *at));
        }
        canvas.close();
        canvas.close_layer(chrome);
    }
    // Above the marks.
    for (tone, at, anchor, label) in labels {
        canvas.open(&format!("f-{}", tone.name()), "");
        canvas.text(at, "t-level", anchor, label);
        canvas.close();
    }
}

/// Many dots of a page have this radius at most.
const MANY_DOTS_RADIUS: f64 = 2.0;

/// The page adds the name of the series.
fn hover(value: &[f64; 2], at: [f64; 2]) -> Hover {
    Hover { at, id: None, words: vec![digits(value[0], 6), digits(value[1], 6)] }
}

struct AxisScale {
    scale: Scale,
    span: Span,
    /// True if all values are whole numbers: then so are the ticks, as half a pass says nothing.
    whole: bool,
    /// The least and the largest value.
    values: (f64, f64),
}

impl AxisScale {
    fn new(scale: Scale, values: impl Iterator<Item = f64> + Clone, pixels: [f64; 2]) -> Self {
        let whole = values.clone().all(|v| v.fract() == 0.0);
        let all = range(values.clone());
        let (unit, [low, high]) = match scale {
            Scale::Linear => {
                let unit = unit(values.clone());
                let (low, high) = range(values.map(|v| v / unit));
                (unit, padded(low, high, 0.04))
            }
            Scale::Log => {
                let (mut low, mut high) =
                    range(values.clone().filter(|&v| v > 0.0).map(f64::log10));
                // At least a decade and a half, so that there are ticks to read.
                if high - low < 1.5 {
                    (low, high) = (low.floor(), high.ceil().max(low.floor() + 1.0));
                }
                if values.clone().any(|v| v <= 0.0) {
                    low -= (high - low) * 0.08;
                }
                (1.0, padded(low, high, 0.03))
            }
            Scale::NormalDeviate => {
                let (low, high) = range(values.filter(|&v| has_place(v)).map(quantile));
                (1.0, padded(low, high, 0.03))
            }
        };
        AxisScale { scale, span: Span { unit, low, high, pixels }, whole, values: all }
    }

    fn map(&self) -> Option<AxisMap> {
        match self.scale {
            Scale::Linear | Scale::Log => self.span.map(self.scale == Scale::Log),
            Scale::NormalDeviate => None,
        }
    }

    /// The pixel of a number; none for what is not finite.
    fn at(&self, value: f64) -> Option<f64> {
        if !value.is_finite() {
            return None;
        }
        Some(match self.scale {
            Scale::Linear => self.span.place(value),
            Scale::Log if value > 0.0 => self.span.place(value.log10()),
            Scale::NormalDeviate if has_place(value) => self.span.place(quantile(value)),
            Scale::Log | Scale::NormalDeviate => self.span.pixels[0],
        })
    }

    /// Returns true if the number cannot be shown and stands at the lower edge.
    fn below(&self, value: f64) -> bool {
        match self.scale {
            Scale::Linear => false,
            Scale::Log => value <= 0.0,
            Scale::NormalDeviate => !has_place(value),
        }
    }

    /// The place of each whole number, such as a pass, where all values are whole and there is room for their marks.
    fn whole_places(&self) -> Vec<f64> {
        let Span { unit, low, high, pixels } = self.span;
        let (first, last) = self.values;
        let room = (pixels[1] - pixels[0]).abs();
        if self.scale != Scale::Linear
            || !self.whole
            || (high - low) * unit * WHOLE_PLACES_APART > room
        {
            return Vec::new();
        }
        let place = |i: i64| (i as f64 / unit - low) / (high - low);
        (first as i64..=last as i64).map(place).collect()
    }

    fn ticks(&self, most: usize) -> Ticks {
        match self.scale {
            Scale::Linear if self.whole => {
                let width = (self.span.high - self.span.low) * self.span.unit;
                // Each of a few whole numbers has its tick, such as passes and centers.
                let steps = (width.ceil() as usize).max(1);
                linear(&self.span, if steps <= WHOLE_TICKS_MAX { steps } else { most.min(steps) })
            }
            Scale::Linear => linear(&self.span, most),
            Scale::Log => logarithmic(&self.span, most),
            Scale::NormalDeviate => deviate::ticks(&self.span, most),
        }
    }
}

/// Whole numbers along an axis that have a label each, at most.
const WHOLE_TICKS_MAX: usize = 12;

/// Pixels between the marks of whole numbers, at least.
const WHOLE_PLACES_APART: f64 = 4.0;

fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values
        .filter(|v| v.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    if low <= high { (low, high) } else { (0.0, 1.0) }
}
