//! A report as one HTML file.
//!
//! *Idea.* Pictures of the plane and charts are inline SVG that takes its colors from variables of the page, so that
//! one picture serves bright and dark screens and paper. Scenes of space are numbers for a small viewer of our own.
//! *Guarantee.* The file asks for nothing from anywhere, and its content policy forbids that it could.
//! *Trap.* Words from outside stand in markup and in scripts: each has its own escape.

mod font;
mod space;

use std::fmt::Write as _;

use crate::axes::AxisMap;
use crate::number::{exact, px};
use crate::style::classes;
use crate::svg::{Chrome, Drawn, Hover, draw, draw_coarse, legend};
use crate::text::{escape, json};
use crate::{Figure, Layer3, Scene3, Shape3, Theme, View, Views};

/// A report: what [`to_html`] writes as one file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Page {
    /// The title of the page.
    pub title: String,
    /// Paragraphs below the title, divided by blank lines; plain text.
    pub intro: String,
    /// The sections, in order.
    pub sections: Vec<Section>,
    /// The last line of the page; plain text, may be empty.
    pub footer: String,
}

/// A part of a [`Page`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section {
    /// Its heading.
    pub heading: String,
    /// Paragraphs, divided by blank lines; plain text, may be empty.
    pub text: String,
    /// A command that makes this section again; may be empty.
    pub command: String,
    /// Numbers with their names.
    pub fields: Vec<Field>,
    /// Pictures.
    pub figures: Vec<Figure>,
}

/// A number with its name.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// The name.
    pub name: String,
    /// The value as it is printed.
    pub value: String,
}

impl Field {
    /// A field from anything that prints.
    pub fn new(name: impl Into<String>, value: impl ToString) -> Self {
        Field { name: name.into(), value: value.to_string() }
    }
}

/// Width at which the first figure of a section is drawn, and its height, pixels.
const LEAD_SIZE: [f64; 2] = [740.0, 560.0];
/// The same for figures that stand side by side.
const BESIDE_SIZE: [f64; 2] = [540.0, 330.0];

/// Scenes of space of more marks, but for opaque surfaces, have no picture for readers without scripts.
const STILL_MARKS_MAX: usize = 2000;

/// The page as one HTML file that needs nothing else: figures inline, scenes of space to be turned by hand.
///
/// Figures are drawn in sizes that suit the page; their own widths and heights do not matter here.
pub fn to_html(page: &Page) -> String {
    let title = escape(&page.title);
    let [light, dark] = [Theme::Light, Theme::Dark].map(Theme::variables);
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; \
         script-src 'unsafe-inline'; font-src data:; img-src data:\">\n\
         <title>{title}</title>\n<style>\n{}:root{{{light}}}\n\
         @media screen and (prefers-color-scheme: dark){{:root{{{dark}}}}}\n{}{}\n</style>\n</head>\n<body>\n\
         <header>\n<h1>{title}</h1>\n{}</header>\n<main>\n",
        font::faces(),
        include_str!("page.css"),
        classes(|name| format!("var(--{name})")),
        paragraphs(&page.intro),
    );
    for part in &page.sections {
        section(&mut out, part);
    }
    out.push_str("</main>\n");
    if !page.footer.is_empty() {
        let _ = writeln!(out, "<footer>{}</footer>", escape(&page.footer));
    }
    let _ = write!(
        out,
        "<div id=\"tip\" role=\"status\"></div>\n<script>\n{}</script>\n</body>\n</html>\n",
        concat!(include_str!("raster.js"), include_str!("viewer.js"))
    );
    out
}

/// Plain text as paragraphs, divided at blank lines.
fn paragraphs(text: &str) -> String {
    let mut out = String::new();
    let mut paragraph = String::new();
    for line in text.lines().chain([""]) {
        if !line.trim().is_empty() {
            paragraph += if paragraph.is_empty() { "" } else { " " };
            paragraph += line.trim();
        } else if !paragraph.is_empty() {
            let _ = writeln!(out, "<p>{}</p>", escape(&paragraph));
            paragraph.clear();
        }
    }
    out
}

fn section(out: &mut String, part: &Section) {
    out.push_str("<section>\n");
    if !part.heading.is_empty() {
        let _ = writeln!(out, "<h2>{}</h2>", escape(&part.heading));
    }
    out.push_str(&paragraphs(&part.text));
    let words = !part.fields.is_empty() || !part.command.is_empty();
    let (lead, rest) = match part.figures.split_first() {
        Some((lead @ (Figure::Plane(_) | Figure::Space(_) | Figure::Views(_)), rest)) => {
            (Some(lead), rest)
        }
        _ => (None, &part.figures[..]),
    };
    if words || lead.is_some() {
        let columns = if words && lead.is_some() { "top two" } else { "top" };
        let _ = writeln!(out, "<div class=\"{columns}\">");
        if words {
            out.push_str("<div>\n");
            fields(out, part);
            out.push_str("</div>\n");
        }
        if let Some(lead) = lead {
            figure(out, lead, LEAD_SIZE);
        }
        out.push_str("</div>\n");
    }
    if !rest.is_empty() {
        out.push_str("<div class=\"rest\">\n");
        let mut before = lead;
        for each in rest {
            match (each, before) {
                (Figure::Views(views), Some(Figure::Space(scene)))
                    if views.scene.layers == scene.layers =>
                {
                    fixed_views(out, views);
                }
                _ => figure(out, each, BESIDE_SIZE),
            }
            before = Some(each);
        }
        out.push_str("</div>\n");
    }
    out.push_str("</section>\n");
}

fn fields(out: &mut String, part: &Section) {
    if !part.fields.is_empty() {
        out.push_str("<table>\n");
        for field in &part.fields {
            let (name, value) = (escape(&field.name), escape(&field.value));
            let _ = writeln!(out, "<tr><th scope=\"row\">{name}</th><td>{value}</td></tr>");
        }
        out.push_str("</table>\n");
    }
    if !part.command.is_empty() {
        let _ = writeln!(out, "<pre><code>{}</code></pre>", escape(&part.command));
    }
}

fn figure(out: &mut String, figure: &Figure, [width, height]: [f64; 2]) {
    let mut sized = figure.clone();
    match &mut sized {
        Figure::Plane(scene) => {
            (scene.width, scene.height) =
                (width, (scene.height / scene.width * width).clamp(200.0, height));
        }
        Figure::Space(scene) => (scene.width, scene.height) = (width, height),
        // Panels side by side and one above the other are as high as they are wide.
        Figure::Views(Views { scene, .. }) => {
            (scene.width, scene.height) = (width, 0.9 * width);
        }
        Figure::Plot(plot) => (plot.width, plot.height) = (width, height.min(BESIDE_SIZE[1])),
    }
    let (title, caption) = (escape(figure.title()), escape(figure.caption()));
    let kind = if matches!(figure, Figure::Space(_)) { "space" } else { "flat" };
    let _ = writeln!(out, "<figure class=\"{kind}\">\n<h3>{title}</h3>");
    match &sized {
        Figure::Space(scene) => {
            let _ = writeln!(
                out,
                "{}<div class=\"sheet\"><canvas width=\"{w}\" height=\"{h}\" tabindex=\"0\" role=\"img\" \
                 aria-label=\"{title}. {caption}\"></canvas></div>\n<noscript>{}</noscript>\n\
                 <div class=\"hint\">Drag to turn, pinch or click and wheel to zoom; arrow keys, + and − do the \
                 same, 0 goes back.</div>\n<script type=\"application/json\" class=\"data\">{}</script>",
                legend(scene),
                still(&sized, scene),
                space::data(scene),
                w = px(scene.width),
                h = px(scene.height),
            );
        }
        Figure::Plane(scene) => flat(out, &sized, &[&scene.x.name, &scene.y.name]),
        Figure::Views(Views { scene, .. }) => {
            let names = [&scene.axes[0].name, &scene.axes[1].name, &scene.axes[2].name];
            flat(out, &sized, &names.map(String::as_str));
        }
        Figure::Plot(plot) => flat(out, &sized, &[&plot.x.name, &plot.y.name]),
    }
    let _ = writeln!(out, "<figcaption>{caption}</figcaption>\n</figure>");
}

/// Fixed views of the scene before them, which a script draws from the data that are there already.
fn fixed_views(out: &mut String, Views { scene, views }: &Views) {
    let (title, caption) = (escape(&scene.title), escape(&scene.caption));
    let size = [BESIDE_SIZE[0] / 2.0, 0.45 * BESIDE_SIZE[0]];
    let _ = writeln!(
        out,
        "<figure class=\"space views\">\n<h3>{title}</h3>\n{}<div class=\"sheet\">",
        legend(scene)
    );
    for View { name, .. } in views {
        let name = escape(name);
        let [w, h] = size.map(px);
        let _ = writeln!(
            out,
            "<div><p>{name}</p><canvas width=\"{w}\" height=\"{h}\" tabindex=\"0\" role=\"img\" aria-label=\"{title}: {name}\">\
             </canvas></div>",
        );
    }
    let _ = writeln!(
        out,
        "</div>\n<noscript>{NO_SCRIPT}</noscript>\n<script type=\"application/json\" class=\"data\">{}</script>\n\
         <figcaption>{caption}</figcaption>\n</figure>",
        space::views(scene, views, size)
    );
}

/// What readers without scripts see where a script draws.
const NO_SCRIPT: &str =
    "<p>A script of this page draws this scene, but scripts do not run here.</p>";

/// Returns a picture of space for readers without scripts. A scene with opaque surfaces gets a small one, without layers of many other
/// marks; a scene of many marks and no surface gets none.
fn still(figure: &Figure, scene: &Scene3) -> String {
    let marks = |layer: &Layer3| match &layer.shape {
        Shape3::Points(points) => points.len(),
        Shape3::Crosses(places) => places.len(),
        Shape3::Spheres(spheres) => spheres.len(),
        Shape3::Polylines(chains) => chains.iter().map(Vec::len).sum(),
        Shape3::Mesh(mesh) => mesh.triangles.len(),
        // Triangles of surfaces are not counted: up to some thousands they are polygons, and more are one image.
        Shape3::Surface(_) => 0,
    };
    let is_surface = |layer: &Layer3| match &layer.shape {
        Shape3::Surface(surface) => !surface.triangles.is_empty(),
        _ => false,
    };
    let all = scene.layers.iter().map(marks).fold(0, usize::saturating_add);
    if !scene.layers.iter().any(is_surface) {
        return match all <= STILL_MARKS_MAX {
            true => draw(figure, Chrome::Bare).document,
            false => NO_SCRIPT.into(),
        };
    }
    let mut room = STILL_MARKS_MAX;
    let mut has_room = |layer: &&Layer3| {
        let fits = marks(layer) <= room;
        room -= if fits { marks(layer) } else { 0 };
        fits
    };
    let layers: Vec<Layer3> =
        scene.layers.iter().filter(|layer| has_room(layer)).cloned().collect();
    let left_out = match layers.len() < scene.layers.len() {
        true => "<p>Layers of many marks are left out, as scripts do not run here.</p>",
        false => "",
    };
    let (width, height) = (scene.width / 2.0, scene.height / 2.0);
    let Scene3 { projection, azimuth, elevation, .. } = *scene;
    let [title, caption] = [&scene.title, &scene.caption].map(String::clone);
    let axes = scene.axes.clone();
    let small =
        Scene3 { title, caption, axes, layers, projection, azimuth, elevation, width, height };
    draw_coarse(&Figure::Space(small)).document + left_out
}

/// Words as the end of a list, numbers as such where a script writes them alike; an empty last one is left out.
fn words(words: &[String]) -> String {
    let shown = match words.split_last() {
        Some((last, before)) if last.is_empty() => before,
        _ => words,
    };
    let is_plain = |word: &str| {
        let digits = word.strip_prefix('-').unwrap_or(word);
        let is_number = digits.chars().all(|c| c.is_ascii_digit() || c == '.');
        is_number
            && word.parse().is_ok_and(|value: f64| {
                (value == 0.0 && word == "0" || (1e-4..1e15).contains(&value.abs()))
                    && exact(value) == word
            })
    };
    let word = |word: &String| match is_plain(word) {
        true => format!(",{word}"),
        false => format!(",{}", json(word)),
    };
    shown.iter().map(word).collect()
}

/// Returns true if the first words of a mark tell its place to a twentieth of a pixel.
fn is_told(hover: &Hover, map: &[AxisMap; 2]) -> bool {
    let at = |k: usize| {
        let value: f64 = hover.words.get(k)?.parse().ok()?;
        Some(map[k].place(value) - hover.at[k])
    };
    (0..2).all(|k| at(k).is_some_and(|off| off.abs() < 0.05))
}

fn flat(out: &mut String, figure: &Figure, names: &[&str]) {
    let Drawn { document, hovers, ends, map } = draw(figure, Chrome::Bare);
    let names: Vec<_> = names.iter().map(|name| json(name)).collect();
    let _ = write!(
        out,
        "<div class=\"sheet\">{}</div>\n<script type=\"application/json\" class=\"data\">{{\"names\":[{}],\"ends\":{:?},{}\"marks\":[",
        document,
        names.join(","),
        ends,
        map.map_or_else(String::new, |[x, y]| format!("\"map\":[{},{}],", x.json(), y.json())),
    );
    for (i, hover) in hovers.iter().enumerate() {
        let comma = if i == 0 { "" } else { "," };
        // Where no axis has a name nobody reads coordinates.
        let is_nameless = hover.words.len() > 2
            && hover.words[2..].iter().all(String::is_empty)
            && names.iter().all(|name| name == "\"\"");
        let said = if is_nameless { &[] } else { &hover.words[..] };
        let at = match !is_nameless && map.is_some_and(|map| is_told(hover, &map)) {
            true => String::new(),
            // Tenths are enough for a pointer.
            false => {
                let [x, y] = hover.at.map(|x| px((x * 10.0).round() / 10.0));
                format!("[{x},{y}],")
            }
        };
        let id = hover.id.map_or_else(|| "null".to_owned(), |id| id.to_string());
        let _ = write!(out, "{comma}[{at}{id}{}]", words(said));
    }
    out.push_str("]}</script>\n");
}
