//! A scene of the plane as SVG.

use super::canvas::{Anchor, Canvas, stroke};
use super::frame::{self, Chrome, Entry, Key, PlotArea};
use super::{DISCS_MAX, Hover};
use crate::axes::{Span, linear, padded, unit};
use crate::number::digits;
use crate::{Aspect, Axis, Layer2, LineStyle, Scene2, Shape2};

pub(super) fn draw(scene: &Scene2, chrome: Chrome, canvas: &mut Canvas) {
    let entries: Vec<_> = scene.layers.iter().map(entry).collect();
    let size = [scene.width, scene.height];
    let mut room = frame::begin(canvas, chrome, &scene.title, &scene.caption, size, &entries);
    room.bottom -= frame::height_below(&scene.x);
    let extent = Extent::of(scene);
    // On equal scales equal distances of ticks give equal steps on both axes.
    let apart = if scene.aspect == Aspect::Equal { [72.0, 72.0] } else { [85.0, 55.0] };
    // The labels of the vertical axis decide how much room is left, which decides the labels: twice is enough.
    let left = room.left;
    let mut spans = extent.spans(scene.aspect, room);
    let mut y_ticks = linear(&spans[1], ticks_along(room.bottom - room.top, apart[1]));
    for _ in 0..2 {
        room.left = left + frame::width_left(&scene.y, &y_ticks);
        spans = extent.spans(scene.aspect, room);
        y_ticks = linear(&spans[1], ticks_along(room.bottom - room.top, apart[1]));
    }
    let [x, y] = spans;
    let x_ticks = linear(&x, ticks_along(room.right - room.left, apart[0]));
    frame::axes(canvas, room, [&scene.x, &scene.y], [&x, &y], [&x_ticks, &y_ticks]);
    canvas.map = x.map(false).zip(y.map(false)).map(|(x, y)| [x, y]);
    for (number, layer) in scene.layers.iter().enumerate() {
        canvas.open_layer(number, chrome);
        marks(canvas, layer, &x, &y, [&scene.x, &scene.y], chrome);
        canvas.close_layer(chrome);
    }
}

/// At most this many thin chains are in one path: programs that show SVG slow down over very long ones.
const CHAINS_PER_PATH: usize = 500;

/// As many ticks as fit, `apart` pixels each.
pub(super) fn ticks_along(pixels: f64, apart: f64) -> usize {
    ((pixels / apart) as usize).clamp(2, 10)
}

fn entry(layer: &Layer2) -> Entry<'_> {
    let key = match &layer.shape {
        Shape2::Points(points) => Key::Disc(points.iter().map(|p| p.size).fold(0.0, f64::max)),
        Shape2::Crosses(_) => Key::Cross,
        Shape2::Texts(_) => Key::Disc(0.0),
        _ if layer.line_style == LineStyle::Filled => Key::Area,
        _ => Key::Line(layer.line_style),
    };
    Entry { name: &layer.name, tone: layer.tone, key }
}

/// The range that the marks cover, in multiples of a unit.
struct Extent {
    unit: f64,
    low: [f64; 2],
    high: [f64; 2],
}

impl Extent {
    fn of(scene: &Scene2) -> Self {
        let mut numbers = Vec::new();
        let mut boxes: Vec<([f64; 2], f64)> = Vec::new();
        for layer in &scene.layers {
            match &layer.shape {
                Shape2::Points(points) => boxes.extend(points.iter().map(|p| (p.at, 0.0))),
                Shape2::Crosses(places) => boxes.extend(places.iter().map(|&p| (p, 0.0))),
                Shape2::Circles(circles) => {
                    boxes.extend(circles.iter().map(|c| (c.center, c.radius)))
                }
                Shape2::Polylines(chains) | Shape2::Polygons(chains) => {
                    boxes.extend(chains.iter().flatten().map(|&p| (p, 0.0)));
                }
                Shape2::Texts(texts) => boxes.extend(texts.iter().map(|t| (t.at, 0.0))),
            }
        }
        boxes
            .retain(|(at, r)| at[0].is_finite() && at[1].is_finite() && r.is_finite() && *r >= 0.0);
        numbers.extend(boxes.iter().flat_map(|(at, r)| [at[0], at[1], *r]));
        let unit = unit(numbers.into_iter());
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for (at, r) in &boxes {
            for k in 0..2 {
                low[k] = low[k].min(at[k] / unit - r / unit);
                high[k] = high[k].max(at[k] / unit + r / unit);
            }
        }
        if boxes.is_empty() {
            (low, high) = ([-1.0; 2], [1.0; 2]);
        }
        Extent { unit, low, high }
    }

    /// The intervals of both axes in a room, with space around the marks.
    fn spans(&self, aspect: Aspect, room: PlotArea) -> [Span; 2] {
        let [mut x, mut y] = [0, 1].map(|k| (self.low[k], self.high[k]));
        let pixels = [(room.right - room.left).max(1.0), (room.bottom - room.top).max(1.0)];
        match aspect {
            Aspect::Free => {
                x = padded(x.0, x.1, 0.05).into();
                y = padded(y.0, y.1, 0.05).into();
            }
            Aspect::Equal => {
                let widths = [x.1 - x.0, y.1 - y.0];
                let per_pixel = if widths[0] > 0.0 || widths[1] > 0.0 {
                    1.1 * (widths[0] / pixels[0]).max(widths[1] / pixels[1])
                } else {
                    let [low, high] = padded(x.0, x.0, 0.0);
                    let [below, above] = padded(y.0, y.0, 0.0);
                    (high - low).min(above - below) / pixels[0].min(pixels[1])
                };
                let around = |(low, high): (f64, f64), pixels: f64| {
                    let (middle, half) = (low + (high - low) / 2.0, per_pixel * pixels / 2.0);
                    (middle - half, middle + half)
                };
                (x, y) = (around(x, pixels[0]), around(y, pixels[1]));
            }
        }
        [
            Span { unit: self.unit, low: x.0, high: x.1, pixels: [room.left, room.right] },
            Span { unit: self.unit, low: y.0, high: y.1, pixels: [room.bottom, room.top] },
        ]
    }
}

fn marks(
    canvas: &mut Canvas,
    layer: &Layer2,
    x: &Span,
    y: &Span,
    axes: [&Axis; 2],
    chrome: Chrome,
) {
    let name = layer.tone.name();
    let place = |p: &[f64; 2]| [x.place(p[0]), y.place(p[1])];
    let finite = |p: &[f64; 2]| p[0].is_finite() && p[1].is_finite();
    let title = |id: Option<u64>, at: [f64; 2], label: &str| {
        let who = id.map(|id| format!("point {id}"));
        // Places on an axis that is hidden mean nothing.
        let shown = axes.iter().zip(at).filter(|(axis, _)| !axis.name.is_empty());
        let places: Vec<String> =
            shown.map(|(axis, v)| format!("{} = {}", axis.name, digits(v, 6))).collect();
        let places = (!places.is_empty()).then(|| places.join(", "));
        let what = (!label.is_empty()).then(|| label.to_owned());
        let said: Vec<String> = places.into_iter().chain(what).collect();
        who.into_iter()
            .chain((!said.is_empty()).then(|| said.join("; ")))
            .collect::<Vec<_>>()
            .join(": ")
    };
    match &layer.shape {
        Shape2::Points(points) => {
            let classes =
                if points.len() <= 200 { format!("f-{name} t-halo") } else { format!("f-{name}") };
            let opacity = match points.len() {
                0..=200 => "0.95",
                201..=2000 => "0.6",
                _ => "0.4",
            };
            let size = points.first().map_or(0.0, |point| point.size);
            let dots = chrome == Chrome::Bare
                && points.len() > DISCS_MAX
                && points.iter().all(|point| point.size == size);
            if !dots {
                canvas.open(&classes, &format!("data-layer=\"points\" fill-opacity=\"{opacity}\""));
            }
            let mut places = Vec::new();
            for point in points.iter().filter(|p| finite(&p.at)) {
                let at = place(&point.at);
                places.push(at);
                // A title for each of many points would double the document; labeled ones are few.
                let words = if point.label.is_empty() {
                    String::new()
                } else {
                    title(point.id, point.at, &point.label)
                };
                if !dots {
                    canvas.disc(at, point.size, &words);
                }
                let words =
                    vec![digits(point.at[0], 6), digits(point.at[1], 6), point.label.clone()];
                canvas.hovers.push(Hover { at, id: point.id, words });
            }
            if dots {
                canvas.dots(name, size, opacity, &places);
                return;
            }
        }
        Shape2::Crosses(places) => {
            canvas.open(&format!("s-{name}"), "data-layer=\"crosses\" stroke-width=\"2\"");
            for at in places.iter().filter(|p| finite(p)) {
                canvas.cross(place(at), 6.0);
            }
        }
        Shape2::Circles(circles) => {
            let (classes, attributes) = stroke(layer.tone, layer.line_style);
            let thin =
                if circles.len() > 3 { " style=\"stroke-width:1;stroke-opacity:.7\"" } else { "" };
            canvas.open(&classes, &format!("data-layer=\"circles\" {attributes}{thin}"));
            for circle in circles.iter().filter(|c| finite(&c.center) && c.radius.is_finite()) {
                let at = place(&circle.center);
                canvas.ellipse(at, [x.length(circle.radius), y.length(circle.radius)], "");
                if circle.id.is_some() {
                    let [a, b] = circle.center.map(|v| digits(v, 6));
                    let words = vec![a, b, format!("radius {}", digits(circle.radius, 6))];
                    canvas.hovers.push(Hover { at, id: circle.id, words });
                }
            }
        }
        Shape2::Polylines(chains) | Shape2::Polygons(chains) => {
            let (classes, attributes) = stroke(layer.tone, layer.line_style);
            canvas.open(&classes, &format!("data-layer=\"chains\" {attributes}"));
            let closed = matches!(layer.shape, Shape2::Polygons(_));
            let placed = |chain: &Vec<[f64; 2]>| -> Vec<[f64; 2]> {
                chain.iter().filter(|p| finite(p)).map(place).collect()
            };
            let chains: Vec<_> = chains.iter().map(placed).collect();
            let thin = layer.line_style == LineStyle::Thin;
            let segments: Vec<[[f64; 2]; 2]> =
                chains.iter().filter_map(|chain| chain.as_slice().try_into().ok()).collect();
            if thin && !closed && segments.len() == chains.len() {
                canvas.segments(&segments);
            } else {
                // Areas stay apart: laid over each other in one path they would leave holes.
                for some in chains.chunks(if thin { CHAINS_PER_PATH } else { 1 }) {
                    canvas.chains(some.iter().map(Vec::as_slice), closed);
                }
            }
        }
        Shape2::Texts(texts) => {
            canvas.open(&format!("f-{name}"), "data-layer=\"texts\"");
            for text in texts.iter().filter(|t| finite(&t.at)) {
                canvas.text(place(&text.at), "t-level", Anchor::Middle, &text.text);
            }
        }
    }
    canvas.close();
}
