//! Meshes of `$TAUT_DATA/surface`, and what is true of them.

use super::*;

/// A mesh whose vertices are the input, and the closed surface that they are from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Model {
    /// What tables call it.
    pub(super) name: &'static str,
    file: &'static str,
    /// Its parts.
    pub(super) components: usize,
    /// Handles of all parts together.
    pub(super) genus: u64,
}

const fn model(name: &'static str, file: &'static str, components: usize, genus: u64) -> Model {
    Model { name, file, components, genus }
}

pub(super) const ANCHOR: Model = model("anchor", "reconbench_anchor", 1, 4);
pub(super) const DC: Model = model("dc", "reconbench_dc", 1, 8);
pub(super) const HORSE: Model = model("horse", "horse", 1, 0);
/// The mesh has five holes, and 1113 vertices that no triangle uses; closed, the body is a ball.
pub(super) const BUNNY: Model = model("bunny", "stanford_bunny", 1, 0);
/// Sampled less densely than its folds ask for.
pub(super) const BLOB5: Model = model("blob5", "hoppe_blob5", 1, 0);

/// Those that are closed, and nearly clean.
pub(super) const SEVEN: [Model; 7] = [
    ANCHOR,
    model("daratech", "reconbench_daratech", 1, 7),
    DC,
    model("fandisk", "fandisk", 1, 0),
    HORSE,
    model("mechpart", "hoppe_mechpart", 1, 3),
    model("knot2", "knot2", 2, 2),
];

/// The points of Hoppe's cactus, lines `p x y z` between remarks.
pub(super) fn cactus() -> Result<Option<Vec<Point>>> {
    let Some(text) = data::read_xz("surface/hoppe_cactus.pts.xz")? else { return Ok(None) };
    let mut points = vec![];
    for line in text.lines() {
        if let ["p", x, y, z] = line.split_whitespace().collect::<Vec<_>>()[..] {
            points.push([x.parse()?, y.parse()?, z.parse()?]);
        }
    }
    Ok(Some(points))
}

impl Model {
    /// Its mesh, if it is there.
    pub(super) fn read(&self) -> Result<Option<Mesh>> {
        let Some(path) = data::find(&format!("surface/{}.off.xz", self.file)) else {
            return Ok(None);
        };
        let shape = open_mesh(&path, Content::Surface, None);
        shape.map(Some).with_context(|| path.display().to_string())
    }
}
