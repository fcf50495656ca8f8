//! The writer of SVG elements; the one place where numbers and words become markup.

use std::fmt::Write as _;

use super::trails::trails;
use super::{Chrome, Hover};
use crate::axes::AxisMap;
use crate::base64::base64;
use crate::number::px;
use crate::raster::Image;
use crate::text::escape;
use crate::{LineStyle, Tone};

/// At most this many lines are in one path: programs that show SVG slow down over very long ones.
const TRAILS_PER_PATH: usize = 50;

/// About this many dots are in one path.
const DOTS_PER_PATH: usize = 50;

/// Elements written so far.
pub(super) struct Canvas {
    body: String,
    /// Pixels of images to each unit of the picture.
    pub(super) density: f64,
    /// True if images are written into the body; else they are kept beside it, to be laid over what was written before the first.
    pub(super) embeds: bool,
    pub(super) images: Vec<PlacedImage>,
    /// Length of the body before the first image.
    cut: usize,
    /// Width and height of the document, pixels.
    pub(super) size: [f64; 2],
    /// Marks for the pointer.
    pub(super) hovers: Vec<Hover>,
    /// The number of these after each layer that an entry of the legend can hide.
    pub(super) ends: Vec<usize>,
    /// From numbers to pixels, where both axes have such a map.
    pub(super) map: Option<[AxisMap; 2]>,
    /// True if marks carry titles of their own; a page shows their words itself.
    pub(super) titled: bool,
}

/// An image and where it lies.
#[cfg_attr(not(feature = "png"), expect(dead_code, reason = "only PNG lays images itself"))]
pub(crate) struct PlacedImage {
    pub(crate) image: Image,
    /// Its upper left corner, and its width and height, in units of the picture.
    pub(crate) at: [f64; 2],
    pub(crate) size: [f64; 2],
}

/// Where a word stands relative to its place.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

impl Canvas {
    pub(super) fn new(density: f64, embeds: bool) -> Self {
        Canvas {
            body: String::new(),
            density,
            embeds,
            images: Vec::new(),
            cut: 0,
            size: [0.0; 2],
            hovers: Vec::new(),
            ends: Vec::new(),
            map: None,
            titled: false,
        }
    }

    /// Opens a group with classes and further attributes, which must be safe as they are.
    pub(super) fn open(&mut self, classes: &str, attributes: &str) {
        let space = if attributes.is_empty() { "" } else { " " };
        let _ = write!(self.body, "<g class=\"{classes}\"{space}{attributes}>");
    }

    pub(super) fn close(&mut self) {
        self.body.push_str("</g>\n");
    }

    /// Opens the marks of a layer, which its entry in the legend of a page hides.
    pub(super) fn open_layer(&mut self, number: usize, chrome: Chrome) {
        if chrome == Chrome::Bare {
            let _ = write!(self.body, "<g data-of=\"{number}\">");
        }
    }

    pub(super) fn close_layer(&mut self, chrome: Chrome) {
        if chrome == Chrome::Bare {
            self.body.push_str("</g>");
            self.ends.push(self.hovers.len());
        }
    }

    /// Opens the entry of a layer in the legend.
    pub(super) fn open_entry(&mut self, number: usize, chrome: Chrome) {
        if chrome == Chrome::Bare {
            let _ = write!(self.body, "<g data-entry=\"{number}\">");
        }
    }

    pub(super) fn close_entry(&mut self, chrome: Chrome) {
        if chrome == Chrome::Bare {
            self.body.push_str("</g>");
        }
    }

    pub(super) fn raw(&mut self, markup: &str) {
        self.body.push_str(markup);
    }

    pub(super) fn line(&mut self, from: [f64; 2], to: [f64; 2]) {
        let [x1, y1, x2, y2] = [from[0], from[1], to[0], to[1]].map(px);
        let _ = write!(self.body, "<line x1=\"{x1}\" y1=\"{y1}\" x2=\"{x2}\" y2=\"{y2}\"/>");
    }

    pub(super) fn disc(&mut self, at: [f64; 2], radius: f64, title: &str) {
        let [x, y, r] = [at[0], at[1], radius].map(px);
        let _ = write!(self.body, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{r}\"");
        self.end("circle", title);
    }

    pub(super) fn ellipse(&mut self, at: [f64; 2], radii: [f64; 2], title: &str) {
        if px(radii[0]) == px(radii[1]) {
            return self.disc(at, radii[0], title);
        }
        let [x, y, rx, ry] = [at[0], at[1], radii[0], radii[1]].map(px);
        let _ = write!(self.body, "<ellipse cx=\"{x}\" cy=\"{y}\" rx=\"{rx}\" ry=\"{ry}\"");
        self.end("ellipse", title);
    }

    fn end(&mut self, tag: &str, title: &str) {
        if title.is_empty() || !self.titled {
            self.body.push_str("/>");
        } else {
            let _ = write!(self.body, "><title>{}</title></{tag}>", escape(title));
        }
    }

    pub(super) fn rect(&mut self, from: [f64; 2], to: [f64; 2]) {
        let [x, y] = [from[0].min(to[0]), from[1].min(to[1])].map(px);
        let [w, h] = [(to[0] - from[0]).abs(), (to[1] - from[1]).abs()].map(px);
        let _ = write!(self.body, "<rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\"/>");
    }

    pub(super) fn cross(&mut self, at: [f64; 2], arm: f64) {
        let [x, y, a] = [at[0], at[1], arm].map(px);
        let _ =
            write!(self.body, "<path d=\"M{x} {y}m-{a} 0h{t}m-{a} -{a}v{t}\"/>", t = px(2.0 * arm));
    }

    /// A chain of segments; fewer than two places make none.
    pub(super) fn chain(&mut self, places: &[[f64; 2]], closed: bool) {
        self.chains([places], closed);
    }

    /// Chains in one path, which takes a third of the room that a path for each would take.
    pub(super) fn chains<'a>(
        &mut self,
        chains: impl IntoIterator<Item = &'a [[f64; 2]]>,
        closed: bool,
    ) {
        let before = self.body.len();
        self.body.push_str("<path d=\"");
        let begun = self.body.len();
        for places in chains.into_iter().filter(|places| places.len() >= 2) {
            for (i, place) in places.iter().enumerate() {
                let letter = if i == 0 { 'M' } else { 'L' };
                let _ = write!(self.body, "{letter}{} {}", px(place[0]), px(place[1]));
            }
            if closed {
                self.body.push('Z');
            }
        }
        match self.body.len() == begun {
            true => self.body.truncate(before),
            false => self.body.push_str("\"/>"),
        }
    }

    /// Segments as long lines, some of them in each path; lines begin at places, and go on by steps.
    pub(super) fn segments(&mut self, segments: &[[[f64; 2]; 2]]) {
        let hundredths = |at: [f64; 2]| at.map(|x| (x.clamp(-1e6, 1e6) * 100.0).round() as i64);
        let segments: Vec<_> = segments.iter().map(|ends| ends.map(hundredths)).collect();
        let shown = |x: i64| {
            let text = px(x as f64 / 100.0);
            match (text.strip_prefix("0."), text.strip_prefix("-0.")) {
                (Some(rest), _) => format!(".{rest}"),
                (_, Some(rest)) => format!("-.{rest}"),
                _ => text,
            }
        };
        for some in trails(&segments).chunks(TRAILS_PER_PATH) {
            self.body.push_str("<path d=\"");
            for trail in some {
                let _ = write!(self.body, "M{} {}l", shown(trail[0][0]), shown(trail[0][1]));
                for (i, pair) in trail.windows(2).enumerate() {
                    let [x, y] = [0, 1].map(|k| shown(pair[1][k] - pair[0][k]));
                    // A sign separates numbers, too.
                    let before = if i == 0 || x.starts_with('-') { "" } else { " " };
                    let between = if y.starts_with('-') { "" } else { " " };
                    let _ = write!(self.body, "{before}{x}{between}{y}");
                }
            }
            self.body.push_str("\"/>");
        }
    }

    /// Discs of one radius as dots of round lines, a third of the room. Those of one path are far apart, as they do not add up where they
    /// overlap.
    pub(super) fn dots(&mut self, name: &str, radius: f64, opacity: &str, places: &[[f64; 2]]) {
        let width = px(2.0 * radius);
        self.open(
            &format!("s-{name}"),
            &format!(
                "data-layer=\"points\" stroke-linecap=\"round\" stroke-width=\"{width}\" stroke-opacity=\"{opacity}\""
            ),
        );
        let paths = places.len().div_ceil(DOTS_PER_PATH);
        for first in 0..paths {
            self.body.push_str("<path d=\"");
            for [x, y] in places.iter().skip(first).step_by(paths) {
                let _ = write!(self.body, "M{} {}h0", px(*x), px(*y));
            }
            self.body.push_str("\"/>");
        }
        self.close();
    }

    /// A closed chain with a color of its own.
    pub(super) fn polygon(&mut self, places: &[[f64; 2]], [r, g, b]: [u8; 3]) {
        let _ = write!(self.body, "<path fill=\"#{r:02x}{g:02x}{b:02x}\" d=\"");
        for (i, place) in places.iter().enumerate() {
            let letter = if i == 0 { 'M' } else { 'L' };
            let _ = write!(self.body, "{letter}{} {}", px(place[0]), px(place[1]));
        }
        self.body.push_str("Z\"/>");
    }

    /// Writes a PNG file as an image of a size in units of the picture.
    pub(super) fn embed(&mut self, png: &[u8], at: [f64; 2], size: [f64; 2]) {
        let [x, y, w, h] = [at[0], at[1], size[0], size[1]].map(px);
        let _ = writeln!(
            self.body,
            "<image x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" preserveAspectRatio=\"none\" \
             href=\"data:image/png;base64,{}\"/>",
            base64(png)
        );
    }

    /// Keeps an image beside the body.
    pub(super) fn lay(&mut self, image: Image, at: [f64; 2], size: [f64; 2]) {
        if self.images.is_empty() {
            self.cut = self.body.len();
        }
        self.images.push(PlacedImage { image, at, size });
    }

    pub(super) fn text(&mut self, at: [f64; 2], class: &str, anchor: Anchor, text: &str) {
        let anchor = match anchor {
            Anchor::Start => "",
            Anchor::Middle => " text-anchor=\"middle\"",
            Anchor::End => " text-anchor=\"end\"",
        };
        let [x, y] = at.map(px);
        let text = escape(text);
        let _ =
            write!(self.body, "<text class=\"{class}\" x=\"{x}\" y=\"{y}\"{anchor}>{text}</text>");
    }

    /// A word that reads upwards, centered on its place.
    pub(super) fn text_upwards(&mut self, at: [f64; 2], class: &str, text: &str) {
        let [x, y] = at.map(px);
        let text = escape(text);
        let _ = write!(
            self.body,
            "<text class=\"{class}\" transform=\"translate({x} {y}) rotate(-90)\" text-anchor=\"middle\">{text}</text>"
        );
    }

    pub(super) fn document(&self, title: &str, caption: &str, chrome: Chrome) -> String {
        let mut out = self.head(title, caption, chrome);
        if let Chrome::Full(_) = chrome {
            let [w, h] = self.size.map(px);
            let _ = writeln!(out, "<rect class=\"t-ground\" width=\"{w}\" height=\"{h}\"/>");
        }
        out + &self.body + "</svg>\n"
    }

    /// A document of what lies under the images, and one, without ground, of what lies over them.
    #[cfg(feature = "png")]
    pub(super) fn documents(mut self, chrome: Chrome) -> [String; 2] {
        let over = self.head("", "", chrome) + &self.body[self.cut..] + "</svg>\n";
        self.body.truncate(self.cut);
        [self.document("", "", chrome), over]
    }

    fn head(&self, title: &str, caption: &str, chrome: Chrome) -> String {
        let [w, h] = self.size.map(px);
        let (title, caption) = (escape(title), escape(caption));
        let attributes = match chrome {
            Chrome::Full(theme) => format!(
                " width=\"{w}\" height=\"{h}\" role=\"img\" \
                 font-family=\"Inter, system-ui, 'Helvetica Neue', Arial, sans-serif\">\n\
                 <title>{title}</title>\n<desc>{caption}</desc>\n<style>{}</style>\n",
                theme.classes()
            ),
            // The caption stands below; a title element would follow the pointer everywhere.
            Chrome::Bare => format!(" role=\"img\" aria-label=\"{title}\">\n"),
        };
        format!("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {w} {h}\"{attributes}")
    }

    /// Returns what was written, without a document around it.
    pub(super) fn into_body(self) -> String {
        self.body
    }
}

/// The classes of lines and areas of a layer, and the attributes that go with its look.
pub(super) fn stroke(tone: Tone, line_style: LineStyle) -> (String, &'static str) {
    let name = tone.name();
    match line_style {
        LineStyle::Solid => (format!("s-{name}"), "stroke-width=\"2\" stroke-linejoin=\"round\""),
        LineStyle::Dashed => (format!("s-{name}"), "stroke-width=\"1.8\" stroke-dasharray=\"6 5\""),
        LineStyle::Filled => {
            (format!("f-{name} e-{name}"), "stroke-width=\"2\" fill-opacity=\"0.07\"")
        }
        LineStyle::Thin => (format!("s-{name}"), "stroke-width=\"0.8\" stroke-linejoin=\"round\""),
    }
}
