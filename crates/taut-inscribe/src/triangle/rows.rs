//! Conditions that triangles of a cell obey: from the edges that may enter them, and from the hulls of their boxes.

use super::bound::{Row, doubled_area};
use super::cell::{Cell, middle, product};
use super::gauge::{Triangle, minus, turn};
use super::lines::Lines;
use super::program::{Column, ROWS};
use super::tile::Tiles;
use super::tree::{Leaf, Part};
use crate::groups::Groups;

/// Shares of the way along an edge are whole multiples of 1 over this, as in a certificate.
const SHARES: f64 = 65536.0;

/// Largest numerator of a weight in a certificate.
const WEIGHT_MAX: f64 = (1u64 << 53) as f64;

/// A condition.
#[derive(Clone, Copy, Debug)]
pub(super) enum Condition {
    /// The point at a share of the way along an edge is not left of the side that begins at a corner.
    Side { side: usize, edge: u32, share: u32, point: [f64; 2] },
    /// The corner is in the half-plane with an outer normal that holds the hull of its box.
    Half { corner: usize, normal: [f64; 2] },
}

impl Condition {
    /// Numbers by which conditions differ.
    pub(super) fn key(&self) -> [u32; 3] {
        match *self {
            Condition::Side { side, edge, share, .. } => [side as u32, edge, share],
            Condition::Half { corner, .. } => [3 + corner as u32, 0, 0],
        }
    }
}

/// What is known of the groups of a list.
pub(super) enum Entered {
    /// A point of an edge, by a share of its length, that is in all triangles.
    Surely(u32, u32),
    /// The groups that may enter some triangle, and conditions with how much the middle of the cell breaks them, from −1 to 1.
    Perhaps(Vec<u32>, Vec<(f64, Condition)>),
}

/// The first and the last multiple of 1/[`SHARES`] in a range, strictly within it except at the ends of the edge.
fn whole_shares([from, to]: [f64; 2]) -> Option<[u32; 2]> {
    let low = if from == 0.0 { 0.0 } else { (from * SHARES).floor() + 1.0 };
    let high = if to == 1.0 { SHARES } else { (to * SHARES).ceil() - 1.0 };
    (low <= high).then_some([low as u32, high as u32])
}

/// The intersection of ranges; `None` where it or one of them is empty.
fn common(ranges: &[Option<[f64; 2]>]) -> Option<[f64; 2]> {
    let both = |[a, b]: [f64; 2], range: &Option<[f64; 2]>| {
        range.map(|[from, to]| [a.max(from), b.min(to)]).filter(|[from, to]| from <= to)
    };
    ranges.iter().try_fold([0.0, 1.0], both)
}

/// Which groups of a list may enter triangles; an error bounds what counts as left.
pub(super) fn examine(groups: &Groups, lines: &[Lines; 3], list: &[u32], error: f64) -> Entered {
    let mut examined = Examined { groups, lines, error, last: None, conditions: vec![] };
    let (mut kept, mut pending) = (Vec::with_capacity(list.len()), vec![]);
    for &group in list {
        pending.push(group);
        while let Some(group) = pending.pop() {
            let extent = groups.extent(group);
            if extent.half[0].is_infinite() {
                continue;
            }
            // A condition takes a point that is surely left of two sides.
            let (mut is_right, mut sides) = (false, 0);
            for side in lines {
                let [least, most] = side.largest_over(extent);
                if most <= 0.0 {
                    is_right = true;
                    break;
                }
                sides += u32::from(least > error);
            }
            if is_right {
                continue;
            }
            match groups.children(group) {
                _ if sides < 2 => kept.push(group),
                Some([one, other]) => pending.extend([other, one]),
                None => {
                    let mut is_kept = false;
                    for edge in groups.range(group) {
                        match examined.edge(edge) {
                            Some(share) => return Entered::Surely(edge, share),
                            None => is_kept |= examined.may_enter(),
                        }
                    }
                    if is_kept {
                        kept.push(group);
                    }
                }
            }
        }
    }
    Entered::Perhaps(kept, examined.conditions)
}

/// Edges examined one after the other.
struct Examined<'a> {
    groups: &'a Groups,
    lines: &'a [Lines; 3],
    error: f64,
    /// The last edge, and the values of the lines at its ends.
    last: Option<(u32, [[[f64; 2]; 3]; 2])>,
    conditions: Vec<(f64, Condition)>,
}

impl Examined<'_> {
    /// Whether the last edge may enter a triangle.
    fn may_enter(&self) -> bool {
        self.last.is_some_and(|(_, [from, to])| {
            (0..3).all(|side| from[side][1] > 0.0 || to[side][1] > 0.0)
        })
    }

    /// Adds the conditions of an edge; returns the share of its length at which it is in all triangles, if there is one.
    fn edge(&mut self, edge: u32) -> Option<u32> {
        let (lines, error) = (self.lines, self.error);
        let [a, b] = self.groups.edge(edge);
        let ranges = |w: [f64; 2]| [0, 1, 2].map(|side: usize| lines[side].range(w));
        // Where an edge follows another one, its first vertex is the last one of that.
        let from = match self.last {
            Some((before, [_, ranges]))
                if before + 1 == edge && self.groups.edge(before)[1] == a =>
            {
                ranges
            }
            _ => ranges(a),
        };
        let to = ranges(b);
        self.last = Some((edge, [from, to]));
        if !self.may_enter() {
            return None;
        }
        let left = |side: usize| {
            let (one, other) = (from[side], to[side]);
            if one[0] > error && other[0] > error {
                Some([0.0, 1.0])
            } else if one[1] <= error && other[1] <= error {
                None
            } else {
                lines[side].shares_left(a, b, error)
            }
        };
        let (one, other) = (left(0), left(1));
        if one.is_none() && other.is_none() {
            return None;
        }
        let left = [one, other, left(2)];
        if let Some([first, last]) = common(&left).and_then(whole_shares) {
            return Some(if first == 0 { 0 } else { (first + last) / 2 });
        }
        for side in 0..3 {
            let others = [left[(side + 1) % 3], left[(side + 2) % 3]];
            let Some([low, high]) = common(&others).and_then(whole_shares) else { continue };
            let shares = [low, high];
            for &share in &shares[..if low < high { 2 } else { 1 }] {
                let t = f64::from(share) / SHARES;
                // The last vertex is the first one of the next edge.
                if t < 1.0 {
                    let point = [0, 1].map(|k| a[k] + t * (b[k] - a[k]));
                    let range = if share == 0 { from[side] } else { lines[side].range(point) };
                    if range[1] > 0.0 {
                        let broken = (range[1] + range[0]) / (range[1] - range[0]);
                        let condition = Condition::Side { side, edge, share, point };
                        self.conditions.push((broken, condition));
                    }
                }
            }
        }
        None
    }
}

/// The half-planes of the boxes of a cell.
pub(super) fn half_planes<'a>(
    cell: &'a Cell,
    tiles: &'a Tiles<'_>,
) -> impl Iterator<Item = Condition> + 'a {
    cell.iter().enumerate().flat_map(|(corner, tile)| {
        let normals = tiles.hull(tile).normals.iter();
        normals.map(move |&normal| Condition::Half { corner, normal })
    })
}

/// The gradient of the doubled area of the ends of a side and a point, times changes of the ends.
pub(super) fn side_gradient(
    triangle: &Triangle,
    side: usize,
    w: [f64; 2],
    half: [[f64; 2]; 3],
) -> [f64; ROWS] {
    let next = (side + 1) % 3;
    let (p, q) = (minus(triangle[side], w), minus(triangle[next], w));
    let mut gradient = [0.0; ROWS];
    gradient[2 * side] = q[1] * half[side][0];
    gradient[2 * side + 1] = -q[0] * half[side][1];
    gradient[2 * next] = -p[1] * half[next][0];
    gradient[2 * next + 1] = p[0] * half[next][1];
    gradient
}

/// The column of a condition in the program of a cell.
pub(super) fn column(cell: &Cell, tiles: &Tiles<'_>, condition: &Condition) -> Column {
    let triangle = middle(cell);
    let half = cell.each_ref().map(|tile| tile.half());
    match *condition {
        Condition::Side { side, point, .. } => {
            let mut gradient = side_gradient(&triangle, side, point, half);
            gradient[6 + side] = product(half, side);
            Column::new(turn(triangle[side], triangle[(side + 1) % 3], point), gradient)
        }
        Condition::Half { corner, normal } => {
            let p = triangle[corner];
            let offset = tiles.hull(&cell[corner]).support(normal);
            let mut gradient = [0.0; ROWS];
            gradient[2 * corner] = normal[0] * half[corner][0];
            gradient[2 * corner + 1] = normal[1] * half[corner][1];
            Column::new(normal[0] * p[0] + normal[1] * p[1] - offset, gradient)
        }
    }
}

/// The leaf of conditions with weights in as many bits, and the bound that it proves; `None` where no weight is left.
pub(super) fn leaf(
    cell: &Cell,
    tiles: &Tiles<'_>,
    weighted: &[(Condition, f64)],
    [bits, normal_bits]: [u32; 2],
    error: f64,
) -> Option<(Leaf, f64)> {
    let denominator = (1u64 << bits) as f64;
    let (mut rows, mut parts) = (vec![], vec![]);
    for &(condition, weight) in weighted {
        let whole = (weight * denominator).round().min(WEIGHT_MAX);
        if whole < 1.0 {
            continue;
        }
        let weight = whole / denominator;
        let (kind, named, row) = match condition {
            Condition::Side { side, edge, share, point } => (
                3 + side as u8,
                [i64::from(edge), i64::from(share)],
                Row::Side { side, point, weight },
            ),
            Condition::Half { corner, normal } => {
                let whole = normal.map(|x| (x * (1u64 << normal_bits) as f64).round());
                let largest = whole[0].abs().max(whole[1].abs());
                let normal = whole.map(|x| x / largest);
                let offset = tiles.hull(&cell[corner]).support(normal) + error;
                (
                    corner as u8,
                    whole.map(|x| x as i64),
                    Row::Half { corner, normal, offset, weight },
                )
            }
        };
        rows.push(row);
        parts.push(Part { kind, named, weight: whole as i64 });
    }
    if parts.is_empty() {
        return None;
    }
    let bound = doubled_area(cell, &rows, error);
    Some((Leaf::Rows { bits, parts }, bound))
}
