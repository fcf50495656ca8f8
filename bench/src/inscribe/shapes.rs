//! Outlines and models of `$TAUT_DATA/inscribe`.

use std::collections::BTreeSet;

use taut_io::{Content, open_mesh};

use super::*;

pub(super) const COUNTRIES_110M: &str = "inscribe/countries_110m.json.xz";
pub(super) const COUNTRIES_10M: &str = "inscribe/countries_10m.json.xz";

/// The name of a country, and one of its rings.
type Named = (String, Vec<f64>);

/// The rings of a file; `None`, after saying so, where it is missing.
pub(super) fn countries(file: &str) -> Result<Option<Vec<Named>>> {
    let Some(text) = data::read_xz(file)? else { return Ok(None) };
    let mut found = vec![];
    collect(&serde_json::from_str(&text)?, "", &mut found);
    Ok(Some(found))
}

/// Lists of points at any depth, each under the name of what holds it.
fn collect(value: &Value, name: &str, found: &mut Vec<Named>) {
    let point = |value: &Value| Some([value.get(0)?.as_f64()?, value.get(1)?.as_f64()?]);
    match value {
        Value::Object(fields) => fields.iter().for_each(|(key, value)| collect(value, key, found)),
        Value::Array(items) => match items.iter().map(point).collect::<Option<Vec<_>>>() {
            Some(ring) if ring.len() > 2 => found.push((name.to_owned(), ring.concat())),
            _ => items.iter().for_each(|value| collect(value, name, found)),
        },
        _ => {}
    }
}

/// The triangles of a mesh, by their corners.
pub(crate) type Mesh = Vec<[[f64; 3]; 3]>;

/// A model, and what has to be reached on it.
#[derive(Clone, Copy)]
pub(super) struct Model {
    pub(super) name: &'static str,
    /// Bodies of a packing.
    pub(super) count: usize,
    /// Shares of the inside to cover, which must be reached and which is the aim.
    pub(super) overlapping: [f64; 2],
    pub(super) disjoint: [f64; 2],
    /// The same of as many bodies with free facets.
    pub(super) free: [f64; 2],
    /// The same of lines that ten bodies hide.
    pub(super) hidden: [f64; 2],
    /// The volume of the largest 18-dop known, with the longest side 1; 0 where none is.
    pub(super) largest: f64,
}

pub(super) const fn model(
    name: &'static str,
    count: usize,
    [overlapping, disjoint, free, hidden]: [[f64; 2]; 4],
    largest: f64,
) -> Model {
    Model { name, count, overlapping, disjoint, free, hidden, largest }
}

/// The mesh of a model with the longest side 1 and without holes, each closed by a fan; `None` where it is missing.
pub(crate) fn read(name: &str) -> Result<Option<Mesh>> {
    let Some(path) = data::find(&format!("inscribe/{name}.off.xz")) else { return Ok(None) };
    let mesh = open_mesh(&path, Content::Surface, None)?;
    let extent = |c: usize| {
        let along = mesh.vertices.iter().map(|p| p[c]);
        along.clone().fold(f64::NEG_INFINITY, f64::max) - along.fold(f64::INFINITY, f64::min)
    };
    let side = extent(0).max(extent(1)).max(extent(2));
    let corner = |id: u32| mesh.vertices[id as usize].map(|x| x / side);
    Ok(Some(closed(mesh.triangles().iter().map(|ids| ids.map(corner)).collect())))
}

/// Closes holes by triangles from the mean of their corners to the edges that belong to an odd number of triangles.
fn closed(mut mesh: Mesh) -> Mesh {
    let mut odd: BTreeSet<[[u64; 3]; 2]> = BTreeSet::new();
    for &[a, b, c] in &mesh {
        for edge in [[a, b], [b, c], [c, a]] {
            let mut ends = edge.map(|end| end.map(|x| (x + 0.0).to_bits()));
            ends.sort_unstable();
            if ends[0] != ends[1] && !odd.remove(&ends) {
                odd.insert(ends);
            }
        }
    }
    while let Some(first) = odd.pop_first() {
        let (mut hole, mut at) = (vec![first], 0);
        while let Some(&ends) = hole.get(at) {
            let next = odd.extract_if(.., |edge| edge.iter().any(|p| ends.contains(p)));
            hole.extend(next.collect::<Vec<_>>());
            at += 1;
        }
        let edges: Vec<_> = hole.iter().map(|edge| edge.map(|p| p.map(f64::from_bits))).collect();
        let corners = edges.as_flattened();
        let mean = |c: usize| corners.iter().map(|p| p[c]).sum::<f64>() / corners.len() as f64;
        let apex = [0, 1, 2].map(mean);
        mesh.extend(edges.iter().map(|&[a, b]| [a, b, apex]));
    }
    mesh
}
