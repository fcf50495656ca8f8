//! Boxes of corners, and what of the polygon lies in them.
//!
//! *Idea.* Many cells have the same box for one of their corners, so that boxes are kept by their coordinates. Each box has the edges
//! that may meet it, out of those of the box that it is half of.
//! *Rounding.* A vertex is off by at most e in both coordinates. Edges are clipped to boxes enlarged by e + [`CLIP_ERROR`]: shares
//! along an edge are off by 3u relatively, which moves their point by less than 2⁻⁴⁸. So each exact point of an edge in the box is
//! within e of a computed one between the computed shares. Where no edge comes as near as e to a point, moving the vertices to
//! their exact places lets no edge pass over it.

use std::cell::OnceCell;
use std::collections::HashMap;
use std::rc::Rc;

use crate::polygon::{Levels, Units};

/// How much boxes are enlarged beyond the errors of vertices: 2⁻⁴⁴.
const CLIP_ERROR: f64 = f64::from_bits((1023 - 44) << 52);

/// Edges in the lists of boxes after which boxes that no cell holds are forgotten, so that memory is bounded.
const LISTED_MAX: usize = 1 << 24;

/// A box of positions of a corner.
pub(super) struct Tile {
    pub(super) low: [f64; 2],
    pub(super) high: [f64; 2],
    /// The edges that may meet it.
    edges: Vec<u32>,
    /// Whether it is outside of the polygon.
    pub(super) is_outside: bool,
    /// The corners of the box that may be inside of the polygon.
    inner: OnceCell<Vec<[f64; 2]>>,
}

impl Tile {
    pub(super) fn corners(&self) -> [[f64; 2]; 4] {
        let (low, high) = (self.low, self.high);
        [low, [high[0], low[1]], [low[0], high[1]], high]
    }

    pub(super) fn middle(&self) -> [f64; 2] {
        [0, 1].map(|k| 0.5 * self.low[k] + 0.5 * self.high[k])
    }
}

/// The boxes so far.
pub(super) struct Tiles<'a> {
    pub(super) units: &'a Units,
    pub(super) levels: Levels,
    known: HashMap<[u64; 4], Rc<Tile>>,
    listed: usize,
}

impl<'a> Tiles<'a> {
    pub(super) fn of(units: &'a Units) -> Self {
        Tiles { units, levels: Levels::of(units), known: HashMap::new(), listed: 0 }
    }

    /// The box of all positions.
    pub(super) fn root(&mut self, [low, high]: [[f64; 2]; 2]) -> Rc<Tile> {
        let edges = (0..self.units.len() as u32).collect();
        Rc::new(Tile { low, high, edges, is_outside: false, inner: OnceCell::new() })
    }

    /// The two halves of a box along an axis; `None` where rounding leaves no middle.
    pub(super) fn halves(&mut self, tile: &Tile, axis: usize) -> Option<[Rc<Tile>; 2]> {
        let (low, high) = (tile.low, tile.high);
        let at = 0.5 * low[axis] + 0.5 * high[axis];
        let (mut below, mut above) = (high, low);
        (below[axis], above[axis]) = (at, at);
        let has_middle = low[axis] < at && at < high[axis];
        has_middle.then(|| [self.part(tile, low, below), self.part(tile, above, high)])
    }

    /// A box in another one.
    fn part(&mut self, parent: &Tile, low: [f64; 2], high: [f64; 2]) -> Rc<Tile> {
        let key = [low[0], low[1], high[0], high[1]].map(f64::to_bits);
        if let Some(tile) = self.known.get(&key) {
            return tile.clone();
        }
        let units = self.units;
        let meets = |edge: &&u32| clip(units, **edge, low, high).is_some();
        let edges: Vec<u32> = parent.edges.iter().filter(meets).copied().collect();
        let mut tile = Tile { low, high, edges, is_outside: false, inner: OnceCell::new() };
        tile.is_outside = match (tile.edges.is_empty(), parent.edges.is_empty()) {
            (false, _) => false,
            (true, true) => parent.is_outside,
            (true, false) => !self.levels.is_inside(units, tile.middle()),
        };
        if self.listed > LISTED_MAX {
            self.known.clear();
            self.listed = 0;
        }
        self.listed += tile.edges.len() + 16;
        let tile = Rc::new(tile);
        self.known.insert(key, tile.clone());
        tile
    }

    /// The largest n·p over the computed points p of the polygon in a box, for a normal with coordinates of at most 1 in size. Off by
    /// less than 4e and 2⁻⁴⁶; −∞ where there are none.
    pub(super) fn support(&self, tile: &Tile, normal: [f64; 2]) -> f64 {
        let at = |p: [f64; 2]| normal[0] * p[0] + normal[1] * p[1];
        let inner = tile.inner.get_or_init(|| {
            let is_inside = |p: &[f64; 2]| self.levels.is_inside(self.units, *p);
            tile.corners().into_iter().filter(is_inside).collect()
        });
        let mut most = inner.iter().map(|&p| at(p)).fold(f64::NEG_INFINITY, f64::max);
        for &edge in &tile.edges {
            if let Some(shares) = clip(self.units, edge, tile.low, tile.high) {
                for share in shares {
                    most = most.max(at(point(self.units, edge, share)));
                }
            }
        }
        most
    }
}

/// The point at a share of the way along an edge.
pub(super) fn point(units: &Units, edge: u32, share: f64) -> [f64; 2] {
    let [a, b] = units.edge(edge as usize);
    [0, 1].map(|k| a[k] + share * (b[k] - a[k]))
}

/// The shares between which an edge is in a box, if it may meet it.
fn clip(units: &Units, edge: u32, low: [f64; 2], high: [f64; 2]) -> Option<[f64; 2]> {
    let [a, b] = units.edge(edge as usize);
    let error = units.error() + CLIP_ERROR;
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
