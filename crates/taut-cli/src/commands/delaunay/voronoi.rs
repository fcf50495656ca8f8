//! Voronoi cells as GeoJSON in the plane and as lists of faces in space.
//!
//! *Idea.* Each site has its cell, in the order of the rows of the input; a duplicate has none, as it has no cell of its
//! own. Cells that reach to infinity end at a box.

use std::fmt::Write as _;

use anyhow::anyhow;
use rayon::prelude::*;
use taut::PointSource;
use taut::delaunay::{Plane, Polygon, Polyhedron, Space};
use taut::points::{Blocks, Scratch};

use super::built::Built;

/// Room around the box of all points, as a part of its longest side.
const MARGIN: f64 = 0.1;

/// Cells that one task writes.
const TASK: usize = 1 << 10;

pub(super) fn cells(built: &Built, source: &dyn PointSource) -> anyhow::Result<Vec<u8>> {
    let (low, high) = frame(source)?;
    match built {
        Built::Plane(plane) => Ok(in_plane(plane, low, high)),
        Built::Space(space) => Ok(in_space(space, low, high)),
    }
}

/// Two corners of the box that the cells are clipped to.
pub(super) fn frame(source: &dyn PointSource) -> anyhow::Result<([f64; 3], [f64; 3])> {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    let (blocks, mut scratch) = (Blocks::of(source), Scratch::new());
    for block in 0..blocks.count() {
        let rows = source.read(blocks.range(block), &mut scratch)?;
        let mut at = [0.0; 3];
        for i in 0..rows.len() {
            rows.copy_row(i, &mut at[..source.dim()]);
            for k in 0..3 {
                low[k] = low[k].min(at[k]);
                high[k] = high[k].max(at[k]);
            }
        }
    }
    let side = (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
    let room = if side > 0.0 { MARGIN * side } else { 1.0 };
    let corners = (low.map(|x| x - room), high.map(|x| x + room));
    match corners.0.iter().chain(&corners.1).all(|x| x.is_finite()) {
        true => Ok(corners),
        false => Err(anyhow!(
            "the box of the points exceeds double precision, so no cell can be clipped to it"
        )),
    }
}

/// Rows with their sites, ascending.
fn order(sites: usize, row: impl Fn(u32) -> u32) -> Vec<(u32, u32)> {
    let mut order: Vec<(u32, u32)> = (0..sites as u32).map(|site| (row(site), site)).collect();
    order.sort_unstable();
    order
}

/// A document of all cells, each as `one` writes it for its row and site.
fn document(
    head: &str,
    order: &[(u32, u32)],
    one: impl Fn(&mut String, u32, u32) + Sync,
) -> Vec<u8> {
    let parts: Vec<String> = order
        .par_chunks(TASK)
        .map(|cells| {
            let mut text = String::new();
            for &(row, site) in cells {
                one(&mut text, row, site);
                text.push_str(",\n");
            }
            text
        })
        .collect();
    let cells = parts.concat();
    let cells = cells.strip_suffix(",\n").unwrap_or(&cells);
    format!("{head}\n{cells}\n]}}\n").into_bytes()
}

/// The beginning of a document of cells in the plane.
pub(super) fn head_in_plane(_: [f64; 3], _: [f64; 3]) -> String {
    "{\"type\": \"FeatureCollection\", \"features\": [".to_owned()
}

/// The beginning of a document of cells in space.
pub(super) fn head_in_space(low: [f64; 3], high: [f64; 3]) -> String {
    format!("{{\"low\": {low:?}, \"high\": {high:?}, \"cells\": [")
}

/// The cell of the site of a row in the plane.
pub(super) fn put_feature(text: &mut String, row: u64, cell: &Polygon) {
    let _ = write!(
        text,
        "{{\"type\": \"Feature\", \"properties\": {{\"point\": {row}}}, \"geometry\": {{\"type\": \"Polygon\", \
         \"coordinates\": [["
    );
    // A ring of GeoJSON ends where it begins.
    corners(text, cell.corners.iter().chain(cell.corners.first()));
    text.push_str("]]}}");
}

/// The cell of the site of a row in space.
pub(super) fn put_polyhedron(text: &mut String, row: u64, cell: &Polyhedron) {
    let _ = write!(text, "{{\"point\": {row}, \"faces\": [");
    for (i, face) in cell.faces.iter().enumerate() {
        text.push_str(if i == 0 { "[" } else { ", [" });
        corners(text, face.iter());
        text.push(']');
    }
    text.push_str("]}");
}

fn in_plane(plane: &Plane, low: [f64; 3], high: [f64; 3]) -> Vec<u8> {
    let locator = plane.locator();
    let (head, order) = (head_in_plane(low, high), order(plane.site_count(), |v| plane.row(v)));
    document(&head, &order, |text, row, site| {
        let cell = locator.voronoi_cell(site, [low[0], low[1]], [high[0], high[1]]);
        put_feature(text, row.into(), &cell);
    })
}

fn in_space(space: &Space, low: [f64; 3], high: [f64; 3]) -> Vec<u8> {
    let locator = space.locator();
    let (head, order) = (head_in_space(low, high), order(space.site_count(), |v| space.row(v)));
    document(&head, &order, |text, row, site| {
        put_polyhedron(text, row.into(), &locator.voronoi_cell(site, low, high));
    })
}

/// Points as JSON lists. The shortest decimals that read back to the same number are JSON, too.
fn corners<'a, const D: usize>(text: &mut String, corners: impl Iterator<Item = &'a [f64; D]>) {
    for (i, corner) in corners.enumerate() {
        let _ = write!(text, "{}{corner:?}", if i == 0 { "" } else { ", " });
    }
}
