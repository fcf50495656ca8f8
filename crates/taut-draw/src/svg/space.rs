//! A scene of space as SVG: one view of it.
//!
//! *Idea.* The scene is moved and scaled to the unit ball around the origin, turned so that the eye looks down the
//! third axis, and painted from back to front; what is far is smaller and paler. The viewer of the HTML page does the
//! same from the same numbers.

use super::Hover;
use super::canvas::{Anchor, Canvas, stroke};
use super::frame::{self, Chrome, Entry, Key, Room};
use crate::axes::unit;
use crate::number::{px, short};
use crate::text::{escape, fit};
use crate::{Layer3, Look, Projection, Scene3, Shape3, Tone};

/// Distance of the eye from the middle of the scene, in radii of the scene.
pub(crate) const EYE: f64 = 4.0;

/// A scene of which more spheres than this are drawn has outlines only.
pub(crate) const WIRED: usize = 4;

/// Where the unit ball of the view lies in the data.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stage {
    unit: f64,
    middle: [f64; 3],
    radius: f64,
}

/// The ball that holds all finite marks of a scene: the box around them decides its middle.
pub(crate) fn stage(scene: &Scene3) -> Stage {
    let mut balls: Vec<([f64; 3], f64)> = Vec::new();
    for layer in &scene.layers {
        match &layer.shape {
            Shape3::Points(points) => balls.extend(points.iter().map(|p| (p.at, 0.0))),
            Shape3::Crosses(places) => balls.extend(places.iter().map(|&p| (p, 0.0))),
            Shape3::Spheres(spheres) => balls.extend(spheres.iter().map(|s| (s.center, s.radius))),
            Shape3::Polylines(chains) => balls.extend(chains.iter().flatten().map(|&p| (p, 0.0))),
            Shape3::Mesh(mesh) => balls.extend(mesh.vertices.iter().map(|&p| (p, 0.0))),
        }
    }
    balls.retain(|(p, r)| finite(p) && r.is_finite() && *r >= 0.0);
    let unit = unit(balls.iter().flat_map(|(p, r)| [p[0], p[1], p[2], *r]));
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for (p, r) in &balls {
        for k in 0..3 {
            low[k] = low[k].min(p[k] / unit - r / unit);
            high[k] = high[k].max(p[k] / unit + r / unit);
        }
    }
    if balls.is_empty() {
        (low, high) = ([-1.0; 3], [1.0; 3]);
    }
    let middle = [0, 1, 2].map(|k| low[k] + (high[k] - low[k]) / 2.0);
    let reach = |(p, r): &([f64; 3], f64)| {
        let square: f64 = (0..3).map(|k| (p[k] / unit - middle[k]).powi(2)).sum();
        square.sqrt() + r / unit
    };
    let radius = balls.iter().map(reach).fold(0.0, f64::max);
    Stage { unit, middle, radius: if radius > 0.0 { radius } else { 1.0 } }
}

impl Stage {
    /// A place in the unit ball.
    pub(crate) fn place(&self, p: &[f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|k| (p[k] / self.unit - self.middle[k]) / self.radius)
    }

    /// A length in the unit ball.
    pub(crate) fn length(&self, r: f64) -> f64 {
        r / self.unit / self.radius
    }
}

pub(crate) fn finite(p: &[f64; 3]) -> bool {
    p.iter().all(|v| v.is_finite())
}

type V3 = [f64; 3];

fn dot(a: V3, b: V3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn add(a: V3, b: V3, t: f64) -> V3 {
    [0, 1, 2].map(|k| a[k] + t * b[k])
}

/// The eye and the sheet it draws on.
struct Camera {
    /// Right, up, and towards the eye.
    frame: [V3; 3],
    projection: Projection,
    middle: [f64; 2],
    /// Pixels of a unit at the middle of the scene.
    scale: f64,
}

impl Camera {
    fn new(scene: &Scene3, room: Room) -> Self {
        let turn = |degrees: f64| if degrees.is_finite() { degrees.to_radians() } else { 0.0 };
        let (sa, ca) = turn(scene.azimuth).sin_cos();
        let (se, ce) = turn(scene.elevation.clamp(-90.0, 90.0)).sin_cos();
        let frame = [[-sa, ca, 0.0], [-se * ca, -se * sa, ce], [ce * ca, ce * sa, se]];
        let half = (room.right - room.left).min(room.bottom - room.top).max(20.0) / 2.0;
        // The outline of the unit ball seen from EYE has radius EYE/√(EYE² − 1).
        let outline = match scene.projection {
            Projection::Perspective => EYE / (EYE * EYE - 1.0).sqrt(),
            Projection::Orthographic => 1.0,
        };
        let middle = [(room.left + room.right) / 2.0, (room.top + room.bottom) / 2.0];
        Camera { frame, projection: scene.projection, middle, scale: 0.97 * half / outline }
    }

    /// Turns a place of the stage: right, up, towards the eye.
    fn turn(&self, p: V3) -> V3 {
        self.frame.map(|axis| dot(axis, p))
    }

    /// How much larger things look at a depth.
    fn zoom(&self, depth: f64) -> f64 {
        match self.projection {
            Projection::Perspective => EYE / (EYE - depth),
            Projection::Orthographic => 1.0,
        }
    }

    /// The pixel of a turned place.
    fn pixel(&self, v: V3) -> [f64; 2] {
        let s = self.scale * self.zoom(v[2]);
        [self.middle[0] + s * v[0], self.middle[1] - s * v[1]]
    }

    /// The direction from a turned place to the eye.
    fn to_eye(&self, v: V3) -> V3 {
        match self.projection {
            Projection::Perspective => [-v[0], -v[1], EYE - v[2]],
            Projection::Orthographic => [0.0, 0.0, 1.0],
        }
    }

    /// The outline of a sphere: the circle where lines from the eye touch it.
    fn outline(&self, center: V3, radius: f64) -> Vec<[f64; 2]> {
        let to_eye = self.to_eye(center);
        let distance = dot(to_eye, to_eye).sqrt();
        let sine = match self.projection {
            Projection::Perspective => (radius / distance).min(0.999),
            Projection::Orthographic => 0.0,
        };
        let axis = to_eye.map(|v| v / distance);
        let middle = add(center, axis, radius * sine);
        let ring = radius * (1.0 - sine * sine).sqrt();
        let [u, w] = across(axis);
        (0..96)
            .map(|i| {
                let (s, c) = (f64::from(i) / 96.0 * std::f64::consts::TAU).sin_cos();
                self.pixel(add(add(middle, u, ring * c), w, ring * s))
            })
            .collect()
    }
}

/// Two directions that make a frame with a unit vector.
fn across(axis: V3) -> [V3; 2] {
    let helper = if axis[0].abs() < 0.9 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    let u = add(helper, axis, -dot(helper, axis));
    let u = u.map(|v| v / dot(u, u).sqrt());
    let w = [
        axis[1] * u[2] - axis[2] * u[1],
        axis[2] * u[0] - axis[0] * u[2],
        axis[0] * u[1] - axis[1] * u[0],
    ];
    [u, w]
}

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

/// Something to paint, nearest last.
enum Piece {
    Disc { at: [f64; 2], radius: f64, title: String },
    Line { chain: Vec<[f64; 2]>, look: Look },
    Cross([f64; 2]),
    Face { corners: Vec<[f64; 2]>, light: f64 },
}

pub(super) fn draw(scene: &Scene3, chrome: Chrome, canvas: &mut Canvas) {
    let entries: Vec<_> = scene.layers.iter().map(entry).collect();
    let size = [scene.width, scene.height];
    let room = frame::begin(canvas, chrome, &scene.title, &scene.caption, size, &entries);
    let (stage, camera) = (stage(scene), Camera::new(scene, room));
    for layer in &scene.layers {
        if let Shape3::Spheres(spheres) = &layer.shape {
            draw_spheres(canvas, layer, spheres, &stage, &camera, chrome);
        }
    }
    let mut pieces: Vec<(f64, Tone, Piece)> = Vec::new();
    for layer in &scene.layers {
        collect(layer, scene, &stage, &camera, &mut pieces, &mut canvas.hovers);
    }
    // A stable sort: equal depths keep the order of the layers, so the bytes are the same each time.
    pieces.sort_by(|a, b| a.0.total_cmp(&b.0));
    let many = pieces.len() > 2000;
    let mut group: Option<(Tone, u8)> = None;
    for (depth, tone, piece) in &pieces {
        let bucket = ((depth + 1.0) / 2.0 * 5.0).clamp(0.0, 4.0) as u8;
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
            let opacity = short(low + (high - low) * f64::from(bucket) / 4.0, 3);
            let halo = if *tone == Tone::Point { "" } else { " t-halo" };
            canvas.open(&format!("f-{name}{halo}"), &format!("opacity=\"{opacity}\""));
        }
        paint(canvas, *tone, piece);
    }
    if group.is_some() {
        canvas.close();
    }
    triad(canvas, scene, &camera, room);
}

fn entry(layer: &Layer3) -> Entry<'_> {
    let key = match &layer.shape {
        Shape3::Points(points) => Key::Disc(points.iter().map(|p| p.size).fold(0.0, f64::max)),
        Shape3::Crosses(_) => Key::Cross,
        Shape3::Polylines(_) => Key::Line(layer.look),
        Shape3::Spheres(_) if layer.look != Look::Filled => Key::Line(layer.look),
        Shape3::Spheres(_) | Shape3::Mesh(_) => Key::Area,
    };
    Entry { name: &layer.name, tone: layer.tone, key }
}

/// The legend of a scene as HTML, for the viewer, which draws none.
pub(crate) fn legend(scene: &Scene3) -> String {
    let mut out = String::from("<ul class=\"legend\">");
    for entry in scene.layers.iter().map(entry).filter(|entry| !entry.name.is_empty()) {
        let mut canvas = Canvas::default();
        frame::key(&mut canvas, &entry, [11.0, 7.0]);
        let (key, name) = (canvas.into_body(), escape(entry.name));
        out +=
            &format!("<li><svg viewBox=\"0 0 22 14\" aria-hidden=\"true\">{key}</svg>{name}</li>");
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
    placed.sort_by(|a, b| a.0[2].total_cmp(&b.0[2]));
    let wired = spheres.len() <= WIRED;
    let (classes, attributes) = stroke(layer.tone, layer.look);
    let mut fill = String::new();
    if let (Chrome::Full(theme), Look::Filled, true) = (chrome, layer.look, wired) {
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
            let mut words: Vec<_> = sphere.center.iter().map(|&v| short(v, 6)).collect();
            words.push(format!("radius {}", short(sphere.radius, 6)));
            canvas.hovers.push(Hover { at: camera.pixel(*center), id: sphere.id, words });
        }
    }
    canvas.close();
    if !wired || layer.look == Look::Dashed {
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
    scene: &Scene3,
    stage: &Stage,
    camera: &Camera,
    pieces: &mut Vec<(f64, Tone, Piece)>,
    hovers: &mut Vec<Hover>,
) {
    let turned = |p: &V3| camera.turn(stage.place(p));
    match &layer.shape {
        Shape3::Points(points) => {
            for point in points.iter().filter(|p| finite(&p.at)) {
                let v = turned(&point.at);
                let (at, radius) = (camera.pixel(v), point.size * camera.zoom(v[2]));
                let mut words: Vec<_> = point.at.iter().map(|&c| short(c, 6)).collect();
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
                pieces.push((v[2], layer.tone, Piece::Disc { at, radius, title }));
            }
        }
        Shape3::Crosses(places) => {
            for v in places.iter().filter(|p| finite(p)).map(turned) {
                pieces.push((v[2], layer.tone, Piece::Cross(camera.pixel(v))));
            }
        }
        Shape3::Polylines(chains) => {
            for pair in chains.iter().flat_map(|chain| chain.windows(2)) {
                if pair.iter().all(finite) {
                    let [a, b] = [turned(&pair[0]), turned(&pair[1])];
                    let chain = vec![camera.pixel(a), camera.pixel(b)];
                    let line = Piece::Line { chain, look: layer.look };
                    pieces.push(((a[2] + b[2]) / 2.0, layer.tone, line));
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
                    let [u, w] = [add(b, a, -1.0), add(c, a, -1.0)];
                    let n = [
                        u[1] * w[2] - u[2] * w[1],
                        u[2] * w[0] - u[0] * w[2],
                        u[0] * w[1] - u[1] * w[0],
                    ];
                    let norm = dot(n, n).sqrt();
                    let light =
                        if norm > 0.0 { (dot(n, [-0.3, 0.5, 0.81]) / norm).abs() } else { 0.0 };
                    let corners = vec![camera.pixel(a), camera.pixel(b), camera.pixel(c)];
                    pieces.push((
                        (a[2] + b[2] + c[2]) / 3.0,
                        layer.tone,
                        Piece::Face { corners, light },
                    ));
                }
            }
        }
        Shape3::Spheres(_) => {}
    }
}

fn paint(canvas: &mut Canvas, tone: Tone, piece: &Piece) {
    match piece {
        Piece::Disc { at, radius, title } => canvas.disc(*at, *radius, title),
        Piece::Cross(at) => {
            canvas.open(&format!("s-{}", tone.name()), "style=\"stroke-width:2\"");
            canvas.cross(*at, 6.0);
            canvas.close();
        }
        Piece::Line { chain, look } => {
            let (classes, attributes) = stroke(tone, *look);
            canvas.open(&classes, attributes);
            canvas.chain(chain, false);
            canvas.close();
        }
        Piece::Face { corners, light } => {
            let opacity = px(0.25 + 0.5 * light);
            canvas.open(
                &format!("f-{0} e-{0}", tone.name()),
                &format!("style=\"fill-opacity:{opacity};stroke-width:.4\""),
            );
            canvas.chain(corners, true);
            canvas.close();
        }
    }
}

/// The three directions, in the lower left corner.
fn triad(canvas: &mut Canvas, scene: &Scene3, camera: &Camera, room: Room) {
    let origin = [room.left + 40.0, room.bottom - 40.0];
    canvas.open("t-axis", "");
    let tips = [0, 1, 2].map(|k| {
        let mut axis = [0.0; 3];
        axis[k] = 1.0;
        let v = camera.turn(axis);
        let tip = |length: f64| [origin[0] + length * v[0], origin[1] - length * v[1]];
        canvas.line(origin, tip(26.0));
        tip(36.0)
    });
    canvas.close();
    for (axis, tip) in scene.axes.iter().zip(tips) {
        canvas.text([tip[0], tip[1] + 4.0], "t-tick", Anchor::Middle, &fit(&axis.name, 70.0, 12.0));
    }
}
