//! Builds the tree: halves the rows along their widest extent, at whole subtrees, until a block is left; bounds from below.
//!
//! *Idea.* All blocks are full but the last, and all nodes have eight children but the last of each level. So rows are halved at
//! multiples of the rows of a full node, and the tree needs no links.
//! *Guarantee.* ⌈log₈ m⌉ levels over m blocks whatever the rows; the same tree for any number of threads: cuts are by coordinate
//! and then by row, and blocks are sorted by row.
//! *Trap.* The middle of a box is a poor center for the ball around points on a curve; a few steps towards the farthest point
//! (Bădoiu and Clarkson's first method, which 2.4 of the thesis uses too) shrink it, and the best center is kept.

use rayon::prelude::*;
use taut_points::times_two_to;

use super::cuts::{AXES_MAX, Cuts};
use super::measure::BALL_SLACK;
use super::nodes::{BLOCK_SIZE, FANOUT, Lanes, Level, NO_ROW, Nodes};

/// Rows below which a part is not shared among threads.
const ALONE_BELOW: usize = 1 << 13;
/// Steps towards the farthest point for the center of a ball.
const CENTER_STEPS: usize = 4;

/// Packs rows into the arrays of the tree; there is at least one row, and fewer than 2³² − 1.
pub(super) fn pack(values: &[f64], dim: usize, row_radii: &[f64]) -> Nodes {
    let len = values.len() / dim;
    let mut order: Vec<u32> = (0..len as u32).collect();
    let mut keyed = vec![(0.0, 0); len];
    let mut unit = BLOCK_SIZE;
    while unit * FANOUT < len {
        unit *= FANOUT;
    }
    let points = Rows { values, dim };
    split(points, &mut order, &mut keyed, unit);
    drop(keyed);
    let blocks = len.div_ceil(BLOCK_SIZE);
    let lane = |i: usize| order[i.min(len - 1)] as usize;
    let mut coordinates = vec![Lanes([0.0; BLOCK_SIZE]); blocks * dim];
    coordinates.par_chunks_mut(dim).enumerate().for_each(|(block, columns)| {
        for (axis, column) in columns.iter_mut().enumerate() {
            for (i, x) in column.0.iter_mut().enumerate() {
                *x = values[lane(block * BLOCK_SIZE + i) * dim + axis];
            }
        }
    });
    let lanes = 0..blocks * BLOCK_SIZE;
    let rows = lanes.clone().map(|i| order.get(i).copied().unwrap_or(NO_ROW)).collect();
    let row_radii: Vec<f64> = match row_radii {
        [] => vec![],
        radii => lanes.map(|i| radii[lane(i)]).collect(),
    };
    let row_radius_max = row_radii.iter().fold(0.0, |a: f64, &r| a.max(r));
    let mut nodes = Nodes { dim, coordinates, row_radii, row_radius_max, rows, levels: vec![] };
    let mut rows_below = BLOCK_SIZE;
    loop {
        let level = bounds(&nodes, points, &order, rows_below);
        let is_top = level.count <= FANOUT;
        nodes.levels.push(level);
        if is_top {
            return nodes;
        }
        rows_below *= FANOUT;
    }
}

#[derive(Clone, Copy)]
struct Rows<'a> {
    values: &'a [f64],
    dim: usize,
}

impl<'a> Rows<'a> {
    fn at(self, row: u32) -> &'a [f64] {
        &self.values[row as usize * self.dim..][..self.dim]
    }

    /// Low and high ends of some rows.
    fn extents(self, order: &[u32]) -> (Vec<f64>, Vec<f64>) {
        let first = self.at(order[0]);
        let (mut low, mut high) = (first.to_vec(), first.to_vec());
        for &row in &order[1..] {
            for ((x, low), high) in self.at(row).iter().zip(&mut low).zip(&mut high) {
                *low = if x < low { *x } else { *low };
                *high = if x > high { *x } else { *high };
            }
        }
        (low, high)
    }
}

/// Puts rows in tree order: those of each node of `unit` rows, and of the nodes within it, side by side.
fn split(points: Rows<'_>, order: &mut [u32], keyed: &mut [(f64, u32)], mut unit: usize) {
    while order.len() <= unit {
        if unit == BLOCK_SIZE {
            order.sort_unstable();
            return;
        }
        unit /= FANOUT;
    }
    // The lower half of a group, of its half or of its quarter is full: so the cuts of all groups have the same places.
    let middle = order.len().div_ceil(unit).next_power_of_two() / 2 * unit;
    let (low, high) = points.extents(order);
    // Halves, as an extent may overflow.
    let extent = |axis: usize| high[axis] / 2.0 - low[axis] / 2.0;
    let widest = |best, axis| if extent(axis) > extent(best) { axis } else { best };
    let axis = (1..points.dim.min(AXES_MAX)).fold(0, widest);
    for (key, &row) in keyed.iter_mut().zip(&*order) {
        *key = (points.at(row)[axis], row);
    }
    keyed.select_nth_unstable_by(middle, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    for (row, key) in order.iter_mut().zip(&*keyed) {
        *row = key.1;
    }
    let is_small = order.len() < ALONE_BELOW;
    let (left, right) = order.split_at_mut(middle);
    let (keyed_left, keyed_right) = keyed.split_at_mut(middle);
    let mut lower = || split(points, left, keyed_left, unit);
    let mut upper = || split(points, right, keyed_right, unit);
    if is_small {
        lower();
        upper();
    } else {
        rayon::join(lower, upper);
    }
}

/// The bounds of one node.
struct Bounds {
    low: Vec<f64>,
    high: Vec<f64>,
    center: Vec<f64>,
    radius: f64,
    row_radius: f64,
    lowest_row: u32,
}

/// The bounds of the nodes over `rows_below` rows each.
fn bounds(nodes: &Nodes, points: Rows<'_>, order: &[u32], rows_below: usize) -> Level {
    let dim = nodes.dim;
    let found: Vec<Bounds> = order
        .par_chunks(rows_below)
        .enumerate()
        .map(|(node, rows)| {
            let (low, high) = match nodes.levels.last() {
                None => points.extents(rows),
                Some(below) => extents_below(below, dim, node),
            };
            let (center, radius) = ball(points, rows, &low, &high);
            let first = node * rows_below;
            let radii = nodes.row_radii.get(first..first + rows.len()).unwrap_or(&[]);
            Bounds {
                low,
                high,
                center,
                radius,
                row_radius: radii.iter().fold(0.0, |a: f64, &r| a.max(r)),
                lowest_row: rows.iter().copied().min().unwrap_or(NO_ROW),
            }
        })
        .collect();
    let (count, groups) = (found.len(), found.len().div_ceil(FANOUT));
    let mut level = Level {
        count,
        cuts: Vec::with_capacity(groups),
        boxes: Vec::with_capacity(groups * dim),
        centers: Vec::with_capacity(groups * dim),
        radii: vec![],
        row_radii: vec![],
        lowest_rows: vec![],
    };
    for group in 0..groups {
        let at = |lane: usize| &found[(group * FANOUT + lane).min(count - 1)];
        let lanes = || (0..FANOUT).map(at);
        let nodes_of = &found[group * FANOUT..count.min((group + 1) * FANOUT)];
        let boxes: Vec<_> = nodes_of.iter().map(|node| (&node.low[..], &node.high[..])).collect();
        level.cuts.push(Cuts::between(&boxes));
        for axis in 0..dim {
            let ends = |lane| match lane {
                ..FANOUT => at(lane).low[axis],
                _ => at(lane - FANOUT).high[axis],
            };
            level.boxes.push(Lanes(std::array::from_fn(ends)));
            level.centers.push(Lanes(std::array::from_fn(|lane| at(lane).center[axis])));
        }
        level.radii.extend(lanes().map(|node| node.radius));
        level.lowest_rows.extend(lanes().map(|node| node.lowest_row));
        if !nodes.row_radii.is_empty() {
            level.row_radii.extend(lanes().map(|node| node.row_radius));
        }
    }
    level
}

/// Low and high ends of the children of a node.
fn extents_below(below: &Level, dim: usize, node: usize) -> (Vec<f64>, Vec<f64>) {
    let (mut low, mut high) = (vec![f64::INFINITY; dim], vec![f64::NEG_INFINITY; dim]);
    for child in node * FANOUT..below.count.min((node + 1) * FANOUT) {
        for (axis, (child_low, child_high)) in below.ends_of(dim, child).enumerate() {
            low[axis] = low[axis].min(child_low);
            high[axis] = high[axis].max(child_high);
        }
    }
    (low, high)
}

/// A ball around rows in a box: its center, and its radius rounded up.
fn ball(points: Rows<'_>, rows: &[u32], low: &[f64], high: &[f64]) -> (Vec<f64>, f64) {
    let mut center: Vec<f64> = low.iter().zip(high).map(|(l, h)| l / 2.0 + h / 2.0).collect();
    let extent = low.iter().zip(high).fold(0.0, |e: f64, (l, h)| e.max(h / 2.0 - l / 2.0));
    if extent == 0.0 || !extent.is_normal() {
        // Rows that are equal, or so close that twice the extent of each axis is as good a radius.
        let radius = extent * 4.0 * (low.len() as f64).sqrt();
        return (center, radius);
    }
    // Sizes of all kinds meet in one tree: distances are taken in units of the node.
    let exponent = (extent.to_bits() >> 52) as i32 - 1023;
    let farthest = |center: &[f64]| {
        let square = |row: u32| -> f64 {
            let along = points.at(row).iter().zip(center);
            along.map(|(x, c)| times_two_to(x / 2.0 - c / 2.0, 1 - exponent).powi(2)).sum()
        };
        rows.iter()
            .map(|&row| (square(row), row))
            .fold((-1.0, NO_ROW), |a, b| if b.0 > a.0 { b } else { a })
    };
    let (mut square, mut far) = farthest(&center);
    let mut best = (square, center.clone());
    for step in 1..=CENTER_STEPS {
        let part = 1.0 / (step + 2) as f64;
        for (c, x) in center.iter_mut().zip(points.at(far)) {
            *c += (x / 2.0 - *c / 2.0) * part * 2.0;
        }
        (square, far) = farthest(&center);
        if square < best.0 {
            best = (square, center.clone());
        }
    }
    let radius = times_two_to(best.0.sqrt() * BALL_SLACK, exponent);
    (best.1, radius.next_up())
}
