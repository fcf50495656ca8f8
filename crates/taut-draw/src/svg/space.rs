//! A scene of space as SVG: one view of it.
//!
//! *Idea.* The scene is moved and scaled to the unit ball around the origin, turned so that the eye looks down the
//! third axis, and painted from back to front; what is far is smaller and paler. The viewer of the HTML page does the
//! same from the same numbers.

use taut_points::OrderBy;
use taut_points::parallel::ParallelSlice;

use super::Hover;
use super::camera::{Camera, V3, add, cross, dot};
use super::canvas::{Anchor, Canvas, stroke};
use super::frame::{self, Chrome, Entry, Key, PlotArea};
use super::opaque::{Coverage, solids};
use super::stage::{Stage, balls, finite, stage};
use crate::number::{digits, px};
use crate::text::{escape, fit};
use crate::{Layer3, LineStyle, Scene3, Shape3, Tone, View, Views};

/// A scene of which more spheres than this are drawn has outlines only.
pub(crate) const WIRED_SPHERES_MAX: usize = 4;

/// Circles of latitude and longitude on the unit sphere, every 30 degrees.
fn wires() -> Vec<Vec<V3>> {
    let step = |i: i32| (f64::from(i) * 5.0).to_radians().sin_cos();
    let latitudes = (-2..=2).map(|k| {
        let (sin, cos) = (f64::from(k) * 30.0).to_radians().sin_cos();
        (0..=72).map(|i| [cos * step(i).1, cos * step(i).0, sin]).collect()
    });
    let longitudes = (0..6).map(|k| {
        let (sin, cos) = (f64::from(k) * 30.0).to_radians().sin_cos();
        (0..=72).map(|i| [step(i).1 * cos, step(i).1 * sin, step(i).0]).collect()
    });
    latitudes.chain(longitudes).collect()
}

/// Up to this many discs on a surface have a rim.
const RIMS_MAX: usize = 50;

/// The group of what a surface hides.
const HIDDEN_GROUP: u8 = 5;

/// Something to paint, and where it is.
struct PaintItem {
    depth: f64,
    tone: Tone,
    hidden: bool,
    piece: Piece,
}

/// A scene as an eye sees it.
struct ViewedScene<'a> {
    scene: &'a Scene3,
    stage: &'a Stage,
    camera: &'a Camera,
    cover: Option<&'a Coverage>,
}

/// Something to paint.
enum Piece {
    Disc { at: [f64; 2], radius: f64, title: String },
    Line { chain: Vec<[f64; 2]>, line_style: LineStyle },
    Cross([f64; 2]),
    Face { corners: Vec<[f64; 2]>, light: f64 },
}

pub(super) fn draw(scene: &Scene3, chrome: Chrome, canvas: &mut Canvas) {
    let room = begin(scene, chrome, canvas);
    let camera = Camera::new(scene.projection, scene.azimuth, scene.elevation, room);
    panels(scene, &[Panel { room, camera, small: false }], chrome, canvas);
}

/// The scene from several places, in panels as near to a square of them as can be.
pub(super) fn draw_views(views: &Views, chrome: Chrome, canvas: &mut Canvas) {
    let scene = &views.scene;
    let room = begin(scene, chrome, canvas);
    let columns = (1..).find(|c| c * c >= views.views.len()).unwrap_or(1).max(1);
    let rows = views.views.len().div_ceil(columns).max(1);
    let (width, height) =
        ((room.right - room.left) / columns as f64, (room.bottom - room.top) / rows as f64);
    let mut all = Vec::new();
    for (i, view) in views.views.iter().enumerate() {
        let [left, top] =
            [room.left + (i % columns) as f64 * width, room.top + (i / columns) as f64 * height];
        let middle = [left + width / 2.0, top + 6.0];
        canvas.text(middle, "t-name", Anchor::Middle, &fit(&view.name, width - 8.0, 13.0));
        let room = PlotArea {
            left: left + 6.0,
            top: top + 14.0,
            right: left + width - 6.0,
            bottom: top + height - 8.0,
        };
        let camera = Camera::new(scene.projection, view.azimuth, view.elevation, room);
        all.push(Panel { room, camera, small: true });
    }
    let factor = common_scale(scene, &all);
    for panel in &mut all {
        panel.camera = panel.camera.enlarged(factor);
    }
    panels(scene, &all, chrome, canvas);
}

/// By how much panels are enlarged to have one scale, as large as the fullest of them allows.
fn common_scale(scene: &Scene3, panels: &[Panel]) -> f64 {
    let stage = stage(scene);
    let balls: Vec<_> = balls(scene)
        .iter()
        .map(|(place, radius)| (stage.place(place), stage.length(*radius)))
        .collect();
    let reach = |panel: &Panel| panel.camera.reach(panel.room, &balls);
    let reach = panels.iter().map(reach).fold(0.0, f64::max);
    if reach > 0.0 { 0.94 / reach } else { 1.0 }
}

/// By how much fixed views are enlarged in panels of a size of their own.
pub(crate) fn enlargement(scene: &Scene3, views: &[View], [right, bottom]: [f64; 2]) -> f64 {
    let room = PlotArea { left: 0.0, top: 0.0, right, bottom };
    let panel = |view: &View| {
        let camera = Camera::new(scene.projection, view.azimuth, view.elevation, room);
        Panel { room, camera, small: true }
    };
    common_scale(scene, &views.iter().map(panel).collect::<Vec<_>>())
}

fn begin(scene: &Scene3, chrome: Chrome, canvas: &mut Canvas) -> PlotArea {
    let entries: Vec<_> = scene.layers.iter().flat_map(entries).collect();
    let size = [scene.width, scene.height];
    frame::begin(canvas, chrome, &scene.title, &scene.caption, size, &entries)
}

/// A view of a scene and its place in the picture.
struct Panel {
    room: PlotArea,
    camera: Camera,
    small: bool,
}

/// All images come before everything else that is drawn in panels, so that a document can be cut into before and after.
fn panels(scene: &Scene3, panels: &[Panel], chrome: Chrome, canvas: &mut Canvas) {
    let stage = stage(scene);
    for panel in panels {
        for layer in &scene.layers {
            if let Shape3::Spheres(spheres) = &layer.shape {
                draw_spheres(canvas, layer, spheres, &stage, &panel.camera, chrome);
            }
        }
    }
    let solids = solids(scene, &stage);
    let mut covers: Vec<_> = panels
        .iter()
        .map(|panel| Coverage::find(&solids, &panel.camera, canvas.density, chrome))
        .collect();
    // Samples are the work of all threads already; compressing is not.
    if canvas.embeds && covers.iter().any(Option::is_some) {
        covers.par_iter_mut().for_each(|cover| cover.iter_mut().for_each(Coverage::compress));
    }
    for cover in covers.iter_mut().flatten() {
        cover.write(canvas);
    }
    for (panel, cover) in panels.iter().zip(&covers) {
        let mut pieces = Vec::new();
        for layer in &scene.layers {
            let view =
                ViewedScene { scene, stage: &stage, camera: &panel.camera, cover: cover.as_ref() };
            collect(layer, &view, &mut pieces, &mut canvas.hovers);
        }
        paint_all(canvas, pieces, cover.is_some());
        triad(canvas, scene, panel);
    }
}

/// From back to front.
fn paint_all(canvas: &mut Canvas, mut pieces: Vec<PaintItem>, on_surface: bool) {
    // A stable sort: equal depths keep the order of the layers, so the bytes are the same each time.
    pieces.sort_by(|a, b| a.depth.total_cmp(&b.depth));
    let many = pieces.len() > 2000;
    // Rims of many marks would cover a surface more than the marks do.
    let discs = pieces.iter().filter(|p| matches!(p.piece, Piece::Disc { .. })).count();
    let rimless = on_surface && discs > RIMS_MAX;
    let mut group: Option<(Tone, u8)> = None;
    for PaintItem { depth, tone, hidden, piece } in &pieces {
        let bucket =
            if *hidden { HIDDEN_GROUP } else { ((depth + 1.0) / 2.0 * 5.0).clamp(0.0, 4.0) as u8 };
        if group != Some((*tone, bucket)) {
            if group.is_some() {
                canvas.close();
            }
            group = Some((*tone, bucket));
            let name = tone.name();
            let low = match tone {
                Tone::Point if many => 0.12,
                Tone::Point => 0.25,
                _ => 0.6,
            };
            let high = if many && *tone == Tone::Point { 0.6 } else { 0.95 };
            let opacity = match bucket {
                HIDDEN_GROUP => "0.2".to_owned(),
                _ => digits(low + (high - low) * f64::from(bucket) / 4.0, 3),
            };
            let halo = if *tone == Tone::Point || *hidden || rimless { "" } else { " t-halo" };
            canvas.open(&format!("f-{name}{halo}"), &format!("opacity=\"{opacity}\""));
        }
        paint(canvas, *tone, piece, on_surface);
    }
    if group.is_some() {
        canvas.close();
    }
}

/// Returns what the legend says of a layer: of a surface with two sides it names both.
fn entries(layer: &Layer3) -> Vec<Entry<'_>> {
    let front = entry(layer);
    match &layer.shape {
        Shape3::Surface(surface) if !layer.name.is_empty() && surface.back != layer.tone => {
            vec![front, Entry { name: "its back", tone: surface.back, key: Key::Side }]
        }
        _ => vec![front],
    }
}

fn entry(layer: &Layer3) -> Entry<'_> {
    let key = match &layer.shape {
        Shape3::Points(points) => Key::Disc(points.iter().map(|p| p.size).fold(0.0, f64::max)),
        Shape3::Crosses(_) => Key::Cross,
        Shape3::Polylines(_) => Key::Line(layer.line_style),
        Shape3::Spheres(_) if layer.line_style != LineStyle::Filled => Key::Line(layer.line_style),
        Shape3::Spheres(_) | Shape3::Mesh(_) => Key::Area,
        Shape3::Surface(_) => Key::Side,
    };
    Entry { name: &layer.name, tone: layer.tone, key }
}

/// The legend of a scene as HTML, for the viewer, which draws none.
pub(crate) fn legend(scene: &Scene3) -> String {
    let mut out = String::from("<ul class=\"legend\">");
    let entries =
        scene.layers.iter().enumerate().flat_map(|(number, layer)| {
            entries(layer).into_iter().map(move |entry| (number, entry))
        });
    for (number, entry) in entries.filter(|(_, entry)| !entry.name.is_empty()) {
        let mut canvas = Canvas::new(1.0, true);
        frame::key(&mut canvas, &entry, [11.0, 7.0]);
        let (key, name) = (canvas.into_body(), escape(entry.name));
        out += &format!(
            "<li data-layer=\"{number}\"><svg viewBox=\"0 0 22 14\" aria-hidden=\"true\">{key}</svg>{name}</li>"
        );
    }
    out + "</ul>\n"
}

fn draw_spheres(
    canvas: &mut Canvas,
    layer: &Layer3,
    spheres: &[crate::Sphere3],
    stage: &Stage,
    camera: &Camera,
    chrome: Chrome,
) {
    let name = layer.tone.name();
    let mut placed: Vec<_> = spheres
        .iter()
        .filter(|s| finite(&s.center) && s.radius.is_finite() && s.radius >= 0.0)
        .map(|s| (camera.turn(stage.place(&s.center)), stage.length(s.radius), s))
        .collect();
    placed.order_by(&|a, b| a.0[2].total_cmp(&b.0[2]));
    let wired = spheres.len() <= WIRED_SPHERES_MAX;
    let (classes, attributes) = stroke(layer.tone, layer.line_style);
    let mut fill = String::new();
    if let (Chrome::Full(theme), LineStyle::Filled, true) = (chrome, layer.line_style, wired) {
        let color = theme.color(layer.tone);
        let stop = |at: &str, opacity: &str| {
            format!("<stop offset=\"{at}\" stop-color=\"{color}\" stop-opacity=\"{opacity}\"/>")
        };
        canvas.raw(&format!(
            "<defs><radialGradient id=\"shade-{name}\" cx=\"0.36\" cy=\"0.3\" r=\"0.75\">{}{}{}</radialGradient></defs>\n",
            stop("0", "0.02"),
            stop("0.7", "0.09"),
            stop("1", "0.24"),
        ));
        fill = format!(" style=\"fill:url(#shade-{name});fill-opacity:1\"");
    } else if !wired {
        fill = " style=\"stroke-width:0.8;stroke-opacity:.7;fill-opacity:.08\"".into();
    }
    canvas.open(&classes, &format!("data-layer=\"spheres\" {attributes}{fill}"));
    for (center, radius, sphere) in &placed {
        canvas.chain(&camera.outline(*center, *radius), true);
        if sphere.id.is_some() {
            let mut words: Vec<_> = sphere.center.iter().map(|&v| digits(v, 6)).collect();
            words.push(format!("radius {}", digits(sphere.radius, 6)));
            canvas.hovers.push(Hover { at: camera.pixel(*center), id: sphere.id, words });
        }
    }
    canvas.close();
    if !wired || layer.line_style == LineStyle::Dashed {
        return;
    }
    for front in [false, true] {
        let side = if front { "t-front" } else { "t-back" };
        canvas.open(&format!("s-{name} {side}"), "stroke-width=\"0.8\"");
        for (center, radius, _) in placed.iter().filter(|(_, radius, _)| *radius > 0.0) {
            for wire in wires() {
                let mut chain = Vec::new();
                for n in wire {
                    let normal = camera.turn(n);
                    let at = add(*center, normal, *radius);
                    if (dot(normal, camera.to_eye(at)) > 0.0) == front {
                        chain.push(camera.pixel(at));
                    } else {
                        canvas.chain(&chain, false);
                        chain.clear();
                    }
                }
                canvas.chain(&chain, false);
            }
        }
        canvas.close();
    }
}

fn collect(
    layer: &Layer3,
    &ViewedScene { scene, stage, camera, cover }: &ViewedScene<'_>,
    pieces: &mut Vec<PaintItem>,
    hovers: &mut Vec<Hover>,
) {
    let mut push = |depth, hidden, piece| {
        pieces.push(PaintItem { depth, tone: layer.tone, hidden, piece });
    };
    let hidden = |v: V3| cover.is_some_and(|cover| cover.hides(camera, v));
    let turned = |p: &V3| camera.turn(stage.place(p));
    match &layer.shape {
        Shape3::Points(points) => {
            for point in points.iter().filter(|p| finite(&p.at)) {
                let v = turned(&point.at);
                let (at, radius) = (camera.pixel(v), point.size * camera.zoom(v[2]));
                let mut words: Vec<_> = point.at.iter().map(|&c| digits(c, 6)).collect();
                let title = if point.label.is_empty() {
                    String::new()
                } else {
                    let places: Vec<_> = scene
                        .axes
                        .iter()
                        .zip(&words)
                        .map(|(a, w)| format!("{} = {w}", a.name))
                        .collect();
                    let who = point.id.map(|id| format!("point {id}: ")).unwrap_or_default();
                    format!("{who}{}; {}", places.join(", "), point.label)
                };
                words.push(point.label.clone());
                hovers.push(Hover { at, id: point.id, words });
                push(v[2], hidden(v), Piece::Disc { at, radius, title });
            }
        }
        Shape3::Crosses(places) => {
            for v in places.iter().filter(|p| finite(p)).map(turned) {
                push(v[2], hidden(v), Piece::Cross(camera.pixel(v)));
            }
        }
        Shape3::Polylines(chains) => {
            for pair in chains.iter().flat_map(|chain| chain.windows(2)) {
                if pair.iter().all(finite) {
                    let ends = [turned(&pair[0]), turned(&pair[1])];
                    let runs = match cover {
                        Some(cover) => cover.runs(camera, ends),
                        None => vec![(ends, false)],
                    };
                    for ([a, b], hidden) in runs {
                        let chain = vec![camera.pixel(a), camera.pixel(b)];
                        let line = Piece::Line { chain, line_style: layer.line_style };
                        push((a[2] + b[2]) / 2.0, hidden, line);
                    }
                }
            }
        }
        Shape3::Mesh(mesh) => {
            for triangle in &mesh.triangles {
                let corners: Vec<V3> = triangle
                    .iter()
                    .filter_map(|&i| mesh.vertices.get(i).filter(|p| finite(p)).map(turned))
                    .collect();
                if let [a, b, c] = corners[..] {
                    let n = cross(add(b, a, -1.0), add(c, a, -1.0));
                    let norm = dot(n, n).sqrt();
                    let light =
                        if norm > 0.0 { (dot(n, [-0.3, 0.5, 0.81]) / norm).abs() } else { 0.0 };
                    let corners = vec![camera.pixel(a), camera.pixel(b), camera.pixel(c)];
                    push((a[2] + b[2] + c[2]) / 3.0, false, Piece::Face { corners, light });
                }
            }
        }
        // Drawn before all pieces.
        Shape3::Spheres(_) | Shape3::Surface(_) => {}
    }
}

fn paint(canvas: &mut Canvas, tone: Tone, piece: &Piece, on_surface: bool) {
    match piece {
        Piece::Disc { at, radius, title } => canvas.disc(*at, *radius, title),
        Piece::Cross(at) => {
            canvas.open(&format!("s-{}", tone.name()), "style=\"stroke-width:2\"");
            canvas.cross(*at, 6.0);
            canvas.close();
        }
        Piece::Line { chain, line_style } => {
            let (classes, attributes) = stroke(tone, *line_style);
            canvas.open(&classes, attributes);
            canvas.chain(chain, false);
            canvas.close();
        }
        Piece::Face { corners, light } => {
            // A translucent mesh around opaque bodies must not hide them.
            let part = if on_surface { 0.3 } else { 1.0 };
            let opacity = px(part * (0.25 + 0.5 * light));
            canvas.open(
                &format!("f-{0} e-{0}", tone.name()),
                &format!("style=\"fill-opacity:{opacity};stroke-width:.4\""),
            );
            canvas.chain(corners, true);
            canvas.close();
        }
    }
}

/// The three directions, in the lower left corner; one that points at the eye has neither a line nor a name.
fn triad(canvas: &mut Canvas, scene: &Scene3, panel: &Panel) {
    let (room, scale) = (panel.room, if panel.small { 0.6 } else { 1.0 });
    let origin = [room.left + 40.0 * scale, room.bottom - 40.0 * scale];
    let directions = [0, 1, 2].map(|k| {
        let mut axis = [0.0; 3];
        axis[k] = 1.0;
        panel.camera.turn(axis)
    });
    let shown = |v: &V3| v[0].hypot(v[1]) > 0.05;
    let tip = |v: V3, length: f64| [origin[0] + length * v[0], origin[1] - length * v[1]];
    canvas.open("t-axis", "");
    for v in directions.into_iter().filter(shown) {
        canvas.line(origin, tip(v, 26.0 * scale));
    }
    canvas.close();
    for (axis, v) in scene.axes.iter().zip(directions).filter(|(_, v)| shown(v)) {
        let at = tip(v, 26.0 * scale + 10.0);
        canvas.text([at[0], at[1] + 4.0], "t-tick", Anchor::Middle, &fit(&axis.name, 70.0, 12.0));
    }
}
