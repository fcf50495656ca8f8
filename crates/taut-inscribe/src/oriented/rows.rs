//! Conditions that rectangles of a cell obey, from the edges.
//!
//! *Points.* A point w of an edge that is surely below all sides but side k is not below side k, as it would be in the rectangle:
//! uₖ·w ≥ sₖ. That is linear in m and sₖ.
//! *Corners.* Take a connected part of the boundary whose points are surely below the two sides that do not meet in corner p. If one end
//! is surely beyond one of the two other sides, the other end beyond the other one, and n·q ≤ h for all points q of the part, with n
//! a normal of nonnegative products with the normals of these sides, then n·p ≤ h: otherwise the sides would part the two ends.

use crate::polygon::Segment;

use super::cell::{Cell, MARGIN, SLOPE, height, height_parts, largest_value};
use super::tree::Part;

/// Shares of the way along an edge are whole multiples of 1 over this, as in a certificate.
const SHARES: f64 = 65536.0;

/// The largest coordinate of a normal in a certificate.
const NORMAL_SIZE: f64 = (1u64 << 26) as f64;

/// Most edges of a part of the boundary before and after its first one.
const WALK_MAX: usize = 12;

/// A polynomial in the offsets and the slope that is not negative: c₀ + c₁m + c₂m² + Σ (αₖ + βₖm)sₖ.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Terms {
    pub(super) constant: [f64; 3],
    pub(super) of_side: [[f64; 2]; 4],
}

/// A condition: what names it, and its polynomial.
#[derive(Clone, Debug)]
pub(super) struct Condition {
    pub(super) part: Part,
    pub(super) terms: Terms,
}

impl Terms {
    /// The condition that a point is not below a side.
    pub(super) fn of_point(side: usize, w: [f64; 2]) -> Self {
        let [constant, linear] = height_parts(side, w);
        let mut terms = Terms { constant: [constant, linear, 0.0], ..Terms::default() };
        terms.of_side[side] = [-1.0, 0.0];
        terms
    }

    /// The condition that corner k, between sides k and k + 1, is in a half-plane n·p ≤ h.
    pub(super) fn of_corner(corner: usize, normal: [f64; 2], offset: f64) -> Self {
        let mut terms = Terms { constant: [offset, 0.0, offset], ..Terms::default() };
        for side in [corner, (corner + 1) % 4] {
            terms.of_side[side] = height_parts(side, normal).map(|x| -x);
        }
        terms
    }

    pub(super) fn add(&mut self, other: &Terms, weight: f64) {
        for (x, y) in self.constant.iter_mut().zip(other.constant) {
            *x += weight * y;
        }
        for (x, y) in self.of_side.as_flattened_mut().iter_mut().zip(other.of_side.as_flattened()) {
            *x += weight * y;
        }
    }

    pub(super) fn value(&self, at: &[f64; 5]) -> f64 {
        let m = at[SLOPE];
        let [c0, c1, c2] = self.constant;
        let of_sides: f64 =
            (0..4).map(|k| (self.of_side[k][0] + m * self.of_side[k][1]) * at[k]).sum();
        c0 + m * (c1 + m * c2) + of_sides
    }

    pub(super) fn gradient(&self, at: &[f64; 5]) -> [f64; 5] {
        let m = at[SLOPE];
        let mut gradient = [0.0; 5];
        gradient[SLOPE] = self.constant[1] + 2.0 * m * self.constant[2];
        for k in 0..4 {
            gradient[k] = self.of_side[k][0] + m * self.of_side[k][1];
            gradient[SLOPE] += self.of_side[k][1] * at[k];
        }
        gradient
    }

    /// How much more than its linear part the polynomial can be for changes up to `half`.
    pub(super) fn remainder(&self, half: &[f64; 5]) -> f64 {
        let of_sides: f64 = (0..4).map(|k| self.of_side[k][1].abs() * half[k]).sum();
        half[SLOPE] * (of_sides + self.constant[2].abs() * half[SLOPE])
    }
}

/// The largest (s₀ + s₂)(s₁ + s₃) − area·(1 + m²) plus a polynomial in a cell.
pub(super) fn largest(cell: &Cell, terms: &Terms, area: f64) -> f64 {
    let mut most = f64::NEG_INFINITY;
    for corner in 0..16 {
        let s = [0, 1, 2, 3].map(|k| if corner >> k & 1 == 1 { cell.high[k] } else { cell.low[k] });
        let [mut c0, mut c1, mut c2] = terms.constant;
        c0 += (s[0] + s[2]) * (s[1] + s[3]) - area;
        c2 -= area;
        for (s, [constant, linear]) in s.into_iter().zip(terms.of_side) {
            c0 += constant * s;
            c1 += linear * s;
        }
        most = most.max(largest_value([c0, c1, c2], cell.slopes()));
    }
    most
}

/// The edges, and which follow which.
pub(super) struct Boundary {
    pub(super) edges: Vec<Segment>,
    after: Vec<u32>,
    before: Vec<u32>,
    /// No coordinate is off by more, here and in a checker.
    pub(super) error: f64,
}

/// Conditions of a cell, or a point of an edge that is in all of its rectangles.
pub(super) enum Found {
    Entered(u32, u32),
    Conditions(Vec<Condition>),
}

impl Boundary {
    /// From edges and the same edges as given, ring by ring, in which no two vertices of a ring are equal.
    pub(super) fn of(edges: Vec<Segment>, given: &[Segment], error: f64) -> Self {
        let mut after: Vec<u32> = (1..=edges.len() as u32).collect();
        let mut first = 0;
        for edge in 0..given.len() {
            if given[edge][1] == given[first][0] {
                after[edge] = first as u32;
                first = edge + 1;
            }
        }
        let mut before = vec![0; edges.len()];
        for (edge, &next) in after.iter().enumerate() {
            if let Some(place) = before.get_mut(next as usize) {
                *place = edge as u32;
            }
        }
        Boundary { edges, after, before, error }
    }

    /// The point at a share of an edge.
    pub(super) fn point(&self, edge: u32, share: u32) -> [f64; 2] {
        let [a, b] = self.edges[edge as usize];
        let share = f64::from(share) / SHARES;
        [0, 1].map(|k| a[k] + share * (b[k] - a[k]))
    }

    /// How surely a point is below or above a side.
    fn margin(&self) -> f64 {
        MARGIN + 8.0 * self.error
    }

    /// For each side the shares of an edge that are surely below it; empty where the first is larger.
    fn below(&self, cell: &Cell, edge: u32) -> [[f64; 2]; 4] {
        let [a, b] = self.edges[edge as usize];
        let mut found = [[0.0f64, 1.0f64]; 4];
        for (side, range) in found.iter_mut().enumerate() {
            let top = cell.low[side] - self.margin();
            for slope in cell.slopes() {
                let (of_a, of_b) = (height(side, slope, a) - top, height(side, slope, b) - top);
                let share = of_a / (of_a - of_b);
                match (of_a < 0.0, of_b < 0.0) {
                    (true, true) => (),
                    (true, false) => range[1] = range[1].min(share),
                    (false, true) => range[0] = range[0].max(share),
                    (false, false) => *range = [2.0, -1.0],
                }
            }
        }
        found
    }

    /// The conditions of a list of edges.
    pub(super) fn conditions(&self, cell: &Cell, list: &[u32]) -> Found {
        let mut found = vec![];
        let has_core = (0..2).all(|k| cell.low[k] + cell.low[k + 2] > 0.0);
        for &edge in list {
            let below = self.below(cell, edge);
            if has_core && let Some([from, _]) = shares(&below) {
                return Found::Entered(edge, from);
            }
            for side in 0..4 {
                let others = [1, 2, 3].map(|k| below[(side + k) % 4]);
                let Some([from, to]) = shares(&others) else { continue };
                // The next edge has the vertex in which this one ends.
                let ends = if to == from || f64::from(to) == SHARES { 1 } else { 2 };
                for share in [from, to].into_iter().take(ends) {
                    let part = Part::Point { side: side as u8, edge, share };
                    let terms = Terms::of_point(side, self.point(edge, share));
                    found.push(Condition { part, terms });
                }
            }
            for corner in 0..4 {
                found.extend(self.corner(cell, corner, edge, &below));
            }
        }
        Found::Conditions(found)
    }

    /// The condition of a corner by a part of the boundary with an edge, whose normal it has.
    fn corner(
        &self,
        cell: &Cell,
        corner: usize,
        edge: u32,
        below: &[[f64; 2]; 4],
    ) -> Option<Condition> {
        let quadrant =
            |below: &[[f64; 2]; 4]| shares(&[below[(corner + 2) % 4], below[(corner + 3) % 4]]);
        let [from, to] = quadrant(below)?;
        let [a, b] = self.edges[edge as usize];
        let across = [b[1] - a[1], a[0] - b[0]];
        let size = across[0].abs().max(across[1].abs());
        let sides = [corner, (corner + 1) % 4];
        let sign = height(sides[0], cell.middle(SLOPE), across).signum();
        let named = across.map(|x| (sign * x / size * NORMAL_SIZE).round() as i64);
        let largest = named[0].abs().max(named[1].abs()) as f64;
        let normal = named.map(|x| x as f64 / largest);
        if sides.iter().any(|&side| cell.heights(side, normal)[0] <= MARGIN) {
            return None;
        }
        let mut offset = f64::NEG_INFINITY;
        let mut walk = |mut share: u32, is_forward: bool| {
            let (mut at, end) = (edge, if is_forward { SHARES as u32 } else { 0 });
            for _ in 0..WALK_MAX {
                let w = self.point(at, share);
                offset = offset.max(normal[0] * w[0] + normal[1] * w[1]);
                let beyond = self.beyond(cell, sides, w);
                if beyond != [false; 2] {
                    return Some((at, share, beyond));
                }
                if share != end {
                    return None;
                }
                at = if is_forward { self.after[at as usize] } else { self.before[at as usize] };
                let [from, to] = quadrant(&self.below(cell, at))?;
                let near = if is_forward { from } else { to };
                if f64::from(near) != SHARES - f64::from(end) {
                    return None;
                }
                share = if is_forward { to } else { from };
            }
            None
        };
        let (last, first) = (walk(to, true)?, walk(from, false)?);
        let parts = |one: [bool; 2], other: [bool; 2]| one[0] && other[1] || one[1] && other[0];
        parts(first.2, last.2).then(|| Condition {
            part: Part::Corner {
                corner: corner as u8,
                first: (first.0, first.1),
                last: (last.0, last.1),
                normal: named,
            },
            terms: Terms::of_corner(corner, normal, offset + self.margin()),
        })
    }

    /// Whether a point in the quadrant of a corner and in no rectangle is surely beyond the second of two sides and not the first, or
    /// the first and not the second.
    fn beyond(&self, cell: &Cell, sides: [usize; 2], w: [f64; 2]) -> [bool; 2] {
        let heights = sides.map(|side| cell.heights(side, w));
        [[0, 1], [1, 0]].map(|[one, other]| {
            heights[one][1] < cell.low[sides[one]] - self.margin()
                || heights[other][0] > cell.high[sides[other]] + self.margin()
        })
    }
}

/// The shares in all ranges, as a certificate writes them.
fn shares(ranges: &[[f64; 2]]) -> Option<[u32; 2]> {
    let from = ranges.iter().fold(0.0f64, |from, range| from.max(range[0]));
    let to = ranges.iter().fold(1.0f64, |to, range| to.min(range[1]));
    let (from, to) = ((from * SHARES).ceil(), (to * SHARES).floor());
    (from <= to).then_some([from as u32, to as u32])
}
