//! spade and delaunator as peers: `peers NAME FILE` builds one triangulation in the plane and prints one line of JSON.
//! quickheap as a peer: `peers quickheap FILE OUTPUT` and `peers quickheap-keys FILE OUTPUT`, see `queue`; `peers imageproc FILE OUTPUT`,
//! see `images`; `peers polylabel-crate FILE OUTPUT` and `peers parry3d FILE`, see `shapes`; `peers parry3d-pairs FILE OUTPUT`, see
//! `spheres`.
//!
//! The line is described in `bench/peers/delaunay.hpp`; time and memory are taken by the code that takes those of taut.
#![forbid(unsafe_code)]

mod images;
#[path = "../../../src/meter.rs"]
mod meter;
mod queue;
mod shapes;
mod spheres;

use std::fs::File;
use std::io::{BufReader, Read};

use meter::{Cost, Meter};
use serde_json::json;
use spade::{DelaunayTriangulation, Point2, Triangulation};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let (name, path) = match &arguments[..] {
        [_, name, path] if name == "parry3d" => {
            println!("{}", shapes::convex_parts(path)?);
            return Ok(());
        }
        [_, name, path] => (name, path),
        [_, name, path, output] if name == "imageproc" => return images::serve(path, output),
        [_, name, path, output] if name == "polylabel-crate" => {
            return shapes::serve_circle(path, output);
        }
        [_, name, path, output] if name == "parry3d-pairs" => return spheres::serve(path, output),
        [_, name, path, output] => return queue::serve(name, path, output),
        _ => return Err("expected NAME and FILE".into()),
    };
    let (points, simplices, cost) = match name.as_str() {
        "spade" => spade(read(path, |[x, y]| Point2::new(x, y))?)?,
        "delaunator" => delaunator(&read(path, |[x, y]| delaunator::Point { x, y })?),
        _ => return Err(format!("no peer is called {name}").into()),
    };
    let line = json!({
        "program": format!("{name} {}", version(name).unwrap_or("of unknown version")),
        "points": points,
        "simplices": simplices,
        "cpu": cost.cpu,
        "wall": cost.wall,
        "peak": cost.peak,
    });
    println!("{line}");
    Ok(())
}

/// It is given its points for good, so they need not be copied; they are counted as input all the same.
fn spade(points: Vec<Point2<f64>>) -> Result<(usize, usize, Cost), spade::InsertionError> {
    let count = points.len();
    let meter = Meter::start();
    let built = DelaunayTriangulation::<Point2<f64>>::bulk_load(points)?;
    let cost = meter.stop();
    Ok((count, built.num_inner_faces(), cost))
}

fn delaunator(points: &[delaunator::Point]) -> (usize, usize, Cost) {
    let meter = Meter::start();
    let built = delaunator::triangulate(points);
    let cost = meter.stop();
    (points.len(), built.len(), cost)
}

/// The points of a raw file, each as its peer wants it, without a second copy of them.
fn read<P>(path: &str, point: impl Fn([f64; 2]) -> P) -> std::io::Result<Vec<P>> {
    let file = File::open(path)?;
    let mut points = Vec::with_capacity(file.metadata()?.len() as usize / 16);
    let mut file = BufReader::with_capacity(1 << 16, file);
    for _ in 0..points.capacity() {
        let mut number = || {
            let mut bytes = [0; 8];
            file.read_exact(&mut bytes).map(|()| f64::from_le_bytes(bytes))
        };
        points.push(point([number()?, number()?]));
    }
    Ok(points)
}

/// The version of a crate this program was built with.
fn version(name: &str) -> Option<&'static str> {
    let (_, after) =
        include_str!("../Cargo.lock").split_once(&format!("name = \"{name}\"\nversion = \""))?;
    after.split('"').next()
}
