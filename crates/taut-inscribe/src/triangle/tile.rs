//! Boxes of corners, and the convex hull of what of the polygon lies in them.
//!
//! *Idea.* Many cells have the same box for one of their corners, so that boxes are kept by their coordinates. Each box has the edges
//! that may meet it, out of those of the box that it is half of.

use std::collections::HashMap;
use std::sync::{Arc, OnceLock};

use taut_points::{OrderBy, two_to};

use super::frame::Frame;
use super::gauge::turn;
use crate::levels::Levels;

/// How much boxes are enlarged beyond the errors of coordinates, more than in a checker: 2⁻⁴³.
const CLIP_ERROR: f64 = two_to(-43);

/// Edges in the lists of boxes after which boxes that no cell holds are forgotten, so that memory is bounded.
const LISTED_MAX: usize = 1 << 25;

/// Most half-planes of a hull; of more the longest sides are taken.
const HALF_PLANES_MAX: usize = 12;

/// Sides of a hull that are shorter than this share of its box have no half-plane.
const SHORT_SIDE: f64 = 1e-9;

/// A box of positions of a corner.
pub(super) struct Tile {
    pub(super) low: [f64; 2],
    pub(super) high: [f64; 2],
    /// The edges that may meet it.
    edges: Vec<u32>,
    /// Whether it is outside of the polygon.
    pub(super) is_outside: bool,
    hull: OnceLock<Hull>,
}

/// The convex hull of the part of the polygon in a box.
pub(super) struct Hull {
    /// The corners, counterclockwise.
    points: Vec<[f64; 2]>,
    /// Outer normals of sides that are not sides of the box, their larger coordinate 1 in size.
    pub(super) normals: Vec<[f64; 2]>,
}

impl Tile {
    pub(super) fn corners(&self) -> [[f64; 2]; 4] {
        let (low, high) = (self.low, self.high);
        [low, [high[0], low[1]], [low[0], high[1]], high]
    }

    pub(super) fn middle(&self) -> [f64; 2] {
        [0, 1].map(|k| 0.5 * self.low[k] + 0.5 * self.high[k])
    }

    /// Half the extents.
    pub(super) fn half(&self) -> [f64; 2] {
        [0, 1].map(|k| 0.5 * (self.high[k] - self.low[k]))
    }
}

impl Hull {
    /// The largest n·p over the points of the hull; −∞ where there are none.
    pub(super) fn support(&self, normal: [f64; 2]) -> f64 {
        let at = |p: &[f64; 2]| normal[0] * p[0] + normal[1] * p[1];
        self.points.iter().map(at).fold(f64::NEG_INFINITY, f64::max)
    }
}

/// The boxes so far.
pub(super) struct Tiles<'a> {
    pub(super) frame: &'a Frame,
    levels: Levels,
    known: HashMap<[u64; 4], Arc<Tile>>,
    listed: usize,
}

impl<'a> Tiles<'a> {
    pub(super) fn of(frame: &'a Frame) -> Self {
        let levels = Levels::of(&frame.edges, frame.extent[1]);
        Tiles { frame, levels, known: HashMap::new(), listed: 0 }
    }

    pub(super) fn is_inside(&self, p: [f64; 2]) -> bool {
        self.levels.is_inside(&self.frame.edges, p)
    }

    /// The box of all positions.
    pub(super) fn root(&self) -> Arc<Tile> {
        let [low, high] = self.frame.root();
        let edges = (0..self.frame.edges.len() as u32).collect();
        Arc::new(Tile { low, high, edges, is_outside: false, hull: OnceLock::new() })
    }

    /// The two halves of a box along an axis; `None` where rounding leaves no middle.
    pub(super) fn halves(&mut self, tile: &Tile, axis: usize) -> Option<[Arc<Tile>; 2]> {
        let (low, high) = (tile.low, tile.high);
        let at = 0.5 * low[axis] + 0.5 * high[axis];
        let (mut below, mut above) = (high, low);
        (below[axis], above[axis]) = (at, at);
        let has_middle = low[axis] < at && at < high[axis];
        has_middle.then(|| [self.part(tile, low, below), self.part(tile, above, high)])
    }

    /// A box in another one.
    fn part(&mut self, parent: &Tile, low: [f64; 2], high: [f64; 2]) -> Arc<Tile> {
        let key = [low[0], low[1], high[0], high[1]].map(f64::to_bits);
        if let Some(tile) = self.known.get(&key) {
            return tile.clone();
        }
        let meets = |edge: &&u32| self.clip(**edge, low, high).is_some();
        let edges: Vec<u32> = parent.edges.iter().filter(meets).copied().collect();
        let mut tile = Tile { low, high, edges, is_outside: false, hull: OnceLock::new() };
        tile.is_outside = match (tile.edges.is_empty(), parent.edges.is_empty()) {
            (false, _) => false,
            (true, true) => parent.is_outside,
            (true, false) => !self.is_inside(tile.middle()),
        };
        if self.listed > LISTED_MAX {
            self.known.clear();
            self.listed = 0;
        }
        self.listed += tile.edges.len() + 16;
        let tile = Arc::new(tile);
        self.known.insert(key, tile.clone());
        tile
    }

    /// The shares between which an edge is in a box, if it may meet it.
    fn clip(&self, edge: u32, low: [f64; 2], high: [f64; 2]) -> Option<[f64; 2]> {
        let [a, b] = self.frame.edges[edge as usize];
        let error = self.frame.error + CLIP_ERROR;
        let (mut from, mut to) = (0.0f64, 1.0f64);
        for k in 0..2 {
            let (below, above) = (low[k] - error - a[k], high[k] + error - a[k]);
            let along = b[k] - a[k];
            if along == 0.0 {
                if below > 0.0 || above < 0.0 {
                    return None;
                }
            } else {
                let (one, other) = (below / along, above / along);
                from = from.max(one.min(other));
                to = to.min(one.max(other));
            }
        }
        (from <= to).then_some([from, to])
    }

    /// The convex hull of the part of the polygon in a box.
    pub(super) fn hull<'t>(&self, tile: &'t Tile) -> &'t Hull {
        tile.hull.get_or_init(|| {
            let mut points: Vec<[f64; 2]> =
                tile.corners().into_iter().filter(|&p| self.is_inside(p)).collect();
            for &edge in &tile.edges {
                if let Some(shares) = self.clip(edge, tile.low, tile.high) {
                    let [a, b] = self.frame.edges[edge as usize];
                    points.extend(shares.map(|share| [0, 1].map(|k| a[k] + share * (b[k] - a[k]))));
                }
            }
            let points = convex_hull(points);
            let normals = normals(&points, tile);
            Hull { points, normals }
        })
    }
}

/// The convex hull of points, counterclockwise.
fn convex_hull(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.order_by(&|p, q| p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1])));
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let mut hull: Vec<[f64; 2]> = vec![];
    // The lower chain from left to right, then the upper one back.
    for is_upper in [false, true] {
        let first = hull.len();
        for &p in &points {
            while hull.len() >= first + 2
                && turn(hull[hull.len() - 2], hull[hull.len() - 1], p) <= 0.0
            {
                hull.pop();
            }
            hull.push(p);
        }
        hull.pop();
        if !is_upper {
            points.reverse();
        }
    }
    hull
}

/// The outer normals of the longest sides of a hull, but for those that lie along sides of the box.
fn normals(hull: &[[f64; 2]], tile: &Tile) -> Vec<[f64; 2]> {
    let [width, height] = tile.half();
    let slack = [SHORT_SIDE * width, SHORT_SIDE * height];
    let mut found: Vec<(f64, [f64; 2])> = vec![];
    for (i, &p) in hull.iter().enumerate() {
        let q = hull[(i + 1) % hull.len()];
        let along = [q[0] - p[0], q[1] - p[1]];
        let is_on_box = (0..2).any(|k| {
            let is_at = |end: f64, p: [f64; 2]| (p[k] - end).abs() <= slack[k];
            [tile.low[k], tile.high[k]].iter().any(|&end| is_at(end, p) && is_at(end, q))
        });
        let length = (along[0] / width).abs().max((along[1] / height).abs());
        if !is_on_box && length > SHORT_SIDE {
            let largest = along[0].abs().max(along[1].abs());
            found.push((length, [along[1] / largest, -along[0] / largest]));
        }
    }
    // Along the axes, where the hull ends before the box does.
    for k in 0..2 {
        for sign in [1.0, -1.0] {
            let mut normal = [0.0; 2];
            normal[k] = sign;
            let most = hull.iter().map(|p| sign * p[k]).fold(f64::NEG_INFINITY, f64::max);
            let end = if sign > 0.0 { tile.high[k] } else { -tile.low[k] };
            let room = (end - most) / [width, height][k];
            if room > SHORT_SIDE && room < f64::INFINITY {
                found.push((room, normal));
            }
        }
    }
    found.order_by(&|one, other| other.0.total_cmp(&one.0));
    found.truncate(HALF_PLANES_MAX);
    found.into_iter().map(|side| side.1).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::Loops;
    use crate::units::Units;

    #[test]
    fn the_hull_of_a_box_holds_the_polygon_there() {
        // A square less a triangle at its upper right corner.
        let mut loops = Loops::default();
        loops.push(&[[0.0, 0.0], [1.5, 0.0], [1.5, 0.5], [0.5, 1.5], [0.0, 1.5]]);
        let frame = Frame::of(Units::of(&loops.segments));
        let mut tiles = Tiles::of(&frame);
        let root = tiles.root();
        let mut right = None;
        if let Some([_, tile]) = tiles.halves(&root, 0) {
            right = tiles.halves(&tile, 1).map(|[_, above]| above);
        }
        let right = right.unwrap();
        let hull = tiles.hull(&right);
        assert!(!right.is_outside);
        let oblique = hull.normals.iter().find(|n| n[0] * n[1] != 0.0).unwrap();
        assert!((oblique[0] - 1.0).abs() < 1e-9 && (oblique[1] - 1.0).abs() < 1e-9);
        assert!((hull.support(*oblique) - 2.0).abs() < 1e-9);
        // The upper right quarter of that box is outside.
        let [_, upper] = tiles.halves(&right, 0).unwrap();
        let [_, corner] = tiles.halves(&upper, 1).unwrap();
        assert!(corner.is_outside);
    }
}
