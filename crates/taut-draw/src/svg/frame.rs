//! The parts of a picture around the marks: title, legend, axes, caption.

use super::canvas::{Anchor, Canvas, stroke};
use crate::axes::{Span, Ticks};
use crate::text::{fit, width, wrap};
use crate::{Axis, LineStyle, Theme, Tone};

/// The parts of a picture around the marks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Chrome {
    /// A document of its own: ground, colors, title and caption.
    Full(Theme),
    /// A part of a page, which has its own colors, titles and captions.
    Bare,
}

pub(super) struct Entry<'a> {
    pub(super) name: &'a str,
    pub(super) tone: Tone,
    pub(super) key: Key,
}

/// The sample beside a name.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Key {
    /// A disc of this radius.
    Disc(f64),
    Cross,
    Line(LineStyle),
    LineAndDot,
    Area,
    /// A side of an opaque surface.
    Side,
}

const MARGIN: f64 = 22.0;
const LINE: f64 = 18.0;
const KEY: f64 = 22.0;

/// The length of a mark without a label below an axis.
const BETWEEN_TICK: f64 = 4.0;

/// The place of the marks: left, top, right, bottom.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlotArea {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) right: f64,
    pub(super) bottom: f64,
}

/// Writes title, legend and caption, sets the size of the document, and returns the room between them.
pub(super) fn begin(
    canvas: &mut Canvas,
    chrome: Chrome,
    title: &str,
    caption: &str,
    size: [f64; 2],
    entries: &[Entry<'_>],
) -> PlotArea {
    let [w, mut h] = size.map(|s| if s.is_finite() { s.clamp(160.0, 20_000.0) } else { 600.0 });
    // A page has margins of its own.
    let margin = if chrome == Chrome::Bare { 4.0 } else { MARGIN };
    let room = w - 2.0 * margin;
    let mut top = if chrome == Chrome::Bare { 2.0 } else { 14.0 };
    let bottom = if chrome == Chrome::Bare { h - 2.0 } else { h - 12.0 };
    let mut lines = Vec::new();
    if let Chrome::Full(_) = chrome {
        // Semi-bold letters are about 5 % wider than those the table of widths knows.
        for line in wrap(title, room / 1.05, 17.0) {
            top += 22.0;
            lines.push((top, "t-title", line));
        }
        top += 6.0;
        if !caption.is_empty() {
            h += 4.0;
            for line in wrap(caption, room, 12.5) {
                lines.push((h + 4.0, "t-caption", line));
                h += LINE;
            }
            h += 6.0;
        }
    }
    canvas.size = [w, h];
    for (y, class, line) in lines {
        canvas.text([margin, y], class, Anchor::Start, &line);
    }
    let mut x = margin;
    let shown: Vec<_> = entries.iter().enumerate().filter(|(_, e)| !e.name.is_empty()).collect();
    if !shown.is_empty() {
        top += 12.0;
    }
    for (number, entry) in shown {
        let name = fit(entry.name, room - KEY - 8.0, 12.5);
        let needed = KEY + 8.0 + width(&name, 12.5);
        if x > margin && x + needed > w - margin {
            x = margin;
            top += LINE + 2.0;
        }
        canvas.open_entry(number, chrome);
        key(canvas, entry, [x + KEY / 2.0, top]);
        canvas.text([x + KEY + 7.0, top + 4.3], "t-legend", Anchor::Start, &name);
        canvas.close_entry(chrome);
        x += needed + 20.0;
    }
    PlotArea { left: margin, top: top + 18.0, right: w - margin.max(16.0), bottom }
}

/// The sample of an entry around a place.
pub(super) fn key(canvas: &mut Canvas, entry: &Entry<'_>, at: [f64; 2]) {
    let name = entry.tone.name();
    let [x, y] = at;
    match entry.key {
        Key::Disc(radius) => {
            canvas.open(&format!("f-{name}"), "");
            canvas.disc(at, radius.clamp(2.5, 6.0), "");
        }
        Key::Cross => {
            canvas.open(&format!("s-{name}"), "stroke-width=\"2\"");
            canvas.cross(at, 5.0);
        }
        Key::Line(line_style) => {
            let (classes, attributes) = stroke(entry.tone, line_style);
            canvas.open(&classes, attributes);
            canvas.line([x - KEY / 2.0, y], [x + KEY / 2.0, y]);
        }
        Key::LineAndDot => {
            canvas.open(&format!("f-{name} e-{name}"), "stroke-width=\"2\"");
            canvas.line([x - KEY / 2.0, y], [x + KEY / 2.0, y]);
            canvas.disc(at, 2.2, "");
        }
        Key::Side => {
            canvas.open(&format!("f-{name}"), "fill-opacity=\"0.75\"");
            canvas.rect([x - 7.0, y - 5.0], [x + 7.0, y + 5.0]);
        }
        Key::Area => {
            canvas
                .open(&format!("f-{name} e-{name}"), "stroke-width=\"1.6\" fill-opacity=\"0.15\"");
            canvas.disc(at, 6.0, "");
        }
    }
    canvas.close();
}

/// Height that tick labels and the name of a horizontal axis need below the room.
pub(super) fn height_below(axis: &Axis) -> f64 {
    if axis.name.is_empty() { 8.0 } else { 44.0 }
}

/// Width that tick labels and the name of a vertical axis need to the left of the room.
pub(super) fn width_left(axis: &Axis, ticks: &Ticks) -> f64 {
    if axis.name.is_empty() {
        return 0.0;
    }
    ticks.ticks.iter().map(|t| width(&t.label, 12.0)).fold(0.0, f64::max) + 32.0
}

/// The name of an axis with its unit and what its ticks are counted in; a long name is cut, the rest never.
fn axis_title(axis: &Axis, ticks: &Ticks, room: f64) -> String {
    let unit = if axis.unit.is_empty() { String::new() } else { format!(" ({})", axis.unit) };
    let rest = format!("{}{}{}", ticks.offset, ticks.scale, unit);
    fit(&axis.name, (room - width(&rest, 13.0)).max(40.0), 13.0) + &rest
}

/// Grid, ticks and names of both axes around `room`.
pub(super) fn axes(
    canvas: &mut Canvas,
    room: PlotArea,
    [x_axis, y_axis]: [&Axis; 2],
    [x, y]: [&Span; 2],
    [x_ticks, y_ticks]: [&Ticks; 2],
) {
    canvas.open("t-grid", "");
    if !x_axis.name.is_empty() {
        for tick in &x_ticks.ticks {
            let at = x.tick(tick);
            canvas.line([at, room.top], [at, room.bottom]);
        }
    }
    if !y_axis.name.is_empty() {
        for tick in &y_ticks.ticks {
            let at = y.tick(tick);
            canvas.line([room.left, at], [room.right, at]);
        }
    }
    canvas.close();
    canvas.open("t-axis", "");
    if !x_axis.name.is_empty() {
        canvas.line([room.left, room.bottom], [room.right, room.bottom]);
        for fraction in &x_ticks.between {
            let at = x.at_fraction(*fraction);
            canvas.line([at, room.bottom], [at, room.bottom + BETWEEN_TICK]);
        }
    }
    if !y_axis.name.is_empty() {
        canvas.line([room.left, room.top], [room.left, room.bottom]);
    }
    canvas.close();
    if !x_axis.name.is_empty() {
        for tick in &x_ticks.ticks {
            canvas.text([x.tick(tick), room.bottom + 17.0], "t-tick", Anchor::Middle, &tick.label);
        }
        let title = axis_title(x_axis, x_ticks, room.right - room.left);
        let at = [(room.left + room.right) / 2.0, room.bottom + 37.0];
        canvas.text(at, "t-name", Anchor::Middle, &title);
    }
    if !y_axis.name.is_empty() {
        for tick in &y_ticks.ticks {
            canvas.text([room.left - 7.0, y.tick(tick) + 4.2], "t-tick", Anchor::End, &tick.label);
        }
        let title = axis_title(y_axis, y_ticks, room.bottom - room.top);
        let labels = y_ticks.ticks.iter().map(|t| width(&t.label, 12.0)).fold(0.0, f64::max);
        let at = [room.left - labels - 20.0, (room.top + room.bottom) / 2.0];
        canvas.text_upwards(at, "t-name", &title);
    }
}
