//! A scene of space as the data of the page's viewer.

use crate::base64::base64;
use crate::number::digits;
use crate::svg::{EYE_DISTANCE, Stage, WIRED_SPHERES_MAX, enlargement, finite, stage};
use crate::text::json;
use crate::{Layer3, LineStyle, Projection, Scene3, Shading, Shape3, View};

/// The scene as JSON: places in the unit ball of the view, words as they are to be shown.
pub(super) fn data(scene: &Scene3) -> String {
    let stage = stage(scene);
    let map = stage.map();
    let names: Vec<_> = scene.axes.iter().map(|axis| json(&axis.name)).collect();
    let layers: Vec<_> = scene.layers.iter().map(|l| layer(l, &stage, &map)).collect();
    format!(
        "{{\"names\":[{}],\"eye\":{EYE_DISTANCE},\"wired\":{WIRED_SPHERES_MAX},\"map\":{map:?},\"perspective\":{},\"azimuth\":{},\"elevation\":{},\
         \"width\":{},\"height\":{},\"layers\":[{}]}}",
        names.join(","),
        scene.projection == Projection::Perspective,
        number(scene.azimuth),
        number(scene.elevation.clamp(-90.0, 90.0)),
        number(scene.width.max(1.0)),
        number(scene.height.max(1.0)),
        layers.join(",\n"),
    )
}

/// Fixed views of a scene that is on the page already, in panels of one size and one scale: as large as the fullest of them allows.
pub(super) fn views(scene: &Scene3, views: &[View], [width, height]: [f64; 2]) -> String {
    let directions: Vec<_> = views
        .iter()
        .map(|view| format!("[{},{}]", number(view.azimuth), number(view.elevation)))
        .collect();
    format!(
        "{{\"views\":[{}],\"perspective\":{},\"zoom\":{},\"width\":{},\"height\":{}}}",
        directions.join(","),
        scene.projection == Projection::Perspective,
        number(enlargement(scene, views, [width, height])),
        number(width),
        number(height),
    )
}

/// Four decimals: a tenth of a pixel on any screen.
fn number(value: f64) -> String {
    let value = if value.is_finite() { (value * 1e4).round() / 1e4 } else { 0.0 };
    format!("{}", value + 0.0)
}

fn place(p: [f64; 3]) -> String {
    format!("[{}]", p.map(number).join(","))
}

/// Place, size, number and words in one list: a page can have many.
fn mark(at: [f64; 3], size: f64, id: Option<u64>, words: &[String]) -> String {
    let id = id.map_or_else(|| "null".to_owned(), |id| id.to_string());
    format!("[{},{},{id}{}]", place(at), number(size), super::words(words))
}

/// A point whose size and label are those of its layer, if its coordinates as told are its place to a fraction of a pixel.
fn told(at: [f64; 3], id: Option<u64>, words: &[String], map: &[[f64; 2]; 3]) -> Option<String> {
    let off = |k: usize| Some(map[k][0] + map[k][1] * words[k].parse::<f64>().ok()? - at[k]);
    let id = id.map_or_else(|| "null".to_owned(), |id| id.to_string());
    let is_told = (0..3).all(|k| off(k).is_some_and(|off| off.abs() < 5e-5));
    is_told.then(|| format!("[{id}{}]", super::words(&words[..3])))
}

/// Vertices and triangles as bytes: four for a coordinate and four for a corner.
fn packed(
    vertices: &[[f64; 3]],
    triangles: impl Iterator<Item = [u32; 3]>,
    stage: &Stage,
) -> String {
    // A corner that is not finite is of no triangle; JSON and the viewer get a 0.
    let finite = |x: f64| if x.is_finite() { x as f32 } else { 0.0 };
    let places = vertices.iter().flat_map(|p| stage.place(p)).map(finite);
    let vertices: Vec<u8> = places.flat_map(f32::to_le_bytes).collect();
    let triangles: Vec<u8> = triangles.flatten().flat_map(u32::to_le_bytes).collect();
    format!(",\"vertices\":\"{}\",\"triangles\":\"{}\"", base64(&vertices), base64(&triangles))
}

fn layer(layer: &Layer3, stage: &Stage, map: &[[f64; 2]; 3]) -> String {
    let line_style = match layer.line_style {
        LineStyle::Solid => "solid",
        LineStyle::Dashed => "dashed",
        LineStyle::Filled => "filled",
        LineStyle::Thin => "thin",
    };
    let mut marks = Vec::new();
    let mut more = String::new();
    let said = |at: &[f64; 3], last: String| -> Vec<String> {
        at.iter().map(|&v| digits(v, 6)).chain([last]).collect()
    };
    let kind = match &layer.shape {
        Shape3::Points(points) => {
            // Most are alike.
            let common = points.first().map_or((0.0, ""), |p| (p.size, &*p.label));
            more = format!(",\"size\":{},\"label\":{}", number(common.0), json(common.1));
            for p in points.iter().filter(|p| finite(&p.at)) {
                let (at, words) = (stage.place(&p.at), said(&p.at, p.label.clone()));
                let is_common = (p.size, &*p.label) == common;
                let short = is_common.then(|| told(at, p.id, &words, map)).flatten();
                marks.push(short.unwrap_or_else(|| mark(at, p.size, p.id, &words)));
            }
            "points"
        }
        Shape3::Crosses(places) => {
            marks.extend(
                places.iter().filter(|p| finite(p)).map(|p| mark(stage.place(p), 6.0, None, &[])),
            );
            "crosses"
        }
        Shape3::Spheres(spheres) => {
            for s in spheres
                .iter()
                .filter(|s| finite(&s.center) && s.radius.is_finite() && s.radius >= 0.0)
            {
                let words = said(&s.center, format!("radius {}", digits(s.radius, 6)));
                marks.push(mark(stage.place(&s.center), stage.length(s.radius), s.id, &words));
            }
            "spheres"
        }
        Shape3::Polylines(chains) => {
            let chain = |chain: &Vec<[f64; 3]>| {
                let places: Vec<_> =
                    chain.iter().filter(|p| finite(p)).map(|p| place(stage.place(p))).collect();
                format!("[{}]", places.join(","))
            };
            let chains: Vec<_> = chains.iter().map(chain).collect();
            more = format!(",\"chains\":[{}]", chains.join(","));
            "polylines"
        }
        Shape3::Mesh(mesh) => {
            let drawable =
                |t: &&[usize; 3]| t.iter().all(|&i| mesh.vertices.get(i).is_some_and(finite));
            let triangles = mesh.triangles.iter().filter(drawable).map(|t| t.map(|i| i as u32));
            more = packed(&mesh.vertices, triangles, stage);
            "mesh"
        }
        Shape3::Surface(surface) => {
            let drawable = |t: &&[u32; 3]| {
                t.iter().all(|&i| surface.vertices.get(i as usize).is_some_and(finite))
            };
            more = format!(
                ",\"back\":\"{}\",\"smooth\":{}{}",
                surface.back.name(),
                surface.shading == Shading::Smooth,
                packed(
                    &surface.vertices,
                    surface.triangles.iter().filter(drawable).copied(),
                    stage
                ),
            );
            "surface"
        }
    };
    format!(
        "{{\"tone\":\"{}\",\"look\":\"{line_style}\",\"kind\":\"{kind}\",\"marks\":[{}]{more}}}",
        layer.tone.name(),
        marks.join(",\n"),
    )
}
